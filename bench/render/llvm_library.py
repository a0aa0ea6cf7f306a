"""Which LLVM Mitsuba's llvm variants use."""

from __future__ import annotations

import glob
import os
import re
from typing import Optional, Tuple

FOLDERS = ("/usr/lib/*", "/usr/lib/llvm-*/lib", "/usr/lib64", "/usr/local/lib", "/opt/homebrew/opt/llvm/lib")


def _version(path: str) -> Tuple[int, ...]:
    digits = re.search(r"libLLVM[-.](?:so\.)?(\d+(?:\.\d+)*)", os.path.basename(path))
    return tuple(int(n) for n in digits[1].split(".")) if digits else (0,)


def newest_llvm() -> Optional[str]:
    """The newest library of this machine. drjit 1.5 refuses LLVM 14; 15 and 16 fail to compile its AVX-512 code."""
    found = [
        path for folder in FOLDERS for path in glob.glob(f"{folder}/libLLVM[-.]*") if ".so" in path or ".dylib" in path
    ]
    return max(found, key=_version) if found else None


def environment() -> dict:
    """The environment of a process that loads Mitsuba. DRJIT_LIBLLVM_PATH is kept if it is set."""
    known = dict(os.environ)
    library = known.get("DRJIT_LIBLLVM_PATH") or newest_llvm()
    return {**known, "DRJIT_LIBLLVM_PATH": library} if library else known
