"""A pool of processes that evaluate an integrand, one call at a time each.

Unlike executors of the standard library it ends calls that are running, so that Ctrl-C and errors never wait for a
slow function; and a call takes some 50 microseconds.
"""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from queue import SimpleQueue
from types import TracebackType
from typing import Any, TypeVar

import numpy as np

from ._core import CancelFlag, Error
from ._foreign_arrays import as_numpy
from ._result import Array

_SECONDS_TO_END = 5.0  # for processes that have nothing to do
_END = b""  # the message that ends a process
_Answer = TypeVar("_Answer")


class WorkerTraceback(Exception):
    """The cause of an exception from a worker process: its traceback there, as text."""

    def __str__(self) -> str:
        return f'\n"""\n{self.args[0]}"""'


def worker_count(workers: int) -> int:
    """The number of processes that `workers` asks for; 0: one for each processor."""
    return workers or len(os.sched_getaffinity(0))


class WorkerPool:
    """f, evaluated by processes: call it from as many threads as there are workers.

    With `out` the pool is a function f(x, y) that fills y, of shape (n,), or (n, components) if there are any.
    """

    def __init__(self, f: Callable[..., Any], workers: int, *, out: bool, components: int) -> None:
        if multiprocessing.current_process().daemon:
            raise Error("workers: this process is itself a worker of a pool and may start none; expected workers=1")
        self._row = None if not out else (components,) if components else ()
        self._failure: BaseException | None = None
        self._lock = threading.Lock()
        self._idle: SimpleQueue[_Worker] = SimpleQueue()
        self._workers: list[_Worker] = []
        try:
            context = multiprocessing.get_context()
            shared = _as_shared(f, context.get_start_method())
            with _ctrl_c_waits():
                for _ in range(workers):
                    others = [worker.connection for worker in self._workers]
                    self._workers.append(_Worker(context, shared, others))
            for worker in self._workers:
                worker.wait_until_ready()
                self._idle.put(worker)
        except BaseException:
            self._kill()
            raise

    def __call__(self, x: Array, y: Array | None = None) -> Any:
        worker = self._idle.get()
        try:
            values = worker.evaluate(x, self._row)
        except BaseException as error:
            self._fail(error)
            raise
        self._idle.put(worker)
        if y is None:
            return values
        y[...] = values
        return None

    def run(self, work: Callable[[], _Answer], cancel: CancelFlag) -> _Answer:
        """What work() returns, which calls this pool from a thread of its own.

        Ctrl-C in this thread requests `cancel`, and ends the calls that are running by an error.
        """
        ended = threading.Event()
        answers: list[_Answer] = []
        errors: list[BaseException] = []

        def run() -> None:
            try:
                answers.append(work())
            except BaseException as error:
                errors.append(error)
            finally:
                ended.set()

        threading.Thread(target=run, daemon=True).start()
        while True:
            try:
                ended.wait()
                break
            except KeyboardInterrupt as interruption:
                cancel.request()
                self._fail(interruption)
        if errors:
            raise errors[0]
        return answers[0]

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        if error is None:
            self._end()
            return
        self._kill()
        # Calls of other threads end when the processes do, and may be heard of first.
        if self._failure is not None and error is not self._failure:
            raise self._failure

    def _fail(self, error: BaseException) -> None:
        with self._lock:
            if self._failure is None:
                self._failure = error
        for worker in self._workers:
            worker.process.kill()

    def _end(self) -> None:
        for worker in self._workers:
            worker.end()
        for worker in self._workers:
            worker.process.join(_SECONDS_TO_END)
        self._kill()

    def _kill(self) -> None:
        for worker in self._workers:
            worker.process.kill()
        for worker in self._workers:
            worker.process.join()
            worker.connection.close()


@contextmanager
def _ctrl_c_waits() -> Iterator[None]:
    """Holds SIGINT back, also in the processes that are started meanwhile."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _Worker:
    """A process and the connection to it."""

    def __init__(self, context: Any, shared: Any, others: list[Connection]) -> None:
        self.connection, theirs = context.Pipe()
        # A forked process inherits this end of the connections, which would keep them open after this process ends.
        inherited = [*others, self.connection] if context.get_start_method() == "fork" else []
        self.process = context.Process(target=_serve, args=(theirs, inherited, shared), daemon=True)
        try:
            self.process.start()
        except OSError as error:
            self.connection.close()
            raise Error(f"workers: a process could not be started ({error}); expected fewer workers") from error
        finally:
            theirs.close()

    def wait_until_ready(self) -> None:
        self._answer(
            "before it evaluated anything; with the start method 'spawn' or 'forkserver' the main part of a "
            "script must be under `if __name__ == \"__main__\":`"
        )

    def evaluate(self, x: Array, row: tuple[int, ...] | None) -> Any:
        try:
            # Coordinate by coordinate, as here, so that sums over the coordinates have the same bits.
            _send(self.connection, (np.ascontiguousarray(x.T), row))
        except OSError:
            pass  # it ended; its exit code is looked up below
        return self._answer("while it evaluated the integrand")

    def end(self) -> None:
        # Forked processes of other pools may hold this end of the connection, too: closing it would not be noticed.
        try:
            self.connection.send_bytes(_END)
        except OSError:
            pass  # the process ended before
        self.connection.close()

    def _answer(self, when: str) -> Any:
        try:
            kind, answer, text = pickle.loads(self.connection.recv_bytes())
        except (EOFError, OSError):
            self.process.join(_SECONDS_TO_END)
            raise Error(f"workers: a worker process {_ended(self.process.exitcode)} {when}") from None
        if kind == "values":
            return answer
        error = pickle.loads(answer)
        error.__cause__ = WorkerTraceback(text)
        raise error


def _ended(code: int | None) -> str:
    if code is None or code >= 0:
        return f"ended with exit code {code}"
    try:
        return f"was killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"was killed by signal {-code}"


def _as_shared(f: Callable[..., Any], start_method: str) -> Any:
    """The function as forked processes inherit it, or as bytes for others."""
    if start_method == "fork":
        return f
    try:
        return pickle.dumps(f)
    except Exception as error:
        raise Error(
            f"workers: the integrand cannot be sent to processes of the start method '{start_method}' "
            f"({type(error).__name__}: {error}); define it by `def` at the top level of a module, or call "
            "multiprocessing.set_start_method('fork', force=True) first"
        ) from error


# In the worker process.


def _serve(connection: Connection, inherited: list[Connection], shared: Any) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the other process ends this one
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    for other in inherited:
        other.close()
    try:
        f = _function(shared)
    except BaseException as error:
        _send_error(connection, error)
        return
    _send(connection, ("values", None, ""))
    while True:
        try:
            message = connection.recv_bytes()
        except EOFError:
            return
        if message == _END:
            return
        x, row = pickle.loads(message)
        x = x.T
        x.flags.writeable = False
        try:
            answer = pickle.dumps(("values", _values(f, x, row), ""), pickle.HIGHEST_PROTOCOL)
        except BaseException as error:
            _send_error(connection, error)
        else:
            connection.send_bytes(answer)


def _function(shared: Any) -> Callable[..., Any]:
    if not isinstance(shared, bytes):
        function: Callable[..., Any] = shared
        return function
    try:
        return pickle.loads(shared)  # type: ignore[no-any-return]
    except Exception as error:
        raise Error(
            f"workers: a worker process cannot load the integrand ({type(error).__name__}: {error}); define it "
            "in a module that can be imported, or call multiprocessing.set_start_method('fork', force=True) first"
        ) from error


def _values(f: Callable[..., Any], x: Array, row: tuple[int, ...] | None) -> Any:
    if row is not None:
        y = np.zeros((len(x), *row), order="F")
        f(x, y)
        return y
    y = f(x)
    return as_numpy(y, "integrand") if hasattr(y, "__dlpack__") and not isinstance(y, np.ndarray) else y


def _send(connection: Connection, message: Any) -> None:
    connection.send_bytes(pickle.dumps(message, pickle.HIGHEST_PROTOCOL))


def _send_error(connection: Connection, error: BaseException) -> None:
    text = "".join(traceback.format_exception(type(error), error, error.__traceback__))
    try:
        pickled = pickle.dumps(error)
        pickle.loads(pickled)
    except Exception:
        said = f"{type(error).__name__}: {error}"
        pickled = pickle.dumps(Error(f"workers: the integrand raised an exception that does not pickle: {said}"))
    _send(connection, ("error", pickled, text))
