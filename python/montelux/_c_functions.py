"""Integrands in machine code: numba's cfuncs, functions of ctypes, scipy.LowLevelCallable; none is imported."""

from __future__ import annotations

import ctypes
from _ctypes import CFuncPtr
from collections.abc import Callable, Sequence
from typing import Any, Protocol, Union

from . import _core
from ._core import Error


class LowLevelCallable(Protocol):
    """What is read of scipy.LowLevelCallable: a tuple whose first item is a capsule of the function."""

    @property
    def signature(self) -> str:
        """The function's signature in C."""

    @property
    def user_data(self) -> Any:
        """What it gets as its last argument."""


#: What integrate() takes for f: functions of Python, cfuncs of numba and functions of ctypes can be called; texts are
#: for devices.
Integrand = Union[Callable[..., Any], LowLevelCallable, str, Sequence[str]]

_NUMBERS: dict[Any, str] = {
    ctypes.c_double: "double",
    ctypes.c_float: "float",
    ctypes.c_int: "int",
    ctypes.c_uint: "unsigned int",
    ctypes.c_long: "long",
    ctypes.c_ulong: "unsigned long",
    ctypes.c_void_p: "void *",
    None: "void",
}
_NEEDS_THE_LOCK = 4  # FUNCFLAG_PYTHONAPI


def c_function(f: Integrand, dimensions: int) -> _core.CFunction | None:
    """f as a function in machine code; None for what Python calls. Throws Error for signatures that do not fit."""
    if isinstance(f, tuple) and hasattr(f, "signature") and hasattr(f, "user_data"):  # scipy.LowLevelCallable
        function = _core.CFunction.of_capsule(tuple.__getitem__(f, 0), f)
        _check_dimensions(f.signature, dimensions)
        return function
    pointer: Any = f.ctypes if hasattr(f, "address") and hasattr(f, "ctypes") else f  # numba
    if not isinstance(pointer, CFuncPtr):
        return None
    if pointer.argtypes is None:
        raise Error(
            "integrand: the types of a ctypes function were not declared; "
            "set f.argtypes = [ctypes.c_double] and f.restype = ctypes.c_double, or as its signature is"
        )
    if getattr(pointer, "_flags_", 0) & _NEEDS_THE_LOCK:
        raise Error("integrand: a function of ctypes.pythonapi was given; expected one that needs no interpreter")
    address = ctypes.cast(pointer, ctypes.c_void_p).value or 0
    signature = _signature(pointer)
    function = _core.CFunction.at(address, signature, f)
    _check_dimensions(signature, dimensions)
    return function


def _check_dimensions(signature: str, dimensions: int) -> None:
    if dimensions != 1 and signature.replace(" ", "").startswith("double(double"):
        raise Error(
            f"integrand: a C function of one number was given for a domain of {dimensions} variables; "
            "expected double (int, double *)"
        )


def _signature(pointer: Any) -> str:
    """The signature of a function of ctypes, in C."""
    return f"{_name(pointer.restype)} ({', '.join(map(_name, pointer.argtypes))})"


def _name(kind: Any) -> str:
    if kind in _NUMBERS:
        return _NUMBERS[kind]
    if isinstance(kind, type) and issubclass(kind, ctypes._Pointer):
        return _name(kind._type_) + " *"
    return getattr(kind, "__name__", str(kind))
