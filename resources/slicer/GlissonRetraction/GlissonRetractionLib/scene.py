# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes scene.json for a patient. Standard library only."""
import json
import pathlib


def patient_scene(mri, mre, roi, diameter_mm=10.0, length_mm=80.0, force_N=None, uncertainty=False):
    """A retraction of a patient's liver, measured against textbook stiffness.

    mri, mre: folders of DICOM files. roi: outline of the liver (RT Structure Set, segmentation or mask file). force_N: of the
    bar; None: the liver's weight. Raises ValueError for what cannot be a bar or a force.
    """
    if not 0 < diameter_mm <= length_mm:
        raise ValueError("a bar has a diameter above 0 mm that is not larger than its length")
    if force_N is not None and force_N <= 0:
        raise ValueError("the force of the bar is above 0 N, or the liver's weight")
    spring = {"kind": "spring", "stiffness_kPa_per_mm": 0.1}
    scene = {
        "schema": "glisson/scene/1",
        "geometry": {"kind": "patient", "mri": str(mri), "mre": str(mre), "roi": str(roi)},
        "material": "mre",
        "supports": [{"region": {"surface": "posterior"}, **spring}, {"region": {"surface": "superior"}, **spring}],
        "loads": [{"kind": "retractor", "diameter_mm": diameter_mm, "length_mm": length_mm, "at": "inferior-right-lobe",
                   "force": "liver-weight" if force_N is None else force_N, "direction": "transverse"}],
        "model": {"kind": "fem-hex"},
        "compare": {"against": "atlas"},
        "outputs": ["vessels", "report"],
        "seed": 1,
    }
    if uncertainty:
        scene["uncertainty"] = True
    return scene


def write_scene(folder, scene):
    """Writes scene.json into the folder, which is made where it is missing; returns its path."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "scene.json"
    path.write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")
    return path
