"""A Mitsuba scene as one file, with a small film, box filter and independent samples, for both programs to read."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Dict, Iterator, List

# Of Mitsuba's films.
STANDARD_SIZE = (768, 576)


def _resolve(name: str, folders: List[Path]) -> Path:
    for folder in folders:
        if (folder / name).exists():
            return (folder / name).resolve()
    # Folders that were moved up, as montelux finds them.
    if name.startswith("../"):
        return _resolve(name[3:], folders)
    raise FileNotFoundError(f"{name} is in none of {', '.join(map(str, folders))}")


def _children(file: Path, main: Path) -> Iterator[ET.Element]:
    """The objects of a file, those of the files that it includes in their places, with absolute search paths."""
    folders = [file.parent, main]
    for element in ET.parse(file).getroot():
        if element.tag == "path":
            element.set("value", str(_resolve(element.get("value", ""), folders)))
            folders.append(Path(element.get("value", "")))
        if element.tag == "include":
            yield from _children(_resolve(element.get("filename", ""), folders), main)
        else:
            yield element


def _number(film: ET.Element, name: str, defaults: Dict[str, str], otherwise: int) -> int:
    for element in film.findall("integer"):
        if element.get("name") == name:
            text = element.get("value", "")
            return int(defaults.get(text[1:], otherwise)) if text.startswith("$") else int(text)
    return otherwise


def _shrink(film: ET.Element, defaults: Dict[str, str], side: int) -> None:
    size = [_number(film, n, defaults, s) for n, s in zip(("width", "height"), STANDARD_SIZE)]
    scale = min(1.0, side / max(size))
    for element in list(film):
        unwanted = element.get("name", "") in ("width", "height") or element.get("name", "").startswith("crop_")
        if unwanted or element.tag == "rfilter":
            film.remove(element)
    for name, pixels in zip(("width", "height"), size):
        ET.SubElement(film, "integer", name=name, value=str(max(1, round(pixels * scale))))
    ET.SubElement(film, "rfilter", type="box")


def prepared_scene(scene: Path, side: int) -> ET.Element:
    """The scene with films of at most `side` pixels on the longer side."""
    root = ET.Element("scene", version="3.0.0")
    root.extend(list(_children(scene, scene.parent)))
    root.insert(0, ET.Element("path", value=str(scene.parent.resolve())))
    defaults = {e.get("name", ""): e.get("value", "") for e in root.findall("default")}
    samplers = {e.get("id") for e in root.findall("sampler")}
    for sensor in root.findall("sensor"):
        for element in list(sensor):
            if element.tag == "sampler" or (element.tag == "ref" and element.get("id") in samplers):
                sensor.remove(element)
        ET.SubElement(sensor, "sampler", type="independent")
        film = sensor.find("film")
        if film is None:
            film = ET.SubElement(sensor, "film", type="hdrfilm")
        _shrink(film, defaults, side)
    return root


def with_moments(scene: ET.Element) -> ET.Element:
    """A copy whose integrator, without the layers of an `aov`, is wrapped in `moment`."""
    scene = copy.deepcopy(scene)
    inner = scene.find("integrator")
    if inner is None:
        inner = ET.Element("integrator", type="path")
    else:
        scene.remove(inner)
    while inner.get("type") in ("aov", "moment"):
        nested = inner.find("integrator")
        if nested is None:
            raise ValueError(f"the integrator {inner.get('type')!r} has none within")
        inner = nested
    inner.attrib.pop("id", None)
    inner.set("name", "nested")
    ET.SubElement(scene, "integrator", type="moment").append(inner)
    return scene


def write(scene: ET.Element, file: Path) -> None:
    ET.ElementTree(scene).write(file, encoding="unicode")
