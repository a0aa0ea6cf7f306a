"""Settings of scenes that a pbrt file has as well: a scene built or changed in Python renders to the same bits."""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from small_scene import TEXT, unnamed_files

# A biconvex lens with a stop behind it; in millimetres as pbrt's lens files have it.
LENS = "50 3 1.5 20\n-50 1 1 20\n0 50 0 8\n"
SURFACES = [(0.05, 0.003, 1.5, 0.01), (-0.05, 0.001, 1, 0.01), (0, 0.05, 0, 0.004)]


def lens_scene(folder, aperture=""):
    (folder / "lens.dat").write_text(LENS)
    numbers = '"float focusdistance" 1 "float aperturediameter" 8'
    camera = f'Camera "realistic" "string lensfile" "lens.dat" {numbers} {aperture}'
    return montelux.parse(TEXT.replace('Camera "perspective" "float fov" 40', camera), folder=folder)


def test_an_aperture_is_a_name_a_file_or_an_array(tmp_path):
    scene, square = lens_scene(tmp_path), lens_scene(tmp_path, '"string aperture" "square"')
    assert scene.camera.aperture is None
    round_picture, square_picture = scene.render().mean, square.render().mean
    assert not np.array_equal(round_picture, square_picture)
    scene.camera.aperture = "square"
    assert np.array_equal(scene.render().mean, square_picture)
    stop = scene.camera.aperture
    assert stop.shape == (256, 256) and stop.mean() == pytest.approx(np.pi / 4)
    assert np.array_equal(stop, square.camera.aperture) and stop[128, 64] > 0 == stop[128, 63]
    scene.camera.aperture = None
    assert np.array_equal(scene.render().mean, round_picture)
    # Row 0 is the top; the scale of an array has no effect, and uint8 is in sRGB, as in files.
    code = np.array([[255, 128], [0, 0]], np.uint8)
    linear = np.array([[1, 0.2158605], [0, 0]])
    camera = montelux.RealisticCamera(surfaces=SURFACES, aperture=code)
    assert camera.aperture == pytest.approx(linear * np.pi / linear.sum(), abs=1e-6)
    camera.aperture = np.repeat(7 * linear[:, :, None], 3, axis=2)
    assert camera.aperture == pytest.approx(linear * np.pi / linear.sum(), abs=1e-6)
    scene.render(spp=1).save(tmp_path / "stop.exr")
    camera.aperture = tmp_path / "stop.exr"
    assert camera.aperture.shape == (24, 32)
    camera.aperture = str(tmp_path / "stop.exr")
    assert camera.aperture.shape == (24, 32)


@pytest.mark.parametrize(
    "value, sentence",
    [
        ("pentagn", r"'pentagn' \(did you mean 'pentagon'\?\); expected one of gaussian, .*, a file or an array"),
        (3, r"RealisticCamera.aperture: expected a file, or an array of shape \(h, w, 3\) or \(h, w\)"),
        (np.zeros((2, 2)), "RealisticCamera.aperture: .*the picture lets no light through"),
        (-np.ones((2, 2)), "RealisticCamera.aperture: .*negative or not finite"),
    ],
)
def test_apertures_that_make_no_sense(value, sentence):
    camera = montelux.RealisticCamera(aperture="star")
    before = camera.aperture
    with pytest.raises(montelux.Error, match=sentence):
        camera.aperture = value
    assert np.array_equal(camera.aperture, before)


def test_a_spectral_film_has_layers_of_wavelengths(scene, tmp_path):
    assert scene.film.spectral is None and "spectral" not in scene.render(spp=1).layers
    film = 'Film "spectral" "integer nbuckets" 5 "float lambdamin" 400 "float lambdamax" 700'
    loaded = montelux.parse(TEXT.replace('Film "rgb"', film))
    scene.film.spectral = montelux.Spectral(buckets=5, lambda_min=400, lambda_max=700)
    there, here = loaded.render(), scene.render()
    for layer in ("mean", "spectral", "spectral_standard_error"):
        assert np.array_equal(there.layers[layer], here.layers[layer])
    assert here.layers["spectral"].shape == here.layers["spectral_standard_error"].shape == (24, 32, 5)
    assert scene.film.spectral.wavelengths == pytest.approx([430, 490, 550, 610, 670])
    here.save(tmp_path / "picture.exr")
    file = montelux.read_channels(tmp_path / "picture.exr")
    assert np.array_equal(file["S0.550,000nm"], here.layers["spectral"][:, :, 2])
    assert np.array_equal(file["stderr.S0.670,000nm"], here.layers["spectral_standard_error"][:, :, 4])
    # Parts of a scene are places in it.
    part = scene.film.spectral
    part.buckets = 1
    assert scene.film.spectral.buckets == 1 and scene.render(spp=1).layers["spectral"].shape == (24, 32, 1)
    scene.film = montelux.Film(resolution=(8, 6), spectral=part)
    assert scene.film.spectral.lambda_max == 700
    scene.film.spectral = None
    assert scene.film.spectral is None and "spectral" not in scene.render(spp=1).layers
    with pytest.raises(montelux.Error, match="Film.spectral: it was set to None after"):
        part.buckets = 3


@pytest.mark.parametrize(
    "change, sentence",
    [
        ("film.spectral.buckets = 0", "0 was given; expected a whole number from 1 to 512"),
        ("film.spectral.lambda_min = 300", "300 was given; expected 360 nm or more, and less than lambda_max"),
        ("film.spectral.lambda_max = 400", "400 was given; expected 830 nm or less, and more than lambda_min"),
        ("film.spectral.lambda_max = 'red'", "'red' was given; expected a number"),
        ("film.spectral.bucket = 3", r"did you mean 'buckets'\?"),
        ("film.spectral = 16", r"Film.spectral: 16 was given; expected None, or Spectral\(\)"),
        ("render(slice=(1, 2))", "a spectral film cannot be rendered in slices"),
    ],
)
def test_spectral_films_that_make_no_sense(scene, change, sentence):
    scene.film.spectral = montelux.Spectral(buckets=4, lambda_min=450)
    with pytest.raises(montelux.Error, match=sentence):
        exec(f"scene.{change}", {"scene": scene})
    assert repr(scene.film.spectral) == "Spectral(buckets=4, lambda_min=450.0, lambda_max=830.0)"


def test_ambient_occlusion(scene):
    assert scene.integrator.occlusion is None
    light = scene.render().mean
    for settings, parameters in (
        ({}, ""),
        ({"cosine": False}, '"bool cossample" false'),
        ({"max_distance": 0.5}, '"float maxdistance" 0.5'),
    ):
        scene.integrator.occlusion = montelux.Occlusion(**settings)
        loaded = montelux.parse(f'Integrator "ambientocclusion" {parameters}' + TEXT)
        assert np.array_equal(scene.render().mean, loaded.render().mean)
        assert repr(scene.integrator.occlusion) == repr(loaded.integrator.occlusion)
    # Above the ball's top is a lamp at a distance of 2.
    scene.camera.look_at((0, 0, 2.9), (0, 0, 0), (0, 1, 0))
    assert scene.render().mean[8:16, 12:20].mean() == pytest.approx(1, abs=0.03)
    scene.integrator.occlusion.max_distance = 3
    assert scene.render().mean[8:16, 12:20].mean() < 0.9
    scene.camera.look_at((0, -4, 0), (0, 0, 0))
    scene.integrator.occlusion = None
    assert np.array_equal(scene.render().mean, light)
    assert montelux.Integrator(occlusion=montelux.Occlusion()).occlusion.max_distance == float("inf")


def test_merging(scene):
    integrator = scene.integrator
    assert integrator.merging is None
    integrator.method = "bidirectional"
    unmerged = scene.render().mean
    integrator.merging = montelux.Merging(radius=0.2, memory=16)
    assert repr(integrator.merging).startswith("Merging(radius=0.2")
    assert not np.array_equal(scene.render().mean, unmerged)
    integrator.method = "path"
    with pytest.raises(montelux.Error, match="only the integrator 'bidirectional' merges"):
        scene.render()
    with pytest.raises(montelux.Error, match="a number from 0 on"):
        integrator.merging.radius = -1


@pytest.mark.parametrize(
    "change, sentence",
    [
        ("integrator.occlusion = True", r"Integrator.occlusion: True was given; expected None, or Occlusion\(\)"),
        ("integrator.occlusion.max_distance = 0", "0 was given; expected a number above zero"),
        ("integrator.occlusion.max_distance = 1e-300", "1e-300 was given; expected a number above zero"),
        ("integrator.occlusion.max_distance = None", "None was given; expected a number"),
        ("integrator.occlusion.cosine = 1", "1 was given; expected True or False"),
        ("integrator.occlusion.maxdistance = 1", r"did you mean 'max_distance'\?"),
    ],
)
def test_ambient_occlusion_that_makes_no_sense(scene, change, sentence):
    scene.integrator.occlusion = montelux.Occlusion(max_distance=2)
    with pytest.raises(montelux.Error, match=sentence):
        exec(f"scene.{change}", {"scene": scene})
    assert repr(scene.integrator.occlusion) == "Occlusion(cosine=True, max_distance=2.0)"


def test_regularization():
    mirror = 'Material "conductor" "float roughness" 0'
    text = TEXT.replace('Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]', mirror)
    floor = 'Material "diffuse" Shape "disk" "float radius" 3 "float height" -1'
    scene, loaded = montelux.parse(text + floor), None
    assert scene.integrator.regularize is False
    plain = scene.render().mean
    scene.integrator.regularize = True
    with pytest.warns(UserWarning, match="the picture is biased"):
        loaded = montelux.parse('Integrator "path" "bool regularize" true' + text + floor)
    assert loaded.integrator.regularize is True
    wide = scene.render().mean
    assert np.array_equal(wide, loaded.render().mean) and not np.array_equal(wide, plain)
    with pytest.raises(montelux.Error, match="Integrator.regularize: 'yes' was given; expected True or False"):
        scene.integrator.regularize = "yes"


def test_textures_of_a_new_scene_in_a_file():
    def ball(**settings):
        scene = montelux.Scene(**settings)
        scene.camera = montelux.PerspectiveCamera(fov=40, look_at=((0, -4, 0), (0, 0, 0)))
        scene.film.resolution = 16, 12
        scene.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
        picture = np.random.default_rng(1).random((128, 128, 3))
        material = montelux.Diffuse(reflectance=scene.image_texture(picture, filter="trilinear"))
        material.normal_map = scene.normal_map(0.5 + picture / 2)
        scene.add_sphere(1, material)
        return scene

    usual = ball()
    assert usual.texture_memory is None
    picture, before = usual.render(spp=4).mean, unnamed_files()
    scene = ball(texture_memory=16 << 20)
    assert scene.texture_memory == 16 << 20 and unnamed_files() >= before + 2
    assert np.array_equal(scene.render(spp=4).mean, picture)
    scene.film.resolution = 8, 6  # while the finished render may still share the scene
    assert scene.texture_memory == 16 << 20
    del scene
    assert unnamed_files() == before
    assert montelux.parse(TEXT, texture_memory=1 << 30).texture_memory == 1 << 30


def test_texture_memory_that_makes_no_sense():
    for wrong in (-1, 1.5, "500M", True, 1 << 70):
        with pytest.raises(montelux.Error, match="montelux.Scene, texture_memory: .* expected a number of bytes"):
            montelux.Scene(texture_memory=wrong)
    with pytest.raises(montelux.Error, match="the limit must be at least 16777216 bytes, but is 1000"):
        montelux.Scene(texture_memory=1000)
    with pytest.raises(montelux.Error, match=r"Scene: there is no argument 'texturememory' \(did you mean"):
        montelux.Scene(texturememory=1 << 30)


def test_lights_are_grouped_by_light_or_by_kind(scene):
    scene.lights.append(montelux.PointLight(position=(0, -4, 1)))
    scene.lights.append(montelux.PointLight(position=(0, -4, 2)))
    scene.film.layers = "default,light-groups"

    def groups():
        return sorted(name for name in scene.render(spp=1).layers if name.startswith("light."))

    assert scene.film.light_grouping == "light" and len(groups()) == 4
    scene.film.light_grouping = "kind"
    assert scene.film.light_grouping == "kind"
    assert groups() == ["light.area-light", "light.point-light", "light.uniform-sky"]
    with pytest.raises(montelux.Error, match=r"'kinds' \(did you mean 'kind'\?\); expected one of light, kind"):
        scene.film.light_grouping = "kinds"


def moving_scene(shutter=""):
    """The camera moves one unit to the right."""
    start, end = ("LookAt {0} -4 0  {0} 0 0  0 0 1".format(x) for x in (0, 1))
    moving = f"ActiveTransform StartTime {start} ActiveTransform EndTime {end} ActiveTransform All"
    camera = f'Camera "perspective" "float fov" 40 {shutter}'
    text = TEXT.replace("LookAt 0 -4 0  0 0 0  0 0 1", moving)
    return montelux.parse(text.replace('Camera "perspective" "float fov" 40', camera))


def test_cameras_move_while_the_shutter_is_open(scene):
    start, still = scene.camera.world_from_camera, scene.render().mean
    assert scene.camera.end_world_from_camera is None and scene.camera.shutter == (0, 1)
    end = start + np.outer([1, 0, 0, 0], [0, 0, 0, 1])
    for loaded in (moving_scene(), moving_scene('"float shutteropen" 0.25 "float shutterclose" 0.75')):
        scene.camera.end_world_from_camera, scene.camera.shutter = end, loaded.camera.shutter
        scene.film.exposure_time = loaded.film.exposure_time
        assert np.array_equal(scene.camera.end_world_from_camera, loaded.camera.end_world_from_camera)
        picture = scene.render().mean
        assert np.array_equal(picture, loaded.render().mean) and not np.array_equal(picture, still)
    assert scene.camera.shutter == (0.25, 0.75)
    there = (0, -4, 0), (0, 0, 0)
    made = montelux.PerspectiveCamera(fov=40, end_world_from_camera=end, look_at=there, shutter=(0, 0))
    assert made.end_world_from_camera == pytest.approx(end)
    scene.camera = made  # open for an instant only
    scene.film.exposure_time = 1
    moving = moving_scene().render().mean
    assert 5 * np.abs(scene.render().mean - still).mean() < np.abs(moving - still).mean()
    scene.camera.end_world_from_camera = None
    assert scene.camera.end_world_from_camera is None
    scene.camera.world_from_camera = start
    assert np.array_equal(scene.render().mean, still)


def test_a_moving_camera_that_is_placed_stands_still(scene):
    """It was placed in vain: its motion went on."""
    still = scene.render().mean
    for place in (
        lambda camera: camera.look_at((0, -4, 0), (0, 0, 0)),
        lambda camera: setattr(camera, "world_from_camera", scene.camera.world_from_camera),
    ):
        moving = moving_scene()
        place(moving.camera)
        assert np.array_equal(moving.render().mean, still)
        assert moving.camera.end_world_from_camera is None


@pytest.mark.parametrize(
    "change, sentence",
    [
        ("shutter = (1, 0)", r"camera.shutter: \(1, 0\) was given; expected \(open, close\) with open <= close"),
        ("shutter = 1", "camera.shutter: 1 was given; expected 2 numbers"),
        ("shutter = (0, float('inf'))", "camera.shutter: a number that is not finite"),
        ("end_world_from_camera = np.eye(3)", r"end_world_from_camera: expected a matrix of shape \(4, 4\)"),
        ("end_world_from_camera = np.zeros((4, 4))", "end_world_from_camera: the matrix has no inverse"),
        ("end_world_from_camera = np.diag([-1, 1, 1, 1])", "_camera: .*one end is mirrored and the other is not"),
        ("end_world_from_camera = np.eye(4)[::-1]", "the last row of its matrices is 0 0 0 1"),
    ],
)
def test_motions_that_make_no_sense(change, sentence):
    scene = moving_scene()
    shutter, end = scene.camera.shutter, scene.camera.end_world_from_camera
    with pytest.raises(montelux.Error, match=sentence):
        exec(f"scene.camera.{change}", {"scene": scene, "np": np})
    assert scene.camera.shutter == shutter and np.array_equal(scene.camera.end_world_from_camera, end)
