"""Scenes of all formats: invalid and unusual ones, and options that select or change their content."""

import gzip
import json
import os

from program import (FORMATS, GLTF_MOTION, GLTF_TRIANGLE, PROGRAM, SKY, TENT, ProgramTest, each, edited, pfm, read,
                     scene, steps, write)  # fmt: skip

PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
"""


class BrokenScenes(ProgramTest):
    def broken(self, text, world):
        """Expects that a render fails with the text and leaves no picture. The world begins in line 7."""
        with self.subTest(world):
            scene("broken", f"{SKY}\n{world}")
            self.expect(1, text, "render broken.pbrt")
            self.assert_absent("broken.exr")

    def test_worlds(self):
        mesh = 'Shape "trianglemesh" "integer indices"'
        for text, world in [
            ("broken.pbrt:7:35: there is no file 'no.png'", 'Texture "t" "spectrum" "imagemap" "string filename"'
             ' "no.png"\nMaterial "diffuse" "texture reflectance" "t" Shape "sphere"'),
            ("unknown shape 'spere' (did you mean 'sphere'?)", 'Shape "spere"'),
            ("unknown directive 'Shap'", 'Shap "sphere"'),
            ("broken.pbrt:7:16: parameter 'radius' has type integer; expected float",
             'Shape "sphere" "integer radius" 1'),
            ("triangle 0 refers to vertex 7", f'{mesh} [0 1 7] "point3 P" [0 0 0 1 0 0 0 1 0]'),
            ("expected a number, read 'nan'", f'{mesh} [0 1 2] "point3 P" [0 0 nan 1 0 0 0 1 0]'),
            ("this AttributeBegin has no AttributeEnd", "AttributeBegin"),
            ("AttributeEnd without AttributeBegin", "AttributeEnd"),
            ("'broken.pbrt' includes itself", 'Include "broken.pbrt"'),
            ("'broken.pbrt' includes itself", 'Import "broken.pbrt"'),
        ]:  # fmt: skip
            self.broken(text, world)

    def test_files_that_include_each_other(self):
        write("a.pbrt", 'Include "b.pbrt"')
        write("b.pbrt", 'Include "a.pbrt"')
        self.expect(1, "b.pbrt:1:1: 'a.pbrt' includes itself", "render a.pbrt")
        write("z.pbrt.gz", gzip.compress(b'Include "z.pbrt.gz"'))
        self.expect(1, "includes itself", "render z.pbrt.gz")

    def test_films(self):
        for width, height, spp, text in [
            (0, 6, 4, "parameter 'xresolution' is 0"),
            (8, -6, 4, "parameter 'yresolution' is -6"),
            (99999999, 6, 4, "expected 1 to 65536 pixels"),
            (99999999999, 6, 4, "too large for a 32-bit integer"),
            (65536, 65536, 4, "GiB of memory"),
            (8, 6, 0, "parameter 'pixelsamples' is 0"),
            (8, 6, -4, "parameter 'pixelsamples' is -4"),
        ]:
            with self.subTest(text):
                scene("film", "", width, height, spp)
                self.expect(1, text, "render film.pbrt")

    def test_ply(self):
        world = 'Shape "plymesh" "string filename" "bad.ply'
        for length in 0, 3, 60, 150, 175, 176:
            write("bad.ply", PLY[:length])
            self.broken("broken.pbrt:7:17: bad.ply", world + '"')
        for before, after, text in [
            ("3 0 1 2", "3 0 1 9", "refers to vertex 9; the file has 3 vertices"),
            ("1 0 0", "1 0 nan", "bad.ply:11: expected a number"),
            ("vertex 3", "vertex 4000000000", "more than the file can hold"),
            ("face 1", "face 1000000000000", "more than the file can hold"),
        ]:
            write("bad.ply", PLY.replace(before, after))
            self.broken(text, world + '"')
        write("bad.ply.gz", gzip.compress(PLY.encode())[:60])
        self.broken("the gzip data ends early", world + '.gz"')

    def test_files_that_are_not_scenes(self):
        write("empty.pbrt", "")
        self.expect_each([
            (1, "empty.pbrt: the file is empty", "render empty.pbrt"),
            (1, "missing.pbrt: cannot be opened", "render missing.pbrt"),
            (1, "it is a folder", "render ."),
            (1, f"this is a program; {FORMATS}", "render", PROGRAM),
            (1, "cannot be opened", "render", ""),
        ])  # fmt: skip


class UnusualScenes(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("none", 'Shape "sphere"')
        write("bare.pbrt", "WorldBegin\n")
        scene("warned", 'Shape "sphere" "float raduis" 2 Shape "sphere" "float raduis" 2')
        scene("ok", f'{SKY} Material "diffuse" Shape "sphere"')
        text = read("ok.pbrt")
        write("packed.pbrt.gz", gzip.compress(text))
        write("crlf.pbrt", text.replace(b"\n", b"\r\n"))
        write("bom.pbrt", b"\xef\xbb\xbf" + text)
        os.makedirs("a ü/deep")
        write("a ü/main.pbrt", text.replace(b'Shape "sphere"', b'Include "ball.pbrt"'))
        write("a ü/ball.pbrt", 'Shape "sphere"')

    test_scenes_without_light_or_content = each("""
        0 none.pbrt:7:1: the scene has no light; its picture is black $ render none.pbrt
        0 bare.exr: 8 x 6 pixels $ render bare.pbrt --resolution 8x6 --spp 1
    """)

    def test_picture_does_not_depend_on_how_the_file_is_written(self):
        self.quietly("render ../main.pbrt -o '../ö .pfm'", cwd="a ü/deep")
        self.take("""
            0 ok.exr $ render ok.pbrt -o ok.pfm -o ok.exr
            0 $ render packed.pbrt.gz -o packed.pfm
            ok.pfm == packed.pfm
            0 $ render crlf.pbrt -o crlf.pfm
            ok.pfm == crlf.pfm
            0 $ render bom.pbrt -o bom.pfm
            ok.pfm == bom.pfm
        """)
        self.assert_same("ok.pfm", "a ü/ö .pfm", "a file beside the scene")

    def test_each_warning_is_printed_once(self):
        text = self.expect(0, "did you mean 'radius'?", "render warned.pbrt")
        self.assertEqual(sum("raduis" in line for line in text.splitlines()), 1, text)


class Gltf(ProgramTest):
    """A triangle that emits, two cameras, an animation that moves the triangle."""

    SHOT = "render scene.gltf --spp 4 --resolution 32x16"

    @classmethod
    def prepare(cls):
        variants = "KHR_materials_variants"
        attributes = {"attributes": {"POSITION": 0}, "material": 0,
                      "extensions": {variants: {"mappings": [{"material": 1, "variants": [0]}]}}}  # fmt: skip
        write("scene.gltf", json.dumps({
            "asset": {"version": "2.0"}, **GLTF_TRIANGLE, **GLTF_MOTION,
            "materials": [{"emissiveFactor": [1, 0, 0]}, {"emissiveFactor": [0, 1, 0]}],
            "meshes": [{"primitives": [attributes]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "aspectRatio": 2}},
                        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0}}],
            "nodes": [{"mesh": 0}, {"camera": 0, "name": "front", "translation": [0.3, 0.3, 1]},
                      {"camera": 1, "name": "plan", "translation": [0, 0, 2]}],
            "extensions": {variants: {"variants": [{"name": "green"}]}},
        }))  # fmt: skip
        edited("scene.gltf", "broken.gltf", ('"POSITION": 0', '"POSITION": 7'))
        scene("old", f'{SKY} Shape "sphere"')

    test_camera_variant_and_time_are_chosen = steps(f"""
        0 front.pfm $ {SHOT} -o front.pfm
        0 again.pfm $ {SHOT} -o again.pfm --camera 0
        front.pfm == again.pfm
        0 plan.pfm $ {SHOT} -o plan.pfm --camera plan
        front.pfm != plan.pfm
        0 green.pfm $ {SHOT} -o green.pfm --variant green
        front.pfm != green.pfm
        0 later.pfm $ {SHOT} -o later.pfm --time-of-scene 1s
        front.pfm != later.pfm
    """)
    test_film_has_the_shape_of_the_camera = steps("""
        0 film.exr $ render scene.gltf --spp 4 -o film.exr --camera front
        0 800 x 400 $ info film.exr
    """)
    test_mistakes = each("""
        1 scene.gltf: there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan'
          $ render scene.gltf --camera plam
        1 scene.gltf: there is no variant 'gren' (did you mean 'green'?); expected 'green'
          $ render scene.gltf --variant gren
        2 --time-of-scene: 'soon' was given $ render scene.gltf --time-of-scene soon
        1 old.pbrt: only glTF and Mitsuba scenes have a choice of cameras $ render old.pbrt --camera 0
        1 broken.gltf: /meshes/0/primitives/0/attributes/POSITION: accessor 7 does not exist (there are 3)
          $ render broken.gltf
    """)


class Mitsuba(ProgramTest):
    """Parameters, includes, messages."""

    @classmethod
    def prepare(cls):
        write("scene.xml", """<?xml version="1.0" encoding="utf-8"?>
<!-- A grey ball under a white sky. -->
<scene version="3.0.0">
    <default name="spp" value="2"/>
    <default name="grey" value="0.5"/>
    <integrator type="path"><integer name="max_depth" value="3"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 1 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="16"/></film>
        <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    </sensor>
    <emitter type="constant"/>
    <include filename="parts/ball.xml"/>
</scene>
""")
        os.mkdir("parts")
        write("parts/ball.xml", """<scene version="3.0.0">
    <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="$grey"/></bsdf></shape>
</scene>
""")
        scene("old", f'{SKY} Shape "sphere"')
        edited("parts/ball.xml", "parts/misspelt.xml", ('type="sphere"', 'type="spere"'))
        edited("scene.xml", "misspelt.xml", ("ball.xml", "misspelt.xml"))
        edited("scene.xml", "polarized.xml", ('type="path"', 'type="stokes"'), ('"independent"', '"idependent"'))
        edited("scene.xml", "cut.xml", ("</scene>", ""))

    test_parameters = steps("""
        0 $ render scene.xml -o grey.pfm
        0 24 x 16 $ info grey.pfm
        0 $ render scene.xml -o same.pfm -D grey=0.5 -D spp=2
        grey.pfm == same.pfm
        0 $ render scene.xml -D grey=0.25 -o dark.pfm
        grey.pfm != dark.pfm
        0 $ render -D spp=1 scene.xml -o fewer.pfm
        grey.pfm != fewer.pfm
        0 shapes       1 sphere $ info scene.xml -D spp=4
        0 the scene does not use the parameter 'gray' $ render scene.xml -D gray=1 -o other.pfm
    """)
    test_list_of_formats = each("""
        0 roughplastic $ formats mitsuba
        0 "plugin": "roughplastic" $ formats mitsuba --json
    """)
    test_mistakes = steps("""
        2 NAME=VALUE $ render scene.xml -D grey -o none.pfm
        2 NAME=VALUE $ render scene.xml -D =1 -o none.pfm
        1 old.pbrt: only Mitsuba scenes have parameters that can be defined $ render old.pbrt -D grey=1 -o none.pfm
        1 parts/misspelt.xml:2:5: there is no shape 'spere' (did you mean 'sphere'?) $ render misspelt.xml -o none.pfm
        1 polarization $ render polarized.xml -o none.pfm
        1 cut.xml: $ render cut.xml -o none.pfm
        no none.pfm
    """)


class Models(ProgramTest):
    """Models without a scene: the studio, and options that change it."""

    SMALL = "--resolution 32x24 --spp 8"
    SHOT = f"render tent.obj {SMALL}"
    CORNER, BARE = f"{SHOT} --crop 0,0.1,0,0.1 --ground off --background", f"{SHOT} --ground off --background"

    @classmethod
    def prepare(cls):
        write("tent.obj", TENT)
        write("model.obj", TENT)
        cls.quietly(f"{cls.SHOT} -o studio.exr")
        write("broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n")
        write("empty.obj", "v 0 0 0\nv 1 0 0\n")
        write("model.usda", "#usda 1.0\n")
        scene("ball", f'{SKY} Shape "sphere"')
        scene("dark", 'Shape "sphere"')
        pfm("sky.pfm", 2, 1, 1, 0, 0)
        os.mkdir("models")
        write("models/m.mtl", "newmtl red\nKd 1 0 0\nmap_Kd C:\\textures\\brick.png\nnewmtl lamp\nKe 5 5 5\n")
        red = TENT.replace("f 1 2 3 4", "usemtl red\nf 1 2 3 4").replace("f 2 5 3", "usemtl lost\nf 2 5 3")
        write("models/red.obj", "mtllib m.mtl\nmtllib other.mtl\n" + red)
        write("lamp.obj", "mtllib models/m.mtl\n" + TENT.replace("f 1 2 3 4", "usemtl lamp\nf 1 2 3 4"))

    test_studio_is_added = steps(f"""
        0 montelux: tent.obj has no camera and no environment: a studio was added (--environment, --orbit, --ground,\
 --background change it) & 32 x 24 pixels, 8 samples per pixel $ {SHOT} -o a.exr -o a.png
        0 "background" $ info a.exr
        a.exr ~ studio.exr
        0 model.exr: 800 x 600 pixels $ render model.obj --spp 1
        0 tent.obj has no camera: a studio $ {SHOT} --environment none -o dark.exr
        0 "maximum": 0 $ info dark.exr --json
    """)
    test_orbit_and_ground = steps(f"""
        0 turned.pfm $ {SHOT} -o studio.pfm -o turned.pfm
        0 turned.pfm $ {SHOT} --orbit 120,10 -o turned.pfm
        turned.pfm != studio.pfm
        0 far.pfm $ {SHOT} --orbit 35,18,2 -o far.pfm
        far.pfm != studio.pfm
        0 bare.pfm $ {SHOT} --ground off -o bare.pfm
        bare.pfm != studio.pfm
        0 $ {SHOT} --orbit 35,18,1 -o same.exr
        same.exr ~ studio.exr
        # An elevation below 0 is an argument of its own.
        0 $ {SHOT} --orbit -35,-10 --ground off -o below.exr
    """)
    test_background_is_exact_and_not_seen_by_the_light = steps(f"""
        0 $ {CORNER} #4080ff -o blue.png
        0 "minimum": 0.25098 $ info blue.png --json
        0 $ {CORNER} 0.25,0.5,3 -o linear.exr
        0 "minimum": 3.0 & "maximum": 0.25 $ info linear.exr --json
        0 $ {BARE} black --checkpoint black.state -o black.exr
        0 $ {BARE} grey --checkpoint grey.state -o grey.exr
        0 $ {BARE} white --checkpoint white.state -o white.exr
        1 the integrator differs $ {BARE} black --checkpoint white.state --resume -o x.exr
        0 $ {BARE} white --checkpoint white.state --resume -o x.exr
        x.exr ~ white.exr
        0 $ {BARE} transparent -o clear.png -o clear.exr -o clear.pfm
        0 4 channels, 8-bit $ info clear.png
        0 A  $ info clear.exr
        0 3 channels $ info clear.pfm
    """)
    test_options_change_other_scenes_too = steps("""
        0 $ render ball.pbrt --background black -o black.exr
        0 $ render ball.pbrt --orbit 0,0 --ground on -o orbit.exr
        1 8 x 6 pixels; an environment map must be square $ render ball.pbrt --environment orbit.exr -o x.exr
        0 $ render ball.pbrt --environment sky.pfm -o red.exr
        2 sky.pfm: the scene is read from this file $ render ball.pbrt --environment sky.pfm -o sky.pfm
        0 dark.pbrt:7:1: the scene has no light; its picture is black $ render dark.pbrt
        0 $ render dark.pbrt --environment sky.pfm
    """)

    def test_pbrt_scene_gets_no_studio(self):
        self.assertNotIn("studio", self.expect(0, "", "render ball.pbrt -o ball.exr"))

    test_mistakes = each(f"""
        2 --orbit: '90' was given; expected AZ,EL or AZ,EL,DIST $ render tent.obj --orbit 90
        2 --orbit: '90,100' was given $ render tent.obj --orbit 90,100
        2 --orbit: '90,10,0' was given $ render tent.obj --orbit 90,10,0
        2 --orbit: '90,10,1,1' was given $ render tent.obj --orbit 90,10,1,1
        2 --orbit: 'front' was given $ render tent.obj --orbit front
        2 --ground: 'yes' was given; on or off is expected $ render tent.obj --ground yes
        2 --background: 'redish' was given; expected transparent, black, grey, white, #rrggbb
          $ render tent.obj --background redish
        2 --background: '#12345' was given $ render tent.obj --background #12345
        2 --background: '1,2' was given $ render tent.obj --background 1,2
        2 --background: '1,-2,0' was given $ render tent.obj --background 1,-2,0
        1 nowhere.hdr $ render tent.obj --environment nowhere.hdr
        2 --environment $ render tent.obj --environment ''
        1 broken.obj:3: the face refers to vertex 3; there are 2 so far $ render broken.obj
        1 empty.obj: the file has no faces $ render empty.obj
        1 model.usda: this is a USD scene (text); {FORMATS} $ render model.usda
    """)
    test_materials_and_missing_ones = each(rf"""
        0 models/red.obj:2: there is no file 'other.mtl' in the folder of the OBJ file
          & models/m.mtl:3: there is no picture 'C:\textures\brick.png' in the folder
          & models/red.obj:12: no MTL file has the material 'lost' $ render models/red.obj {SMALL} -o red.exr
        0 lamp.obj has no camera: a studio was added $ render lamp.obj {SMALL} -o lamp.exr
    """)
