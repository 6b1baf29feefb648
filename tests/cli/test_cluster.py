# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes of resources/cluster give the bytes of one machine, though a worker is killed and a shard is repeated. A long trial that
asks for a scheduler (`packaging/install --cluster`): it runs where GLISSON_CLUSTER_PATIENTS says with how many patients, at least 4."""
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

import slurm_node
from support import CLI, cli, folder_of_class
from test_cohort import coarse_patients, digests

CLUSTER = pathlib.Path(os.environ["GLISSON_ROOT"]) / "resources" / "cluster"
NUMBER = int(os.environ.get("GLISSON_CLUSTER_PATIENTS", "0"))
SHARDS = 2
# The runs with other assumptions would be the same four patients once more in each of the three ways.
OPTIONS = "--no-sensitivity"


def kill_worker(results, shard):
    """Kills the program that works on a shard once it has finished a patient and has another to do."""
    end = time.monotonic() + 1800
    while time.monotonic() < end:
        if list((results / f"shard-{shard}").glob("cases/*/result.json")):
            for process in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
                try:
                    words = process.read_bytes().split(b"\0")
                except OSError:
                    continue
                if f"{shard}/{SHARDS}".encode() in words and words[0] == str(CLI).encode() and str(results).encode() in b" ".join(words):
                    os.kill(int(process.parent.name), signal.SIGKILL)
                    return
        time.sleep(0.02)
    raise AssertionError("there was no worker to kill")


@unittest.skipUnless(NUMBER >= 4, "GLISSON_CLUSTER_PATIENTS does not ask for at least 4 patients")
@unittest.skipUnless(shutil.which("snakemake") or slurm_node.installed(), "neither snakemake nor Slurm is installed")
class Cluster(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        cls.patients = cls.folder / "patients"
        coarse_patients(cls.patients, NUMBER)
        cls.whole = cls.folder / "whole"
        cli("cohort", cls.patients, "--output", cls.whole, OPTIONS)

    @unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
    def test_snakemake(self):
        results = self.folder / "snakemake"
        command = ["snakemake", "--snakefile", CLUSTER / "Snakefile", "--cores", "2", "--config", f"patients={self.patients}",
                   f"results={results}", f"shards={SHARDS}", f"glisson_cli={CLI}", f"options={OPTIONS}"]
        with open(self.folder / "first.log", "w") as log:
            first = subprocess.Popen(command, cwd=self.folder, stdout=log, stderr=log)
            kill_worker(results, 1)
            self.assertNotEqual(first.wait(), 0, "nobody noticed that a worker was killed")
        self.assertFalse((results / "cohort/report.html").exists())
        for further in ([], ["--forcerun", results / "shard-2/shard.json"]):
            run = subprocess.run([*command, *further], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(digests(results / "cohort"), digests(self.whole))

    @unittest.skipUnless(slurm_node.installed(), "Slurm is not installed, or this is not root")
    def test_slurm(self):
        results = self.folder / "slurm"
        with slurm_node.one_node(self.folder / "node") as environment:
            environment.update(PATIENTS=str(self.patients), RESULTS=str(results), GLISSON_CLI=str(CLI), OPTIONS=OPTIONS)

            def submit(*arguments, **more):
                done = subprocess.run(["sbatch", "--parsable", *map(str, arguments)], cwd=self.folder, env={**environment, **more},
                                      capture_output=True, text=True)
                return done.returncode, done.stdout.strip(), done.stderr

            _, shards, _ = submit(f"--array=1-{SHARDS}", CLUSTER / "cohort.sbatch")
            kill_worker(results, 1)
            # The merge waits for tasks that have succeeded, so that it cannot start; Slurm says so and takes it away.
            submit("--wait", f"--dependency=afterok:{shards}", "--kill-on-invalid-dep=yes", CLUSTER / "merge.sbatch")
            self.assertFalse((results / "cohort").exists())
            # The one that was killed, and one that was done.
            for shard in (1, 2):
                code, _, said = submit("--wait", f"--array={shard}", CLUSTER / "cohort.sbatch", SHARDS=str(SHARDS))
                self.assertEqual(code, 0, said)
            code, _, said = submit("--wait", CLUSTER / "merge.sbatch")
            self.assertEqual(code, 0, said)
        self.assertEqual(digests(results / "cohort"), digests(self.whole))


if __name__ == "__main__":
    unittest.main()
