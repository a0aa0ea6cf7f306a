"""Whether the processor has the instructions that the compiled module uses: asked before that is loaded."""

from __future__ import annotations

from ._instructions import REQUIRED

_NAMES = {"sse4_2": "SSE4.2", "avx2": "AVX2", "fma": "FMA", "bmi2": "BMI2"}


def _flags(cpuinfo: str) -> frozenset[str] | None:
    """Features of the first processor of the file; None where it does not say."""
    try:
        with open(cpuinfo, encoding="ascii", errors="replace") as lines:
            for line in lines:
                name, _, value = line.partition(":")
                if name.strip() == "flags":
                    return frozenset(value.split())
    except OSError:
        pass
    return None


def check(cpuinfo: str = "/proc/cpuinfo") -> None:
    """Raises ImportError on a processor that lacks what the module was built for. Without it the interpreter would end
    with an illegal instruction."""
    flags = _flags(cpuinfo)
    missing = next((flag for flag in REQUIRED if flags is not None and flag not in flags), None)
    if missing is not None:
        raise ImportError(
            f"this processor has no {_NAMES.get(missing, 'AVX-512')}, which montelux was built for; build it here by "
            "pip install . --config-settings=cmake.define.MONTELUX_PROCESSOR=native"
        )
