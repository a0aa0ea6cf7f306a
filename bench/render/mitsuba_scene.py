"""A pbrt-v4 scene as a dictionary for mitsuba.load_dict. Matrices are NumPy arrays; see mitsuba_values.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Optional, Tuple

import numpy as np

import meshes
import transforms
from mitsuba_materials import Materials
from mitsuba_textures import EQUAL_AREA_MAP, Textures, report_rest, rgb
from pbrt_scene import Plugin, Scene, Shape
from pbrt_text import SceneError

MITSUBA_DEPTH = 1  # of a path without scattering, which is 0 in pbrt
ROULETTE = 2  # Montelux and pbrt-v4 start Russian roulette after the second scattering


def film_size(scene: Scene, width: Optional[int] = None) -> Tuple[int, int]:
    """The film's resolution, or one of this width and nearly the same shape."""
    p = scene.film.parameters
    size = int(p.number("xresolution", 1280)), int(p.number("yresolution", 720))
    return (width, max(1, round(size[1] * width / size[0]))) if width else size


class Converter:
    """Writes meshes into `folder`; notices of what is not converted go to the scene."""

    def __init__(self, scene: Scene, folder: Path, width: Optional[int] = None) -> None:
        self.scene, self.folder, self.size = scene, folder, film_size(scene, width)
        self.materials, self.textures = Materials(scene), Textures(scene)
        self.names: Dict[int, str] = {}  # of materials that are already in the output
        self.out: Dict[str, Any] = {"type": "scene"}

    def convert(self) -> Dict[str, Any]:
        self.out["integrator"] = self.integrator()
        self.out["sensor"] = self.camera()
        for light in self.scene.lights:
            self.light(light)
        for shape in self.scene.shapes:
            self.shape(shape)
        return self.out

    def add(self, kind: str, value: Dict[str, Any]) -> str:
        name = f"{kind}_{len(self.out)}"
        self.out[name] = value
        return name

    def integrator(self) -> Dict[str, Any]:
        integrator = self.scene.integrator
        if integrator.type not in ("path", "volpath"):
            self.scene.notice(integrator.place, f"integrator {integrator.type} becomes path")
        depth = int(integrator.parameters.number("maxdepth", 5)) + MITSUBA_DEPTH
        report_rest(self.scene, integrator, f"integrator {integrator.type}")
        return {"type": "path", "max_depth": depth, "rr_depth": ROULETTE}

    def camera(self) -> Dict[str, Any]:
        camera, p = self.scene.camera, self.scene.camera.parameters
        if camera.type != "perspective":
            raise SceneError(f"{camera.place}: camera {camera.type} is not converted")
        p.without_effect("shutteropen", "shutterclose")  # nothing moves
        lens = p.number("lensradius", 0)
        to_world = camera.to_world @ transforms.scaling(-1, 1, 1)  # Mitsuba's x points to the left
        out = {"type": "perspective", "fov": p.number("fov", 90), "fov_axis": "smaller", "to_world": to_world}
        if lens > 0:
            out.update(type="thinlens", aperture_radius=lens, focus_distance=p.number("focaldistance", 1e6))
        p.without_effect("focaldistance")
        report_rest(self.scene, camera, "camera")
        film = self.scene.film
        film.parameters.without_effect("filename", "savefp16", "xresolution", "yresolution", "diagonal")
        report_rest(self.scene, film, "film")
        hdr = {"type": "hdrfilm", "width": self.size[0], "height": self.size[1], "pixel_format": "rgb"}
        hdr.update(component_format="float32", rfilter={"type": "box"})
        return {**out, "film": hdr, "sampler": {"type": "independent"}}

    def light(self, light: Plugin) -> None:
        p = light.parameters
        scale = p.number("scale", 1)
        if light.type == "infinite" and "filename" in p.given:
            out = {"type": EQUAL_AREA_MAP, "filename": str((self.scene.file.parent / p.text("filename")).resolve())}
            out.update(scale=scale, to_world=light.to_world)
        elif light.type == "infinite":
            out = {"type": "constant", "radiance": self.emission(light, "L", scale)}
        elif light.type == "distant":
            start, end = self.point(p, "from", (0, 0, 0)), self.point(p, "to", (0, 0, 1))
            direction = light.to_world[:3, :3] @ (end - start)
            out = {
                "type": "directional",
                "direction": direction.tolist(),
                "irradiance": self.emission(light, "L", scale),
            }
        elif light.type == "point":
            at = light.to_world @ np.append(self.point(p, "from", (0, 0, 0)), 1)
            out = {"type": "point", "position": at[:3].tolist(), "intensity": self.emission(light, "I", scale)}
        else:
            self.scene.notice(light.place, f"light {light.type} is left out")
            return
        report_rest(self.scene, light, f"light {light.type}")
        self.add("light", out)

    @staticmethod
    def point(p: Any, name: str, default: Tuple[float, float, float]) -> np.ndarray:
        found = p.array(name, 3)
        return np.array(default, dtype=float) if found is None else found[0]

    def emission(self, light: Plugin, name: str, scale: float) -> Dict[str, Any]:
        """A colour of 1 has a luminance of 1 in both programs."""
        color = self.textures.color(light.parameters, name, [1, 1, 1], light.place)
        if not isinstance(color, dict) or color["type"] != "rgb":
            self.scene.notice(light.place, f"{name} of the light is no RGB colour: white is used")
            color = rgb([1, 1, 1])
        return rgb([v * scale for v in color["value"]])

    def shape(self, shape: Shape) -> None:
        plugin = shape.plugin
        if plugin.type in ("trianglemesh", "plymesh"):
            out: Optional[Dict[str, Any]] = self.mesh(shape)
        elif plugin.type in ("sphere", "disk"):
            out = self.quadric(shape)
        else:
            self.scene.notice(plugin.place, f"shape {plugin.type} is left out")
            return
        if out is None:
            return
        if shape.light is not None:
            p = shape.light.parameters
            out["emitter"] = {"type": "area", "radiance": self.emission(shape.light, "L", p.number("scale", 1))}
            if p.flag("twosided", False):
                self.scene.notice(shape.light.place, "a light of two sides shines on one side only")
            report_rest(self.scene, shape.light, "area light")
        out["bsdf"] = self.material(shape)
        report_rest(self.scene, plugin, f"shape {plugin.type}")
        self.add("shape", out)

    def material(self, shape: Shape) -> Dict[str, Any]:
        """A reference: materials are shared, which keeps Mitsuba's kernels small."""
        key = id(shape.material)
        if key not in self.names:
            self.names[key] = self.add("material", self.materials.bsdf(shape.material))
        reference = {"type": "ref", "id": self.names[key]}
        if "alpha" not in shape.plugin.parameters.given:
            return reference
        opacity = self.textures.number(shape.plugin.parameters, "alpha", 1, shape.plugin.place)
        return {"type": "mask", "opacity": opacity, "nested": reference}

    def mesh(self, shape: Shape) -> Dict[str, Any]:
        plugin, p = shape.plugin, shape.plugin.parameters
        if plugin.type == "plymesh":
            mesh = meshes.read_ply(self.scene.file.parent / p.text("filename"))
        else:
            points, indices = p.array("P", 3), p.array("indices", 3)
            if points is None:
                raise SceneError(f"{plugin.place}: the mesh has no points")
            faces = np.arange(3)[None] if indices is None else indices.astype(np.int64)
            mesh = meshes.Mesh(points, faces, p.array("N", 3), p.array("uv", 2))
        if mesh.faces.size and not 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.points):
            raise SceneError(f"{plugin.place}: the mesh has indices out of range")
        mesh = meshes.placed(mesh, plugin.to_world, shape.reverse)
        if shape.light is not None:
            mesh.normals = None  # the winding says which side shines
        file = self.folder / f"mesh_{len(self.out)}.ply"
        meshes.write_ply(file, mesh)
        return {"type": "ply", "filename": str(file), "face_normals": mesh.normals is None}

    def quadric(self, shape: Shape) -> Optional[Dict[str, Any]]:
        plugin, p = shape.plugin, shape.plugin.parameters
        radius = p.number("radius", 1)
        to_world = plugin.to_world
        if plugin.type == "disk":
            to_world = to_world @ transforms.translation(0, 0, p.number("height", 0))
        scale = transforms.uniform_scale(to_world)
        if not scale:
            self.scene.notice(plugin.place, f"{plugin.type} scaled unevenly is left out")
            return None
        if plugin.type == "sphere" and transforms.mirrors(to_world):  # Mitsuba takes no mirrored spheres
            to_world = to_world @ transforms.scaling(-1, 1, 1)
        to_world = to_world @ transforms.scaling(radius, radius, radius)
        return {"type": plugin.type, "to_world": to_world, "flip_normals": shape.reverse}
