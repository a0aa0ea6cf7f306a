"""Draws from a density that is known up to a constant, by chains and ensembles, with their diagnostics."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._c_functions import Integrand
from ._core import Error
from ._integrand_forms import ArrayMaker, prepared
from ._names import MOST_THREADS, UnknownAttribute, is_whole, unknown
from ._regions import Ranges, as_region
from ._result import Array


@dataclass(frozen=True, repr=False, eq=False)
class Draws:
    """Draws of Markov chains, and what they say of each variable.

    The means and what follows have one entry a variable, shape (d,). R-hat and the effective sizes are those of
    Vehtari, Gelman, Simpson, Carpenter and Buerkner 2021, as ArviZ computes them; effective sizes and errors of
    ensembles know that walkers depend on one another.
    """

    #: Shape (chains, n, d); of ensembles each walker is a chain, one ensemble after the other.
    states: Array
    #: Of the variables; empty where none were given.
    names: tuple[str, ...]
    mean: Array
    #: Of the mean; it knows the autocorrelation.
    standard_error: Array
    #: Of a single draw.
    standard_deviation: Array
    #: 1 when halves of chains agree as draws of one density do; at most 1.01 is expected.
    r_hat: Array
    #: Independent draws that would tell as much of the centre of the distribution.
    bulk_effective_size: Array
    #: The same for its 5 % and 95 % quantiles, the smaller one.
    tail_effective_size: Array
    acceptance_rate: float
    #: Of the density.
    evaluations: int
    #: Log densities that were NaN or +infinity, and were taken for -infinity.
    non_finite: int
    #: Reasons why the draws may not follow the density, as sentences.
    warnings: tuple[str, ...]

    @property
    def posterior(self) -> dict[str, Array]:
        """The draws by variable, each of shape (chain, draw), for `arviz.from_dict(posterior=draws.posterior)`.

        Without names one variable "x", of shape (chain, draw, d) for more than one dimension.
        """
        if self.names:
            return {name: self.states[:, :, k] for k, name in enumerate(self.names)}
        return {"x": self.states[:, :, 0] if self.states.shape[2] == 1 else self.states}

    def __repr__(self) -> str:
        names = self.names or tuple(f"x{k + 1}" for k in range(len(self.mean)))
        lines = [
            f"{name}: {m:.6g} +- {e:.2g}, R-hat {r:.4f}, effective size {b:.0f} (bulk), {t:.0f} (tail)"
            for name, m, e, r, b, t in zip(
                names, self.mean, self.standard_error, self.r_hat, self.bulk_effective_size, self.tail_effective_size
            )
        ]
        chains, draws, _ = self.states.shape
        lines.append(f"{chains} chains of {draws} draws, {self.evaluations} evaluations")
        return "\n".join([*lines, *(f"warning: {warning}" for warning in self.warnings)])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        raise UnknownAttribute(unknown("attribute of Draws", name, [*type(self).__dataclass_fields__, "posterior"]))


def sample(
    log_density: Integrand,
    domain: Ranges,
    n: int = 1024,
    *,
    sampler: str = "metropolis",
    chains: int = 4,
    walkers: int | None = None,
    burn_in: int = 2000,
    thin: int = 1,
    seed: int = 0,
    starts: npt.ArrayLike | None = None,
    names: Iterable[str] = (),
    threads: int = 1,
    workers: int = 1,
    batch: bool = True,
    array: ArrayMaker | None = None,
) -> Draws:
    """n draws of each chain whose density over a domain is proportional to exp(log_density).

        >>> draws = montelux.sample(lambda x: -(x**2) / 2, (-np.inf, np.inf), sampler="slice")
        >>> idata = arviz.from_dict(posterior=draws.posterior)

    log_density is a function as integrate() takes it, of many points x of shape (n, d), or (n,) for a single range:
    with `batch=False` of one point, with `array` of another library's array, or a C function (numba, ctypes, scipy).
    It returns logarithms; -inf is a density of zero. domain: ranges, whose ends may be infinite.

    sampler: 'metropolis', random walks that adapt during the burn-in, one point a call; 'ensemble', walkers that
    stretch towards one another (Goodman and Weare 2010); 'slice', walkers that slice along one another's differences
    (Karamanis and Beutler 2021): about five evaluations for a draw that depends far less on the last one. Ensembles
    take any linear correlation and scale, and call log_density with half of their walkers at once.

    chains: independent chains, or ensembles of `walkers` each (by default 2 (d + 1), at least 8). Each of them drops
    `burn_in` states, then keeps every `thin`-th. starts: one point, one for each chain, or one for each walker; by
    default they are drawn by their density from random points of the domain. names: of the variables, for `posterior`
    and `warnings`.

    The draws depend on the seed and not on `threads` or `workers`.
    """
    region = as_region(domain)
    if not isinstance(sampler, str) or sampler not in _core.chain_samplers():
        raise Error("sampler: " + unknown("sampler", str(sampler), _core.chain_samplers()))
    for name, number, least, below in (
        ("n", n, 8, 2**40),
        ("chains", chains, 1, 10001),
        ("walkers", 0 if walkers is None else walkers, 0 if walkers is None else 1, 100001),
        ("burn_in", burn_in, 0, 2**60),
        ("thin", thin, 1, 2**32),
        ("seed", seed, 0, 2**64),
        ("threads", threads, 0, MOST_THREADS + 1),
        ("workers", workers, 0, MOST_THREADS + 1),
    ):
        if not (is_whole(number) and least <= number < below):
            raise Error(f"{name}: {number!r} was given; expected a whole number from {least} to {below - 1}")
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise Error(f"names: {names!r} was given; expected a name for each variable, as ['mass', 'width']")
    names = tuple(names)
    if not all(isinstance(name, str) for name in names):
        raise Error(f"names: {list(names)!r} was given; expected a name for each variable, as ['mass', 'width']")
    if len(set(names)) != len(names):
        raise Error(f"names: {list(names)!r} was given; expected names that differ")
    if reserved := {"chain", "draw"} & set(names):
        raise Error(f"names: {reserved.pop()!r} is the name of a dimension of the draws; expected another one")
    with prepared(log_density, region, batch, False, array, int(threads), int(workers), 0) as integrand:
        made = _core.sample_chains(
            integrand.function,
            region.domain,
            sampler,
            int(chains),
            0 if walkers is None else int(walkers),
            int(n),
            int(burn_in),
            int(thin),
            int(seed),
            _starts(starts, region.domain.dimensions),
            list(names),
            integrand.threads,
        )
    made["warnings"] = tuple(made["warnings"])
    return Draws(names=tuple(names), **made)


def _starts(starts: npt.ArrayLike | None, dimensions: int) -> list[list[float]]:
    if starts is None:
        return []
    try:
        points = np.asarray(starts, dtype=float)
    except (TypeError, ValueError):
        raise Error(f"starts: {starts!r} was given; expected numbers, of shape (d,) or (chains, d)") from None
    if points.size == 0:
        raise Error("starts: no point was given; expected shape (d,) or (chains, d), or None")
    if points.ndim == 0 or (points.ndim == 1 and dimensions == 1):
        points = points.reshape(-1, 1)
    points = np.atleast_2d(points)
    if points.ndim != 2 or points.shape[1] != dimensions:
        raise Error(f"starts: an array of shape {points.shape} was given; expected (d,) or (chains, d) with d={dimensions}")
    rows: list[list[float]] = points.tolist()
    return rows
