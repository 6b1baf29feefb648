# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what glisson-cli wrote as plain data. Standard library only."""
import csv
import json
import math
import pathlib
import xml.etree.ElementTree
from dataclasses import dataclass, field
from typing import List, Optional, Tuple

# Element of a Slicer scene -> what it is.
KINDS = {"Volume": "volume", "VectorVolume": "vector", "Segmentation": "segmentation", "Model": "model",
         "MarkupsClosedCurve": "curves"}


@dataclass
class FileNode:
    """A node whose data are in a file that Slicer can load. kind: a value of KINDS."""
    kind: str
    name: str
    file: pathlib.Path
    colour: Tuple[float, float, float] = (0.87, 0.72, 0.45)
    opacity: float = 1.0


@dataclass
class Vessels:
    """Landmarks of the hepatic vessels, LPS mm: at rest, and after the retraction with the measured stiffness.

    difference_mm: distance to where the textbook stiffness puts each; nothing where the run compares none.
    """
    rest: List[Tuple[float, float, float]] = field(default_factory=list)
    retracted: List[Tuple[float, float, float]] = field(default_factory=list)
    difference_mm: List[Optional[float]] = field(default_factory=list)


def file_nodes(folder):
    """What `export --to slicer` wrote into the folder, in the order of its scene.

    Raises ValueError where a file is named that does not lie in the folder.
    """
    folder = pathlib.Path(folder)
    root = xml.etree.ElementTree.parse(folder / "scene.mrml").getroot()
    by_id = {node.get("id"): node for node in root}
    nodes = []
    for node in root:
        kind = KINDS.get(node.tag)
        if kind is None:
            continue
        references = dict(part.split(":", 1) for part in node.get("references", "").split(";") if ":" in part)
        name = by_id[references["storage"]].get("fileName")
        path = folder / name
        if pathlib.PurePath(name).name != name or not path.is_file():
            raise ValueError(f"the scene names '{name}', which does not lie beside it")
        display = by_id.get(references.get("display"))
        one = FileNode(kind, node.get("name"), path)
        if display is not None and display.get("color"):
            one.colour = tuple(float(c) for c in display.get("color").split())
            one.opacity = float(display.get("opacity", 1))
        nodes.append(one)
    return nodes


def vessels(file):
    """Landmarks of a run's vessels.csv. Rows outside the body (no displacement) are left out."""
    found = Vessels()
    with open(file, newline="", encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            at = tuple(float(row[name]) for name in ("x_mm", "y_mm", "z_mm"))
            moved = [float(row[name] or "nan") for name in ("ux_mm", "uy_mm", "uz_mm")]
            if not all(map(math.isfinite, moved)):
                continue
            apart = float(row.get("difference_mm") or "nan")
            found.rest.append(at)
            found.retracted.append(tuple(a + u for a, u in zip(at, moved)))
            found.difference_mm.append(apart if math.isfinite(apart) else None)
    return found


def figures(record):
    """(what, value with unit) for a table, of run.json as an object or a path. Withheld figures are said as such."""
    if not isinstance(record, dict):
        record = json.loads(pathlib.Path(record).read_text(encoding="utf-8"))
    rows = [("Converged", "yes" if record["solver"]["converged"] else "no"),
            ("Liver", f"{record['model']['volume_mL']:.0f} mL")]
    contact = record.get("contact")
    if contact:
        rows.append(("Travel of the bar", f"{contact['travel_mm']:.1f} mm"))
    difference = record.get("difference")
    if difference:
        rows.append(("Difference at the bar", f"{difference['at_retractor_mm']:.1f} mm"))
        rows.append(("Difference, mean", f"{difference['mean_mm']:.2f} mm"))
    else:
        rows.append(("Difference", "not given"))
    rows.extend(("Warning", text) for text in record.get("warnings", []))
    return rows
