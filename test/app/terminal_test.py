"""Progress: on a terminal a bar that fits its width and is measured against the limit; otherwise lines."""

import re

from program import SKY, ProgramTest, scene

CONTENT = f"""{SKY} LightSource "point" "rgb I" [9 9 9] "point3 from" [0 0.9 1.2] Material "diffuse"
Shape "sphere" Translate 1 0 0 Shape "sphere\""""


class Progress(ProgramTest):
    @classmethod
    def prepare(cls):
        scene("lit", CONTENT, 480, 360)
        scene("small", CONTENT, 200, 150)
        scene("short", f'{SKY} Shape "sphere"')

    def drawn(self, line, columns=80):
        """Successive texts of the line of progress, each of which must leave the last column free."""
        outcome = self.on_terminal(line, columns)
        self.assertEqual(outcome.code, 0, outcome)
        lines = [text.replace("\x1b[K", "") for text in re.split("[\r\n]+", outcome.text)]
        lines = [text for text in lines if re.search("[0-9] %  ", text)]
        self.assertTrue(lines, f"no progress: {outcome}")
        self.assertLess(max(map(len, lines)), columns, lines)
        return lines

    def test_time_left_refers_to_the_limit(self):
        """The number of samples does not matter."""
        for columns in 80, 40:
            with self.subTest(columns=columns):
                lines = self.drawn("render lit.pbrt --time 0.6 --threads 1 -o x.exr", columns)
                left = [line for line in lines if " left" in line]
                self.assertTrue(left, lines)
                for line in left:
                    self.assertLessEqual(float(re.search(r"([0-9.]+) s left", line)[1]), 0.75, line)
                self.assertIn("100 %", lines[-1])

    def test_time_left_is_not_extrapolated_without_an_error(self):
        for line in self.drawn("render lit.pbrt --target-error 30% --threads 1 -o x.exr"):
            self.assertNotRegex(line, "[0-9]+:[0-9]+:[0-9]+ left")

    def test_bar_of_80_columns(self):
        lines = self.drawn("render small.pbrt --spp 16 -o x.exr")
        self.assertTrue(any("100 %" in line for line in lines), lines)
        self.assertTrue(any(re.search(r"\[#+\.*\] +[0-9]+ %", line) for line in lines), lines)

    def test_times_on_40_columns(self):
        lines = self.drawn("render small.pbrt --spp 16 -o x.exr", 40)
        self.assertTrue(any("100 %" in line for line in lines), lines)
        self.assertTrue(any("elapsed" in line or "left" in line for line in lines), lines)

    def test_line_of_a_short_render_is_complete(self):
        text = self.on_terminal("render short.pbrt").text
        for part in "[####", "100 %", "elapsed", "samples/s", "error":
            self.assertIn(part, text)

    def test_lines_where_there_is_no_terminal(self):
        self.expect(0, "rendering: 100 %", "render short.pbrt")

    def test_bar_is_full_only_at_the_target(self):
        lines = self.drawn("render small.pbrt --target-error 7% -o x.exr")
        known = [line for line in lines if " error " in line]
        self.assertTrue(known, lines)
        for line in known:
            if "100 %" in line:
                self.assertLessEqual(float(re.search(r".* error ([0-9.]+)", line)[1]), 7, line)

    def test_render_that_is_interrupted_in_its_pilot_has_seen_every_pixel(self):
        job = self.start("render lit.pbrt --target-error 0.1% -o early.exr")
        self.interrupted(job, works=0.8)
        info = self.output("info early.exr")
        self.assertGreaterEqual(float(re.search(r"^samples +(\S+)", info, re.M)[1]), 1, info)
