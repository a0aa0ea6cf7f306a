"""Speaks the viewer's protocol (docs/view-protocol.md) with a synthetic render.

Usage: fake_server.py [--port 8000] [--seconds 20] [--size 640x360]
"""

from __future__ import annotations

import argparse
import asyncio
import io
import json
import logging
import math
import struct
import threading
import time
from pathlib import Path
from typing import Any, Dict, List, Optional, Set

import numpy as np
from aiohttp import WSMsgType, web

from fake_picture import FakePicture, replay_lines

PAGE = Path(__file__).resolve().parents[3] / "montelux" / "view" / "page"
TOKEN = "0123456789abcdef0123456789abcdef"
POLICY = "default-src 'self'; connect-src 'self'; img-src 'self' blob: data:"
TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
TILE = 64
# Clients that go away are part of the tests.
logging.getLogger("aiohttp").setLevel(logging.CRITICAL)


def tiles_message(index: int, epoch: int, values: np.ndarray) -> bytes:
    """A whole layer as tiles."""
    height, width, channels = values.shape
    parts = [struct.pack("<BBBBI", 1, index, channels, values.itemsize, epoch)]
    for y in range(0, height, TILE):
        for x in range(0, width, TILE):
            tile = values[y:y + TILE, x:x + TILE]
            parts.append(struct.pack("<HHHH", x, y, tile.shape[1], tile.shape[0]) + tile.tobytes())
    return b"".join(parts)


def as_json(v: float) -> Any:
    v = float(v)
    return v if math.isfinite(v) else "nan" if math.isnan(v) else "inf" if v > 0 else "-inf"


class FakeServer:
    """Runs in a thread of its own. `received` and `requests` record what the page sent."""

    def __init__(self, picture: FakePicture, port: int = 0, seconds: float = 2.0, **scene: Any) -> None:
        self.picture, self.port, self.seconds_of_render = picture, port, seconds
        self.scene_values: Dict[str, Any] = {"stays": True, "exposure": 0.0, "tone": "srgb", "name": "studio.pbrt",
                                             "x0": 0, "y0": 0, **scene}
        self.epoch, self.state, self.ended_by = 0, "rendering", None
        self.clock, self.curve = 0.0, []  # type: float, List[List[float]]
        self.target: Dict[str, Optional[float]] = {"error": None, "time": None}
        self.received: List[Dict[str, Any]] = []
        self.requests: List[str] = []
        self.clients: Dict[web.WebSocketResponse, Set[str]] = {}
        self.azimuth = 0.0
        self.loop = asyncio.new_event_loop()
        self.start()

    # Control from a test.

    def start(self) -> None:
        ready = threading.Event()
        self.thread = threading.Thread(target=self._run, args=(ready,), daemon=True)
        self.thread.start()
        ready.wait(10)

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/?token={TOKEN}"

    def call(self, coroutine: Any) -> Any:
        return asyncio.run_coroutine_threadsafe(coroutine, self.loop).result(10)

    def send_all(self, message: Any) -> None:
        """A dict as JSON, bytes as they are."""
        self.call(self._send_all(message))

    def stop(self, goodbye: Optional[str] = None) -> None:
        if goodbye is not None:
            self.send_all({"type": "goodbye", "why": goodbye})
        self.call(self._close())
        self.loop.call_soon_threadsafe(self.loop.stop)
        self.thread.join(10)
        self.loop = asyncio.new_event_loop()

    def sent(self, kind: str) -> List[Dict[str, Any]]:
        return [m for m in self.received if m["type"] == kind]

    # The server's thread.

    def _run(self, ready: threading.Event) -> None:
        asyncio.set_event_loop(self.loop)
        app = web.Application()
        app.router.add_get("/", self._page)
        app.router.add_get("/page/{name}", self._file)
        app.router.add_get("/live", self._live)
        app.router.add_get("/picture.{kind}", self._picture)
        self.runner = web.AppRunner(app, shutdown_timeout=0.2)

        async def begin() -> None:
            await self.runner.setup()
            site = web.TCPSite(self.runner, "127.0.0.1", self.port)
            await site.start()
            self.port = self.runner.addresses[0][1]
            self.ticker = asyncio.ensure_future(self._tick())
            ready.set()

        self.loop.run_until_complete(begin())
        self.loop.run_forever()
        self.loop.close()

    async def _close(self) -> None:
        self.ticker.cancel()
        for client in list(self.clients):
            await client.close()
        await self.runner.cleanup()

    async def _page(self, request: web.Request) -> web.Response:
        self.requests.append(request.path_qs)
        if request.query.get("token") != TOKEN:
            return web.Response(status=403)
        return self._answer(PAGE / "index.html")

    async def _file(self, request: web.Request) -> web.Response:
        self.requests.append(request.path_qs)
        path = PAGE / request.match_info["name"]
        return self._answer(path) if path.is_file() else web.Response(status=404)

    def _answer(self, path: Path) -> web.Response:
        return web.Response(body=path.read_bytes(), content_type=TYPES[path.suffix], charset="utf-8",
                            headers={"Content-Security-Policy": POLICY, "X-Content-Type-Options": "nosniff"})

    async def _picture(self, request: web.Request) -> web.Response:
        self.requests.append(request.path_qs)
        return web.Response(body=io.BytesIO(b"picture").read(), content_type="application/octet-stream")

    def _scene(self) -> Dict[str, Any]:
        p = self.picture
        return {"type": "scene", "epoch": self.epoch, "width": p.width, "height": p.height, "layers": p.names(),
                "lights": p.lights() if p.has_light_groups else [], "reference": p.has_reference, "can_orbit": True,
                "can_group_lights": True, "spp": p.spp, **self.scene_values}

    def _progress(self) -> Dict[str, Any]:
        p = self.picture
        share, error = p.samples / p.spp, p.error()
        return {"type": "progress", "epoch": self.epoch, "state": self.state, "seconds": self.clock,
                "samples": p.samples, "share": share,
                "seconds_left": self.clock * (1 / share - 1) if share > 0 else None, "error": error,
                "visible": min(1.0, 4 * p.spread()) if error else None, "target_error": self.target["error"],
                "target_quantile": None, "target_time": self.target["time"], "ended_by": self.ended_by,
                "samples_per_second": p.width * p.height * p.samples / self.clock if self.clock else None,
                "curve": self.curve, "histogram": p.histogram()}

    def _tiles(self, name: str) -> bytes:
        names = [layer["name"] for layer in self.picture.names()]
        return tiles_message(names.index(name), self.epoch, self.picture.layer(name))

    async def _send_all(self, message: Any) -> None:
        for client in list(self.clients):
            if isinstance(message, (bytes, bytearray)):
                await client.send_bytes(bytes(message))
            else:
                await client.send_str(message if isinstance(message, str) else json.dumps(message))

    async def _tick(self) -> None:
        interval = 0.1
        while True:
            await asyncio.sleep(interval)
            if self.state != "rendering":
                continue
            p = self.picture
            self.clock += interval
            p.advance(p.spp * interval / self.seconds_of_render)
            if p.error():
                self.curve.append([self.clock, p.error()])
            limits = {"samples": p.samples >= p.spp,
                      "error": bool(self.target["error"] and p.error() and p.error() <= self.target["error"]),
                      "time": bool(self.target["time"] and self.clock >= self.target["time"])}
            met = [name for name, is_met in limits.items() if is_met]
            if met:
                self.state, self.ended_by = "ended", met[0]
            await self._publish()

    async def _publish(self) -> None:
        for client, shown in list(self.clients.items()):
            try:
                await client.send_json(self._progress())
                for name in shown:
                    await client.send_bytes(self._tiles(name))
            except ConnectionError:
                self.clients.pop(client, None)

    async def _restart(self) -> None:
        self.epoch += 1
        self.clock, self.curve, self.state, self.ended_by = 0.0, [], "rendering", None
        self.picture.restart()
        await self._send_all(self._scene())

    async def _live(self, request: web.Request) -> web.WebSocketResponse:
        self.requests.append(request.path_qs)
        if request.query.get("token") != TOKEN:
            raise web.HTTPForbidden
        client = web.WebSocketResponse(max_msg_size=4096, compress=False)
        await client.prepare(request)
        self.clients[client] = set()
        await client.send_json(self._scene())
        await client.send_json(self._progress())
        async for message in client:
            if message.type != WSMsgType.TEXT:
                break
            await self._receive(client, json.loads(message.data))
        self.clients.pop(client, None)
        return client

    async def _receive(self, client: web.WebSocketResponse, m: Dict[str, Any]) -> None:
        self.received.append(m)
        p, kind = self.picture, m["type"]
        if kind == "show":
            known = {layer["name"] for layer in p.names()}
            new = [name for name in m["layers"] if name in known]
            for name in new:
                await client.send_bytes(self._tiles(name))
            self.clients[client] = set(new)
        elif kind == "pixel":
            x, y = m["x"], m["y"]
            mean = p.layer("mean")[y, x]
            layers = {name["name"]: [as_json(v) for v in p.layer(name["name"])[y, x]] for name in p.names()
                      if name["name"] in ("depth", "normal", "relative error")}
            await client.send_json({"type": "pixel", "x": x, "y": y, "mean": [as_json(v) for v in mean],
                                    "error": [as_json(v * p.spread()) for v in mean], "samples": p.samples,
                                    "layers": layers})
        elif kind == "replay":
            await client.send_json({"type": "replay", "x": m["x"], "y": m["y"], "sample": m["sample"],
                                    "lines": replay_lines(m["x"], m["y"], m["sample"])})
        elif kind in ("pause", "resume"):
            if self.state in ("rendering", "paused"):
                self.state = "paused" if kind == "pause" else "rendering"
                await self._publish()
        elif kind == "stop":
            self.state, self.ended_by = "ended", "cancelled"
            await self._publish()
        elif kind == "target":
            if m["error"] is not None and m["error"] > 1:
                await client.send_json({"type": "refused", "request": "target", "why": "the error is larger than 1"})
                return
            self.target = {"error": m["error"], "time": m["time"]}
            await self._publish()
        elif kind == "orbit":
            self.picture.turn(m["azimuth"])
            await self._restart()
        elif kind == "light groups":
            p.has_light_groups = m["on"]
            await self._restart()
        elif kind == "quit":
            await self._send_all({"type": "goodbye", "why": "quit by the page"})


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, default=8000)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--size", default="640x360")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    server = FakeServer(FakePicture(width, height), options.port, options.seconds)
    print(server.url, flush=True)
    try:
        while True:
            time.sleep(1)
    except KeyboardInterrupt:
        server.stop()


if __name__ == "__main__":
    main()
