"""Replayed samples: refused arguments, the printed record, and the option named by the message on bad samples."""

import re

from program import SKY, ProgramTest, read_pfm, scene

# A metal whose index of refraction overflows, so that its radiance is NaN.
METAL = ('Material "conductor" "spectrum eta" [300 1e30 900 1e30] "spectrum k" [300 1 900 1]'
         ' "float roughness" 0.3')  # fmt: skip
OPTION = r"(?m)--debug-sample [0-9,]*$"  # at the end of the message on bad samples
LEFT_OUT = "left out: it is not a number, first at vertex "
RECORDS = """
    2 --debug-sample: pixel 64,0: the film has columns 0 to 63 and rows 0 to 47 $ ok.pbrt --debug-sample 64,0,0
    2 pixel 0,48 $ ok.pbrt --debug-sample 0,48,0
    2 pixel -1,0 $ ok.pbrt --debug-sample -1,0,0
    2 sample 4: the pixel has 4 samples, counted from 0 $ ok.pbrt --debug-sample 0,0,4
    2 the crop of the film has columns 32 to 63 and rows 0 to 23 $ ok.pbrt --crop 0.5,1,0,0.5 --debug-sample 0,0,0
    0 sample 8 of 9 of pixel 32,24, sampler halton, seed 5, strategy light
      $ ok.pbrt --spp 9 --sampler halton --seed 5 --strategy light --debug-sample 32,24,8
    0 strategy mis-bsdf with the power heuristic $ ok.pbrt --strategy mis-bsdf --debug-sample 32,24,3
    0 to the term mis-light, which is left out $ lamp.pbrt --strategy mis-bsdf --debug-sample 32,24,0
    0 to the term mis-bsdf, which is left out $ ok.pbrt --strategy mis-light --debug-sample 0,0,0
    0 vertex 1: shape 0, a sphere, material 0 $ ok.pbrt --debug-sample 32,24,0
    0 coated diffuse $ ok.pbrt --debug-sample 32,24,0
    0 the path left the scene $ ok.pbrt --debug-sample 0,0,0
    0 --debug-sample renders no picture $ ok.pbrt --debug-sample 0,0,0 -o picture.exr
"""


class Replay(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ok", f'{SKY} Material "coateddiffuse" Shape "sphere"', 64, 48)
        scene("lamp", 'LightSource "point" "point3 from" [0 0 3] Shape "sphere"', 64, 48)

    def test_arguments(self):
        for value in "1,2", "1,2,3,4", "1,2,x", "1.5,2,3", "1,2,-3", "1,2,1e1", "", ",,", "99999999999,0,0":
            with self.subTest(value):
                self.expect(2, f"--debug-sample: '{value}' was given", "render ok.pbrt --debug-sample", value)

    def test_records(self):
        self.expect_each(RECORDS, "render ")
        text = self.expect(0, "the pixel gets", "render ok.pbrt --debug-sample 0,0,0 --quiet -o picture.exr")
        self.assertNotIn("warning", text)
        self.assert_absent("ok.exr", "picture.exr")

    def test_radiance_of_a_lamp_that_no_path_can_hit_has_a_density(self):
        """The lamp is not a point light."""
        scene("hidden", """AttributeBegin AreaLightSource "diffuse" "bool twosided" true Translate 0 0 3
    Shape "disk" "float alpha" 0 AttributeEnd Shape "sphere\"""", 64, 48)
        text = self.expect(0, "per steradian; weight 1", "render hidden.pbrt --strategy bsdf --debug-sample 32,20,0")
        self.assertNotIn("irradiance", text)

    def test_picture_of_one_sample_per_pixel_is_that_sample(self):
        self.quietly("render ok.pbrt --spp 1 --crop 0.5,0.51,0.5,0.51 -o one.pfm")
        text = self.expect(0, "", "render ok.pbrt --quiet --spp 1 --debug-sample 32,24,0")
        replayed = re.search(r"the pixel gets (.*)", text)[1].split()[:3]
        self.assertEqual([f"{float(v):.5g}" for v in replayed], [f"{v:.5g}" for v in read_pfm("one.pfm")[2][-3:]])

    def test_message_on_bad_samples_names_the_option_that_replays_one(self):
        scene("bad", f'{SKY} {METAL} Shape "sphere"')
        text = self.expect(0, "not a number, is sample", "render bad.pbrt")
        self.assertRegex(text, OPTION)
        self.expect(0, f"{LEFT_OUT}1, in the value of the BSDF", f"render bad.pbrt {re.search(OPTION, text)[0]}")

    def test_few_bad_samples_are_left_out_and_counted(self):
        """One sample in 1e5 hits the metal."""
        scene("rare", f"""{SKY} Material "diffuse" Shape "disk" "float radius" 9 "float height" -1
{METAL} Translate 0.6 0 0 Shape "sphere" "float radius" 0.006""", 64, 48, 200)
        text = self.expect(0, "samples were left out", "render rare.pbrt")
        count = int(re.search(r"warning: (\d+) samples were left out", text)[1])
        self.assertTrue(1 <= count <= 60, f"{count} of 614400")
        self.expect(0, LEFT_OUT, f"render rare.pbrt {re.search(OPTION, text)[0]}")
        info = self.expect(0, f'"badSamples" = {count}', "info rare.exr")
        rows = [line.split() for line in info.splitlines() if re.match("(R|G|B|stderr|samples)", line)]
        self.assertGreaterEqual(len(rows), 7, info)
        for row in rows:
            self.assertEqual(row[4], "0", f"values that are not a number: {info}")
