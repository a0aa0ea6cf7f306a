"""Tests of the displayed picture: tone curves, false colors, light mix, comparison, zoom."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

import tone_reference
from fake_picture import FakePicture
from page_harness import Viewer, wait_for
from picture_codes import assert_close, mean_codes, viridis


def test_picture_appears(b: Any) -> None:
    with Viewer(b, seconds=3) as v:
        v.wait(lambda s: s["progress"] and 0 < s["progress"]["share"] < 1, "progress")
        assert re.match(r"\d+ % studio.pbrt", v.page.title()), v.page.title()
        v.wait_for_end()
        assert_close(v.picture(), mean_codes(v), 1, "picture")
        assert v.page.evaluate("montelux.readPixel(70, 20)") == v.picture()[20, 70].tolist()
        # What is on the screen is what readPixel gives.
        x, y = v.on_screen(70, 20)
        shot = v.page.screenshot(clip={"x": int(x), "y": int(y), "width": 1, "height": 1})
        assert shot[:4] == b"\x89PNG"
        status = v.text("#status")
        for part in ("Ended: all samples taken", "100 %", "64 samples per pixel", "error ± ", "noise visible in"):
            assert part in status, f"{part} is missing in {status!r}"
        assert v.page.title() == "studio.pbrt · ended: all samples taken"


def test_tone_curves(b: Any) -> None:
    with Viewer(b, FakePicture(specials=True), seconds=0.3) as v:
        v.wait_for_end()
        for tone in tone_reference.TONES:
            v.page.select_option("#tone", tone)
            for exposure in (-6, -2.5, 0, 1.3, 5, 10):
                v.set_range("#exposure", exposure)
                assert_close(v.picture(), mean_codes(v, exposure, tone), 1, f"{tone} at {exposure} stops")


def test_exposure_needs_no_server(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        v.settle()
        before = (len(v.server.received), len(v.server.requests))
        old = v.picture()
        v.set_range("#exposure", 2)
        v.page.select_option("#tone", "agx")
        v.page.locator("#stage").focus()
        v.page.keyboard.press("e")
        v.page.keyboard.press("t")
        v.settle()
        assert v.state()["exposure"] == 2.5 and v.state()["tone"] == "filmic"
        assert not np.array_equal(v.picture(), old)
        assert (len(v.server.received), len(v.server.requests)) == before, "the page spoke to the server"
        href = v.page.get_attribute("#save-png", "href")
        assert href.startswith("/picture.png?token=") and href.endswith("&exposure=2.5&tone=filmic"), href
        with v.page.expect_download():
            v.page.click("#save-png")
        assert v.server.requests[-1] == href


def test_automatic_exposure(b: Any) -> None:
    with Viewer(b, FakePicture(96, 54, specials=True), exposure=None) as v:
        v.wait(lambda s: not s["isExposureAutomatic"], "the exposure is fixed")
        fixed = v.state()["exposure"]
        luminance = v.server.picture.layer("reference").astype(float) @ [0.2126, 0.7152, 0.0722]
        expected = np.log2(0.18 / np.exp(np.log(luminance).mean()))
        assert abs(fixed - expected) < 0.3, (fixed, expected)
        v.wait_for_end()
        assert v.state()["exposure"] == fixed, "the exposure moved after the first picture"
        v.set_range("#exposure", 3)
        v.page.click("#auto-exposure")
        mean = v.server.picture.layer("mean").astype(float) @ [0.2126, 0.7152, 0.0722]
        good = mean[np.isfinite(mean) & (mean > 0)]
        assert abs(v.state()["exposure"] - np.log2(0.18 / np.exp(np.log(good).mean()))) < 0.02


def test_light_mix(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        v.page.locator("#lights summary").click()
        v.page.click("#lights .start")
        v.wait(lambda s: s["epoch"] == 1 and len(s["weights"]) == 2, "the lights")
        assert v.server.sent("light groups") == [{"type": "light groups", "on": True}]
        v.wait_for_end()
        assert_close(v.picture(), mean_codes(v), 1, "mean")
        v.set_range("[aria-label='Stops of key']", 1.5)
        v.page.locator("[aria-label='Tint of sky']").evaluate(
            "e => { e.value = '#ff8000'; e.dispatchEvent(new Event('input')); }")
        v.settle()
        assert v.state()["shown"][0] == "light mix"
        assert set(v.server.sent("show")[-1]["layers"]) == {"light key", "light sky"}
        messages = len(v.server.received)
        key, sky = (v.server.picture.layer(f"light {n}").astype(float) for n in ("key", "sky"))
        tint = np.array([1, ((128 / 255 + 0.055) / 1.055) ** 2.4, 0])
        expected = tone_reference.codes(2 ** 1.5 * key + tint * sky, 0, "srgb")
        assert_close(v.picture(), expected, 1, "light mix")
        v.page.locator("[aria-label='Light of key']").uncheck()
        assert_close(v.picture(), tone_reference.codes(tint * sky, 0, "srgb"), 1, "without key")
        v.select("light key")
        messages += 1  # show
        assert_close(v.picture(), tone_reference.codes(key, 0, "srgb"), 1, "a light's layer")
        v.page.click("#lights .reset")
        v.settle()
        messages += 1
        assert_close(v.picture(), tone_reference.codes(key + sky, 0, "srgb"), 1, "reset")
        assert len(v.server.received) == messages, "mixing speaks to the server"


def test_compare(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        v.page.locator("#stage").focus()
        v.page.keyboard.press("c")
        v.settle()
        assert v.state()["shown"] == ["mean", "reference"]
        assert set(v.server.sent("show")[-1]["layers"]) == {"mean", "reference"}
        v.page.mouse.move(*v.on_screen(9, 9))
        value = v.server.picture.layer("reference")[9, 9, 0]
        wait_for(lambda: f"{value:.4g}" in v.text("#readout"), "the reference in the readout")
        mean, reference = mean_codes(v), tone_reference.codes(v.server.picture.layer("reference"), 0, "srgb")
        middle = v.server.picture.width // 2
        assert_close(v.picture(), np.concatenate([mean[:, :middle], reference[:, middle:]], 1), 1, "half and half")
        box, (x, y) = v.page.locator("#wipe").bounding_box(), v.on_screen(20, 27)
        v.page.mouse.move(box["x"] + box["width"] / 2, y)
        v.page.mouse.down()
        v.page.mouse.move(x - v.state()["scale"] / 2, y, steps=3)
        v.page.mouse.up()
        assert_close(v.picture(), np.concatenate([mean[:, :20], reference[:, 20:]], 1), 1, "after a drag")
        v.page.focus("#wipe")
        v.page.keyboard.press("End")
        assert_close(v.picture(), mean, 1, "all of A")
        assert v.state()["chosen"] is None and v.state()["corner"][0] > 0


def test_false_colors(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        p = v.server.picture
        v.select("relative error")
        ratio = p.layer("relative error").astype(float)[..., 0]
        assert_close(v.picture(), viridis(np.log10(ratio / 0.001) / 3), 1.01, "relative error")
        ticks = v.page.locator("#legend .ticks span").all_inner_texts()
        assert ticks == ["0.1 %", "1 %", "10 %", "100 %"], ticks
        v.select("depth")
        low, high = v.state()["ranges"][0]
        depth = p.layer("depth").astype(float)[..., 0]
        finite = np.isfinite(depth)
        assert depth[finite].min() <= low < high <= depth[finite].max()
        expected = viridis((np.where(finite, depth, 0) - low) / (high - low))
        expected[~finite] = 128
        assert_close(v.picture(), expected, 1.01, "depth")
        v.select("normal")
        assert_close(v.picture(), np.clip(p.layer("normal").astype(float) * 0.5 + 0.5, 0, 1) * 255, 1, "normal")
        v.select("material")
        found = v.picture().reshape(-1, 3)
        ids = p.ids.ravel()
        assert all(len(np.unique(found[ids == i], axis=0)) == 1 for i in np.unique(ids)), "ids share no color"
        assert len(np.unique(found, axis=0)) == len(np.unique(ids)), "colors repeat"
        v.select("z")
        z = p.layer("z").astype(float)[..., 0]
        assert (v.picture()[z > 1][:, 0] > v.picture()[z > 1][:, 2]).all(), "positive z-scores are red"
        assert_close(v.picture()[np.abs(z) < 0.02], np.float64(247), 3, "z-scores of zero are white")
        v.select("samples")
        assert v.page.is_visible("#legend")
        v.select("error")
        assert v.page.is_visible("#legend")


def test_zoom(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        overlay = """() => {
            const from = document.getElementById('overlay'), to = document.createElement('canvas');
            Object.assign(to, {width: from.width, height: from.height});
            const context = to.getContext('2d', {willReadFrequently: true});
            context.drawImage(from, 0, 0);
            return context.getImageData(0, 0, to.width, to.height).data.some(v => v > 0); }"""
        assert not v.page.evaluate(overlay)
        x, y = v.on_screen(60, 30)
        v.page.mouse.move(x, y)
        for _ in range(6):
            v.page.mouse.wheel(0, -200)
        v.settle()
        assert v.state()["scale"] > 32 and v.state()["hovered"] == {"x": 60, "y": 30}, v.state()
        near = v.on_screen(60, 30)
        # Chromium rounds the pointer's place, here by up to half a pixel times the zoom of 11.
        assert abs(near[0] - x) < 8 and abs(near[1] - y) < 8, "the pixel under the pointer moved"
        assert v.page.evaluate(overlay), "no values over the pixels"
        v.page.mouse.down()
        v.page.mouse.move(x + 50, y + 20, steps=4)
        v.page.mouse.up()
        moved = v.on_screen(60, 30)
        assert abs(moved[0] - near[0] - 50) < 1 and v.state()["chosen"] is None, (moved, x)
        v.page.locator("#stage").focus()
        v.page.keyboard.press("0")
        v.settle()
        assert not v.page.evaluate(overlay)
        fitted = v.state()["scale"]
        v.page.keyboard.press("+")
        assert v.state()["scale"] > fitted and np.log2(v.state()["scale"]) % 1 == 0
        v.page.keyboard.press("1")
        assert v.state()["scale"] == 1
        corner = v.state()["corner"]
        v.page.keyboard.press("ArrowLeft")
        assert v.state()["corner"][0] == corner[0] + 60
        v.page.mouse.click(*v.on_screen(5, 6))
        assert v.state()["chosen"] == {"x": 5, "y": 6}
        v.page.keyboard.press("Escape")
        assert v.state()["chosen"] is None


def test_touch(b: Any) -> None:
    phone = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}
    with Viewer(b, seconds=0.3, context=phone) as v:
        v.wait_for_end()
        client = v.context.new_cdp_session(v.page)

        def touch(kind: str, *points: Any) -> None:
            client.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [
                {"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})

        x, y = v.on_screen(48, 27)
        before = v.state()
        touch("touchStart", (x - 20, y), (x + 20, y))
        for d in range(24, 64, 4):
            touch("touchMove", (x - d, y), (x + d, y))
        touch("touchEnd")
        after = v.state()
        assert abs(after["scale"] / before["scale"] - 3) < 0.15, (before["scale"], after["scale"])
        touch("touchStart", (x, y))
        for d in range(4, 44, 4):
            touch("touchMove", (x + d, y + d / 2))
        touch("touchEnd")
        assert abs(v.state()["corner"][0] - after["corner"][0] - 40) < 6
        assert v.state()["chosen"] is None and v.page.evaluate("scrollY") == 0
        v.page.touchscreen.tap(x, y)
        wait_for(lambda: "±" in v.text("#readout"), "the tapped pixel's values")
