"""integrate() in a process: the interpreter's lock, Ctrl-C, and the same bits as the program's."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import threading
import time

import pytest

import montelux

needs_compiler = pytest.mark.skipif(shutil.which("c++") is None, reason="no C++ compiler")

# The interpreter's lock and signals.


def test_other_threads_run_meanwhile():
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
    montelux.integrate(slow, (0, 1), "basic", time=0.3, threads=2)
    after = len(counted)
    done.set()
    thread.join()
    assert after - before > 20


INTERRUPTED = """
import ctypes, ctypes.util, os, signal, sys, threading, time
import numpy as np, montelux
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a parent in the background ignores

sine = ctypes.CDLL(ctypes.util.find_library("m")).sin
sine.argtypes, sine.restype = [ctypes.c_double], ctypes.c_double
polar = montelux.Domain.mapped(1, 1, lambda u: (u**2, 2 * u), "squares")
def slow(x):
    time.sleep(1e-4)
    return x * x
def nested(x):
    return float(montelux.integrate(lambda y: slow(y) + x, (0, 1), "basic", evaluations=2, batch=False, components=0))
def hidden(x):  # its exception is not Ctrl-C
    try:
        return slow(x)
    except KeyboardInterrupt:
        raise ValueError

def press(seconds):
    def soon():
        time.sleep(seconds)
        os.killpg(0, signal.SIGINT)  # worker processes get it from a terminal, too
    threading.Thread(target=soon, daemon=True).start()

def run(f, domain=(0, 1), call=montelux.integrate, **named):
    pressed = []
    def progress(r):  # a step is done
        if not pressed:
            press(0.2)
            pressed.append(time.monotonic())
    r = call(f, domain, "basic", time=100, **{"progress": progress, **named})
    assert not pressed or time.monotonic() - pressed[0] < 20, time.monotonic() - pressed[0]
    return r
"""


def interrupted(code):
    """Runs code that is interrupted; the line that it prints at its end."""
    command = [sys.executable, "-c", INTERRUPTED + code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, start_new_session=True)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return done.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        "np.sin",
        "np.sin, threads=2",
        "lambda x: x * x",
        "lambda x: x * x, threads=2",
        "slow, batch=False",
        "slow, batch=False, threads=2",
        "slow, batch=False, workers=2",
        "sine",
        "sine, threads=2",
        "np.sin, polar",
        pytest.param("'x*x', device='emulated'", marks=needs_compiler),
        "lambda x: -x * x, call=montelux.integrate_log",
    ],
)
def test_ctrl_c_returns_the_result_so_far(arguments):
    """Twice in a row: the first one leaves nothing behind."""
    text = interrupted(
        f"for _ in range(2):\n    r = run({arguments})\n"
        "    assert r.stop == 'interrupted' and r.evaluations > 0 and not r.converged, r\n"
        "    assert abs(float(r)) < 1 and 0 < getattr(r, 'standard_error', 0.1) < 0.5, r\n"
        "assert montelux.integrate(np.sin, (0, 1), evaluations=1000).evaluations > 0\nprint('done')"
    )
    assert text == "done\n"


def test_ctrl_c_ends_nested_integrations_as_one():
    text = interrupted("r = run(nested, batch=False, components=0)\nprint(r.stop, 0.4 < r.value < 1.6)")
    assert text == "interrupted True\n"


def test_ctrl_c_in_a_progress_function_returns_the_result_so_far():
    text = interrupted("press(1)\nr = run(np.sin, progress=lambda r: time.sleep(0.5))\nprint(r.stop, r.value > 0)")
    assert text == "interrupted True\n"


STUCK = """
import multiprocessing
def stuck(x):
    if os.path.exists(flag):
        time.sleep(60)
    return x
def first_step(r):
    if not os.path.exists(flag):
        open(flag, "w").close()
        press(0.5)
begin = time.monotonic()
r = run(stuck, batch=False, workers=2, progress=first_step)
print(r.stop, time.monotonic() - begin < 30, multiprocessing.active_children())
"""


def test_ctrl_c_ends_calls_of_worker_processes(tmp_path):
    assert interrupted(f"flag = {str(tmp_path / 'flag')!r}" + STUCK) == "interrupted True []\n"


def test_ctrl_c_keeps_the_checkpoint(tmp_path):
    state = str(tmp_path / "run.state")
    text = interrupted(
        f"r = run(np.sin, checkpoint={state!r})\n"
        f"whole = montelux.integrate(np.sin, (0, 1), 'basic', evaluations=2 * r.evaluations, checkpoint={state!r},"
        " resume=True)\n"
        "print(r.stop, r.evaluations < whole.evaluations)"
    )
    assert text == "interrupted True\n"


def test_ctrl_c_without_a_result_is_raised():
    code = (
        "press(0.5)\ntry:\n    montelux.integrate(lambda x: time.sleep(60), (0, 1), {})\n"
        "except KeyboardInterrupt:\n    print('raised')"
    )
    for named in ("", "components=0", "workers=2", "workers=2, components=0"):
        assert interrupted(code.format(named)) == "raised\n"


def test_other_exceptions_pass_through():
    text = interrupted("try:\n    run(hidden, batch=False)\nexcept ValueError:\n    print('raised')")
    assert text == "raised\n"


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
