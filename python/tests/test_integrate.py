"""integrate(): values and errors, arrays that are not copied, methods and their settings, mistakes."""

from __future__ import annotations

import gc
import json
import math
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import montelux
from montelux._core import call_integrand

NAMED = [name for name in montelux.METHODS if name not in ("importance", "multiple_importance", "control_variate")]


def sine_times_y(x):
    return np.sin(x[:, 0]) * x[:, 1]


BOX = [(0, math.pi / 2), (0, 1)]


@pytest.mark.parametrize("name", NAMED)
def test_every_method_finds_the_value(name):
    most = 200_000 if name == "metropolis" else 20_000
    r = montelux.integrate(sine_times_y, BOX, name, evaluations=most, seed=3)
    assert r.method in NAMED and 0 < r.evaluations <= most
    # Deterministic rules have no standard deviation; grids of this size are within a hundredth.
    tolerance = 6 * r.standard_error if r.statistical else 1e-2
    assert abs(r.value - 0.5) <= tolerance
    assert not r.statistical or 0 < r.standard_error < 0.02


def test_target_is_reached_and_told():
    r = montelux.integrate(sine_times_y, BOX, "adaptive", relative_error=1e-4, seed=1)
    assert r.converged and r.stop == "error_target" and r.relative_error <= 1e-4
    assert abs(float(r) - 0.5) < 6e-4
    assert r.covariance == pytest.approx(r.standard_error**2)


@pytest.mark.parametrize("dimensions", [1, 3])
def test_arrays_are_views_of_the_library_s_buffers(dimensions):
    seen = {}

    def f(x, y):
        seen["x"], seen["y"] = x.__array_interface__["data"][0], y.__array_interface__["data"][0]
        seen["shape"], seen["strides"], seen["writeable"] = x.shape, x.strides, x.flags.writeable

    _, points, values = call_integrand(f, 100, dimensions, 1, True)
    assert seen["x"] == points and seen["y"] == values
    assert seen["shape"] == ((100,) if dimensions == 1 else (100, 3)) and not seen["writeable"]
    assert seen["strides"] == ((8,) if dimensions == 1 else (8, 800))


def test_one_variable_has_shape_n():
    shapes = set()
    montelux.integrate(lambda x: shapes.add(x.ndim) or x, (0, 1), "basic", evaluations=5000)
    montelux.integrate(lambda x: shapes.add(x.ndim) or x, [(0, 1)], "basic", evaluations=5000)
    assert shapes == {1}


def test_vector_valued_integrands_have_covariances():
    def f(x):
        return np.stack([x[:, 0], 1 - x[:, 0], x[:, 1] ** 2], axis=-1)

    r = montelux.integrate(f, [(0, 1), (0, 1)], "basic", evaluations=50_000)
    assert r.value.shape == r.standard_error.shape == (3,) and r.covariance.shape == (3, 3)
    assert np.all(np.abs(r.value - [0.5, 0.5, 1 / 3]) <= 6 * r.standard_error)
    assert np.sqrt(np.diag(r.covariance)) == pytest.approx(r.standard_error)
    assert r.covariance[0, 1] == pytest.approx(-r.covariance[0, 0])  # x and 1 - x
    assert np.asarray(r).shape == (3,)
    with pytest.raises(TypeError, match="3 components"):
        float(r)
    without = montelux.integrate(f, [(0, 1), (0, 1)], "basic", evaluations=1000, covariance=False)
    assert without.covariance is None


def test_one_column_stays_a_vector():
    r = montelux.integrate(lambda x: x[:, :1], [(0, 1), (0, 1)], evaluations=1000)
    assert r.value.shape == (1,) and float(r) == r.value[0]


def test_writing_into_the_values_gives_the_same_bits():
    def into(x, y):
        np.multiply(np.sin(x[:, 0]), x[:, 1], out=y)

    a = montelux.integrate(sine_times_y, BOX, "vegas", evaluations=30_000)
    b = montelux.integrate(into, BOX, "vegas", evaluations=30_000, out=True)
    assert a.value == b.value and a.standard_error == b.standard_error

    def two(x, y):
        y[:, 0], y[:, 1] = x[:, 0], x[:, 1]

    c = montelux.integrate(two, [(0, 1), (0, 2)], "quasi", evaluations=5000, out=True, components=2)
    assert np.all(np.abs(c.value - [1, 2]) < 6 * c.standard_error)


def test_points_one_at_a_time_give_the_same_bits():
    a = montelux.integrate(lambda x: x**2, (0, 3), "quasi", evaluations=4000)
    b = montelux.integrate(lambda x: x**2, (0, 3), "quasi", evaluations=4000, batch=False)
    assert a.value == b.value
    c = montelux.integrate(lambda x: [x[0], x.sum()], [(0, 1), (0, 1)], "basic", evaluations=3000, batch=False)
    assert np.all(np.abs(c.value - [0.5, 1]) < 6 * c.standard_error)


def test_other_types_of_numbers_are_converted():
    for kind in (np.float32, np.int64, bool):
        r = montelux.integrate(lambda x: (x < 0.5).astype(kind), (0, 1), "quasi", evaluations=20_000)
        assert abs(r.value - 0.5) < 1e-3
    r = montelux.integrate(lambda x: list(x), (0, 1), "basic", evaluations=2000)
    assert abs(r.value - 0.5) < 6 * r.standard_error
    big = montelux.integrate(lambda x: x.astype(">f8"), (0, 1), "basic", evaluations=2000)
    assert big.value == r.value


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("name", ["quasi", "vegas"])
def test_threads_change_no_bit(name, threads):
    r = montelux.integrate(sine_times_y, BOX, name, evaluations=60_000, seed=5, threads=threads)
    one = montelux.integrate(sine_times_y, BOX, name, evaluations=60_000, seed=5)
    assert (r.value, r.standard_error) == (one.value, one.standard_error)


def test_seeds_change_the_value():
    a, b = (montelux.integrate(sine_times_y, BOX, "basic", evaluations=1000, seed=s) for s in (1, 2))
    assert a.value != b.value


def test_errors_are_calibrated():
    """Over 200 seeds the truth lies within two errors in about 95 %; fewer than 170 come once in 1e10."""
    within = 0
    for seed in range(200):
        r = montelux.integrate(sine_times_y, BOX, "basic", evaluations=2000, seed=seed, components=0)
        within += abs(r.value - 0.5) <= 2 * r.standard_error
    assert 170 <= within < 200


# Domains.


@pytest.mark.parametrize(
    "domain, volume",
    [
        (montelux.Domain.ball([0, 0, 0]), 4 / 3 * math.pi),
        (montelux.Domain.simplex(3), 1 / 6),
        (montelux.Domain.sphere([1, 2, 3], 2), 16 * math.pi),
        (montelux.Domain.product(montelux.Domain.ball([0, 0]), montelux.Domain.box([(0, 2)])), 2 * math.pi),
        ([(0, 2), (1, 4)], 6),
    ],
)
def test_volumes(domain, volume):
    r = montelux.integrate(lambda x: np.ones(len(x)), domain, "quasi", evaluations=5000)
    assert r.value == pytest.approx(volume, abs=6 * r.standard_error + 1e-9)


def test_infinite_ranges():
    r = montelux.integrate(lambda x: np.exp(-x * x), (-math.inf, math.inf), relative_error=1e-8)
    assert float(r) == pytest.approx(math.sqrt(math.pi), rel=1e-8)
    r = montelux.integrate(lambda x: np.exp(-x), (0, math.inf), relative_error=1e-8)
    assert float(r) == pytest.approx(1, rel=1e-8)


def test_maps_of_your_own():
    def polar(u):
        radius, angle = np.sqrt(u[:, 0]), 2 * math.pi * u[:, 1]
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1), np.full(len(u), math.pi)

    disk = montelux.Domain.mapped(2, 2, polar, "disk")
    r = montelux.integrate(lambda x: x[:, 0] ** 2, disk, "quasi", evaluations=20_000)
    assert float(r) == pytest.approx(math.pi / 4, abs=6 * r.standard_error)
    with pytest.raises(montelux.Error, match="expected two arrays"):
        montelux.integrate(lambda x: x, montelux.Domain.mapped(1, 1, lambda u: u))


# Densities and controls.


def test_importance_sampling():
    p = montelux.Distribution.exponential(5)
    f = lambda x: np.exp(-5 * x) * np.cos(x)  # noqa: E731
    for points in ("random", "sobol"):
        r = montelux.integrate(f, (0, math.inf), montelux.Importance(p, points=points), evaluations=20_000)
        assert abs(r.value - 5 / 26) <= 6 * r.standard_error < 1e-2
    named = montelux.integrate(f, (0, math.inf), "importance", technique=p, evaluations=20_000)
    assert abs(named.value - 5 / 26) <= 6 * named.standard_error


def test_techniques_from_functions_and_multiple_importance():
    tilted = montelux.Technique.functions(2, 2, lambda u: np.sqrt(u), lambda x: 4 * x[:, 0] * x[:, 1])
    flat = montelux.Technique.uniform(montelux.Domain.unit_cube(2))
    for weights in ("balance", "power", "cutoff", "maximum", "optimal"):
        method = montelux.MultipleImportance([(tilted, 3), flat], weights=weights)
        r = montelux.integrate(lambda x: x[:, 0] * x[:, 1] + 1, [(0, 1), (0, 1)], method, evaluations=20_000)
        assert abs(r.value - 1.25) <= 6 * r.standard_error + 1e-9
    with pytest.raises(montelux.Error, match=r"did you mean 'balance'"):
        montelux.MultipleImportance([flat], weights="balanc")


def test_control_variates():
    r = montelux.integrate(
        lambda x: np.exp(x), (0, 1), montelux.ControlVariate(lambda x: x, [0.5]), evaluations=10_000
    )
    plain = montelux.integrate(lambda x: np.exp(x), (0, 1), "basic", evaluations=10_000)
    assert abs(r.value - (math.e - 1)) <= 6 * r.standard_error < plain.standard_error


def test_a_trained_map_is_kept_and_used(tmp_path):
    def peak(x):
        return np.exp(-((x - 0.3) ** 2).sum(axis=1) * 2000)

    montelux.train_map(peak, [(0, 1), (0, 1)], 50_000).save(str(tmp_path / "peak.map"))
    learned = montelux.AdaptiveMap.load(str(tmp_path / "peak.map"))
    assert learned.dimensions == 2 and learned.edges(0)[[0, -1]] == pytest.approx([0, 1])
    r = montelux.integrate(
        peak, [(0, 1), (0, 1)], "vegas", training_iterations=0, map=learned, evaluations=5000
    )
    assert r.standard_error < 0.02 * r.value and r.value == pytest.approx(math.pi / 2000, rel=0.1)


# Results.


def test_results_print_and_convert():
    r = montelux.integrate(sine_times_y, BOX, "quasi", evaluations=20_000, seed=1)
    first, second = str(r).splitlines()
    assert repr(r) == str(r) and first.startswith("0.") and first.endswith(")")
    assert "evaluations by quasi, stopped at the number of evaluations" in second
    assert float(r) == r.value and isinstance(r.value, float)
    steps = r.history
    assert steps.evaluations[-1] == r.evaluations and steps.value[-1] == r.value
    assert np.all(np.diff(steps.evaluations.astype(float)) > 0)
    d = json.loads(json.dumps(r.to_dict()))
    assert d["value"] == r.value and d["method"] == "quasi" and d["converged"] is False
    assert d["history"]["value"][-1] == r.value


def test_results_format_compare_and_hash():
    r, again = (montelux.integrate(sine_times_y, BOX, "quasi", evaluations=1000) for _ in range(2))
    assert f"{r:.3f}" == f"{r.value:.3f}" and f"{r}" == str(r)
    assert r == r and r != again and len({r, again}) == 2  # arrays inside are not compared
    with pytest.raises(AttributeError, match=r"no attribute of Result 'valu' \(did you mean 'value'\?\)"):
        r.valu


@pytest.mark.skipif(sys.version_info < (3, 11), reason="exceptions have no notes")
def test_functions_of_one_point_are_told_about_batches():
    for f in (math.sin, lambda x, y: x):
        with pytest.raises(TypeError) as caught:
            montelux.integrate(f, (0, 1))
        assert "batch=False calls it with one point at a time" in caught.value.__notes__[0]


def test_unknown_errors_are_null_in_json():
    r = montelux.integrate(sine_times_y, BOX, "quasi", randomisation="none", evaluations=1000)
    assert r.standard_error == math.inf and r.to_dict()["standard_error"] is None


def test_progress_is_told():
    seen = []
    montelux.integrate(sine_times_y, BOX, "quasi", evaluations=50_000, progress=seen.append)
    assert len(seen) > 3 and all(isinstance(r, montelux.Result) for r in seen)
    assert [r.evaluations for r in seen] == sorted(r.evaluations for r in seen)


def test_progress_line(capsys):
    montelux.integrate(sine_times_y, BOX, "quasi", evaluations=5000, progress=True)
    assert capsys.readouterr().out == ""


def test_time_limit():
    begin = time.monotonic()
    r = montelux.integrate(sine_times_y, BOX, "basic", seconds=0.2)
    assert r.stop == "time" and time.monotonic() - begin < 2


def test_checkpoints_go_on_to_the_same_bits(tmp_path):
    f = lambda x: np.exp(-x[:, 0]) * x[:, 1]  # noqa: E731
    whole = montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=2)
    state = tmp_path / "run.state"
    montelux.integrate(f, BOX, "quasi", absolute_error=1e-4, seed=2, checkpoint=state)
    resumed = montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=2, checkpoint=state, resume=True)
    assert (resumed.value, resumed.standard_error) == (whole.value, whole.standard_error)
    with pytest.raises(montelux.Error, match="another integrand"):
        montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=3, checkpoint=state, resume=True)


# Settings.


def test_settings_as_arguments_and_as_objects():
    a = montelux.integrate(sine_times_y, BOX, "vegas", alpha=0.5, increments=64, evaluations=20_000)
    settings = montelux.Vegas(alpha=0.5)
    settings.increments = 64
    b = montelux.integrate(sine_times_y, BOX, settings, evaluations=20_000)
    c = montelux.integrate(sine_times_y, BOX, "vegas", evaluations=20_000)
    assert a.value == b.value != c.value


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
        ({"seconds": 0}, "expected a time above zero"),
        ({"seconds": "1s"}, "'1s' was given; expected a time above zero"),
        ({"threads": 100_000}, "threads: 100000 was given; expected a whole number from 0 to 4096"),
        ({"threads": 1.5}, "expected a whole number from 0 to 4096"),
        ({"components": -1}, "expected a whole number that is not negative"),
        ({"progress": 3}, "expected True, False or a function"),
        ({"seed": -1}, "expected a whole number in"),
        ({"non_finite": "ignore"}, "there is no choice 'ignore'"),
        ({"method": "vegas", "points": "sobol", "replicates": 1}, "replicates"),
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
        (lambda x: ["a"] * len(x), "not all numbers"),
        (lambda x: np.array([object()] * len(x)), "not all numbers"),
    ],
)
def test_wrong_returns_are_answered(f, sentence):
    with pytest.raises(montelux.Error, match="integrand: .*" + sentence):
        montelux.integrate(f, [(0, 1), (0, 1)], evaluations=1000)
    with pytest.raises(montelux.Error, match="integrand: "):  # without the look ahead
        montelux.integrate(f, [(0, 1), (0, 1)], evaluations=1000, components=0)


def test_a_shape_that_changes_is_answered():
    calls = []

    def f(x):
        calls.append(1)
        return x if len(calls) < 3 else np.ones((len(x), 2))

    with pytest.raises(montelux.Error, match=r"expected shape \(\d+,\)"):
        montelux.integrate(f, (0, 1), "basic", evaluations=100_000)


def test_values_that_are_not_finite_are_counted_and_doubted():
    with np.errstate(all="ignore"):
        r = montelux.integrate(
            lambda x: np.where(x < 0.01, np.nan, 1.0), (0, 1), "basic", evaluations=10_000, seed=1
        )
        assert 0 < r.non_finite < 300 and r.first_non_finite_point[0] < 0.01
        assert "were not finite" in r.doubts[0] and not r.converged
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
    import weakref

    alive = weakref.ref(f)
    montelux.integrate(f, (0, 1), evaluations=1000)
    del f
    gc.collect()
    assert alive() is None


# The interpreter's lock and signals.


def test_other_threads_go_on_meanwhile():
    done = threading.Event()
    counted = []

    def count():
        while not done.is_set():
            counted.append(1)
            time.sleep(0.001)

    def slow(x):
        time.sleep(0.005)
        return x

    thread = threading.Thread(target=count)
    thread.start()
    before = len(counted)
    montelux.integrate(slow, (0, 1), "basic", seconds=0.3, threads=2)
    after = len(counted)
    done.set()
    thread.join()
    assert after - before > 20


INTERRUPTED = """
import os, signal, sys, threading, time
import numpy as np, montelux
def soon():
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=soon, daemon=True).start()
begin = time.monotonic()
try:
    montelux.integrate({f}, (0, 1), "basic", seconds=30, threads={threads}, components=0)
except KeyboardInterrupt:
    print("interrupted after", time.monotonic() - begin)
    sys.exit(0 if time.monotonic() - begin < 10 else 3)
sys.exit(4)
"""


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("f", ["np.sin", "lambda x: x * x"])
def test_ctrl_c_stops_an_integration(f, threads):
    code = INTERRUPTED.format(f=f, threads=threads)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "interrupted after" in done.stdout, done.stderr


# The program.


def test_the_program_gives_the_same_bits():
    program = os.environ.get("MONTELUX_PROGRAM", "")
    if not os.access(program, os.X_OK):
        pytest.skip("MONTELUX_PROGRAM names no program")
    for method in ("vegas", "quasi", "adaptive", "cubature"):
        text = subprocess.run(
            [program, "integrate", "x*x*y+1", "--over", "x=0:2", "--over", "y=0:1", "--method", method]
            + ["--evaluations", "20000", "--seed", "7", "--json", "--quiet"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        expected = json.loads(text)
        r = montelux.integrate(
            lambda x: x[:, 0] * x[:, 0] * x[:, 1] + 1, [(0, 2), (0, 1)], method, evaluations=20_000, seed=7
        )
        assert (r.value, r.standard_error) == (expected["value"], expected["standard_error"])
