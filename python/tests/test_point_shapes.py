"""The shape in which functions get points of one variable."""

from __future__ import annotations

import copy

import numpy as np
import pytest

import montelux


@pytest.mark.parametrize(
    "domain, shape",
    [
        ((0, 1), ()),
        ([0, 1], ()),
        (np.array([0.0, 1.0]), ()),
        (montelux.Domain.box([(0, 1)]), ()),
        ([(0, 1)], (1,)),
        (((0, 1),), (1,)),
        (np.array([[0.0, 1.0]]), (1,)),
    ],
)
def test_the_shape_of_a_point_of_one_variable(domain, shape):
    """A list of one range gives points of one coordinate; a single range and a Domain give numbers."""
    seen = set()

    def f(x):
        seen.add(np.shape(x)[1:])
        return np.ravel(x) ** 2

    def into(x, y):
        y[:] = f(x)

    def at(x):
        seen.add(np.shape(x))
        return float(np.sum(x) ** 2)

    plain = montelux.integrate(lambda x: x**2, (0, 1), "vegas", evaluations=4000)
    for function, options in (
        (f, {}),
        (f, {"workers": 2}),
        (f, {"array": np.from_dlpack}),
        (into, {"out": True}),
        (at, {"batch": False}),
        (at, {"batch": False, "workers": 2}),
    ):
        r = montelux.integrate(function, domain, "vegas", evaluations=4000, **options)
        assert (r.value, r.standard_error) == (plain.value, plain.standard_error)
        log = montelux.integrate_log(function, domain, "quasi", evaluations=1000, **options)
        assert log.log_value > 0
    montelux.train_map(f, domain, 5000)
    montelux.sample(lambda x: -f(x), domain, 10, burn_in=50)
    for density in (r.density, copy.copy(r.density)):
        density.samples(f, 10)
        density.unweighted(f, 10)
        density.expectations(f, f, 100)
        density.histogram(f, f, [0, 0.5, 1], 100)
    assert seen == {shape}


def test_the_example_of_the_installation():
    r = montelux.integrate(lambda x: x[:, 0] ** 2, [(0, 1)], relative_error=1e-6)
    assert float(r) == pytest.approx(1 / 3, rel=1e-5)
