"""PDF files with vector graphics, searchable text and embedded subsets of the TrueType fonts."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator, Sequence
from functools import cache, lru_cache
from itertools import accumulate
from pathlib import Path

import numpy as np
from matplotlib.colors import to_rgb

from tmm_cli.drawing.paper import (
    POINT,
    AreaMark,
    CircleMark,
    Drawing,
    LineMark,
    Mark,
    TextMark,
    baseline,
    font_file,
    letter_advance,
    load_font,
    replace_missing,
)

HINT_TABLES = ("cvt ", "fpgm", "prep")  # tables that the hinting instructions need
ARGUMENTS_ARE_WORDS, HAS_SCALE, MORE_COMPONENTS = 0x01, 0x08, 0x20  # flags of a component of a composite glyph
HAS_TWO_SCALES, HAS_MATRIX = 0x40, 0x80
HEAD_BYTES, MAXP_BYTES = 54, 32  # lengths of these tables
CHECKSUM_BASE = 0xB1B0AFBA  # constant of the TrueType specification for the checksum of the font


def subset_font(path: str, glyphs: Sequence[int]) -> bytes:
    """Return the bytes of a TrueType font file that contains only the given glyphs, in this order.

    Glyphs that are components of composite glyphs are appended after them.

    Args:
        path: file of the complete font.
        glyphs: numbers of the glyphs in that font.
    """
    tables = _read_tables(path)
    offsets = np.frombuffer(tables["loca"], ">u4" if tables["head"][51] else ">u2").astype(int)
    offsets *= 1 if tables["head"][51] else 2
    order, shapes = list(glyphs), list[bytes]()
    for glyph in order:  # grows as components are found
        shape = bytearray(tables["glyf"][offsets[glyph] : offsets[glyph + 1]])
        for at in _component_offsets(shape):
            order.append(struct.unpack_from(">H", shape, at)[0])
            struct.pack_into(">H", shape, at, len(order) - 1)
        shapes.append(bytes(shape) + bytes(-len(shape) % 4))
    (measured,) = struct.unpack_from(">H", tables["hhea"], 34)
    measures = [tables["hmtx"][4 * k : 4 * k + 4] for k in (min(glyph, measured - 1) for glyph in order)]
    count = struct.pack(">H", len(order))
    return _build_font(
        {
            **{name: tables[name] for name in HINT_TABLES if name in tables},
            "glyf": b"".join(shapes),
            "head": tables["head"][:8] + bytes(4) + tables["head"][12:50] + b"\x00\x01" + tables["head"][52:HEAD_BYTES],
            "hhea": tables["hhea"][:34] + count,
            "hmtx": b"".join(measures),
            "loca": np.cumsum([0, *map(len, shapes)]).astype(">u4").tobytes(),
            "maxp": tables["maxp"][:4] + count + tables["maxp"][6:MAXP_BYTES],
        }
    )


@lru_cache(4)
def _read_tables(path: str) -> dict[str, bytes]:
    data = Path(path).read_bytes()
    (count,) = struct.unpack_from(">H", data, 4)
    entries = (struct.unpack_from(">4s4xII", data, 12 + 16 * k) for k in range(count))
    return {name.decode("latin-1"): data[start : start + length] for name, start, length in entries}


def _component_offsets(shape: bytearray) -> Iterator[int]:
    """Yield the byte offsets at which a composite glyph stores its component numbers; none for a simple glyph."""
    if len(shape) < 10 or shape[0] < 0x80:  # not composite: the number of contours is not negative
        return
    at, more = 10, True
    while more:
        (flags,) = struct.unpack_from(">H", shape, at)
        yield at + 2
        at += 8 if flags & ARGUMENTS_ARE_WORDS else 6
        at += 2 if flags & HAS_SCALE else 4 if flags & HAS_TWO_SCALES else 8 if flags & HAS_MATRIX else 0
        more = bool(flags & MORE_COMPONENTS)


def _build_font(tables: dict[str, bytes]) -> bytes:
    power = len(tables).bit_length() - 1
    head = struct.pack(">IHHHH", 0x10000, len(tables), 16 << power, power, 16 * (len(tables) - (1 << power)))
    entries, body = [head], list[bytes]()
    start = place = len(head) + 16 * len(tables)
    for name, table in sorted(tables.items()):
        padded = table + bytes(-len(table) % 4)
        entries.append(struct.pack(">4sIII", name.encode(), _checksum(padded), start, len(table)))
        place = start if name == "head" else place
        body.append(padded)
        start += len(padded)
    font = bytearray(b"".join(entries + body))
    struct.pack_into(">I", font, place + 8, (CHECKSUM_BASE - _checksum(font)) % 2**32)
    return bytes(font)


def _checksum(data: bytes | bytearray) -> int:
    return int(np.frombuffer(data, ">u4").sum(dtype=np.uint64)) % 2**32


# Pages of drawings as PDF vector graphics with searchable text and embedded fonts.


CIRCLE_HANDLE = 0.5522847498  # of the radius: length of the handles of a Bézier quarter circle
ROUND_LINES = "1 J 1 j\n"  # round line caps and joins
SYMBOLIC_FLAG, ITALIC_FLAG = 4, 64
CAPITAL_HEIGHT = 729  # thousandths of the font size
STEM_WIDTH = 100  # thousandths of the font size: about the width of a stroke
Slant = tuple[bool, bool]  # bold, italic


def write_pdf(*drawings: Drawing) -> bytes:
    """Write drawings as one PDF file, each on a page of its own.

    The file has no date: the same drawings give the same bytes.
    """
    file, fonts = _PdfObjects(), _FontCodes()
    contents = [file.add(_stream(_page_content(drawing, fonts))) for drawing in drawings]
    used = "".join(f"/F{n} {_add_font(file, slant, codes)} 0 R" for n, (slant, codes) in enumerate(fonts.codes.items()))
    parent = file.count + len(drawings) + 1
    pages = [
        file.add(
            f"<</Type/Page/Parent {parent} 0 R/MediaBox[0 0 {' '.join(map(_format_length, drawing.paper))}]"
            f"/Resources<</Font<<{used}>>>>/Contents {content} 0 R>>"
        )
        for drawing, content in zip(drawings, contents, strict=True)
    ]
    kids = " ".join(f"{page} 0 R" for page in pages)
    file.add(f"<</Type/Pages/Count {len(pages)}/Kids[{kids}]>>")
    return file.finish(file.add(f"<</Type/Catalog/Pages {parent} 0 R>>"))


class _PdfObjects:
    """The numbered objects of a PDF file, collected in the order in which they are written."""

    def __init__(self) -> None:
        self.parts = [b"%PDF-1.4\n%\xb5\xb6\xb7\xb8\n"]

    @property
    def count(self) -> int:
        return len(self.parts) - 1

    def add(self, content: str | bytes) -> int:
        self.parts.append(b"%d 0 obj\n%b\nendobj\n" % (len(self.parts), _bytes(content)))
        return self.count

    def finish(self, root: int) -> bytes:
        """Complete the file with its cross-reference table and return its bytes.

        root: number of the catalogue object.
        """
        *offsets, end = accumulate(map(len, self.parts))
        table = b"".join(b"%010d 00000 n \n" % place for place in offsets)
        form = b"xref\n0 %d\n0000000000 65535 f \n%btrailer\n<</Size %d/Root %d 0 R>>\nstartxref\n%d\n%%%%EOF\n"
        return b"".join([*self.parts, form % (len(self.parts), table, len(self.parts), root, end)])


class _FontCodes:
    """Character codes of each font in the PDF file, assigned from 1 on in the order in which characters occur."""

    def __init__(self) -> None:
        self.codes: dict[Slant, dict[str, int]] = {}

    def encode(self, text: str, slant: Slant) -> tuple[int, str]:
        """Return the number of the font of this weight and slant, and the text in its character codes (hexadecimal)."""
        codes = self.codes.setdefault(slant, {})
        return list(self.codes).index(slant), "".join(
            f"{codes.setdefault(x, len(codes) + 1):04x}" for x in replace_missing(text)
        )


def _add_font(file: _PdfObjects, slant: Slant, codes: Iterable[str]) -> int:
    """Add a font to the PDF file and return its object number.

    Only the glyphs of the characters in `codes` are embedded.
    """
    face, letters = load_font(*slant), list(codes)
    outlines = subset_font(str(font_file(*slant)), [0, *(face.get_char_index(ord(letter)) for letter in letters)])
    tag, per = zlib.crc32(outlines), 1000 / face.units_per_EM
    name = "".join(chr(ord("A") + tag // 26**k % 26) for k in range(6)) + f"+{face.postscript_name}"
    box = " ".join(f"{per * side:.0f}" for side in face.bbox)
    embedded = file.add(_stream(outlines, f"/Length1 {len(outlines)}"))
    descriptor = file.add(
        f"<</Type/FontDescriptor/FontName/{name}/Flags {SYMBOLIC_FLAG + ITALIC_FLAG * slant[1]}/FontBBox[{box}]"
        f"/ItalicAngle {-11 * slant[1]}/Ascent {per * face.ascender:.0f}/Descent {per * face.descender:.0f}"
        f"/CapHeight {CAPITAL_HEIGHT}/StemV {STEM_WIDTH}/FontFile2 {embedded} 0 R>>"
    )
    widths = " ".join(f"{1000 * letter_advance(letter, *slant):.2f}" for letter in letters)
    descendant = file.add(
        f"<</Type/Font/Subtype/CIDFontType2/BaseFont/{name}/CIDToGIDMap/Identity/W[1[{widths}]]"
        f"/CIDSystemInfo<</Registry(Adobe)/Ordering(Identity)/Supplement 0>>/FontDescriptor {descriptor} 0 R>>"
    )
    characters = file.add(_stream(_character_map(letters)))
    return file.add(
        f"<</Type/Font/Subtype/Type0/BaseFont/{name}/Encoding/Identity-H/DescendantFonts[{descendant} 0 R]"
        f"/ToUnicode {characters} 0 R>>"
    )


def _character_map(letters: Sequence[str]) -> str:
    """Return the ToUnicode CMap of an embedded font, from which a reader extracts the text. Codes begin at 1."""
    lines = [f"<{code:04x}><{letter.encode('utf-16-be').hex()}>\n" for code, letter in enumerate(letters, 1)]
    blocks = [lines[k : k + 100] for k in range(0, len(lines), 100)]
    return (
        "/CIDInit /ProcSet findresource begin 12 dict begin begincmap\n"
        "/CIDSystemInfo<</Registry(Adobe)/Ordering(UCS)/Supplement 0>>def\n"
        "/CMapName/Adobe-Identity-UCS def/CMapType 2 def\n1 begincodespacerange\n<0000><ffff>\nendcodespacerange\n"
        + "".join(f"{len(block)} beginbfchar\n{''.join(block)}endbfchar\n" for block in blocks)
        + "endcmap CMapName currentdict/CMap defineresource pop end end"
    )


def _stream(content: str | bytes, about: str = "") -> bytes:
    packed = zlib.compress(_bytes(content))
    return b"<</Length %d/Filter/FlateDecode%b>>stream\n%b\nendstream" % (len(packed), _bytes(about), packed)


def _bytes(content: str | bytes) -> bytes:
    return content.encode("ascii") if isinstance(content, str) else content


def _page_content(drawing: Drawing, fonts: _FontCodes) -> str:
    """Return the content stream of a page. Operators for pen and colour are written only where they change."""
    current: dict[str, str] = {}
    lines = [ROUND_LINES]
    for mark in drawing.marks:
        states, shape = _mark_operators(mark, fonts)
        for kind, state in states:
            if current.get(kind) != state:
                current[kind] = state
                lines.append(f"{state}\n")
        lines.append(shape)
    return "".join(lines)


def _mark_operators(mark: Mark, fonts: _FontCodes) -> tuple[list[tuple[str, str]], str]:
    """Return the PDF operators that draw a mark.

    The first list sets pen, dashes and fill colour, as pairs (kind, operator). The second item draws the mark.
    """
    match mark:
        case LineMark():
            dashes = f"[{' '.join(map(_format_length, mark.dashes))}] 0 d"
            return [*_pen_states(mark.colour, mark.width), ("dashes", dashes)], f"{_path_operators(mark.places)}S\n"
        case AreaMark():
            states = [
                *(_pen_states(mark.edge, mark.width) if mark.edge else ()),
                ("dashes", "[] 0 d"),
                _fill_state(mark.face),
            ]
            return states, f"{_path_operators(mark.corners)}{'b' if mark.edge else 'f'}\n"
        case CircleMark():
            states = [*_pen_states(mark.edge, mark.width), ("dashes", "[] 0 d"), _fill_state(mark.face)]
            return states, f"{_circle_operators(mark.centre, mark.radius)}b\n"
        case TextMark():
            name, codes = fonts.encode(mark.text, (mark.bold, mark.italic))
            start, along = baseline(mark)
            turned = f"{along.real:.6f} {along.imag:.6f} {-along.imag:.6f} {along.real:.6f}"
            return [_fill_state(mark.colour)], (
                f"BT /F{name} {_format_length(mark.size)} Tf {turned} {_format_point(start)} Tm <{codes}> Tj ET\n"
            )


def _pen_states(colour: str, width: float) -> list[tuple[str, str]]:
    return [("colour", f"{_rgb(colour)} RG"), ("width", f"{_format_length(width)} w")]


def _fill_state(colour: str) -> tuple[str, str]:
    return "face", f"{_rgb(colour)} rg"


@cache
def _rgb(colour: str) -> str:
    return " ".join(f"{channel:.4g}" for channel in to_rgb(colour))


def _path_operators(points: Sequence[complex]) -> str:
    first, *others = map(_format_point, points)
    return f"{first} m\n" + "".join(f"{place} l\n" for place in others)


def _circle_operators(centre: complex, radius: float) -> str:
    """Return the PDF operators for a circle, approximated by four Bézier curves."""
    lines = [f"{_format_point(centre + radius)} m\n"]
    for k in range(4):
        axis_point = radius * 1j**k
        handles = (axis_point * (1 + CIRCLE_HANDLE * 1j), axis_point * (CIRCLE_HANDLE + 1j), axis_point * 1j)
        lines.append(" ".join(_format_point(centre + handle) for handle in handles) + " c\n")
    return "".join(lines)


def _format_point(place: complex) -> str:
    return f"{place.real / POINT:.3f} {place.imag / POINT:.3f}"


def _format_length(length: float) -> str:
    """Convert a length from mm to PDF points (1/72 inch) and format it."""
    return f"{length / POINT:.4f}".rstrip("0").rstrip(".")
