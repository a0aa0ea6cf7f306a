"""What integrands of other kinds cost: nanoseconds per evaluation of a cfunc, and the scaling of worker processes.

Usage: PYTHONPATH=BUILD/python python3 bench/python_integrands.py (numba is needed for the first table)
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

import montelux
from montelux._c_functions import c_function
from montelux._core import call_integrand

METHODS = ("basic", "vegas", "quasi", "adaptive")


def shortest(seconds: Any, tries: int) -> float:
    """Neighbours of the processor only add to a time."""
    return float(min(seconds() for _ in range(tries)))


def cfuncs() -> None:
    import numba

    types = numba.types
    pointer = types.CPointer(types.double)

    @numba.cfunc(types.double(types.intc, pointer))  # type: ignore[untyped-decorator]
    def f(n: int, x: Any) -> float:
        total = 0.0
        for d in range(n):
            total += (x[d] - 0.4) ** 2
        return math.exp(-total)

    of_point = f.ctypes

    @numba.njit  # type: ignore[untyped-decorator]
    def by_itself(x: Any, calls: int) -> float:
        total = 0.0
        for _ in range(calls):
            total += of_point(np.int32(x.size), x.ctypes)
        return total

    print("nanoseconds per evaluation of a numba cfunc")
    for d in (1, 4, 8):
        x = np.full(d, 0.5)
        by_itself(x, 1)

        def own(x: Any = x) -> float:
            begin = time.perf_counter()
            by_itself(x, 1_000_000)
            return (time.perf_counter() - begin) / 1e6

        def run(method: str, d: int = d) -> float:
            begin = time.perf_counter()
            r = montelux.integrate(f, [(0, 1)] * d, method, evaluations=2_000_000)
            return (time.perf_counter() - begin) / r.evaluations

        alone = shortest(own, 15)
        called = shortest(lambda: call_integrand(c_function(f, d), 1024, d, 1000)[0] / 1024, 15)
        whole = {m: 1e9 * shortest(lambda: run(m), 3) for m in ("basic", "vegas")}
        print(
            f"  {d} variables: {1e9 * alone:.1f} by itself, {1e9 * called:.1f} as an integrand "
            f"(+{1e9 * (called - alone):.1f}); with the method: "
            + ", ".join(f"{m} {t:.1f}" for m, t in whole.items())
        )


def slow(x: Any) -> float:
    time.sleep(1e-3)
    return math.exp(-float(np.sum((x - 0.4) ** 2)))


def workers() -> None:
    print("seconds for points that sleep 1 ms, with 1 and 2 workers")
    for evaluations in (2000, 8000):
        for method in METHODS:
            values, seconds = set(), []
            for count in (1, 2):
                begin = time.perf_counter()
                r = montelux.integrate(
                    slow, [(0, 1)] * 4, method, evaluations=evaluations, seed=1, batch=False, workers=count
                )
                seconds.append(time.perf_counter() - begin)
                values.add((r.value, r.standard_error))
            assert len(values) == 1
            one, two = seconds
            print(f"  {method:8} {r.evaluations} evaluations: {one:.2f} s, {two:.2f} s: {one / two:.2f} times")


if __name__ == "__main__":
    cfuncs()
    workers()
