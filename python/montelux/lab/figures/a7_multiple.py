"""A7: multiple importance sampling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, of
from ..marks import STROKES, grid

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

WIDE = montelux.Distribution.normal(2, 1.5)
NARROW = montelux.Distribution.normal(5, 0.4)
#: Each with what the figure calls it, and its parameter.
HEURISTICS = {"balance": None, "power": 2.0, "cutoff": 0.1, "maximum": None}


def lobes(x):  # type: ignore[no-untyped-def]
    """A wide lobe and a narrow one, times a slope that neither density knows; the integral is 2 + 0.5 * 5 = 4.5."""
    return x * (WIDE.pdf(x) + 0.5 * NARROW.pdf(x))


def multiple() -> Outcome:
    """The weights along the line, and the estimates that they make: unbiased, one and all."""
    line, numbers = (-np.inf, np.inf), []
    x = np.linspace(-2, 8, 1001)
    q = np.stack([WIDE.pdf(x), NARROW.pdf(x)], axis=1)
    weights = {}
    for name, parameter in HEURISTICS.items():
        weights[name] = montelux.mis_weights(q, name, parameter)
        apart = np.abs(weights[name].sum(axis=1) - 1).max()
        numbers.append(Number(f"{name}: sum of weights, farthest from 1", apart, 1e-15, 0, bound=True))
        r = montelux.integrate(
            lobes,
            line,
            "multiple_importance",
            techniques=[WIDE, NARROW],
            weights=name,
            parameter=parameter,
            evaluations=200_000,
            seed=2,
        )
        numbers.append(of(f"{name}: estimate", r, 4.5))
    unequal = montelux.MultipleImportance([(WIDE, 3), (NARROW, 1)])
    numbers.append(
        of("balance, three samples to one", montelux.integrate(lobes, line, unequal, evaluations=200_000, seed=2), 4.5)
    )
    optimal = montelux.MultipleImportance([WIDE, NARROW], weights="optimal")
    numbers.append(of("optimal weights", montelux.integrate(lobes, line, optimal, evaluations=200_000, seed=2), 4.5))
    alone = montelux.integrate(lobes, line, "importance", technique=WIDE, evaluations=200_000, seed=2)
    return Outcome(numbers, {"x": x, "q": q, "weights": weights, "alone": alone})


def draw_multiple(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    top = figure.subplot_mosaic([["f", "f"], ["balance", "power"], ["cutoff", "maximum"]], height_ratios=[1.3, 1, 1])
    x = s["x"]
    a = top["f"]
    a.fill_between(x, lobes(x), color=theme.faint, alpha=0.35, linewidth=0)
    a.plot(x, lobes(x), color=theme.ink, label="f")
    for i, name in enumerate(("$p_1$, wide", "$p_2$, narrow")):
        a.plot(x, s["q"][:, i], color=theme.cycle[i], linestyle=STROKES[1 + i], label=name)
    a.set(xlim=(-2, 8), ylim=(0, 3.2))
    a.legend(loc="upper left")
    for name in HEURISTICS:
        a = top[name]
        w = s["weights"][name]
        a.fill_between(x, w[:, 0], color=theme.blue, alpha=0.45, linewidth=0)
        a.fill_between(x, w[:, 0], 1, color=theme.orange, alpha=0.45, linewidth=0)
        a.plot(x, w[:, 0], color=theme.ink, linewidth=1.2)
        a.set(title=name, xlim=(-2, 8), ylim=(0, 1), yticks=[0, 1])
    for name in ("cutoff", "maximum"):
        top[name].set_xlabel("x")


FIGURES = (
    Figure(
        "A7",
        "weights",
        "Multiple importance sampling",
        "Two densities, each good at one lobe. The weights distribute each point between them (below the line the"
        " wide one, above it the narrow one) and always sum to one. Every choice is unbiased; only the noise differs.",
        (
            (
                r"F = \sum_i \frac{1}{n_i} \sum_{j=1}^{n_i} w_i(X_{ij})\,\frac{f(X_{ij})}{p_i(X_{ij})}, \qquad \sum_i"
                r" w_i(x) = 1"
            ),
            (
                r"\mathrm{balance:}\ \ w_i = \frac{n_i p_i}{\sum_k n_k p_k}, \qquad \mathrm{power:}\ \ w_i = \frac{(n_i"
                r" p_i)^\beta}{\sum_k (n_k p_k)^\beta}"
            ),
        ),
        multiple,
        draw_multiple,
        7.4,
        "A function of two lobes with two densities, and below it the weights of four heuristics along the line",
        (lobes,),
    ),
)
