"""The page of all C++ headers, room by room: cpp_page.py TAG-FILE-OF-DOXYGEN > PAGE. Needs the standard library only."""

from __future__ import annotations

import html
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

INTRODUCTION = """# The C++ headers

What programs include first:

| header | for |
|---|---|
| {integrate} | integrals: `integrate(f, domain, method, budget)` ([guide](../integration.md)) |
| {integrate_log} | integrals of exp(log f) |
| {distribution} | random variables ([guide](../distributions.md)) |
| {point_set} | low-discrepancy points ([guide](../random.md)) |
| {chi_squared} | chi-squared tests of samplers |
| {load_scene} | scenes from files |
| {session} | renders ([architecture](../architecture.md)) |
| {bake} | prefiltered maps ([guide](../baking.md)) |

[Classes](../cpp/annotated.html){{.doxygen}}, [functions](../cpp/namespacemembers.html){{.doxygen}} and
[files](../cpp/files.html){{.doxygen}} in alphabetical order, with a search of their own. Below are all headers by
[room](../architecture.md#rooms), with the first sentence of each.
"""
FIRST = {
    "integrate": "mc/integrate/integrate.h",
    "integrate_log": "mc/integrate/integrate_log.h",
    "distribution": "mc/dist/distribution.h",
    "point_set": "mc/random/point_set.h",
    "chi_squared": "mc/stats/chi_squared.h",
    "load_scene": "formats/load_scene.h",
    "session": "render/render_session.h",
    "bake": "bake/environment_map.h",
}


def purpose(header):
    """The first sentence of a header."""
    text = []
    for line in header.read_text(encoding="utf-8").split("\n"):
        if not line.startswith("//"):
            break
        text.append(line[2:].strip())
    return re.split(r"(?<=[.;]) (?=[A-Z])|\.$", " ".join(text), maxsplit=1)[0].rstrip(".")


def main():
    tags = Path(sys.argv[1]).read_text(encoding="utf-8")
    pages = {}
    for name, folder, page in re.findall(
        r'<compound kind="file">\s*<name>(.*?)</name>\s*<path>(.*?)</path>\s*<filename>(.*?)</filename>', tags
    ):
        path = Path(html.unescape(folder)) / name
        pages[path.relative_to(ROOT / "montelux").as_posix()] = page

    def link(path, text=None):
        # HTML, because MkDocs knows nothing of Doxygen's pages.
        return f'<a href="../cpp/{pages[path]}"><code>{text or path}</code></a>'

    table = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    rooms = re.findall(r"^\s*montelux_room\((\S+)", re.sub(r"#.*", "", table), flags=re.M)
    text = INTRODUCTION.format(**{key: link(path, f"montelux/{path}") for key, path in FIRST.items()})
    text = re.sub(r"\[([^\]]*)\]\((\.\./cpp/[^)]*)\)\{\.doxygen\}", r'<a href="\2">\1</a>', text)
    left = set(pages)
    for room in rooms:
        mine = sorted(path for path in left if path.startswith(room + "/"))
        left -= set(mine)
        text += f"\n## {room}\n\n| header | |\n|---|---|\n"
        for path in mine:
            sentence = purpose(ROOT / "montelux" / path).replace("|", "\\|").replace("<", "&lt;")
            text += f"| {link(path)} | {sentence} |\n"
    if left:
        sys.exit(f"cpp_page.py: no room has {sorted(left)[0]} ({len(left)} headers)")
    print(text, end="")


main()
