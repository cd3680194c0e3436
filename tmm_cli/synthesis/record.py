"""Outcome of a synthesis: given values, solution, demands to be measured, tables, drawings; refusals."""

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
Kind = str  # name of a dimension: length, angle, number, speed, ...; `word`: a text


@dataclass(frozen=True)
class NamedValue:
    """A quantity of a task (SI, rad). text: its description; kind `word`: the value is a text.

    name: the parameter it sets, or the key that gives it.
    """

    name: str
    value: Any
    kind: Kind
    text: str


@dataclass(frozen=True)
class Listing:
    """A table of a solution. name: of its file; long: written to files only.

    columns: name in result.json, heading, kind. Kinds `word` and `name` are plain texts; `mixed` are numbers whose kind
    stands in the row's column of kind `unit`. A cell of None is empty.
    """

    name: str
    title: str
    columns: tuple[tuple[str, str, Kind], ...]
    rows: tuple[tuple[Any, ...], ...]
    long: bool = False


@dataclass(frozen=True)
class Demand:
    """A value that the analysed mechanism must show, and the function that measures it on the Results.

    Attributes:
        text: its description.
        value: required or predicted value (SI, rad).
        asked: True if the file requires it; False if the synthesis predicts it.
        measure: returns the measured value; nan if the mechanism has no such quantity.
        at: smallest reference of the relative difference, for a value that may be zero.
        open: returns the uncertainty of the measured value from rounding; None: negligible.
        of: the quantity measured, under which warnings look for it (pressure).
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
        """Return the difference relative to the value, or the absolute one if the value is zero."""
        return abs(measured - self.value) / (max(abs(self.value), self.at) or 1.0)


@dataclass(frozen=True)
class SynthesisOutcome:
    """Outcome of a synthesis.

    Attributes:
        asked, found: given values and solution, as tables show them.
        source: source of the formulas.
        demands: values to be measured on the mechanism.
        drawings: constructions and diagrams.
        notes: texts below the solution.
        listings: further tables.
        sketch: the assembly, if the sketch of the file does not show it.
        output: "slide" or "swing": motion of the link that the demands concern, if the file has another output; "": the
            demands find their link themselves.
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

    @property
    def parameters(self) -> dict[str, NamedValue]:
        """The values found that are parameters, by name."""
        return {value.name: value for value in self.found if value.name}


def given_values(task: Any, quantities: Mapping[str, tuple[Kind, str]]) -> tuple[NamedValue, ...]:
    """Return the quantities that the task has as fields and are not None. quantities: kind and description by name."""
    numbers = ((name, getattr(task, name, None)) for name in quantities)
    return tuple(NamedValue(name, value, *quantities[name]) for name, value in numbers if value is not None)


class Infeasible(Exception):  # noqa: N818
    """No mechanism meets the task.

    Attributes:
        path: the key at fault, or the path inside the block.
        reason: the message.
        nearest: nearest feasible value, if the task knows it: a text, or (value in SI, kind, rounding: 1 up, -1 down, 0
            none).
            Else the value is searched for.
        search: False if such a search would repeat a solution that takes long.
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


def refuse_nonfinite(outcome: SynthesisOutcome) -> SynthesisOutcome:
    """Return the outcome. Raises Infeasible if one of its numbers is not finite, so that none is shown as a
    solution."""
    for value in outcome.found:
        if value.kind != "word" and not bool(np.all(np.isfinite(np.asarray(value.value, dtype=float)))):
            raise Infeasible(
                (), _("no mechanism was found: this quantity has no finite value: {name}").format(name=value.text)
            )
    return outcome
