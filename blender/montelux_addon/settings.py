# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a scene and of its view layers."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty


class MonteluxSceneSettings(bpy.types.PropertyGroup):
    end: EnumProperty(
        name="End",
        description="What ends the render",
        items=(
            ("SAMPLES", "Samples", "A number of samples per pixel"),
            ("ERROR", "Error", "The relative error of the picture"),
            ("TIME", "Time", "A time"),
        ),
        default="SAMPLES",
    )
    samples: IntProperty(name="Samples", description="Samples per pixel", default=128, min=1, soft_max=16384)
    target_error: FloatProperty(
        name="Error",
        description="The render ends when the relative error of the picture is this, in percent",
        default=2,
        min=0.001,
        soft_max=20,
        max=100,
        precision=2,
    )
    time: FloatProperty(
        name="Time", description="The render ends after this time, in seconds", default=60, min=0.1, soft_max=36000
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="The render ends after this time, in seconds, also where the error is not reached. 0: no limit",
        default=0,
        min=0,
        soft_max=36000,
    )
    seed: IntProperty(name="Seed", description="Of all random numbers", default=0, min=0)
    max_depth: IntProperty(
        name="Bounces", description="Scattering events of a path at most", default=12, min=0, soft_max=64, max=1024
    )
    denoise: BoolProperty(
        name="Denoise",
        description="Shows the picture denoised by Open Image Denoise. The pass 'Noisy' has it as rendered",
        default=False,
    )

    def options(self, render: bpy.types.RenderSettings) -> tuple[str, ...]:
        """Options of the program. Threads are those of Blender's panel Performance."""
        options = ["--seed", str(self.seed), "--max-depth", str(self.max_depth)]
        options += ["--threads", str(render.threads if render.threads_mode == "FIXED" else 0)]
        if self.end == "SAMPLES":
            options += ["--spp", str(self.samples)]
        elif self.end == "ERROR":
            options += ["--target-error", f"{self.target_error:.6g}%"]
            if self.time_limit > 0:
                options += ["--time", f"{self.time_limit:.6g}"]
        else:
            options += ["--time", f"{self.time:.6g}"]
        if self.denoise:
            options.append("--denoise")
        return tuple(options)


class MonteluxLayerSettings(bpy.types.PropertyGroup):
    use_error: BoolProperty(
        name="Standard Error", description="Of each pixel and colour, as a pass of the picture", default=True
    )
    use_samples: BoolProperty(name="Samples", description="Number of samples of each pixel", default=False)
    use_albedo: BoolProperty(name="Albedo", description="Of the first surface", default=False)
    use_normal: BoolProperty(name="Normal", description="Of the first surface, in world space", default=False)
    use_distance: BoolProperty(
        name="Distance", description="To the first surface, averaged over the samples", default=False
    )


CLASSES = (MonteluxSceneSettings, MonteluxLayerSettings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.montelux = bpy.props.PointerProperty(type=MonteluxSceneSettings)
    bpy.types.ViewLayer.montelux = bpy.props.PointerProperty(type=MonteluxLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.montelux
    del bpy.types.Scene.montelux
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
