"""B4: the linear density, on the unit interval and restricted to [2, 4)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def linear() -> Outcome:
    """p = 2v on [0, 1) and its restriction of the same recipe to [2, 4)."""
    u = montelux.points("independent", 100_000, 2, seed=6)
    xi, y = u[:, 0], u[:, 1]
    unit, range24 = montelux.Distribution.linear(0, 1), montelux.Distribution.linear(2, 4)
    restricted = montelux.Distribution.linear(0, 8).truncated(2, 4)  # the same law, from a wider one
    x, v = unit.sample(xi), range24.sample(xi)
    t = np.linspace(2, 4, 101)
    numbers = [
        Number("X and √ξ, farthest apart", np.abs(x - np.sqrt(xi)).max(), 1e-15, 0, bound=True),
        Number("X on [2, 4) and 2 √(3ξ + 1)", np.abs(v - 2 * np.sqrt(3 * xi + 1)).max(), 4e-15, 0, bound=True),
        Number("P on [2, 4) and (v² − 4)/12", np.abs(range24.cdf(t) - (t**2 - 4) / 12).max(), 1e-15, 0, bound=True),
        Number(
            "the same, restricted from [0, 8)", np.abs(restricted.cdf(t) - (t**2 - 4) / 12).max(), 1e-14, 0, bound=True
        ),
        mean_of("mean on [0, 1)", x, 2 / 3, "2/3"),
        mean_of("mean on [2, 4)", v, 28 / 9, "28/9"),
    ]
    return Outcome(numbers, {"x": x, "v": v, "y": y, "unit": unit, "range": range24})


def draw_linear(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(2, 2, height_ratios=[1, 1.8], sharex="col")
    for i, (points, law, ends) in enumerate(((s["x"], s["unit"], (0, 1)), (s["v"], s["range"], (2, 4)))):
        top, plane = panels[0, i], panels[1, i]
        t = np.linspace(*ends, 100)
        top.hist(points, bins=30, range=ends, density=True, color=theme.cycle[i], alpha=0.5)
        top.plot(t, law.pdf(t), color=theme.ink)
        top.set_title((r"$X = \sqrt{\xi}$", r"$X = 2\,\sqrt{3 \xi + 1}$")[i])
        top.set_ylim(0, None)
        plane.plot(points[:1200], s["y"][:1200], "o", markersize=2.6, color=theme.cycle[i], markeredgewidth=0)
        plane.set(xlabel=("x", "v")[i], xlim=ends, ylim=(0, 1), yticks=[0, 1])
    panels[0, 0].set_ylabel("density")
    panels[1, 0].set_ylabel("y")


FIGURES = (
    Figure(
        "B4",
        "linear",
        "The square root, and its restriction to [2, 4)",
        "A square root makes the density rise in proportion to x. Restricted to [2, 4) the same recipe subtracts the"
        " part of P that lies below 2 and divides by what remains, c = 12: there it grows by a factor of two alone.",
        (
            r"p(v) = 2v \ \mathrm{on}\ [0, 1):\quad X = \sqrt{\xi}",
            r"v \in [2, 4):\quad c = 12, \quad P(v) = \frac{v^2 - 4}{12}, \quad X = 2\,\sqrt{3 \xi + 1}",
        ),
        linear,
        draw_linear,
        5.4,
        "Points and histograms of the linear density on the unit interval and on two to four",
    ),
)
