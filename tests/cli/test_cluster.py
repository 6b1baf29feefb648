# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes of resources/cluster give the bytes of one machine; skipped where their scheduler is not installed."""
import os
import pathlib
import shutil
import subprocess
import unittest

from support import CLI, cli, folder_of_class
from test_cohort import coarse_patients, digests

CLUSTER = pathlib.Path(os.environ["GLISSON_ROOT"]) / "resources" / "cluster"


def slurm_answers():
    return shutil.which("sinfo") and subprocess.run(["sinfo", "--noheader"], capture_output=True, timeout=30).returncode == 0


class Cluster(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which("snakemake") and not slurm_answers():
            raise unittest.SkipTest("neither snakemake nor a Slurm cluster is there")
        cls.folder = folder_of_class(cls)
        cls.patients = cls.folder / "patients"
        coarse_patients(cls.patients, 2)
        cls.whole = cls.folder / "whole"
        cli("cohort", cls.patients, "--output", cls.whole)

    def test_snakemake(self):
        if not shutil.which("snakemake"):
            self.skipTest("snakemake is not installed")
        results = self.folder / "snakemake"
        run = subprocess.run(["snakemake", "--snakefile", CLUSTER / "Snakefile", "--cores", "2", "--config",
                              f"patients={self.patients}", f"results={results}", "shards=2", f"glisson_cli={CLI}"],
                             cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(digests(results / "cohort"), digests(self.whole))

    def test_slurm(self):
        if not slurm_answers():
            self.skipTest("no Slurm cluster answers")
        results = self.folder / "slurm"
        environment = {**os.environ, "PATIENTS": str(self.patients), "RESULTS": str(results), "GLISSON_CLI": str(CLI)}

        def submit(*arguments):
            return subprocess.run(["sbatch", "--parsable", *map(str, arguments)], cwd=self.folder, env=environment,
                                  capture_output=True, text=True, check=True).stdout.strip()
        shards = submit("--array=1-2", CLUSTER / "cohort.sbatch")
        submit("--wait", f"--dependency=afterok:{shards}", CLUSTER / "merge.sbatch")
        self.assertEqual(digests(results / "cohort"), digests(self.whole))


if __name__ == "__main__":
    unittest.main()
