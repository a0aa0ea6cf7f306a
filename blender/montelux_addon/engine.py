# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: exports the scene, runs the program, shows its picture."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

from . import passes
from .export.errors import ExportError
from .export.scene_files import SceneFiles, export_scene
from .main_thread import Cancelled, on_main_thread
from .preferences import preferred_program
from .run.child import INTERRUPTED, TARGET_MISSED, Child
from .run.command import Command, Film
from .run.exr import ExrError, ExrPicture
from .run.live_picture import LivePicture
from .run.program import ProgramError, find_program

SECONDS_BETWEEN_LOOKS = 0.1
SECONDS_BETWEEN_PICTURES = 0.5
SECONDS_TO_SAVE = 20  # after an interrupt, before the program is killed


class MonteluxRenderEngine(bpy.types.RenderEngine):
    bl_idname = "MONTELUX"
    bl_label = "Montelux"
    bl_use_preview = False  # of materials: each would start the program
    bl_use_postprocess = True
    bl_use_eevee_viewport = True  # draws the material preview of the viewport
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene: bpy.types.Scene = None, renderlayer: bpy.types.ViewLayer = None) -> None:
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for p in passes.passes_of(scene, renderlayer):
            self.register_pass(scene, renderlayer, p.name, len(p.components), p.components, p.kind)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        try:
            with tempfile.TemporaryDirectory(prefix="montelux-") as folder:
                self._render(depsgraph, Path(folder))
        except (ExportError, ProgramError, ExrError) as error:
            self.report({"ERROR"}, str(error))
            self.error_set(str(error))  # shown in place of a picture
        except Cancelled:
            pass

    def is_cancelled(self) -> bool:
        """By Esc, or the cross beside the progress."""
        return self.test_break()

    def _render(self, depsgraph: bpy.types.Depsgraph, folder: Path) -> None:
        program = find_program(preferred_program())
        self.update_stats("Montelux", "Exporting the scene")
        camera = self.camera_override or depsgraph.scene.camera
        files = on_main_thread(lambda: export_scene(depsgraph, camera, folder), self.is_cancelled)
        for warning in files.warnings:
            self.report({"WARNING"}, warning)
        command = self._command(depsgraph, files, folder)
        self.update_stats("Montelux", "Reading the scene")
        try:
            child = Child([*command.arguments(program), "--view"], folder)
        except OSError as error:
            raise ProgramError(f"{program} does not run: {error.strerror}") from error
        try:
            code = self._follow(child, depsgraph.view_layer.name, command.film)
        finally:
            child.kill()
        for warning in child.warnings:
            self.report({"WARNING"}, warning)
        if code in (0, INTERRUPTED, TARGET_MISSED) and command.output.is_file():
            self._show_final(ExrPicture(command.output), depsgraph, command.film)
            if code == TARGET_MISSED:
                self.report({"WARNING"}, "The render ended before the requested error")
        elif not self.is_cancelled():
            raise ProgramError(child.failure())

    def _command(self, depsgraph: bpy.types.Depsgraph, files: SceneFiles, folder: Path) -> Command:
        scene = depsgraph.scene
        return Command(
            scene=files.scene,
            output=folder / "picture.exr",
            camera=files.camera.name,
            film=files.camera.film,
            environment=files.environment,
            interpolate_environment=files.interpolate_environment,
            transparent=scene.render.film_transparent,
            layers=passes.layers_for(passes.passes_of(scene, depsgraph.view_layer)),
            options=scene.montelux.options(scene.render),
        )

    def _follow(self, child: Child, layer: str, film: Film) -> int:
        """Shows the picture until the program ends; its exit code."""
        live: LivePicture | None = None
        last_picture = interrupted = 0.0
        try:
            while (code := child.poll()) is None:
                now = time.monotonic()
                if interrupted and now - interrupted > SECONDS_TO_SAVE:
                    child.kill()
                elif self.is_cancelled() and not interrupted:
                    self.update_stats("Montelux", "Ending the render")
                    child.interrupt()
                    interrupted = now
                if live is None and child.address:
                    live = LivePicture(child.address)
                if live is not None and not interrupted:
                    self.update_progress(live.progress.share)
                    self.update_stats("Montelux", live.progress.text())
                    if now - last_picture >= SECONDS_BETWEEN_PICTURES:
                        last_picture = now
                        self._show_live(live, layer, film)
                time.sleep(SECONDS_BETWEEN_LOOKS)
        finally:
            if live is not None:
                live.close()
        return code

    def _show_live(self, live: LivePicture, layer: str, film: Film) -> None:
        mean = live.changed_mean()
        if mean is not None and _fits(mean, film):
            result = self._begin(mean, layer)
            _fill(result.layers[0].passes["Combined"], passes.with_alpha(mean))
            self.update_result(result)
            self.end_result(result)

    def _show_final(self, picture: ExrPicture, depsgraph: bpy.types.Depsgraph, film: Film) -> None:
        chosen = passes.passes_of(depsgraph.scene, depsgraph.view_layer)
        combined = passes.combined_of(picture)
        if not _fits(combined, film):
            expected = f"expected {film.crop_width} x {film.crop_height}"
            raise ProgramError(
                f"The program's picture has {combined.shape[1]} x {combined.shape[0]} pixels; {expected}"
            )
        result = self._begin(combined, depsgraph.view_layer.name)
        layer = result.layers[0]
        _fill(layer.passes["Combined"], combined)
        for p in chosen:
            values = passes.values_of(p, picture)
            if values is not None and p.name in layer.passes:
                _fill(layer.passes[p.name], values)
        self.end_result(result)

    def _begin(self, picture: np.ndarray, layer: str) -> bpy.types.RenderResult:
        height, width = picture.shape[:2]
        return self.begin_result(0, 0, width, height, layer=layer)


def _fits(picture: np.ndarray, film: Film) -> bool:
    """Blender does not check the size of what it is given."""
    return picture.shape[:2] == (film.crop_height, film.crop_width)


def _fill(target: bpy.types.RenderPass, values: np.ndarray) -> None:
    """Rows from the top; Blender's are from the bottom."""
    values = np.ascontiguousarray(values[::-1], np.float32)
    try:
        target.rect.foreach_set(values.reshape(-1))
    except TypeError:  # Blender 3.4 takes as many rows as there are pixels
        target.rect.foreach_set(values.reshape(-1, values.shape[-1]))
