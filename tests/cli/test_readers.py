# SPDX-License-Identifier: GPL-3.0-or-later
"""Inversion of raw phase, agreement of readers, a proposed outline, and what measure leaves out."""
import math
import pathlib
import random
import unittest

from support import cli, cli_json, folder_of_test, read_nifti, write_nifti

SIZE, SPACING = (48, 44, 2), (1.64, 1.64, 10.0)


def volume(value):
    """value(i, j, k) for every voxel, i fastest."""
    return [value(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])]


def box(low, high):
    return volume(lambda i, j, k: 1 if low[0] <= i < high[0] and low[1] <= j < high[1] else 0)


class Readers(unittest.TestCase):
    def setUp(self):
        self.at = folder_of_test(self)

    def phases(self, shear_kPa, frequency):
        wavelength = 1e3 * math.sqrt(shear_kPa) / frequency  # mm, at 1000 kg/m3
        files = []
        for t in range(4):
            def phase(i, j, k, t=t):
                along = 1.64 * (0.8 * i + 0.6 * j)
                value = 0.9 * k + math.cos(2 * math.pi * (t / 4 - along / wavelength))
                return math.remainder(value, 2 * math.pi)
            files.append(self.at / f"phase{t}.nii")
            write_nifti(files[-1], volume(phase), SIZE, SPACING)
        return files

    def test_invert_gives_the_modulus_of_a_plane_wave(self):
        out = self.at / "out"
        j = cli_json("invert", "--phase", *self.phases(2.1, 60), "--frequency", 60, "--filter", "none", "--output", out)
        self.assertEqual(j["quantity"], "shear")
        self.assertEqual(j["offsets"], 4)
        self.assertAlmostEqual(j["stiffness"]["mean_kPa"], 2.1, delta=0.03)
        self.assertAlmostEqual(j["loss"]["mean_kPa"], 0.0, delta=0.03)
        self.assertTrue(any("slice by slice" in w for w in j["warnings"]))
        names = {pathlib.Path(f).name for f in j["files"]}
        self.assertLessEqual({"stiffness.nii.gz", "confidence.nii.gz", "wave_1_real.nii.gz", "invert.json"}, names)
        size, _, _ = read_nifti(out / "stiffness.nii.gz")
        self.assertEqual(size, SIZE)
        write_nifti(self.at / "roi.nii", box((14, 14), (34, 30)), SIZE, SPACING, kind="B")
        m = cli_json("measure", "--mre", out / "stiffness.nii.gz", "--quantity", "shear", "--unit", "kPa",
                     "--roi", self.at / "roi.nii")
        self.assertAlmostEqual(m["pooled"]["mean_kPa"], 2.1, delta=0.03)

    def test_invert_says_where_few_voxels_are_confident_and_blames_no_order_of_time(self):
        good = cli_json("invert", "--phase", *self.phases(2.1, 60), "--frequency", 60, "--filter", "none")
        self.assertFalse(any("loss modulus" in w or "reach a confidence" in w for w in good["warnings"]))
        chance, files = random.Random(1), self.phases(2.1, 60)
        for file in files:
            _, _, values = read_nifti(file)
            write_nifti(file, [math.remainder(v + chance.gauss(0, 0.45), 2 * math.pi) for v in values], SIZE, SPACING)
        noisy = cli_json("invert", "--phase", *files, "--frequency", 60, "--filter", "none", "--confidence", 0.999)
        self.assertTrue(any("reach a confidence of" in w and "phase noise" in w for w in noisy["warnings"]), noisy["warnings"])

    def test_confidence_on_a_bare_map_is_said_to_be_unused(self):
        write_nifti(self.at / "map.nii", volume(lambda i, j, k: 2.5), SIZE, SPACING)
        write_nifti(self.at / "roi.nii", box((14, 14), (34, 30)), SIZE, SPACING, kind="B")
        bare = ("measure", "--mre", self.at / "map.nii", "--quantity", "shear", "--unit", "kPa", "--roi", self.at / "roi.nii")
        self.assertFalse(any("--confidence" in w for w in cli_json(*bare)["warnings"]))
        self.assertTrue(any("--confidence was not used" in w for w in cli_json(*bare, "--confidence", 0.9)["warnings"]))

    def test_invert_needs_a_frequency_and_whole_directions(self):
        files = self.phases(2.1, 60)
        cli("invert", "--phase", *files, code=3)
        cli("invert", "--phase", *files, "--frequency", 60, "--directions", 3, code=3)
        cli("invert", "--phase", *files, "--frequency", 60, "--filter", "curl", code=3)
        cli("invert", "--phase", self.at / "nowhere.nii", "--frequency", 60, code=3)

    def test_agree_on_one_case_and_over_cases(self):
        for reader in ("a", "b"):
            (self.at / reader).mkdir()
        for n in range(4):
            write_nifti(self.at / f"a/case{n}.nii", box((5, 5), (25 + n, 25)), SIZE, SPACING, kind="B")
            write_nifti(self.at / f"b/case{n}.nii", box((6, 5), (26 + 2 * n, 25)), SIZE, SPACING, kind="B")
        write_nifti(self.at / "a/extra.nii", box((5, 5), (9, 9)), SIZE, SPACING, kind="B")
        one = cli_json("agree", self.at / "a/case0.nii", self.at / "b/case0.nii")["cases"][0]["with_first"][0]
        self.assertAlmostEqual(one["dice"], 19 / 20, places=9)
        self.assertAlmostEqual(one["hausdorff_mm"], 1.64, places=4)
        # Both slices are alike: nothing changes where others are drawn.
        self.assertEqual(one["by_slices"]["slices"], 2)
        self.assertAlmostEqual(one["by_slices"]["dice"]["value"], one["dice"], places=9)
        self.assertAlmostEqual(one["by_slices"]["dice"]["se"], 0, places=9)
        write_nifti(self.at / "map.nii", volume(lambda i, j, k: 2000 + 10 * i), SIZE, SPACING)
        many = cli_json("agree", self.at / "a", self.at / "b", "--output", self.at / "out")
        self.assertEqual(len(many["cases"]), 4)
        self.assertTrue(any("extra" in w for w in many["warnings"]))
        icc = many["volume"]["icc_2_1"]
        self.assertLess(icc["low"], icc["value"])
        self.assertLess(icc["value"], icc["high"])
        # reader b adds n columns of 20 x 2 voxels to case n
        voxel = 1.64 * 1.64 * 10 * 1e-3
        self.assertAlmostEqual(many["volume"]["bland_altman"]["bias"], 1.5 * 40 * voxel, places=4)
        self.assertTrue((self.at / "out/readers.csv").read_text().startswith("case,reader,quantity,value,unit\n"))
        self.assertTrue((self.at / "out/bland-altman-volume.svg").exists())
        case = cli_json("agree", self.at / "a/case0.nii", self.at / "b/case0.nii", "--mre", self.at / "map.nii",
                        "--quantity", "shear", "--unit", "Pa")["cases"][0]
        mean = case["mean_stiffness_kPa"]
        self.assertAlmostEqual(mean[1] - mean[0], 0.01, places=5)
        difference = case["with_first"][0]["by_slices"]["stiffness_difference_kPa"]
        self.assertAlmostEqual(difference["value"], 0.01, places=5)
        self.assertAlmostEqual(difference["se"], 0, places=6)
        self.assertEqual(len(case["mean_stiffness_uncertainty"]), 2)
        low, high = case["mean_stiffness_uncertainty"][0]["ci95"]
        self.assertTrue(low < mean[0] < high)
        cli("agree", self.at / "a", self.at / "b/case0.nii", code=3)
        cli("agree", self.at / "a", code=2)

    def test_propose_writes_outlines_and_masks(self):
        write_nifti(self.at / "image.nii", volume(lambda i, j, k: 300 if (i - 22) ** 2 + (j - 20) ** 2 < 225 else 50),
                    SIZE, SPACING)
        j = cli_json("propose", "--image", self.at / "image.nii", "--seed", "22,20,1", "--index", "--neck", 3, "--least", 5,
                     "--output", self.at / "roi.json")
        area = math.pi * 225 * 1.64 * 1.64 * 20 * 1e-3
        self.assertAlmostEqual(j["volume_mL"], area, delta=0.05 * area)
        self.assertTrue(j["touches_border"])
        cli_json("propose", "--image", self.at / "image.nii", "--seed", "22,20,1", "--index", "--neck", 3, "--least", 5,
                 "--output", self.at / "mask.nii.gz")
        same = cli_json("agree", self.at / "mask.nii.gz", self.at / "roi.json")["cases"][0]["with_first"][0]
        self.assertGreater(same["dice"], 0.97)
        cli("propose", "--image", self.at / "image.nii", "--seed", "900,0,0", "--output", self.at / "x.json", code=3)

    def test_measure_leaves_out_border_and_vessels(self):
        write_nifti(self.at / "map.nii", volume(lambda i, j, k: 200 + (i + 3 * j) % 5), SIZE, SPACING)
        write_nifti(self.at / "roi.nii", box((5, 5), (35, 35)), SIZE, SPACING, kind="B")
        write_nifti(self.at / "vessel.nii", box((15, 15), (18, 18)), SIZE, SPACING, kind="B")
        base = ["measure", "--mre", self.at / "map.nii", "--quantity", "shear", "--unit", "0.01kPa", "--roi",
                self.at / "roi.nii"]
        whole, inner = cli_json(*base), cli_json(*base, "--erode-px", 3)
        self.assertEqual(whole["pooled"]["n"], 2 * 900)
        self.assertEqual(inner["pooled"]["n"], 2 * 24 * 24)
        self.assertAlmostEqual(whole["pooled"]["mean_kPa"], 2.02, delta=0.01)
        self.assertLess(whole["mean_ci95_kPa"][0], whole["pooled"]["mean_kPa"])
        sure = whole["mean_uncertainty"]
        self.assertLess(sure["ci95_kPa"][0], whole["pooled"]["mean_kPa"])
        self.assertEqual(sure["by_slices"]["slices"], 2)
        self.assertAlmostEqual(sure["by_slices"]["se_kPa"], 0, places=6)
        self.assertAlmostEqual(sure["se_kPa"], sure["by_correlation"]["se_kPa"], places=12)
        self.assertTrue(1 <= sure["by_correlation"]["effective_voxels"] <= whole["pooled"]["n"])
        self.assertEqual(cli_json(*base, "--exclude", self.at / "vessel.nii")["pooled"]["n"], 2 * (900 - 9))
        self.assertEqual(cli_json(*base, "--erode-mm", 3.3)["pooled"]["n"], 2 * 26 * 26)
        cli(*base, "--erode-mm", 60, code=3)
        cli(*base, "--register", code=3)


if __name__ == "__main__":
    unittest.main()
