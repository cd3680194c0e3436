"""Values of a task of synthesis within what a mechanism can have: beyond, numbers overflow and answers mean nothing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import PhysicalValue, UnitSystem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, ANGULAR_SPEED, LENGTH, NUMBER, SPEED, Dimension
from tmm_cli.synthesis.record import SMALLEST

MOST: Final = {LENGTH: 1e6, NUMBER: 1e6, SPEED: 1e6, ANGULAR_SPEED: 1e6, ANGLE: 1e3}  # SI, rad
# what has a size is SMALLEST or more: coordinates, offsets and angles may be as near to zero as they like
# k is refused by its task, which knows the bounds of it
SIZED: Final = (LENGTH, SPEED, ANGULAR_SPEED)
SHARES: Final = ("ratio", "frame_ratio", "rod_ratio", "pressure")
PLACES: Final = ("e", "xA", "yA")
PLAIN: Final = ("table", "x")  # of a function: they are no measures of a mechanism


class Bounded(ValueReader):
    """The sense of a file's values, for a task that computes a mechanism.

    others: values (SI) in the place of the file's own; given: what was read, with its dimension. Both by their paths.
    """

    def __init__(
        self, parameters: Mapping[str, PhysicalValue], units: UnitSystem, others: Mapping[Path, float] | None = None
    ) -> None:
        super().__init__(parameters, units)
        self.others = others or {}
        self.given: dict[Path, tuple[float, Dimension]] = {}

    def found(self, value: Any, want: Dimension, path: Path) -> float:
        return self.others[path] if path in self.others else super().found(value, want, path)

    def most(self, want: Dimension, path: Path) -> float:
        limit = super().most(want, path)
        return limit if _exempt(path) else MOST.get(want, limit)

    def number(self, value: Any, want: Dimension, path: Path) -> float:
        """A value in SI. Raises ProblemError where no mechanism has it."""
        found = super().number(value, want, path)
        self.given[path] = found, want
        key = path[-1] if path else ""
        sized = isinstance(key, str) and key not in PLACES and (want in SIZED or key in SHARES)
        if not sized or _exempt(path) or found >= SMALLEST:
            return found
        raise self.too_small(value, SMALLEST, want, path)


def _exempt(path: Path) -> bool:
    return bool(path) and (path[-1] == "k" or path[0] in PLAIN)
