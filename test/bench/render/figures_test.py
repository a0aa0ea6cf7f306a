"""Environments, and what is computed from pictures and times."""

import unittest

import numpy as np
from scene_testing import InFolder

from comparison import Comparison, Measurement, ReferenceResult, Settings, estimator
from mitsuba_values import equal_area_coordinates, latitude_longitude
from pictures import Reference, read_pfm, relative_errors
from report import markdown


class Environments(unittest.TestCase):
    def test_axes(self):
        """+z is the centre of the square, -z its corners, the other axes the middles of its sides."""
        axes = np.array([[0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], float)
        expected = [[0.5, 0.5], [1, 0.5], [0, 0.5], [0.5, 1], [0.5, 0]]
        np.testing.assert_allclose(equal_area_coordinates(axes), expected, atol=1e-6)
        self.assertTrue(np.isin(equal_area_coordinates(np.array([0.0, 0, -1])).round(6), [0, 1]).all())

    def test_areas_are_kept(self):
        n, random = 8, np.random.default_rng(1)
        d = random.normal(size=(400000, 3))
        at = (equal_area_coordinates(d / np.linalg.norm(d, axis=1, keepdims=True)) * n).astype(int)
        counts = np.bincount(at[:, 0] + n * at[:, 1], minlength=n * n)
        self.assertLess(np.abs(counts / counts.mean() - 1).max(), 5 / counts.mean() ** 0.5)

    def test_latitude_longitude(self):
        """A map that holds the direction of each texel's centre, looked up where Mitsuba finds that direction."""
        n = 128
        square, found = np.zeros((n, n, 3)), np.random.default_rng(2).normal(size=(200000, 3))
        found /= np.linalg.norm(found, axis=1, keepdims=True)
        at = (equal_area_coordinates(found) * n).astype(int)
        square[at[:, 1], at[:, 0]] = found
        image = latitude_longitude(square)
        self.assertEqual(image.shape, (n, 2 * n, 3))
        for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.6, 0.48, 0.64), (0.48, -0.64, -0.6)):
            u, v = np.arctan2(x, -z) / (2 * np.pi) % 1, np.arccos(y) / np.pi
            texel = image[min(int(v * n), n - 1), min(int(u * 2 * n), 2 * n - 1)]
            np.testing.assert_allclose(texel, [x, y, z], atol=0.06)


class Figures(InFolder):
    def test_relative_errors(self):
        reference = np.ones((50, 40, 3))
        picture = reference.copy()
        picture[0, 0] = 11
        everything, trimmed = relative_errors(picture, reference)
        self.assertAlmostEqual(everything, 100 / 1.01 / 2000)
        self.assertEqual(trimmed, 0)

    def test_reference(self):
        found = Reference([np.full((2, 2, 3), v) for v in (1.0, 3.0)])
        self.assertAlmostEqual(found.luminance, 2)
        self.assertAlmostEqual(found.error, 1)

    def test_pfm(self):
        file = self.folder / "a.pfm"
        file.write_bytes(b"PF\n1 2\n-1\n" + np.arange(6, dtype="<f4").tobytes())
        np.testing.assert_array_equal(read_pfm(file), [[[3, 4, 5]], [[0, 1, 2]]])

    def test_table(self):
        comparison = Comparison([], Settings(200, [16], 64, 3, 1))
        comparison.measurements = [Measurement("a", "montelux", 16, [1, 2, 9], [3, 3, 3], [(0.1, 0.01)] * 3),
                                   Measurement("a", "llvm_ad_rgb", 16, [3, 4, 5], [3, 3, 3], [(0.05, 0.02)] * 3)]  # fmt: skip
        comparison.references = [
            ReferenceResult("a", "montelux", 64, 2.0, 0.03),
            ReferenceResult("a", "llvm_ad_rgb", 64, 2.1, 0.04),
        ]
        text = markdown(comparison, [])
        self.assertIn("| a | 16 | llvm_ad_rgb | 4.00 (3.00) | 3.00 (3.00) | 0.05 (0.02) | 2.00 | 1.00 (4.00) |", text)
        self.assertIn("+5.00 % (2.50)", text)

    def test_estimators(self):
        self.assertEqual(estimator("scalar_rgb"), estimator("llvm_ad_rgb"))
        self.assertNotEqual(estimator("llvm_ad_spectral"), estimator("llvm_ad_rgb"))
        self.assertEqual(estimator("montelux:sobol"), estimator("montelux"))
