"""A5: stratified sampling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..marks import MARKERS, grid, square

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

SQUARE = [(0, 1), (0, 1)]
SEEDS = 300


def smooth(x):  # type: ignore[no-untyped-def]
    """exp(x + y), whose integral over the square is (e - 1)^2."""
    return np.exp(x[:, 0] + x[:, 1])


def variance(strata: int, samples: int) -> float:
    """The variance of its estimate with this number of strata along each side, and of samples in each, in closed form."""
    h = 1 / strata
    squares = ((np.e**2 - 1) / 2) ** 2
    squared_means = h**2 * (np.expm1(h) / h) ** 4 * ((np.e**2 - 1) / np.expm1(2 * h)) ** 2
    return float((squares - squared_means) / (strata**2 * samples))


def jittered() -> Outcome:
    """Where 256 points lie; then the spread of 300 estimates, without strata and with two points in each."""
    seen: list[Any] = []

    def looking(x):  # type: ignore[no-untyped-def]
        seen.append(x.copy())
        return smooth(x)

    montelux.integrate(looking, SQUARE, "stratified", strata=16, evaluations=512, seed=2, components=0)
    points = np.concatenate(seen)
    exact, numbers = (np.e - 1) ** 2, []
    sides = np.array([2, 4, 8, 16, 32])
    spread: dict[str, list[float]] = {"basic": [], "stratified": []}
    for k in sides:
        n = 2 * int(k) ** 2
        strata: Any = {"strata": int(k)}
        for method, settings in (("basic", {}), ("stratified", strata)):
            runs = [
                montelux.integrate(smooth, SQUARE, method, evaluations=n, seed=s, components=0, **settings).value
                for s in range(SEEDS)
            ]
            spread[method].append(np.sqrt(np.mean((np.array(runs) - exact) ** 2)))
    counts = 2 * sides**2
    t = np.log(counts) - np.mean(np.log(counts))
    for method, order in (("basic", -0.5), ("stratified", -1)):
        # Of a smooth function the strata's slope is -1 in the limit; the closed form has it for these numbers too.
        expected = [variance(int(k), 2) if method == "stratified" else variance(1, 2 * int(k) ** 2) for k in sides]
        fitted, true = (t @ np.log(v) / (t @ t) for v in (spread[method], np.sqrt(expected)))
        text = f"{order:g} in the limit, here".replace("-", "−")
        numbers.append(Number(f"slope, {method}", fitted, np.sqrt(1 / (2 * SEEDS) / (t @ t)), true, formula=text))
    gain = spread["basic"][-1] / spread["stratified"][-1]
    numbers.append(
        Number(
            "2048 samples: error, times less",
            gain,
            gain * np.sqrt(1 / SEEDS),
            np.sqrt(variance(1, 2048) / variance(32, 2)),
        )
    )
    return Outcome(
        numbers,
        {
            "points": points,
            "counts": counts,
            "spread": spread,
            "random": montelux.points("independent", 256, 2, seed=3),
        },
    )


def draw_jittered(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b, c = figure.subplots(1, 3, width_ratios=[1, 1, 1.5])
    # One of the two points of each stratum.
    first = {tuple((p * 16).astype(int)): p for p in s["points"] if p.min() >= 0}
    points = np.array(list(first.values()))
    for axes, x, title in ((a, s["random"], "256 random"), (b, points, "256 jittered")):
        square(axes, theme, title)
        if axes is b:
            for k in np.linspace(0, 1, 17):
                axes.axvline(k, color=theme.faint, linewidth=0.5)
                axes.axhline(k, color=theme.faint, linewidth=0.5)
        axes.plot(x[:, 0], x[:, 1], "o", markersize=2.6, color=theme.blue)
    for i, (method, spread) in enumerate(s["spread"].items()):
        c.loglog(s["counts"], spread, MARKERS[i] + "-", color=theme.cycle[i], label=method)
    c.set(xlabel="samples N", ylabel="error (r.m.s.)")
    c.legend()
    grid(c, theme)


def peaked(x):  # type: ignore[no-untyped-def]
    """Flat nearly everywhere: the variance differs between strata."""
    return np.exp(-0.5 * ((x - 0.3) / 0.04) ** 2)


def neyman() -> Outcome:
    """The same strata with as many samples in each, and with more where a pilot saw more spread (Neyman)."""
    from math import erf

    exact = 0.04 * np.sqrt(np.pi / 2) * (erf(0.3 / 0.04 / np.sqrt(2)) + erf(0.7 / 0.04 / np.sqrt(2)))
    numbers, series = [], {}
    for allocation in ("proportional", "neyman"):
        seen: list[Any] = []

        def looking(x):  # type: ignore[no-untyped-def]
            seen.append(x.copy())
            return peaked(x)

        r = montelux.integrate(
            looking, (0, 1), "stratified", strata=32, allocation=allocation, evaluations=4096, seed=9, components=0
        )
        numbers.append(Number(f"{allocation}, 4096 evaluations", r.value, r.standard_error, exact))
        series[allocation] = np.concatenate(seen)
    basic = montelux.integrate(peaked, (0, 1), "basic", evaluations=4096, seed=9)
    numbers.append(Number("no strata, 4096 evaluations", basic.value, basic.standard_error, exact))
    return Outcome(numbers, series)


def draw_neyman(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(1, 2, sharey=True)
    t = np.linspace(0, 1, 400)
    for i, (a, allocation) in enumerate(zip(panels, ("proportional", "neyman"))):
        counts, edges = np.histogram(s[allocation], 32, (0, 1))
        a.bar(
            edges[:-1],
            counts,
            1 / 32,
            align="edge",
            color=theme.cycle[i],
            alpha=0.6,
            edgecolor=theme.ink,
            linewidth=0.6,
        )
        a.set(title=allocation, xlabel="x", yscale="log", ylim=(10, 4000), xlim=(0, 1))
        twin = a.twinx()
        twin.plot(t, peaked(t), color=theme.ink)
        twin.set(yticks=[], ylim=(0, 1.05))
        twin.spines["right"].set_visible(False)
    panels[0].set_ylabel("evaluations in a stratum")


FIGURES = (
    Figure(
        "A5",
        "jittered",
        "Stratified sampling",
        "One random point in each cell of a grid cannot clump, so the error on a smooth function of two variables"
        " falls with the number of samples instead of its square root. Strata of equal shares never increase the"
        " variance.",
        (
            (
                r"\langle F \rangle = \sum_k \frac{V_k}{N_k} \sum_{j=1}^{N_k} f(X_{kj}), \qquad \mathrm{Var} = \sum_k"
                r" \frac{V_k^2 \sigma_k^2}{N_k}"
            ),
        ),
        jittered,
        draw_jittered,
        3.7,
        "Random points clump, jittered ones do not; errors with slopes of minus one half and minus one",
        (smooth, variance),
    ),
    Figure(
        "A5",
        "neyman",
        "Where to sample: Neyman's allocation",
        "Left, every stratum gets the same number of samples, although the function is flat in most. Right, after a"
        " short pilot in each, the samples go where the function varies (the line is the function, at its own scale).",
        (r"N_k \;\propto\; V_k\,\sigma_k",),
        neyman,
        draw_neyman,
        4.4,
        "Histograms of the evaluations in 32 strata, even and following the spread of a peak",
        (peaked,),
    ),
)
