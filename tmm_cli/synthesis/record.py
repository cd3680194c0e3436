"""What every synthesis gives: values, what the mechanism must show when it is analysed, and how it is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from tmm_cli.language import _

if TYPE_CHECKING:
    from tmm_cli.mechanics.linkage import Sketch
    from tmm_cli.synthesis.construction import Diagram, GeometricConstruction


SMALLEST: Final = 1e-6  # SI, of what has a size: less is no mechanism's
Kind = str  # a dimension by its name: length, angle, number, speed, ...; `word` for what is no number


@dataclass(frozen=True)
class NamedValue:
    """A quantity of a task (SI, rad); text: what it is called. Of kind `word` the value is a text itself.

    name: of the parameter that it is, or of the key that gives it.
    """

    name: str
    value: Any
    kind: Kind
    text: str


@dataclass(frozen=True)
class Listing:
    """A table of what was found. columns: name in result.json, text of the header, and kind of the values; name: of its
    file; a long one is for files only.

    kind `word`, `name`: texts as they are; `mixed`: numbers whose kind is in the row's column of kind `unit`. None:
    there is none.
    """

    name: str
    title: str
    columns: tuple[tuple[str, str, Kind], ...]
    rows: tuple[tuple[Any, ...], ...]
    long: bool = False


@dataclass(frozen=True)
class Demand:
    """What must come back when the mechanism is analysed: value (SI, rad), and how it is measured on the Results.

    text: what it is called. asked: by the file; else it is what the synthesis foretells. A measure gives nan where the
    mechanism has no such quantity. at: the least size that counts in the relative difference, for a value that may be
    zero. open: by how much of it rounding leaves the measured value open; None: by next to nothing. of: what is
    measured, where a warning looks for it (pressure).
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
        """Relative to what is wanted, or absolute where that is zero."""
        return abs(measured - self.value) / (max(abs(self.value), self.at) or 1.0)


@dataclass(frozen=True)
class SynthesisOutcome:
    """What a task gives. parameters: what the linkage may use, by name; source: where the formula is from.

    asked, found: what is shown; demands: what is measured; drawings: how a student draws it;
    notes: texts below what was found; listings: further tables. sketch: how the mechanism is assembled,
    where the file's own does not show it. output: slide or swing, whose link the demands are about where the file's
    output is another; empty: they look for theirs.
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
        """Found values by name."""
        return {value.name: value for value in self.found if value.name}


def given_values(task: Any, quantities: Mapping[str, tuple[Kind, str]]) -> tuple[NamedValue, ...]:
    """Those of these quantities that a task has as fields, and not None, by their kinds and what they are called."""
    numbers = ((name, getattr(task, name, None)) for name in quantities)
    return tuple(NamedValue(name, value, *quantities[name]) for name, value in numbers if value is not None)


class Infeasible(Exception):  # noqa: N818  said of a task, as it is said
    """A task that no mechanism meets.

    key: which of what was given is at fault, or the way to it inside the block. nearest: its nearest feasible value,
    where the task knows it: a word, or (value in SI, kind, the side to which it may be rounded: 1, -1, or 0). Else it
    is searched for, but not where `search` says that this takes as long as the task itself, again and again.
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
    """The same. Raises Infeasible where a number that was found is none, so that none is ever shown as an answer."""
    for value in outcome.found:
        if value.kind != "word" and not bool(np.all(np.isfinite(np.asarray(value.value, dtype=float)))):
            raise Infeasible((), _("no mechanism was found: it has no {name}").format(name=value.text))
    return outcome
