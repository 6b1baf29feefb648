# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays are core's own memory, keep their owner alive, and lie where their affines say."""
import gc
import tempfile
import pathlib
import unittest

import numpy as np

import glisson
from scenes import beam

# Oblique and flipped, with three different spacings.
ANGLE = 0.3
DIRECTION = np.array([[np.cos(ANGLE), 0, -np.sin(ANGLE)], [0, -1, 0], [np.sin(ANGLE), 0, np.cos(ANGLE)]])
AFFINE = np.eye(4)
AFFINE[:3, :3] = DIRECTION * [1.5, 2.0, 4.0]
AFFINE[:3, 3] = [10, -20, 30]


def address(array):
    return array.__array_interface__["data"][0]


class Geometry(unittest.TestCase):
    def test_a_grid_of_an_affine_has_that_affine(self):
        grid = glisson.Grid([4, 5, 6], AFFINE)
        self.assertEqual(grid.size, (4, 5, 6))
        np.testing.assert_allclose(grid.spacing_mm, [1.5, 2, 4], rtol=1e-14)
        np.testing.assert_allclose(grid.direction, DIRECTION, atol=1e-14)
        np.testing.assert_allclose(grid.affine_lps, AFFINE, atol=1e-12)
        np.testing.assert_allclose(grid.affine_ras, np.diag([-1, -1, 1, 1]) @ AFFINE, atol=1e-12)

    def test_axes_that_are_not_orthogonal_are_refused(self):
        skewed = AFFINE.copy()
        skewed[0, 1] += 1
        with self.assertRaises(glisson.BadInput):
            glisson.Grid([4, 5, 6], skewed)

    def test_a_file_keeps_place_and_order_of_the_voxels(self):
        values = np.arange(4 * 5 * 6, dtype=np.float32).reshape(4, 5, 6)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("volume.nii.gz", "volume.nrrd", "volume.mha"):
                file = pathlib.Path(folder) / name
                glisson.Volume(values, AFFINE).write(file)
                again = glisson.read_volume(file)
                np.testing.assert_array_equal(again.values, values)
                np.testing.assert_allclose(again.affine_lps, AFFINE, atol=1e-4)

    def test_the_affine_in_ras_is_that_of_the_nifti_header(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "volume.nii"
            glisson.Volume(np.zeros((4, 5, 6)), AFFINE).write(file)
            header = file.read_bytes()
        srow = np.frombuffer(header, "<f4", 12, 280).reshape(3, 4)
        np.testing.assert_allclose(srow, np.diag([-1, -1, 1, 1])[:3] @ AFFINE, atol=1e-4)

    def test_arrays_of_any_order_and_type_are_taken(self):
        values = np.arange(24).reshape(2, 3, 4)
        for given in (values, np.asfortranarray(values), values.astype(float)[::1], values[::-1][::-1], values.tolist()):
            np.testing.assert_array_equal(glisson.Volume(given, AFFINE).values, values)
        mask = values % 2 == 1
        np.testing.assert_array_equal(glisson.Mask(mask, AFFINE).values, mask)
        with self.assertRaises(glisson.BadArgument):
            glisson.Volume(np.zeros((3, 3)), AFFINE)


class NoCopies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_ = glisson.run(glisson.Scene(beam()))

    def test_values_are_cores_own_memory(self):
        volume = glisson.Volume(np.ones((3, 4, 5)), AFFINE)
        self.assertEqual(address(volume.values), address(volume.values))
        self.assertEqual(address(self.run_.model.youngs_kPa.values), address(self.run_.model.youngs_kPa.values))
        u = self.run_.primary.displacement_mm
        self.assertEqual(address(u.values), address(self.run_.primary.displacement_mm.values))
        for array in (volume.values, u.values, self.run_.primary.probes_mm):
            self.assertFalse(array.flags.owndata)
            self.assertFalse(array.flags.writeable)
        self.assertTrue(volume.values.flags.f_contiguous)

    def test_views_cannot_be_written_to(self):
        with self.assertRaises(ValueError):
            self.run_.primary.displacement_mm.values[0, 0, 0, 0] = 1

    def test_an_array_keeps_its_owner_alive(self):
        run = glisson.run(glisson.Scene(beam()))
        u = run.primary.displacement_mm.values
        probes = run.primary.probes_mm
        before = u.copy(), probes.copy()
        del run
        gc.collect()
        junk = [glisson.Volume(np.full((40, 40, 40), 7.0), AFFINE) for _ in range(20)]
        np.testing.assert_array_equal(u, before[0])
        np.testing.assert_array_equal(probes, before[1])
        self.assertEqual(len(junk), 20)

    def test_index_and_component_are_where_they_say(self):
        """The beam bends down (z) and its displacement grows along x; the other axes would not."""
        u = self.run_.primary.displacement_mm
        self.assertEqual(u.values.shape, (20, 4, 4, 3))
        down = -u.values[:, 2, 2, 2]
        self.assertTrue(np.all(np.diff(down) > 0))
        self.assertGreater(down[-1], 10 * np.abs(u.values[-1, 2, 2, 1]))
        np.testing.assert_allclose(u.affine_lps @ [0, 0, 0, 1], [1.25, 1.25, 1.25, 1], atol=1e-12)

    def test_displacement_at_a_probe_is_that_of_the_probe(self):
        at = self.run_.displacement_at([[25, 5, 5], [50, 5, 5], [500, 0, 0]])
        np.testing.assert_allclose(at[:2], self.run_.primary.probes_mm, atol=1e-12)
        self.assertTrue(np.isnan(at[2]).all())
        for wrong in ([1, 2, 3], [[1, 2]], np.zeros((2, 2, 3))):
            with self.assertRaises(glisson.BadArgument):
                self.run_.displacement_at(wrong)
        with self.assertRaises(glisson.BadArgument):
            self.run_.displacement_at([[1, 2, 3]], atlas=True)


if __name__ == "__main__":
    unittest.main()
