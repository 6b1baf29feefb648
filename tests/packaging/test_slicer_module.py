# SPDX-License-Identifier: GPL-3.0-or-later
"""The logic of the scripted module for 3D Slicer with plain Python: the program is run, results become (stand-in) nodes."""
import json
import os
import pathlib
import py_compile
import sys
import tempfile
import unittest

from support import ROOT, folder_of_class

MODULE = ROOT / "resources/slicer/GlissonRetraction"
sys.path.insert(0, str(MODULE))
from GlissonRetractionLib import command_line, nodes, results, scene  # noqa: E402


class StandIn:
    """Notes what is called on it: a Slicer without Slicer."""

    def __init__(self, log, path=""):
        self._log, self._path = log, path

    def __getattr__(self, name):
        return StandIn(self._log, f"{self._path}.{name}")

    def __call__(self, *arguments):
        self._log.append((self._path, arguments))
        return StandIn(self._log, self._path + "()")


class Box(unittest.TestCase):
    """A small scene, run and exported through the module's own functions."""

    @classmethod
    def setUpClass(cls):
        cls.folder = folder_of_class(cls)
        cls.scene = scene.write_scene(cls.folder, {
            "schema": "glisson/scene/1", "geometry": {"kind": "box", "size_mm": [30, 10, 10], "cell_mm": 2.5},
            "material": {"youngs_kPa": 12}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]}], "outputs": []})
        cls.heard = []
        cls.record = command_line.run("run", cls.scene, "--output", cls.folder / "run",
                                      progress=lambda percent, words: cls.heard.append((percent, words)))
        command_line.run("export", cls.scene, "--to", "slicer", "--output", cls.folder / "slicer")
        cls.files = results.file_nodes(cls.folder / "slicer")

    def test_progress_is_told_up_to_the_end(self):
        self.assertEqual(self.heard[-1][0], 100)
        self.assertEqual([p for p, _ in self.heard], sorted(p for p, _ in self.heard))

    def test_the_export_becomes_nodes(self):
        self.assertEqual([f.kind for f in self.files], ["model", "model", "vector"])
        self.assertTrue(all(f.file.is_file() for f in self.files))
        log = []
        made = nodes.add_results(StandIn(log), self.files)
        self.assertEqual(len(made), 3)
        loaded = [(path, str(arguments[0])) for path, arguments in log if path in (".util.loadModel", ".util.loadVolume")]
        self.assertEqual(loaded, [(".util.loadModel", str(self.files[0].file)), (".util.loadModel", str(self.files[1].file)),
                                  (".util.loadVolume", str(self.files[2].file))])

    def test_figures_of_the_record(self):
        rows = dict(results.figures(self.record))
        self.assertEqual(rows["Liver"], "3 mL")
        self.assertEqual(rows["Difference"], "not given")
        self.assertEqual(rows, dict(results.figures(self.folder / "run/run.json")))

    def test_a_file_outside_the_folder_is_refused(self):
        away = self.folder / "away"
        away.mkdir()
        text = (self.folder / "slicer/scene.mrml").read_text()
        (away / "scene.mrml").write_text(text.replace('fileName="surface.vtp"', 'fileName="../slicer/surface.vtp"'))
        with self.assertRaisesRegex(ValueError, "surface.vtp"):
            results.file_nodes(away)

    def test_what_the_program_says_is_the_error(self):
        with self.assertRaisesRegex(command_line.GlissonError, "nowhere.json") as refused:
            command_line.run("run", self.folder / "nowhere.json")
        self.assertEqual(refused.exception.code, 3)

    def test_the_scene_for_a_patient_is_one_that_the_program_reads(self):
        made = scene.write_scene(self.folder / "patient", scene.patient_scene("mri", "mre", "outline.nrrd", uncertainty=True))
        schema = json.loads((ROOT / "resources/schemas/scene.schema.json").read_text())
        import jsonschema
        jsonschema.validate(json.loads(made.read_text()), schema)
        # Nothing is said against the scene; its images are not there.
        with self.assertRaisesRegex(command_line.GlissonError, "mri|mre|outline"):
            command_line.run("plan", made)
        for wrong in ({"diameter_mm": 0}, {"diameter_mm": 90}, {"force_N": -1}):
            with self.assertRaises(ValueError):
                scene.patient_scene("mri", "mre", "roi", **wrong)


class Plain(unittest.TestCase):
    def test_vessels_are_moved_and_turned_into_slicers_frame(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "vessels.csv"
            file.write_text("landmark,x_mm,y_mm,z_mm,radius_mm,ux_mm,uy_mm,uz_mm,difference_mm\n"
                            "0,10,20,30,2,1,-2,3,4.5\n1,1,1,1,2,,,,\n2,0,0,0,2,1,1,1,\n")
            found = results.vessels(file)
        self.assertEqual(found.rest, [(10, 20, 30), (0, 0, 0)])
        self.assertEqual(found.retracted, [(11, 18, 33), (1, 1, 1)])
        self.assertEqual(found.difference_mm, [4.5, None])
        log = []
        nodes.add_results(StandIn(log), [], found)
        points = [arguments for path, arguments in log if path.endswith("AddControlPoint")]
        self.assertEqual(points, [(-10, -20, 30), (0, 0, 0), (-11, -18, 33), (-1, -1, 1)])

    def test_slicers_own_libraries_are_not_passed_on(self):
        cleaned = command_line.clean_environment({"LD_LIBRARY_PATH": "/slicer", "PYTHONHOME": "/slicer", "HOME": "/home/x"})
        self.assertEqual(cleaned, {"HOME": "/home/x"})

    def test_a_missing_program_is_said(self):
        with self.assertRaisesRegex(command_line.GlissonError, "GLISSON_CLI"):
            command_line.program({"PATH": "/nowhere"})

    def test_slicers_part_is_python(self):
        with tempfile.TemporaryDirectory() as folder:
            py_compile.compile(str(MODULE / "GlissonRetraction.py"), cfile=os.path.join(folder, "m.pyc"), doraise=True)


if __name__ == "__main__":
    unittest.main()
