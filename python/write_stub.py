"""Writes the types of the extension module: write_stub.py FOLDER-OF-THE-MODULE OUTPUT.

nanobind's generator does most of it; what it calls `object` may be anything here, and of the class of errors it
knows nothing.
"""

import re
import sys

from nanobind.stubgen import StubGen

sys.path.insert(0, sys.argv[1])
import _core  # noqa: E402  (without the package, which adds to its classes)

generator = StubGen(_core, include_private=True)
generator.put(_core)
text = generator.get()
error = f'class Error(RuntimeError):\n    """{_core.Error.__doc__}"""\n'
text = re.sub(r"^from (montelux|\.) import Error as Error\n", "", text, flags=re.M)
text = re.sub(r"^(?=class Domain:)", error + "\n", text, count=1, flags=re.M)
for found, meant in (
    (r"(-> |: )object\b", r"\1Any"),
    (r"\bdict(?=[:,)\s])", "dict[str, Any]"),
    (r"\btuple(?=[:,)\]\s](?!\[))", "tuple[Any, ...]"),
    (r"\bos\.PathLike\b(?!\[)", "os.PathLike[str]"),
    (r"\*\*(kwargs|attributes)\b", "**attributes: Any"),
    (r"typing\.Any", "Any"),
    (r"-> Any: \.\.\.$", r"-> Any: ..."),
):
    text = "\n".join(
        re.sub(found, meant, line) if re.match(r"\s*(def|@|\w+ ?:|class)", line) else line for line in text.split("\n")
    )
if not re.search(r"^from typing import .*\bAny\b", text, re.M):
    text = "from typing import Any\n" + text
with open(sys.argv[2], "w", encoding="utf-8") as file:
    file.write(text)
