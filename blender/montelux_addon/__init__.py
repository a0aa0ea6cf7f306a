# SPDX-License-Identifier: GPL-3.0-or-later
"""Montelux as a render engine of Blender."""

import bpy

from . import panels, preferences, settings
from .engine import MonteluxRenderEngine

# For Blender before 4.2, which does not read blender_manifest.toml.
bl_info = {
    "name": "Montelux",
    "author": "The authors of Montelux",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "description": "Renders by Montelux, with the standard error of every pixel",
    "category": "Render",
}

PARTS = (preferences, settings, panels)


def register() -> None:
    for part in PARTS:
        part.register()
    bpy.utils.register_class(MonteluxRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(MonteluxRenderEngine)
    for part in reversed(PARTS):
        part.unregister()
