"""Types: `mypy --strict` passes on a file that uses every public name, and on the package itself."""

from __future__ import annotations

import ast
import importlib.util
import os
import site
import subprocess
import sys
from pathlib import Path

import pytest

import montelux
import typed_usage
from small_scene import TEXT

USAGE = Path(typed_usage.__file__)
needs_mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")


def checked(folder: Path, *files: object) -> str:
    """What mypy says of files, with the package as it is imported here and its settings, which are strict."""
    settings = Path(__file__).resolve().parents[2] / "pyproject.toml"
    package = Path(montelux.__file__).parents[1]
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file", settings, "--cache-dir", ".cache", *files]
    installed = str(package) in site.getsitepackages()  # where mypy finds it, and wants no path
    environment = {**os.environ, "MYPYPATH": "" if installed else str(package)}
    ended = subprocess.run(
        [str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True, timeout=600
    )
    return ended.stdout + ended.stderr


def test_every_public_name_is_used_with_types():
    used = {
        node.attr
        for node in ast.walk(ast.parse(USAGE.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "montelux"
    }
    assert set(montelux.__all__) - used == set()


def test_the_typed_file_runs():
    assert typed_usage.integrals().standard_error > 0
    assert len(typed_usage.integrands_from_anywhere()) == 3
    assert len(typed_usage.methods()) == len(montelux.METHODS)
    assert typed_usage.sampling().shape == (64, 3)
    assert len(typed_usage.values()) > 20
    assert typed_usage.scenes(TEXT).rmse == 0
    assert "did you mean 'alpha'" in typed_usage.mistakes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for all runs of mypy, which keeps there what it knows of libraries."""
    return tmp_path_factory.mktemp("mypy")


@needs_mypy
def test_mypy_passes_on_every_public_name(folder):
    assert "Success: no issues found" in checked(folder, USAGE)
    wrong = folder / "wrong.py"
    wrong.write_text(
        "import montelux\n"
        "r = montelux.integrate(abs, (0, 1))\n"
        "a: int = r / r\n"
        "b: str = r.uncertain.standard_error\n"
    )
    said = checked(folder, wrong)
    assert "wrong.py:3:" in said and "wrong.py:4:" in said


@needs_mypy
def test_mypy_passes_on_the_package(folder):
    assert "Success: no issues found" in checked(folder, "-p", "montelux")
