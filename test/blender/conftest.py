"""The add-on, installed from its zip into a Blender without user settings, and a program that is watched."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import pytest

# Before bpy is imported, which reads it: nothing of the user's Blender is read or written.
_resources = tempfile.TemporaryDirectory(prefix="montelux-blender-")
os.environ["BLENDER_USER_RESOURCES"] = _resources.name

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender"))

import bpy  # noqa: E402

from blender_scene import BlenderScene  # noqa: E402
from build_zip import build_zip  # noqa: E402
from watched_program import WatchedProgram  # noqa: E402

MODULE = "bl_ext.user_default.montelux"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--program", help="the program montelux", required=True)


def install_zip(folder: Path) -> None:
    archive = folder / "montelux-blender.zip"
    build_zip(archive)
    bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)


@pytest.fixture(scope="session")
def program(request: pytest.FixtureRequest) -> Path:
    return Path(request.config.getoption("--program")).resolve()


@pytest.fixture(scope="session")
def addon(tmp_path_factory: pytest.TempPathFactory):
    """The module of the installed add-on."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    install_zip(tmp_path_factory.mktemp("zip"))
    return sys.modules[MODULE]


@pytest.fixture
def watched(addon, program: Path, tmp_path: Path) -> WatchedProgram:
    """The program that the add-on is set to: keeps its files and its command."""
    watched = WatchedProgram(program, tmp_path / "watched")
    bpy.context.preferences.addons[MODULE].preferences.program = str(watched.script)
    return watched


@pytest.fixture
def scene(watched: WatchedProgram, tmp_path: Path) -> BlenderScene:
    """An empty scene of Montelux with a camera."""
    return BlenderScene(tmp_path)
