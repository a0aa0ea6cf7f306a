"""Parts of a picture: crops keep their place, layers are chosen by name, slices are merged to the whole."""

import os
import re

from program import SKY, ProgramTest, each, edited, scene, steps


class Crops(ProgramTest):
    """Crops, whose place in EXR files is used by compare, merge and resumed renders."""

    RENDER = "render ball.pbrt --sampler independent --quiet"
    CROP = f"{RENDER} --crop 0.25,0.75,0.5,1"
    BOTH = "32 x 24 pixels that both pictures have (columns 16 to 47, rows 24 to 47), 768 compared & RMSE 0, relMSE 0 "

    @classmethod
    def prepare(cls):
        scene("ball", f'{SKY} Material "diffuse" Shape "sphere"', 64, 48, 16)
        cls.take(f"""
            0 $ {cls.RENDER} -o whole.exr -o whole.pfm
            0 $ {cls.CROP} -o crop.exr -o crop.png -o crop.pfm
            0 $ {cls.RENDER} --crop 0,0.25,0,0.25 -o far.exr
        """)

    test_file_says_its_place = steps("""
        0 crop.exr: 32 x 24 pixels & "dataWindow.x" = 16 & "dataWindow.y" = 24
          & "displayWindow.width" = 64 & "displayWindow.height" = 48 $ info crop.exr
    """)
    test_pixels_are_those_of_the_whole = steps(f"""
        0 {BOTH} $ compare crop.exr whole.exr
        0 {BOTH} $ compare whole.exr crop.exr
        0 {BOTH} $ compare crop.exr whole.pfm
        0 $ {RENDER} --crop 0.5,1,0.25,0.75 -o other.exr
        0 16 x 12 pixels that both pictures have (columns 32 to 47, rows 24 to 35), 192 compared & RMSE 0, relMSE 0
          $ compare crop.exr other.exr
        # PFM keeps no place.
        1 64 x 48 $ compare crop.pfm whole.exr
        0 768 compared $ compare crop.pfm crop.exr
        1 they have no pixel in common $ compare crop.exr far.exr
    """)
    test_errors_in_a_file_of_their_own_have_the_size_of_their_picture = steps("""
        0 that both pictures have (columns 16 $ compare crop.exr whole.exr --stderr-b whole.pfm --difference d.png
        0 d.png: 32 x 24 pixels $ info d.png
    """)
    test_slices_of_a_crop = steps(f"""
        0 $ {CROP} --slice 1/2 -o part1.exr
        0 $ {CROP} --slice 2/2 -o part2.exr
        0 $ merge part1.exr part2.exr -o joined.exr
        0 "displayWindow.width" = 64 $ info joined.exr
        0 that both pictures have (columns 16 to 47, rows 24 to 47) $ compare joined.exr whole.exr
        1 another render $ merge part1.exr far.exr -o x.exr
    """)
    test_resumed_crop = steps(f"""
        0 $ {CROP} --spp 8 --checkpoint state -o half.exr
        1 the film differs $ {RENDER} --crop 0.5,1,0.25,0.75 --resume --checkpoint state -o x.exr
        0 $ {CROP} --checkpoint state --resume -o resumed.exr
        resumed.exr ~ whole.exr
    """)

    def test_whole_picture_has_no_crop_window(self):
        self.assertNotRegex(self.output("info whole.exr"), "(data|display)Window")
        result = self.json("compare crop.exr whole.exr")
        self.assertEqual((result["width"], result["height"], result["window"]), (32, 24, [16, 24, 48, 48]))


class Layers(ProgramTest):
    RENDER = "render ball.pbrt --quiet"

    @classmethod
    def prepare(cls):
        scene("ball", f"""{SKY} Attribute "light" "string group" "lamp"
LightSource "point" "rgb I" [9 9 9] "point3 from" [2 2 3]
MakeNamedMaterial "gold" "string type" "conductor" "float roughness" 0.3 NamedMaterial "gold"
Shape "sphere" "string name" "globe\"""", 32, 24, 16)
        edited("ball.pbrt", "fp16.pbrt", ('Film "rgb"', 'Film "rgb" "bool savefp16" true'))
        edited("ball.pbrt", "bright.pbrt", (r'"rgb I" \[9 9 9\]', '"rgb I" [9e9 9e9 9e9]'))
        edited("ball.pbrt", "gbuffer.pbrt", ('Film "rgb"', 'Film "gbuffer"'))

    test_mistakes = steps("""
        2 no layer 'positon' (did you mean 'position'?); expected a list of default $ render ball.pbrt --layers positon
        2 --layer-space: 'object' was given; world or camera is expected $ render ball.pbrt --layer-space object
        2 --light-groups: 'all' was given; light or kind is expected $ render ball.pbrt --light-groups all
        2 add --layers default $ render ball.pbrt --layers uv --slice 1/2
        no ball.exr
    """)
    test_layers_do_not_change_the_mean = steps(f"""
        0 $ {RENDER} -o default.exr
        0 32 x 24 pixels, 20 channels $ info default.exr
        0 $ {RENDER} --layers mean -o mean.exr -o mean.pfm
        0 32 x 24 pixels, 3 channels & "layers" = "mean" $ info mean.exr
        0 $ {RENDER} --layers default,variance,relative-variance,geometric-normal,position,uv,depth-slopes,motion,\
alpha,direct,indirect,light-groups,shape,material --layer-space camera -o all.exr -o all.pfm -o all.png
        0 P.X & uv.U & dzdx & motion.Y & light.lamp.G & light.uniform-sky-0.R & direct.R & relativeVariance.B
          & CryptoShape02.A & "layerSpace" = "camera" & globe & gold & MurmurHash3_32 $ info all.exr
        0 3 channels, 8-bit $ info all.png
        mean.pfm == all.pfm
        all.exr ~ default.exr
    """)
    test_halfs_are_rounded = steps(f"""
        0 $ {RENDER} --layers default,position,shape --half -o half.exr
        0 $ {RENDER} --layers default,position,shape -o full.exr
        0 RMSE $ compare half.exr full.exr
        0 $ {RENDER} --layers mean --half -o half_mean.exr
        0 16-bit float $ info half_mean.exr
        0 $ {RENDER} --layers mean --no-half -o full_mean.exr
        0 32-bit float $ info full_mean.exr
        0 $ render fp16.pbrt --layers mean -o fp16.exr
        0 16-bit float $ info fp16.exr
        0 $ render fp16.pbrt --layers mean --no-half -o wide.exr
        0 32-bit float $ info wide.exr
        0 values beyond the range of 16-bit floats became 65504 $ render bright.pbrt --layers mean --half -o bright.exr
    """)
    # The default is camera space.
    test_film_of_pbrt_has_layers = steps("""
        0 $ render gbuffer.pbrt -o g.exr
        0 P.Z & Ng.X & dzdy & uv.V & variance.G & "layerSpace" = "camera" $ info g.exr
        2 add --layers default $ render gbuffer.pbrt --slice 1/2
        0 $ render gbuffer.pbrt --layers default --slice 1/2 -o slice.exr
        0 $ render gbuffer.pbrt --crop 0.25,0.75,0.5,1 -o c.exr
        0 16 x 12 pixels that both pictures have (columns 8 to 23, rows 12 to 23), 192 compared & RMSE 0, relMSE 0
          $ compare c.exr g.exr
    """)

    def test_half_precision_makes_files_smaller(self):
        self.quietly("render ball.pbrt --layers default,position,shape --half -o small.exr")
        self.quietly("render ball.pbrt --layers default,position,shape -o large.exr")
        self.assertLess(os.path.getsize("small.exr"), 0.75 * os.path.getsize("large.exr"))

    def test_standard_layers_are_not_named(self):
        self.quietly("render ball.pbrt --layers default -o standard.exr")
        self.assertNotIn('"layers"', self.output("info standard.exr"))

    def test_checkpoints_keep_the_sums_of_layers(self):
        self.take(f"""
            0 $ {self.RENDER} --layers uv --spp 8 --checkpoint state -o x.exr
            1 the layers of the film (--layers) differ $ render ball.pbrt --checkpoint state --resume -o x.exr
            0 $ {self.RENDER} --layers uv --checkpoint state --resume -o resumed.exr
            0 $ {self.RENDER} --layers uv -o whole.exr
        """)
        resumed, whole = (re.findall("(?m)^ *uv.*", self.output(f"info {name}.exr")) for name in ("resumed", "whole"))
        self.assertTrue(whole)
        self.assertEqual(resumed, whole)


class Slices(ProgramTest):
    RENDER = "render ball.pbrt --spp 48 --sampler"

    @classmethod
    def prepare(cls):
        scene("ball", f'{SKY} Material "diffuse" Shape "sphere"', 16, 12)
        cls.slices("s", f"{cls.RENDER} sobol")

    @classmethod
    def slices(cls, name, line, n=3):
        """Names of n slices."""
        names = [f"{name}{k}.exr" for k in range(1, n + 1)]
        for k, file in enumerate(names, 1):
            cls.expect(0, "samples per pixel", f"{line} --slice {k}/{n} -o {file}")
        return names

    def test_merged_slices_equal_the_whole(self):
        for sampler in "independent", "sobol":
            self.expect(0, "", f"{self.RENDER} {sampler} -o whole.exr")
            one, two, three = self.slices("part", f"{self.RENDER} {sampler}")
            self.expect(0, "of 3 slices, 48 samples per pixel", "merge -o joined.exr -o joined.png", two, one, three)
            self.assertLess(self.json("compare joined.exr whole.exr")["rmse"], 1e-6, sampler)

    def roughness(self, name):
        """Least, mean and largest value of two layers."""
        rows = re.findall(r"(?m)^(?:outlier|warning)\s+(\S+)\s+(\S+)\s+(\S+)", self.output(f"info {name}"))
        return [float(value) for row in rows for value in row]

    def test_fireflies_are_found_from_the_replicates_of_all_slices(self):
        """Slices of one replicate each are included."""
        scene("lamp", f"""{SKY} Material "diffuse" Shape "sphere" AttributeBegin
AreaLightSource "diffuse" "rgb L" [500 500 500]
Translate 1.1 0.6 0 Shape "sphere" "float radius" 0.008 AttributeEnd""", 16, 12)
        line = "render lamp.pbrt --sampler halton"
        few = self.expect(0, "error bars         checked in 0 % of the pixels", f"{line} --spp 255 --stats -o few.exr")
        self.assertNotIn("fireflies", few)
        self.expect(0, "are fireflies", f"{line} --spp 256 -o lamp.exr")
        wanted = self.roughness("lamp.exr")
        self.assertEqual(len(wanted), 6)
        for n in 3, 16:
            names = self.slices(f"lamp{n}-", f"{line} --spp 256", n)
            self.expect(0, f"of {n} slices & are fireflies", "merge -o joined.exr", *names)
            for value, exact in zip(self.roughness("joined.exr"), wanted, strict=True):
                self.assert_near(value, exact, 1e-4, f"{n} slices")

    def test_clamped_light_is_reported_as_for_the_whole(self):
        text = self.expect(0, "samples were clamped, which removed", f"{self.RENDER} independent --clamp 0.5 -o c.exr")
        (clamped,) = (line for line in text.splitlines() if "clamped" in line)
        self.expect(0, clamped, "merge -o joined.exr", *self.slices("c", f"{self.RENDER} independent --clamp 0.5"))
        self.expect(0, "clampedLuminance", "info joined.exr")

    test_slices_that_are_missing_or_do_not_fit = steps(f"""
        0 samples per pixel $ render ball.pbrt --spp 32 --sampler sobol --slice 16/16 -o sixteenth.exr
        0 samples per pixel $ {RENDER} sobol --slice 1/3 -o copy.exr
        0 samples per pixel $ {RENDER} sobol --slice 2/3 --seed 5 -o other.exr
        0 samples per pixel $ {RENDER} sobol --slice 1/4 -o quarter.exr
        0 without slice 2: the picture is right $ merge s1.exr s3.exr -o two.exr
        0 without slices 2, 3: the picture is right & of 1 slice,  $ merge s1.exr -o one.exr -o one.png
        1 s1.exr: it is given twice $ merge s1.exr s1.exr -o x.exr
        1 copy.exr: it is slice 1, as s1.exr is $ merge s1.exr copy.exr -o x.exr
        1 other.exr: it is of another render than s1.exr $ merge s1.exr other.exr -o x.exr
        1 quarter.exr: it is one of 4 slices, but s2.exr is one of 3 $ merge s2.exr quarter.exr -o x.exr
        1 an EXR file that montelux render --slice wrote is expected $ merge one.png -o x.exr
        1 missing.exr $ merge s1.exr missing.exr -o x.exr
        2 it is one of the slices $ merge s1.exr s2.exr -o s1.exr
        no x.exr
    """)
    test_mistakes = each("""
        2 K/N is expected $ --slice 4/3 -o x.exr
        2 slices share a number of samples $ --slice 1/3 --target-error 0.1 -o x.exr
        2 --slice: there are fewer replicates than slices $ --spp 2 --slice 3/3 -o x.exr
        2 --slice: there are fewer replicates than slices $ --spp 2 --slice 3/3 --debug-sample 1,1,0
    """, "render ball.pbrt ")
