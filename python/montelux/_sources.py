"""Where errors come from: the runs, and gradients with respect to their values."""

from __future__ import annotations

import math
import sys
import uuid
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ._core import Error

#: What is below this share of the terms of a sum is their rounding.
_ROUNDING = 8 * sys.float_info.epsilon

_UNKNOWN = "the covariance of the components of a run is not known; expected a method that has it, and covariance=True"


class Run:
    """The random values of one run, with their errors. Runs of one key are the same, in other processes too.

    standard_error has shape (m,), covariance (m, m); None where it is not known. seed: of the random numbers; None
    where there are none.
    """

    __slots__ = ("__weakref__", "covariance", "key", "seed", "standard_error", "warnings")

    def __init__(
        self,
        standard_error: npt.ArrayLike,
        covariance: npt.ArrayLike | None = None,
        seed: int | None = None,
        warnings: tuple[str, ...] = (),
    ) -> None:
        self.key = uuid.uuid4().hex
        self.seed = seed
        self.standard_error = np.atleast_1d(np.asarray(standard_error, dtype=float))
        self.covariance = None if covariance is None else np.atleast_2d(np.asarray(covariance, dtype=float))
        self.warnings = warnings

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Run) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __getstate__(self) -> tuple[object, ...]:
        return self.key, self.seed, self.standard_error, self.covariance, self.warnings

    def __setstate__(self, state: tuple[object, ...]) -> None:
        for name, value in zip(("key", "seed", "standard_error", "covariance", "warnings"), state):
            setattr(self, name, value)

    def between(self, a: dict[int, float], b: dict[int, float]) -> float:
        """Covariance of two linear forms in the values: the sum of a_i C_ij b_j."""
        if a.keys() == b.keys() and len(a) == 1:
            ((i, x),) = a.items()
            return x * b[i] * float(self.standard_error[i]) ** 2
        if self.covariance is None:
            raise Error(_UNKNOWN)
        matrix = self.covariance[np.ix_(list(a), list(b))]
        terms = np.outer(list(a.values()), list(b.values())) * matrix
        total = float(terms.sum())
        return 0.0 if abs(total) <= _ROUNDING * float(np.abs(terms).sum()) else total


#: Derivatives with respect to values of runs: none of them is zero.
Gradient = dict[Run, dict[int, float]]


def combined(terms: Iterable[tuple[float, Gradient]]) -> Gradient:
    """The gradient of a sum of factor times value. What cancels to rounding is zero."""
    sums: Gradient = {}
    sizes: dict[tuple[Run, int], float] = {}
    for factor, gradient in terms:
        for run, parts in gradient.items():
            into = sums.setdefault(run, {})
            for i, derivative in parts.items():
                term = factor * derivative
                into[i] = into.get(i, 0.0) + term
                sizes[run, i] = sizes.get((run, i), 0.0) + abs(term)
    for run in list(sums):
        sums[run] = {i: d for i, d in sums[run].items() if not abs(d) <= _ROUNDING * sizes[run, i] < math.inf}
        if not sums[run]:
            del sums[run]
        elif len(sums[run]) > 1 and run.covariance is None:
            raise Error(_UNKNOWN)
    return sums


def standard_error(gradient: Gradient) -> float:
    """To first order. Runs are independent."""
    errors = []
    for run, parts in gradient.items():
        if len(parts) == 1:
            ((i, derivative),) = parts.items()
            errors.append(abs(derivative) * float(run.standard_error[i]))
        else:
            variance = run.between(parts, parts)
            errors.append(variance if math.isnan(variance) else math.sqrt(max(variance, 0.0)))
    return math.hypot(*errors)


def covariance(a: Gradient, b: Gradient) -> float:
    """Of two values, to first order."""
    return math.fsum(run.between(parts, b[run]) for run, parts in a.items() if run in b)


def shared_seed(gradient: Gradient) -> int | None:
    """The seed of two different runs, whose random numbers are the same; None where there is no such pair."""
    seen: set[int] = set()
    for run in gradient:
        if run.seed in seen:
            return run.seed
        if run.seed is not None:
            seen.add(run.seed)
    return None
