"""Comparison of two results of one problem: every quantity of result.json with its expected value."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tmm_cli.language import _
from tmm_cli.reports.table import Table, text_table

Path = tuple[str, ...]

IGNORED = {"files", "part", "tmm", "problem", "warnings", "checks", "digits"}  # checks and warnings rest on the others
NOT_RECORDED = {
    "first",
    "second",
    "tangential",
    "normal",
    "signed",
    "size",
    "items",
}  # these follow from what is recorded
GOLDEN_DIGITS = 8
DERIVED = {"arm"}  # follows from others (as the angle of a reaction does), and means nothing where those vanish
EXTREME_LOCATIONS = {"other_at"}  # where an extreme lies: its value grows by the square of the distance from there
RELATIVE = {"balance", "difference", "margin", "margins"}  # relative already: compared as they are
SMALLEST_SCALE = 1e-4  # SI: where all values are smaller, with a tolerance of 1e-9 rounding of sums that vanish passes
SMALLEST_SHARE = (
    1e-4  # of the largest value of the same name anywhere: with a tolerance of 1e-9 rounding at 1e-13 of it passes
)
DIFFERENCE_OF = {
    "slope": "inertia",
    "rate": "kinetic",
}  # what is a difference of values of another name rounds as these do


@dataclass(frozen=True)
class ResultDifference:
    """A quantity that differs from its expected value.

    Attributes:
        quantity: path of the quantity in result.json.
        position: index of the position; None if the quantity has one value.
        expected: expected value.
        found: value of the result that is checked.
        size: difference relative to the largest value of the quantity in the cycle; None if it is not a number.
    """

    quantity: str
    position: int | None
    expected: Any
    found: Any
    size: float | None


def golden_part(result: dict[str, Any]) -> dict[str, Any]:
    """Return what a golden run records of result.json: results that do not follow from the others."""
    return {key: _recorded(part) for key, part in result.items() if key not in IGNORED}


def _recorded(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _recorded(part) for key, part in value.items() if key not in NOT_RECORDED}
    return [_recorded(part) for part in value] if isinstance(value, list) else value


def golden_record(result: dict[str, Any]) -> dict[str, Any]:
    """Return the recorded part of result.json, with numbers rounded to 8 digits."""
    text = json.dumps(golden_part(result))
    rounded: dict[str, Any] = json.loads(text, parse_float=lambda number: float(f"{float(number):.{GOLDEN_DIGITS}g}"))
    return rounded


def new_quantities(expected: dict[str, Any], found: dict[str, Any]) -> list[str]:
    """Return the paths of quantities that the expected record does not have: results of a later version."""
    known = {path for path, __ in _series_by_path(expected)}
    return [_path_text(path) for path, __ in _series_by_path(found) if path not in known]


def find_differences(expected: dict[str, Any], found: dict[str, Any], tolerance: float) -> list[ResultDifference]:
    """Return the largest difference of every expected quantity that exceeds the tolerance, in the order of the file.

    Args:
        expected: content of result.json that is expected.
        found: content of result.json that is checked.
        tolerance: largest allowed difference, relative to the largest value of the quantity in the cycle.
    """
    want, have = dict(_series_by_path(expected)), dict(_series_by_path(found))
    scales = _series_scales(want)
    out = [ResultDifference(_path_text(p), None, "there", "missing", None) for p in want if p not in have]
    for path, values in want.items():
        follows = path[-1] in DERIVED or (path[-1] == "angle" and "reactions" in path)
        if path in have and not follows:
            worst = _largest_difference(path, values, have[path], scales[path])
            if worst is not None and (worst.size is None or worst.size > tolerance):
                out.append(worst)
    return out


def _series_scales(series: dict[Path, list[Any]]) -> dict[Path, float]:
    """Return the reference value of each series for relative differences: its largest value.

    Both components of a vector share the largest magnitude of the vector.
    """
    peaks = {path: max((abs(v) for v in values if _is_number(v)), default=0.0) for path, values in series.items()}
    for path, values in series.items():
        across = (*path[:-1], "y")
        if path[-1] == "x" and across in series:
            parts = (part for part in zip(values, series[across], strict=False) if all(map(_is_number, part)))
            peaks[path] = peaks[across] = max((math.hypot(*part) for part in parts), default=0.0)
    largest: dict[str, float] = {}
    for path, peak in peaks.items():
        largest[_quantity_name(path)] = max(largest.get(_quantity_name(path), 0.0), peak)
    scales = {}
    for path, peak in peaks.items():
        source = largest.get(DIFFERENCE_OF.get(_quantity_name(path), ""), 0.0)
        scales[path] = max(peak, SMALLEST_SHARE * max(largest[_quantity_name(path)], source), SMALLEST_SCALE)
        if path[-1] == "angle":
            scales[path] = max(math.pi, peak)
        elif set(path) & RELATIVE:
            scales[path] = max(1.0, peak)  # of a synthesis a margin may be one in newtons
        elif path[-1] == "at" or path[-1] in EXTREME_LOCATIONS:  # a place of the driver, which may be the zero
            scales[path] = max(scales[path], largest.get("driver", 0.0))
    return scales


def difference_table(different: Mapping[str, Sequence[ResultDifference]]) -> Table:
    """Return a table of the differences, problem by problem."""
    headers = (_("problem"), _("quantity"), _("position"), _("expected"), _("actual"), _("relative"))
    rows = [
        (
            name,
            d.quantity,
            "" if d.position is None else str(d.position),
            brief_value(d.expected),
            brief_value(d.found),
            "" if d.size is None else f"{d.size:.2g}",
        )
        for name, here in different.items()
        for d in here
    ]
    return text_table("check", _("Differences from the expected values"), headers, rows)


def brief_value(value: Any) -> str:
    """Return a value as the text of a table cell: 15 digits of a number, at most 60 letters of anything else."""
    return f"{value:.15g}" if isinstance(value, float) else str(value)[:60]


def _largest_difference(path: Path, expected: list[Any], found: list[Any], scale: float) -> ResultDifference | None:
    if len(expected) != len(found):
        return ResultDifference(_path_text(path), None, f"{len(expected)} values", f"{len(found)} values", None)
    worst: ResultDifference | None = None
    for k, (a, b) in enumerate(zip(expected, found, strict=True)):
        position = k if len(expected) > 1 else None
        if not (_is_number(a) and _is_number(b)):
            if a != b:
                return ResultDifference(_path_text(path), position, a, b, None)
            continue
        gap = abs(a - b)
        if path[-1] == "angle":  # a turn more or less is the same place
            gap = abs(math.remainder(gap, 2 * math.pi))
        size = gap / scale if scale else (0.0 if gap == 0 else math.inf)
        if path[-1] in EXTREME_LOCATIONS:
            size = size * size
        if worst is None or size > (worst.size or 0.0):
            worst = ResultDifference(_path_text(path), position, a, b, size)
    return worst


def _series_by_path(value: Any, path: Path = ()) -> Iterator[tuple[Path, list[Any]]]:
    """Yield every value or list of values with its path; an item of a list is named by its index and its name."""
    if isinstance(value, dict):
        for key, part in value.items():
            if path or key not in IGNORED:
                yield from _series_by_path(part, (*path, key))
    elif isinstance(value, list) and any(isinstance(part, dict | list) for part in value):
        for k, part in enumerate(value):
            name = str(part.get("name", k)) if isinstance(part, dict) else str(k)
            yield from _series_by_path(part, (*path, f"{k}:{name}"))
    else:
        yield path, value if isinstance(value, list) else [value]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _quantity_name(path: Path) -> str:
    return path[-2] if path[-1] in ("x", "y") and len(path) > 1 else path[-1]


def _path_text(path: Path) -> str:
    return ".".join(path)
