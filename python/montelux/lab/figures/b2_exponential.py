"""B2: the exponential law."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

RATE, COUNT = 5.0, 10_000


def exponential() -> Outcome:
    """10 000 samples, beside as many of the standard library's own distribution."""
    law = montelux.Distribution.exponential(RATE)
    xi = montelux.points("independent", COUNT, 1, seed=2)[:, 0]
    ours = law.sample(xi)
    standard = random.Random(2)
    theirs = np.array([standard.expovariate(RATE) for _ in range(COUNT)])
    numbers = [
        Number("X(ξ) and −ln(1 − ξ)/λ, farthest apart", np.abs(ours + np.log1p(-xi) / RATE).max(), 2e-15, 0, bound=True)
    ]
    edges = law.quantile(np.linspace(0, 1, 51))
    for name, x in (("montelux", ours), ("standard library", theirs)):
        numbers.append(mean_of(f"mean, {name}", x, 1 / RATE, "1/λ"))
        # The fourth central moment of the law is 9 / rate^4.
        numbers.append(
            Number(f"variance, {name}", x.var(ddof=1), np.sqrt(8 / COUNT) / RATE**2, 1 / RATE**2, formula="1/λ²")
        )
        counts = np.histogram(x, edges)[0]
        chi_squared = float(((counts - COUNT / 50) ** 2 / (COUNT / 50)).sum())
        numbers.append(Number(f"χ² of 50 bins, {name}", chi_squared, np.sqrt(98), 49))
    return Outcome(numbers, {"ours": ours, "theirs": theirs, "law": law})


def draw_exponential(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(1, 2, sharey=True)
    x = np.linspace(0, 1.5, 200)
    for i, (a, key, title) in enumerate(zip(panels, ("ours", "theirs"), ("montelux", "standard library"))):
        a.hist(s[key], bins=45, range=(0, 1.5), density=True, color=theme.cycle[i], alpha=0.55)
        a.plot(x, s["law"].pdf(x), color=theme.ink)
        a.set(title=title, xlabel="x", xlim=(0, 1.5))
    panels[0].set_ylabel("density")


FIGURES = (
    Figure(
        "B2",
        "exponential",
        "The exponential law",
        "10 000 uniform numbers become exponential ones by one logarithm; the bars follow the density 5 exp(−5x)."
        " Python's own random.expovariate, on the right, has the same distribution.",
        (r"p(x) = \lambda e^{-\lambda x}, \qquad P(x) = 1 - e^{-\lambda x}, \qquad X = -\frac{\ln(1 - \xi)}{\lambda}",),
        exponential,
        draw_exponential,
        4.4,
        "Two histograms of 10 000 samples, each on the exponential density",
    ),
)
