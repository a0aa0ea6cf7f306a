"""Writes a fog volume as a NanoVDB file (version 32.4, compressed by zlib) without NanoVDB."""

import struct
import zlib

import numpy as np

HAS_BBOX, IS_BREADTH_FIRST, FLOAT, FOG_VOLUME, ZIP = 2, 32, 1, 2, 1
VERSION = 32 << 21 | 4 << 10 | 2
GRID, TREE, ROOT, ROOT_TILE = 672, 64, 64, 32
UPPER, LOWER, LEAF = 270400, 33856, 2144
UPPER_TABLE, LOWER_TABLE, LEAF_VALUES = 8256, 1088, 96  # where they begin


def bits(indices, count):
    on = np.zeros(count, np.uint8)
    on[indices] = 1
    return np.packbits(on, bitorder="little").tobytes()


def write_fog(path, name, values, first=(0, 0, 0), voxel_size=1.0, origin=(0.0, 0.0, 0.0)):
    """values[x, y, z] is the density of voxel first + (x, y, z), whose centre is at
    origin + voxel_size * (first + (x, y, z)). Zero voxels are left out."""
    values = np.asarray(values, np.float32)
    first = np.asarray(first)
    low = first // 8 * 8
    padded_shape = (first + values.shape - low + 7) // 8 * 8
    padded = np.zeros(padded_shape, np.float32)
    at = first - low
    padded[tuple(slice(a, a + n) for a, n in zip(at, values.shape))] = values
    active = np.argwhere(padded) + low
    lower_corner, upper_corner = active.min(axis=0), active.max(axis=0)

    # Leaves by their lower nodes, those by their upper nodes.
    blocks = padded.reshape(padded_shape[0] // 8, 8, padded_shape[1] // 8, 8, padded_shape[2] // 8, 8)
    blocks = blocks.transpose(0, 2, 4, 1, 3, 5).reshape(*(padded_shape // 8), 512)
    tree = {}
    for block in np.argwhere(blocks.any(axis=-1)):
        corner = low + 8 * block
        upper, lower = tuple(corner // 4096), tuple(corner // 128)
        tree.setdefault(upper, {}).setdefault(lower, {})[tuple(corner)] = blocks[tuple(block)]
    lowers = [l for u in sorted(tree) for l in sorted(tree[u])]
    leaves = {l: sorted(tree[u][l]) for u in tree for l in tree[u]}
    upper_at = GRID + TREE + ROOT + ROOT_TILE * len(tree)
    lower_at = upper_at + UPPER * len(tree)
    leaf_at = lower_at + LOWER * len(lowers)
    leaf_count = sum(map(len, leaves.values()))
    data = bytearray(leaf_at + LEAF * leaf_count)

    scale = (voxel_size,) * 3
    diagonal = lambda s: (s, 0, 0, 0, s, 0, 0, 0, s)
    s, inverse = diagonal(voxel_size), diagonal(1 / voxel_size)
    world = [o + voxel_size * c for o, c in zip(origin * 2, (*lower_corner, *(upper_corner + 1)))]
    struct.pack_into("<QQIIIIQ256s", data, 0, int.from_bytes(b"NanoVDB0", "little"), 2**64 - 1, VERSION,
                     HAS_BBOX | IS_BREADTH_FIRST, 0, 1, len(data), name.encode())
    struct.pack_into("<9f9f3ff9d9d3dd", data, 296, *s, *inverse, *origin, 1, *s, *inverse, *origin, 1)
    struct.pack_into("<6d3dII", data, 560, *world, *scale, FOG_VOLUME, FLOAT)
    box = (*lower_corner.tolist(), *upper_corner.tolist())
    struct.pack_into("<4Q3I3IQ", data, GRID, leaf_at - GRID, lower_at - GRID, upper_at - GRID, TREE,
                     leaf_count, len(lowers), len(tree), 0, 0, 0, len(active))
    root = GRID + TREE
    struct.pack_into("<6iI", data, root, *box, len(tree))

    lower_index = {l: i for i, l in enumerate(lowers)}
    leaf = 0
    for i, u in enumerate(sorted(tree)):
        upper = upper_at + i * UPPER
        key = sum((int(c) & 0xFFFFF) << shift for c, shift in zip(u, (42, 21, 0)))
        struct.pack_into("<Qq", data, root + ROOT + i * ROOT_TILE, key, upper - root)
        struct.pack_into("<6i", data, upper, *box)
        places = []
        for l in sorted(tree[u]):
            x, y, z = (int(c) % 32 for c in l)
            places.append(x << 10 | y << 5 | z)
            lower = lower_at + lower_index[l] * LOWER
            struct.pack_into("<q", data, upper + UPPER_TABLE + 8 * places[-1], lower - upper)
            struct.pack_into("<6i", data, lower, *box)
            children = []
            for corner in leaves[l]:
                x, y, z = (int(c) // 8 % 16 for c in corner)
                children.append(x << 8 | y << 4 | z)
                node = leaf_at + leaf * LEAF
                leaf += 1
                struct.pack_into("<q", data, lower + LOWER_TABLE + 8 * children[-1], node - lower)
                block = tree[u][l][corner]
                struct.pack_into("<3i4B", data, node, *map(int, corner), 7, 7, 7, 2)
                data[node + 16:node + 80] = bits(np.flatnonzero(block), 512)
                data[node + LEAF_VALUES:node + LEAF] = block.astype("<f4").tobytes()
            data[lower + 32 + 512:lower + 32 + 1024] = bits(children, 4096)
        data[upper + 32 + 4096:upper + 32 + 8192] = bits(places, 32768)

    packed = zlib.compress(bytes(data), 9)
    text = name.encode() + b"\0"
    with open(path, "wb") as file:
        file.write(struct.pack("<8sIHH", b"NanoVDB0", VERSION, 1, ZIP))
        file.write(struct.pack("<4Q2I6d6i3dI4I3I2HI", len(data), 8 + len(packed), 0, len(active), FLOAT, FOG_VOLUME,
                               *world, *box, *scale, len(text), leaf_count, len(lowers), len(tree), 1, 0, 0, 0,
                               ZIP, 0, VERSION))
        file.write(text + struct.pack("<Q", len(packed)) + packed)
