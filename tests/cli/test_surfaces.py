# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces and volume meshes as regions: what is exported comes back as the same liver."""
import json
import pathlib
import shutil
import tempfile
import unittest

from support import DATA, cli, cli_json, write_scene


def write_obj(path, scale, skip=0):
    """A box of 40 x 60 x 80 mm times scale; the last `skip` faces are left out."""
    corners = [(0, 0, 0), (40, 0, 0), (40, 60, 0), (0, 60, 0), (0, 0, 80), (40, 0, 80), (40, 60, 80), (0, 60, 80)]
    faces = ["1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"]
    lines = ["v " + " ".join(str(scale * v) for v in c) for c in corners]
    lines += ["f " + f for f in faces[:len(faces) - skip]]
    path.write_text("\n".join(lines) + "\n")
    return path


class Surfaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_an_exported_surface_measures_like_the_outline(self):
        cli("phantom", "--cases", 1, "--seed", 3, "--output", self.folder / "in", "--quiet")
        patient = self.folder / "in" / "patient-001"
        scene = json.loads((patient / "scene.json").read_text())
        scene["geometry"]["cell_mm"] = [9, 9, 10]
        (patient / "scene.json").write_text(json.dumps(scene))
        cli("export", patient / "scene.json", "--to", "vtu", "--output", self.folder / "out", "--case", "case-1",
            "--reader", "reader-1", "--quiet")
        common = ["measure", "--mri", patient / "mri", "--mre", patient / "mre"]
        outline = cli_json(*common, "--roi", patient / "rtstruct.dcm")["pooled"]
        surface = cli_json(*common, "--roi", self.folder / "out" / "surface.vtp")["pooled"]
        self.assertAlmostEqual(surface["mean_kPa"], outline["mean_kPa"], delta=0.002 * outline["mean_kPa"])
        self.assertAlmostEqual(surface["n"], outline["n"], delta=0.02 * outline["n"])

    def test_a_box_as_a_surface_runs_like_a_box(self):
        load = {"supports": [{"region": {"face": "z-"}, "kind": "fixed"}],
                "loads": [{"kind": "body_force", "N_per_m3": [1000, 0, 0]}], "model": {"kind": "fem-hex"},
                "material": {"youngs_kPa": 10, "poisson": 0.3}, "analysis": {"kind": "static"}}
        write_obj(self.folder / "box.obj", 1)
        box = cli_json("run", write_scene(self.folder, {
            **load, "geometry": {"kind": "box", "size_mm": [40, 60, 80], "cell_mm": 5}}, "box.json"))
        surface = cli_json("run", write_scene(self.folder, {
            **load, "geometry": {"kind": "mask", "file": "box.obj", "cell_mm": 5}}, "surface.json"))
        self.assertEqual(surface["model"]["cells"], box["model"]["cells"])
        self.assertAlmostEqual(surface["max_displacement_mm"], box["max_displacement_mm"], delta=1e-6)

    def test_what_cannot_be_filled_is_refused_with_the_reason(self):
        scene = {"geometry": {"kind": "mask", "file": "bad.obj"}, "material": {"youngs_kPa": 10, "poisson": 0.3},
                 "supports": [{"region": {"face": "z-"}, "kind": "fixed"}],
                 "loads": [{"kind": "body_force", "N_per_m3": [1, 0, 0]}], "model": {"kind": "fem-hex"}}
        for text, arguments in (("not closed", {"scale": 1, "skip": 1}), ("millimetres", {"scale": 0.001})):
            write_obj(self.folder / "bad.obj", **arguments)
            done = cli("run", write_scene(self.folder, scene), code=3)
            self.assertIn(text, done.stderr)
            self.assertEqual(len([line for line in done.stderr.splitlines() if " %  " not in line]), 1, done.stderr)

    def test_a_broken_mesh_file_is_one_line(self):
        broken = DATA / "liver_meshes" / "liver_for_test_broken.vtk"
        if not broken.exists():
            self.skipTest("the shared data are not here")
        scene = {"geometry": {"kind": "mask", "file": str(broken)}, "material": {"youngs_kPa": 10, "poisson": 0.3},
                 "supports": [{"region": {"face": "z-"}, "kind": "fixed"}],
                 "loads": [{"kind": "body_force", "N_per_m3": [1, 0, 0]}], "model": {"kind": "fem-hex"}}
        done = cli("run", write_scene(self.folder, scene), "--quiet", code=3)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("liver_for_test_broken.vtk", done.stderr)


if __name__ == "__main__":
    unittest.main()
