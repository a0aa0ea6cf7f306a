"""Materials look as in Cycles, as far as glTF has them."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from blender_scene import BlenderScene
from world_test import blocks_of, distinct_map

MATERIALS = {
    "glass": {"Transmission Weight": 1.0, "Roughness": 0.0, "IOR": 1.5, "Base Color": (1, 1, 1, 1)},
    "metal": {"Metallic": 1.0, "Roughness": 0.3, "Base Color": (0.9, 0.6, 0.3, 1)},
    "plastic": {"Roughness": 0.4, "Base Color": (0.2, 0.4, 0.6, 1)},
    "coat": {"Coat Weight": 1.0, "Coat Roughness": 0.0, "Roughness": 0.5, "Base Color": (0.5, 0.1, 0.05, 1)},
    "emission": {"Emission Strength": 2.0, "Emission Color": (1, 0.5, 0.25, 1), "Base Color": (0, 0, 0, 1)},
}
# Principled BSDFs of the two programs are different models, glass is the same; edges depend on the filter.
TOLERANCE = {"glass": 0.03}


def test_surfaces_without_a_material(scene: BlenderScene) -> None:
    scene.add_plane().data.materials.clear()
    scene.set_world((1, 1, 1))
    scene.look((0, -4, 3), (0, 0, 0))
    scene.scene.montelux.samples = 64
    ours, theirs = blocks_of(scene.render(), 4), blocks_of(scene.render_by_cycles(64), 4)
    assert abs(ours.mean() / theirs.mean() - 1) < 0.02


def test_what_is_not_exported_is_named(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    ball = scene.add_cube()
    tree = ball.data.materials[0].node_tree
    shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], shader.inputs["Base Color"])
    tree.nodes.new("ShaderNodeTexVoronoi")  # without a part in the surface
    scene.add_light("POINT", energy=100, shadow_soft_size=0.5)
    scene.add_light("SUN", energy=1, angle=0.1)
    scene.render()
    printed = "".join(capfd.readouterr())
    assert "Material 'cube': its node 'Noise Texture' is not exported" in printed
    assert "Voronoi" not in printed
    assert "Light 'point': its radius is ignored, its shadows are hard" in printed
    assert "Light 'sun': its angle is ignored" in printed


@pytest.mark.parametrize("name", MATERIALS)
def test_ball(scene: BlenderScene, name: str) -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1)
    ball = bpy.context.object
    ball.data.shade_smooth()
    material = scene.matt(name)
    shader = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    shader.inputs["Specular IOR Level"].default_value = 0.5
    for socket, value in MATERIALS[name].items():
        shader.inputs[socket].default_value = value
    ball.data.materials.append(material)
    scene.set_world_map(distinct_map())
    scene.look((0, -4, 1), (0, 0, 0))
    scene.scene.montelux.samples = 256
    ours, theirs = blocks_of(scene.render(), 4), blocks_of(scene.render_by_cycles(256), 4)
    print(
        f"{name}: largest difference {np.abs(ours - theirs).max():.4f}, of the mean {ours.mean() / theirs.mean():.4f}"
    )
    assert np.abs(ours - theirs).max() < TOLERANCE.get(name, 0.07)
