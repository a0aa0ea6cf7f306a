"""B7: several variables: a marginal density, then a conditional one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of, of, share_of

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


ROWS, COLUMNS = 24, 32


def bumps(p):  # type: ignore[no-untyped-def]
    """Two hills on a plain, on the unit square."""
    x, y = p[:, 0], p[:, 1]
    high = np.exp(-40 * ((x - 0.3) ** 2 + (y - 0.65) ** 2))
    ridge = np.exp(-60 * (x - 0.7) ** 2) * y
    return 0.03 + high + 0.6 * ridge


def tabulated() -> Outcome:
    """A table of the hills as a density, and their volume by points of it."""
    x, y = (np.arange(COLUMNS) + 0.5) / COLUMNS, (np.arange(ROWS) + 0.5) / ROWS
    middles = np.stack(np.meshgrid(x, y), axis=-1)
    table = bumps(middles.reshape(-1, 2)).reshape(ROWS, COLUMNS)
    density = montelux.warp.tabulated(table)
    of_middles = density.pdf(middles)
    apart = np.abs(of_middles / (table / table.mean()) - 1).max()
    u = montelux.points("independent", 100_000, 2, seed=7)
    points = density.sample(u)
    back = np.abs(density.inverse(points) - u).max()
    numbers = [
        Number("density over the table's values, farthest from 1", apart, 1e-6, 0, bound=True),
        Number("there and back, farthest", back, 1e-8, 0, bound=True),
    ]
    inside = np.all(np.abs(middles - np.array([0.3, 0.65])) < np.array([0.175, 0.15]), axis=-1)
    column, row = np.floor(points[:, 0] * COLUMNS).astype(int), np.floor(points[:, 1] * ROWS).astype(int)
    hill = inside[row, column]
    numbers.append(share_of("share on the hill", int(hill.sum()), len(points), table[inside].sum() / table.sum()))
    ridge = row >= ROWS // 2
    share = table[ROWS // 2 :].sum() / table.sum()
    numbers.append(share_of("share of the upper half", int(ridge.sum()), len(points), share))

    def erf_integral(a, b, c, k):  # type: ignore[no-untyped-def]
        """The integral of exp(-k (x - c)^2) over [a, b], by the normal law."""
        law = montelux.Distribution.normal(c, np.sqrt(0.5 / k))
        return (law.cdf(b) - law.cdf(a)) * np.sqrt(np.pi / k)

    exact = 0.03 + erf_integral(0, 1, 0.3, 40) * erf_integral(0, 1, 0.65, 40) + 0.6 * erf_integral(0, 1, 0.7, 60) / 2
    technique = montelux.Technique.functions(2, 2, sample=density.sample, density=density.pdf)
    square = [(0, 1), (0, 1)]
    plain = montelux.integrate(bumps, square, "basic", evaluations=100_000, seed=9)
    by_table = montelux.integrate(bumps, square, "importance", technique=technique, evaluations=100_000, seed=9)
    numbers.append(of("∫ f, uniform points", plain, exact))
    numbers.append(of("∫ f, points of the table", by_table, exact))
    return Outcome(numbers, {"table": table, "points": points, "marginal": table.mean(axis=1) / table.mean()})


def draw_tabulated(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplot_mosaic([["table", "side", "points"]], width_ratios=[2, 0.8, 2])
    a, side, b = panels["table"], panels["side"], panels["points"]
    shown = dict(origin="lower", extent=(0, 1, 0, 1), aspect="auto", cmap=theme.map, interpolation="nearest")
    a.imshow(s["table"], **shown)
    a.set(title="table", xticks=[0, 1], yticks=[0, 1], xlabel="x", ylabel="y")
    side.hist(
        s["points"][:, 1], bins=ROWS, range=(0, 1), density=True, orientation="horizontal", color=theme.blue, alpha=0.5
    )
    side.step(
        np.concatenate((s["marginal"][:1], s["marginal"])), np.arange(ROWS + 1) / ROWS, where="post", color=theme.ink
    )
    side.set(ylim=(0, 1), yticks=[], title="rows", xlim=(0, None))
    x, y = s["points"][:3000].T
    b.plot(x, y, "o", markersize=2.2, color=theme.blue, markeredgewidth=0)
    b.set(title="3000 points", xlabel="x", xlim=(0, 1), ylim=(0, 1), xticks=[0, 1], yticks=[0, 1])


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
    Figure(
        "B7",
        "tabulated",
        "A table of two variables",
        "The sums of the rows select a row, the sums along that row a cell; within it points are uniform. Points"
        " gather where the function is high, and their weights correct for its variation within the cells: the"
        " integral is unbiased, with a far smaller error than that of uniform points.",
        (
            r"p(y) = \frac{\sum_j f_{ij}}{\sum_{ij} f_{ij}}\,n_y, \qquad p(x \mid y) ="
            r" \frac{f_{ij}}{\sum_j f_{ij}}\,n_x",
        ),
        tabulated,
        draw_tabulated,
        4.4,
        "A table as a picture, the histogram of the rows and three thousand points drawn from it",
        helpers=(bumps,),
    ),
)
