"""C7: the split sum of real-time engines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import montelux

from .._figure import Figure, Outcome
from .._number import Number, mean_of
from ..light import displayed
from ..marks import MARKERS, STROKES, grid
from ..sky import axes_of, parts_of_pixels, rough_mirror, show, side_by_side, sky, smith

if TYPE_CHECKING:
    import matplotlib.figure

    from ..style import Theme

PLACES = ((8, 8), (8, 40), (56, 8), (30, 25), (2, 20), (60, 60))  # column and row of the table


def albedo(cosine, alpha):  # type: ignore[no-untyped-def]
    """Scale and bias with their errors, by quasi-random points and the normals that are seen; an Estimate of both."""
    v = np.array([np.sqrt(1 - cosine**2), 0, cosine])
    normals = montelux.warp.ggx_visible_normals(alpha, [float(c) for c in v])

    def terms(u):  # type: ignore[no-untyped-def]
        h = normals.sample(u)
        c = h @ v
        w = 2 * c[:, None] * h - v
        weight = np.where(w[:, 2] > 0, (1 + smith(v, alpha)) / (1 + smith(v, alpha) + smith(w, alpha)), 0)
        fresnel = (1 - c) ** 5
        return np.stack([weight * (1 - fresnel), weight * fresnel], axis=1)

    return montelux.integrate(terms, [(0, 1), (0, 1)], montelux.Quasi(replicates=32), evaluations=1 << 17, seed=1)


def table() -> Outcome:
    """Scale and bias of the table, six of its texels by another way, and the mean albedo by the sum of its rows."""
    made = montelux.bake.brdf_table(64, blue="average-albedo")
    numbers = []
    for x, y in PLACES:
        cosine, roughness = made.n_dot_v[x], made.roughness[y]
        r = albedo(cosine, roughness**2)
        for k, term in enumerate(("scale", "bias")):
            error = np.hypot(r.standard_error[k], 1e-6)  # normals are drawn in single precision
            name = f"{term} at n·v = {cosine:.3f}, roughness {roughness:.3f}"
            numbers.append(Number(name, made.values[y, x, k], error, r.value[k], degrees_of_freedom=31))
    # Blue: the mean albedo of a rough mirror, by the sum over each row.
    means = 2 * (made.values[..., 0] + made.values[..., 1]) @ made.n_dot_v / 64
    apart = np.abs(means - made.values[:, 0, 2]).max()
    numbers.append(Number("mean albedo less the sum over its row, farthest", apart, 1e-3, 0, bound=True))
    numbers.append(Number("largest bound on an error", made.errors[..., :2].max(), 1e-4, 0, bound=True))
    return Outcome(numbers, {"table": made})


#: Lines of equal value, and where their names stand.
LINES: tuple[dict[float, tuple[float, float]], ...] = (
    {0.2: (0.04, 0.05), 0.4: (0.85, 0.95), 0.6: (0.85, 0.78), 0.8: (0.85, 0.6), 0.9: (0.85, 0.51), 0.95: (0.6, 0.35)},
    {0.01: (0.5, 0.75), 0.02: (0.54, 0.12), 0.05: (0.44, 0.25), 0.1: (0.25, 0.5), 0.2: (0.25, 0.2), 0.4: (0.12, 0.2)},
)


def draw_table(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    made = s["table"]
    for k, (a, name) in enumerate(zip(figure.subplots(1, 2, sharey=True), ("R: scale", "G: bias"))):
        values = made.values[..., k]
        a.imshow(values, extent=(0, 1, 1, 0), cmap=theme.map, vmin=0, vmax=1, interpolation="nearest")
        lines = (0.2, 0.4, 0.6, 0.8, 0.9, 0.95) if k == 0 else (0.01, 0.02, 0.05, 0.1, 0.2, 0.4)
        drawn = a.contour(made.n_dot_v, made.roughness, values, list(LINES[k]), colors="white", linewidths=1.6)
        for label in a.clabel(drawn, fontsize=12, fmt="%g", manual=list(LINES[k].values())):
            label.set_path_effects(_outline())
        a.set(xlabel="n·v", xlim=(0, 1), ylim=(1, 0), xticks=[0, 0.5, 1], yticks=[0, 0.5, 1], title=name)
        if k == 0:
            a.set_ylabel("roughness")


def _outline() -> Any:
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=2.5, foreground="black")]


STEPS = (0.0, 0.25, 0.5, 0.75, 1.0)


def blurred(image, sampler, directions, alpha):  # type: ignore[no-untyped-def]
    """The mean of a map under the GGX lobe about directions, n = v = r: a sum over its pixels, or parts of them."""
    n = 1 if alpha > 0.2 else 2
    w = sampler.direction(parts_of_pixels(image, n)).reshape(-1, 3)
    light = np.repeat(np.repeat(image * sampler.solid_angles[..., None], n, axis=0), n, axis=1).reshape(-1, 3)
    omega = np.repeat(np.repeat(sampler.solid_angles, n, axis=0), n, axis=1).ravel()
    cosine = directions @ w.T
    half = 0.5 * (1 + cosine)  # the squared cosine of the half vector
    lobe = np.maximum(cosine, 0) / ((alpha**2 - 1) * half + 1) ** 2
    return lobe @ light / (lobe @ omega)[:, None]


def prefilter() -> Outcome:
    """A chain of five cube maps, and 64 texels of each rough level by quadrature over the whole map."""
    image = sky()
    sampler = montelux.EnvironmentSampler(image)
    chain = montelux.bake.environment(image, 64, roughness=STEPS, target_error=0.02, seed=1)
    numbers = [Number("texels that missed their error", sum(level.missed for level in chain), 0, 0, bound=True)]
    within = []
    for level in chain:
        name = f"roughness {level.roughness:g}"
        if level.roughness > 0:
            directions = montelux.bake.to_map(montelux.bake.face_directions(level.size)).reshape(-1, 3)
            some = np.arange(len(directions))[:: max(1, len(directions) // 64)]
            exact = blurred(image, sampler, directions[some], level.roughness**2)
            value, error = (a.reshape(-1, 3)[some].astype(float) for a in (level.faces, level.errors))
            # Channels share their samples: one of them.
            z = ((value - exact) / error)[:, 1]
            numbers.append(mean_of(f"{name}: errors from quadrature, mean over texels", z, 0))
            within.append(np.abs(z) <= 3)
        else:
            t = (2 * np.arange(level.size) + 1) / level.size - 1
            omega = (1 + t[:, None] ** 2 + t**2) ** -1.5  # of texels, beside each other
            mean = (level.faces.mean(axis=(0, 3)) * omega).sum() / omega.sum()
            exact = sampler.mean_radiance
            numbers.append(Number(f"{name}: mean over the cube", mean, 0.01 * exact, exact, bound=True))
    share = np.concatenate(within).mean()
    numbers.append(Number("texels within three errors of quadrature", share, 0.02, 0.9973, bound=True))
    return Outcome(numbers, {"chain": chain})


def draw_prefilter(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    for a, level in zip(figure.subplots(len(STEPS), 1), s["chain"]):
        show(a, side_by_side([displayed(face, 0.45) for face in level.faces]))
        a.set_ylabel(f"{level.roughness:g}", rotation=0, ha="right", va="center", labelpad=8)
        if level is s["chain"][0]:
            width = a.get_xlim()[1]
            a.xaxis.tick_top()
            a.set_xticks((np.arange(6) + 0.46) / 6 * width, ("+X", "−X", "+Y", "−Y", "+Z", "−Z"))
            a.tick_params(length=0)
    figure.supylabel("roughness", fontsize="medium")


ROUGHNESS, COSINES = (0.2, 0.4, 0.6, 0.8, 1.0), (0.1, 0.3, 0.6, 1.0)
SIZE = 33


def full_integral(sampler, normal, view, alpha):  # type: ignore[no-untyped-def]
    """What a rough mirror reflects of the map's green, and its error: directions to the map and of the normals seen."""
    frame = axes_of(normal)
    v = frame @ view
    normals = montelux.warp.ggx_visible_normals(alpha, [float(c) for c in v])
    u = montelux.points("independent", 1 << 16, 4, seed=7)
    h = normals.sample(u[:, 2:])
    value = np.zeros(len(u))
    for w in (sampler.sample(u[:, :2])[0] @ frame.T, 2 * (h @ v)[:, None] * h - v):
        middle = w + v
        middle /= np.linalg.norm(middle, axis=-1, keepdims=True)
        density = sampler.pdf(w @ frame) + normals.pdf(middle) / (4 * (middle @ v))
        up = w[:, 2] > 0
        value[up] += (sampler.radiance(w @ frame)[:, 1] * rough_mirror(v, w, alpha) / density)[up]
    return value.mean(), value.std(ddof=1) / np.sqrt(len(value))


def split_sum() -> Outcome:
    """Spheres by the full integral and by the split sum, and their difference over random surfaces and views."""
    image = sky()
    sampler = montelux.EnvironmentSampler(image, sampling="tabulated")
    found = montelux.bake.report(
        image, roughness=ROUGHNESS, n_dot_v=COSINES, f0=[1], sphere_size=SIZE, target_error=0.04, seed=1
    )
    numbers = []
    for k, column in ((0, 16), (2, 6), (2, 26), (4, 16)):  # of the middle row
        x = 2 * (column + 0.5) / SIZE - 1
        normal, view = montelux.bake.to_map([[x, 0, -np.sqrt(1 - x**2)], [0, 0, -1]])
        cosine, alpha = normal @ view, ROUGHNESS[k] ** 2
        place = f"roughness {ROUGHNESS[k]:g}, x = {x:.2f}"
        at = k, SIZE // 2, column, 1
        value, error = full_integral(sampler, normal, view, alpha)
        numbers.append(Number(f"full, {place}", found.full[at], np.hypot(found.full_errors[at], error), value))
        mirror = 2 * cosine * normal - view
        exact = blurred(image, sampler, mirror[None], alpha)[0, 1] * albedo(cosine, alpha).value.sum()
        numbers.append(Number(f"split sum, {place}", found.split[at], found.split_errors[at], exact))
    # Over all orientations both sides are the albedo times the mean radiance: no difference is left.
    for row in found.rows[::2]:
        name = f"mean difference, roughness {row.roughness:g}, n·v = {row.n_dot_v:g}"
        numbers.append(Number(name, row.bias, row.bias_error, 0, degrees_of_freedom=63))
    return Outcome(numbers, {"found": found})


def draw_split_sum(figure: matplotlib.figure.Figure, theme: Theme, s: dict[str, Any]) -> None:
    found = s["found"]
    halves: Any = figure.subfigures(2, 1, height_ratios=[3.1, 2.4])
    top, bottom = halves
    t = (2 * np.arange(SIZE) + 1) / SIZE - 1
    inside = (t**2 + t[:, None] ** 2 < 1).astype(float)[..., None]
    shown = {"full\nintegral": found.full, "split\nsum": found.split, "their\ndifference": found.difference}
    for k, (a, (name, spheres)) in enumerate(zip(top.subplots(3, 1), shown.items())):
        show(a, side_by_side([np.concatenate([displayed(sphere, 0.45), inside], axis=-1) for sphere in spheres]))
        a.set_ylabel(name, rotation=0, ha="right", va="center", labelpad=8)
        if k == 0:
            a.xaxis.tick_top()
            a.set_xticks((np.arange(5) + 0.48) / 5 * a.get_xlim()[1], [f"{roughness:g}" for roughness in ROUGHNESS])
            a.tick_params(length=0)
            a.set_title("roughness")
    a, b = bottom.subplots(1, 2)
    lit = t**2 < 0.97
    for i, k in enumerate((0, 2, 4)):
        full, error, split = (p[k, SIZE // 2, lit].mean(axis=-1) for p in (found.full, found.full_errors, found.split))
        a.errorbar(
            t[lit], full, error, fmt=MARKERS[i], color=theme.cycle[i], markersize=4, elinewidth=1.2, linestyle="none"
        )
        a.plot(t[lit], split, color=theme.cycle[i], linestyle=STROKES[i], linewidth=1.6, label=f"{ROUGHNESS[k]:g}")
    a.set(xlabel="x along the middle", title="marks: full, lines: split", yscale="log", ylabel="radiance")
    a.legend(title="roughness", fontsize=12, title_fontsize=12)
    for i, roughness in enumerate(ROUGHNESS):
        rms = [100 * row.rms for row in found.rows if row.roughness == roughness]
        b.plot(
            COSINES,
            rms,
            color=theme.cycle[i],
            linestyle=STROKES[i],
            marker=MARKERS[i],
            linewidth=1.8,
            label=f"{roughness:g}",
        )
    b.set(xlabel="n·v", title="difference, r.m.s., %", xlim=(0, 1.05))
    b.set_ylim(bottom=0)
    b.legend(title="roughness", fontsize=12, title_fontsize=12)
    for axes in (a, b):
        grid(axes, theme)


FIGURES = (
    Figure(
        "C7",
        "table",
        "The table of the split sum",
        "In uniform light, a rough mirror whose reflectance along the normal is F₀ reflects F₀ times the red channel"
        " plus the green one. Seen steeply, scale is near one and bias near zero; towards grazing views, on the left,"
        " bias dominates, the more so the smoother the surface is.",
        (
            r"\int f_r\,(n \cdot l)\,dl = F_0\,\mathrm{scale} + \mathrm{bias}",
            r"\mathrm{scale} = \int \frac{f_r}{F} (1 - F_c)\,(n \cdot l)\,dl, \qquad \mathrm{bias} = \int"
            r" \frac{f_r}{F} F_c\,(n \cdot l)\,dl, \qquad F_c = (1 - v \cdot h)^5",
        ),
        table,
        draw_table,
        4.6,
        "Two tables over n.v and roughness with lines of equal value",
        helpers=(albedo, smith),
    ),
    Figure(
        "C7",
        "prefilter",
        "The map, blurred by the lobe",
        "A cube map of the sky, each level with half the texels of the one above and blurred by the lobe of its"
        " roughness: the sun spreads over ever more of the cube, and the lamp dissolves. Each texel is a mean of the map"
        " under the lobe about its direction, with an error of its own.",
        (r"\bar{L}(r) = \frac{\int D(h)\,(n \cdot l)\,L(l)\,dl}{\int D(h)\,(n \cdot l)\,dl}, \qquad n = v = r",),
        prefilter,
        draw_prefilter,
        7.2,
        "Thirty faces of five cube maps, ever more blurred",
        slow=True,
        helpers=(sky, blurred),
    ),
    Figure(
        "C7",
        "split-sum",
        "The split sum against the full integral",
        "Metal spheres under the sky, from smooth to rough: the product of the blurred map and the table is close"
        " where the surface faces the eye. Towards the rim the true reflection is stretched towards the horizon, which"
        " the round lobe of the split sum cannot represent; over random grazing views the difference is as large as"
        " the reflection itself.",
        (r"\int f_r\,L\,(n \cdot l)\,dl \;\approx\; \bar{L}(r)\,(F_0\,\mathrm{scale} + \mathrm{bias})",),
        split_sum,
        draw_split_sum,
        9.0,
        "Rows of spheres by both ways and their difference, curves along the middle of three, and the difference over angles",
        slow=True,
        helpers=(sky, full_integral, blurred),
    ),
)
