# SPDX-License-Identifier: GPL-3.0-or-later
"""The World as the latitude-longitude map of --environment."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

CONSTANT_SIZE = (4, 8)  # of the map of a plain colour

# Blender's axes in glTF's world: x, y, z there are x, -z, y here.
BLENDER_FROM_GLTF = np.array([(1, 0, 0), (0, 0, -1), (0, 1, 0)], float)
# Columns: the x, y and z axes of the program's map in glTF's world (docs/meshes.md).
GLTF_FROM_MAP = np.array([(0, -1, 0), (0, 0, 1), (1, 0, 0)], float)


@dataclass(frozen=True)
class World:
    """Light from far away: texels (rows from the bottom, linear RGB) times strength, or those of a plain colour.

    A direction of Blender's world finds its texel after `matrix` and `offset`, the World's Mapping node.
    """

    texels: np.ndarray
    strength: float = 1.0
    matrix: np.ndarray | None = None
    offset: np.ndarray | None = None
    interpolate: bool = True

    @property
    def is_dark(self) -> bool:
        return self.strength <= 0 or not np.any(self.texels > 0)


def environment_map(world: World) -> np.ndarray:
    """Texels of the map, rows from the top, twice as wide as high."""
    height = world.texels.shape[0]
    if world.texels.shape[:2] == (1, 1):
        return np.broadcast_to(world.texels[0, 0] * world.strength, (*CONSTANT_SIZE, 3)).astype(np.float32)
    width = 2 * height
    azimuth = 2 * np.pi * (np.arange(width) + 0.5) / width
    to_blender = BLENDER_FROM_GLTF @ GLTF_FROM_MAP
    picture = np.empty((height, width, 3), np.float32)
    rows_at_once = max(1, (1 << 20) // width)
    for first in range(0, height, rows_at_once):
        rows = np.arange(first, min(height, first + rows_at_once))
        polar = (np.pi * (rows + 0.5) / height)[:, None]
        flat = np.sin(polar)
        directions = np.stack(
            [flat * np.cos(azimuth), flat * np.sin(azimuth), np.broadcast_to(np.cos(polar), (len(rows), width))], -1
        )
        picture[rows] = _look_up(world, directions @ to_blender.T) * world.strength
    return picture


def _look_up(world: World, directions: np.ndarray) -> np.ndarray:
    """Blender's equirectangular projection: the middle is +x, +y a quarter to the left, +z at the top."""
    if world.matrix is not None:
        directions = directions @ world.matrix.T
    if world.offset is not None:
        directions = directions + world.offset
    x, y, z = np.moveaxis(directions, -1, 0)
    height, width = world.texels.shape[:2]
    u = (0.5 - np.arctan2(y, x) / (2 * np.pi)) * width - 0.5
    v = (0.5 + np.arctan2(z, np.hypot(x, y)) / np.pi) * height - 0.5
    if not world.interpolate:
        row = np.clip(np.rint(v).astype(int), 0, height - 1)
        return world.texels[row, np.rint(u).astype(int) % width]
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    s, t = (u - column)[..., None], (v - row)[..., None]
    left, right = column % width, (column + 1) % width
    low, high = np.clip(row, 0, height - 1), np.clip(row + 1, 0, height - 1)
    texels = world.texels
    below = (1 - s) * texels[low, left] + s * texels[low, right]
    above = (1 - s) * texels[high, left] + s * texels[high, right]
    return (1 - t) * below + t * above


def write_pfm(path: Path, picture: np.ndarray) -> None:
    """Rows from the top; in the file they are from the bottom, little-endian."""
    height, width, _ = picture.shape
    with path.open("wb") as file:
        file.write(f"PF\n{width} {height}\n-1.0\n".encode())
        file.write(np.ascontiguousarray(picture[::-1], "<f4").tobytes())
