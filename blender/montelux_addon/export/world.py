# SPDX-License-Identifier: GPL-3.0-or-later
"""The World's background, read from its nodes."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Euler

from .environment_map import World


def export_world(scene: bpy.types.Scene, warnings: list[str]) -> World | None:
    """`scene`: evaluated. None: there is no light from far away."""
    world = scene.world
    if world is None:
        return None
    if not world.use_nodes or world.node_tree is None:
        return _plain(world.color, 1)
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    if output is None:
        return None
    if output.inputs["Volume"].is_linked:
        warnings.append(f"World '{world.name}': its volume is ignored")
    background = _source(output.inputs["Surface"])
    if background is None:
        return None
    try:
        return _read_background(background)
    except _Unsupported as reason:
        warnings.append(f"World '{world.name}' gives no light: {reason}")
        return None


class _Unsupported(Exception):
    pass


def _source(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    links = socket.links
    node = links[0].from_node if links else None
    while node is not None and node.bl_idname == "NodeReroute":
        links = node.inputs[0].links
        node = links[0].from_node if links else None
    return node


def _plain(colour, strength: float) -> World:
    return World(np.array([[tuple(colour)[:3]]], np.float32), strength)


def _read_background(node: bpy.types.Node) -> World:
    if node.bl_idname != "ShaderNodeBackground":
        raise _Unsupported(f"its surface is '{node.name}'; expected a Background")
    if node.inputs["Strength"].is_linked:
        raise _Unsupported("the strength of its Background is linked; expected a plain number")
    strength = node.inputs["Strength"].default_value
    colour = node.inputs["Color"]
    source = _source(colour)
    if source is None:
        return _plain(colour.default_value, strength)
    if source.bl_idname == "ShaderNodeRGB":
        return _plain(source.outputs[0].default_value, strength)
    if source.bl_idname != "ShaderNodeTexEnvironment":
        raise _Unsupported(f"the colour is of '{source.name}'; expected a plain colour or an Environment Texture")
    if source.projection != "EQUIRECTANGULAR":
        raise _Unsupported("its Environment Texture is a mirror ball; expected an equirectangular one")
    matrix, offset = _mapping(_source(source.inputs["Vector"]))
    return World(_texels(source.image), strength, matrix, offset, source.interpolation != "Closest")


def _mapping(node: bpy.types.Node | None) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Matrix and offset from directions of the world to those of the texture."""
    if node is None:
        return None, None
    if node.bl_idname == "ShaderNodeTexCoord":
        return None, None
    if node.bl_idname != "ShaderNodeMapping":
        raise _Unsupported(f"its Environment Texture is placed by '{node.name}'; expected a Mapping node")
    if any(socket.is_linked for socket in node.inputs if socket.name != "Vector"):
        raise _Unsupported("its Mapping node has linked values; expected plain ones")
    before = _source(node.inputs["Vector"])
    if before is not None and before.bl_idname != "ShaderNodeTexCoord":
        raise _Unsupported(f"its Mapping node follows '{before.name}'; expected a Texture Coordinate node")
    turn = np.array(Euler(node.inputs["Rotation"].default_value, "XYZ").to_matrix())
    scale = np.array(node.inputs["Scale"].default_value)
    kind = node.vector_type
    shift = np.array(node.inputs["Location"].default_value) if kind in ("POINT", "TEXTURE") else np.zeros(3)
    if not scale.all() and kind in ("TEXTURE", "NORMAL"):
        raise _Unsupported("its Mapping node has a scale of 0")
    if kind == "TEXTURE":
        matrix = np.diag(1 / scale) @ turn.T
        return matrix, -matrix @ shift
    if kind == "NORMAL":
        return turn @ np.diag(1 / scale), None
    return turn @ np.diag(scale), shift


def _texels(image: bpy.types.Image | None) -> np.ndarray:
    """Linear RGB, rows from the bottom."""
    if image is None:
        raise _Unsupported("its Environment Texture has no image")
    width, height = image.size
    if width == 0 or height == 0:
        raise _Unsupported(f"image '{image.name}' cannot be read")
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)
    rgb = values[..., :3] if image.channels >= 3 else np.repeat(values[..., :1], 3, axis=-1)
    # Blender keeps floats in linear light, and bytes in the encoding of the file.
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        rgb = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return rgb.astype(np.float32)
