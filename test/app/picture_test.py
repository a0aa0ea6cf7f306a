"""Commands on pictures: convert with tone curves and exposures, info of scenes and textures, denoise."""

import itertools
import json
import os
import re
import unittest

from program import NAN, SKY, ProgramTest, each, edited, pfm, read, scene, steps, write

TONES = ["linear", "srgb", "aces", "agx", "filmic"]
TEXTURED_TRIANGLE = {  # a textured triangle with colours
    "asset": {"version": "2.0"},
    "buffers": [{"byteLength": 108, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAA"
                 "AAAAAgD8AAAAAAAAAAAAAAAAAAABAAAAAAAAAAAAAAABAAACAPwAAgD8AAIA/AACAPwAAAD8"
                 "AAIA/AACAPgAAgD8AAIA/AAAAPwAAgD8AAIA/"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
                    {"buffer": 0, "byteOffset": 60, "byteLength": 48}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
                  {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"}],
    "images": [{"uri": "ok.png"}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9729}],
    "textures": [{"source": 0, "sampler": 0}],
    "materials": [{
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.5, 0.25, 1, 1], "roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0},
            "baseColorTexture": {"index": 0, "extensions": {
                "KHR_texture_transform": {"rotation": 0.5, "scale": [2, 3]}}}},
        "normalTexture": {"index": 0, "scale": 0.5}, "alphaMode": "MASK"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "material": 0}]}],
    "nodes": [{"mesh": 0}], "extensionsUsed": ["KHR_texture_transform"],
}  # fmt: skip


class Pictures(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ok", f'{SKY} Material "diffuse" Shape "sphere"', 16, 12, 4)
        cls.printed = cls.expect(0, "ok.exr", "render ok.pbrt -o ok.exr -o ok.png -o ok.jpg")
        for end in "exr", "png", "jpg", "hdr", "pfm":
            cls.expect(0, f"c.{end}: 16 x 12 pixels", f"convert ok.exr c.{end}")
        pfm("bright.pfm", 2, 1, 1000)
        pfm("dark.pfm", 2, 1, 1e-5)
        pfm("black.pfm", 2, 1, 0)
        pfm("fine.pfm", 2, 1, 0.5, 0.5, 0.5, 1, 1, 1)
        scene("lit", 'LightSource "infinite" "rgb L" [1000 1000 1000] Shape "sphere"', 8, 6, 1)
        edited("lit.pbrt", "iso.pbrt", ('"string filename"', '"float iso" 50 "string filename"'))

    test_formats_are_those_of_render = steps("""
        ok.png == c.png
        ok.jpg == c.jpg
        0 stderr.R $ info c.exr
    """)
    test_bits_and_channels = steps("""
        0 wide.png $ convert ok.exr wide.png --bits 16
        0 16-bit integer $ info wide.png
        0 l.exr $ convert ok.exr l.exr --layer depth
        0 1 channels $ info l.exr
    """)
    test_mistakes = steps("""
        1 the extension '.gif' $ convert ok.exr x.gif
        2 OUT is required $ convert ok.exr
        1 none.exr: cannot be opened $ convert none.exr x.png
        2 montelux render $ convert ok.pbrt x.png
        2 one of linear, srgb, aces, agx, filmic is expected (did you mean 'agx'?) $ convert ok.exr x.png --tone agxx
        2 a number from -100 to 100 is expected, or auto $ convert ok.exr x.png --exposure bright
        2 'nan' was given $ convert ok.exr x.png --exposure nan
        2 --exposure: it is for .png and .jpg pictures; none is written $ convert ok.exr x.exr --exposure 1
        2 --tone: it is for .png and .jpg $ render ok.pbrt -o x.exr --tone aces
        2 --quality: it is for .jpg $ convert ok.exr x.png --quality 50
        2 --bits: it is for .png $ convert ok.exr x.jpg --bits 16
        2 8 or 16 is expected $ convert ok.exr x.png --bits 10
        2 a whole number from 1 to 100 is expected $ convert ok.exr x.jpg --quality 0
        2 --half: it is for .exr $ convert ok.exr x.png --half
        no x.*
        0 --tone $ convert --help
    """)
    test_exposures_that_show_what_0_would_not = steps("""
        0 exposure $ convert ok.exr a.png --exposure auto
        0 e.png $ convert ok.exr e.png --exposure -2 --tone aces
        0 b.png: exposure -12.44 stops, at 0 100 % of the pixels are white $ convert bright.pfm b.png
        0 d.png: exposure +14.14 stops, at 0 100 % of the pixels are black $ convert dark.pfm d.png
        0 "mean": 0.46 $ info d.png --json
        0 z.png: 100 % of the pixels are black; there is no light in the picture $ convert black.pfm z.png
        0 w.png: 100 % of the pixels are white; --exposure auto chooses -12.44 stops
          $ convert bright.pfm w.png --exposure 0
        0 exposure - $ render lit.pbrt -o lit.png
        # A film with an exposure of its own chooses it.
        0 100 % of the pixels are white; --exposure auto chooses - $ render iso.pbrt -o iso.png
        0 level ground & sky.png: exposure - $ bake sky --size 16 -o sky.png
    """)

    def test_quiet_conversion_chooses_the_exposure_too(self):
        self.quietly("convert bright.pfm q.png")
        self.expect(0, "", "convert bright.pfm b.png")
        self.assert_same("b.png", "q.png")

    def test_no_exposure_is_chosen_in_a_sensible_range(self):
        self.assertNotIn("exposure", self.printed)
        self.assertNotIn("exposure", self.expect(0, "f.png", "convert fine.pfm f.png"))

    def test_sizes_of_files(self):
        self.assertEqual(read("ok.jpg")[:3], b"\xff\xd8\xff")
        for small, large, option in ("half.exr", "c.exr", "--half"), ("low.jpg", "c.jpg", "--quality 5"):
            self.expect(0, small, f"convert ok.exr {small} {option}")
            self.assertLess(os.path.getsize(small), os.path.getsize(large), option)

    def test_layers(self):
        for layer in "mean", "error", "albedo", "normal", "depth", "samples", "stderr", "N":
            self.expect(0, "l.png", f"convert ok.exr l.png --layer {layer}")
        self.expect(0, "3 channels", "info l.png")
        self.expect(0, "d.png", "convert ok.exr d.png --layer depth")
        (channel,) = self.json("info d.png")["channels"]
        self.assertEqual((channel["minimum"], channel["maximum"]), (0, 1))  # whatever the unit of length
        text = self.expect(1, "there is no layer 'albdo' (did you mean 'albedo'?); there are mean, ",
                           "convert ok.exr x.png --layer albdo")  # fmt: skip
        self.assertIn("error", text.partition("there are mean")[2])

    def test_each_tone_curve_gives_another_picture(self):
        for tone in TONES:
            self.expect(0, f"t_{tone}.png", f"convert ok.exr t_{tone}.png --tone {tone}")
        for one, other in itertools.combinations(TONES, 2):
            self.assert_differ(f"t_{one}.png", f"t_{other}.png")


class Scenes(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("full", f"""MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [0.9 0.1 0.1]
NamedMaterial "red" {SKY} Shape "loopsubdiv" "integer levels" 4 "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1]
"integer indices" [0 2 1 0 1 3 1 2 3 0 3 2]""", 16, 12, 4)
        write("noname", read("full.pbrt"))
        scene("ok", f'{SKY} Material "diffuse" Shape "sphere"', 16, 12, 4)
        cls.quietly("render ok.pbrt -o ok.png")
        write("model.gltf", json.dumps(TEXTURED_TRIANGLE))
        eye = {"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}
        nodes = [{"camera": 0, "name": "front", "translation": [0, 0, 5]},
                 {"camera": 0, "name": "plan", "translation": [0, 7, 0]}]  # fmt: skip
        write("two.gltf", json.dumps({"asset": {"version": "2.0"}, "cameras": [eye], "nodes": nodes}))
        pfm("square.pfm", 2, 2, 1)
        os.mkdir("other")
        cls.expect(0, "other/again.pbrt: 1 shapes, 1 lights, 1 files in other/again-files",
                   "convert full.pbrt other/again.pbrt")  # fmt: skip

    test_converted_scene_has_the_same_picture = steps("""
        0 full.exr $ render full.pbrt -o full.pfm -o full.exr
        0 again.pfm $ render other/again.pbrt -o again.pfm
        full.pfm == again.pfm
    """)
    # Extended pbrt syntax describes textured models completely.
    test_converted_model_has_the_same_picture = steps("""
        0 model.gltf has no camera and no environment: the studio is written with it $ convert model.gltf model.pbrt
        0 model.exr $ render model.gltf --spp 4 --resolution 32x24 -o model.pfm -o model.exr
        0 model.again $ render model.pbrt --spp 4 --resolution 32x24 -o model.again.pfm
        model.pfm == model.again.pfm
    """)
    test_mistakes = steps("""
        2 is read from $ convert full.pbrt full.pbrt
        2 is read from $ convert other/again.pbrt other/again.pbrt
        2 --layer: it is for pictures $ convert full.pbrt x.pbrt --layer mean
        2 --tone: it is for .png and .jpg $ convert full.pbrt x.pbrt --tone aces
        1 this is a PNG picture $ convert ok.png x.pbrt
        1 none/x.pbrt $ convert full.pbrt none/x.pbrt
        no x.pbrt **/.montelux*
    """)
    test_info_of_scenes = each("""
        0 shapes       1 triangle mesh & lights       1 uniform sky $ info full.pbrt
        0 "primitives": 1024 & "strategy": "mis" $ info full.pbrt --json
        0 1024 primitives $ info noname
        0 cameras      0 'front', 1 'plan' (--camera) & camera       perspective at 0 0 5 $ info two.gltf
        0 camera       perspective at 0 7 0 $ info two.gltf --camera plan
        1 there is no camera 'plam' (did you mean 'plan'?); expected 0 'front', 1 'plan' $ info two.gltf --camera plam
    """)

    def test_converted_model_gives_the_same_picture(self):
        text = self.expect(0, "its map is latitude-longitude, which pbrt-v4 refuses", "convert model.gltf whole.pbrt")
        self.assertEqual(text.count("warning"), 1)

    def test_info_of_textures(self):
        self.take("""
            0 texels $ bake environment square.pfm --size 8 --levels 3 -o t.ktx2 -o t.ktx -o t.dds
            0 KTX 2.0, 8 x 8 texels, 3 levels, 1 layer, 6 faces, R16G16B16A16_SFLOAT & montelux.roughness $ info t.ktx2
            0 KTX 1.1, 8 x 8 texels, 3 levels, 1 layer, 6 faces, GL_RGBA16F $ info t.ktx
            0 DDS, 8 x 8 texels, 3 levels, 1 layer, 6 faces,  $ info t.dds
            0 "faces": 6 $ info t.ktx2 --json
        """)
        write("cut.ktx2", read("t.ktx2")[:100])
        self.expect(1, "ends early", "info cut.ktx2")


class DenoiserMissing(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("long", f'{SKY} Shape "sphere"', 2000, 2000, 1000000)
        scene("ok", f'{SKY} Material "diffuse" Shape "sphere"', 32, 24, 4)
        cls.expect(0, "ok.exr", "render ok.pbrt")

    test_mistakes = each("""
        2 --output is required $ denoise ok.exr
        2 --threads $ denoise ok.exr -o x.exr --threads -1
        1 the extension '.gif' $ denoise ok.exr -o x.gif
        0 MONTELUX_OIDN_LIBRARY $ denoise --help
        0 --denoise $ render --help
    """)

    def test_error_comes_before_the_render(self):
        """The test would time out if the scene were rendered first."""
        write("text.so", "text\n")
        no_function = "this is not Open Image Denoise 1.4 or newer: it has no function oidnNewDevice"
        for library, text in ("no.so", "cannot be loaded"), ("text.so", "cannot be loaded"), ("libm.so.6", no_function):
            library = library if library == "libm.so.6" else os.path.abspath(library)
            self.expect(1, text, "denoise ok.exr -o x.exr", environment={"MONTELUX_OIDN_LIBRARY": library})
        library = os.path.abspath("no.so")
        self.expect(1, f"MONTELUX_OIDN_LIBRARY: Open Image Denoise cannot be loaded from '{library}'",
                    "render long.pbrt --denoise -o x.exr", environment={"MONTELUX_OIDN_LIBRARY": library})  # fmt: skip
        self.assert_absent("x.exr")


class Denoiser(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ok", f'{SKY} Material "diffuse" Shape "sphere"', 32, 24, 4)
        scene("long", f'{SKY} Shape "sphere"', 2000, 2000, 1000000)
        pfm("nan.pfm", 2, 1, NAN, 1, 1, 1, 1, 1)
        pfm("grey.pfm", 1, 1, 1, channels=1)
        cls.expect(0, "ok", "render ok.pbrt -o ok.exr -o ok.pfm")
        outcome = cls.outcome("denoise ok.exr -o denoised.exr --quiet")
        if outcome.code != 0:
            assert "pip install pyoidn" in outcome.text, outcome
            raise unittest.SkipTest(outcome.text)
        cls.expect(0, "denoised by Open Image Denoise & the error bars are those of the picture before denoising",
                   "render ok.pbrt --denoise -o both.exr -o both.pfm -o both.png")  # fmt: skip

    def rows(self, name, channels):
        """Lines of `info` on these channels."""
        return re.findall(rf"(?m)^(?:{channels}) .*", self.output(f"info {name}"))

    def test_file_has_the_layers_of_the_render_and_the_denoised_one(self):
        self.expect(0, '"denoiser" = "Open Image Denoise', "info both.exr")
        self.assertEqual(len(self.rows("both.exr", r"R|stderr\.R|albedo\.R|N\.X|denoised\.[RGB]")), 7)
        channels = r"R|G|B|stderr\.[RGB]|albedo\.[RGB]|N\.[XYZ]|samples"
        self.assertEqual(self.rows("both.exr", channels), self.rows("ok.exr", channels))

    # `denoise` gives the picture of `render --denoise`, for any number of threads.
    test_other_formats_show_the_denoised_picture = steps("""
        0 with albedo and normal $ denoise ok.exr -o later.pfm -o later.png -o later.exr --threads 1
        both.pfm == later.pfm
        both.png == later.png
        both.pfm != ok.pfm
    """)
    test_layer_is_compared_and_converted = steps("""
        0 RMSE & A  both.exr  (no standard errors) $ compare both.exr ok.exr --layer-a denoised
        1 there is no layer 'denoised' $ compare both.exr ok.exr --layer-b denoised
        0 $ convert both.exr layer.pfm --layer denoised
        layer.pfm == both.pfm
        0 $ convert both.exr raw.pfm --layer mean
        raw.pfm == ok.pfm
    """)
    test_pictures_of_other_channels = each("""
        0 without albedo and normal $ denoise ok.pfm -o bare.pfm
        0 1 pixels have a colour, albedo or normal that is not a number or infinite $ denoise nan.pfm -o filled.exr
        1 needs the channels R, G and B, but there are Y $ denoise grey.pfm -o x.exr
    """)

    def test_denoising_again_replaces_the_layers(self):
        self.expect(0, "twice.exr", "denoise ok.exr -o twice.exr")
        self.expect(0, "twice.exr", "denoise twice.exr -o twice.exr")
        self.expect(0, "32 x 24 pixels", "info twice.exr")
        self.assertEqual(len(self.rows("twice.exr", r"denoised\..")), 3)

    def test_interrupted_render_is_saved_without_denoising(self):
        job = self.start("render long.pbrt --denoise -o stopped.exr")
        self.assertIn("stopped before the end, not denoised", self.interrupted(job, works=1.5))
