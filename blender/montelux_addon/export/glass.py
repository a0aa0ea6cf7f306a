# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass is solid: Blender's transmission bends light at every surface, that of glTF crosses a thin sheet."""

from __future__ import annotations

from .glb import Glb


def make_glass_solid(glb: Glb) -> None:
    """Gives materials that transmit a volume, without which glTF means a sheet (docs/gltf.md)."""
    for material in glb.json.get("materials", []):
        extensions = material.get("extensions", {})
        if "KHR_materials_transmission" in extensions and "KHR_materials_volume" not in extensions:
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1}
            glb.use_extension("KHR_materials_volume")
