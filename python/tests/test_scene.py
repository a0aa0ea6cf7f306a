"""Scenes: attributes, and values that can be made and read."""

from __future__ import annotations

import math

import numpy as np
import pytest

import montelux


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


def test_crop_keeps_its_place_on_films_of_any_resolution(scene):
    scene.film.resolution = 50_000, 10
    scene.film.crop = (40_000, 0, 50_000, 10)
    scene.film.resolution = 60_000, 10
    assert scene.film.crop == (48_000, 0, 60_000, 10)


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


def test_the_light_of_a_shape_is_replaced_in_its_place(scene):
    lamp = scene.lights.append(montelux.PointLight(spectrum=100, position=(0, -4, 1)))
    before = scene.shapes[0].light
    scene.shapes[0].light = (1, 0, 0)
    assert scene.shapes[0].light == before == scene.lights[1]
    assert lamp == scene.lights[2] and lamp.position == pytest.approx([0, -4, 1])
    picture = scene.render(spp=4).mean
    # One that is refused changes nothing.
    for wrong in (montelux.Spectrum(-1), montelux.PointLight(), -1, "no spectrum"):
        with pytest.raises(montelux.Error, match="Shape.light"):
            scene.shapes[0].light = wrong
        assert scene.shapes[0].light == before and len(scene.lights) == 3
    assert np.array_equal(scene.render(spp=4).mean, picture)
    scene.shapes[0].light = None
    assert [type(light).__name__ for light in scene.lights] == ["UniformInfiniteLight", "PointLight"]


def test_parts_of_values_outside_a_scene_are_changed_where_they_are():
    film = montelux.Film(filter=montelux.GaussianFilter(), spectral=montelux.Spectral(buckets=4))
    part, spectral = film.filter, film.spectral
    part.sigma, spectral.buckets = 0.25, 7
    assert film.filter.sigma == 0.25 and film.spectral.buckets == 7
    assert film.filter == part and film.spectral == spectral
    assert montelux.Film(filter=montelux.GaussianFilter()).filter != part
    other = montelux.Film(filter=part)
    other.filter.sigma = 1
    assert film.filter.sigma == 0.25
    film.spectral, film.filter = None, montelux.BoxFilter()
    with pytest.raises(montelux.Error, match="Film.spectral: it was set to None after"):
        spectral.buckets = 3
    with pytest.raises(montelux.Error, match="replaced by one of another kind"):
        part.sigma = 0.5
    integrator = montelux.Integrator(occlusion=montelux.Occlusion())
    integrator.occlusion.max_distance = 2
    assert integrator.occlusion.max_distance == 2


def test_shapes_that_cannot_shine_take_no_light():
    scene = montelux.parse(
        """WorldBegin
        Shape "curve" "point3 P" [0 0 0 0 1 0 0 2 0 0 3 0]
        ObjectBegin "ball" Shape "sphere" ObjectEnd
        ObjectInstance "ball"
        ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
        AreaLightSource "diffuse" "rgb L" [1 1 1]
        Shape "sphere"
        """
    )
    curve, in_object, moving = scene.shapes
    assert [s.kind for s in scene.shapes] == ["curves", "sphere", "sphere"]
    for shape, sentence in (curve, "curves do not emit light"), (in_object, "inside object definitions do not shine"):
        with pytest.raises(montelux.Error, match=f"Shape.light: .*{sentence}"):
            shape.light = (1, 1, 1)
        shape.light = None
        assert shape.light is None and len(scene.lights) == 1
    moving.light = (2, 2, 2)
    assert len(scene.lights) == 1


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
