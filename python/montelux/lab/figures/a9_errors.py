"""A9: what an error means."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, share_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

SHARES = {1: 0.6826894921370859, 2: 0.9544997361036416, 3: 0.9973002039367398}


def calibration() -> Outcome:
    """4000 integrations with different seeds: how often does the exact value lie within their errors?"""
    runs = [
        montelux.integrate(np.sin, (0, np.pi / 2), "basic", evaluations=1024, seed=s, components=0) for s in range(4000)
    ]
    values, errors = (np.array([getattr(r, what) for r in runs]) for what in ("value", "standard_error"))
    z = (values - 1) / errors
    numbers = [
        share_of(f"within {k} error{'s' if k > 1 else ''}", int((np.abs(z) <= k).sum()), len(z), p)
        for k, p in SHARES.items()
    ]
    # Four times the samples.
    more = [
        montelux.integrate(np.sin, (0, np.pi / 2), "basic", evaluations=4096, seed=s, components=0).value
        for s in range(1000)
    ]
    a, b = values.std(ddof=1), np.array(more).std(ddof=1)
    numbers.append(Number("error of 1024 over that of 4096 samples", a / b, a / b * np.sqrt(1 / 8000 + 1 / 2000), 2))
    sigma = np.sqrt((np.pi**2 / 8 - 1) / 1024)
    numbers.append(
        Number(
            "mean of the reported errors",
            errors.mean(),
            errors.std() / np.sqrt(len(z)) + sigma / 8192,
            sigma,
            formula="σ/√N",
        )
    )
    return Outcome(numbers, {"values": values, "errors": errors, "z": z})


def draw_calibration(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2, width_ratios=[1.5, 1])
    for i in range(60):
        v, e = s["values"][i], s["errors"][i]
        missed = abs(v - 1) > e
        a.plot([i, i], [v - e, v + e], color=theme.orange if missed else theme.blue, linewidth=2 if missed else 1.5)
        a.plot(i, v, "s" if missed else "o", color=theme.orange if missed else theme.blue, markersize=3.5)
    a.axhline(1, color=theme.ink, linewidth=1.2)
    a.set(xlabel="run", ylabel="estimate ± one error", title="60 runs of 1024 samples")
    x = np.linspace(-4, 4, 200)
    b.hist(s["z"], bins=41, range=(-4.1, 4.1), density=True, color=theme.blue, alpha=0.45)
    b.plot(x, montelux.Distribution.normal().pdf(x), color=theme.ink)
    b.set(xlabel="(estimate − 1) / error", yticks=[], title="4000 runs")


FIGURES = (
    Figure(
        "A9",
        "calibration",
        "What an error means",
        "Each run estimates its error from its own samples: about one in three of the bars (orange, with squares)"
        " misses the exact line, as expected. Over 4000 runs the distances in units of the error follow the normal"
        " law.",
        (r"s^2 = \frac{1}{N - 1} \sum_{i=1}^{N} (f(X_i) - \bar{f})^2, \qquad \mathrm{error} = \frac{s}{\sqrt{N}}",),
        calibration,
        draw_calibration,
        4.4,
        "Sixty estimates with error bars about the exact value, and a histogram of distances in errors on a bell curve",
    ),
)
