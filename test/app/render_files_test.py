"""Files that `render` reads and writes."""

import os
import resource
import shutil
import signal
import subprocess

from program import FORMATS, NAN, PROGRAM, SKY, ProgramTest, pfm, read, scene, write


class Outputs(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("ok", f'{SKY} Shape "sphere"')
        scene("long", f'{SKY} Shape "sphere"', 2000, 2000, 1000000)

    def test_outputs_are_checked_before_the_render(self):
        """The test would time out if the scene were rendered first."""
        os.mkdir("folder.exr")
        name = "x" * 252  # one letter too long with .exr
        self.expect_each(f"""
            1 nowhere/x.exr: cannot be written $ -o nowhere/x.exr
            1 cannot be written $ -o long.pbrt/x.exr
            1 it is a folder $ -o folder.exr
            1 the extension '.gif' is not one of .exr, .png, .jpg, .hdr, .pfm $ -o x.gif
            1 the extension '.pbrt' $ -o long.pbrt
            1 the name has no extension $ -o x
            1 the name has no extension $ -o ''
            1 File name too long $ -o {name}.exr
            # too long with .previous
            1 File name too long $ -o x.exr --checkpoint {name[7:]}
            1 no files can be made in the folder '/proc' $ -o /proc/x.exr
            1 it is a folder $ -o x.exr --checkpoint folder.exr
        """, "render long.pbrt ")
        if os.getuid() != 0:
            os.mkdir("locked", 0o500)
            self.expect(1, "Permission denied", "render long.pbrt -o locked/x.exr")

    def test_message_names_the_kind_of_a_file_that_is_no_scene(self):
        self.expect(0, "8 x 6 pixels", "render ok.pbrt -o picture.exr --checkpoint ok.state")
        write("collada.xml", '<?xml version="1.0"?>\n<COLLADA version="1.4.1"/>')
        self.expect_each(f"""
            1 picture.exr: this is an OpenEXR picture; {FORMATS} $ render picture.exr
            1 ok.state: this is a checkpoint of Montelux; {FORMATS}: give the scene itself $ render ok.state
            1 collada.xml: this is a COLLADA scene; pbrt-v4 $ render collada.xml
        """)
        shutil.copy("ok.pbrt", "any name")
        self.expect(0, "8 x 6 pixels", "render 'any name' -o picture.exr")

    def on_small_disk(self, size, line):
        """Output of a render that fails because of a limit on file sizes."""
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        text = self.expect(1, "", f"render ok.pbrt --resolution 300x200 {line}", preexec_fn=limit)
        self.assert_absent(".montelux-*")
        return text

    def test_full_disk_leaves_the_older_file(self):
        write("limited.exr", "old")
        text = self.on_small_disk(512, "-o limited.exr")
        self.assertEqual(read("limited.exr"), b"old")
        self.assertIn("limited.exr: cannot be written: writing: File too large", text)

    def test_full_disk_leaves_the_other_outputs(self):
        text = self.on_small_disk(800 * 512, "-o limited.exr -o small.png -o big.pfm -o small.hdr")
        self.assertRegex(text, "error: limited.exr: .*File too large; big.pfm: .*File too large")
        self.assertNotIn("limited.exr: 300", text, "a file that was not written is reported as written")
        self.expect(0, "300 x 200 pixels", "info small.png")
        self.expect(0, "300 x 200 pixels", "info small.hdr")

    def test_full_disk_behind_standard_output(self):
        with open("/dev/full", "wb") as full:
            self.assertNotEqual(self.start("render ok.pbrt", stdout=full).ended().code, 0)

    def test_messages_are_not_written_into_a_picture(self):
        """With closed standard streams the file of the picture could get their descriptors."""
        subprocess.run(["sh", "-c", f'exec "{PROGRAM}" render ok.pbrt -o closed.exr >&- 2>&- <&-'], timeout=60)
        self.expect(0, "8 x 6 pixels", "info closed.exr")

    def test_closed_reader_of_messages_does_not_stop_the_render(self):
        reader, writer = os.pipe()
        os.close(reader)
        with open(writer, "wb") as pipe:
            line = "render ok.pbrt --spp 64 -o unread.exr"
            subprocess.run([PROGRAM, *line.split()], stdout=pipe, stderr=pipe, timeout=60)
        self.assertTrue(os.path.exists("unread.exr"))


class Inputs(ProgramTest):
    @classmethod
    def prepare(cls):
        pfm("one.pfm", 1, 1, 1)
        pfm("wide.pfm", 3, 1, 1)
        pfm("negative.pfm", 1, 1, 1, 1, -1)
        pfm("nan.pfm", 1, 1, 1, 1, NAN)
        pfm("black.pfm", 1, 1, 0)
        pfm("grey.pfm", 1, 1, 1, channels=1)

    def use(self, kind, file):
        """Writes a scene with the picture as a texture or as the environment."""
        scene("picture", f'LightSource "infinite" "string filename" "{file}" Shape "sphere"'
              if kind == "environment" else f"""{SKY} Texture "t" "spectrum" "imagemap" "string filename" "{file}"
Material "diffuse" "texture reflectance" "t" Shape "sphere\"""")  # fmt: skip

    def test_pictures(self):
        for kind, file, code, text in [
            ("texture", "one.pfm", 0, "picture.exr"),
            ("texture", "grey.pfm", 0, "picture.exr"),
            ("environment", "one.pfm", 0, "picture.exr"),
            ("environment", "grey.pfm", 0, "picture.exr"),
            ("environment", "wide.pfm", 1, "an environment map must be square"),
            ("environment", "negative.pfm", 0, "negative.pfm has negative pixels; they count as 0"),
            ("environment", "nan.pfm", 1, "nan.pfm has a pixel that is not finite"),
            ("environment", "black.pfm", 0, "black.pfm is black; the light gives nothing"),
            ("texture", "nan.pfm", 0, "nan.pfm has 1 values that are not finite; they count as 0"),
        ]:
            with self.subTest(kind, file=file):
                self.use(kind, file)
                self.expect(code, text, "render picture.pbrt")

    def test_environment_of_one_channel_equals_that_of_three(self):
        for name in "one", "grey":
            self.use("environment", f"{name}.pfm")
            self.expect(0, "", f"render picture.pbrt -o by_{name}.pfm")
        self.assert_same("by_one.pfm", "by_grey.pfm")

    def test_picture_does_not_overwrite_files_of_the_scene(self):
        self.use("texture", "one.pfm")
        self.expect(2, "one.pfm: the scene is read from this file", "render picture.pbrt -o one.pfm")
        self.expect(0, "1 x 1 pixels", "info one.pfm")
