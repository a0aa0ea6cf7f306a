"""Writes knot.ply: a tube along the trefoil knot, with vertex normals. Needs nothing but Python."""

import math
import struct
from pathlib import Path

ALONG, AROUND = 216, 24  # segments along and around the tube
SCALE, TUBE = 0.33, 0.17


def curve(t):
    ring = 2 + math.cos(3 * t)
    return [SCALE * ring * math.cos(2 * t), SCALE * ring * math.sin(2 * t), SCALE * math.sin(3 * t)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


vertices = b""
for i in range(ALONG):
    t, h = 2 * math.pi * i / ALONG, 1e-4
    before, centre, after = curve(t - h), curve(t), curve(t + h)
    tangent = unit([a - b for a, b in zip(after, before)])
    bend = [a - 2 * c + b for a, c, b in zip(after, centre, before)]
    binormal = unit(cross(tangent, bend))
    normal = cross(binormal, tangent)
    for j in range(AROUND):
        phi = 2 * math.pi * j / AROUND
        out = [math.cos(phi) * n + math.sin(phi) * b for n, b in zip(normal, binormal)]
        point = [c + TUBE * o for c, o in zip(centre, out)]
        vertices += struct.pack("<6f", *point, *out)

faces = b""
for i in range(ALONG):
    for j in range(AROUND):
        a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
        c, d = (a + AROUND) % (ALONG * AROUND), (b + AROUND) % (ALONG * AROUND)
        # Counter-clockwise seen from outside: along the tube x around it points inwards.
        faces += struct.pack("<B3i", 3, a, b, d) + struct.pack("<B3i", 3, a, d, c)

header = f"""ply
format binary_little_endian 1.0
element vertex {ALONG * AROUND}
property float x
property float y
property float z
property float nx
property float ny
property float nz
element face {2 * ALONG * AROUND}
property list uchar int vertex_indices
end_header
"""
(Path(__file__).parent / "knot.ply").write_bytes(header.encode() + vertices + faces)
