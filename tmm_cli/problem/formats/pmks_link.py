"""PMKS+: a saved link, or the text of a .pmks file, which is its part behind the question mark.

PMKS-Web/PMKSWeb, src/app/services/transcoding/string-transcoder.ts: settings, joints, links and forces are parted by
full stops, numbers written to the base 64 in thousandths, negative ones behind a zero.
"""

from __future__ import annotations

import re
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats.foreign import Foreign, Length
from tmm_cli.problem.formats.pmks import Force, Joint, Link, Saved, foreign

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"
FORM = re.compile(r"(?:https?://[^\s?]*\?)?([\w-]+\.[\w,-]*\.[\w,-]*\.[\w-]*\.\S*)\s*")
LENGTHS: Final[tuple[Length, ...]] = ("in", "cm", "m")
MOST = 100_000
LONGEST = 10  # characters of a number: as many as a mechanism can have


def recognised(text: str) -> bool:
    """Whether the text is of this format."""
    return len(text) < MOST and FORM.fullmatch(text.strip()) is not None


def read(text: str, file: str) -> Foreign:
    """The mechanism of a file. Raises ProblemError."""
    found = FORM.fullmatch(text.strip())
    assert found is not None
    content = found[1]
    if DIGITS[(len(content) - 1) % 62] != content[-1]:
        raise ProblemError(
            _("this link is not whole: its last character does not fit its length"), found=repr(content[-1]),
            allowed=_("a link as PMKS+ copies it, or its file .pmks"), file=file,
        )  # fmt: skip
    try:
        return foreign(_saved(content[:-1]), file)
    except (ValueError, IndexError):
        raise ProblemError(_("this link of PMKS+ cannot be read"), file=file) from None


def _saved(content: str) -> Saved:
    flags, __, whole, words, rest = content.split(".", 4)
    on = _number(flags, signed=False)
    joints, rest = _items(rest)
    links, rest = _items(rest)
    forces, rest = _items(rest)
    speed, made = _number(whole.split(",")[0]), [_link(item) for item in links]
    return Saved(
        tuple(_joint(item) for item in joints), tuple(link for link, root in made if root),
        tuple(_force(item) for item in forces), -speed if on & 1 else speed, bool(on & 2),
        LENGTHS[_number(words[0])], _number(words[2]) == 0,
    )  # fmt: skip


def _items(rest: str) -> tuple[list[str], str]:
    """Joints, links or forces, and what comes after: each ends with a full stop, and all of them with one more."""
    found = []
    while rest and rest[0] != ".":
        item, __, rest = rest.partition(".")
        found.append(item)
    return found, rest[1:]


def _number(text: str, *, signed: bool = True) -> int:
    """Raises ValueError."""
    if len(text) > LONGEST:
        raise ValueError
    negative = signed and text[:1] == "0"
    found = 0
    for char in text[negative:]:
        found = found * 64 + DIGITS.index(char)
    return -found if negative else found


def _decimal(text: str) -> float:
    return _number(text) / 1000


def _joint(item: str) -> Joint:
    flags, (name, __, x, y, angle) = _number(item[0], signed=False), item[1:].split(",")[:5]
    return Joint(
        name, complex(_decimal(x), _decimal(y)), bool(flags & 1), bool(flags & 4), bool(flags & 2), _decimal(angle)
    )


def _link(item: str) -> tuple[Link, bool]:
    """And whether it is one of its own, not welded into another."""
    name, label, mass, inertia, x, y, __, *others = item[2:].split(",")
    joints = others[: others.index("")] if "" in others else others
    centre = complex(_decimal(x), _decimal(y))
    return Link(name, tuple(joints), item[1] == "P", _decimal(mass), _decimal(inertia), centre, label), item[0] == "Y"


def _force(item: str) -> Force:
    flags, parts = _number(item[0], signed=False), item[1:].split(",")
    x0, y0, x1, y1, size = map(_decimal, parts[3:8])
    return Force(parts[0], parts[1], complex(x0, y0), complex(x1, y1), bool(flags & 1), bool(flags & 2), size)
