"""A pbrt-v4 scene as plain values: what each directive means once transformations and attributes are applied."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Dict, List, Optional

import numpy as np

import transforms
from pbrt_text import Directive, Parameter, SceneError, directives


class Parameters:
    """The parameters of one directive. It remembers which were asked for, so that the others can be reported."""

    def __init__(self, given: Dict[str, Parameter]) -> None:
        self.given, self.asked = given, set()

    def find(self, name: str) -> Optional[Parameter]:
        self.asked.add(name)
        return self.given.get(name)

    def number(self, name: str, default: float) -> float:
        found = self.find(name)
        if found is None or not found.values or isinstance(found.values[0], str):
            return default
        return float(found.values[0])

    def text(self, name: str, default: str = "") -> str:
        found = self.find(name)
        return str(found.values[0]) if found and found.values else default

    def flag(self, name: str, default: bool) -> bool:
        found = self.find(name)
        return bool(found.values[0]) if found and found.values else default

    def array(self, name: str, width: int) -> Optional[np.ndarray]:
        found = self.find(name)
        if found is None:
            return None
        if len(found.values) % width:
            raise SceneError(f"parameter {name} has {len(found.values)} numbers, no multiple of {width}")
        return np.array(found.values, dtype=float).reshape(-1, width)

    def without_effect(self, *names: str) -> None:
        """These change nothing in the comparison."""
        self.asked.update(names)

    def not_asked(self) -> List[str]:
        return sorted(set(self.given) - self.asked)


@dataclass
class Plugin:
    """A camera, film, material, texture, light or shape with its parameters."""

    type: str
    parameters: Parameters
    place: str
    name: str = ""
    to_world: np.ndarray = field(default_factory=lambda: np.eye(4))


@dataclass
class Shape:
    plugin: Plugin
    reverse: bool
    material: Plugin
    light: Optional[Plugin]  # the area light


@dataclass
class Scene:
    file: Path
    camera: Plugin
    film: Plugin
    integrator: Plugin
    shapes: List[Shape] = field(default_factory=list)
    lights: List[Plugin] = field(default_factory=list)
    materials: Dict[str, Plugin] = field(default_factory=dict)
    textures: Dict[str, Plugin] = field(default_factory=dict)
    notices: List[str] = field(default_factory=list)  # what was left out

    def notice(self, place: str, text: str) -> None:
        line = f"{place}: {text}"
        if line not in self.notices:
            self.notices.append(line)


@dataclass
class _State:
    to_world: np.ndarray
    material: Plugin
    light: Optional[Plugin] = None
    reverse: bool = False
    attributes: Dict[str, Dict[str, Parameter]] = field(default_factory=dict)


WITHOUT_COUNTERPART = {
    "ActiveTransform": "motion",
    "TransformTimes": "motion",
    "ColorSpace": "another colour space than sRGB",
    "MakeNamedMedium": "a participating medium",
    "MediumInterface": "a participating medium",
    "ObjectBegin": "an object to repeat",
    "ObjectInstance": "a repeated object",
    "Option": "an option",
}
# The comparison sets its own sampler and filter; accelerators change no picture.
NO_EFFECT = ("Sampler", "PixelFilter", "Accelerator", "WorldEnd", "ObjectEnd")


class _Builder:
    def __init__(self, file: Path) -> None:
        def nothing(type_: str) -> Plugin:
            return Plugin(type_, Parameters({}), str(file))

        self.scene = Scene(file, nothing("perspective"), nothing("rgb"), nothing("volpath"))
        self.state = _State(np.eye(4), nothing("diffuse"))
        self.stack: List[_State] = []
        self.systems: Dict[str, np.ndarray] = {}
        self.in_object = False

    def plugin(self, d: Directive, kind: str, type_: str, name: str = "") -> Plugin:
        """Parameters of Attribute directives count unless the directive has them itself."""
        parameters = {**self.state.attributes.get(kind, {}), **d.parameters}
        return Plugin(type_, Parameters(parameters), d.place, name, self.state.to_world.copy())

    def run(self, d: Directive) -> None:
        if d.name in WITHOUT_COUNTERPART:
            detail = " ".join(d.strings)
            self.scene.notice(
                d.place, f"{d.name} {detail} ({WITHOUT_COUNTERPART[d.name]}) is left out".replace("  ", " ")
            )
            self.in_object = self.in_object or d.name == "ObjectBegin"
        elif d.name in NO_EFFECT:
            self.in_object = self.in_object and d.name != "ObjectEnd"
        elif d.name in ("AttributeBegin", "TransformBegin"):
            self.stack.append(replace(self.state, attributes=dict(self.state.attributes)))
        elif d.name in ("AttributeEnd", "TransformEnd"):
            if not self.stack:
                raise SceneError(f"{d.place}: {d.name} without a beginning")
            before = self.stack.pop()
            self.state = before if d.name == "AttributeEnd" else replace(self.state, to_world=before.to_world)
        elif not self.transformation(d):
            self.declaration(d)

    def transformation(self, d: Directive) -> bool:
        s, n = self.state, d.numbers
        if d.name == "Identity":
            s.to_world = np.eye(4)
        elif d.name == "Translate":
            s.to_world = s.to_world @ transforms.translation(*n)
        elif d.name == "Scale":
            s.to_world = s.to_world @ transforms.scaling(*n)
        elif d.name == "Rotate":
            s.to_world = s.to_world @ transforms.rotation(*n)
        elif d.name == "LookAt":
            s.to_world = s.to_world @ transforms.camera_from_world(n)
        elif d.name == "Transform":
            s.to_world = transforms.matrix(n)
        elif d.name == "ConcatTransform":
            s.to_world = s.to_world @ transforms.matrix(n)
        elif d.name == "CoordinateSystem":
            self.systems[d.strings[0]] = s.to_world
        elif d.name == "CoordSysTransform":
            if d.strings[0] not in self.systems:
                raise SceneError(f"{d.place}: unknown coordinate system {d.strings[0]}")
            s.to_world = self.systems[d.strings[0]]
        elif d.name == "WorldBegin":
            s.to_world = np.eye(4)
            self.systems["world"] = s.to_world
        else:
            return False
        return True

    def declaration(self, d: Directive) -> None:
        scene, s = self.scene, self.state
        type_ = d.strings[0] if d.strings else ""
        if d.name == "Camera":  # the transformation so far is that of the world into the camera
            scene.camera = self.plugin(d, "camera", type_)
            scene.camera.to_world = np.linalg.inv(s.to_world)
            self.systems["camera"] = scene.camera.to_world
        elif d.name == "Film":
            scene.film = self.plugin(d, "film", type_)
        elif d.name == "Integrator":
            scene.integrator = self.plugin(d, "integrator", type_)
        elif d.name == "Attribute":
            s.attributes[type_] = {**s.attributes.get(type_, {}), **d.parameters}
        elif d.name == "ReverseOrientation":
            s.reverse = not s.reverse
        elif d.name == "Texture":
            scene.textures[type_] = self.plugin(d, "texture", d.strings[2], type_)
        elif d.name == "MakeNamedMaterial":
            material = self.plugin(d, "material", "", type_)
            material.type = material.parameters.text("type")
            scene.materials[type_] = material
        elif d.name == "NamedMaterial":
            if type_ not in scene.materials:
                raise SceneError(f"{d.place}: unknown material {type_}")
            s.material = scene.materials[type_]
        elif d.name == "Material":
            s.material = self.plugin(d, "material", type_)
        elif d.name == "AreaLightSource":
            s.light = self.plugin(d, "light", type_)
        elif d.name == "LightSource":
            scene.lights.append(self.plugin(d, "light", type_))
        elif d.name == "Shape" and not self.in_object:
            scene.shapes.append(Shape(self.plugin(d, "shape", type_), s.reverse, s.material, s.light))


def read_scene(file: Path) -> Scene:
    builder = _Builder(file)
    for directive in directives(file):
        builder.run(directive)
    return builder.scene
