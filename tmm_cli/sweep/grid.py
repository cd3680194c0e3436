"""Which values parameters are swept over: `OA=80..120:41`, 41 values from 80 to 120 in the unit of the file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.batch import NUMBER, Task
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import Dimension
from tmm_cli.problem import ProblemError, quote

OVER = re.compile(r"\s*([^=\s]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*(?::\s*(\S+)\s*)?")
COUNT = (41, 21)  # values where none is given: of one parameter, of each of two
MOST = 1_000_000  # values of a parameter
EXAMPLE = "--over OA=80..120:41"


@dataclass(frozen=True, eq=False)
class Axis:
    """A parameter that is swept. values: as they are written, in `unit` (none: bare numbers); dimension: of these.

    factor: what a written value is multiplied by: to SI, by 1 where it is bare.
    """

    name: str
    values: Real
    unit: str
    dimension: Dimension | None
    factor: float

    @property
    def words(self) -> str:
        """Its name with the unit."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    def text(self, value: float) -> str:
        """A value as `--set` reads it."""
        return f"{value!r} {self.unit}".strip()


def read_axes(task: Task, over: Sequence[str]) -> tuple[Axis, ...]:
    """What one or two options `--over` say. Raises ProblemError."""
    if not 1 <= len(over) <= 2:
        raise ProblemError(_("one or two parameters are swept"), found=", ".join(over) or None, allowed=EXAMPLE)
    axes = []
    for text in over:
        try:
            axes.append(_axis(task, text, COUNT[len(over) - 1]))
        except ProblemError as error:
            raise error.located(f"--over {text}") from None
        if len({axis.name for axis in axes}) < len(axes):
            raise ProblemError(_("this is swept twice"), found=quote(axes[-1].name), file=f"--over {text}")
    return tuple(axes)


def _axis(task: Task, text: str, usual: int) -> Axis:
    found = OVER.fullmatch(text)
    if found is None:
        raise ProblemError(_("a name, two bounds and perhaps a count are wanted"), found=quote(text), allowed=EXAMPLE)
    name, *ends, count = found.groups()
    (own,) = task.dimensions((name,))
    units = [part[2] for part in map(NUMBER.fullmatch, ends[::-1]) if part]
    unit = next(filter(None, units), "") or _own_unit(task, name)
    said: list[Any] = []
    for end in ends:
        part = NUMBER.fullmatch(end)
        if part is None or (part[2] and part[2] != unit):
            raise ProblemError(_("two numbers in one unit are wanted"), found=quote(end), allowed=EXAMPLE)
        said.append(task.value(f"{part[1]} {unit}".strip()))
    dimension = said[0].dimension
    if own and dimension and not dimension.fits(own):
        raise ProblemError(_("{want} is wanted here").format(want=own), found=quote(text), allowed=own.example)
    low, high = (float(NUMBER.fullmatch(end)[1]) for end in ends)  # type: ignore[index]
    if not low < high:
        raise ProblemError(_("the lower bound comes first"), found=quote(text), allowed=EXAMPLE)
    steps = usual if count is None else int(count) if count.isascii() and count.isdigit() and len(count) < 9 else 0
    if not 2 <= steps <= MOST:
        raise ProblemError(
            _("the number of values is a whole number"),
            found=quote(count),
            allowed=_("{least} to {most}").format(least=2, most=MOST),
        )
    dimension = dimension or own
    values = np.linspace(low, high, steps)
    unit = unit or (task.units.symbol(dimension) if dimension else "")
    return Axis(name, values, unit, dimension, task.number(task.value(f"1 {unit}"), dimension) if unit else 1.0)


def _own_unit(task: Task, name: str) -> str:
    """In which the file writes the parameter; none of arithmetic on others."""
    written = NUMBER.fullmatch(str(task.tree.data.get("parameters", {}).get(name, "")))
    try:
        task.value(f"1 {written[2]}" if written else "")
    except ProblemError:
        return ""
    return written[2] if written else ""


def grid_points(axes: Sequence[Axis]) -> Real:
    """All points as they are written, (points, axes): the last parameter changes first."""
    return np.stack([part.ravel() for part in np.meshgrid(*(axis.values for axis in axes), indexing="ij")], axis=1)
