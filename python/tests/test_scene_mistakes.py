"""Mistakes with scenes and their files are answered with sentences."""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from small_scene import TEXT, unnamed_files


def test_a_scene_without_a_camera():
    with pytest.raises(montelux.Error, match="the scene has no camera; set scene.camera"):
        montelux.Scene().render()


@pytest.mark.parametrize(
    "path, value, sentence",
    [
        ("materials[0].reflectence", 1, r"no attribute of Diffuse 'reflectence' \(did you mean 'reflectance'\?\)"),
        ("camera.fow", 1, r"did you mean 'fov'\?"),
        ("film.resoluton", 1, r"did you mean 'resolution'\?"),
        ("sampler.sed", 1, r"did you mean 'seed'\?"),
        ("sammpler", 1, r"no attribute of Scene 'sammpler' \(did you mean 'sampler'\?\)"),
        ("camera.fov", 200, "200 was given; expected an angle between 0 and 180 degrees"),
        ("camera.fov", "wide", "'wide' was given; expected a number"),
        ("camera.fov", None, "None was given; expected a number"),
        ("camera", 3, "expected a camera, such as PerspectiveCamera"),
        ("materials[0].reflectance", 1.5, "a reflectance above 1"),
        ("materials[0].reflectance", (1, 2), "expected 3 numbers"),
        ("materials[0].reflectance", -0.1, "not negative"),
        ("lights[0].spectrum", "stdillum-D66", "did you mean 'stdillum-D65'|did you mean"),
        ("sampler.kind", "sobl", r"did you mean 'sobol'\?"),
        ("sampler.seed", -1, "expected a whole number"),
        ("film.resolution", (0, 1), "expected two whole numbers"),
        ("film.crop", (0, 0, 999, 1), "expected pixels"),
        ("film.white_balance", 65, "65 was given; expected 0 \\(none\\) or a temperature of 2000 K or more"),
        ("film.filter", 1, "expected a pixel filter"),
        ("shapes[0].material", 1, "expected a material"),
        ("lights[0]", "lamp", "expected a light"),
    ],
)
def test_wrong_attributes_are_answered(scene, path, value, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        exec(f"scene.{path} = value", {"scene": scene, "value": value})


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"spp": 0}, "expected a whole number from 1"),
        ({"target_error": -1}, "expected a number above zero"),
        ({"target_error": "1%"}, "'1%' was given; expected a number above zero"),
        ({"checkpoint_every": -1}, "expected a number above zero"),
        ({"progress": 3}, "expected True, False or a function"),
        ({"threads": 1.5}, "expected a whole number from 0 to 4096"),
        ({"target_quantile": 0.9}, "expected target_error"),
        ({"seed": -1}, "expected a whole number"),
        ({"threads": -1}, "expected a whole number from 0 to 4096"),
        ({"resume": True}, "without a checkpoint"),
    ],
)
def test_wrong_arguments_are_answered(scene, arguments, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        scene.render(**arguments)


def test_files_that_are_wrong(tmp_path):
    (tmp_path / "bad.pbrt").write_text('WorldBegin\nShape "spere"\n')
    with pytest.raises(montelux.Error, match=r"bad.pbrt:2:\d+: .*did you mean 'sphere'"):
        montelux.load(tmp_path / "bad.pbrt")
    with pytest.raises(montelux.Error, match="missing.pbrt"):
        montelux.load(tmp_path / "missing.pbrt")
    (tmp_path / "dark.pbrt").write_text('WorldBegin\nShape "sphere"\n')
    with pytest.warns(UserWarning, match="the scene has no light"):
        assert "the scene has no light" in montelux.load(tmp_path / "dark.pbrt").warnings[0]


def test_textures_in_a_file_change_nothing(tmp_path):
    ball = montelux.parse(TEXT)
    ball.film.resolution = (200, 150)
    ball.render(spp=16).save(tmp_path / "map.exr")
    text = TEXT.replace(
        'Shape "sphere"', 'Texture "t" "spectrum" "imagemap" "string filename" "map.exr"\n'
        'Material "diffuse" "texture reflectance" "t" Shape "sphere"')
    (tmp_path / "scene.pbrt").write_text(text)
    plain = montelux.load(tmp_path / "scene.pbrt")
    usual = plain.render(spp=4).mean

    for load in (
        lambda: montelux.load(tmp_path / "scene.pbrt", texture_memory=16 << 20),
        lambda: montelux.parse(text, folder=tmp_path, texture_memory=1 << 40),
    ):
        before = unnamed_files()
        scene = load()
        assert unnamed_files() > before
        assert (scene.render(spp=4).mean == usual).all()
        del scene
    for wrong in (-1, 1.5, "500M", True, 1 << 70):
        with pytest.raises(montelux.Error, match="texture_memory: .* was given; expected a number of bytes"):
            montelux.load(tmp_path / "scene.pbrt", texture_memory=wrong)
    with pytest.raises(montelux.Error, match="the limit must be at least 16777216 bytes, but is 1000"):
        montelux.parse(text, folder=tmp_path, texture_memory=1000)


def test_indices_beyond_the_end(scene):
    with pytest.raises(IndexError, match="material 9 of"):
        scene.materials[9]
    assert [type(m).__name__ for m in scene.materials] == ["Diffuse"] * len(scene.materials)


def test_messages_name_the_kind_of_files_that_are_not_scenes(tmp_path):
    for name, content, kind in [
        ("model.json", '{"asset": 2}', "a JSON file"),
        ("bunny.pbrt", "OFF\n3 1 0\n", "an OFF mesh"),
    ]:
        (tmp_path / name).write_text(content)
        with pytest.raises(montelux.Error, match=f"{name}: this is {kind}; pbrt-v4, glTF 2.0, Mitsuba 3, OBJ, PLY and STL are read"):
            montelux.load(tmp_path / name)


@pytest.mark.parametrize(
    "changes, sentence",
    [
        ({"triangles": [[0, 1, 4]]}, r"add_mesh: triangle 0 refers to vertex 4; the mesh has 3 vertices"),
        ({"triangles": [[0, 1, -1]]}, r"add_mesh, triangles: the index -1"),
        ({"normals": [[0, 0, 1]]}, "add_mesh: the mesh has 1 normals for 3 vertices"),
        ({"uvs": [[0, 0]]}, "add_mesh: the mesh has 1 texture coordinates for 3 vertices"),
        ({"positions": [[0, 0, 0], [1, 0, 0], [0, 1e300, 0]]}, "add_mesh: vertex 2 lies at infinity"),
        ({"end_positions": [[0, 0, 0]]}, "add_mesh: the mesh has 1 positions at the end for 3 vertices"),
        ({"end_positions": np.empty((0, 3))}, "add_mesh, end_positions: expected one per position"),
        ({"end_positions": np.full((3, 3), np.nan)}, "add_mesh: vertex 0 lies at infinity in world space at the end"),
        ({"end_normals": [[0, 0, 1]] * 3}, "add_mesh: the mesh has normals at the end, but no positions"),
        ({"light": montelux.Spectrum(-1)}, "Shape.light: the light's spectrum has no positive luminance"),
    ],
)
def test_meshes_that_make_no_sense_are_refused_whole(changes, sentence):
    scene = montelux.Scene()
    mesh = {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]], "material": montelux.Diffuse()}
    with pytest.raises(montelux.Error, match=sentence):
        scene.add_mesh(**{**mesh, **changes})
    assert len(scene.shapes) == 0 and len(scene.lights) == 0 and len(scene.materials) == 0
    scene.add_mesh(**mesh)
    assert len(scene.shapes) == 1
