"""Arrays of other libraries (torch, JAX, CuPy), exchanged by DLPack."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import Error

#: Types of devices whose memory the processor reads: kDLCPU, kDLCUDAHost and kDLROCMHost of dlpack.h.
_HOST_MEMORY = (1, 3, 11)


def as_numpy(array: Any, what: str) -> Any:
    """A NumPy array of an object with `__dlpack__`, on its own memory where that is the processor's."""
    try:
        if hasattr(array, "detach"):  # torch: tensors that record gradients export nothing
            array = array.detach()
        if int(array.__dlpack_device__()[0]) not in _HOST_MEMORY:
            array = _moved_to_host(array, what)
        if isinstance(array, np.ndarray):
            return array
        try:
            return np.from_dlpack(array)
        except (AttributeError, BufferError, TypeError):  # NumPy 1.22, and what is there without DLPack
            if not hasattr(array, "__array__"):
                raise
            return np.asarray(array)
    except Error:
        raise
    except Exception as error:
        raise Error(
            f"{what}: an object of type '{type(array).__name__}' was returned that NumPy cannot read "
            f"({type(error).__name__}: {error}); expected an array of real numbers"
        ) from error


def _moved_to_host(array: Any, what: str) -> Any:
    """An array in the processor's memory, by the means of its own library."""
    for name in ("get", "cpu", "__array__"):  # CuPy, torch, JAX
        if callable(getattr(array, name, None)):
            return getattr(array, name)()
    raise Error(
        f"{what}: an object of type '{type(array).__name__}' was returned that is on the device "
        f"{tuple(map(int, array.__dlpack_device__()))}; return it in the processor's memory"
    )
