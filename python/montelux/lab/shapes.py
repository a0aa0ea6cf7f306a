"""The 2-D warps of the library, with what is known of each, and how they are drawn."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from montelux import warp

CONE_COSINE = 0.4
CORNERS = (1.0, 2.0, 0.5, 6.0)


@dataclass(frozen=True)
class Shape:
    """A warp of the unit square, and the mean of a quantity under it in closed form."""

    name: str
    #: 'plane', 'barycentric' or 'sphere'.
    space: str
    warp: Any
    quantity: str
    value: Callable[[Any], Any]
    mean: float
    mean_text: str
    #: Of the image: area or solid angle; None where the density is not uniform.
    measure: float | None


def x_squared(p):  # type: ignore[no-untyped-def]
    return p[:, 0] ** 2


def xy(p):  # type: ignore[no-untyped-def]
    return p[:, 0] * p[:, 1]


def z(p):  # type: ignore[no-untyped-def]
    return p[:, 2]


def z_squared(p):  # type: ignore[no-untyped-def]
    return p[:, 2] ** 2


_FACE = ([0, 0, 0], [-1, -1, 1], [2, 0, 0], [0, 2, 0])
_BILINEAR_MEAN = (CORNERS[0] + 2 * CORNERS[1] + 2 * CORNERS[2] + 4 * CORNERS[3]) / 9 / sum(CORNERS)

SHAPES = (
    Shape("disc, polar", "plane", warp.uniform_disk_polar, "x²", x_squared, 1 / 4, "1/4", math.pi),
    Shape("disc, concentric", "plane", warp.uniform_disk_concentric, "x²", x_squared, 1 / 4, "1/4", math.pi),
    Shape("triangle", "barycentric", warp.uniform_triangle, "b₀b₁", xy, 1 / 12, "1/12", 1 / 2),
    Shape(
        "triangle, low distortion",
        "barycentric",
        warp.uniform_triangle_low_distortion,
        "b₀b₁",
        xy,
        1 / 12,
        "1/12",
        1 / 2,
    ),
    Shape("sphere", "sphere", warp.uniform_sphere, "z²", z_squared, 1 / 3, "1/3", 4 * math.pi),
    Shape("sphere, equal area", "sphere", warp.equal_area_sphere, "z²", z_squared, 1 / 3, "1/3", 4 * math.pi),
    Shape("hemisphere", "sphere", warp.uniform_hemisphere, "z", z, 1 / 2, "1/2", 2 * math.pi),
    Shape("hemisphere, cosine", "sphere", warp.cosine_hemisphere, "z", z, 2 / 3, "2/3", None),
    Shape(
        "cone",
        "sphere",
        warp.uniform_cone(CONE_COSINE),
        "z",
        z,
        (1 + CONE_COSINE) / 2,
        "0.7",
        2 * math.pi * (1 - CONE_COSINE),
    ),
    Shape(
        "spherical triangle",
        "sphere",
        warp.spherical_triangle([1, 0, 0], [0, 1, 0], [0, 0, 1]),
        "z",
        z,
        1 / 2,
        "1/2",
        math.pi / 2,
    ),
    # Its form factor over its solid angle, a sixth of the sphere.
    Shape(
        "spherical rectangle",
        "sphere",
        warp.spherical_rectangle(*_FACE),
        "z",
        z,
        3 * math.sqrt(2) * math.atan(math.sqrt(0.5)) / math.pi,
        "(3√2/π) atan √½",
        4 * math.pi / 6,
    ),
    Shape("bilinear", "plane", warp.bilinear(CORNERS), "xy", xy, _BILINEAR_MEAN, "20/57", None),
)

_TURN, _TILT = math.radians(35), math.radians(28)


def project(shape: Shape, points: Any) -> tuple[Any, Any]:
    """Points (..., coordinates) as they are drawn (..., 2), and whether they face the eye (...)."""
    if shape.space == "sphere":
        x, y, height = np.moveaxis(points, -1, 0)
        a, b = math.cos(_TURN) * x + math.sin(_TURN) * y, -math.sin(_TURN) * x + math.cos(_TURN) * y
        depth = math.cos(_TILT) * a + math.sin(_TILT) * height
        return np.stack([b, math.cos(_TILT) * height - math.sin(_TILT) * a], axis=-1), depth >= 0
    if shape.space == "barycentric":  # the triangle with equal sides
        corners = np.array([[-0.5, 0], [0.5, 0], [0, math.sqrt(0.75)]])
        return points @ corners, np.ones(points.shape[:-1], dtype=bool)
    return points, np.ones(points.shape[:-1], dtype=bool)


def bare(axes: Any, theme: Any, shape: Shape) -> None:
    """Axes of one shape: its outline and its name alone."""
    axes.set(aspect="equal", xticks=[], yticks=[])
    for side in axes.spines.values():
        side.set_visible(False)
    t = np.linspace(0, 2 * np.pi, 200)
    if shape.space == "sphere":
        axes.plot(np.cos(t), np.sin(t), color=theme.faint, linewidth=1)
    axes.set_title(shape.name.replace(", ", ",\n").replace("spherical ", "spherical\n"), fontsize="medium")


def cell_areas(shape: Shape, cells: int, pieces: int) -> Any:
    """Areas (solid angles) of the images of the cells of a grid, shape (cells, cells), in units of the density's.

    Each cell is cut into pieces x pieces, and each piece into two flat triangles.
    """
    n = cells * pieces
    edge = np.linspace(0, 1, n + 1)
    edge[-1] = np.nextafter(1.0, 0.0)
    u = np.stack(np.meshgrid(edge, edge, indexing="ij"), axis=-1)
    p = shape.warp.sample(u)
    if shape.space == "barycentric":
        p = p[..., :2]  # two barycentric coordinates are a triangle of area one half
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    area = _triangle(a, b, c) + _triangle(a, c, d)
    return area.reshape(cells, pieces, cells, pieces).sum(axis=(1, 3))


def _triangle(a: Any, b: Any, c: Any) -> Any:
    if a.shape[-1] == 2:
        u, v = b - a, c - a
        return 0.5 * np.abs(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
    # Solid angle: van Oosterom, Strackee 1983.
    triple = np.abs((a * np.cross(b, c)).sum(-1))
    return 2 * np.arctan2(triple, 1 + (a * b).sum(-1) + (b * c).sum(-1) + (c * a).sum(-1))


def measured_areas(shape: Shape, cells: int = 8, pieces: int = 48) -> tuple[Any, Any]:
    """Areas of cells times their number, and how far the cut into pieces may be off."""
    coarse, fine = (cell_areas(shape, cells, k) * cells**2 for k in (pieces // 2, pieces))
    return fine, _remainder(coarse, fine)


def _remainder(coarse: Any, fine: Any) -> Any:
    # Where the density goes to zero at an edge, as a cosine does, errors fall with the root of the pieces alone.
    return np.abs(fine - coarse) / (np.sqrt(2) - 1) + 1e-9


def mean_of_inverse_density(shape: Shape, cells: int = 8, pieces: int = 48) -> tuple[Any, Any]:
    """The mean of 1/p over each cell by the midpoints of its pieces, and its error."""
    means = []
    for k in (pieces // 2, pieces):
        n = cells * k
        t = (np.arange(n) + 0.5) / n
        u = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
        means.append((1 / shape.warp.pdf(shape.warp.sample(u))).reshape(cells, k, cells, k).mean(axis=(1, 3)))
    return means[1], _remainder(*means)


__all__ = ["SHAPES", "Shape", "bare", "cell_areas", "mean_of_inverse_density", "measured_areas", "project"]
