"""Point sets, distributions, warps, weights and chains on arrays."""

from __future__ import annotations

import math

import numpy as np
import pytest

import montelux
from montelux import Distribution

FAMILIES = {
    "uniform": Distribution.uniform(1, 3),
    "normal": Distribution.normal(1, 2),
    "log_normal": Distribution.log_normal(),
    "exponential": Distribution.exponential(2),
    "gamma": Distribution.gamma(2.5),
    "chi_squared": Distribution.chi_squared(3),
    "beta": Distribution.beta(2, 3),
    "cauchy": Distribution.cauchy(),
    "student_t": Distribution.student_t(5),
    "laplace": Distribution.laplace(1),
    "logistic": Distribution.logistic(),
    "pareto": Distribution.pareto(3),
    "power_law": Distribution.power_law(2.0),
    "weibull": Distribution.weibull(2),
    "triangular": Distribution.triangular(0, 0.3, 1),
    "linear": Distribution.linear(2, 4),
    "quadratic": Distribution.quadratic(),
    "cosine": Distribution.cosine(),
    "ggx_angle": Distribution.ggx_angle(0.3),
    "tabulated": Distribution.tabulated([0, 1, 3], [1, 2, 0]),
    "piecewise_constant": Distribution.piecewise_constant([1, 0, 3], 0, 6),
    "mixture": Distribution.mixture([1, 2], [Distribution.normal(-2), Distribution.normal(2)]),
    "truncated": Distribution.normal().truncated(0, 1),
    "scaled": Distribution.exponential(1).scaled(-2, 1),
    "from_density": Distribution.from_density(lambda x: math.exp(-5 * x), 0, math.inf),
}


@pytest.mark.parametrize("name", FAMILIES)
def test_the_four_functions_agree(name):
    d = FAMILIES[name]
    u = np.linspace(0.05, 0.95, 19).reshape(1, 19)
    x = d.sample(u)
    assert x.shape == u.shape and np.all(np.isfinite(x))
    if name != "mixture":  # whose sample() is by composition
        assert np.all(np.diff(x) > 0) and d.quantile(u) == pytest.approx(x)
        assert d.cdf(x) == pytest.approx(u, abs=1e-7)
    p = np.linspace(0.05, 0.95, 19)
    q = d.quantile(p)
    assert d.cdf(q) == pytest.approx(p, abs=1e-7) and d.cdf_complement(q) == pytest.approx(1 - p, abs=1e-7)
    assert d.quantile_complement(1 - p) == pytest.approx(q, rel=1e-5, abs=1e-4)
    # The density is the derivative of the distribution function.
    h = 1e-5 * (1 + np.abs(q))
    slope = (d.cdf(q + h) - d.cdf(q - h)) / (2 * h)
    edges = {"tabulated": [1.0], "piecewise_constant": [2.0, 4.0]}.get(name, [])
    smooth = np.array([min([abs(v - e) for e in edges], default=1) > 1e-3 for v in q])
    assert d.pdf(q)[smooth] == pytest.approx(slope[smooth], rel=1e-3, abs=1e-4)


def test_numbers_give_numbers():
    d = Distribution.normal()
    assert isinstance(d.pdf(0.0), float) and d.pdf(0) == pytest.approx(1 / math.sqrt(2 * math.pi))
    assert isinstance(d.sample(0.5), float)
    assert d.lower == -math.inf and d.upper == math.inf


def test_draws_follow_the_law():
    d = Distribution.exponential(2)
    x = d.draw(20_000, seed=4)
    assert x.shape == (20_000,) and np.array_equal(x, d.draw(20_000, seed=4))
    assert not np.array_equal(x, d.draw(20_000, seed=5))
    # Kolmogorov-Smirnov: P(D > 2.7 / sqrt(n)) < 1e-6.
    distance = np.abs(np.sort(d.cdf(x)) - (np.arange(20_000) + 0.5) / 20_000).max()
    assert distance < 2.7 / math.sqrt(20_000)


def test_densities_of_your_own():
    def singular(x):
        return 1 / math.sqrt(abs(x - 0.3)) if x != 0.3 else math.inf

    d = Distribution.from_density(singular, 0, 1, break_points=[0.3])
    assert d.cdf(0.3) == pytest.approx(math.sqrt(0.3) / (math.sqrt(0.3) + math.sqrt(0.7)), rel=1e-6)
    calls = []

    def failing(x):
        calls.append(x)
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        Distribution.from_density(failing, 0, 1)
    assert len(calls) == 1
    with pytest.raises(montelux.Error, match="expected a real number"):
        Distribution.from_density(lambda x: "one", 0, 1)
    with pytest.raises(montelux.Error, match="negative|not negative|-1"):
        Distribution.from_density(lambda x: -1, 0, 1)


def test_parameters_are_checked():
    with pytest.raises(montelux.Error, match="deviation = -1.*expected"):
        Distribution.normal(0, -1)
    with pytest.raises(montelux.Error, match=r"expected numbers in \[0, 1\]"):
        Distribution.normal().sample([0.5, 1.5])
    with pytest.raises(montelux.Error, match="not all numbers"):
        Distribution.normal().pdf(["a"])


# Point sets.


@pytest.mark.parametrize("kind", ["independent", "halton", "hammersley", "sobol", "golden_ratio", "weyl"])
@pytest.mark.parametrize("randomisation", ["none", "shift", "digit_permutation", "scramble"])
def test_every_point_set(kind, randomisation):
    digits = ("halton", "hammersley")
    allowed = randomisation in ("none", "shift") or kind in digits or (randomisation == "scramble" and kind == "sobol")
    dimensions = 2
    if not allowed or (kind == "independent" and randomisation != "none"):
        try:
            x = montelux.points(kind, 64, dimensions, randomisation)
        except montelux.Error as error:
            assert "randomisation" in str(error) or randomisation in str(error)
            return
    x = montelux.points(kind, 512, dimensions, randomisation, seed=3)
    assert x.shape == (512, 2) and x.min() >= 0 and x.max() < 1
    assert np.array_equal(x, montelux.points(kind, 512, dimensions, randomisation, seed=3))
    if randomisation != "none":
        assert not np.array_equal(x, montelux.points(kind, 512, dimensions, randomisation, seed=4))
    # A random set of 512 points has about 0.05; one of these less.
    assert montelux.star_discrepancy(x) < (0.12 if kind == "independent" else 0.04)


def test_known_points_and_discrepancies():
    assert montelux.points("halton", 4, 2) == pytest.approx(
        np.array([[0, 0], [1 / 2, 1 / 3], [1 / 4, 2 / 3], [3 / 4, 1 / 9]])
    )
    assert montelux.star_discrepancy((np.arange(10) + 0.5) / 10) == pytest.approx(0.05)
    assert montelux.l2_star_discrepancy(np.array([[0.5]])) == pytest.approx(math.sqrt(1 / 12))
    with pytest.raises(montelux.Error, match="in one and two"):
        montelux.star_discrepancy(np.zeros((4, 3)))
    with pytest.raises(montelux.Error, match="outside the unit square"):
        montelux.star_discrepancy([[0.5, 2]])
    with pytest.raises(montelux.Error, match=r"did you mean 'sobol'\?"):
        montelux.points("sobl", 4)


# Warps.

WARPS = {
    "uniform_disk_polar": montelux.warp.uniform_disk_polar,
    "uniform_disk_concentric": montelux.warp.uniform_disk_concentric,
    "uniform_triangle": montelux.warp.uniform_triangle,
    "uniform_triangle_low_distortion": montelux.warp.uniform_triangle_low_distortion,
    "bilinear": montelux.warp.bilinear([1, 2, 3, 4]),
    "uniform_sphere": montelux.warp.uniform_sphere,
    "equal_area_sphere": montelux.warp.equal_area_sphere,
    "uniform_hemisphere": montelux.warp.uniform_hemisphere,
    "cosine_hemisphere": montelux.warp.cosine_hemisphere,
    "uniform_cone": montelux.warp.uniform_cone(0.8),
    "spherical_triangle": montelux.warp.spherical_triangle([1, 0, 0], [0, 1, 0], [0, 0, 1]),
    "spherical_rectangle": montelux.warp.spherical_rectangle([0, 0, 0], [-1, -1, 1], [2, 0, 0], [0, 2, 0]),
    "cosine": montelux.warp.cosine,
    "quadratic": montelux.warp.quadratic,
    "linear": montelux.warp.linear(1, 3),
    "tent": montelux.warp.tent(2),
    "exponential": montelux.warp.exponential(3),
    "truncated": montelux.warp.exponential(3, 0.5),
}


@pytest.mark.parametrize("name", WARPS)
def test_warps_go_there_and_back(name):
    w = WARPS[name]
    u = montelux.points("sobol", 1024, w.uniforms, "scramble", seed=2)
    u = 1e-3 + 0.998 * (u[:, 0] if w.uniforms == 1 else u)
    x = w.sample(u)
    assert x.shape == ((1024,) if w.coordinates == 1 else (1024, w.coordinates))
    assert w.inverse(x) == pytest.approx(u, abs=1e-6)
    p = w.pdf(x)
    assert p.shape == (1024,) and np.all(p > 0)
    if w.coordinates == 3 and "triangle" not in name:
        assert np.linalg.norm(x, axis=1) == pytest.approx(1)


@pytest.mark.parametrize(
    "name, measure",
    [
        ("uniform_disk_polar", math.pi),
        ("uniform_disk_concentric", math.pi),
        ("bilinear", 1),
        ("uniform_sphere", 4 * math.pi),
        ("equal_area_sphere", 4 * math.pi),
        ("uniform_hemisphere", 2 * math.pi),
        ("uniform_cone", 2 * math.pi * 0.2),
        ("spherical_triangle", math.pi / 2),
        ("spherical_rectangle", 4 * math.pi / 6),
        ("linear", 1),
        ("truncated", 0.5),
    ],
)
def test_the_mean_of_the_inverse_density_is_the_measure(name, measure):
    w = WARPS[name]
    u = montelux.points("sobol", 1 << 14, w.uniforms, "scramble", seed=1)
    u = u[:, 0] if w.uniforms == 1 else u
    assert np.mean(1 / w.pdf(w.sample(u))) == pytest.approx(measure, rel=0.02)


@pytest.mark.parametrize("name, lower, upper", [("cosine", 0, 2), ("tent", -3, 3), ("quadratic", -2, 2)])
def test_densities_integrate_to_one(name, lower, upper):
    r = montelux.integrate(WARPS[name].pdf, (lower, upper), "midpoint", evaluations=100_000)
    assert r.value == pytest.approx(1, abs=1e-4)


def test_the_cosine_density_integrates_to_one():
    directions = montelux.Domain.sphere([0, 0, 0])
    r = montelux.integrate(montelux.warp.cosine_hemisphere.pdf, directions, "quasi", evaluations=50_000)
    assert r.value == pytest.approx(1, abs=6 * r.standard_error)


def test_shapes_of_warps_are_checked():
    with pytest.raises(montelux.Error, match=r"uniform_sphere, sample: expected an array of shape \(n, 2\)"):
        montelux.warp.uniform_sphere.sample(np.zeros(5))
    with pytest.raises(montelux.Error, match="spans no solid angle"):
        montelux.warp.spherical_triangle([1, 0, 0], [1, 0, 0], [0, 0, 1])
    assert montelux.warp.uniform_sphere.sample(np.zeros((2, 3, 2))).shape == (2, 3, 3)
    assert repr(montelux.warp.tent(1)) == "<montelux.warp.tent>" and montelux.warp.tent(1).uniforms == 1


# Weights and chains.


def test_weights_of_multiple_importance_sampling():
    q = np.array([[1.0, 3.0], [0.0, 2.0]])
    assert montelux.mis_weights(q) == pytest.approx(np.array([[0.25, 0.75], [0, 1]]))
    with pytest.raises(montelux.Error, match="negative or NaN"):
        montelux.mis_weights([[-1, 2]])
    assert montelux.mis_weights(q, "power")[0] == pytest.approx([0.1, 0.9])
    assert montelux.mis_weights(q, "power", 1)[0] == pytest.approx([0.25, 0.75])
    assert montelux.mis_weights(q, "maximum")[0] == pytest.approx([0, 1])
    assert montelux.mis_weights(q, "cutoff", 0.5)[0] == pytest.approx([0, 1])
    with pytest.raises(montelux.Error, match="did you mean 'power'"):
        montelux.mis_weights(q, "powr")


def test_chains_follow_a_density():
    chains = montelux.metropolis(lambda x: -0.5 * float(x @ x), [0.0, 0.0], samples=2000, burn_in=300, thin=2, seed=1)
    assert chains.states.shape == (4, 1000, 2) and chains.mean.shape == (2,)
    assert np.all(np.abs(chains.mean) < 6 * chains.standard_error) and np.all(chains.effective_sample_size > 100)
    assert 0.1 < chains.acceptance_rate < 0.6
    product = montelux.metropolis(
        lambda x: -0.5 * float(x @ x), [0.0, 0.0], lambda x: x[0] ** 2, samples=2000, burn_in=300, seed=1
    )
    assert product.mean.shape == (1,) and abs(product.mean[0] - 1) < 6 * product.standard_error[0]


def test_mistakes_with_chains():
    with pytest.raises(ZeroDivisionError):
        montelux.metropolis(lambda x: 1 / 0, [0.0], samples=100)
    with pytest.raises(montelux.Error, match="where chain 0 starts"):
        montelux.metropolis(lambda x: -math.inf, [0.0], samples=100)


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"samples": 1e3}, "samples=1000.0 was given; expected a whole number, at least 8"),
        ({"samples": 0}, "samples=0 was given"),
        ({"chains": 0}, "expected a whole number, at least 1"),
        ({"seed": -1}, "expected a whole number, at least 0"),
        ({"step": -1}, "expected a number that is not negative"),
        ({"starts": "abc"}, "'abc' was given; expected numbers"),
        ({"starts": [[0.0], [1.0]]}, "2 starts were given for 4 chains; expected one, or one for each"),
    ],
)
def test_wrong_arguments_of_metropolis_are_answered(arguments, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.metropolis(lambda x: -x @ x, **{"starts": [0.0], **arguments})


@pytest.mark.parametrize(
    "thing, name, nearest",
    [
        (montelux.Distribution.normal(), "quantil", "quantile"),
        (montelux.Domain.simplex(2), "dimension", "dimensions"),
        (montelux.warp.cosine, "sampl", "sample"),
        (montelux.Spectrum(1), "__len__", None),
        (montelux.Scene().lights, "apend", "append"),
        (montelux.Scene(), "rendr", "render"),
    ],
)
def test_misspelt_names_are_answered_with_the_nearest(thing, name, nearest):
    sentence = rf"'{name}' \(did you mean '{nearest}'\?\)" if nearest else f"^{name}$"
    with pytest.raises(AttributeError, match=sentence):
        getattr(thing, name)


def test_chains_print():
    chains = montelux.metropolis(lambda x: -x @ x, [0.0, 0.0], samples=500, seed=1)
    lines = repr(chains).splitlines()
    assert "R-hat" in lines[1] and "4 chains of 500 states" in lines[2] and len(repr(chains)) < 2000
    with pytest.raises(AttributeError, match=r"no attribute of Chains 'means' \(did you mean 'mean'\?\)"):
        chains.means


def test_distributions_describe_themselves():
    assert repr(montelux.Distribution.exponential(1)) == "Distribution(lower=0, upper=inf, median=0.693147)"
