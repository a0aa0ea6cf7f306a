"""Trained densities: samples, expectations and histograms; files and pickles; other integrands."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest

import montelux
from montelux import Domain, TrainedDensity

WIDTH = 0.05
DOMAIN = [(0, 1), (0, 2)]


def peak(x):
    """A Gaussian along the diagonal x = y of the first square."""
    return np.exp(-0.5 * ((x[:, 0] - x[:, 1]) / WIDTH) ** 2) * x[:, 0]


def log_peak(x):
    with np.errstate(divide="ignore"):
        return np.log(peak(x)) - 4000


TRUTH = WIDTH * math.sqrt(2 * math.pi) / 2  # but for what the faces cut: about 1e-3 of it


@pytest.fixture(scope="module")
def result():
    return montelux.integrate(peak, DOMAIN, "adaptive", evaluations=60_000)


@pytest.fixture(scope="module")
def density(result):
    return result.density


def test_results_hold_the_density(result):
    assert isinstance(result.density, TrainedDensity)
    assert (result.density.kind, result.density.dimensions) == ("mixture", 2)
    assert "mixture on [0, 1] x [0, 2]" in repr(result.density)
    assert montelux.integrate(peak, DOMAIN, "vegas", evaluations=20_000).density.kind == "map"
    assert montelux.integrate(peak, DOMAIN, "quasi", evaluations=20_000).density is None
    assert "density" not in result.to_dict()


def test_the_pdf_integrates_to_one_and_follows_the_peak(density):
    total = montelux.integrate(density.pdf, DOMAIN, "adaptive", evaluations=50_000)
    s = density.samples(peak, 20_000)  # some draws fall outside of the ranges
    inside = len(s) / s.draws
    assert 0.8 < inside < 1
    assert abs(total.value - inside) < 5 * (total.standard_error + math.sqrt(inside * (1 - inside) / s.draws))
    on, off = density.pdf([[0.8, 0.8], [0.2, 1.9]])
    assert on > 50 * off > 0
    assert density.pdf([[2, 0]]) == 0
    with pytest.raises(montelux.Error, match="TrainedDensity.pdf"):
        density.pdf([[1, 2, 3]])


def test_weighted_samples_add_up_to_the_integral(density):
    s = density.samples(peak, 20_000, seed=1)
    assert s.points.shape == (20_000, 2) and s.weights.shape == s.values.shape == (20_000,) and len(s) == 20_000
    assert s.weights.sum() == pytest.approx(s.integral, rel=1e-12)
    assert abs(s.integral - TRUTH) < 5 * s.standard_error + 2e-3 * TRUTH
    assert np.array_equal(s.values, peak(s.points))
    mean = np.average(s.points[:, 0], weights=s.weights)
    assert mean == pytest.approx(2 / 3, abs=0.01)
    assert 8000 < s.effective_sample_size <= 20_000 and "20000 samples" in repr(s)


def test_unweighted_samples_follow_the_target(density):
    s = density.unweighted(peak, 20_000, seed=1)
    assert (s.weights >= 1).all() and np.count_nonzero(s.weights > 1) == s.overweight < 2000
    assert s.overweight_share < 0.01 and s.largest_weight < 3 and not s.warnings
    assert 0.3 < s.efficiency <= 1 and 0 < s.efficiency_error < 0.01
    # x has the density 2 x.
    counts, _ = np.histogram(s.points[:, 0], np.sqrt(np.linspace(0.04, 0.9025, 11)))
    assert ((counts - counts.mean()) ** 2 / counts.mean()).sum() < 40


def test_logarithms_give_the_same(density):
    a, b = density.unweighted(peak, 1000), density.unweighted(log_peak, 1000, log=True)
    assert np.array_equal(a.points, b.points)
    assert math.log(b.integral) + b.log_reference == pytest.approx(math.log(a.integral) - 4000)


def test_posteriors_of_integrate_log():
    r = montelux.integrate_log(log_peak, DOMAIN, "adaptive", evaluations=60_000)
    s = r.density.samples(log_peak, 5000, log=True)
    assert abs(math.log(s.integral) + s.log_reference - r.log_value) < 5 * (r.log_error + s.standard_error / s.integral)
    assert np.average(s.points[:, 1], weights=s.weights) == pytest.approx(2 / 3, abs=0.02)


def test_expectations_and_histograms_have_covariances(density):
    e = density.expectations(peak, lambda x: np.stack([x[:, 0], x[:, 0] ** 2], axis=1), 50_000)
    assert e.mean == pytest.approx([2 / 3, 1 / 2], abs=0.01)
    assert e.mean_covariance.shape == (2, 2) and e.mean_covariance[0, 1] > 0
    scalar = density.expectations(peak, lambda x: x[:, 0], 50_000)
    assert scalar.mean[0] == e.mean[0] and scalar.value[0] == pytest.approx(e.mean[0] * e.integral)
    h = density.histogram(peak, lambda x: x[:, 0], [0, 0.5, 1], 50_000)
    assert h.mean == pytest.approx([0.25, 0.75], abs=0.01) and h.value.sum() == pytest.approx(h.integral)
    first, second = montelux.Uncertain.correlated(h.mean, h.mean_covariance)
    assert (first + second).standard_error < 1e-6 < first.standard_error


def test_other_integrands_use_it(density):
    other = montelux.integrate(lambda x: peak(x) * x[:, 1], DOMAIN, montelux.Trained(density), relative_error=2e-3)
    assert other.converged and other.method == "trained"
    named = montelux.integrate(peak, DOMAIN, "trained", density=density, evaluations=20_000)
    assert abs(named.value - TRUTH) < 5 * named.standard_error + 2e-3 * TRUTH
    with pytest.raises(montelux.Error, match="expected the setting 'density'"):
        montelux.integrate(peak, DOMAIN, "trained", evaluations=1000)
    with pytest.raises(montelux.Error, match="the density has 2 dimensions"):
        montelux.integrate(lambda x: x, (0, 1), montelux.Trained(density), evaluations=1000)
    with pytest.raises(montelux.Error, match="expected a TrainedDensity"):
        montelux.Trained(3)


def test_files_bring_it_back(density, tmp_path):
    path = str(tmp_path / "trained.mx")
    density.notes = {"model": "peak"}
    density.save(path)
    loaded = TrainedDensity.load(path)
    assert loaded.notes == {"model": "peak"}
    assert np.array_equal(loaded.samples(peak, 50).weights, density.samples(peak, 50).weights)
    content = bytearray((tmp_path / "trained.mx").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "damaged.mx").write_bytes(content)
    with pytest.raises(montelux.Error, match="damaged.mx"):
        TrainedDensity.load(str(tmp_path / "damaged.mx"))


def test_pickles_bring_it_back(result, density):
    ball = Domain.ball((0, 0))
    round_one = montelux.integrate(peak, ball, "vegas", evaluations=20_000)
    for made in (density, result.density, round_one.density, montelux.Trained(density)):
        for again in (pickle.loads(pickle.dumps(made)), copy.copy(made), copy.deepcopy(made)):
            assert type(again) is type(made) and again is not made
            if isinstance(made, TrainedDensity):
                assert np.array_equal(again.samples(peak, 20).weights, made.samples(peak, 20).weights)
                pickle.loads(pickle.dumps(again))
    for r in (result, round_one):
        again = pickle.loads(pickle.dumps(r))
        assert np.array_equal(again.density.samples(peak, 9).points, r.density.samples(peak, 9).points)


@pytest.mark.parametrize("given", [(), (None,), (Domain.ball((0, 0)),)], ids=["left out", "None", "ball"])
def test_loaded_densities_pickle(density, given, tmp_path):
    path = str(tmp_path / "trained.mx")
    domain = given[0] if given else None
    made = density if domain is None else montelux.integrate(peak, domain, "vegas", evaluations=20_000).density
    made.save(path)
    loaded = TrainedDensity.load(path, *given)
    named = TrainedDensity.load(path=path, domain=domain)
    for again in (pickle.loads(pickle.dumps(loaded)), copy.copy(named), copy.deepcopy(loaded)):
        assert np.array_equal(again.samples(peak, 20).points, made.samples(peak, 20).points)
        pickle.loads(pickle.dumps(again))


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda d: d.samples(peak, 0), "a number of samples of 0 was given"),
        (lambda d: d.samples(lambda x: x, 10), "target"),
        (lambda d: d.unweighted(lambda x: 0 * x[:, 0], 10), "the target is zero at all"),
        (lambda d: d.unweighted(peak, 10, overweight_share=1), "share of overweight"),
        (lambda d: d.unweighted(peak, 10, pilot=0), "pilot"),
        (lambda d: d.samples(peak, 10, non_finite="leave"), "expected 'skip' or 'throw'"),
        (lambda d: d.histogram(peak, lambda x: x[:, 0], [1, 0]), "each above the one before"),
        (lambda d: TrainedDensity.load("/no/such/file.mx"), "/no/such/file.mx"),
    ],
)
def test_mistakes_get_a_sentence(density, call, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        call(density)


def test_exceptions_of_functions_pass_through(density):
    with pytest.raises(ZeroDivisionError):
        density.samples(lambda x: 1 / 0, 10)
    with pytest.raises(ZeroDivisionError):
        density.expectations(peak, lambda x: 1 / 0, 10)
