"""integrate() of functions in machine code: ctypes, numba's cfuncs and scipy.LowLevelCallable."""

from __future__ import annotations

import ctypes
import ctypes.util
import itertools
import math
import threading

import numpy as np
import pytest

import montelux
from montelux._core import call_integrand
from montelux._c_functions import c_function

Pointer = ctypes.POINTER(ctypes.c_double)
OfNumber = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
OfNumberWithData = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_void_p)
OfPoint = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int, Pointer)
OfPointWithData = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int, Pointer, ctypes.c_void_p)
OfPoints = ctypes.CFUNCTYPE(None, ctypes.c_int, ctypes.c_int, Pointer, Pointer)

BOX = [(0, 1), (0, 2)]


def value(x):
    return math.sin(x[0]) * x[1]


class LowLevelCallable(tuple):
    """As of SciPy: (capsule, function, user data)."""

    def __new__(cls, function, signature, user_data=None):
        new = ctypes.pythonapi.PyCapsule_New
        new.restype, new.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
        put = ctypes.pythonapi.PyCapsule_SetContext
        put.argtypes = [ctypes.py_object, ctypes.c_void_p]
        name = signature and signature.encode()
        capsule = new(ctypes.cast(function, ctypes.c_void_p).value, name, None)
        put(capsule, user_data)
        self = super().__new__(cls, (capsule, function, user_data))
        self.kept = name
        return self

    signature = property(lambda self: (self.kept or b"").decode())
    user_data = property(lambda self: tuple.__getitem__(self, 2))

    def __getitem__(self, _):
        raise ValueError("as of SciPy")


def sine():
    f = ctypes.CDLL(ctypes.util.find_library("m")).sin
    f.argtypes, f.restype = [ctypes.c_double], ctypes.c_double
    return f


def expected(**named):
    return montelux.integrate(value, BOX, "vegas", evaluations=3000, seed=2, batch=False, **named)


def test_a_function_of_the_library_of_c():
    c = montelux.integrate(sine(), (0, 1), "quasi", evaluations=5000)
    python = montelux.integrate(math.sin, (0, 1), "quasi", evaluations=5000, batch=False)
    assert (c.value, c.standard_error) == (python.value, python.standard_error)


@pytest.mark.parametrize(
    "f",
    [
        OfPoint(lambda n, x: value(x[:n])),
        OfPointWithData(lambda n, x, data: math.nan if data else value(x[:n])),
        LowLevelCallable(OfPoint(lambda n, x: value(x[:n])), "double (int, double *)"),
        LowLevelCallable(OfPoint(lambda n, x: value(x[:n])), "double(int,const double*)"),
    ],
)
def test_the_bits_are_those_of_python(f):
    r = montelux.integrate(f, BOX, "vegas", evaluations=3000, seed=2)
    assert (r.value, r.standard_error) == (expected().value, expected().standard_error)


def test_user_data():
    data = ctypes.c_double(3)
    of_point = OfPointWithData(lambda n, x, p: ctypes.cast(p, Pointer)[0] * x[0])
    f = LowLevelCallable(of_point, "double (int, double *, void *)", ctypes.addressof(data))
    assert montelux.integrate(f, BOX, "cubature", evaluations=500).value == pytest.approx(3, rel=1e-12)
    of_number = OfNumberWithData(lambda x, p: ctypes.cast(p, Pointer)[0] * x)
    f = LowLevelCallable(of_number, "double (double, void *)", ctypes.addressof(data))
    assert montelux.integrate(f, (0, 1), "cubature", evaluations=500).value == pytest.approx(1.5, rel=1e-12)


def batch(n, d, x, y):
    x, y = np.ctypeslib.as_array(x, (d, n)), np.ctypeslib.as_array(y, (n,))
    y[:] = [value(point) for point in x.T.tolist()]


def test_many_points_at_once():
    r = montelux.integrate(OfPoints(batch), BOX, "vegas", evaluations=3000, seed=2)
    assert (r.value, r.standard_error) == (expected().value, expected().standard_error)


def test_several_components():
    def two(n, d, x, y):
        x, y = np.ctypeslib.as_array(x, (d, n)), np.ctypeslib.as_array(y, (2, n))
        y[:] = x[0], x[0] * x[1]

    r = montelux.integrate(OfPoints(two), BOX, "basic", evaluations=2000, seed=2, components=2)
    q = montelux.integrate(
        lambda x: np.stack([x[:, 0], x[:, 0] * x[:, 1]], axis=-1), BOX, "basic", evaluations=2000, seed=2
    )
    assert np.array_equal(r.value, q.value) and np.array_equal(r.covariance, q.covariance)


def test_functions_may_change_their_point():
    def f(n, x):
        x[0] = 100 * x[0]
        return x[0]

    r = montelux.integrate(OfPoint(f), BOX, "vegas", evaluations=3000, seed=2)
    q = montelux.integrate(lambda x: 100 * x[:, 0], BOX, "vegas", evaluations=3000, seed=2)
    assert r.value == q.value


def test_threads_and_logarithms_and_maps():
    f = OfPoint(lambda n, x: -value(x))
    runs = [montelux.integrate_log(f, BOX, evaluations=3000, threads=t) for t in (1, 2)]
    assert (runs[0].log_value, runs[0].log_error) == (runs[1].log_value, runs[1].log_error)
    bumpy = OfPoint(lambda n, x: math.exp(-50 * (x[0] - 0.3) ** 2))
    maps = [montelux.train_map(g, BOX, 4000) for g in (bumpy, lambda x: np.exp(-50 * (x[:, 0] - 0.3) ** 2))]
    runs = [montelux.integrate(f, BOX, montelux.Vegas(map=m), evaluations=2000) for m in maps]
    assert runs[0].value == pytest.approx(runs[1].value, rel=1e-9)


def test_threads_call_at_the_same_time():
    seen, both, calls = set(), threading.Event(), itertools.count()

    def f(x):
        seen.add(threading.get_ident())
        if len(seen) == 2:
            both.set()
        if next(calls) % 1000 == 999:  # on a busy machine the second thread starts late, and small steps take one alone
            both.wait(timeout=0.5)
        return x

    montelux.integrate(OfNumber(f), (0, 1), "basic", evaluations=50_000, threads=2)
    assert both.is_set()


def test_many_dimensions():
    f = OfPoint(lambda n, x: sum(x[:n]))
    r = montelux.integrate(f, [(0, 1)] * 30, "basic", evaluations=2000)
    assert abs(r.value - 15) < 6 * r.standard_error


EXPECTED = r"expected double \(double\), double \(double, void \*\), double \(int, double \*\), .* or void \(int, int"


@pytest.mark.parametrize(
    "f, sentence",
    [
        (ctypes.CFUNCTYPE(ctypes.c_float, ctypes.c_float)(abs), r"signature 'float \(float\)' was given; " + EXPECTED),
        (ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_long, Pointer)(pow), r"'double \(long, double \*\)' was given"),
        (ctypes.CFUNCTYPE(ctypes.c_double)(dict), r"'double \(\)' was given"),
        (ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_char_p)(len), r"'double \(c_char_p\)' was given"),
        (ctypes.CDLL(None).abs, r"types of a ctypes function were not declared; set f.argtypes"),
        (LowLevelCallable(sine(), "int (int)"), r"'int \(int\)' was given"),
        (LowLevelCallable(sine(), None), r"signature '' was given"),
        (LowLevelCallable(sine(), "double (double)", 8), r"user data was given.*takes none; expected a void \* last"),
        (type("Other", (tuple,), {"signature": "", "user_data": 0})((3,)), "type 'int' was found in a LowLevel"),
        ((), "an object of type 'tuple' was given; expected a function, a numba cfunc"),
        (3, "an object of type 'int' was given; expected a function, a numba cfunc"),
    ],
)
def test_other_signatures_are_answered(f, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(f, (0, 1))


def test_functions_that_need_the_interpreter_are_answered():
    f = ctypes.pythonapi.PyFloat_GetMax
    f.argtypes, f.restype = [ctypes.c_double], ctypes.c_double
    with pytest.raises(montelux.Error, match="a function of ctypes.pythonapi"):
        montelux.integrate(f, (0, 1))


@pytest.mark.parametrize(
    "options, sentence",
    [
        ({"batch": False}, "batch: it is for functions of Python"),
        ({"out": True}, "out: it is for functions of Python"),
        ({"array": np.asarray}, "array: it is for functions of Python"),
        ({"workers": 2}, "workers: it is for functions of Python.*threads=N"),
        ({"components": 2}, r"components=2 was given for a C function that returns one number; expected the form void"),
    ],
)
def test_options_that_do_nothing_are_answered(options, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(OfPoint(lambda n, x: 1), BOX, **options)


def test_wrong_dimensions_are_answered():
    sentence = r"C function of one number was given for a domain of 2 variables; expected double \(int, double \*\)"
    for f in (sine(), LowLevelCallable(sine(), "double (double)")):
        with pytest.raises(montelux.Error, match=sentence):
            montelux.integrate(f, BOX)


def test_a_call_takes_below_20_nanoseconds():
    f = c_function(sine(), 1)
    seconds = min(call_integrand(f, 1000, 1, 20)[0] for _ in range(50))
    assert seconds / 1000 < 40e-9  # with the sine itself


# numba and SciPy.


def test_numba():
    numba = pytest.importorskip("numba", reason="numba is not installed")
    types = numba.types
    double, pointer = types.double, types.CPointer(types.double)

    @numba.cfunc(double(types.intc, pointer))
    def of_point(n, x):
        return math.sin(x[0]) * x[1]

    @numba.cfunc(types.void(types.intc, types.intc, pointer, pointer))
    def of_points(n, d, x, y):
        point, values = numba.carray(x, (d, n)), numba.carray(y, (n,))
        for i in range(n):
            values[i] = math.sin(point[0, i]) * point[1, i]

    @numba.cfunc(double(double))
    def square(x):
        return x * x

    @numba.cfunc(double(types.int64, pointer))
    def wrong(n, x):
        return x[0]

    for f in (of_point, of_points):
        runs = [montelux.integrate(f, BOX, "vegas", evaluations=3000, seed=2, threads=t) for t in (1, 2)]
        assert runs[0].value == runs[1].value == pytest.approx(expected().value, rel=1e-14)
    assert montelux.integrate(square, (0, 3)).value == pytest.approx(9, rel=1e-12)
    with pytest.raises(montelux.Error, match=r"'double \(long, double \*\)' was given; expected"):
        montelux.integrate(wrong, BOX)
    seconds = min(call_integrand(c_function(of_point, 2), 1000, 2, 20)[0] for _ in range(50))
    assert seconds / 1000 < 40e-9  # with the sine


def test_scipy():
    scipy = pytest.importorskip("scipy", reason="SciPy is not installed")
    of_point = OfPoint(lambda n, x: value(x[:n]))
    r = montelux.integrate(scipy.LowLevelCallable(of_point), BOX, "vegas", evaluations=3000, seed=2)
    assert (r.value, r.standard_error) == (expected().value, expected().standard_error)
    data = ctypes.c_double(3)
    with_data = OfPointWithData(lambda n, x, p: ctypes.cast(p, Pointer)[0] * x[0])
    f = scipy.LowLevelCallable(with_data, ctypes.cast(ctypes.pointer(data), ctypes.c_void_p))
    assert montelux.integrate(f, BOX, "cubature", evaluations=500).value == pytest.approx(3, rel=1e-12)
