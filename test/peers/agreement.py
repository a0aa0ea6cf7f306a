"""Whether two methods render the same picture, and whether their error bars hold, from renders with different seeds.

- bias: of the mean luminance of the picture. Its error comes from the spread of seeds, since pixels of one render may
  share paths.
- pooled z: root mean square, over pixels and channels, of the difference of the seeds' mean pictures over its error; the
  errors are the claimed ones, averaged over 3 x 3 pixels (docs/images.md says why).
- shares of the pixels and channels of single renders within one, two and four claimed errors of the other method's mean
  picture, beside those of Student's law. A pixel beyond four errors that the render does not mark fails silently.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB
# The goals: relative bias, and pooled z.
MOST_BIAS, LEAST_Z, MOST_Z = 0.01, 0.9, 1.1
# Of the shares of pixels, in claimed errors.
LIMITS = (1, 2, 4)
# Standard errors at which a difference is clear. By Student's law of 30 degrees of freedom: once in 2600 comparisons.
CLEAR = 4


@dataclass(frozen=True)
class Renders:
    """Of one scene by one method, several seeds. Arrays (seeds, height, width, 3), and (seeds, height, width)."""

    means: np.ndarray
    errors: np.ndarray
    replicates: np.ndarray
    doubtful: np.ndarray  # pixels whose error bar the render itself calls unreliable

    def __len__(self) -> int:
        return len(self.means)

    def part(self, seeds: slice) -> Renders:
        return Renders(self.means[seeds], self.errors[seeds], self.replicates[seeds], self.doubtful[seeds])

    @property
    def variance(self) -> np.ndarray:
        """Claimed, of the mean picture of all seeds."""
        return (self.errors**2).sum(axis=0) / len(self) ** 2

    @property
    def mostly_doubtful(self) -> np.ndarray:
        return self.doubtful.mean(axis=0) > 0.5


@dataclass(frozen=True)
class Agreement:
    bias: float  # relative
    bias_error: float
    most_sigmas: float  # of luminance and the three channels
    pooled_z: float  # without doubtful pixels
    pooled_z_error: float
    pooled_z_of_all: float
    doubtful: float  # share of the pixels: of the mean pictures (pooled z) ...
    doubtful_of_renders: float  # ... and of single renders (shares within errors)
    within: Tuple[float, ...]  # LIMITS
    expected: Tuple[float, ...]
    within_errors: Tuple[float, ...]

    @property
    def bias_verdict(self) -> str:
        if abs(self.bias) > max(MOST_BIAS, CLEAR * self.bias_error):
            return "differs"
        return "agrees" if abs(self.bias) + 2 * self.bias_error < MOST_BIAS else "open"

    @property
    def z_verdict(self) -> str:
        """'open' also where every pixel is doubtful."""
        if LEAST_Z <= self.pooled_z <= MOST_Z:
            return "agrees"
        beyond = max(LEAST_Z - self.pooled_z, self.pooled_z - MOST_Z)
        return "differs" if beyond > CLEAR * self.pooled_z_error else "open"


def pooled(variance: np.ndarray) -> np.ndarray:
    """Means over 3 x 3 pixels, cut off at the edges, of an array (height, width, channels)."""
    height, width = variance.shape[:2]

    def sums(a: np.ndarray) -> np.ndarray:
        wide = np.pad(a, ((1, 1), (1, 1), (0, 0)))
        parts = [wide[y : y + height, x : x + width] for y in range(3) for x in range(3)]
        return np.sum(parts, axis=0)

    return sums(variance) / sums(np.ones_like(variance))


@lru_cache(maxsize=None)
def _student_table(limit: float) -> Tuple[np.ndarray, np.ndarray]:
    """Inverse degrees of freedom, from 0 to 1, and shares."""

    def share(nu: float) -> float:
        if nu > 1e6:  # lgamma would lose digits
            return math.erf(limit / math.sqrt(2))
        density = math.exp(math.lgamma((nu + 1) / 2) - math.lgamma(nu / 2)) / math.sqrt(nu * math.pi)
        t = np.linspace(0, limit, 201)
        heights = (1 + t * t / nu) ** (-(nu + 1) / 2)
        simpson = heights[0] + heights[-1] + 4 * heights[1:-1:2].sum() + 2 * heights[2:-1:2].sum()
        return float(2 * density * simpson * (t[1] - t[0]) / 3)

    inverse = np.linspace(0, 1, 2001)
    return inverse, np.array([share(1 / i if i else math.inf) for i in inverse])


def student_share(limit: float, freedom: np.ndarray) -> np.ndarray:
    """Probability that |t| of Student's law with `freedom` degrees of freedom (1 and more) is below `limit`."""
    return np.interp(1 / np.asarray(freedom), *_student_table(limit))


def _welch(a: np.ndarray, freedom_a: np.ndarray, b: np.ndarray, freedom_b: np.ndarray) -> np.ndarray:
    """Degrees of freedom of the sum of two estimated variances, not both 0 (Welch 1947)."""
    return (a + b) ** 2 / (a**2 / freedom_a + b**2 / freedom_b)


def _mean_and_error(values: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    return values.mean(axis=0), values.std(axis=0, ddof=1) / math.sqrt(len(values))


def _biases(reference: Renders, renders: Renders) -> Tuple[np.ndarray, np.ndarray]:
    """Of the picture's mean luminance and its three channels, relative, with errors."""

    def of_pictures(r: Renders) -> np.ndarray:
        channels = r.means.mean(axis=(1, 2))
        return np.concatenate([(channels @ LUMINANCE)[:, None], channels], axis=1)

    expected, expected_error = _mean_and_error(of_pictures(reference))
    mean, error = _mean_and_error(of_pictures(renders))
    return (mean - expected) / expected, np.hypot(error, expected_error) / np.abs(expected)


def _z_error(reference: Renders, renders: Renders, variance: np.ndarray, kept: np.ndarray, rms: float) -> float:
    """Standard error of the root mean square of scores that are correlated from pixel to pixel.

    The mean of n squared Gaussian scores with the correlations R has the variance 2 tr(R^2) / n^2. The trace is estimated
    without bias from the seeds (Srivastava 2005, "Some Tests Concerning the Covariance Matrix in High Dimensional Data")."""
    seeds = min(len(reference), len(renders))
    scores = (renders.means[:seeds] - reference.means[:seeds])[:, kept] / np.sqrt(variance[kept] * seeds)
    scores -= scores.mean(axis=0)
    n, m = scores.shape[1], seeds - 1
    gram = scores @ scores.T / m
    trace = m**2 / ((m - 1) * (m + 2)) * (np.sum(gram**2) - np.trace(gram) ** 2 / m)
    return math.sqrt(2 * max(float(trace), n)) / n / (2 * rms)


def _within(reference: Renders, renders: Renders) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shares within LIMITS, those expected, and errors of the former from the spread of seeds."""
    truth, truth_variance = reference.means.mean(axis=0), reference.variance
    truth_freedom = (reference.replicates - 1).sum(axis=0)[..., None]
    shares, expected = [], []
    for s in range(len(renders)):
        variance = renders.errors[s] ** 2
        kept = ~(renders.doubtful[s] | reference.mostly_doubtful)[..., None] & (variance + truth_variance > 0)
        freedom = np.broadcast_to(renders.replicates[s][..., None] - 1, variance.shape)
        if not kept.any():
            continue
        z = np.abs(renders.means[s] - truth)[kept] / np.sqrt(variance + truth_variance)[kept]
        law = _welch(
            variance[kept], freedom[kept], truth_variance[kept], np.broadcast_to(truth_freedom, variance.shape)[kept]
        )
        shares.append([float(np.mean(z < limit)) for limit in LIMITS])
        expected.append([float(np.mean(student_share(limit, law))) for limit in LIMITS])
    if len(shares) < 2:
        nothing = np.full(len(LIMITS), math.nan)
        return nothing, nothing, nothing
    share, error = _mean_and_error(np.array(shares))
    return share, np.mean(expected, axis=0), error


def agreement(reference: Renders, renders: Renders) -> Agreement:
    """Of two sets of renders of the same pixels with independent seeds."""
    biases, errors = _biases(reference, renders)
    difference = renders.means.mean(axis=0) - reference.means.mean(axis=0)
    variance = pooled(renders.variance + reference.variance)
    known = variance > 0
    doubtful = reference.mostly_doubtful | renders.mostly_doubtful
    kept = known & ~doubtful[..., None]

    def rms(pixels: np.ndarray) -> float:
        return math.sqrt(float(np.mean(difference[pixels] ** 2 / variance[pixels]))) if pixels.any() else math.nan

    z = rms(kept)
    share, expected, share_error = _within(reference, renders)
    return Agreement(
        bias=float(biases[0]),
        bias_error=float(errors[0]),
        most_sigmas=float(np.max(np.abs(biases) / errors)),
        pooled_z=z,
        pooled_z_error=_z_error(reference, renders, variance, kept, z) if kept.any() else math.nan,
        pooled_z_of_all=rms(known),
        doubtful=float(doubtful.mean()),
        doubtful_of_renders=float((renders.doubtful | reference.mostly_doubtful).mean()),
        within=tuple(share.tolist()),
        expected=tuple(expected.tolist()),
        within_errors=tuple(share_error.tolist()),
    )
