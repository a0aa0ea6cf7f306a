import unittest

import numpy as np
from z_test import XYZ_FROM_RGB, compare

SHAPE, SPP, MANY = (48, 64, 3), 256, 4096


def pictures(ours_variance: float, bias: float, wrong_pixels: int = 0):
    """A grey picture of ours and the reference, whose samples have the variance 0.04, with what compare() wants."""
    random = np.random.default_rng(5)
    grey, variance = np.full(SHAPE, 0.5), 0.04
    noise = random.standard_normal(SHAPE[:2])[..., None] * np.ones(3)

    def ours(spp):
        error = np.full(SHAPE, np.sqrt(ours_variance / spp))
        picture = grey * (1 + bias) + noise * error
        picture.reshape(-1, 3)[:wrong_pixels] += 0.5
        return picture, error

    scale = XYZ_FROM_RGB.sum(axis=1)
    mean = grey @ XYZ_FROM_RGB.T + random.standard_normal(SHAPE[:2])[..., None] * scale * np.sqrt(variance / MANY)
    (few, few_errors), (many, many_errors) = ours(SPP), ours(MANY)
    return few, few_errors, SPP, many, many_errors, mean, np.ones(SHAPE) * variance * scale**2, MANY


class ZTest(unittest.TestCase):
    def test_same_picture_passes(self):
        self.assertEqual(compare(*pictures(0.04, 0)).name, "passes")

    def test_more_noise_passes_by_both_error_bars(self):
        self.assertEqual(compare(*pictures(1.0, 0)).name, "passes by both error bars")

    def test_other_mean_differs(self):
        verdict = compare(*pictures(0.04, 0.03))
        self.assertEqual(verdict.name, "differs")
        self.assertAlmostEqual(verdict.ratios[1], 1.03, places=2)

    def test_wrong_pixels_differ(self):
        self.assertEqual(compare(*pictures(0.04, 0, wrong_pixels=5)).name, "passes")
        verdict = compare(*pictures(0.04, 0, wrong_pixels=12))
        self.assertEqual(verdict.name, "differs")
        self.assertAlmostEqual(verdict.share, 1 - 12 / (48 * 64), places=3)


if __name__ == "__main__":
    unittest.main()
