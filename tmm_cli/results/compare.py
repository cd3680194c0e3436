"""Two results of the same problem: every quantity of result.json against what is expected."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

IGNORED = {"files", "tmm", "problem", "warnings", "digits"}
DERIVED = {"arm"}  # follows from others, and has no size of its own where those pass through zero
SHARES = {"balance", "difference", "margin", "margins"}  # relative already: compared as they are
FLOOR = 1e-9  # of the largest value of the same name anywhere: below that a quantity is zero but for rounding


@dataclass(frozen=True)
class Difference:
    """A quantity that is not as expected. size: relative to its largest value in the cycle; None: not a number."""

    quantity: str
    position: int | None
    expected: Any
    found: Any
    size: float | None


def differences(expected: dict[str, Any], found: dict[str, Any], tolerance: float) -> list[Difference]:
    """The worst deviation of every quantity that is beyond the tolerance, in the order of the file."""
    largest: dict[str, float] = {}
    for path, values in _series(expected):
        name = _kind(path)
        largest[name] = max(largest.get(name, 0.0), _peak(values))
    vectors = _vector_peaks(expected)
    want, have = dict(_series(expected)), dict(_series(found))
    out = [Difference(_text(p), None, "there", "missing", None) for p in want if p not in have]
    out += [Difference(_text(p), None, "nothing", "there", None) for p in have if p not in want]
    for path, values in want.items():
        if path in have and path[-1] not in DERIVED and path[-2:-1] != ("angle",):
            scale = 1.0 if set(path) & SHARES else max(vectors.get(path, _peak(values)), FLOOR * largest[_kind(path)])
            if path[-1] == "at":  # a place on the driver's way, which may be the zero
                scale = max(scale, largest.get("driver", 0.0))
            worst = _worst(path, values, have[path], scale)
            if worst is not None and (worst.size is None or worst.size > tolerance):
                out.append(worst)
    return out


def _worst(path: tuple[str, ...], expected: list[Any], found: list[Any], scale: float) -> Difference | None:
    if len(expected) != len(found):
        return Difference(_text(path), None, f"{len(expected)} values", f"{len(found)} values", None)
    worst: Difference | None = None
    for k, (a, b) in enumerate(zip(expected, found, strict=True)):
        position = k if len(expected) > 1 else None
        if not (_number(a) and _number(b)):
            if a != b:
                return Difference(_text(path), position, a, b, None)
            continue
        gap = abs(a - b)
        if path[-1] == "angle":  # a turn more or less is the same place
            gap, scale = abs(math.remainder(gap, 2 * math.pi)), math.pi
            if "reactions" in path:  # follows from the components; of a force that vanishes it means nothing
                continue
        size = gap / scale if scale else (0.0 if gap == 0 else math.inf)
        if worst is None or size > (worst.size or 0.0):
            worst = Difference(_text(path), position, a, b, size)
    return worst


def _series(value: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], list[Any]]]:
    """Every leaf or list of leaves with its path; list items that have a name are known by it."""
    if isinstance(value, dict):
        for key, part in value.items():
            if path or key not in IGNORED:
                yield from _series(part, (*path, key))
    elif isinstance(value, list) and any(isinstance(part, dict | list) for part in value):
        for k, part in enumerate(value):
            name = str(part.get("name", k)) if isinstance(part, dict) else str(k)
            yield from _series(part, (*path, f"{k}:{name}"))
    else:
        yield path, value if isinstance(value, list) else [value]


def _vector_peaks(result: dict[str, Any]) -> dict[tuple[str, ...], float]:
    """For both components of a vector the largest length of the vector: a component may vanish."""
    series = dict(_series(result))
    peaks = {}
    for path, values in series.items():
        if path[-1] == "x" and (*path[:-1], "y") in series:
            other = series[*path[:-1], "y"]
            peak = max((math.hypot(a, b) for a, b in zip(values, other, strict=False) if _number(a) and _number(b)),
                       default=0.0)  # fmt: skip
            peaks[path] = peaks[*path[:-1], "y"] = peak
    return peaks


def _peak(values: Iterable[Any]) -> float:
    return max((abs(v) for v in values if _number(v)), default=0.0)


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _kind(path: tuple[str, ...]) -> str:
    return path[-2] if path[-1] in ("x", "y") and len(path) > 1 else path[-1]


def _text(path: tuple[str, ...]) -> str:
    return ".".join(path)
