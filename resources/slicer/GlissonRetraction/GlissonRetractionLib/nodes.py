# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns results into Slicer's nodes. The module `slicer` is passed in, so that it can be replaced in tests."""

LOADERS = {"volume": "loadVolume", "vector": "loadVolume", "segmentation": "loadSegmentation", "model": "loadModel",
           "curves": "loadMarkups"}


def ras(point_lps):
    """Slicer's frame: x and y the other way round, mm."""
    x, y, z = point_lps
    return (-x, -y, z)


def add_file(slicer, item):
    """Loads a FileNode; returns the node that Slicer made."""
    node = getattr(slicer.util, LOADERS[item.kind])(str(item.file))
    node.SetName(item.name)
    if item.kind == "model":
        display = node.GetDisplayNode()
        display.SetColor(*item.colour)
        display.SetOpacity(item.opacity)
    return node


def add_points(slicer, name, points_lps, colour):
    """A locked markups node of points given in LPS mm."""
    node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLMarkupsFiducialNode", name)
    for point in points_lps:
        node.AddControlPoint(*ras(point))
    node.SetLocked(True)
    node.CreateDefaultDisplayNodes()
    display = node.GetDisplayNode()
    display.SetSelectedColor(*colour)
    display.SetGlyphScale(1.0)
    display.SetTextScale(0.0)
    return node


def add_results(slicer, files, vessels=None):
    """Nodes of an export, and of the vessels at rest (grey) and retracted (blue). Returns them in order."""
    nodes = [add_file(slicer, item) for item in files]
    if vessels is not None and vessels.rest:
        nodes.append(add_points(slicer, "vessels at rest", vessels.rest, (0.6, 0.6, 0.6)))
        nodes.append(add_points(slicer, "vessels retracted", vessels.retracted, (0.1, 0.3, 0.9)))
    return nodes
