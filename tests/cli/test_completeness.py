# SPDX-License-Identifier: GPL-3.0-or-later
"""What is there of a series, and objects in several pieces or newer forms: whole, or said."""
import json
import subprocess
import sys
import unittest

from support import cli, cli_json, write_scene
from test_shapes import InAFolder
from tiny_dicom import COLUMNS, LABEL_MAP, ROWS, image, items, multi_frame, outlines, read, rectangle, stiffness, words


def plain(value):
    return words([value] * (ROWS * COLUMNS))


class Completeness(InAFolder):
    def series(self, folder):
        return cli_json("scan", self.folder / folder)["series"]

    def test_images_that_did_not_arrive_are_counted(self):
        for k in range(6):
            image(self.folder / "whole", k, 10.0 * k, ImagesInAcquisition=6)
        self.silent_about(self.series("whole")[0], "are there")
        for first, last in ((0, 4), (2, 6)):
            for k in range(first, last):
                image(self.folder / f"part{first}", k, 10.0 * k, ImagesInAcquisition=6)
            self.said(self.series(f"part{first}")[0], "4 of 6 images")
        file = outlines(self.folder / "rs.dcm", [rectangle(-16, 16, -10, 10, 10.0 * k) for k in range(6)])
        self.said(cli_json("measure", "--mre", self.folder / "part0", "--roi", file), "4 of 6 images")

    def test_one_image_with_two_contents_is_refused_and_a_copy_is_not(self):
        for folder, value in (("copy", (2000, 4000)), ("other", 7000)):
            stiffness(self.folder / folder)
            image(self.folder / folder, 1, 10.0, value=value, name="z.dcm")
        file = outlines(self.folder / "rs.dcm", [rectangle(-16, 16, -10, 10, 10.0 * k) for k in range(4)])
        j = cli_json("measure", "--mre", self.folder / "copy", "--roi", file)
        self.assertAlmostEqual(j["pooled"]["mean_kPa"], 3.0, places=4)
        why = cli("measure", "--mre", self.folder / "other", "--roi", file, "--quiet", code=3).stderr
        self.assertIn("different pixels", why)

    def part(self, folder, ks, number=0):
        frames = [(10.0 * k, plain(100 * (k + 1)), {"StackID": "1", "InStackPositionNumber": k + 1}, {}) for k in ks]
        more = {}
        if number:
            more = {"ConcatenationUID": "2.25.77", "InConcatenationNumber": number, "InConcatenationTotalNumber": 3,
                    "ConcatenationFrameOffsetNumber": ks[0]}
        multi_frame(self.folder / folder / f"part{number}.dcm", frames, **more)

    def test_a_cut_volume_is_joined_and_half_of_it_is_refused(self):
        self.part("whole", range(6))
        for n, ks in enumerate(((0, 1), (2, 3), (4, 5))):
            self.part("cut", ks, n + 1)
            if n != 1:
                self.part("torn", ks, n + 1)
        whole, cut = self.series("whole")[0], self.series("cut")
        self.assertEqual(len(cut), 1)
        for key in ("slices", "origin_lps_mm", "spacing_mm"):
            self.assertEqual(cut[0][key], whole[key])
        for folder in ("whole", "cut"):
            cli("convert", self.folder / folder, self.folder / f"{folder}.nii", "--quiet")
        self.assertEqual((self.folder / "whole.nii").read_bytes(), (self.folder / "cut.nii").read_bytes())
        self.assertIn("part 2 is missing", self.series("torn")[0]["error"])

    def test_phases_are_told_apart_by_trigger_delay_or_dimension(self):
        for kind in ("trigger", "index", "acquisition"):
            frames = []
            for k in range(3):
                for t in range(4):
                    content = {"StackID": "1", "InStackPositionNumber": k + 1, "DimensionIndexValues": [t + 1, k + 1]}
                    groups = {}
                    if kind == "trigger":
                        groups["CardiacSynchronizationSequence"] = items(NominalCardiacTriggerDelayTime=50.0 * t)
                        del content["DimensionIndexValues"]
                    if kind == "acquisition":
                        content["FrameAcquisitionNumber"] = t + 1
                        del content["DimensionIndexValues"]
                    frames.append((10.0 * k, plain(100 * (t + 1) + k), content, groups))
            multi_frame(self.folder / kind / "e.dcm", frames, pointers=(0x00209153, 0x00209057) if kind == "index" else ())
            series = self.series(kind)
            self.assertEqual([s["slices"] for s in series], [3] * 4, kind)
            cli("convert", self.folder / kind, self.folder / "o.nrrd", "--series", series[2]["uid"], "--quiet")
            self.assertTrue(all(s.get("error") is None for s in series))

    def test_label_maps_are_read(self):
        stiffness(self.folder / "mre")
        label = bytes(7 if -16 < x < 16 and -10 < y < 10 else 2 if x > 20 else 0
                      for y in range(-23, 24, 2) for x in range(-29, 30, 2))
        segments = []
        for number, name in ((2, "spleen"), (7, "liver")):
            one = items(SegmentNumber=number, SegmentLabel=name)[0]
            segments.append(one)
        for name, sop_class in (("new", LABEL_MAP), ("old", "1.2.840.10008.5.1.4.1.1.66.4")):
            file = multi_frame(self.folder / f"{name}.dcm", [(10.0 * k, label, {}, {}) for k in range(4)], sop_class,
                               name, "SEG", 8, SegmentationType="LABELMAP", SegmentSequence=segments)
            j = cli_json("measure", "--mre", self.folder / "mre", "--roi", file)
            self.assertEqual(j["pooled"]["n"], 640)
            self.assertAlmostEqual(j["pooled"]["mean_kPa"], 3.0, places=4)
            self.assertLess(cli_json("measure", "--mre", self.folder / "mre", "--roi", file, "--label", 2)["pooled"]["n"], 640)

    def test_high_ages_are_put_together(self):
        for name, age in (("a", "097Y"), ("b", "089Y"), ("c", "999M"), ("d", "090Y")):
            image(self.folder / "in", 0, 0.0, series=name, PatientAge=age, PatientWeight="70")
        j = cli_json("deidentify", self.folder / "in", self.folder / "out", "--key", self.folder / "key.json",
                     "--keep-characteristics")
        ages = sorted(read(p).PatientAge for p in (self.folder / "out").rglob("*.dcm"))
        self.assertEqual(ages, ["089Y", "090Y", "090Y", "999M"])
        self.assertTrue(any("090Y" in n for n in j["notes"]))

    def test_the_body_opens_in_meshio(self):
        scene = write_scene(self.folder, {
            "geometry": {"kind": "box", "size_mm": [20, 10, 10], "cell_mm": 2.5},
            "material": {"youngs_kPa": 12, "poisson": 0.45}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}], "model": {"kind": "fem-hex"}})
        cli("export", scene, "--to", "vtu", "--output", self.folder / "ex", "--quiet")
        body = (self.folder / "ex" / "body.vtu").read_bytes()
        # meshio knows numbers only: a text array anywhere ends the program that calls it.
        self.assertNotIn(b'type="String"', body)
        self.assertIn(b'header_type="UInt64"', body)
        look = "import meshio, sys, json; m = meshio.read(sys.argv[1]); print(json.dumps([len(m.points), " \
               "[[c.type, len(c.data)] for c in m.cells], sorted(m.point_data), sorted(m.cell_data)]))"
        try:
            import meshio  # noqa: F401
        except ImportError:
            self.skipTest("meshio is not installed")
        process = subprocess.run([sys.executable, "-c", look, str(self.folder / "ex" / "body.vtu")], capture_output=True,
                                 text=True)
        self.assertEqual(json.loads(process.stdout.splitlines()[-1]),
                         [9 * 5 * 5, [["hexahedron", 8 * 4 * 4]], ["u_mm"], ["E_kPa"]], process.stderr)


if __name__ == "__main__":
    unittest.main()
