"""A3: general Monte Carlo, with points of any density."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import of
from ..marks import STROKES

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

DENSITIES = {
    "uniform": montelux.Distribution.uniform(0, np.pi / 2),
    "falling": montelux.Distribution.tabulated([0, np.pi / 2], [5, 1]),
    "bump": montelux.Distribution.normal(0.8, 0.6).truncated(0, np.pi / 2),
}


def general() -> Outcome:
    """The integral of sin x over [0, pi/2] by points of three densities; then by one that leaves a half of it out."""
    numbers = []
    for name, density in DENSITIES.items():
        r = montelux.integrate(np.sin, (0, np.pi / 2), "importance", technique=density, evaluations=200_000, seed=5)
        numbers.append(of(f"{name} density", r, 1))
    # A density that is zero where the function is not: the estimate misses that part and has a warning.
    half = montelux.Distribution.uniform(0, np.pi / 4)
    r = montelux.integrate(np.sin, (0, np.pi / 2), "importance", technique=half, evaluations=200_000, seed=5)
    numbers.append(of("uniform on [0, π/4) alone (with a warning)", r, 1 - np.sqrt(0.5), "1 − √½"))
    points = DENSITIES["falling"].draw(16, seed=2)
    return Outcome(numbers, {"points": points, "warning": r.warnings[0] if r.warnings else ""})


def draw_general(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm

    a, b = figure.subplots(1, 2, width_ratios=[1, 1.25])
    x = np.linspace(0, np.pi / 2, 300)
    for i, name in enumerate(("uniform", "falling", "bump")):
        a.plot(x, DENSITIES[name].pdf(x), color=theme.cycle[i], linestyle=STROKES[i], label=name)
    a.set(title="densities p", xlabel="x", ylim=(0, 1.6), xticks=[0, np.pi / 2], xticklabels=["0", "π/2"])
    a.legend()
    p = DENSITIES["falling"]
    widths = 1 / (16 * p.pdf(s["points"]))
    scale = ScalarMappable(LogNorm(0.5, 8), theme.map)
    for v, w in sorted(zip(s["points"], widths), key=lambda t: -t[1]):
        b.bar(v, np.sin(v), w, color=scale.to_rgba(16 * w), alpha=0.55, edgecolor=theme.ink, linewidth=0.8)
    b.plot(x, np.sin(x), color=theme.ink)
    b.set(
        title="16 points of the falling one",
        xlabel="x",
        ylabel="sin x",
        ylim=(0, 1.05),
        xlim=(-0.1, np.pi / 2 + 0.3),
        xticks=[0, np.pi / 2],
        xticklabels=["0", "π/2"],
    )
    figure.colorbar(scale, ax=b, label="1 / p", ticks=[0.5, 1, 2, 4, 8], format="%g").minorticks_off()


FIGURES = (
    Figure(
        "A3",
        "general",
        "General Monte Carlo",
        "Points may follow any density that is not zero where the function is not. Where they are rare, each has a"
        " larger weight 1/p, the width of its strip. A density that omits a part misses that part of the integral; the"
        " library checks for this and warns.",
        (r"\langle F^N \rangle = \frac{1}{N} \sum_{i=1}^{N} \frac{f(X_i)}{p(X_i)}, \qquad X_i \sim p",),
        general,
        draw_general,
        4.6,
        "Three densities, and strips of different widths at points of a falling density",
    ),
)
