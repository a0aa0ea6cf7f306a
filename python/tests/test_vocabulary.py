"""One name for one setting: in the program, in Python, in C++ and in JSON."""

from __future__ import annotations

import inspect
import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import montelux
from montelux._names import settings_of

PROGRAM = os.environ.get("MONTELUX_PROGRAM", "")
needs_program = pytest.mark.skipif(not os.access(PROGRAM, os.X_OK), reason="MONTELUX_PROGRAM names no program")
ROOT = Path(__file__).resolve().parents[2]

#: Names before there was one vocabulary, and the one name now.
OLD = {
    "samples": "spp",
    "samples_per_pixel": "spp",
    "max_samples": "max_spp",
    "spp_max": "max_spp",
    "seconds": "time",
}


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=60)


def options(*command):
    """The long options of a command, as Python would write them."""
    text = program(*command, "--help").stdout
    return {name.replace("-", "_") for name in re.findall(r"^ +(?:-\w, ?)?--([a-z-]+)", text, re.M)} - {"help"}


def arguments(function):
    kind = inspect.Parameter.KEYWORD_ONLY
    return {name for name, p in inspect.signature(function).parameters.items() if p.kind is kind}


@needs_program
def test_options_of_render_have_the_names_of_python():
    of_scene = {n for kind in (montelux.Sampler, montelux.Integrator, montelux.Film) for n in settings_of(kind)}
    known, ours = options("render"), arguments(montelux.Scene.render)
    assert ours - known == {"progress", "every"}
    of_the_program = {"output", "rank_timeout", "debug_sample", "stats", "memory", "quiet"}
    of_the_program |= {"port", "host", "reference", "tev"}  # of the page that `view` serves
    loading = (montelux.Scene, montelux.load, montelux.parse)
    of_the_program |= {"texture_memory"}.intersection(*map(arguments, loading))
    of_files = arguments(montelux.load) | set(inspect.signature(montelux.Picture.save).parameters)
    # sampler.kind, integrator.method, .large_step_probability and .merging.memory, film.max_component_value, film.layers_in_camera_space, film.half, the groups of the lights, `time` of
    # montelux.load, which renders no sequences
    others = {"sampler", "integrator", "large_steps", "clamp", "layer_space", "no_half", "light_groups", "time_of_scene"}
    others |= {"merging_memory", "frames", "frame_rate", "turntable", "define"}  # the last: `definitions` of montelux.load
    assert known - ours - of_scene - of_the_program - of_files == others | {"bits"}  # 16 bits: of the program alone
    assert {"spp", "max_spp", "time"} <= known & ours and "spp" in settings_of(montelux.Sampler)


@needs_program
def test_options_of_integrate_have_the_names_of_python():
    known, ours = options("integrate"), arguments(montelux.integrate)
    assert ours - known == {"batch", "out", "array", "workers", "covariance", "progress"}
    of_the_program = {"over", "density", "method", "domain", "radius", "centre", "log", "json", "quiet", "save_density"}
    of_the_program |= {"let", "library", "source"}
    assert known - ours == of_the_program | {"plot", "points", "points_limit"}


@needs_program
def test_json_has_the_same_names(scene, tmp_path):
    scene.render(spp=3, seed=5).save(tmp_path / "picture.exr")
    header = json.loads(program("info", "--json", tmp_path / "picture.exr").stdout)["attributes"]
    assert header["spp"] == 3
    names = {re.sub("[A-Z]", lambda m: "_" + m[0].lower(), name) for name in header}
    assert names & options("render") >= {"spp", "adaptive", "slice", "seed", "sampler", "strategy", "max_depth"}
    assert not names & OLD.keys()
    keys = set(json.loads(program("integrate", "x", "--over", "x=0:1", "--json").stdout))
    of_the_run = {"seed", "variables", "formulas", "domain", "chi_squared_per_degree", "reason"}
    assert keys - set(dir(montelux.integrate(np.sin, (0, 1)))) - of_the_run == set()


def test_cpp_has_the_same_names():
    """Fields of the settings that the options are copied to."""

    def fields(folder, struct):
        texts = (path.read_text(encoding="utf-8") for path in (ROOT / folder).rglob("*.h"))
        (body,) = (m[1] for text in texts for m in re.finditer(rf"struct {struct} {{\n(.*?)\n}};", text, re.S))
        return set(re.findall(r"^    [\w:<> ]+? (\w+)(?: = [^;]*|{[^}]*})?;", body, re.M))

    assert {"spp", "seed"} <= fields("montelux/mc/random", "SamplerSettings")
    assert {"time", "adaptive", "slice"} <= fields("montelux/render", "RenderTarget")
    assert {"time", "evaluations"} <= fields("montelux/mc/integrate", "Budget")


def test_no_text_has_an_old_name():
    """In what is compiled, run and read; notebooks too."""
    old = re.compile(r"samples_per_pixel|samplesPerPixel|spp[_-]max|max_samples|render\([^)\n]*\b(samples|seconds)=")
    table = ROOT / "montelux/mc/math/nearest_name.cpp"  # answers them
    found = [
        f"{path.relative_to(ROOT)}: {match[0]}"
        for folder in ("app", "montelux", "python/montelux", "python/src", "docs", "examples", "scenes", "README.md")
        for path in ([ROOT / folder] if (ROOT / folder).is_file() else (ROOT / folder).rglob("*"))
        if path.suffix in (".cpp", ".h", ".py", ".md", ".ipynb", ".pbrt", ".sh") and path != table
        for match in old.finditer(path.read_text(encoding="utf-8"))
    ]
    assert found == []


@needs_program
@pytest.mark.parametrize("old, new", OLD.items())
def test_the_program_answers_old_names(old, new):
    given, offered = (f"--{name.replace('_', '-')}" for name in (old, new))
    for word in (given, f"{given}=3"):
        ended = program("render", "scene.pbrt", word, "3")
        assert ended.returncode == 2
        assert f"there is no option '{given}' (did you mean '{offered}'?)" in ended.stderr


@pytest.mark.parametrize("old, new", OLD.items())
def test_python_answers_old_names(scene, old, new):
    with pytest.raises(montelux.Error, match=rf"there is no argument '{old}' \(did you mean '{new}'\?\)"):
        scene.render(**{old: 3})


def test_python_answers_old_names_elsewhere(scene):
    for old in ("samples", "samples_per_pixel"):
        with pytest.raises(montelux.Error, match=rf"'{old}' \(did you mean 'spp'\?\)"):
            setattr(scene.sampler, old, 3)
    with pytest.raises(montelux.Error, match=r"'samples_per_pixel' \(did you mean 'spp'\?\)"):
        scene.render(spp=1).samples_per_pixel
    with pytest.raises(montelux.Error, match=r"'samples' \(did you mean 'spp'\?\)"):
        montelux.Sampler(samples=3)
    for run in (montelux.integrate, montelux.integrate_log):
        with pytest.raises(montelux.Error, match=r"'seconds' \(did you mean 'time'\?\)"):
            run(np.sin, (0, 1), seconds=1)
    result = montelux.integrate(np.sin, (0, 1))
    with pytest.raises(montelux.Error, match=r"'time' \(did you mean 'seconds'\?\)"):  # a measurement, not a limit
        result.time


@needs_program
def test_texts_promise_no_option_that_does_not_exist():
    """Options in messages are those of some command."""
    commands = ["render", "integrate", "sample", "merge", "compare", "denoise", "convert", "info"]
    commands += ["bake brdf", "bake environment", "bake report", "bake sky"]
    known = {"help", "version", "mpi"}.union(*(options(*command.split()) for command in commands))  # srun has --mpi
    found = set()
    for path in [path for folder in ("app", "montelux") for path in (ROOT / folder).rglob("*.cpp")]:
        for text in re.findall(r'"((?:[^"\\\n]|\\.)*)"', path.read_text(encoding="utf-8")):
            for name in re.findall(r"(?<![\w-])--([a-z][a-z-]+)", text):
                if name.replace("-", "_") not in known:
                    found.add(f"{path.relative_to(ROOT)}: --{name}")
    assert found == set()
