"""On a processor that lacks instructions, importing the package is an error, not the end of the interpreter."""

from __future__ import annotations

import subprocess
import sys

import pytest

from montelux import _processor
from montelux._instructions import REQUIRED

NEHALEM = "fpu vme sse sse2 ssse3 sse4_1 sse4_2 popcnt"


def cpuinfo(folder, flags):
    file = folder / "cpuinfo"
    file.write_text(f"processor\t: 0\nmodel name\t: of a test\nflags\t\t: {flags}\nbugs\t\t: none\n\n" * 2)
    return str(file)


def test_a_processor_with_all_instructions_passes(tmp_path):
    _processor.check()
    _processor.check(cpuinfo(tmp_path, NEHALEM + " " + " ".join(REQUIRED)))


@pytest.mark.parametrize(
    "required, flags, missing",
    [
        (("sse4_2", "avx2", "fma", "bmi2"), NEHALEM, "AVX2"),
        (("sse4_2", "avx2", "fma", "bmi2"), "sse4_2 avx2 bmi2", "FMA"),
        (("sse4_2",), "sse sse2 sse4_1", "SSE4.2"),
        (("avx2", "avx512f", "avx512vl"), "avx2 avx512f", "AVX-512"),
    ],
)
def test_what_is_missing_is_named(tmp_path, monkeypatch, required, flags, missing):
    monkeypatch.setattr(_processor, "REQUIRED", required)
    with pytest.raises(ImportError, match=f"this processor has no {missing}, which"):
        _processor.check(cpuinfo(tmp_path, flags))


def test_where_nothing_is_known_nothing_is_refused(tmp_path):
    _processor.check(str(tmp_path / "absent"))
    (tmp_path / "arm").write_text("processor\t: 0\nFeatures\t: fp asimd\n")
    _processor.check(str(tmp_path / "arm"))


@pytest.mark.skipif("avx2" not in REQUIRED, reason="built for any processor")
def test_the_package_is_refused_before_the_compiled_module_is_loaded(tmp_path):
    code = f"""
import builtins, sys
real = builtins.open
def open(file, *args, **kwargs):
    return real({cpuinfo(tmp_path, NEHALEM)!r} if file == "/proc/cpuinfo" else file, *args, **kwargs)
builtins.open = open
try:
    import montelux
except ImportError as error:
    print(error)
print("loaded" if "montelux._core" in sys.modules else "not loaded")
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.startswith("this processor has no AVX2")
    assert result.stdout.endswith("\nnot loaded\n")
