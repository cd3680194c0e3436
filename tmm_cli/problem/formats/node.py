"""Values of a foreign file with their places in it, so that a mistake is said where it stands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.problem.tree import Path, Tree
from tmm_cli.problem.values import LARGEST

MOST = 500  # items of a list, keys of a mapping


@dataclass(frozen=True)
class Node:
    """A value of a file that has been read. All methods raise ProblemError where something else is wanted."""

    tree: Tree
    data: Any
    path: Path = ()

    def refused(self, message: str, allowed: str | None = None, near: str | None = None) -> ProblemError:
        """The error, with its place."""
        found = None if isinstance(self.data, dict | list) else quote(self.data)
        error = ProblemError(message, path=self.path, found=found, allowed=allowed, near=near)
        return error.located(self.tree.file, self.tree)

    def get(self, key: str) -> Node | None:
        """The value of a key, None where there is none."""
        found = self.mapping().get(key)
        return None if found is None else Node(self.tree, found, (*self.path, key))

    def __getitem__(self, key: str) -> Node:
        found = self.get(key)
        if found is None:
            error = ProblemError(_("key '{key}' is missing").format(key=key), path=self.path, key=True)
            raise error.located(self.tree.file, self.tree)
        return found

    def mapping(self) -> dict[str, Any]:
        """Its keys."""
        if not isinstance(self.data, dict):
            raise self.refused(_("keys with values are wanted"))
        self._bounded(len(self.data))
        return self.data

    def _bounded(self, length: int) -> None:
        if length > MOST:
            raise self.refused(_("this is too long: at most {max_length}").format(max_length=MOST))

    def pairs(self) -> Iterator[tuple[str, Node]]:
        """Its keys and their values."""
        for key, value in self.mapping().items():
            yield key, Node(self.tree, value, (*self.path, key))

    def items(self) -> list[Node]:
        """Of a list."""
        if not isinstance(self.data, list):
            raise self.refused(_("a list [..., ...] is wanted"))
        self._bounded(len(self.data))
        return [Node(self.tree, value, (*self.path, k)) for k, value in enumerate(self.data)]

    def text(self) -> str:
        """A name."""
        if isinstance(self.data, bool) or not isinstance(self.data, str | int) or len(str(self.data)) > 100:
            raise self.refused(_("a name is wanted"))
        return str(self.data)

    def one_of(self, names: Iterable[str]) -> str:
        """One of the names that are known."""
        known, found = list(names), self.text()
        if found not in known:
            raise self.refused(_("this word is not known here"), ", ".join(known), nearest(found, known))
        return found

    def number(self) -> float:
        """A number that a mechanism can have."""
        if isinstance(self.data, bool) or not isinstance(self.data, int | float):
            raise self.refused(_("a number is wanted"))
        if not -LARGEST <= self.data <= LARGEST:
            raise self.refused(_("this is too large for a mechanism"))
        return float(self.data)

    def vector(self) -> complex:
        """Two coordinates; a third one, of a plane mechanism, is left out."""
        items = self.items()
        if len(items) not in (2, 3):
            raise self.refused(_("two coordinates [x, y] are wanted"))
        return complex(items[0].number(), items[1].number())
