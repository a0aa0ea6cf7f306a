"""What Blender renders is exported: render levels, instances, visibility, materials of objects."""

from __future__ import annotations

import json
from pathlib import Path

import bmesh
import bpy
import numpy as np
from blender_scene import BlenderScene
from watched_program import WatchedProgram


def exported(run: Path) -> dict:
    data = (run / "scene.glb").read_bytes()
    return json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])


def triangles_of(document: dict) -> list[int]:
    primitives = [mesh["primitives"] for mesh in document.get("meshes", [])]
    return [sum(document["accessors"][p["indices"]]["count"] // 3 for p in mesh) for mesh in primitives]


def mesh_places(document: dict) -> list[tuple[float, ...]]:
    """Of nodes with a mesh, in Blender's axes."""
    places = [node.get("translation", [0, 0, 0]) for node in document["nodes"] if "mesh" in node]
    return sorted((round(x, 3), round(-z, 3), round(y, 3)) for x, y, z in places)


def test_render_levels(scene: BlenderScene, watched: WatchedProgram) -> None:
    modifier = scene.add_cube().modifiers.new("smooth", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 2
    scene.render()
    assert triangles_of(exported(watched.runs[0])) == [6 * 16 * 2]


def test_hidden_objects(scene: BlenderScene, watched: WatchedProgram) -> None:
    scene.add_cube(place=(0, 0, 0)).hide_render = True
    scene.add_cube(place=(1, 0, 0)).hide_set(True)  # in the viewport only
    scene.add_cube(place=(2, 0, 0)).hide_viewport = True
    hidden = bpy.data.collections.new("hidden")
    scene.scene.collection.children.link(hidden)
    cube = scene.add_cube(place=(3, 0, 0))
    scene.scene.collection.objects.unlink(cube)
    hidden.objects.link(cube)
    hidden.hide_render = True
    scene.render()
    assert mesh_places(exported(watched.runs[0])) == [(1, 0, 0), (2, 0, 0)]


def test_instances_share_a_mesh(scene: BlenderScene, watched: WatchedProgram) -> None:
    group = bpy.data.collections.new("group")
    cube = scene.add_cube(place=(0, 0.5, 0))
    scene.scene.collection.objects.unlink(cube)
    group.objects.link(cube)
    light = scene.add_light("POINT", (0, 0, 1), energy=10)
    scene.scene.collection.objects.unlink(light)
    group.objects.link(light)
    for x in (-2, 1):
        empty = scene.add(f"place {x}", None, (x, 0, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", group
    scene.render()
    document = exported(watched.runs[0])
    assert mesh_places(document) == [(-2, 0.5, 0), (1, 0.5, 0)]
    assert len(document["meshes"]) == 1
    lights = [
        node["matrix"][12:15] for node in document["nodes"] if "KHR_lights_punctual" in node.get("extensions", {})
    ]
    assert sorted(lights) == [[-2, 1, 0], [1, 1, 0]]


def test_children_of_faces(scene: BlenderScene, watched: WatchedProgram) -> None:
    parent, child = scene.add_plane(2), scene.add_cube(0.2, name="child")
    child.parent = parent
    parent.instance_type, parent.show_instancer_for_render = "VERTS", False
    scene.render()
    assert mesh_places(exported(watched.runs[0])) == [(-1, -1, 0), (-1, 1, 0), (1, -1, 0), (1, 1, 0)]


def test_particles(scene: BlenderScene, watched: WatchedProgram) -> None:
    """Objects at particles, without the surface that emits them."""
    emitter = scene.add_plane(2)
    emitter.modifiers.new("particles", "PARTICLE_SYSTEM")
    particles = emitter.particle_systems[0].settings
    particles.count, particles.frame_start, particles.frame_end, particles.lifetime = 5, 1, 1, 100
    particles.physics_type, particles.render_type = "NO", "OBJECT"
    particles.instance_object = scene.add_cube(0.2, (9, 9, 9))
    emitter.show_instancer_for_render = False
    scene.render()
    document = exported(watched.runs[0])
    places = mesh_places(document)
    assert len(places) == 6 and (9, 9, 9) in places
    assert len(document["meshes"]) == 1, "the plane is exported, or each particle has a mesh of its own"


def test_geometry_nodes(scene: BlenderScene, watched: WatchedProgram) -> None:
    tree = bpy.data.node_groups.new("two balls", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    line, ball, instance = (
        tree.nodes.new(kind)
        for kind in ("GeometryNodeMeshLine", "GeometryNodeMeshUVSphere", "GeometryNodeInstanceOnPoints")
    )
    line.inputs["Count"].default_value = 2
    line.inputs["Offset"].default_value = (3, 0, 0)
    tree.links.new(line.outputs["Mesh"], instance.inputs["Points"])
    tree.links.new(ball.outputs["Mesh"], instance.inputs["Instance"])
    tree.links.new(instance.outputs["Instances"], tree.nodes.new("NodeGroupOutput").inputs[0])
    scene.add_plane().modifiers.new("nodes", "NODES").node_group = tree
    scene.render()
    document = exported(watched.runs[0])
    assert mesh_places(document) == [(0, 0, 0), (3, 0, 0)]
    assert len(document["meshes"]) == 1


def test_curves_texts_and_metaballs(scene: BlenderScene, watched: WatchedProgram) -> None:
    text = bpy.data.curves.new("text", "FONT")
    text.body, text.extrude = "M", 0.1
    scene.add("text", text)
    curve = bpy.data.curves.new("ring", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    curve.splines.new("POLY").points.add(2)
    for point, place in zip(curve.splines[0].points, ((0, 0, 0, 1), (1, 0, 0, 1), (1, 1, 0, 1))):
        point.co = place
    scene.add("ring", curve)
    scene.add("empty mesh", bpy.data.meshes.new("empty"))
    for place in ((3, 0, 0), (4, 0, 0)):  # of one family: the first one has the surface of both
        ball = bpy.data.metaballs.new("ball")
        ball.elements.new()
        scene.add("ball", ball, place)
    scene.render()
    assert len(triangles_of(exported(watched.runs[0]))) == 3


def test_materials_of_objects(scene: BlenderScene) -> None:
    """Two objects of one mesh, with materials of their own."""
    first = scene.add_plane(2, (-1, 0, 0), colour=(0.8, 0, 0))
    second = scene.add("second", first.data, (1, 0, 0))
    second.material_slots[0].link = "OBJECT"
    second.material_slots[0].material = scene.matt("blue", (0, 0, 0.8))
    scene.add_light("SUN", energy=3, angle=0)
    left, right = scene.render()[16, 20, :3], scene.render()[16, 28, :3]
    assert left[0] > 5 * abs(left[2]) and right[2] > 5 * abs(right[0])


def test_edit_mode(scene: BlenderScene, watched: WatchedProgram) -> None:
    cube = scene.add_cube()
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(cube.data)
    bmesh.ops.translate(edited, verts=edited.verts, vec=(0, 0, 5))
    bmesh.update_edit_mesh(cube.data)
    scene.render()
    assert cube.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    document = exported(watched.runs[0])
    heights = [
        document["accessors"][m["primitives"][0]["attributes"]["POSITION"]]["max"][1] for m in document["meshes"]
    ]
    assert heights == [5.5]


def test_picture_on_a_surface(scene: BlenderScene) -> None:
    """A texture of two colours keeps its places and values; its sRGB codes are decoded."""
    plane = scene.add_plane(4)
    plane.data.uv_layers.new(name="UVMap")
    for loop, uv in zip(plane.data.uv_layers[0].data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = uv
    image = bpy.data.images.new("codes", 2, 1)
    image.pixels = (1, 0, 0, 1, 0, 0.5, 0, 1)
    tree = plane.data.materials[0].node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    scene.add_light("SUN", energy=np.pi, angle=0)
    scene.scene.montelux.samples = 256
    ours, theirs = scene.render(), scene.render_by_cycles(64)
    for x in (slice(17, 23), slice(25, 31)):
        a, b = ours[13:19, x, :3].mean(axis=(0, 1)), theirs[13:19, x, :3].mean(axis=(0, 1))
        assert np.abs(a - b).max() < 0.02
