"""B6: the inversion method, for any function that is not negative."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def inversion() -> Outcome:
    """x exp(-x) on [0, 6]: c, P and its inverse by numbers alone; then the same from tables."""

    def f(x: float) -> float:
        return x * math.exp(-x)

    law = montelux.Distribution.from_density(f, 0, 6)
    c = 1 - 7 * math.exp(-6)
    t = np.linspace(0, 6, 601)
    numbers = [
        Number("c, by p = f/c at x = 1", f(1) / law.pdf(1.0), 1e-10, c, bound=True, formula="1 − 7 e⁻⁶"),
        Number(
            "P, farthest from (1 − (1 + x) e⁻ˣ)/c",
            np.abs(law.cdf(t) - (1 - (1 + t) * np.exp(-t)) / c).max(),
            1e-10,
            0,
            bound=True,
        ),
        Number("P(P⁻¹(ξ)) − ξ, farthest", np.abs(law.cdf(law.quantile(t / 6)) - t / 6).max(), 1e-10, 0, bound=True),
    ]
    mean = (2 - 50 * math.exp(-6)) / c
    x = law.draw(10_000, seed=3)
    numbers.append(mean_of("mean of x", x, mean, "(2 − 50 e⁻⁶)/c"))
    nodes = np.linspace(0, 6, 9)
    values = nodes * np.exp(-nodes)
    tables = {
        "constant pieces": montelux.Distribution.piecewise_constant((values[1:] + values[:-1]) / 2, 0, 6),
        "linear pieces": montelux.Distribution.tabulated(nodes, values),
    }
    h = 0.75
    area = h * (values[1:] + values[:-1]).sum() / 2
    middles = (nodes[1:] + nodes[:-1]) / 2
    # First moments of the pieces; a slope moves that of a linear one.
    constant = h * ((values[1:] + values[:-1]) / 2 * middles).sum() / area
    slopes = h**2 / 12 * np.diff(values).sum() / area
    for (name, d), exact in zip(tables.items(), (constant, constant + slopes)):
        numbers.append(mean_of(f"mean of x, {name}", d.draw(100_000, seed=3), float(exact)))
    return Outcome(numbers, {"law": law, "c": c, "tables": tables})


def draw_inversion(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b, c = figure.subplots(1, 3)
    t = np.linspace(0, 6, 400)
    a.plot(t, s["law"].pdf(t) * s["c"], color=theme.ink)
    a.fill_between(t, s["law"].pdf(t) * s["c"], color=theme.blue, alpha=0.3, linewidth=0)
    a.annotate("c", (1.7, 0.1), ha="center")
    a.set(title="f", xlabel="x", ylim=(0, 0.42))
    b.plot(t, s["law"].cdf(t), color=theme.ink)
    for i, xi in enumerate((0.15, 0.5, 0.85)):
        x = float(s["law"].quantile(xi))
        b.annotate(
            "",
            (x, 0),
            (x, xi),
            arrowprops={"arrowstyle": "->", "color": theme.cycle[i], "linewidth": 2, "shrinkA": 0, "shrinkB": 0},
        )
        b.plot([0, x], [xi, xi], color=theme.cycle[i], linewidth=2)
    b.set(title="P, from ξ to X", xlabel="x", ylabel="ξ", xlim=(0, 6), ylim=(0, 1.02), yticks=[0, 1])
    for i, (name, d) in enumerate(s["tables"].items()):
        c.plot(t, d.pdf(t), color=theme.cycle[i], label=name.replace(" ", "\n"), linewidth=1.8)
    c.plot(t, s["law"].pdf(t), color=theme.ink, linewidth=1.2, linestyle=(0, (3, 2)))
    c.set(title="from 9 values", xlabel="x", ylim=(0, 0.42))
    c.legend(loc="upper right", handlelength=1)


FIGURES = (
    Figure(
        "B6",
        "inversion",
        "The inversion method",
        "Any function that is not negative is a density after division by its area c. The running area P, read from"
        " the vertical axis to the horizontal one, turns a uniform number into a sample. An unknown inverse is"
        " computed numerically; a table of values is interpolated by constant or linear pieces.",
        (r"c = \int_a^b f, \qquad P(x) = \frac{1}{c} \int_a^x f(t)\,dt, \qquad X = P^{-1}(\xi)",),
        inversion,
        draw_inversion,
        4.2,
        "A function and its area, its running area with arrows from uniform numbers to samples, and pieces from a"
        " table",
    ),
)
