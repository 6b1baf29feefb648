# SPDX-License-Identifier: GPL-3.0-or-later
"""No picture, no OpenGL; what is left out changes no bit of what is asked for; pictures and runs can be made again."""
import hashlib
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import CLI, cli, cli_json, folder_of_class, write_nifti, write_scene

DRAWING = re.compile(r"lib(GL|EGL|GLX|OpenGL|GLEW|vtkRendering\w*)[.-]")


def loaded_libraries(*arguments):
    """Names of every library that the program loads, at its start or later, as the dynamic linker tells it."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "libs"
        cli(*arguments, "--quiet", env={"LD_DEBUG": "libs", "LD_DEBUG_OUTPUT": str(out)})
        text = "".join(f.read_text(errors="replace") for f in pathlib.Path(folder).iterdir())
    return set(re.findall(r"calling init: (\S+)", text))


def digests(folder):
    return {f.name: hashlib.sha256(f.read_bytes()).hexdigest() for f in sorted(pathlib.Path(folder).iterdir()) if f.is_file()}


class Lean(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        # A small "liver": a ball of 60 mm in voxels of 6 mm.
        n = (14, 14, 14)
        ball = [1 if sum((c - 6.5) ** 2 for c in (i % 14, i // 14 % 14, i // 196)) < 25 else 0 for i in range(14**3)]
        write_nifti(cls.folder / "ball.nii.gz", ball, n, (6, 6, 6), kind="B")
        cls.scene = {"geometry": {"kind": "mask", "file": "ball.nii.gz"},
                     "material": {"shear_kPa": 4, "poisson": 0.45},
                     "supports": [{"region": {"surface": "posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.5}],
                     "loads": [{"kind": "retractor", "force": 1.0, "length_mm": 40}],
                     "compare": {"against": "atlas"}}
        cls.full = cls.folder / "full"
        cls.record = cli_json("run", cls.write("full.json", ["displacement-field", "overlay", "report"]), "--output", cls.full)

    @classmethod
    def write(cls, name, outputs, **more):
        return write_scene(cls.folder, {**cls.scene, "outputs": outputs, **more}, name)

    def test_opengl_is_loaded_for_a_3d_picture_only(self):
        plain = loaded_libraries("run", self.write("plain.json", ["displacement-field"]), "--output", self.folder / "plain")
        self.assertTrue(any("libstdc++" in name for name in plain), "the linker tells what it loads")
        self.assertEqual([name for name in plain if DRAWING.search(name)], [])
        drawn = loaded_libraries("render", self.full, "--camera", "anterior", "--size", "320x240", "--output", self.folder / "gl")
        for library in ("libEGL", "libvtkRenderingCore", "libvtkRenderingOpenGL2"):
            self.assertTrue(any(library in name for name in drawn), library)
        # Slices are pictures without OpenGL.
        flat = loaded_libraries("render", self.full, "--slice", 6, "--output", self.folder / "flat")
        self.assertEqual([name for name in flat if DRAWING.search(name)], [])

    def test_nothing_that_draws_is_linked(self):
        linked = subprocess.run(["ldd", CLI], capture_output=True, text=True, check=True).stdout
        self.assertIn("libstdc++", linked)
        self.assertIsNone(DRAWING.search(linked), linked)

    def test_cells_that_leave_the_verdict_open_are_told(self):
        # Displacements are proportional to the force: one that puts the difference at the retractor on the line of 5 mm,
        # where any error leaves it open, and one that puts it at 0.5 mm, where the error would have to be nine times that.
        patch = {**self.scene["loads"][0], "contact": "patch"}
        was = cli_json("run", self.write("line.json", [], loads=[patch], kinematics="linear"),
                       "--output", self.folder / "line")["difference"]["at_retractor_mm"]
        for wanted, open_ in ((5.0, True), (0.5, False)):
            force = [{**patch, "force": patch["force"] * wanted / was}]
            r = cli_json("run", self.write("line.json", [], loads=force, kinematics="linear"), "--output", self.folder / "line")
            self.assertAlmostEqual(r["difference"]["at_retractor_mm"], wanted, delta=1e-3 * wanted)
            error = r["discretisation_error"]["difference"]["at_retractor_mm"]
            self.assertTrue(0 < error < 9 * wanted, error)
            self.assertEqual(any("on which side of that line" in w for w in r["warnings"]), open_, r["warnings"])

    def test_leaving_out_changes_no_bit_of_what_is_asked_for(self):
        alone = self.folder / "alone"
        r = cli_json("run", self.write("alone.json", ["displacement-field"]), "--output", alone)
        few, all_ = digests(alone), digests(self.full)
        for name in ("displacement-mre.nrrd", "displacement-atlas.nrrd"):
            self.assertEqual(few[name], all_[name], name)
        self.assertEqual([f for f in few if f.endswith((".png", ".html", ".glisson"))], [])
        for key in ("difference", "energy_J", "reaction_N", "max_strain", "max_rotation_deg"):
            self.assertEqual(r[key], self.record[key], key)
        pictures = self.folder / "pictures"
        cli_json("run", self.write("pictures.json", ["overlay"]), "--output", pictures)
        some = digests(pictures)
        self.assertIn("overlay-3d-oblique.png", some)
        for name, digest in some.items():
            if name.endswith(".png"):
                self.assertEqual(digest, all_[name], name)

    def test_render_draws_the_same_pictures_again(self):
        again = self.folder / "again"
        files = {f["file"]: f["sha256"] for f in cli_json("render", self.full, "--output", again)["files"]}
        pictures = {name: d for name, d in digests(self.full).items() if name.endswith(".png")}
        self.assertEqual(files, pictures)
        self.assertEqual(digests(again), pictures)

    def test_render_takes_camera_palette_slice_size_and_dpi(self):
        out = self.folder / "other"
        names = [f["file"] for f in cli_json("render", self.full, "--camera", "left", "--camera=-40,35", "--slice", 5,
                                             "--palette", "colour-blind", "--size", "400x300", "--dpi", 150,
                                             "--output", out)["files"]]
        pressure = [f"contact-pressure-{of}-{camera}.png" for of in ("atlas", "mre") for camera in ("az-40-el35", "left")]
        self.assertEqual(sorted(names), pressure + ["difference-map-slice-5.png", "overlay-3d-az-40-el35.png",
                                                    "overlay-3d-left.png", "overlay-slice-5.png"])
        for name in names:
            data = (out / name).read_bytes()
            self.assertEqual(data[37:41], b"pHYs", name)
            self.assertEqual(int.from_bytes(data[41:45], "big"), 5906, name)  # 150 / 0.0254
        data = (out / "overlay-3d-left.png").read_bytes()
        self.assertEqual((int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")), (400, 300))
        for arguments, word in ((("--camera", "sideways"), "sideways"), (("--slice", 99), "99"), (("--size", "9x9"), "9x9")):
            process = cli("render", self.full, *arguments, "--quiet", code=3)
            self.assertIn(word, process.stderr)
        self.assertIn("overlay", cli("render", self.folder, "--quiet", code=3).stderr)

    def test_damaged_picture_data_is_refused(self):
        whole = (self.full / "pictures.glisson").read_bytes()
        hurt = self.folder / "hurt"
        hurt.mkdir()
        for cut in (whole[:4], whole[:40], whole[:-1], whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:],
                    whole[:8] + b"\xff" * 8 + whole[16:]):
            (hurt / "pictures.glisson").write_bytes(cut)
            self.assertEqual(len(cli("render", hurt, "--quiet", code=3).stderr.strip().splitlines()), 1)

    def test_replay_gives_the_same_bits_and_sees_a_change(self):
        r = cli_json("replay", self.full / "run.json")
        self.assertTrue(r["identical"], r)
        self.assertGreater(len(r["outputs"]), 6)
        # A record that says otherwise is found out.
        record = json.loads((self.full / "run.json").read_text())
        record["outputs"][0]["sha256"] = "0" * 64
        (self.folder / "forged.json").write_text(json.dumps(record))
        r = cli_json("replay", self.folder / "forged.json", "--scene", self.full / "scene.json", code=1)
        self.assertFalse(r["identical"])
        self.assertEqual([f["identical"] for f in r["outputs"]].count(False), 1)
        # Inputs that have moved are found by --root; inputs that have changed are refused.
        moved = self.folder / "moved"
        moved.mkdir()
        (moved / "ball.nii.gz").write_bytes((self.folder / "ball.nii.gz").read_bytes())
        self.assertTrue(cli_json("replay", self.full / "run.json", "--root", moved)["identical"])
        write_nifti(moved / "ball.nii.gz", [1] * 14**3, (14, 14, 14), (6, 6, 6), kind="B")
        self.assertIn("mask", cli("replay", self.full / "run.json", "--root", moved, "--quiet", code=3).stderr)

    def test_report_is_whole_and_tells_the_method(self):
        page = (self.full / "report.html").read_text()
        self.assertNotRegex(page, r"(src|href)=\"(?!data:)")
        self.assertNotIn("<script", page)
        for word in ("Research use only", "Discretisation error", "µ = 2.1 kPa", "0.45", "retractor bar of 10 mm", "0.5 kPa/mm",
                     hashlib.sha256((self.folder / "ball.nii.gz").read_bytes()).hexdigest(),
                     digests(self.full)["overlay-retractor.png"]):
            self.assertIn(word, page)
        words = re.sub(r"data:[^\"]*", "", page)  # any three letters may stand in an encoded picture
        for secret in (str(self.folder), os.uname().nodename, "ball.nii"):
            self.assertNotRegex(words, r"(?<!\w)" + re.escape(secret) + r"(?!\w)")

    def test_large_deformation_is_reported_beside_linear(self):
        out = self.folder / "corotational"
        patch = [{**self.scene["loads"][0], "contact": "patch"}]
        linear = cli_json("run", self.write("linear.json", [], loads=patch, kinematics="linear"), "--output", self.folder / "linear")
        r = cli_json("run", self.write("corotational.json", ["report"], loads=patch, kinematics="corotational"), "--output", out)
        c = r["kinematics_compared"]
        self.assertEqual(set(c), {"linear", "corotational", "between"})
        self.assertEqual(c["linear"]["difference"]["mean_mm"], linear["difference"]["mean_mm"])
        self.assertEqual(c["corotational"]["difference"]["mean_mm"], r["difference"]["mean_mm"])
        self.assertGreater(c["between"]["max_mm"], 0)
        self.assertIn("Linear theory beside corotational", (out / "report.html").read_text())
        plan = {s["step"]: s for s in r["plan"]}
        self.assertTrue(plan["linear-solve"]["needed"])
        quiet = cli_json("run", self.write("quiet.json", [], loads=patch, kinematics="corotational"), "--output", self.folder / "quiet")
        self.assertNotIn("kinematics_compared", quiet)
        self.assertEqual(quiet["energy_J"], r["energy_J"])

    def test_advice_where_linear_theory_ends(self):
        loads = [{"kind": "retractor", "force": 12.0, "length_mm": 40, "contact": "patch"}]
        r = cli_json("run", self.write("heavy.json", [], loads=loads, kinematics="linear"), "--output", self.folder / "heavy")
        self.assertFalse(r["linear_valid"])
        self.assertIn("hyperelastic", r["advice"])
        self.assertNotIn("advice", cli_json("run", self.write("light.json", [], loads=[{**loads[0], "force": 0.1}], kinematics="linear"),
                                            "--output", self.folder / "light"))

    def test_errors_are_one_line_and_name_the_file(self):
        bad = self.write("my.json", [], colour=1)
        self.assertRegex(cli("plan", bad, code=3).stderr, r"my\.json, line \d+")
        for arguments in (("run",), ("no-such-verb",), ("plan", bad, "--threads", "-3")):
            self.assertEqual(len(cli(*arguments, code=2).stderr.strip().splitlines()), 1)
        process = cli("run", self.write("threads.json", []), "--threads", 64, "--json", "--quiet", "--output", self.folder / "t")
        self.assertEqual(process.stderr, "")
        json.loads(process.stdout)


if __name__ == "__main__":
    unittest.main()
