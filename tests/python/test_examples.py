# SPDX-License-Identifier: GPL-3.0-or-later
"""The three notebooks run as scripts; each checks its own numbers. Their cells are those of the percent format."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(os.environ["GLISSON_ROOT"]) / "resources/examples/python"


class Examples(unittest.TestCase):
    def run_example(self, name, *said):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, EXAMPLES / name], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout[-1500:] + done.stderr[-1500:])
        for words in said:
            self.assertIn(words, done.stdout)

    def test_a_patient(self):
        self.run_example("01_patient.py", "shear modulus", "unknowns", "vessel landmarks")

    def test_a_parameter_study(self):
        self.run_example("02_parameter_study.py", "1000 forces answered", "youngs_kPa")

    def test_statistics_of_a_cohort(self):
        self.run_example("03_cohort_statistics.py", "rank correlation")

    def test_every_example_is_run_and_has_cells(self):
        self.assertEqual([p.name for p in sorted(EXAMPLES.glob("*.py"))],
                         ["01_patient.py", "02_parameter_study.py", "03_cohort_statistics.py"])
        for path in EXAMPLES.glob("*.py"):
            text = path.read_text(encoding="utf-8")
            self.assertTrue(text.startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n\n# %% [markdown]\n# # "), path.name)
            self.assertGreater(text.count("\n# %%\n"), 3, path.name)


if __name__ == "__main__":
    unittest.main()
