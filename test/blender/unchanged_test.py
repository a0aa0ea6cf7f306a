"""Rendering leaves the user's scene as it is."""

from __future__ import annotations

import sys

import bpy
import pytest
from animation_test import keyed
from blender_scene import BlenderScene


def names_of_all_data() -> dict[str, list[tuple[str, int]]]:
    """Names and numbers of users of all data-blocks, but for the picture of the render."""
    kinds = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    blocks = {kind: sorted((b.name, b.users) for b in getattr(bpy.data, kind)) for kind in kinds}
    blocks["images"] = [(name, users) for name, users in blocks["images"] if name != "Render Result"]
    return blocks


def state_of(scene: BlenderScene) -> dict:
    layer = bpy.context.view_layer
    return {
        "data": names_of_all_data(),
        "scene": bpy.context.scene.name,
        "frame": (scene.scene.frame_current, scene.scene.frame_subframe),
        "mode": bpy.context.mode,
        "active": layer.objects.active.name,
        "selected": sorted(o.name for o in scene.scene.objects if o.select_get()),
        "matrices": {o.name: [list(row) for row in o.matrix_world] for o in scene.scene.objects},
        "modifiers": {o.name: [(m.name, m.show_viewport) for m in o.modifiers] for o in scene.scene.objects},
        "properties": {s.name: sorted(s.keys()) for s in bpy.data.scenes},
        "preferences": sorted(bpy.context.preferences.addons.keys()),
    }


def prepare(scene: BlenderScene) -> bpy.types.Object:
    scene.add_plane()
    cube = scene.add_cube(2)
    cube.modifiers.new("smooth", "SUBSURF")
    keyed(cube, "location", {1: (0, 0, 0), 9: (1, 0, 0)})
    shader = cube.data.materials[0].node_tree.nodes["Principled BSDF"]
    keyed(shader.inputs["Base Color"], "default_value", {1: (0.8, 0, 0, 1), 9: (0, 0, 0.8, 1)})
    scene.add_light("POINT")
    scene.set_world((0.1, 0.1, 0.1))
    scene.scene.frame_set(2)
    bpy.context.view_layer.objects.active = cube
    cube.select_set(True)
    bpy.context.view_layer.update()
    return cube


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_still(scene: BlenderScene, mode: str) -> None:
    prepare(scene)
    bpy.ops.object.mode_set(mode=mode)
    before = state_of(scene)
    scene.render()
    assert state_of(scene) == before
    bpy.ops.object.mode_set(mode="OBJECT")


def test_animation(scene: BlenderScene) -> None:
    prepare(scene)
    before = state_of(scene)
    scene.scene.frame_start, scene.scene.frame_end = 4, 5
    scene.scene.render.filepath = str(scene.folder / "frame")
    bpy.ops.render.render(animation=True)
    bpy.context.view_layer.update()
    assert state_of(scene) == before


def test_failure(scene: BlenderScene, addon, monkeypatch: pytest.MonkeyPatch) -> None:
    prepare(scene)
    before = state_of(scene)
    geometry = sys.modules[f"{addon.__name__}.export.geometry"]
    monkeypatch.setitem(geometry.EXPORTER_SETTINGS, "export_format", "NO SUCH FORMAT")
    with pytest.raises(RuntimeError, match="Blender's glTF exporter failed: .*NO SUCH FORMAT"):
        scene.render()
    assert state_of(scene) == before
