# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that the tests of the module share."""
import json


def beam(cell_mm=2.5, youngs_kPa=12):
    return {"schema": "glisson/scene/1", "geometry": {"kind": "box", "size_mm": [50, 10, 10], "cell_mm": cell_mm},
            "material": {"youngs_kPa": youngs_kPa, "poisson": 0.45}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -128]}], "outputs": [{"probe": [[25, 5, 5], [50, 5, 5]]}]}


def long_run():
    """Takes many seconds wherever it runs: large deformation of 64,000 cells."""
    return {"schema": "glisson/scene/1", "geometry": {"kind": "box", "size_mm": [200, 100, 100], "cell_mm": 2.5},
            "material": {"youngs_kPa": 6, "poisson": 0.49}, "supports": [{"region": {"face": "x-"}, "kind": "fixed"}],
            "loads": [{"kind": "body_force", "N_per_m3": [0, 0, -300]}], "kinematics": "hyperelastic",
            "outputs": [{"probe": [[200, 50, 50]]}]}


def coarse(patient):
    """The patient's scene with cells of 8 mm and a bar that travels 20 mm: some seconds."""
    file = patient / "scene.json"
    words = json.loads(file.read_text())
    words["geometry"]["cell_mm"] = 8
    words["loads"][0].pop("force", None)
    words["loads"][0]["drive"] = {"travel_mm": 20}
    words["outputs"] = ["vessels", "displacement-field"]
    file.write_text(json.dumps(words))
    return file
