"""Whatever fails is one sentence, and no traceback."""

from __future__ import annotations

import ctypes
import os
import time
from pathlib import Path

import bpy
import pytest
from blender_scene import BlenderScene
from conftest import MODULE
from watched_program import WatchedProgram


def message_of_render(scene: BlenderScene, capfd: pytest.CaptureFixture) -> str:
    capfd.readouterr()
    try:
        bpy.ops.render.render()
        text = ""
    except RuntimeError as error:
        text = str(error)
    ctypes.CDLL(None).fflush(None)  # Blender prints by C, which holds lines back
    text += "".join(capfd.readouterr())
    assert "Traceback" not in text
    return text


def use_program(text: str, folder: Path) -> Path:
    """A script in place of the program."""
    script = folder / "program"
    script.write_text(text)
    script.chmod(0o755)
    bpy.context.preferences.addons[MODULE].preferences.program = str(script)
    return script


def test_no_program(scene: BlenderScene, capfd: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    preferences = bpy.context.preferences.addons[MODULE].preferences
    preferences.program = "/nowhere/montelux"
    assert "There is no program at /nowhere/montelux: set its path in Preferences" in message_of_render(scene, capfd)
    preferences.program = ""
    monkeypatch.setenv("PATH", "/nowhere")
    assert "The program 'montelux' is not on PATH: set its path in Preferences" in message_of_render(scene, capfd)


def test_program_on_path(scene: BlenderScene, program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "montelux").symlink_to(program)
    bpy.context.preferences.addons[MODULE].preferences.program = ""
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    scene.set_world((1, 1, 1))
    assert scene.render()[..., :3].mean() > 0.9


def test_program_that_cannot_run(scene: BlenderScene, tmp_path: Path, capfd: pytest.CaptureFixture) -> None:
    use_program("", tmp_path).chmod(0o644)
    assert "does not run: Permission denied" in message_of_render(scene, capfd)


def test_program_that_fails(scene: BlenderScene, tmp_path: Path, capfd: pytest.CaptureFixture) -> None:
    use_program("#!/bin/sh\necho 'montelux: error: scene.glb: no memory is left' >&2\nexit 1\n", tmp_path)
    assert "scene.glb: no memory is left" in message_of_render(scene, capfd)
    use_program("#!/bin/sh\necho 'other words' >&2\nexit 9\n", tmp_path)
    assert "The program ended with exit code 9: other words" in message_of_render(scene, capfd)
    use_program("#!/bin/sh\nkill -SEGV $$\n", tmp_path)
    assert "The program was ended by SIGSEGV" in message_of_render(scene, capfd)


def test_program_with_a_damaged_picture(scene: BlenderScene, tmp_path: Path, capfd: pytest.CaptureFixture) -> None:
    use_program("#!/bin/sh\necho nothing > picture.exr\n", tmp_path)
    assert "is no picture that can be read" in message_of_render(scene, capfd)


def test_picture_of_another_size(
    scene: BlenderScene, program: Path, tmp_path: Path, capfd: pytest.CaptureFixture
) -> None:
    command = f'eval exec {program} $(printf \'"%s" \' "$@" | sed s/48x32/64x40/)'
    use_program(f"#!/bin/sh\n{command}\n", tmp_path)
    scene.scene.montelux.samples = 4096  # so that there are pictures before the end, too
    assert "The program's picture has 64 x 40 pixels; expected 48 x 32" in message_of_render(scene, capfd)


def test_warnings_of_the_program(
    scene: BlenderScene, program: Path, tmp_path: Path, capfd: pytest.CaptureFixture
) -> None:
    use_program(f"#!/bin/sh\necho 'montelux: warning: the tide is high' >&2\nexec {program} \"$@\"\n", tmp_path)
    scene.add_plane()
    assert "the tide is high" in message_of_render(scene, capfd)


def test_denoiser_that_is_missing(
    scene: BlenderScene, capfd: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MONTELUX_OIDN_LIBRARY", "/nowhere/libOpenImageDenoise.so.2")
    scene.scene.montelux.denoise = True
    assert "/nowhere/libOpenImageDenoise.so.2" in message_of_render(scene, capfd)


def test_scene_without_camera(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    scene.scene.camera = None
    message = message_of_render(scene, capfd)
    assert "no camera" in message.lower()


def test_panoramic_camera(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    scene.camera.data.type = "PANO"
    assert "Camera 'camera' is panoramic" in message_of_render(scene, capfd)


def test_what_is_ignored_is_said(scene: BlenderScene, capfd: pytest.CaptureFixture) -> None:
    scene.camera.data.dof.use_dof = True
    scene.scene.render.pixel_aspect_x = 2
    scene.scene.render.use_motion_blur = True
    scene.add_light("AREA", spread=1)
    scene.add_cube().visible_camera = False
    message = message_of_render(scene, capfd)
    assert "Motion blur is ignored" in message
    for words in ("depth of field is ignored", "aspect of the pixels is ignored", "its spread is ignored"):
        assert words in message
    assert "'cube' is visible to all rays" in message


def test_check_of_the_program(scene: BlenderScene, program: Path, tmp_path: Path) -> None:
    preferences = bpy.context.preferences.addons[MODULE].preferences
    preferences.program = str(program)
    assert bpy.ops.montelux.check_program() == {"FINISHED"}
    use_program("#!/bin/sh\necho other 1.0\n", tmp_path)
    with pytest.raises(RuntimeError, match="is not Montelux"):
        bpy.ops.montelux.check_program()


def cancel_after(addon, monkeypatch: pytest.MonkeyPatch, seconds: float) -> None:
    begin = time.monotonic()
    monkeypatch.setattr(addon.MonteluxRenderEngine, "is_cancelled", lambda self: time.monotonic() - begin > seconds)


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_cancel_keeps_the_picture(
    scene: BlenderScene, addon, watched: WatchedProgram, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene.set_world((1, 1, 1))
    scene.add_plane(2)
    scene.scene.montelux.end, scene.scene.montelux.time = "TIME", 300
    cancel_after(addon, monkeypatch, 2)
    begin = time.monotonic()
    picture = scene.render()
    assert time.monotonic() - begin < 15
    assert picture[0, 0, 1] > 0.9 and 0.3 < picture[16, 24, 1] < 0.7
    assert not is_running(watched.command(watched.runs[0])["pid"])


def test_cancel_kills_a_program_that_goes_on(
    scene: BlenderScene, addon, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pid_file = tmp_path / "pid"
    use_program(f"#!/bin/sh\ntrap '' INT\necho $$ > {pid_file}\nwhile :; do sleep 0.1; done\n", tmp_path)
    monkeypatch.setattr(addon.engine, "SECONDS_TO_SAVE", 0.5)
    cancel_after(addon, monkeypatch, 1)
    begin = time.monotonic()
    bpy.ops.render.render()
    assert time.monotonic() - begin < 10
    assert not is_running(int(pid_file.read_text()))
