"""Linkages of one kind with different numbers, as one linkage whose numbers are arrays over variants."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from tmm_cli.linkage import Linkage
from tmm_cli.vectors import Real

LEFT = ("sketch",)  # what says how a linkage is assembled, not what it is


class NotAlikeError(ValueError):
    """Two linkages differ in more than their numbers. path: where."""

    def __init__(self, path: str) -> None:
        super().__init__(f"the linkages differ in {path}, which is no number")
        self.path = path


def numbers(record: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """All numbers of a record with their paths, and all else that must be equal in linkages of one kind."""
    if is_dataclass(record) and not isinstance(record, type):
        for f in fields(record):
            if f.name not in LEFT:
                yield from numbers(getattr(record, f.name), f"{path}.{f.name}" if path else f.name)
    elif isinstance(record, Mapping):
        for key, value in record.items():
            yield from numbers(value, f"{path}.{key}")
    elif isinstance(record, (tuple, list)):
        for k, value in enumerate(record):
            yield from numbers(value, f"{path}[{k}]")
    else:
        yield path, record


@cache
def _sort(kind: Any) -> tuple[str, ...] | type | None:
    """Names of the fields of a class of records, Mapping, tuple, or None for what is a value itself."""
    if is_dataclass(kind):
        return tuple(f.name for f in fields(kind) if f.name not in LEFT)
    return Mapping if issubclass(kind, Mapping) else tuple if issubclass(kind, tuple | list) else None


def _leaves(record: Any) -> tuple[list[Any], list[Any]]:
    """The numbers of a record without their paths, as `numbers` has them, and its shape: of one shape, one order."""
    found: list[Any] = []
    shape: list[Any] = []

    def walk(part: Any) -> None:
        kind: Any = type(part)
        sort = _sort(kind)
        if sort is None:
            found.append(part)
            return
        if isinstance(sort, tuple):
            shape.append(kind)
            inner: Iterable[Any] = [getattr(part, name) for name in sort]
        elif sort is Mapping:
            shape.append(tuple(part))
            inner = part.values()
        else:
            shape.append(len(part))
            inner = part
        shape.append(len(found))
        for one in inner:
            walk(one)

    walk(record)
    return found, shape


def changed(record: Any, new: Mapping[str, Any], path: str = "") -> Any:
    """A record with the numbers at some paths exchanged."""
    if is_dataclass(record) and not isinstance(record, type):
        return replace(
            record,
            **{
                f.name: changed(getattr(record, f.name), new, f"{path}.{f.name}" if path else f.name)
                for f in fields(record)
                if f.name not in LEFT and f.init
            },
        )
    if isinstance(record, Mapping):
        return {key: changed(value, new, f"{path}.{key}") for key, value in record.items()}
    if isinstance(record, (tuple, list)):
        return type(record)(changed(value, new, f"{path}[{k}]") for k, value in enumerate(record))
    return new.get(path, record)


def varying(linkages: Sequence[Linkage]) -> dict[str, Real]:
    """Numbers that are not the same in all linkages, (variants, 1), by path. Raises NotAlikeError."""
    first = dict(numbers(linkages[0]))
    rows, shape = [list(first.values())], _leaves(linkages[0])[1]
    for linkage in linkages[1:]:
        row, own = _leaves(linkage)
        if own != shape:  # their mappings may be in another order
            here = dict(numbers(linkage))
            if here.keys() != first.keys():
                raise NotAlikeError(next(iter(here.keys() ^ first.keys())))
            row = [here[path] for path in first]
        rows.append(row)
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
