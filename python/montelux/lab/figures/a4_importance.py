"""A4: importance sampling, and the race of two densities."""

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

UNIFORM = montelux.Distribution.uniform(0, np.pi / 2)
LINEAR = montelux.Distribution.linear(0, np.pi / 2)  # p = 8 x / pi^2, X = pi/2 sqrt(xi)
#: Of the weight sin X / p(X); Ci(pi) = 0.0736679120464254860.
UNIFORM_VARIANCE = np.pi**2 / 8 - 1
LINEAR_VARIANCE = np.pi**2 / 16 * (np.euler_gamma + np.log(np.pi) - 0.0736679120464254860) - 1


def importance() -> Outcome:
    """Sixteen points of a density that looks like the function: the weights 1/p undo it."""
    xi = (montelux.points("independent", 16, 1, seed=8)[:, 0] + np.arange(16)) / 16
    x = LINEAR.sample(xi)
    perfect = montelux.Distribution.from_density(np.sin, 0, np.pi / 2)
    numbers = []
    for name, density in (("uniform density", UNIFORM), ("linear density", LINEAR)):
        r = montelux.integrate(np.sin, (0, np.pi / 2), "importance", technique=density, evaluations=100_000, seed=4)
        numbers.append(of(f"{name}, 10⁵ samples", r, 1))
    r = montelux.integrate(np.sin, (0, np.pi / 2), "importance", technique=perfect, evaluations=1000, seed=4)
    numbers.append(Number("density sin x itself, 1000 samples", r.value, 1e-9, 1, bound=True))
    return Outcome(numbers, {"x": x, "uniform": UNIFORM.sample(xi)})


def draw_importance(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm

    panels = figure.subplots(1, 2, sharey=True)
    t = np.linspace(0, np.pi / 2, 200)
    scale = ScalarMappable(LogNorm(0.5, 8), theme.map)
    for a, p, x, title in (
        (panels[0], UNIFORM, s["uniform"], "uniform"),
        (panels[1], LINEAR, s["x"], "linear, p = 8x/π²"),
    ):
        widths = 1 / (16 * p.pdf(x))
        a.bar(x, np.sin(x), widths, color=scale.to_rgba(16 * widths), alpha=0.6, edgecolor=theme.ink, linewidth=0.8)
        a.plot(t, np.sin(t), color=theme.ink)
        a.plot(t, p.pdf(t), color=theme.orange, linestyle=STROKES[1])
        a.annotate("p", (1.2, float(p.pdf(1.2))), (4, -18), textcoords="offset points", color=theme.orange)
        a.plot(x, np.zeros(16) - 0.05, "|", color=theme.ink, markersize=12)
        a.set(title=title, xlabel="x", xticks=[0, np.pi / 2], xticklabels=["0", "π/2"], ylim=(-0.1, 1.35))
    panels[0].set_ylabel("sin x")
    figure.colorbar(scale, ax=panels, label="1 / p", ticks=[0.5, 1, 2, 4, 8], format="%g").minorticks_off()


def race() -> Outcome:
    """Runs of growing N with one seed, each of which begins as the one before it, with two densities; then the
    variances of a sample, as integrals over xi."""
    n = np.unique(np.round(np.geomspace(2, 10_000, 100)).astype(int))
    runs: dict[str, list[montelux.Result]] = {"uniform": [], "linear": []}
    numbers_drawn = []
    for name, p in (("uniform", UNIFORM), ("linear", LINEAR)):
        for count in n:
            xi: list[Any] = []

            def f(x, p=p, xi=xi):  # type: ignore[no-untyped-def]
                xi.append(p.cdf(x))
                return np.sin(x)

            runs[name].append(
                montelux.integrate(
                    f, (0, np.pi / 2), "importance", technique=p, evaluations=int(count), seed=11, components=0
                )
            )
            # One point for 32 samples, before the first 4096 of them, looks for what the density misses.
            numbers_drawn.append(np.concatenate(xi)[min(32, count // 33) :][:4096])
    # Both densities and all runs have the same numbers.
    last = numbers_drawn[-1]
    apart = max(np.abs(xi - last[: len(xi)]).max() for xi in numbers_drawn)
    estimates = {name: np.array([r.value for r in all_runs]) for name, all_runs in runs.items()}

    def squares(u):  # type: ignore[no-untyped-def]
        w = [np.sin(p.sample(u)) / p.pdf(p.sample(u)) for p in (UNIFORM, LINEAR)]
        return np.stack([(v - 1) ** 2 for v in w], axis=1)

    r = montelux.integrate(squares, (0, 1), "basic", evaluations=4_000_000, seed=1)
    (a, b), errors, c = np.asarray(r.value), np.asarray(r.standard_error), np.asarray(r.covariance)
    # Of a quotient of correlated means, to first order.
    error = a / b * np.sqrt(c[0, 0] / a**2 + c[1, 1] / b**2 - 2 * c[0, 1] / (a * b))
    numbers = [
        Number("variance, uniform density", a, errors[0], UNIFORM_VARIANCE, formula="π²/8 − 1"),
        Number("variance, linear density", b, errors[1], LINEAR_VARIANCE, formula="(π²/16)(γ + ln π − Ci π) − 1"),
        Number("times less", a / b, error, UNIFORM_VARIANCE / LINEAR_VARIANCE),
    ]
    for name, all_runs in runs.items():
        numbers.append(of(f"{name}, after 10⁴ samples", all_runs[-1], 1))
    numbers.append(Number("random numbers of all runs, farthest apart", apart, 1e-12, 0, bound=True))
    return Outcome(numbers, {"n": n, "estimates": estimates})


def draw_race(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a = figure.subplots()
    n = s["n"]
    for i, (name, variance) in enumerate((("uniform", UNIFORM_VARIANCE), ("linear", LINEAR_VARIANCE))):
        colour = theme.cycle[i]
        band = np.sqrt(variance / n)
        a.fill_between(n, 1 - band, 1 + band, color=colour, alpha=0.22, linewidth=0)
        a.plot(
            n,
            s["estimates"][name],
            color=colour,
            linestyle=STROKES[i],
            label=f"{name} density: {name_of(i)}",
        )
    a.axhline(1, color=theme.ink, linewidth=1.2)
    a.set(xscale="log", xlabel="samples N", ylabel="estimate of 1", ylim=(0.55, 1.45), xlim=(2, n[-1]))
    a.legend(loc="upper right")
    grid(a, theme)


def name_of(i: int) -> str:
    return ("p = 2/π", "p = 8x/π²")[i]


FIGURES = (
    Figure(
        "A4",
        "importance",
        "Importance sampling",
        "Both estimators cover the area with sixteen strips, whose widths 1/(N p) are shown by colour. If the density"
        " is high where the values are high, all strips have nearly the same area, so the variance is small.",
        (r"X = P^{-1}(\xi), \quad P(x) = \int_a^x p(t)\,dt, \qquad \mathrm{ideal:}\ \ p(x) = f(x) / \int f",),
        importance,
        draw_importance,
        4.8,
        "Strips of equal widths beside strips that are narrow where the sine is high",
    ),
    Figure(
        "A4",
        "race",
        "The race",
        "Both estimates see the same random numbers, and the shaded bands are one standard error wide. The linear"
        " density, which resembles the sine, has a fourteenth of the variance: the other needs fourteen times the"
        " samples for the same error.",
        (
            r"\int_0^{\pi/2} \sin x\,dx = 1, \qquad X_0 = \frac{\pi}{2}\,\xi, \qquad X_1 = \frac{\pi}{2}\sqrt{\xi}",
            (
                r"\mathrm{Var}_0 = \frac{\pi^2}{8} - 1, \qquad \mathrm{Var}_1 = \frac{\pi^2}{16}\,(\gamma + \ln \pi -"
                r" \mathrm{Ci}(\pi)) - 1"
            ),
        ),
        race,
        draw_race,
        4.8,
        "Two running estimates of one with their bands of one standard error",
    ),
)
