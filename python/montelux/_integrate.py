"""The front door: integrate a function, or its logarithm, over a domain until an error, a budget or a time is reached."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from inspect import Parameter, signature
from typing import Any, Union

from . import _core
from ._c_functions import Integrand
from ._core import Error
from ._integrand_forms import ArrayMaker, prepared
from ._names import MOST_THREADS, did_you_mean, is_number, is_whole, settings_of, unknown
from ._progress import IntegrationProgress
from ._regions import Ranges, as_region
from ._result import LogResult, Result, from_core, log_from_core

Progress = Union[bool, Callable[[Result], object]]

#: The methods that can be named, with the classes of their settings.
METHODS: dict[str, Any] = {
    kind.name: kind
    for kind in (
        _core.Auto,
        _core.Adaptive,
        _core.Vegas,
        _core.VegasSobol,
        _core.Quasi,
        _core.BasicMonteCarlo,
        _core.Stratified,
        _core.Recursive,
        _core.Metropolis,
        _core.Cubature,
        _core.RiemannSum,
        _core.MidpointRule,
        _core.TrapezoidRule,
        _core.Importance,
        _core.MultipleImportance,
        _core.ControlVariate,
        _core.Trained,
    )
}
# Settings without defaults.
_REQUIRED = {
    "importance": ("technique",),
    "multiple_importance": ("techniques",),
    "control_variate": ("controls", "integrals"),
    "trained": ("density",),
}


def as_method(method: Any, settings: dict[str, Any], arguments: Sequence[str]) -> _core.Method:
    """The method of a name, a class or an object of settings; `arguments`: the caller's own."""
    if isinstance(method, str):
        if method not in METHODS:
            raise Error("method: " + unknown("method", method, METHODS))
        method = METHODS[method]
    if isinstance(method, type) and method in METHODS.values():
        kind: str = getattr(method, "name")
        names = [*_REQUIRED.get(kind, ()), *settings_of(method)]
        if method is _core.MultipleImportance:
            names += ["weights", "parameter"]
        for name in settings:
            if name not in names:
                known = [*names, *arguments]
                raise Error(f"method '{kind}': " + unknown("setting", name, known))
        missing = [name for name in _REQUIRED.get(kind, ()) if name not in settings]
        if missing:
            raise Error(f"method '{kind}': expected the setting '{missing[0]}'")
        method = method(**settings)
    elif settings:
        name = next(iter(settings))
        hint = did_you_mean(name, arguments)
        raise Error(
            f"integrate: there is no argument '{name}'{hint}; settings of a method object are given to the object"
        )
    if not hasattr(type(method), "_method"):
        raise Error(f"method: an object of type '{type(method).__name__}' was given; expected a name or a method")
    made: _core.Method = method._method()
    return made


def integrate(
    f: Integrand,
    domain: Ranges,
    method: Any = "auto",
    *,
    relative_error: float = 0.0,
    absolute_error: float = 0.0,
    norm: str = "component",
    evaluations: int | float | None = None,
    time: float | None = None,
    seed: int = 0,
    threads: int = 1,
    workers: int = 1,
    device: str | None = None,
    batch: bool = True,
    out: bool = False,
    array: ArrayMaker | None = None,
    components: int | None = None,
    covariance: bool = True,
    non_finite: str = "skip",
    progress: Progress = False,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: float = 60.0,
    resume: bool = False,
    **settings: Any,
) -> Result:
    """The integral of f over a domain, with its error.

    f(x) is called with many points at once and returns a value for each: x has shape (n, d), or (n,) for a single
    range, and f returns shape (n,), or (n, m) for m components that are integrated together. x is a view of
    the library's own memory (strided, read-only, coordinate by coordinate) that ends with the call: keep
    `x.copy()`, not x. With `out=True` f(x, y) writes into y, shape (n,) or (n, m), so that values are not
    copied either. With `batch=False` f takes one point: a float for a single range, else an array of shape (d,).
    What f raises ends the integration and passes through. With `array`, such as torch.from_dlpack or
    jax.numpy.asarray, f gets array(x) of a copy of x. It may return any object with `__dlpack__`.

    f may be a C function, too: a numba cfunc, a scipy.LowLevelCallable, a function of ctypes with declared types;
    double (double), double (int, double *), and more of docs/python-integrands.md.

    domain: a range (lower, upper); or a sequence of ranges, one for each variable, where [(0, 1)] gives x of shape (n, 1);
    or a Domain, where one coordinate gives x of shape (n,). Ends may be infinite.

    method: a name ('auto', 'vegas', ...) with its settings as further keyword arguments, or an object such as
    `Vegas(alpha=0.5)`. `montelux.METHODS` lists the names; docs/integration.md says which is for what.

    It stops when every component's standard error is below the larger of `absolute_error` and `relative_error`
    times its value; after this many `evaluations`; or `time` seconds. Without any of these it stops after 1e6
    evaluations, and with an error alone after 60 seconds or 1e9 evaluations at the latest.
    With norm='vector' relative errors are relative to the Euclidean norm of all values. Ctrl-C stops it, too, and
    returns the result so far, with the stop 'interrupted'; it raises KeyboardInterrupt before the first step is done.

    The result depends on f, domain, method, budget and seed, and not on `threads` or `workers`. Python runs one
    thread at a time, so that more than one helps only C functions and those that release the interpreter's lock
    for long; 0: one for each processor. Slow functions of Python take `workers`, processes that evaluate f; 0: one
    for each processor.

    device: 'cuda' draws and evaluates the points on a GPU, for the methods adaptive, basic, quasi, vegas and
    vegas_sobol. f is then a formula such as 'exp(-x*x)*y' (variables x, y, z, or x1 to xn of more than three), a list
    of formulas, or a source in C or CUDA C++ with the function double integrand(int n, const double *x);
    docs/accelerator.md.
    'emulated' runs the same code on the processor, to check it.

    components: the m of f's shape (n, m); 0 for shape (n,). Without it f is called once more, with five to
    eight points, to see.

    covariance: False leaves out covariances, for thousands of components. non_finite: 'skip' leaves out NaN and
    infinite values, counted and reported in `warnings`; 'throw' ends with an Error that names the point.

    progress: True shows a line on standard error; a function is called with the Result so far, between steps, and
    stops the run as Ctrl-C does by returning False. With `workers` it is called from another thread.

    checkpoint: a file that keeps the running state, written every `checkpoint_every` seconds and at the end;
    with `resume` the run continues from it, to the digits of an uninterrupted one. Without, an existing file is an
    error.
    """
    result: Result = _run(
        _core.integrate,
        f,
        domain,
        method,
        settings,
        relative_error=relative_error,
        absolute_error=absolute_error,
        norm=norm,
        evaluations=evaluations,
        time=time,
        seed=seed,
        threads=threads,
        workers=workers,
        device=device,
        batch=batch,
        out=out,
        array=array,
        components=components,
        covariance=covariance,
        non_finite=non_finite,
        progress=progress,
        checkpoint=checkpoint,
        checkpoint_every=checkpoint_every,
        resume=resume,
        made=from_core,
    )
    return result


def integrate_log(
    log_f: Integrand,
    domain: Ranges,
    method: Any = "auto",
    *,
    relative_error: float = 0.0,
    evaluations: int | float | None = None,
    time: float | None = None,
    seed: int = 0,
    threads: int = 1,
    workers: int = 1,
    device: str | None = None,
    batch: bool = True,
    out: bool = False,
    array: ArrayMaker | None = None,
    non_finite: str = "skip",
    progress: Progress = False,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: float = 60.0,
    resume: bool = False,
    **settings: Any,
) -> LogResult:
    """log Z with its error, Z being the integral of exp(log_f): for values such as e^-5000.

        >>> montelux.integrate_log(lambda x: -5000 - x**2 / 2, (-np.inf, np.inf), relative_error=1e-6).log_value
        -4999.0810614...

    log_f returns one number a point, natural logarithms; -inf is an f of zero. `relative_error`, that of Z, is
    the error of log Z. The other arguments are those of integrate(); a `progress` function gets a Result
    relative to a reference that moves while larger values are met.
    """
    if "absolute_error" in settings:
        raise Error("integrate_log: an absolute_error was given; expected relative_error, which is the error of log Z")
    result: LogResult = _run(
        _core.integrate_log,
        log_f,
        domain,
        method,
        settings,
        relative_error=relative_error,
        absolute_error=0.0,
        norm="component",
        evaluations=evaluations,
        time=time,
        seed=seed,
        threads=threads,
        workers=workers,
        device=device,
        batch=batch,
        out=out,
        array=array,
        components=None if not out else 0,
        covariance=True,
        non_finite=non_finite,
        progress=progress,
        checkpoint=checkpoint,
        checkpoint_every=checkpoint_every,
        resume=resume,
        made=log_from_core,
    )
    return result


def _run(
    call: Callable[..., Any],
    f: Integrand,
    domain: Ranges,
    method: Any,
    settings: dict[str, Any],
    *,
    relative_error: float,
    absolute_error: float,
    norm: str,
    evaluations: int | float | None,
    time: float | None,
    seed: int,
    threads: int,
    workers: int,
    device: str | None,
    batch: bool,
    out: bool,
    array: ArrayMaker | None,
    components: int | None,
    covariance: bool,
    non_finite: str,
    progress: Progress,
    checkpoint: str | os.PathLike[str] | None,
    checkpoint_every: float,
    resume: bool,
    made: Callable[[Any, bool, int], Any],
) -> Any:
    """Checks the arguments, calls the library, and makes of its result what `made` does."""
    region = as_region(domain)
    chosen = as_method(method, settings, _ARGUMENTS[call])
    for name, choice, choices in (
        ("norm", norm, ("component", "vector")),
        ("non_finite", non_finite, ("skip", "throw")),
    ):
        if choice not in choices:
            raise Error(f"{name}: " + unknown("choice", choice, choices))
    for name, error in (("relative_error", relative_error), ("absolute_error", absolute_error)):
        if not is_number(error):
            raise Error(f"{name}: {error!r} was given; expected a number")
    if evaluations is not None:
        if not (is_number(evaluations) and 1 <= evaluations < 2**63 and float(evaluations).is_integer()):
            raise Error(f"evaluations: {evaluations!r} was given; expected a whole number above zero and below 2**63")
    if time is not None and not (is_number(time) and time > 0):
        raise Error(f"time: {time!r} was given; expected a number of seconds above zero")
    if not (is_whole(seed) and 0 <= seed < 2**64):
        raise Error(f"seed: {seed!r} was given; expected a whole number in [0, 2**64)")
    for name, number in (("threads", threads), ("workers", workers)):
        if not (is_whole(number) and 0 <= number <= MOST_THREADS):
            raise Error(f"{name}: {number!r} was given; expected a whole number from 0 to {MOST_THREADS}")
    if components is not None and not (is_whole(components) and 0 <= components < 2**31):
        raise Error(f"components: {components!r} was given; expected a whole number that is not negative")
    if not (isinstance(progress, bool) or callable(progress)):
        raise Error(f"progress: {progress!r} was given; expected True, False or a function")
    with prepared(f, region, batch, out, array, int(threads), int(workers), components, device) as integrand:
        cancel = _core.CancelFlag()
        watch = IntegrationProgress(made is log_from_core) if progress is True else progress
        report = None
        vector = integrand.components > 0
        if watch:
            report = lambda r: watch(from_core(r, vector, int(seed)))  # noqa: E731
        try:
            result = integrand.run(
                lambda: call(
                    integrand.function,
                    integrand.components,
                    out,
                    region.domain,
                    chosen,
                    float(relative_error),
                    float(absolute_error),
                    norm == "vector",
                    0 if evaluations is None else int(evaluations),
                    0.0 if time is None else float(time),
                    int(seed),
                    integrand.threads,
                    non_finite == "throw",
                    covariance,
                    report,
                    "" if checkpoint is None else os.fspath(checkpoint),
                    checkpoint_every,
                    resume,
                    cancel,
                ),
                cancel,
            )
        finally:
            if isinstance(watch, IntegrationProgress):
                watch.finish()
    finished = made(result, vector, int(seed))
    density = finished.density
    if density is not None:
        density._region = region  # with which it is pickled
    return finished


_ARGUMENTS = {
    call: [name for name, p in signature(door).parameters.items() if p.kind is Parameter.KEYWORD_ONLY]
    for call, door in ((_core.integrate, integrate), (_core.integrate_log, integrate_log))
}


def train_map(
    f: Integrand,
    domain: Ranges,
    evaluations: int = 100_000,
    settings: _core.Vegas | None = None,
    *,
    seed: int = 0,
    components: int | None = None,
) -> _core.AdaptiveMap:
    """A map that follows f, for integrals that differ from this one a little.

    Start these with `Vegas(training_iterations=0, map=...)`. None of the evaluations goes into an integral.
    """
    region = as_region(domain)
    with prepared(f, region, components=components) as integrand:
        return _core.train_map(
            integrand.function, region.domain, int(evaluations), settings or _core.Vegas(), seed, integrand.components
        )
