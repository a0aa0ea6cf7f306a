"""Tests of the panels and controls: error, readout, replay, limits, camera, keyboard."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from page_harness import Viewer, wait_for


def test_error_chart(b: Any) -> None:
    with Viewer(b, seconds=5) as v:
        v.server.target["error"] = 0.005
        v.page.wait_for_selector("#curve polyline")
        wait_for(lambda: "Forecast: 0.50 % after" in v.text("#curve"), "the forecast")
        v.page.wait_for_selector("#curve .forecast", state="attached")
        v.wait_for_end()
        points = [tuple(map(float, p.split(","))) for p in
                  v.page.get_attribute("#curve polyline", "points").split()]
        assert len(points) > 5
        assert all(a[0] < c[0] and a[1] < c[1] for a, c in zip(points, points[1:])), "the error does not fall"
        assert "target 0.50 %" in v.page.locator("#curve text.target").text_content()
        assert v.page.locator("#histogram rect").count() > 0


def test_readout(b: Any) -> None:
    with Viewer(b, seconds=0.3, x0=1000, y0=500) as v:
        v.wait_for_end()
        v.page.mouse.move(*v.on_screen(30, 12))
        wait_for(lambda: "±" in v.text("#readout"), "the answer")
        text = v.text("#readout")
        mean, spread = v.server.picture.layer("mean")[12, 30].astype(float), v.server.picture.spread()
        assert "1030, 512" in text and "\n64\n" in text, text
        decimals = 1 - int(np.floor(np.log10(mean[0] * spread)))
        assert f"{mean[0]:.{decimals}f} ± " in text, (text, mean)
        assert "depth" in text and "inf" in text, text
        asked, start = len(v.server.sent("pixel")), time.monotonic()
        for x in range(31, 61):
            v.page.mouse.move(*v.on_screen(x, 12))
        v.settle()
        assert v.server.sent("pixel")[-1] == {"type": "pixel", "x": 60, "y": 12}
        assert len(v.server.sent("pixel")) - asked < (time.monotonic() - start) / 0.1 + 2, "requests are not throttled"


def test_replay(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        v.page.mouse.click(*v.on_screen(20, 10))
        assert not v.server.sent("replay")
        v.page.locator("#replay summary").first.click()
        v.page.wait_for_selector(".tree details")
        assert v.server.sent("replay") == [{"type": "replay", "x": 20, "y": 10, "sample": 0}]
        heads = v.page.locator(".tree > details > summary").all_inner_texts()
        assert [h.split(":")[0].split(" of")[0] for h in heads] == ["sample 0", "vertex 1", "vertex 2", "end"], heads
        leaf = v.page.locator(".tree >> text=/^contribution/")
        assert not leaf.is_visible()
        v.page.locator(".tree summary", has_text="vertex 1").click()
        assert leaf.is_visible()
        v.page.click("#replay .next")
        wait_for(lambda: "sample 1 of" in v.text(".tree"), "the next sample")
        assert leaf.is_visible(), "headings do not stay open"
        v.page.fill("#replay input", "7")
        v.page.keyboard.press("Enter")
        wait_for(lambda: "sample 7 of" in v.text(".tree"), "sample 7")
        v.page.locator("#stage").focus()
        v.page.keyboard.press(",")
        v.page.keyboard.press("Shift+ArrowRight")
        wait_for(lambda: "sample 6 of 64 of pixel 21,10" in v.text(".tree"), "the neighbour's sample 6")


def test_limits(b: Any) -> None:
    with Viewer(b, seconds=20) as v:
        v.page.fill("#target-error", "0.3")
        v.page.keyboard.press("Enter")
        wait_for(lambda: v.server.sent("target"), "the message")
        assert v.server.sent("target") == [{"type": "target", "error": 0.003, "time": None}]
        v.page.fill("#target-time", "90")
        v.page.click("#limits button")
        v.settle()
        assert v.server.sent("target")[-1] == {"type": "target", "error": 0.003, "time": 90}
        v.wait(lambda s: s["progress"]["target_time"] == 90, "the limits")
        assert "target 0.30 %" in v.text("#status .error")
        v.page.fill("#target-error", "-1")
        v.page.keyboard.press("Enter")
        assert len(v.server.sent("target")) == 2
        assert "positive" in v.text("#note")
        v.page.fill("#target-error", "500")
        v.page.keyboard.press("Enter")
        wait_for(lambda: v.text("#note") == "Refused: the error is larger than 1", "the refusal")
        v.page.locator("#stage").focus()
        wait_for(lambda: v.page.input_value("#target-error") == "0.3", "the field follows the program")


def test_pause_stop_quit(b: Any) -> None:
    with Viewer(b, seconds=20) as v:
        v.wait(lambda s: s["progress"] and s["progress"]["samples"] > 0, "samples")
        v.page.click("#pause")
        v.wait(lambda s: s["progress"]["state"] == "paused", "pause")
        assert v.text("#pause") == "Resume" and v.text("#status .state") == "Paused"
        v.page.locator("#stage").focus()
        v.page.keyboard.press(" ")
        v.wait(lambda s: s["progress"]["state"] == "rendering", "resume by the space bar")
        v.page.click("#stop")
        v.wait(lambda s: s["progress"]["ended_by"] == "cancelled", "stop")
        assert v.text("#status .state") == "Ended: stopped"
        assert v.page.is_disabled("#pause") and v.page.is_disabled("#stop")
        v.page.click("#quit")
        v.page.click("#quit-dialog button >> text=Cancel")
        v.settle()
        assert not v.server.sent("quit")
        v.page.click("#quit")
        v.page.locator("#quit-dialog button[value=quit]").click()
        v.wait(lambda s: s["connection"] == "ended", "goodbye")
        assert "The program has ended" in v.text("#status .state")
        kinds = [m["type"] for m in v.server.received if m["type"] not in ("show", "pixel")]
        assert kinds == ["pause", "resume", "stop", "quit"], kinds


def test_orbit(b: Any) -> None:
    with Viewer(b, seconds=20) as v:
        v.wait(lambda s: s["progress"] and s["progress"]["samples"] > 0, "samples")
        x, y = v.on_screen(40, 20)
        v.page.mouse.move(x, y)
        v.page.keyboard.down("Alt")
        v.page.mouse.down()
        start = time.monotonic()
        for i in range(1, 31):
            v.page.mouse.move(x - 4 * i, y + i)
            time.sleep(0.03)
        v.page.mouse.up()
        v.page.keyboard.up("Alt")
        seconds = time.monotonic() - start
        time.sleep(0.4)
        sent = v.server.sent("orbit")
        assert 2 <= len(sent) <= 4 * seconds + 2, (len(sent), seconds)
        assert sent[-1]["azimuth"] == 36 and sent[-1]["elevation"] == 9 and sent[-1]["zoom"] == 1, sent[-1]
        v.wait(lambda s: s["epoch"] == len(sent), "the restarts")
        corner = v.state()["corner"]
        v.page.keyboard.press("o")
        v.page.mouse.wheel(0, -100)
        time.sleep(0.4)
        assert v.server.sent("orbit")[-1]["zoom"] > 1 and v.state()["corner"] == corner
        v.page.keyboard.press("Escape")
        v.page.locator("#orbit summary").click()
        v.page.click("#orbit .reset")
        time.sleep(0.4)
        assert v.server.sent("orbit")[-1] == {"type": "orbit", "azimuth": 0, "elevation": 0, "zoom": 1}


def test_accessible(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        unnamed = v.page.evaluate("""() => [...document.querySelectorAll('button, input, select, a')].filter(e =>
            !(e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.length)).map(e => e.outerHTML)""")
        assert not unnamed, unnamed
        v.page.keyboard.press("?")
        assert v.page.is_visible("#help-dialog")
        v.page.keyboard.press("Escape")
        assert not v.page.is_visible("#help-dialog")
        assert v.page.get_attribute("#status .state", "aria-live") == "polite"
        v.page.keyboard.press("]")
        assert v.state()["shown"][0] == "error"
        v.page.keyboard.press("[")
        assert v.state()["shown"][0] == "mean"
        stops = set()
        for _ in range(40):
            v.page.keyboard.press("Tab")
            stops.add(v.page.evaluate("document.activeElement.id || document.activeElement.className"))
        assert {"save-png", "stage", "layer-a", "exposure", "tone", "target-error", "zoom-in"} <= stops, stops
