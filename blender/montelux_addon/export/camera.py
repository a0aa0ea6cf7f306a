# SPDX-License-Identifier: GPL-3.0-or-later
"""The active camera, and the film behind it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
from mathutils import Matrix

from ..run.command import Film
from .errors import ExportError
from .space import node_matrix, without_scale

NAME = "montelux camera"


@dataclass(frozen=True)
class Camera:
    gltf: dict
    matrix: Matrix
    film: Film
    name: str = NAME

    def node(self, index: int) -> dict:
        return {"name": self.name, "camera": index, "matrix": node_matrix(self.matrix)}


@dataclass(frozen=True)
class Window:
    """Whole pixels of the picture that Blender expects, from the bottom left of the full one."""

    width: int
    height: int
    x0: int
    y0: int
    x1: int
    y1: int


def window_of(render: bpy.types.RenderSettings) -> Window:
    """The size by percentage, and the border, rounded as Blender does."""
    width = max(1, render.resolution_x * render.resolution_percentage // 100)
    height = max(1, render.resolution_y * render.resolution_percentage // 100)
    if not render.use_border:
        return Window(width, height, 0, 0, width, height)
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    if x1 <= x0 or y1 <= y0:
        raise ExportError("The render region contains no pixel")
    return Window(width, height, x0, y0, x1, y1)


def export_camera(scene: bpy.types.Scene, camera: bpy.types.Object, warnings: list[str]) -> Camera:
    """`camera`: evaluated."""
    data = camera.data
    if data.type not in ("PERSP", "ORTHO"):
        raise ExportError(f"Camera '{camera.name}' is panoramic; use a perspective or an orthographic one")
    if data.dof.use_dof:
        warnings.append(f"Camera '{camera.name}': depth of field is ignored, everything is in focus")
    window = window_of(scene.render)
    corners = data.view_frame(scene=scene)
    left, right = min(c.x for c in corners), max(c.x for c in corners)
    bottom, top = min(c.y for c in corners), max(c.y for c in corners)

    # glTF's cameras look through the middle of their film. A shifted lens is a part of a larger film, to whole pixels.
    shift_x = round((left + right) / 2 / (right - left) * window.width)
    shift_y = round((bottom + top) / 2 / (top - bottom) * window.height)
    width, height = window.width + 2 * abs(shift_x), window.height + 2 * abs(shift_y)
    from_left = abs(shift_x) + shift_x
    from_top = abs(shift_y) - shift_y
    film = Film(
        width,
        height,
        from_left + window.x0,
        from_top + window.height - window.y1,
        from_left + window.x1,
        from_top + window.height - window.y0,
    )
    half_width = (right - left) / 2 * width / window.width
    half_height = (top - bottom) / 2 * height / window.height
    matrix = without_scale(camera.matrix_world)
    if data.type == "ORTHO":
        lens = {"xmag": half_width, "ymag": half_height, "znear": data.clip_start, "zfar": data.clip_end}
        return Camera({"type": "orthographic", "orthographic": lens}, matrix, film)
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        warnings.append("The aspect of the pixels is ignored under a perspective camera: they are square")
    yfov = 2 * math.atan(half_width * height / width / abs(corners[0].z))
    lens = {"yfov": yfov, "aspectRatio": width / height, "znear": data.clip_start}
    return Camera({"type": "perspective", "perspective": lens}, matrix, film)
