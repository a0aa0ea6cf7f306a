"""B7: several variables: a marginal density, then a conditional one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def several() -> Outcome:
    """p(x, y) = x + y on the square: y first by its marginal density, then x by its conditional one."""
    joint = montelux.warp.bilinear([0, 1, 1, 2])  # the values of x + y at the corners
    marginal = montelux.warp.linear(0.5, 1.5)
    u = montelux.points("independent", 100_000, 2, seed=8)
    points = joint.sample(u)
    x, y = points.T
    grid = np.stack(np.meshgrid(np.linspace(0.02, 0.98, 25), np.linspace(0.02, 0.98, 25)), axis=-1).reshape(-1, 2)
    # Integrated over x the joint density is the marginal one.
    rows = []
    for v in (0.25, 0.75):

        def along(t, v=v):  # type: ignore[no-untyped-def]
            return joint.pdf(np.stack([t, np.full_like(t, v)], axis=1))

        rows.append(montelux.integrate(along, (0, 1), "midpoint", cells=64).value)
    numbers = [
        Number("density, farthest from x + y", np.abs(joint.pdf(grid) - grid.sum(axis=1)).max(), 1e-14, 0, bound=True),
        Number("marginal at 0.25", rows[0], 1e-12, float(marginal.pdf(np.array([0.25]))[0]), bound=True, formula="3/4"),
        Number("marginal at 0.75", rows[1], 1e-12, float(marginal.pdf(np.array([0.75]))[0]), bound=True, formula="5/4"),
        mean_of("mean of x", x, 7 / 12, "7/12"),
        mean_of("mean of y", y, 7 / 12, "7/12"),
        mean_of("mean of xy", x * y, 1 / 3, "1/3"),
    ]
    # Independent factors: the density of the product is the product of the densities.
    factors = [
        montelux.Distribution.exponential(1.0),
        montelux.Distribution.cosine(),
        montelux.Distribution.linear(0, 1),
    ]
    r = montelux.integrate(
        lambda v: np.exp(-v[:, 0]) * np.cos(v[:, 1]) * v[:, 2] ** 2,
        [(0, np.inf), (0, np.pi / 2), (0, 1)],
        "importance",
        technique=factors,
        evaluations=100_000,
        seed=3,
    )
    numbers.append(Number("∫ e⁻ˣ cos y z², three factors", r.value, r.standard_error, 1 / 3, formula="1/3"))
    return Outcome(numbers, {"points": points, "marginal": marginal, "joint": joint})


def draw_several(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplot_mosaic([["plane", "side", "slices"]], width_ratios=[2, 1, 2])
    a, side, slices = panels["plane"], panels["side"], panels["slices"]
    x, y = s["points"].T
    for level in (0.25, 0.75):
        a.axhspan(
            level - 0.03, level + 0.03, color=theme.orange if level > 0.5 else theme.green, alpha=0.3, linewidth=0
        )
    a.plot(x[:2000], y[:2000], "o", markersize=2.4, color=theme.blue, markeredgewidth=0)
    a.set(xlabel="x", ylabel="y", xlim=(0, 1), ylim=(0, 1), xticks=[0, 1], yticks=[0, 1], title="p = x + y")
    t = np.linspace(0, 1, 100)
    side.hist(y, bins=25, range=(0, 1), density=True, orientation="horizontal", color=theme.blue, alpha=0.5)
    side.plot(s["marginal"].pdf(t), t, color=theme.ink)
    side.set(ylim=(0, 1), yticks=[], title="p(y)", xticks=[0, 1])
    for level, colour, stroke in ((0.75, theme.orange, "-"), (0.25, theme.green, (0, (5, 2)))):
        near = np.abs(y - level) < 0.03
        slices.hist(x[near], bins=20, range=(0, 1), density=True, histtype="step", color=colour, linewidth=1.5)
        slices.plot(t, (t + level) / (0.5 + level), color=colour, linestyle=stroke, label=f"p(x | y = {level})")
    slices.set(xlabel="x", ylim=(0, 2.6), xlim=(0, 1), title="conditional")
    slices.legend(loc="upper left")


FIGURES = (
    Figure(
        "B7",
        "several",
        "Several variables",
        "One coordinate is drawn from the marginal density, the other from the density along its line, which differs"
        " from line to line. The points of two bands have the histograms of their own conditional densities.",
        (r"p(y) = \int p(x, y)\,dx, \qquad p(x \mid y) = \frac{p(x, y)}{p(y)}",),
        several,
        draw_several,
        4.2,
        "Points of the density x plus y, the histogram of y, and histograms of x in two bands",
    ),
)
