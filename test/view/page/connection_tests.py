"""Tests of what goes wrong: malformed messages, a program that ends, lost or missing WebGL2."""

from __future__ import annotations

import struct
import time
from pathlib import Path
from typing import Any

import numpy as np

import tone_reference
from fake_server import tiles_message
from page_harness import Viewer, wait_for
from picture_codes import assert_close, mean_codes


def test_malformed_messages(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        good, server = v.picture(), v.server
        shape = (54, 96, 3)
        whole = tiles_message(0, 0, np.full(shape, 0.5, np.float16))
        bad = [b"", b"\x01", b"\x02" + whole[1:], whole[:-1], whole[:11],
               tiles_message(99, 0, np.zeros(shape, np.float16)),
               tiles_message(1, 0, np.zeros(shape, np.float16)), tiles_message(0, 0, np.zeros(shape, np.float32)),
               struct.pack("<BBBBIHHHH", 1, 0, 3, 2, 0, 90, 0, 10, 10) + bytes(600),
               struct.pack("<BBBBIHHHH", 1, 0, 3, 2, 0, 0, 0, 0, 10), whole + b"\x00\x00", bytes(range(256)) * 4]
        for message in bad:
            server.send_all(message)
        for text in ("no json", "[]", "null", "3", '{"type": 3}', "{}"):
            server.send_all(text)
        server.send_all({"type": "weather", "rain": True})
        # Of another epoch: not malformed, but not for this picture.
        server.send_all(tiles_message(0, 7, np.full(shape, 0.5, np.float16)))
        v.settle()
        assert v.state()["ignored"] == len(bad) + 6, v.state()["ignored"]
        assert "ignored" in v.text("#note")
        assert np.array_equal(v.picture(), good), "a malformed message changed the picture"
        server.send_all(whole)
        v.settle()
        assert (v.picture() == tone_reference.codes(np.float64([0.5] * 3), 0, "srgb")).all()


def test_server_gone(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        good = v.picture()
        v.server.stop()
        v.wait(lambda s: s["connection"] == "lost", "the lost connection")
        assert "Connection lost. The picture stays" in v.text("#status .state")
        assert np.array_equal(v.picture(), good)
        assert not v.page.evaluate("montelux.connected()") and v.page.is_disabled("#stop")
        v.set_range("#exposure", 1)
        assert_close(v.picture(), mean_codes(v, 1), 1, "exposure without the server")
        with v.page.expect_download() as download:
            v.page.click("#save-png")
        assert Path(download.value.path()).read_bytes()[:4] == b"\x89PNG"
        v.server.epoch = 3
        v.server.start()
        v.wait(lambda s: s["connection"] == "open" and s["epoch"] == 3, "the reconnection")
        wait_for(lambda: v.server.clients, "the client")
        v.settle()
        assert v.server.sent("show")[-1] == {"type": "show", "layers": ["mean"]}
        assert v.state()["exposure"] == 1
        v.server.stop(goodbye="the render has ended")
        v.wait(lambda s: s["connection"] == "ended", "goodbye")
        assert "The program has ended. The picture stays." in v.text("#status .state")
        assert_close(v.picture(), mean_codes(v, 1), 1, "picture after the end")
        requests = len(v.server.requests)
        v.server.start()
        time.sleep(1.5)
        assert len(v.server.requests) == requests, "the page reconnects after goodbye"
        v.page.click("#retry")
        v.wait(lambda s: s["connection"] == "open", "the connection by the button")
        # Chromium itself reports refused connections.
        assert all("WebSocket connection" in line for line in v.console), v.console
        v.console.clear()


def test_lost_context(b: Any) -> None:
    with Viewer(b, seconds=0.3) as v:
        v.wait_for_end()
        good = v.picture()
        v.page.evaluate("""() => {
            window.lose = document.getElementById('picture').getContext('webgl2').getExtension('WEBGL_lose_context');
            lose.loseContext(); }""")
        v.settle()
        assert v.page.evaluate("montelux.readPicture()") is None
        v.page.evaluate("lose.restoreContext()")
        v.settle()
        assert np.array_equal(v.picture(), good)
        v.console[:] = [line for line in v.console if "CONTEXT_LOST" not in line]


def test_no_webgl(b: Any) -> None:
    script = """const get = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind === 'webgl2' ? null : get.call(this, kind, ...rest); };"""
    with Viewer(b, seconds=0.3, init=script) as v:
        v.wait_for_end()
        assert v.text("#message") == "This browser offers no WebGL2, which the picture needs."
        assert "64 samples per pixel" in v.text("#status")
