"""Reader of PMKS+ web links and .pmks files; a .pmks file contains the query part of such a link.

Source: PMKS-Web/Planar-Mechanism-Kinematic-Simulator, src/app/services/transcoding, string-transcoder.ts (records),
checksum.ts (check character, digest of autumn 2026), stored-settings.ts, precise-values.ts, gear-codec.ts,
structural-codec.ts, body-document-envelope.ts (pmks2:).

Settings, joints, links, forces, the selected object and a list of tagged entries are separated by full stops, fields
of a record by commas. Numbers are integers in base 64, in thousandths of the unit; a negative number begins with a
zero. Fields of the records (fields at the end of a record may be missing):

joint: flags and id, name, x, y, angle (rad), carrier and two joints of a slot, drive speed, mass of the block,
       whether a welded link stands on the slider, name of the machine
link:  flags and id, name, mass, moment of inertia, x and y of the centre of mass, colour, joints, an empty field, parts
force: flags and id, link, name, x and y of both ends, magnitude
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final
from urllib.parse import unquote

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.formats.imported_mechanism import ImportedMechanism, LengthUnit
from tmm_cli.problem.formats.pmks import PmksFile, PmksForce, PmksJoint, PmksLink, import_pmks
from tmm_cli.problem.values import LARGEST

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"
CHECKS = DIGITS[:62]
ADDRESS = r"(?:https?://[^\s?]*\?)?"
LINK_TEXT = re.compile(ADDRESS + r"([\w-]+\.[\w,-]*\.[\w,-]*\.[\w-]*\.[^\r\n#]*)(?:#\S*)?")
NEW_DOCUMENT = re.compile(ADDRESS + r"pmks2:[^\r\n]*")
LENGTHS: Final[tuple[LengthUnit, ...]] = ("in", "cm", "m")
MAX_TEXT_LENGTH = 100_000
MAX_NUMBER_LENGTH = 10  # characters of a number: as many as a mechanism can have
CLOCKWISE, GRAVITY_OFF = 1, 256  # flags of the file; 2 was gravity once and is dead
SLIDES, INPUT, GROUND, WELDED = 1, 2, 4, 8  # flags of a joint; 16: its path is drawn, 32: drawn as a cylinder
LOCAL, OUTWARD = 1, 2  # flags of a force
ROOT_LINKS, WELDED_LINKS = "YAMG0123", "Namg4567"  # first character of a link: of its own, or welded into another one
AUTOMATIC = {"A": "both", "1": "both", "M": "inertia", "2": "inertia", "G": "centre", "3": "centre"}
IGNORED_TAGS = "JLFCHK"  # tags of locks, anchors of centres of mass, held lengths, colours: they change no mechanism


def recognised(text: str) -> bool:
    """Return True if the text is a PMKS+ web link or a .pmks file."""
    text = text.strip()
    return len(text) < MAX_TEXT_LENGTH and (LINK_TEXT.fullmatch(text) or NEW_DOCUMENT.fullmatch(text)) is not None


def read(text: str, file: str) -> ImportedMechanism:
    """Read the mechanism from a PMKS+ web link or .pmks file. Raises ProblemError."""
    if NEW_DOCUMENT.fullmatch(text.strip()):
        raise ProblemError(
            _("documents of the new PMKS+ editor are not supported"),
            found="pmks2:...",
            allowed=_("a PMKS+ web link that begins with its settings, such as ?2v.Ay,1E8.5,..."),
            file=file,
        )
    match = LINK_TEXT.fullmatch(text.strip())
    assert match is not None
    return import_pmks(_LinkRecords.of(_strip_checks(unquote(match[1]), file), file).decode(), file)


def _strip_checks(content: str, file: str) -> str:
    """Remove the check character and the checksum from the text. Raises ProblemError if they do not match it."""
    body, mark, digest = content.rpartition("*")
    if mark and digest != _digest(body):
        raise ProblemError(
            _("this web link is damaged: its checksum does not match its text"),
            found=quote(digest),
            allowed=_("a web link as copied from PMKS+, or a .pmks file"),
            file=file,
        )
    body = body if mark else content
    if CHECKS[(len(body) - 1) % 62] != body[-1:]:
        raise ProblemError(
            _("this web link is incomplete: its check character does not match its length"),
            found=quote(body[-1:]),
            allowed=_("a web link as copied from PMKS+, or a .pmks file"),
            file=file,
        )
    return body[:-1]


def _digest(body: str) -> str:
    """Return the 32-bit FNV-1a hash of the characters as six base-62 digits."""
    value = 0x811C9DC5
    for char in body:
        value = (value ^ ord(char)) * 0x01000193 & 0xFFFFFFFF
    digits = ""
    for __ in range(6):
        value, digit = divmod(value, 62)
        digits = CHECKS[digit] + digits
    return digits


@dataclass(frozen=True)
class _LinkRecords:
    """Records of a web link, split into fields.

    Attributes:
        settings: fields of the settings.
        joints, links, forces: records, each a list of fields.
        exact: numbers stored more precisely than in thousandths, by kind and id of the record and index of the number.
        left: sentences on what is not imported.
        file: name of the file, for messages.
    """

    settings: tuple[str, ...]
    joints: list[list[str]]
    links: list[list[str]]
    forces: list[list[str]]
    exact: dict[tuple[str, str, int], float]
    left: tuple[str, ...]
    file: str

    @classmethod
    def of(cls, content: str, file: str) -> _LinkRecords:
        """Split the text of a web link into records. Raises ProblemError."""
        *settings, rest = content.split(".", 4)
        joints, rest = _split_records(rest)
        links, rest = _split_records(rest)
        forces, rest = _split_records(rest)
        exact, left = _read_entries(rest.partition(".")[2], file)
        records = [[item.split(",") for item in items] for items in (joints, links, forces)]
        return cls(tuple(settings), records[0], records[1], records[2], exact, left, file)

    def decode(self) -> PmksFile:
        """Decode the records into the content of a PMKS+ file. Raises ProblemError."""
        flags, decimals, whole, words = self.settings
        on = self._integer(flags, ("settings",), signed=False)
        if not words or words[0] not in DIGITS[: len(LENGTHS)]:
            raise self._refused(("settings",), _("unknown unit of length"), quote(words[:1]), ", ".join(LENGTHS))
        rpm = self.exact.get(("I", "", 0), self._integer(whole.split(",")[0], ("settings",)))
        linear = self._number(("settings",), "D", "", 1, [*decimals.split(","), "", ""][1]) or 5.0
        left = list(self.left)
        titles = [fields[11] for fields in self.joints if len(fields) > 11 and fields[11] and "~" not in fields[11]]
        roots, notes = [], []
        for fields in self.links:
            link, kind = self._link(fields)
            if kind in ROOT_LINKS:
                roots.append(link)
            if kind in AUTOMATIC and kind in ROOT_LINKS:
                notes.append(
                    _(
                        "PMKS+ computes the moment of inertia or the centre of mass of link {name} from its shape; the "
                        "stored values were taken."
                    ).format(name=link.id)
                )
        joints = tuple(self._joint(fields, left) for fields in self.joints)
        return PmksFile(
            joints,
            tuple(self._merge_welded(link) for link in roots),
            tuple(self._force(fields) for fields in self.forces),
            -rpm if on & CLOCKWISE else rpm,
            not on & GRAVITY_OFF,
            LENGTHS[DIGITS.index(words[0])],
            linear,
            tuple(notes),
            tuple(left),
            titles[0] if titles else "",
        )

    def _joint(self, fields: list[str], left: list[str]) -> PmksJoint:
        head, name = fields[0], fields[0][1:]
        path = ("joints", name)
        if not name or len(fields) < 5:
            raise self._refused(
                path, _("expected a record of a joint with at least five fields"), quote(",".join(fields))
            )
        flags = self._integer(head[0], path, signed=False)
        x, y, angle = (self._number(path, "J", name, k, text, needed=True) for k, text in enumerate(fields[2:5]))
        carrier, a, b, speed, mass, *more = [*fields[5:], "", "", "", "", ""][: max(5, len(fields) - 5)]
        if any("~" in text for text in (mass, *more)) and len(more) == 2:  # static, kinetic, radius of the journal
            left.append(_("The friction of joint {name}.").format(name=name))
            mass, more = "", []
        welded, __, *unknown = [*more, "", ""]
        if welded not in ("", "0", "Fe") or any(unknown):
            raise self._refused(path, _("unknown field in the record of a joint"), quote(",".join(more)))
        if any((carrier, a, b)) and not (all((carrier, a, b)) and flags & SLIDES and a != b):
            raise self._refused(
                path,
                _("a slot needs a sliding joint, a link and two joints of that link"),
                quote(",".join((carrier, a, b))),
            )
        return PmksJoint(
            name,
            complex(x, y),
            bool(flags & SLIDES),
            bool(flags & GROUND),
            bool(flags & INPUT),
            angle,
            bool(flags & WELDED),
            carrier,
            (a, b),
            self._number(path, "J", name, 4, mass),
            self._number(path, "J", name, 3, speed),
        )

    def _link(self, fields: list[str]) -> tuple[PmksLink, str]:
        """Decode the record of a link.

        Returns:
            The link, and a character of its flags. The character shows whether the link is welded to another one, and
            which of its mass properties PMKS+ computes itself.
        """
        kind, form, name = fields[0][:1], fields[0][1:2], fields[0][2:]
        path = ("links", name)
        if not name or len(fields) < 9 or form not in ("R", "P"):
            raise self._refused(
                path, _("expected a record of a link with at least nine fields"), quote(",".join(fields))
            )
        if kind not in ROOT_LINKS + WELDED_LINKS:
            raise self._refused(path, _("unknown kind of link"), quote(kind), " ".join(ROOT_LINKS + WELDED_LINKS))
        mass, inertia, x, y = (self._number(path, "L", name, k, text) for k, text in enumerate(fields[2:6]))
        others = fields[7:]
        stop = others.index("") if "" in others else len(others)
        parts = tuple(part_name for part_name in others[stop + 1 :] if part_name)
        joints = tuple(others[:stop])
        return PmksLink(name, joints, form == "P", mass, inertia, complex(x, y), fields[1], parts), kind

    def _merge_welded(self, link: PmksLink) -> PmksLink:
        """Combine a link with all links that are welded to it, directly or indirectly, to one link with all their
        joints.
        """
        records = {fields[0][2:]: self._link(fields)[0] for fields in self.links}
        parts, joints = list(link.parts), list(link.joints)
        for name in parts:  # grows while it is read
            if name not in records:
                raise self._refused(("links", link.id), _("there is no link of that name"), quote(name))
            parts += [part_name for part_name in records[name].parts if part_name not in parts]
            joints += [joint for joint in records[name].joints if joint not in joints]
        return PmksLink(
            link.id, tuple(joints), link.piston, link.mass, link.inertia, link.centre, link.name, tuple(parts)
        )

    def _force(self, fields: list[str]) -> PmksForce:
        head, name = fields[0], fields[0][1:]
        path = ("forces", name)
        if not name or len(fields) != 8:
            raise self._refused(path, _("expected a record of a force with eight fields"), quote(",".join(fields)))
        flags = self._integer(head[0], path, signed=False)
        x0, y0, x1, y1, magnitude = (self._number(path, "F", name, k, text) for k, text in enumerate(fields[3:]))
        return PmksForce(
            name, fields[1], complex(x0, y0), complex(x1, y1), bool(flags & LOCAL), bool(flags & OUTWARD), magnitude
        )

    def _number(
        self, path: tuple[str, ...], kind: str, name: str, index: int, text: str, needed: bool = False
    ) -> float:
        """Decode a number stored in thousandths.

        An empty field is zero, or an error if the number is required.
        """
        if (kind, name, index) in self.exact:
            return self.exact[kind, name, index]
        return self._integer(text, path) / 1000 if text or needed else 0.0

    def _integer(self, text: str, path: tuple[str, ...], *, signed: bool = True) -> int:
        negative = signed and text[:1] == "0"
        if not text or len(text) > MAX_NUMBER_LENGTH or any(char not in DIGITS for char in text):
            raise self._refused(path, _("this is not a base-64 number"), quote(text))
        number = 0
        for char in text[negative:]:
            number = number * 64 + DIGITS.index(char)
        return -number if negative else number

    def _refused(self, path: tuple[str, ...], message: str, found: str, allowed: str | None = None) -> ProblemError:
        return ProblemError(message, path=path, found=found, allowed=allowed, file=self.file)


def _split_records(rest: str) -> tuple[list[str], str]:
    """Split off the records of joints, links or forces, and return them with the remaining text.

    Each record ends with a full stop; one more full stop ends the group of records.
    """
    records = []
    while rest and rest[0] != ".":
        item, __, rest = rest.partition(".")
        records.append(item)
    return records, rest[1:]


def _read_entries(tail: str, file: str) -> tuple[dict[tuple[str, str, int], float], tuple[str, ...]]:
    """Read the tagged entries at the end of a web link. Raises ProblemError.

    Returns:
        Exact numbers by kind and id of the record and index of the number; sentences on what is not imported.
    """
    exact: dict[tuple[str, str, int], float] = {}
    left: list[str] = []
    for entry in filter(None, tail.split(",")):
        tag = entry[0]
        if tag == "P":  # of a joint, a link, a force, or D, I: a setting
            target, *numbers = entry.split("~")
            try:
                index, value = int(numbers[0]), float(numbers[1])
            except (ValueError, IndexError):
                raise _unknown_entry_error(entry, file) from None
            if len(numbers) != 2 or target[1:2] not in tuple("JLFDI") or not abs(value) <= LARGEST:
                raise _unknown_entry_error(entry, file)
            exact[target[1], target[2:], index] = value
        elif tag == "G":
            raise ProblemError(_("gears of PMKS+ are not supported"), found=quote(entry), file=file)
        elif tag in "ST":
            lost = (
                _("The data for synthesis in PMKS+.") if tag == "S" else _("Materials, cross-sections and load cases.")
            )
            if lost not in left:
                left.append(lost)
        elif tag not in IGNORED_TAGS:
            raise _unknown_entry_error(entry, file)
    return exact, tuple(left)


def _unknown_entry_error(entry: str, file: str) -> ProblemError:
    return ProblemError(
        _("this entry of the web link is unknown"), found=quote(entry), allowed="J L F C H K P S T", file=file
    )
