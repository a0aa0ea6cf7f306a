"""integrate(): what is wrong is answered with a sentence, and what functions raise passes through."""

from __future__ import annotations

import gc
import math
import weakref

import numpy as np
import pytest

import montelux

BOX = [(0, math.pi / 2), (0, 1)]


def sine_times_y(x):
    return np.sin(x[:, 0]) * x[:, 1]


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"method": "vegs"}, r"there is no method 'vegs' \(did you mean 'vegas'\?\)"),
        ({"method": "vegas", "alpah": 1}, r"there is no setting 'alpah' \(did you mean 'alpha'\?\)"),
        ({"method": "quasi", "points": "sobl"}, r"there is no choice 'sobl' \(did you mean 'sobol'\?\)"),
        ({"method": "importance"}, "expected the setting 'technique'"),
        ({"method": 3}, "an object of type 'int' was given; expected a name or a method"),
        ({"relative_error": -1}, "the relative error asked for is -1"),
        ({"relative_error": "1%"}, "'1%' was given; expected a number"),
        ({"relativ_error": 0.1}, r"there is no setting 'relativ_error' \(did you mean 'relative_error'\?\)"),
        ({"method": montelux.Vegas(), "relativ_error": 1}, r"no argument 'relativ_error' \(did you mean 'relative_error'"),
        ({"evaluations": 0.5}, "expected a whole number above zero"),
        ({"evaluations": "many"}, "'many' was given; expected a whole number above zero"),
        ({"evaluations": 1e30}, "expected a whole number above zero and below"),
        ({"time": 0}, "expected a number of seconds above zero"),
        ({"time": "1s"}, "'1s' was given; expected a number of seconds above zero"),
        ({"threads": 100_000}, "threads: 100000 was given; expected a whole number from 0 to 4096"),
        ({"threads": 1.5}, "expected a whole number from 0 to 4096"),
        ({"components": -1}, "expected a whole number that is not negative"),
        ({"progress": 3}, "expected True, False or a function"),
        ({"seed": -1}, "expected a whole number in"),
        ({"non_finite": "ignore"}, "there is no choice 'ignore'"),
        ({"norm": "vectr"}, r"norm: there is no choice 'vectr' \(did you mean 'vector'\?\)"),
        ({"method": "vegas", "points": "sobol", "replicates": 1}, "replicates"),
        *(({name: 1}, rf"there is no setting '{name}' \(did you mean 'relative_error'\?\)") for name in ("rtol", "epsrel")),
        *(({name: 1}, rf"'{name}' \(did you mean 'absolute_error'\?\)") for name in ("atol", "epsabs")),
        *(({name: 1}, rf"'{name}' \(did you mean 'evaluations'\?\)") for name in ("neval", "nitn", "maxeval", "n")),
        ({"method": montelux.Vegas(), "neval": 1}, r"no argument 'neval' \(did you mean 'evaluations'\?\)"),
        ({"resume": True}, "resume was asked for without a checkpoint"),
    ],
)
def test_wrong_arguments_are_answered(arguments, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(sine_times_y, BOX, **{"evaluations": 1000, **arguments})


@pytest.mark.parametrize(
    "domain, sentence",
    [
        ((1, 0), "reversed|lower"),
        ([(0, 1, 2)], "expected ranges"),
        ("unit", "expected ranges"),
        ([(0, math.nan)], "nan|NaN"),
        ([], "expected ranges"),
    ],
)
def test_wrong_domains_are_answered(domain, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(lambda x: x, domain)


@pytest.mark.parametrize(
    "make, sentence",
    [
        (lambda: montelux.Domain.ball("x"), "Domain.ball: an object of type 'str' was given; expected the coordinates"),
        (lambda: montelux.Domain.ball(2.5), "Domain.ball: an object of type 'float' was given; expected"),
        (lambda: montelux.Domain.ball(0), "Domain.ball: 0 dimensions were given; expected at least one"),
        (lambda: montelux.Domain.sphere([1, "a"]), "Domain.sphere: an object of type 'list' was given; expected"),
        (lambda: montelux.Domain.sphere(1), "at least 2 dimensions"),
    ],
)
def test_wrong_centres_are_answered(make, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        make()


@pytest.mark.parametrize(
    "other, ours",
    [("mean", "value"), ("sdev", "standard_error"), ("error", "standard_error"), ("std", "standard_error"),
     ("chi2", "chi_squared"), ("dof", "degrees_of_freedom"), ("neval", "evaluations"), ("Q", "p_value")],
)  # fmt: skip
def test_names_of_other_integrators_are_answered_with_ours(other, ours):
    r = montelux.integrate(lambda x: x, (0, 1), evaluations=1000)
    with pytest.raises(AttributeError, match=rf"no attribute of Result '{other}' \(did you mean '{ours}'\?\)"):
        getattr(r, other)


def test_unknown_attributes_are_answered_with_the_nearest():
    settings = montelux.Vegas()
    with pytest.raises(AttributeError, match=r"did you mean 'alpha'\?"):
        settings.alpah = 2
    with pytest.raises(montelux.Error, match=r"did you mean 'alpha'\?"):
        settings.alpah
    assert not hasattr(settings, "alpah") and not hasattr(settings, "__len__")


# Integrands that are wrong.


@pytest.mark.parametrize(
    "f, sentence",
    [
        (lambda x: np.sum(x**2), r"shape \(\) was returned for 5 points.*axis=1"),
        (lambda x: x[:3, 0], r"an array of shape \(3,\) was returned for 5 points; expected shape \(5,\)"),
        (lambda x: x.T, r"shape \(2, 5\)"),
        (lambda x: 1j * x[:, 0], "complex numbers were found.*np.stack"),
        (lambda x: None, "returned None.*return statement"),
        (lambda x: np.ma.masked_less(x[:, 0], 0.5), r"a masked array was found.*filled\(0\)"),
        (lambda x: ["a"] * len(x), "not all numbers"),
        (lambda x: np.array([object()] * len(x)), "not all numbers"),
    ],
)
def test_wrong_returns_give_a_message(f, sentence):
    with pytest.raises(montelux.Error, match="integrand: .*" + sentence):
        montelux.integrate(f, [(0, 1), (0, 1)], evaluations=1000)
    with pytest.raises(montelux.Error, match="integrand: "):  # without the call before the run
        montelux.integrate(f, [(0, 1), (0, 1)], evaluations=1000, components=0)


def test_a_shape_that_changes_gives_a_message():
    calls = []

    def f(x):
        calls.append(1)
        return x if len(calls) < 3 else np.ones((len(x), 2))

    with pytest.raises(montelux.Error, match=r"expected shape \(\d+,\)"):
        montelux.integrate(f, (0, 1), "basic", evaluations=100_000)


def test_values_that_are_not_finite_are_counted_and_give_a_warning():
    with np.errstate(all="ignore"):
        r = montelux.integrate(lambda x: np.where(x < 0.01, np.nan, 1.0), (0, 1), "basic", evaluations=10_000, seed=1)
        assert 0 < r.non_finite < 300 and r.first_non_finite_point[0] < 0.01
        assert "were not finite" in r.warnings[0] and not r.converged
        with pytest.raises(montelux.Error, match=r"the integrand is nan at \(0\.00"):
            montelux.integrate(
                lambda x: np.where(x < 0.01, np.nan, 1.0), (0, 1), "basic", evaluations=10_000, non_finite="throw"
            )
        with pytest.raises(montelux.Error, match="none of the .* values of the integrand is a finite number"):
            montelux.integrate(lambda x: x * np.nan, (0, 1))


class OwnError(Exception):
    pass


@pytest.mark.parametrize("threads", [1, 2])
def test_exceptions_pass_through_unchanged(threads):
    raised = OwnError("mine", 42)

    def f(x):
        if len(x) > 100:
            raise raised
        return x

    with pytest.raises(OwnError) as caught:
        montelux.integrate(f, (0, 1), "basic", evaluations=100_000, threads=threads)
    assert caught.value is raised and caught.value.args == ("mine", 42)
    assert "raise raised" in str(caught.traceback[-1].statement)


def test_points_that_are_kept_are_refused():
    kept = []
    with pytest.raises(montelux.Error, match=r"kept beyond the call.*x\.copy\(\)"):
        montelux.integrate(lambda x: kept.append(x[:, 0]) or x[:, 0], [(0, 1), (0, 1)], components=0)
    with pytest.raises(montelux.Error, match="kept beyond the call"):
        montelux.integrate(lambda x, y: kept.append(y), (0, 1), out=True)
    kept.clear()
    montelux.integrate(lambda x: kept.append(x.copy()) or x, (0, 1), "basic", evaluations=1000)
    assert sum(map(len, kept)) >= 1000


def test_frames_of_failed_integrands_keep_no_points():
    def f(x):
        doubled = x[::2]
        raise OwnError(len(doubled))

    with pytest.raises(OwnError) as caught:
        montelux.integrate(f, (0, 1), components=0)
    trace = caught.value.__traceback__
    while trace.tb_next:
        trace = trace.tb_next
    assert trace.tb_frame.f_code.co_name == "f" and "x" not in trace.tb_frame.f_locals


def test_integrals_within_integrals():
    def inner(y):
        return float(montelux.integrate(lambda x: np.exp(-y * x), (0, 1), relative_error=1e-8))

    r = montelux.integrate(inner, (1, 2), relative_error=1e-6, batch=False)
    truth = montelux.integrate(lambda x: np.exp(-x[:, 0] * x[:, 1]), [(0, 1), (1, 2)], relative_error=1e-8)
    assert float(r) == pytest.approx(float(truth), rel=1e-5)


def test_functions_are_let_go():
    class F:
        def __call__(self, x):
            return x

    f = F()
    alive = weakref.ref(f)
    montelux.integrate(f, (0, 1), evaluations=1000)
    del f
    gc.collect()
    assert alive() is None
