# SPDX-License-Identifier: GPL-3.0-or-later
"""What materials mean in Blender and not in glTF: solid glass, surfaces without a material, nodes that are left out."""

from __future__ import annotations

import bpy

from .glb import Glb

# Nodes that Blender's exporter reads, in some places at least.
EXPORTED_NODES = {
    "NodeFrame",
    "NodeReroute",
    "ShaderNodeAttribute",
    "ShaderNodeBackground",
    "ShaderNodeBsdfPrincipled",
    "ShaderNodeBsdfTransparent",
    "ShaderNodeEmission",
    "ShaderNodeGroup",
    "ShaderNodeLightPath",
    "ShaderNodeMapping",
    "ShaderNodeMath",
    "ShaderNodeMix",
    "ShaderNodeMixRGB",
    "ShaderNodeMixShader",
    "ShaderNodeNormalMap",
    "ShaderNodeOutputMaterial",
    "ShaderNodeRGB",
    "ShaderNodeSeparateColor",
    "ShaderNodeSeparateRGB",
    "ShaderNodeTexCoord",
    "ShaderNodeTexImage",
    "ShaderNodeUVMap",
    "ShaderNodeValue",
    "ShaderNodeVertexColor",
}
GREY, ROUGHNESS = 0.8, 0.5  # of Blender's surfaces without a material, a Principled BSDF


def make_glass_solid(glb: Glb) -> None:
    """Gives materials that transmit a volume, without which glTF means a sheet (docs/gltf.md): Blender's transmission
    bends light at every surface."""
    for material in glb.json.get("materials", []):
        extensions = material.get("extensions", {})
        if "KHR_materials_transmission" in extensions and "KHR_materials_volume" not in extensions:
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1}
            glb.use_extension("KHR_materials_volume")


def add_missing_material(glb: Glb) -> None:
    """Makes surfaces without a material light grey plastic, as Cycles does: in glTF they are rough white metal."""
    bare = [p for mesh in glb.json.get("meshes", []) for p in mesh["primitives"] if "material" not in p]
    if not bare:
        return
    shader = {"baseColorFactor": [GREY, GREY, GREY, 1], "metallicFactor": 0, "roughnessFactor": ROUGHNESS}
    material = glb.add("materials", {"pbrMetallicRoughness": shader})
    for primitive in bare:
        primitive["material"] = material


def warn_of_nodes(material: bpy.types.Material | None, warnings: list[str]) -> None:
    """Names the nodes that have a part in the surface and that the exporter leaves out."""
    if material is None or material.node_tree is None:
        return
    output = material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")
    reached, left = set(), [output] if output else []
    while left:
        node = left.pop()
        if node.name in reached:
            continue
        reached.add(node.name)
        left += [link.from_node for socket in node.inputs for link in socket.links]
        if node.bl_idname not in EXPORTED_NODES:
            warnings.append(f"Material '{material.name}': its node '{node.bl_label}' is not exported")
