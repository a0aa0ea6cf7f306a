"""Scenes built in Python: shapes, textures, maps and the spectra of values."""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from small_scene import TEXT


def test_values_bring_their_spectra_into_scenes(scene):
    warm, red = montelux.Spectrum.blackbody(3000), montelux.Spectrum.rgb(0.6, 0.2, 0.1)
    material = montelux.Dielectric(eta="glass-BK7")
    metal = montelux.CoatedConductor(conductor_eta="metal-Au-eta", interface_eta=red)
    light = montelux.PointLight(spectrum=warm)
    other = montelux.Scene()
    other.materials.append(montelux.Conductor())
    for s in (scene, other):
        placed = [s.materials.append(material), s.materials.append(metal), s.lights.append(light)]
        assert placed[0].eta(550) == montelux.Spectrum.named("glass-BK7")(550)
        assert placed[1].conductor_eta(550) == montelux.Spectrum.named("metal-Au-eta")(550)
        assert placed[1].conductor_k(550) == montelux.Spectrum.named("metal-Cu-k")(550)
        assert placed[1].interface_eta(550) == red(550)
        assert placed[2].spectrum(550) == warm(550)
    # From scene to scene.
    shape = other.add_sphere(1, scene.materials[-1], light=warm)
    assert shape.material.conductor_eta(600) == montelux.Spectrum.named("metal-Au-eta")(600)
    scene.shapes[1].light = shape.light
    assert scene.shapes[1].light.spectrum(600) == warm(600)
    scene.materials[0] = shape.material
    assert scene.materials[0].interface_eta(500) == red(500)
    # A change stays where it is made.
    material.eta = 2
    placed[0].eta = warm
    assert [m.eta(550) for m in (material, scene.materials[-2], placed[0])] == [
        2,
        montelux.Spectrum.named("glass-BK7")(550),
        warm(550),
    ]


def test_a_scene_built_in_python_equals_the_file_s():
    built = montelux.Scene()
    built.camera = montelux.PerspectiveCamera(fov=40, look_at=((0, -4, 0), (0, 0, 0), (0, 0, 1)))
    built.film.resolution = 32, 24
    built.sampler.kind = "sobol-blue-noise"
    built.sampler.seed = 3
    built.integrator.max_depth = 5
    built.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    up = np.eye(4)
    up[2, 3] = 3
    built.add_mesh(
        square, [[0, 1, 2], [0, 2, 3]], montelux.Diffuse(reflectance=(0.5, 0.5, 0.5)), transform=up, light=(2, 2, 2)
    )
    built.add_sphere(1, montelux.Diffuse(reflectance=(0.5, 0.5, 0.5)))
    loaded = montelux.parse(TEXT)
    assert loaded.sampler.kind == "sobol-blue-noise"
    assert np.array_equal(built.render(spp=16).mean, loaded.render(spp=16).mean)


def test_meshes_deform_while_the_shutter_is_open():
    scene = montelux.Scene()
    scene.camera = montelux.OrthographicCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)))
    scene.film.resolution = 16, 16
    scene.sampler.spp = 256
    scene.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    up, ups = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1.0]]), [[0, 0, 1]] * 4
    shape = scene.add_mesh(
        corners, [[0, 1, 2], [0, 2, 3]], montelux.Diffuse(reflectance=0), normals=ups, transform=up,
        end_positions=corners * [0, 1, 1], end_normals=ups,
    )  # fmt: skip
    assert shape.positions == pytest.approx(corners + [0, 0, 1])
    assert shape.end_positions == pytest.approx(corners * [0, 1, 1] + [0, 0, 1])
    # |x| is covered until time 1 - |x|.
    x = np.abs((np.arange(16) + 0.5) / 8 - 1)
    row = scene.render(spp=1024).mean[8, :, 1]
    assert row == pytest.approx(x, abs=0.08)
    # It may shine: |x| sees it until the time 1 - |x|, and the sky of the same radiance afterwards.
    shape.light = (1, 1, 1)
    assert len(scene.lights) == 2
    assert scene.render(spp=256).mean[8, :, 1] == pytest.approx(np.ones(16), abs=0.02)
    assert scene.add_sphere(1, montelux.Diffuse()).end_positions is None


def test_meshes_textures_and_environments():
    scene = montelux.Scene()
    scene.camera = montelux.OrthographicCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)))
    scene.film.resolution = 16, 16
    scene.add_environment(np.ones((4, 4, 3)))
    picture = np.zeros((2, 2, 3))
    picture[:, 1] = 0.8  # the right half
    material = montelux.Diffuse(reflectance=scene.image_texture(picture, filter="point"))
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    shape = scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], material, uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
    albedo = scene.render(spp=16).layers["albedo"]
    right, left = albedo[8, 12, 0], albedo[8, 3, 0]
    assert sorted([right, left]) == pytest.approx([0, 0.8], abs=0.05)
    assert shape.positions == pytest.approx(corners) and shape.kind == "mesh"
    shape.material = montelux.Diffuse(reflectance=scene.checkerboard_texture(0.1, 0.9, 2, 2))
    assert 0.1 < scene.render(spp=16).layers["albedo"].mean() < 0.9
    scene.add_disk(0.5, montelux.Conductor(), height=1)
    assert scene.render(spp=4).layers["depth"][8, 8] == pytest.approx(3, abs=1e-3)
    tube = scene.add_cylinder(0.5, montelux.Conductor(), z_min=0.5, z_max=1.5)
    assert tube.kind == "cylinder"
    with pytest.raises(montelux.Error, match="add_cylinder, z_max"):
        scene.add_cylinder(1, material, z_min=1, z_max=-1)
    strands = np.array([[[x, -1, 0], [x, 0, 0.5], [x, 1, 0]] for x in (-0.5, 0, 0.5)])
    hair = scene.add_curves(strands, (0.1, 0.05), montelux.Hair(), kind="cylinder", degree=2)
    assert hair.kind == "curves"
    assert np.isfinite(scene.render(spp=4).layers["mean"]).all()
    with pytest.raises(montelux.Error, match="add_curves: 3 control points were given; expected 4"):
        scene.add_curves(strands, 0.1, material)
    with pytest.raises(montelux.Error, match="0 normals were given for 1 segment; expected 2"):
        scene.add_curves(strands, 0.1, material, degree=2, kind="ribbon")
    with pytest.raises(montelux.Error, match="add_curves, width"):
        scene.add_curves(strands, -1, material, degree=2)
    other = montelux.Scene()
    with pytest.raises(montelux.Error, match="another scene"):
        other.add_sphere(1, material)
    with pytest.raises(montelux.Error, match="another scene"):
        other.add_sphere(1, shape.material)
