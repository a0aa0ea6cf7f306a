# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights of the evaluated scene: point, sun and spot as KHR_lights_punctual, area lights as panels that glow.

Blender's own exporter omits area lights, and its numbers depend on a setting. Here radiance 1 of Cycles is film RGB 1
of Montelux, which calls it 1 cd/m^2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .glb import Glb
from .space import GLTF_FROM_BLENDER, node_matrix, without_scale

# Corners of the polygon that stands for a disc. Its light is scaled to that of the disc.
DISC_CORNERS = 64
NARROWEST_EDGE = 1e-3  # radians between the cones of a spot; glTF forbids 0

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class PunctualLight:
    gltf: dict
    matrix: Matrix

    def add_to(self, glb: Glb) -> None:
        index = glb.add_light(self.gltf)
        reference = {"KHR_lights_punctual": {"light": index}}
        glb.add_root({"name": self.gltf["name"], "matrix": node_matrix(self.matrix), "extensions": reference})


@dataclass(frozen=True)
class Panel:
    """A flat emitter: its corners, counter-clockwise as seen from where it shines, in glTF's world."""

    name: str
    corners: np.ndarray
    radiance: Colour

    def add_to(self, glb: Glb) -> None:
        brightest = max(self.radiance)
        glb.use_extension("KHR_materials_emissive_strength")
        glb.use_extension("KHR_materials_specular")
        material = glb.add(
            "materials",
            {
                "name": self.name,
                "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
                "emissiveFactor": [c / brightest for c in self.radiance],
                "extensions": {
                    "KHR_materials_emissive_strength": {"emissiveStrength": brightest},
                    "KHR_materials_specular": {"specularFactor": 0},
                },
            },
        )
        fan = np.array([(0, i, i + 1) for i in range(1, len(self.corners) - 1)])
        glb.add_root({"name": self.name, "mesh": glb.add_mesh(self.name, self.corners, fan, material)})


def export_light(light_object: bpy.types.Object, matrix: Matrix, warnings: list[str]) -> PunctualLight | Panel | None:
    """`light_object`: evaluated; `matrix`: of it or of its instance. None for a light without light."""
    light = light_object.data
    colour = _colour_of(light, warnings)
    if max(colour) <= 0:
        return None
    if light.type == "AREA":
        return _panel_of(light, matrix, colour, warnings)
    if (light.angle if light.type == "SUN" else light.shadow_soft_size) > 0:
        size = "angle" if light.type == "SUN" else "radius"
        warnings.append(f"Light '{light.name}': its {size} is ignored, its shadows are hard")
    # Power that is not normalised is per area, which only light.area() knows.
    area = 1.0 if getattr(light, "normalize", True) else light.area(matrix_world=matrix)
    if light.type == "SUN":
        return _punctual(light, matrix, colour, area, "directional")
    intensity = area / (4 * math.pi)
    if light.type == "POINT":
        return _punctual(light, matrix, colour, intensity, "point")
    return _punctual(light, matrix, colour, intensity, "spot", spot=_cones_of(light))


def _punctual(light: bpy.types.Light, matrix: Matrix, colour: Colour, scale: float, kind: str, **more: dict):
    brightest = max(colour)
    gltf = {"name": light.name, "type": kind, "color": [c / brightest for c in colour], "intensity": brightest * scale}
    return PunctualLight({**gltf, **more}, without_scale(matrix))


def _cones_of(light: bpy.types.SpotLight) -> dict:
    # Blender's edge is a share of 1 - cos; both programs blend cosines smoothly from cone to cone.
    outer = min(light.spot_size / 2, math.pi / 2)
    inner = math.acos(min(1.0, math.cos(outer) + (1 - math.cos(outer)) * light.spot_blend))
    return {"outerConeAngle": outer, "innerConeAngle": max(0.0, min(inner, outer - NARROWEST_EDGE))}


def _panel_of(light: bpy.types.AreaLight, matrix: Matrix, colour: Colour, warnings: list[str]) -> Panel | None:
    if light.spread < math.pi - 1e-3:
        warnings.append(f"Light '{light.name}': its spread is ignored, it shines into all directions")
    width = light.size
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    round_shape = light.shape in ("DISK", "ELLIPSE")
    if round_shape:
        turns = [2 * math.pi * i / DISC_CORNERS for i in range(DISC_CORNERS)]
        outline = [(math.cos(a) / 2, math.sin(a) / 2) for a in turns]
    else:
        outline = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    placed = GLTF_FROM_BLENDER @ matrix
    # Reversed: the light shines along -z.
    corners = [placed @ Vector((x * width, y * height, 0)) for x, y in reversed(outline)]
    if placed.determinant() < 0:
        corners.reverse()
    middle = sum(corners, Vector((0, 0, 0))) / len(corners)
    pairs = zip(corners, corners[1:] + corners[:1])
    area = sum((a - middle).cross(b - middle).length / 2 for a, b in pairs)
    if area <= 0:
        return None
    # Power is that of a Lambertian emitter, or, where it is not normalised, of one square metre.
    scale = 1 / (math.pi * area) if getattr(light, "normalize", True) else 1 / math.pi
    radiance = tuple(c * scale for c in colour)
    return Panel(light.name, np.array([tuple(c) for c in corners]), (radiance[0], radiance[1], radiance[2]))


def _colour_of(light: bpy.types.Light, warnings: list[str]) -> Colour:
    """Linear colour times power."""
    power = light.energy * 2 ** getattr(light, "exposure", 0.0)
    colour = [c * power for c in light.color]
    if getattr(light, "use_temperature", False):
        colour = [c * t for c, t in zip(colour, light.temperature_color)]
    if light.use_nodes and light.node_tree:
        colour = [c * e for c, e in zip(colour, _emission_of(light, warnings))]
    return colour[0], colour[1], colour[2]


def _emission_of(light: bpy.types.Light, warnings: list[str]) -> Colour:
    """What the light's nodes multiply it by, where that is one Emission node with plain values."""
    output = light.node_tree.get_output_node("CYCLES") or light.node_tree.get_output_node("ALL")
    links = output.inputs["Surface"].links if output else ()
    node = links[0].from_node if links else None
    if node is None or node.bl_idname != "ShaderNodeEmission" or any(i.is_linked for i in node.inputs):
        warnings.append(f"Light '{light.name}': its nodes are ignored; one Emission node with plain values is exported")
        return 1, 1, 1
    strength = node.inputs["Strength"].default_value
    r, g, b, _ = node.inputs["Color"].default_value
    return r * strength, g * strength, b * strength
