# SPDX-License-Identifier: GPL-3.0-or-later
"""The cohort as a researcher runs it: several patients, one of them bad; killed and resumed; sharded and merged."""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from support import CLI, cli, cli_json, folder_of_class


def digests(folder):
    """Every file that must be the same wherever and however often it is made."""
    folder = pathlib.Path(folder)
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.rglob("*"))
            if p.is_file() and p.name != "timings.csv"}


def coarse_patients(folder, number):
    """Synthetic patients whose livers are cut into cells of 8 mm: a cohort that takes seconds."""
    cli("phantom", "--cases", number, "--seed", 11, "--cohort", "paper", "--output", folder, "--quiet")
    for scene_file in folder.glob("*/scene.json"):
        scene = json.loads(scene_file.read_text())
        scene["geometry"]["cell_mm"] = 8
        scene_file.write_text(json.dumps(scene))


class Cohort(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        cls.patients = cls.folder / "patients"
        coarse_patients(cls.patients, 2)
        for n, name in enumerate(("Doefeather^Jane", "Zoeblossom^Zelda"), 1):
            (cls.patients / f"patient-00{n}").rename(cls.patients / name)
        bad = cls.patients / "Poewhistle^Paul"
        shutil.copytree(cls.patients / "Doefeather^Jane", bad)
        # One slice in the middle of the elastogram is gone.
        images = sorted((bad / "mre" / "stiffness").iterdir())
        images[len(images) // 2].unlink()
        cls.whole = cls.folder / "whole"
        cls.result = cli_json("cohort", cls.patients, "--output", cls.whole, "--no-sensitivity", code=6)

    def test_reports_both_studies(self):
        r = self.result
        self.assertEqual((r["retraction"]["tried"], r["retraction"]["left"]), (3, 2))
        truth = [json.loads((self.patients / n / "truth.json").read_text())["shear_kPa"]
                 for n in ("Doefeather^Jane", "Zoeblossom^Zelda")]
        measured = [c["shear_kPa"] for c in r["cases"] if c["status"] == "done"]
        self.assertEqual(len(measured), len(truth))
        for t, m in zip(truth, measured):
            self.assertAlmostEqual(t, m, delta=0.02 * t)
        # The stiffness of a patient who is rejected later counts: a slice is missing, the others are measured.
        known = [c["shear_kPa"] for c in r["cases"] if c.get("shear_kPa")]
        over = sum(m > 3.1 for m in known) / len(known)
        self.assertAlmostEqual(r["stiffness"]["fraction_over_1kPa"], over, places=12)
        for name in ("cohort.json", "patients.csv", "rejected.csv", "report.html", "report.pdf", "figures/stiffness-histogram.png",
                     "figures/difference-retractor.svg"):
            self.assertTrue((self.whole / name).stat().st_size > 100, name)
        self.assertEqual(len(r["chosen"]), 2)

    def test_rejects_with_the_reason(self):
        bad = [c for c in self.result["cases"] if c["status"] != "done"]
        self.assertEqual([c["id"] for c in bad], ["case-002"])
        self.assertEqual(bad[0]["status"], "rejected")
        self.assertIn("slice", bad[0]["reason"])

    def test_names_nobody(self):
        for path in self.whole.rglob("*"):
            if path.is_file():
                data = path.read_bytes()
                if path.suffix == ".pdf" and shutil.which("pdftotext"):
                    words = subprocess.run(["pdftotext", path, "-"], capture_output=True, check=True).stdout
                    self.assertIn(b"Research use only", words)
                    data += words
                for name in (b"Doefeather", b"Zoeblossom", b"Poewhistle", str(self.folder).encode()):
                    self.assertFalse(name in data, f"{name} in {path}")

    def test_resumes_with_the_same_result_after_a_kill(self):
        output = self.folder / "killed"
        command = [CLI, "cohort", str(self.patients), "--output", str(output), "--no-sensitivity", "--jobs", "1",
                   "--quiet"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 300
        while not list(output.glob("cases/*/result.json")) and time.monotonic() < deadline:
            time.sleep(0.02)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
        before = {p: p.stat().st_mtime_ns for p in output.glob("cases/*/result.json")}
        self.assertTrue(0 < len(before) < 3)
        cli("cohort", self.patients, "--output", output, "--no-sensitivity", code=6)
        for path, written in before.items():
            self.assertEqual(path.stat().st_mtime_ns, written, "computed again")
        self.assertEqual(digests(output), digests(self.whole))

    def test_shards_merge_to_the_same_bytes(self):
        for shard in (1, 2):
            cli_json("cohort", self.patients, "--shard", f"{shard}/2", "--output", self.folder / f"shard{shard}",
                     code=6 if shard == 2 else 0)
        merged = self.folder / "merged"
        cli("cohort", "merge", self.folder / "shard1", self.folder / "shard2", "--data", self.patients, "--output",
            merged, "--no-sensitivity", code=6)
        self.assertEqual(digests(merged), digests(self.whole))
        message = cli("cohort", "merge", self.folder / "shard1", "--output", merged, code=3).stderr
        self.assertIn("shards are missing", message)

    def test_a_report_of_each_patient_on_request(self):
        out = self.folder / "with-reports"
        cli("cohort", self.patients, "--output", out, "--no-sensitivity", "--reports", "--quiet", code=6)
        for case in ("case-001", "case-003"):
            report = out / "cases" / case / "report"
            page = (report / "report.html").read_text()
            self.assertIn("data:image/png;base64", page)
            for name in ("Doefeather", "Zoeblossom", str(self.patients)):
                self.assertNotIn(name, page)
                self.assertNotIn(name, (report / "run.json").read_text())
            self.assertEqual((report / "report.pdf").read_bytes()[:5], b"%PDF-")
        self.assertFalse((out / "cases" / "case-002" / "report").exists())
        # The numbers are those of a run without reports; the vessels come on top.
        for case in ("case-001", "case-002", "case-003"):
            a, b = (json.loads((f / "cases" / case / "result.json").read_text()) for f in (out, self.whole))
            self.assertEqual({k: v for k, v in a.items() if "vessel" not in k and k != "key"},
                             {k: v for k, v in b.items() if "vessel" not in k and k != "key"})
            self.assertNotEqual(a["key"], b["key"], "a cohort would mix records with and without vessels")

    def test_refuses_what_is_no_cohort(self):
        empty = self.folder / "empty"
        empty.mkdir()
        self.assertIn("no patient was found", cli("cohort", empty, code=3).stderr)
        self.assertIn("--shard", cli("cohort", self.patients, "--shard", "3", "--output", empty, code=3).stderr)


class HowSure(unittest.TestCase):
    def test_shares_have_intervals_where_the_patients_say_how_sure_they_are(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            coarse_patients(folder / "patients", 2)
            for scene_file in (folder / "patients").glob("*/scene.json"):
                scene = json.loads(scene_file.read_text())
                scene["uncertainty"] = {"fields": 4, "checks": 0}
                scene_file.write_text(json.dumps(scene))
            r = cli_json("cohort", folder / "patients", "--output", folder / "out", "--no-sensitivity")
            done = [c for c in r["cases"] if c["probability_beyond_5mm"] is not None]
            self.assertEqual(len(done), 2)
            for c in done:
                self.assertLess(c["at_retractor_low_mm"], c["at_retractor_mm"])
                self.assertGreater(c["at_retractor_high_mm"], c["at_retractor_mm"])
            sure = r["retraction"]["how_sure"]
            self.assertEqual(sure["patients"], 2)
            for share, probability in (("fraction_clinically_significant", "probability_beyond_5mm"),
                                       ("fraction_travel_clinically_significant", "probability_travel_beyond_5mm"),
                                       ("fraction_within_voxel", "probability_within_voxel")):
                p, q = (c[probability] for c in done)
                self.assertAlmostEqual(sure[share]["expected"], (p + q) / 2)
                of_count = [(1 - p) * (1 - q), p * (1 - q) + q * (1 - p), p * q]
                quantile = lambda s: next(k for k in range(3) if sum(of_count[:k + 1]) >= s or k == 2) / 2
                self.assertEqual(sure[share]["interval95"], [quantile(0.025), quantile(0.975)])
            self.assertIn("sum of their probabilities", (folder / "out/report.html").read_text())
            self.assertIn("probability_beyond_5mm", (folder / "out/patients.csv").read_text())


if __name__ == "__main__":
    unittest.main()
