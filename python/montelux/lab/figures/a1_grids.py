"""A1: sums on grids, and what they cost in many variables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..marks import MARKERS, grid

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

RULES = {"riemann": "left Riemann sum", "midpoint": "midpoint rule", "trapezoid": "trapezoid rule"}


def riemann() -> Outcome:
    """The integral of sin x over [0, pi/2], which is 1, by three rules of eight cells; then with ever more cells."""
    quarter = (0, np.pi / 2)
    h = quarter[1] / 8
    # The sums of the sine at equidistant points, in closed form.
    exact = {
        "riemann": h * np.sin(7 * h / 2) * np.sin(4 * h) / np.sin(h / 2),
        "midpoint": h * np.sin(4 * h) ** 2 / np.sin(h / 2),
        "trapezoid": h / 2 / np.tan(h / 2),
    }
    numbers, errors = [], {}
    cells = 2 ** np.arange(1, 11)
    for method, name in RULES.items():
        eight = montelux.integrate(np.sin, quarter, method, cells=8)
        numbers.append(Number(f"{name}, 8 cells", eight.value, 1e-14, exact[method], bound=True))
        error = np.array([abs(montelux.integrate(np.sin, quarter, method, cells=int(n)).value - 1) for n in cells])
        errors[method] = error
        # Between the last two grids; grids with twice the cells leave at most half of what the slope still lacks.
        slopes = np.diff(np.log2(error))
        order = -1 if method == "riemann" else -2
        remainder = 2 * abs(slopes[-1] - slopes[-2]) + 1e-8
        numbers.append(Number(f"{name}, order of the error", slopes[-1], remainder, order, bound=True))
    return Outcome(numbers, {"cells": cells, "errors": errors})


def draw_riemann(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplot_mosaic(
        [["riemann", "midpoint", "trapezoid"], ["errors", "errors", "errors"]], height_ratios=[1, 1.35]
    )
    x = np.linspace(0, np.pi / 2, 200)
    edges = np.linspace(0, np.pi / 2, 9)
    left, right, centre = edges[:-1], edges[1:], (edges[:-1] + edges[1:]) / 2
    for i, (method, name) in enumerate(RULES.items()):
        a = panels[method]
        colour = theme.cycle[i]
        ends = {"riemann": (np.sin(left),) * 2, "midpoint": (np.sin(centre),) * 2}.get(
            method, (np.sin(left), np.sin(right))
        )
        for k in range(8):
            a.fill([left[k], left[k], right[k], right[k]], [0, ends[0][k], ends[1][k], 0], facecolor=colour, alpha=0.35)
            a.plot([left[k], left[k], right[k], right[k]], [0, ends[0][k], ends[1][k], 0], color=colour, linewidth=1.2)
        a.plot(x, np.sin(x), color=theme.ink)
        a.set(
            title=name,
            xticks=[0, np.pi / 2],
            xticklabels=["0", "π/2"],
            yticks=[0, 1],
            ylim=(0, 1.05),
            xlim=(0, np.pi / 2),
        )
    panels["riemann"].set_ylabel("sin x")
    a = panels["errors"]
    for i, (method, name) in enumerate(RULES.items()):
        a.loglog(
            s["cells"],
            s["errors"][method],
            MARKERS[i] + "-",
            color=theme.cycle[i],
            label=name,
            markerfacecolor="none" if i == 2 else None,
            markersize=7 + 4 * (i == 2),
        )
    a.set(xlabel="cells N", ylabel="error")
    a.legend()
    grid(a, theme)


#: Cells along each variable, three grids of each dimension.
CELLS = {
    1: (4, 64, 1024),
    2: (4, 32, 256),
    3: (4, 16, 64),
    4: (3, 9, 27),
    5: (2, 6, 14),
    6: (2, 5, 10),
    7: (2, 4, 7),
    8: (2, 4, 6),
}


def curse() -> Outcome:
    """The midpoint rule on a smooth product of n sines, whose integral over the cube is 1."""
    numbers, errors = [], {}
    for n, cells in CELLS.items():

        def f(x, n=n):  # type: ignore[no-untyped-def]
            return np.prod(np.pi / 2 * np.sin(np.pi / 2 * x.reshape(len(x), n)), axis=1)

        def error(k, n=n):  # type: ignore[no-untyped-def]
            return abs(
                montelux.integrate(f, [(0, 1)] * n, "midpoint", cells=k, evaluations=k**n, components=0).value - 1
            )

        e = np.array([error(k) for k in cells])
        evaluations = np.array(cells, dtype=float) ** n
        slopes = np.diff(np.log(e)) / np.diff(np.log(evaluations))
        errors[n] = (evaluations, e)
        remainder = abs(slopes[1] - slopes[0]) + 1e-7
        numbers.append(
            Number(f"slope, n = {n}", slopes[1], remainder, -2 / n, bound=True, formula=f"−2/{n}" if n > 2 else "")
        )
    return Outcome(numbers, {"errors": errors})


def draw_curse(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a = figure.subplots()
    for i, (n, (evaluations, error)) in enumerate(s["errors"].items()):
        colour = theme.map(i / 7)
        a.loglog(evaluations, error, MARKERS[i] + "-", color=colour)
        a.annotate(
            f"n = {n}",
            (evaluations[-1], error[-1]),
            (8, -4 if n < 8 else 6),
            textcoords="offset points",
            color=theme.ink,
        )
    x = np.array([10.0, 2e5])
    a.loglog(x, 0.6 * x**-0.5, color=theme.ink, linestyle=(0, (2, 2)), label="Monte Carlo, any n: $N^{-1/2}$", zorder=0)
    a.set(xlabel="evaluations N", ylabel="error", xlim=(2, 5e7))
    a.legend(loc="lower right")
    grid(a, theme)


FIGURES = (
    Figure(
        "A1",
        "riemann",
        "Sums on a grid",
        "The left sum takes each cell's first value and always stays below a function that grows; the midpoint and the "
        "trapezoid err on either side. Twice the cells halve the first one's error and quarter those of the others.",
        (
            (
                r"\int_a^b f(x)\,dx \;\approx\; h \sum_{i=0}^{N-1} f(a + i h), \quad h \sum_{i=0}^{N-1} f(a + (i +"
                r" \frac{1}{2}) h), \quad h = \frac{b - a}{N}"
            ),
        ),
        riemann,
        draw_riemann,
        7.0,
        "Rectangles and trapezoids under the sine, and their errors against the number of cells",
    ),
    Figure(
        "A1",
        "curse",
        "The curse of dimensionality",
        "The same rule on a grid needs ever more points for the same error the more variables there are: its slope is"
        " two over their number. From four variables on random points, whose slope is one half in any number, fall as"
        " fast or faster.",
        (r"N = k^n \;\Rightarrow\; \mathrm{error} \;\propto\; k^{-2} = N^{-2/n}",),
        curse,
        draw_curse,
        5.4,
        "Errors of the midpoint rule against evaluations in one to eight variables",
    ),
)
