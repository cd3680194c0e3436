"""Comparison of the content of a result.json with expected content, quantity by quantity."""

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
        position: index of the position; None if the quantity has a single value.
        expected: expected value.
        found: actual value.
        size: difference divided by the largest value of the quantity in the cycle; None if the values are not numbers.
    """

    quantity: str
    position: int | None
    expected: Any
    found: Any
    size: float | None


def golden_part(result: dict[str, Any]) -> dict[str, Any]:
    """Return the part of result.json that is recorded as expected content.

    It omits results that follow from other results in the file.
    """
    return {key: _recorded(part) for key, part in result.items() if key not in IGNORED}


def _recorded(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _recorded(part) for key, part in value.items() if key not in NOT_RECORDED}
    return [_recorded(part) for part in value] if isinstance(value, list) else value


def golden_record(result: dict[str, Any]) -> dict[str, Any]:
    """Return the content that is recorded as expected: the `golden_part` of result.json with numbers rounded to 8
    digits.
    """
    text = json.dumps(golden_part(result))
    rounded: dict[str, Any] = json.loads(text, parse_float=lambda number: float(f"{float(number):.{GOLDEN_DIGITS}g}"))
    return rounded


def new_quantities(expected: dict[str, Any], actual: dict[str, Any]) -> list[str]:
    """Return the paths of quantities in result.json that have no expected value.

    They are new in this version; the expected content was recorded by an earlier one.
    """
    known = {path for path, __ in _series_by_path(expected)}
    return [_path_text(path) for path, __ in _series_by_path(actual) if path not in known]


def find_differences(expected: dict[str, Any], actual: dict[str, Any], tolerance: float) -> list[ResultDifference]:
    """Compare two contents of result.json and return the quantities that differ by more than the tolerance.

    Missing quantities come first. For every other expected quantity the position with the largest difference is
    reported, in the order of the file.

    Args:
        expected: expected content of result.json.
        actual: actual content of result.json.
        tolerance: largest allowed difference, as a fraction of the largest value of the quantity in the cycle.
    """
    want, have = dict(_series_by_path(expected)), dict(_series_by_path(actual))
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
    """Return the reference value of each series of numbers: its largest value, by which differences are divided.

    Both components of a vector share the largest magnitude of the vector. A series of very small values gets a larger
    reference, so that its rounding error does not count as a difference.
    """
    peaks = {path: max((abs(v) for v in values if _is_number(v)), default=0.0) for path, values in series.items()}
    for path, values in series.items():
        across = (*path[:-1], "y")
        if path[-1] == "x" and across in series:
            vectors = (xy for xy in zip(values, series[across], strict=False) if all(map(_is_number, xy)))
            peaks[path] = peaks[across] = max((math.hypot(*xy) for xy in vectors), default=0.0)
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


def difference_table(differences_by_problem: Mapping[str, Sequence[ResultDifference]]) -> Table:
    """Return the table of the differences found in several problems; keys: names of the problems."""
    headers = (_("problem"), _("quantity"), _("position"), _("expected"), _("actual"), _("relative difference"))
    rows = [
        (
            name,
            d.quantity,
            "" if d.position is None else str(d.position),
            brief_value(d.expected),
            brief_value(d.found),
            "" if d.size is None else f"{d.size:.2g}",
        )
        for name, differences in differences_by_problem.items()
        for d in differences
    ]
    return text_table("check", _("Differences from the expected values"), headers, rows)


def brief_value(value: Any) -> str:
    """Return a value as text for a table cell: a number with 15 digits, any other value with at most 60 characters."""
    return f"{value:.15g}" if isinstance(value, float) else str(value)[:60]


def _largest_difference(path: Path, expected: list[Any], actual: list[Any], scale: float) -> ResultDifference | None:
    if len(expected) != len(actual):
        return ResultDifference(_path_text(path), None, f"{len(expected)} values", f"{len(actual)} values", None)
    worst: ResultDifference | None = None
    for k, (a, b) in enumerate(zip(expected, actual, strict=True)):
        position = k if len(expected) > 1 else None
        if not (_is_number(a) and _is_number(b)):
            if a != b:
                return ResultDifference(_path_text(path), position, a, b, None)
            continue
        gap = abs(a - b)
        if path[-1] == "angle":  # a turn more or less is the same place
            gap = abs(math.remainder(gap, 2 * math.pi))
        relative_gap = gap / scale if scale else (0.0 if gap == 0 else math.inf)
        if path[-1] in EXTREME_LOCATIONS:
            relative_gap = relative_gap * relative_gap
        if worst is None or relative_gap > (worst.size or 0.0):
            worst = ResultDifference(_path_text(path), position, a, b, relative_gap)
    return worst


def _series_by_path(value: Any, path: Path = ()) -> Iterator[tuple[Path, list[Any]]]:
    """Yield the path and the values of every quantity in nested content; a single value becomes a list of one.

    An item of a list appears in the path with its index and its name, e.g. `0:slider`.
    """
    if isinstance(value, dict):
        for key, nested in value.items():
            if path or key not in IGNORED:
                yield from _series_by_path(nested, (*path, key))
    elif isinstance(value, list) and any(isinstance(nested, dict | list) for nested in value):
        for k, nested in enumerate(value):
            name = str(nested.get("name", k)) if isinstance(nested, dict) else str(k)
            yield from _series_by_path(nested, (*path, f"{k}:{name}"))
    else:
        yield path, value if isinstance(value, list) else [value]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _quantity_name(path: Path) -> str:
    return path[-2] if path[-1] in ("x", "y") and len(path) > 1 else path[-1]


def _path_text(path: Path) -> str:
    return ".".join(path)
