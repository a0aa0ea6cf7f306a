"""Lights are as bright as in Cycles."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from blender_scene import BlenderScene

LIGHTS = {
    "point": lambda s: s.add_light("POINT", energy=300, shadow_soft_size=0),
    "coloured point": lambda s: s.add_light("POINT", energy=300, shadow_soft_size=0, color=(1, 0.7, 0.4)),
    "exposed point": lambda s: s.add_light("POINT", energy=100, shadow_soft_size=0, exposure=1.5),
    "sun": lambda s: s.add_light("SUN", energy=2, angle=0, turn=(40, 10, 0)),
    "spot": lambda s: s.add_light("SPOT", energy=300, shadow_soft_size=0, spot_size=1.2, spot_blend=0.5),
    "rectangle": lambda s: s.add_light("AREA", energy=150, shape="RECTANGLE", size=2, size_y=0.5, turn=(20, 0, 0)),
    "ellipse": lambda s: s.add_light("AREA", energy=150, shape="ELLIPSE", size=2, size_y=1, turn=(0, 30, 0)),
    "warm point": lambda s: s.add_light(
        "POINT", energy=300, shadow_soft_size=0, use_temperature=True, temperature=4000
    ),
    "point per area": lambda s: s.add_light("POINT", energy=2000, shadow_soft_size=0.1, normalize=False),
    "panel per area": lambda s: s.add_light("AREA", energy=100, shape="RECTANGLE", size=2, size_y=0.5, normalize=False),
    "sun with nodes": lambda s: _set_nodes(s.add_light("SUN", energy=2, angle=0)),
    "world": lambda s: s.set_world((0.2, 0.3, 0.5), 1.5),
    "emission": lambda s: _add_glowing(s),
}


def _set_nodes(light: bpy.types.Object) -> None:
    light.data.use_nodes = True
    emission = next(n for n in light.data.node_tree.nodes if n.bl_idname == "ShaderNodeEmission")
    emission.inputs["Color"].default_value = (0.5, 0.8, 1, 1)
    emission.inputs["Strength"].default_value = 1.5


def _add_glowing(scene: BlenderScene) -> None:
    panel = scene.add_plane(1, (0, 0, 3), "panel")
    panel.rotation_euler = (3.14159265, 0, 0)
    panel.data.materials[0] = scene.matt("glowing", emission=30)


@pytest.mark.parametrize("name", LIGHTS)
def test_agrees_with_cycles(scene: BlenderScene, name: str) -> None:
    scene.add_plane()
    scene.add_cube(1, (1.5, 0, 0.5))
    scene.look((0, -7, 4), (0, 0, 0))
    scene.set_world((0, 0, 0))
    LIGHTS[name](scene)
    scene.scene.montelux.samples = 256
    ours, theirs = scene.render()[..., :3], scene.render_by_cycles(1024)[..., :3]
    blocks = [
        (ours[y : y + 8, x : x + 12], theirs[y : y + 8, x : x + 12]) for y in (8, 16, 24) for x in (0, 12, 24, 36)
    ]
    ratios = np.array([a.mean() / b.mean() for a, b in blocks if b.mean() > 0.05 * theirs.mean()])
    whole = ours.mean() / theirs.mean()
    print(f"{name}: whole {whole:.4f}, blocks {ratios.min():.4f} to {ratios.max():.4f}")
    assert theirs.mean() > 1e-3
    assert abs(whole - 1) < 0.02
