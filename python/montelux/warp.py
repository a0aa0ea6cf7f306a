"""Uniform numbers to points of a density, and back.

Each warp has `sample(u)`, `pdf(x)` and `inverse(x)` on arrays of shape (n, coordinates), or (n,) for one. Those
without parameters are objects (`warp.cosine_hemisphere.sample(u)`), the others functions that make them
(`warp.uniform_cone(0.9).sample(u)`). Directions are unit vectors around +z.
"""

from __future__ import annotations

from . import _core

Warp = _core.Warp

bilinear = _core.warp_bilinear
cosine = _core.warp_cosine
cosine_hemisphere = _core.warp_cosine_hemisphere
equal_area_sphere = _core.warp_equal_area_sphere
exponential = _core.warp_exponential
ggx_normals = _core.warp_ggx_normals
ggx_visible_normals = _core.warp_ggx_visible_normals
linear = _core.warp_linear
quadratic = _core.warp_quadratic
spherical_rectangle = _core.warp_spherical_rectangle
spherical_triangle = _core.warp_spherical_triangle
tabulated = _core.warp_tabulated
tent = _core.warp_tent
uniform_cone = _core.warp_uniform_cone
uniform_disk_concentric = _core.warp_uniform_disk_concentric
uniform_disk_polar = _core.warp_uniform_disk_polar
uniform_hemisphere = _core.warp_uniform_hemisphere
uniform_sphere = _core.warp_uniform_sphere
uniform_triangle = _core.warp_uniform_triangle
uniform_triangle_low_distortion = _core.warp_uniform_triangle_low_distortion
