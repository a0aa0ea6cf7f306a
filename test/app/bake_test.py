"""Baking: files, options, messages and unusual maps; no partial files are left."""

import os
import resource
import shutil
import signal

from program import INFINITE, NAN, ProgramTest, pfm, read

TEXELS = [1, 0.5, 2, 1, 1, 1, 2, 0.5, 1, 0, 0.5, 1]
BAKES = """
    # The table: half of 1/255, and 2^-12 of it.
    0 table.exr: 32 x 32 texels, error below $ brdf -o table.exr -o table.png -o table.ktx2 --size 32
    0 table.png: 32 x 32 texels, error below 0.002, $ brdf -o table.png --size 32
    0 table.ktx2: 32 x 32 texels, error below 0.00026, $ brdf -o table.ktx2 --size 32
    0 "largest_error_bound" $ brdf -o f.exr --size 8 --terms bias-sum --first-row rough --blue sheen --json
    2 has no channel B $ brdf -o x.ktx2 --size 8 --blue sheen
    0 x.ktx2 $ brdf -o x.ktx2 --size 8 --blue sheen --format rgba16f
    2 --size $ brdf -o x.exr --size 0
    2 --output is required $ brdf
    1 the extension '.gif' $ brdf -o x.gif
    1 the extension '.dds' is not one of .exr, .ktx2, .pfm, .hdr, .png $ brdf -o brdf.dds
    2 bake $
    0 environment $ --help
    0 --target-error $ environment --help
    # Skies
    0 "sun_illuminance": 0.0 $ sky --elevation -3 -o dusk.pfm --size 16 --json
    2 --elevation $ sky --elevation 91 -o x.exr
    2 --elevation: 'nan' was given; a number from $ sky --elevation nan -o x.exr
    2 --turbidity $ sky --turbidity 0 -o x.exr
    2 an even number $ sky --size 63 -o x.exr
    2 --output is required $ sky
    2 '0' was given; a number above 0 is expected $ sky -o x.exr --scale 0
    2 becomes too large for a float $ sky --size 16 --scale 1e300 -o x.exr
    2 becomes too small for a float $ sky --size 16 --scale 1e-300 -o x.exr
    0 texels $ sky --size 16 --scale 1e-20 -o x.exr
    # The report
    0 split - full $ report sky.pfm --roughness 0.3,1 --n-dot-v 0.5 --orientations 4 -o r.exr --sphere-size 8
    0 "bias_error" $ report sky.pfm --roughness 0.5 --orientations 2 --json
    2 --roughness $ report sky.pfm --roughness 0
    2 --roughness: 'nan' was given $ report sky.pfm --roughness 0.5,nan
    2 --seed: '-1' was given $ report sky.pfm --seed -1
"""
ENVIRONMENTS = """
    0 "missed": 0 $ --size 4 -o b.exr --json
    # the harmonics
    0 "polynomial" $ --size 4 -o b.exr --json
    0 texels $ --size 4 --levels 1 -o rgbm.ktx2 --format rgbm8 --rgbm-range 7
    0 do not include their bias $ --size 4 -o x.exr --sampling lobe --source-mips --samples 64
    0 0.4 $ --size 4 -o x.exr --roughness 0.4,0.8
    0 texels $ --size 4 --levels 2 -o both.exr -o both.pfm --roughness 0.5,1
    2 nothing to bake $
    2 --seed: '-1' was given; a whole number is expected $ -o x.exr --seed -1
    2 --exposure: 'nan' was given; a number from -100 to 100 $ -o x.png --exposure nan
    2 --turn: '1e300' was given; a number from -360 to 360 $ -o x.exr --turn 1e300
    2 --dark-floor: 'nan' was given $ -o x.exr --dark-floor nan
    2 '-1' was given; a number that is not negative $ -o x.exr --dark-floor -1
    2 they are of --format rgbm8 $ -o x.ktx2 --rgbm-range 7
    2 they are of --format rgbm8 $ -o x.ktx2 --rgbm-power 2
    2 --irradiance-size requires --irradiance $ -o x.exr --irradiance-size 8
    1 '.xyz' is not one of .ktx2, .ktx, .dds, .exr, .hdr, .pfm, .png $ -o q.xyz
    2 does not go with $ -o x.exr --samples 10 --target-error 0.1
    2 '2' was given; a number above 0 and below 1 is expected $ -o x.exr --target-error 2
    2 needs --sampling lobe $ -o x.exr --source-mips
    2 expected linear, filament, babylon, or numbers $ -o x.exr --roughness 0,2
    2 do not go together $ -o x.exr --roughness 0,1 --levels 3
    2 at most 3 levels $ -o x.exr --size 4 --levels 4
    2 does not go into this kind of file $ -o x.dds --format rgbm8
    2 spherical harmonics go into $ --harmonics x.exr
    3 texels exceed the target error $ --size 4 --roughness 0.5 -o x.exr --target-error 1e-5 --samples-max 64
    1 no-folder $ -o no-folder/x.exr
    1 an equal-area map is square; this picture has 4 x 2 pixels $ -o x.exr --map equal-area
    # No two outputs share a name.
    2 w.ktx2: two outputs have the same name $ --size 4 -o w.ktx2 --irradiance ./w.ktx2
    2 two outputs have the same name $ --size 4 --levels 1 -o w.exr --preview w.exr
    2 w_m1.exr: two outputs $ --size 4 --levels 2 -o w.exr --irradiance w_m1.exr
"""
ODD_MAPS = """
    0 equal-area map of 1 x 1 texels $ one.pfm --size 2 -o x.exr --roughness 0.5
    0 not twice as wide as high $ tall.pfm --size 2 -o x.exr --roughness 0.5
    0 3 samples became 0 (1 not a number, 1 infinite, 1 negative) $ bad.pfm --size 2 -o x.exr --roughness 0.5
    0 0 % $ black.pfm --size 4 -o x.exr --irradiance y.exr --roughness 0,0.5
    1 missing.hdr $ missing.hdr -o x.exr
    # Texels too large for sums are refused, and large ones have finite results.
    1 large.pfm: environment map: a sample is 3 $ large.pfm --size 2 -o x.exr --roughness 0.5
    1 a sample is 1 $ very.pfm --size 2 -o x.exr --roughness 0,0.5
"""


class Bake(ProgramTest):
    @classmethod
    def prepare(cls):
        pfm("sky.pfm", 4, 2, *TEXELS)

    def environment(self, options, code=0, text="texels"):
        return self.expect(code, text, f"bake environment sky.pfm {options}")

    def test_tables_skies_and_reports(self):
        self.expect_each(BAKES, "bake ")
        self.expect(0, "error.G", "info table.exr")
        self.expect(0, "32 x 32 pixels", "info table.png")
        self.expect(0, "16 x 24 pixels", "info r.exr")

    def test_error_bounds_include_the_rounding_of_texels(self):
        def bound(texels):
            return self.json(f"bake brdf --size 8 -o b.ktx2 --format {texels}")["files"][0]["largest_error_bound"]

        for half, single in ("rg16f", "rg32f"), ("rgba16f", "rgba32f"):
            self.assert_near(bound(half) - bound(single), 2**-12 - 2**-25, 1e-9, half)

    def test_sky(self):
        line = "bake sky --elevation 20 --turbidity 3 --size 64"
        self.expect(0, "level ground gets", f"{line} -o clear.exr -o clear.hdr -o clear.pfm")
        self.expect(0, "64 x 32 pixels", "info clear.exr")
        self.expect(0, "level ground", f"{line} -o bare.pfm --no-sun")
        self.assert_differ("clear.pfm", "bare.pfm")
        self.expect(0, "level ground", f"{line} -o again.pfm --threads 1")
        self.assert_same("clear.pfm", "again.pfm", "the number of threads changes the sky")
        self.expect(0, "texels", "bake environment clear.exr --size 8 --levels 2 -o clear.ktx2")

    def test_environments(self):
        self.expect_each(ENVIRONMENTS, "bake environment sky.pfm ")
        for part in "brdf", "sky", "report sky.pfm":
            self.expect(2, "two outputs have the same name", f"bake {part} -o w.exr -o w.exr")
        same = "--harmonics w.txt --harmonics " + os.path.abspath("w.txt")
        self.environment(same, 2, "two outputs have the same name")
        self.assert_absent("w.*", "w_*")

    def test_chain_in_all_kinds_of_files(self):
        self.environment("--size 8 --levels 3 -o a.ktx2 -o a.ktx -o a.dds -o a.exr -o a.png --preview sheet.png"
                         " --irradiance i.exr --irradiance-size 4 --harmonics sh.json --harmonics sh.txt",
                         text="equirectangular map of 4 x 2 texels")  # fmt: skip
        for file in ("a.ktx2 a.ktx a.dds a_m0.exr a_m1.exr a_m2.exr a_m0.png a_m2.png sheet.png i.exr sh.json"
                     " sh.txt").split():  # fmt: skip
            self.assertGreater(os.path.getsize(file), 0, file)
        self.expect(0, "stderr.R", "info a_m1.exr")
        self.expect(0, "32 x 24 pixels", "info a_m0.exr")
        self.environment("--size 4 -o strip.exr --layout vertical --target-error 2%")
        self.expect(0, "4 x 24 pixels", "info strip.exr")
        self.environment("--size 4 --levels 2 -o f.exr --layout faces")
        self.assertGreater(os.path.getsize("f_m1_nz.exr"), 0)
        self.quietly("bake environment sky.pfm --size 4 -o q.exr")

    def test_results_do_not_depend_on_the_number_of_threads(self):
        line = "--size 8 --levels 3"
        self.environment(f"{line} -o t1.pfm --threads 1")
        self.environment(f"{line} -o t3.pfm --threads 3")
        self.assert_same("t1_m1.pfm", "t3_m1.pfm")
        for change in "--up z", "--mirror", "--turn 40":
            self.environment(f"{line} -o other.pfm {change}")
            self.assert_differ("t1_m1.pfm", "other_m1.pfm", change)

    def test_unusual_maps(self):
        pfm("one.pfm", 1, 1, 1, 0.5, 2)
        pfm("tall.pfm", 1, 3, 1, 1, 1, 0.5, 0.5, 0.5, 1, 1, 1)
        pfm("bad.pfm", 2, 1, -1, NAN, INFINITE, 1, 1, 1)
        pfm("black.pfm", 2, 1, 0)
        pfm("large.pfm", 2, 1, 1, 1, 1, 3e38, 1, 1)
        pfm("very.pfm", 2, 1, 1, 1e38, 1, 1, 1, 1)
        self.expect_each(ODD_MAPS, "bake environment ")
        self.expect(1, "is expected, so that sums are finite", "bake report large.pfm --roughness 0.5 --orientations 2")

    def test_input_map_is_not_overwritten(self):
        for name in "map.pfm", "map_m1.pfm":
            shutil.copy("sky.pfm", name)
        os.symlink("map.pfm", "link.pfm")
        os.link("map.pfm", "hard.pfm")
        for name in "map.pfm", "./map.pfm", "link.pfm", "hard.pfm":
            self.expect_each(f"""
                2 this file is read; what is written needs another name
                  $ environment map.pfm --size 2 --levels 1 -o {name}
                2 this file is read $ environment map.pfm --size 2 --irradiance {name}
                2 this file is read $ environment map.pfm --size 2 -o x.ktx2 --preview {name}
                2 this file is read $ report map.pfm --roughness 0.5 --orientations 2 -o {name}
            """, "bake ")
        self.expect(2, "map_m1.pfm: this file is read", "bake environment map_m1.pfm --size 4 --levels 2 -o map.pfm")
        for name in "map.pfm", "map_m1.pfm":
            self.assert_same(name, "sky.pfm")

    def test_one_unwritable_output_leaves_the_others(self):
        def small_disk():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        self.expect(1, "montelux: error: lost.exr: cannot be written: writing: File too large",
                    "bake environment sky.pfm --size 64 --levels 1 --roughness 1 --samples 2 -o lost.exr --harmonics"
                    " kept.json", preexec_fn=small_disk)  # fmt: skip
        self.assert_absent("lost.exr")
        self.assertTrue(read("kept.json"))

    def test_interruption_writes_nothing(self):
        job = self.start("bake environment sky.pfm --size 1024 -o stopped.exr --target-error 1e-4")
        self.assertIn("interrupted, nothing was written", self.interrupted(job))
        self.assert_absent(".*", "*stopped*")
