"""A TrueType font cut down to some letters, as PDF embeds it."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

AS_THEY_ARE = ("cvt ", "fpgm", "prep")  # what the hints of the letters need
WORDS, SCALED, MORE, TWO_SCALES, TWO_BY_TWO = 0x01, 0x08, 0x20, 0x40, 0x80  # of a part of a composite letter
HEAD, MAXP = 54, 32  # bytes
MAGIC = 0xB1B0AFBA  # what the sum of a font is subtracted from


def cut(path: str, wanted: Sequence[int]) -> bytes:
    """The font with these glyphs alone, in this order; parts of which they are composed come after them."""
    tables = _tables(path)
    offsets = np.frombuffer(tables["loca"], ">u4" if tables["head"][51] else ">u2").astype(int)
    offsets *= 1 if tables["head"][51] else 2
    order, shapes = list(wanted), list[bytes]()
    for glyph in order:  # grows while its parts are met
        shape = bytearray(tables["glyf"][offsets[glyph] : offsets[glyph + 1]])
        for at in _parts(shape):
            order.append(struct.unpack_from(">H", shape, at)[0])
            struct.pack_into(">H", shape, at, len(order) - 1)
        shapes.append(bytes(shape) + bytes(-len(shape) % 4))
    (measured,) = struct.unpack_from(">H", tables["hhea"], 34)
    measures = [tables["hmtx"][4 * k : 4 * k + 4] for k in (min(glyph, measured - 1) for glyph in order)]
    count = struct.pack(">H", len(order))
    return _joined({
        **{name: tables[name] for name in AS_THEY_ARE if name in tables},
        "glyf": b"".join(shapes),
        "head": tables["head"][:8] + bytes(4) + tables["head"][12:50] + b"\x00\x01" + tables["head"][52:HEAD],
        "hhea": tables["hhea"][:34] + count,
        "hmtx": b"".join(measures),
        "loca": np.cumsum([0, *map(len, shapes)]).astype(">u4").tobytes(),
        "maxp": tables["maxp"][:4] + count + tables["maxp"][6:MAXP],
    })  # fmt: skip


@lru_cache(4)
def _tables(path: str) -> dict[str, bytes]:
    data = Path(path).read_bytes()
    (count,) = struct.unpack_from(">H", data, 4)
    entries = (struct.unpack_from(">4s4xII", data, 12 + 16 * k) for k in range(count))
    return {name.decode("latin-1"): data[start : start + length] for name, start, length in entries}


def _parts(shape: bytearray) -> Iterator[int]:
    """Where a composite glyph says the numbers of its parts."""
    if len(shape) < 10 or shape[0] < 0x80:  # its number of contours is not negative
        return
    at, more = 10, True
    while more:
        (flags,) = struct.unpack_from(">H", shape, at)
        yield at + 2
        at += 8 if flags & WORDS else 6
        at += 2 if flags & SCALED else 4 if flags & TWO_SCALES else 8 if flags & TWO_BY_TWO else 0
        more = bool(flags & MORE)


def _joined(tables: dict[str, bytes]) -> bytes:
    """A font of these tables."""
    power = len(tables).bit_length() - 1
    head = struct.pack(">IHHHH", 0x10000, len(tables), 16 << power, power, 16 * (len(tables) - (1 << power)))
    entries, body = [head], list[bytes]()
    start = place = len(head) + 16 * len(tables)
    for name, table in sorted(tables.items()):
        padded = table + bytes(-len(table) % 4)
        entries.append(struct.pack(">4sIII", name.encode(), _sum(padded), start, len(table)))
        place = start if name == "head" else place
        body.append(padded)
        start += len(padded)
    font = bytearray(b"".join(entries + body))
    struct.pack_into(">I", font, place + 8, (MAGIC - _sum(font)) % 2**32)
    return bytes(font)


def _sum(data: bytes | bytearray) -> int:
    return int(np.frombuffer(data, ">u4").sum(dtype=np.uint64)) % 2**32
