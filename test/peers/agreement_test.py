import math
import unittest

import numpy as np
from agreement import Renders, agreement, pooled, student_share

SEEDS, HEIGHT, WIDTH, SPP = 16, 24, 32, 64


def renders(random, bias=0.0, claimed=1.0, common=0.0, skewed=False, replicates=SPP):
    """Of a grey picture by samples of variance 0.04; `claimed`: errors over the true ones; `common`: share of the
    variance that all pixels of a render have in common."""
    shape = (SEEDS, HEIGHT, WIDTH, 1, replicates)
    sample = random.exponential(size=shape) - 1 if skewed else random.standard_normal(shape)
    shared = random.standard_normal((SEEDS, 1, 1, 1, replicates))
    sample = 0.2 * (math.sqrt(1 - common) * sample + math.sqrt(common) * shared) * np.ones(3)[:, None]
    means = 0.5 * (1 + bias) + sample.mean(axis=-1)
    errors = claimed * sample.std(axis=-1, ddof=1) / math.sqrt(replicates)
    flat = means.shape[:3]
    return Renders(means, errors, np.full(flat, replicates), np.zeros(flat, dtype=bool))


class Agreement(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(3)

    def check_law(self, a):
        for share, expected, delta in zip(a.within, a.expected, (0.01, 0.01, 0.003)):
            self.assertAlmostEqual(share, expected, delta=delta)

    def test_same_picture_agrees(self):
        a = agreement(renders(self.random), renders(self.random))
        self.assertEqual((a.bias_verdict, a.z_verdict), ("agrees", "agrees"))
        self.assertLess(abs(a.bias), 4 * a.bias_error)
        self.assertLess(abs(a.pooled_z - 1), 4 * a.pooled_z_error)
        # Scores of three equal channels: as many independent ones as pixels.
        self.assertAlmostEqual(a.pooled_z_error, math.sqrt(0.5 / (HEIGHT * WIDTH)), delta=0.01)
        self.check_law(a)

    def test_bias_is_found(self):
        a = agreement(renders(self.random), renders(self.random, bias=0.03))
        self.assertEqual(a.bias_verdict, "differs")
        self.assertAlmostEqual(a.bias, 0.03, delta=4 * a.bias_error)
        self.assertEqual(a.z_verdict, "differs")

    def test_wrong_errors_are_found(self):
        for claimed, sign in ((0.7, 1), (1.4, -1)):
            a = agreement(renders(self.random, claimed=claimed), renders(self.random, claimed=claimed))
            self.assertEqual((a.bias_verdict, a.z_verdict), ("agrees", "differs"))
            self.assertGreater(sign * (a.expected[0] - a.within[0]), 0.05)

    def test_few_replicates_follow_students_law(self):
        a = agreement(renders(self.random), renders(self.random, replicates=4))
        self.assertLess(a.expected[0], 0.63)
        self.check_law(a)

    def test_skewed_samples_agree(self):
        a = agreement(renders(self.random, skewed=True), renders(self.random, skewed=True))
        self.assertEqual((a.bias_verdict, a.z_verdict), ("agrees", "agrees"))

    # The mean square of 768 scores that share 5 % of their variance varies as much as that of 260 independent ones.
    def test_pixels_that_share_their_error_widen_that_of_z(self):
        squares = []
        for _ in range(40):
            a = agreement(renders(self.random, common=0.05, replicates=16), renders(self.random, common=0.05, replicates=16))
            squares.append((a.pooled_z**2, 2 * a.pooled_z * a.pooled_z_error))
        values, errors = np.array(squares).T
        self.assertAlmostEqual(np.mean(errors), math.sqrt(2 / 260), delta=0.015)
        self.assertAlmostEqual(values.std() / np.mean(errors), 1, delta=0.5)

    def test_doubtful_pixels_are_left_out(self):
        reference, wrong = renders(self.random), renders(self.random)
        wrong.means[:, :4] += 1
        wrong.doubtful[: SEEDS // 2 + 1, :4] = True
        a = agreement(reference, wrong)
        self.assertEqual(a.z_verdict, "agrees")
        self.assertGreater(a.pooled_z_of_all, 2)
        self.assertAlmostEqual(a.doubtful, 4 / HEIGHT)

    def test_pixels_without_errors_have_no_score(self):
        pictures = [renders(self.random), renders(self.random)]
        for p in pictures:
            p.means[:, :, :6], p.errors[:, :, :6] = 0, 0
        a = agreement(*pictures)
        self.assertEqual(a.z_verdict, "agrees")
        self.check_law(a)

    def test_pictures_of_doubtful_pixels_decide_nothing(self):
        pictures = [renders(self.random), renders(self.random)]
        pictures[1].doubtful[:] = True
        a = agreement(*pictures)
        self.assertEqual((a.bias_verdict, a.z_verdict), ("agrees", "open"))
        self.assertTrue(math.isnan(a.within[0]))

    def test_pooling_is_cut_off_at_the_edges(self):
        variance = np.arange(12.0).reshape(3, 4, 1)
        self.assertAlmostEqual(pooled(variance)[1, 1, 0], 5)
        self.assertAlmostEqual(pooled(variance)[0, 0, 0], (0 + 1 + 4 + 5) / 4)

    def test_students_law(self):
        for limit, freedom, share in ((1, 1, 0.5), (2, 2, 0.816497), (2, 4, 0.883883), (1, 1e9, 0.682689)):
            self.assertAlmostEqual(float(student_share(limit, np.array(float(freedom)))), share, delta=1e-5)


if __name__ == "__main__":
    unittest.main()
