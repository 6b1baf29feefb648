# SPDX-License-Identifier: GPL-3.0-or-later
"""The exported SOFA node, read by a reader of its own: elements assembled anew, displacement compared with `run`."""
import itertools
import pathlib
import unittest
import xml.etree.ElementTree as ElementTree

import numpy

from support import cli, cli_json, folder_of_test, write_nifti, write_scene


def read_vtk(path):
    """Points, cells (VTK order) and moduli of a legacy ASCII unstructured grid."""
    words = iter(pathlib.Path(path).read_text().split("\n", 2)[2].split())
    points = cells = moduli = None
    for word in words:
        if word == "POINTS":
            count = int(next(words))
            next(words)
            points = numpy.array([float(next(words)) for _ in range(3 * count)]).reshape(-1, 3)
        elif word == "CELLS":
            count = int(next(words))
            next(words)
            cells = [[int(next(words)) for _ in range(int(next(words)))] for _ in range(count)]
        elif word == "LOOKUP_TABLE":
            next(words)
            moduli = numpy.array([float(w) for w in words])
    return points, numpy.array(cells), moduli


CORNERS = numpy.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1],
                       [-1, 1, 1]])


def hexahedron_stiffness(corners, young, poisson):
    """Plain trilinear hexahedron, 2×2×2 Gauss points, on its actual corners."""
    lam = young * poisson / (1 + poisson) / (1 - 2 * poisson)
    mu = young / 2 / (1 + poisson)
    elastic = numpy.diag([2 * mu] * 3 + [mu] * 3)
    elastic[:3, :3] += lam
    K = numpy.zeros((24, 24))
    for xi in itertools.product((-3 ** -0.5, 3 ** -0.5), repeat=3):
        terms = 1 + CORNERS * numpy.array(xi)
        local = numpy.stack([CORNERS[:, a] * terms[:, (a + 1) % 3] * terms[:, (a + 2) % 3] / 8 for a in range(3)])
        jacobian = local @ corners
        volume = numpy.linalg.det(jacobian)
        assert volume > 0, "a hexahedron is inside out"
        dx, dy, dz = numpy.linalg.solve(jacobian, local)
        B = numpy.zeros((6, 24))
        B[0, 0::3], B[1, 1::3], B[2, 2::3] = dx, dy, dz
        B[3, 0::3], B[3, 1::3] = dy, dx
        B[4, 1::3], B[4, 2::3] = dz, dy
        B[5, 0::3], B[5, 2::3] = dz, dx
        K += B.T @ elastic @ B * volume
    return K


def numbers(text):
    return numpy.array([float(w) for w in text.split()])


def solve_as_sofa(folder):
    """Displacement at the nodes of the exported scene at rest, mm."""
    root = ElementTree.parse(folder / "retraction.scn").getroot()
    liver = root.find("Node[@name='liver']")
    points, cells, moduli = read_vtk(folder / "liver.vtk")
    poisson = float(liver.find("HexahedronFEMForceField").get("poissonRatio"))
    K = numpy.zeros((3 * len(points), 3 * len(points)))
    for cell, young in zip(cells, moduli):
        unknowns = (3 * cell[:, None] + numpy.arange(3)).ravel()
        K[numpy.ix_(unknowns, unknowns)] += hexahedron_stiffness(points[cell], young, poisson)
    for springs in liver.findall("RestShapeSpringsForceField"):
        active = numbers(springs.get("activeDirections", "1 1 1"))
        for node, k in zip(numbers(springs.get("points")).astype(int), numbers(springs.get("stiffness"))):
            K[range(3 * node, 3 * node + 3), range(3 * node, 3 * node + 3)] += k * active
    f = numpy.zeros(3 * len(points))
    for load in liver.findall("ConstantForceField"):
        for node, force in zip(numbers(load.get("indices")).astype(int), numbers(load.get("forces")).reshape(-1, 3)):
            f[3 * node:3 * node + 3] += force
    free = numpy.ones(3 * len(points), bool)
    for held in liver.findall("FixedProjectiveConstraint"):
        for node in numbers(held.get("indices")).astype(int):
            free[3 * node:3 * node + 3] = False
    u = numpy.zeros(3 * len(points))
    u[free] = numpy.linalg.solve(K[numpy.ix_(free, free)], f[free])
    return points, u.reshape(-1, 3)


class Sofa(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_test(self)

    def mask_scene(self, **more):
        """A lump with stiffness that differs from voxel to voxel, on springs, hoisted by a retractor."""
        size, spacing = (9, 7, 6), (8.0, 9.0, 10.0)
        mask, map_kPa = [], []
        for k, j, i in itertools.product(range(6), range(7), range(9)):
            inside = ((i - 4) / 4.4) ** 2 + ((j - 3) / 3.4) ** 2 + ((k - 2.5) / 2.9) ** 2 <= 1
            mask.append(1 if inside else 0)
            map_kPa.append(4.0 + 0.3 * i + 0.2 * j + 0.1 * k)
        write_nifti(self.folder / "mask.nii.gz", mask, size, spacing, kind="B")
        write_nifti(self.folder / "E.nii.gz", map_kPa, size, spacing)
        return {"geometry": {"kind": "mask", "file": "mask.nii.gz"},
                "material": {"map": "E.nii.gz", "quantity": "youngs", "unit": "kPa", "poisson": 0.45},
                "supports": [{"region": {"surface": "posterior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.2},
                             {"region": {"surface": "superior"}, "kind": "spring", "stiffness_kPa_per_mm": 0.2}],
                "loads": [{"kind": "retractor", "length_mm": 40, "force": 2, "contact": "patch"}], "kinematics": "linear",
                "model": {"kind": "fem-hex", "element": "H8"}, **more}

    def test_same_element_gives_the_same_retraction(self):
        scene = self.mask_scene()
        exported = cli_json("export", write_scene(self.folder, scene), "--to", "sofa", "--output",
                            self.folder / "sofa")
        self.assertTrue(any(str(f).endswith("retraction.scn") for f in exported["files"]))
        points, u = solve_as_sofa(self.folder / "sofa")
        chosen = list(range(0, len(points), 17))
        scene["outputs"] = [{"probe": points[chosen].tolist()}]
        result = cli_json("run", write_scene(self.folder, scene))
        ours = numpy.array([p["u_mm"] for p in result["probes"]])
        self.assertGreater(numpy.abs(ours).max(), 0.5)
        self.assertLess(numpy.abs(ours - u[chosen]).max(), 1e-5 * numpy.abs(u).max())

    def test_a_run_exports_it_where_it_is_asked_for(self):
        scene = self.mask_scene(outputs=["sofa"])
        cli("run", write_scene(self.folder, scene), "--output", self.folder / "out")
        written = {p.name for p in (self.folder / "out" / "sofa").iterdir()}
        self.assertLessEqual({"retraction.scn", "liver_node.xml", "liver.vtk", "K.mtx", "M.mtx", "README.txt"}, written)
        readme = (self.folder / "out" / "sofa" / "README.txt").read_text()
        self.assertIn("runSofa -g batch", readme)
        self.assertIn("mN", readme)


if __name__ == "__main__":
    unittest.main()
