"""After a failed file operation or a kill, each output is the complete old file or the complete new one.

Every file operation of each command fails once. MONTELUX_FAULT_KINDS="ENOSPC EIO ..." selects kinds of faults
(test/fault/fault_injection.cpp); "all" selects every kind.
"""

import os
import re
import shutil
import signal

from program import FAULT_LIBRARY, SKY, ProgramTest, read, scene, skip_without_faults, without_seconds, write

EVERY_KIND = "ENOSPC EIO EDQUOT EINTR full-disk short kill-before kill-after"
KINDS = os.environ.get("MONTELUX_FAULT_KINDS", "ENOSPC short kill-before")
KINDS = (EVERY_KIND if KINDS == "all" else KINDS).split()
MOST_CALLS = 400


def contents(folder):
    """The contents of the files of a folder, by name."""
    return {entry.name: read(entry.path) for entry in os.scandir(folder) if entry.is_file()}


class WriteFaults(ProgramTest):
    @classmethod
    def prepare(cls):
        skip_without_faults()
        scene("tiny", f'{SKY} Shape "sphere"', 8, 6, 1)

    def with_fault(self, call, kind, line):
        """Runs the command in the folder `work`, where file operations are counted; returns outcome and report."""
        work, report = os.path.abspath("work"), os.path.abspath("report")
        if os.path.exists(report):
            os.remove(report)
        outcome = self.outcome(line, cwd="work", environment={
            "MONTELUX_FAULT_FOLDER": work, "MONTELUX_FAULT_CALL": str(call), "MONTELUX_FAULT_KIND": kind,
            "MONTELUX_FAULT_REPORT": report, "LD_PRELOAD": FAULT_LIBRARY})  # fmt: skip
        return outcome, read(report).decode(errors="replace") if os.path.exists(report) else ""

    def fresh(self, old):
        """Recreates the folder `work` with the old files."""
        shutil.rmtree("work", ignore_errors=True)
        os.mkdir("work")
        for name, data in old.items():
            write(f"work/{name}", data)

    def is_whole(self, name, wanted):
        """Whether a file equals that of a run without faults. EXR files contain times: their pixels are compared."""
        if read(f"work/{name}") == wanted:
            return True
        if not name.endswith(".exr"):
            return False
        write("wanted.exr", wanted)
        return "RMSE 0, relMSE 0 " in self.outcome(f"compare work/{name} wanted.exr").text

    def faults(self, outputs, line, old, check=lambda where: None):
        """Injects each fault at each file operation; `check` examines what is left in `work`."""
        self.fresh(old)
        outcome, report = self.with_fault(0, "none", line)
        self.assertEqual(outcome.code, 0, outcome)
        self.assertNotIn("unseen", report, "no fault can reach these writes")
        new = contents("work")
        for kind in KINDS:
            with self.subTest(kind):
                for call in range(1, MOST_CALLS + 2):
                    self.assertLessEqual(call, MOST_CALLS, "there is no end of faults")
                    self.fresh(old)
                    outcome, report = self.with_fault(call, kind, line)
                    if not report:
                        self.assertEqual(outcome.code, 0, f"nothing went wrong, but: {outcome}")
                        break
                    where = f"{kind} at call {call} ({report.splitlines()[0]}): {outcome}"
                    for name in outputs:
                        self.check_output(name, outcome.code, old, new, where)
                    (self.check_killed if kind.startswith("kill-") else self.check_ended)(kind, outcome, report, where)
                    check(where)
                print(f"{kind}: {call - 1} calls", end=" ... ")
                self.assertGreater(call, 5, "a case without faults would test nothing")

    def check_output(self, name, code, old, new, where):
        if code == 0:
            self.assertTrue(self.is_whole(name, new[name]), f"{name} is not the new file: {where}")
        elif os.path.exists(f"work/{name}"):
            self.assertTrue(name in old and self.is_whole(name, old[name]) or self.is_whole(name, new[name]),
                            f"{name} is half a file: {where}")  # fmt: skip
        else:
            self.assertNotIn(name, old, f"it is lost: {where}")

    def check_killed(self, kind, outcome, report, where):
        self.assertEqual(outcome.code, -signal.SIGKILL, where)

    def check_ended(self, kind, outcome, report, where):
        code, text = outcome.code, outcome.text
        left = [name for _, _, names in os.walk("work") for name in names if re.match(r"\.montelux-|.*\.tmp$", name)]
        self.assertEqual(left, [], f"left behind: {where}")
        self.assertIn(code, (0, 1), where)
        if code == 1:
            self.assertEqual(text.count("montelux: error: "), 1, where)
            if kind == "ENOSPC":  # the first failure is reported, even where a library ignores it
                self.assertIn("No space left on device", text, where)
        if kind in ("ENOSPC", "EIO", "EDQUOT", "full-disk") and code == 0 and "montelux: warning: " not in text:
            # Probes and files that are only read may fail to open or close; every other fault must be reported.
            self.assertRegex(report.splitlines()[0], "fault (open|close)", f"it went unnoticed: {where}")
        if kind in ("short", "EINTR") and code != 0:
            # Short writes are no faults, and interrupted calls are repeated, except renames.
            self.assertRegex(report, "fault (rename|link)", where)

    def test_pictures(self):
        old = dict.fromkeys(("x.exr", "x.png", "x.pfm"), b"old")
        self.faults(["x.exr", "x.png"], "render ../tiny.pbrt --seed 1 --quiet -o x.exr -o x.png", old)

    def test_pictures_of_floats(self):
        old = dict.fromkeys(("x.exr", "x.png", "x.pfm"), b"old")
        self.faults(["x.pfm", "x.hdr"], "render ../tiny.pbrt --seed 1 --quiet -o x.pfm -o x.hdr", old)

    def test_points(self):
        self.faults(["points.csv"], "integrate x*y --over x,y=0:1 --method basic --evaluations 2000 --quiet"
                    " --points points.csv", {"points.csv": b"old"})  # fmt: skip

    def test_plot(self):
        self.faults(["plot.svg"], "integrate x*y --over x,y=0:1 --method midpoint --evaluations 2000 --quiet"
                    " --plot plot.svg", {"points.csv": b"old"})  # fmt: skip

    def test_samples(self):
        self.faults(["points.csv"], "sample --set sobol --n 2000 --dim 3 -o points.csv", {"points.csv": b"old"})

    def saved(self, *lines):
        """The files that consecutive commands leave in a folder of their own."""
        shutil.rmtree("saved", ignore_errors=True)
        os.mkdir("saved")
        for line in lines:
            self.expect(0, "", line, cwd="saved")
        return contents("saved")

    def resume(self, line, where):
        outcome = self.outcome(line, cwd="work", apart=True)
        self.assertEqual(outcome.code, 0, f"cannot be resumed: {outcome}; {where}")
        self.assertNotIn("warning", outcome.errors, where)
        return outcome.text

    def test_checkpoint_of_an_integral(self):
        """Checkpoints contain elapsed times, so the results of resumed runs are compared."""
        integral = "integrate x*y --over x,y=0:1 --method basic --quiet --json"
        checkpoints = f"{integral} --checkpoint state --checkpoint-every 0"
        longer = f"{checkpoints} --evaluations 50000 --resume"
        old = self.saved(f"{checkpoints} --evaluations 16384")  # a step of the longer run ends there, too
        wanted = without_seconds(self.output(f"{integral} --evaluations 50000"))

        def check(where):
            self.assertEqual(without_seconds(self.resume(longer, where)), wanted, where)

        self.faults([], longer, old, check)

    def test_checkpoint_of_a_render(self):
        picture = "render ../tiny.pbrt --seed 1 --quiet"
        checkpoints = f"{picture} --checkpoint state"
        old = self.saved(f"{checkpoints} --spp 3 -o x.pfm", f"{checkpoints} --spp 5 -o x.pfm --resume")
        self.expect(0, "", f"{picture.replace('../', '')} --spp 9 -o uninterrupted.pfm")

        def check(where):
            self.resume(f"{checkpoints} --spp 9 -o y.pfm --resume", where)
            self.assert_same("work/y.pfm", "uninterrupted.pfm", where)

        self.faults(["x.pfm"], f"{checkpoints} --spp 7 -o x.pfm --resume", old, check)
