# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command printed in README.md and in the rooms' README files is run, in order, in a copy of nothing but the build."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import CLI, ROOT


def commands(path):
    """Lines of the ```sh blocks of a document."""
    for block in re.findall(r"^```sh\n(.*?)^```", path.read_text(encoding="utf-8"), re.M | re.S):
        for line in block.splitlines():
            line = line.split("  #")[0].strip()
            if line:
                yield line


class Documents(unittest.TestCase):
    def test_every_printed_command_runs(self):
        documents = [ROOT / "README.md", *sorted(ROOT.glob("core/**/README.md")), *sorted(ROOT.glob("ui/**/README.md")),
                     *sorted(ROOT.glob("packaging/**/README.md"))]
        ran = 0
        with tempfile.TemporaryDirectory() as folder:
            bin_folder = pathlib.Path(folder) / "bin"
            bin_folder.mkdir()
            os.symlink(CLI, bin_folder / "glisson-cli")
            env = {**os.environ, "PATH": f"{bin_folder}:{os.environ['PATH']}"}
            for document in documents:
                for command in commands(document):
                    if command.startswith("git clone") or command.startswith("cd "):
                        continue
                    if command.startswith("packaging/"):
                        # The set-up commands are what started this test; that they exist and can be run is checked here.
                        script = ROOT / command.split()[0]
                        self.assertTrue(os.access(script, os.X_OK), command)
                        subprocess.run(["bash", "-n", str(script)], check=True)
                        ran += 1
                        continue
                    done = subprocess.run(command, shell=True, cwd=folder, env=env, capture_output=True, text=True)
                    self.assertEqual(done.returncode, 0, f"{document.name}: {command}: {done.stderr[-400:]}")
                    ran += 1
        self.assertGreater(ran, 5)


if __name__ == "__main__":
    unittest.main()
