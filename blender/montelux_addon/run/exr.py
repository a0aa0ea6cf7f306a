# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the EXR files that the program writes: one part, scan lines, no or deflate compression.

Blender's own reader gives the picture without the other layers, and makes a data-block in the user's file.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

MAGIC = 20000630
TILED, DEEP, PARTS = 0x200, 0x800, 0x1000
KINDS = (np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4"))
LINES_OF_A_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP


class ExrError(Exception):
    pass


class ExrPicture:
    """Channels by name as float32 arrays of shape (height, width), rows from the top."""

    def __init__(self, path: Path):
        data = path.read_bytes()
        try:
            self.channels = _read(data)
        except (struct.error, ValueError, KeyError, IndexError, zlib.error) as error:
            raise ExrError(f"{path} is no picture that can be read ({error})") from error

    def stack(self, *names: str) -> np.ndarray | None:
        """Channels side by side; None if one is missing."""
        if any(name not in self.channels for name in names):
            return None
        return np.stack([self.channels[name] for name in names], axis=-1)


def _text_at(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _read_header(data: bytes) -> tuple[dict[str, bytes], int]:
    magic, version = struct.unpack_from("<II", data)
    if magic != MAGIC or version & (TILED | DEEP | PARTS):
        raise ValueError("not an EXR file of one part with scan lines")
    attributes, at = {}, 8
    while data[at]:
        name, at = _text_at(data, at)
        _, at = _text_at(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def _read_channels(text: bytes) -> list[tuple[str, np.dtype]]:
    channels, at = [], 0
    while text[at]:
        name, at = _text_at(text, at)
        kind, _, x_step, y_step = struct.unpack_from("<iIii", text, at)
        if (x_step, y_step) != (1, 1):
            raise ValueError(f"channel {name} is subsampled")
        channels.append((name, KINDS[kind]))
        at += 16
    return channels


def _inflate(packed: bytes, size: int) -> bytes:
    """ZIP blocks: deflate, then differences of bytes, then bytes of even and odd places apart."""
    if len(packed) == size:
        return packed
    steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
    steps[1:] -= 128
    halves = np.cumsum(steps).astype(np.uint8)
    if halves.size != size:
        raise ValueError(f"a block has {halves.size} bytes; expected {size}")
    together = np.empty(size, np.uint8)
    middle = (size + 1) // 2
    together[0::2], together[1::2] = halves[:middle], halves[middle:]
    return together.tobytes()


def _read(data: bytes) -> dict[str, np.ndarray]:
    attributes, at = _read_header(data)
    channels = _read_channels(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    lines = LINES_OF_A_BLOCK[attributes["compression"][0]]
    picture = {name: np.empty((height, width), np.float32) for name, _ in channels}
    line_size = width * sum(kind.itemsize for _, kind in channels)
    blocks = -(-height // lines)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        top = y - y0
        count = min(lines, height - top)
        block = _inflate(data[offset + 8 : offset + 8 + size], count * line_size)
        place = 0
        for line in range(top, top + count):
            for name, kind in channels:
                picture[name][line] = np.frombuffer(block, kind, width, place)
                place += width * kind.itemsize
    return picture
