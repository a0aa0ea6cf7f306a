"""montelux view and render --view: pages show and control the render without changing it; attacks have no effect."""

import contextlib
import re
import signal
import socket
import struct
import threading
import time
from pathlib import Path

from program import ProgramTest, scene, write
from view_client import Picture, Viewer, hostile

WORLD = """LightSource "infinite" "rgb L" [0.2 0.3 0.4] LightSource "point" "rgb I" [9 9 9] "point3 from" [0 0.9 1.2]
Material "diffuse" Shape "sphere" "float radius" 0.7"""
LAYERS = "mean error skewness albedo normal depth samples replicates outlier warning".split()


class Tev:
    """A stand-in for tev that records operations, size with channels, and values of pixels in a thread."""

    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.operations, self.pixels, self.size, self.rest = [], {}, None, b""
        self.thread = threading.Thread(target=self.listen, daemon=True)
        self.thread.start()

    def listen(self):
        connection, _ = self.listener.accept()
        with connection:
            while chunk := connection.recv(1 << 20):
                self.rest += chunk
                while len(self.rest) >= 4 and len(self.rest) >= (length := struct.unpack_from("<I", self.rest)[0]):
                    packet, self.rest = self.rest[4:length], self.rest[length:]
                    self.take(packet)

    def take(self, packet):
        def texts(at, n):
            parts = packet[at:].split(b"\0", n)[:n]
            return [part.decode() for part in parts], at + sum(len(part) + 1 for part in parts)

        self.operations.append(packet[0])
        if packet[0] == 4:
            _, at = texts(2, 1)
            width, height, count = struct.unpack_from("<3i", packet, at)
            self.size = width, height, texts(at + 12, count)[0]
        if packet[0] == 6:
            _, at = texts(2, 1)
            (count,) = struct.unpack_from("<i", packet, at)
            names, at = texts(at + 4, count)
            x, y, width, height = struct.unpack_from("<4i", packet, at)
            places = struct.unpack_from("<%dq" % (2 * count), packet, at + 16)
            at += 16 + 16 * count
            values = struct.unpack_from("<%df" % ((len(packet) - at) // 4), packet, at)
            for c, name in enumerate(names):
                for i in range(width * height):
                    self.pixels[name, x + i % width, y + i // width] = values[places[c] + i * places[count + c]]


class View(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("lit", WORLD, 70, 50, 96)
        scene("long", WORLD, 200, 150, 100000)
        cls.quietly("render lit.pbrt -o plain.exr")

    def serve(self, line):
        """Starts the program; returns it and its first page."""
        job = self.start(line)
        address = re.compile(r"(?m)^The render is shown at (.*)$")
        url = self.until(lambda: address.search(job.output()), "an address", job=job)[1]
        self.assertRegex(url, r"^http://127\.0\.0\.1:\d+/\?token=.{32}$")
        return job, Viewer(url)

    def ends(self, job, code=0, number=None):
        """Waits for the end of the program, after a signal if one is given; returns its output."""
        if number is not None:
            job.signal(number)
        outcome = job.ended()
        self.assertEqual(outcome.code, code, outcome)
        return outcome.text

    def assert_same_layers(self, a, b):
        for layer in LAYERS:
            for picture in a, b:
                self.expect(0, "", f"convert {picture} {picture}.pfm --layer {layer}")
            self.assert_same(f"{a}.pfm", f"{b}.pfm", f"layer '{layer}'")

    def assert_tiles_and_errors(self, viewer):
        """Follows a render to its end and checks that all tiles arrive and errors fall."""
        scene = viewer.next("scene")
        viewer.ask(type="show", layers=["mean", "error", "samples"])
        picture, errors, state = Picture(scene), [], None
        while state != "ended":
            message = viewer.message()
            if isinstance(message, bytes):
                picture.add(message)
            elif message["type"] == "progress":
                state = message["state"]
                if message["error"] is not None:
                    errors.append(message["error"])
        self.assertTrue(errors == sorted(errors, reverse=True) or errors[-1] < errors[0], errors)
        pixels, pixel = scene["width"] * scene["height"], None

        def missing():
            """The reason why tiles of the last samples are missing."""
            if [len(picture.layers[i]) for i in (0, 1, 3)] != [pixels] * 3 or pixel is None:
                return "tiles or an exact pixel"
            if any(value != (scene["spp"],) for value in picture.layers[3].values()):
                return "the last samples"
            shown, exact = picture.layers[0][1, 1], pixel["mean"]
            if any(abs(a - b) > 1e-3 * abs(b) + 1e-6 for a, b in zip(shown, exact, strict=True)):
                return f"the mean {exact} instead of {shown}"
            return None

        viewer.ask(type="pixel", x=1, y=1)
        deadline = time.monotonic() + 20
        while missing():
            self.assertLess(time.monotonic(), deadline, missing())
            message = viewer.message()
            if isinstance(message, bytes):
                picture.add(message)
            elif message["type"] == "pixel":
                pixel = message

    def ended(self, viewer):
        return viewer.next("progress", lambda p: p["state"] == "ended")

    def test_watched_picture_has_the_bits_of_an_unwatched_one(self):
        """The picture is saved by the page and, after Ctrl-C, by the program."""
        job, viewer = self.serve("view lit.pbrt -o watched.exr")
        self.assert_tiles_and_errors(viewer)
        write("page.exr", viewer.get("/picture.exr"))
        self.ends(job, number=signal.SIGINT)
        for file in "watched.exr", "page.exr":
            self.assert_same_layers(file, "plain.exr")

    def test_controls(self):
        job, viewer = self.serve("render lit.pbrt --spp 30000 --view -o controls.exr")
        viewer.next("scene")
        viewer.next("progress", lambda p: p["state"] == "rendering")
        viewer.ask(type="pause")
        paused = viewer.next("progress", lambda p: p["state"] == "paused")
        time.sleep(1)
        viewer.ask(type="resume")
        resumed = viewer.next("progress", lambda p: p["state"] == "rendering")
        self.assertLess(resumed["seconds"] - paused["seconds"], 0.8)
        viewer.ask(type="replay", x=3, y=2, sample=1)
        lines = viewer.next("replay")["lines"]
        self.assertTrue(any(line["text"].startswith("vertex 1") for line in lines), lines)
        viewer.ask(type="target", error=0.5, time=None)
        last = self.ended(viewer)
        self.assertEqual(last["ended_by"], "error")
        self.assertLessEqual(last["error"], 0.5)
        self.assertIn("target reached", self.ends(job))

    def test_orbit_begins_a_new_picture(self):
        job, viewer = self.serve("view lit.pbrt")
        first = viewer.next("scene")
        self.assertTrue(first["can_orbit"])
        viewer.ask(type="orbit", azimuth=40, elevation=10, zoom=1)
        self.assertEqual(viewer.next("scene")["epoch"], first["epoch"] + 1)
        viewer.ask(type="show", layers=["mean"])
        self.ended(viewer)
        self.ends(job, number=signal.SIGTERM)

    def test_pictures_of_lights_add_up(self):
        job, viewer = self.serve("view lit.pbrt")
        first = viewer.next("scene")
        self.assertEqual(first["lights"], [])
        self.assertTrue(first["can_group_lights"])
        viewer.ask(type="light groups", on=True)
        second = viewer.next("scene", lambda s: s["epoch"] > first["epoch"])
        self.assertEqual(len(second["lights"]), 2, second["lights"])
        names = ["light " + name for name in second["lights"]]
        viewer.ask(type="show", layers=["mean", *names])
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
        while state != "ended" or disagreement():  # the last tiles may follow the end
            self.assertLess(time.monotonic(), deadline, disagreement())
            message = viewer.message()
            if isinstance(message, bytes):
                picture.add(message)
            elif message["type"] == "progress":
                state = message["state"]
        self.ends(job, number=signal.SIGTERM)

    def memory(self, job):
        """Resident memory in kB."""
        return int(re.search(r"VmRSS:\s*(\d+)", Path(f"/proc/{job.pid}/status").read_text())[1])

    def test_attacks_take_no_memory_and_a_page_is_answered(self):
        job, viewer = self.serve("render long.pbrt --threads 1 --view -o attacked.exr")
        viewer.next("progress", lambda p: p["state"] == "rendering" and p["seconds"] > 0.5)
        before = self.memory(job)
        hostile(viewer, 2500)
        self.assertLess(self.memory(job) - before, 15000, "attacks took memory")
        self.ends(job, 130, signal.SIGINT)

    def test_attacks_do_not_delay_the_end(self):
        job, viewer = self.serve("render long.pbrt --threads 1 --time 3 --view -o late.exr")

        begin, lasted = time.monotonic(), []

        def attack():
            with contextlib.suppress(OSError, EOFError):  # connections end with the program
                while job.runs():
                    hostile(viewer, 1000)
            lasted.append(time.monotonic() - begin)

        attacks = threading.Thread(target=attack, daemon=True)
        attacks.start()
        self.assertRegex(self.ends(job), r"\b3\.\d* s")
        attacks.join(60)
        self.assertGreater(max(lasted, default=0), 1.5, "the attacks failed or ended early")

    def test_attacks_change_no_bit(self):
        self.quietly("render lit.pbrt --spp 1000 -o unseen.exr")
        job, viewer = self.serve("view lit.pbrt --spp 1000 --threads 1 -o attacked.exr")
        hostile(viewer, 500)
        self.assert_tiles_and_errors(Viewer(viewer.url))
        self.ends(job, number=signal.SIGINT)
        self.assert_same_layers("attacked.exr", "unseen.exr")

    def test_tev_gets_all_pixels(self):
        tev = Tev()
        self.quietly(f"render lit.pbrt --tev 127.0.0.1:{tev.port} -o tev.exr")
        tev.thread.join(60)
        self.assertEqual(tev.operations[:2], [2, 4], "closed and created first")
        self.assertEqual(tev.size, (70, 50, ["R", "G", "B", "error.Y"]))
        self.assertEqual(len(tev.pixels), 4 * 70 * 50)
        self.assertTrue(all(value == value for value in tev.pixels.values()), "values are finite")
        self.assert_same_layers("tev.exr", "plain.exr")

    def test_mistakes(self):
        self.expect_each("""
            1 nothing listens on 127.0.0.1:1 $ render lit.pbrt --tev 127.0.0.1:1 -o x.exr
            1 'nowhere' is not HOST:PORT $ render lit.pbrt --tev nowhere -o x.exr
            1 'localhost' is not an IP address $ view lit.pbrt --host localhost
            2 it is the port of the page that --view serves $ render lit.pbrt --port 8080 -o x.exr
            2 --port $ view lit.pbrt --port 65536
            2 it shows one picture, not a sequence $ render lit.pbrt --view --turntable 3 -o x.exr
            2 has 70 x 50 pixels $ view long.pbrt --reference plain.exr
            2 there is no option '--frames' $ view lit.pbrt --frames 1-3
            1 no.exr $ view lit.pbrt --reference no.exr
        """)
