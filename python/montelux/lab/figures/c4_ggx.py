"""C4: microfacet normals of the GGX law."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

ALPHA = 0.7


def ggx() -> Outcome:
    """P of the angle and its inverse at roughness 0.7, beside the formulas, and D as a density of directions."""
    law = montelux.Distribution.ggx_angle(ALPHA)
    xi = np.linspace(0, 1, 1001)[1:-1]
    theta = law.quantile(xi)
    cosine = np.sqrt((1 - xi) / (xi * (ALPHA**2 - 1) + 1))
    numbers = [
        Number("cos X, farthest from the formula", np.abs(np.cos(theta) - cosine).max(), 2e-15, 0, bound=True),
        Number("P(X(ξ)) − ξ, farthest", np.abs(law.cdf(theta) - xi).max(), 1e-14, 0, bound=True),
        Number("median angle", law.quantile(0.5), 1e-15, np.arctan(ALPHA), bound=True, formula="atan a"),
    ]

    def facing_area(w):  # type: ignore[no-untyped-def]
        c = w[:, 2]
        d = ALPHA**2 / (np.pi * ((ALPHA**2 - 1) * c**2 + 1) ** 2)
        return d * np.maximum(c, 0)

    sphere = montelux.Domain.sphere([0, 0, 0])
    r = montelux.integrate(facing_area, sphere, montelux.Quasi(replicates=32), evaluations=1 << 18, seed=1)
    numbers.append(Number("∫ D cos θ dω over the hemisphere", r.value, r.standard_error, 1, degrees_of_freedom=31))
    angles = law.draw(100_000, seed=2)
    # The integral over c of P(cos X > c) = (1 - c^2) / (1 - k c^2), k = 1 - a^2.
    root = np.sqrt(1 - ALPHA**2)
    exact = (1 - ALPHA**2 * np.arctanh(root) / root) / (1 - ALPHA**2)
    numbers.append(mean_of("mean of cos X", np.cos(angles), exact, "(1 − a² artanh(√k)/√k)/k, k = 1 − a²"))
    return Outcome(numbers, {"law": law, "angles": angles})


def draw_ggx(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a, b = figure.subplots(1, 2)
    quarter = {"xticks": [0, np.pi / 4, np.pi / 2], "xticklabels": ["0", "π/4", "π/2"]}
    t = np.linspace(0, np.pi / 2, 300)
    a.hist(s["angles"], bins=60, range=(0, np.pi / 2), density=True, color=theme.blue, alpha=0.4)
    a.plot(t, s["law"].pdf(t), color=theme.orange, linestyle=(0, (5, 2)), label="p")
    a.plot(t, s["law"].cdf(t), color=theme.ink, label="P")
    a.set(xlabel="θ", xlim=(0, np.pi / 2), ylim=(0, 1.35), **quarter)
    a.legend(loc="upper left")
    xi = np.linspace(0, 1, 500)
    b.plot(xi, s["law"].quantile(xi), color=theme.ink)
    b.set(
        xlabel="ξ",
        ylabel="θ",
        xlim=(0, 1),
        ylim=(0, np.pi / 2),
        yticks=[0, np.pi / 4, np.pi / 2],
        yticklabels=["0", "π/4", "π/2"],
        title="$P^{-1}$",
    )


FIGURES = (
    Figure(
        "C4",
        "ggx",
        "GGX: the angle of microfacet normals",
        "At roughness 0.7 facet normals tilt most often by about 30 degrees, and seldom lie flat. The inverse on the"
        " right turns a uniform number into that angle: half of the numbers give less than atan 0.7, 35 degrees.",
        (
            r"D = \frac{a^2}{\pi\,((a^2 - 1) \cos^2\theta + 1)^2}, \qquad p(h) = D \cos\theta",
            r"\cos\theta = \sqrt{\frac{1 - \xi}{\xi\,(a^2 - 1) + 1}}",
        ),
        ggx,
        draw_ggx,
        4.4,
        "The density and the cumulative function of the angle, and its inverse",
    ),
)
