"""Mitsuba's test of a picture: a z-test of each pixel, at a significance of 1 % with the correction of Sidak for their
number, which 99.75 % must pass. It takes the reference's variance for ours; the same test by the error bars of both tells
a difference from samples that vary more."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Tuple

import numpy as np

# From linear sRGB (IEC 61966-2-1).
XYZ_FROM_RGB = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
# Of a sample: what Mitsuba takes for the least.
LEAST_VARIANCE = 1e-4
# Share of the pixels that must pass, and the most by which means may differ.
SHARE, MEANS = 0.9975, 0.01

_beyond = np.vectorize(lambda z: math.erfc(z / math.sqrt(2)), otypes=[float])


@dataclass
class Verdict:
    share: float  # of pixels that pass by the reference's variance
    share_by_both: float  # by the error bars of both
    ratios: Tuple[float, ...]  # of mean X, Y, Z
    ratio_errors: Tuple[float, ...]  # of these, one standard error

    @property
    def means_agree(self) -> bool:
        """Within 1 %, or three standard errors where noise is more."""
        return all(abs(r - 1) <= MEANS + 3 * e for r, e in zip(self.ratios, self.ratio_errors))

    @property
    def name(self) -> str:
        if not self.means_agree or self.share_by_both < SHARE:
            return "differs"
        return "passes" if self.share >= SHARE else "passes by both error bars"

    @property
    def passes(self) -> bool:
        return self.name != "differs"


def _share(z: np.ndarray) -> float:
    pixels = z.shape[0] * z.shape[1]
    alpha = 1 - (1 - 0.01) ** (1 / pixels)
    return float(np.mean(np.all(_beyond(np.abs(z)) > alpha, axis=-1)))


def compare(
    few: np.ndarray,
    few_errors: np.ndarray,
    spp: int,
    many: np.ndarray,
    many_errors: np.ndarray,
    mean: np.ndarray,
    variance: np.ndarray,
    reference_spp: int,
) -> Verdict:
    """Pictures of ours in linear sRGB with standard errors, (height, width, 3), of `spp` samples and of more; mean and
    variance of a sample of the reference, in XYZ."""
    difference = few @ XYZ_FROM_RGB.T - mean
    least = np.maximum(variance, LEAST_VARIANCE)
    by_reference = difference / np.sqrt(least * (1 / spp + 1 / reference_spp))
    # Errors of the three colours as if they were one number: at most that much.
    ours = few_errors @ XYZ_FROM_RGB.T
    by_both = difference / np.sqrt(ours**2 + least / reference_spp)
    sums, expected = (many @ XYZ_FROM_RGB.T).sum(axis=(0, 1)), mean.sum(axis=(0, 1))
    noise = np.sqrt(
        (variance / reference_spp).sum(axis=(0, 1)) + ((many_errors @ XYZ_FROM_RGB.T) ** 2).sum(axis=(0, 1))
    )
    return Verdict(
        _share(by_reference), _share(by_both), tuple((sums / expected).tolist()), tuple((noise / expected).tolist())
    )
