"""Directions to environment maps on arrays.

Statistical tests have fixed seeds and reject correct code with a probability of 1e-7 or less each.
"""

from __future__ import annotations

import numpy as np
import pytest

import montelux
from montelux import EnvironmentSampler

WAYS = ["tabulated", "median-cut", "structured"]


def a_map(height: int = 16, width: int = 32) -> np.ndarray:
    """With a sun of one pixel, and otherwise bright and dark parts."""
    y, x = np.mgrid[:height, :width]
    grey = 0.2 + (x * 13 + y * 7) % 23 / 4.0
    grey[height // 3, width // 3] = 4000
    return grey[..., None] * np.array([0.5, 1.0, 1.5])


def middles(sampler: EnvironmentSampler) -> np.ndarray:
    height, width = sampler.solid_angles.shape
    return sampler.direction(np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1))


@pytest.mark.parametrize("shape", [(48, 96), (64, 64)])
@pytest.mark.parametrize("way", WAYS)
def test_directions_and_densities_give_the_light(way, shape):
    image = a_map(*shape)
    sampler = EnvironmentSampler(image, sampling=way)
    assert sampler.sampling == way and not sampler.compensated
    assert sampler.layout == ("equal-area" if shape[0] == shape[1] else "equirectangular")
    u = montelux.points("independent", 20_000, 2, seed=1)
    directions, pdf = sampler.sample(u)
    assert directions.shape == (20_000, 3) and pdf.shape == (20_000,)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1, abs=1e-6)
    # At the edges of pixels rounding may find the neighbour.
    assert (np.abs(sampler.pdf(directions) / pdf - 1) < 1e-5).mean() > 0.999
    light = (image * sampler.solid_angles[..., None]).sum(axis=(0, 1))
    ratio = sampler.radiance(directions) / pdf[:, None]
    error = ratio.std(axis=0) / np.sqrt(len(ratio)) + 1e-4 * light
    assert (np.abs(ratio.mean(axis=0) - light) < 5.5 * error).all()
    assert light.mean() == pytest.approx(4 * np.pi * sampler.mean_radiance, rel=1e-6)
    if way != "tabulated":
        shape_of = (image * sampler.solid_angles[..., None]).mean(axis=-1)
        assert sampler.sun_share == pytest.approx(shape_of.max() / shape_of.sum(), rel=1e-5)
    else:
        assert sampler.sun_share == 0
        assert sampler.pdf(middles(sampler)) == pytest.approx(image.mean(axis=-1) / light.mean(), rel=1e-5)


def test_places_and_directions_of_a_latitude_longitude_map():
    sampler = EnvironmentSampler(a_map(8, 16))
    assert sampler.direction([[0, 4], [4, 4], [0, 0], [0, 8]]) == pytest.approx(
        np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]]), abs=1e-6
    )
    assert sampler.locate([0, 3.0, 0]) == pytest.approx([4, 4])
    assert sampler.radiance([0.0, -1, -0.1]) == pytest.approx(a_map(8, 16)[4, 12])
    assert sampler.solid_angles.sum() == pytest.approx(4 * np.pi)
    u = montelux.points("sobol", 12, 2).reshape(3, 4, 2)
    directions, pdf = sampler.sample(u)
    assert directions.shape == (3, 4, 3) and pdf.shape == (3, 4) == sampler.pdf(directions).shape
    assert sampler.direction(sampler.locate(directions)) == pytest.approx(directions, abs=1e-5)


def test_compensation_leaves_out_what_is_dim():
    image = a_map()
    sampler = EnvironmentSampler(image, compensation=True)
    assert sampler.compensated and sampler.sampling == "tabulated"
    rest = np.maximum(image.mean(axis=-1) - sampler.mean_radiance, 0)
    exact = rest / (rest * sampler.solid_angles).sum()
    assert sampler.pdf(middles(sampler)) == pytest.approx(exact, rel=1e-4, abs=1e-9)
    assert not EnvironmentSampler(np.ones((4, 4, 3)), compensation=True).compensated


def test_regions_of_equal_light():
    image = np.ones((16, 32, 3))
    image[4:8, 8:16] = 20
    sampler = EnvironmentSampler(image, sampling="median-cut", parts=16)
    assert sampler.regions.shape == (16, 4) and sampler.centres.shape == (16, 2)
    x0, x1, y0, y1 = sampler.regions.T
    x, y = sampler.centres.T
    assert ((x0 < x) & (x < x1) & (y0 < y) & (y < y1)).all()
    labels = sampler.labels
    assert labels.shape == (16, 32) and labels.dtype == np.int64 and set(np.unique(labels)) <= set(range(16))
    for row in range(16):
        for column in range(32):
            k = labels[row, column]
            assert x0[k] <= column + 0.5 <= x1[k] and y0[k] <= row + 0.5 <= y1[k]
    # Each region as often as any other.
    place = sampler.locate(sampler.sample(montelux.points("independent", 16_000, 2, seed=3))[0])
    inside = (place[:, :1] >= x0) & (place[:, :1] <= x1) & (place[:, 1:] >= y0) & (place[:, 1:] <= y1)
    assert np.abs(inside.sum(axis=0) - 1000).max() < 5.5 * np.sqrt(1000) + 5


def test_strata_about_their_centres():
    image = np.ones((16, 32, 3))
    image[4:8, 8:16] = 20
    sampler = EnvironmentSampler(image, sampling="structured", parts=40)
    labels, levels = sampler.labels, sampler.levels
    assert labels.min() == 0 and labels.max() == len(levels) - 1 and levels.dtype == np.int64
    column, row = np.floor(sampler.centres).astype(int).T
    assert list(labels[row, column]) == list(range(len(levels)))
    lamp = np.zeros((16, 32), dtype=bool)
    lamp[4:8, 8:16] = True
    assert np.array_equal(levels[labels] > 0, lamp)
    black = image.copy()
    black[12:] = 0
    assert (EnvironmentSampler(black, sampling="structured").labels[12:] == -1).all()


def test_odd_maps():
    for image in (np.full((1, 1, 3), 2.0), np.zeros((2, 4, 3)), np.ones((3, 3)), np.ones((1, 2, 3), dtype=np.float32)):
        for way in (*WAYS, "auto"):
            sampler = EnvironmentSampler(image, sampling=way)
            directions, pdf = sampler.sample([[0, 0], [1, 1], [0.5, 0.3]])
            assert np.isfinite(directions).all() and (pdf > 0).all()
    wide = EnvironmentSampler(np.ones((4, 5, 3)), layout="equirectangular")
    assert wide.solid_angles.sum() == pytest.approx(4 * np.pi)
    assert "tabulated" in repr(wide) and "5 x 4" in repr(wide)


def test_mistakes_are_sentences():
    image = a_map()
    for given, sentence in (
        (dict(image=image[:, :20]), r"20 x 16 pixels; expected a square map"),
        (dict(image=-image), "negative or not finite"),
        (dict(image=image * np.nan), "negative or not finite"),
        (dict(image=image[..., :2]), "expected a file, or an array"),
        (dict(image=image, sampling="median_cut"), r"'median_cut' \(did you mean 'median-cut'\?\)"),
        (dict(image=image, layout="equal area"), r"did you mean 'equal-area'\?"),
        (dict(image=image, layout="equal-area"), "expected a square one"),
        (dict(image=image, sampling="median-cut", parts=100), "100 regions were asked for; expected a power of two"),
        (dict(image=image, sampling="structured", parts=-1), "-1 strata were asked for"),
        (dict(image=image, parts=4), "a tabulated density has none"),
    ):
        with pytest.raises(montelux.Error, match=sentence):
            EnvironmentSampler(**given)
    sampler = EnvironmentSampler(image)
    for call, argument, sentence in (
        (sampler.sample, [0.5], r"shape \(n, 2\)"),
        (sampler.sample, [[0.5, 1.5]], r"expected numbers in \[0, 1\]"),
        (sampler.pdf, [[0, 1]], r"shape \(n, 3\)"),
        (sampler.pdf, [[0, 0, 0]], "neither zero nor infinite"),
        (sampler.radiance, [[0, np.nan, 0]], "neither zero nor infinite"),
        (sampler.locate, 3, r"shape \(n, 3\)"),
        (sampler.direction, [[0, 17]], r"\(0.0+, 17.0+\) was given; expected places within \(32, 16\)"),
    ):
        with pytest.raises(montelux.Error, match=sentence):
            call(argument)
    for name in ("labels", "centres", "regions", "levels"):
        with pytest.raises(montelux.Error, match="the sampling 'tabulated' has none; expected"):
            getattr(sampler, name)
    with pytest.raises(montelux.Error, match="expected 'structured'"):
        EnvironmentSampler(image, sampling="median-cut").levels
    with pytest.raises(montelux.UnknownAttribute, match=r"did you mean 'labels'\?"):
        sampler.label
