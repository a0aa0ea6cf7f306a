"""What pbrt scenes become for Mitsuba, and that all that is left out is named."""

import numpy as np
from pathlib import Path
from scene_testing import SOURCE, TRIANGLE, InFolder

import meshes
import transforms
from mitsuba_scene import Converter, film_size
from mitsuba_textures import EQUAL_AREA_MAP, PICTURE, UNBOUNDED
from pbrt_scene import read_scene
from pbrt_text import SceneError


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
        self.assertEqual(
            (bsdf["weight"], bsdf["first"]["type"], bsdf["second"]["type"]), (0.25, "twosided", "dielectric")
        )

    def test_materials_are_shared(self):
        converted, _ = self.convert('MakeNamedMaterial "a" "string type" "diffuse" NamedMaterial "a"\n' + 2 * TRIANGLE)
        self.only(converted, "material")

    def test_what_is_left_out_is_named(self):
        for text, message in (
            ('Material "hair"', "material hair is not converted"),
            ('Material "diffuse" "normal map" [1]', "parameter map is not converted"),
            ('Material "coatedconductor"', "the coat is left out"),
            ('Material "diffusetransmission"', "what it transmits is left out"),
            (
                'Texture "t" "spectrum" "marble" Material "diffuse" "texture reflectance" "t"',
                "texture t of type marble",
            ),
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
        self.assertEqual(
            (found["type"], found["filename"], notices), (PICTURE, str((self.folder / "a.png").resolve()), [])
        )
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
        for inner, key in (
            ('imagemap" "string filename" "a.png', "scale"),
            ('constant" "rgb value" [1 1 1] "string filter" "x', "value"),
        ):
            found, _ = self.reflectance(
                f'Texture "i" "spectrum" "{inner}" Texture "t" "spectrum" "scale" "texture tex" "i" "float scale" 0.5'
            )
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
        converted, _ = self.convert(
            'Scale 2 2 2 LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "rgb L" [1 1 1]'
        )
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
            faces = b"".join(
                np.array([len(f)], "u1").tobytes() + np.array(f, order + "i4").tobytes()
                for f in ([0, 1, 2], [0, 1, 2, 3])
            )
            file = self.folder / "b.ply"
            file.write_bytes(
                (head.format(f"binary_{name}_endian", 2) + tail).encode()
                + points.astype(order + "f4").tobytes()
                + faces
            )
            mesh = meshes.read_ply(file)
            np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [0, 1, 2], [0, 2, 3]])
            np.testing.assert_array_equal(mesh.points.ravel(), points)
            file.write_bytes(file.read_bytes()[:-3])
            with self.assertRaises(SceneError):
                meshes.read_ply(file)


class OwnScenes(InFolder):
    def test_demo(self):
        scene = read_scene(SOURCE / "scenes/demo/studio.pbrt")
        converted = Converter(scene, self.folder, 200).convert()
        self.assertEqual(sum(name.startswith("shape_") for name in converted), 16)
        self.assertEqual(len(scene.notices), 1)
        self.assertIn("coatedconductor", scene.notices[0])
        self.assertEqual(film_size(scene, 200), (200, 112))
