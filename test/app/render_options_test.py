"""Options of `render`: refused values, and effects on the picture."""

import os
import re

from program import SKY, ProgramTest, read_pfm, scene

REFUSED = {  # values of options
    "--resolution": ["0x0", "axb", "8", "8x", "8x8x8", "-8x8", "1e9x1", "99999x9", "8,8", ""],
    "--crop": ["0,1", "0,1,0,1,1", "a,b,c,d", "1,0,0,1", "0,0,0,0", "-1,1,0,1", "nan,1,0,1", "0,1,0,2", ""],
}
REFUSED |= dict.fromkeys(["--spp", "--seed", "--threads", "--max-depth"],
                         ["-1", "1.5", "1e-1", "1e30", "99999999999999999999", "0x10", "x", ""])  # fmt: skip
CHOICES = ("--sampler --integrator --strategy --heuristic --light-sampling --microfacet-scattering"
           " --shading-terminator").split()  # fmt: skip
MISTAKES = """
    2 SCENE is required $ render
    2 extra $ render ok.pbrt extra
    2 --nonsense $ render ok.pbrt --nonsense
    2 no pixel of the 64x48 film $ render ok.pbrt --crop 0.001,0.002,0,1
    2 --checkpoint-every requires --checkpoint $ render ok.pbrt --checkpoint-every 5
    2 --checkpoint: the name of a file is expected $ render ok.pbrt --checkpoint ''
    2 --spp: '0' was given; a whole number from 1 to $ render ok.pbrt --spp 0
    2 --threads: '5000' $ render ok.pbrt --threads 5000
    2 --rank-timeout: '1' was given; a time of at least 2s $ render ok.pbrt --rank-timeout 1
    2 path, bidirectional, light-tracing, metropolis, auto is expected $ render ok.pbrt --integrator bdpt
    1 leave out --adaptive or choose 'path' $ render ok.pbrt --integrator bidirectional --adaptive on
    1 cannot be replayed $ render ok.pbrt --integrator bidirectional --debug-sample 0,0,0
    2 --merging: '0' was given; off, auto or a radius above 0 $ render ok.pbrt --integrator bidirectional --merging 0
    2 expected --merging auto or a radius $ render ok.pbrt --integrator bidirectional --merging-memory 64
    1 only the integrator 'bidirectional' merges paths, not 'path' $ render ok.pbrt --merging auto
    2 mis, mis-bsdf, mis-light is expected $ render ok.pbrt --strategy mis_bsdf
    1 GiB of memory; this machine has $ render ok.pbrt --resolution 65536x65536
"""
CHANGES = [
    "--max-depth 1", "--spp 9", "--sampler halton", "--strategy bsdf", "--integrator bidirectional",
    "--integrator light-tracing", "--heuristic balance", "--light-sampling uniform",
]  # fmt: skip
HEADER = [
    '"spp" = 2', '"seed" = "18446744073709551615"', '"sampler" = "halton"', '"maxDepth" = 3',
    '"cropPixels" = [0.0,24.0,32.0,36.0]', '"fullResolution" = [64.0,48.0]', '"scene" = "ok.pbrt"', '"sceneHash" = "',
    '"software" = "Montelux ', '"renderSeconds" = ', '"worldToCamera" = [[', '"interrupted" = 0',
]  # fmt: skip


class OptionsTest(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ok", f"""{SKY} LightSource "point" "rgb I" [9 9 9] "point3 from" [2 2 3]
Material "coateddiffuse" Shape "sphere" Translate 1 0 0 Shape "sphere\"""", 64, 48, 8)


class Mistakes(OptionsTest):
    def tearDown(self):
        self.assert_absent("ok.exr")

    def test_values_out_of_range(self):
        for option, values in REFUSED.items():
            for value in values:
                with self.subTest(option, value=value):
                    self.expect(2, f"{option}: '{value}' was given", "render ok.pbrt", option, value)

    def test_unknown_choices(self):
        for option in CHOICES:
            with self.subTest(option):
                self.expect(2, f"{option}: 'foo' was given; one of", f"render ok.pbrt {option} foo")

    def test_mistakes(self):
        self.expect_each(MISTAKES)


class Effects(OptionsTest):
    def test_numbers_may_have_an_exponent(self):
        self.expect(0, "20 samples per pixel", "render ok.pbrt --resolution 8x6 --spp 2e1 --seed 1e3 -o twenty.pfm")

    def test_files_record_options(self):
        self.expect(0, "32 x 12 pixels, 2 samples per pixel", "render -o a.exr -o a.png -o a.hdr -o a.pfm ok.pbrt"
                    " --resolution 64x48 --spp 2 --seed 18446744073709551615 --sampler halton --crop 0,0.5,0.5,0.75"
                    " --max-depth 3")  # fmt: skip
        info = self.expect(0, "32 x 12 pixels, 20 channels", "info a.exr")
        for entry in HEADER:
            self.assertIn(entry, info)
        self.expect_each("""
            0 32 x 12 pixels, 3 channels, 8-bit integer, sRGB $ info a.png
            0 z-scores use the standard errors of B alone $ compare a.hdr a.exr
            0 z-scores with errors pooled over 3 x 3 pixels of $ compare a.hdr a.exr
            0 "z_pooled": { $ compare a.hdr a.exr --json
        """)

    def test_samplers(self):
        """The picture depends on the seed but not on threads; a crop equals that part of it."""
        for sampler in "independent", "stratified", "halton", "hammersley", "sobol", "sobol-blue-noise":
            with self.subTest(sampler):
                line = f"render ok.pbrt --sampler {sampler}"
                self.quietly(f"{line} --threads 1 -o one.pfm")
                self.quietly(f"{line} --threads 2 -o two.pfm")
                self.assert_same("one.pfm", "two.pfm")
                self.quietly(f"{line} --seed 1 -o seed.pfm")
                self.assert_differ("one.pfm", "seed.pfm")
                self.quietly(f"{line} --crop 0.25,0.75,0.5,1 -o crop.pfm")
                _, _, whole = read_pfm("one.pfm")
                rows = [whole[192 * row + 48:192 * row + 144] for row in range(24)]  # the lower half
                self.assertEqual(read_pfm("crop.pfm"), (32, 24, sum(rows, ())))

    def test_options_change_the_picture(self):
        self.quietly("render ok.pbrt -o plain.pfm")
        for change in CHANGES:
            with self.subTest(change):
                self.quietly(f"render ok.pbrt -o other.pfm {change}")
                self.assert_differ("plain.pfm", "other.pfm")

    def test_statistics_and_memory(self):
        self.expect(0, "inside Embree", "render ok.pbrt --stats")
        self.expect(0, "peak of the process", "render ok.pbrt --memory")


class IntegratorChosenByPilot(OptionsTest):
    @classmethod
    def prepare(cls):
        super().prepare()
        scene("shaded", """LightSource "point" "rgb I" [9 9 9] "point3 from" [0 0 2]
AttributeBegin Material "dielectric" Translate 0 0 2 Shape "sphere" "float radius" 0.3 AttributeEnd
Material "diffuse" Shape "bilinearmesh" "point3 P" [-5 -5 -1  5 -5 -1  -5 5 -1  5 5 -1]""", 64, 48)

    def test_picture_is_that_of_the_chosen_integrator(self):
        for line, kind in [("render ok.pbrt --spp 256", "path"),
                           ("render shaded.pbrt --resolution 32x24 --target-error 25%", "bidirectional")]:  # fmt: skip
            with self.subTest(line):
                text = self.expect(0, f"montelux: integrator {kind}: to the same error ",
                                   f"{line} --integrator auto -o chosen.exr -o chosen.pfm")  # fmt: skip
                if "target" in line:
                    self.assertIn("about ", text)
                info = self.expect(0, f'"integratorChoice" = "{kind}: to the same error ', "info chosen.exr")
                self.assertIn(f'"integrator" = "{kind}"', info)
                self.expect(0, "", f"{line} --integrator {kind} --quiet -o by_name.pfm")
                self.assert_same("by_name.pfm", "chosen.pfm")

    def test_path_tracing_is_not_chosen_where_it_lacks_light(self):
        """A lamp in a bulb of glass beside a bare one."""
        scene("bulb", """LightSource "point" "rgb I" [20 20 20] "point3 from" [2 4 1]
LightSource "point" "rgb I" [3 3 3] "point3 from" [0 0 0.8] Material "diffuse" Shape "disk" "float radius" 20
Material "dielectric" Translate 0 0 0.8 Shape "sphere" "float radius" 0.3""", 32, 24)
        line = "render bulb.pbrt --target-error 10% -o bulb.exr"
        self.expect(3, "target missed: light is missing & path tracing cannot find light of the point light", line)
        self.expect(0, "integrator bidirectional: path tracing would lack & target reached",
                    line + " --integrator auto")  # fmt: skip

    def test_refusals(self):
        self.expect_each("""
            0 the render is too short to try bidirectional and metropolis $ --spp 4
            0 not a candidate: integrator bidirectional: its light paths reach all pixels $ --spp 64 --adaptive on
            1 all slices of a picture must be rendered by the same integrator $ --spp 64 --slice 1/2
            1 choose path, bidirectional or metropolis $ --debug-sample 0,0,0
        """, "render ok.pbrt --integrator auto -o refused.exr ")

    def test_resumed_render_keeps_the_integrator(self):
        self.expect(0, "montelux: integrator bidirectional: to the same error ",
                    "render shaded.pbrt --spp 256 --integrator auto --checkpoint chosen.ckpt -o part.pfm")  # fmt: skip
        self.quietly("render shaded.pbrt --spp 256 --integrator bidirectional -o by_name.pfm")
        self.assert_same("by_name.pfm", "part.pfm")
        self.expect(0, "272 samples per pixel",
                    "render shaded.pbrt --spp 272 --integrator auto --checkpoint chosen.ckpt --resume -o resumed.exr")
        info = self.expect(0, '"integratorChoice" = "bidirectional: ', "info resumed.exr")
        self.assertIn('"integrator" = "bidirectional"', info)


class Surfaces(ProgramTest):
    """Options of surfaces: each has its effect, and the defaults have none."""

    MULTIPLE, SOFT = "--microfacet-scattering multiple", "--shading-terminator soft"

    @classmethod
    def prepare(cls):
        scene("rough", """LightSource "distant" "point3 from" [3 1 -0.3]
Material "conductor" "float roughness" 0.5 Translate -0.9 0 0 Shape "sphere" "float radius" 0.7
Material "diffuse" Translate 1.7 0 0
Shape "trianglemesh" "point3 P" [-0.7 -0.7 0  0.7 -0.7 0  0 0.7 0] "integer indices" [0 1 2]
    "normal N" [-0.9 -0.2 0.2  0.9 -0.2 0.2  0 0.9 0.2]""", 64, 48, 8)

    def test_effects(self):
        self.quietly("render rough.pbrt -o one.pfm")
        self.quietly("render rough.pbrt -o two.pfm --microfacet-scattering single --shading-terminator hard")
        self.assert_same("one.pfm", "two.pfm")
        for change in self.MULTIPLE, self.SOFT:
            self.quietly(f"render rough.pbrt -o two.pfm {change}")
            self.assert_differ("one.pfm", "two.pfm", change)

    def test_header_and_checkpoint_record_them(self):
        self.quietly(f"render rough.pbrt -o two.exr --checkpoint two.ckpt {self.MULTIPLE} {self.SOFT}")
        info = self.expect(0, '"microfacetScattering" = "multiple"', "info two.exr")
        self.assertIn('"shadingTerminator" = "soft"', info)
        resume = f"render rough.pbrt --spp 16 -o two.exr --checkpoint two.ckpt --resume {self.MULTIPLE}"
        self.expect(1, "the integrator differs", resume)
        self.expect(0, "16 samples per pixel", f"{resume} {self.SOFT}")


class TextureMemory(OptionsTest):
    """Textures in a temporary file: pictures, scene hash and checkpoints are unchanged for any number of threads."""

    @classmethod
    def prepare(cls):
        super().prepare()
        cls.quietly("render ok.pbrt -o map.exr -o map.png --resolution 300x200")
        spheres = [
            f"""Texture "{filter} {file}" "spectrum" "imagemap" "string filename" "{file}" "string filter" "{filter}"
Material "diffuse" "texture reflectance" "{filter} {file}" Translate 0.4 0 0.1 Shape "sphere\""""
            for filter in ("point", "bilinear", "trilinear", "ewa") for file in ("map.png", "map.exr")]  # fmt: skip
        scene("textured", "\n".join([SKY, *spheres]), 64, 48, 8)

    def test_sizes(self):
        for value in "1M", "15.9M", "500", "M", "-20M", "20MB", "20m", "nanG", "", "1e":
            with self.subTest(value):
                self.expect(2, f"--texture-memory: '{value}' was given; a size from 16M on is expected",
                            "render ok.pbrt --texture-memory", value)  # fmt: skip

    def test_picture_and_hash_stay_and_no_file_is_left(self):
        os.mkdir("temporary")
        self.quietly("render textured.pbrt -o one.pfm -o one.exr --threads 1")
        for threads in 1, 3:
            self.quietly(f"render textured.pbrt -o two.pfm -o two.exr --threads {threads} --texture-memory 16M",
                         environment={"TMPDIR": os.path.abspath("temporary")})  # fmt: skip
            self.assert_same("one.pfm", "two.pfm", f"{threads} threads")
        self.assertEqual(os.listdir("temporary"), [])
        one, two = (re.search('.*"sceneHash".*', self.output(f"info {name}.exr"))[0] for name in ("one", "two"))
        self.assertEqual(one, two)

    def test_checkpoint_is_resumed_without_it(self):
        self.quietly("render textured.pbrt -o one.exr --checkpoint textured.ckpt --texture-memory 1.5G")
        self.expect(0, "16 samples per pixel", "render textured.pbrt --spp 16 -o one.exr --checkpoint textured.ckpt"
                    " --resume")  # fmt: skip

    def test_memory_report_names_the_temporary_file(self):
        text = self.expect(0, "MiB in a temporary file", "render textured.pbrt --memory --texture-memory 0.5G")
        self.assertIn("2 images, ", text)

    def test_folder_that_is_missing(self):
        self.expect(1, "set TMPDIR to another folder", "render textured.pbrt --texture-memory 16M",
                    environment={"TMPDIR": os.path.abspath("missing")})  # fmt: skip
