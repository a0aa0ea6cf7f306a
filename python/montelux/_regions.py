"""Domains as callers give them, and the shape of the points that functions get."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple, Union

import numpy as np

from ._core import Domain, Error
from ._result import Array

Ranges = Union[Domain, Sequence[float], Sequence[Sequence[float]]]


class Region(NamedTuple):
    """A domain, and whether it was given as a list of ranges: a point of one variable then has one coordinate."""

    domain: Domain
    is_list: bool

    def shape(self, n: int) -> tuple[int, ...]:
        """The shape of n points."""
        d = self.domain.dimensions
        return (n, d) if d > 1 or self.is_list else (n,)


def as_region(domain: Ranges) -> Region:
    """From a Domain, ranges (lower, upper), one per variable, or a single range."""
    if isinstance(domain, Domain):
        return Region(domain, False)
    try:
        ranges = np.asarray(domain, dtype=float)
    except (TypeError, ValueError):
        raise Error(f"domain: {domain!r} was given; expected ranges (lower, upper), one per variable") from None
    is_list = ranges.shape != (2,)
    if not is_list:
        ranges = ranges.reshape(1, 2)
    if ranges.ndim != 2 or ranges.shape[1] != 2 or len(ranges) == 0:
        raise Error(
            f"domain: an array of shape {ranges.shape} was given; expected ranges (lower, upper), one per variable"
        )
    return Region(Domain.box([(float(a), float(b)) for a, b in ranges]), is_list)


def with_points_of(region: Region | None, f: Callable[..., Any]) -> Callable[..., Any]:
    """f for the library, which gives points of one variable as shape (n,). It pickles if f does."""
    if region is None or region.domain.dimensions > 1 or not region.is_list or not callable(f):
        return f
    return partial(_of_column, f)


def _of_column(f: Callable[..., Any], x: Array, *y: Array) -> Any:
    return f(x.reshape(-1, 1), *y)
