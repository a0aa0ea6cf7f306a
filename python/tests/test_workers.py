"""integrate(workers=N): functions of Python in a pool of processes, with the bits of one process."""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import traceback

import numpy as np
import pytest

import montelux

BOX = [(0, 1), (0, 2), (0, 1)]


def bump(x):
    """A sum over the coordinates: its rounding depends on the order of the memory."""
    return np.exp(-np.sum((x - 0.4) ** 2, axis=1))


def bump_at(x):
    return math.exp(-float(np.sum((x - 0.4) ** 2)))


def bump_into(x, y):
    y[:] = bump(x)


def two_into(x, y):
    y[:, 0], y[:, 1] = bump(x), x[:, 0]


def two(x):
    return np.stack([bump(x), x[:, 0]], axis=-1)


def in_processes(f, *arguments, **named):
    """The runs with one, two and three workers, and the processes left over."""
    runs = [montelux.integrate(f, *arguments, **named, workers=w) for w in (1, 2, 3)]
    assert multiprocessing.active_children() == []
    return runs


def assert_equal_bits(runs):
    for r in runs[1:]:
        assert np.array_equal(r.value, runs[0].value) and np.array_equal(r.standard_error, runs[0].standard_error)
        assert r.evaluations == runs[0].evaluations


def test_as_many_workers_as_processors_of_this_process(monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: {3, 5, 9})
    assert montelux._workers.worker_count(0) == 3


@pytest.mark.parametrize("method", ["basic", "vegas", "quasi", "adaptive", "cubature"])
def test_the_bits_do_not_depend_on_the_workers(method):
    assert_equal_bits(in_processes(bump, BOX, method, evaluations=6000, seed=3))


@pytest.mark.parametrize(
    "f, options",
    [
        (bump_at, {"batch": False}),
        (bump_into, {"out": True}),
        (two, {}),
        (two_into, {"out": True, "components": 2}),
        (lambda x: x.sum(axis=1), {"array": np.from_dlpack}),
    ],
)
def test_every_form_of_function(f, options):
    assert_equal_bits(in_processes(f, BOX, "vegas", evaluations=4000, seed=5, **options))


def test_one_variable_and_many():
    assert_equal_bits(in_processes(math.sin, (0, 1), evaluations=2000, batch=False))
    assert_equal_bits(in_processes(bump, [(0, 1)] * 20, "basic", evaluations=5000))


def test_logarithms():
    runs = [
        montelux.integrate_log(lambda x: -np.sum(x**2, axis=1) - 5000, BOX, evaluations=4000, workers=w) for w in (1, 2)
    ]
    assert (runs[0].log_value, runs[0].log_error) == (runs[1].log_value, runs[1].log_error)


def test_the_function_runs_elsewhere():
    seen = []
    montelux.integrate(lambda x: seen.append(1) or x * os.getpid(), (0, 1), evaluations=1000, workers=2)
    assert seen == []


def share_together(method):
    """The share of the calls that begin while the other of two workers is in one: nearly half at best."""
    context = multiprocessing.get_context("fork")
    running, calls, together = (context.Value("i", 0) for _ in range(3))

    def slow(x):
        with running.get_lock():
            running.value += 1
            calls.value += 1
            together.value += running.value == 2
        time.sleep(1e-3)
        with running.get_lock():
            running.value -= 1
        return bump_at(x)

    montelux.integrate(slow, BOX, method, evaluations=1000, workers=2, batch=False)
    return together.value / calls.value


@pytest.mark.parametrize("method", ["basic", "quasi", "adaptive"])
def test_slow_functions_run_at_the_same_time(method):
    # On a busy machine threads start late.
    assert any(share_together(method) > 0.15 for _ in range(20))


def test_a_pool_ends_at_once_while_another_runs():
    context = multiprocessing.get_context("fork")
    first_runs, both_run, first_ended = (context.Event() for _ in range(3))

    def first(x):
        first_runs.set()
        both_run.wait(20)
        return x

    def second(x):  # its processes start while those of the first one run, and inherit the ends of their pipes
        both_run.set()
        first_ended.wait(20)
        return x

    def integral(f):
        return montelux.integrate(f, (0, 1), "basic", evaluations=100, batch=False, workers=2)

    def integrate_beside():
        first_runs.wait(20)
        integral(second)

    beside = threading.Thread(target=integrate_beside)
    begin = time.monotonic()
    beside.start()
    integral(first)
    seconds = time.monotonic() - begin
    assert both_run.is_set() and beside.is_alive()
    first_ended.set()
    beside.join()
    assert seconds < 5, "processes that have nothing to do are waited for 5 s each before they are killed"
    assert multiprocessing.active_children() == []


# What goes wrong.


class Unpickled(Exception):
    def __init__(self, a, b):
        super().__init__(a)


def raise_it(x):
    if x[:, 0].max() > 0.9:
        raise ValueError("no value here")
    return x[:, 0]


def raise_what_does_not_pickle(x):
    raise Unpickled(1, 2)


def test_exceptions_pass_through_with_their_traceback():
    with pytest.raises(ValueError, match="no value here") as raised:
        montelux.integrate(raise_it, BOX, evaluations=10_000, workers=2)
    text = "".join(traceback.format_exception(raised.type, raised.value, raised.tb))
    assert "in raise_it" in text and 'raise ValueError("no value here")' in text
    with pytest.raises(montelux.Error, match="an exception that does not pickle: Unpickled: 1") as raised:
        montelux.integrate(raise_what_does_not_pickle, BOX, workers=2)
    assert "in raise_what_does_not_pickle" in str(raised.value.__cause__)
    assert multiprocessing.active_children() == []


@pytest.mark.parametrize(
    "end, sentence",
    [
        (lambda: os._exit(3), "a worker process ended with exit code 3 while it evaluated the integrand"),
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "a worker process was killed by SIGKILL while"),
    ],
)
def test_the_end_of_a_worker_is_an_error(end, sentence):
    def f(x):
        if x.max() > 0.99:
            end()
        return x

    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(f, (0, 1), "basic", evaluations=10_000, workers=2)
    assert multiprocessing.active_children() == []


@pytest.mark.parametrize(
    "options, sentence",
    [
        ({"workers": -1}, "workers: -1 was given; expected a whole number from 0"),
        ({"workers": 1.5}, "workers: 1.5 was given; expected a whole number"),
        ({"workers": 2, "threads": 2}, "threads: 2 was given with workers=2.*expected threads=1"),
        ({"processes": 2}, r"did you mean 'workers'\?"),
    ],
)
def test_wrong_arguments_are_answered(options, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.integrate(bump, BOX, evaluations=1000, **options)


def test_wrong_values_are_answered_as_in_one_process():
    for f, sentence in (
        (lambda x: None, r"returned None.*return statement"),
        (lambda x: x[:3, 0], r"shape \(3,\) was returned for 5 points"),
    ):
        with pytest.raises(montelux.Error, match=sentence):
            montelux.integrate(f, BOX, workers=2)

    def write(x):
        x[:] = 0

    with pytest.raises(ValueError, match="read-only"):
        montelux.integrate(write, BOX, workers=2)


def test_pools_do_not_nest():
    def f(x):
        return montelux.integrate(bump, BOX, evaluations=100, workers=2).value * x

    with pytest.raises(montelux.Error, match="itself a worker of a pool.*expected workers=1"):
        montelux.integrate(f, (0, 1), evaluations=100, workers=2)


# In processes of their own: signals and start methods.


def run(code, *arguments):
    command = [sys.executable, *arguments] if arguments else [sys.executable, "-c", code]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


INTERRUPTED = """
import os, signal, sys, threading, time
import multiprocessing, montelux
signal.signal(signal.SIGINT, signal.default_int_handler)
def slow(x):
    time.sleep(60)
def soon():
    time.sleep(0.5)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=soon, daemon=True).start()
try:
    montelux.integrate(slow, (0, 1), workers=2, components=0)
except KeyboardInterrupt:
    sys.exit(len(multiprocessing.active_children()))
sys.exit(9)
"""


def test_ctrl_c_ends_calls_that_are_running():
    begin = time.monotonic()
    done = run(INTERRUPTED)
    assert done.returncode == 0 and done.stderr == "" and time.monotonic() - begin < 20


KILLED = """
import os, signal, sys, time
import montelux
def f(x):
    print(os.getpid(), flush=True)
    time.sleep(0.1)
    os.kill(os.getppid(), signal.SIGKILL)
    return x
montelux.integrate(f, (0, 1), workers=3, components=0)
"""


def test_workers_end_with_their_parent():
    done = run(KILLED)
    assert done.returncode == -signal.SIGKILL
    (worker,) = map(int, done.stdout.split())
    end = time.monotonic() + 20
    while os.path.exists(f"/proc/{worker}") and time.monotonic() < end:
        time.sleep(0.01)
    assert not os.path.exists(f"/proc/{worker}")


SPAWNED = """
import math, multiprocessing
import montelux

def f(x):
    return math.exp(x)

if __name__ == "__main__":
    multiprocessing.set_start_method("{method}")
    runs = [montelux.integrate(f, (0, 1), evaluations=2000, workers=w, batch=False) for w in (1, 2)]
    assert runs[0].value == runs[1].value and runs[0].standard_error == runs[1].standard_error
    try:
        montelux.integrate(lambda x: x, (0, 1), workers=2)
    except montelux.Error as error:
        print(error)
"""


@pytest.mark.parametrize("method", ["spawn", "forkserver"])
def test_other_ways_to_start_processes(method, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SPAWNED.format(method=method))
    done = run("", str(script))
    assert done.returncode == 0, done.stderr
    assert f"cannot be sent to processes of the start method '{method}'" in done.stdout
    assert "define it by `def` at the top level of a module" in done.stdout


def test_functions_that_spawned_processes_do_not_find():
    code = 'import multiprocessing, montelux\nmultiprocessing.set_start_method("spawn")\ndef f(x): return x\n'
    done = run(code + "montelux.integrate(f, (0, 1), workers=2)")
    assert "a worker process cannot load the integrand (AttributeError" in done.stderr
    assert "montelux.Error" in done.stderr or "Error: workers" in done.stderr


def test_scripts_without_a_guard(tmp_path):
    script = tmp_path / "script.py"
    code = 'import multiprocessing, montelux\nmultiprocessing.set_start_method("spawn", force=True)\n'
    script.write_text(code + "def f(x): return x\nmontelux.integrate(f, (0, 1), workers=2)\n")
    done = run("", str(script))
    assert done.returncode == 1
    assert "a worker process ended with exit code 1 before it evaluated anything" in done.stderr
    assert 'if __name__ == "__main__"' in done.stderr
