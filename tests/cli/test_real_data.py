# SPDX-License-Identifier: GPL-3.0-or-later
"""Real data written by others: GE MR750 DICOM, odd series, an abdominal MR with its liver mask. Skipped where absent."""
import os
import unittest

from support import DATA, cli, cli_json, folder_of_test, read_nifti, write_nifti, write_scene


@unittest.skipUnless(DATA.exists(), "the folder of real data is not beside this checkout")
class RealData(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)

    def test_ge_series_equals_the_independent_nifti(self):
        ge = DATA / "mr750_and_odd_series/ge/anatomical"
        cli("convert", ge / "001", self.folder / "ours.nii.gz", "--quiet")
        cli("convert", ge / "001_ground_truth.nii.gz", self.folder / "theirs.nii.gz", "--quiet")
        a, b = read_nifti(self.folder / "ours.nii.gz"), read_nifti(ge / "001_ground_truth.nii.gz")
        self.assertEqual(sorted(a[0]), sorted(b[0]))
        self.assertEqual(sorted(a[2]), sorted(b[2]))  # the same voxels; their places are compared in the unit tests
        scan = cli_json("scan", ge / "001")
        self.assertEqual(scan["series"][0]["slices"], 4)
        for key in ("uid", "role", "role_reason", "description", "modality", "slices", "rows", "columns", "spacing_mm",
                    "origin_lps_mm", "direction", "warnings"):
            self.assertIn(key, scan["series"][0])

    def test_odd_series_are_refused_or_warned_about(self):
        odd = DATA / "mr750_and_odd_series/failing"
        for name, word in (("gantrytilting/001", "tilt"), ("notavolume/001", "position"), ("sliceincrement/001", "missing"),
                           ("sliceincrement/002", "tilt"), ("sliceorientation/001", "orientation")):
            self.assertIn(word, cli("convert", odd / name, self.folder / "x.nii", "--quiet", code=3).stderr)
        scan = cli_json("scan", odd / "slicecount/001")
        self.assertTrue(any("2 slices" in w for w in scan["series"][0]["warnings"]))

    def test_liver_mask_of_a_real_mr_runs_to_overlays(self):
        source = DATA / "liver_mr_ct_volumes"
        for name in ("example_seg_mr.nii.gz", "example_mr_sm.nii.gz"):
            os.symlink(source / name, self.folder / name)
        size, spacing, labels = read_nifti(source / "example_seg_mr.nii.gz")
        # A stiffness map made for it, on the grid of the mask: 3 kPa with a stiffer half.
        cli("convert", self.folder / "example_seg_mr.nii.gz", self.folder / "labels.nii", "--quiet")
        raw = bytearray((self.folder / "labels.nii").read_bytes())
        import struct
        n = size[0] * size[1] * size[2]
        offset = int(struct.unpack_from("<f", raw, 108)[0])
        values = [3.0 + (1.5 if i % size[0] < size[0] // 2 else 0.0) for i in range(n)]
        struct.pack_into(f"<{n}f", raw, offset, *values)
        (self.folder / "mu.nii").write_bytes(raw)
        scene = write_scene(self.folder, {
            "geometry": {"kind": "mask", "file": "example_seg_mr.nii.gz", "label": 5, "mri": "example_mr_sm.nii.gz"},
            "material": {"map": "mu.nii", "quantity": "shear", "unit": "kPa"},
            "supports": [{"region": {"surface": s}, "kind": "spring", "stiffness_kPa_per_mm": 0.2} for s in ("posterior", "superior")],
            "loads": [{"kind": "retractor", "force": 4.0}], "compare": {"against": "atlas"}, "outputs": ["overlay", "report"]})
        r = cli_json("run", scene, "--output", self.folder / "out", env={"DISPLAY": ""})
        self.assertEqual(sum(1 for v in labels if round(v) == 5), 18480)
        self.assertAlmostEqual(r["model"]["volume_mL"], 498.96, delta=0.01 * 498.96)
        self.assertTrue(r["solver"]["converged"])
        self.assertGreater(r["difference"]["mean_mm"], 0)
        for name in ("overlay-largest-difference.png", "overlay-3d-oblique.png", "difference-map.png", "report.html", "run.json"):
            self.assertGreater((self.folder / "out" / name).stat().st_size, 1000, name)


if __name__ == "__main__":
    unittest.main()
