"""The World shines from where Cycles lets it shine, whatever the camera looks at."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from blender_scene import BlenderScene

DIRECTIONS = {
    "front": ((0, -5, 0), (0, 0, 0)),
    "right": ((0, 0, 0), (5, 0, 0)),
    "back and up": ((0, 0, 0), (-1, -3, 2)),
    "straight down": ((0, 0, 8), (0, 0, 0)),
    "straight up": ((0, 0, -8), (0, 0, 0)),
    "steeply down": ((0.5, -1, 8), (0, 0, 0)),
}


def distinct_map(height: int = 64) -> np.ndarray:
    """Another colour in every direction: red grows with x, green with y, blue with z."""
    latitude = np.pi * ((np.arange(height) + 0.5) / height - 0.5)[:, None]
    azimuth = np.pi - np.pi * (np.arange(2 * height) + 0.5) / height
    axes = np.cos(latitude) * np.cos(azimuth), np.cos(latitude) * np.sin(azimuth), np.sin(latitude) + 0 * azimuth
    return np.stack([0.6 + 0.4 * axis for axis in axes], axis=-1).astype(np.float32)


def blocks_of(picture: np.ndarray, size: int = 8) -> np.ndarray:
    """Means of squares: single pixels have noise of colour, since paths have few wavelengths."""
    height, width, _ = picture.shape
    return picture[..., :3].reshape(height // size, size, width // size, size, 3).mean(axis=(1, 3))


def assert_like_cycles(scene: BlenderScene, tolerance: float = 0.02) -> None:
    scene.scene.montelux.samples = 64
    ours, theirs = blocks_of(scene.render()), blocks_of(scene.render_by_cycles(64))
    assert theirs.std() > 0.02, "the picture shows too little to tell"
    assert np.abs(ours - theirs).max() < tolerance


def add_mapping(scene: BlenderScene, texture: bpy.types.Node) -> bpy.types.Node:
    tree = scene.scene.world.node_tree
    mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return mapping


@pytest.mark.parametrize("name", DIRECTIONS)
def test_background(scene: BlenderScene, name: str) -> None:
    scene.set_world_map(distinct_map())
    scene.look(*DIRECTIONS[name])
    assert_like_cycles(scene)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR", "NORMAL"])
def test_mapping(scene: BlenderScene, kind: str) -> None:
    mapping = add_mapping(scene, scene.set_world_map(distinct_map()))
    mapping.vector_type = kind
    mapping.inputs["Rotation"].default_value = (0.3, -0.5, 2)
    mapping.inputs["Scale"].default_value = (1, 1.5, 0.8)
    if kind in ("POINT", "TEXTURE"):
        mapping.inputs["Location"].default_value = (0.1, 0.2, -0.1)
    scene.look((0, -5, 1), (0, 0, 0))
    assert_like_cycles(scene)


def test_closest_texels_have_edges(scene: BlenderScene) -> None:
    texels = np.zeros((4, 8, 3), np.float32)
    texels[:, 2] = 1  # around +y
    # Turned by a part of a texel.
    add_mapping(scene, scene.set_world_map(texels, "Closest")).inputs["Rotation"].default_value = (0, 0, 0.3)
    scene.look((0, 0, 0), (0, 5, 0))
    picture = scene.render()[..., 1]
    between = (picture > 0.1) & (picture < 0.9)
    assert picture.max() > 0.9 and picture.min() == 0
    assert between.mean() < 0.1, "interpolated texels have no edges"


def test_lights_from_its_side(scene: BlenderScene) -> None:
    texels = np.zeros((16, 32, 3), np.float32)
    texels[10:13, 20:24] = 40
    scene.set_world_map(texels)
    scene.add_plane()
    scene.add_cube(2, (0, 0, 1))
    scene.look((0, -8, 8), (0, 0, 0))
    scene.scene.montelux.samples = 256
    ours, theirs = scene.render()[..., :3], scene.render_by_cycles(1024)[..., :3]
    for y in range(0, 32, 16):
        for x in range(0, 48, 12):
            a, b = ours[y : y + 16, x : x + 12].mean(), theirs[y : y + 16, x : x + 12].mean()
            assert abs(a / b - 1) < 0.02


def test_unsupported_nodes_give_a_warning(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    tree = scene.set_world()
    background = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBackground")
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], background.inputs["Color"])
    assert not scene.render()[..., :3].any()
    assert "gives no light: the colour is of 'Noise Texture'" in "".join(capfd.readouterr())
