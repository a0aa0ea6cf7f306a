"""Sequences: frames of animations and turntables, skipped frames, interruption."""

import json
import os
from pathlib import Path

from program import (GLTF_MOTION, GLTF_TRIANGLE, SKY, TENT, ProgramTest, each, edited, pfm, read, remove, scene, steps,
                     write)  # fmt: skip

SMALL = "--resolution 32x24 --spp 2"
# A triangle that emits and moves by 5 along z within 2 s; no camera.
MOVING = {
    "asset": {"version": "2.0"}, **GLTF_TRIANGLE, "materials": [{"emissiveFactor": [1, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "nodes": [{"mesh": 0}],
}  # fmt: skip
CAMERA = {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "zfar": 9, "znear": 0}}
LISTS = ["0", "3-1", "1-", "1-4x", "1-4x0", "1,,2", "1-1000001", "one", "1-4y2", "-3", " 1"]


class FramesTest(ProgramTest):
    @classmethod
    def prepare(cls):
        write("tent.obj", TENT)
        write("moving.gltf", json.dumps({**MOVING, **GLTF_MOTION}))


class Animations(FramesTest):
    FRAMED = f"render framed.gltf {SMALL}"
    STILL = f"{FRAMED} --time-of-scene 0.5"

    @classmethod
    def prepare(cls):
        super().prepare()
        (motion,) = GLTF_MOTION["animations"]
        motion = {**motion, "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}
        nodes = [{"camera": 0, "rotation": [0, 0.38268343, 0, 0.92387953], "translation": [6, 0.5, 7]}, {"mesh": 0}]
        write("framed.gltf", json.dumps({**MOVING, "cameras": [CAMERA], "nodes": nodes, "animations": [motion]}))
        cls.expect(0, "still.pfm", f"{cls.STILL} -o still.pfm")

    def test_frames_have_numbers_and_show_motion(self):
        """One camera frames the whole animation."""
        self.expect(0, "out.0003.png, out.0003.pfm: 32 x 24 pixels",
                    f"render moving.gltf {SMALL} --frames 1-5x2 --frame-rate 2 -o out.png -o out.pfm")  # fmt: skip
        self.assertEqual(sorted(str(path) for path in Path().glob("out.0*.p*")),
                         [f"out.000{k}.{end}" for k in (1, 3, 5) for end in ("pfm", "png")])  # fmt: skip
        self.assert_differ("out.0001.pfm", "out.0003.pfm")

    # The time of frame n is (n - 1) / rate.
    test_frame_is_the_scene_at_its_time = steps(f"""
        0 film.0004.pfm $ {FRAMED} --frames 4 --frame-rate 6 -o film.pfm
        still.pfm == film.0004.pfm
        0 the animation ends at 2 s; frame 60 and those behind it show its end $ {FRAMED} --frames 60 -o film.pfm
    """)
    # Shutters: none, seconds, and an angle of the time of a frame.
    test_shutter = steps(f"""
        0 none.pfm $ {STILL} --shutter 0 -o none.pfm
        still.pfm == none.pfm
        0 blur.pfm $ {STILL} --shutter 0.25s -o blur.pfm
        still.pfm != blur.pfm
        0 angle.pfm $ {STILL} --shutter 180deg --frame-rate 2 -o angle.pfm
        blur.pfm == angle.pfm
        0 blurred.0004.pfm: 32 x 24 $ {FRAMED} --frames 4 --frame-rate 6 --shutter 0.25 -o blurred.pfm
        blur.pfm == blurred.0004.pfm
    """)


class FinishedFrames(FramesTest):
    """Frames whose settings and files are unchanged are skipped."""

    LINE = f"render moving.gltf {SMALL} --frames 2"

    def test_lost_and_damaged_files(self):
        line = f"render moving.gltf {SMALL} --frame-rate 2 -o out.png -o out.pfm"
        self.expect(0, "out.0005.png", f"{line} --frames 1-5x2")
        text = self.expect(0, "finished before and skipped: frames 1,3 (out.frames)", f"{line} --frames 1,3")
        self.assertNotIn("pixels", text)
        remove("out.0003.pfm")
        write("out.0005.png", read("out.0005.png") + b"x")
        text = self.expect(0, "skipped: frames 1 (", f"{line} --frames 1-5x2")
        self.assertEqual(sum("pixels" in row for row in text.splitlines()), 2, text)
        self.expect(0, "out.0001.png, out.0001.pfm: 32 x 24 pixels, 3 samples", f"{line} --spp 3 --frames 1")

    def test_other_settings_are_rendered_anew(self):
        line = f"{self.LINE} -o a.png -o a.jpg"
        self.expect(0, "a.0002.jpg: 32 x 24", line)
        for option in ("--seed 7", "--tone aces", "--exposure 1", "--bits 16", "--quality 50", "--layers default,uv",
                       "--frame-rate 3", "--time 60", "--background white"):  # fmt: skip
            with self.subTest(option):
                self.expect(0, "a.0002.jpg: 32 x 24", f"{line} {option}")
                self.expect(0, "a.0002.jpg: 32 x 24", line)
        self.expect(0, "skipped: frames 2", line)

    def test_changed_scene_is_rendered_anew(self):
        line = f"render changed.gltf {SMALL} --frames 2 -o c.png"
        write("changed.gltf", read("moving.gltf"))
        self.expect(0, "c.0002.png: 32 x 24", line)
        edited("moving.gltf", "changed.gltf", (r"\[1, 0, 0\]", "[0, 1, 0]"))
        self.expect(0, "c.0002.png: 32 x 24", line)

    def test_folder_can_be_moved(self):
        os.mkdir("old")
        self.expect(0, "old/out.0002.png", f"{self.LINE} -o old/out.png")
        os.rename("old", "new")
        self.expect(0, "skipped: frames 2 (new/out.frames)", f"{self.LINE} -o new/out.png")

    def test_edited_log_of_frames(self):
        write("log.frames", "montelux frames 1\nnonsense\n0 0 0\n")  # lines that are not understood are ignored
        write("diary.frames", "a diary\n")
        self.take(f"""
            0 log.0002.png: 32 x 24 $ {self.LINE} -o log.png
            1 diary.frames: the finished frames are kept in a file of this name $ {self.LINE} -o diary.png
            no diary.0002.png
        """)


class Turntables(FramesTest):
    LINE = f"render tent.obj {SMALL}"
    CHOSEN = "render tent.obj --resolution 32x24 --spp 8 --turntable 2 --integrator auto -o chosen.exr"

    @classmethod
    def prepare(cls):
        super().prepare()
        scene("ball", f'{SKY} Shape "sphere" Translate 1 0 0 Shape "sphere" "float radius" 0.5')
        write("rest.gltf", json.dumps(MOVING))
        pfm("map.0001.pfm", 2, 1, 1)

    def test_turntable_begins_at_the_still_picture(self):
        self.take(f"""
            0 tent.obj has no camera $ {self.LINE} --turntable 4 -o turn.pfm
            0 $ {self.LINE} -o tent.pfm
            tent.pfm == turn.0001.pfm
            no turn.0005.pfm
            0 skipped: frames 2-3 $ {self.LINE} --turntable 4 --frames 2-3 -o turn.pfm
            0 $ {self.LINE} --orbit 215,18 -o back.pfm
        """)
        self.assertLess(self.json("compare back.pfm turn.0003.pfm")["rmse"], 0.01, "half a turn")

    def test_integrator_is_chosen_for_each_frame(self):
        self.assertEqual(self.expect(0, "", self.CHOSEN).count("montelux: integrator path: "), 2)
        self.expect(0, "skipped: frames 1-2", self.CHOSEN)

    def test_sequence_continues_after_a_missed_target(self):
        line = "render tent.obj --resolution 32x24"
        self.expect(0, "target reached", f"{line} --max-spp 256 --target-error 50% --turntable 1 -o turn.exr")
        self.expect(3, "samples are used up before the target was reached",
                    f"{line} --max-spp 2 --target-error 0.01% --turntable 2 -o never.exr")  # fmt: skip
        self.assertTrue(os.path.exists("never.0002.exr"))

    def test_camera_of_a_pbrt_scene_turns(self):
        self.expect(0, "ball.0002.exr", "render ball.pbrt --turntable 2")
        self.expect(0, "ball.exr", "render ball.pbrt")
        self.assertNotIn("RMSE 0,", self.expect(0, "RMSE", "compare ball.0002.exr ball.exr"))

    def test_interruption_keeps_whole_frames_only(self):
        job = self.start("render tent.obj --resolution 64x48 --spp 40000 --turntable 3 -o slow.exr")
        self.assertIn("interrupted: 0 of 3 frames are finished; the same command renders the others",
                      self.interrupted(job))  # fmt: skip
        self.assert_absent("*slow*", "*montelux-*")

    test_lists_of_frames = each([
        (2, f"--frames: '{value}' was given; frames from 1 to 1000000 are expected", "", f"--frames={value}")
        for value in LISTS], "render moving.gltf ")  # fmt: skip
    test_mistakes = each("""
        1 ball.pbrt: only glTF scenes have a time of animations $ ball.pbrt --frames 1-4
        2 --frames: rest.gltf has no animation; --turntable N takes the camera around it $ rest.gltf --frames 1-4
        2 --shutter: expected --time-of-scene TIME, when it opens, or --frames $ moving.gltf --shutter 1
        2 --shutter: '361deg' was given; an angle from 0deg to 360deg is expected
          $ moving.gltf --frames 1 --shutter 361deg
        2 --shutter: '-1' was given $ moving.gltf --frames 1 --shutter=-1
        2 --shutter: 'long' was given $ moving.gltf --frames 1 --shutter long
        2 --frames: there is no frame 5; the turntable has 4 $ tent.obj --turntable 4 --frames 1-5
        2 --turntable: '0' was given $ tent.obj --turntable 0
        2 --frame-rate: '0' was given $ moving.gltf --frames 1 --frame-rate 0
        2 --checkpoint: a sequence has no checkpoint: it skips frames that are finished
          $ tent.obj --turntable 4 --checkpoint a
        2 --resume: a sequence has no checkpoint $ tent.obj --turntable 4 --resume
        2 --debug-sample: it replays a sample of one picture $ tent.obj --turntable 4 --debug-sample 1,1,0
        2 --time-of-scene: the frames of --frames have times of their own $ moving.gltf --frames 1 --time-of-scene 1
        2 map.0001.pfm: the scene is read from this file $ tent.obj --turntable 1 --environment map.0001.pfm -o map.pfm
    """, "render ")
