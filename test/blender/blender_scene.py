"""BlenderScene: builds small scenes and renders them by one engine or another."""

from __future__ import annotations

import math
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector


class BlenderScene:
    def __init__(self, folder: Path, size: tuple[int, int] = (48, 32)):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
        self.folder = folder
        self.scene = bpy.context.scene
        render = self.scene.render
        render.engine = "MONTELUX"
        render.resolution_x, render.resolution_y = size
        render.resolution_percentage = 100
        render.threads_mode, render.threads = "FIXED", 2
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        self.scene.montelux.samples = 16
        self.camera = self.add("camera", bpy.data.cameras.new("camera"))
        self.scene.camera = self.camera
        self.look((0, 0, 8), (0, 0, 0))

    def add(self, name: str, data: bpy.types.ID | None, place=(0, 0, 0)) -> bpy.types.Object:
        added = bpy.data.objects.new(name, data)
        added.location = place
        self.scene.collection.objects.link(added)
        return added

    def look(self, eye, at) -> None:
        self.camera.location = eye
        self.camera.rotation_euler = (Vector(at) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()

    def add_plane(self, size: float = 20, place=(0, 0, 0), name: str = "plane", colour=(0.5, 0.5, 0.5)):
        s = size / 2
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata([(-s, -s, 0), (s, -s, 0), (s, s, 0), (-s, s, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(self.matt(name, colour))
        return self.add(name, mesh, place)

    def add_cube(self, size: float = 1, place=(0, 0, 0), name: str = "cube", colour=(0.5, 0.5, 0.5)):
        s = size / 2
        corners = [(x, y, z) for x in (-s, s) for y in (-s, s) for z in (-s, s)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(corners, [], faces)
        mesh.materials.append(self.matt(name, colour))
        return self.add(name, mesh, place)

    def matt(self, name: str, colour=(0.5, 0.5, 0.5), emission: float = 0) -> bpy.types.Material:
        """Diffuse in both programs: without the specular layer of the Principled BSDF."""
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        shader = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
        shader.inputs["Base Color"].default_value = (*colour, 1)
        shader.inputs["Roughness"].default_value = 1
        shader.inputs["Specular IOR Level"].default_value = 0
        if emission > 0:
            shader.inputs["Emission Color"].default_value = (1, 1, 1, 1)
            shader.inputs["Emission Strength"].default_value = emission
        return material

    def add_light(self, kind: str, place=(0, 0, 3), turn=(0, 0, 0), **settings) -> bpy.types.Object:
        light = bpy.data.lights.new(kind.lower(), kind)
        for name, value in settings.items():
            setattr(light, name, value)
        added = self.add(kind.lower(), light, place)
        added.rotation_euler = [math.radians(a) for a in turn]
        return added

    def set_world(self, colour=(0, 0, 0), strength: float = 1) -> bpy.types.NodeTree:
        world = self.scene.world or bpy.data.worlds.new("world")
        self.scene.world = world
        world.use_nodes = True
        background = next(n for n in world.node_tree.nodes if n.bl_idname == "ShaderNodeBackground")
        background.inputs["Color"].default_value = (*colour, 1)
        background.inputs["Strength"].default_value = strength
        return world.node_tree

    def set_world_map(self, texels: np.ndarray, interpolation: str = "Linear") -> bpy.types.Node:
        """`texels`: linear RGB, rows from the bottom. The node of the texture."""
        tree = self.set_world()
        height, width, _ = texels.shape
        image = bpy.data.images.new("world", width, height, float_buffer=True)
        rgba = np.ones((height, width, 4), np.float32)
        rgba[..., :3] = texels
        image.pixels.foreach_set(rgba.reshape(-1))
        texture = tree.nodes.new("ShaderNodeTexEnvironment")
        texture.image, texture.interpolation = image, interpolation
        background = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBackground")
        tree.links.new(texture.outputs["Color"], background.inputs["Color"])
        return texture

    def render(self, **more) -> np.ndarray:
        """The picture in the render result, RGBA in linear light, rows from the top."""
        path = self.folder / "result.exr"
        path.unlink(missing_ok=True)
        self.scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True, **more)
        return read_picture(path)

    def render_by_cycles(self, samples: int = 256) -> np.ndarray:
        """The same scene by Cycles, on the CPU, with as many bounces."""
        self.scene.render.engine = "CYCLES"
        cycles = self.scene.cycles
        cycles.device, cycles.samples, cycles.use_denoising = "CPU", samples, False
        cycles.use_adaptive_sampling = False
        cycles.max_bounces = cycles.diffuse_bounces = self.scene.montelux.max_depth
        cycles.sample_clamp_indirect = 0
        cycles.filter_width = 1
        try:
            return self.render()
        finally:
            self.scene.render.engine = "MONTELUX"


def read_picture(path: Path) -> np.ndarray:
    """By Blender's own reader; rows from the top."""
    image = bpy.data.images.load(str(path))
    try:
        width, height = image.size
        values = np.empty(width * height * image.channels, np.float32)
        image.pixels.foreach_get(values)
        return values.reshape(height, width, image.channels)[::-1]
    finally:
        bpy.data.images.remove(image)
