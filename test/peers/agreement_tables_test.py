import sys
import unittest

from agreement_tables import differs, refusals, table, tables
from program import error_message, run


def row(bias, bias_verdict, z_verdict="agrees"):
    return {
        "bias": bias, "bias_error": 0.001, "bias_verdict": bias_verdict, "pooled_z": 1.02, "pooled_z_error": 0.01,
        "z_verdict": z_verdict, "doubtful": 0.1, "doubtful_of_renders": 0.2, "within": [0.68, 0.95, 0.999],
        "expected": [0.682, 0.954, 0.9999], "samples": 64, "seeds": 16, "cpu": 12.3,
    }  # fmt: skip


RESULTS = {
    "room": {"path": row(0.002, "agrees"), "guided": row(0.03, "differs"), "merging": row(0.03, "differs")},
    "hair": {"path": row(0.002, "open"), "guided": {"refused": "no"}, "merging": {"refused": "no"}},
    "fog": {"path": row(0, "agrees"), "guided": {"refused": "no"}, "merging": row(0, "agrees", "differs")},
}


class Tables(unittest.TestCase):
    def test_rows_and_marks(self):
        lines = tables(RESULTS, ["path", "guided"]).splitlines()
        self.assertIn("| room | 0.20 ± 0.10 | **3.00 ± 0.10** |", lines)
        self.assertIn("| hair | 0.20 ± 0.10 ? | - |", lines)
        self.assertIn("- guided, 1 scenes: bias 1 differs; pooled z 1 agrees", lines)
        self.assertIn("| room | 1.00 (0.10) | 1.00 (0.10) |", lines)

    def test_refusals_of_one_kind_are_one_line(self):
        self.assertEqual(refusals(RESULTS, ["path", "guided"]), "- guided: no: hair, fog")

    def test_merging_has_no_verdict(self):
        self.assertEqual([differs(m, r) for m, r in RESULTS["room"].items()], [False, True, False])
        self.assertFalse(differs("guided", RESULTS["hair"]["guided"]))

    def test_columns_are_the_methods_that_are_asked_for(self):
        self.assertEqual(table(RESULTS, ["guided"], lambda r: "x").splitlines()[0], "| scene | guided |")


class Program(unittest.TestCase):
    def test_status_messages_and_cpu_time(self):
        text = "import sys; sum(range(10**6)); sys.stderr.write('a\\nmontelux: error: no file\\n'); sys.exit(3)"
        done = run([sys.executable, "-c", text])
        self.assertEqual((done.status, error_message(done.messages)), (3, "no file"))
        self.assertGreater(done.cpu, 0.001)

    def test_silence_is_no_message(self):
        self.assertEqual(error_message(""), "no message")


if __name__ == "__main__":
    unittest.main()
