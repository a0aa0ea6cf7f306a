# SPDX-License-Identifier: GPL-3.0-or-later
"""A binary glTF file that can be read, added to, and written."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np

MAGIC, VERSION, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
FLOAT, UNSIGNED_INT = 5126, 5125
VERTICES, INDICES = 34962, 34963


class Glb:
    def __init__(self, data: bytes):
        magic, version, _ = struct.unpack_from("<III", data)
        if magic != MAGIC or version != VERSION:
            raise ValueError("not a binary glTF 2.0 file")
        self.json: dict = {}
        self.binary = bytearray()
        at = 12
        while at < len(data):
            size, kind = struct.unpack_from("<II", data, at)
            chunk = data[at + 8 : at + 8 + size]
            if kind == JSON_CHUNK:
                self.json = json.loads(chunk)
            elif kind == BINARY_CHUNK:
                self.binary += chunk
            at += 8 + size

    @classmethod
    def read(cls, path: Path) -> Glb:
        return cls(path.read_bytes())

    def write(self, path: Path) -> None:
        self._align()
        if self.binary:
            self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
        if self.binary:
            chunks += struct.pack("<II", len(self.binary), BINARY_CHUNK) + bytes(self.binary)
        path.write_bytes(struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks)

    def _align(self) -> None:
        self.binary += b"\0" * (-len(self.binary) % 4)

    def add(self, kind: str, item: dict) -> int:
        """Appends to a top-level array such as `materials`; its index."""
        items = self.json.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def add_light(self, light: dict) -> int:
        """Appends to the lights of KHR_lights_punctual; its index."""
        self.use_extension("KHR_lights_punctual")
        extensions = self.json.setdefault("extensions", {})
        lights = extensions.setdefault("KHR_lights_punctual", {}).setdefault("lights", [])
        lights.append(light)
        return len(lights) - 1

    def add_root(self, node: dict) -> None:
        """A node at the root of the scene."""
        index = self.add("nodes", node)
        if not self.json.get("scenes"):
            self.json["scenes"] = [{}]
        scene = self.json["scenes"][self.json.setdefault("scene", 0)]
        scene.setdefault("nodes", []).append(index)

    def use_extension(self, name: str) -> None:
        used = self.json.setdefault("extensionsUsed", [])
        if name not in used:
            used.append(name)

    def add_mesh(self, name: str, positions: np.ndarray, triangles: np.ndarray, material: int) -> int:
        """Positions of shape (n, 3), triangles of shape (m, 3); the mesh's index."""
        points = np.ascontiguousarray(positions, "<f4")
        corners = np.ascontiguousarray(triangles, "<u4").reshape(-1)
        position = self._add_accessor(points, VERTICES, FLOAT, "VEC3")
        self.json["accessors"][position].update(min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist())
        indices = self._add_accessor(corners, INDICES, UNSIGNED_INT, "SCALAR")
        primitive = {"attributes": {"POSITION": position}, "indices": indices, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def _add_accessor(self, values: np.ndarray, target: int, component: int, kind: str) -> int:
        self._align()
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": values.nbytes, "target": target}
        self.binary += values.tobytes()
        accessor = {"bufferView": self.add("bufferViews", view), "componentType": component}
        return self.add("accessors", {**accessor, "count": len(values), "type": kind})
