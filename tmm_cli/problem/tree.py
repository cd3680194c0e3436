"""A file that has been read: plain data, and where each value stands."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Any, Final, Self

MAX_DEPTH: Final = 20  # lists and mappings of a file within each other

Path = tuple[str | int, ...]
"""Where a value stands in a file: keys as written (str) and list indices from 0 (int)."""


class WrittenNumber(float):
    """A number of a file, and the decimals that it was written with: a float keeps 16 of them."""

    written: str

    def __new__(cls, written: str) -> Self:
        number = super().__new__(cls, written)
        number.written = written
        return number

    def __repr__(self) -> str:
        return self.written


@dataclass(frozen=True)
class Mark:
    """A place in a text; line and column count from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class Tree:
    """A file as plain data (dict with str keys, list, str, int, float, bool, None) with places.

    marks: start of every value, () being the top. key_marks: start of every key, by the path of its value.
    commas: flow lists that may be numbers with a decimal comma, by path, with what they would then read.
    given: what stands on the command line in place of the file's, by path, as it is written there.
    """

    file: str
    data: dict[str, Any]
    marks: Mapping[Path, Mark]
    key_marks: Mapping[Path, Mark]
    commas: Mapping[Path, str]
    given: Mapping[Path, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """That of the problem: its file's without the ending; what of it is no text is lost, and it is one line."""
        return re.sub(r"[^\S ]+", "_", PurePath(self.file).stem.encode(errors="replace").decode())

    def mark(self, path: Path, *, key: bool = False) -> Mark | None:
        """The place of a value, or of its key; of what is not in the file the key of its nearest ancestor."""
        if path in self.marks:
            return self.key_marks.get(path, self.marks[path]) if key else self.marks[path]
        while path and path not in self.marks:
            path = path[:-1]
        return self.key_marks.get(path) or self.marks.get(path)
