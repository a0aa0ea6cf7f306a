"""B5: the quadratic density."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme


def quadratic() -> Outcome:
    """The cube root of uniform numbers in [-1, 1)."""
    law = montelux.Distribution.quadratic()
    xi = montelux.points("independent", 100_000, 1, seed=7)[:, 0]
    x = law.sample(xi)
    numbers = [
        Number("X and ∛(2ξ − 1), farthest apart", np.abs(x - np.cbrt(2 * xi - 1)).max(), 1e-15, 0, bound=True),
        mean_of("mean of x", x, 0),
        mean_of("mean of x²", x**2, 3 / 5, "3/5"),
        mean_of("mean of x⁴", x**4, 3 / 7, "3/7"),
    ]
    return Outcome(numbers, {"x": x, "law": law})


def draw_quadratic(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2)
    t = np.linspace(-1, 1, 200)
    a.hist(s["x"], bins=50, range=(-1, 1), density=True, color=theme.blue, alpha=0.5)
    a.plot(t, s["law"].pdf(t), color=theme.ink)
    a.set(xlabel="x", ylabel="density")
    xi = np.linspace(0, 1, 401)
    b.plot(xi, s["law"].quantile(xi), color=theme.ink)
    for k, u in enumerate(np.linspace(0.05, 0.95, 10)):
        v = float(s["law"].quantile(u))
        b.plot([u, u, 0], [-1, v, v], color=theme.cycle[k % 2], linewidth=1.2)
    b.set(xlabel="ξ", ylabel="X(ξ)", xlim=(0, 1), ylim=(-1, 1))


FIGURES = (
    Figure(
        "B5",
        "quadratic",
        "The quadratic density",
        "Samples gather at both ends and leave the middle empty. On the right, uniform numbers that are equally far"
        " apart go up to the curve and across: where it is flat they crowd, where it is steep they spread.",
        (
            (
                r"p(x) = \frac{3}{2} x^2 \ \mathrm{on}\ [-1, 1], \qquad P(x) = \frac{x^3 + 1}{2}, \qquad X = (2 \xi -"
                r" 1)^{1/3}"
            ),
        ),
        quadratic,
        draw_quadratic,
        4.4,
        "A histogram that is high at both ends, and the curve of the cube root with lines from equally spaced numbers",
    ),
)
