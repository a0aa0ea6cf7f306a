"""A6: the error against the number of samples, estimator by estimator."""

from __future__ import annotations

from math import erf
from typing import TYPE_CHECKING, Any

import numpy as np

import montelux
from montelux import Quasi

from .._figure import Figure, Outcome
from .._number import Number, of
from ..marks import MARKERS, STROKES, grid

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

METHODS = {
    "random": montelux.BasicMonteCarlo(),
    "stratified": montelux.Stratified(),
    "Halton": Quasi(points="halton"),
    "Hammersley": Quasi(points="hammersley"),
    "Sobol'": Quasi(points="sobol"),
    "golden ratio": Quasi(points="golden_ratio"),
    "Weyl": Quasi(points="weyl"),
    "adaptive": montelux.VegasSobol(),
}
DIMENSIONS = (1, 2, 5)
COUNTS = 4 ** np.arange(3, 9)
SEEDS = 16


def bump(x):  # type: ignore[no-untyped-def]
    """A soft bump: the product of exp(-32 (x_k - 0.4)^2) over the variables."""
    x = x if x.ndim == 2 else x[:, None]
    return np.exp(-32 * ((x - 0.4) ** 2).sum(axis=1))


def integral(d: int) -> float:
    """Of the bump over the cube of d variables."""
    a = np.sqrt(32)
    return float((np.sqrt(np.pi) / (2 * a) * (erf(0.6 * a) + erf(0.4 * a))) ** d)


def convergence() -> Outcome:
    """Root mean square errors over 16 seeds, relative to the integral; then one large run of each method."""
    numbers, errors = [], {}
    for d in DIMENSIONS:
        cube, exact = [(0, 1)] * d, integral(d)
        for name, method in METHODS.items():
            e = []
            for n in COUNTS:
                runs = [
                    montelux.integrate(bump, cube, method, evaluations=int(n), seed=s, components=0)
                    for s in range(SEEDS)
                ]
                e.append(
                    (
                        np.mean([r.evaluations for r in runs]),
                        np.sqrt(np.mean([(r.value / exact - 1) ** 2 for r in runs])),
                    )
                )
            errors[d, name] = np.array(e).T
            large = method
            if isinstance(method, Quasi):
                large = Quasi(points=method.points, replicates=32)
            elif isinstance(method, montelux.VegasSobol):
                large = montelux.VegasSobol(montelux.Vegas(points="sobol", replicates=32))
            r = montelux.integrate(bump, cube, large, evaluations=1 << 17, seed=100)
            numbers.append(
                of(f"{name}, d = {d}, 2¹⁷ evaluations", r, exact, replicates=32 if large is not method else 0)
            )
    t = np.log(COUNTS) - np.mean(np.log(COUNTS))
    for d in (1, 2):  # in five variables few random points see the bump, and 16 runs do not know their spread
        fitted = t @ np.log(errors[d, "random"][1]) / (t @ t)
        numbers.append(
            Number(f"slope of random points, d = {d}", fitted, np.sqrt(1 / (2 * SEEDS) / (t @ t)), -0.5, formula="−1/2")
        )
    return Outcome(numbers, {"errors": errors})


def draw_convergence(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    for a, d in zip(panels, DIMENSIONS):
        for i, name in enumerate(METHODS):
            colour = (
                theme.orange,
                theme.purple,
                theme.blue,
                theme.blue,
                theme.green,
                theme.yellow,
                theme.yellow,
                theme.ink,
            )[i]
            a.loglog(
                *s["errors"][d, name],
                marker=MARKERS[i],
                linestyle=STROKES[i % 6],
                color=colour,
                label=name,
                markersize=5,
                linewidth=1.8,
            )
        a.set(title=f"d = {d}", xlabel="evaluations N")
        a.set_xticks([1e2, 1e4])
        grid(a, theme)
    panels[0].set_ylabel("relative error (r.m.s.)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)


FIGURES = (
    Figure(
        "A6",
        "convergence",
        "Error against samples",
        "Random points keep their slope of one half in every dimension; strata and point sets are far better in one"
        " and two variables, and a little better in five. The adaptive method (VEGAS on Sobol' points) spends its"
        " first evaluations on locating the bump; after that it is about ten times better than all others in five"
        " variables.",
        (r"f(x) = \prod_{k=1}^{d} e^{-32 (x_k - 0.4)^2}, \qquad x \in [0,1]^d",),
        convergence,
        draw_convergence,
        6.4,
        "Errors of eight estimators against evaluations in one, two and five variables",
        slow=True,
        helpers=(bump, integral),
    ),
)
