"""Text of pbrt scenes, their transformations and attributes, copies of them."""

from pathlib import Path

import numpy as np
from scene_testing import TRIANGLE, InFolder

from mitsuba_scene import Converter
from montelux_scene import with_box_filter
from pbrt_scene import read_scene
from pbrt_text import SceneError, directives_of


class Text(InFolder):
    def test_directives(self):
        text = (
            '# "Shape"\nShape "sphere" "float radius" 2 # "x"\n"bool b" true "string s" ["a b"]\nTranslate 1 -2e0 .5\n'
        )
        shape, translate = directives_of(text, Path("f"))
        self.assertEqual((shape.name, shape.strings, shape.line), ("Shape", ["sphere"], 2))
        self.assertEqual([(k, p.type, p.values) for k, p in shape.parameters.items()],
                         [("radius", "float", [2]), ("b", "bool", [True]), ("s", "string", ["a b"])])  # fmt: skip
        self.assertEqual((translate.numbers, translate.line), ([1, -2, 0.5], 4))
        self.assertEqual(text[translate.span[0] : translate.span[1]], "Translate 1 -2e0 .5")

    def test_mistakes_name_the_line(self):
        for text, message in (
            ("\nSphere 1", "f:2: unknown directive Sphere"),
            ('Shape "sphere" "float radius" [', "ends within"),
            ("Translate 1 2 x", "f:1: expected a number, found x"),
            ('Shape "sphere" "radius" 2', 'f:1: expected "type name"'),
            ('Shape "sphere" "float radius" [two]', "f:1: parameter radius"),
            ("Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5]", "more than 16"),
        ):
            with self.assertRaises(SceneError) as caught:
                list(directives_of(text, Path("f")))
            self.assertIn(message, str(caught.exception))

    def test_included_files(self):
        (self.folder / "parts").mkdir()
        self.write("parts/a.pbrt", 'Include "parts/b.pbrt"')
        self.write("parts/b.pbrt", TRIANGLE)
        self.assertEqual(len(self.read('Include "parts/a.pbrt"').shapes), 1)
        self.write("parts/a.pbrt", 'Include "parts/a.pbrt"')
        with self.assertRaises(SceneError):
            self.read('Include "parts/a.pbrt"')


class Transformations(InFolder):
    def place(self, world):
        return self.read(world + '\nShape "sphere"').shapes[0].plugin.to_world

    def test_order_and_columns(self):
        np.testing.assert_allclose(self.place("Translate 1 2 3 Scale 2 2 2") @ [1, 1, 1, 1], [3, 4, 5, 1])
        np.testing.assert_allclose(self.place("Rotate 90 0 0 1") @ [1, 0, 0, 1], [0, 1, 0, 1], atol=1e-12)
        np.testing.assert_allclose(self.place("Rotate 120 1 1 1") @ [1, 0, 0, 1], [0, 1, 0, 1], atol=1e-12)
        moved = "Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1]"
        np.testing.assert_allclose(self.place("Scale 9 9 9 " + moved) @ [0, 0, 0, 1], [5, 6, 7, 1])
        np.testing.assert_allclose(self.place("Scale 2 2 2 Concat" + moved) @ [0, 0, 0, 1], [10, 12, 14, 1])

    def test_attributes_end_with_their_block(self):
        scene = self.read(
            'AttributeBegin Translate 1 0 0 ReverseOrientation Material "dielectric" AttributeEnd Shape "sphere"'
        )
        shape = scene.shapes[0]
        np.testing.assert_array_equal(shape.plugin.to_world, np.eye(4))
        self.assertEqual((shape.reverse, shape.material.type), (False, "diffuse"))
        with self.assertRaises(SceneError):
            self.read("AttributeEnd")

    def test_attribute_directives(self):
        scene = self.read('Attribute "shape" "float radius" 2 Shape "sphere" Shape "sphere" "float radius" 3')
        self.assertEqual([s.plugin.parameters.number("radius", 1) for s in scene.shapes], [2, 3])

    def test_camera(self):
        """At (0, 0, 5), looking at the origin with y up, +x of the world is to the left in pbrt."""
        header = 'LookAt 0 0 5  0 0 0  0 1 0\nFilm "rgb" "integer xresolution" 400 "integer yresolution" 225\n'
        converted, notices = self.convert(TRIANGLE, header, 200)
        sensor = converted["sensor"]
        np.testing.assert_allclose(sensor["to_world"][:3, 2:], [[0, 0], [0, 0], [-1, 5]], atol=1e-12)
        np.testing.assert_allclose(sensor["to_world"][:3, :2], [[1, 0], [0, 1], [0, 0]], atol=1e-12)
        self.assertEqual((sensor["fov"], sensor["fov_axis"], sensor["film"]["rfilter"]["type"]), (40, "smaller", "box"))
        self.assertEqual((sensor["film"]["width"], sensor["film"]["height"], notices), (200, 112, []))

    def test_lens(self):
        scene = read_scene(
            self.write("s.pbrt", 'Camera "perspective" "float lensradius" 0.1 "float focaldistance" 3 WorldBegin')
        )
        sensor = Converter(scene, self.folder).convert()["sensor"]
        self.assertEqual((sensor["type"], sensor["aperture_radius"], sensor["focus_distance"]), ("thinlens", 0.1, 3))

    def test_depth_and_roulette(self):
        converted, _ = self.convert("", 'Integrator "path" "integer maxdepth" 7')
        self.assertEqual(converted["integrator"], {"type": "path", "max_depth": 8, "rr_depth": 2})


class Copies(InFolder):
    def test_filter_and_media(self):
        text = ('Film "rgb"\n# PixelFilter\nPixelFilter "gaussian" "float xradius" [ 1.5 ] "float yradius" 2\n'
                'Sampler "sobol"\nWorldBegin\nMediumInterface "fog" ""\nShape "sphere"\n')  # fmt: skip
        copied = with_box_filter(text, Path("f"))
        names = [(d.name, d.strings) for d in directives_of(copied, Path("f"))]
        self.assertEqual(
            names,
            [
                ("Film", ["rgb"]),
                ("Sampler", ["sobol"]),
                ("PixelFilter", ["box"]),
                ("WorldBegin", []),
                ("Shape", ["sphere"]),
            ],
        )
        with self.assertRaises(SceneError):
            with_box_filter("Identity", Path("f"))
