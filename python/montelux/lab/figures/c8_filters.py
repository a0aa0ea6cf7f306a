"""C8: pixel filters, sampled by their importance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number
from ..marks import grid

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: Radius in pixels, and the second moment along an axis in pixels squared where it has a closed form.
FILTERS = {
    "box": (0.5, 1 / 12, "1/12"),
    "triangle": (1.0, 1 / 6, "1/6"),
    "gaussian": (1.5, None, ""),
    "mitchell": (2.0, 1 / 9, "1/9"),
    "sinc": (4.0, None, ""),
}
NAMES = {"sinc": "Lanczos (sinc)"}


def filters() -> Outcome:
    """Points that follow each filter's magnitude, and their weights: negative ones in negative lobes."""
    numbers, series = [], {}
    n = 200_000
    for name, (radius, moment, text) in FILTERS.items():
        f = montelux.pixel_filter(name, radius=(radius, radius))
        offset, weight = f.sample(montelux.points("independent", n, 2, seed=7))

        def profile(x, f=f):  # type: ignore[no-untyped-def]
            return f.value(np.stack([x, np.zeros_like(x)], axis=1))

        area = montelux.integrate(profile, (-radius, radius), "midpoint", cells=20_000).value
        if moment is None:
            moment = montelux.integrate(lambda x: profile(x) * x * x, (-radius, radius), "midpoint", cells=20_000).value / area
            text = "its own integral"
        numbers.append(Number(f"{name}: mean weight", weight.mean(), weight.std() / np.sqrt(n) + 1e-6, 1))
        products = weight * offset[:, 0] ** 2
        numbers.append(Number(f"{name}: weighted mean of x²", products.mean(), products.std() / np.sqrt(n), moment, formula=text))
        x = np.linspace(-radius, radius, 401)
        series[name] = (x, profile(x) / area, offset[:, 0], weight)
    return Outcome(numbers, series)


def draw_filters(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(2, 3)
    panels[1, 2].remove()
    for a, (name, (x, value, offset, weight)) in zip(panels.flat, s.items()):
        radius = x[-1]
        for sign, colour in ((1, theme.blue), (-1, theme.orange)):
            count, edges = np.histogram(offset[weight * sign > 0], 48, (-radius, radius))
            height = sign * count / len(offset) / (edges[1] - edges[0]) * np.abs(weight).mean()
            a.bar(edges[:-1], height, edges[1] - edges[0], align="edge", color=colour, alpha=0.5)
        a.plot(x, value, color=theme.ink, linewidth=1.8)
        a.set(title=NAMES.get(name, name), xlabel="pixels")
        grid(a, theme)


FIGURES = (
    Figure(
        "C8",
        "filters",
        "Pixel filters",
        "A pixel's value is an integral over the film, weighted by a filter about its middle; points are drawn as the filter's magnitude, so that most of them fall where it counts. "
        "Mitchell's and Lanczos' filters sharpen by negative lobes (orange), whose points count negative.",
        (r"I = \int f(x, y)\,L(x, y)\,dx\,dy, \qquad p \;\propto\; |f|, \qquad w = f / p",),
        filters,
        draw_filters,
        5.6,
        "Profiles of five filters with histograms of the points drawn for them",
    ),
)
