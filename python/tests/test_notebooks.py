"""The notebooks of docs/notebooks: they are those of their sources, and their cells say what is stored in them.

Cells are executed as plain Python, in order; those that draw are left out where there is no matplotlib.
"""

from __future__ import annotations

import functools
import importlib.util
import json
import math
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "notebooks"
HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None


def _tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("write_notebooks", FOLDER / "write_notebooks.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


tool = _tool()


def stored(name: str) -> str:
    return (FOLDER / f"{name}.ipynb").read_text(encoding="utf-8")


@functools.cache
def cells_of(name: str) -> list[Any]:
    cells: list[Any] = tool.read_cells((FOLDER / f"{name}.py").read_text(encoding="utf-8"))
    return cells


def outputs_of(name: str) -> list[list[dict[str, Any]]]:
    return [cell["outputs"] for cell in json.loads(stored(name))["cells"] if cell["cell_type"] == "code"]


def texts(outputs: list[dict[str, Any]]) -> list[str]:
    """What a cell says; the text beside a figure is none."""
    shown = (o["text"] if "text" in o else o["data"]["text/plain"] for o in outputs)
    return [text for text in ("".join(lines) for lines in shown) if text != "<Figure>"]


NUMBER = re.compile(r"-?\d+(?:\.(\d*))?(?:\((\d+)\))?(?:e([+-]?\d+))?(?![\w.])")


#: Light paths fork where a number is rounded differently: pictures of two builds differ by some of their samples.
RELATIVE = {"rendering": 0.05}


def differences(expected: str, found: str, relative: float = 0.0) -> list[str]:
    """How two texts differ. Seeds are fixed and one build gives the same digits always; other compilers and other
    processors round differently, so that numbers may differ by one in their last digit, or by this share, and those
    with an error in brackets by that error. Seconds and the widths of columns are left out."""
    expected, found = (re.sub(r"[\d.e+-]+ s\b", "# s", re.sub(" +", " ", text)) for text in (expected, found))
    if NUMBER.sub("#", expected) != NUMBER.sub("#", found):
        return [f"{expected!r} was expected, {found!r} found"]
    wrong = []
    for e, f in zip(NUMBER.finditer(expected), NUMBER.finditer(found)):
        digits, error, exponent = e.groups()
        unit = 10.0 ** (int(exponent or 0) - len(digits or ""))
        allowed = unit * (int(error) if error else 1)
        values = [float(re.sub(r"\(\d+\)", "", m.group())) for m in (e, f)]
        if not math.isclose(*values, rel_tol=relative, abs_tol=1.001 * allowed):
            wrong.append(f"{e.group()} was expected, {f.group()} found")
    return wrong


@pytest.mark.parametrize("name", tool.NAMES)
def test_the_notebook_is_that_of_its_source(name: str) -> None:
    text = stored(name)
    assert text == tool.as_notebook(cells_of(name), outputs_of(name)), "run docs/notebooks/write_notebooks.py"
    ids = [cell["id"] for cell in json.loads(text)["cells"]]
    assert len(set(ids)) == len(ids)
    assert len(text.encode()) < 400_000
    assert not re.search(r"/(home|tmp|root|work|usr)/|Traceback", text)


@pytest.mark.parametrize("name", tool.NAMES)
def test_cells_say_what_is_stored(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    runner, relative = tool.Runner(name), RELATIVE.get(name, 0.0)
    compared = 0
    for cell, expected in zip((c for c in cells_of(name) if c.is_code), outputs_of(name), strict=True):
        if cell.draws and not HAS_MATPLOTLIB:
            continue
        found = runner.execute(cell)
        if cell.varies:
            assert found and expected
            continue
        assert [o["output_type"] for o in found] == [o["output_type"] for o in expected], cell.text
        wrong = [d for e, f in zip(texts(expected), texts(found), strict=True) for d in differences(e, f, relative)]
        assert not wrong, f"{cell.text}\n" + "\n".join(wrong)
        assert [("image/png" in o.get("data", {})) for o in found] == [
            ("image/png" in o.get("data", {})) for o in expected
        ]
        compared += len(texts(expected))
    assert compared > 8


@pytest.mark.parametrize("name", tool.NAMES)
def test_links_lead_somewhere(name: str) -> None:
    links = [link for c in cells_of(name) if not c.is_code for link in re.findall(r"\]\(([^)#]+)", c.text)]
    assert links and all((FOLDER / link).exists() for link in links if "://" not in link), links


@pytest.mark.parametrize(
    "expected, found, count",
    [
        ("0.50001(22) after 100", "0.50021(25) after 101", 0),
        ("0.50001(22)", "0.50031(22)", 1),
        ("value 1.25e-07", "value 1.26e-07", 0),
        ("value 1.25", "value 1.27", 1),
        ("converged True", "converged False", 1),
        ("0.61 s, by samples", "12 s, by samples", 0),
        ("0.61 s, by samples", "0.61 s, by error", 1),
        ("1.5 errors", "-1.5 errors", 1),
        ("no warning", "no warning\nwarning: 3", 1),
    ],
)
def test_texts_are_compared(expected: str, found: str, count: int) -> None:
    assert len(differences(expected, found)) == count


def test_a_share_may_be_allowed() -> None:
    assert not differences("RMSE   0.0796 of 904", "RMSE  0.0799 of 912", 0.05)
    assert len(differences("RMSE 0.0796", "RMSE 0.0899", 0.05)) == 1


def test_wrong_cells_are_seen() -> None:
    with pytest.raises(ValueError, match="there is no kind of cell 'tags'"):
        tool.read_cells("# %% tags\n1\n")
    cell, text = tool.read_cells("# %%\nprint(1 + 1)\n3 * 4\n# %% [markdown]\n# # Title\n#\n# text\n")
    assert text.text == "# Title\n\ntext" and not text.is_code
    assert texts(tool.Runner("test").execute(cell)) == ["2\n", "12"]
