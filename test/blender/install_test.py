"""The zip installs, registers and unregisters, as an extension and as an add-on."""

from __future__ import annotations

import ast
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import bpy
from build_zip import build_zip


def panels_of_engine() -> set[str]:
    panels = bpy.types.Panel.__subclasses__()
    return {p.__name__ for p in panels if "MONTELUX" in getattr(p, "COMPAT_ENGINES", ())}


def test_same_bytes(tmp_path: Path) -> None:
    build_zip(tmp_path / "a.zip")
    build_zip(tmp_path / "b.zip")
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        assert len({entry.date_time for entry in archive.infolist()}) == 1, "times of files are in the archive"
        assert archive.namelist() == sorted(archive.namelist())


def test_content(tmp_path: Path) -> None:
    """One folder, which older Blenders need; the version is the same in both of its places."""
    build_zip(tmp_path / "a.zip")
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        names = archive.namelist()
        assert {name.split("/")[0] for name in names} == {"montelux_addon"}
        assert "montelux_addon/LICENSE" in names and not [name for name in names if "__pycache__" in name]
        manifest = tomllib.loads(archive.read("montelux_addon/blender_manifest.toml").decode())
        module = ast.parse(archive.read("montelux_addon/__init__.py"))
    (info,) = (s.value for s in module.body if isinstance(s, ast.Assign) and s.targets[0].id == "bl_info")
    assert manifest["version"] == ".".join(map(str, ast.literal_eval(info)["version"]))
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]


def test_blender_accepts_the_manifest(tmp_path: Path) -> None:
    """By the checks of `blender --command extension validate`, which are stricter than those of an installation."""
    build_zip(tmp_path / "a.zip")
    (checker,) = Path(bpy.utils.system_resource("SCRIPTS")).glob("addons_core/bl_pkg/cli/blender_ext.py")
    checked = subprocess.run(
        [sys.executable, checker, "validate", tmp_path / "a.zip"], capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_registers_again(addon) -> None:
    shown = panels_of_engine()
    assert {"MONTELUX_PT_sampling", "RENDER_PT_format", "EEVEE_MATERIAL_PT_surface", "DATA_PT_EEVEE_light"} <= shown
    assert hasattr(bpy.types, "VIEWLAYER_PT_filter") and "VIEWLAYER_PT_filter" not in shown
    addon.unregister()
    assert not hasattr(bpy.types.Scene, "montelux") and not hasattr(bpy.types.ViewLayer, "montelux")
    assert "MonteluxRenderEngine" not in {
        c.__name__ for c in bpy.types.RenderEngine.__subclasses__() if c.is_registered
    }
    assert {name.split("_")[0] for name in panels_of_engine()} == {"MONTELUX"}  # its own classes, unregistered
    addon.register()
    assert panels_of_engine() == shown
    fresh = bpy.data.scenes.new("fresh")
    fresh.render.engine = "MONTELUX"
    assert fresh.montelux.samples == 128
    bpy.data.scenes.remove(fresh)
