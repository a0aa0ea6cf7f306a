# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences of the add-on: where the program is."""

from __future__ import annotations

import bpy

from .run.program import ProgramError, find_program, version_of


def preferred_program() -> str:
    """The path that the user has set, or nothing."""
    addon = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(addon.preferences.program) if addon else ""


class MONTELUX_OT_check_program(bpy.types.Operator):
    """Runs the program and shows its version"""

    bl_idname = "montelux.check_program"
    bl_label = "Check"

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, version_of(find_program(preferred_program())))
        except ProgramError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class MonteluxPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", description="Path of the program 'montelux'. Empty: the one on PATH", subtype="FILE_PATH"
    )

    def draw(self, context: bpy.types.Context) -> None:
        row = self.layout.row()
        row.prop(self, "program")
        row.operator(MONTELUX_OT_check_program.bl_idname)


CLASSES = (MONTELUX_OT_check_program, MonteluxPreferences)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
