# SPDX-License-Identifier: GPL-3.0-or-later
"""What the camera can see, as a temporary scene that Blender's glTF exporter writes.

The exporter would evaluate the user's scene as the viewport does, change its mode, and leave out instances. Copies of
what was evaluated for this render have the levels, visibility and instances of the render, and leave the user's scene
alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy
from mathutils import Matrix

from .animated_materials import AnimatedMaterials
from .errors import ExportError
from .materials import warn_of_nodes

WITHOUT_EQUAL = ("CURVES", "POINTCLOUD", "VOLUME", "GPENCIL", "GREASEPENCIL")

SMALL = 1e-5  # rounding errors of a matrix

EXPORTER_SETTINGS = {
    "export_format": "GLB",
    "use_active_scene": True,
    "export_yup": True,
    "export_apply": False,  # the copies have no modifiers
    "export_animations": False,
    "export_current_frame": True,  # the exporter would go to frame 0
    "export_skins": False,
    "export_morph": False,
    "export_cameras": False,
    "export_lights": False,
    "export_extras": False,
    "export_tangents": False,
    "export_attributes": False,
    "export_gpu_instances": False,
    "export_import_convert_lighting_mode": "COMPAT",  # emission as it is
    "will_save_settings": False,
}


@dataclass
class _Copies:
    scene: bpy.types.Scene
    objects: list[bpy.types.Object]
    meshes: list[bpy.types.Mesh]
    materials: AnimatedMaterials


def export_geometry(depsgraph: bpy.types.Depsgraph, path: Path, warnings: list[str]) -> None:
    """Writes a .glb of all surfaces. Runs operators: on the main thread only."""
    if not hasattr(bpy.types, "EXPORT_SCENE_OT_gltf"):
        raise ExportError("Blender's add-on 'glTF 2.0 format' is disabled; enable it in Preferences > Add-ons")
    with _copied_scene(depsgraph, warnings) as copies:
        known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
        settings = {name: value for name, value in EXPORTER_SETTINGS.items() if name in known}
        override = {"scene": copies.scene, "view_layer": copies.scene.view_layers[0]}
        try:
            with bpy.context.temp_override(**override):
                bpy.ops.export_scene.gltf(filepath=str(path), **settings)
        except (RuntimeError, TypeError) as error:
            raise ExportError(f"Blender's glTF exporter failed: {_last_line(error)}") from error
    if not path.is_file():
        raise ExportError("Blender's glTF exporter wrote no file")


def _last_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[-1] if lines else type(error).__name__


@contextmanager
def _copied_scene(depsgraph: bpy.types.Depsgraph, warnings: list[str]) -> Iterator[_Copies]:
    copies = _Copies(bpy.data.scenes.new("montelux export"), [], [], AnimatedMaterials())
    try:
        _copy(depsgraph, copies, warnings)
        yield copies
    finally:
        for kind, items in ((bpy.data.objects, copies.objects), (bpy.data.meshes, copies.meshes)):
            for item in items:
                kind.remove(item, do_unlink=True)
        copies.materials.remove()
        bpy.data.scenes.remove(copies.scene, do_unlink=True)


def _copy(depsgraph: bpy.types.Depsgraph, copies: _Copies, warnings: list[str]) -> None:
    meshes: dict[tuple, bpy.types.Mesh | None] = {}
    for instance in depsgraph.object_instances:
        shown = instance.object
        if not instance.show_self or not _is_for_the_camera(shown, warnings):
            continue
        for slot in shown.material_slots:
            warn_of_nodes(slot.material, warnings)
        materials = tuple(copies.materials.stand_in(slot.material) for slot in shown.material_slots)
        # One mesh for all instances of what is evaluated once, so that the program stores it once, too.
        key = (shown.data.as_pointer(), materials)
        if key not in meshes:
            meshes[key] = _copy_mesh(shown, materials)
            if meshes[key] is not None:
                copies.meshes.append(meshes[key])
        mesh = meshes[key]
        if mesh is None:
            continue
        copy = bpy.data.objects.new(shown.name, mesh)
        copies.objects.append(copy)
        copies.scene.collection.objects.link(copy)
        copy.matrix_basis = instance.matrix_world
        if _differs(copy.matrix_basis, instance.matrix_world):
            copy.matrix_basis.identity()
            copy.data = _sheared(mesh, instance.matrix_world)
            copies.meshes.append(copy.data)


def _differs(a: Matrix, b: Matrix) -> bool:
    largest = max(abs(v) for row in b for v in row)
    return max(abs(x - y) for r, s in zip(a, b) for x, y in zip(r, s)) > SMALL * largest


def _sheared(mesh: bpy.types.Mesh, matrix: Matrix) -> bpy.types.Mesh:
    """The mesh in world space. Objects have place, turn and scale of their own, but no shear, which parents bring."""
    sheared = mesh.copy()
    sheared.transform(matrix)
    if matrix.determinant() < 0:
        sheared.flip_normals()
    return sheared


def is_linked_to_lights(shown: bpy.types.Object) -> bool:
    """Light linking of Blender 4.0 and later: some lights reach some objects alone."""
    linking = getattr(shown, "light_linking", None)
    return linking is not None and bool(linking.receiver_collection or linking.blocker_collection)


def _is_for_the_camera(shown: bpy.types.Object, warnings: list[str]) -> bool:
    if shown.type in WITHOUT_EQUAL:
        warnings.append(f"'{shown.name}' is ignored: glTF has nothing like a {shown.type.lower()}")
    # Curves, texts and metaballs are listed as they are, and again as the mesh that they are evaluated to.
    if not isinstance(shown.data, bpy.types.Mesh):
        return False
    if getattr(shown, "is_holdout", False) or getattr(shown, "is_shadow_catcher", False):
        warnings.append(f"'{shown.name}' is rendered as it is, not as a holdout or shadow catcher")
    if is_linked_to_lights(shown):
        warnings.append(f"'{shown.name}' is lit by all lights, whatever its light linking says")
    if not all(getattr(shown, f"visible_{ray}", True) for ray in ("camera", "diffuse", "glossy", "shadow")):
        warnings.append(f"'{shown.name}' is visible to all rays, whatever its ray visibility says")
    return True


def _copy_mesh(shown: bpy.types.Object, materials: tuple[bpy.types.Material | None, ...]) -> bpy.types.Mesh | None:
    """None for an object without faces."""
    mesh = bpy.data.meshes.new_from_object(shown)
    if not mesh.polygons:
        bpy.data.meshes.remove(mesh)
        return None
    # Slots may be linked to the object instead of its data.
    mesh.materials.clear()
    for material in materials:
        mesh.materials.append(material)
    return mesh
