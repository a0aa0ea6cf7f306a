# SPDX-License-Identifier: GPL-3.0-or-later
"""All files of a render, and what became of the scene on the way."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import bpy

from .camera import Camera, export_camera
from .environment_map import World, environment_map, write_pfm
from .errors import ExportError
from .geometry import export_geometry, is_linked_to_lights
from .glb import Glb
from .lights import Panel, PunctualLight, export_light
from .materials import add_missing_material, make_glass_solid
from .world import export_world


@dataclass
class SceneFiles:
    scene: Path
    environment: Path | None
    interpolate_environment: bool
    camera: Camera
    warnings: list[str] = field(default_factory=list)


def export_scene(depsgraph: bpy.types.Depsgraph, camera_object: bpy.types.Object | None, folder: Path) -> SceneFiles:
    """Writes the evaluated scene into `folder`. On the main thread only."""
    scene = depsgraph.scene_eval
    if camera_object is None:
        raise ExportError("The scene has no camera")
    warnings: list[str] = []
    if scene.render.use_motion_blur:
        warnings.append("Motion blur is ignored: the picture shows one moment")
    camera = export_camera(scene, camera_object.evaluated_get(depsgraph), warnings)
    lights = _lights_of(depsgraph, warnings)
    world = export_world(scene, warnings)

    path = folder / "scene.glb"
    export_geometry(depsgraph, path, warnings)
    glb = Glb.read(path)
    make_glass_solid(glb)
    add_missing_material(glb)
    glb.add_root(camera.node(glb.add("cameras", {"name": camera.name, **camera.gltf})))
    for light in lights:
        light.add_to(glb)
    glb.write(path)
    environment = _write_world(world, camera, folder / "world.pfm")
    interpolate = world is None or world.interpolate
    return SceneFiles(path, environment, interpolate, camera, list(dict.fromkeys(warnings)))


def _lights_of(depsgraph: bpy.types.Depsgraph, warnings: list[str]) -> list[PunctualLight | Panel]:
    lights = []
    for instance in depsgraph.object_instances:
        if instance.object.type == "LIGHT" and instance.show_self:
            if is_linked_to_lights(instance.object):
                warnings.append(f"Light '{instance.object.name}' reaches everything, whatever its light linking says")
            light = export_light(instance.object, instance.matrix_world.copy(), warnings)
            if light is not None:
                lights.append(light)
    return lights


def _write_world(world: World | None, camera: Camera, path: Path) -> Path | None:
    if world is None or world.is_dark:
        return None
    write_pfm(path, environment_map(world))
    return path
