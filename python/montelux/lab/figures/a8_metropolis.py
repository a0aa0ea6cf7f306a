"""A8: Metropolis-Hastings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def target(x):  # type: ignore[no-untyped-def]
    """exp(-x^2) (2 + sin 5x + sin 2x): three lobes; the chain does not know its integral, 2 sqrt(pi)."""
    return np.exp(-x * x) * (2 + np.sin(5 * x) + np.sin(2 * x))


def chain() -> Outcome:
    """Four chains from far away; their states beside the target, which an independent estimate normalises."""
    chains = montelux.metropolis(
        lambda x: float(np.log(target(x[0]))),
        [[-2.0], [-1.0], [1.0], [2.0]],
        lambda x: [x[0], x[0] ** 2],
        samples=40_000,
        burn_in=1000,
        seed=4,
    )
    # The moments of the sines under exp(-x^2) are closed forms.
    mean = (5 * np.exp(-25 / 4) + 2 * np.exp(-1)) / 4
    numbers = [
        Number("mean of x", chains.mean[0], chains.standard_error[0], mean, formula="(5 e^(−25/4) + 2 e^(−1)) / 4"),
        Number("mean of x²", chains.mean[1], chains.standard_error[1], 0.5, formula="1/2"),
    ]
    r = montelux.integrate(target, (-np.inf, np.inf), "metropolis", evaluations=200_000, seed=4)
    numbers.append(of("normalisation", r, 2 * np.sqrt(np.pi), "2 √π"))
    # Thinned until the states hardly know one another, their histogram is compared with the target.
    apart = int(np.ceil(4 * chains.autocorrelation_time.max()))
    states = chains.states[:, ::apart, 0].ravel()
    law = montelux.Distribution.from_density(target, -6, 6)
    edges = law.quantile(np.linspace(0, 1, 41))
    counts = np.histogram(states, np.concatenate(([-np.inf], edges[1:-1], [np.inf])))[0]
    expected = len(states) / 40
    chi_squared = float(((counts - expected) ** 2 / expected).sum())
    numbers.append(Number(f"χ² of 40 bins, one state in {apart}", chi_squared, np.sqrt(2 * 39), 39))
    return Outcome(numbers, {"chains": chains, "law": law})


def draw_chain(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2, width_ratios=[1.6, 1], sharey=True)
    chains = s["chains"]
    a.plot(chains.states[0, :400, 0], color=theme.blue, linewidth=1.2, drawstyle="steps-post")
    a.set(xlabel="step", ylabel="x", ylim=(-2.8, 2.8), xlim=(0, 400), title="one chain")
    x = np.linspace(-2.8, 2.8, 300)
    b.hist(
        chains.states.ravel(),
        bins=70,
        range=(-2.8, 2.8),
        density=True,
        orientation="horizontal",
        color=theme.blue,
        alpha=0.45,
    )
    b.plot(s["law"].pdf(x), x, color=theme.ink)
    b.set(xlabel="density", title="160 000 states")


FIGURES = (
    Figure(
        "A8",
        "chain",
        "A Metropolis chain",
        "The chain proposes a step, accepts it always where the target grows and sometimes where it falls, and stays"
        " otherwise. Only ratios of the target are used, so its integral need not be known. The states follow the"
        " target (line), but neighbouring ones are correlated, as the autocorrelation time measures.",
        (
            (
                r"a(x \to y) = \min\left(1,\ \frac{f(y)\,T(y \to x)}{f(x)\,T(x \to y)}\right), \qquad f(x) = e^{-x^2}"
                r" (2 + \sin 5x + \sin 2x)"
            ),
        ),
        chain,
        draw_chain,
        4.6,
        "The path of one chain and the histogram of the states of four on the target density",
        (target,),
    ),
)
