"""C8: pixel filters, measured by what a picture makes of thin lamps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of
from ..light import rendered
from ..marks import grid

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

FILTERS = {
    "box": montelux.pixel_filter("box", 0.5),
    "triangle": montelux.pixel_filter("triangle", 1.5),
    "Gaussian": montelux.pixel_filter("gaussian", 1.5, sigma=0.5),
    "Mitchell": montelux.pixel_filter("mitchell", 2, b=1 / 3, c=1 / 3),
    "Lanczos": montelux.pixel_filter("lanczos", 4, tau=3),
}
LAMPS, APART, WIDTH = 20, 20, 0.1  # pixels


def formula(name, x):  # type: ignore[no-untyped-def]
    """The filters along one axis, not normalised."""
    x = np.abs(x)
    if name == "box":
        return np.where(x <= 0.5, 1.0, 0)
    if name == "triangle":
        return np.maximum(1.5 - x, 0)
    if name == "Gaussian":
        return np.maximum(np.exp(-2 * x**2) - np.exp(-2 * 1.5**2), 0)
    if name == "Mitchell":  # Mitchell, Netravali 1988, b = c = 1/3
        return np.where(
            x <= 1, 7 * x**3 - 12 * x**2 + 16 / 3, np.where(x <= 2, -7 / 3 * x**3 + 12 * x**2 - 20 * x + 32 / 3, 0)
        )
    return np.where(x <= 4, np.sinc(x) * np.sinc(x / 3), 0)


def lamps():  # type: ignore[no-untyped-def]
    """Their positions: each a twentieth of a pixel farther than the previous one."""
    return (np.arange(LAMPS) + 0.5) * APART + np.arange(LAMPS) / LAMPS


def picture(name, samples=256):  # type: ignore[no-untyped-def]
    """A black picture with thin vertical lamps through a filter: mean and error of its columns."""
    text = (
        'Camera "orthographic" "float screenwindow" [0 400 -8 8]\nFilm "rgb" "integer xresolution" 400 "integer'
        ' yresolution" 16\n'
    )
    text += 'Sampler "sobol"\nIntegrator "path" "integer maxdepth" 1\nWorldBegin\n'
    for x in lamps():
        a, b = x - WIDTH / 2, x + WIDTH / 2
        text += (
            f'AttributeBegin AreaLightSource "diffuse" "rgb L" [{1 / WIDTH} {1 / WIDTH} {1 / WIDTH}] "bool twosided"'
            " true\n"
        )
        text += (
            f'Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [{a} -20 5 {b} -20 5 {b} 20 5 {a} 20 5]'
            " AttributeEnd\n"
        )
    scene = montelux.parse(text)
    scene.film.filter = FILTERS[name]
    r = rendered(scene, samples, seed=3)
    mean, error = (np.asarray(v, dtype=float) for v in (r.mean, r.standard_error))
    # Channels share their samples: errors add up.
    return mean.mean(axis=(0, 2)), np.sqrt((error.mean(axis=2) ** 2).sum(axis=0)) / len(mean)


def filters() -> Outcome:
    """The filters' profiles from their pictures; sums and second moments of these beside the formulas'."""
    numbers, series = [], {}
    # From each lamp to the middles of the nine columns about it: every twentieth of a pixel is met once.
    column = np.floor(lamps()).astype(int)[:, None] + np.arange(-5, 6)
    offset = column + 0.5 - lamps()[:, None]
    for name in FILTERS:
        mean, error = picture(name)
        value, deviation = mean[column], error[column]
        area = montelux.integrate(lambda x: formula(name, x), (-5.5, 5.5), "midpoint", cells=110_000).value
        moment = (
            montelux.integrate(lambda x: formula(name, x) * x**2, (-5.5, 5.5), "midpoint", cells=110_000).value / area
        )
        numbers.append(Number(f"{name}: sum", value.sum() / LAMPS, np.sqrt((deviation**2).sum()) / LAMPS, 1))
        measured = (value * offset**2).sum() / LAMPS
        # A lamp's own width, and the steps of a twentieth between the offsets, add their share.
        numbers.append(
            Number(
                f"{name}: second moment, pixels²",
                measured,
                np.sqrt((deviation**2 * offset**4).sum()) / LAMPS,
                moment + WIDTH**2 / 12,
            )
        )
        order = np.argsort(offset.ravel())
        series[name] = (offset.ravel()[order], value.ravel()[order], deviation.ravel()[order], area)
    return Outcome(numbers, series)


def profile(name, x):  # type: ignore[no-untyped-def]
    """The library's filter along one axis, 1 in the middle."""
    on_axis = np.stack([x, np.zeros_like(x)], axis=-1)
    return FILTERS[name].value(on_axis) / FILTERS[name].value([[0.0, 0.0]])


def draws() -> Outcome:
    """Offsets drawn in proportion to each filter's magnitude, with their weights."""
    numbers, series = [], {}
    u = montelux.points("independent", 100_000, 2, seed=12)
    for name in FILTERS:
        radius = FILTERS[name].radius[0]
        x = np.linspace(-radius, radius, 2001)[1:-1]
        apart = np.abs(profile(name, x) - formula(name, x) / formula(name, np.zeros(1))).max()
        numbers.append(Number(f"{name}: value less its formula, farthest", apart, 3e-6, 0, bound=True))

        def moments(t, name=name):  # type: ignore[no-untyped-def]
            f = formula(name, t)
            return np.stack([f, f * t**2], axis=1)

        area, second = np.asarray(montelux.integrate(moments, (-radius, radius), "midpoint", cells=100_000).value)
        offsets, weights = FILTERS[name].sample(u)
        if name not in ("box", "triangle"):  # there every weight is one
            numbers.append(mean_of(f"{name}: mean weight", weights, 1))
        weighted = weights * offsets[:, 0] ** 2
        numbers.append(mean_of(f"{name}: second moment of weighted offsets, pixels²", weighted, second / area))
        series[name] = (offsets[:, 0], weights, area / float(formula(name, np.zeros(1))[0]))
    return Outcome(numbers, series)


def draw_draws(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(2, 3)
    for a, (name, (x, weights, area)) in zip(panels.flat, s.items()):
        radius = FILTERS[name].radius[0]
        t = np.linspace(-radius, radius, 600)
        bins = np.linspace(-radius, radius, 49)
        width = bins[1] - bins[0]
        a.axhline(0, color=theme.faint, linewidth=1)
        drawn, weighted = np.histogram(x, bins)[0], np.histogram(x, bins, weights=weights)[0]
        a.stairs(drawn / len(x) / width, bins, color=theme.orange, linewidth=1.4, linestyle=(0, (2, 1)))
        a.stairs(weighted / len(x) / width, bins, fill=True, color=theme.blue, alpha=0.45)
        a.plot(t, profile(name, t) / area, color=theme.ink, linewidth=1.6)
        a.set(title=name, xlabel="pixels", xlim=(-radius, radius))
        grid(a, theme)
    legend = panels[1, 2]
    legend.set_axis_off()
    legend.plot([], [], color=theme.ink, label="filter")
    legend.plot([], [], color=theme.orange, linestyle=(0, (2, 1)), label="drawn")
    legend.fill_between([], [], color=theme.blue, alpha=0.45, label="times weights")
    legend.legend(loc="center left")


def draw_filters(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(2, 3)
    panels[1, 2].remove()
    for a, (name, (x, value, error, area)) in zip(panels.flat, s.items()):
        radius = 0.7 if name == "box" else float(FILTERS[name].radius[0]) + 0.3
        t = np.linspace(-radius, radius, 600)
        a.axhline(0, color=theme.faint, linewidth=1)
        a.plot(t, profile(name, t) * formula(name, np.zeros(1)) / area, color=theme.ink, linewidth=1.6)
        seen = np.abs(x) <= radius
        for sign, colour, mark in ((value >= 0, theme.blue, "o"), (value < 0, theme.orange, "s")):
            a.errorbar(
                x[seen & sign],
                value[seen & sign],
                error[seen & sign],
                fmt=mark,
                color=colour,
                markersize=3.5,
                elinewidth=1,
            )
        a.set(title=name, xlabel="pixels", xlim=(-radius, radius))
        grid(a, theme)


FIGURES = (
    Figure(
        "C8",
        "filters",
        "Pixel filters",
        "A pixel's value is an integral over the film, weighted by a filter about its centre: each mark is the value"
        " of a pixel at that distance from a thin bright lamp, and the line is the filter. Mitchell's and Lanczos'"
        " filters sharpen by negative lobes (squares): points are drawn in proportion to the filter's magnitude, and"
        " those in such a lobe have negative weights.",
        (r"I = \int f(x, y)\,L(x, y)\,dx\,dy, \qquad p \;\propto\; |f|, \qquad w = f / p",),
        filters,
        draw_filters,
        6.0,
        "Profiles of five filters, measured and by their formulas",
        slow=True,
        helpers=(formula, lamps, picture),
    ),
    Figure(
        "C8",
        "draws",
        "Points drawn from a pixel filter",
        "Points on the film are drawn in proportion to the filter's magnitude (broken line), each for one pixel only,"
        " so pixels share no noise. Times their weights (filled) they reproduce the filter, including negative lobes."
        " The offset along x is shown, over all offsets along y.",
        (r"p = \frac{|f|}{\int |f|}, \qquad w = \frac{f / \int f}{p}, \qquad E[w] = 1",),
        draws,
        draw_draws,
        6.0,
        "Five filters with histograms of offsets drawn from them, plain and times their weights",
        helpers=(formula, profile),
    ),
)
