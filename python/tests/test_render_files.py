"""Saved renders: the header that the program writes, slices that it joins, denoised layers."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import montelux
from small_scene import TEXT

PROGRAM = os.environ.get("MONTELUX_PROGRAM", "")
needs_program = pytest.mark.skipif(not os.access(PROGRAM, os.X_OK), reason="MONTELUX_PROGRAM names no program")


def run(folder, *arguments):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], cwd=folder, check=True, capture_output=True, text=True
    ).stdout


def header(folder, file):
    """The lines of entries, by name."""
    lines = [line for line in run(folder, "info", file).splitlines() if " = " in line]
    return {line.split(" = ")[0].strip().strip('"'): line.split(" = ", 1)[1] for line in lines}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scene.pbrt").write_text(TEXT)
    return tmp_path


@needs_program
def test_the_header_is_that_of_the_program(folder):
    run(folder, "render", "scene.pbrt", "--quiet", "--spp", 24, "--seed", 9, "--slice", "2/3", "-o", "program.exr")
    scene = montelux.load(folder / "scene.pbrt")
    scene.render(spp=24, seed=9, slice=(2, 3)).save(folder / "python.exr")
    program, python = header(folder, "program.exr"), header(folder, "python.exr")
    assert len(program) > 20 and python["slice"] == '"2/3"' and python["seed"] == '"9"'
    assert {k: v for k, v in program.items() if k != "renderSeconds"} == {
        k: v for k, v in python.items() if k != "renderSeconds"
    }
    there, here = montelux.read_channels(folder / "program.exr"), montelux.read_channels(folder / "python.exr")
    assert there.keys() == here.keys() and all(np.array_equal(there[c], here[c], equal_nan=True) for c in there)
    scene.materials[0].reflectance = 0.1
    scene.render(spp=24, target_error=0.9).save(folder / "other.exr")
    other = header(folder, "other.exr")
    assert other["renderHash"] != python["renderHash"] and other["sceneHash"] != python["sceneHash"]
    assert float(other["targetError"]) == pytest.approx(0.9) and other["stoppedBy"] == '"error"'


@needs_program
def test_slices_are_joined_with_those_of_the_program(folder):
    scene = montelux.load(folder / "scene.pbrt")
    for k in (1, 3):
        scene.render(spp=24, slice=(k, 3)).save(folder / f"part{k}.exr")
    run(folder, "render", "scene.pbrt", "--quiet", "--spp", 24, "--slice", "2/3", "-o", "part2.exr")
    run(folder, "merge", "part1.exr", "part2.exr", "part3.exr", "-o", "joined.exr", "--quiet")
    joined, whole = montelux.read_channels(folder / "joined.exr"), scene.render(spp=24)
    for i, channel in enumerate("RGB"):
        assert joined[channel] == pytest.approx(whole.mean[:, :, i], rel=1e-5, abs=1e-6)
        assert joined[f"stderr.{channel}"] == pytest.approx(whole.standard_error[:, :, i], rel=1e-3, abs=1e-6)
    for layer in ("outlier", "warning"):
        assert joined[layer] == pytest.approx(whole.layers[layer], rel=1e-3, abs=1e-4)


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        ({"slice": (0, 3)}, r"slice=\(0, 3\) was given; expected \(k, n\) with k from 1 to n"),
        ({"slice": (4, 3)}, "with k from 1 to n"),
        ({"slice": (1, 2, 3)}, "with k from 1 to n"),
        ({"slice": (1, 2), "target_error": 0.1}, "slices share a number of samples"),
        ({"slice": (1, 2), "adaptive": True}, "slices share a number of samples"),
    ],
)
def test_wrong_slices_are_answered(arguments, sentence):
    with pytest.raises(montelux.Error, match=sentence):
        montelux.parse(TEXT).render(**arguments)


def test_a_missing_denoiser_is_an_error_before_the_render(monkeypatch, tmp_path):
    monkeypatch.setenv("MONTELUX_OIDN_LIBRARY", str(tmp_path / "no.so"))
    with pytest.raises(montelux.Error, match="Open Image Denoise cannot be loaded"):
        montelux.parse(TEXT).render(denoise=True)


def test_the_denoiser_of_pip_is_found(monkeypatch, tmp_path):
    library = tmp_path / "pyoidn" / "oidn" / "lib" / "libOpenImageDenoise.so.2"
    library.parent.mkdir(parents=True)
    (tmp_path / "pyoidn" / "__init__.py").write_text("raise RuntimeError('it need not be imported')")
    library.write_text("no library")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "pyoidn", raising=False)
    monkeypatch.setenv("MONTELUX_OIDN_LIBRARY", "")
    with pytest.raises(montelux.Error, match=f"cannot be loaded from '{library}'"):
        montelux.parse(TEXT).render(denoise=True)
    # A library that the user names comes first.
    monkeypatch.setenv("MONTELUX_OIDN_LIBRARY", str(tmp_path / "mine.so"))
    with pytest.raises(montelux.Error, match="mine.so"):
        montelux.parse(TEXT).render(denoise=True)


def test_denoised_layers(tmp_path):
    scene = montelux.parse(TEXT)
    try:
        render = scene.render(spp=2, denoise=True).wait()
    except montelux.Error as error:
        assert "Open Image Denoise" in str(error)
        pytest.skip("there is no Open Image Denoise")
    plain = scene.render(spp=2)
    assert "denoised" not in plain.layers and np.array_equal(plain.mean, render.mean)
    smooth = render.layers["denoised"]
    assert smooth.shape == render.mean.shape and not np.array_equal(smooth, render.mean)
    truth = scene.render(spp=256).mean
    assert np.abs(smooth - truth).mean() < np.abs(render.mean - truth).mean()
    render.save(tmp_path / "both.exr")
    render.save(tmp_path / "shown.pfm")
    both, shown = montelux.read_channels(tmp_path / "both.exr"), montelux.read_channels(tmp_path / "shown.pfm")
    assert np.array_equal(both["R"], render.mean[:, :, 0]) and np.array_equal(both["denoised.R"], shown["R"])
    assert not np.array_equal(render.to_srgb(0), plain.to_srgb(0))
    stopped = scene.render(spp=1 << 24, denoise=True).stop()
    assert stopped.stopped_by == "cancelled" and "denoised" not in stopped.layers
