"""Text of a pbrt-v4 scene as a sequence of directives."""

from __future__ import annotations

import gzip
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterator, List, Tuple, Union

Value = Union[float, str, bool]

# How many quoted strings a directive begins with, and how many numbers.
STRINGS = {
    name: count
    for count, names in {
        0: "AttributeBegin AttributeEnd TransformBegin TransformEnd WorldBegin WorldEnd Identity ReverseOrientation "
        "ObjectEnd Option Translate Scale Rotate LookAt Transform ConcatTransform TransformTimes",
        1: "Accelerator AreaLightSource Attribute Camera ColorSpace CoordinateSystem CoordSysTransform Film Import "
        "Include Integrator LightSource MakeNamedMaterial MakeNamedMedium Material MediumInterface NamedMaterial "
        "ObjectBegin ObjectInstance PixelFilter Sampler Shape",
        3: "Texture",
    }.items()
    for name in names.split()
}
NUMBERS = {
    "Translate": 3,
    "Scale": 3,
    "Rotate": 4,
    "LookAt": 9,
    "Transform": 16,
    "ConcatTransform": 16,
    "TransformTimes": 2,
}
TOKEN = re.compile(r'"(?:[^"\\\n]|\\.)*"|[\[\]]|#[^\n]*|[^\s\[\]"#]+|"')
INCLUDE_DEPTH = 64


class SceneError(Exception):
    """A scene that cannot be read; the message begins with the place."""


@dataclass
class Parameter:
    type: str
    values: List[Value]


@dataclass
class Directive:
    name: str
    strings: List[str]
    numbers: List[float]
    parameters: Dict[str, Parameter]
    file: Path
    line: int
    span: Tuple[int, int] = field(default=(0, 0))  # characters of the file's text

    @property
    def place(self) -> str:
        return f"{self.file}:{self.line}"


def read_text(path: Path) -> str:
    """A scene file; .gz is unpacked."""
    try:
        data = path.read_bytes()
        if path.suffix == ".gz":
            data = gzip.decompress(data)
    except (OSError, EOFError) as error:
        raise SceneError(f"{path}: {error}") from error
    return data.decode("utf-8", errors="replace")


class _Reader:
    """Tokens of one file with one token of lookahead."""

    def __init__(self, text: str, file: Path) -> None:
        self.text, self.file = text, file
        self.tokens = (m for m in TOKEN.finditer(text) if not m[0].startswith("#"))
        self.line, self.counted = 1, 0  # the line of the character `counted`
        self.end = 0
        self.ahead = next(self.tokens, None)

    def peek(self) -> str:
        return self.ahead[0] if self.ahead else ""

    def take(self) -> str:
        if self.ahead is None:
            raise SceneError(f"{self.file}: the file ends within a directive")
        token = self.ahead[0]
        self.end = self.ahead.end()
        self.ahead = next(self.tokens, None)
        return token

    def line_ahead(self) -> int:
        """The line of the next token."""
        start = self.ahead.start() if self.ahead else len(self.text)
        self.line += self.text.count("\n", self.counted, start)
        self.counted = start
        return self.line

    def string(self) -> str:
        token = self.take()
        if len(token) < 2 or token[0] != '"':
            raise SceneError(f"{self.file}:{self.line_ahead()}: expected a quoted string, found {token}")
        return token[1:-1]

    def number(self) -> float:
        token = self.take()
        try:
            return float(token)
        except ValueError:
            raise SceneError(f"{self.file}:{self.line_ahead()}: expected a number, found {token}") from None

    def parameter(self) -> Tuple[str, Parameter]:
        line = self.line_ahead()
        declared = self.string().split()
        if len(declared) != 2:
            raise SceneError(f'{self.file}:{line}: expected "type name", found "{" ".join(declared)}"')
        tokens = []
        if self.peek() == "[":
            self.take()
            while self.peek() != "]":
                tokens.append(self.take())
            self.take()
        else:
            tokens.append(self.take())
        try:
            return declared[1], Parameter(declared[0], _values(declared[0], tokens))
        except ValueError as error:
            raise SceneError(f"{self.file}:{line}: parameter {declared[1]}: {error}") from None


def _values(type_: str, tokens: List[str]) -> List[Value]:
    quoted = [t[1:-1] if t[0] == '"' else t for t in tokens]
    if type_ in ("string", "texture"):
        return list(quoted)
    if type_ == "bool":
        if not set(quoted) <= {"true", "false"}:
            raise ValueError(f"expected true or false, found {' '.join(quoted)}")
        return [t == "true" for t in quoted]
    if type_ == "spectrum" and tokens and tokens[0][0] == '"':
        return list(quoted)
    return [float(t) for t in tokens]


def _directive(reader: _Reader) -> Directive:
    start, line = (reader.ahead.start() if reader.ahead else 0), reader.line_ahead()
    name = reader.take()
    if name == "ActiveTransform":
        return Directive(name, [reader.take()], [], {}, reader.file, line, (start, reader.end))
    if name not in STRINGS:
        raise SceneError(f"{reader.file}:{line}: unknown directive {name}")
    strings = [reader.string() for _ in range(STRINGS[name])]
    if name == "MediumInterface" and reader.peek()[:1] == '"':
        strings.append(reader.string())
    numbers: List[float] = []
    if name in NUMBERS:
        bracketed = reader.peek() == "["
        if bracketed:
            reader.take()
        numbers = [reader.number() for _ in range(NUMBERS[name])]
        if bracketed and reader.take() != "]":
            raise SceneError(f"{reader.file}:{line}: {name} has more than {NUMBERS[name]} numbers")
    parameters: Dict[str, Parameter] = {}
    while reader.peek()[:1] == '"':
        key, parameter = reader.parameter()
        parameters[key] = parameter
    return Directive(name, strings, numbers, parameters, reader.file, line, (start, reader.end))


def directives_of(text: str, file: Path) -> Iterator[Directive]:
    """The directives of one text; Include is one of them."""
    reader = _Reader(text, file)
    while reader.ahead is not None:
        yield _directive(reader)


def directives(file: Path, _folder: Union[Path, None] = None, _depth: int = 0) -> Iterator[Directive]:
    """The directives of a scene, with those of the files that it includes. Names are relative to the first file."""
    folder = file.parent if _folder is None else _folder
    if _depth > INCLUDE_DEPTH:
        raise SceneError(f"{file}: files include one another more than {INCLUDE_DEPTH} deep")
    for directive in directives_of(read_text(file), file):
        if directive.name in ("Include", "Import"):
            yield from directives(folder / directive.strings[0], folder, _depth + 1)
        else:
            yield directive
