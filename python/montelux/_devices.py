"""Integrands as text, for devices: formulas, and sources in C or CUDA C++."""

from __future__ import annotations

import importlib.util
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Union

from . import _core
from ._core import Error

#: A formula, formulas of several components, or a source.
Text = Union[str, Sequence[str]]


def is_text(f: object) -> bool:
    """Whether an integrand is given as text."""
    return isinstance(f, str) or (isinstance(f, (list, tuple)) and bool(f) and all(isinstance(t, str) for t in f))


def variable_names(dimensions: int) -> list[str]:
    """x; x and y; x, y and z; or x1 to xn: the variables of formulas."""
    return list("xyz"[:dimensions]) if dimensions <= 3 else [f"x{d}" for d in range(1, dimensions + 1)]


def device_function(f: Text, device: str, dimensions: int, components: int | None) -> tuple[_core.DeviceFunction, int]:
    """f compiled for a device, and its components: 0 for one value a point."""
    if device == "cuda":
        _find_nvrtc()
    if isinstance(f, str) and "{" in f:
        count = components or 0
        return _core.DeviceFunction.of_source(device, f, count, dimensions), count
    formulas = [f] if isinstance(f, str) else list(f)
    count = 0 if isinstance(f, str) else len(formulas)
    if components is not None and components != count:
        raise Error(f"components: {components} was given with {len(formulas)} formulas; each is a component, leave it out")
    if count == 1:
        raise Error("integrand: a list of one formula was given; expected the formula, or several")
    return _core.DeviceFunction.of_formulas(device, formulas, variable_names(dimensions), dimensions), count


def _find_nvrtc() -> None:
    """Where the wheel nvidia-cuda-nvrtc is installed, its library is the one to load."""
    if os.environ.get("MONTELUX_NVRTC"):
        return
    for name in ("nvidia.cuda_nvrtc", "nvidia.cu13"):
        try:
            found = importlib.util.find_spec(name)
        except ModuleNotFoundError:
            return
        for folder in (found.submodule_search_locations or []) if found else []:
            for file in sorted(Path(folder, "lib").glob("libnvrtc.so.*")):
                os.environ["MONTELUX_NVRTC"] = str(file)
                return
