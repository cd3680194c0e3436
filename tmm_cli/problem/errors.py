"""The one exception that a problem file can cause, and what makes its message readable and safe."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from tmm_cli.problem.reader import Tree

Path = tuple[str | int, ...]
"""Where a value stands in a file: keys as written (str) and list indices from 0 (int)."""

# Cyrillic letters that look like Latin ones on paper and screen: the commonest invisible mistake in a key.
_LOOKALIKES = str.maketrans("АВЕКМНОРСТУХаеорсухкмІіЅѕЈј", "ABEKMHOPCTYXaeopcyxkmIiSsJj")


@dataclass(frozen=True)
class Mark:
    """A place in a text; line and column count from 1."""

    line: int
    column: int


class ProblemError(Exception):
    """Bad input: one mistake, said once, with what was found and what is allowed.

    message: one line. path: the key path. found, allowed: words ready to print (`quote` a raw value first).
    near: the nearest valid name. key: the key itself is at fault, not its value, so `located` marks the key.
    All words are cut and control characters escaped here, so callers need not.
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
        mark: Mark | None = None,
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
        """A copy with `path` put before the path it has; `at("links", "3")`, `at(*path)`."""
        new = copy.copy(self)
        new.path = (*path, *self.path)
        return new

    def located(self, file: str, tree: Tree | None = None) -> Self:
        """A copy that names the file and, from the tree, the line and column of the path.

        A mark already set is kept. When the path is not in the file (a missing key), the key of its nearest
        ancestor is marked.
        """
        new = copy.copy(self)
        new.file = file
        if new.mark is None and tree is not None:
            new.mark = _mark(tree, self.path, self.key)
        return new

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data for --json; what is not known is None."""
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
        head = ": ".join(part for part in (where, path_text(self.path), self.message) if part)
        lines = [head]
        if self.found is not None:
            lines.append(f"found:   {self.found}")
        if self.allowed is not None:
            lines.append(f"allowed: {self.allowed}")
        if self.near is not None:
            same = self.found is not None and latin(self.found.strip("'")) == latin(self.near)
            same = same and self.found != quote(self.near)
            script = f" in {'Latin' if self.near.isascii() else 'Cyrillic'} letters" if same else ""
            lines.append(f"did you mean '{self.near}'{script}?")
        return "\n  ".join(lines)


class UnknownParameterError(ProblemError):
    """Arithmetic on a name that is no parameter, `unknown`; where it is a key of the synthesis, that is said."""

    unknown = ""

    def located(self, file: str, tree: Tree | None = None) -> Self:
        """As every error; the tree tells whether the name is a key of the block `synthesis`."""
        new = super().located(file, tree)
        block = tree.data.get("synthesis") if tree is not None else None
        if isinstance(block, dict) and self.unknown in block and self.path[:1] != ("synthesis",):
            key = clean(self.unknown, 40)
            new.message = f"{key} is a key of the synthesis, not a parameter"
            new.allowed = f"{key} as a parameter too: parameters: {{{key}: ...}}, synthesis: {{{key}: {key}}}"
            new.near = None
        return new


def _mark(tree: Tree, path: Path, key: bool) -> Mark | None:
    if path in tree.marks:
        return tree.key_marks.get(path, tree.marks[path]) if key else tree.marks[path]
    while path and path not in tree.marks:
        path = path[:-1]
    return tree.key_marks.get(path) or tree.marks.get(path)


def path_text(path: Path) -> str:
    """`links.3.points[0]`, safe to print."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{clean(part, 40)}" for part in path)
    return text.removeprefix(".")


def clean(text: str, limit: int = 60) -> str:
    """The text on one line, control and invisible characters escaped, cut to `limit` characters."""
    if len(text) > limit:
        end = text[-1] if text[-1] in "'\")" else ""
        text = text[: limit - 1 - len(end)] + "…" + end
    return "".join(_escape(char) for char in text)


def _escape(char: str) -> str:
    # Not printable are controls, bidirectional overrides, line separators and spaces that only look like one.
    return char if char.isprintable() else char.encode("unicode_escape").decode("ascii")


def quote(value: object) -> str:
    """A value of the file as shown in a message: strings in single quotes, the rest as YAML writes it."""
    if isinstance(value, str):
        return f"'{clean(value)}'"
    if value is None or isinstance(value, bool):
        return {None: "nothing (null)", True: "true", False: "false"}[value]
    if isinstance(value, int | float):
        return clean(f"{value!r}")
    if isinstance(value, list | tuple):
        if 0 < len(value) <= 4 and not any(isinstance(item, list | tuple | dict) for item in value):
            return clean("[" + ", ".join(item if isinstance(item, str) else quote(item) for item in value) + "]")
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return "a mapping with " + (", ".join(clean(str(key), 20) for key in list(value)[:4]) or "no keys")
    return clean(type(value).__name__)


def nearest(name: str, names: Iterable[str]) -> str | None:
    """The name that was probably meant, or None when nothing is close.

    Case and Latin/Cyrillic look-alikes cost little; a swap of neighbours, a missing, extra or wrong letter
    cost one. A third of the letters may be wrong; in names of one or two only case and order may differ.
    """
    wanted = _folded(name[:60])
    best: tuple[float, str] | None = None
    names = list(names)
    for candidate in names:
        if candidate == name:
            return candidate
        other = _folded(candidate[:60])
        longest = max(len(wanted), len(other))
        limit = max(1, longest // 3)
        if not wanted or not other or abs(len(wanted) - len(other)) > limit:
            continue
        cost = float(_distance(wanted, other))
        if (longest <= 2 and sorted(wanted) != sorted(other)) or cost > limit:
            continue
        if best is None or cost < best[0]:
            best = (cost, candidate)
    if best is None:  # a letter too many in a short name: EE for E
        part = [n for n in names if n and len(wanted) <= 3 and (_folded(n) in wanted or wanted in _folded(n))]
        return part[0] if len(part) == 1 else None
    return best[1]


def latin(text: str) -> str:
    """The text with Cyrillic letters that look like Latin ones replaced by these."""
    return text.translate(_LOOKALIKES)


def _folded(name: str) -> str:
    return latin(name).casefold().replace("-", "_").replace(" ", "_")


def _distance(a: str, b: str) -> int:
    """Edits from a to b, a swap of neighbours counting as one (optimal string alignment)."""
    before: list[int] = []
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        before, previous, row = row, before, [i]
        for j, y in enumerate(b, 1):
            cost = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, previous[j - 2] + 1)
            row.append(cost)
    return row[-1]
