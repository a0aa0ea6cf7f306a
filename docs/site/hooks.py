"""What MkDocs needs to know of these pages, which are written for a code host as much as for the site.

- Links that lead out of docs/ lead to copies below source/: pages as they are, other text highlighted, folders as lists.
- Notebooks become pages.
- Pages below generated/, which docs/site/build.sh wrote, join.
- Lists, tables and code follow a paragraph without an empty line on a code host; Python-Markdown asks for one.
"""

from __future__ import annotations

import base64
import json
import os
import posixpath
import re
import shutil
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ROOT / "build/docs/generated"
LANGUAGES = {".cpp": "cpp", ".h": "cpp", ".py": "python", ".sh": "sh", ".txt": "text", ".pbrt": "text"}
NAMES = {"CMakeLists.txt": "cmake", "Makefile": "make"}
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s#]*)((?:#[^)\s]*)?\))")
CODE_SPAN = re.compile(r"(`+)(.+?)\1")
FENCE = re.compile(r"\s*(```+|~~~+)")
ITEM = re.compile(r"( *)([-*]|\d+\.) ")


def outside_of_code(text, change):
    """The text with `change` applied to its lines outside of fenced blocks; it gets the lines before, too."""
    lines, fence = [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if fence:
            if mark and line.strip() == fence:
                fence = None
        else:
            line = change(line, lines)
            if mark:
                fence = mark[1]
        lines.append(line)
    return "\n".join(lines)


def in_paragraph_of_item(lines):
    """Whether the last line is of an item's second paragraph, or a later one."""
    for line in reversed(lines):
        if ITEM.match(line):
            return False
        if not line.strip():
            return True
    return False


def as_python_markdown(text):
    """Empty lines before lists, tables and code; four spaces before what is in an item; bare | in code of tables."""

    def change(line, before):
        last = before[-1] if before else ""
        item, table = ITEM.match(line), line.startswith("|")
        if item and item[1]:
            line = "    " * (1 if len(item[1]) < 4 else len(item[1]) // 4) + line.lstrip()
        elif re.match(r" {2,3}\S", line) and not FENCE.match(line):
            said = next((b for b in reversed(before) if b.strip()), "")
            if ITEM.match(said) or said.startswith("  "):  # a paragraph of an item
                line = "    " + line.lstrip()
        if table:
            line = CODE_SPAN.sub(lambda m: m[0].replace(r"\|", "|"), line)
        continued = ITEM.match(last) or (last.startswith(" ") and not in_paragraph_of_item(before))
        starts = (item and not continued) or (table and not last.startswith("|")) or FENCE.match(line)
        if starts and last.strip() and not (FENCE.match(line) and line.startswith(" ")):
            before.append("")
        return line

    return outside_of_code(text, change)


class Sources:
    """The files outside of docs/ that pages link to, and their pages."""

    def __init__(self):
        self.pages = {}  # path in the repository (of a page of the site): address of the page in the site
        self.paths = {}  # the other way

    def address(self, path):
        """The page, relative to the site, of what lies in the repository at `path`; None where there is none."""
        if path == "docs" or path.startswith("docs/"):
            inside = posixpath.relpath(path, "docs")
            if inside == ".":
                return "README.md"
            return inside[: -len(".ipynb")] + ".md" if inside.endswith(".ipynb") else inside
        file = ROOT / path
        if file.is_dir():
            page = f"source/{path}/README.md" if path != "." else "source/README.md"
            path = posixpath.join(path, "README.md") if (file / "README.md").exists() else path
        elif not file.is_file() or file.stat().st_size > 300_000:
            return None
        else:
            page = f"source/{path}" if path.endswith(".md") else f"source/{path}.md"
        if path not in self.pages:
            self.pages[path] = page
            self.paths[page] = path
        return page

    def text(self, path):
        """The page of a file or folder: Markdown with links as in the repository."""
        file = ROOT / path
        if path.endswith(".md"):
            return file.read_text(encoding="utf-8")
        if file.is_dir():
            entries = sorted(e.name for e in file.iterdir() if not e.name.startswith((".", "__")))
            return f"# {path}/\n\n" + "\n".join(f"- [{e}]({e})" for e in entries if self.is_text(file / e)) + "\n"
        language = NAMES.get(file.name, LANGUAGES.get(file.suffix, "text"))
        code = file.read_text(encoding="utf-8", errors="replace")
        return f"---\nsearch: {{exclude: true}}\n---\n# {path}\n\n````{language}\n{code}\n````\n"

    @staticmethod
    def is_text(file):
        return file.is_dir() or file.suffix in LANGUAGES or file.name in NAMES or file.suffix == ".md"

    def with_links(self, text, path, page):
        """The text of the page of the repository's `path`, its links leading to pages of the site."""

        def link(match):
            before, url, after = match.groups()
            if not url or re.match(r"[a-z]+:", url):
                return match[0]
            folder = path if (ROOT / path).is_dir() else posixpath.dirname(path)
            target = posixpath.normpath(posixpath.join(folder, url))
            address = self.address(target)
            if address is None:
                return match[0]
            return before + posixpath.relpath(address, posixpath.dirname(page) or ".") + after

        def change(line, _before):
            spans = []
            hidden = CODE_SPAN.sub(lambda m: spans.append(m[0]) or f"\0{len(spans) - 1}\0", line)
            # Links whose text is code: what is hidden holds no brackets.
            return re.sub(r"\0(\d+)\0", lambda m: spans[int(m[1])], LINK.sub(link, hidden))

        return outside_of_code(text, change)


def notebook_page(file, name):
    """A notebook as a page: what its cells say, compute and print; pictures are part of it."""
    parts = []
    for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                image = base64.b64encode(base64.b64decode("".join(data["image/png"]))).decode()
                parts.append(f'<img alt="" src="data:image/png;base64,{image}">')
            else:
                text = "".join(output.get("text", data.get("text/plain", [])))
                parts.append(f"```text\n{text.rstrip()}\n```")
    parts.append(f"The notebook itself: [{name}.ipynb]({name}.ipynb)")
    return "\n\n".join(parts) + "\n"


def on_files(files, config):
    sources = config.extra["sources"] = Sources()
    for file in list(files):
        if file.src_uri.endswith(".ipynb"):
            name = posixpath.basename(file.src_uri)[: -len(".ipynb")]
            page = posixpath.splitext(file.src_uri)[0] + ".md"
            files.append(File.generated(config, page, content=notebook_page(Path(file.abs_src_path), name)))
    for file in sorted(GENERATED.glob("*.md")):
        files.append(File.generated(config, f"generated/{file.name}", content=file.read_text(encoding="utf-8")))
    # Pages link to sources, and READMEs among these to more.
    for file in files.documentation_pages():
        sources.with_links(file.content_string, f"docs/{file.src_uri}", file.src_uri)
    sources.address("README.md")
    done = set()
    while len(done) < len(sources.pages):
        for path, page in list(sources.pages.items()):
            if path not in done:
                done.add(path)
                text = sources.text(path)
                if path.endswith(".md") or (ROOT / path).is_dir():
                    sources.with_links(text, path, page)
                files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown, page, config, files):
    sources, address = config.extra["sources"], page.file.src_uri
    path = sources.paths.get(address, f"docs/{address}")
    if address.startswith("generated/"):
        return markdown
    if not address.startswith("source/") or path.endswith(".md") or (ROOT / path).is_dir():
        markdown = sources.with_links(markdown, path, address)
        if address.startswith("notebooks/"):  # the file to download
            name = posixpath.basename(address)[: -len(".md")]
            markdown = markdown.replace(f"[{name}.ipynb]({name}.md)", f"[{name}.ipynb]({name}.ipynb)")
    return as_python_markdown(markdown)


def on_post_build(config):
    """The pages of Doxygen, beside those of MkDocs."""
    made = ROOT / "build/docs/cpp"
    if made.is_dir():
        shutil.copytree(made, os.path.join(config.site_dir, "cpp"), dirs_exist_ok=True)
