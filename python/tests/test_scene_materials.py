"""Materials of scenes: measured ones, bumps and normal maps, light through leaves."""

from __future__ import annotations

import struct

import numpy as np
import pytest

import montelux


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
        if material in (montelux.Interface, montelux.Mix, montelux.Sided):  # have no surface to tilt
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


def test_sides_have_their_own_materials():
    scene = montelux.Scene()
    scene.camera = montelux.PerspectiveCamera(look_at=((0, 0, 4), (0, 0, 0), (0, 1, 0)), fov=1)
    scene.film.resolution = (4, 4)
    scene.lights.append(montelux.UniformInfiniteLight())
    shape = scene.add_disk(3, montelux.Sided(front=None))
    assert shape.material.front is None and shape.material.back is None
    assert scene.render(spp=1).mean.max() == 0
    shape.material.front = montelux.Diffuse(reflectance=0.5)
    lit = scene.render(spp=256)
    assert np.all(np.abs(lit.mean - 0.5) < 6 * lit.standard_error + 1e-3) and lit.standard_error.max() < 0.02
    assert repr(shape.material.front) == repr(scene.materials[1])
    shape.material.front, shape.material.back = None, scene.materials[1]
    assert scene.render(spp=1).mean.max() == 0
    with pytest.raises(montelux.Error, match="front: an object of type 'int' was given; expected a material"):
        shape.material.front = 3
    shape.material.back = shape.material
    with pytest.raises(montelux.Error, match=r"\(Sided\) depends on itself"):
        scene.render(spp=1).mean


def test_distributions_have_names():
    metal = montelux.Conductor(roughness=0.2)
    assert metal.distribution == "ggx"
    metal.distribution = "beckmann"
    assert metal.distribution == "beckmann"
    plastic = montelux.Plastic(alpha=0.3, distribution="ggx-separable", nonlinear=True)
    assert plastic.distribution == "ggx-separable" and plastic.nonlinear and plastic.eta == 1.5
    with pytest.raises(montelux.Error, match="did you mean 'beckmann'"):
        metal.distribution = "bekmann"
    with pytest.raises(montelux.Error, match="expected 'ggx', 'ggx-separable' or 'beckmann'"):
        metal.distribution = 3


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
