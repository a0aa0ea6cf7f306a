#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the add-on into a zip that Blender installs: build_zip.py OUTPUT. The same sources give the same bytes."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

ADDON = Path(__file__).resolve().parent / "montelux_addon"
DAY = (2024, 1, 1, 0, 0, 0)


def build_zip(output: Path) -> None:
    output.parent.mkdir(parents=True, exist_ok=True)
    files = sorted(p for p in ADDON.rglob("*") if p.suffix in (".py", ".toml") or p.name == "LICENSE")
    with zipfile.ZipFile(output, "w") as archive:
        for path in files:
            entry = zipfile.ZipInfo(path.relative_to(ADDON.parent).as_posix(), DAY)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, path.read_bytes())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: build_zip.py OUTPUT")
    build_zip(Path(sys.argv[1]))
