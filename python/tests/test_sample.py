"""sample(): draws of chains and ensembles, their diagnostics, and what ArviZ makes of them."""

from __future__ import annotations

import ctypes
import math

import numpy as np
import pytest

import montelux

LINE = (-math.inf, math.inf)
SAMPLERS = ["metropolis", "ensemble", "slice"]


def normal(x):
    """Means 0 and 1, variances 2/3, correlation 1/2."""
    a, b = x[:, 0], x[:, 1] - 1
    return -a * a - b * b + a * b


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_draws_follow_the_density(sampler):
    chains, n = (4, 2000) if sampler == "metropolis" else (32, 400)
    settings = {"sampler": sampler, "burn_in": 200, "thin": 2, "seed": 3}
    draws = montelux.sample(normal, [LINE, LINE], n, names=["a", "b"], **settings)
    assert draws.states.shape == (chains, n, 2)
    z = (draws.mean - [0, 1]) / draws.standard_error
    assert np.all(np.abs(z) < 5) and np.all(draws.standard_error < 0.1)
    assert np.all(draws.r_hat < 1.1) and np.all(draws.bulk_effective_size > 300)
    assert set(draws.posterior) == {"a", "b"} and draws.posterior["a"].shape == (chains, n)
    assert np.array_equal(draws.posterior["b"], draws.states[:, :, 1])
    assert "a: " in repr(draws) and f"{chains} chains of {n} draws" in repr(draws)
    again = montelux.sample(normal, [LINE, LINE], n, threads=3, **settings)
    assert np.array_equal(draws.states, again.states)


def test_any_form_of_function():
    settings = {"n": 200, "sampler": "slice", "burn_in": 100}
    expected = montelux.sample(lambda x: -0.5 * x * x, LINE, **settings).states
    assert expected.shape == (32, 200, 1)
    one = montelux.sample(lambda x: -0.5 * x * x, LINE, batch=False, **settings)
    assert np.array_equal(one.states, expected) and one.posterior["x"].shape == (32, 200)

    @ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
    def native(x):
        return -0.5 * x * x

    assert np.array_equal(montelux.sample(native, LINE, threads=2, **settings).states, expected)
    metropolis = montelux.sample(native, LINE, 200, starts=[-1, 1, -2, 2])
    assert metropolis.states.shape == (4, 200, 1)


def test_c_functions_as_targets_of_trained_densities():
    @ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int, ctypes.POINTER(ctypes.c_double))
    def native(n, x):
        return x[0] * math.exp(-x[1])

    def f(x):
        return x[:, 0] * np.array([math.exp(-y) for y in x[:, 1]])

    density = montelux.integrate(f, [(0, 1), (0, 2)], "vegas", evaluations=20_000).density
    for of_native, of_python in (
        (density.samples(native, 500), density.samples(f, 500)),
        (density.unweighted(native, 500), density.unweighted(f, 500)),
    ):
        assert np.array_equal(of_native.points, of_python.points)
        assert np.array_equal(of_native.weights, of_python.weights)
    h = [density.histogram(g, lambda x: x[:, 0], [0, 0.5, 1], 5000).value for g in (native, f)]
    e = [density.expectations(g, lambda x: x[:, 0], 5000).mean for g in (native, f)]
    assert np.array_equal(*h) and np.array_equal(*e)
    one = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda x: x)
    with pytest.raises(montelux.Error, match="a C function of one number was given for a domain of 2 variables"):
        density.samples(one, 10)


def test_names_may_come_from_a_generator():
    draws = montelux.sample(normal, [LINE, LINE], 8, names=(name for name in "ab"), burn_in=10)
    assert draws.names == ("a", "b")


def test_chains_that_disagree_say_so():
    def two(x):
        return np.logaddexp(-0.5 * (x - 20) ** 2, -0.5 * (x + 20) ** 2)

    draws = montelux.sample(two, (-40, 40), 500, starts=[-20, 20, -20, 20], names=["mass"])
    assert draws.r_hat[0] > 1.5 and any("R-hat of 'mass'" in warning for warning in draws.warnings)


def test_mistakes_get_a_sentence():
    def refused(match, *arguments, **settings):
        with pytest.raises(montelux.Error, match=match):
            montelux.sample(*arguments, **settings)

    refused("did you mean 'ensemble'", normal, [LINE, LINE], sampler="ensembl")
    refused("n: 7 was given", normal, [LINE, LINE], 7)
    refused("3 walkers were given for 2 variables", normal, [LINE, LINE], sampler="slice", walkers=3)
    refused("chains of metropolis have no walkers", normal, [LINE, LINE], walkers=8)
    refused(r"starts: an array of shape \(1, 3\)", normal, [LINE, LINE], starts=[1, 2, 3])
    refused("2 starts were given for 4 chains", normal, [LINE, LINE], starts=[[0, 0], [1, 1]])
    refused("names: 'ab' was given", normal, [LINE, LINE], names="ab")
    refused("expected names that differ", normal, [LINE, LINE], names=["a", "a"])
    refused("a name for each of 2 variables", normal, [LINE, LINE], names=["a"])
    refused("names: 'draw' is the name of a dimension", normal, [LINE, LINE], names=["a", "draw"])
    refused("names: None was given", normal, [LINE, LINE], names=None)
    refused("sampler", normal, [LINE, LINE], sampler=None)
    refused("starts: no point was given", normal, [LINE, LINE], starts=[])
    refused(r"GiB of memory; this machine has .*--thin", normal, [LINE, LINE], 10**11)
    refused("the density is zero at all of 1000 points", lambda x: np.full(len(x), -np.inf), (0, 1))
    refused("expected a box of ranges", normal, montelux.Domain.ball([0, 0]))
    refused("expected a function", 3, (0, 1))
    with pytest.raises(ZeroDivisionError):
        montelux.sample(lambda x: 1 / 0, (0, 1))
    with pytest.raises(AttributeError, match="did you mean 'r_hat'"):
        montelux.sample(lambda x: -x, (0, 1), 8).rhat


def test_arviz_takes_the_draws():
    arviz = pytest.importorskip("arviz", reason="ArviZ is not installed")
    draws = montelux.sample(normal, [LINE, LINE], 500, names=["a", "b"], seed=1)
    data = arviz.from_dict(posterior=draws.posterior)
    assert data.posterior.sizes == {"chain": 4, "draw": 500}
    summary = arviz.summary(data, round_to="none", kind="all")
    columns = (
        ("mean", draws.mean),
        ("sd", draws.standard_deviation),
        ("ess_bulk", draws.bulk_effective_size),
        ("ess_tail", draws.tail_effective_size),
        ("r_hat", draws.r_hat),
        ("mcse_mean", draws.standard_error),
    )
    for name, ours in columns:
        assert np.allclose(summary[name], ours, rtol=1e-8), name
