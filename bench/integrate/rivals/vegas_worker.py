"""Runs the package vegas on request: one JSON object a line in, one a line out.

Usage: vegas_worker.py LIBRARY, the shared library of integrands.
"""
import ctypes
import json
import os
import signal
import sys
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import gvar
import numpy
import vegas

WARM_UP = 5  # iterations that train the map and are thrown away
COUNTED = 10  # iterations that make an estimate
FIRST = 1000  # evaluations an iteration, at first


def load(path):
    library = ctypes.CDLL(path)
    library.montelux_bench_integrand.restype = ctypes.c_void_p
    library.montelux_bench_integrand.argtypes = [ctypes.c_char_p, ctypes.c_uint64]
    library.montelux_bench_release.argtypes = [ctypes.c_void_p]
    library.montelux_bench_evaluations.restype = ctypes.c_uint64
    library.montelux_bench_evaluations.argtypes = [ctypes.c_void_p]
    library.montelux_bench_rows.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p]
    return library


def integrate(library, handle, request):
    @vegas.lbatchintegrand
    def f(x):
        x = numpy.ascontiguousarray(x)
        values = numpy.empty(x.shape[0])
        library.montelux_bench_rows(handle, x.ctypes.data, x.shape[0], values.ctypes.data)
        return values

    gvar.ranseed(request["seed"])
    integrator = vegas.Integrator(request["dimensions"] * [[0.0, 1.0]])
    target, limit = request["relative_error"], request["evaluations"]
    if not target > 0:
        integrator(f, nitn=WARM_UP, neval=limit * 0.2 / WARM_UP)
        return integrator(f, nitn=COUNTED, neval=limit * 0.8 / COUNTED), False

    # The map is kept; each estimate is of new iterations alone.
    integrator(f, nitn=WARM_UP, neval=FIRST)
    neval = FIRST
    while True:
        result = integrator(f, nitn=COUNTED, neval=neval)
        if result.sdev <= target * abs(result.mean):
            return result, True
        left = limit - library.montelux_bench_evaluations(handle)
        ratio = result.sdev / (target * abs(result.mean)) if result.mean != 0 else 1e9
        wanted = 1.2 * ratio**2 * neval
        following = min(max(wanted, 2 * neval), 16 * neval)
        if COUNTED * following > left and COUNTED * wanted < 2 * left:
            following = left / COUNTED
        if COUNTED * following > left or COUNTED * wanted > 50 * left or following < 1.2 * neval:
            return result, False
        neval = int(following)


def answer(library, request):
    handle = library.montelux_bench_integrand(request["problem"].encode(), request["parameters"])
    if not handle:
        return {"failure": "there is no such integrand"}
    try:
        begin = time.process_time()
        result, converged = integrate(library, handle, request)
        seconds = time.process_time() - begin
        return {
            "value": float(result.mean),
            "error": float(result.sdev),
            "converged": bool(converged),
            "warned": bool(result.Q < 0.001),  # its own chi-squared test of the iterations
            "evaluations": int(library.montelux_bench_evaluations(handle)),
            "cpu_seconds": seconds,
        }
    finally:
        library.montelux_bench_release(handle)


def main():
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the comparison decides when to stop
    library = load(sys.argv[1])
    print(json.dumps({"version": vegas.__version__}), flush=True)
    for line in sys.stdin:
        try:
            reply = answer(library, json.loads(line))
        except Exception as error:  # one failed run must not end the comparison
            reply = {"failure": f"{type(error).__name__}: {error}"}
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    main()
