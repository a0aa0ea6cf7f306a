"""Discrete variables, tabulated densities, microfacet normals and pixel filters on arrays.

Statistical tests have fixed seeds and reject correct code with a probability of 1e-6 or less each.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import montelux
from montelux import warp

WEIGHTS = [3.0, 0.0, 1.0, 4.0, 0.0, 2.0]
P = np.array(WEIGHTS) / 10


# Discrete variables.


@pytest.mark.parametrize("way", ["bisection", "walking"])
def test_indices_are_the_steps_of_the_sums(way):
    d = montelux.Discrete(WEIGHTS)
    assert d.probabilities == pytest.approx(P) and d.cdf == pytest.approx([0.3, 0.3, 0.4, 0.8, 0.8, 1])
    assert d.cdf[-1] == 1 and len(d) == 6 and d.weight_sum == 10
    u = montelux.points("independent", 2000, 2, seed=5)
    k = (d.sample if way == "bisection" else d.sample_by_walking)(u)
    assert k.shape == u.shape and k.dtype == np.int64
    assert np.array_equal(k, np.searchsorted(d.cdf, u, side="right"))
    one = d.sample(0.35) if way == "bisection" else d.sample_by_walking(0.35)
    assert isinstance(one, int) and one == 2


def test_an_alias_table_draws_the_same_law():
    t = montelux.AliasTable(WEIGHTS)
    assert t.probabilities == pytest.approx(P, abs=1e-7) and len(t) == 6 and t.weight_sum == 10
    n = 1 << 16
    count = np.bincount(t.sample((np.arange(n) + 0.5) / n), minlength=6)
    # Each bin is cut once: a midpoint falls to the wrong side of a cut at most.
    assert np.abs(count - n * P).max() <= 6 and count[1] == count[4] == 0
    assert isinstance(t.sample(0.35), int) and t.sample([0.35, 0.9]).dtype == np.int64


def test_mistakes_with_weights():
    for kind in (montelux.Discrete, montelux.AliasTable):
        with pytest.raises(montelux.Error, match="weight 1 of 2 is -1"):
            kind([1, -1])
        with pytest.raises(montelux.Error, match="at least one weight"):
            kind([])
        with pytest.raises(montelux.Error, match=r"shape \(n,\)"):
            kind([[1, 2]])
        for wrong in (1.5, -0.1, math.nan):
            with pytest.raises(montelux.Error, match=r"expected numbers in \[0, 1\]"):
                kind([1, 2]).sample([0.5, wrong])
    with pytest.raises(montelux.Error, match=r"expected numbers in \[0, 1\]"):
        montelux.Discrete([1, 2]).sample_by_walking(2)
    assert list(montelux.Discrete([0, 0]).probabilities) == [0.5, 0.5]


# A table of two variables.


def test_a_tabulated_density():
    values = np.array([[1.0, 2.0, 0.0], [3.0, 0.0, 6.0]])  # rows along y
    w = warp.tabulated(values, lower=(-1, 0), upper=(2, 4))
    u = montelux.points("sobol", 4096, 2)
    x = w.sample(u)
    column, row = np.floor(x[:, 0] + 1).astype(int), np.floor(x[:, 1] / 2).astype(int)
    assert w.pdf(x) == pytest.approx(values[row, column] / 12 / 2, rel=1e-6)
    share = np.bincount(3 * row + column, minlength=6) / 4096
    assert share == pytest.approx(values.ravel() / 12, abs=2e-3)
    assert w.inverse(x) == pytest.approx(u, abs=1e-8)
    assert np.isnan(w.inverse([[1.5, 1.0], [9, 9]])).all() and list(w.pdf([[1.5, 1.0], [9, 9]])) == [0, 0]
    for wrong in ([1.0, 2.0], np.zeros((0, 3)), [[-1.0, 2.0]]):
        with pytest.raises(montelux.Error, match="expected"):
            warp.tabulated(wrong)
    with pytest.raises(montelux.Error):
        warp.tabulated(values, lower=(1, 0), upper=(1, 1))


# Microfacet normals.

NORMALS = {
    "normals": warp.ggx_normals(0.7),
    "stretched": warp.ggx_normals([0.3, 0.8]),
    "visible": warp.ggx_visible_normals(0.5, [0, 0, 3.0]),
    "visible, stretched": warp.ggx_visible_normals((0.4, 0.9), [0.9, 0.2, 0.25]),
}


@pytest.mark.parametrize("name", NORMALS)
def test_microfacet_normals_follow_their_density(name):
    w = NORMALS[name]
    u = 1e-3 + 0.998 * montelux.points("sobol", 4096, 2, "scramble", seed=2)
    m = w.sample(u)
    assert np.linalg.norm(m, axis=1) == pytest.approx(1) and m[:, 2].min() > 0
    assert w.inverse(m) == pytest.approx(u, abs=2e-5)
    assert np.all(w.pdf(-m) == 0)

    def moments(v):
        return np.stack([np.ones(len(v)), v[:, 2], v[:, 0] ** 2, v[:, 0], v[:, 1]], axis=1)

    sphere = montelux.Domain.sphere([0, 0, 0])
    quasi = montelux.Quasi(replicates=16)
    r = montelux.integrate(lambda v: moments(v) * w.pdf(v)[:, None], sphere, quasi, evaluations=1 << 17, seed=1)
    value, error = np.asarray(r.value), np.asarray(r.standard_error)
    assert value[0] == pytest.approx(1, abs=8 * error[0] + 1e-6)
    drawn = moments(w.sample(montelux.points("independent", 1 << 16, 2, seed=3)))
    both = np.hypot(drawn.std(axis=0) / 256, error)
    # Student's law with 15 degrees of freedom: P below 1e-6.
    assert np.all(np.abs(drawn.mean(axis=0) - value)[1:] < 7.5 * both[1:])


def test_visible_normals_show_the_projected_area():
    """Seen from wo, facets of density D cover cos(theta_o) / G1: the density is G1 D (wo.m) / cos(theta_o)."""
    alpha, wo = 0.6, np.array([0.6, 0.0, 0.8])
    w, all_normals = warp.ggx_visible_normals(alpha, wo), warp.ggx_normals(alpha)
    m = w.sample(montelux.points("sobol", 256, 2, "scramble", seed=1))
    g1 = 2 / (1 + math.sqrt(1 + alpha**2 * (0.6 / 0.8) ** 2))  # Walter et al. 2007, equation 34
    d = all_normals.pdf(m) / m[:, 2]
    assert w.pdf(m) == pytest.approx(g1 * d * (m @ wo) / 0.8, rel=1e-4)
    assert d == pytest.approx(alpha**2 / (math.pi * ((alpha**2 - 1) * m[:, 2] ** 2 + 1) ** 2), rel=1e-4)


def test_mistakes_with_normals():
    for alpha in (0, -1, [0.5, math.nan]):
        with pytest.raises(montelux.Error, match="expected numbers from 0.001"):
            warp.ggx_normals(alpha)
    with pytest.raises(montelux.Error, match="above the surface"):
        warp.ggx_visible_normals(0.5, [1, 0, 0])
    with pytest.raises(montelux.Error, match=r"warp tent, sample: the uniform number 2.0.*\[0, 1\]"):
        warp.tent(1).sample([0.5, 2])


# Pixel filters.


@pytest.mark.parametrize("name", ["box", "triangle", "gaussian", "mitchell", "lanczos"])
def test_filters_and_their_samples(name):
    f = montelux.pixel_filter(name, (1.5, 2))
    assert f.radius == (1.5, 2)
    side = (np.arange(300) + 0.5) / 300
    grid = np.stack(np.meshgrid(1.5 * (2 * side - 1), 2 * (2 * side - 1)), axis=-1)
    value = f.value(grid)
    assert value.shape == (300, 300)
    assert list(f.value([[1.6, 0], [0, 2.1]])) == [0, 0]
    mean = value.mean()
    offsets, weights = f.sample(montelux.points("sobol", 1 << 14, 2, "scramble", seed=1))
    assert offsets.shape == (1 << 14, 2) and weights.shape == (1 << 14,)
    assert np.all(np.abs(offsets) <= [1.5, 2])
    # Weighted samples have the filter's own moments.
    assert weights.mean() == pytest.approx(1, abs=2e-3)
    for power in (1, 2):
        moment = (value[..., None] * np.abs(grid) ** power).mean(axis=(0, 1)) / mean
        assert (weights[:, None] * np.abs(offsets) ** power).mean(axis=0) == pytest.approx(moment, abs=4e-3)
    clear = np.abs(f.value(offsets)) > 1e-3  # away from where the filter crosses zero
    assert np.array_equal(weights[clear] < 0, f.value(offsets)[clear] < 0)
    assert (weights.min() < 0) == (name in ("mitchell", "lanczos"))


def test_filters_by_their_formulas():
    x = np.linspace(-2, 2, 41)
    points = np.stack([x, np.zeros(41)], axis=1)

    def profile(f):
        return f.value(points) / f.value([[0, 0]])

    gaussian = np.maximum(np.exp(-2 * x**2) - np.exp(-2 * 1.5**2), 0)
    assert profile(montelux.pixel_filter("gaussian", 1.5, sigma=0.5)) == pytest.approx(
        gaussian / gaussian[20], abs=1e-6
    )
    sinc = np.sinc(x) * np.sinc(x / 3)
    assert profile(montelux.pixel_filter("lanczos", 4, tau=3)) == pytest.approx(sinc, abs=1e-6)
    assert profile(montelux.pixel_filter("triangle", 2)) == pytest.approx(1 - np.abs(x) / 2, abs=1e-6)
    made = montelux.pixel_filter("mitchell")
    assert isinstance(made, montelux.MitchellFilter) and made.radius == (2, 2)


def test_mistakes_with_filters():
    with pytest.raises(montelux.Error, match=r"no filter 'gausian' \(did you mean 'gaussian'\?\)"):
        montelux.pixel_filter("gausian")
    with pytest.raises(montelux.Error, match=r"no attribute 'sgma' \(did you mean 'sigma'\?\)"):
        montelux.pixel_filter("gaussian", sgma=1)
    with pytest.raises(montelux.Error, match="two numbers above zero"):
        montelux.pixel_filter("box", 0)
    with pytest.raises(montelux.Error, match=r"shape \(n, 2\)"):
        montelux.pixel_filter("box").value([1.0, 2.0, 3.0])
    with pytest.raises(montelux.Error, match=r"expected numbers in \[0, 1\]"):
        montelux.pixel_filter("box").sample([[0.5, 1.5]])
