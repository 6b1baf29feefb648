# SPDX-License-Identifier: GPL-3.0-or-later
"""From files to numbers: what belongs together, which scale holds, which image was outlined. Every answer is right, or
its doubt is told."""
import unittest

import pydicom
from pydicom.sequence import Sequence

import small_mre as small
from small_mre import PER_SLICE, STEP, code, everywhere, liver, scale, siemens, sides, structures, write
from support import cli, cli_json, folder_of_test


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)
        self.roi = liver(self.folder / "liver.dcm")

    def measure(self, mre="mre", *more, roi=None):
        return cli_json("measure", "--mre", self.folder / mre, "--roi", roi or self.roi, *more)

    def refused(self, mre="mre", *more, roi=None):
        return cli("measure", "--mre", self.folder / mre, "--roi", roi or self.roi, *more, "--quiet", code=3).stderr

    def codes(self, answer, severity=None):
        return {d["code"] for d in answer["diagnostics"] if severity in (None, d["severity"])}

    def assertMean(self, answer, mean, n=3 * PER_SLICE):
        self.assertEqual(answer["pooled"]["n"], n)
        self.assertAlmostEqual(answer["pooled"]["mean_kPa"], mean, places=5)


class Partners(Folder):
    def acquisition(self, base, stiffness, confidence, slices=3, **more):
        write(self.folder / "mre", 100 * base + 1, stiffness, "Stiffness (Pa)", slices, **more)
        write(self.folder / "mre", 100 * base + 7, confidence, "Confidence", slices, **more)

    def test_each_stiffness_has_its_own_confidence(self):
        self.acquisition(7, everywhere(8000), sides(999, 0))
        self.acquisition(8, sides(1800, 3000), everywhere(999))
        first = self.measure("mre", "--role", "701=stiffness")
        self.assertMean(first, 8.0, 3 * PER_SLICE // 2)
        second = self.measure("mre", "--role", "801=stiffness")
        self.assertMean(second, 2.4)
        self.assertEqual(second["sources"]["confidence"], small.uid("series 807"))
        self.assertIn("partner-taken", self.codes(second, "note"))
        by_hand = self.measure("mre", "--role", "801=stiffness", "--role", "707=confidence")
        self.assertMean(by_hand, 1.8, 3 * PER_SLICE // 2)
        self.assertTrue({"partner-doubtful", "partner-contradicted"} & self.codes(by_hand, "warning"))

    def test_a_confidence_of_another_acquisition_is_not_borrowed(self):
        write(self.folder / "mre", 301, everywhere(2500), "Stiffness (Pa)")
        self.acquisition(5, everywhere(2500), sides(999, 0))
        alone = self.measure("mre", "--role", "301=stiffness")
        self.assertMean(alone, 2.5)
        self.assertTrue({"partner-elsewhere", "no-confidence-map"} <= self.codes(alone, "warning"))
        self.assertIsNone(alone["sources"]["confidence"])

    def test_without_series_numbers_what_the_images_say_counts(self):
        def two(folder, **attributes):
            for n, (number, left) in enumerate(((11, 5000), (21, 2000))):
                more = {key: values[n] for key, values in attributes.items()}
                mine = {"series": lambda what: f"{folder} {what} {n}"}
                write(self.folder / folder, number, everywhere(left), "MRE stiffness [Pa]", maker="ACME", sequence=None,
                      series=mine["series"]("s"), **more)
            # Listed the other way round, so that the first is the wrong one.
            for n, (number, right) in enumerate(((31, 0), (30, 999))):
                more = {key: values[n] for key, values in attributes.items()}
                write(self.folder / folder, number, sides(999, right), "MRE confidence map", maker="ACME", sequence=None,
                      series=f"{folder} c {n}", **more)
            for number, n, mean in ((11, PER_SLICE * 3 // 2, 5.0), (21, PER_SLICE * 3, 2.0)):
                self.assertMean(self.measure(folder, "--role", f"{number}=stiffness"), mean, n)
        two("numbers", AcquisitionNumber=[4, 9])
        two("uids", add=[[(0x00080017, "UI", small.uid(uid))] for uid in ("one", "two")])
        two("times", AcquisitionTime=["101500.25", "104010"])
        two("frames", frame=["frame", "other"])
        two("places", shift=[(0, 0, 0), (0, 0, 2)])

    def test_references_count_more_than_times(self):
        images = {}
        for n, number in enumerate((11, 21)):
            images[number] = write(self.folder / "mre", number, everywhere(2000 + 1000 * n), "MRE stiffness [Pa]",
                                   maker="ACME", sequence=None, AcquisitionTime=("100000", "110000")[n])
        for number, source, right, time in ((12, 21, 999, "100000"), (22, 11, 0, "110000")):
            write(self.folder / "mre", number, sides(999, right), "MRE confidence map", maker="ACME", sequence=None,
                  AcquisitionTime=time, SourceImageSequence=Sequence([small.reference(images[source][0])]))
        answer = self.measure("mre", "--role", "21=stiffness")
        self.assertMean(answer, 3.0)
        self.assertIn("partner-contradicted", self.codes(answer, "warning"))

    def test_equal_candidates_are_asked_about(self):
        write(self.folder / "mre", 11, everywhere(2000), "MRE stiffness [Pa]", maker="ACME", sequence=None)
        for number in (12, 13):
            write(self.folder / "mre", number, sides(999, 0), "MRE confidence map", maker="ACME", sequence=None,
                  AcquisitionNumber=1)
        answer = self.measure()
        self.assertMean(answer, 2.0)
        self.assertTrue({"partner-ambiguous", "no-confidence-map"} <= self.codes(answer, "warning"))
        self.assertMean(self.measure("mre", "--role", "13=confidence"), 2.0, 3 * PER_SLICE // 2)

    def test_scan_lists_acquisitions_and_patients(self):
        for base in (7, 8):
            self.acquisition(base, everywhere(2000), everywhere(999))
            write(self.folder / "mre", base, everywhere(300), "MRE", image_type=("ORIGINAL", "PRIMARY", "OTHER"))
            write(self.folder / "mre", 100 * base + 5, everywhere(50), "Wave")
        scan = cli_json("scan", self.folder / "mre")
        self.assertEqual([a["products"] for a in scan["acquisitions"]],
                         [{"magnitude": small.uid(f"series {b}"), "wave": [small.uid(f"series {b}05")],
                           "stiffness": small.uid(f"series {b}01"), "confidence": small.uid(f"series {b}07")}
                          for b in (7, 8)])
        self.assertTrue(all("series numbers" in a["why"] for a in scan["acquisitions"]))
        self.assertEqual(scan["patients"], [{"studies": [{"series": list(range(8))}]}])
        other = small.slice_of(everywhere(1), 0, 3, "T1", sequence=None, series="elsewhere", name="elsewhere")
        other.PatientID, other.StudyInstanceUID = "SOMEBODY-ELSE", small.uid("another study")
        small.save(other, self.folder / "mre", "other.dcm")
        scan = cli_json("scan", self.folder / "mre")
        mine = [n for n, s in enumerate(scan["series"]) if s["uid"] != small.uid("elsewhere")]
        patients = sorted((p["studies"][0]["series"] for p in scan["patients"]), key=len)
        self.assertEqual([len(p) for p in patients], [1, 8])
        self.assertEqual(patients[1], mine)
        self.assertNotIn("SOMEBODY", str(scan))

    def test_the_magnitude_of_the_same_acquisition_is_laid_over_the_mri(self):
        size = 48

        def body(dx):
            return lambda k: [[int(1000 * max(0.0, 1 - ((4 * i - 94 - dx) / 70) ** 2 - ((4 * j - 94) / 50) ** 2) +
                                   400 * max(0.0, 1 - ((4 * i - 124 - dx) ** 2 + (4 * j - 100 - 3 * k) ** 2) / 400))
                               for i in range(size)] for j in range(size)]
        original = {"image_type": ("ORIGINAL", "PRIMARY", "OTHER"), "shift": (-64, -64, 0)}
        write(self.folder / "mri", 3, body(0), "T1 ax", 4, sequence=None, **original)
        for base, dx in ((7, 12.0), (8, 0.0)):
            write(self.folder / "mre", base, body(dx), "MRE", 4, **original)
            flat = [[2000] * size] * size
            write(self.folder / "mre", 100 * base + 1, flat, "Stiffness", 4, shift=(-64, -64, 0))
        for number, shift in ((701, 12.0), (801, 0.0)):
            answer = self.measure("mre", "--mri", self.folder / "mri", "--register", "--role", f"{number}=stiffness")
            self.assertAlmostEqual(answer["registration"]["shift_mm"], shift, delta=1.5)

    def test_voxels_without_a_confidence_are_told_from_those_below_it(self):
        write(self.folder / "short", 401, everywhere(2000), "Stiffness")
        write(self.folder / "short", 407, everywhere(999), "Confidence", 2)
        short = self.measure("short")
        self.assertMean(short, 2.0, 2 * PER_SLICE)
        self.assertEqual(short["left_out"]["no_confidence"], PER_SLICE)
        self.assertEqual(short["left_out"]["low_confidence"], 0)
        self.assertTrue({"confidence-covers-less", "no-confidence-there"} <= self.codes(short, "warning"))
        covers = next(d for d in short["diagnostics"] if d["code"] == "confidence-covers-less")
        self.assertEqual(covers["arguments"]["slices"], "2")
        write(self.folder / "aside", 401, everywhere(2000), "Stiffness")
        write(self.folder / "aside", 407, everywhere(999), "Confidence", shift=(32, 0, 0))
        aside = self.measure("aside")
        self.assertMean(aside, 2.0, 3 * PER_SLICE // 2)
        self.assertIn("confidence-covers-less", self.codes(aside, "warning"))
        write(self.folder / "frame", 401, everywhere(2000), "Stiffness")
        write(self.folder / "frame", 407, everywhere(999), "Confidence", frame="other")
        self.assertTrue(any("frame of reference" in w for w in self.measure("frame")["warnings"]))

    def test_full_confidence_is_never_made_up(self):
        def with_scale(folder, high, low, *more):
            write(self.folder / folder, 401, everywhere(2000), "Stiffness")
            write(self.folder / folder, 407, sides(high, low), "Confidence")
            return (folder, *more)
        half = 3 * PER_SLICE // 2
        self.assertMean(self.measure(*with_scale("ge", 999, 400)), 2.0, half)
        self.assertNotIn("confidence-scale-taken", self.codes(self.measure("ge")))
        bytes_ = self.measure(*with_scale("bytes", 255, 90))
        self.assertMean(bytes_, 2.0, half)
        self.assertIn("confidence-scale-taken", self.codes(bytes_, "warning"))
        self.assertIn("say which stored value means full confidence", self.refused(*with_scale("odd", 500, 90)))
        self.assertMean(self.measure("odd", "--confidence-scale", 500), 2.0, half)


class Values(Folder):
    def test_the_quantity_of_a_map_is_what_its_code_says(self):
        shear = code("shear-modulus", "99GLISSON", "Shear modulus (mu)")
        youngs = code("youngs-modulus", "99GLISSON", "Young's modulus (E)")
        named = code("E-1", "99OTHER", "Young's modulus of elasticity")
        speed = code("c", "99OTHER", "Shear wave speed")
        adc = code("113041", "DCM", "Apparent Diffusion Coefficient")
        for name, value, unit, quantity, mu in (("mu", 2.7, "kPa", shear, 2.7), ("e", 8.1, "kPa", youngs, 2.7),
                                                ("named", 8100.0, "Pa", named, 2.7), ("c", 1.5, "m/s", speed, 2.25),
                                                ("mm", 1500.0, "mm/s", speed, 2.25)):
            with self.subTest(name):
                answer = self.measure(small.parametric_map(self.folder / f"{name}.dcm", value, unit, quantity, "map"))
                self.assertAlmostEqual(answer["shear_mean_kPa"], mu, places=4)
        self.assertIn("speed-turned-into-shear", self.codes(answer, "warning"))
        self.assertEqual(self.measure("e.dcm")["quantity"], "youngs")
        words = small.parametric_map(self.folder / "words.dcm", 8.1, "kPa", None, "stiffness, Young's modulus [kPa]")
        answer = self.measure(words)
        self.assertAlmostEqual(answer["shear_mean_kPa"], 2.7, places=4)
        self.assertIn("quantity-by-words", self.codes(answer, "warning"))
        asked = self.measure("e.dcm", "--quantity", "shear")
        self.assertAlmostEqual(asked["shear_mean_kPa"], 8.1, places=4)
        self.assertIn("quantity-as-asked", self.codes(asked, "warning"))
        other = small.parametric_map(self.folder / "adc.dcm", 1.1, "kPa", adc, "stiffness map")
        self.assertIn("another quantity", self.refused(other))

    def test_the_map_with_a_unit_of_stiffness_is_the_scale(self):
        def mapped(folder, maps, stored=1050, rescale=None, description="MRE_stiffness"):
            siemens(self.folder / folder, 12, stored, description, rescale=rescale,
                    RealWorldValueMappingSequence=Sequence(maps))
            return folder
        flat = everywhere(1050)
        self.assertMean(self.measure(mapped("only", [scale(0.003, "kPa")], flat)), 3.15)
        self.assertMean(self.measure(mapped("identity", [scale(0.003, "kPa")], flat, ("1", "0", "US"))), 3.15)
        both = self.measure(mapped("both", [scale(0.003, "kPa")], flat, ("0.5", "0", "US")))
        self.assertMean(both, 3.15)
        self.assertIn("scales-differ", self.codes(both, "warning"))
        rescaled = self.measure(mapped("rescaled", [scale(0.003, "kPa")], flat, ("0.002", "0", "kPa")))
        self.assertMean(rescaled, 2.1)
        self.assertIn("scales-differ", self.codes(rescaled, "warning"))
        agreed = self.measure(mapped("agreed", [scale(0.003, "kPa")], flat, ("3", "0", "Pa")))
        self.assertMean(agreed, 3.15)
        self.assertNotIn("scales-differ", self.codes(agreed))
        table = [scale(None, "kPa", 1000, 1099, [3.0 + 0.01 * n for n in range(100)])]
        self.assertMean(self.measure(mapped("table", table, flat)), 3.5)
        two = [scale(1.0, "1"), scale(0.003, "kPa")]
        self.assertMean(self.measure(mapped("two", two, flat)), 3.15)
        pieces = [scale(0.003, "kPa", 0, 1999), scale(0.001, "kPa", 2000, 60000)]
        self.assertMean(self.measure(mapped("pieces", pieces, sides(1000, 4000))), 3.5)
        self.assertIn("no measure", self.refused(mapped("torn", [scale(0.003, "kPa"), scale(0.002, "kPa")], flat)))
        quantities = [scale(0.006, "kPa", quantity=code("e", "99OTHER", "Young's modulus")),
                      scale(0.002, "kPa", quantity=code("m", "99OTHER", "Shear modulus"))]
        self.assertMean(self.measure(mapped("quantities", quantities, flat)), 2.1)

    def test_a_map_that_gives_no_scale_is_doubted(self):
        # A table of more than 64 KiB stands as raw bytes in explicit encodings.
        table = scale(None, "kPa", 0, 19999, [0.003 * n for n in range(20000)])
        self.assertGreater(len(bytes(20000 * 8)), 65536)
        write(self.folder / "large", 401, everywhere(1000), "Stiffness",
              RealWorldValueMappingSequence=Sequence([table]))
        self.assertMean(self.measure("large"), 3.0)
        bare = scale(0.003, "kPa")
        del bare.RealWorldValueSlope, bare.RealWorldValueIntercept
        write(self.folder / "bare", 401, everywhere(1000), "Stiffness",
              RealWorldValueMappingSequence=Sequence([bare]))
        self.assertIn("map-without-scale", self.codes(self.measure("bare"), "warning"))

    def test_slices_of_different_quantities_are_no_map(self):
        def mixed(folder, odd, others):
            for k in range(3):
                quantity = odd if k == 1 else others
                d = small.slice_of(everywhere(2000), k, 12, "MRE_stiffness", maker="SIEMENS", sequence=None,
                                   RealWorldValueMappingSequence=Sequence([scale(0.001, "kPa", quantity=quantity)]))
                small.save(d, self.folder / folder, f"{k}.dcm")
            return folder
        shear, youngs = code("m", "99OTHER", "Shear modulus"), code("e", "99OTHER", "Young's modulus")
        self.assertIn("different quantities", self.refused(mixed("both", youngs, shear)))
        self.assertIn("do not say what they hold", self.refused(mixed("some", youngs, None)))
        self.assertMean(self.measure(mixed("shear", shear, None)), 2.0)

    def test_slices_of_another_order_of_magnitude_are_doubted(self):
        # One slice went through a converter that lost its scale: no unit tells.
        siemens(self.folder / "mre", 12, lambda k: everywhere(2 if k == 2 else 2000), "MRE_stiffness",
                rescale=("0.001", "0", "US"))
        answer = self.measure("mre", "--unit", "kPa")
        self.assertIn("slices-of-another-scale", self.codes(answer, "warning"))

    def test_many_voxels_of_one_huge_value_are_doubted(self):
        rows = [[2000] * 6 + [32767] * 10] * small.N
        write(self.folder / "mre", 401, rows, "Stiffness")
        self.assertIn("median", str(self.measure()["warnings"]))  # most voxels: the median tells
        rows = [[2000] * 10 + [32767] * 6] * small.N
        write(self.folder / "unmarked", 401, rows, "Stiffness")
        self.assertIn("values-at-ceiling", self.codes(self.measure("unmarked"), "warning"))

    def test_stored_values_beyond_the_map_have_no_value(self):
        siemens(self.folder / "mre", 12, sides(1050, 9000), "MRE_stiffness",
                RealWorldValueMappingSequence=Sequence([scale(0.003, "kPa", 0, 5000)]))
        answer = self.measure()
        self.assertMean(answer, 3.15, 3 * PER_SLICE // 2)
        self.assertEqual(answer["left_out"]["not_finite"], 3 * PER_SLICE // 2)
        self.assertIn("outside-mapped-range", self.codes(answer, "warning"))

    def test_padding_is_no_stiffness(self):
        def padded(folder, fill, **attributes):
            write(self.folder / folder, 401, sides(2000, fill), "Stiffness", **attributes)
            return folder
        half = 3 * PER_SLICE // 2
        one = self.measure(padded("one", 9999, PixelPaddingValue=9999))
        self.assertMean(one, 2.0, half)
        self.assertEqual(one["left_out"]["not_finite"], half)
        self.assertTrue(any("do not count" in w for w in one["warnings"]))
        self.assertIn("padding-left-out", self.codes(one))
        for low, high in ((9000, 10000), (10000, 9000)):
            ranged = padded(f"range{low}", 9500, PixelPaddingValue=low, PixelPaddingRangeLimit=high)
            self.assertMean(self.measure(ranged), 2.0, half)
        self.assertMean(self.measure(padded("none", 4000)), 3.0)
        cli("convert", self.folder / "one", self.folder / "one.nii", "--quiet")
        again = cli_json("measure", "--mre", self.folder / "one.nii", "--roi", self.roi, "--unit", "Pa", "--quantity",
                         "shear")
        self.assertMean(again, 2.0, half)

    def test_a_scale_and_a_unit_in_the_file_count_more_than_the_vendor(self):
        def rescaled(folder, stored, rescale, description="Stiffness"):
            write(self.folder / folder, 401, everywhere(stored), description, rescale=rescale)
            return folder
        self.assertMean(self.measure(rescaled("raw", 2300, None)), 2.3)
        self.assertMean(self.measure(rescaled("us", 2300, ("1", "0", "US"))), 2.3)
        self.assertMean(self.measure(rescaled("kpa", 2300, ("0.001", "0", "kPa"))), 2.3)
        self.assertMean(self.measure(rescaled("half", 4600, ("0.5", "0", "Pa"))), 2.3)
        self.assertMean(self.measure(rescaled("word", 23, ("0.1", "0", "kilopascal"))), 2.3)
        self.assertMean(self.measure(rescaled("newton", 2300, ("1", "0", "N/m2"))), 2.3)
        self.assertIn("--unit", self.refused(rescaled("unknown", 2300, ("0.001", "0", "US"))))
        said = self.measure(rescaled("said", 23, ("0.1", "0", "US"), "Stiffness [kPa]"))
        self.assertMean(said, 2.3)
        self.assertIn("unit-by-words", self.codes(said, "warning"))

    def test_units_that_change_within_a_series(self):
        def mixed(folder, of):
            images = siemens(self.folder / folder, 12, everywhere(2300), "MRE_stiffness")
            for k, image in enumerate(images):
                if of(k):
                    image.RescaleSlope, image.RescaleIntercept, image.RescaleType = of(k)
                small.save(image, self.folder / folder, f"12-{k}.dcm")
            return folder
        pa, kpa = ("1", "0", "Pa"), ("0.001", "0", "kPa")
        for odd in range(3):
            answer = self.measure(mixed(f"odd{odd}", lambda k, odd=odd: pa if k == odd else kpa))
            self.assertMean(answer, 2.3)
            self.assertEqual([round(s["mean_kPa"], 4) for s in answer["slices"]], [2.3] * 3)
            self.assertIn("units-differ", self.codes(answer, "warning"))
        self.assertIn("name no unit", self.refused(mixed("missing", lambda k: None if k == 1 else kpa)))

    def test_each_volume_of_one_series_has_its_own_role(self):
        kinds = [(("ORIGINAL", "PRIMARY", "M_FFE", "M", "FFE"), 300, None),
                 (("DERIVED", "PRIMARY", "WAVE", "MRE", "FFE"), 7000, None),
                 (("DERIVED", "PRIMARY", "STIFFNESS", "MRE", "FFE"), 2300, ("0.001", "0", "kPa")),
                 (("DERIVED", "PRIMARY", "CONFIDENCE", "MRE", "FFE"), 999, None)]
        for folder, order in (("a", (0, 1, 2, 3)), ("b", (2, 3, 1, 0)), ("c", (1, 0, 3, 2))):
            for place, n in enumerate(order):
                image_type, value, rescale = kinds[n]
                for k in range(3):
                    d = small.slice_of(everywhere(value), k, 501, "MRE", maker="Philips Medical Systems", sequence=None,
                                       series="one", image_type=image_type, rescale=rescale, name=f"{n} {k}")
                    small.save(d, self.folder / folder, f"{place}{k}.dcm")
            scan = cli_json("scan", self.folder / folder)
            self.assertEqual(sorted(s["role"] for s in scan["series"]), ["confidence", "magnitude", "stiffness", "wave"])
            self.assertEqual(len(scan["acquisitions"]), 1)
            self.assertTrue(all(scan["acquisitions"][0]["products"].values()))
            answer = self.measure(folder)
            self.assertMean(answer, 2.3)
            self.assertNotIn("no-confidence-map", self.codes(answer))

    def test_words_of_descriptions(self):
        for description, role in (("MRE shear wave", "wave"), ("MRE wave", "wave"), ("MRE stiffness [kPa]", "stiffness"),
                                  ("MRE stiffness 95% confidence [kPa]", "stiffness"),
                                  ("MRE stiffness with 95 conf mask", "stiffness"), ("MRE confidence map", "confidence"),
                                  ("MRE stiffness confidence", "confidence"), ("MRE confidence of stiffness", "confidence"),
                                  ("MRE shear wave speed", "stiffness"), ("MRE shear modulus", "stiffness"),
                                  ("MRE loss modulus", "other")):
            for maker in ("SIEMENS", "Philips"):
                with self.subTest(description, maker=maker):
                    d = small.slice_of(everywhere(1), 0, 9, description, maker=maker, sequence=None)
                    scan = cli_json("scan", small.save(d, self.folder / f"{maker}.dcm"))
                    self.assertEqual(scan["series"][0]["role"], role)
        kpa = ("0.001", "0", "kPa")
        siemens(self.folder / "mre", 601, sides(2300, 0), "MRE stiffness 95% confidence [kPa]", rescale=kpa)
        siemens(self.folder / "mre", 602, everywhere(2300), "MRE stiffness [kPa]", rescale=kpa)
        siemens(self.folder / "mre", 603, everywhere(2048), "MRE shear wave")
        siemens(self.folder / "mre", 604, everywhere(999), "MRE confidence map")
        answer = self.measure()
        self.assertMean(answer, 2.3)
        acquisitions = cli_json("scan", self.folder / "mre")["acquisitions"]
        self.assertEqual(len(acquisitions), 1)
        self.assertEqual(acquisitions[0]["products"]["stiffness"], small.uid("series 602"))
        self.assertEqual(acquisitions[0]["products"]["other_stiffness"], [small.uid("series 601")])

    def test_private_attributes_are_those_of_their_creator(self):
        def ge(folder, creators, element):
            for number, value, what in ((301, 2300, "MR-Touch"), (307, 999, "MR-Touch")):
                for k in range(3):
                    d = small.slice_of(everywhere(value), k, number, what, sequence=None)
                    for block, creator in creators:
                        d.add_new((0x0019 << 16) | block, "LO", creator)
                    d.add_new((0x0019 << 16) | element, "LO", "epimre")
                    small.save(d, self.folder / folder, f"{number}-{k}.dcm")
            return [s["role"] for s in cli_json("scan", self.folder / folder)["series"]]
        self.assertEqual(ge("moved", [(0x10, "ACME"), (0x12, "GEMS_ACQU_01")], 0x129C), ["stiffness", "confidence"])
        self.assertNotIn("stiffness", ge("foreign", [(0x10, "ACME")], 0x109C))
        self.assertMean(self.measure("moved"), 2.3)

    def test_a_private_scale_that_differs_is_told(self):
        for k in range(3):
            d = small.slice_of(everywhere(2300), k, 501, "MRE", maker="Philips Medical Systems", sequence=None,
                               image_type=("DERIVED", "PRIMARY", "STIFFNESS", "MRE"), rescale=("0.001", "0", "normalized"))
            d.add_new(0x20050010, "LO", "Philips MR Imaging DD 001")
            d.add_new(0x2005100E, "FL", 5.0)
            small.save(d, self.folder / "mre", f"{k}.dcm")
        self.assertIn("unit", self.refused())
        answer = self.measure("mre", "--unit", "kPa")
        self.assertMean(answer, 2.3)
        self.assertIn("private-scale-not-used", self.codes(answer, "warning"))


class Outlines(Folder):
    def setUp(self):
        super().setUp()
        self.stiffness = write(self.folder / "mre", 401, sides(1800, 3000), "Stiffness")
        write(self.folder / "mre", 407, everywhere(999), "Confidence")

    def test_the_series_that_was_outlined_is_the_image(self):
        original = {"sequence": None, "image_type": ("ORIGINAL", "PRIMARY", "OTHER")}
        t1 = write(self.folder / "mri", 3, everywhere(100), "T1 ax", 3, **original)
        write(self.folder / "mri", 4, everywhere(100), "T2 ax", 6, shift=(6, 0, 0), **original)
        roi = liver(self.folder / "t1.dcm", images=t1)
        answer = self.measure("mre", "--mri", self.folder / "mri", roi=roi)
        chosen = next(d for d in answer["diagnostics"] if d["code"] == "series-by-outline")
        self.assertEqual(chosen["arguments"]["series"], 3)
        against = self.measure("mre", "--mri", self.folder / "mri", "--role", "4=anatomical", roi=roi)
        self.assertIn("outlined-series-not-taken", self.codes(against, "warning"))
        torn = pydicom.dcmread(roi)
        study = torn.ReferencedFrameOfReferenceSequence[0].RTReferencedStudySequence[0]
        study.RTReferencedSeriesSequence[0].SeriesInstanceUID = small.uid("series 401")
        torn.save_as(self.folder / "torn.dcm", write_like_original=False)
        answer = self.measure("mre", "--mri", self.folder / "mri", roi=self.folder / "torn.dcm")
        self.assertIn("outline-names-contradict", self.codes(answer, "warning"))
        lost = write(self.folder / "elsewhere", 9, everywhere(100), "T1 gone", 3, **original)
        answer = self.measure("mre", "--mri", self.folder / "mri", roi=liver(self.folder / "lost.dcm", images=lost))
        self.assertIn("outlined-series-absent", self.codes(answer, "warning"))

    def test_the_acquisition_that_was_outlined_is_measured(self):
        second = write(self.folder / "mre", 501, everywhere(5000), "Stiffness")
        write(self.folder / "mre", 507, everywhere(999), "Confidence")
        first = self.measure(roi=liver(self.folder / "first.dcm", images=self.stiffness))
        self.assertMean(first, 2.4)
        other = self.measure(roi=liver(self.folder / "second.dcm", images=second))
        self.assertMean(other, 5.0)
        self.assertIn("series-by-outline", self.codes(other, "note"))
        by_hand = self.measure("mre", "--role", "401=stiffness", roi=self.folder / "second.dcm")
        self.assertMean(by_hand, 2.4)
        self.assertIn("outlined-series-not-taken", self.codes(by_hand, "warning"))

    def test_the_frame_of_reference_is_that_of_the_structure(self):
        def told(name, liver_frame, spleen_frame, listed):
            contours = [(small.box(STEP * k), None) for k in range(3)]
            roi = structures(self.folder / name, [(1, "Spleen", spleen_frame, contours[:1]),
                                                  (2, "Liver", liver_frame, contours)], self.stiffness, listed)
            return any("different frames of reference" in w for w in self.measure(roi=roi)["warnings"])
        self.assertFalse(told("own.dcm", "frame", "frame", ["frame"]))
        self.assertFalse(told("swapped.dcm", "frame", "other", ["other", "frame"]))
        self.assertTrue(told("foreign.dcm", "other", "frame", ["frame", "other"]))

    def test_an_outline_without_a_frame_of_reference_is_told(self):
        contours = [(small.box(STEP * k), self.stiffness[k]) for k in range(3)]
        for name, frame, listed, missing in (("none", None, [], True), ("own", "frame", [], False),
                                             ("list", None, ["frame"], False)):
            roi = structures(self.folder / f"{name}.dcm", [(1, "Liver", frame, contours)], self.stiffness, listed)
            answer = self.measure(roi=roi)
            self.assertMean(answer, 2.4)
            self.assertEqual("outline-frame-missing" in self.codes(answer, "warning"), missing, name)

    def test_contours_that_are_not_on_the_image_that_they_name(self):
        def off(name, order):
            contours = [(small.box(STEP * k), self.stiffness[order[k]]) for k in range(3)]
            answer = self.measure(roi=structures(self.folder / name, [(1, "Liver", "frame", contours)], self.stiffness))
            self.assertMean(answer, 2.4)
            return [d["arguments"] for d in answer["diagnostics"] if d["code"] == "off-the-named-image"]
        self.assertEqual(off("good.dcm", (0, 1, 2)), [])
        self.assertEqual(off("reversed.dcm", (2, 1, 0)),
                         [{"count": 2, "of": 3, "what": "contours", "distance_mm": 2 * STEP}])
        self.assertEqual(off("shifted.dcm", (1, 2, 2))[0]["count"], 2)

    def test_segmentations_say_the_same(self):
        good = self.measure(roi=small.segmentation(self.folder / "good.dcm", [2, 0], self.stiffness, [2, 0]))
        self.assertMean(good, 2.4, 2 * PER_SLICE)
        self.assertEqual(self.codes(good, "warning"), set())
        none = small.segmentation(self.folder / "none.dcm", [2, 0], self.stiffness, [2, 0], frame=None)
        self.assertIn("outline-frame-missing", self.codes(self.measure(roi=none), "warning"))
        off = self.measure(roi=small.segmentation(self.folder / "off.dcm", [2, 0], self.stiffness, [2, 1]))
        self.assertMean(off, 2.4, 2 * PER_SLICE)
        self.assertIn("off-the-named-image", self.codes(off, "warning"))

    def test_two_sets_in_a_folder_are_asked_about(self):
        liver(self.folder / "sets" / "draft.dcm")
        contours = [(small.box(STEP * k, 8.0), None) for k in range(3)]
        structures(self.folder / "sets" / "final.dcm", [(1, "Liver", "frame", contours)], series="final")
        question = self.refused(roi=self.folder / "sets")
        self.assertIn("'draft.dcm', 'final.dcm'", question)
        (self.folder / "sets" / "final.dcm").write_bytes((self.folder / "sets" / "draft.dcm").read_bytes())
        self.assertMean(self.measure(roi=self.folder / "sets"), 2.4)
        # A set among images, filed in their series.
        liver(self.folder / "mre" / "set.dcm", series="series 401")
        self.assertMean(self.measure(roi=self.folder / "mre"), 2.4)

    def test_structures_of_one_name(self):
        def cs(half):
            return [(small.box(STEP * k, half), None) for k in range(3)]
        empty = structures(self.folder / "empty.dcm", [(1, "Liver", "frame", []), (2, "Liver", "frame", cs(16.0))])
        answer = self.measure(roi=empty)
        self.assertMean(answer, 2.4)
        self.assertIn("empty-twins", self.codes(answer, "warning"))
        both = structures(self.folder / "both.dcm", [(4, "Liver", "frame", cs(16.0)), (7, "Liver", "frame", cs(8.0))])
        question = self.refused(roi=both)
        self.assertIn("--label", question)
        self.assertIn("number 7", question)
        self.assertMean(self.measure("mre", "--label", 7, roi=both), 2.4, 3 * PER_SLICE // 2)
        self.assertMean(self.measure("mre", "--name", "#4", roi=both), 2.4)


class Strict(Folder):
    def test_warnings_are_refusals(self):
        write(self.folder / "mre", 401, everywhere(2000), "Stiffness")
        self.measure()
        refusal = cli("measure", "--mre", self.folder / "mre", "--roi", self.roi, "--strict", "--json", "--quiet", code=3)
        self.assertEqual(refusal.stdout, "")
        self.assertIn("there is no confidence map", refusal.stderr)
        write(self.folder / "mre", 407, everywhere(999), "Confidence")
        images = [pydicom.dcmread(f) for f in sorted((self.folder / "mre").glob("401*"))]
        roi = liver(self.folder / "whole.dcm", images=images)
        self.assertEqual(self.measure(roi=roi)["warnings"], [])
        self.assertMean(self.measure("mre", "--strict", roi=roi), 2.0)
        cli("scan", self.folder / "mre", "--strict", "--quiet")
        cli("--strict", "convert", self.folder / "mre", self.folder / "out.nii", "--series", "401", "--quiet")
        single = write(self.folder / "single", 3, everywhere(1), "T1", 1, sequence=None)
        self.assertEqual(len(single), 1)
        cli("scan", self.folder / "single", "--strict", "--quiet", code=3)
        cli("convert", self.folder / "single", self.folder / "single.nii", "--strict", "--quiet", code=3)
        self.assertFalse((self.folder / "single.nii").exists())

    def test_every_warning_is_a_diagnostic(self):
        write(self.folder / "mre", 401, sides(9000, 0), "Stiffness")
        answer = self.measure()
        said = {d["text"] for d in answer["diagnostics"]}
        self.assertTrue(answer["warnings"])
        self.assertTrue(set(answer["warnings"]) <= said)
        for d in answer["diagnostics"]:
            self.assertEqual(set(d), {"code", "severity", "text", "arguments"})
            self.assertIn(d["severity"], ("note", "warning", "error"))


if __name__ == "__main__":
    unittest.main()
