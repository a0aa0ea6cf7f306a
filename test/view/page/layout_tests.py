"""Layout on a phone and a desktop, light and dark; screenshots where a folder is given."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

from fake_picture import FakePicture
from page_harness import Viewer


# Set by page_test.py.
screenshots: Optional[str] = None


def test_layout(b: Any) -> None:
    for width, height, mobile in ((390, 844, True), (1920, 1080, False)):
        for scheme in ("light", "dark"):
            context = {"viewport": {"width": width, "height": height}, "color_scheme": scheme, "is_mobile": mobile,
                       "has_touch": mobile, "device_scale_factor": 2 if mobile else 1}
            with Viewer(b, FakePicture(320, 180), seconds=8, context=context) as v:
                v.server.target["error"] = 0.008
                v.wait(lambda s: s["progress"] and s["progress"]["share"] > 0.3, "progress")
                v.page.mouse.move(*v.on_screen(120, 60))
                v.settle()
                assert v.page.evaluate("document.documentElement.scrollWidth") <= width, "the page scrolls sideways"
                shot(v, f"rendering-{width}-{scheme}")
                v.server.seconds_of_render = 1
                v.page.locator("#lights summary").click()
                v.page.click("#lights .start")
                v.wait(lambda s: s["epoch"] == 1, "lights")
                v.wait_for_end()
                v.page.locator("#orbit summary").click()
                v.page.locator("#replay summary").first.click()
                v.page.click("#compare")
                v.select("relative error")
                (v.page.touchscreen.tap if mobile else v.page.mouse.click)(*v.on_screen(100, 50))
                v.page.wait_for_selector(".tree details")
                v.page.locator(".tree summary", has_text="vertex 1").click()
                v.settle()
                assert v.page.evaluate("document.documentElement.scrollWidth") <= width, "the page scrolls sideways"
                shot(v, f"ended-{width}-{scheme}", mobile)


def shot(v: Viewer, name: str, full: bool = False) -> None:
    if screenshots:
        v.page.screenshot(path=str(Path(screenshots) / f"{name}.png"), full_page=full)
