"""The denoiser that pip has installed."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path

_VARIABLE = "MONTELUX_OIDN_LIBRARY"
_NAME = "libOpenImageDenoise.so.2"


def offer_denoiser() -> None:
    """Names the library of the package pyoidn (`pip install montelux[denoise]`) to the module, unless
    MONTELUX_OIDN_LIBRARY names one. Without the package the system's own is tried."""
    if os.environ.get(_VARIABLE):
        return
    try:
        found = importlib.util.find_spec("pyoidn")
    except (ImportError, ValueError):
        return
    for folder in found.submodule_search_locations or [] if found else []:
        library = Path(folder) / "oidn" / "lib" / _NAME
        if library.is_file():
            os.environ[_VARIABLE] = str(library)
            return
