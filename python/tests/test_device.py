"""integrate(..., device=): formulas and sources as texts, on the emulated device, and what is said where one cannot run."""

from __future__ import annotations

import ctypes
import shutil

import numpy as np
import pytest

import montelux

pytestmark = pytest.mark.skipif(shutil.which("c++") is None, reason="no C++ compiler")
SOURCE = """
double integrand(int n, const double *x) {
    double s = 0;
    for (int i = 0; i < n; ++i) s += x[i] * x[i];
    return s;
}
"""


def squares(x):
    total = np.zeros(len(x))
    for column in x.T:
        total += column * column
    return total


@pytest.mark.parametrize("method", ["basic", "quasi", "vegas", "vegas_sobol", "adaptive"])
def test_a_source_gives_the_bits_of_numpy(method):
    arguments = {"evaluations": 20_000, "seed": 5}
    here = montelux.integrate(squares, [(0, 1)] * 5, method, **arguments)
    there = montelux.integrate(SOURCE, [(0, 1)] * 5, method, device="emulated", **arguments)
    assert (there.value, there.standard_error) == (here.value, here.standard_error)
    assert there.evaluations == here.evaluations


def test_formulas_and_their_variables():
    one = montelux.integrate("3*x^2", (0, 1), "quasi", evaluations=4096, device="emulated")
    assert abs(one.value - 1) < 1e-3
    many = montelux.integrate("x1+x4", [(0, 1)] * 4, "quasi", evaluations=4096, device="emulated")
    assert abs(many.value - 1) < 1e-3
    two = montelux.integrate(["x*y", "z"], [(0, 1)] * 3, "quasi", evaluations=4096, device="emulated")
    np.testing.assert_allclose(two.value, [0.25, 0.5], atol=1e-3)
    assert two.covariance.shape == (2, 2)


def test_components_and_logarithms():
    moments = "void integrand(int, const double *x, int m, double *y) { for (int c = 0; c < m; ++c) y[c] = pow(x[0], c); }"
    r = montelux.integrate(moments, (0, 1), "quasi", evaluations=8192, components=3, device="emulated")
    np.testing.assert_allclose(r.value, [1, 1 / 2, 1 / 3], atol=1e-3)
    z = montelux.integrate_log("-5000-x^2/2", (-np.inf, np.inf), "quasi", evaluations=8192, device="emulated")
    assert abs(z.log_value + 4999.0810614) < 1e-3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (dict(f="x", device=None), "a text was given; expected a function, or device='cuda'"),
        (dict(f="x", device="gpu"), "there is no device 'gpu'; expected one of cuda, emulated"),
        (dict(f=np.sin, device="emulated"), "expected a formula, a list of formulas, or a source"),
        (dict(f="y", device="emulated"), "at character 1: there is no variable 'y'"),
        (dict(f=["x"], device="emulated"), "a list of one formula was given"),
        (dict(f=["x", "1"], components=3, device="emulated"), "components: 3 was given with 2 formulas"),
        (dict(f="x", workers=2, device="emulated"), "workers: it is for functions of Python, and the integrand is compiled"),
        (dict(f="double integrand(int n, double *x) { return a; }", device="emulated"), "was not declared"),
        (dict(f="x", method="auto", device="emulated"), "the method 'auto' does not run on a device; expected adaptive, vegas"),
    ],
)
def test_mistakes(arguments, message):
    arguments = {"method": "basic", "evaluations": 1000, **arguments}
    with pytest.raises(montelux.Error, match=message.replace("(", r"\(")):
        montelux.integrate(domain=(0, 1), **arguments)


def has_driver():
    try:
        ctypes.CDLL("libcuda.so.1")
    except OSError:
        return False
    return True


@pytest.mark.skipif(has_driver(), reason="a driver is installed")
def test_without_a_driver_there_is_a_sentence():
    with pytest.raises(montelux.Error, match="device 'cuda': there is no NVIDIA driver"):
        montelux.integrate("x", (0, 1), "basic", device="cuda")


@pytest.mark.parametrize("method", ["basic", "quasi", "vegas", "vegas_sobol", "adaptive"])
def test_a_gpu_agrees_with_numpy(method):
    try:
        montelux.integrate("x", (0, 1), "basic", evaluations=1000, device="cuda")
    except montelux.Error as error:
        if not any(what in str(error) for what in ("there is no NVIDIA driver", "shows no GPU", "is not installed")):
            raise  # what does not work on a machine that has it all is a failure
        pytest.skip(str(error))
    there = montelux.integrate(SOURCE, [(0, 1)] * 5, method, device="cuda", evaluations=2e6, seed=5)
    here = montelux.integrate(squares, [(0, 1)] * 5, method, evaluations=2e6, seed=5)
    assert abs(there.value - here.value) <= 1e-12 * here.value
    assert abs(there.standard_error - here.standard_error) <= 1e-6 * here.standard_error
    assert there.evaluations == here.evaluations
