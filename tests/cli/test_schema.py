# SPDX-License-Identifier: GPL-3.0-or-later
"""The published scene schema and the program agree: what one takes the other takes, what one refuses the other refuses."""
import copy
import json
import unittest

from support import ROOT, cli, folder_of_test, write_scene

try:
    import jsonschema
except ImportError:
    jsonschema = None

GOOD = {
    "schema": "glisson/scene/1",
    "geometry": {"kind": "box", "size_mm": [20, 10, 10], "cell_mm": 5},
    "material": {"shear_kPa": 4, "poisson": 0.45, "density_kg_m3": 1000},
    "supports": [{"region": {"face": "x-"}, "kind": "fixed", "axes": ["x", "y", "z"]},
                 {"region": {"surface": "inferior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1, "direction": "normal"}],
    "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -40]},
              {"kind": "traction", "region": {"box_mm": [[19, 0, 0], [20, 10, 10]]}, "kPa": [0, 0, -0.01]},
              {"kind": "retractor", "at": [12, 10, 5], "force": 0.01, "length_mm": 8, "spread_mm": 2, "direction": "transverse"}],
    "model": {"kind": "fem-hex", "element": "H8-Bbar"}, "kinematics": "linear", "analysis": {"kind": "static"},
    "solver": {"kind": "cg", "iterations": 500, "tolerance": 1e-7, "preconditioner": "jacobi"},
    "compare": {"against": "atlas", "shear_kPa": 2.1}, "outputs": [{"probe": [[20, 5, 5]]}, "displacement-field"], "seed": 3,
    "uncertainty": {"force_percent": 5, "bar_mm": 2, "fields": 8, "checks": 1}}

BAD = [
    lambda s: s.update(colour=1),
    lambda s: s.update(schema="glisson/scene/2"),
    lambda s: s.pop("geometry"),
    lambda s: s["geometry"].update(kind="sphere"),
    lambda s: s["geometry"].update(size_mm=[1, 2]),
    lambda s: s["material"].update(poisson=0.5),
    lambda s: s["material"].update(youngs_kPa=3),
    lambda s: s["material"].update(shear_kPa=-1),
    lambda s: s["supports"][0].update(kind="glued"),
    lambda s: s["supports"][0]["region"].update(surface="all"),
    lambda s: s["supports"][1].update(stiffness_kPa_per_mm=-1),
    lambda s: s["supports"][0].update(axes=["w"]),
    lambda s: s["supports"][1].update(kind="ligament"),
    lambda s: s["supports"].append({"region": {"face": "z+"}, "kind": "ligament", "name": "cruciate"}),
    lambda s: s["supports"].append({"region": {"face": "z+"}, "kind": "ligament", "name": "other", "slack_mm": -1}),
    lambda s: s["loads"][0].update(kind="wind"),
    lambda s: s["loads"][1].update(kPa=3),
    lambda s: s["loads"][2].update(length_mm=0),
    lambda s: s["model"].update(element="H20"),
    lambda s: s["solver"].update(kind="magic"),
    lambda s: s["compare"].update(against="nothing"),
    lambda s: s["outputs"].append("music"),
    lambda s: s.update(seed=-1),
    lambda s: s.update(uncertainty={"fields": 1}),
    lambda s: s.update(uncertainty={"force_percent": -2}),
]


@unittest.skipIf(jsonschema is None, "python3-jsonschema is not installed")
class Schema(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)
        self.schema = json.loads((ROOT / "resources/schemas/scene.schema.json").read_text())

    def test_both_take_a_full_scene_and_what_the_program_writes(self):
        jsonschema.validate(GOOD, self.schema)
        scene = write_scene(self.folder, GOOD)
        cli("run", scene, "--output", self.folder / "out", "--quiet")
        jsonschema.validate(json.loads((self.folder / "out/scene.json").read_text()), self.schema)

    def test_both_take_what_large_deformation_adds(self):
        scene = {**GOOD, "kinematics": "hyperelastic", "solver": {"kind": "auto"}, "compare": None,
                 "supports": [*GOOD["supports"],
                              {"region": {"face": "z-"}, "kind": "spring", "stiffness_kPa_per_mm": 0.1, "unilateral": True,
                               "tangential": 0.1},
                              {"region": {"face": "x+"}, "kind": "ligament", "name": "falciform", "stiffness_N_per_mm": 0.1,
                               "length_mm": 20, "slack_mm": 1, "towards": [1, 0, 1], "two_sided": True}],
                 "loads": [{"kind": "traction", "region": {"face": "y+"}, "kPa": [0.01, 0.01, 0], "follows": True}]}
        del scene["compare"]
        jsonschema.validate(scene, self.schema)
        cli("run", write_scene(self.folder, scene), "--output", self.folder / "out", "--quiet")
        written = json.loads((self.folder / "out/scene.json").read_text())
        jsonschema.validate(written, self.schema)
        self.assertEqual(written["supports"][3]["two_sided"], True)
        self.assertEqual(written["loads"][0]["follows"], True)

    def test_both_refuse_the_same(self):
        for number, spoil in enumerate(BAD):
            scene = copy.deepcopy(GOOD)
            spoil(scene)
            with self.subTest(number=number):
                self.assertRaises(jsonschema.ValidationError, jsonschema.validate, scene, self.schema)
                path = self.folder / "scene.json"
                path.write_text(json.dumps(scene))
                cli("plan", path, "--quiet", code=3)


if __name__ == "__main__":
    unittest.main()
