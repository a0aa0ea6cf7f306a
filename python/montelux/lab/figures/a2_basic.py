"""A2: basic Monte Carlo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, of
from ..marks import grid, slope

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def basic() -> Outcome:
    """Sixteen uniform points under the sine; then the spread of 400 estimates for each number of samples."""
    quarter = (0, np.pi / 2)
    drawn = []

    def sine(x):  # type: ignore[no-untyped-def]
        drawn.append(x.copy())
        return np.sin(x)

    sixteen = montelux.integrate(sine, quarter, "basic", evaluations=16, seed=3, components=0)
    points = np.concatenate(drawn)[:16]
    many = montelux.integrate(np.sin, quarter, "basic", evaluations=1_000_000, seed=1)

    counts, seeds = 4 ** np.arange(1, 8), 400
    spread = []
    for n in counts:
        values = [
            montelux.integrate(np.sin, quarter, "basic", evaluations=int(n), seed=s, components=0).value
            for s in range(seeds)
        ]
        spread.append(np.sqrt(np.mean((np.array(values) - 1) ** 2)))
    # The logarithm of a root mean square of k normal errors has a deviation of 1 / sqrt(2 k).
    t = np.log(counts) - np.mean(np.log(counts))
    fitted = t @ np.log(spread) / (t @ t)
    numbers = [
        of("16 samples", sixteen, 1),
        of("a million samples", many, 1),
        Number("slope of the error", fitted, np.sqrt(1 / (2 * seeds) / (t @ t)), -0.5, formula="−1/2"),
        Number(
            "error of one sample",
            spread[-1] * np.sqrt(counts[-1]),
            spread[-1] * np.sqrt(counts[-1] / (2 * seeds)),
            np.sqrt(np.pi**2 / 8 - 1),
            formula="√(π²/8 − 1)",
        ),
    ]
    return Outcome(numbers, {"points": points, "counts": counts, "spread": np.array(spread)})


def draw_basic(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2)
    x = np.linspace(0, np.pi / 2, 200)
    width = np.pi / 2 / 16
    for v in s["points"]:
        a.bar(v, np.sin(v), width, color=theme.blue, alpha=0.28, edgecolor=theme.blue, linewidth=1)
    a.plot(s["points"], np.sin(s["points"]), "o", color=theme.blue)
    a.plot(x, np.sin(x), color=theme.ink)
    a.set(
        xlabel="x",
        ylabel="sin x",
        title="16 samples, equally wide",
        xticks=[0, np.pi / 4, np.pi / 2],
        xticklabels=["0", "π/4", "π/2"],
    )
    b.loglog(s["counts"], s["spread"], "o", color=theme.blue)
    c = np.array([s["counts"][0], s["counts"][-1]])
    b.loglog(c, np.sqrt(np.pi**2 / 8 - 1) * c**-0.5, color=theme.ink, linewidth=1.6, linestyle=(0, (5, 2)))
    b.annotate(r"$\sigma / \sqrt{N}$", (c[0] * 40, 0.48 / np.sqrt(c[0] * 40)), (8, 6), textcoords="offset points")
    b.set(xlabel="samples N", ylabel="error (r.m.s.)", title="400 runs each")
    grid(b, theme)


FIGURES = (
    Figure(
        "A2",
        "basic",
        "Basic Monte Carlo",
        "Each random point contributes a strip of equal width and the height of the function there. Strips overlap"
        " and leave gaps, but their sum is right on average. Four times the points halve the error of any function.",
        (r"\langle F^N \rangle = \frac{b - a}{N} \sum_{i=1}^{N} f(X_i), \qquad X_i \sim \mathrm{uniform\ on}\ [a, b)",),
        basic,
        draw_basic,
        4.4,
        "Strips at random points under the sine, and the error against the number of samples on a line of slope minus"
        " one half",
    ),
)
