"""Uniform numbers to points of a density, and back.

Each warp has `sample(u)`, `pdf(x)` and `inverse(x)` on arrays of shape (n, coordinates), or (n,) for one. Those
without parameters are objects (`warp.cosine_hemisphere.sample(u)`), the others functions that make them
(`warp.uniform_cone(0.9).sample(u)`). Directions are unit vectors around +z.
"""

from __future__ import annotations

from ._core import warp as _warp

Warp = _warp.Warp

bilinear = _warp.bilinear
cosine = _warp.cosine
cosine_hemisphere = _warp.cosine_hemisphere
equal_area_sphere = _warp.equal_area_sphere
exponential = _warp.exponential
linear = _warp.linear
quadratic = _warp.quadratic
spherical_rectangle = _warp.spherical_rectangle
spherical_triangle = _warp.spherical_triangle
tent = _warp.tent
uniform_cone = _warp.uniform_cone
uniform_disk_concentric = _warp.uniform_disk_concentric
uniform_disk_polar = _warp.uniform_disk_polar
uniform_hemisphere = _warp.uniform_hemisphere
uniform_sphere = _warp.uniform_sphere
uniform_triangle = _warp.uniform_triangle
uniform_triangle_low_distortion = _warp.uniform_triangle_low_distortion
