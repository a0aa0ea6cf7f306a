"""The figures, row by row of docs/mission.md."""

from __future__ import annotations

from collections.abc import Iterable

import montelux
from montelux._names import unknown

from .._figure import Figure
from . import (
    a1_grids,
    a2_basic,
    a3_general,
    a4_importance,
    a5_stratified,
    a6_point_sets,
    a6_convergence,
    a7_multiple,
    a8_metropolis,
    a9_errors,
    b1_discrete,
    b2_exponential,
    b3_cosine,
    b4_linear,
    b5_quadratic,
    b6_inversion,
    b7_several,
    b8_geometry,
    b9_warped_grids,
    c4_ggx,
    c5_plates,
    c6_environment,
    c6_variance,
    c7_split_sum,
    c8_filters,
    c8_lens,
    c9_visible,
    c10_pyramid,
    c10_guides,
    c10_chains,
    c10_methods,
)

_MODULES = (
    a1_grids,
    a2_basic,
    a3_general,
    a4_importance,
    a5_stratified,
    a6_point_sets,
    a6_convergence,
    a7_multiple,
    a8_metropolis,
    a9_errors,
    b1_discrete,
    b2_exponential,
    b3_cosine,
    b4_linear,
    b5_quadratic,
    b6_inversion,
    b7_several,
    b8_geometry,
    b9_warped_grids,
    c4_ggx,
    c5_plates,
    c6_environment,
    c6_variance,
    c7_split_sum,
    c8_filters,
    c8_lens,
    c9_visible,
    c10_pyramid,
    c10_guides,
    c10_chains,
    c10_methods,
)


def all_figures() -> list[Figure]:
    return [figure for module in _MODULES for figure in module.FIGURES]


def chosen_figures(names: Iterable[str]) -> list[Figure]:
    """The figures of these rows ('A4') and keys ('A4-race'), several with commas, in the order of the report."""
    figures = all_figures()
    wanted = [name.strip() for given in names for name in given.split(",")]
    known = list(dict.fromkeys([f.row for f in figures] + [f.key for f in figures]))
    lower = {name.lower(): name for name in known}
    for name in wanted:
        if name.lower() not in lower:
            raise montelux.Error(unknown("figure", name, known))
    chosen = {lower[name.lower()] for name in wanted}
    return [f for f in figures if f.row in chosen or f.key in chosen]
