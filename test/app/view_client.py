"""A client of the viewer without dependencies, and attacks on it; used by view_test.py and bench/view_cost.py.

Usage: view_client.py URL [CONNECTIONS]   attacks
"""

import base64
import json
import os
import socket
import struct
import sys
import time
import urllib.parse
import urllib.request


class Viewer:
    """A WebSocket connection to the viewer."""

    def __init__(self, url):
        self.url = url
        parts = urllib.parse.urlsplit(url)
        self.host, self.port = parts.hostname, parts.port
        self.token = urllib.parse.parse_qs(parts.query)["token"][0]
        self.socket = socket.create_connection((self.host, self.port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /live?token={self.token} HTTP/1.1\r\nHost: {self.host}:{self.port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.buffer = b""
        head = self.until(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 101"), head

    def until(self, mark):
        while mark not in self.buffer:
            self.fill()
        head, self.buffer = self.buffer.split(mark, 1)
        return head

    def fill(self):
        chunk = self.socket.recv(1 << 20)
        if not chunk:
            raise EOFError("the viewer closed the connection")
        self.buffer += chunk

    def take(self, count):
        while len(self.buffer) < count:
            self.fill()
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def frame(self, opcode, payload):
        mask = os.urandom(4)
        length = len(payload)
        head = bytes([0x80 | opcode, 0x80 | length]) if length < 126 else bytes([0x80 | opcode, 0xFE]) + struct.pack(
            ">H", length)
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def ask(self, **message):
        self.frame(1, json.dumps(message).encode())

    def message(self):
        """The next message: an object, or bytes."""
        whole = b""
        while True:
            first, second = self.take(2)
            length = second & 127
            if length == 126:
                (length,) = struct.unpack(">H", self.take(2))
            elif length == 127:
                (length,) = struct.unpack(">Q", self.take(8))
            payload = self.take(length)
            opcode = first & 15
            if opcode == 9:
                self.frame(10, payload)
                continue
            if opcode == 8:
                raise EOFError("the viewer said goodbye")
            if opcode in (1, 2):
                kind = opcode
            whole += payload
            if first & 0x80:
                return json.loads(whole) if kind == 1 else whole

    def next(self, kind, test=lambda message: True):
        """The next message of this type that meets the condition."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            message = self.message()
            if isinstance(message, dict) and message["type"] == kind and test(message):
                return message
        raise TimeoutError(kind)

    def get(self, path):
        with urllib.request.urlopen(f"http://{self.host}:{self.port}{path}?token={self.token}", timeout=60) as answer:
            return answer.read()


class Picture:
    """Layers assembled from the tiles of the protocol."""

    def __init__(self, scene):
        self.scene = scene
        self.layers = [{} for _ in scene["layers"]]

    def add(self, message):
        layer, channels, size = message[1], message[2], message[3]
        (epoch,) = struct.unpack_from("<I", message, 4)
        if epoch != self.scene["epoch"]:
            return
        at = 8
        while at < len(message):
            x0, y0, width, height = struct.unpack_from("<4H", message, at)
            at += 8
            values = struct.unpack_from("<%d%s" % (width * height * channels, "e" if size == 2 else "f"), message, at)
            at += len(values) * size
            for i in range(width * height):
                self.layers[layer][x0 + i % width, y0 + i // width] = values[i * channels:(i + 1) * channels]
        assert at == len(message)


def patient_viewer(url):
    """A Viewer, opened again while the program closes new connections because attacks take all of them."""
    for _ in range(20):
        try:
            return Viewer(url)
        except (EOFError, ConnectionError):
            time.sleep(0.1)
    return Viewer(url)


def hostile(viewer, count=10000):
    """Attacks with `count` connections; then `viewer` must still be answered."""
    address = (viewer.host, viewer.port)
    host = f"Host: {viewer.host}:{viewer.port}\r\n"
    silent, opened = [], 0
    end = time.monotonic() + 6e-4 * count
    while time.monotonic() < end or opened < count:
        s = socket.socket()
        s.setblocking(False)  # the program does not accept all of them
        s.connect_ex(address)
        opened += 1
        try:
            kind = opened % 5
            if kind == 0:
                s.sendall(b"GET / HTTP/1.1\r\nHost: x")  # half a request
            elif kind == 1:
                s.sendall(f"POST / HTTP/1.1\r\n{host}Content-Length: 100000000\r\n\r\n".encode() + b"x" * 100000)
            elif kind == 2:
                s.sendall(f"GET /page/main.js HTTP/1.1\r\n{host}\r\n".encode())  # the answer is not read
            elif kind == 3:
                s.sendall(os.urandom(500))
        except OSError:
            pass
        silent.append(s)
        if len(silent) > 400:
            silent.pop(0).close()
    viewer.ask(type="pixel", x=0, y=0)
    viewer.next("pixel")
    for s in silent:  # they would keep the next ones waiting
        s.close()
    slow = [patient_viewer(viewer.url) for _ in range(4)]
    for s in slow:  # answers are not read
        s.ask(type="show", layers=["mean", "error", "samples", "relative error"])
        for _ in range(200):
            s.ask(type="pixel", x=0, y=0)
    time.sleep(1)
    viewer.ask(type="pixel", x=1, y=1)
    viewer.next("pixel")


if __name__ == "__main__":
    hostile(Viewer(sys.argv[1]), *map(int, sys.argv[2:]))
