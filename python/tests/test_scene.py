"""Scenes: attributes, scenes built in Python, and mistakes answered with sentences."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest

import montelux
from small_scene import TEXT

# Attributes.


def test_attributes_change_the_picture(scene):
    before = scene.render().mean
    scene.materials[0].reflectance = (0.9, 0.1, 0.1)
    red = scene.render().mean
    assert red[12, 16, 0] > 2 * red[12, 16, 1] and not np.array_equal(before, red)
    scene.lights[0].scale *= 2
    assert scene.render().mean[0, 0] == pytest.approx(2 * red[0, 0], rel=1e-3)
    scene.camera.fov = 20
    assert scene.render().layers["depth"][12, 0] > 0  # the sphere fills the picture
    scene.film.resolution = 8, 6
    assert scene.render().mean.shape == (6, 8, 3)
    scene.film.crop = (2, 1, 6, 5)
    assert scene.render().mean.shape == (4, 4, 3)


def test_attributes_read_what_was_set(scene):
    camera, film = scene.camera, scene.film
    camera.fov, camera.lens_radius = 33, 0.5
    assert (scene.camera.fov, scene.camera.lens_radius) == (33, 0.5)
    film.filter = montelux.GaussianFilter(radius=(2, 1), sigma=0.7)
    assert scene.film.filter.radius == (2, 1) and scene.film.filter.sigma == pytest.approx(0.7)
    film.filter.sigma = 0.5
    assert scene.film.filter.sigma == 0.5
    assert film.sensor == "cie1931"
    film.sensor = "nikon_d850"
    assert scene.film.sensor == "nikon_d850"
    with pytest.raises(montelux.Error, match="did you mean 'nikon_d850'"):
        film.sensor = "nikon_d85"
    scene.materials[0].reflectance = montelux.Spectrum(0.25)
    assert scene.materials[0].reflectance(550) == 0.25
    scene.materials[0] = montelux.Dielectric(eta="glass-BK7", roughness=0.1)
    assert scene.materials[0].eta(587.6) == pytest.approx(1.5168, abs=1e-3)
    assert scene.shapes[1].material == scene.materials[0] == scene.shapes[0].material
    scene.shapes[0].material = montelux.Diffuse()
    assert scene.shapes[0].material == scene.materials[1] != scene.shapes[1].material
    assert scene.lights[1].two_sided is False and len(scene.lights) == 2
    assert scene.shapes[0].light == scene.lights[1] and scene.shapes[1].light is None
    assert camera.world_from_camera[:3, 3] == pytest.approx([0, -4, 0], abs=1e-6)
    scene.integrator.max_depth = 2
    assert scene.integrator.max_depth == 2 and scene.integrator.strategy == "mis"
    assert "2 shapes" in repr(scene) and "fov=33" in repr(scene.camera)


@pytest.mark.parametrize("kind", [montelux.UniformInfiniteLight, montelux.PointLight, montelux.AreaLight])
def test_the_scale_of_a_new_light_multiplies(kind):
    plain, double = kind(spectrum=(0.5, 0.6, 0.7)), kind(spectrum=(0.5, 0.6, 0.7), scale=2)
    assert double.scale == pytest.approx(2 * plain.scale)
    assert kind(scale=2).scale == pytest.approx(2 * kind().scale)
    double.scale /= 2
    assert double.scale == pytest.approx(plain.scale)


@pytest.mark.parametrize("kind", ["uniform", "map"])
def test_light_comes_through_a_portal(kind):
    scene = montelux.Scene()
    scene.camera = montelux.PerspectiveCamera(fov=90, look_at=((0, 0, 0), (0, 0, 1), (0, 1, 0)))
    scene.film.resolution = 8, 8
    if kind == "uniform":
        scene.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
    else:
        scene.add_environment(np.ones((4, 4, 3)))
    light = scene.lights[0]
    assert light.portal is None
    assert scene.render(spp=64).mean.mean() == pytest.approx(1, rel=1e-2)  # wavelengths are drawn
    corners = np.array([[-0.5, -0.5, 1], [-0.5, 0.5, 1], [0.5, 0.5, 1], [0.5, -0.5, 1]])
    light.portal = corners
    assert np.array_equal(light.portal, corners)
    assert scene.render(spp=4).mean.mean() < 0.5
    with pytest.raises(montelux.Error, match="portal: the portal is no rectangle: edges are not perpendicular"):
        light.portal = corners + [[0, 0, 0], [0.2, 0, 0], [0.2, 0, 0], [0, 0, 0]]
    with pytest.raises(montelux.Error, match=r"corners of a rectangle, shape \(4, 3\)"):
        light.portal = corners[:3]
    light.portal = None
    assert scene.render(spp=64).mean.mean() == pytest.approx(1, rel=1e-2)  # wavelengths are drawn


def test_numbers_of_numpy_are_numbers(scene):
    render = scene.render(spp=np.int64(4), seed=np.uint8(3), threads=np.int32(1))
    assert np.array_equal(render.mean, scene.render(spp=4).mean)


def test_an_unknown_error_is_reported(scene):
    assert "error not known yet" in repr(scene.render(spp=1).wait())
    with pytest.raises(montelux.Error, match=r"look_at=5 was given; expected \(eye, target\)"):
        montelux.PerspectiveCamera(look_at=5)


def test_area_lights_of_a_mesh_are_one(scene):
    light = scene.shapes[0].light
    light.spectrum, light.two_sided = (10, 0, 0), True
    picture = scene.render().mean
    scene.shapes[0].light = None
    assert len(scene.lights) == 1 and scene.render().mean.sum() < picture.sum()
    scene.shapes[0].light = montelux.AreaLight(spectrum=(1, 0, 0), two_sided=True)
    assert len(scene.lights) == 2 and scene.lights[1].two_sided


def test_lights_can_be_taken_away_and_added(scene):
    del scene.lights[0]
    assert scene.shapes[0].light == scene.lights[0]
    assert scene.render().mean[0, 0].sum() == 0  # no sky
    scene.lights.append(montelux.PointLight(spectrum=100, position=(0, -4, 1)))
    scene.lights.append(montelux.SpotLight(spectrum=10, position=(0, -4, 4), axis=(0, 1, -1), cone_angle=40))
    scene.lights.append(montelux.DistantLight(to_light=(0, -1, 2)))
    assert scene.lights[-1].to_light == pytest.approx(np.array([0, -1, 2]) / math.sqrt(5))
    assert scene.render().mean[12, 16].sum() > 0


def test_a_running_render_does_not_change_with_the_scene(scene):
    alone = scene.render(spp=64).mean
    render = scene.render(spp=64)
    scene.materials[0].reflectance = 0.0
    assert np.array_equal(render.mean, alone)


# Built in Python.


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
    assert scene.add_sphere(1, montelux.Diffuse()).end_positions is None
    # It may shine: |x| sees it until the time 1 - |x|, and the sky of the same radiance afterwards.
    shape.light = (1, 1, 1)
    assert len(scene.lights) == 2
    assert scene.render(spp=256).mean[8, :, 1] == pytest.approx(np.ones(16), abs=0.02)


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


def write_measured_brdf(path):
    """A white surface whose microfacets face all directions alike, in the format of Dupuy and Jakob's database."""
    ones = {"ndf": (2, 2), "sigma": (2, 2), "vndf": (1, 2, 2, 2), "luminance": (1, 2, 2, 2), "spectra": (1, 2, 1, 2, 2)}
    fields = {"jacobian": np.ones(1, np.uint8), "phi_i": np.zeros(1, "<f4"), "theta_i": np.array([0, 1.5], "<f4")}
    fields["wavelengths"] = np.array([550], "<f4")
    fields.update({name: np.ones(shape, "<f4") for name, shape in ones.items()})
    offset = 18 + sum(13 + len(name) + 8 * values.ndim for name, values in fields.items())
    head, data = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
    for name, values in fields.items():
        head += struct.pack("<H", len(name)) + name.encode()
        head += struct.pack("<HBQ", values.ndim, 1 if values.dtype == np.uint8 else 10, offset + len(data))
        head += struct.pack(f"<{values.ndim}Q", *values.shape)
        data += values.tobytes()
    path.write_bytes(head + data)


def test_measured_material(tmp_path):
    write_measured_brdf(tmp_path / "a.bsdf")
    scene = montelux.Scene()
    scene.camera = montelux.PerspectiveCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)), fov=30)
    scene.film.resolution = (8, 8)
    scene.lights.append(montelux.PointLight(position=(1, 0, 3)))
    shape = scene.add_sphere(1, montelux.Measured())
    assert shape.material.brdf is None
    with pytest.raises(montelux.Error, match=r"material 0 \(Measured\), brdf: no measured BRDF is given"):
        scene.render(spp=1).mean
    shape.material.brdf = scene.measured_brdf(tmp_path / "a.bsdf")
    assert repr(shape.material.brdf) == "<MeasuredBrdf 0>"
    assert scene.render(spp=4).mean.max() > 0
    with pytest.raises(montelux.Error, match="brdf: 3 was given; expected what Scene.measured_brdf"):
        shape.material.brdf = 3
    with pytest.raises(montelux.Error, match="none.bsdf"):
        scene.measured_brdf(tmp_path / "none.bsdf")
    shape.material = montelux.Mix()
    with pytest.raises(montelux.Error, match=r"\(Mix\), first: no material is given"):
        scene.render(spp=1).mean


def test_every_material_has_bumps_and_normal_maps():
    def picture(material, **detail):
        scene = montelux.Scene()
        scene.camera = montelux.PerspectiveCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)), fov=30)
        scene.film.resolution = (8, 8)
        scene.lights.append(montelux.PointLight(position=(1, 0, 3)))
        corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
        shape = scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], material(), uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
        for name, make in detail.items():
            setattr(shape.material, name, make(scene))
        return scene, scene.render(spp=4)

    def bumps(scene):
        ramp = np.tile((np.arange(64) + 0.5) / 64, (64, 1))
        return scene.image_texture(ramp, scale=0.8, as_float=True)

    def normals(scene):
        return scene.normal_map(np.array([[[0.4, 0.5, 1.0]]]))

    def flat(scene):
        return scene.normal_map(np.array([[[0.5, 0.5, 1.0]]]))

    for material in montelux._core.MATERIALS:
        assert material().normal_map is None and material().displacement == 0
        if material in (montelux.Interface, montelux.Mix):  # have no surface to tilt
            continue
        if material is montelux.Measured:  # needs a file
            continue
        scene, plain = picture(material)
        # Both tilt the normal by a slope of 0.2 against x.
        for name, make in (("displacement", bumps), ("normal_map", normals)):
            scene, tilted = picture(material, **{name: make})
            normal = tilted.layers["normal"][4, 4]
            assert normal == pytest.approx(np.array([-0.2, 0, 1]) / np.sqrt(1.04), abs=2e-3), (material, name)
        assert repr(scene.materials[0].normal_map) == "<NormalMap 0>"
        scene.materials[0].normal_map = None
        assert scene.materials[0].normal_map is None
        assert (picture(material, normal_map=flat)[1].mean == plain.mean).all()
    # Bytes are taken for linear.
    _, eight_bits = picture(montelux.Diffuse, normal_map=lambda s: s.normal_map(np.uint8([[[102, 128, 255]]])))
    assert eight_bits.layers["normal"][4, 4][0] == pytest.approx(-0.2, abs=0.01)
    with pytest.raises(montelux.Error, match="normal_map: 3 was given; expected None or what Scene.normal_map"):
        scene.materials[0].normal_map = 3
    with pytest.raises(montelux.Error, match="another scene"):
        scene.materials[0].normal_map = montelux.Scene().normal_map(np.ones((1, 1, 3)))
    with pytest.raises(montelux.Error, match="no channels R, G and B"):
        scene.normal_map(np.ones((2, 2)))


def test_light_shines_through_a_leaf():
    scene = montelux.Scene()
    scene.camera = montelux.PerspectiveCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)), fov=1)
    scene.film.resolution = (4, 4)
    lamp = scene.lights.append(montelux.PointLight(position=(0, 0, -2)))
    leaf = montelux.DiffuseTransmission(reflectance=0.5, transmittance=0.25)
    shape = scene.add_disk(3, leaf)
    behind = scene.render(spp=16).mean.mean()
    lamp.position = (0, 0, 2)
    assert scene.render(spp=16).mean.mean() == pytest.approx(2 * behind, rel=1e-3)
    shape.material.scale = 0.5
    assert scene.render(spp=16).mean.mean() == pytest.approx(behind, rel=1e-3)


def test_every_value_can_be_made_and_read():
    from montelux._scene import VALUES

    for kind in VALUES:
        value = kind()
        for name in montelux._names.settings_of(kind):
            getattr(value, name)
        assert repr(value).startswith(kind.__name__ + "(")
        with pytest.raises(montelux.Error, match="there is no attribute 'wrong'"):
            kind(wrong=1)


def test_every_value_and_method_is_in_the_package():
    from montelux import _core
    from montelux._scene import VALUES

    methods = {kind for kind in vars(_core).values() if hasattr(kind, "_method")}
    assert methods == set(montelux.METHODS.values())
    for kind in (*VALUES, *methods):
        assert kind.__name__ in montelux.__all__ and getattr(montelux, kind.__name__) is kind


# Mistakes.


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
    usual = montelux.load(tmp_path / "scene.pbrt").render(spp=4).mean
    for scene in (
        montelux.load(tmp_path / "scene.pbrt", texture_memory=16 << 20),
        montelux.parse(text, folder=tmp_path, texture_memory=1 << 40),
    ):
        assert (scene.render(spp=4).mean == usual).all()
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
        ("model.gltf", '{"asset": {"version": "2.0"}, "scenes": []}', r"a glTF scene \(JSON\)"),
        ("bunny.pbrt", "ply\nformat ascii 1.0\n", "a PLY mesh"),
    ]:
        (tmp_path / name).write_text(content)
        with pytest.raises(montelux.Error, match=f"{name}: looks like {kind}; expected a scene of pbrt-v4"):
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
    assert len(scene.shapes) == 0 and len(scene.lights) == 0
    scene.add_mesh(**mesh)
    assert len(scene.shapes) == 1
