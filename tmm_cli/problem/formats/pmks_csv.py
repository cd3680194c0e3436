"""PMKS+: the CSV files that it saved before its links (PMKS-Web/PMKSWeb, toolbar.component.ts of 2022)."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping

from tmm_cli.language import _
from tmm_cli.problem.errors import Mark, ProblemError, quote
from tmm_cli.problem.formats.foreign import Foreign
from tmm_cli.problem.formats.pmks import Force, Joint, Link, Saved, foreign
from tmm_cli.problem.values import LARGEST

PARTS = ("joints", "links", "forces", "pathPoints", "threePositions", "settings")
MOST = 1000  # rows
Row = tuple[int, Mapping[str, str]]


def recognised(text: str) -> bool:
    """Whether the text is of this format."""
    return re.match(r"\ufeff?joints\s*\r?\nid,", text) is not None


def read(text: str, file: str) -> Foreign:
    """The mechanism of a file. Raises ProblemError."""
    rows = _rows(text, file)
    joints = tuple(
        Joint(
            row["id"],
            complex(*_numbers(row, ("x", "y"), file, n)),
            row["type"] == "P",
            _true(row["ground"]),
            _true(row["input"]),
            _numbers(row, ("angle",), file, n)[0],
        )
        for n, row in rows["joints"]
    )
    links = tuple(_link(row, file, n) for n, row in rows["links"])
    forces = tuple(
        Force(
            row["id"],
            row["link"],
            complex(*_numbers(row, ("startx", "starty"), file, n)),
            complex(*_numbers(row, ("endx", "endy"), file, n)),
            not _true(row["fixed"]),
            _true(row["direction"]),
            _numbers(row, ("mag",), file, n)[0],
        )
        for n, row in rows["forces"]
    )
    notes = [_("CSV files of PMKS+ say no units: lengths are taken for cm.")]
    rpm, gravity = 10.0, False
    for n, row in rows["settings"]:
        rpm = _numbers(row, ("input_speed",), file, n)[0] * (-1 if _true(row.get("clockwise", "")) else 1)
        gravity = _true(row.get("gravity", ""))
    if not rows["settings"]:
        notes.append(_("The file says no speed: 10 rpm, with which PMKS+ begins, is put there."))
    return foreign(Saved(joints, links, forces, rpm, gravity, "cm", notes=tuple(notes)), file)


def _link(row: Mapping[str, str], file: str, n: int) -> Link:
    mass, inertia = _numbers(row, ("mass", "mass_moi"), file, n)
    centre = complex(*_numbers(row, ("center_of_mass_x", "center_of_mass_y"), file, n))
    return Link(row["id"], tuple(row["joints"].split(",")), row["type"] == "P", mass, inertia, centre)


def _rows(text: str, file: str) -> dict[str, list[Row]]:
    """The rows of each part, by the keys of its head, with their lines."""
    found: dict[str, list[Row]] = {part: [] for part in PARTS}
    part, head = "", None
    reader = csv.reader(io.StringIO(text.removeprefix("\ufeff")))
    try:
        for cells in reader:
            if reader.line_num > MOST:
                raise ProblemError(_("this is too long: at most {max_length}").format(max_length=MOST), file=file)
            if len(cells) == 1 and cells[0].strip() in found:
                part, head = cells[0].strip(), None
            elif part and head is None:
                head = [cell.strip() for cell in cells]
            elif part and any(cells):
                assert head is not None
                row = dict(zip(head, (cell.strip() for cell in cells), strict=False))
                missing = _WANTED[part] - row.keys()
                if missing:
                    raise _refused(file, reader.line_num, _("cells are missing"), ", ".join(sorted(missing)))
                found[part].append((reader.line_num, row))
    except csv.Error:
        raise ProblemError(_("this is no CSV file"), file=file, mark=Mark(reader.line_num, 1)) from None
    return found


_WANTED = {part: set[str]() for part in PARTS} | {
    "joints": {"id", "x", "y", "type", "ground", "angle", "input"},
    "links": {"id", "type", "mass", "joints"},
    "forces": {"id", "link", "startx", "starty", "endx", "endy", "fixed", "direction", "mag"},
    "settings": {"input_speed"},
}


def _numbers(row: Mapping[str, str], keys: tuple[str, ...], file: str, line: int) -> tuple[float, ...]:
    """Of cells; one that is empty, or Null, is zero."""
    found = []
    for key in keys:
        text = row.get(key, "")
        try:
            number = 0.0 if text in ("", "Null", "undefined", "NaN") else float(text)
        except ValueError:
            raise _refused(file, line, _("a number is wanted"), quote(text), key) from None
        if not -LARGEST <= number <= LARGEST:
            raise _refused(file, line, _("this is too large for a mechanism"), quote(text), key)
        found.append(number)
    return tuple(found)


def _true(text: str) -> bool:
    return text.lower() == "true"


def _refused(file: str, line: int, message: str, found: str, key: str = "") -> ProblemError:
    return ProblemError(message, path=(key,) if key else (), found=found, file=file, mark=Mark(line, 1))
