"""Metropolis-Hastings: samples of a density that is known up to a constant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Error
from ._names import UnknownAttribute, is_number, is_whole, unknown
from ._result import Array


@dataclass(frozen=True, repr=False, eq=False)
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
    #: Reasons why the means may be wrong, as sentences.
    warnings: tuple[str, ...]
    #: Every `thin`-th state after the burn-in, shape (chains, states, d).
    states: Array

    def __repr__(self) -> str:
        lines = [f"{m:.6g} +- {e:.2g}, R-hat {r:.4f}" for m, e, r in zip(self.mean, self.standard_error, self.r_hat)]
        chains, states, _ = self.states.shape
        lines.append(f"{chains} chains of {states} states, {100 * self.acceptance_rate:.0f} % accepted")
        return "\n".join([*lines, *(f"warning: {warning}" for warning in self.warnings)])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise UnknownAttribute(unknown("attribute of Chains", name, type(self).__dataclass_fields__))


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
    coordinates are. starts: one point for all chains, shape (d,), or one for each, shape (chains, d); R-hat
    is informative if they are spread widely.

    The walk y = x + step * scale * z, z standard normal, adapts step and scale during the burn-in, unless
    switched off; step 0: 2.38 / sqrt(d). `samples` is the number of states of each chain after it.
    """
    for name, number, least in (
        ("chains", chains, 1),
        ("samples", samples, 8),
        ("burn_in", burn_in, 0),
        ("thin", thin, 1),
        ("seed", seed, 0),
    ):
        if not (is_whole(number) and least <= number < 2**63):
            raise Error(f"metropolis: {name}={number!r} was given; expected a whole number, at least {least}")
    if not (is_number(step) and 0 <= step < float("inf")):
        raise Error(f"metropolis: step={step!r} was given; expected a number that is not negative")
    try:
        points = np.atleast_2d(np.asarray(starts, dtype=float))
    except (TypeError, ValueError):
        raise Error(f"metropolis: starts={starts!r} was given; expected numbers, (d,) or (chains, d)") from None
    if points.ndim != 2:
        raise Error(f"metropolis: starts of shape {points.shape} were given; expected (d,) or (chains, d)")
    if len(points) not in (1, chains):
        raise Error(f"metropolis: {len(points)} starts were given for {chains} chains; expected one, or one for each")
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
    d["warnings"] = tuple(d["warnings"])
    return Chains(**d)
