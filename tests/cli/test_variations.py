# SPDX-License-Identifier: GPL-3.0-or-later
"""Situations beside those that were reported: other words, units, headers and outlines. Each is right, refused, or its
doubt is told."""
import struct
import time
import unittest
import zipfile

import pydicom
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence

import small_mre as small
from small_mre import N, PER_SLICE, STEP, box, everywhere, liver, save, scale, sides, slice_of, structures, write
from support import cli, cli_json, folder_of_test, write_scene
from test_belonging import Folder

KPA = ("0.001", "0", "kPa")


class Values(Folder):
    def maps(self, description, values=sides(2000, 4000), maker="ACME", folder="mre", number=5, confidence=True, **more):
        write(self.folder / folder, number, values, description, maker=maker, sequence=None, **more)
        if confidence:
            write(self.folder / folder, number + 1, everywhere(999), "MRE confidence", maker=maker, sequence=None)

    def test_what_is_no_stiffness_is_not_measured(self):
        for n, words in enumerate(("MRE shear loss", "MRE imaginary shear modulus", "MRE Imag Shear Modulus",
                                   "MRE stiffness std dev", "MRE stiffness_SD", "MRE stiffness error map",
                                   "MRE stiffness difference pre post", "MRE shear compliance 1/kPa")):
            for maker in ("ACME", "SIEMENS", "Philips Medical Systems"):
                self.maps(words, maker=maker, folder=f"{n}{maker}", rescale=KPA)
                self.assertTrue(self.refused(f"{n}{maker}"), words)

    def test_a_stiffness_is_taken_and_not_its_spread(self):
        self.maps("MRE stiffness SD", sides(200, 400), number=4, confidence=False, rescale=KPA)
        self.maps("MRE stiffness", rescale=KPA)
        self.assertMean(self.measure(), 3.0)

    def test_youngs_modulus_is_known_by_words_beside_the_description(self):
        label = scale(0.001, "kPa")
        label.LUTExplanation = "Young's modulus"
        ways = {"label": {"RealWorldValueMappingSequence": Sequence([label])},
                "type": {"rescale": KPA, "image_type": ("DERIVED", "PRIMARY", "YOUNGS_MODULUS")},
                "derivation": {"rescale": KPA, "DerivationDescription": "Young's modulus by direct inversion"}}
        for name, more in ways.items():
            self.maps("MRE elastogram", sides(6000, 12000), folder=name, **more)
            answer = self.measure(name)
            self.assertAlmostEqual(answer["shear_mean_kPa"], 3.0, places=4, msg=name)
            self.assertIn("quantity-by-words", self.codes(answer, "warning"), name)

    def test_a_range_of_display_is_no_unit(self):
        write(self.folder / "ge", 401, sides(2000, 4000), "Stiffness 0-8 kPa")
        write(self.folder / "ge", 407, everywhere(999), "Confidence")
        self.assertMean(self.measure("ge"), 3.0)  # GE's own unit
        self.maps("MRE_Stiffness_0-8kPa", maker="SIEMENS")
        self.assertIn("in which unit", self.refused())

    def test_a_table_that_is_not_read_is_no_scale(self):
        self.maps("MRE stiffness (kPa)", sides(1, 2))
        for file in (self.folder / "mre").glob("5-*"):
            d = pydicom.dcmread(file)
            table = Dataset()
            table.add_new(0x00283002, "US", [3, 0, 16])
            table.add_new(0x00283006, "US", [0, 20, 40])
            table.ModalityLUTType = "US"
            d.ModalityLUTSequence = Sequence([table])
            d.save_as(file)
        self.assertIn("look-up table", self.refused())
        self.assertIn("look-up table", self.refused("mre", "--unit", "kPa"))

    def test_a_unit_of_two_names_is_no_unit(self):
        item = scale(0.001, "kPa")
        item.MeasurementUnitsCodeSequence[0].CodeMeaning = "Pa"
        self.maps("MRE stiffness", RealWorldValueMappingSequence=Sequence([item]))
        self.assertIn("one unit by its code and another one in words", self.refused())

    def test_padding_that_only_some_slices_name_is_told(self):
        values = [[9000] * 2 + list(row[2:]) for row in sides(2000, 4000)]
        self.maps("MRE stiffness", values, PixelPaddingValue=9000, rescale=KPA)
        self.assertNotIn("padding-in-part", self.codes(self.measure()))
        file = self.folder / "mre" / "5-1.dcm"
        d = pydicom.dcmread(file)
        del d.PixelPaddingValue
        d.save_as(file)
        self.assertIn("padding-in-part", self.codes(self.measure(), "warning"))


class Whole(Folder):
    def test_slices_that_only_the_partners_have_are_told(self):
        write(self.folder / "mre", 401, sides(2000, 4000), "Stiffness")
        write(self.folder / "mre", 407, everywhere(999), "Confidence", slices=4)
        self.assertIn("partner-has-more-slices", self.codes(self.measure(), "warning"))
        write(self.folder / "even", 401, sides(2000, 4000), "Stiffness")
        write(self.folder / "even", 407, everywhere(999), "Confidence")
        self.assertNotIn("partner-has-more-slices", self.codes(self.measure("even")))
        write(self.folder / "even", 400, everywhere(500), "MRE", slices=5)
        found = cli_json("scan", self.folder / "even")
        self.assertIn("partner-has-more-slices", self.codes(found, "warning"))

    def test_nothing_found_is_an_error(self):
        (self.folder / "empty").mkdir()
        why = cli("scan", self.folder / "empty", "--quiet", code=3).stderr
        self.assertIn("no image series", why)
        (self.folder / "empty" / "notes.txt").write_text("no image")
        answer = cli_json("scan", self.folder / "empty", code=3)
        self.assertIn("no-image-series", self.codes(answer, "error"))
        self.assertEqual(len(answer["skipped"]), 1)

    def test_empty_entries_of_an_archive_cost_nothing(self):
        images = write(self.folder / "mre", 401, sides(2000, 4000), "Stiffness")
        archive = self.folder / "a.zip"
        with zipfile.ZipFile(archive, "w") as z:
            for k in range(len(images)):
                z.write(self.folder / "mre" / f"401-{k}.dcm", f"{k}.dcm")
            for n in range(20000):
                z.writestr(f"e/{n}", b"")
        begin = time.monotonic()
        found = cli_json("scan", archive)
        self.assertEqual(found["series"][0]["slices"], 3)
        self.assertEqual([s["reason"] for s in found["skipped"]], ["holds 20000 empty files, which were left out"])
        self.assertLess(time.monotonic() - begin, 20.0)

    def test_parts_of_the_signal_are_no_anatomy(self):
        for n, kind in ((2, "real"), (3, "imaginary")):
            write(self.folder / "ge", n, everywhere(100), "Ax T1", add=[(0x00430010, "LO", "GEMS_PARM_01"),
                                                                       (0x0043102F, "SS", n)], sequence=None)
        write(self.folder / "ge", 4, everywhere(100), "Ax T1", add=[(0x00430010, "LO", "GEMS_PARM_01"),
                                                                   (0x0043102F, "SS", 0)], sequence=None)
        write(self.folder / "ge", 5, everywhere(100), "T2", maker="Philips", sequence=None,
              image_type=("ORIGINAL", "PRIMARY", "R_FFE", "R", "FFE"))
        roles = {s["number"]: s["role"] for s in cli_json("scan", self.folder / "ge")["series"]}
        self.assertEqual(roles, {2: "other", 3: "other", 4: "anatomical", 5: "other"})


class Outlines(Folder):
    def setUp(self):
        super().setUp()
        write(self.folder / "mre", 401, sides(2000, 4000), "Stiffness")
        write(self.folder / "mre", 407, everywhere(999), "Confidence")

    def drawn(self, middle, name="Liver"):
        rings = [box(0), middle, box(2 * STEP)]
        return structures(self.folder / "drawn.dcm", [(1, name, "frame", [(r, None) for r in rings])])

    def test_an_outline_that_goes_round_twice_counts_once(self):
        ring = box(STEP)
        for twice in (ring + ring, ring + ring[:1] + ring, ring + [(0.999 * x, 0.999 * y, z) for x, y, z in ring]):
            answer = self.measure(roi=self.drawn(twice))
            self.assertMean(answer, 3.0)
            self.assertIn("outlines-cross-themselves", self.codes(answer, "warning"))

    def test_outlines_that_cross_themselves_are_told_and_keyholes_are_not(self):
        a, b, c, d = box(STEP)
        z = STEP
        loop = [a, b, c, d, a, (0, -12, z), (0, -4, z), (-16, -4, z)]
        for ring in ([a, c, b, d], loop):
            self.assertIn("outlines-cross-themselves", self.codes(self.measure(roi=self.drawn(ring)), "warning"))
        hole = [(-4, -4, z), (-4, 4, z), (4, 4, z), (4, -4, z)]
        keyhole = [a, hole[0], *hole[1:], hole[0], a, b, c, d]
        answer = self.measure(roi=self.drawn(keyhole))
        self.assertMean(answer, 3.0, 3 * PER_SLICE - 4)
        self.assertNotIn("outlines-cross-themselves", self.codes(answer))

    def test_an_offset_that_is_not_applied_is_told(self):
        file = self.drawn(box(STEP))
        d = pydicom.dcmread(file)
        for contour in d.ROIContourSequence[0].ContourSequence:
            contour.ContourOffsetVector = [0, 0, 8]
        d.save_as(file)
        answer = self.measure(roi=file)
        self.assertTrue(any("ContourOffsetVector" in w for w in answer["warnings"]))

    def test_a_structure_that_is_more_than_the_liver_is_told(self):
        part = [([(-4, -4, STEP), (4, -4, STEP), (4, 4, STEP), (-4, 4, STEP)], None)]
        whole = [(box(STEP * k), None) for k in range(3)]
        for names, told in ((("Body", "GTV liver met"), True), (("Kidney", "Body minus liver"), True),
                            (("Body", "Liver ROI 1"), False), (("Body", "liver_left-lobe"), False)):
            file = structures(self.folder / "set.dcm", [(1, names[0], "frame", whole), (2, names[1], "frame", part)])
            self.assertEqual("structure-by-name" in self.codes(self.measure(roi=file), "warning"), told, names)
            self.assertNotIn("structure-by-name", self.codes(self.measure("mre", "--name", names[1], roi=file)))
        for name, told in (("Spleen", True), ("ROI-1", False), ("Leber", False)):
            file = self.drawn(box(STEP), name)
            self.assertEqual("structure-by-name" in self.codes(self.measure(roi=file), "warning"), told, name)

    def test_segments_by_name_too(self):
        images = [pydicom.dcmread(self.folder / "mre" / f"401-{k}.dcm") for k in range(3)]
        file = small.segmentation(self.folder / "seg.dcm", [0, 1, 2], images, [0, 1, 2])
        self.assertNotIn("structure-by-name", self.codes(self.measure(roi=file)))
        d = pydicom.dcmread(file)
        d.SegmentSequence[0].SegmentLabel = "Liver vessels"
        d.SegmentSequence[0].SegmentedPropertyTypeCodeSequence[0].CodeValue = "59820001"
        d.save_as(file)
        self.assertIn("structure-by-name", self.codes(self.measure(roi=file), "warning"))

    def mha(self, name, *lines, spacing="4 4 8", offset="-30 -30 0"):
        voxels = bytes(1 if 4 <= i < 12 and 5 <= j < 11 else 0 for _ in range(3) for j in range(N) for i in range(N))
        head = ["ObjectType = Image", "NDims = 3", "BinaryData = True", f"Offset = {offset}",
                *([f"ElementSpacing = {spacing}"] if spacing else []), *lines, f"DimSize = {N} {N} 3",
                "ElementType = MET_UCHAR", "ElementDataFile = LOCAL", ""]
        path = self.folder / name
        path.write_bytes("\n".join(head).encode() + voxels)
        return path

    def test_headers_of_metaimage(self):
        self.assertMean(self.measure(roi=self.mha("plain.mha", "AnatomicalOrientation = RAI")), 3.0)
        self.assertMean(self.measure(roi=self.mha("cm.mha", "DistanceUnits = cm", spacing="0.4 0.4 0.8",
                                                  offset="-3 -3 0")), 3.0)
        odd = self.measure(roi=self.mha("odd.mha", "AnatomicalOrientation = LPI"))
        self.assertIn("axes-contradicted", self.codes(odd, "warning"))
        self.assertIn("unit of length", self.refused(roi=self.mha("ell.mha", "DistanceUnits = ell")))
        self.assertIn("ElementToIntensity", self.refused(roi=self.mha("s.mha", "ElementToIntensityFunctionSlope = 0.5")))
        without = self.mha("without.mha", spacing=None, offset="-5 -5 0")
        self.assertIn("volume-place-unknown", self.codes(self.measure(roi=without), "warning"))

    def test_lengths_in_another_unit_are_told(self):
        small_voxels = self.mha("m.mha", spacing="0.004 0.004 0.008", offset="1 1 8")
        told = cli_json("convert", small_voxels, self.folder / "out.nii")["diagnostics"]
        self.assertIn("voxel-size-odd", {d["code"] for d in told})

    def test_a_name_that_is_not_used_is_told(self):
        answer = self.measure("mre", "--name", "Spleen", roi=self.mha("plain.mha"))
        self.assertIn("name-not-used", self.codes(answer, "warning"))


class Scenes(unittest.TestCase):
    def test_values_that_no_tissue_has_are_told(self):
        where = folder_of_test(self)

        def told(geometry, **material):
            scene = {"geometry": geometry, "material": {"youngs_kPa": 12, "poisson": 0.45, **material},
                     "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
                     "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}]}
            plan = cli_json("plan", write_scene(where, scene))
            return [d["arguments"]["what"] for d in plan["diagnostics"] if d["code"] == "value-implausible"]

        cube = {"kind": "box", "size_mm": [20, 10, 10], "cell_mm": 5}
        self.assertEqual(told(cube), [])
        self.assertEqual(told(cube, density_kg_m3=7800, youngs_kPa=2e8, poisson=0.3), [])
        self.assertEqual(told(cube, density_kg_m3=3), ["the density"])
        from support import write_nifti
        write_nifti(where / "body.nii", [1] * 1000, (10, 10, 10), (4, 4, 4), kind="B")
        organ = {"kind": "mask", "file": "body.nii"}
        self.assertEqual(told(organ), [])
        self.assertEqual(told(organ, density_kg_m3=1.06), ["the density"])
        self.assertEqual(told(organ, youngs_kPa=12000, poisson=0.1), ["the stiffness", "Poisson's ratio"])
        scene = {"geometry": organ, "material": {"youngs_kPa": 12},
                 "supports": [{"region": {"surface": "posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.2}],
                 "loads": [{"kind": "retractor", "diameter_mm": 100, "length_mm": 2, "at": [20, 20, 20], "force": 400}]}
        plan = cli_json("plan", write_scene(where, scene))
        self.assertEqual([d["arguments"]["what"] for d in plan["diagnostics"] if d["code"] == "value-implausible"],
                         ["the bar's diameter", "the bar's length", "the bar's force"])


if __name__ == "__main__":
    unittest.main()
