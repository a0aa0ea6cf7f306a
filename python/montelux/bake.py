"""Tables and prefiltered maps for real-time engines, as `montelux bake` makes them (docs/baking.md).

Arguments are the program's options by the same names. Maps are files, or arrays of shape (height, width, 3): square
ones equal-area, those twice as wide as high equirectangular, unless `layout` ('equirectangular', 'equal-area') says
otherwise. Cubes stand as `up` ('y', 'z'), `mirror` and `turn` (degrees) say.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core

Map = Union[str, "os.PathLike[str]", npt.ArrayLike]
Pixels = npt.NDArray[np.floating[Any]]

__all__ = ["BrdfTable", "Level", "Report", "Row", "brdf_table", "environment", "face_directions", "report", "to_map"]


@dataclass(frozen=True, eq=False)
class BrdfTable:
    """The split sum's second factor: rows by perceptual roughness, the smoothest first; columns by n.v."""

    #: Scale, bias and what `blue` says, shape (size, size, 3).
    values: Pixels
    #: How far quadrature with half as many nodes lies away, which the values' errors are far below.
    errors: Pixels

    @property
    def n_dot_v(self) -> npt.NDArray[np.float64]:
        """Of each column, shape (size,)."""
        return _middles(self.values.shape[1])

    @property
    def roughness(self) -> npt.NDArray[np.float64]:
        """Of each row, shape (size,); alpha is its square."""
        return _middles(self.values.shape[0])


def _middles(size: int) -> npt.NDArray[np.float64]:
    return np.asarray((np.arange(size) + 0.5) / size, dtype=np.float64)


def brdf_table(size: int = 256, *, blue: str = "zero") -> BrdfTable:
    """Scale and bias of GGX: its albedo is F0 * scale + bias. blue: 'zero', 'sheen' or 'average-albedo'."""
    return BrdfTable(*_core.bake_brdf_table(size, blue))


@dataclass(frozen=True, eq=False)
class Level:
    """A level of a prefiltered environment."""

    roughness: float
    #: Faces +X, -X, +Y, -Y, +Z, -Z seen from inside a left-handed cube, shape (6, size, size, 3), and their
    #: standard errors.
    faces: Pixels
    errors: Pixels
    #: Of all texels, and the texels whose error is above the target.
    samples: int
    missed: int
    #: Of the largest channel's error of each texel beside its brightness.
    mean_error: float
    largest_error: float

    @property
    def size(self) -> int:
        """Texels along an edge."""
        return int(self.faces.shape[1])


def environment(
    image: Map,
    size: int = 256,
    levels: int | None = None,
    roughness: str | Sequence[float] = "linear",
    *,
    layout: str = "auto",
    up: str = "y",
    mirror: bool = False,
    turn: float = 0,
    sampling: str = "cells",
    source_mips: bool = False,
    target_error: float | None = None,
    samples: int | None = None,
    samples_max: int | None = None,
    dark_floor: float = 0.01,
    seed: int = 0,
) -> list[Level]:
    """A map blurred by the GGX lobe, level by level: a chain of cube maps.

    roughness: 'linear', 'filament', 'babylon', or that of each level. levels None: down to 16 texels, with 'babylon'
    down to one.
    """
    given = [float(r) for r in roughness] if not isinstance(roughness, str) else roughness
    made = _core.bake_environment(
        image,
        layout=layout,
        up=up,
        mirror=mirror,
        turn=turn,
        size=size,
        levels=levels,
        roughness=given,
        sampling=sampling,
        source_mips=source_mips,
        target_error=target_error,
        samples=samples,
        samples_max=samples_max,
        dark_floor=dark_floor,
        seed=seed,
    )
    return [
        Level(
            level["roughness"],
            np.stack(level["faces"]),
            np.stack(level["errors"]),
            level["samples"],
            level["missed"],
            level["mean_error"],
            level["largest_error"],
        )
        for level in made
    ]


def face_directions(size: int) -> npt.NDArray[np.float64]:
    """Of the middles of a cube's texels, unit vectors of the cube, shape (6, size, size, 3)."""
    return _core.bake_face_directions(size)


def to_map(
    directions: npt.ArrayLike, *, up: str = "y", mirror: bool = False, turn: float = 0
) -> npt.NDArray[np.float64]:
    """Directions of the cube, shape (n, 3), as directions of the map (those of `EnvironmentSampler`)."""
    return _core.bake_to_map(directions, up, mirror, turn)


@dataclass(frozen=True)
class Row:
    """The split sum less the full integral over random surfaces and views of one roughness, n.v and F0."""

    roughness: float
    n_dot_v: float
    f0: float
    #: Mean of the integral, in the mean of channels.
    full: float
    #: Mean of the difference over `full`, and its standard error.
    bias: float
    bias_error: float
    #: Root mean square of the difference over `full`, less what the errors of both sides add to it.
    rms: float


@dataclass(frozen=True, eq=False)
class Report:
    """How far the split sum is from the integral that it approximates."""

    roughness: tuple[float, ...]
    rows: tuple[Row, ...]
    #: Spheres of each roughness seen from -z, shape (len(roughness), size, size, 3), black outside of them: the
    #: full integral, the split sum, and the size of their difference; each with its standard errors.
    full: Pixels
    full_errors: Pixels
    split: Pixels
    split_errors: Pixels
    difference: Pixels
    difference_errors: Pixels


def report(
    image: Map,
    *,
    layout: str = "auto",
    up: str = "y",
    mirror: bool = False,
    turn: float = 0,
    roughness: Sequence[float] | None = None,
    n_dot_v: Sequence[float] | None = None,
    f0: Sequence[float] | None = None,
    orientations: int = 64,
    sphere_size: int = 0,
    sphere_f0: float = 1,
    target_error: float = 0.01,
    samples_max: int = 1 << 16,
    seed: int = 0,
) -> Report:
    """The split sum beside the full integral, in a table and on spheres."""
    lists = ([float(v) for v in given] if given is not None else None for given in (roughness, n_dot_v, f0))
    used, rows, values, errors = _core.bake_report(
        image,
        layout=layout,
        up=up,
        mirror=mirror,
        turn=turn,
        **dict(zip(("roughness", "n_dot_v", "f0"), lists)),
        orientations=orientations,
        sphere_size=sphere_size,
        sphere_f0=sphere_f0,
        target_error=target_error,
        samples_max=samples_max,
        seed=seed,
    )
    parts = []
    for k in range(3):
        for picture in (values, errors):
            band = picture[k * sphere_size : (k + 1) * sphere_size] if picture is not None else np.zeros((0, 0, 3))
            parts.append(band.reshape(sphere_size, len(used), sphere_size, 3).swapaxes(0, 1))
    return Report(tuple(used), tuple(Row(*row) for row in rows), *parts)
