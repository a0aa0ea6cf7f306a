"""The report: its texts and its files."""

from __future__ import annotations

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

import pytest

import montelux
from montelux.lab import all_figures, chosen_figures, concise
from montelux.lab._number import digits_of

FIGURES = all_figures()


@pytest.mark.parametrize(
    "value, error, text",
    [
        (1.23456, 0.056, "1.235(56)"),
        (0.5, 0.0012, "0.5000(12)"),
        (-2, 0.1, "−2.00(10)"),
        (1, 0.0996, "1.00(10)"),
        (123456.0, 1200.0, "1.235(12) × 10⁵"),
        (1e-7, 1e-9, "1.000(10) × 10⁻⁷"),
        (0, 0.02, "0.000(20)"),
        (3, 0, "3"),
        (1, float("inf"), "1(?)"),
    ],
)
def test_numbers_are_written_with_their_errors(value: float, error: float, text: str) -> None:
    assert concise(value, error) == text


def test_exact_numbers_have_more_digits_than_measured_ones() -> None:
    assert digits_of(0.233700550136, 1e-4) == "0.233701"
    assert digits_of(2.0, 0.1) == "2"
    assert digits_of(-0.5, 0.1) == "−0.5"


def test_every_row_has_its_figures() -> None:
    rows = {f.row for f in FIGURES}
    assert {f"A{i}" for i in range(1, 10)} | {f"B{i}" for i in range(1, 10)} <= rows
    assert {f"C{i}" for i in range(4, 11)} <= rows
    keys = [f.key for f in FIGURES]
    assert len(set(keys)) == len(keys)
    for f in FIGURES:
        sentences = len(re.findall(r"[.:;]( |$)", f.see))
        assert sentences >= 2, f"{f.key}: two sentences on what to see"
        assert f.alt, f.key
        assert (
            "montelux" in f.code or "shape.warp" in f.code or "measured_areas" in f.code or "rendered(" in f.code
        ), f.key


def test_figures_are_chosen_by_row_and_name() -> None:
    assert [f.key for f in chosen_figures(["a4"])] == ["A4-importance", "A4-race"]
    assert [f.key for f in chosen_figures(["A4-race,B2"])] == ["A4-race", "B2-exponential"]
    with pytest.raises(montelux.Error, match=r"no figure 'A4-rase' \(did you mean 'A4-race'\?\)"):
        chosen_figures(["A4-rase"])


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.files: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.tags: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        for name, value in attrs:
            assert value is not None
            if name == "id":
                self.ids.append(value)
            elif name == "href" and value.startswith("#"):
                self.links.append(value[1:])
            elif name in ("src", "srcset", "href") and not value.startswith("data:"):
                self.files.append(value)
            if tag == "img" and name == "alt":
                assert value


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("matplotlib")
    from montelux.lab.report import make_report

    folder = tmp_path_factory.mktemp("lab")
    make_report(chosen_figures(["A4", "B2", "B8"]), folder)
    return folder


def test_the_page_is_whole(report: Path) -> None:
    text = (report / "index.html").read_text(encoding="utf-8")
    page = _Page()
    page.feed(text)
    assert page.files and all((report / name).stat().st_size > 0 for name in page.files)
    assert len(set(page.ids)) == len(page.ids), "ids are unique"
    assert set(page.links) <= set(page.ids)
    # Offline, and without scripts.
    assert not {"script", "iframe"} & page.tags
    assert not re.search(r'(src|srcset|href)="(https?:)?//', text)
    assert "0.23370" in text and "A4-race" in text and "prefers-color-scheme: dark" in text


def test_drawings_are_xml_in_both_themes(report: Path) -> None:
    files = sorted(p.name for p in report.glob("*.svg"))
    assert files == sorted(f"{f.key}-{t}.svg" for f in chosen_figures(["A4", "B2", "B8"]) for t in ("light", "dark"))
    for name in files:
        root = ElementTree.parse(report / name).getroot()
        assert root.tag.endswith("svg")
    light, dark = ((report / f"A4-race-{t}.svg").read_text() for t in ("light", "dark"))
    assert "#1a1a1f" in light and "#ececf0" in dark and "#ececf0" not in light


def test_the_command(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    command = [sys.executable, "-m", "montelux.lab"]
    done = subprocess.run([*command, "--out", tmp_path / "r", "--only", "B5"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "r" / "index.html").exists() and ": 1 figure, " in done.stdout
    wrong = subprocess.run([*command, "--out", tmp_path / "s", "--only", "Z9"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "no figure 'Z9'" in wrong.stderr and not (tmp_path / "s").exists()
    assert subprocess.run(command, capture_output=True, text=True).returncode == 2
    listed = subprocess.run([*command, "--list"], capture_output=True, text=True)
    assert listed.stdout.count("\n") == len(FIGURES)
