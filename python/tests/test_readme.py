"""The Python example of the README; package_test.sh runs it as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_the_example_of_the_readme(tmp_path, monkeypatch, capsys):
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)
    assert len(blocks) == 1
    quick = blocks[0].replace("320, 180", "32, 18").replace("target_error=0.2", "target_error=0.3")
    assert quick.count("32, 18") == quick.count("0.3") == 1
    exec(compile(quick, "README.md", "exec"), {})
    out = capsys.readouterr().out
    assert out.startswith("0.4999") or out.startswith("0.5000")
    assert "stopped by error" in out and (tmp_path / "studio.png").stat().st_size > 1000
