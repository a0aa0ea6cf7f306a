"""C6: directions to an environment map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of, share_of
from ..light import displayed
from ..sky import parts_of_pixels, show, sky, sun_pixels

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

N = 65_536
REGIONS, STRATA = 128, 256


def samples() -> Outcome:
    """256 directions by each way; 65536 of them and their densities give the light of the whole map."""
    image = sky()
    L, sun = image.mean(axis=-1), sun_pixels(image)
    few = montelux.points("sobol", 256, 2, "scramble", seed=4)
    many = montelux.points("independent", N, 2, seed=3)
    numbers, places = [], {}
    for name in ("tabulated", "median-cut", "structured"):
        sampler = montelux.EnvironmentSampler(image, sampling=name)
        places[name] = sampler.locate(sampler.sample(few)[0])
        light = (L * sampler.solid_angles).sum()
        directions, pdf = sampler.sample(many)
        ratio = sampler.radiance(directions).mean(axis=-1) / pdf
        if name == "tabulated":  # in proportion to the light: nothing varies
            numbers.append(Number("tabulated: light, farthest", farthest(ratio, light), 2e-4, light, bound=True))
        else:
            numbers.append(mean_of(f"{name}: light", ratio, light))
    uniform = montelux.warp.uniform_sphere
    places["uniform"] = sampler.locate(uniform.sample(few))
    w = uniform.sample(many)
    seen = sampler.radiance(w)
    ratio = np.where(sun_pixels(seen), 0, seen.mean(axis=-1)) / uniform.pdf(w)
    exact = (L * sampler.solid_angles)[~sun].sum()  # 22 of them meet the sun: too few to know their own noise
    numbers.append(mean_of("uniform: light without the sun", ratio, exact))

    # The density is zero where a surface's own directions are to find the light.
    compensated = montelux.EnvironmentSampler(image, sampling="tabulated", compensation=True)
    places["tabulated, compensated"] = compensated.locate(compensated.sample(few)[0])
    omega = compensated.solid_angles
    p = compensated.pdf(compensated.direction(parts_of_pixels(image, 1)))
    rest = np.maximum(L - compensated.mean_radiance, 0)
    numbers.append(Number("compensated: ∫ p dω", (p * omega).sum(), 1e-5, 1, bound=True))
    apart = np.abs(p - rest / (rest * omega).sum()).max() / p.max()
    numbers.append(Number("compensated: p less max(0, L − mean), farthest", apart, 1e-5, 0, bound=True))
    x, y = np.floor(compensated.locate(compensated.sample(many)[0])).astype(int).T
    share = (rest * omega)[sun].sum() / (rest * omega).sum()
    numbers.append(share_of("compensated: share of the sun", int(sun[y, x].sum()), N, share))
    return Outcome(numbers, {"image": image, "places": places})


def farthest(values, exact):  # type: ignore[no-untyped-def]
    """The value that lies farthest from the exact one."""
    return values.flat[np.abs(values - exact).argmax()]


def draw_samples(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    panels = figure.subplots(3, 2)
    for a, name in zip(
        panels.flat, ("the map", "uniform", "tabulated", "tabulated, compensated", "median-cut", "structured")
    ):
        show(a, displayed(s["image"], 0.45))
        a.set_title(name)
        if name in s["places"]:
            x, y = s["places"][name].T
            a.plot(x, y, "o", color="black", markersize=3.4, markeredgecolor="white", markeredgewidth=0.6)


def overlaps(begin, end, count):  # type: ignore[no-untyped-def]
    """How much of [begin, end] lies in each of this number of cells of length one."""
    i = np.arange(count)
    return np.clip(np.minimum(end, i + 1) - np.maximum(begin, i), 0, None)


def median_cut() -> Outcome:
    """128 regions of equal light, and one direction in each."""
    image = sky()
    sampler = montelux.EnvironmentSampler(image, sampling="median-cut", parts=REGIONS)
    L = np.where(sun_pixels(image), 0, image.mean(axis=-1))  # the sun is sampled by itself
    height, width = L.shape
    light, squares, omega = np.empty((3, REGIONS))
    for k, (x0, x1, y0, y1) in enumerate(sampler.regions):
        area = np.outer(overlaps(y0, y1, height), overlaps(x0, x1, width)) * sampler.solid_angles
        light[k], squares[k], omega[k] = (L * area).sum(), (L**2 * area).sum(), area.sum()
    whole = (L * sampler.solid_angles).sum()
    each = farthest(light, whole / REGIONS)
    numbers = [Number("light of a region, farthest", each, 1e-4 * whole / REGIONS, whole / REGIONS, bound=True)]
    # The first random number picks the sun or one of the regions; here each region once, 1024 times.
    u = montelux.points("independent", 1024 * REGIONS, 2, seed=5).reshape(1024, REGIONS, 2)
    share = sampler.sun_share
    numbers.append(Number("share of the sun", share, 1e-5, 1 - whole / (4 * np.pi * sampler.mean_radiance), bound=True))
    within = np.clip(u[..., 0], 1e-4, 1 - 1e-4)  # in single precision the region's neighbours are near
    u[..., 0] = share + (1 - share) * (np.arange(REGIONS) + within) / REGIONS
    place = sampler.locate(sampler.sample(u)[0])
    x0, x1, y0, y1 = sampler.regions.T
    x, y = np.moveaxis(place, -1, 0)
    rim = 1e-3  # of a pixel, for rounding
    outside = (x < x0 - rim) | (x > x1 + rim) | (y < y0 - rim) | (y > y1 + rim)
    numbers.append(Number("directions outside of their region", outside.sum(), 0, 0, bound=True))
    estimates = (L[y.astype(int), x.astype(int)] * omega).sum(axis=-1)
    numbers.append(mean_of("light of all regions, one direction in each", estimates, whole))
    variance = (squares * omega - light**2).sum()
    numbers.append(mean_of("its variance", (estimates - whole) ** 2, variance))
    return Outcome(numbers, {"image": image, "regions": sampler.regions, "place": place[0]})


def draw_median_cut(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    from matplotlib.patches import Rectangle

    a = figure.subplots()
    show(a, displayed(s["image"], 0.45))
    for x0, x1, y0, y1 in s["regions"]:
        a.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, edgecolor="black", linewidth=1.0))
    x, y = s["place"].T
    a.plot(x, y, "o", color="#F0E442", markersize=4.5, markeredgecolor="black", markeredgewidth=0.8)


def connected(mask):  # type: ignore[no-untyped-def]
    """A number for each pixel that those which hang together with it by their sides share; -1 outside the mask."""
    least = np.where(mask, np.arange(mask.size).reshape(mask.shape), mask.size)
    while True:
        padded = np.pad(least, 1, constant_values=mask.size)
        near = np.minimum.reduce([padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:], least])
        near = np.where(mask, near, mask.size)
        if (near == least).all():
            return np.where(mask, least, -1)
        least = near


def structured() -> Outcome:
    """Thresholds, strata and their centres, beside what the map's radiance says of them."""
    image = sky()
    sampler = montelux.EnvironmentSampler(image, sampling="structured", parts=STRATA)
    labels, strata = sampler.labels, len(sampler.levels)
    L = np.where(sun_pixels(image), 0, image.mean(axis=-1))  # the sun is sampled by itself
    omega = sampler.solid_angles
    mean = (L * omega).sum() / (4 * np.pi)
    sigma = np.sqrt((L**2 * omega).sum() / (4 * np.pi) - mean**2)
    level = np.where(labels >= 0, sampler.levels[labels], -1)
    below = (L < level * sigma * (1 - 1e-5)).sum()
    numbers = [Number("pixels below the threshold of their stratum", below, 0, 0, bound=True)]
    numbers.append(Number("pixels in a stratum", (labels >= 0).sum(), 0, (L > 0).sum(), bound=True))

    w = sampler.direction(parts_of_pixels(image, 1))
    lit = labels >= 0
    size = np.bincount(labels[lit], omega[lit], strata)
    flat = (sampler.pdf(w) * size[labels])[lit]
    exact = (1 - sampler.sun_share) / strata
    numbers.append(
        Number("density times solid angle, farthest", farthest(flat, exact), 1e-5 * exact, exact, bound=True)
    )

    # Each pixel goes to the nearest centre of its part: what hangs together above a threshold, less what is brighter.
    centres = sampler.direction(sampler.centres)
    wrong = 0
    for k in np.unique(level[lit]):
        part = connected(L >= k * sigma) if k > 0 else np.where(lit, 0, -1)
        for which in np.unique(part[level == k]):
            here = (level == k) & (part == which)
            to_own = (w[here] * centres[labels[here]]).sum(axis=-1)
            to_nearest = (w[here] @ centres[np.unique(labels[here])].T).max(axis=-1)
            wrong += (to_own < to_nearest - 1e-6).sum()
    numbers.append(Number("pixels with a nearer centre in their part", wrong, 0, 0, bound=True))
    directions, pdf = sampler.sample(montelux.points("independent", N, 2, seed=6))
    ratio = sampler.radiance(directions).mean(axis=-1) / pdf
    numbers.append(mean_of("light of the map", ratio, 4 * np.pi * sampler.mean_radiance))
    return Outcome(numbers, {"image": image, "labels": labels, "level": level, "centres": sampler.centres})


def draw_structured(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    from matplotlib.colors import BoundaryNorm

    a, b = figure.subplots(2, 1)
    height, width = s["level"].shape
    shown = np.ma.masked_less(s["level"], 0)
    for axes in (a, b):
        show(axes, displayed(s["image"], 0.45))
    bar = figure.colorbar(
        a.imshow(
            shown,
            cmap=theme.map,
            norm=BoundaryNorm(np.arange(-0.5, 6.5), 256),
            extent=(0, width, height, 0),
            interpolation="nearest",
        ),
        ax=a,
        ticks=range(6),
        shrink=0.78,
    )
    bar.set_label("threshold, σ")
    bar.outline.set_visible(False)
    a.set_title("parts above thresholds")
    b.set_title("strata and their centres")
    # Lines between pixels of different strata, in a picture of four times as many.
    fine = np.kron(s["labels"], np.ones((4, 4), dtype=int))
    edge = np.zeros((*fine.shape, 4))
    edge[:, 1:, 3] = fine[:, 1:] != fine[:, :-1]
    edge[1:, :, 3] = np.maximum(edge[1:, :, 3], fine[1:] != fine[:-1])
    b.imshow(edge, extent=(0, width, height, 0), interpolation="antialiased")
    x, y = s["centres"].T
    b.plot(x, y, "o", color="#F0E442", markersize=3.4, markeredgecolor="black", markeredgewidth=0.6)


FIGURES = (
    Figure(
        "C6",
        "samples",
        "Where directions to a sky go",
        "Uniform directions hardly ever find the sun. Tabulated ones fall on each pixel in proportion to its light;"
        " compensated ones leave pixels that are dimmer than the mean to the directions of the surface. Median-cut and"
        " structured directions are uniform within regions, and the sun is sampled separately.",
        (
            r"p(\omega) = \frac{L(\omega)}{\int L\,d\omega}\ \ \mathrm{(tabulated)}, \qquad p(\omega) \;\propto\;"
            r" \max(0, L(\omega) - \bar{L})\ \ \mathrm{(compensated)}",
        ),
        samples,
        draw_samples,
        7.0,
        "A map of a sky with a sun and a lamp, and 256 directions to it by each of five ways",
        helpers=(sky, farthest),
    ),
    Figure(
        "C6",
        "median-cut",
        "Median cut: regions of equal light",
        "Each region is cut across its longer side into two of equal light: small ones cover the lamp and the bright"
        " sky, large ones the ground. One direction is drawn in each region, so nearly all of the noise comes from the"
        " contrast within regions. The sun was removed before.",
        (
            r"p(\omega) = \frac{1}{n\,|\Omega_k|}, \qquad \int_{\Omega_k} L\,d\omega = \frac{1}{n} \int L\,d\omega",
            r"\mathrm{Var} = \sum_k \left( |\Omega_k| \int_{\Omega_k} L^2 d\omega - \left( \int_{\Omega_k} L\,d\omega"
            r" \right)^2 \right)",
        ),
        median_cut,
        draw_median_cut,
        4.2,
        "A map cut into 128 rectangles with a dot in each",
        helpers=(sky, overlaps, farthest),
    ),
    Figure(
        "C6",
        "structured",
        "Structured importance sampling: thresholds and strata",
        "The map is cut at multiples of its standard deviation. Each connected part above a threshold gets strata in"
        " proportion to its light and the fourth root of its size. Their centres are as far apart as possible, and"
        " each pixel belongs to the nearest one. The sun was removed before.",
        (
            r"\Gamma = L\,\min(\Delta\omega, \Delta\omega_0)^{1/4}, \qquad L = \int_{\mathrm{part}} L\,d\omega, \qquad"
            r" \Delta\omega_0 = 0.01",
        ),
        structured,
        draw_structured,
        8.2,
        "A map in parts by brightness, and the same cut into strata with their centres",
        helpers=(sky, connected, farthest),
    ),
)
