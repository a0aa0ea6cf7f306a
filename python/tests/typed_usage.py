"""Every public name in use, with types: `mypy --strict` passes on this file, and it runs (test_types.py)."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt

import montelux

Array = npt.NDArray[np.float64]


class Named(Protocol):
    """Any class of settings of a method."""

    name: str


def two(x: Array) -> Array:
    return np.stack([np.sin(x[:, 0]), x[:, 1]], axis=-1)


def integrals() -> montelux.Uncertain:
    box: list[tuple[float, float]] = [(0, 1), (0, 1)]
    r: montelux.Result = montelux.integrate(two, box, "basic", evaluations=2000, seed=1, norm="vector")
    notes: tuple[str, ...] = (*r.notes, *r.warnings)
    assert all(isinstance(note, str) for note in notes)
    history: montelux.History = r.history
    assert len(history.value) == len(history.seconds) and r.converged is False
    ratio = r[0] / r[1]
    other = montelux.integrate(lambda x: x, montelux.Domain.box([(0, 1)]), montelux.Quasi(), evaluations=2000, seed=2)
    log_z: montelux.LogResult = montelux.integrate_log(lambda x: -x * x, (-9, 9), "quasi", evaluations=2000, seed=3)
    total: montelux.Uncertain = 2 * ratio - other**2 / 3 + (log_z - 1) * other + (1 - other) + abs(-ratio)
    total = total.exp().log() + montelux.propagate(np.hypot, ratio, other)
    matrix: Array = montelux.covariance([ratio, other, total])
    assert matrix.shape == (3, 3) and ratio.covariance(other) == 0 and total.correlation(ratio) < 1
    constants: list[montelux.Uncertain] = montelux.Uncertain.correlated([1, 2], [[1, 0.5], [0.5, 1]])
    numbers: tuple[float, float, float] = (float(total), total.relative_error, total.z_score(constants[0]))
    texts: list[str] = [str(total), f"{total:.3f}", total._repr_html_(), total._repr_latex_(), *total.warnings]
    assert len(numbers) == 3 and len(texts) >= 4 and issubclass(montelux.PropagationWarning, UserWarning)
    assert isinstance(r.uncertain if r.value is None else list(r)[0], montelux.Uncertain)
    return total


def integrands_from_anywhere() -> list[montelux.Result]:
    square = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(lambda x: x * x)
    return [
        montelux.integrate(square, (0, 1), "quasi", evaluations=2000, threads=2),
        montelux.integrate(np.sin, (0, 1), "quasi", evaluations=2000, workers=2),
        montelux.integrate(np.sin, (0, 1), "quasi", evaluations=2000, array=np.from_dlpack),
    ]


def methods() -> list[str]:
    normal: montelux.Distribution = montelux.Distribution.normal()
    technique = montelux.Technique(normal)
    trained: montelux.AdaptiveMap = montelux.train_map(two, [(0, 1), (0, 1)], 10_000)
    density = montelux.integrate(two, [(0, 1), (0, 1)], "vegas", evaluations=10_000).density
    assert density is not None
    chosen: list[Named] = [
        montelux.Adaptive(replicates=8),
        montelux.Auto(),
        montelux.BasicMonteCarlo(),
        montelux.ControlVariate(np.sin, [0.5]),
        montelux.Cubature(max_memory=1 << 20),
        montelux.Importance(technique, points="sobol"),
        montelux.Metropolis(chains=4),
        montelux.MidpointRule(cells=8),
        montelux.MultipleImportance([(technique, 2)], weights="power"),
        montelux.Quasi(points="halton"),
        montelux.Recursive(pilot=0.2),
        montelux.RiemannSum(cells=8),
        montelux.Stratified(strata=4),
        montelux.Trained(density, replicates=8),
        montelux.TrapezoidRule(cells=8),
        montelux.Vegas(alpha=0.5, map=trained),
        montelux.VegasSobol(montelux.Vegas()),
    ]
    assert {m.name for m in chosen} == set(montelux.METHODS)
    return [m.name for m in chosen]


def trained_density() -> list[float]:
    r = montelux.integrate_log(lambda x: -x * x, (-9, 9), "adaptive", evaluations=5000)
    density: montelux.TrainedDensity | None = r.density
    assert density is not None and density.kind == "mixture" and density.dimensions == 1
    density.notes = {"formula": "exp(-x^2)"}
    p: Array = density.pdf([[0.5]])
    samples: montelux.Samples = density.samples(lambda x: -x * x, 100, log=True, seed=2)
    events: montelux.UnweightedSamples = density.unweighted(lambda x: -x * x, 100, log=True, pilot=1000)
    arrays: list[Array] = [samples.points, samples.weights, events.values]
    e: montelux.Expectations = density.expectations(lambda x: -x * x, np.cos, 1000, log=True)
    bins: montelux.Expectations = density.histogram(lambda x: -x * x, np.abs, [0, 1, 2], 1000, log=True)
    arrays += [e.mean, e.mean_covariance, bins.value, bins.covariance]
    assert len(samples) == 100 and all(a.size for a in arrays) and not events.warnings
    return [samples.integral, events.efficiency, events.efficiency_error, e.standard_error, float(p[0])]


def sampling() -> Array:
    points: Array = montelux.points("sobol", 64, 2, "scramble", seed=7)
    assert montelux.star_discrepancy(points[:16]) > montelux.l2_star_discrepancy(points[:16]) > 0
    weights: Array = montelux.mis_weights([[1.0, 3.0]], "power")
    discrete, alias = montelux.Discrete([1, 2, 3]), montelux.AliasTable([1, 2, 3])
    assert len(discrete) == len(alias) == 3 and weights.shape == (1, 2)
    chains: montelux.Chains = montelux.metropolis(lambda x: -float(x @ x), [0.0], samples=100, burn_in=50)
    draws: montelux.Draws = montelux.sample(lambda x: -x * x, (-9, 9), 100, sampler="slice", names=["x"], burn_in=50)
    posterior: dict[str, Array] = draws.posterior
    assert chains.mean.shape == (1,) and posterior["x"].shape == draws.states.shape[:2] and draws.r_hat[0] > 0
    directions: Array = montelux.warp.cosine_hemisphere.sample(points)
    return directions


def values() -> tuple[object, ...]:
    red: montelux.Spectrum = montelux.Spectrum.rgb(0.6, 0.2, 0.1)
    diffuse = montelux.Diffuse(reflectance=red)
    return (
        diffuse,
        montelux.CoatedConductor(),
        montelux.CoatedDiffuse(),
        montelux.Conductor(eta="metal-Au-eta", k="metal-Au-k"),
        montelux.Dielectric(eta=1.5),
        montelux.DiffuseTransmission(),
        montelux.Disney(),
        montelux.DisneyThin(),
        montelux.Hair(),
        montelux.Interface(),
        montelux.Plastic(),
        montelux.Principled(),
        montelux.Subsurface(),
        montelux.ThinDielectric(),
        montelux.AreaLight(),
        montelux.DistantLight(),
        montelux.PointLight(),
        montelux.SpotLight(),
        montelux.Merging(radius=0.1),
        montelux.Occlusion(max_distance=2),
        montelux.Spectral(buckets=4),
        montelux.BoxFilter(),
        montelux.GaussianFilter(),
        montelux.LanczosFilter(),
        montelux.MitchellFilter(),
        montelux.TriangleFilter(),
        montelux.pixel_filter("gaussian", 1.5, sigma=0.5),
    )


def of_files(folder: Path) -> tuple[object, ...]:
    """Values that need files or other values; only their types are checked."""
    channels: dict[str, npt.NDArray[np.float32]] = montelux.read_channels(folder / "out.exr")
    loaded: montelux.Scene = montelux.load(folder / "scene.pbrt")
    sky = montelux.EnvironmentSampler(folder / "sky.hdr", sampling="median-cut", parts=128)
    table: montelux.bake.BrdfTable = montelux.bake.brdf_table(64)
    return (
        channels,
        loaded,
        sky.mean_radiance,
        table.values,
        montelux.EnvironmentLight(),
        montelux.GoniometricLight(),
        montelux.Measured(),
        montelux.Mix(),
        montelux.ProjectionLight(),
        montelux.RealisticCamera(),
        montelux.Sided(),
        montelux.SkyLight(),
        montelux.SunLight(),
    )


def view_of(render: montelux.Render) -> str:
    page: montelux.View = render.view
    return page.url


def scenes(text: str) -> montelux.Comparison:
    scene: montelux.Scene = montelux.parse(text)
    scene.camera = montelux.PerspectiveCamera(fov=40, look_at=((0, -4, 1), (0, 0, 0)))
    assert isinstance(montelux.OrthographicCamera(), object) and isinstance(montelux.SphericalCamera(), object)
    scene.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
    ball: montelux.Shape = scene.add_sphere(1, montelux.Diffuse(reflectance=0.5))
    film, sampler, integrator = montelux.Film(), montelux.Sampler(), montelux.Integrator()
    assert all(isinstance(setting, object) for setting in (ball, film, sampler, integrator))
    integrator.guiding_memory, integrator.manifold_sampling = 64, True
    integrator.guiding, integrator.method, integrator.large_step_probability = "auto", "metropolis", 0.3
    seen: list[montelux.Progress] = []
    render: montelux.Render = scene.render(spp=4, progress=seen.append)
    picture: montelux.Picture = list(render)[-1]
    mean: npt.NDArray[np.float32] = picture.mean
    assert mean.shape[2] == 3
    guide: montelux.Guide | None = render.guide
    assert guide is None and render.cpu_seconds > 0
    scene.integrator.method = "metropolis"
    chains: montelux.PathChains = scene.path_chains(chains=1, spp=64)
    assert chains.large.dtype == np.bool_ and chains.film.shape[2] == 2
    scene.integrator.method = "bidirectional"
    strategies: list[montelux.StrategyPicture] = scene.strategy_pictures(spp=1)
    assert strategies[0].weighted.shape == mean.shape
    comparison = montelux.compare(render, render)
    channels: tuple[montelux.ChannelComparison, ...] = comparison.channels
    scores: montelux.ZScores | None = comparison.z
    assert len(channels) == 3 and (scores is None or scores.count >= 0)
    return comparison


def mistakes() -> str:
    try:
        montelux.Vegas().alfa  # type: ignore[attr-defined]
    except montelux.UnknownAttribute as error:
        assert isinstance(error, montelux.Error)
        return montelux.__version__ + str(error)
    return ""
