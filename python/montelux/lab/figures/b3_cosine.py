"""B3: the cosine, in the plane with a uniform second coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def cosine() -> Outcome:
    """1500 points (asin xi_1, xi_2) to draw, 100 000 to measure."""
    law = montelux.Distribution.cosine()
    u = montelux.points("independent", 100_000, 2, seed=5)
    x, y = law.sample(u[:, 0]), u[:, 1]
    numbers = [
        Number("X(ξ) and asin ξ, farthest apart", np.abs(x - np.arcsin(u[:, 0])).max(), 1e-15, 0, bound=True),
        mean_of("mean of x", x, np.pi / 2 - 1, "π/2 − 1"),
        mean_of("mean of xy", x * y, (np.pi / 2 - 1) / 2, "(π/2 − 1)/2"),
        mean_of("mean of sin x", np.sin(x), 0.5, "1/2"),
    ]
    return Outcome(numbers, {"x": x, "y": y, "law": law})


def draw_cosine(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplot_mosaic([["top"], ["plane"]], height_ratios=[1, 2.2], sharex=True)
    panels["top"].hist(s["x"], bins=40, range=(0, np.pi / 2), density=True, color=theme.blue, alpha=0.5)
    t = np.linspace(0, np.pi / 2, 200)
    panels["top"].plot(t, s["law"].pdf(t), color=theme.ink)
    panels["top"].set(ylabel="density", ylim=(0, 1.15))
    a = panels["plane"]
    a.plot(s["x"][:1500], s["y"][:1500], "o", markersize=2.6, color=theme.blue, markeredgewidth=0)
    a.set(
        xlabel="x",
        ylabel="y",
        xlim=(0, np.pi / 2),
        ylim=(0, 1),
        xticks=[0, np.pi / 4, np.pi / 2],
        xticklabels=["0", "π/4", "π/2"],
        yticks=[0, 1],
    )


FIGURES = (
    Figure(
        "B3",
        "cosine",
        "The cosine",
        "The points crowd where the cosine is high, at the left, and thin out towards π/2; the second coordinate is"
        " uniform and independent. Above, the histogram of x on the density cos x.",
        (r"p(x, y) = \cos x, \qquad X = \arcsin \xi_1, \qquad Y = \xi_2",),
        cosine,
        draw_cosine,
        5.6,
        "Points that are dense at the left and rare at the right, with the histogram of x above",
    ),
)
