"""integrate(): values and errors, arrays that are not copied, methods and their settings, checkpoints."""

from __future__ import annotations

import json
import math
import sys
import time

import numpy as np
import pytest

import montelux
from montelux._core import call_integrand

REQUIRE_SETTINGS = ("importance", "multiple_importance", "control_variate", "trained")
NAMED = [name for name in montelux.METHODS if name not in REQUIRE_SETTINGS]


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


def test_target_is_reached_and_reported():
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


@pytest.mark.parametrize("name", ["basic", "vegas", "quasi", "cubature", "adaptive"])
def test_slow_functions_that_release_the_lock_run_at_the_same_time(name):
    running, most, calls, waits = 0, 0, 0, 0

    def f(x):
        nonlocal running, most, calls, waits
        running += 1
        calls += 1
        most = max(most, running)
        time.sleep(1e-4)  # without the lock
        end = time.monotonic() + 0.5
        while calls > 300 and most < threads and waits < 20 and time.monotonic() < end:
            time.sleep(1e-3)  # on a busy machine the second thread comes late
        waits += calls > 300 and most < threads
        running -= 1
        return abs(x[0] - 0.3) * (1 + x[1])

    results = []
    for threads in (1, 2):
        running = most = calls = waits = 0
        results.append(montelux.integrate(f, BOX, name, evaluations=2500, threads=threads, batch=False))
        assert most == threads
    assert results[0].value == results[1].value and results[0].standard_error == results[1].standard_error


def test_balls_about_the_origin_by_their_dimensions():
    ball = montelux.integrate(lambda x: np.ones(len(x)), montelux.Domain.ball(3), "quasi", evaluations=4096)
    assert float(ball) == pytest.approx(4 / 3 * math.pi, rel=1e-12)
    sphere = montelux.integrate(lambda x: np.ones(len(x)), montelux.Domain.sphere(np.int64(2), 3), evaluations=100)
    assert float(sphere) == pytest.approx(6 * math.pi, rel=1e-12)
    x, _ = montelux.Domain.ball(2).map(np.random.default_rng(1).random((50, 2)))
    y, _ = montelux.Domain.ball((0, 0)).map(np.random.default_rng(1).random((50, 2)))
    assert np.array_equal(x, y)


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
    both = montelux.Domain.product(disk, montelux.Domain.mapped(1, 1, lambda u: (u**2, 2 * u), "square"))
    r = montelux.integrate(lambda x: x[:, 2], both, "quasi", evaluations=20_000)
    assert float(r) == pytest.approx(math.pi / 2, abs=6 * r.standard_error)


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
    r = montelux.integrate(lambda x: np.exp(x), (0, 1), montelux.ControlVariate(lambda x: x, [0.5]), evaluations=10_000)
    plain = montelux.integrate(lambda x: np.exp(x), (0, 1), "basic", evaluations=10_000)
    assert abs(r.value - (math.e - 1)) <= 6 * r.standard_error < plain.standard_error


def test_a_trained_map_is_kept_and_used(tmp_path):
    def peak(x):
        return np.exp(-((x - 0.3) ** 2).sum(axis=1) * 2000)

    montelux.train_map(peak, [(0, 1), (0, 1)], 50_000).save(str(tmp_path / "peak.map"))
    learned = montelux.AdaptiveMap.load(str(tmp_path / "peak.map"))
    assert learned.dimensions == 2 and learned.edges(0)[[0, -1]] == pytest.approx([0, 1])
    r = montelux.integrate(peak, [(0, 1), (0, 1)], "vegas", training_iterations=0, map=learned, evaluations=5000)
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
def test_functions_of_one_point_get_a_hint_about_batches():
    for f in (math.sin, lambda x, y: x):
        with pytest.raises(TypeError) as caught:
            montelux.integrate(f, (0, 1))
        assert "batch=False calls it with one point at a time" in caught.value.__notes__[0]


def test_unknown_errors_are_null_in_json():
    r = montelux.integrate(sine_times_y, BOX, "quasi", randomisation="none", evaluations=1000)
    assert r.standard_error == math.inf and r.to_dict()["standard_error"] is None


def test_progress_is_reported():
    seen = []
    montelux.integrate(sine_times_y, BOX, "quasi", evaluations=50_000, progress=seen.append)
    assert len(seen) > 3 and all(isinstance(r, montelux.Result) for r in seen)
    assert [r.evaluations for r in seen] == sorted(r.evaluations for r in seen)


def test_progress_stops_the_run_by_returning_false():
    seen = []

    def three(r):
        seen.append(r)
        return len(seen) < 3

    for workers in (1, 2):
        seen.clear()
        r = montelux.integrate(sine_times_y, BOX, "basic", time=60, progress=three, workers=workers)
        assert r.stop == "interrupted" and not r.converged and len(seen) == 3
        assert r.value == seen[-1].value and r.evaluations >= seen[-1].evaluations
    for ignored in (None, 0, np.False_, ""):
        r = montelux.integrate(sine_times_y, BOX, "quasi", evaluations=5000, progress=lambda r, i=ignored: i)
        assert r.stop == "evaluations"
    log = montelux.integrate_log(lambda x: -x * x, (-9, 9), "basic", time=60, progress=lambda r: False)
    assert log.stop == "interrupted" and log.log_value == pytest.approx(math.log(math.pi) / 2, abs=0.5)
    with pytest.raises(ZeroDivisionError):
        montelux.integrate(sine_times_y, BOX, "quasi", evaluations=5000, progress=lambda r: 1 / 0)


def test_progress_line(capsys):
    montelux.integrate(sine_times_y, BOX, "quasi", evaluations=5000, progress=True)
    assert capsys.readouterr().out == ""


def test_time_limit():
    begin = time.monotonic()
    r = montelux.integrate(sine_times_y, BOX, "basic", time=0.2)
    assert r.stop == "time" and time.monotonic() - begin < 2


def test_resumed_runs_have_the_same_bits(tmp_path):
    f = lambda x: np.exp(-x[:, 0]) * x[:, 1]  # noqa: E731
    whole = montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=2)
    state = tmp_path / "run.state"
    montelux.integrate(f, BOX, "quasi", absolute_error=1e-4, seed=2, checkpoint=state)
    resumed = montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=2, checkpoint=state, resume=True)
    assert (resumed.value, resumed.standard_error) == (whole.value, whole.standard_error)
    with pytest.raises(montelux.Error, match="another integrand"):
        montelux.integrate(f, BOX, "quasi", absolute_error=2e-6, seed=3, checkpoint=state, resume=True)


def test_a_checkpoint_is_not_overwritten(tmp_path):
    state = tmp_path / "run.state"

    def run(**named):
        return montelux.integrate(sine_times_y, BOX, "quasi", seed=2, checkpoint=state, **named)

    run(evaluations=5000)
    before = state.read_bytes()
    with pytest.raises(montelux.Error, match="run.state"):
        run(evaluations=5000)
    assert state.read_bytes() == before
    assert run(evaluations=50_000, resume=True).evaluations > 5000


def test_relative_errors_of_the_vector():
    """A component that is small beside the others needs no relative error of its own."""

    def f(x):
        return np.stack([1 + x[:, 0], 1e-3 * np.sin(2 * math.pi * x[:, 1])], axis=-1)

    r = montelux.integrate(f, [(0, 1), (0, 1)], "basic", relative_error=1e-3, norm="vector")
    assert r.converged and np.all(r.standard_error <= 1e-3 * np.linalg.norm(r.value))
    assert isinstance(r.notes, tuple)


def test_notes_say_how_a_result_was_judged():
    """The second component is zero within its error, which has no relative size."""

    def f(x):
        return np.stack([1 + x[:, 0], x[:, 1] - 0.5], axis=-1)

    r = montelux.integrate(f, [(0, 1), (0, 1)], "basic", relative_error=1e-2)
    assert any("component" in note for note in r.notes) and r.to_dict()["notes"] == list(r.notes)
    assert all(note in str(r) and note in r._repr_html_() for note in r.notes)
    log = montelux.integrate_log(lambda x: -x * x, (-9, 9), evaluations=1000)
    assert log.notes == log.relative.notes == tuple(log.to_dict()["relative"]["notes"])


# Settings.


def test_settings_as_arguments_and_as_objects():
    a = montelux.integrate(sine_times_y, BOX, "vegas", alpha=0.5, increments=64, evaluations=20_000)
    settings = montelux.Vegas(alpha=0.5)
    settings.increments = 64
    b = montelux.integrate(sine_times_y, BOX, settings, evaluations=20_000)
    c = montelux.integrate(sine_times_y, BOX, "vegas", evaluations=20_000)
    assert a.value == b.value != c.value
