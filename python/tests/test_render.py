"""Scenes and renders: arrays with errors, progress, Ctrl-C, and the bits of the program."""

from __future__ import annotations

import gc
import os
import shutil
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
import zlib

import numpy as np
import pytest

import montelux
from small_scene import TEXT


def white_furnace(reflectance=0.5):
    """A sphere under a white sky, built in Python: its points send back their albedo."""
    scene = montelux.Scene()
    scene.camera = montelux.PerspectiveCamera(fov=40, look_at=((0, -4, 0), (0, 0, 0)))
    scene.film.resolution = 16, 16
    scene.sampler.kind = "independent"
    scene.sampler.spp = 64
    scene.lights.append(montelux.UniformInfiniteLight(spectrum=(1, 1, 1)))
    scene.add_sphere(1, montelux.Diffuse(reflectance=reflectance))
    return scene


def test_a_render_gives_arrays_with_errors(scene):
    render = scene.render()
    assert render.mean.shape == render.standard_error.shape == (24, 32, 3) and render.mean.dtype == np.float32
    assert set(render.layers) == {
        "mean", "standard_error", "skewness", "albedo", "normal", "samples", "replicates", "outlier", "warning", "depth",
    }  # fmt: skip
    assert render.layers["depth"].shape == (24, 32) and np.all(render.layers["samples"] == 16)
    assert render.stopped_by == "samples" and render.spp == 16 and render.finished
    assert 0 < render.relative_error < 0.2 and render.seconds > 0
    assert np.array_equal(np.asarray(render), render.mean)
    assert not render.mean.flags.writeable and render.mean.base is not None
    with pytest.raises((ValueError, TypeError)):
        render.mean[0, 0] = 1


def test_layers_are_views_of_one_picture(scene):
    render = scene.render(spp=1)
    mean, error = render.mean, render.standard_error
    address = [a.__array_interface__["data"][0] for a in (mean, error)]
    assert address[1] - address[0] == 3 * 4 and mean.strides[1] == error.strides[1] > 9 * 4
    del render
    assert mean.sum() > 0  # the arrays keep the picture alive


def test_the_mean_is_right():
    render = white_furnace().render(spp=256)
    middle = render.mean[7:9, 7:9]
    assert np.all(np.abs(middle - 0.5) < 6 * render.standard_error[7:9, 7:9] + 1e-4)
    corner = render.mean[0, 0]
    assert corner == pytest.approx([1, 1, 1], abs=0.2)


def test_threads_change_no_bit(scene):
    assert np.array_equal(scene.render(threads=1).mean, scene.render(threads=3).mean)
    assert not np.array_equal(scene.render(seed=4).mean, scene.render().mean)
    assert scene.sampler.seed == 3  # render(seed=...) is of that render alone


def test_targets_and_times(scene):
    render = scene.render(target_error=0.1)
    assert render.stopped_by == "error" and render.relative_error <= 0.1
    assert scene.render(target_error=1e-6, max_spp=32).stopped_by == "samples"
    begin = time.monotonic()
    assert scene.render(time=0.2).stopped_by == "time" and time.monotonic() - begin < 5
    assert scene.render(spp=4).layers["samples"].max() == 4


# Progress and interruption.


def test_iterating_gives_pictures_meanwhile(scene):
    scene.film.resolution = 64, 48
    pictures = list(scene.render(spp=256, every=0.02, threads=1))
    assert len(pictures) >= 3 and isinstance(pictures[-1], montelux.Render)
    taken = [p.spp for p in pictures]
    assert taken == sorted(taken) and taken[0] < taken[-1] == 256
    assert all(p.mean.shape == (48, 64, 3) for p in pictures)
    whole = scene.render(spp=256).mean
    assert np.array_equal(pictures[-1].mean, whole)  # looking changes no bit
    unfinished = [p for p in pictures if p.spp < 256][-1]
    assert np.median(np.abs(unfinished.mean - whole)) < 0.1 and not np.array_equal(unfinished.mean, whole)


def test_progress_is_reported(scene, capsys):
    scene.film.resolution = 64, 48
    seen = []
    scene.render(spp=256, progress=seen.append).wait()
    assert seen and all(0 <= p.share <= 1 for p in seen)
    scene.render(spp=16, progress=True).wait()
    assert capsys.readouterr().out == ""


def test_other_threads_run_meanwhile(scene):
    scene.film.resolution = 64, 48
    done, counted = threading.Event(), []

    def count():
        while not done.is_set():
            counted.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    render = scene.render(time=0.3, threads=1)
    before = len(counted)
    render.wait()
    after = len(counted)
    done.set()
    thread.join()
    assert after - before > 20


def test_stop_returns_the_samples_so_far(scene):
    scene.film.resolution = 160, 120
    render = scene.render(spp=1 << 20)
    assert not render.finished and "going on" in repr(render)
    time.sleep(0.1)
    render.stop()
    assert render.stopped_by == "cancelled" and 0 < render.spp < 1 << 20
    assert "stopped by cancelled" in repr(render)


INTERRUPTED = """
import os, signal, sys, threading, time
import montelux
scene = montelux.parse(sys.argv[1])
scene.film.resolution = 160, 120
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a parent in the background ignores
def soon():
    time.sleep(0.4)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=soon, daemon=True).start()
begin = time.monotonic()
render = scene.render(spp=1 << 24)
mean = {what}
print(render.stopped_by, mean.shape, render.spp > 0)
sys.exit(0 if time.monotonic() - begin < 10 else 3)
"""


@pytest.mark.parametrize("what", ["render.mean", "list(render)[-1].mean"])
def test_ctrl_c_ends_a_render_with_what_it_has(what):
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED.format(what=what), TEXT], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0 and done.stdout == "cancelled (120, 160, 3) True\n", done.stderr


def test_a_program_may_end_in_the_middle_of_a_render():
    code = "import sys, montelux; r = montelux.parse(sys.argv[1]).render(spp=1 << 24); print('end')"
    done = subprocess.run([sys.executable, "-c", code, TEXT], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout == "end\n" and done.stderr == ""


def test_resumed_runs_have_the_same_bits(scene, tmp_path):
    whole = scene.render(spp=64).mean
    state = tmp_path / "render.state"
    assert scene.render(spp=32, checkpoint=state).stopped_by == "samples"
    with pytest.raises(montelux.Error, match="the file exists; pass resume=True"):
        scene.render(spp=64, checkpoint=state)
    scene.materials[0].reflectance = 0.3
    with pytest.raises(montelux.Error, match="scene"):
        scene.render(spp=64, checkpoint=state, resume=True)
    again = montelux.parse(TEXT)
    resumed = again.render(spp=64, checkpoint=state, resume=True)
    assert resumed.spp == 64
    assert np.abs(resumed.mean - whole).mean() < 0.05


def test_scenes_are_known_by_their_values(tmp_path):
    state = tmp_path / "render.state"
    white_furnace(0.1).render(spp=4, checkpoint=state)
    with pytest.raises(montelux.Error, match="of another render: the scene's materials differ"):
        white_furnace(0.9).render(spp=8, checkpoint=state, resume=True)
    moved = white_furnace(0.1)
    moved.add_disk(1, montelux.Diffuse(reflectance=0.1))
    with pytest.raises(montelux.Error, match="the scene's geometry differs"):
        moved.render(spp=8, checkpoint=state, resume=True)
    # Neither what was there in between nor how it came about counts.
    same = white_furnace(0.9)
    same.materials[0].reflectance = 0.1
    resumed = same.render(spp=8, checkpoint=state, resume=True)
    assert np.array_equal(resumed.mean, white_furnace(0.1).render(spp=8).mean)


def test_comments_do_not_change_a_scene(tmp_path):
    state, text = tmp_path / "render.state", TEXT
    montelux.parse(text).render(spp=4, checkpoint=state)
    with pytest.raises(montelux.Error, match="the scene's lights differ"):
        montelux.parse(text.replace("[ 2 2 2 ]", "[ 2 2 3 ]")).render(spp=8, checkpoint=state, resume=True)
    montelux.parse("# as before\n" + text).render(spp=8, checkpoint=state, resume=True)


def test_snapshots_write_no_checkpoint(scene, tmp_path):
    state = tmp_path / "render.state"
    render = scene.render(time=60, checkpoint=state, checkpoint_every=1000, every=0.02)
    assert not any(state.exists() for _, _ in zip(range(6), render))
    render.stop()
    assert state.exists()  # written at the end
    often = tmp_path / "often.state"  # snapshots do not delay checkpoints
    render = scene.render(time=60, checkpoint=often, checkpoint_every=0.1, every=0.02)
    assert any(often.exists() for _ in render) and not render.finished
    render.stop()


def test_checkpoint_that_cannot_be_written_is_a_warning(scene, tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    render = scene.render(time=60, checkpoint=folder / "render.state", checkpoint_every=1000, every=0.02)
    next(iter(render))
    shutil.rmtree(folder)
    with pytest.warns(RuntimeWarning, match="render.state"):
        render.stop()


# Pictures.


def test_pictures_show_and_save(scene, tmp_path):
    render = scene.render()
    png = render._repr_png_()
    assert png[:8] == b"\x89PNG\r\n\x1a\n" and png[-8:-4] == b"IEND"
    (tmp_path / "show.png").write_bytes(png)
    shown = montelux.read_channels(tmp_path / "show.png")
    assert np.stack([shown[c] for c in "RGB"], -1) == pytest.approx(np.clip(render.mean, 0, 1), abs=0.02)
    assert render.to_srgb().shape == (24, 32, 3)
    render.save(tmp_path / "render.exr")
    layers = montelux.read_channels(tmp_path / "render.exr")
    assert np.array_equal(layers["stderr.G"], render.standard_error[:, :, 1])
    with pytest.raises(montelux.Error, match="extension|format|xyz"):
        render.save(tmp_path / "render.xyz")
    render.save(tmp_path / "plain.png")
    assert not np.array_equal(render.to_srgb(0.0), render.to_srgb(0.0, tone="agx"))
    for name, settings in {"up": {"exposure": 2.0}, "auto": {"exposure": "auto"}, "aces": {"tone": "aces"}}.items():
        render.save(tmp_path / f"{name}.png", **settings)
        assert (tmp_path / f"{name}.png").read_bytes() != (tmp_path / "plain.png").read_bytes()
    render.save(tmp_path / "low.jpg", quality=5)
    render.save(tmp_path / "high.jpg")
    assert (tmp_path / "low.jpg").stat().st_size < (tmp_path / "high.jpg").stat().st_size
    with pytest.raises(montelux.Error, match="did you mean 'agx'"):
        render.save(tmp_path / "x.png", tone="agxx")
    assert zlib.crc32(png) != 0


def test_compare(scene, tmp_path):
    a, b = scene.render(), scene.render(seed=9)
    found = montelux.compare(a, b)
    assert found.pixels == 24 * 32 and 0 < found.rmse < 0.2 and [c.name for c in found.channels] == list("RGB")
    assert 0.5 < found.z_pooled.standard_deviation < 2 and abs(found.z_pooled.mean) < 0.5
    a.save(tmp_path / "a.exr")
    assert montelux.compare(tmp_path / "a.exr", b).rmse == found.rmse
    arrays = montelux.compare((a.mean, a.standard_error), (b.mean, b.standard_error))
    assert arrays.rmse == pytest.approx(found.rmse) and arrays.z.count == found.z.count
    assert montelux.compare(a.mean, a.mean).rmse == 0 and montelux.compare(a.mean, a.mean).z is None
    assert "RMSE" in repr(found)
    with pytest.raises(montelux.Error, match="size|pixels"):
        montelux.compare(a.mean, b.mean[:-1])


def test_a_crop_is_compared_with_the_whole(scene, tmp_path):
    scene.sampler.kind = "independent"
    whole = scene.render()
    scene.film.crop = 8, 6, 20, 24
    crop = scene.render()
    crop.save(tmp_path / "crop.exr")
    for part in (crop, tmp_path / "crop.exr"):
        found = montelux.compare(part, whole)
        assert found.window == (8, 6, 20, 24) and found.pixels == 12 * 18 and found.rmse == 0 and found.z is not None
    assert montelux.compare(whole, whole).window == (0, 0, 32, 24)
    scene.film.crop = 0, 0, 8, 6
    with pytest.raises(montelux.Error, match="no pixel in common"):
        montelux.compare(crop, scene.render())


# The program.


def test_the_program_gives_the_same_bits(scene, tmp_path):
    program = os.environ.get("MONTELUX_PROGRAM", "")
    if not os.access(program, os.X_OK):
        pytest.skip("MONTELUX_PROGRAM names no program")
    (tmp_path / "scene.pbrt").write_text(TEXT)
    for arguments, settings in ((["--spp", "32"], {"spp": 32}), (["--target-error", "10%"], {"target_error": 0.1})):
        subprocess.run(
            [program, "render", "scene.pbrt", "-o", "out.exr", "--quiet", *arguments], cwd=tmp_path, check=True
        )
        file, render = montelux.read_channels(tmp_path / "out.exr"), scene.render(**settings)
        for i, channel in enumerate("RGB"):
            assert np.array_equal(file[channel], render.mean[:, :, i])
            assert np.array_equal(file[f"stderr.{channel}"], render.standard_error[:, :, i])
        assert np.array_equal(file["depth.Z"], render.layers["depth"])


def test_a_page_shows_a_render(scene):
    plain = scene.render()
    render = scene.render(view=True)
    url = render.view.url
    assert url.startswith("http://127.0.0.1:") and url in render.view._repr_html_() and "<iframe" in render.view._repr_html_()
    with urllib.request.urlopen(url) as page:
        assert b"<title>" in page.read()
    with pytest.raises(urllib.error.HTTPError, match="403"):
        urllib.request.urlopen(url[:-1] + ("0" if url[-1] != "0" else "1"))
    assert np.array_equal(render.mean, plain.mean) and np.array_equal(render.standard_error, plain.standard_error)
    with urllib.request.urlopen(url.replace("/?", "/picture.png?")) as picture:  # also after the end
        assert picture.read().startswith(b"\x89PNG")
    with pytest.raises(montelux.Error, match="view=True"):
        plain.view
    del render
    gc.collect()
    with pytest.raises(OSError):
        urllib.request.urlopen(url)


def test_a_viewed_render_is_stopped(scene):
    render = scene.render(spp=1 << 24, view=True)
    assert next(iter(render)).mean.max() > 0
    assert render.stop().stopped_by == "cancelled"


INTERRUPTED_PILOT = """
import os, signal, sys, threading, time
import montelux
signal.signal(signal.SIGINT, signal.default_int_handler)
scene = montelux.parse(sys.stdin.read())
scene.film.resolution = 1200, 900
scene.integrator.method = "auto"
begin = time.process_time()
whole = scene.render(spp=1 << 24, threads=1)  # goes on after the pilot
print(time.process_time() - begin)
whole.stop()
begin = time.process_time()
threading.Timer(0.25, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    scene.render(spp=1 << 24, threads=1)
except KeyboardInterrupt:
    print(time.process_time() - begin)
"""


def test_ctrl_c_ends_a_pilot():
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED_PILOT], input=TEXT, capture_output=True, text=True, timeout=120
    )
    whole, interrupted = map(float, done.stdout.split())
    assert done.stderr == "" and interrupted < 0.6 * whole, (whole, interrupted)


def test_an_integrator_is_chosen_by_a_pilot(scene):
    scene.film.resolution = 64, 48
    scene.sampler.spp = 256
    scene.integrator.method = "auto"
    chosen = scene.render()
    assert scene.integrator.method == "auto"
    scene.integrator.method = "path"
    assert np.array_equal(chosen.mean, scene.render().mean)
    scene.integrator.method = "auto"
    with pytest.raises(montelux.Error, match="all slices of a picture must be rendered by the same integrator"):
        scene.render(slice=(1, 2))
