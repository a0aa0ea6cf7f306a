"""B1: discrete random variables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, share_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

WEIGHTS = (3.0, 1.0, 4.0, 1.5, 0.5, 2.0)


def discrete() -> Outcome:
    """100 000 indices: a variable that is constant on six pieces, rounded down."""
    p = np.array(WEIGHTS) / sum(WEIGHTS)
    pieces = montelux.Distribution.piecewise_constant(WEIGHTS, 0, 6)
    cdf = pieces.cdf(np.arange(1, 7))
    numbers = [Number("farthest of P from the sums of p", np.abs(cdf - np.cumsum(p)).max(), 1e-15, 0, bound=True)]
    u = montelux.points("independent", 100_000, 1, seed=3)[:, 0]
    count = np.bincount(pieces.sample(u).astype(int), minlength=6)
    for k in (0, 2, 4):
        numbers.append(share_of(f"share of k = {k}", int(count[k]), len(u), p[k]))
    chi_squared = float(((count - len(u) * p) ** 2 / (len(u) * p)).sum())
    numbers.append(Number("χ² of the six", chi_squared, np.sqrt(10), 5))
    # The inverse goes to the step that it meets.
    starts = pieces.sample(np.concatenate(([0], cdf[:-1])) + 1e-9).astype(int)
    numbers.append(
        Number("steps that are not met at their foot", int((starts != np.arange(6)).sum()), 0, 0, bound=True)
    )
    return Outcome(numbers, {"p": p, "cdf": cdf, "pieces": pieces, "counts": {"inversion": count}, "n": len(u)})


def draw_discrete(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2)
    k = np.arange(6)
    a.step(np.arange(-1, 7), np.concatenate(([0], s["cdf"], [1])), where="post", color=theme.ink)
    for i, xi in enumerate((0.31, 0.68, 0.9)):
        index = int(s["pieces"].sample(xi))
        colour = theme.cycle[i]
        a.annotate("", (index, xi), (-0.6, xi), arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 2})
        a.annotate("", (index, 0), (index, xi), arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 2})
        a.annotate(rf"$\xi_{i + 1}$", (-0.6, xi), (-20, -4), textcoords="offset points", color=colour)
    a.set(xlabel="k", ylabel="P", xticks=k, yticks=[0, 1], ylim=(0, 1.03), xlim=(-0.6, 6))
    a.yaxis.labelpad = 14
    for i, (way, count) in enumerate(s["counts"].items()):
        b.bar(
            k + (0.2 * (2 * i - 1) if len(s["counts"]) > 1 else 0),
            count / s["n"],
            0.36 if len(s["counts"]) > 1 else 0.7,
            color=theme.cycle[i],
            alpha=0.7,
            label="drawn" if len(s["counts"]) == 1 else way,
            hatch=("", "//")[i],
            edgecolor=theme.ink,
            linewidth=0.6,
        )
    b.plot(k, s["p"], "_", color=theme.ink, markersize=30, markeredgewidth=2, label="p")
    b.set(xlabel="k", title="100 000 samples", ylim=(0, 0.48))
    b.legend(loc="upper right")


FIGURES = (
    Figure(
        "B1",
        "discrete",
        "A discrete variable",
        "A uniform number goes right until it meets the staircase of the sums, and the step it meets is the index; a"
        " high step is met often. How often each was met in 100 000 tries stands beside its probability.",
        (r"P_k = \sum_{i \leq k} p_i, \qquad X = \min\{k : \xi < P_k\}",),
        discrete,
        draw_discrete,
        4.4,
        "A staircase of probabilities with three arrows, and bars of how often each index was drawn",
    ),
)
