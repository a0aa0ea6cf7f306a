"""Tables and prefiltered maps: values of the library's own baking, by their names."""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from montelux import bake


def a_map() -> np.ndarray:
    y, x = np.mgrid[:8, :16]
    return (1 + (x * 5 + y * 3) % 7)[..., None] * np.array([1.0, 0.5, 0.25])


def test_the_table():
    made = bake.brdf_table(8)
    assert made.values.shape == made.errors.shape == (8, 8, 3)
    assert made.n_dot_v[0] == made.roughness[0] == 0.0625
    assert (made.values[..., 2] == 0).all() and made.errors.max() < 1e-3
    # A smooth mirror seen along its normal reflects what it should; nothing reflects more than all.
    assert made.values[0, -1, 0] == pytest.approx(1, abs=1e-3) and made.values[..., :2].sum(axis=-1).max() < 1 + 1e-6
    assert (bake.brdf_table(4, blue="sheen").values[..., 2] > 0).all()
    blue = bake.brdf_table(4, blue="average-albedo").values[..., 2]
    assert (blue == blue[:, :1]).all() and (np.diff(blue[:, 0]) < 0).all()
    with pytest.raises(montelux.Error, match=r"'shen' \(did you mean 'sheen'\?\)"):
        bake.brdf_table(4, blue="shen")
    with pytest.raises(montelux.Error, match="the size is 0"):
        bake.brdf_table(0)


def test_a_chain_of_cube_maps():
    image = a_map()
    chain = bake.environment(image, 8, levels=3, target_error=0.05)
    assert [level.size for level in chain] == [8, 4, 2] and [level.roughness for level in chain] == [0, 0.5, 1]
    mean = montelux.EnvironmentSampler(image).mean_radiance
    for level in chain:
        assert level.faces.shape == level.errors.shape == (6, level.size, level.size, 3)
        assert level.missed == 0 and level.samples > 0 and level.mean_error <= level.largest_error <= 0.05
        assert level.faces.mean() == pytest.approx(mean, rel=0.1)
    assert chain[2].faces[..., 0].std() < 0.3 * chain[0].faces[..., 0].std()
    assert [level.size for level in bake.environment(image, 32, samples=8)] == [32, 16]
    listed = bake.environment(image, 8, roughness=np.array([0.5, 0.7]), target_error=0.05, sampling="lobe")
    assert [level.roughness for level in listed] == [0.5, 0.7]
    steps = [level.roughness for level in bake.environment(image, 8, 3, "filament", target_error=0.1)]
    assert steps == pytest.approx([0, 1 - np.sqrt(0.5), 1])


def test_texels_see_where_they_stand():
    """Of a map that is bright about one direction the texel that looks there is the brightest."""
    for options in ({}, {"up": "z"}, {"mirror": True}, {"up": "z", "turn": 70.0}):
        image = np.full((16, 32, 3), 0.1)
        image[5, 11] = 50
        toward = montelux.EnvironmentSampler(image).direction([11.5, 5.5])
        level = bake.environment(image, 16, levels=1, target_error=0.1, **options)[0]
        directions = bake.to_map(bake.face_directions(16), **options)
        assert np.linalg.norm(directions, axis=-1) == pytest.approx(1)
        brightest = directions.reshape(-1, 3)[level.faces.mean(axis=-1).argmax()]
        assert brightest @ toward > 0.98, options


def test_a_report():
    found = bake.report(
        np.full((4, 8, 3), 0.7), roughness=[0.3, 0.8], n_dot_v=[0.5], f0=[0.04, 1], orientations=4, sphere_size=7
    )
    assert found.roughness == (0.3, 0.8) and len(found.rows) == 4
    # An even light: both are the albedo.
    for row in found.rows:
        # Errors are measured by the map where reflections are darker.
        assert row.bias == pytest.approx(0, abs=0.03 / row.f0**0.7) and row.n_dot_v == 0.5
    assert found.full.shape == found.split_errors.shape == found.difference.shape == (2, 7, 7, 3)
    assert (found.full[:, 0, 0] == 0).all() and found.full[0, 3, 3] == pytest.approx(0.7, abs=0.06)
    apart = np.abs(found.split - found.full)
    assert found.difference == pytest.approx(apart, abs=1e-6)
    assert bake.report(a_map(), roughness=[0.5], n_dot_v=[1], f0=[1], orientations=2).full.shape == (1, 0, 0, 3)


def test_mistakes_are_sentences():
    image = a_map()
    for call, sentence in (
        (lambda: bake.environment(image[:, :9], 8), "9 x 8 pixels; expected a square map"),
        (lambda: bake.environment(image, 8, roughness="lineal"), r"'lineal' \(did you mean 'linear'\?\)"),
        (lambda: bake.environment(image, 8, roughness=[0, 2]), "level 1 has the roughness"),
        (lambda: bake.environment(image, 8, levels=3, roughness=[0, 1]), "do not go together"),
        (lambda: bake.environment(image, 8, levels=9), "expected 1 to 4, as many as faces of 8 texels have"),
        (lambda: bake.environment(image, 8, levels=2**31 - 1), "expected 1 to 4"),
        (lambda: bake.environment(image, 8, levels=0), "expected 1 to 4"),
        (lambda: bake.environment(image, 0, levels=1), "faces of 0 texels"),
        (lambda: bake.environment(image, 8, samples=4, target_error=0.1), "does not go with"),
        (lambda: bake.environment(image, 8, source_mips=True), "needs sampling='lobe'"),
        (lambda: bake.environment(image, 8, sampling="cell"), r"did you mean 'cells'\?"),
        (lambda: bake.environment(image, 8, up="x"), "expected one of y, z"),
        (lambda: bake.environment(image, 8, target_error=0), "not above 0"),
        (lambda: bake.environment(-image, 8), "negative or not finite"),
        (lambda: bake.report(image, roughness=[0.01]), "roughness is expected in 0.03 to 1"),
        (lambda: bake.report(image, orientations=1), "at least 2 orientations"),
        (lambda: bake.face_directions(0), "faces of 0 texels"),
        (lambda: bake.to_map([1, 2]), r"shape \(n, 3\)"),
        (lambda: bake.to_map([1, 2, 3], turn=float("nan")), "number of degrees"),
    ):
        with pytest.raises(montelux.Error, match=sentence):
            call()
