"""The programs of docs/python-integrands.md as they stand there, each after the imports of those before it."""

from __future__ import annotations

import importlib.util
import math
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python-integrands.md"
PROGRAMS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S)
BUMP = math.sqrt(math.pi) / 2 * (math.erf(0.4) + math.erf(0.6))  # the integral of exp(-(x - 0.4)^2) over [0, 1]


@pytest.mark.parametrize(
    "index, needs, value",
    [
        (0, ["numba"], BUMP**4),
        (1, [], 1),
        (2, ["numba", "scipy"], 1 / 5),
        (3, [], BUMP * (1 - math.exp(-1))),
        (4, ["jax"], BUMP**4),
    ],
)
def test_a_program_of_the_page(index, needs, value, tmp_path):
    assert len(PROGRAMS) == 5
    missing = [library for library in needs if importlib.util.find_spec(library) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    imports = re.findall(r"^(?:import|from) (\w+).*$", "\n".join(PROGRAMS[:index]), re.M)
    lines = re.findall(r"^(?:import|from) .*$", "\n".join(PROGRAMS[:index]), re.M)
    known = [line for name, line in zip(imports, lines) if importlib.util.find_spec(name)]
    script = tmp_path / "script.py"
    script.write_text("\n".join([*known, PROGRAMS[index]]))
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    assert float(done.stdout.split("(")[0]) == pytest.approx(value, rel=0.02)
