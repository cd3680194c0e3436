"""Outcome of a synthesis (input data, solution, values to be verified, tables, drawings), and the error for a task
without solution.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from tmm_cli.language import _

if TYPE_CHECKING:
    from tmm_cli.mechanics.linkage import Sketch
    from tmm_cli.synthesis.construction import Diagram, GeometricConstruction


SMALLEST: Final = 1e-6  # SI: smallest length or ratio of a mechanism
NO_DISTANCE: Final = 1e-10  # relative to the lengths of a mechanism
Kind = str  # name of a dimension: length, angle, number, speed, ...; `word`: a text


@dataclass(frozen=True)
class NamedValue:
    """A quantity of a synthesis task, with the description that tables show.

    Attributes:
        name: name of the parameter that has this value, or of the key that specifies it; empty if there is neither.
        value: value (SI, rad); a text if the kind is `word`.
        kind: name of the dimension (length, angle, number, ...), or `word`.
        text: description.
    """

    name: str
    value: Any
    kind: Kind
    text: str


@dataclass(frozen=True)
class Listing:
    """A table of a solution.

    Attributes:
        name: file name without its extension.
        title: title of the table.
        columns: name in result.json, heading and kind of each column. Columns of kind `word` and `name` contain plain
            text. Columns of kind `mixed` contain numbers whose kind is given in the same row, in the column of kind
            `unit`.
        rows: cells of each row (SI, rad); None for an empty cell.
        long: True if the table is written only to files, and not printed.
    """

    name: str
    title: str
    columns: tuple[tuple[str, str, Kind], ...]
    rows: tuple[tuple[Any, ...], ...]
    long: bool = False


@dataclass(frozen=True)
class Demand:
    """A value that the synthesised mechanism must have, and the function that measures it.

    Attributes:
        text: description.
        value: required or predicted value (SI, rad).
        kind: name of its dimension.
        measure: function of the analysis Results that returns the measured value; nan if the mechanism has no such
            quantity.
        asked: True if the file requires the value; False if the synthesis predicts it.
        at: lower limit of the reference for the relative difference; needed if the value may be zero.
        open: function of the Results that returns the uncertainty of the measured value from rounding; None if
            negligible.
        of: name of the measured quantity, e.g. `pressure`, by which the warnings find it.
    """

    text: str
    value: float
    kind: Kind
    measure: Callable[[Any], float]
    asked: bool = True
    at: float = 0.0
    open: Callable[[Any], float] | None = None
    of: str = ""

    def difference(self, measured: float) -> float:
        """Return the difference between a measured value and the required one, as a fraction of the required value.

        If the required value is less than `at`, the difference is divided by `at`; if both are zero, it is absolute.
        """
        return abs(measured - self.value) / (max(abs(self.value), self.at) or 1.0)


@dataclass(frozen=True)
class SolutionQuality:
    """Quality of a mechanism found by a synthesis.

    Attributes:
        pressure: largest pressure angle on the driven link (rad), 90 degrees less the smallest transmission angle.
        slides: True if the driven link slides on the frame, False if it rotates.
        crank: True if the input link rotates fully.
        defect: "" for none; "branch" if some positions belong to the other assembly; "order" if they are not reached in
            order or the input link locks between them.
        limited: True if the task specifies a limit of the pressure angle.
    """

    pressure: float
    slides: bool = False
    crank: bool = True
    defect: Literal["", "branch", "order"] = ""
    limited: bool = False


@dataclass(frozen=True)
class SynthesisOutcome:
    """Outcome of a synthesis task.

    Attributes:
        asked: input data, as tables show them.
        found: solution, as tables show it.
        source: source of the formulas.
        demands: values to be measured on the mechanism.
        drawings: constructions and diagrams.
        notes: texts below the solution.
        listings: further tables.
        sketch: sketch that selects the assembly; None to use the sketch of the file.
        output: motion of the link that the demands concern, "slide" or "swing"; needed if the file names another output
            link. Empty if the demands select their link themselves.
        quality: quality of the mechanism; None if the task leaves it to the analysis.
    """

    asked: tuple[NamedValue, ...]
    found: tuple[NamedValue, ...]
    source: str
    demands: tuple[Demand, ...] = ()
    drawings: tuple[GeometricConstruction | Diagram, ...] = ()
    notes: tuple[str, ...] = field(default=())
    listings: tuple[Listing, ...] = ()
    sketch: Sketch | None = None
    output: Literal["slide", "swing", ""] = ""
    quality: SolutionQuality | None = None

    @property
    def parameters(self) -> dict[str, NamedValue]:
        """Values of the solution that set parameters of the file, by name of the parameter."""
        return {value.name: value for value in self.found if value.name}


def given_values(task: Any, quantities: Mapping[str, tuple[Kind, str]]) -> tuple[NamedValue, ...]:
    """Return the input data of a task as values with descriptions.

    Args:
        task: record of the task.
        quantities: kind and description of each quantity, by name. A quantity that the task lacks, or that is None, is
            omitted.
    """
    numbers = ((name, getattr(task, name, None)) for name in quantities)
    return tuple(NamedValue(name, value, *quantities[name]) for name, value in numbers if value is not None)


class Infeasible(Exception):  # noqa: N818
    """Raised if no mechanism satisfies the task.

    Attributes:
        path: key at fault, or its path inside the block; empty if no single key is at fault.
        reason: error message.
        nearest: nearest feasible value if the task knows it: a text, or (value in SI, kind, direction of rounding: 1
            up, -1 down, 0 none). If None, the nearest value is searched for.
        search: False if this search would take too long.
    """

    def __init__(
        self,
        key: str | tuple[str | int, ...],
        reason: str,
        nearest: str | tuple[float, Kind, int] | None = None,
        *,
        search: bool = True,
    ) -> None:
        self.path = (key,) if isinstance(key, str) else key
        self.reason, self.nearest, self.search = reason, nearest, search and bool(self.path)
        super().__init__(reason)


def distance_beyond_rounding(apart: Any, size: float) -> float:
    """Return the distance (m) of a point from the required one; zero below the ten digits that are printed of lengths.

    Args:
        apart: difference of the two points (complex, m).
        size: length (m) of the mechanism.
    """
    distance = float(abs(apart))
    return distance if distance > NO_DISTANCE * size else 0.0


def refuse_nonfinite(outcome: SynthesisOutcome) -> SynthesisOutcome:
    """Check that every number of a solution is finite.

    Returns:
        The same outcome.

    Raises:
        Infeasible: a number is infinite or nan.
    """
    for value in outcome.found:
        if value.kind != "word" and not bool(np.all(np.isfinite(np.asarray(value.value, dtype=float)))):
            raise Infeasible(
                (), _("no mechanism was found: the quantity '{name}' has no finite value").format(name=value.text)
            )
    return outcome
