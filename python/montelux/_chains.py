"""Metropolis-Hastings: samples of a density that is known up to a constant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Error
from ._result import Array


@dataclass(frozen=True)
class Chains:
    """States of Markov chains, and what they say of the means of observables.

    The means and what follows have one entry an observable, shape (m,).
    """

    mean: Array
    #: Knows the autocorrelation of the chains.
    standard_error: Array
    #: Of a single state.
    variance: Array
    #: Variance of the mean times the number of states, over the variance of a state.
    autocorrelation_time: Array
    effective_sample_size: Array
    #: Split R-hat: 1 when halves of chains agree as draws of one density do.
    r_hat: Array
    acceptance_rate: float
    #: Of the density.
    evaluations: int
    #: Densities that were NaN or +infinity, and were rejected.
    non_finite: int
    #: Reasons to doubt the means, as sentences.
    doubts: tuple[str, ...]
    #: Every `thin`-th state after the burn-in, shape (chains, states, d).
    states: Array


def metropolis(
    log_density: Callable[[Array], float],
    starts: npt.ArrayLike,
    observables: Callable[[Array], Any] | None = None,
    *,
    chains: int = 4,
    samples: int = 20000,
    burn_in: int = 2000,
    thin: int = 1,
    seed: int = 0,
    step: float = 0.0,
    scale: Sequence[float] = (),
    adapt: bool = True,
) -> Chains:
    """Chains of random walks whose states follow a density that is known up to a constant.

    log_density(x) takes one point, shape (d,), and returns the logarithm, -inf where the density is zero.
    observables(x) returns the number or the numbers whose means over the density are wanted; without it the
    coordinates are. starts: one point for all chains, shape (d,), or one for each, shape (chains, d); where
    they are spread widely R-hat has something to say.

    The walk y = x + step * scale * z, z standard normal, adapts step and scale during the burn-in, unless told
    not to; step 0: 2.38 / sqrt(d). `samples` is the number of states of each chain after it.
    """
    points = np.atleast_2d(np.asarray(starts, dtype=float))
    if points.ndim != 2:
        raise Error(f"metropolis: starts of shape {points.shape} were given; expected (d,) or (chains, d)")
    count = points.shape[1] if observables is None else np.size(observables(points[0].copy()))
    d = _core.metropolis(
        log_density,
        points.tolist(),
        observables,
        count,
        step,
        [float(s) for s in scale],
        adapt,
        chains,
        burn_in,
        samples,
        thin,
        seed,
    )
    d["doubts"] = tuple(d["doubts"])
    return Chains(**d)
