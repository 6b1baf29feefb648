# SPDX-License-Identifier: GPL-3.0-or-later
"""A synthetic patient from DICOM to overlays with no display; and a patient called PHI^CANARY who must not be seen."""
import json
import subprocess
import sys
import unittest

from support import cli, cli_json, folder_of_class


class Journey(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        cls.demo = cls.folder / "demo"
        cls.told = cli_json("demo", "--seed", 5, "--output", cls.demo, env={"DISPLAY": "", "WAYLAND_DISPLAY": ""})
        cls.patient = cls.demo / "patient-001"
        cls.truth = json.loads((cls.patient / "truth.json").read_text())

    def test_scan_finds_every_role_with_a_reason(self):
        series = cli_json("scan", self.patient)["series"]
        roles = {s["role"] for s in series}
        self.assertLessEqual({"anatomical", "magnitude", "wave", "stiffness", "confidence"}, roles)
        for s in series:
            self.assertTrue(s["role_reason"])
        waves = sorted((s for s in series if s["role"] == "wave"), key=lambda s: s["time_step"])
        self.assertEqual([s["time_step"] for s in waves], [0, 1, 2, 3])
        self.assertEqual(len({s["uid"].split("#")[0] for s in waves}), 1, "one series")
        self.assertEqual(len({(s["slices"], *s["origin_lps_mm"], *s["spacing_mm"]) for s in waves}), 1, "one grid")

    def test_measure_recovers_the_truth(self):
        r = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.patient / "rtstruct.dcm")
        error = abs(r["pooled"]["mean_kPa"] - self.truth["shear_kPa"])
        noise_of_mean = self.truth["noise_kPa"] / r["pooled"]["n"] ** 0.5
        # A hand-drawn outline takes in and leaves out voxels at the border: 0.5 % of the mean on top of the noise.
        self.assertLess(error, 5 * noise_of_mean + 0.005 * self.truth["shear_kPa"])
        self.assertLess(r["pooled"]["n"], r["pooled"]["n_before_mask"])

    def test_demo_goes_from_nothing_to_overlays(self):
        out, r = self.demo / "run", self.told
        self.assertAlmostEqual(r["model"]["volume_mL"], self.truth["volume_mL"], delta=0.03 * self.truth["volume_mL"])
        self.assertTrue(r["solver"]["converged"])
        self.assertIn("overlay-3d-oblique.png", r["files"])
        d = r["difference"]
        self.assertGreater(d["max_mm"], d["mean_mm"])
        self.assertGreater(d["vessels"]["landmarks"], 100)
        # What the cells may shift: both answers are shifted alike, so the difference is shifted less.
        error = r["discretisation_error"]
        self.assertTrue(error["known"], error["note"])
        self.assertGreater(error["difference"]["mean_mm"], 0)
        self.assertLess(error["difference"]["mean_mm"], error["mean_mm"])
        self.assertGreater(error["difference"]["at_retractor_mm"], 0)
        self.assertLess(error["difference"]["at_retractor_mm"], error["max_mm"])
        self.assertGreater(error["at_retractor_mm"], 0)
        for told in (error, error["difference"]):
            self.assertLessEqual(told["vessels_mm"], told["vessels_max_mm"])
            self.assertGreater(told["vessels_mm"], 0)
        self.assertLess(error["difference"]["vessels_mm"], error["vessels_mm"])
        open_ = abs(d["at_retractor_mm"] - 5) <= error["difference"]["at_retractor_mm"]
        self.assertEqual(any("on which side of that line" in w for w in r["warnings"]), open_)
        self.assertEqual(d["significance"], "open" if open_ else "beyond" if d["clinically_significant"] else "below")
        page = (out / "report.html").read_text()
        self.assertIn("of the difference MRE against atlas", page)
        self.assertIn("At the retractor, error from the size of the cells", page)
        self.assertAlmostEqual(r["load_N"][1], -r["model"]["mass_kg"] * 9.81, delta=2e-5)  # the solver's 1e-6
        for name in r["files"]:
            self.assertTrue((out / name).exists(), name)

    def test_same_seed_same_bytes(self):
        cli("phantom", "--cases", 1, "--seed", 5, "--output", self.folder / "again", "--quiet")
        for path in sorted(self.patient.rglob("*")):
            if path.is_file():
                twin = self.folder / "again/patient-001" / path.relative_to(self.patient)
                self.assertEqual(path.read_bytes(), twin.read_bytes(), path.name)

    def test_an_odd_shape_is_named_and_the_usual_is_what_none_gives(self):
        cli("phantom", "--cases", 1, "--seed", 5, "--shape", "riedel", "--output", self.folder / "riedel", "--quiet")
        truth = json.loads((self.folder / "riedel/patient-001/truth.json").read_text())
        self.assertEqual(truth["shape"], "riedel")
        self.assertEqual(truth["seed"], self.truth["seed"])
        self.assertGreater(truth["volume_mL"], self.truth["volume_mL"])
        self.assertNotIn("shape", self.truth)
        refused = cli("phantom", "--shape", "round", "--output", self.folder / "round", code=2)
        self.assertIn("riedel", refused.stderr)

    def test_no_word_of_the_patient_comes_out(self):
        try:
            subprocess.run([sys.executable, "-c", "import pydicom"], check=True, capture_output=True)
            python = sys.executable
        except subprocess.CalledProcessError:
            python = "/usr/bin/python3"
        canary = self.folder / "canary"
        script = (
            "import pathlib, pydicom, shutil, sys\n"
            "src, dst = map(pathlib.Path, sys.argv[1:])\n"
            "shutil.copytree(src, dst)\n"
            "for p in dst.rglob('*.dcm'):\n"
            "    d = pydicom.dcmread(p)\n"
            "    d.PatientName = 'PHI^CANARY'; d.PatientID = 'PHI_CANARY_ID'; d.PatientBirthDate = '19010203'\n"
            "    d.InstitutionName = 'CANARY HOSPITAL'; d.ReferringPhysicianName = 'CANARY^DOCTOR'\n"
            "    d.save_as(p)\n")
        done = subprocess.run([python, "-c", script, str(self.patient), str(canary)], capture_output=True, text=True)
        if done.returncode != 0:
            self.skipTest("pydicom is not installed: " + done.stderr.strip()[-80:])
        scene = json.loads((canary / "scene.json").read_text())
        scene["geometry"]["cell_mm"] = 8
        (canary / "scene.json").write_text(json.dumps(scene))
        out = self.folder / "canary-run"
        said = []
        for arguments in (("scan", canary), ("scan", canary, "--json"), ("run", canary / "scene.json", "--output", out),
                          ("measure", "--mre", canary / "mre", "--roi", canary / "rtstruct.dcm")):
            process = cli(*arguments)
            said.append(process.stdout + process.stderr)
        for text in said:
            # The folder is called canary by this test; the patient's own words are in capitals.
            self.assertNotIn("CANARY", text)
            self.assertNotIn("19010203", text)
        for path in out.rglob("*"):
            if path.is_file():
                self.assertNotIn(b"CANARY", path.read_bytes(), path.name)


if __name__ == "__main__":
    unittest.main()
