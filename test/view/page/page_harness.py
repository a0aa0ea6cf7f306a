"""A page of the viewer in headless Chromium, in front of the fake server."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import time
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

try:
    import numpy as np
    from playwright.sync_api import Browser, Page, sync_playwright

    from fake_picture import FakePicture
    from fake_server import FakeServer
except ImportError as missing:
    print(f"skipped: there is no Python package '{missing.name}'")
    sys.exit(77)

ARGUMENTS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def chromium() -> str:
    """Path of Chromium; ends the test as skipped without one."""
    path = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    if not path:
        print("skipped: there is no chromium (apt-get install chromium, or set CHROMIUM)")
        sys.exit(77)
    return path


@contextlib.contextmanager
def browser() -> Iterator[Browser]:
    path = chromium()
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield found
        found.close()


def wait_for(condition: Callable[[], Any], what: str, seconds: float = 10) -> Any:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"timed out: {what}")


class Viewer:
    """A page and its server. Fails at the end if the page wrote to the console."""

    def __init__(self, browser: Browser, picture: Optional[FakePicture] = None, seconds: float = 1.0,
                 context: Optional[Dict[str, Any]] = None, init: str = "", **scene: Any) -> None:
        self.server = FakeServer(picture or FakePicture(), 0, seconds, **scene)
        self.context = browser.new_context(**{"viewport": {"width": 1000, "height": 700}, **(context or {})})
        self.page: Page = self.context.new_page()
        self.console: List[str] = []
        self.page.on("console", lambda m: self.console.append(f"{m.type}: {m.text}"))
        self.page.on("pageerror", lambda e: self.console.append(f"exception: {e}"))
        if init:
            self.page.add_init_script(init)
        self.page.goto(self.server.url)
        # Not wait_for_function, which evaluates strings in the page, against its content security policy.
        wait_for(lambda: self.page.evaluate("Boolean(window.montelux?.connected())"), "the connection")

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, kind: Any, *_: Any) -> None:
        self.context.close()
        with contextlib.suppress(Exception):
            self.server.stop()
        if kind is None and self.console:
            raise AssertionError(f"the page wrote to the console: {self.console}")

    def state(self) -> Dict[str, Any]:
        return self.page.evaluate("montelux.state()")

    def picture(self) -> np.ndarray:
        """Displayed 8-bit codes: rows, columns, RGB."""
        data = self.page.evaluate("montelux.readPicture()")
        return np.array(data["rgba"]).reshape(data["height"], data["width"], 4)[..., :3]

    def wait(self, condition: Callable[[Dict[str, Any]], Any], what: str) -> Dict[str, Any]:
        def check() -> Optional[Dict[str, Any]]:
            state = self.state()
            return state if condition(state) else None

        return wait_for(check, what)

    def wait_for_end(self) -> None:
        self.wait(lambda s: (s["progress"] or {}).get("state") == "ended", "the end of the render")
        self.settle()

    def settle(self) -> None:
        """Messages in flight arrive, and two frames are drawn."""
        time.sleep(0.25)
        self.page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def text(self, selector: str) -> str:
        return self.page.locator(selector).inner_text()

    def select(self, layer: str, menu: str = "#layer-a") -> None:
        self.page.select_option(menu, layer)
        wait_for(lambda: self.page.evaluate("name => montelux.values(name, 0, 0) !== null", layer), f"layer {layer}")
        self.settle()

    def set_range(self, selector: str, value: float) -> None:
        self.page.locator(selector).evaluate(
            "(e, v) => { e.value = v; e.dispatchEvent(new Event('input', {bubbles: true})); }", value)

    def on_screen(self, x: int, y: int) -> Tuple[float, float]:
        """The centre of a pixel of the picture, in the page."""
        state, box = self.state(), self.page.locator("#stage").bounding_box()
        return (box["x"] + state["corner"][0] + (x + 0.5) * state["scale"],
                box["y"] + state["corner"][1] + (y + 0.5) * state["scale"])
