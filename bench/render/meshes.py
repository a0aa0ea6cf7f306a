"""Triangle meshes: read from pbrt's parameters or a PLY file, oriented as pbrt does, written as PLY."""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import numpy as np

from pbrt_text import SceneError
from transforms import mirrors

SCALARS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
TEXTURE_COORDINATES = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))


@dataclass
class Mesh:
    points: np.ndarray  # (n, 3)
    faces: np.ndarray  # (m, 3)
    normals: Optional[np.ndarray] = None
    uv: Optional[np.ndarray] = None


def placed(mesh: Mesh, to_world: np.ndarray, reverse: bool) -> Mesh:
    """The mesh in world space. Its faces wind counterclockwise around the side that pbrt calls outside: that of the
    vertex normals if it has some (ReverseOrientation flips these), else that of the order of its vertices."""
    points = mesh.points @ to_world[:3, :3].T + to_world[:3, 3]
    faces = mesh.faces.copy()
    normals = mesh.normals
    if normals is None:
        turned = np.full(len(faces), reverse != mirrors(to_world))
    else:
        normals = normals @ np.linalg.inv(to_world[:3, :3])
        normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        if reverse:
            normals = -normals
        corners = points[faces]
        geometric = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        turned = np.einsum("ij,ij->i", geometric, normals[faces].sum(1)) < 0
    faces[turned] = faces[turned, ::-1]
    return Mesh(points, faces, normals, mesh.uv)


def write_ply(path: Path, mesh: Mesh) -> None:
    """Binary PLY. Texture coordinates are written for pictures whose first row is at v = 0; pbrt's last row is."""
    columns = [("xyz", mesh.points)]
    if mesh.normals is not None:
        columns.append((("nx", "ny", "nz"), mesh.normals))
    if mesh.uv is not None:
        columns.append((("u", "v"), np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], -1)))
    names = "".join(f"property float {name}\n" for group, _ in columns for name in group)
    vertices = np.concatenate([values for _, values in columns], axis=1).astype("<f4")
    rows = np.empty(len(mesh.faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, mesh.faces
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{names}"
        f"element face {len(rows)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(header.encode() + vertices.tobytes() + rows.tobytes())


Property = Tuple[str, str, str]  # name, type of the value, type of the count ("" if it is no list)


def read_ply(path: Path) -> Mesh:
    """ASCII or binary, polygons split into fans."""
    try:
        data = path.read_bytes()
        data = gzip.decompress(data) if path.suffix == ".gz" else data
        return _parse_ply(data)
    except (OSError, EOFError, ValueError, KeyError, IndexError) as error:
        raise SceneError(f"{path}: cannot be read as PLY ({error})") from error


def _parse_ply(data: bytes) -> Mesh:
    head, mark, _ = data.partition(b"end_header")
    if not data.startswith(b"ply") or not mark:
        raise ValueError("no PLY header")
    body = data[data.index(b"\n", len(head)) + 1 :]
    format_, elements = "", []  # type: str, List[Tuple[str, int, List[Property]]]
    for line in head.decode("ascii", errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            format_ = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][2].append((words[4], SCALARS[words[3]], SCALARS[words[2]]))
        elif words[:1] == ["property"]:
            elements[-1][2].append((words[2], SCALARS[words[1]], ""))
    read = _Ascii(body) if format_ == "ascii" else _Binary(body, "<" if "little" in format_ else ">")
    tables = {name: read.element(count, properties) for name, count, properties in elements}
    vertex, face = tables["vertex"], tables["face"]

    def columns(*names: str) -> Optional[np.ndarray]:
        return np.stack([vertex[n] for n in names], -1).astype(float) if set(names) <= set(vertex) else None

    points = columns("x", "y", "z")
    if points is None:
        raise ValueError("its vertices have no x, y and z")
    polygons = face["vertex_indices"] if "vertex_indices" in face else face["vertex_index"]
    uv = next((found for found in (columns(*names) for names in TEXTURE_COORDINATES) if found is not None), None)
    return Mesh(points, _fans(polygons), columns("nx", "ny", "nz"), uv)


def _fans(polygons) -> np.ndarray:
    if isinstance(polygons, np.ndarray):  # all of one size
        size = polygons.shape[1]
        parts = [polygons[:, [0, k, k + 1]] for k in range(1, size - 1)]
        return np.stack(parts, 1).reshape(-1, 3).astype(np.int64)
    return np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)], dtype=np.int64)


class _Ascii:
    def __init__(self, body: bytes) -> None:
        self.words, self.at = body.split(), 0

    def element(self, count: int, properties: List[Property]) -> Dict[str, object]:
        found: Dict[str, list] = {name: [] for name, _, _ in properties}
        for _ in range(count):
            for name, _, counted in properties:
                n = 1
                if counted:
                    n, self.at = int(self.words[self.at]), self.at + 1
                values = [float(w) for w in self.words[self.at : self.at + n]]
                self.at += n
                found[name].append([int(v) for v in values] if counted else values[0])
        return {name: v if _is_list(properties, name) else np.array(v) for name, v in found.items()}


class _Binary:
    def __init__(self, body: bytes, order: str) -> None:
        self.body, self.order, self.at = body, order, 0

    def element(self, count: int, properties: List[Property]) -> Dict[str, object]:
        """Rows of one size in one read; only where lists differ in length row by row."""
        sizes, at = [], self.at
        for _, type_, counted in properties:
            n = int(np.frombuffer(self.body, self.order + counted, 1, at)[0]) if counted and count else 1
            at += np.dtype(type_).itemsize * n + (np.dtype(counted).itemsize if counted else 0)
            sizes.append(n)
        fields = []
        for (name, type_, counted), n in zip(properties, sizes):
            if counted:
                fields.append(("count of " + name, self.order + counted))
            fields.append((name, self.order + type_, (n,)) if counted else (name, self.order + type_))
        row = np.dtype(fields)
        if self.at + count * row.itemsize <= len(self.body):
            table = np.frombuffer(self.body, row, count, self.at)
            if all((table["count of " + p[0]] == n).all() for p, n in zip(properties, sizes) if p[2]):
                self.at += count * row.itemsize
                return {name: table[name] for name, _, _ in properties}
        return self._rows(count, properties)

    def _rows(self, count: int, properties: List[Property]) -> Dict[str, object]:
        found: Dict[str, list] = {name: [] for name, _, _ in properties}
        for _ in range(count):
            for name, type_, counted in properties:
                n = int(self._take(counted, 1)[0]) if counted else 1
                values = self._take(type_, n)
                found[name].append(values.tolist() if counted else values[0])
        return {name: v if _is_list(properties, name) else np.array(v) for name, v in found.items()}

    def _take(self, type_: str, n: int) -> np.ndarray:
        values = np.frombuffer(self.body, self.order + type_, n, self.at)
        self.at += values.nbytes
        return values


def _is_list(properties: List[Property], name: str) -> bool:
    return any(p[0] == name and p[2] for p in properties)
