"""Each frame of an animation shows its own time: objects, materials, lights, world, camera."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from blender_scene import BlenderScene, read_picture


def keyed(owner: bpy.types.bpy_struct, path: str, values: dict[int, object]) -> None:
    for frame, value in values.items():
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def frames_of(scene: BlenderScene, folder: Path, first: int, last: int) -> list[np.ndarray]:
    scene.scene.frame_start, scene.scene.frame_end = first, last
    scene.scene.render.filepath = str(folder / "frame")
    bpy.ops.render.render(animation=True)
    return [read_picture(folder / f"frame{n:04}.exr")[..., :3] for n in range(first, last + 1)]


def test_frames(scene: BlenderScene, tmp_path: Path) -> None:
    cube = scene.add_cube(2)
    keyed(cube, "location", {3: (-1.5, 0, 0), 4: (1.5, 0, 0)})
    shader = cube.data.materials[0].node_tree.nodes["Principled BSDF"]
    keyed(shader.inputs["Base Color"], "default_value", {3: (0.8, 0, 0, 1), 4: (0, 0, 0.8, 1)})
    scene.set_world((1, 1, 1))
    background = scene.scene.world.node_tree.nodes["Background"]
    keyed(background.inputs["Strength"], "default_value", {3: 1.0, 4: 0.5})
    scene.scene.frame_set(1)
    before, after = frames_of(scene, tmp_path, 3, 4)
    assert before[16, 18, 0] > 0.3 and before[16, 18, 2] < 0.1
    assert after[16, 30, 2] > 0.15 and after[16, 30, 0] < 0.1
    assert abs(before[0, 0].mean() - 1) < 0.05 and abs(after[0, 0].mean() - 0.5) < 0.05
    assert scene.scene.frame_current == 1


def test_frame_is_the_still_of_its_time(scene: BlenderScene, tmp_path: Path) -> None:
    scene.add_plane()
    scene.add_cube(2)
    lamp = scene.add_light("POINT", (0, 0, 4), energy=100)
    keyed(lamp.data, "energy", {1: 100.0, 11: 1000.0})
    keyed(scene.camera, "location", {1: (0, 0, 8), 11: (3, 0, 8)})
    (frame,) = frames_of(scene, tmp_path, 6, 6)
    scene.scene.frame_set(6)
    np.testing.assert_array_equal(frame, scene.render()[..., :3])
    scene.scene.frame_set(1)
    assert np.abs(frame - scene.render()[..., :3]).max() > 0.05
