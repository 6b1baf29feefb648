# SPDX-License-Identifier: GPL-3.0-or-later
"""Outlines and surfaces as sets of points, and places that two programs read differently: right, or said."""
import json
import math
import struct
import unittest

from support import cli, cli_json, folder_of_test, write_scene
from tiny_dicom import image, outlines, rectangle, stiffness


class InAFolder(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)

    def said(self, j, *parts):
        self.assertTrue(any(all(str(p) in w for p in parts) for w in j["warnings"]), j["warnings"])

    def silent_about(self, j, part):
        self.assertFalse([w for w in j["warnings"] if part in w])


class Outlines(InAFolder):
    """A region of 16 x 10 pixels of 2 mm on each of four slices: 640, half of it at 2 kPa and half at 4."""

    def setUp(self):
        super().setUp()
        stiffness(self.folder / "mre")

    def measured(self, on_second_slice, kind="CLOSED_PLANAR", more=()):
        contours = [p for k in (0, 2, 3) for p in [rectangle(-16, 16, -10, 10, 10.0 * k)]]
        file = outlines(self.folder / "rs.dcm", contours + list(on_second_slice), kind)
        return cli_json("measure", "--mre", self.folder / "mre", "--roi", file, *more)

    def assertPixels(self, j, n, mean=3.0):
        self.assertEqual(j["pooled"]["n"], n)
        self.assertAlmostEqual(j["pooled"]["mean_kPa"], mean, places=3)

    def test_repeated_outlines_count_once(self):
        one = rectangle(-16, 16, -10, 10, 10.0)
        self.assertPixels(self.measured([one]), 640)
        for again in (one, one[::-1], one[2:] + one[:2], rectangle(-15.98, 16.03, -10.02, 10.01, 10.0),
                      rectangle(-15.7, 15.7, -9.8, 9.8, 10.0)):
            j = self.measured([one, again])
            self.assertPixels(j, 640)
            self.said(j, "repeat")
        self.assertPixels(self.measured([one, one], "CLOSEDPLANAR_XOR"), 640)

    def test_overlapping_outlines_are_joined_and_touching_ones_are_not_doubted(self):
        j = self.measured([rectangle(-16, 4, -10, 10, 10.0), rectangle(-4, 16, -10, 10, 10.0)])
        self.assertPixels(j, 640)
        self.said(j, "overlap")
        j = self.measured([rectangle(-16, 0, -10, 10, 10.0), rectangle(0, 16, -10, 10, 10.0)])
        self.assertPixels(j, 640)
        self.silent_about(j, "overlap")

    def test_holes_by_inclusion_by_keyhole_and_by_parity(self):
        outer, hole = rectangle(-16, 16, -10, 10, 10.0), rectangle(-4, 4, -4, 4, 10.0)
        keyhole = [outer[0]] + [hole[n] for n in (0, 3, 2, 1, 0)] + outer
        self.assertPixels(self.measured([outer, hole]), 640 - 16)
        self.assertPixels(self.measured([keyhole]), 640 - 16)
        self.assertPixels(self.measured([outer, hole], "CLOSEDPLANAR_XOR"), 640 - 16)
        left, right = rectangle(-16, 4, -10, 10, 10.0), rectangle(-4, 16, -10, 10, 10.0)
        self.assertPixels(self.measured([left, right], "CLOSEDPLANAR_XOR"), 640 - 40)

    def test_a_region_drawn_twice_is_no_large_hole_without_a_word(self):
        outer = rectangle(-16, 16, -10, 10, 10.0)
        for inner in (rectangle(-14, 14, -8, 8, 10.0), rectangle(-12, 14, -9, 9, 10.0)):
            self.said(self.measured([outer, inner]), "less than half", "twice")
        self.silent_about(self.measured([outer, rectangle(-4, 4, -4, 4, 10.0)]), "less than half")

    def test_a_lobe_at_another_height_of_its_slice_counts_and_is_said(self):
        j = self.measured([rectangle(-16, 0, -10, 10, 10.0), rectangle(0, 16, -10, 10, 12.0)])
        self.assertPixels(j, 640)
        self.said(j, "above or below", "2 mm")
        j = self.measured([rectangle(-16, 16, -10, 10, 10.0), rectangle(-16, 10, -10, 10, 13.0)])
        self.assertPixels(j, 640)
        self.said(j, "left out", "3 mm")

    def test_slices_between_outlines_that_hold_none_are_counted(self):
        file = outlines(self.folder / "sparse.dcm", [rectangle(-16, 16, -10, 10, z) for z in (0.0, 30.0)])
        j = cli_json("measure", "--mre", self.folder / "mre", "--roi", file)
        self.assertPixels(j, 320)
        self.said(j, "2 of 4", "hold no outline")
        for k in range(7):
            image(self.folder / "mri", k, 5.0 * k, series="t1", number=3, description="T1 axial")
        j = cli_json("measure", "--mre", self.folder / "mre", "--roi", file, "--mri", self.folder / "mri")
        self.assertPixels(j, 640)
        self.silent_about(j, "hold no outline")

    def test_doubled_outlines_of_a_patient_keep_the_liver_whole(self):
        for k in range(8):
            image(self.folder / "mri", k, 5.0 * k, series="t1", number=3, description="T1 axial")
        volumes = []
        for doubled in ((), (2, 5)):
            polygons = [{"points_lps_mm": rectangle(-16, 16, -10, 10, 5.0 * k)}
                        for k in range(8) for _ in range(2 if k in doubled else 1)]
            (self.folder / "liver.json").write_text(json.dumps(
                {"schema": "glisson/contours/1", "name": "liver", "polygons": polygons}))
            scene = write_scene(self.folder, {
                "geometry": {"kind": "patient", "mri": "mri", "mre": "mre", "roi": "liver.json", "cell_mm": 5},
                "material": "mre", "supports": [{"region": {"surface": "posterior"}, "kind": "fixed"}],
                "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -500]}], "model": {"kind": "fem-hex"}, "outputs": []})
            j = cli_json("run", scene, "--output", self.folder / "run")
            volumes.append(j["model"]["volume_mL"])
            if doubled:
                self.said(j, "repeat", "2")
        self.assertAlmostEqual(volumes[0], volumes[1], places=6)

    def test_exclusions_that_touch_nothing_are_said(self):
        def nrrd(name, *lines):
            m = bytes(1 if -16 < x < -8 and -10 < y < 10 else 0 for _ in range(4) for y in range(-23, 24, 2)
                      for x in range(-29, 30, 2))
            head = ["NRRD0004", "type: uint8", "dimension: 3", "sizes: 30 24 4", "encoding: raw", *lines]
            (self.folder / name).write_bytes(("\n".join(head) + "\n\n").encode() + m)
            return self.measured([rectangle(-16, 16, -10, 10, 10.0)], more=("--exclude", self.folder / name))
        axes = ("space: left-posterior-superior", "space directions: (2,0,0) (0,2,0) (0,0,10)")
        j = nrrd("there.nrrd", *axes, "space origin: (-29,-23,0)")
        self.assertEqual(j["pooled"]["n"], 640 - 160)
        self.silent_about(j, "nothing was left out")
        for lines in ((*axes, "space origin: (300,-23,0)"), ("spacings: 2 2 10",)):
            j = nrrd("away.nrrd", *lines)
            self.assertPixels(j, 640)
            self.said(j, "nothing was left out")


def sphere(centre, radius, inward=False, wrap=True, noise=0.0, n=16):
    def point(i, j):
        if wrap and i in (0, n):
            return (centre[0], centre[1], centre[2] + (radius if i == 0 else -radius))
        t, f = math.pi * i / n, math.pi * (j % (2 * n) if wrap else j) / n
        shake = noise * math.sin(1000 * i + 77 * j)
        return tuple(c + radius * u + shake for c, u in
                     zip(centre, (math.sin(t) * math.cos(f), math.sin(t) * math.sin(f), math.cos(t))))
    triangles = []
    for i in range(n):
        for j in range(2 * n):
            p, q, r, s = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            triangles += ([(p, q, r)] if i < n - 1 else []) + ([(p, r, s)] if i > 0 else [])
    return [(a, c, b) for a, b, c in triangles] if inward else triangles


class Surfaces(InAFolder):
    def body(self, triangles, cell=2.5, code=0):
        with open(self.folder / "body.stl", "wb") as out:
            out.write(b"closed SPACE=LPS".ljust(80) + struct.pack("<I", len(triangles)))
            for t in triangles:
                out.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0))
        scene = write_scene(self.folder, {
            "geometry": {"kind": "mask", "file": "body.stl", "cell_mm": cell},
            "material": {"youngs_kPa": 6, "poisson": 0.45},
            "supports": [{"region": {"surface": "posterior"}, "kind": "fixed"}],
            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -500]}], "model": {"kind": "fem-hex"}, "outputs": []})
        if code:
            return cli("run", scene, "--output", self.folder / "run", "--quiet", code=code).stderr
        return cli_json("run", scene, "--output", self.folder / "run")

    def assertHolds(self, j, mL):
        self.assertAlmostEqual(j["model"]["volume_mL"] / mL, 1.0, delta=0.02)

    def test_shells_are_sets_of_points(self):
        o, r = (3.0, -2.0, 5.0), 28.0
        one = self.body(sphere(o, r))
        whole = one["model"]["volume_mL"]
        self.assertEqual([w for w in one["warnings"] if "shell" in w], [])
        cavity = 4 / 3 * math.pi * 13 ** 3 / 1000
        self.assertHolds(self.body(sphere(o, r) + sphere(o, 13, inward=True)), whole - cavity)
        j = self.body(sphere(o, r) + sphere(o, 13))
        self.assertHolds(j, whole - cavity)
        self.said(j, "turned outwards", "1 of 2")
        for again in (sphere(o, r + 0.004), sphere(o, r - 0.2), sphere(o, r, inward=True)):
            self.assertHolds(self.body(sphere(o, r) + again), whole)
        self.said(self.body(sphere(o, r) + sphere(o, r + 0.004)), "repeat")
        j = self.body(sphere(o, r) + sphere((3 + 28.0, -2, 5), r))
        lens = 5 / 12 * math.pi * r ** 3 / 1000
        self.assertHolds(j, 2 * whole - lens)
        self.said(j, "cross", "2 of 2")

    def test_seams_that_differ_in_the_last_digits_are_closed(self):
        o = (100.0, 40.0, -300.0)
        whole = self.body(sphere(o, 45), cell=5)["model"]["volume_mL"]
        for surface in (sphere(o, 45, wrap=False), sphere(o, 45, noise=2e-5)):
            self.assertHolds(self.body(surface, cell=5), whole)
        self.assertIn("not closed", self.body(sphere(o, 45)[1:], code=3))

    def test_another_unit_is_doubted(self):
        self.silent_about(self.body(sphere((0, 0, 0), 60), cell=8), "millimetres")
        self.said(self.body(sphere((0, 0, 0), 10), cell=1.2), "millimetres", "mL")
        self.said(self.body(sphere((0, 0, 0), 600), cell=80), "millimetres", "mL")


class Places(InAFolder):
    def nifti(self, name, qform=(0, 0, 0, 10.0, 20.0, 30.0), qfac=1.0, codes=(1, 1), pixdim=(2, 2, 5)):
        h = bytearray(348)
        struct.pack_into("<i", h, 0, 348)
        struct.pack_into("<8h", h, 40, 3, 6, 5, 4, 1, 1, 1, 1)
        struct.pack_into("<2h", h, 70, 2, 8)
        struct.pack_into("<8f", h, 76, qfac, *pixdim, 0, 0, 0, 0)
        struct.pack_into("<3f", h, 108, 352, 1, 0)
        h[123] = 2
        struct.pack_into("<2h6f", h, 252, *codes, *qform)
        struct.pack_into("<12f", h, 280, 2, 0, 0, 10, 0, 2, 0, 20, 0, 0, 5, 30)
        h[344:348] = b"n+1\0"
        (self.folder / name).write_bytes(bytes(h) + b"\0" * 4 + bytes(range(120)))
        return cli_json("convert", self.folder / name, self.folder / "out.nrrd")

    def test_two_forms_of_nifti_are_compared(self):
        self.assertEqual(self.nifti("same.nii")["warnings"], [])
        self.said(self.nifti("moved.nii", qform=(0, 0, 0, 10.0, 26.0, 30.0)), "6 mm", "not mirrored", "0 degrees")
        turn = math.sin(math.radians(10.0))
        self.said(self.nifti("turned.nii", qform=(0, 0, turn, 10.0, 20.0, 30.0)), "20 degrees")
        j = self.nifti("mirrored.nii", qform=(0, 1, 0, 20.0, 20.0, 30.0), qfac=-1.0)
        self.said(j, "mirrored", "mm")
        self.assertEqual(self.nifti("only_sform.nii", qform=(0, 0, 0, 99.0, 0, 0), codes=(0, 1))["warnings"], [])
        self.said(self.nifti("no_form.nii", codes=(0, 0)), "does not say where it lies")
        self.said(self.nifti("steps.nii", codes=(0, 2), pixdim=(2, 2, 4)), "4 mm", "5 mm")

    def nrrd(self, *lines, voxels=b"\1" * 60, code=0):
        head = ["NRRD0004", "type: uint8", "dimension: 3", "sizes: 5 4 3", "encoding: raw", *lines]
        (self.folder / "v.nrrd").write_bytes(("\n".join(head) + "\n\n").encode() + voxels)
        call = ("convert", self.folder / "v.nrrd", self.folder / "out.nii.gz")
        return cli(*call, "--quiet", code=code).stderr if code else cli_json(*call)

    def test_nrrd_says_space_unit_and_directions(self):
        axes = ("space: left-posterior-superior", "space directions: (2,0,0) (0,2,0) (0,0,5)", "space origin: (1,2,3)")
        self.assertEqual(self.nrrd(*axes)["warnings"], [])
        j = self.nrrd("space: left-posterior-superior", "space directions: (.2,0,0) (0,.2,0) (0,0,.5)",
                      "space origin: (.1,.2,.3)", 'space units: "cm" "cm" "cm"')
        self.assertEqual([round(v, 4) for v in j["spacing_mm"] + j["origin_lps_mm"]], [2, 2, 5, 1, 2, 3])
        self.assertIn("no unit of length", self.nrrd(*axes, 'space units: "furlong" "furlong" "furlong"', code=3))
        self.said(self.nrrd("spacings: 2 2 5"), "does not say where it lies")
        self.assertIn("space directions", self.nrrd("space: left-posterior-superior", "spacings: 2 2 5", code=3))
        layers = cli("convert", self.layered(), self.folder / "out.nii", "--quiet", code=3).stderr
        self.assertIn("segments overlap", layers)
        self.assertIn("'liver', 'lesion'", layers)

    def layered(self):
        head = ["NRRD0004", "type: uint8", "dimension: 4", "sizes: 2 5 4 3", "encoding: raw", "kinds: list domain domain domain",
                "space: left-posterior-superior", "space directions: none (2,0,0) (0,2,0) (0,0,5)", "space origin: (0,0,0)"]
        for n, name in enumerate(("liver", "lesion")):
            head += [f"Segment{n}_ID:=Segment_{n}", f"Segment{n}_Name:={name}", f"Segment{n}_LabelValue:=1", f"Segment{n}_Layer:={n}"]
        path = self.folder / "layers.seg.nrrd"
        path.write_bytes(("\n".join(head) + "\n\n").encode() + b"\1" * 120)
        return path

    def test_headers_that_announce_more_than_the_file_holds_are_refused(self):
        axes = ("space: left-posterior-superior", "space directions: (2,0,0) (0,2,0) (0,0,5)", "space origin: (1,2,3)")
        self.assertIn("truncated", self.nrrd(*axes, voxels=b"\1" * 59, code=3))
        self.assertIn("byte skip", self.nrrd(*axes, "byte skip: 900000", code=3))
        self.assertIn("one for each axis", self.nrrd(*axes, "kinds: domain", code=3))
        (self.folder / "other.raw").write_bytes(b"\1" * 60)
        (self.folder / "inner").mkdir()
        for name in ("../" + self.folder.name + "/other.raw", str(self.folder / "other.raw"), "inner"):
            self.assertIn("plain name", self.nrrd(*axes, f"data file: {name}", code=3))
        (self.folder / "link.raw").symlink_to(self.folder / "other.raw")
        self.assertIn("plain name", self.nrrd(*axes, "data file: link.raw", code=3))
        meta = ["ObjectType = Image", "NDims = 3", "DimSize = 5 4 3", "ElementType = MET_UCHAR", "Offset = 1 2 3",
                "ElementSpacing = 2 2 5", "BinaryData = True", "BinaryDataByteOrderMSB = False",
                "ElementDataFile = LOCAL"]
        def mha(lines, code=0):
            (self.folder / "v.mha").write_bytes(("\n".join(lines) + "\n").encode() + b"\1" * 60)
            call = ("convert", self.folder / "v.mha", self.folder / "out.nii")
            return cli(*call, "--quiet", code=code).stderr if code else cli_json(*call)
        self.assertEqual(mha(meta)["warnings"], [])
        self.said(mha([m for m in meta if "Offset" not in m]), "does not say where it lies")
        self.assertIn("NDims", mha([m.replace("NDims = 3", "NDims = 12") for m in meta], code=3))
        self.assertIn("Offset", mha([m.replace("Offset = 1 2 3", "Offset = 1 2 3 4") for m in meta], code=3))
        self.assertIn("truncated", mha([m.replace("5 4 3", "5 4 4") for m in meta], code=3))

    def test_lists_of_cells_that_contradict_themselves_are_refused(self):
        points = "DATASET POLYDATA\nPOINTS 4 float\n0 0 0\n100 0 0\n0 100 0\n0 0 100\n"
        old = "# vtk DataFile Version 3.0\nx\nASCII\n" + points + "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"
        new = ("# vtk DataFile Version 5.1\nx\nASCII\n" + points + "POLYGONS 5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\n"
               "CONNECTIVITY vtktypeint64\n0 2 1 0 1 3 1 2 3 0 3 2\n")
        for n, text in enumerate((old, new)):
            file = self.folder / f"{n}.vtk"
            file.write_text(text)
            cli("agree", file, file, "--quiet")
            for broken in (text[:-4], text.replace("0 3 2", "0 32"), text.replace("3 0 1 3", "30 1 3"),
                           text.replace("POLYGONS 4 16", "POLYGONS 4 15"), text.replace("POLYGONS 5 12", "POLYGONS 5 14")):
                if broken != text:
                    file.write_text(broken)
                    self.assertIn("list of cells", cli("agree", file, file, "--quiet", code=3).stderr)

    def test_rounded_positions_are_even_and_said(self):
        def scanned(heights):
            folder = self.folder / f"s{len(list(self.folder.iterdir()))}"
            for k, z in enumerate(heights):
                image(folder, k, z, series="t1", number=3, description="T1 axial")
            return cli_json("scan", folder)["series"][0]
        s = scanned([round(0.85 * k + 1e-9, 1) for k in range(16)])
        self.assertIsNone(s.get("error"))
        self.assertAlmostEqual(s["spacing_mm"][2], 0.85, delta=0.001)
        self.said(s, "rounded", "0.85")
        self.silent_about(scanned([0.85 * k for k in range(16)]), "rounded")
        self.assertIn("unevenly", scanned([0.85 * k + (0.5 if k > 7 else 0) for k in range(16)])["error"])

    def test_uneven_elastography_is_measured_and_not_simulated(self):
        heights = (0.0, 12.0, 22.0, 41.0)
        stiffness(self.folder / "mre", heights)
        file = outlines(self.folder / "rs.dcm", [rectangle(-16, 16, -10, 10, z) for z in heights])
        j = cli_json("measure", "--mre", self.folder / "mre", "--roi", file)
        self.assertEqual([s["n"] for s in j["slices"]], [160] * 4)
        self.assertAlmostEqual(j["pooled"]["mean_kPa"], 3.0, places=4)
        self.said(j, "unevenly", "10 to 19 mm")
        sparse = outlines(self.folder / "sparse.dcm", [rectangle(-16, 16, -10, 10, z) for z in (0.0, 22.0, 31.0, 41.0)])
        j = cli_json("measure", "--mre", self.folder / "mre", "--roi", sparse)
        self.assertEqual([s["n"] for s in j["slices"]], [160, 160, 160])
        self.said(j, "1 of 4", "hold no outline")
        self.said(j, "1 of 4", "none of the image's slices")
        self.assertIn("unevenly", cli("convert", self.folder / "mre", self.folder / "o.nii", "--quiet", code=3).stderr)


if __name__ == "__main__":
    unittest.main()
