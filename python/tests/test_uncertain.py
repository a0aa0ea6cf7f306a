"""Values with errors that compute: covariances to first order, what is one random variable, warnings, text."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
import warnings

import numpy as np
import pytest

import montelux
from montelux import PropagationWarning, Uncertain
from montelux._derivatives import FUNCTIONS

UNIT = [(0, 1), (0, 1)]


def parts(x):
    return np.stack([x[:, 0], 1 - x[:, 0], np.exp(x[:, 0] * x[:, 1])], axis=-1)


@pytest.fixture(scope="module")
def run():
    return montelux.integrate(parts, UNIT, "basic", evaluations=20_000, seed=1)


# Exact algebra.


def test_errors_equal_the_covariance_algebra(run):
    a, b, c = run
    value, covariance = run.value, run.covariance
    x, y, z = value
    for computed, expected, gradient in (
        (a + b, x + y, [1, 1, 0]),
        (a + c, x + z, [1, 0, 1]),
        (c - 2 * a + 3, z - 2 * x + 3, [-2, 0, 1]),
        (a * c, x * z, [z, 0, x]),
        (a / c, x / z, [1 / z, 0, -x / z**2]),
        (1 / c, 1 / z, [0, 0, -1 / z**2]),
        (c**-1.5, z**-1.5, [0, 0, -1.5 * z**-2.5]),
        (a**c, x**z, [z * x ** (z - 1), 0, x**z * math.log(x)]),
        (2**c, 2**z, [0, 0, 2**z * math.log(2)]),
        (-abs(-c), -z, [0, 0, -1]),
        (np.exp(a) * np.sin(c), math.exp(x) * math.sin(z), [math.exp(x) * math.sin(z), 0, math.exp(x) * math.cos(z)]),
        ((a * a + c * c).sqrt(), math.hypot(x, z), [x / math.hypot(x, z), 0, z / math.hypot(x, z)]),
    ):
        variance = np.array(gradient) @ covariance @ gradient
        assert computed.value == pytest.approx(expected, rel=1e-14)
        assert computed.standard_error == pytest.approx(math.sqrt(max(variance, 0)), rel=1e-11, abs=1e-10)


def test_what_cancels_has_no_error(run):
    a, b, c = run
    assert (a - a) == 0 and (a - a).standard_error == 0 and str(a - a) == "0(0)"
    assert (a + c - c - a).standard_error == 0 and (a / a).standard_error == 0
    assert (0.1 * a + 0.2 * a - 0.3 * a).standard_error == 0  # to rounding
    assert (a + b).standard_error == 0 and (a + b).value == pytest.approx(1)  # x and 1 - x
    assert a.standard_error == run.standard_error[0] > 0  # all bits


def test_covariances_of_computed_values(run):
    a, b, c = run
    other = montelux.Uncertain(2, 0.1)
    computed = [a / c, c, a * c + other, other, 3]
    z, x = c.value, a.value
    j = np.array([[1 / z, 0, -x / z**2, 0], [0, 0, 1, 0], [z, 0, x, 1], [0, 0, 0, 1], [0, 0, 0, 0]])
    sources = np.zeros((4, 4))
    sources[:3, :3], sources[3, 3] = run.covariance, 0.01
    assert montelux.covariance(computed) == pytest.approx(j @ sources @ j.T, rel=1e-11, abs=1e-14)
    assert c.correlation(c) == pytest.approx(1) and c.correlation(-c) == pytest.approx(-1)
    assert c.correlation(other) == 0 and math.isnan(c.correlation(3.0))
    assert montelux.covariance([run[0], run[1]]) == pytest.approx(run.covariance[:2, :2], rel=1e-14)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_derivatives_of_functions(name):
    x = 1.3 if name == "arccosh" else 0.3
    f, h = FUNCTIONS[name], 1e-4
    values = [f(x + k * h)[0] for k in (-2, -1, 0, 1, 2)]
    first = (values[0] - 8 * values[1] + 8 * values[3] - values[4]) / (12 * h)
    second = (-values[0] + 16 * values[1] - 30 * values[2] + 16 * values[3] - values[4]) / (12 * h * h)
    assert f(x)[0] == pytest.approx(getattr(np, name)(x), rel=1e-14)
    assert f(x)[1] == pytest.approx(first, rel=1e-9) and f(x)[2] == pytest.approx(second, rel=1e-5, abs=1e-6)


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name != "abs"])
def test_functions_of_numpy_and_methods(name):
    x = Uncertain(1.3 if name == "arccosh" else 0.3, 0.01)
    by_numpy = getattr(np, name)(x)
    assert isinstance(by_numpy, Uncertain) and by_numpy == getattr(x, name)()
    assert by_numpy.standard_error == pytest.approx(abs(FUNCTIONS[name](x.value)[1]) * 0.01, rel=1e-14)


def test_any_function_propagates(run):
    a, _, c = run
    exact = np.sin(a) * c
    secant = montelux.propagate(lambda x, y: math.sin(x) * y, a, c)
    assert secant.value == exact.value and secant.standard_error == pytest.approx(exact.standard_error, rel=1e-5)
    assert secant.covariance(a) == pytest.approx(exact.covariance(a), rel=1e-5)
    assert montelux.propagate(math.gamma, 5.0) == 24.0
    with pytest.warns(PropagationWarning, match=r"^gamma\(1.00\(50\)\)"):
        montelux.propagate(math.gamma, Uncertain(1, 0.5))


def test_numpy_arrays_of_values(run):
    a, b, c = run
    array = np.array(list(run))
    assert array.dtype == object and array.shape == (3,)
    assert array.sum() == a + b + c and (array @ [1.0, 0.0, 2.0]) == a + 2 * c
    assert list(np.array([1.0, 2.0]) * c) == [c, 2 * c] and list(c - np.array([1.0, 2.0])) == [c - 1, c - 2]
    assert np.float64(2) * c == c * np.float64(2) == 2 * c and np.exp(array)[2] == c.exp()
    with pytest.raises(TypeError, match="cbrt"):
        np.cbrt(c)


# Results.


def test_scalar_results_compute():
    a = montelux.integrate(np.sin, (0, 1), "quasi", evaluations=1000, seed=1)
    b = montelux.integrate(np.exp, (0, 1), "quasi", evaluations=1000, seed=2)
    expected = (a.value / b.value) * math.hypot(a.relative_error, b.relative_error)
    assert (a / b).standard_error == pytest.approx(expected, rel=1e-14) and float(a / b) == a.value / b.value
    assert a - a == 0 and 2 * a - a == a.uncertain == +a and np.exp(a) == a.uncertain.exp()
    assert 3 - a == -(a - 3) and 1 / a == a**-1 and 2**a == np.exp2(1) ** a and abs(-a) == a.uncertain
    assert a.uncertain.standard_error == a.standard_error and np.asarray(a) == a.value
    assert a.uncertain.relative_error == a.relative_error
    with pytest.raises(TypeError, match="a single number, without components"):
        a[0]
    with pytest.raises(TypeError):
        a + "1"


def test_vector_results_compute_by_component(run):
    assert list(run) == [run[0], run[1], run[2]] and run[-1] == run[2]
    with pytest.raises(TypeError, match=r"3 components.*r\[0\]"):
        2 * run
    with pytest.raises(TypeError, match="3 components"):
        np.exp(run)
    with pytest.raises(IndexError, match="component 3 was asked for; the integral has 3"):
        run[3]
    with pytest.raises(TypeError, match="expected a whole number"):
        run["a"]
    one = montelux.integrate(lambda x: x[:, :1], UNIT, "basic", evaluations=1000)
    assert one.uncertain == one[0] == +one
    with pytest.raises(ValueError, match="read-only"):
        run.covariance[0, 0] = 0


def test_unknown_covariances_are_refused():
    r = montelux.integrate(parts, UNIT, "basic", evaluations=1000, covariance=False)
    assert (2 * r[0]).standard_error == 2 * r.standard_error[0] and (r[0] - r[0]).standard_error == 0
    with pytest.raises(montelux.Error, match="covariance of the components.*not known"):
        r[0] + r[1]
    with pytest.raises(montelux.Error, match="not known"):
        montelux.covariance(list(r))


def test_logarithms_compute():
    a, b = (montelux.integrate_log(lambda x: -x * x / s, (-9, 9), "quasi", evaluations=4000, seed=s) for s in (1, 2))
    bayes = a - b
    assert bayes.value == a.log_value - b.log_value
    assert bayes.standard_error == pytest.approx(math.hypot(a.log_error, b.log_error), rel=1e-12)
    assert np.exp(a).relative_error == pytest.approx(a.log_error) and a - a == 0
    # log Z and Z are of one run.
    assert (a - a.relative.uncertain.log()).standard_error == 0


def test_one_seed_is_warned_of():
    a, b, c = (
        montelux.integrate(f, (0, 1), "quasi", evaluations=500, seed=s)
        for f, s in ((np.sin, 3), (np.exp, 3), (np.cos, 4))
    )
    with pytest.warns(PropagationWarning, match=r"runs with one seed \(3\)"):
        total = a + b
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert total.warnings == (total + c).warnings and "one seed" in total.warnings[0]  # said once
        a + c, a + a, a + Uncertain(1, 1)
        d, e = (montelux.integrate(np.exp, (0, 1), "cubature", absolute_error=1e-9) for _ in range(2))
        d + e  # no random numbers
    assert (total - b).warnings == total.warnings


def test_warnings_of_runs_come_along():
    r = montelux.integrate(lambda x: np.where(x < 0.5, np.nan, x), (0, 1), "basic", evaluations=1000)
    assert r.warnings and (2 * r).warnings == r.warnings


# What the first order hides.


@pytest.mark.parametrize(
    "compute, share",
    [
        (lambda x: 1 / x, 0.3),
        (lambda x: x / Uncertain(1, 0.2), 0.2),
        (lambda x: x**2, 0.15),
        (lambda x: x * x, 0.15),
        (lambda x: x.log(), 0.15),
        (lambda x: x.exp(), 0.15),
        (lambda x: 3**x, 0.15 * math.log(3)),
    ],
)
def test_curved_functions_are_warned_of(compute, share):
    with pytest.warns(PropagationWarning, match=f"second-order term is {100 * share:.2g} % of the first"):
        y = compute(Uncertain(1, 0.3))
    assert len(y.warnings) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compute_small = compute if share != 0.2 else lambda x: x / Uncertain(1, 0.02)
        assert compute_small(Uncertain(1, 0.03)).warnings == ()


def test_the_second_order_is_that_of_normal_variables():
    """The term that the warning compares, beside the bias of 1/x in 400000 draws; its error is 1.5 %."""
    x = 1 + 0.12 * np.random.default_rng(1).standard_normal(400_000)
    with pytest.warns(PropagationWarning, match="second-order term is 12 %"):
        y = 1 / Uncertain(1, 0.12)
    bias = (np.mean(1 / x) - 1) / y.standard_error
    assert bias == pytest.approx(0.12, rel=0.12)


def test_errors_that_vanish_are_warned_of():
    with pytest.warns(PropagationWarning, match="more than ten times"):
        assert (Uncertain(0, 0.1) ** 2).standard_error == 0
    with pytest.warns(PropagationWarning, match="more than ten times"):
        assert (Uncertain(0, 0.1) * Uncertain(0, 0.1)).standard_error == 0
    with pytest.warns(PropagationWarning, match="abs"):
        abs(Uncertain(0, 0.1))
    with pytest.warns(PropagationWarning, match="sqrt"):
        assert Uncertain(0, 0.1).sqrt().standard_error == math.inf


def test_what_cancels_is_not_warned_of():
    x = Uncertain(1, 0.3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert x / x == 1


def test_warnings_name_the_line_of_the_caller():
    with pytest.warns(PropagationWarning) as caught:
        1 / Uncertain(1, 0.5)
    assert caught[0].filename == __file__


def test_impossible_values_raise_what_numbers_raise():
    x = Uncertain(-1, 0.01)
    for compute in (x.log, x.sqrt, lambda: x**0.5):
        with pytest.raises(ValueError):
            compute()
    with pytest.raises(ZeroDivisionError):
        1 / Uncertain(0, 1)


# The type.


def test_equality_is_of_random_variables():
    a, b = Uncertain(1, 0.1), Uncertain(1, 0.1)
    assert a == a and a != b and a + b == b + a and a != 1 and Uncertain(1, 0) == 1 and a != "1"
    assert len({a, 1 * a, b}) == 2 and hash(Uncertain(1, 0)) == hash(1)


def test_there_is_no_order_and_no_truth():
    a, b = Uncertain(1, 0.1), Uncertain(2, 0.1)
    for compare in (lambda: a < b, lambda: a <= 1, lambda: a > b, lambda: 1 >= a, lambda: max(a, b)):
        with pytest.raises(TypeError, match=r"have no order.*z_score"):
            compare()
    with pytest.raises(TypeError, match="neither true nor false"):
        bool(a)
    r = montelux.integrate(np.sin, (0, 1))
    assert bool(r)
    with pytest.raises(TypeError, match="no order"):
        r < 1


def test_z_scores():
    a = Uncertain(1.3, 0.1)
    assert a.z_score(1) == pytest.approx(3) and a.z_score(a) == 0 and (a - a).z_score() == 0
    assert a.z_score(Uncertain(1, 0.1)) == pytest.approx(3 / math.sqrt(2))
    assert Uncertain(2, 0).z_score(1) == math.inf and Uncertain(2, 0).z_score(3) == -math.inf


def test_values_do_not_change():
    a = Uncertain(1, 0.1)
    with pytest.raises(AttributeError, match="value cannot be set"):
        a.value = 2
    with pytest.raises(montelux.UnknownAttribute, match="did you mean 'standard_error'"):
        a.sdev
    with pytest.raises(montelux.UnknownAttribute, match="did you mean 'value'"):
        a.mean
    b = a
    b += 1
    assert a.value == 1 and b == a + 1


@pytest.mark.parametrize("value, error", [("1", 0.1), (1, -0.1), (1, math.nan), (1, None)])
def test_errors_are_checked(value, error):
    with pytest.raises(montelux.Error, match="was given; expected"):
        Uncertain(value, error)


def test_correlated_constants():
    a, b = Uncertain.correlated([1, 2], [[4, 1], [1, 9]])
    assert (a.standard_error, b.standard_error, a.covariance(b)) == (2, 3, 1)
    assert (a - b).standard_error == pytest.approx(math.sqrt(11))
    for covariance, said in (
        ([[4, 1], [2, 9]], "not symmetric"),
        ([[1, 2], [2, 1]], "negative eigenvalue"),
        ([1, 2], "shapes"),
        ([[math.nan, 0], [0, 1]], "finite"),
        ([[-1, 0], [0, 1]], "negative variance"),
        ([[1e-20, 2], [2, 1e20]], "negative eigenvalue"),
    ):
        with pytest.raises(montelux.Error, match=said):
            Uncertain.correlated([1, 2], covariance)


def test_copies_and_pickles_are_the_same_variable(run):
    ratio = run[0] / run[2]
    for same in (copy.copy(ratio), copy.deepcopy(ratio), pickle.loads(pickle.dumps(ratio))):
        assert same == ratio and hash(same) == hash(ratio) and (same - ratio).standard_error == 0
        assert same.covariance(run[0]) == ratio.covariance(run[0])
    again = pickle.loads(pickle.dumps(run))
    assert again == run and again[0] / run[2] == ratio


# Text.


@pytest.mark.parametrize(
    "value, error, text, html, latex",
    [
        (0.49987, 0.0012, "0.4999(12)", "0.4999(12)", "$0.4999(12)$"),
        (
            -1.5e-20,
            2e-21,
            "-1.50(20)e-20",
            "&minus;1.50(20) &times; 10<sup>&minus;20</sup>",
            r"$-1.50(20) \times 10^{-20}$",
        ),
        (math.pi, 0, "3.1415926535897931(0)", "3.1415926535897931(0)", "$3.1415926535897931(0)$"),
        (1e300, 0, "1.0000000000000001e+300(0)", "1.0000000000000001(0) &times; 10<sup>300</sup>", None),
        (2, math.inf, "2(?)", "2(?)", "$2(?)$"),
        (math.inf, 1, "inf(?)", "inf(?)", r"$\infty(?)$"),
    ],
)
def test_values_as_text(value, error, text, html, latex):
    u = Uncertain(value, error)
    assert str(u) == repr(u) == f"{u}" == text and f"{u:.2e}" == f"{value:.2e}"
    assert u._repr_html_() == html
    assert latex is None or u._repr_latex_() == latex


def test_results_as_html_and_latex(run):
    page = run._repr_html_()
    assert page.count("<tr><td>") == 3 and f"<td>2</td><td>{run[2]}</td>" in page
    assert "20000 evaluations by basic" in page and run._repr_latex_().count(r",\;") == 2
    bad = montelux.integrate(lambda x: np.where(x < 0.5, np.nan, x), (0, 1), "basic", evaluations=1000)
    assert f"<b>{bad.uncertain}</b>" in bad._repr_html_() and "<b>warning: " in bad._repr_html_()
    assert bad._repr_latex_() == f"${bad.uncertain}$"
    assert dataclasses.replace(bad, _text="0(1)\n<i>\nwarning: <i>")._repr_html_().count("&lt;i&gt;") == 2
    wide = montelux.integrate(lambda x: np.repeat(x[:, :1], 60, axis=1), UNIT, "basic", evaluations=100)
    assert "and 10 more" in wide._repr_html_() and r"\dots" in wide._repr_latex_()
    log_z = montelux.integrate_log(lambda x: -x * x, (-9, 9), "quasi", evaluations=1000)
    assert f"<b>log Z = {log_z.uncertain}</b>" in log_z._repr_html_() and "log Z" in log_z._repr_latex_()
