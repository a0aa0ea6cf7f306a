# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the Properties editor: those of the engine, and Blender's own that it follows."""

from __future__ import annotations

import bpy

ENGINE = "MONTELUX"

# Blender's panels whose settings have no effect here.
WITHOUT_EFFECT = {
    "RENDER_PT_freestyle",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "WORLD_PT_viewport_display",
}
# Panels of the other engines whose settings are exported.
ALSO_OURS = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_light",
    "DATA_PT_EEVEE_light",
    "DATA_PT_spot",
}


def _shared_panels() -> list[type]:
    """As the documentation of RenderEngine finds them: panels that every engine may take."""
    shared = []
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        everybodys = "BLENDER_RENDER" in engines and panel.__name__ not in WITHOUT_EFFECT
        if everybodys or panel.__name__ in ALSO_OURS and engines:
            shared.append(panel)
    return shared


class _RenderPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine in cls.COMPAT_ENGINES


class MONTELUX_PT_sampling(_RenderPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.scene.montelux
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(settings, "end")
        if settings.end == "SAMPLES":
            layout.prop(settings, "samples")
        elif settings.end == "ERROR":
            layout.prop(settings, "target_error", text="Error (%)")
            layout.prop(settings, "time_limit", text="Time Limit (s)")
        else:
            layout.prop(settings, "time", text="Time (s)")
        layout.prop(settings, "max_depth")
        layout.prop(settings, "seed")
        layout.prop(settings, "denoise")


class MONTELUX_PT_film(_RenderPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(context.scene.render, "film_transparent", text="Transparent")


class MONTELUX_PT_threads(_RenderPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        render = context.scene.render
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(render, "threads_mode")
        threads = layout.row()
        threads.enabled = render.threads_mode == "FIXED"
        threads.prop(render, "threads")


class MONTELUX_PT_passes(_RenderPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.view_layer.montelux
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in settings.bl_rna.properties.keys():
            if name.startswith("use_"):
                layout.prop(settings, name)


CLASSES = (MONTELUX_PT_sampling, MONTELUX_PT_film, MONTELUX_PT_threads, MONTELUX_PT_passes)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    for panel in bpy.types.Panel.__subclasses__():
        if ENGINE in getattr(panel, "COMPAT_ENGINES", ()) and panel not in CLASSES:
            panel.COMPAT_ENGINES.remove(ENGINE)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
