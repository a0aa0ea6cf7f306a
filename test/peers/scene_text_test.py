import tempfile
import unittest
import xml.etree.ElementTree as ET
from pathlib import Path

from scene_text import prepared_scene, with_moments, write

MAIN = """<scene version="3.0.0">
  <path value="../data"/>
  <default name="w" value="400"/>
  <sampler type="stratified" id="mine"/>
  <integrator type="aov"><string name="aovs" value="d:depth"/>
    <integrator type="path"><integer name="max_depth" value="3"/></integrator></integrator>
  <include filename="parts/camera.xml"/>
  <shape type="sphere"/>
</scene>"""
CAMERA = """<scene version="2.1.0"><sensor type="perspective"><sampler type="ldsampler"/><ref id="mine"/>
  <film type="hdrfilm"><integer name="width" value="$w"/><integer name="height" value="200"/>
    <integer name="crop_width" value="7"/><rfilter type="gaussian"/></film></sensor></scene>"""


class SceneText(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        root = Path(self.folder.name)
        for name in ("scene/parts", "data"):
            (root / name).mkdir(parents=True)
        (root / "scene" / "main.xml").write_text(MAIN)
        (root / "scene" / "parts" / "camera.xml").write_text(CAMERA)
        self.root, self.scene = root, prepared_scene(root / "scene" / "main.xml", 64)

    def tearDown(self):
        self.folder.cleanup()

    def test_includes_are_in_their_places(self):
        self.assertEqual(
            [e.tag for e in self.scene], ["path", "path", "default", "sampler", "integrator", "sensor", "shape"]
        )
        folders = [e.get("value") for e in self.scene.findall("path")]
        self.assertEqual(folders, [str(self.root.resolve() / f) for f in ("scene", "data")])

    def test_films_are_small_with_a_box_filter(self):
        film = self.scene.find("sensor/film")
        numbers = {e.get("name"): e.get("value") for e in film.findall("integer")}
        self.assertEqual(numbers, {"width": "64", "height": "32"})
        self.assertEqual([e.get("type") for e in film.findall("rfilter")], ["box"])
        self.assertEqual([e.get("type") for e in self.scene.findall("sensor/sampler")], ["independent"])
        self.assertEqual(self.scene.findall("sensor/ref"), [])

    def test_moments_are_around_the_inner_integrator(self):
        moments = with_moments(self.scene)
        outer = moments.findall("integrator")
        self.assertEqual([e.get("type") for e in outer], ["moment"])
        self.assertEqual([e.get("type") for e in outer[0]], ["path"])
        self.assertEqual(outer[0][0].find("integer").get("value"), "3")
        self.assertEqual(self.scene.find("integrator").get("type"), "aov")

    def test_written_file_is_xml(self):
        write(self.scene, self.root / "out.xml")
        self.assertEqual(ET.parse(self.root / "out.xml").getroot().tag, "scene")


if __name__ == "__main__":
    unittest.main()
