"""Writes cloud.nvdb: a cumulus of billows upon billows, with a flat base. Needs NumPy."""

from pathlib import Path

import numpy as np

from nanovdb import write_fog

VOXEL = 0.0125  # km
BASE, TOP = 0.9, 2.35  # km
random = np.random.default_rng(20)


def billows():
    """Spheres (x, y, z, radius): a few large ones, each covered by smaller ones, twice over."""
    level = [np.array(s) for s in (
        (0, 0, 1.35, 0.42), (0.5, 0.12, 1.2, 0.32), (-0.52, -0.05, 1.18, 0.33), (0.1, -0.3, 1.15, 0.3),
        (-0.1, 0.35, 1.2, 0.32), (0.12, 0.02, 1.72, 0.3), (-0.95, 0.1, 1.05, 0.2), (0.95, -0.05, 1.05, 0.22),
        (-0.28, -0.28, 1.1, 0.26), (0.5, -0.28, 1.05, 0.2))]
    spheres = list(level)
    for count, share, spread in ((22, 0.42, 0.85), (14, 0.42, 0.9)):
        children = []
        for parent in level:
            for _ in range(count):
                d = random.normal(size=3)
                d /= np.linalg.norm(d)
                d[2] = abs(d[2]) if random.random() < 0.75 else d[2]
                radius = parent[3] * share * random.uniform(0.6, 1.15)
                children.append(np.array([*(parent[:3] + d * parent[3] * spread), radius]))
        spheres += children
        level = children
    return [s for s in spheres if s[2] + s[3] > BASE]


def noise(points, cell):
    """Value noise in [-1, 1] at points[..., 3], with features of size `cell`, smooth to the first derivative."""
    p = points / cell
    i = np.floor(p).astype(np.int64)
    f = p - i
    f = f * f * (3 - 2 * f)
    lattice = np.random.default_rng(int(1e6 * cell)).uniform(-1, 1, 1 << 16)
    total = 0
    for corner in np.ndindex(2, 2, 2):
        j = i + corner
        h = (j[..., 0] * 73856093 ^ j[..., 1] * 19349663 ^ j[..., 2] * 83492791) & 0xFFFF
        weight = np.prod(np.where(corner, f, 1 - f), axis=-1)
        total = total + weight * lattice[h]
    return total


spheres = billows()
low = np.array([min(s[a] - s[3] for s in spheres) for a in range(3)]) - 0.1
high = np.array([max(s[a] + s[3] for s in spheres) for a in range(3)]) + 0.1
low[2] = BASE - 0.06
size = np.ceil((high - low) / VOXEL).astype(int)
axes = [low[a] + VOXEL * np.arange(size[a]) for a in range(3)]

# Depth below the surface of the union of spheres, km.
depth = np.full(size, -1.0, np.float32)
for x, y, z, r in spheres:
    window = [slice(max(0, int((c - r - 0.1 - low[a]) / VOXEL)), int((c + r + 0.1 - low[a]) / VOXEL) + 1)
              for a, c in enumerate((x, y, z))]
    dx, dy, dz = (axes[a][window[a]] - c for a, c in enumerate((x, y, z)))
    distance = np.sqrt(dx[:, None, None] ** 2 + dy[None, :, None] ** 2 + dz[None, None, :] ** 2)
    depth[tuple(window)] = np.maximum(depth[tuple(window)], r - distance)

# Smaller billows, with creases between them, and wisps.
near = np.argwhere(np.abs(depth) < 0.15)
points = low + VOXEL * near
puffs = sum((1 - 2.5 * np.abs(noise(points, 0.2 / 2**k))) * 0.55**k for k in range(3))
wisps = noise(points, 0.04)
depth[tuple(near.T)] += (0.035 * puffs + 0.012 * wisps).astype(np.float32)
flat = (axes[2] - BASE)[None, None, :] + 0.03 * noise(
    np.stack(np.meshgrid(axes[0], axes[1], [0.0], indexing="ij"), -1), 0.2)
depth = np.minimum(depth, 0.6 * flat)

density = np.clip(depth / 0.035, 0, 1)
density = np.round(density * density * (3 - 2 * density) * 15) / 15  # a few levels compress well
write_fog(Path(__file__).parent / "cloud.nvdb", "density", density, voxel_size=VOXEL, origin=tuple(low))
print(size, np.mean(density > 0))
