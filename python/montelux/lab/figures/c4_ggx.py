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


VIEW = np.array([np.sin(np.radians(70)), 0, np.cos(np.radians(70))])
N = 100_000


def mask(w):  # type: ignore[no-untyped-def]
    """Smith's Lambda of directions (Walter et al. 2007, equation 34): G1 = 1 / (1 + Lambda)."""
    tangent_squared = (1 - w[:, 2] ** 2) / w[:, 2] ** 2
    return 0.5 * (np.sqrt(1 + ALPHA**2 * tangent_squared) - 1)


def weight(m, visible):  # type: ignore[no-untyped-def]
    """What a mirror-like facet with normal m reflects of the light, over the density that m was drawn from."""
    cosine = m @ VIEW
    wi = 2 * cosine[:, None] * m - VIEW
    up = (cosine > 0) & (wi[:, 2] > 1e-6)
    wi[~up] = VIEW  # any direction above: its weight is nothing
    lambda_o = mask(VIEW[None, :])
    both = 1 / (1 + lambda_o + mask(wi))
    w = both * (1 + lambda_o) if visible else both * cosine / (VIEW[2] * m[:, 2])
    return np.where(up, w, 0)


def visible() -> Outcome:
    """How much a rough mirror reflects, seen at 70 degrees: by all facets, and by those that are seen."""
    every = montelux.warp.ggx_normals(ALPHA)
    seen = montelux.warp.ggx_visible_normals(ALPHA, [float(v) for v in VIEW])
    sphere = montelux.Domain.sphere([0, 0, 0])
    quasi = montelux.Quasi(replicates=32)
    r = montelux.integrate(lambda m: seen.pdf(m), sphere, quasi, evaluations=1 << 18, seed=1)
    numbers = [Number("∫ p dω, normals that are seen", r.value, r.standard_error, 1, degrees_of_freedom=31)]
    above = montelux.warp.ggx_visible_normals(ALPHA, [0, 0, 1])
    grid = montelux.warp.uniform_hemisphere.sample(montelux.points("halton", 1000, 2))
    apart = np.abs(above.pdf(grid) - every.pdf(grid)).max()
    numbers.append(Number("seen from above, p less D cos θ, farthest", apart, 1e-6, 0, bound=True))
    drawn = {
        "all": every.sample(montelux.points("independent", N, 2, seed=5)),
        "seen": seen.sample(montelux.points("independent", N, 2, seed=6)),
    }
    weights = {name: weight(m, name == "seen") for name, m in drawn.items()}

    def two_moments(u):  # type: ignore[no-untyped-def]
        a, b = weight(every.sample(u), False), weight(seen.sample(u), True)
        return np.stack([b, a**2, b**2], axis=1)

    r = montelux.integrate(two_moments, [(0, 1), (0, 1)], quasi, evaluations=1 << 18, seed=2)
    albedo, *squares = np.asarray(r.value)
    error, *square_errors = np.asarray(r.standard_error)
    for (name, w), square, square_error in zip(weights.items(), squares, square_errors):
        n = mean_of(f"reflected, {name}", w, albedo)
        numbers.append(Number(n.name, n.measured, np.hypot(n.error, error), albedo, degrees_of_freedom=31))
        variance = square - albedo**2
        deviations = (w - w.mean()) ** 2
        own = deviations.std() / np.sqrt(N)
        numbers.append(
            Number(
                f"variance of a weight, {name}",
                deviations.mean(),
                np.sqrt(own**2 + square_error**2 + (2 * albedo * error) ** 2),
                variance,
                degrees_of_freedom=31,
            )
        )
    unseen = float((drawn["seen"] @ VIEW <= 0).mean())
    numbers.append(Number("share that faces away, of those that are seen", unseen, 0, 0, bound=True))
    return Outcome(numbers, {"drawn": drawn, "weights": weights})


def draw_visible(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(1, 3)
    t = np.linspace(0, 2 * np.pi, 200)
    for a, (name, m) in zip(panels, s["drawn"].items()):
        away = m @ VIEW <= 0
        for which, colour, mark in ((~away, theme.blue, "o"), (away, theme.orange, "x")):
            x, y = m[:2500][which[:2500], :2].T
            a.plot(
                x, y, mark, color=colour, markersize=2.6 if mark == "o" else 4, markeredgewidth=0 if mark == "o" else 1
            )
        a.plot(np.cos(t), np.sin(t), color=theme.faint, linewidth=1)
        a.annotate("", (1.0, 0), (1.45, 0), arrowprops={"arrowstyle": "<-", "color": theme.ink, "linewidth": 2})
        a.annotate("$\\omega_o$", (1.2, 0.08), color=theme.ink)
        a.set(aspect="equal", xlim=(-1.05, 1.5), ylim=(-1.05, 1.05), xticks=[], yticks=[], title=name)
        for side in a.spines.values():
            side.set_visible(False)
    b = panels[2]
    bins = np.linspace(0, 2.5, 51)
    for (name, w), colour, stroke in zip(s["weights"].items(), (theme.orange, theme.blue), ((0, (5, 2)), "-")):
        b.hist(w, bins=bins, density=True, histtype="step", color=colour, linestyle=stroke, label=name, linewidth=2)
    b.set(xlabel="weight", yscale="log", xlim=(0, 2.5))
    b.legend(loc="upper right")


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
    Figure(
        "C4",
        "visible",
        "GGX: the normals that are seen",
        "Seen from the right, 20 degrees above the surface, many facets face away (crosses), and facets that are"
        " turned to the eye cover more of the view than their share of the number. Sampling the visible ones wastes"
        " none, and the weights never exceed one, so their variance is far smaller.",
        (
            r"p(m) = \frac{G_1(\omega_o)\, \max(0, \omega_o \cdot m)\, D(m)}{\cos\theta_o}, \qquad G_1 ="
            r" \frac{1}{1 + \Lambda(\omega_o)}",
            r"\Lambda = \frac{-1 + \sqrt{1 + a^2 \tan^2\theta_o}}{2}, \qquad w = \frac{G_2}{G_1} \leq 1",
        ),
        visible,
        draw_visible,
        4.0,
        "Two discs of normals, drawn by their number and as they are seen, and the histogram of their weights",
        helpers=(mask, weight),
    ),
)
