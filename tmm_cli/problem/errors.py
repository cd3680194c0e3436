"""Content of a file as plain data with the position of each value, and the exception ProblemError.

ProblemError is the only exception that a wrong problem file can cause.
"""

from __future__ import annotations

import copy
import difflib
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Any, Final, Self

from tmm_cli.language import _

MAX_DEPTH: Final = 20  # lists and mappings of a file within each other

Path = tuple[str | int, ...]
"""Where a value stands in a file: keys as written (str) and list indices from 0 (int)."""


class WrittenNumber(float):
    """A number of a file with all its decimals as written. A float would keep only about 16 of them."""

    written: str

    def __new__(cls, written: str) -> Self:
        number = super().__new__(cls, written)
        number.written = written
        return number

    def __repr__(self) -> str:
        return self.written


@dataclass(frozen=True)
class SourcePosition:
    """A position in a text. Line and column are counted from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class Tree:
    """Content of a file as plain data: dict with str keys, list, str, int, float, bool, None.

    Attributes:
        file: name of the file.
        data: top mapping of the file.
        marks: position of each value, by its path; the path of the top mapping is ().
        key_marks: position of each key, by the path of its value.
        commas: corrected text, by path, of each list that may be a number with a decimal comma.
        given: options of the command line that replace values of the file, by the path of the value.
    """

    file: str
    data: dict[str, Any]
    marks: Mapping[Path, SourcePosition]
    key_marks: Mapping[Path, SourcePosition]
    commas: Mapping[Path, str]
    given: Mapping[Path, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the problem: the file name without its extension, on one line and encodable as UTF-8."""
        return re.sub(r"[^\S ]+", "_", PurePath(self.file).stem.encode(errors="replace").decode())

    def mark(self, path: Path, *, key: bool = False) -> SourcePosition | None:
        """Return the line and column at which a value of the file begins; with `key`, those of its key.

        If the file does not contain the path, the nearest existing part of the path is used: the line and column are
        those of its key, or None if there is no such key.
        """
        if path in self.marks:
            return self.key_marks.get(path, self.marks[path]) if key else self.marks[path]
        while path and path not in self.marks:
            path = path[:-1]
        return self.key_marks.get(path) or self.marks.get(path)


CLOSE = 0.66  # similarity (difflib) from which a name is suggested: a third of the letters may be wrong

CONTROLS = re.compile(  # escape sequences, carriage returns, bidirectional overrides, zero widths, lone surrogates
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ud800-\udfff]"
)

# Cyrillic letters that look like Latin ones on paper and screen: the most common invisible mistake in a key.
_LOOKALIKES = str.maketrans("АВЕКМНОРСТУХаеорсухкмІіЅѕЈј", "ABEKMHOPCTYXaeopcyxkmIiSsJj")


class ProblemError(Exception):
    """A mistake in the input, with what was found and what is allowed.

    The constructor shortens all texts and escapes control characters.

    Attributes:
        message: description of the mistake, one line.
        path: keys that lead to the wrong value.
        found: wrong value as text (apply `quote` to a raw value); None if there is none.
        allowed: description of the allowed values; None if there is none.
        near: nearest valid name; None if there is none.
        file: name of the file; None if not yet known.
        mark: line and column; None if not yet known.
        key: True if the key is wrong and not its value; `located` then finds the position of the key.
    """

    def __init__(
        self,
        message: str,
        *,
        path: Path = (),
        found: str | None = None,
        allowed: str | None = None,
        near: str | None = None,
        file: str | None = None,
        mark: SourcePosition | None = None,
        key: bool = False,
    ) -> None:
        self.message = clean(message, 400)
        self.path = path
        self.found = None if found is None else clean(found, 100)
        self.allowed = None if allowed is None else clean(allowed, 400)
        self.near = None if near is None else clean(near)
        self.file = file
        self.mark = mark
        self.key = key
        super().__init__(self.message)

    def at(self, *path: str | int) -> Self:
        """Return a copy of the error with these keys added at the beginning of its path, e.g. `at("links", "3")`."""
        new = copy.copy(self)
        new.path = (*path, *self.path)
        return new

    def located(self, file: str, tree: Tree | None = None) -> Self:
        """Return a copy of the error with the file name and, from the tree, line and column.

        A line and column that are already set are kept. For a path that does not exist in the file (a missing key),
        they are those of the key of the nearest existing ancestor. For a value set on the command line, the option is
        named instead of the file.
        """
        new = copy.copy(self)
        new.file = file
        for path, words in () if tree is None else tree.given.items():
            if new.path[: len(path)] == path:
                new.file = words
                return new
        if new.mark is None and tree is not None:
            new.mark = tree.mark(self.path, key=self.key)
        return new

    def to_dict(self) -> dict[str, Any]:
        """Return all attributes as plain data for --json; unknown ones are None."""
        return {
            "message": self.message,
            "file": self.file,
            "line": self.mark and self.mark.line,
            "column": self.mark and self.mark.column,
            "path": list(self.path),
            "found": self.found,
            "allowed": self.allowed,
            "near": self.near,
        }

    def __str__(self) -> str:
        where = "" if self.file is None else clean(self.file, 300)
        if self.mark is not None:
            where = f"{where or 'line'}:{self.mark.line}:{self.mark.column}"
        head = ": ".join(piece for piece in (where, format_path(self.path), self.message) if piece)
        lines = [head]
        if self.found is not None:
            lines.append(_("found:   {found}").format(found=self.found))
        if self.allowed is not None:
            lines.append(_("allowed: {allowed}").format(allowed=self.allowed))
        if self.near is not None:
            question = _("did you mean '{near}'?")
            if (
                self.found is not None
                and self.found != quote(self.near)
                and to_latin(self.found) == to_latin(quote(self.near))
            ):
                latin_meant = _("did you mean '{near}' in Latin letters?")
                question = latin_meant if self.near.isascii() else _("did you mean '{near}' in Cyrillic letters?")
            lines.append(question.format(near=self.near))
        return "\n  ".join(lines)


@contextmanager
def prefix_errors(*path: str | int) -> Iterator[None]:
    """Context manager that puts `path` before the path of a ProblemError raised in the `with` block."""
    try:
        yield
    except ProblemError as error:
        raise error.at(*path) from None


@contextmanager
def locate_errors_in(tree: Tree) -> Iterator[None]:
    """Context manager that adds file, line and column to a ProblemError raised in the `with` block."""
    try:
        yield
    except ProblemError as error:
        raise error.located(tree.file, tree) from None


def format_path(path: Path) -> str:
    """Format a path as `links.3.points[0]`, with control characters escaped."""
    text = "".join(f"[{key}]" if isinstance(key, int) else f".{clean(key, 40)}" for key in path)
    return text.removeprefix(".")


def clean(text: str, limit: int = 60) -> str:
    """Return a text on one line, cut to `limit` characters, with control and invisible characters escaped."""
    if len(text) > limit:
        end = text[-1] if text[-1] in "'\")" else ""
        text = text[: limit - 1 - len(end)] + "…" + end
    return "".join(_escape(char) for char in text)


def _escape(char: str) -> str:
    # Not printable are controls, bidirectional overrides, line separators and spaces that only look like one.
    return char if char.isprintable() else char.encode("unicode_escape").decode("ascii")


def escape_controls(text: str) -> str:
    """Escape characters that control a terminal or hide text; line breaks and tabs are kept."""
    return CONTROLS.sub(lambda match: match[0].encode("unicode_escape").decode("ascii"), text)


def quote(value: object) -> str:
    """Format a value of the file for a message: strings in single quotes, other values as in YAML."""
    if isinstance(value, str):
        return f"'{clean(value)}'"
    if value is None or isinstance(value, bool):
        return {None: "nothing (null)", True: "true", False: "false"}[value]
    if isinstance(value, int | float):
        return clean(f"{value!r}")
    if isinstance(value, list | tuple):
        if 0 < len(value) <= 4 and not any(isinstance(item, list | tuple | dict) for item in value):
            return clean("[" + ", ".join(item if isinstance(item, str) else quote(item) for item in value) + "]")
        return _("a list, number of items: {count}").format(count=len(value))
    if isinstance(value, dict):
        return "a mapping with " + (", ".join(clean(str(key), 20) for key in list(value)[:4]) or "no keys")
    return clean(type(value).__name__)


def nearest_name(name: str, names: Iterable[str]) -> str | None:
    """Return the name that was probably meant, or None. Case and the script of look-alike letters are ignored."""
    candidates = list(names)
    if name in candidates:
        return name
    target = _folded(name[:60])
    folded = {_folded(other[:60]): other for other in reversed(candidates)}
    if target in folded:
        return folded[target]
    swapped = [other for other in folded if sorted(other) == sorted(target)]
    if len(target) < 2:  # one letter is near to all names that have it
        return None
    close = swapped or difflib.get_close_matches(target, folded, n=1, cutoff=CLOSE)
    return folded[close[0]] if close else None


def unknown_name_error(
    name: str,
    valid_names: Iterable[str],
    message: str,
    allowed: str | None = None,
    *,
    path: Path = (),
    file: str | None = None,
    key: bool = False,
) -> ProblemError:
    """Return the error for an unknown name, with the most similar valid name.

    Args:
        name: unknown name.
        valid_names: valid names.
        message: message of the error.
        allowed: description of the valid names; None lists them.
        path: path of the value in the file.
        file: name of the file or option.
        key: True if the name is a key of the file.
    """
    names = list(valid_names)
    return ProblemError(
        message,
        path=path,
        found=quote(name),
        allowed=allowed or ", ".join(names) or None,
        near=nearest_name(name, names),
        file=file,
        key=key,
    )


def unknown_position_error(number: int, count: int, *path: str | int) -> ProblemError:
    """Return the error for a position number that is not less than the number of positions, `count`."""
    allowed = _("0 to {last}").format(last=count - 1)
    return ProblemError(_("there is no position with this number"), path=path, found=str(number), allowed=allowed)


def parse_names(text: str, valid_names: Iterable[str], option: str, reason: str) -> list[str]:
    """Split the comma-separated list of names in an option of the command line.

    Args:
        text: value of the option.
        valid_names: valid names, in lower case.
        option: name of the option.
        reason: message of the error for an unknown name.

    Raises:
        ProblemError: a name is unknown, or the list is empty.
    """
    chosen, allowed = [word.strip().lower() for word in text.split(",") if word.strip()], list(valid_names)
    for name in chosen or [text]:
        if name not in allowed:
            raise unknown_name_error(name, allowed, reason, file=option)
    return chosen


def to_latin(text: str) -> str:
    """Replace Cyrillic letters that look like Latin ones by the Latin ones."""
    return text.translate(_LOOKALIKES)


def _folded(name: str) -> str:
    return to_latin(name).casefold().replace("-", "_").replace(" ", "_")
