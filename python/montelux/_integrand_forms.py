"""The forms in which integrands are given, each as a function of many points for the library."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np

from . import _core
from ._c_functions import Integrand, c_function
from ._core import Error
from ._devices import device_function, is_text
from ._names import unknown
from ._regions import Region, with_points_of
from ._result import Array
from ._workers import WorkerPool, worker_count

#: Makes another library's array of NumPy's: torch.from_dlpack, jax.numpy.asarray.
ArrayMaker = Callable[[Array], Any]
_Answer = TypeVar("_Answer")

#: What `device` may be.
DEVICES = ("cuda", "emulated")


@dataclass(frozen=True)
class PreparedIntegrand:
    """What montelux._core.integrate is called with."""

    function: Any
    components: int
    threads: int
    pool: WorkerPool | None = None

    def run(self, work: Callable[[], _Answer], cancel: _core.CancelFlag) -> _Answer:
        """What work() returns, which calls the function, until `cancel` is requested; Ctrl-C requests it."""
        return work() if self.pool is None else self.pool.run(work, cancel)


@contextmanager
def prepared(
    f: Integrand,
    region: Region,
    batch: bool = True,
    out: bool = False,
    array: ArrayMaker | None = None,
    threads: int = 1,
    workers: int = 1,
    components: int | None = None,
    device: str | None = None,
) -> Iterator[PreparedIntegrand]:
    """The integrand of a call of integrate(), and the processes that evaluate it meanwhile."""
    if device is not None or is_text(f):
        yield _on_device(f, region.domain.dimensions, batch, out, array, threads, workers, components, device)
        return
    native = c_function(f, region.domain.dimensions)
    if native is not None:
        _refuse_options_of_python(batch, out, array, workers)
        yield PreparedIntegrand(native, components or 0, threads)
        return
    if not callable(f):
        raise Error(
            f"integrand: an object of type '{type(f).__name__}' was given; expected a function, a numba cfunc, a "
            "scipy.LowLevelCallable or a function of ctypes"
        )
    if out and not batch:
        raise Error("out: values are written into by batch functions only; expected batch=True or out=False")
    if array is not None:
        if not callable(array):
            raise Error(f"array: {array!r} was given; expected a function of a NumPy array, as torch.from_dlpack")
        if out or not batch:
            raise Error("array: it is for functions that get a batch and return values; expected batch=True, out=False")
    function = with_points_of(region, _batch_form(f, batch, len(region.shape(1)) == 1, array))
    if out and components is None:
        components = 0
    count = worker_count(workers)
    if count == 1:
        yield _with_components(function, components, region, threads)
        return
    if threads != 1:
        raise Error(f"threads: {threads} was given with workers={workers}; each worker has one, expected threads=1")
    with WorkerPool(function, count, out=out, components=components or 0) as pool:
        yield replace(_with_components(pool, components, region, count), pool=pool)


def _on_device(
    f: Any,
    dimensions: int,
    batch: bool,
    out: bool,
    array: ArrayMaker | None,
    threads: int,
    workers: int,
    components: int | None,
    device: str | None,
) -> PreparedIntegrand:
    if device is None:
        raise Error(
            "integrand: a text was given; expected a function, or device='cuda' of integrate() with a formula or a "
            "source"
        )
    if not isinstance(device, str) or device not in DEVICES:
        raise Error("device: " + unknown("device", str(device), DEVICES))
    if not is_text(f):
        raise Error(
            f"device: an object of type '{type(f).__name__}' was given as integrand; expected a formula, a list of "
            "formulas, or a source in C or CUDA C++"
        )
    _refuse_options_of_python(batch, out, array, workers, "compiled for a device")
    function, count = device_function(f, device, dimensions, components)
    return PreparedIntegrand(function, count, threads)


def _refuse_options_of_python(
    batch: bool, out: bool, array: ArrayMaker | None, workers: int, what: str = "a C function"
) -> None:
    given = {"batch": not batch, "out": out, "array": array is not None, "workers": workers != 1}
    for name, is_given in given.items():
        if is_given:
            hint = "; threads=N runs a C function on N processors" if (name, what) == ("workers", "a C function") else ""
            raise Error(f"{name}: it is for functions of Python, and the integrand is {what}{hint}")


def _batch_form(f: Any, batch: bool, one_variable: bool, array: ArrayMaker | None) -> Callable[..., Any]:
    """f as a function of many points. It pickles if f and `array` do."""
    if not batch:
        return partial(_number_by_number if one_variable else _point_by_point, f)
    if array is not None:
        return partial(_of_arrays, f, array)
    function: Callable[..., Any] = f
    return function


def _number_by_number(f: Callable[[float], Any], x: Array) -> Array:
    return np.array([f(v) for v in x.tolist()])


def _point_by_point(f: Callable[[Array], Any], x: Array) -> Array:
    return np.array([f(row) for row in x.copy()])


def _of_arrays(f: Callable[[Any], Any], array: ArrayMaker, x: Array) -> Any:
    # Libraries refuse arrays that are read-only or strided, and may keep what they get.
    return f(array(np.array(x, order="C")))


def _with_components(f: Callable[..., Any], components: int | None, region: Region, threads: int) -> PreparedIntegrand:
    return PreparedIntegrand(f, _components(f, region) if components is None else components, threads)


def _components(function: Callable[[Array], Any], region: Region) -> int:
    """Calls the integrand with a few points of the domain, to see what it returns."""
    k, d = region.domain.uniforms, region.domain.dimensions
    n = next(n for n in (5, 7, 8) if n not in (k, d))
    # Inside the cube and off its symmetries: additive sequences of square roots.
    u = np.modf(0.5 + np.outer(np.arange(1, n + 1), np.sqrt(np.arange(k) + 2.5)))[0]
    x, _ = region.domain.map(u)
    x.flags.writeable = False
    try:
        values = function(x)
    except TypeError as error:  # math.sin, or a function of two arguments
        if hasattr(error, "add_note"):  # Python 3.11
            error.add_note(
                f"montelux called the integrand with the array of {n} points x, of shape {region.shape(n)}; "
                "batch=False calls it with one point at a time"
            )
        raise
    return _core.values_a_point(values, n)
