"""B8: points on shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import montelux

from .._figure import Figure, Outcome
from .._number import mean_of
from ..shapes import SHAPES, bare, project

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def geometry() -> Outcome:
    """Points of each shape, and the mean of a quantity whose exact mean is known."""
    numbers, points = [], {}
    for shape in SHAPES:
        x = shape.warp.sample(montelux.points("independent", 50_000, 2, seed=9))
        numbers.append(mean_of(f"{shape.name}: mean of {shape.quantity}", shape.value(x), shape.mean, shape.mean_text))
        points[shape.name] = shape.warp.sample(montelux.points("sobol", 512, 2, "scramble", seed=2))
    return Outcome(numbers, {"points": points})


def draw_geometry(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(3, 4)
    for a, shape in zip(panels.flat, SHAPES):
        bare(a, theme, shape)
        p, front = project(shape, s["points"][shape.name])
        a.plot(*p[~front].T, "o", markersize=2, color=theme.faint, alpha=0.5, markeredgewidth=0)
        a.plot(*p[front].T, "o", markersize=2.4, color=theme.blue, markeredgewidth=0)


FIGURES = (
    Figure(
        "B8",
        "geometry",
        "Points on shapes",
        "512 points of a scrambled Sobol' set, carried to each shape: even in the square, they are even there. Only two"
        " of the densities are not uniform: the cosine-weighted hemisphere, which is denser at its pole, and the"
        " bilinear square, denser at one corner (points behind a sphere are grey).",
        (
            (
                r"\mathrm{triangle:}\ \ b = (1 - \sqrt{\xi_1},\ \xi_2 \sqrt{\xi_1}), \qquad \mathrm{disc:}\ \ r = R"
                r" \sqrt{\xi_1}"
            ),
            r"\mathrm{sphere:}\ \ z = 1 - 2 \xi_1, \qquad \mathrm{cosine\ hemisphere:}\ \ z = \sqrt{1 - r^2}",
        ),
        geometry,
        draw_geometry,
        7.6,
        "Twelve panels of points on discs, triangles, spheres and parts of spheres",
    ),
)
