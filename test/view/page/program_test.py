"""Tests the viewer of the program itself with headless Chromium: montelux view on three scenes.

Usage: program_test.py MONTELUX SCENES [--screenshots FOLDER]
Needs what page_test.py needs; exit status 77 without it.
"""

from __future__ import annotations

import argparse
import base64
import contextlib
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict, Iterator, List

from page_harness import browser, wait_for  # first: skips where packages are missing

import numpy as np
from playwright.sync_api import Browser, Page

SCENES = ["demo/studio.pbrt", "surfaces/principled.pbrt", "cloud/cloud.pbrt"]


class Program:
    """montelux view, and the address of its page."""

    def __init__(self, montelux: str, *arguments: str) -> None:
        self.process = subprocess.Popen([montelux, "view", *arguments], stderr=subprocess.PIPE,
                                        stdout=subprocess.DEVNULL, text=True)
        self.began = time.monotonic()
        for line in self.process.stderr:
            if line.startswith("The render is shown at "):
                self.url = line.split()[-1]
                return
        raise AssertionError(f"montelux ended with {self.process.wait()}")

    def end(self) -> int:
        self.process.terminate()
        self.process.stderr.read()
        return self.process.wait(timeout=60)


class Watcher:
    """A page of its own browser context. `sent` are its requests: addresses, and texts over the WebSocket."""

    def __init__(self, browser: Browser, url: str, width: int = 1000, height: int = 700) -> None:
        self.context = browser.new_context(viewport={"width": width, "height": height})
        self.page: Page = self.context.new_page()
        self.console: List[str] = []
        self.sent: List[str] = []
        self.page.on("console", lambda m: self.console.append(f"{m.type}: {m.text}"))
        self.page.on("pageerror", lambda e: self.console.append(f"exception: {e}"))
        self.page.on("request", lambda r: self.sent.append(r.url))
        self.page.on("websocket", lambda s: s.on("framesent", lambda text: self.sent.append(str(text))))
        self.page.goto(url)
        wait_for(lambda: self.page.evaluate("Boolean(window.montelux?.connected())"), "the connection")

    def state(self) -> Dict[str, Any]:
        return self.page.evaluate("montelux.state()")

    def progress(self) -> Dict[str, Any]:
        return self.state()["progress"] or {}

    def wait_for(self, state: str, seconds: float = 120) -> None:
        wait_for(lambda: self.progress().get("state") == state, f"state {state}", seconds)

    def picture(self) -> np.ndarray:
        # As text: half a million numbers of JSON take Playwright ten seconds.
        width, height, text = self.page.evaluate("""() => {
            const {width, height, rgba} = montelux.readPicture(), bytes = [];
            for (let i = 0; i < rgba.length; i += 4096) bytes.push(String.fromCharCode(...rgba.slice(i, i + 4096)));
            return [width, height, btoa(bytes.join(""))];
        }""")
        return np.frombuffer(base64.b64decode(text), np.uint8).reshape(height, width, 4)[..., :3].astype(int)

    def pixel(self, x: int, y: int) -> int:
        """The largest of its displayed codes; 0 without a picture."""
        return max(self.page.evaluate("([x, y]) => montelux.readPixel(x, y) ?? [0]", [x, y]))

    def settle(self) -> None:
        time.sleep(0.5)
        self.page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def close(self) -> None:
        assert not self.console, f"the page wrote to the console: {self.console}"
        self.context.close()


@contextlib.contextmanager
def viewed(montelux: str, *arguments: str) -> Iterator[Program]:
    program = Program(montelux, *arguments)
    try:
        yield program
    except BaseException:
        program.process.kill()
        raise
    assert program.end() == 0, "exit code"


def codes_of(pfm: Path) -> np.ndarray:
    """8-bit codes of a PNG that was converted to light: rows, columns, RGB."""
    kind, size, _, data = pfm.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    light = np.frombuffer(data, "<f4").reshape(height, width, 3)[::-1].astype(float)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    return np.rint(255 * encoded).astype(int)


def bits_of(montelux: str, exr: Path, layer: str, folder: Path) -> bytes:
    out = folder / f"{exr.stem}.{layer}.pfm"
    subprocess.run([montelux, "convert", str(exr), str(out), "--layer", layer], check=True, capture_output=True)
    return out.read_bytes()


def watch(montelux: str, scene: Path, b: Browser, folder: Path, screenshots: str) -> None:
    name = scene.stem
    size = ["--resolution", "480x270", "--spp", "96"]
    with viewed(montelux, str(scene), *size) as program:
        first = Watcher(b, program.url)
        wait_for(lambda: first.progress().get("state") == "rendering", "rendering", 60)
        began = time.monotonic()
        places = [(x, y) for y in range(20, 270, 60) for x in range(20, 480, 110)]
        wait_for(lambda: any(first.pixel(x, y) > 0 for x, y in places), "the picture", 20)
        seconds = time.monotonic() - began
        print(f"  {name}: the picture appears {seconds:.2f} s after the page has heard that the render has begun")
        assert seconds < 1.5, seconds  # Chromium, without a GPU, and the render share the processor

        second = Watcher(b, program.url, 390, 844)
        wait_for(lambda: second.progress().get("curve"), "a curve in the second page", 120)
        # Exposure and tone curve are the page's own business.
        sent = len(first.sent)
        before = first.picture().astype(float).mean()
        first.page.locator("#exposure").evaluate(
            "e => { e.value = 3; e.dispatchEvent(new Event('input', {bubbles: true})); }")
        first.settle()
        assert first.picture().astype(float).mean() > before + 10, (before, first.picture().mean())
        asked = [text for text in first.sent[sent:] if '"type":"pixel"' not in text]
        assert not asked, asked
        first.page.locator("#exposure").evaluate(
            "e => { e.value = 0; e.dispatchEvent(new Event('input', {bubbles: true})); }")

        # A pixel's path, while it renders or after.
        x, y = 240, 135
        state = first.state()
        box = first.page.locator("#stage").bounding_box()
        first.page.mouse.click(box["x"] + state["corner"][0] + (x + 0.5) * state["scale"],
                               box["y"] + state["corner"][1] + (y + 0.5) * state["scale"])
        first.page.evaluate("document.getElementById('replay').open = true")
        wait_for(lambda: "vertex 1" in first.page.locator("#replay").inner_text(), "the replay", 30)

        second.close()  # in the middle of the render
        first.wait_for("ended", 300)
        curve = first.progress()["curve"]
        assert len(curve) >= 4 and curve[-1][1] < 0.7 * curve[0][1], curve
        assert curve == sorted(curve), "seconds increase"
        first.settle()

        # The page shows what the program would save.
        first.page.select_option("#tone", "agx")
        first.settle()
        png = folder / f"{name}.png"
        exr = folder / f"{name}.exr"
        token = program.url.split("=")[1]
        base = program.url.split("/?")[0]
        png.write_bytes(first.context.request.get(f"{base}/picture.png?token={token}&exposure=0&tone=agx").body())
        exr.write_bytes(first.context.request.get(f"{base}/picture.exr?token={token}").body())
        subprocess.run([montelux, "convert", str(png), str(folder / "codes.pfm")], check=True, capture_output=True)
        saved = codes_of(folder / "codes.pfm")
        difference = np.abs(saved - first.picture())
        # Half floats have 11 bits.
        assert difference.max() <= 2 and (difference > 1).mean() < 1e-3, (difference.max(), (difference > 1).mean())

        third = Watcher(b, program.url, 1920, 1080)  # after the end
        third.wait_for("ended")
        wait_for(lambda: any(third.pixel(x, y) > 0 for x, y in places), "the picture of the third page", 20)
        if screenshots:
            for watcher, suffix in ((third, "1920"), (first, "1000")):
                watcher.settle()
                watcher.page.screenshot(path=f"{screenshots}/{name}_{suffix}.png")
            narrow = Watcher(b, program.url, 390, 844)
            narrow.wait_for("ended")
            narrow.settle()
            narrow.page.screenshot(path=f"{screenshots}/{name}_390.png", full_page=True)
            narrow.close()
        third.close()
        first.close()
    plain = folder / f"{name}_plain.exr"
    subprocess.run([montelux, "render", str(scene), *size, "-o", str(plain), "--quiet"], check=True)
    for layer in ("mean", "error", "samples", "albedo", "depth"):
        assert bits_of(montelux, exr, layer, folder) == bits_of(montelux, plain, layer, folder), f"bits of {layer}"


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("montelux")
    parser.add_argument("scenes")
    parser.add_argument("--screenshots", default="")
    options = parser.parse_args()
    failed = 0
    with browser() as b, tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            begin = time.monotonic()
            try:
                watch(options.montelux, Path(options.scenes) / scene, b, Path(folder), options.screenshots)
                print(f"{scene}: passed, {time.monotonic() - begin:.1f} s", flush=True)
            except Exception as error:  # also of Playwright
                failed += 1
                print(f"{scene}: FAILED: {type(error).__name__}: {error}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
