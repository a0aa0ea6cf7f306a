"""B9: a density as a change of area."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._figure import Figure, Outcome
from .._number import Number
from ..marks import MARKERS, grid
from ..shapes import SHAPES, bare, mean_of_inverse_density, measured_areas, project

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def warped() -> Outcome:
    """The areas of the 64 images of the cells of a grid, beside the mean of 1/p in each cell."""
    numbers, areas = [], {}
    for shape in SHAPES:
        area, area_error = measured_areas(shape)
        inverse, inverse_error = mean_of_inverse_density(shape)
        difference = np.abs(area - inverse)
        worst = np.unravel_index(np.argmax(difference / (area_error + inverse_error)), area.shape)
        numbers.append(
            Number(
                f"{shape.name}: worst cell",
                area[worst],
                float((1.5 * (area_error + inverse_error))[worst]),
                inverse[worst],
                bound=True,
                formula="mean of 1/p",
            )
        )
        if shape.measure is not None:
            numbers.append(
                Number(
                    f"{shape.name}: all cells", area.mean(), 1.5 * float(area_error.mean()), shape.measure, bound=True
                )
            )
        areas[shape.name] = (area, inverse)
    return Outcome(numbers, {"areas": areas})


def draw_warped(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(3, 4)
    t = np.clip(np.linspace(0, 1, 121), 0, np.nextafter(1.0, 0.0))
    for a, shape in zip(panels.flat, SHAPES):
        bare(a, theme, shape)
        for k in np.clip(np.linspace(0, 1, 9), 0, np.nextafter(1.0, 0.0)):
            for across, colour in ((False, theme.blue), (True, theme.orange)):
                u = np.stack([t, np.full_like(t, k)][:: -1 if across else 1], axis=1)
                p, front = project(shape, shape.warp.sample(u))
                # Lines that jump from one side of the image to the other are broken there.
                jump = np.concatenate(([False], np.hypot(*np.diff(p, axis=0).T) > 0.5))
                hidden = np.where((~front | jump)[:, None], np.nan, p)
                a.plot(*np.where((front | jump)[:, None], np.nan, p).T, color=theme.faint, linewidth=0.6, alpha=0.6)
                a.plot(*hidden.T, color=colour, linewidth=1.1)


def draw_areas(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a = figure.subplots()
    for i, shape in enumerate(SHAPES):
        area, inverse = s["areas"][shape.name]
        a.loglog(
            inverse.ravel(),
            area.ravel(),
            MARKERS[i % 8],
            color=theme.cycle[i % 6],
            label=shape.name,
            markerfacecolor="none",
            markersize=7,
        )
    ends = np.array([0.3, 20])
    a.loglog(ends, ends, color=theme.ink, linewidth=1, zorder=0)
    a.set(xlabel="mean of 1/p in a cell", ylabel="area of its image × 64", xlim=(0.3, 20), ylim=(0.3, 20))
    grid(a, theme)
    figure.legend(*a.get_legend_handles_labels(), loc="outside right center", fontsize="small")


def areas() -> Outcome:
    """The same, cell by cell."""
    found = warped()
    # Of those whose density does not fall to zero at an edge, where 1/p is infinite.
    uniform = [found.series["areas"][shape.name] for shape in SHAPES if shape.measure is not None]
    worst = max(float(np.abs(area / inverse - 1).max()) for area, inverse in uniform)
    return Outcome([Number("uniform densities: area × p, farthest from 1", worst, 1e-3, 0, bound=True)], found.series)


FIGURES = (
    Figure(
        "B9",
        "grids",
        "Density is change of area",
        "The 8 by 8 grid of the unit square, mapped by each warp. Where the cells of the image are small the density"
        " is high: the area of a cell times the number of cells is 1/p.",
        (
            (
                r"\frac{1}{p(x)} = \left| \frac{\partial x}{\partial \xi} \right| = \lim"
                r" \frac{\mathrm{area\ of\ the\ image}}{\mathrm{area\ of\ the\ cell}}"
            ),
        ),
        warped,
        draw_warped,
        7.6,
        "Twelve panels of curved grids",
    ),
    Figure(
        "B9",
        "areas",
        "Areas of cells against 1/p",
        "Each mark is a cell of one warp: its measured area against the mean of 1/p over it. All lie on the diagonal;"
        " those of a uniform density coincide.",
        (),
        areas,
        draw_areas,
        5.2,
        "Marks of the cells of twelve warps on the diagonal",
        (warped,),
    ),
)
