"""Runs in Blender with a window: renders as F12 does, and prints one line of JSON on what happened.

Usage: blender --factory-startup --python gui_session.py -- ZIP PROGRAM OUTPUT WAY
WAY: still, animation, or cancel: the render is ended by Blender as it quits.
"""

import json
import sys
import threading
import time

import bpy

archive, program, output, way = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
bpy.ops.preferences.addon_enable(module="montelux_addon")
bpy.context.preferences.addons["montelux_addon"].preferences.program = program

import montelux_addon.engine  # noqa: E402

scene = bpy.context.scene
scene.render.engine = "MONTELUX"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 36, 100
scene.render.filepath = output
scene.montelux.end, scene.montelux.time = "TIME", 300 if way == "cancel" else 2
scene.frame_start, scene.frame_end = 3, 4
seen = {"live": 0, "export on the main thread": [], "render on the main thread": [], "ended": None}


def is_main() -> bool:
    return threading.current_thread() is threading.main_thread()


def watched(function, key):
    def call(*arguments):
        seen[key].append(is_main())
        return function(*arguments)

    return call


def counted(function):
    def call(*arguments):
        seen["live"] += 1
        return function(*arguments)

    return call


engine = montelux_addon.engine
engine.export_scene = watched(engine.export_scene, "export on the main thread")
engine.Child = watched(engine.Child, "render on the main thread")
engine.MonteluxRenderEngine._show_live = counted(engine.MonteluxRenderEngine._show_live)
begin = time.monotonic()


def finish(ended: str) -> None:
    seen["ended"] = ended
    seen["seconds"] = time.monotonic() - begin
    seen["scenes"] = len(bpy.data.scenes)
    print("SEEN " + json.dumps(seen), flush=True)


def start() -> None:
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen, area=window.screen.areas[0]):
        bpy.ops.render.render("INVOKE_DEFAULT", write_still=True, animation=way == "animation")
    bpy.app.timers.register(watch, first_interval=0.5)


def watch():
    enough = way == "cancel" and seen["live"] >= 4
    if seen["ended"] or enough or time.monotonic() - begin > 60:
        bpy.ops.wm.quit_blender()
        return None
    return 0.2


bpy.app.handlers.render_complete.append(lambda *_: finish("complete"))
bpy.app.handlers.render_cancel.append(lambda *_: finish("cancelled"))
bpy.app.timers.register(start, first_interval=1)
