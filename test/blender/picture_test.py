"""The picture in Blender is the program's own, bit for bit, in the right place, with its passes."""

from __future__ import annotations

import json
import struct
import sys
from pathlib import Path

import bpy
import numpy as np
import pytest
from blender_scene import BlenderScene
from watched_program import WatchedProgram


def add_something(scene: BlenderScene) -> None:
    scene.add_plane(colour=(0.6, 0.4, 0.2))
    scene.add_cube(1.5, (0.5, 0.3, 0.75), colour=(0.2, 0.3, 0.7))
    scene.add_light("POINT", (2, -2, 4), energy=500, shadow_soft_size=0)
    scene.add_light("AREA", (-3, -1, 3), (0, -45, 0), energy=100, size=1)
    scene.set_world((0.1, 0.2, 0.3))
    scene.look((1, -6, 4), (0, 0, 0.5))


def test_bit_for_bit(scene: BlenderScene, watched: WatchedProgram) -> None:
    add_something(scene)
    picture = scene.render()
    (run,) = watched.runs
    own = watched.layer(watched.render_again(run), "mean")
    assert picture[..., :3].std() > 0.05
    np.testing.assert_array_equal(picture[..., :3], own)
    assert (picture[..., 3] == 1).all()


def test_settings_reach_the_program(scene: BlenderScene, watched: WatchedProgram) -> None:
    add_something(scene)
    settings = scene.scene.montelux
    settings.seed, settings.max_depth = 7, 3
    settings.end, settings.target_error, settings.time_limit = "ERROR", 20, 30
    scene.scene.render.threads = 1
    scene.render()
    arguments = watched.command(watched.runs[0])["arguments"]
    given = dict(zip(arguments, arguments[1:]))
    assert given["--seed"] == "7" and given["--max-depth"] == "3" and given["--threads"] == "1"
    assert given["--target-error"] == "20%" and given["--time"] == "30" and "--spp" not in given
    settings.end, settings.time = "TIME", 0.5
    scene.render()
    assert "--time 0.5" in " ".join(watched.command(watched.runs[1])["arguments"])


def test_missed_target_is_reported(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    add_something(scene)
    settings = scene.scene.montelux
    settings.end, settings.target_error, settings.time_limit = "ERROR", 0.001, 0.5
    assert scene.render()[..., :3].std() > 0.05
    assert "The render ended before the requested error" in "".join(capfd.readouterr())


@pytest.mark.parametrize("crop", [False, True])
def test_border_is_part_of_the_whole(scene: BlenderScene, crop: bool) -> None:
    add_something(scene)
    whole = scene.render()
    render = scene.scene.render
    render.use_border, render.use_crop_to_border = True, crop
    render.border_min_x, render.border_max_x = 0.26, 0.7
    render.border_min_y, render.border_max_y = 0.13, 0.5
    part = scene.render()
    x0, x1, y0, y1 = int(0.26 * 48), int(0.7 * 48), 32 - int(0.5 * 32), 32 - int(0.13 * 32)
    if crop:
        np.testing.assert_array_equal(part, whole[y0:y1, x0:x1])
        return
    assert part.shape == whole.shape
    np.testing.assert_array_equal(part[y0:y1, x0:x1], whole[y0:y1, x0:x1])
    part[y0:y1, x0:x1] = 0
    assert not part.any()


def test_percentage(scene: BlenderScene) -> None:
    add_something(scene)
    half_size = scene.render()
    render = scene.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 96, 64, 50
    np.testing.assert_array_equal(scene.render(), half_size)


def test_transparent_film(scene: BlenderScene) -> None:
    scene.add_cube(2)
    scene.set_world((1, 1, 1))
    scene.scene.render.film_transparent = True
    scene.scene.montelux.samples = 256
    picture = scene.render()
    assert (picture[0, 0] == 0).all()
    assert picture[16, 24, 3] == 1 and picture[16, 24, 1] > 0.3
    edge = picture[(picture[..., 3] > 0) & (picture[..., 3] < 1)]
    assert len(edge) > 10
    # Multiplied by alpha: before nothing, light over alpha is that of the cube.
    assert abs(edge[:, 1].sum() / edge[:, 3].sum() - picture[14:18, 22:26, 1].mean()) < 0.05


CAMERAS = {
    "wide": dict(resolution=(48, 32)),
    "high": dict(resolution=(32, 48)),
    "shifted": dict(resolution=(48, 32), shift_x=0.25, shift_y=-0.125),
    "vertical sensor": dict(resolution=(48, 32), sensor_fit="VERTICAL", sensor_height=20, lens=30),
    "orthographic": dict(resolution=(48, 32), type="ORTHO", ortho_scale=7),
    "orthographic, high, wide pixels": dict(resolution=(32, 48), type="ORTHO", ortho_scale=7, pixel_aspect=2),
}


@pytest.mark.parametrize("name", CAMERAS)
def test_camera_sees_what_cycles_sees(scene: BlenderScene, name: str) -> None:
    settings = dict(CAMERAS[name])
    render = scene.scene.render
    render.resolution_x, render.resolution_y = settings.pop("resolution")
    render.pixel_aspect_x = settings.pop("pixel_aspect", 1)
    for key, value in settings.items():
        setattr(scene.camera.data, key, value)
    scene.camera.scale = (2, 2, 2)
    for place in ((0, 0, 0), (2, 1, 0), (-1.5, 1, 0.5), (1, -1.5, 0)):
        scene.add_cube(0.8, place).data.materials[0] = scene.matt("glowing", emission=1)
    scene.look((1, -2, 8), (0.2, 0, 0))
    ours, theirs = scene.render()[..., 1], scene.render_by_cycles(64)[..., 1]
    assert 0.05 < (theirs > 0.5).mean() < 0.6
    # Other filters at edges; a picture that is off by a pixel differs by more.
    assert np.abs(ours - theirs).mean() < 0.02
    np.testing.assert_array_equal(ours[(theirs == 0)] < 0.5, True)


@pytest.mark.parametrize("mirrored", [1, -1])
def test_sheared_objects(scene: BlenderScene, mirrored: int) -> None:
    """A turned child of a parent that is scaled along one axis."""
    parent = scene.add("parent", None)
    parent.scale = (mirrored, 3, 1)
    cube = scene.add_cube(1.2)
    cube.data.materials[0] = scene.matt("glowing", emission=1)
    cube.parent, cube.rotation_euler = parent, (0, 0, 0.6)
    ours, theirs = scene.render()[..., 1], scene.render_by_cycles(64)[..., 1]
    assert 0.05 < (theirs > 0.5).mean() < 0.6
    assert np.abs(ours - theirs).mean() < 0.02


def render_layers(scene: BlenderScene, addon):
    """The picture with its passes, by the add-on's reader of EXR files."""
    image = scene.scene.render.image_settings
    image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.use_exr_interleave, image.exr_codec = "OPEN_EXR_MULTILAYER", True, "ZIP"
    scene.scene.render.filepath = str(scene.folder / "layers.exr")
    bpy.ops.render.render(write_still=True)
    return sys.modules[f"{addon.__name__}.run.exr"].ExrPicture(scene.folder / "layers.exr")


def layer_of(picture, name: str, channels: str = "RGB") -> np.ndarray:
    return picture.stack(*(f"ViewLayer.{name}.{c}" for c in channels))


def test_passes(scene: BlenderScene, addon, watched: WatchedProgram) -> None:
    add_something(scene)
    layer = scene.scene.view_layers[0].montelux
    layer.use_error = layer.use_samples = layer.use_albedo = layer.use_normal = layer.use_distance = True
    blender = render_layers(scene, addon)
    picture = watched.render_again(watched.runs[0])
    np.testing.assert_array_equal(layer_of(blender, "Combined"), watched.layer(picture, "mean"))
    np.testing.assert_array_equal(layer_of(blender, "Standard Error"), watched.layer(picture, "stderr"))
    np.testing.assert_array_equal(layer_of(blender, "Albedo"), watched.layer(picture, "albedo"))
    np.testing.assert_array_equal(layer_of(blender, "Samples", "X"), watched.layer(picture, "samples"))
    np.testing.assert_array_equal(layer_of(blender, "Distance", "X"), watched.layer(picture, "depth"))
    np.testing.assert_array_equal(layer_of(blender, "Normal", "XZY") * (1, 1, -1), watched.layer(picture, "normal"))
    assert layer_of(blender, "Normal", "Z").max() > 0.99  # of the floor
    assert (layer_of(blender, "Standard Error") > 0).any()


def test_denoised(scene: BlenderScene, addon, watched: WatchedProgram, monkeypatch: pytest.MonkeyPatch) -> None:
    (library,) = Path(bpy.utils.system_resource("SCRIPTS")).parents[1].glob("lib/libOpenImageDenoise.so.2")
    monkeypatch.setenv("MONTELUX_OIDN_LIBRARY", str(library))
    add_something(scene)
    scene.scene.montelux.denoise = True
    blender = render_layers(scene, addon)
    picture = watched.render_again(watched.runs[0])
    np.testing.assert_array_equal(layer_of(blender, "Combined"), watched.layer(picture, "denoised"))
    np.testing.assert_array_equal(layer_of(blender, "Noisy"), watched.layer(picture, "mean"))
    assert (layer_of(blender, "Combined") != layer_of(blender, "Noisy")).mean() > 0.5


def test_view_layers(scene: BlenderScene, watched: WatchedProgram) -> None:
    """Each is rendered with its own collections, and has its own passes."""
    for place in (-1, 1):
        collection = bpy.data.collections.new(f"at {place}")
        scene.scene.collection.children.link(collection)
        cube = scene.add_cube(place=(place, 0, 0))
        scene.scene.collection.objects.unlink(cube)
        collection.objects.link(cube)
    second = scene.scene.view_layers.new("second")
    second.layer_collection.children["at 1"].exclude = True
    scene.set_world((1, 1, 1))
    scene.render()
    counts = []
    for run in watched.runs:
        data = (run / "scene.glb").read_bytes()
        document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
        counts.append(sum("mesh" in node for node in document["nodes"]))
    assert counts == [2, 1]


def test_file_is_gltf(scene: BlenderScene, watched: WatchedProgram) -> None:
    add_something(scene)
    scene.render()
    data = (watched.runs[0] / "scene.glb").read_bytes()
    magic, version, length, json_length, kind = struct.unpack_from("<IIIII", data)
    assert (magic, version, length, kind) == (0x46546C67, 2, len(data), 0x4E4F534A)
    document = json.loads(data[20 : 20 + json_length])
    assert len(document["meshes"]) == 3 and len(document["cameras"]) == 1 and len(document["buffers"]) == 1
    for view in document["bufferViews"]:
        assert view.get("byteOffset", 0) + view["byteLength"] <= document["buffers"][0]["byteLength"]
