"""integrate() in a process: the interpreter's lock, Ctrl-C, and the same bits as the program's."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time

import pytest

import montelux

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
import os, signal, sys, threading, time
import numpy as np, montelux
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a parent in the background ignores
def soon():
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=soon, daemon=True).start()
begin = time.monotonic()
try:
    montelux.integrate({f}, (0, 1), "basic", time=30, threads={threads}, components=0)
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
