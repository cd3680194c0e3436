"""Linkages of one kind with different numbers, as one linkage whose numbers are arrays over variants."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.linkage import Linkage
from tmm_cli.tape.traced_number import TracedNumber
from tmm_cli.vectors import Real, leaves, mapped

LEFT = ("sketch",)  # what says how a linkage is assembled, not what it is


class NotAlikeError(ValueError):
    """Two linkages differ in more than their numbers. path: where."""

    def __init__(self, path: str) -> None:
        super().__init__(f"the linkages differ in {path}, which is no number")
        self.path = path


def numbers(record: Any) -> Iterator[tuple[str, Any]]:
    """All numbers of a record with their paths, and all else that must be equal in linkages of one kind."""
    return leaves(record, LEFT)


def changed(record: Any, new: Mapping[str, Any]) -> Any:
    """A record with the numbers at some paths exchanged."""
    return mapped(lambda path, value: new.get(path, value), record, skip=LEFT)


def stands(record: Any) -> Any:
    """A record built of traced numbers with the arrays that they stand for."""
    return changed(record, {path: x.stand for path, x in numbers(record) if isinstance(x, TracedNumber)})


def each(columns: Real) -> list[Real]:
    """The columns (variants, n) one by one, (variants, 1)."""
    return [columns[:, k : k + 1] for k in range(columns.shape[1])]


def varying(linkages: Sequence[Linkage]) -> dict[str, Real]:
    """Numbers that are not the same in all linkages, (variants, 1), by path. Raises NotAlikeError."""
    first = dict(numbers(linkages[0]))
    rows = [list(first.values())]
    for linkage in linkages[1:]:
        here = dict(numbers(linkage))
        if here.keys() != first.keys():
            raise NotAlikeError(next(iter(here.keys() ^ first.keys())))
        rows.append([here[path] for path in first])
    found = {}
    for path, values in zip(first, zip(*rows, strict=True), strict=True):
        if any(value != values[0] for value in values):
            if not all(isinstance(value, (int, float, complex)) and not isinstance(value, bool) for value in values):
                raise NotAlikeError(path)
            found[path] = np.array(values)[:, None]
    return found


def parts(found: Mapping[str, Real]) -> tuple[list[Real], Callable[..., dict[str, Any]]]:
    """Real columns of varying numbers, and what puts numbers together from (stand-ins for) such columns again."""
    columns: list[Real] = []
    places: dict[str, tuple[int | complex, ...]] = {}
    for path, values in found.items():
        pieces: list[int | complex] = []
        for piece in (values.real, values.imag) if np.iscomplexobj(values) else (values,):
            if np.all(piece == piece[0]):
                pieces.append(complex(piece[0, 0]))  # a number for all
            else:
                pieces.append(len(columns))
                columns.append(np.ascontiguousarray(piece, dtype=float))
        places[path] = tuple(pieces)

    def together(*data: Any) -> dict[str, Any]:
        def one(piece: int | complex) -> Any:
            return piece.real if isinstance(piece, complex) else data[piece]

        return {
            path: one(at[0]) if len(at) == 1 else one(at[0]) + 1j * one(at[1]) for path, at in places.items()
        }  # fmt: skip

    return columns, together
