"""A client of the viewer by the standard library alone, and a stand-in for tev; used by view_test.sh.

Usage: view_client.py URL SCRIPT [FILE or COUNT]   SCRIPT: final, controls, orbit, lights, hostile
       view_client.py tev PORT FILE.npz-free text summary
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
    """One WebSocket of a viewer's page."""

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
        """The next text, as an object, or the next bytes."""
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
        """The next message of a type that passes a test."""
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
    """What the tiles of the protocol make of layers."""

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


def ended(viewer):
    return viewer.next("progress", lambda p: p["state"] == "ended")


def final(viewer, path):
    """Watches a render until it has ended; saves its picture, and checks the tiles against it."""
    scene = viewer.next("scene")
    viewer.ask(type="show", layers=["mean", "error", "samples"])
    picture = Picture(scene)
    errors, state, tiles = [], None, 0
    while state != "ended":
        message = viewer.message()
        if isinstance(message, bytes):
            picture.add(message)
            tiles += 1
        elif message["type"] == "progress":
            state = message["state"]
            if message["error"] is not None:
                errors.append(message["error"])
    pixels = scene["width"] * scene["height"]
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:  # the last tiles
        if all(len(picture.layers[i]) == pixels for i in (0, 1, 3)) and all(
                v == (scene["spp"],) for v in picture.layers[3].values()):
            break
        message = viewer.message()
        if isinstance(message, bytes):
            picture.add(message)
    assert all(len(picture.layers[i]) == pixels for i in (0, 1, 3)), [len(layer) for layer in picture.layers]
    assert errors == sorted(errors, reverse=True) or errors[-1] < errors[0], errors
    with open(path, "wb") as file:
        file.write(viewer.get("/picture.exr"))
    viewer.ask(type="pixel", x=1, y=1)
    pixel = viewer.next("pixel")
    for shown, exact in zip(picture.layers[0][1, 1], pixel["mean"]):
        assert abs(shown - exact) <= 1e-3 * abs(exact) + 1e-6, (shown, exact)
    print(f"{tiles} messages of tiles, {len(errors)} errors")


def controls(viewer, path):
    viewer.next("scene")
    viewer.next("progress", lambda p: p["state"] == "rendering")
    viewer.ask(type="pause")
    paused = viewer.next("progress", lambda p: p["state"] == "paused")
    time.sleep(1)
    viewer.ask(type="resume")
    resumed = viewer.next("progress", lambda p: p["state"] == "rendering")
    assert resumed["seconds"] - paused["seconds"] < 0.8, (paused["seconds"], resumed["seconds"])
    viewer.ask(type="replay", x=3, y=2, sample=1)
    lines = viewer.next("replay")["lines"]
    assert any(line["text"].startswith("vertex 1") for line in lines), lines
    viewer.ask(type="target", error=0.5, time=None)
    last = ended(viewer)
    assert last["ended_by"] == "error" and last["error"] <= 0.5, last
    print("ok")


def orbit(viewer, path):
    first = viewer.next("scene")
    assert first["can_orbit"]
    viewer.ask(type="orbit", azimuth=40, elevation=10, zoom=1)
    second = viewer.next("scene")
    assert second["epoch"] == first["epoch"] + 1
    viewer.ask(type="show", layers=["mean"])
    ended(viewer)
    print("ok")


def lights(viewer, path):
    first = viewer.next("scene")
    assert first["lights"] == [] and first["can_group_lights"]
    viewer.ask(type="light groups", on=True)
    second = viewer.next("scene", lambda s: s["epoch"] > first["epoch"])
    assert len(second["lights"]) == 2, second["lights"]
    names = ["light " + name for name in second["lights"]]
    viewer.ask(type="show", layers=["mean"] + names)
    picture, state = Picture(second), None
    indices = [[layer["name"] for layer in second["layers"]].index(name) for name in names]

    def disagreement():
        for place, mean in picture.layers[0].items():
            for c in range(3):
                total = sum(picture.layers[i][place][c] for i in indices if place in picture.layers[i])
                if abs(total - mean[c]) > 4e-3 * abs(mean[c]) + 1e-4:
                    return place, total, mean
        return None if len(picture.layers[0]) == second["width"] * second["height"] else "tiles are missing"

    deadline = time.monotonic() + 60
    while state != "ended" or disagreement():  # until the last tiles
        assert time.monotonic() < deadline, disagreement()
        message = viewer.message()
        if isinstance(message, bytes):
            picture.add(message)
        elif message["type"] == "progress":
            state = message["state"]
    print("ok")


def patient_viewer(url):
    """As Viewer. While attacks fill the program's connections, a new one is closed if its request comes a moment after
    it: then it is opened again, as by a person who reloads the page."""
    for _ in range(20):
        try:
            return Viewer(url)
        except (EOFError, ConnectionError):
            time.sleep(0.1)
    return Viewer(url)


def hostile(viewer, count):
    """Attacks by `count` connections, by default 10,000; then one page is served as if nothing were."""
    count = int(count or 10000)
    address = (viewer.host, viewer.port)
    host = f"Host: {viewer.host}:{viewer.port}\r\n"
    silent, opened = [], 0
    end = time.monotonic() + 6e-4 * count
    while time.monotonic() < end or opened < count:
        s = socket.socket()
        s.setblocking(False)  # the program lets them wait
        s.connect_ex(address)
        opened += 1
        try:
            kind = opened % 5
            if kind == 0:
                s.sendall(b"GET / HTTP/1.1\r\nHost: x")  # half a request
            elif kind == 1:
                s.sendall(f"POST / HTTP/1.1\r\n{host}Content-Length: 100000000\r\n\r\n".encode() + b"x" * 100000)
            elif kind == 2:
                s.sendall(f"GET /page/main.js HTTP/1.1\r\n{host}\r\n".encode())  # never read
            elif kind == 3:
                s.sendall(os.urandom(500))
        except OSError:
            pass
        silent.append(s)
        if len(silent) > 400:
            silent.pop(0).close()
    slow = [patient_viewer(viewer.url) for _ in range(8)]
    for s in slow:  # ask, and never read
        s.ask(type="show", layers=["mean", "error", "samples", "relative error"])
        for _ in range(200):
            s.ask(type="pixel", x=0, y=0)
    time.sleep(2)
    viewer.ask(type="pixel", x=1, y=1)
    viewer.next("pixel")
    print(f"{opened} connections")


def tev(port):
    """Listens as tev does; prints the operations, and how many pixels of which channels it has in the end."""
    listener = socket.create_server(("127.0.0.1", port))
    print("listening", flush=True)
    connection, _ = listener.accept()
    data = b""
    operations, pixels, size = [], {}, None
    while True:
        while len(data) < 4 or len(data) < struct.unpack_from("<I", data)[0]:
            chunk = connection.recv(1 << 20)
            if not chunk:
                values = list(pixels.values())
                finite = all(v == v for v in values)
                print(f"{operations[:2]} {size} {len(values)} finite={finite} sum={sum(values):.6g}")
                return
            data += chunk
        (length,) = struct.unpack_from("<I", data)
        packet, data = data[4:length], data[length:]
        operation = packet[0]
        if len(operations) < 2:
            operations.append(operation)
        texts = lambda at, n: (lambda parts: ([p.decode() for p in parts[:n]], at + sum(len(p) + 1 for p in parts[:n])))(
            packet[at:].split(b"\0", n))
        if operation == 4:
            _, at = texts(2, 1)
            width, height, count = struct.unpack_from("<3i", packet, at)
            names, _ = texts(at + 12, count)
            size = (width, height, ",".join(names))
        if operation == 6:
            _, at = texts(2, 1)
            (count,) = struct.unpack_from("<i", packet, at)
            names, at = texts(at + 4, count)
            x, y, width, height = struct.unpack_from("<4i", packet, at)
            places = struct.unpack_from("<%dq" % (2 * count), packet, at + 16)
            at += 16 + 16 * count
            values = struct.unpack_from("<%df" % ((len(packet) - at) // 4), packet, at)
            for c, name in enumerate(names):
                for i in range(width * height):
                    pixels[name, x + i % width, y + i // width] = values[places[c] + i * places[count + c]]


if __name__ == "__main__":
    if sys.argv[1] == "tev":
        tev(int(sys.argv[2]))
    else:
        globals()[sys.argv[2]](Viewer(sys.argv[1]), sys.argv[3] if len(sys.argv) > 3 else None)
