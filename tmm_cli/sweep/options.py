"""Options of a sweep: swept parameters with their values (--over), and requested quantities (--show)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.batch import NUMBER_WITH_UNIT, Task
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity, SolvedState
from tmm_cli.mechanics.numerics import Real, greatest_values
from tmm_cli.mechanics.quantities import ANGLE, Dimension
from tmm_cli.problem import ProblemError, quote, unknown_name_error

OVER_OPTION = re.compile(r"\s*([^=\s]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*(?::\s*(\S+)\s*)?")
DEFAULT_COUNTS = (41, 21)  # default numbers of values: of one parameter, of each of two
MOST_VALUES = 1_000_000  # values per parameter
EXAMPLE = "--over OA=80..120:41"


@dataclass(frozen=True, eq=False)
class SweepAxis:
    """A parameter that varies in a sweep.

    Attributes:
        name: name of the parameter.
        values: its values, in `unit`.
        unit: unit as written in the option or in the file; empty for plain numbers.
        dimension: dimension of the parameter; None for plain numbers.
        factor: SI value of one `unit`; 1 for plain numbers.
    """

    name: str
    values: Real
    unit: str
    dimension: Dimension | None
    factor: float

    @property
    def words(self) -> str:
        """Name of the parameter with its unit, e.g. "OA, mm"."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    def text(self, value: float) -> str:
        """Return a value with its unit, in the form that `--set` accepts."""
        return f"{value!r} {self.unit}".strip()


def read_axes(task: Task, over: Sequence[str]) -> tuple[SweepAxis, ...]:
    """Read one or two options `--over`, e.g. "OA=80..120:41".

    Raises:
        ProblemError: An option is malformed, or its parameter does not exist.
    """
    if not 1 <= len(over) <= 2:
        raise ProblemError(_("a sweep must vary one or two parameters"), found=", ".join(over) or None, allowed=EXAMPLE)
    axes = []
    for text in over:
        try:
            axes.append(_read_axis(task, text, DEFAULT_COUNTS[len(over) - 1]))
        except ProblemError as error:
            raise error.located(f"--over {text}") from None
        if len({axis.name for axis in axes}) < len(axes):
            raise ProblemError(_("this parameter is given twice"), found=quote(axes[-1].name), file=f"--over {text}")
    return tuple(axes)


def _read_axis(task: Task, text: str, usual: int) -> SweepAxis:
    match = OVER_OPTION.fullmatch(text)
    if match is None:
        raise ProblemError(
            _("expected the name of a parameter, two bounds and optionally the number of values"),
            found=quote(text),
            allowed=EXAMPLE,
        )
    name, *ends, count = match.groups()
    (expected,) = task.dimensions((name,))
    units = [number[2] for number in map(NUMBER_WITH_UNIT.fullmatch, ends[::-1]) if number]
    unit = next(filter(None, units), "") or _unit_in_file(task, name)
    bounds: list[Any] = []
    for end in ends:
        number = NUMBER_WITH_UNIT.fullmatch(end)
        if number is None or (number[2] and number[2] != unit):
            raise ProblemError(_("both bounds must be numbers in the same unit"), found=quote(end), allowed=EXAMPLE)
        bounds.append(task.value(f"{number[1]} {unit}".strip()))
    dimension = bounds[0].dimension
    if expected and dimension and not dimension.fits(expected):
        raise ProblemError(
            _("expected here: {want}").format(want=expected), found=quote(text), allowed=expected.example
        )
    low, high = (float(NUMBER_WITH_UNIT.fullmatch(end)[1]) for end in ends)  # type: ignore[index]
    if not low < high:
        raise ProblemError(_("the first bound must be smaller than the second"), found=quote(text), allowed=EXAMPLE)
    steps = usual if count is None else int(count) if count.isascii() and count.isdigit() and len(count) < 9 else 0
    if not 2 <= steps <= MOST_VALUES:
        raise ProblemError(
            _("the number of values must be a whole number in the allowed range"),
            found=quote(count),
            allowed=_("{least} to {most}").format(least=2, most=MOST_VALUES),
        )
    dimension = dimension or expected
    values = np.linspace(low, high, steps)
    unit = unit or (task.units.symbol(dimension) if dimension else "")
    return SweepAxis(name, values, unit, dimension, task.number(task.value(f"1 {unit}"), dimension) if unit else 1.0)


def _unit_in_file(task: Task, name: str) -> str:
    """Return the unit of the parameter in the file; empty if the parameter is computed from others or has no unit."""
    written = NUMBER_WITH_UNIT.fullmatch(str(task.tree.data.get("parameters", {}).get(name, "")))
    try:
        task.value(f"1 {written[2]}" if written else "")
    except ProblemError:
        return ""
    return written[2] if written else ""


def grid_points(axes: Sequence[SweepAxis]) -> Real:
    """Return all combinations of the parameter values, in the units of the file, (points, axes).

    The value of the last parameter changes first.
    """
    return np.stack(
        [coordinates.ravel() for coordinates in np.meshgrid(*(axis.values for axis in axes), indexing="ij")], axis=1
    )


PRESSURE = "pressure"  # largest pressure angle on the output over the driver range
DEFAULT_QUANTITIES = ("H", "psi", "k", PRESSURE, "M_b", "F_b")  # shown by default
MOST_QUANTITIES = 12  # in one sweep


@dataclass(frozen=True)
class ShownQuantity:
    """A quantity requested with `--show`.

    Attributes:
        name: name of the quantity.
        dimension: its dimension.
        quantity: description by which the quantity is read from a solved mechanism. None for the largest pressure
            angle,
            which is found by a search.
    """

    name: str
    dimension: Dimension
    quantity: NamedQuantity | None

    @property
    def whole(self) -> bool:
        """True if the quantity describes the whole mechanism (stroke, k) rather than one position."""
        return self.quantity is None or self.quantity.whole

    @property
    def forces(self) -> bool:
        """True if the quantity requires the calculation of forces."""
        return self.quantity is not None and self.quantity.stage in ("forces", "balance")

    @property
    def words(self) -> str:
        """Description of the quantity in the current language."""
        if self.whole:
            return {PRESSURE: _("largest pressure angle")}.get(self.name, self.name)
        if self.ranges:
            return _("range of {quantity} over the cycle").format(quantity=self.name)
        return _("largest {quantity} over the cycle").format(quantity=self.name)

    @property
    def ranges(self) -> bool:
        return self.quantity is not None and self.quantity.against in ("range", "angle")

    def at_positions(self, solved: SolvedState) -> Any:
        """Return the quantity at each position of a solved mechanism.

        If the sweep shows its largest value over the cycle, its magnitude is returned.
        """
        assert self.quantity is not None
        samples = self.quantity.read(solved)
        return samples if self.ranges else np.abs(samples)

    def over_cycle(self, curves: Callable[[Real, Real], Real], q: Real, values: Real) -> Real:
        """Return one value of the quantity for each variant, (variants,).

        It is the range of an angle or coordinate over the cycle, and the largest value of any other quantity.

        Args:
            curves, q, values: as in `greatest_values`.
        """
        if not self.ranges:
            return greatest_values(curves, q, values)
        assert self.quantity is not None
        turns = self.quantity.against == "angle"
        values = np.unwrap(values, axis=1) if turns else values
        high = greatest_values(curves, q, values, turns=turns)
        return high + greatest_values(lambda rows, at: -curves(rows, at), q, -values, turns=turns)


def showable_quantities(task: Task) -> Mapping[str, ShownQuantity]:
    """Return all quantities of a problem that a sweep can show, by name.

    Raises:
        ProblemError: The problem cannot be built.
    """
    named = {
        name: ShownQuantity(name, quantity.dimension, quantity)
        for name, quantity in task.quantities.items()
        if not name.startswith("arm of ")  # it is nothing where its force vanishes
    }
    return {**named, PRESSURE: ShownQuantity(PRESSURE, ANGLE, None)}


def read_shown(task: Task, texts: Sequence[str]) -> tuple[ShownQuantity, ...]:
    """Read options `--show`, each with names separated by commas; `v_E` means "v of E".

    Raises:
        ProblemError: A quantity does not exist, or there are too many.
    """
    available = showable_quantities(task)
    names = {
        **{name.replace(" of ", "_").replace(" on ", "_"): name for name in available},
        **{name: name for name in available},
    }
    chosen: list[ShownQuantity] = []
    for text in texts:
        for name in _split_names(text, names):
            if name not in names:
                some = _("e.g. {names}").format(names=", ".join(_example_names(available)))
                raise unknown_name_error(
                    name, names, _("there is no quantity with this name"), some, file=f"--show {text}"
                )
            chosen.append(available[names[name]])
    chosen = list(dict.fromkeys(chosen)) or [
        available[name] for name in DEFAULT_QUANTITIES if name in available and not (name == "H" and "psi" in available)
    ]
    if len(chosen) > MOST_QUANTITIES:
        raise ProblemError(
            _("too many quantities"),
            found=str(len(chosen)),
            allowed=_("at most {most}").format(most=MOST_QUANTITIES),
            file="--show",
        )
    return tuple(chosen)


def _split_names(text: str, names: Mapping[str, str]) -> list[str]:
    """Split a text at its commas, but not inside a name that contains a comma, e.g. R_10,11."""
    split: list[str] = []
    for piece in re.split(r"\s*,\s*", text.strip()):
        if split and f"{split[-1]},{piece}" in names:
            split[-1] = f"{split[-1]},{piece}"
        else:
            split.append(piece)
    return split


def _example_names(available: Mapping[str, ShownQuantity]) -> list[str]:
    """Return the name of one quantity of each kind, for an error message."""
    kinds = {re.split(r" of |_(?=[^b])", name)[0]: name for name in reversed(list(available))}
    return list(kinds.values())[::-1]
