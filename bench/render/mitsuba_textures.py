"""Colours, numbers and textures of pbrt as Mitsuba's.

Three kinds of values stay open until a variant of Mitsuba is chosen; mitsuba_values.py fills them in:
PICTURE (a texture read from a file), EQUAL_AREA_MAP (an environment) and UNBOUNDED (a colour that may exceed 1).
"""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Union

import numpy as np

from pbrt_scene import Parameters, Plugin, Scene

PICTURE, EQUAL_AREA_MAP, UNBOUNDED = "montelux picture", "montelux equal-area map", "montelux unbounded colour"

Converted = Union[float, Dict[str, Any]]


def rgb(values: List[float]) -> Dict[str, Any]:
    return {"type": "rgb", "value": [float(v) for v in values]}


class Textures:
    """Converts parameters that are colours or textures; what it cannot express it reports to the scene's notices."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def color(
        self, parameters: Parameters, name: str, default: List[float], place: str, unbounded: bool = False
    ) -> Converted:
        """A spectrum parameter. `unbounded` is for those that are no reflectances."""
        found = parameters.find(name)
        if found is None:
            return rgb(default)
        if found.type == "texture":
            return self.texture(str(found.values[0]), place)
        if found.type == "rgb":
            value = rgb(found.values)
            return {**value, "type": UNBOUNDED} if unbounded else value
        if found.type == "spectrum" and found.values and not isinstance(found.values[0], str):
            pairs = np.array(found.values, dtype=float).reshape(-1, 2)
            listed = [", ".join(f"{v:.9g}" for v in column) for column in pairs.T]
            return {"type": "irregular", "wavelengths": listed[0], "values": listed[1]}
        if found.type == "spectrum" and found.values == ["stdillum-D65"]:
            return rgb([1, 1, 1])
        self.scene.notice(place, f"{name} ({found.type} {found.values[0]}) is not converted: {default} is used")
        return rgb(default)

    def number(self, parameters: Parameters, name: str, default: float, place: str) -> Converted:
        """A float parameter or texture."""
        found = parameters.find(name)
        if found is not None and found.type == "texture":
            return self.texture(str(found.values[0]), place)
        return float(parameters.number(name, default))

    def texture(self, name: str, place: str) -> Converted:
        plugin = self.scene.textures.get(name)
        if plugin is None:
            self.scene.notice(place, f"unknown texture {name}: 1 is used")
            return rgb([1, 1, 1])
        convert = {"imagemap": self._picture, "checkerboard": self._checkerboard, "scale": self._scaled}.get(
            plugin.type
        )
        if plugin.type == "constant":
            converted = self._part(plugin.parameters, "value", 1, plugin.place)
        elif convert:
            converted = convert(plugin)
        else:
            self.scene.notice(plugin.place, f"texture {name} of type {plugin.type} is not converted: 0.5 is used")
            return rgb([0.5, 0.5, 0.5])
        report_rest(self.scene, plugin, f"texture {name}")
        return converted

    def _part(self, parameters: Parameters, name: str, default: float, place: str) -> Converted:
        found = parameters.find(name)
        if found is None or found.type == "float":
            return rgb([parameters.number(name, default)] * 3)
        return self.color(parameters, name, [default] * 3, place)

    def _mapping(self, plugin: Plugin) -> Optional[np.ndarray]:
        """pbrt's (s, t) from Mitsuba's coordinates, whose v is 1 less pbrt's. None for mappings other than uv."""
        p = plugin.parameters
        if p.text("mapping", "uv") != "uv":
            return None
        u, v = p.number("uscale", 1), p.number("vscale", 1)
        return np.array([[u, 0, p.number("udelta", 0)], [0, -v, v + p.number("vdelta", 0)], [0, 0, 1]])

    def _picture(self, plugin: Plugin) -> Converted:
        p, mapping = plugin.parameters, self._mapping(plugin)
        p.without_effect("filter", "maxanisotropy")  # noise hides how a picture is filtered
        if mapping is None:
            self.scene.notice(plugin.place, f"mapping {p.text('mapping')} is not converted: 0.5 is used")
            return rgb([0.5, 0.5, 0.5])
        flip = np.array([[1, 0, 0], [0, -1, 1], [0, 0, 1]])  # the first row of the picture is at t = 1
        wrap = p.text("wrap", "repeat")
        modes = {"repeat": "repeat", "clamp": "clamp"}
        if wrap not in modes:
            self.scene.notice(plugin.place, f"wrap {wrap} is not converted: the picture is repeated")
        encoding = p.text("encoding", "sRGB")
        if encoding not in ("sRGB", "linear"):
            self.scene.notice(plugin.place, f"encoding {encoding} is not converted: sRGB is used")
        return {
            "type": PICTURE,
            "filename": str((self.scene.file.parent / p.text("filename")).resolve()),
            "scale": [p.number("scale", 1)] * 3,
            "invert": p.flag("invert", False),
            "linear": encoding == "linear",
            "wrap_mode": modes.get(wrap, "repeat"),
            "to_uv": flip @ mapping,
        }

    def _checkerboard(self, plugin: Plugin) -> Converted:
        p, mapping = plugin.parameters, self._mapping(plugin)
        first, second = (self._part(p, n, d, plugin.place) for n, d in (("tex1", 1), ("tex2", 0)))
        if p.number("dimension", 2) != 2 or mapping is None:
            self.scene.notice(
                plugin.place, f"checkerboard {plugin.name} is not two-dimensional in uv: its first colour is used"
            )
            return first
        period = np.diag([0.5, 0.5, 1])  # a unit of Mitsuba's checkerboard is two squares wide
        return {"type": "checkerboard", "color0": first, "color1": second, "to_uv": period @ mapping}

    def _scaled(self, plugin: Plugin) -> Converted:
        p = plugin.parameters
        texture, factor = (self._part(p, n, 1, plugin.place) for n in ("tex", "scale"))
        for a, b in ((texture, factor), (factor, texture)):
            if isinstance(b, dict) and b["type"] == "rgb":
                return self._times(a, b["value"], plugin)
        self.scene.notice(plugin.place, f"texture {plugin.name} is a product of two pictures: only the first is used")
        return texture

    def _times(self, texture: Converted, factor: List[float], plugin: Plugin) -> Converted:
        if isinstance(texture, float):
            return rgb([texture * f for f in factor])
        if texture["type"] == "rgb":
            return rgb([v * f for v, f in zip(texture["value"], factor)])
        if texture["type"] == "checkerboard":
            return {**texture, **{k: self._times(texture[k], factor, plugin) for k in ("color0", "color1")}}
        if texture["type"] == PICTURE and not texture["invert"]:
            return {**texture, "scale": [v * f for v, f in zip(texture["scale"], factor)]}
        self.scene.notice(plugin.place, f"texture {plugin.name}: its factor {factor} is left out")
        return texture


def report_rest(scene: Scene, plugin: Plugin, what: str) -> None:
    """Names the parameters that no conversion asked for."""
    for name in plugin.parameters.not_asked():
        scene.notice(plugin.place, f"{what}: parameter {name} is not converted")
