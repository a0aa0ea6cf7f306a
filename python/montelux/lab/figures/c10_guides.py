"""C10: what a guide learns in a room."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import mean_of
from ..light import displayed, luminance, same_mean, scene
from ..sky import show

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

#: Points of the floor of scenes/doorway.pbrt, as (x, z) in metres.
POINTS = ((1.6, 1.5), (1.9, -0.8), (0.5, 0.3), (-1.3, 1.1))
#: Pixels of a disc of directions across, and samples of each pixel of a map of the light.
ACROSS, SAMPLES = 64, 512
#: The walls as (x, z) of their ends; the lamp.
WALLS = (((-2, -1.5), (2.5, -1.5), (2.5, 2), (-2, 2), (-2, -1.5)), ((0, -1.5), (0, 0.7)), ((0, 1.3), (0, 2)))
LAMP = (-1, -0.8)


def disc(across: int = ACROSS) -> tuple[Any, Any]:
    """Directions of the upper half as a disc seen from above, equal areas for equal solid angles; where it is."""
    t = 2 * (np.arange(across) + 0.5) / across - 1
    x, z = np.meshgrid(t, t)
    r2 = x**2 + z**2
    sine = np.sqrt(np.maximum(2 - r2, 0))  # over the radius
    return np.stack([x * sine, 1 - r2, z * sine], axis=-1), r2 < 1


def light_at(point, samples):  # type: ignore[no-untyped-def]
    """The light that arrives at a point of the floor but straight from the lamp: a map of (32, 64) directions."""
    x, z = point
    s = scene("doorway")
    s.camera = montelux.SphericalCamera(mapping="equirectangular", look_at=((x, 1e-3, z), (x, 1e-3, z + 1), (0, 1, 0)))
    s.film.resolution = 64, 32
    all_light = luminance(s.render(spp=samples, seed=5).mean)
    s.integrator.max_depth = 0
    return np.maximum(all_light - luminance(s.render(spp=samples, seed=5).mean), 0)


def looked_up(light, directions):  # type: ignore[no-untyped-def]
    """What a latitude-longitude map shows in directions."""
    height, width = light.shape
    x, y, z = np.moveaxis(directions, -1, 0)
    row = np.arccos(np.clip(y, -1, 1)) / np.pi * height
    column = np.arctan2(z, x) % (2 * np.pi) / (2 * np.pi) * width
    return light[np.minimum(row.astype(int), height - 1), np.minimum(column.astype(int), width - 1)]


def relative_variance(light, density, cosine):  # type: ignore[no-untyped-def]
    """Of one sample of the light on the floor, by directions of a density, over equal parts of the half-space."""
    f, omega = light * cosine, 2 * np.pi / len(light)
    mean = (f * omega).sum()
    return float((f**2 / density * omega).sum() / mean**2 - 1)


def guides() -> Outcome:
    """A guide trained by a render of two rooms; at four points of the floor its directions, and the light there."""
    s = scene("doorway")
    plain = s.render(spp=256, seed=8).wait()
    s.integrator.guiding = "on"
    guided = s.render(spp=256, seed=7).wait()
    guide = guided.guide
    assert guide is not None
    numbers = [same_mean("mean of the guided picture over the plain one, less 1", guided, plain)]
    sphere = montelux.warp.equal_area_sphere.sample(montelux.points("independent", 1 << 16, 2, seed=2))
    directions, inside = disc()
    found = []
    for i, (x, z) in enumerate(POINTS):
        point, up = (x, 0, z), (0, 1, 0)
        numbers.append(
            mean_of(f"point {i + 1}: its density, over the sphere", 4 * np.pi * guide.pdf(point, up, sphere), 1)
        )
        light, learned = (looked_up(light_at((x, z), SAMPLES), directions), guide.pdf(point, up, directions))
        cosine, share = directions[inside][:, 1], guide.share(point, up)
        both = share * learned[inside] + (1 - share) * cosine / np.pi
        variances = [relative_variance(light[inside], p, cosine) for p in (cosine / np.pi, both)]
        found.append({"light": light * directions[..., 1], "learned": learned, "share": share, "variances": variances})
    sides, bounds = guide.cells()
    floor = [b for side, b in zip(sides, bounds) if side == "+y" and b[0, 1] <= 0 <= b[1, 1]]
    return Outcome(numbers, {"found": found, "cells": floor, "inside": inside, "picture": guided.mean})


def draw_guides(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    parts: Any = figure.subfigures(1, 2, width_ratios=[1.25, 1])
    left, right = parts
    view, a = left.subplots(2, 1, height_ratios=[1, 1.3])
    show(view, displayed(s["picture"], 0.25 / luminance(s["picture"]).mean()))
    view.set_title("the right room")
    (x0, z0), (x1, z1) = (-2, -1.5), (2.5, 2)
    for low, high in s["cells"]:
        west, east = np.clip((low[0], high[0]), x0, x1)
        north, south = np.clip((low[2], high[2]), z0, z1)
        a.plot([west, east, east, west, west], [north, north, south, south, north], color=theme.faint, linewidth=0.8)
    for wall in WALLS:
        a.plot(*np.transpose(wall), color=theme.ink, linewidth=3, solid_capstyle="projecting")
    a.plot(*LAMP, "*", color=theme.orange, markersize=18)
    for i, point in enumerate(POINTS):
        a.plot(*point, "o", color=theme.blue, markersize=17)
        a.annotate(str(i + 1), point, color=theme.paper, ha="center", va="center", fontsize=12, fontweight="bold")
    a.set(aspect="equal", xticks=[], yticks=[], xlim=(x0 - 0.05, x1 + 0.05), ylim=(z1 + 0.05, z0 - 0.05))
    a.set_title("floor, its cells, the lamp")
    for side in a.spines.values():
        side.set_visible(False)
    axes = right.subplots(len(POINTS), 2)
    t = np.linspace(0, 2 * np.pi, 100)
    for i, (row, f) in enumerate(zip(axes, s["found"])):
        for a, name in zip(row, ("learned", "light")):
            values = np.where(s["inside"], f[name], np.nan)
            a.imshow(
                np.sqrt(values / np.nanquantile(values, 0.995)), cmap=theme.map, vmin=0, vmax=1, extent=(-1, 1, 1, -1)
            )
            a.plot(np.cos(t), np.sin(t), color=theme.faint, linewidth=1)
            a.set(xticks=[], yticks=[], xlim=(-1.04, 1.04), ylim=(1.04, -1.04), aspect="equal")
            for side in a.spines.values():
                side.set_visible(False)
            if i == 0:
                a.set_title({"learned": "guide", "light": "light × cosine"}[name], fontsize="medium")
        row[0].set_ylabel(str(i + 1), rotation=0, labelpad=12, va="center")
        before, after = f["variances"]
        row[1].set_xlabel(f"variance {before:.2g} → {after:.2g}", fontsize=10)


FIGURES = (
    Figure(
        "C10",
        "guides",
        "What a guide learns",
        "A lamp in the left room lights the right one by way of the doorway alone. Paths have taught a guide where light"
        " comes from: space is cut into cells, small where many paths went, and each has a density of directions of its"
        " own. The discs are the half-space above four points of the floor, seen from above. Beside each density is what"
        " the point reflects of each direction, by brute force; without light straight from the lamp, which is left to"
        " samples of the lamp. Variances are relative and of one sample of that: by the cosine alone, and with the share of"
        " the guide. After Mueller, Gross and Novak (2017) and Rath et al. (2020).",
        (r"p(\omega) = \alpha\,p_{guide}(\omega) + (1 - \alpha)\,p_{bsdf}(\omega)",),
        guides,
        draw_guides,
        7.4,
        "A room, the plan of two rooms with the cells of a guide, and discs of directions at four points beside the light there",
        slow=True,
        helpers=(disc, light_at, looked_up, relative_variance),
    ),
)
