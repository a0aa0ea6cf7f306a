"""A copy of a pbrt scene for Montelux: with a box filter, and without the media that the comparison leaves out."""

from __future__ import annotations

from pathlib import Path

from pbrt_text import SceneError, directives_of, read_text

REMOVED = ("PixelFilter", "MakeNamedMedium", "MediumInterface")


def with_box_filter(text: str, file: Path) -> str:
    pieces, at, found = [], 0, False
    for d in directives_of(text, file):
        if d.name in REMOVED:
            pieces.append(text[at : d.span[0]])
            at = d.span[1]
        elif d.name == "WorldBegin":  # the last filter before it counts
            pieces += [text[at : d.span[0]], 'PixelFilter "box"\n']
            at, found = d.span[0], True
    if not found:
        raise SceneError(f"{file}: no WorldBegin")
    return "".join(pieces) + text[at:]


def copy_scene(file: Path, folder: Path) -> Path:
    """Writes the copy into `folder`, beside links to the scene's own files."""
    for entry in file.parent.resolve().iterdir():
        link = folder / entry.name
        if entry.name != file.name and not link.exists():
            link.symlink_to(entry)
    copy = folder / file.with_suffix("" if file.suffix == ".gz" else file.suffix).name
    copy.write_text(with_box_filter(read_text(file), file), encoding="utf-8")
    return copy
