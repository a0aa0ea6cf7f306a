# SPDX-License-Identifier: GPL-3.0-or-later
"""The client's side of a WebSocket (RFC 6455), as far as the program's viewer needs it."""

from __future__ import annotations

import base64
import os
import socket
import struct
from urllib.parse import urlsplit

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class WebSocketError(Exception):
    pass


class WebSocket:
    """Messages of one connection. Only one thread may receive; close() ends its wait."""

    def __init__(self, url: str, timeout: float = 10):
        parts = urlsplit(url)
        if parts.hostname is None or parts.port is None:
            raise WebSocketError(f"{url} names no host and port")
        self._rest = b""
        self._socket = socket.create_connection((parts.hostname, parts.port), timeout)
        try:
            self._shake_hands(f"{parts.path}?{parts.query}", parts.netloc)
            self._socket.settimeout(None)
        except Exception:
            self._socket.close()
            raise

    def _shake_hands(self, target: str, host: str) -> None:
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET {target} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        answer = b""
        while b"\r\n\r\n" not in answer:
            received = self._socket.recv(4096)
            if not received:
                raise WebSocketError("the connection ended before its handshake")
            answer += received
        head, self._rest = answer.split(b"\r\n\r\n", 1)
        status = head.split(b"\r\n", 1)[0].decode("latin-1")
        if " 101 " not in status + " ":
            raise WebSocketError(f"the server answers '{status}'")

    def _read(self, count: int) -> bytes:
        parts = [self._rest[:count]]
        self._rest = self._rest[count:]
        missing = count - len(parts[0])
        while missing > 0:
            received = self._socket.recv(min(missing, 1 << 20))
            if not received:
                raise WebSocketError("the connection ended")
            parts.append(received)
            missing -= len(received)
        return b"".join(parts)

    def _read_frame(self) -> tuple[bool, int, bytes]:
        first, second = self._read(2)
        length = second & 0x7F
        if length == 126:
            (length,) = struct.unpack(">H", self._read(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self._read(8))
        if second & 0x80:
            raise WebSocketError("a server must not mask its frames")
        return bool(first & 0x80), first & 0x0F, self._read(length)

    def receive(self) -> str | bytes | None:
        """The next message; None at the end of the connection."""
        kind, parts = 0, []
        try:
            while True:
                last, code, payload = self._read_frame()
                if code == CLOSE:
                    return None
                if code == PING:
                    self._send(PONG, payload)
                if code >= CLOSE:
                    continue
                kind = code or kind
                parts.append(payload)
                if last:
                    message = b"".join(parts)
                    return message.decode() if kind == TEXT else message
        except (OSError, WebSocketError):
            return None

    def send(self, text: str) -> None:
        self._send(TEXT, text.encode())

    def _send(self, code: int, payload: bytes) -> None:
        size = len(payload)
        head = bytes([0x80 | code])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 1 << 16:
            head += struct.pack(">BH", 0x80 | 126, size)
        else:
            head += struct.pack(">BQ", 0x80 | 127, size)
        mask = os.urandom(4)
        masked = bytes(b ^ mask[i % 4] for i, b in enumerate(payload))
        self._socket.sendall(head + mask + masked)

    def close(self) -> None:
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # the other side was faster
        self._socket.close()
