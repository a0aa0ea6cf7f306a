"""What the tests of the comparison with Mitsuba share: scenes written into a folder, read and converted."""

import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "bench/render"))

from mitsuba_scene import Converter
from pbrt_scene import read_scene

TRIANGLE = 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]\n'


class InFolder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def read(self, world, header=""):
        return read_scene(
            self.write("scene.pbrt", f'{header}\nCamera "perspective" "float fov" 40\nWorldBegin\n{world}')
        )

    def convert(self, world, header="", width=None):
        """What the scene becomes, and what could not be converted."""
        scene = self.read(world, header)
        return Converter(scene, self.folder, width).convert(), [n.split(": ", 1)[1] for n in scene.notices]

    def only(self, converted, kind):
        found = [value for name, value in converted.items() if name.startswith(kind + "_")]
        self.assertEqual(len(found), 1)
        return found[0]

    def material(self, text):
        converted, notices = self.convert(text + "\n" + TRIANGLE)
        return self.only(converted, "material"), notices
