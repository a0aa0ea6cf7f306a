# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender's space (z up) to glTF's (y up), in metres of Blender's units."""

from __future__ import annotations

from mathutils import Matrix

GLTF_FROM_BLENDER = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))


def node_matrix(matrix: Matrix) -> list[float]:
    """The `matrix` of a root node that keeps its own axes, as cameras and lights do: both look along -z."""
    placed = GLTF_FROM_BLENDER @ matrix
    return [placed[row][column] for column in range(4) for row in range(4)]


def without_scale(matrix: Matrix) -> Matrix:
    place, turn, _ = matrix.decompose()
    return Matrix.Translation(place) @ turn.to_matrix().to_4x4()
