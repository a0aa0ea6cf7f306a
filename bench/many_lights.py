#!/usr/bin/env python3
"""Writes a pbrt scene with many small emitters over a plain with balls: many_lights.py COUNT > scene.pbrt

Each emitter is a triangle that faces down, so that the camera sees what they light and none of them. Their
radiances spread over four powers of ten and have colours of their own.
"""

import random
import sys


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    rng = random.Random(1)
    half = count**0.5 / 2  # one emitter per unit of area
    print(f"LookAt 0 {-1.8 * half} {0.9 * half}  0 0 0  0 0 1")
    print('Camera "perspective" "float fov" 45')
    print('Film "rgb" "integer xresolution" 160 "integer yresolution" 100')
    print('Sampler "independent" "integer pixelsamples" 64')
    print('Integrator "path" "integer maxdepth" 2')
    print("WorldBegin")
    print('Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]')
    a = 2 * half
    print(f'Shape "trianglemesh" "point3 P" [{-a} {-a} 0  {a} {-a} 0  {a} {a} 0  {-a} {a} 0] '
          '"integer indices" [0 1 2  0 2 3]')  # fmt: skip
    for _ in range(40):
        x, y, r = rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(1, 4)
        print(f'AttributeBegin Translate {x:.4f} {y:.4f} {0.8 * r:.4f} Shape "sphere" "float radius" {r:.4f} AttributeEnd')
    print('Material "diffuse" "rgb reflectance" [0 0 0]')
    for _ in range(count):
        x, y, z = rng.uniform(-half, half), rng.uniform(-half, half), rng.uniform(0.5, 5)
        colour = " ".join(f"{10 ** rng.uniform(-1, 3):.4g}" for _ in range(3))
        print(f'AttributeBegin AreaLightSource "diffuse" "rgb L" [{colour}] Shape "trianglemesh" "point3 P" '
              f"[{x:.4f} {y:.4f} {z:.4f}  {x:.4f} {y + 0.1:.4f} {z:.4f}  {x + 0.1:.4f} {y:.4f} {z:.4f}] "
              '"integer indices" [0 1 2] AttributeEnd')  # fmt: skip


if __name__ == "__main__":
    main()
