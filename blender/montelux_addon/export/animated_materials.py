# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as they are at the frame of the render.

Meshes can have the user's materials, whose animated values are those of the viewport's frame. Materials that are
animated are copied for the export, with the values that were evaluated for the render.
"""

from __future__ import annotations

import bpy


class AnimatedMaterials:
    """Stands in for animated materials until remove()."""

    def __init__(self) -> None:
        self._copies: dict[bpy.types.Material, bpy.types.Material] = {}

    def stand_in(self, material: bpy.types.Material | None) -> bpy.types.Material | None:
        """`material`: evaluated. The user's own where it is not animated."""
        if material is None:
            return None
        own = material.original
        if not _is_animated(own):
            return own
        if own not in self._copies:
            self._copies[own] = _frozen_copy(own, material)
        return self._copies[own]

    def remove(self) -> None:
        for copy in self._copies.values():
            bpy.data.materials.remove(copy, do_unlink=True)
        self._copies.clear()


def _is_animated(material: bpy.types.Material) -> bool:
    return any(data is not None and data.animation_data is not None for data in (material, material.node_tree))


def _frozen_copy(own: bpy.types.Material, evaluated: bpy.types.Material) -> bpy.types.Material:
    copy = own.copy()
    copy.animation_data_clear()
    if copy.node_tree is None or evaluated.node_tree is None:
        return copy
    copy.node_tree.animation_data_clear()
    for node in copy.node_tree.nodes:
        source = evaluated.node_tree.nodes[node.name]
        for to, of in zip([*node.inputs, *node.outputs], [*source.inputs, *source.outputs]):
            if hasattr(to, "default_value"):
                to.default_value = of.default_value
    return copy
