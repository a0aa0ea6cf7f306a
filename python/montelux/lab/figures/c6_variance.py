"""C6: the variance of each way to find the light of an environment map."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import mean_of
from ..marks import grid
from ..sky import axes_of, parts_of_pixels, rough_mirror, sky

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: A surface that both the sun and the lamp light, seen at 45 degrees, in its own frame.
SURFACE = axes_of([-0.25, -0.15, 0.6])
VIEW = np.array([np.sqrt(0.5), 0, np.sqrt(0.5)])
ALPHA = 0.3
WAYS = (
    ("directions of the surface", "", False),
    ("light: tabulated", "tabulated", False),
    ("light: median-cut", "median-cut", False),
    ("light: structured", "structured", False),
    ("both: tabulated", "tabulated", False),
    ("both: tabulated, compensated", "tabulated", True),
    ("both: median-cut", "median-cut", False),
    ("both: median-cut, compensated", "median-cut", True),
    ("both: structured", "structured", False),
    ("both: structured, compensated", "structured", True),
)


class Diffuse:
    """A white surface of Lambert: f n.l, and directions with density q in proportion to it."""

    @staticmethod
    def reflected(w):  # type: ignore[no-untyped-def]
        return np.maximum(w[..., 2], 0) / np.pi

    @staticmethod
    def sample(u):  # type: ignore[no-untyped-def]
        return montelux.warp.cosine_hemisphere.sample(u)

    q = reflected


class Glossy:
    """A rough mirror of alpha 0.3: directions by the normals that are seen."""

    normals = montelux.warp.ggx_visible_normals(ALPHA, [float(v) for v in VIEW])

    @staticmethod
    def reflected(w):  # type: ignore[no-untyped-def]
        return rough_mirror(VIEW, w, ALPHA)

    @classmethod
    def sample(cls, u):  # type: ignore[no-untyped-def]
        h = cls.normals.sample(u)
        return 2 * (h @ VIEW)[..., None] * h - VIEW

    @classmethod
    def q(cls, w):  # type: ignore[no-untyped-def]
        h = w + VIEW
        h = h / np.linalg.norm(h, axis=-1, keepdims=True)
        return cls.normals.pdf(h) / (4 * (h @ VIEW))


SURFACES: dict[str, Any] = {"diffuse": Diffuse, "glossy, α = 0.3": Glossy}


@functools.cache
def everywhere(surface):  # type: ignore[no-untyped-def]
    """2 x 2 directions in each pixel with their solid angles; there what is reflected, and the surface's density."""
    image, n = sky(), 2
    sampler = montelux.EnvironmentSampler(image)
    directions = sampler.direction(parts_of_pixels(image, n))
    omega, L = (a.repeat(n, axis=0).repeat(n, axis=1) for a in (sampler.solid_angles / n**2, image.mean(axis=-1)))
    w = directions @ SURFACE.T
    f = L * surface.reflected(w)
    return directions, omega, f, np.where(f > 0, surface.q(w), 0)


def quadrature(surface, sampler, way):  # type: ignore[no-untyped-def]
    """The integral of what is reflected, and the variance of its estimate."""
    directions, omega, f, q = everywhere(surface)
    p = sampler.pdf(directions)
    by_map, by_surface = way.startswith(("light", "both")), way.startswith(("directions", "both"))
    density = by_map * p + by_surface * q
    ratio = np.divide(f, density, out=np.zeros_like(f), where=density > 0)
    variance = 0.0
    for own in (p,) * by_map + (q,) * by_surface:  # each of the two directions has its own
        variance += (ratio**2 * own * omega).sum() - (ratio * own * omega).sum() ** 2
    return (f * omega).sum(), variance


def variance() -> Outcome:
    """The variance of a sample by each way, beside quadrature; a sample of both is two directions."""
    image, n = sky(), 1 << 15
    numbers, series = [], {}
    for k, (way, sampling, compensation) in enumerate(WAYS):
        sampler = montelux.EnvironmentSampler(image, sampling=sampling or "auto", compensation=compensation)
        for name, surface in SURFACES.items():
            exact, exact_variance = quadrature(surface, sampler, way)
            if way.startswith("directions"):  # they meet the sun too seldom to know their own noise
                series[name, way] = (exact_variance / exact**2, 0.0)
                continue
            u = montelux.points("independent", n, 4, seed=20 + k)
            w, p = sampler.sample(u[:, :2])
            own = w @ SURFACE.T
            f = sampler.radiance(w).mean(axis=-1) * surface.reflected(own)
            if way.startswith("both"):
                p = p + np.where(f > 0, surface.q(own), 0)
            value = f / p
            if way.startswith("both"):
                own = surface.sample(u[:, 2:])
                w = own @ SURFACE
                f = sampler.radiance(w).mean(axis=-1) * surface.reflected(own)
                value += f / (sampler.pdf(w) + np.where(f > 0, surface.q(own), 1))
            numbers.append(mean_of(f"{name}, {way}: mean", value, exact))
            measured = mean_of(f"{name}, {way}: variance", (value - exact) ** 2, exact_variance)
            numbers.append(measured)
            series[name, way] = (measured.measured / exact**2, measured.error / exact**2)
    return Outcome(numbers, {"noise": series})


def draw_variance(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    a = figure.subplots()
    for name, colour, mark, shift in (
        ("diffuse", theme.blue, "o", -0.15),
        ("glossy, α = 0.3", theme.orange, "s", 0.15),
    ):
        for i, (way, _, compensation) in enumerate(WAYS):
            noise, error = s["noise"][name, way]
            a.errorbar(
                noise,
                i + shift,
                xerr=error,
                fmt=mark,
                color=colour,
                markersize=8,
                markerfacecolor=colour if compensation else theme.paper,
                markeredgewidth=2,
                label=name if compensation and "tabulated" in way else None,
            )
    a.set(xscale="log", xlabel="variance of a sample over its mean²", ylim=(len(WAYS) - 0.5, -0.5))
    a.set_yticks(range(len(WAYS)), [way for way, *_ in WAYS])
    a.legend(loc="lower right")
    grid(a, theme)


FIGURES = (
    Figure(
        "C6",
        "variance",
        "How noisy each way is",
        "Light reflected by a surface under this sky. For the glossy one neither directions of the surface nor those"
        " to the light are good alone, but both together are. Compensation (filled marks) removes directions to the"
        " light where the surface's own ones go anyway. The first row is by quadrature: its directions hit the sun too"
        " rarely to measure their noise.",
        (
            r"F = \frac{f(\omega_1)}{p(\omega_1) + q(\omega_1)} + \frac{f(\omega_2)}{p(\omega_2) + q(\omega_2)},"
            r" \qquad \omega_1 \sim p,\ \omega_2 \sim q",
        ),
        variance,
        draw_variance,
        5.6,
        "Marks of the variance of ten ways for two surfaces",
        slow=True,
        helpers=(sky, rough_mirror, everywhere, quadrature),
    ),
)
