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
N = 100_000


def discrete() -> Outcome:
    """100 000 indices by bisection, by walking and by an alias table."""
    p = np.array(WEIGHTS) / sum(WEIGHTS)
    sums, alias = montelux.Discrete(WEIGHTS), montelux.AliasTable(WEIGHTS)
    numbers = [
        Number("farthest of P from the sums of p", np.abs(sums.cdf - np.cumsum(p)).max(), 1e-15, 0, bound=True),
        Number("farthest of the table's p from p", np.abs(alias.probabilities - p).max(), 3e-8, 0, bound=True),
    ]
    u = montelux.points("independent", N, 2, seed=3)
    drawn = {
        "bisection": sums.sample(u[:, 0]),
        "walking": sums.sample_by_walking(u[:, 0]),
        "alias table": alias.sample(u[:, 1]),
    }
    counts = {way: np.bincount(k, minlength=6) for way, k in drawn.items()}
    different = int((drawn["bisection"] != drawn["walking"]).sum())
    numbers.append(Number("indices that walking and bisection draw differently", different, 0, 0, bound=True))
    for way in ("bisection", "alias table"):
        for k in (0, 2, 4):
            numbers.append(share_of(f"{way}: share of k = {k}", int(counts[way][k]), N, p[k]))
        # Its mean is the degrees of freedom, its largest value not exceeded once in a million.
        chi_squared = float(((counts[way] - N * p) ** 2 / (N * p)).sum())
        numbers.append(Number(f"{way}: χ² of the six, below 40", chi_squared, 40, 0, bound=True))
    # Uniform numbers of each of the table's six bins go to the bin's own index or to its alias.
    fine = (np.arange(6 * 1000) + 0.5) / 6000
    bins = alias.sample(fine).reshape(6, 1000)
    own = (bins == np.arange(6)[:, None]).mean(axis=1)
    other = np.array([next((int(k) for k in row if k != i), i) for i, row in enumerate(bins)])
    filled = (own + np.array([(1 - own)[other == k].sum() for k in range(6)])) / 6
    numbers.append(
        Number("area of an index in the table less p, farthest", np.abs(filled - p).max(), 2e-3, 0, bound=True)
    )
    return Outcome(numbers, {"p": p, "sums": sums, "counts": counts, "own": own, "other": other})


def draw_discrete(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplot_mosaic([["walk", "alias"], ["bars", "bars"]])
    a, table, b = panels["walk"], panels["alias"], panels["bars"]
    k = np.arange(6)
    a.step(np.arange(-1, 7), np.concatenate(([0], s["sums"].cdf, [1])), where="post", color=theme.ink)
    for i, xi in enumerate((0.31, 0.68, 0.9)):
        index = s["sums"].sample(xi)
        colour = theme.cycle[i]
        a.annotate("", (index, xi), (-0.6, xi), arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 2})
        a.annotate("", (index, 0), (index, xi), arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 2})
        a.annotate(rf"$\xi_{i + 1}$", (-0.6, xi), (-20, -4), textcoords="offset points", color=colour)
    a.set(ylabel="P", xticks=k, yticks=[0, 1], ylim=(0, 1.03), xlim=(-0.6, 6), title="sums")
    a.yaxis.labelpad = 14
    table.bar(k, s["own"], 0.9, color=theme.blue, alpha=0.55, edgecolor=theme.ink, linewidth=0.8)
    table.bar(
        k, 1 - s["own"], 0.9, s["own"], color=theme.orange, alpha=0.55, edgecolor=theme.ink, linewidth=0.8, hatch="//"
    )
    for i in range(6):
        if s["own"][i] > 0.12:
            table.annotate(str(i), (i, s["own"][i] / 2), ha="center", va="center")
        if s["own"][i] < 0.9:
            table.annotate(str(s["other"][i]), (i, (1 + s["own"][i]) / 2), ha="center", va="center")
    table.set(xticks=k, yticks=[0, 1], title="alias table", ylim=(0, 1.03))
    for i, (way, count) in enumerate(s["counts"].items()):
        b.bar(
            k + 0.28 * (i - 1),
            count / N,
            0.26,
            color=theme.cycle[i],
            alpha=0.7,
            label=way,
            hatch=("", "//", "..")[i],
            edgecolor=theme.ink,
            linewidth=0.6,
        )
    b.hlines(s["p"], k - 0.41, k + 0.41, color=theme.ink, linewidth=2, label="p")
    b.set(xlabel="k", title="100 000 samples each", ylim=(0, 0.4), xticks=k)
    b.legend(loc="upper right", ncols=2)


FIGURES = (
    Figure(
        "B1",
        "discrete",
        "A discrete variable, three ways",
        "A uniform number goes right until it meets the staircase of the sums; the step that it meets is the index."
        " Walking tries step after step, bisection halves the stairs. The alias table has six bins of equal width and"
        " splits each between its own index and one other, so one bin and one comparison suffice. The bars show how"
        " often each index was drawn, beside its probability.",
        (
            r"P_k = \sum_{i \leq k} p_i, \qquad X = \min\{k : \xi < P_k\}",
            r"i = \lfloor n\xi \rfloor, \qquad X = i \ \mathrm{if}\ n\xi - i < q_i, \ \ \mathrm{else}\ a_i",
        ),
        discrete,
        draw_discrete,
        7.2,
        "A staircase of probabilities with three arrows, the bins of an alias table with their cuts, and bars of how"
        " often each index was drawn",
    ),
)
