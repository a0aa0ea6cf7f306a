"""Links of the pages lead somewhere, and the site's table of contents names every page.

    python3 test/docs/links_test.py

All *.md files and notebooks of the repository: relative links, pictures and headings (as a code host names them), in
Markdown and HTML. Needs neither a network nor more than the standard library.
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]
TEXT = r"\[(?:[^\[\]]|\[[^\]]*\])*\]"  # of a link; may hold a picture
TARGETS = (
    re.compile(TEXT + r"\(\s*<?([^\s<>()]*(?:\([^\s()]*\)[^\s<>()]*)*)>?(?:\s+[\"'][^)]*)?\)"),
    re.compile(r"^\s{0,3}\[[^\]]+\]:\s*<?([^\s>]+)"),  # a definition, [name]: target
    re.compile(r"<(?:a|img)\b[^>]*?\b(?:href|src)=[\"']([^\"']+)", re.I),
)
GENERATED = "generated/"  # pages of the site that docs/site/build.sh writes


def lines_of(file):
    """(line number, line) of a page outside of fenced code, with code spans emptied."""
    if file.suffix == ".ipynb":
        cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
        text = "\n\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    else:
        text = file.read_text(encoding="utf-8")
    fence = None
    for number, line in enumerate(text.split("\n"), 1):
        mark = re.match(r"\s*(`{3,}|~{3,})", line)
        if fence:
            if mark and mark[1].startswith(fence) and not line.strip().strip(fence[0]):
                fence = None
        elif mark:
            fence = mark[1]
        else:
            yield number, line


def without_code(line):
    return re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "", line)


def targets(line):
    """What a line links to; of a picture within a link both."""
    line, found = without_code(line), []
    for pattern in TARGETS:
        found += pattern.findall(line)
    inner = re.findall(r"!\[[^\]]*\]\(([^)\s]+)", line)
    return found + [target for target in inner if target not in found]


def anchors(file):
    """The names that a code host gives to the headings of a page."""
    names, seen = set(), {}
    for _number, line in lines_of(file):
        names.update(re.findall(r"<a\b[^>]*\b(?:id|name)=[\"']([^\"']+)", line))
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*\s*$", line)
        if not heading:
            continue
        text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
        name = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        count = seen.get(name, 0)
        seen[name] = count + 1
        names.add(f"{name}-{count}" if count else name)
    return names


def exists(path):
    """Whether there is such a file, in these capitals: not all file systems ask for them."""
    path = Path(os.path.normpath(path))
    return path.exists() and (path == path.parent or path.name in os.listdir(path.parent))


def broken_links(pages, root):
    """One sentence for each link that leads nowhere."""
    known, wrong = {}, []
    for page in pages:
        for number, line in lines_of(page):
            for target in targets(line):
                if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:|//", target):
                    continue
                where = f"{page.relative_to(root).as_posix()}:{number}"
                path, _, anchor = unquote(target).partition("#")
                if path.startswith("/"):
                    wrong.append(f"{where}: {target} is absolute; expected a path from the page")
                    continue
                file = Path(os.path.normpath(page.parent / path)) if path else page
                if not exists(file):
                    wrong.append(f"{where}: there is no {target}")
                elif not file.is_relative_to(root):
                    wrong.append(f"{where}: {target} is outside of the repository")
                elif anchor and file.suffix == ".md":
                    if file not in known:
                        known[file] = anchors(file)
                    if anchor not in known[file]:
                        wrong.append(f"{where}: there is no heading {target}")
    return wrong


def nav_entries(text):
    """The pages of the nav of mkdocs.yml, in order: what ends in .md in its list."""
    nav = re.search(r"^nav:\n((?:[ #].*\n|\n)*)", text, flags=re.M)
    return re.findall(r"^\s*-(?:[^#\n]*:)?\s*([^\s:#]+\.md)\s*$", nav[1], flags=re.M) if nav else []


def wrong_nav(entries, docs):
    """Pages of docs that the nav misses or names twice, and entries without a page."""
    pages = {p.relative_to(docs).with_suffix(".md").as_posix() for p in pages_below(docs)}
    wrong = [f"mkdocs.yml: the nav has no {page}" for page in sorted(pages - set(entries))]
    wrong += [f"mkdocs.yml: the nav has {e} twice" for e in sorted(set(entries)) if entries.count(e) > 1]
    for entry in entries:
        source = docs.parent / entry[len("source/") :] if entry.startswith("source/") else docs / entry
        if not entry.startswith(GENERATED) and entry not in pages and not source.is_file():
            wrong.append(f"mkdocs.yml: there is no page {entry}")
    return wrong


def pages_below(root):
    """The pages and notebooks below a folder, without builds and hidden folders."""
    found = []
    for folder, inner, names in os.walk(root):
        inner[:] = sorted(n for n in inner if not n.startswith(".") and n not in ("build", "node_modules"))
        found += [Path(folder, n) for n in sorted(names) if n.endswith((".md", ".ipynb"))]
    return found


class Repository(unittest.TestCase):
    def test_links_lead_somewhere(self):
        pages = pages_below(ROOT)
        self.assertGreater(len(pages), 40)
        self.assertEqual("\n".join(broken_links(pages, ROOT)), "")

    def test_nav_names_every_page(self):
        entries = nav_entries((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
        self.assertGreater(len(entries), 40)
        self.assertEqual("\n".join(wrong_nav(entries, ROOT / "docs")), "")

    def test_contents_link_to_every_page(self):
        """docs/README.md, the nav of those who read on a code host."""
        docs = ROOT / "docs"
        linked = set()
        for _number, line in lines_of(docs / "README.md"):
            linked |= {os.path.normpath(docs / target.partition("#")[0]) for target in targets(line)}
        missing = [
            str(p.relative_to(docs)) for p in pages_below(docs) if str(p) not in linked and p.name != "README.md"
        ]
        self.assertEqual(missing, [])


class Rules(unittest.TestCase):
    """Each finds the offence that it exists for."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name).resolve()
        (self.root / "docs/images").mkdir(parents=True)
        (self.root / "docs/images/a.png").touch()
        self.write("README.md", "# One\n\n## Two, `three`: [4](a:b) & 5\n\n## One\n")

    def write(self, name, text):
        file = self.root / name
        file.write_text(text, encoding="utf-8")
        return file

    def wrong(self, text, name="docs/page.md"):
        return broken_links([self.write(name, text)], self.root)

    def test_right_links(self):
        right = """[a](../README.md#one), [b](../README.md#one-1), ![c](images/a.png "title"), [d](../README.md#two-three-4--5)
[![e](images/a.png)](../README.md) <img src="images/a.png"> [f](https://a.b/c_(d)) [g]: <images/a.png> `[h](no.md)`
[i](#here), [j](images), [`k`](page.md)
```
[l](no.md)
```
# Here
"""
        self.assertEqual(self.wrong(right), [])

    def test_broken_links(self):
        for link in (
            "[a](no.md)",
            "![a](no.png)",
            "[![a](no.png)](../README.md)",
            "[![a](images/a.png)](no.md)",
            '[a](no.md "title")',
            "[a]: no.md",
            '<img alt="" src="no.png">',
            "[a](#no)",
            "[a](../README.md#no)",
            "[a](../README.md#one-2)",
            "[a](../readme.md)",
            "[a](/README.md)",
            "[a](../../)",
            "`code` [a](no.md) `code`",
        ):
            self.assertEqual(len(self.wrong(f"text\n{link}")), 1, link)
        self.assertEqual(self.wrong("\n[a](no.md)"), ["docs/page.md:2: there is no no.md"])

    def test_broken_links_of_notebooks(self):
        cells = [{"cell_type": "code", "source": ["[a](no.md)"]}, {"cell_type": "markdown", "source": ["[b](no.md)"]}]
        self.assertEqual(len(self.wrong(json.dumps({"cells": cells}), "docs/a.ipynb")), 1)

    def test_nav(self):
        self.write("docs/a.md", "")
        self.write("docs/b.md", "")
        nav = "x: 1\nnav:\n  - Start:\n      - a.md\n      # - b.md\n      - Title: source/README.md\n      - generated/c.md\n"
        self.assertEqual(nav_entries(nav + "plugins: [d.md]\n"), ["a.md", "source/README.md", "generated/c.md"])
        self.assertEqual(wrong_nav(nav_entries(nav), self.root / "docs"), ["mkdocs.yml: the nav has no b.md"])
        self.assertEqual(len(wrong_nav(["a.md", "b.md", "b.md", "no.md", "source/no.md"], self.root / "docs")), 3)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--buffer", *sys.argv[1:]])
