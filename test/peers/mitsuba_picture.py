"""Renders a scene with moments by Mitsuba: mean and variance of a sample of each pixel, in CIE XYZ.

Usage: mitsuba_picture.py VARIANT SCENE.xml SPP SEED OUT.npz
"""

from __future__ import annotations

import sys

import numpy as np


def main() -> int:
    variant, scene, spp, seed, out = sys.argv[1:]
    import mitsuba as mi

    mi.set_variant(variant)
    loaded = mi.load_file(scene, optimize=False)
    picture = np.array(mi.render(loaded, spp=int(spp), seed=int(seed)), dtype=np.float64)
    # R, G, B (and alpha, if the film has it), then X, Y, Z and the means of their squares.
    mean, square = picture[..., -6:-3], picture[..., -3:]
    np.savez(out, mean=mean, variance=np.maximum(square - mean**2, 0))
    return 0


if __name__ == "__main__":
    sys.exit(main())
