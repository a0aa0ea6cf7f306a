# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the scene of docs/images/blender.png in Blender: blender --python example_scene.py, then F12.

Needs Blender 4.0 or newer. With bpy from PyPI: python example_scene.py FILE.blend saves it.
"""

from __future__ import annotations

import math
import sys

import bpy
from mathutils import Vector

LACQUER = {"Base Color": (0.55, 0.06, 0.02, 1), "Roughness": 0.6, "Coat Weight": 1.0, "Coat Roughness": 0.03}
GOLD = {"Base Color": (1.0, 0.66, 0.26, 1), "Metallic": 1.0, "Roughness": 0.32}
GLASS = {"Base Color": (0.95, 0.98, 0.97, 1), "Roughness": 0.0, "Transmission Weight": 1.0, "IOR": 1.5}
PAPER = {"Base Color": (0.42, 0.43, 0.45, 1), "Roughness": 0.6, "Specular IOR Level": 0.2}


def material(name: str, values: dict) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = next(n for n in made.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    for socket, value in values.items():
        shader.inputs[socket].default_value = value
    return made


def add_head(place: tuple[float, float, float], turn: float, look: bpy.types.Material) -> None:
    bpy.ops.mesh.primitive_monkey_add(location=place, rotation=(math.radians(-26), 0, math.radians(turn)))
    head = bpy.context.object
    smooth = head.modifiers.new("smooth", "SUBSURF")
    smooth.levels, smooth.render_levels = 1, 3
    head.data.shade_smooth()
    head.data.materials.append(look)


def add_backdrop(look: bpy.types.Material) -> None:
    """A floor that bends up behind the scene."""
    radius, depth, height, width = 3.0, 5.0, 9.0, 24.0
    profile = [(-12.0, 0.0)]
    for step in range(25):
        angle = math.pi / 2 * step / 24
        profile.append((depth + radius * math.sin(angle), radius - radius * math.cos(angle)))
    profile.append((depth + radius, height))
    corners = [(x, y, z) for y, z in profile for x in (-width, width)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("backdrop")
    mesh.from_pydata(corners, [], faces)
    mesh.shade_smooth()
    mesh.materials.append(look)
    bpy.context.collection.objects.link(bpy.data.objects.new("backdrop", mesh))


def add_area_light(name: str, place, at, power: float, size: tuple[float, float], colour) -> None:
    light = bpy.data.lights.new(name, "AREA")
    light.shape, (light.size, light.size_y) = "RECTANGLE", size
    light.energy, light.color = power, colour
    added = bpy.data.objects.new(name, light)
    added.location = place
    added.rotation_euler = (Vector(at) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(added)


def build() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
    scene = bpy.context.scene
    add_backdrop(material("paper", PAPER))
    add_head((-2.6, 0.2, 0.5), 24, material("lacquer", LACQUER))
    add_head((0, -0.4, 0.5), 0, material("gold", GOLD))
    add_head((2.6, 0.2, 0.5), -24, material("glass", GLASS))
    add_area_light("key", (-6, -5, 6.5), (0, 0, 0.5), 900, (3, 3), (1, 0.93, 0.84))
    add_area_light("rim", (6.5, 2.5, 4.5), (0, 0, 0.5), 500, (1.2, 4), (0.75, 0.87, 1))
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    background = next(n for n in scene.world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground")
    background.inputs["Color"].default_value = (0.5, 0.6, 0.8, 1)
    background.inputs["Strength"].default_value = 0.25

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 56
    camera.location = (0, -12.5, 3.2)
    camera.rotation_euler = (Vector((0, 0, 0.42)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(camera)
    scene.camera = camera
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 960, 380, 100
    render.image_settings.file_format = "PNG"
    if hasattr(scene, "montelux"):
        render.engine = "MONTELUX"
        scene.montelux.samples = 512


build()
if bpy.app.background and len(sys.argv) == 2:
    bpy.ops.wm.save_as_mainfile(filepath=sys.argv[1])
