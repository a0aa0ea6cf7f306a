"""The comparison with Mitsuba: pbrt scenes read and converted, errors and ratios of pictures. Needs no Mitsuba.

Usage: mitsuba_scene_test.py; 77 means that it was skipped.
"""

import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "bench/render"))
try:
    import numpy as np
except ImportError:
    print("skipped: this Python has no numpy")
    sys.exit(77)

import meshes
import transforms
from comparison import Comparison, Measurement, ReferenceResult, Settings, estimator
from mitsuba_scene import Converter, film_size
from mitsuba_textures import EQUAL_AREA_MAP, PICTURE, UNBOUNDED
from mitsuba_values import equal_area_coordinates, latitude_longitude
from montelux_scene import with_box_filter
from pbrt_scene import read_scene
from pbrt_text import SceneError, directives_of
from pictures import Reference, read_pfm, relative_errors
from report import markdown

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
        return read_scene(self.write("scene.pbrt", f'{header}\nCamera "perspective" "float fov" 40\nWorldBegin\n{world}'))

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


class Text(InFolder):
    def test_directives(self):
        text = '# "Shape"\nShape "sphere" "float radius" 2 # "x"\n"bool b" true "string s" ["a b"]\nTranslate 1 -2e0 .5\n'
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
            ('Shape "sphere" "radius" 2', "f:1: expected \"type name\""),
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
        scene = self.read('AttributeBegin Translate 1 0 0 ReverseOrientation Material "dielectric" AttributeEnd Shape "sphere"')
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
        scene = read_scene(self.write("s.pbrt", 'Camera "perspective" "float lensradius" 0.1 "float focaldistance" 3 WorldBegin'))
        sensor = Converter(scene, self.folder).convert()["sensor"]
        self.assertEqual((sensor["type"], sensor["aperture_radius"], sensor["focus_distance"]), ("thinlens", 0.1, 3))

    def test_depth_and_roulette(self):
        converted, _ = self.convert("", 'Integrator "path" "integer maxdepth" 7')
        self.assertEqual(converted["integrator"], {"type": "path", "max_depth": 8, "rr_depth": 2})


class Materials(InFolder):
    def test_roughness(self):
        for given, expected in (("0.25", 0.5), ('0.25 "bool remaproughness" false', 0.25), ("0", None)):
            bsdf, notices = self.material(f'Material "conductor" "float roughness" {given}')
            self.assertEqual((bsdf["bsdf"].get("alpha"), notices), (expected, []))
            self.assertEqual(bsdf["bsdf"]["type"], "roughconductor" if expected else "conductor")
        bsdf, _ = self.material('Material "conductor" "float uroughness" 0.04 "float vroughness" 0.09')
        np.testing.assert_allclose([bsdf["bsdf"]["alpha_u"], bsdf["bsdf"]["alpha_v"]], [0.2, 0.3])

    def test_kinds(self):
        for text, kind in (
            ("dielectric", "dielectric"),
            ("thindielectric", "thindielectric"),
            ("interface", "null"),
        ):
            self.assertEqual(self.material(f'Material "{text}"')[0]["type"], kind)
        bsdf, notices = self.material('Material "coateddiffuse" "rgb reflectance" [.1 .2 .3] "float roughness" 0.01')
        self.assertEqual((bsdf["type"], bsdf["bsdf"]["type"], notices), ("twosided", "roughplastic", []))
        self.assertEqual(bsdf["bsdf"]["diffuse_reflectance"], {"type": "rgb", "value": [0.1, 0.2, 0.3]})
        bsdf, _ = self.material('Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"')
        self.assertEqual(bsdf["bsdf"]["material"], "Au")
        bsdf, _ = self.material('Material "conductor" "rgb eta" [1 2 3] "rgb k" [4 5 6]')
        self.assertEqual(bsdf["bsdf"]["k"], {"type": UNBOUNDED, "value": [4, 5, 6]})

    def test_mix(self):
        bsdf, _ = self.material('MakeNamedMaterial "a" "string type" "diffuse" MakeNamedMaterial "b" "string type" "dielectric"'
                                ' Material "mix" "string materials" ["a" "b"] "float amount" 0.25')  # fmt: skip
        self.assertEqual((bsdf["weight"], bsdf["first"]["type"], bsdf["second"]["type"]), (0.25, "twosided", "dielectric"))

    def test_materials_are_shared(self):
        converted, _ = self.convert('MakeNamedMaterial "a" "string type" "diffuse" NamedMaterial "a"\n' + 2 * TRIANGLE)
        self.only(converted, "material")

    def test_what_is_left_out_is_named(self):
        for text, message in (
            ('Material "hair"', "material hair is not converted"),
            ('Material "diffuse" "normal map" [1]', "parameter map is not converted"),
            ('Material "coatedconductor"', "the coat is left out"),
            ('Material "diffusetransmission"', "what it transmits is left out"),
            ('Texture "t" "spectrum" "marble" Material "diffuse" "texture reflectance" "t"', "texture t of type marble"),
            ('LightSource "goniometric"', "light goniometric is left out"),
            ('Shape "cylinder"', "shape cylinder is left out"),
            ('Scale 1 2 1 Shape "sphere"', "sphere scaled unevenly is left out"),
            ('MediumInterface "fog" ""', "MediumInterface fog"),
            ('ObjectBegin "o"\nShape "sphere"\nObjectEnd', "ObjectBegin o"),
        ):
            _, notices = self.material(text)
            self.assertTrue(any(message in n for n in notices), f"{text}: {notices}")


class Textures(InFolder):
    def reflectance(self, text):
        bsdf, notices = self.material(text + ' Material "diffuse" "texture reflectance" "t"')
        return bsdf["bsdf"]["reflectance"], notices

    def test_picture(self):
        """The texel at pbrt's (s, t) lies at row 1 - t; a vertex of pbrt's (u, v) has Mitsuba's (u, 1 - v)."""
        found, notices = self.reflectance('Texture "t" "spectrum" "imagemap" "string filename" "a.png" "float vscale" 3'
                                          ' "float vdelta" 0.25 "float scale" 2')  # fmt: skip
        self.assertEqual((found["type"], found["filename"], notices), (PICTURE, str((self.folder / "a.png").resolve()), []))
        u, v = 0.3, 0.1
        np.testing.assert_allclose(found["to_uv"] @ [u, 1 - v, 1], [u, 1 - (3 * v + 0.25), 1])
        self.assertEqual(found["scale"], [2, 2, 2])

    def test_checkerboard(self):
        found, notices = self.reflectance('Texture "t" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 4'
                                          ' "rgb tex1" [1 0 0] "rgb tex2" [0 1 0]')  # fmt: skip
        self.assertEqual((found["color0"]["value"], notices), ([1, 0, 0], []))
        for u, v in ((0.1, 0.1), (0.2, 0.1), (0.2, 0.3), (0.9, 0.6)):
            first = (int(u * 6) + int(v * 4)) % 2 == 0
            x, y, _ = found["to_uv"] @ [u, 1 - v, 1]  # Mitsuba's: the halves of a unit alternate
            self.assertEqual((x % 1 > 0.5) == (y % 1 > 0.5), first)

    def test_scale(self):
        for inner, key in (("imagemap\" \"string filename\" \"a.png", "scale"), ("constant\" \"rgb value\" [1 1 1] \"string filter\" \"x", "value")):
            found, _ = self.reflectance(f'Texture "i" "spectrum" "{inner}" Texture "t" "spectrum" "scale" "texture tex" "i" "float scale" 0.5')
            self.assertEqual(found[key], [0.5] * 3)


class Shapes(InFolder):
    def mesh(self, world):
        converted, _ = self.convert(world)
        return self.only(converted, "shape"), meshes.read_ply(Path(self.only(converted, "shape")["filename"]))

    def test_orientation(self):
        """Side +z by the order of the vertices; reversal and mirroring each flip it; normals overrule all."""
        def outside(before, normals=""):
            _, mesh = self.mesh(before + TRIANGLE.rstrip() + normals)
            a, b, c = mesh.points[mesh.faces[0]]
            return np.sign(np.cross(b - a, c - a)[2])

        down = ' "normal N" [0 0 -1 0 0 -1 0 0 -1]'
        self.assertEqual(outside(""), 1)
        self.assertEqual(outside("ReverseOrientation "), -1)
        self.assertEqual(outside("Scale -1 1 1 "), 1)  # the order turns, and so does the side that counts
        self.assertEqual(outside("Scale -1 1 1 ReverseOrientation "), -1)
        self.assertEqual(outside("", down), -1)
        self.assertEqual(outside("ReverseOrientation ", down), 1)

    def test_normals_and_coordinates(self):
        shape, mesh = self.mesh('Scale 1 1 2 Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 1] "normal N" [0 -1 1 0 -1 1 0 -1 1]'
                                ' "point2 uv" [0 0 1 0 0 .75]')  # fmt: skip
        self.assertFalse(shape["face_normals"])
        np.testing.assert_allclose(mesh.normals[0], np.array([0, -2, 1]) / 5**0.5, atol=1e-6)
        np.testing.assert_allclose(mesh.uv[:, 1], [1, 1, 0.25])

    def test_lights(self):
        converted, notices = self.convert('AreaLightSource "diffuse" "rgb L" [1 2 3] "float scale" 2\n' + TRIANGLE)
        shape = self.only(converted, "shape")
        self.assertEqual((shape["emitter"]["radiance"]["value"], shape["face_normals"], notices), ([2, 4, 6], True, []))
        converted, _ = self.convert('Scale 2 2 2 LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "rgb L" [1 1 1]')
        self.assertEqual(self.only(converted, "light")["direction"], [0, 0, -2])
        converted, _ = self.convert('Translate 1 0 0 LightSource "point" "point3 from" [0 0 1] "rgb I" [1 1 1]')
        self.assertEqual(self.only(converted, "light")["position"], [1, 0, 1])
        converted, _ = self.convert('LightSource "infinite" "string filename" "a.exr"')
        self.assertEqual(self.only(converted, "light")["type"], EQUAL_AREA_MAP)

    def test_quadrics(self):
        converted, _ = self.convert('Translate 1 2 3 Scale -2 2 2 Shape "sphere" "float radius" 3')
        m = self.only(converted, "shape")["to_world"]
        self.assertFalse(transforms.mirrors(m))
        self.assertAlmostEqual(transforms.uniform_scale(m), 6)
        converted, _ = self.convert('Shape "disk" "float radius" 3 "float height" 2')
        np.testing.assert_allclose(self.only(converted, "shape")["to_world"] @ [1, 0, 0, 1], [3, 0, 2, 1])

    def test_ply_files(self):
        square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        head = "ply\nformat {} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n"
        tail = "property list uchar int vertex_indices\nend_header\n"
        quad = self.write("a.ply", head.format("ascii", 1) + tail + square + "4 0 1 2 3\n")
        np.testing.assert_array_equal(meshes.read_ply(quad).faces, [[0, 1, 2], [0, 2, 3]])
        points = np.array([float(x) for x in square.split()])
        for order, name in (("<", "little"), (">", "big")):
            faces = b"".join(np.array([len(f)], "u1").tobytes() + np.array(f, order + "i4").tobytes() for f in ([0, 1, 2], [0, 1, 2, 3]))
            file = self.folder / "b.ply"
            file.write_bytes((head.format(f"binary_{name}_endian", 2) + tail).encode() + points.astype(order + "f4").tobytes() + faces)
            mesh = meshes.read_ply(file)
            np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 1, 2], [0, 2, 3]])
            np.testing.assert_array_equal(mesh.points.ravel(), points)
            file.write_bytes(file.read_bytes()[:-3])
            with self.assertRaises(SceneError):
                meshes.read_ply(file)


class Environments(unittest.TestCase):
    def test_axes(self):
        """+z is the centre of the square, -z its corners, the other axes the middles of its sides."""
        axes = np.array([[0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], float)
        expected = [[0.5, 0.5], [1, 0.5], [0, 0.5], [0.5, 1], [0.5, 0]]
        np.testing.assert_allclose(equal_area_coordinates(axes), expected, atol=1e-6)
        self.assertTrue(np.isin(equal_area_coordinates(np.array([0.0, 0, -1])).round(6), [0, 1]).all())

    def test_areas_are_kept(self):
        n, random = 8, np.random.default_rng(1)
        d = random.normal(size=(400000, 3))
        at = (equal_area_coordinates(d / np.linalg.norm(d, axis=1, keepdims=True)) * n).astype(int)
        counts = np.bincount(at[:, 0] + n * at[:, 1], minlength=n * n)
        self.assertLess(np.abs(counts / counts.mean() - 1).max(), 5 / counts.mean() ** 0.5)

    def test_latitude_longitude(self):
        """A map that holds the direction of each texel's centre, looked up where Mitsuba finds that direction."""
        n = 128
        square, found = np.zeros((n, n, 3)), np.random.default_rng(2).normal(size=(200000, 3))
        found /= np.linalg.norm(found, axis=1, keepdims=True)
        at = (equal_area_coordinates(found) * n).astype(int)
        square[at[:, 1], at[:, 0]] = found
        image = latitude_longitude(square)
        self.assertEqual(image.shape, (n, 2 * n, 3))
        for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-0.6, 0.48, 0.64), (0.48, -0.64, -0.6)):
            u, v = np.arctan2(x, -z) / (2 * np.pi) % 1, np.arccos(y) / np.pi
            texel = image[min(int(v * n), n - 1), min(int(u * 2 * n), 2 * n - 1)]
            np.testing.assert_allclose(texel, [x, y, z], atol=0.06)


class Copies(unittest.TestCase):
    def test_filter_and_media(self):
        text = ('Film "rgb"\n# PixelFilter\nPixelFilter "gaussian" "float xradius" [ 1.5 ] "float yradius" 2\n'
                'Sampler "sobol"\nWorldBegin\nMediumInterface "fog" ""\nShape "sphere"\n')  # fmt: skip
        copied = with_box_filter(text, Path("f"))
        names = [(d.name, d.strings) for d in directives_of(copied, Path("f"))]
        self.assertEqual(names, [("Film", ["rgb"]), ("Sampler", ["sobol"]), ("PixelFilter", ["box"]), ("WorldBegin", []), ("Shape", ["sphere"])])
        with self.assertRaises(SceneError):
            with_box_filter("Identity", Path("f"))


class Figures(InFolder):
    def test_relative_errors(self):
        reference = np.ones((50, 40, 3))
        picture = reference.copy()
        picture[0, 0] = 11
        everything, trimmed = relative_errors(picture, reference)
        self.assertAlmostEqual(everything, 100 / 1.01 / 2000)
        self.assertEqual(trimmed, 0)

    def test_reference(self):
        found = Reference([np.full((2, 2, 3), v) for v in (1.0, 3.0)])
        self.assertAlmostEqual(found.luminance, 2)
        self.assertAlmostEqual(found.error, 1)

    def test_pfm(self):
        file = self.folder / "a.pfm"
        file.write_bytes(b"PF\n1 2\n-1\n" + np.arange(6, dtype="<f4").tobytes())
        np.testing.assert_array_equal(read_pfm(file), [[[3, 4, 5]], [[0, 1, 2]]])

    def test_table(self):
        comparison = Comparison([], Settings(200, [16], 64, 3, 1))
        comparison.measurements = [Measurement("a", "montelux", 16, [1, 2, 9], [3, 3, 3], [(0.1, 0.01)] * 3),
                                   Measurement("a", "llvm_ad_rgb", 16, [3, 4, 5], [3, 3, 3], [(0.05, 0.02)] * 3)]  # fmt: skip
        comparison.references = [ReferenceResult("a", "montelux", 64, 2.0, 0.03), ReferenceResult("a", "llvm_ad_rgb", 64, 2.1, 0.04)]
        text = markdown(comparison, [])
        self.assertIn("| a | 16 | llvm_ad_rgb | 4.00 (3.00) | 3.00 (3.00) | 0.05 (0.02) | 2.00 | 1.00 (4.00) |", text)
        self.assertIn("+5.00 % (2.50)", text)

    def test_estimators(self):
        self.assertEqual(estimator("scalar_rgb"), estimator("llvm_ad_rgb"))
        self.assertNotEqual(estimator("llvm_ad_spectral"), estimator("llvm_ad_rgb"))
        self.assertEqual(estimator("montelux:sobol"), estimator("montelux"))


class OwnScenes(InFolder):
    def test_demo(self):
        scene = read_scene(SOURCE / "scenes/demo/studio.pbrt")
        converted = Converter(scene, self.folder, 200).convert()
        self.assertEqual(sum(name.startswith("shape_") for name in converted), 16)
        self.assertEqual(len(scene.notices), 1)
        self.assertIn("coatedconductor", scene.notices[0])
        self.assertEqual(film_size(scene, 200), (200, 112))


if __name__ == "__main__":
    unittest.main()
