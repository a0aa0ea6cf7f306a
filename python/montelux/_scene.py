"""Scenes: from files, from text, or built from nothing."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _core
from ._core import Error
from ._denoiser import offer_denoiser
from ._names import MOST_THREADS, is_number, is_whole, settings_of, strict, strict_arguments, unknown
from ._paths import PathChains, StrategyPicture
from ._render import Progress, Render

_MOST_SAMPLES = 1 << 24  # per pixel, with a target error or a time


class Scene(_core.SceneBase):
    """What is rendered: shapes, materials, lights, a camera, and film, sampler and integrator.

    `montelux.load` and `montelux.parse` make scenes of pbrt-v4 files. `Scene()` is empty; set `camera`, and add
    shapes and lights. Values that are read from a scene (`scene.materials[0]`, `scene.camera`) are places in
    it: setting their attributes changes the scene. Running renders do not change with it.

    With `texture_memory`, the pictures that are added as textures are kept in a temporary file, of which about this
    many bytes are in memory.
    """

    @strict_arguments
    def __init__(self, *, texture_memory: int | None = None) -> None:
        super().__init__(texture_memory=_size(texture_memory, "montelux.Scene"))

    @strict_arguments
    def render(
        self,
        *,
        spp: int | None = None,
        max_spp: int | None = None,
        target_error: float | None = None,
        target_quantile: float | None = None,
        time: float | None = None,
        adaptive: bool | None = None,
        seed: int | None = None,
        threads: int = 0,
        progress: bool | Callable[[Progress], object] = False,
        every: float = 1.0,
        checkpoint: str | os.PathLike[str] | None = None,
        checkpoint_every: float = 60.0,
        resume: bool = False,
        slice: tuple[int, int] | None = None,
        denoise: bool = False,
        view: bool = False,
    ) -> Render:
        """Starts a render in the background, and returns the Render.

        It stops after `spp` samples per pixel (default: `scene.sampler.spp`); when the relative error of the
        picture is below `target_error` (0.02: two per cent), or with `target_quantile` the error of that share of
        the pixels; after `time` seconds; at `max_spp` samples per pixel, on average. With a target or a time and
        no `spp` the scene's own number is ignored. `adaptive`: more samples where the error is; on with
        `target_error`.

        The picture depends on scene, seed and settings, and not on `threads` (0: one per processor).

        progress: True shows a line on standard error while the render is waited for; a function is called with
        a Progress. every: seconds between the pictures that iterating gives. checkpoint: a file that keeps the
        running state, written every `checkpoint_every` seconds and at the end; `resume` continues from it, to
        the same bits.

        slice: (k, n) takes the k-th of n parts of the samples, k from 1 to n; `montelux merge` joins the saved
        parts. denoise: the finished picture is denoised too, by Open Image Denoise (layer 'denoised'), unless it
        is stopped before. view: a page shows the render while it runs: `Render.view`.
        """
        _check_sampling("render", spp, seed, threads)
        if max_spp is not None:
            _check_spp("render", "max_spp", max_spp)
        for name, number in (
            ("target_error", target_error),
            ("time", time),
            ("every", every),
            ("checkpoint_every", checkpoint_every),
        ):
            if number is not None and not (is_number(number) and 0 < number < float("inf")):
                raise Error(f"render: {name}={number!r} was given; expected a number above zero")
        if target_quantile is not None:
            if target_error is None:
                raise Error(
                    "render: target_quantile was given; expected target_error, the error of that share"
                )
            if not (is_number(target_quantile) and 0 < target_quantile < 1):
                raise Error(f"render: target_quantile={target_quantile!r} was given; expected a number between 0 and 1")
        if not (isinstance(progress, bool) or callable(progress)):
            raise Error(f"render: progress={progress!r} was given; expected True, False or a function")
        part = (1, 1) if slice is None else tuple(slice)
        if len(part) != 2 or not (all(is_whole(i) for i in part) and 1 <= part[0] <= part[1] <= 1_000_000):
            raise Error(f"render: slice={slice!r} was given; expected (k, n) with k from 1 to n")
        if part[1] > 1 and (target_error is not None or adaptive):
            raise Error(
                "render: slices share a number of samples per pixel; give spp, without target_error and adaptive"
            )
        aimed = target_error is not None or time is not None
        most = spp
        if spp is None and max_spp is not None:
            most = max_spp if aimed else min(max_spp, self.sampler.spp)
        elif spp is None and aimed:
            most = _MOST_SAMPLES
        elif spp is not None and max_spp is not None:
            most = min(spp, max_spp)
        if denoise:
            offer_denoiser()
        job = _core.start_render(
            self,
            spp=None if most is None else int(most),
            seed=None if seed is None else int(seed),
            target_error=float(target_error or 0),
            target_quantile=float(target_quantile or 0),
            time=float(time or 0),
            adaptive=None if adaptive is None else bool(adaptive),
            threads=int(threads),
            checkpoint="" if checkpoint is None else os.fspath(checkpoint),
            checkpoint_every=float(checkpoint_every),
            resume=resume,
            slice=part,
            denoise=denoise,
            view=view,
        )
        if job.refused_checkpoint:
            warnings.warn(
                f"{job.refused_checkpoint}; resumed from the checkpoint before it", RuntimeWarning, stacklevel=2
            )
        return Render(job, progress, every)

    @strict_arguments
    def strategy_pictures(
        self, *, spp: int | None = None, seed: int | None = None, threads: int = 0
    ) -> list[StrategyPicture]:
        """What each strategy of the integrator 'bidirectional' or 'light-tracing' brings to the picture, by the length
        of the paths and then by `s` (Veach 1997, figure 10.2). The weighted pictures add up to the picture that
        `render` makes of the same samples. Without media and merging, for a `max_depth` of at most 12."""
        _check_sampling("strategy_pictures", spp, seed, threads)
        found = _core.strategy_pictures(self, spp=spp, seed=seed, threads=int(threads))
        return [StrategyPicture(*values) for values in found]

    @strict_arguments
    def path_chains(
        self, *, chains: int = 4, group: int = 0, spp: int | None = None, seed: int | None = None, threads: int = 0
    ) -> PathChains:
        """The walks of the first chains of a group of the integrator 'metropolis', as `render` with these samples and
        this seed takes them; fewer chains if the group has fewer, none if it found no light."""
        _check_sampling("path_chains", spp, seed, threads)
        for name, value, least in (("chains", chains, 1), ("group", group, 0)):
            if not (is_whole(value) and least <= value < 1 << 30):
                raise Error(f"path_chains: {name}={value!r} was given; expected a whole number from {least} on")
        trace = _core.path_chains(self, chains=int(chains), group=int(group), spp=spp, seed=seed, threads=int(threads))
        return PathChains.of(trace)

    def __repr__(self) -> str:
        width, height = self.film.resolution
        return (
            f"<Scene {self.name}: {len(self.shapes)} shapes, {len(self.materials)} materials, {len(self.lights)} "
            f"lights, {'no camera' if self.camera is None else type(self.camera).__name__}, {width} x {height} pixels>"
        )


def _check_spp(function: str, name: str, value: Any) -> None:
    if not (is_whole(value) and 1 <= value <= 1 << 30):
        raise Error(f"{function}: {name}={value!r} was given; expected a whole number from 1 to {1 << 30}")


def _check_sampling(function: str, spp: Any, seed: Any, threads: Any) -> None:
    if spp is not None:
        _check_spp(function, "spp", spp)
    if seed is not None and not (is_whole(seed) and 0 <= seed < 2**64):
        raise Error(f"{function}: seed={seed!r} was given; expected a whole number in [0, 2**64)")
    if not (is_whole(threads) and 0 <= threads <= MOST_THREADS):
        raise Error(f"{function}: threads={threads!r} was given; expected a whole number from 0 to {MOST_THREADS}")


def load(
    path: str | os.PathLike[str],
    *,
    texture_memory: int | None = None,
    environment: str | os.PathLike[str] | None = None,
    orbit: Sequence[float] | None = None,
    ground: bool | None = None,
    background: str | Sequence[float] | None = None,
    camera: str | int | None = None,
    variant: str | None = None,
    time: float | None = None,
    shutter: float = 0,
    definitions: Mapping[str, object] | None = None,
) -> Scene:
    """Reads a scene (pbrt-v4, glTF 2.0, Mitsuba 3) or a model (OBJ, PLY, STL) and all files that it refers to. What it ignores is reported
    by warnings, and in `scene.warnings`. With `texture_memory`, image textures are kept in a temporary file, of which
    about this many bytes are in memory.

    A model without camera and environment gets those of a studio. `environment` is a map that lights any scene in place
    of its infinite lights ("studio": the studio's, "none": no such light); `orbit` a camera that frames it, (azimuth,
    elevation) in degrees or (azimuth, elevation, distance) with the distance in multiples of the framing one; `ground`
    a disc below it that catches its shadow; `background` what the camera sees where it meets nothing: "transparent"
    (layer "alpha"), "black", "grey", "white", "#rrggbb", or linear (r, g, b).

    Of glTF scenes: `camera` chooses one by name or number, `variant` one of the file's variants of materials, `time`
    the moment of its animations, in seconds, and `shutter` how long the shutter is open from then on, in seconds: what
    moves meanwhile is blurred. Of Mitsuba scenes: `camera` chooses a sensor, `definitions` are values of parameters,
    {"spp": 32} for $spp."""
    scene = Scene()
    scene._load(
        os.fspath(path),
        _size(texture_memory, "montelux.load"),
        None if environment is None else os.fspath(environment),
        _comma_list(orbit, "orbit"),
        ground,
        _comma_list(background, "background"),
        None if camera is None else str(camera),
        variant,
        time,
        float(shutter),
        {name: _parameter_text(value) for name, value in (definitions or {}).items()},
    )
    _tell(scene)
    return scene


def _parameter_text(value: object) -> str:
    """As Mitsuba's XML has it: true, not True."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def parse(
    text: str, name: str = "scene", folder: str | os.PathLike[str] = ".", *, texture_memory: int | None = None
) -> Scene:
    """The same from text in pbrt-v4's format; files that it refers to are looked for in `folder`."""
    scene = Scene()
    scene._parse(text, name, os.fspath(folder), _size(texture_memory, "montelux.parse"))
    _tell(scene)
    return scene


def _comma_list(value: str | Sequence[float] | None, name: str) -> str | None:
    """As an option of the program."""
    if value is None or isinstance(value, str):
        return value
    try:
        return ",".join(repr(float(x)) for x in value)
    except (TypeError, ValueError):
        raise Error(f"montelux.load, {name}: {value!r} was given; expected numbers") from None


def _size(value: int | None, function: str) -> int | None:
    if value is not None and (isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 1 << 60):
        raise Error(f"{function}, texture_memory: {value!r} was given; expected a number of bytes, such as 500 << 20")
    return value


def _tell(scene: Scene) -> None:
    for sentence in scene.warnings:
        warnings.warn(sentence, UserWarning, stacklevel=3)


def assign(value: Any, attributes: dict[str, Any]) -> None:
    """Sets attributes of a value, as its constructor does with keyword arguments. `scale` is of what a light would
    send out without it, as in scene files: twice is twice as bright, although the attribute holds another number."""
    kind = type(value)
    names = settings_of(kind)
    for name in attributes:
        if name not in names and not (name == "look_at" and hasattr(kind, name)):
            raise Error(f"{kind.__name__}: " + unknown("attribute", name, names))
    # Those that set others at once (spectrum, roughness, resolution, look_at) come before these.
    late = ("scale", "crop", "end_world_from_camera")
    for name in sorted(attributes, key=lambda n: (n in late, n.endswith(("_u", "_v")))):
        if name == "look_at":
            given = attributes[name]
            if not (isinstance(given, (tuple, list)) and len(given) in (2, 3)):
                raise Error(
                    f"{kind.__name__}: look_at={given!r} was given; expected (eye, target) or (eye, target, up)"
                )
            value.look_at(*given)
        elif name == "scale" and is_number(attributes[name]) and attributes[name] >= 0:
            value.scale *= attributes[name]
        else:
            setattr(value, name, attributes[name])


def _represent(value: Any) -> str:
    kind = type(value)
    values = ", ".join(f"{name}={getattr(value, name)!r}" for name in settings_of(kind))
    return f"{kind.__name__}({values})"


VALUES = (
    *_core.MATERIALS,
    *_core.LIGHTS,
    _core.PerspectiveCamera,
    _core.OrthographicCamera,
    _core.SphericalCamera,
    _core.RealisticCamera,
    _core.Film,
    _core.Spectral,
    _core.BoxFilter,
    _core.TriangleFilter,
    _core.GaussianFilter,
    _core.MitchellFilter,
    _core.LanczosFilter,
    _core.Sampler,
    _core.Integrator,
    _core.Merging,
    _core.Occlusion,
)
for _kind in VALUES:
    setattr(_kind, "__repr__", _represent)
strict(*VALUES, _core.Shape, _core.Shapes, _core.Materials, _core.Lights, Scene)
