"""Pickles and copies of domains, methods, distributions and results; integrals in other processes."""

from __future__ import annotations

import copy
import math
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import montelux
from montelux import Distribution, Domain, Technique
from montelux._names import settings_of

UNIT = [(0, 1), (0, 1)]


def f(x):
    return np.sin(3 * x[:, 0]) * np.exp(x[:, 1]) if x.ndim == 2 else np.sin(3 * x)


def density(x):
    return math.exp(-3 * x)


def disk(u):
    radius, angle = np.sqrt(u[:, 0]), 2 * math.pi * u[:, 1]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1), np.full(len(u), math.pi)


def product_density(x):
    return 4 * x[:, 0] * x[:, 1]


def copies(thing):
    yield from (pickle.loads(pickle.dumps(thing, protocol)) for protocol in (2, pickle.HIGHEST_PROTOCOL))
    yield copy.copy(thing)
    yield copy.deepcopy(thing)
    yield pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(thing))))


@pytest.mark.parametrize(
    "domain",
    [
        Domain.box([(0, 2), (-math.inf, math.inf)]),
        Domain.unit_cube(2),
        Domain.simplex(dimensions=2),
        Domain.ball((0, 1), radius=2),
        Domain.ball(np.array([1.0, 2.0])),
        Domain.sphere(3),
        Domain.product(Domain.box([(0, 1)]), Domain.box([(2, 3)])),
        Domain.mapped(2, 2, disk, "disk"),
    ],
    ids=repr,
)
def test_domains(domain):
    u = np.random.default_rng(1).random((20, domain.uniforms))
    value = montelux.integrate(f, domain, "quasi", evaluations=1000).value
    for again in copies(domain):
        assert repr(again) == repr(domain) and again is not domain
        assert all(np.array_equal(a, b) for a, b in zip(again.map(u), domain.map(u)))
        assert montelux.integrate(f, again, "quasi", evaluations=1000).value == value


TILTED = Technique.functions(2, 2, np.sqrt, product_density)
FLAT = Technique.uniform(Domain.unit_cube(2))
PAIR = Technique([Distribution.beta(2, 1), Distribution.uniform()])
METHODS = [
    montelux.Auto(),
    montelux.Adaptive(replicates=8, uniform_share=0.1),
    montelux.Vegas(alpha=0.5, points="sobol", map=montelux.train_map(f, UNIT, 20_000)),
    montelux.VegasSobol(montelux.Vegas(increments=64)),
    montelux.Quasi(points="halton", randomisation="shift", replicates=4),
    montelux.BasicMonteCarlo(),
    montelux.Stratified(strata=8, allocation="neyman"),
    montelux.Recursive(pilot=0.3),
    montelux.Metropolis(chains=8, burn_in=100),
    montelux.Cubature(max_memory=1 << 24),
    montelux.RiemannSum(cells=8),
    montelux.MidpointRule(cells=9),
    montelux.TrapezoidRule(cells=10),
    montelux.Importance(TILTED, points="sobol", probes=False),
    montelux.Importance([Distribution.beta(2, 1), Distribution.uniform()]),
    montelux.MultipleImportance([(PAIR, 3), FLAT], weights="power", parameter=1.5),
    montelux.MultipleImportance((TILTED, FLAT), weights="optimal", probes=False),
    montelux.ControlVariate(product_density, [1.0]),
    montelux.Trained(montelux.integrate(f, UNIT, "vegas", evaluations=20_000).density),
]


@pytest.mark.parametrize("method", METHODS, ids=lambda m: m.name)
def test_methods(method):
    r = montelux.integrate(f, UNIT, method, evaluations=5000, seed=3)
    for again in copies(method):
        assert type(again) is type(method) and again is not method
        for name in settings_of(type(method)):
            given = getattr(method, name)
            if isinstance(given, (int, float, str, list, type(None))):
                assert getattr(again, name) == given
        s = montelux.integrate(f, UNIT, again, evaluations=5000, seed=3)
        assert (s.value, s.standard_error) == (r.value, r.standard_error)


def test_every_method_is_tested():
    assert {m.name for m in METHODS} == set(montelux.METHODS)


def test_settings_as_they_are_now():
    method = montelux.Importance(TILTED)
    method.points = "sobol"
    control = montelux.ControlVariate(product_density, [1.0])
    control.integrals = [2.0]
    assert pickle.loads(pickle.dumps(method)).points == "sobol"
    assert pickle.loads(pickle.dumps(control)).integrals == [2.0]


def test_arguments_as_they_were_then():
    x, weights, centre = np.array([0.0, 1.0, 3.0]), [1.0, 2.0], [0.0, 0.0]
    d = Distribution.tabulated(x, [1, 2, 0])
    mixture = Distribution.mixture(weights, components=[Distribution.normal(), Distribution.normal(3)])
    ball, chosen = Domain.ball(centre), montelux.Discrete(x)
    x[:], weights[0], centre[0] = [0, 5, 9], 100, 7
    again = pickle.loads(pickle.dumps((d, mixture, ball, chosen)))
    assert again[0].upper == 3 and again[1].cdf(1.0) == mixture.cdf(1.0)
    assert np.abs(again[2].map(np.full((1, 2), 0.5))[0]).max() < 1
    assert np.array_equal(again[3].probabilities, chosen.probabilities)


FAMILIES = [
    Distribution.uniform(1, 3),
    Distribution.normal(1, deviation=2),
    Distribution.log_normal(),
    Distribution.exponential(2),
    Distribution.gamma(2.5),
    Distribution.chi_squared(3),
    Distribution.beta(2, 3),
    Distribution.cauchy(),
    Distribution.student_t(5),
    Distribution.laplace(1),
    Distribution.logistic(),
    Distribution.pareto(3),
    Distribution.power_law(2.0),
    Distribution.weibull(2),
    Distribution.triangular(0, 0.3, 1),
    Distribution.linear(2, 4),
    Distribution.quadratic(),
    Distribution.cosine(),
    Distribution.ggx_angle(0.3),
    Distribution.tabulated([0, 1, 3], [1, 2, 0]),
    Distribution.piecewise_constant([1, 0, 3], 0, 6),
    Distribution.mixture([1, 2], [Distribution.normal(-2), Distribution.normal(2).truncated(0, 3)]),
    Distribution.normal().truncated(0, 1),
    Distribution.exponential(1).scaled(-2, shift=1),
    Distribution.from_density(density, 0, math.inf),
]


@pytest.mark.parametrize("distribution", FAMILIES, ids=repr)
def test_distributions(distribution):
    u = np.linspace(0.05, 0.95, 19)
    for again in copies(distribution):
        assert repr(again) == repr(distribution) and np.array_equal(again.sample(u), distribution.sample(u))


def test_every_way_to_make_a_distribution_is_tested():
    made = {d._recipe[0] for d in FAMILIES}
    public = {name for name in vars(Distribution) if not name.startswith("_")}
    functions = {"pdf", "cdf", "cdf_complement", "quantile", "quantile_complement", "sample", "draw", "lower", "upper"}
    assert public - functions == made


def test_tables_and_maps():
    u = np.random.default_rng(2).random(50)
    for kind in (montelux.Discrete, montelux.AliasTable):
        for again in copies(kind([1, 2, 3.5])):
            assert np.array_equal(again.sample(u), kind([1, 2, 3.5]).sample(u))
    trained = montelux.train_map(f, UNIT, 20_000)
    for again in copies(trained):
        assert all(np.array_equal(again.edges(d), trained.edges(d)) for d in (0, 1))


def test_results():
    runs = [
        montelux.integrate(f, UNIT, "basic", evaluations=2000),
        montelux.integrate(lambda x: x, UNIT, "vegas", evaluations=2000),
        montelux.integrate_log(lambda x: -x * x, (-9, 9), "quasi", evaluations=1000),
    ]
    for r in runs:
        for again in copies(r):
            assert again == r and hash(again) == hash(r) and str(again) == str(r) and again.to_dict() == r.to_dict()
    assert len({*runs, *copies(runs[0])}) == 3
    chains = montelux.metropolis(lambda x: -float(x @ x), [0.0], samples=100, burn_in=50)
    for again in copies(chains):
        assert np.array_equal(again.states, chains.states) and repr(again) == repr(chains)
    progress = montelux.Progress(1, 4, 0.5, None, 0.25, 1.5)
    assert all(vars(again) == vars(progress) for again in copies(progress))


def test_functions_that_do_not_pickle_are_named():
    for thing in (
        Domain.mapped(1, 1, lambda u: (u, u)),
        Distribution.from_density(lambda x: 1.0, 0, 1),
        montelux.ControlVariate(lambda x: x, [0.5]),
        montelux.Importance(Technique.functions(1, 1, lambda u: u, np.ones_like)),
    ):
        with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
            pickle.dumps(thing)


def test_functions_and_docstrings_stay():
    assert Domain.ball.__doc__.startswith("ball(centre") and Distribution.normal.__name__ == "normal"
    assert "Restricted to an interval" in Distribution.normal().truncated.__doc__
    with pytest.raises(TypeError, match="incompatible function arguments"):
        Distribution.normal("a")
    with pytest.raises(TypeError, match="expected a Distribution, or a list of them"):
        montelux.Importance("a")


def failing(x):
    raise montelux.Error("mine")


def test_integrals_in_other_processes():
    jobs = [(Domain.ball(2), montelux.Vegas(alpha=0.5)), (Domain.mapped(2, 2, disk, "disk"), METHODS[4])]
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        results = list(pool.map(montelux.integrate, [f] * 2, *zip(*jobs), timeout=60))
        with pytest.raises(montelux.Error, match="mine"):
            pool.submit(montelux.integrate, failing, (0, 1)).result(60)
    here = [montelux.integrate(f, domain, method) for domain, method in jobs]
    assert [(r.value, r.standard_error) for r in results] == [(r.value, r.standard_error) for r in here]
    assert results[0] != here[0] and (results[0] - results[0]) == 0
