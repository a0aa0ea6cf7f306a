"""integrate_log(): log Z with its error, for integrals outside the range of floats."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import montelux

LINE = (-np.inf, np.inf)
GAUSSIAN = 0.5 * math.log(2 * math.pi)  # log of the integral of exp(-x^2 / 2)


@pytest.mark.parametrize("height", [-5000.0, 0.0, 5000.0])
@pytest.mark.parametrize("method, error", [("auto", 1e-8), ("vegas", 1e-2), ("quasi", 1e-3)])
def test_gaussians_of_any_height(height, method, error):
    r = montelux.integrate_log(lambda x: height - x**2 / 2, LINE, method, relative_error=error, seed=2)
    assert r.converged and r.stop == "error_target" and 0 < r.log_error <= error
    assert abs(r.log_value - (height + GAUSSIAN)) < 5 * r.log_error + 1e-15 * abs(height)
    assert float(r) == r.log_value and f"{r:.1f}" == f"{height + GAUSSIAN:.1f}"
    # Relative values and their reference are another way to say the same.
    assert math.log(float(r.relative)) + r.log_reference == pytest.approx(r.log_value, abs=1e-12 * (1 + abs(height)))
    assert r.log_error == pytest.approx(r.relative.relative_error)


def test_text_and_dictionary():
    r = montelux.integrate_log(lambda x: -5000 - x**2 / 2, LINE, relative_error=1e-6)
    first, second = str(r).splitlines()[:2]
    assert first.startswith("log Z = -4999.0810614") and first.endswith(")")
    assert second == f"{r.evaluations} evaluations by {r.method} ({r.relative.reason}), error target reached"
    d = json.loads(json.dumps(r.to_dict()))
    assert d["log_value"] == r.log_value and d["log_error"] == r.log_error and d["converged"] is True
    assert d["relative"]["evaluations"] == r.evaluations


def test_points_where_f_is_zero():
    def half(x):
        return np.where(x < 0, -np.inf, -x - 2000)

    r = montelux.integrate_log(half, (-1, 30), "adaptive", relative_error=1e-3)
    assert abs(r.log_value + 2000) < 5 * r.log_error
    nothing = montelux.integrate_log(lambda x: np.full(len(x), -np.inf), (0, 1), evaluations=1000)
    assert nothing.log_value == -np.inf and not nothing.converged and nothing.to_dict()["log_value"] is None


def test_one_point_at_a_time_and_in_place():
    one = montelux.integrate_log(lambda x: -900 - x**2 / 2, LINE, batch=False, evaluations=500)

    def fill(x, y):
        y[:] = -900 - x**2 / 2

    two = montelux.integrate_log(fill, LINE, out=True, evaluations=500)
    assert one.log_value == pytest.approx(-900 + GAUSSIAN, abs=1e-6) and two.log_value == pytest.approx(one.log_value)


def test_progress_and_threads(capfd):
    def f(x):
        return -700 - np.sum(x**2, axis=1)

    seen = []
    one = montelux.integrate_log(f, [LINE, LINE], "basic", evaluations=50_000, progress=seen.append)
    two = montelux.integrate_log(f, [LINE, LINE], "basic", evaluations=50_000, threads=2, progress=True)
    assert one.log_value == two.log_value and one.log_error == two.log_error
    assert seen and seen[-1].evaluations == one.evaluations


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"absolute_error": 1}, "expected relative_error, which is the error of log Z"),
        ({"epsrel": 1}, r"no setting 'epsrel' \(did you mean 'relative_error'\?\); expected one of array, batch, checkpoint"),
        ({"method": "vegs"}, r"no method 'vegs' \(did you mean 'vegas'"),
    ],
)
def test_wrong_arguments_are_answered(arguments, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate_log(lambda x: -x, (0, 1), **arguments)


def test_mistakes():
    with pytest.raises(montelux.Error, match="expected one component, got 2"):
        montelux.integrate_log(lambda x: np.stack([x, x], axis=-1), (0, 1))
    r = montelux.integrate_log(lambda x: -x, (0, 1))
    with pytest.raises(AttributeError, match=r"no attribute of LogResult 'mean' \(did you mean 'log_value'\?\)"):
        r.mean
    with pytest.raises(AttributeError, match=r"no attribute of LogResult 'standard_error' \(did you mean 'log_error'\?\)"):
        r.standard_error
