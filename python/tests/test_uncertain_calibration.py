"""Whether the errors of computed values hold: over seeds, beside draws, and beside gvar."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest

import montelux

#: P(|t| < 1) of Student's law, by degrees of freedom.
WITHIN_ONE_ERROR = {7: 0.649417, math.inf: 0.682689}


def related(x):
    """Two components that vary together: their ratio is far better known than they are."""
    peak = np.exp(-20 * ((x - 0.4) ** 2).sum(axis=1))
    return np.stack([peak, peak * (1 + 0.3 * x[:, 0])], axis=-1)


def truth():
    # Both are products of integrals of one variable, over [0, 1].
    a = 20.0
    zero = math.sqrt(math.pi / a) / 2 * (math.erf(0.6 * math.sqrt(a)) + math.erf(0.4 * math.sqrt(a)))
    first = 0.4 * zero + (math.exp(-a * 0.16) - math.exp(-a * 0.36)) / (2 * a)
    return 1 / (1 + 0.3 * first / zero)


@pytest.mark.parametrize("method, freedom", [(montelux.BasicMonteCarlo(), math.inf), (montelux.Quasi(replicates=8), 7)])
def test_ratios_of_components_are_calibrated(method, freedom):
    """Over 300 seeds the truth is within one error as often as Student's law says: 5 deviations of the binomial
    law are passed once in 1.7 million. Components taken as independent would have errors 30 times too large."""
    seeds, within, squares = 300, 0, 0.0
    for seed in range(seeds):
        r = montelux.integrate(related, [(0, 1), (0, 1)], method, evaluations=1024, seed=seed, components=2)
        z = (r[0] / r[1]).z_score(truth())
        within += abs(z) < 1
        squares += z * z
    p = WITHIN_ONE_ERROR[freedom]
    assert abs(within - seeds * p) < 5 * math.sqrt(seeds * p * (1 - p))
    if math.isinf(freedom):  # a sum of squares is chi-squared, of variance 2 per seed
        assert abs(squares - seeds) < 5 * math.sqrt(2 * seeds)


def test_independent_runs_are_calibrated():
    squares = 0.0
    for seed in range(300):
        a, b = (
            montelux.integrate(f, (0, 1), "basic", evaluations=1000, seed=2 * seed + k, components=0)
            for k, f in enumerate((np.sin, np.exp))
        )
        squares += (a * b - np.log(b)).z_score((1 - math.cos(1)) * (math.e - 1) - math.log(math.e - 1)) ** 2
    assert abs(squares - 300) < 5 * math.sqrt(600)


def test_errors_beside_draws():
    """The deviation of 200000 draws has a relative error of 0.16 %; 5 of these, and 0.1 % for higher orders."""
    value, n = np.array([1.0, 2.0, 0.5]), 200_000
    root = 0.01 * np.array([[1, 0, 0], [0.8, 0.6, 0], [-0.5, 0.5, 0.7]])
    a, b, c = montelux.Uncertain.correlated(value, root @ root.T)
    x, y, z = (value + np.random.default_rng(7).standard_normal((n, 3)) @ root.T).T
    for computed, draws in (
        (a + b - c, x + y - z),
        (a * b / c, x * y / z),
        (np.exp(a - b) * c**2, np.exp(x - y) * z**2),
        (np.arctan(b / a).sin(), np.sin(np.arctan(y / x))),
        (b**c, y**z),
        (montelux.propagate(math.hypot, a, c), np.hypot(x, z)),
    ):
        assert computed.standard_error == pytest.approx(draws.std(), rel=0.009)
        assert abs(draws.mean() - computed.value) < 0.02 * computed.standard_error
    assert (a * c).correlation(b / c) == pytest.approx(np.corrcoef(x * z, y / z)[0, 1], abs=0.012)


def test_gvar_computes_the_same():
    gvar = pytest.importorskip("gvar", reason="gvar is not installed")
    r = montelux.integrate(related, [(0, 1), (0, 1)], "vegas", evaluations=20_000, seed=1)
    a, b = r
    c = montelux.integrate(np.exp, (0, 1), "quasi", evaluations=1000, seed=2)
    x, y = r.to_gvar()
    z = c.to_gvar()
    ours = [a / b, np.exp(a) * b - c, (a * b) ** 0.3 / c, np.arctan(a - b + c)]
    theirs = [x / y, np.exp(x) * y - z, (x * y) ** 0.3 / z, np.arctan(x - y + z)]
    for u, g in zip(ours, theirs):
        assert u.value == pytest.approx(g.mean, rel=1e-13) and u.standard_error == pytest.approx(g.sdev, rel=1e-9)
    assert montelux.covariance(ours) == pytest.approx(gvar.evalcov(theirs), rel=1e-9, abs=1e-16)
    # Correlations to what was converted before, and back.
    assert gvar.evalcorr([ours[0].to_gvar(), theirs[0]])[0, 1] == pytest.approx(1)
    assert (ours[1].to_gvar() - theirs[1]).sdev < 1e-6 * theirs[1].sdev
    back = montelux.Uncertain.from_gvar(theirs)
    assert montelux.covariance(back) == pytest.approx(gvar.evalcov(theirs), rel=1e-12)
    one = montelux.Uncertain.from_gvar(gvar.gvar(2.5, 0.3))
    assert (one.value, one.standard_error) == (2.5, 0.3)
    log_z = montelux.integrate_log(lambda x: -x * x, (-9, 9), "quasi", evaluations=4000)
    assert log_z.to_gvar().sdev == pytest.approx(log_z.log_error)
    unknown = montelux.integrate(related, [(0, 1), (0, 1)], "basic", evaluations=1000, covariance=False)
    with pytest.raises(montelux.Error, match="covariance=True"):
        unknown.to_gvar()


def test_without_gvar_there_is_a_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "gvar", None)
    with pytest.raises(montelux.Error, match="gvar is not installed.*pip install gvar"):
        montelux.Uncertain(1, 0.1).to_gvar()
