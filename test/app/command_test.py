"""Commands of the program: help, completion, manual pages, and info, compare and formats of pictures."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from program import INFINITE, NAN, PROGRAM, SKY, ProgramTest, has_command, pfm, scene, write

MISTAKES = """
    2 a command is expected: integrate, sample, render, view, merge, compare, denoise, bake, convert, info, formats,\
 completion, manual
      $ 
    2 there is no command 'rendr' (did you mean 'render'?) $ rendr
    2 there is no command 'rendr' $ manual rendr
    2 tcsh not in {bash,zsh,fish} $ completion tcsh
    2 there is no bake command 'skye' (did you mean 'sky'?); expected one of environment $ bake skye
    2 a bake command is expected: environment, brdf, report, sky $ bake
    2 there is no option '--speed' (did you mean '--seed'?) $ render x.pbrt --speed 3
    2 there is no option '--speed' (did you mean '--seed'?) $ render --speed=3 x.pbrt
    2 there is no option '-z' $ info -z a.pfm
    2 'b.pfm' is not expected $ info a.pfm b.pfm c.pfm
    2 --nonsense $ --nonsense
    2 --nonsense $ info --nonsense a.pfm
    2 Run 'montelux info --help' $ info
    1 montelux: error: none.exr: cannot be opened $ info none.exr
    1 it is a folder $ info .
    1 montelux: error: text.png: is not a picture $ info text.png
    2 a formats command is expected: pbrt, gltf, mitsuba $ formats
    2 there is no formats command 'pbr' (did you mean 'pbrt'?); expected one of pbrt, gltf, mitsuba $ formats pbr
    2 required $ compare a.pfm
    2 'nan' was given; a number from 0 to 99.999 is expected $ compare a.pfm b.pfm --set-aside nan
    2 set-aside $ compare a.pfm b.pfm --set-aside 100
    1 standard errors $ compare a.pfm b.pfm --set-aside 1
    2 difference $ compare a.pfm b.pfm --full-scale 1
    1 wide.pfm is 2 x 1 $ compare a.pfm wide.pfm
    2 expected a name that ends in .png $ compare a.pfm b.pfm --difference d.gif
    1 standard errors $ compare a.pfm b.pfm --difference d.png --difference-of z
"""
ANSWERS = [
    (0, "montelux render scene.pbrt --spp 64 -o out.exr", "--help"),
    *[(0, "Example", f"{command} --help") for command in ("integrate", "sample", "render", "info", "compare")],
    (0, "--max-depth N", "render --help"),
    (0, "1 x 2 pixels", "info a.pfm"),
    (0, '"maximum": 1.0', "info a.pfm --json"),
    (0, "gbuffer             yes: as 'rgb', with its layers", "formats pbrt"),
    (0, '"plugin": "bilinearmesh"', "formats pbrt --json"),
    (0, "light    KHR_lights_punctual                  in part: ", "formats gltf"),
    (0, '"feature": "KHR_materials_sheen"', "formats gltf --json"),
    (0, "RMSE 0.353553", "compare a.pfm b.pfm"),
    (0, "neither picture has standard errors", "compare a.pfm b.pfm"),
    (0, "full at 0.4995", "compare a.pfm b.pfm --difference d.png"),
    (0, "1 x 2 pixels, 3 channels, 8-bit integer, sRGB", "info d.png"),
    (0, "standard errors of B alone", "compare a.pfm b.pfm --stderr-b b.pfm"),
    (0, '"largest": 0.5', "compare a.pfm b.pfm --stderr-b b.pfm --json"),
]  # fmt: skip
# (words of a command line, candidates that complete the last one)
COMPLETIONS = [
    ("re", "render"),
    ("render --ton", "--tone"),
    ("render scene.pbrt --tone ''", "linear srgb aces agx filmic"),
    ("render --tone a", "aces agx"),
    ("render --tone=a", "--tone=aces --tone=agx"),
    ("render --tone = a", "aces agx"),  # bash splits words at "="
    ("render --tone =", "linear srgb aces agx filmic"),
    ("render --adaptive ''", "on off"),
    ("render --layers position,de", "position,default position,depth position,depth-slopes"),
    ("render --spp ''", ""),  # a number
    ("render --spp 16 -o out", ""),  # a file
    ("render --quiet --to", "--tone"),  # a flag takes no value
    ("bake sk", "sky"),
    ("bake environment --up ''", "y z"),
    ("completion ''", "bash zsh fish"),
    ("nothing --x", ""),
]


def printed_by(*command, **how):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60, **how)


class Commands(ProgramTest):
    @classmethod
    def prepare(cls):
        pfm("a.pfm", 1, 2, 1, 0.5, channels=1)
        pfm("b.pfm", 1, 2, 1, channels=1)
        pfm("wide.pfm", 2, 1, 1, channels=1)
        write("text.png", "no picture")

    def test_answers(self):
        self.expect_each(ANSWERS)
        self.assertNotIn("nan", self.output("compare a.pfm b.pfm"), "where nothing is known")

    def test_mistakes(self):
        self.expect_each(MISTAKES)

    def test_inputs_of_compare_are_not_overwritten_under_any_name(self):
        self.expect(0, "", "compare a.pfm b.pfm --difference d.png")
        for name in "e.png", "kept.png":
            shutil.copy("d.png", name)
        os.symlink("e.png", "link.png")
        os.link("e.png", "hard.png")
        for name in "e.png", "./e.png", "link.png", "hard.png", os.path.abspath("e.png"):
            self.expect_each([
                (2, "this file is read; what is written needs another name", "d.png e.png", "--difference", name),
                (2, "this file is read", "e.png d.png", "--difference", name),
                (2, "this file is read", "d.png d.png --stderr-b e.png", "--difference", name),
            ], "compare ")  # fmt: skip
        self.assert_same("e.png", "kept.png")

    def test_values_that_are_not_finite_are_counted(self):
        """Minimum, mean and maximum are taken over the finite values."""
        pfm("infinite.pfm", 2, 1, 1, INFINITE, 1, 1, INFINITE, NAN)
        rows = {row[0]: row[1:] for row in map(str.split, self.output("info infinite.pfm").splitlines()) if row}
        self.assertEqual((rows["R"][0], rows["R"][2]), ("1", "1"))
        self.assertEqual((rows["G"][:3], rows["G"][4]), (["-", "-", "-"], "2"))
        self.expect(0, '"maximum": null', "info infinite.pfm --json")

    def test_full_disk_or_closed_stream_behind_standard_output_is_noticed(self):
        scene("layers", SKY, 2, 2, 1)
        self.expect(0, "layers.exr", "render layers.pbrt")  # its JSON exceeds the buffer of the stream
        for line in "info a.pfm", "info layers.exr --json", "--version", "--help", "compare a.pfm b.pfm --json":
            for stream in ">/dev/full", ">&-":
                with self.subTest(line + stream):
                    done = printed_by("sh", "-c", f'exec "$@" {stream}', "-", PROGRAM, *line.split())
                    self.assertNotEqual(done.returncode, 0)

    def test_processor_that_lacks_what_the_program_was_built_for(self):
        if not has_command("qemu-x86_64") or not re.search("x86-64-v[34]", self.output("--version")):
            self.skipTest("there is no emulator, or the program is not for x86-64-v3")
        done = printed_by("qemu-x86_64", "-cpu", "Nehalem", PROGRAM, "--version")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("this processor has no AVX2, which the program was built for", done.stdout)


class Help(ProgramTest):
    def offered(self, line):
        return [row.split("\t")[0] for row in self.output(f"completion words {line}").splitlines()]

    def test_completions(self):
        for line, words in COMPLETIONS:
            with self.subTest(line):
                self.assertEqual(self.offered(line), words.split())
        self.assertGreaterEqual(len(self.offered("''")), 12)
        self.assertRegex(self.output("completion words render --sp"), "(?m)^--spp\tSamples per pixel")

    def test_script_of_bash(self):
        done = printed_by("bash", "--norc", "-c", """source <("$1" completion bash)
            COMP_WORDS=("$1" render --tone a) COMP_CWORD=3
            _montelux && echo "${COMPREPLY[*]}\"""", "bash", PROGRAM)
        self.assertEqual(done.stdout, "aces agx\n")

    def test_script_of_zsh(self):
        write("_montelux", self.output("completion zsh"))
        if not has_command("zsh"):
            self.skipTest("there is no zsh")
        self.assertEqual(printed_by("zsh", "-n", "_montelux").returncode, 0)

    def test_script_of_fish(self):
        write("montelux.fish", self.output("completion fish"))
        if not has_command("fish"):
            self.skipTest("there is no fish")
        os.mkdir("program")
        os.symlink(PROGRAM, "program/montelux")
        path = f"{self.folder}/program:{os.environ['PATH']}"
        done = printed_by("fish", "--no-config", "-c", 'source montelux.fish; complete -C "montelux render --tone a"',
                          env={**os.environ, "HOME": self.folder, "PATH": path})  # fmt: skip
        self.assertEqual(done.stdout.split(), ["aces", "agx"])

    def test_every_command_has_a_manual_page_with_every_option_of_its_help(self):
        for command in ["", *self.offered("''")]:
            with self.subTest(command):
                page = self.output(f"manual {command}")
                write("page.1", page)
                self.assertTrue(page.startswith(".TH MONTELUX"), page[:80])
                options = re.findall(r"(?m)^  (?:-.,)*(--[a-z-]*)", self.output(f"{command} --help"))
                self.assertTrue(options)
                self.assertEqual([o for o in options if f"fB{o}fR" not in page.replace("\\", "")], [])
                if has_command("mandoc"):
                    done = printed_by("mandoc", "-T", "lint", "-W", "error", "page.1")
                    self.assertEqual(done.returncode, 0, done.stdout)
                if has_command("groff") and any(Path("/usr/share/groff").glob("*/tmac/an.tmac")):
                    done = printed_by("groff", "-man", "-Tutf8", "-ww", "-z", "page.1")
                    self.assertEqual((done.returncode, done.stdout), (0, ""))
        page = self.output("manual bake")
        for command in "environment", "brdf", "report", "sky":
            self.assertRegex(page, rf"(?m)^\.SH montelux bake {command}")

    def test_version_names_libraries(self):
        version = self.output("--version")
        self.assertRegex(version, r"(?m)^montelux [0-9.]*$")
        self.assertRegex(version, r"(?m)^with: .*(Embree 3\..*, oneTBB .*, OpenEXR|Embree 4\.)")
        self.assertRegex(version, "(?m)^Open Image Denoise: ")
        missing = self.output("--version", environment={"MONTELUX_OIDN_LIBRARY": "/nowhere/libnone.so"})
        self.assertRegex(missing, "(?m)^Open Image Denoise: not found")
