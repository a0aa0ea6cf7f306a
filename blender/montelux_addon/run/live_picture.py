# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a running render, by the viewer's protocol (docs/view-protocol.md)."""

from __future__ import annotations

import json
import struct
import threading
from dataclasses import dataclass
from urllib.parse import urlsplit, urlunsplit

import numpy as np

from .websocket import WebSocket, WebSocketError


@dataclass(frozen=True)
class Progress:
    """Numbers that are not known yet are None."""

    share: float = 0
    seconds: float = 0
    seconds_left: float | None = None
    samples: float | None = None
    error: float | None = None

    def text(self) -> str:
        parts = []
        if self.samples is not None:
            parts.append(f"{self.samples:.4g} samples per pixel")
        if self.error is not None:
            parts.append(f"error {100 * self.error:.3g} %")
        parts.append(f"{self.seconds:.1f} s")
        if self.seconds_left is not None:
            parts.append(f"{self.seconds_left:.0f} s left")
        return ", ".join(parts)


class LivePicture:
    """Follows a render on a thread of its own, until close() or the end of the program.

    A connection that fails ends the following and nothing else: the render goes on, and its file has the picture.
    """

    def __init__(self, page_url: str):
        """`page_url`: the address that the program prints."""
        parts = urlsplit(page_url)
        self._url = urlunsplit((parts.scheme, parts.netloc, "/live", parts.query, ""))
        self._lock = threading.Lock()
        self._scene: dict = {}
        self._progress = Progress()
        self._mean: np.ndarray | None = None
        self._changed = False
        self._socket: WebSocket | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="montelux-live", daemon=True)
        self._thread.start()

    @property
    def progress(self) -> Progress:
        with self._lock:
            return self._progress

    def changed_mean(self) -> np.ndarray | None:
        """Linear RGB, rows from the top; None if nothing has changed since the last call."""
        with self._lock:
            if not self._changed or self._mean is None:
                return None
            self._changed = False
            return self._mean.copy()

    def close(self) -> None:
        with self._lock:
            self._closed = True
            if self._socket is not None:
                self._socket.close()
        self._thread.join()

    def _run(self) -> None:
        try:
            socket = WebSocket(self._url)
        except (OSError, WebSocketError):
            return
        with self._lock:
            if self._closed:
                socket.close()
                return
            self._socket = socket
        while (message := socket.receive()) is not None:
            if isinstance(message, str):
                self._take_text(json.loads(message), socket)
            else:
                self._take_tiles(message)
        socket.close()

    def _take_text(self, message: dict, socket: WebSocket) -> None:
        if message["type"] == "scene":
            with self._lock:
                self._scene = message
                self._mean = np.zeros((message["height"], message["width"], 3), np.float32)
            try:
                socket.send(json.dumps({"type": "show", "layers": ["mean"]}))
            except OSError:
                pass  # receive() says the same
        elif message["type"] == "progress":
            keys = ("share", "seconds", "seconds_left", "samples", "error")
            known = {key: message[key] for key in keys if isinstance(message.get(key), (int, float))}
            with self._lock:
                self._progress = Progress(**known)

    def _take_tiles(self, message: bytes) -> None:
        if len(message) < 8 or message[0] != 1:
            return
        _, layer, channels, value_size, epoch = struct.unpack_from("<BBBBI", message)
        with self._lock:
            scene, mean = self._scene, self._mean
            if mean is None or epoch != scene["epoch"] or scene["layers"][layer]["name"] != "mean" or channels != 3:
                return
            kind = np.dtype("<f2" if value_size == 2 else "<f4")
            at = 8
            while at < len(message):
                x, y, width, height = struct.unpack_from("<4H", message, at)
                count = width * height * channels
                values = np.frombuffer(message, kind, count, at + 8).reshape(height, width, channels)
                mean[y : y + height, x : x + width] = values
                at += 8 + count * value_size
            self._changed = True
