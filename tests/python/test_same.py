# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module computes is what the command line computes, to the last bit."""
import hashlib
import json
import math
import pathlib
import unittest

import numpy as np

import glisson
from scenes import beam, coarse
from support import ROOT, cli, cli_json, folder_of_class, write_nifti
from test_readers import SIZE, SPACING, volume


def or_null(value):
    return value if math.isfinite(value) else None


def digests(folder, but=()):
    folder = pathlib.Path(folder)
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.rglob("*"))
            if p.is_file() and p.name not in but}


class Same(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.at = folder_of_class(cls)
        cls.patient = glisson.phantom(cls.at / "patients", seed=3)[0]
        cls.scene = coarse(cls.patient)

    def same_statistics(self, mine, told):
        for key in ("n", "n_before_mask", "area_mm2", "mean_kPa", "median_kPa", "sd_kPa", "min_kPa", "max_kPa"):
            if key in told:
                self.assertEqual(or_null(getattr(mine, key)), told[key], key)

    def test_phantom_writes_the_same_bytes(self):
        cli("phantom", "--seed", 3, "--output", self.at / "again", "--quiet")
        mine, told = digests(self.patient, but=("scene.json",)), digests(self.at / "again/patient-001", but=("scene.json",))
        self.assertEqual(mine, told)
        self.assertGreater(len(mine), 50)

    def test_scan(self):
        told = cli_json("scan", self.patient)
        mine = glisson.scan(self.patient)
        self.assertEqual([s.uid for s in mine.series], [s["uid"] for s in told["series"]])
        for one, other in zip(mine.series, told["series"]):
            self.assertEqual((one.role, one.role_reason, one.number, one.error),
                             (other["role"], other["role_reason"], other["number"], other.get("error")))
            # Of a series that is no volume the command line says so among the warnings.
            self.assertEqual(one.warnings, other["warnings"][:-1] if one.error else other["warnings"])
            self.assertEqual(list(one.grid.origin_lps_mm), other["origin_lps_mm"])
            self.assertEqual(list(one.grid.direction.T.ravel()), other["direction"])
        self.assertEqual([a.stiffness and a.stiffness.uid for a in mine.acquisitions],
                         [a["products"]["stiffness"] for a in told["acquisitions"]])

    def test_measure(self):
        for words, options in (((), {}), (("--mri", self.patient / "mri", "--erode-mm", 5, "--confidence", 0.9, "--poisson", 0.45),
                                          {"mri": self.patient / "mri", "erode_mm": 5, "confidence": 0.9, "poisson": 0.45})):
            told = cli_json("measure", "--mre", self.patient / "mre", "--roi", self.patient / "rtstruct.dcm", *words)
            found = glisson.measure(self.patient / "mre", self.patient / "rtstruct.dcm", **options)
            mine = found.measurement
            self.same_statistics(mine.pooled, told["pooled"])
            self.assertEqual([s.slice for s in mine.slices], [s["slice"] for s in told["slices"]])
            for one, other in zip(mine.slices, told["slices"]):
                self.same_statistics(one.statistics, other)
            self.assertEqual((mine.quantity, mine.youngs_mean_kPa, mine.shear_mean_kPa, mine.area_weighted_mean_kPa, mine.poisson),
                             (told["quantity"], told["youngs_mean_kPa"], told["shear_mean_kPa"], told["area_weighted_mean_kPa"],
                              told["poisson"]))
            self.assertEqual([mine.mean_se_kPa, *mine.mean_ci95_kPa],
                             [told["mean_uncertainty"]["se_kPa"], *told["mean_uncertainty"]["ci95_kPa"]])
            self.assertEqual((found.coverage, found.warnings), (told["roi_coverage"], told["warnings"]))
            self.assertEqual(mine.low_confidence, told["left_out"]["low_confidence"])
            self.assertEqual([d.code for d in found.diagnostics],
                             [d["code"] for d in told["diagnostics"] if d["code"] != "remark"])

    def test_invert(self):
        files = []
        wavelength = 1e3 * math.sqrt(2.1) / 60
        for t in range(4):
            def phase(i, j, k, t=t):
                along = 1.64 * (0.8 * i + 0.6 * j)
                return math.remainder(0.9 * k + math.cos(2 * math.pi * (t / 4 - along / wavelength)), 2 * math.pi)
            files.append(self.at / f"phase{t}.nii")
            write_nifti(files[-1], volume(phase), SIZE, SPACING)
        told = cli_json("invert", "--phase", *files, "--frequency", 60, "--filter", "none", "--output", self.at / "inverted")
        mine = glisson.invert(files, frequency_Hz=60, filter=glisson.BulkFilter.NONE)
        for one, key in ((mine.stiffness, "stiffness"), (mine.storage, "storage"), (mine.loss, "loss"),
                         (mine.shear_stiffness, "shear_stiffness")):
            self.same_statistics(one, told[key])
        self.assertEqual((mine.resolved, mine.frequency_Hz, mine.phase_scale, mine.warnings),
                         (told["voxels_resolved"], told["frequency_Hz"], told["phase_scale"], told["warnings"]))
        self.assertEqual(mine.noise_rad, [d["noise_rad"] for d in told["directions"]])
        self.assertEqual(len(mine.waves), 1)
        self.assertEqual(mine.waves[0].values.dtype, np.complex64)
        mine.write(self.at / "inverted-here")
        self.assertEqual(digests(self.at / "inverted-here"), digests(self.at / "inverted", but=("invert.json",)))
        self.assertAlmostEqual(float(np.nanmean(mine.magnitude_kPa.values)), 2.1, delta=0.05)

    def test_propose(self):
        write_nifti(self.at / "image.nii", volume(lambda i, j, k: 300 if (i - 22) ** 2 + (j - 20) ** 2 < 225 else 50), SIZE, SPACING)
        told = cli_json("propose", "--image", self.at / "image.nii", "--seed", "22,20,1", "--index", "--neck", 3, "--least", 5,
                        "--output", self.at / "roi.json")
        mine = glisson.propose(self.at / "image.nii", [22, 20, 1], index=True, neck_mm=3, least_mL=5)
        mine.write(self.at / "roi-here.json")
        self.assertEqual((self.at / "roi-here.json").read_bytes(), (self.at / "roi.json").read_bytes())
        self.assertEqual((mine.volume_mL, list(mine.intensities), mine.touches_border, mine.warnings),
                         (told["volume_mL"], told["intensities"], told["touches_border"], told["warnings"]))
        self.assertEqual(len(mine.contours["polygons"]), told["polygons"])
        self.assertAlmostEqual(np.count_nonzero(mine.mask.values) * np.prod(mine.mask.grid.spacing_mm) / 1e3, mine.volume_mL, places=6)

    def test_plan(self):
        told = cli_json("plan", self.scene)["plan"]
        self.assertEqual([(s.step, s.needed, s.why) for s in glisson.plan(self.scene)],
                         [(s["step"], s["needed"], s["why"]) for s in told])

    def test_run_of_a_patient_to_the_last_bit(self):
        told = cli_json("run", self.scene, "--output", self.at / "told")
        mine = glisson.run(self.scene, self.at / "mine")
        nothing_written = glisson.run(glisson.read_scene(self.scene))
        self.assertEqual(mine.results_sha256, told["results_sha256"])
        self.assertEqual(nothing_written.results_sha256, told["results_sha256"])
        self.assertEqual(nothing_written.files, [])
        but = ("run.json", "report.html", "report.pdf")
        self.assertEqual(digests(self.at / "mine", but), digests(self.at / "told", but))
        self.assertEqual({p.name for p in mine.files}, {p.name for p in (self.at / "told").iterdir()})
        self.assertEqual(mine.difference.at_retractor_mm, told["difference"]["at_retractor_mm"])
        self.assertEqual(mine.primary.contact.travel_mm, told["contact"]["travel_mm"])
        self.assertEqual(mine.record["results_sha256"], mine.results_sha256)
        self.assertTrue(mine.converged)
        contact = mine.primary.contact
        # The pressures of the samples add up to the force along the hoist, which is what the bar bears.
        self.assertEqual(contact.path.shape[1], 2)
        self.assertEqual(contact.pressure_kPa.shape, contact.sample_mm2.shape)
        self.assertEqual(contact.sample_mm.shape, (len(contact.pressure_kPa), 3))

    def test_runs_of_boxes_to_the_last_bit(self):
        for name in ("beam.json", "block-on-springs.json"):
            file = ROOT / "resources/examples/scenes" / name
            told = cli_json("run", file, "--output", self.at / name)
            self.assertEqual(glisson.run(file).results_sha256, told["results_sha256"])
        other = glisson.run(glisson.Scene(beam(youngs_kPa=13))).results_sha256
        self.assertNotEqual(other, glisson.run(glisson.Scene(beam())).results_sha256, "the digest tells runs apart")

    def test_cohort_writes_the_same_bytes(self):
        cli("phantom", "--cases", 2, "--seed", 11, "--cohort", "paper", "--output", self.at / "cohort-patients", "--quiet")
        for scene in (self.at / "cohort-patients").glob("*/scene.json"):
            words = json.loads(scene.read_text())
            words["geometry"]["cell_mm"] = 8
            scene.write_text(json.dumps(words))
        cli("cohort", self.at / "cohort-patients", "--no-sensitivity", "--output", self.at / "cohort-told")
        mine = glisson.cohort(self.at / "cohort-patients", self.at / "cohort-mine", sensitivity=False)
        self.assertTrue(mine.complete)
        self.assertEqual([c.status for c in mine.cases], ["done", "done"])
        self.assertEqual(digests(self.at / "cohort-mine", but=("timings.csv",)), digests(self.at / "cohort-told", but=("timings.csv",)))
        self.assertEqual(mine.record["retraction"]["left"], 2)


if __name__ == "__main__":
    unittest.main()
