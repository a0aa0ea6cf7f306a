# %% [markdown]
# # Rendering: pictures with error bars
#
# For people who make pictures and for those who measure with them. A rendered pixel is an integral over light paths, estimated
# from random samples; Montelux keeps the error of every one. This notebook builds a scene in Python, renders it, and asks
# how far its numbers can be believed.

# %%
import numpy as np

import montelux

# %%
import matplotlib.pyplot as plt

plt.rcParams.update({"figure.figsize": (6.4, 3.4), "figure.dpi": 80, "figure.constrained_layout.use": True})
plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
blue, orange, green, purple = "#0072B2", "#D55E00", "#009E73", "#CC79A7"  # Okabe and Ito (2008)

# %% [markdown]
# ## A scene from nothing
#
# A camera, light, and shapes with materials. Lengths are in any unit; z is up here because `look_at` says so. Coordinates
# are left-handed, as in pbrt: with z up and y away from us, x grows to the left.

# %%
scene = montelux.Scene()
scene.camera = montelux.PerspectiveCamera(fov=32, look_at=((0.8, -7, 3), (0, 0, 0.75), (0, 0, 1)))
scene.film.resolution = 144, 108

floor = np.array([[-8, -8, 0], [8, -8, 0], [8, 4, 0], [-8, 4, 0]])
tiles = montelux.Diffuse(reflectance=scene.checkerboard_texture(0.25, 0.6, 16, 12))
square = [[0, 1, 2], [0, 2, 3]]  # two triangles
scene.add_mesh(floor, square, tiles, uvs=[[0, 0], [1, 0], [1, 1], [0, 1]])
wall = np.array([[-8, 4, 0], [8, 4, 0], [8, 4, 9], [-8, 4, 9]])
scene.add_mesh(wall, square, montelux.Diffuse(reflectance=(0.35, 0.45, 0.6)))

scene.add_sphere(0.8, montelux.Dielectric(eta=1.5), centre=(1.3, -0.6, 0.8))
clay = scene.add_sphere(0.6, montelux.Diffuse(reflectance=(0.7, 0.25, 0.15)), centre=(-1.7, -0.9, 0.6))

lamp = scene.add_disk(1.5, montelux.Diffuse(), height=5, light=(10, 9, 7))
lamp.flip_normal = True  # shapes shine from one side, a disk from its upper one
scene.add_sphere(1.5, montelux.Diffuse(), centre=(-5, -5, 5), light=(4, 4, 5))
scene

# %% [markdown]
# Meshes are arrays: vertices of shape `(n, 3)` and triangles of shape `(m, 3)`. A torus of gold, whose optical constants
# are known by name:


# %%
def torus(big, small, around, across):
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, around), np.linspace(0, 2 * np.pi, across), indexing="ij")
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    middle = big * np.stack([np.cos(u), np.sin(u), np.zeros_like(u)], -1).reshape(-1, 3)
    a = (np.arange(around - 1)[:, None] * across + np.arange(across - 1)).ravel()
    triangles = np.concatenate(
        [np.stack([a, a + across, a + across + 1], -1), np.stack([a, a + across + 1, a + 1], -1)]
    )
    return middle + small * normals, triangles, normals


positions, triangles, normals = torus(0.85, 0.3, 65, 33)
gold = montelux.Conductor(eta="metal-Au-eta", k="metal-Au-k", roughness=0.15)
tilt = np.array([[1, 0, 0, -0.4], [0, 0.5, -0.866, 0.6], [0, 0.866, 0.5, 1.1], [0, 0, 0, 1.0]])
ring = scene.add_mesh(positions, triangles, gold, normals=normals, transform=tilt)
print(scene)

# %% [markdown]
# ## Render
#
# `render` returns at once and continues in the background on all processors; whatever you ask of it waits for the end. A notebook shows
# the picture by itself.

# %%
render = scene.render(spp=32)
render

# %% [markdown]
# ## What a render is: arrays
#
# `mean` is linear sRGB, row 0 at the top. `standard_error` is one standard deviation of each of its numbers. `layers` has
# both and more, among them depth, albedo and normal of the first surface.

# %%
print(render.mean.shape, render.mean.dtype)
y, x = 67, 122  # on the ball of clay
for name, mean, error in zip("RGB", render.mean[y, x], render.standard_error[y, x]):
    print(f"pixel ({x}, {y}) {name}: {mean:.3f} +- {error:.3f}")
print("layers:", ", ".join(render.layers))

# %%
figure, axes = plt.subplots(1, 3, figsize=(8.4, 2.0))
error = axes[0].imshow(render.standard_error.mean(axis=2), cmap="cividis", vmax=0.3)
figure.colorbar(error, label="radiance")
depth = axes[1].imshow(render.layers["depth"], cmap="cividis")
figure.colorbar(depth, label="distance")
axes[2].imshow(np.clip(render.layers["albedo"], 0, 1))
for a, title in zip(axes, ("standard error", "depth", "albedo")):
    a.set(title=title, xticks=[], yticks=[])
plt.show()

# %% [markdown]
# The error is largest where few paths carry much light: in the glass and in the caustic that it throws. `relative_error` is
# the whole picture's: root mean square over the pixels, over the picture's mean. Four times the samples would halve it if they
# were independent; the default points, Sobol's, do a little better. Experiments go faster on a smaller film:

# %%
scene.film.resolution = 72, 54
renders = {samples: scene.render(spp=samples, seed=samples) for samples in (8, 32, 128)}
for samples, r in renders.items():
    print(f"{samples:4} samples per pixel: relative error {100 * r.relative_error:.2f} %")

# %% [markdown]
# ## Is the error of a pixel honest?
#
# Compare with a longer render of another seed: `compare` gives figures of the distance, and, where both errors are known,
# $z = (a - b) / \sqrt{\sigma_a^2 + \sigma_b^2}$, which would be standard normal over the pixels if all errors were exact.

# %%
short, long = renders[32], renders[128]
montelux.compare(short, long)

# %% [markdown]
# The scores spread a little too widely, and lean to one side, for two reasons. First, the error of Sobol's points is made of
# a few randomised replicates and is itself uncertain (`layers["replicates"]` counts them); independent samples have more. Second,
# pixels that have not met their rare bright paths yet are too dark *and* too sure of it. Pooled over 3 x 3 pixels most of both goes
# away. Once more with independent samples:

# %%
scene.sampler.kind = "independent"
short_independent, long_independent = scene.render(spp=32), scene.render(spp=64, seed=1)
for name, a, b in (("sobol", short, long), ("independent", short_independent, long_independent)):
    z = montelux.compare(a, b).z
    shares = ", ".join(f"{100 * share:.1f}" for share in z.within)
    print(
        f"{name:12} {a.layers['replicates'][0, 0]:.0f} replicates; within 1, 2, 3 errors: {shares} % (normal: 68.3, 95.4, 99.7 %)"
    )
scene.sampler.kind = "sobol"

# %%
figure, axes = plt.subplots()
t = np.linspace(-5, 5, 200)
for (a, b), colour, name in (
    ((short, long), blue, "Sobol'"),
    ((short_independent, long_independent), green, "independent"),
):
    z = ((a.mean - b.mean) / np.sqrt(a.standard_error**2 + b.standard_error**2)).ravel()
    axes.hist(z, bins=np.linspace(-5, 5, 41), density=True, histtype="step", lw=2, color=colour, label=name)
axes.plot(t, np.exp(-t * t / 2) / np.sqrt(2 * np.pi), "--", color=orange, lw=2, label="normal law")
axes.set(xlabel="z of pixels and channels", ylabel="density")
axes.legend()
plt.show()

# %% [markdown]
# [docs/render-to-an-error.md](../render-to-an-error.md) measures this against references of another renderer.
#
# ## Ask for an error instead of a number of samples
#
# With `target_error` samples go where they help most, until the relative error is there. The layer `samples` shows
# where they went.

# %%
aimed = scene.render(target_error=0.1)
for name, r in (("to an error", aimed), ("equally", renders[128])):
    print(f"{name:12} {r.spp:5.1f} samples per pixel, relative error {100 * r.relative_error:.1f} %, by {r.stopped_by}")
print(f"samples of a pixel: from {aimed.layers['samples'].min():.0f} to {aimed.layers['samples'].max():.0f}")

# %%
figure, axes = plt.subplots(1, 2, figsize=(7.4, 2.7))
axes[0].imshow(aimed.to_srgb(0))
counts = axes[1].imshow(aimed.layers["samples"], cmap="cividis", norm="log")
figure.colorbar(counts, label="samples")
for a, title in zip(axes, ("rendered to 10 %", "where the samples went")):
    a.set(title=title, xticks=[], yticks=[])
plt.show()

# %% [markdown]
# ## Watch it
#
# Iterating over a render gives a picture every so many seconds, each with its error, and at last the finished one. How many depends
# on your machine; looking changes no bit of the result. `render.stop()` and Ctrl-C end it with what there is.

# %% tags=["varies"]
for picture in scene.render(spp=32, every=0.2):
    print(picture)

# %% [markdown]
# ## Change something
#
# Objects read from a scene refer to it: setting an attribute changes the scene. Renders in progress do not change.

# %%
clay.material.reflectance = (0.1, 0.35, 0.6)
ring.material = montelux.CoatedDiffuse(reflectance=(0.15, 0.5, 0.3), roughness=0.05)
lamp.light.scale *= 1.5
scene.camera.fov = 27
scene.film.resolution = 144, 108
scene.render(spp=32)

# %% [markdown]
# Names that do not exist are answered with the nearest one that does:

# %%
try:
    scene.camera.fow = 30
except montelux.Error as error:
    print(error)

# %% [markdown]
# ## Save, and compare files
#
# `.exr` keeps all layers and how the picture was made; `.png` is for screens. `montelux compare` and `montelux info` read the same
# files from the shell.

# %%
render.save("scene.exr")
render.save("scene.png")
channels = montelux.read_channels("scene.exr")
print(len(channels), "channels:", ", ".join(list(channels)[:8]), "...")
print("the file is the picture:", np.array_equal(channels["G"], render.mean[:, :, 1]))
print(f"32 samples beside 128: RMSE {montelux.compare(short, long).rmse:.4f}")

# %% [markdown]
# The picture is bit for bit that of the program `montelux render` with the same scene, seed and samples, for any number
# of threads.
#
# ## Where next
#
# - [integration.ipynb](integration.ipynb) and [sampling.ipynb](sampling.ipynb): what is inside a renderer
# - [docs/python.md](../python.md): environments, textures, lights; `montelux.load` reads scenes of pbrt-v4
# - [docs/rendering.md](../rendering.md): how a picture is estimated; [docs/images.md](../images.md): layers and comparing
