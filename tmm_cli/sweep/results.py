"""Results of a sweep, as tables and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import DIMENSIONS, NUMBER, product_text
from tmm_cli.problem import Problem
from tmm_cli.reports import Column, Table
from tmm_cli.sweep.options import ShownQuantity, SweepAxis

WORKS, LIMIT, STOPS, APART, REFUSED = range(5)  # states of a mechanism
STATES = ("works", "limit", "stops", "apart", "refused")  # words of the states in files
STATE_WORDS = (
    N_("feasible"),
    N_("limit exceeded"),
    N_("no full rotation"),
    N_("cannot be assembled"),
    N_("rejected"),
)


@dataclass(frozen=True)
class Border:
    """A point between two grid points at which the state of the mechanism changes.

    Attributes:
        at: parameter values in the units of the file.
        along: index of the parameter in which the two grid points differ.
        before, after: states on both sides, in the direction in which the parameter increases.
        why: the exceeded limit, or the reason why there is no mechanism.
    """

    at: tuple[float, ...]
    along: int
    before: int
    after: int
    why: str = ""


@dataclass(frozen=True, eq=False)
class SweepResults:
    """Results of a sweep.

    Attributes:
        axes: parameters that vary.
        shown: requested quantities.
        points: parameter values in the units of the file, in the order of `grid_points`, (points, axes).
        state: state of the mechanism, (points,).
        why: the exceeded limit, or the reason why there is no mechanism, for each point.
        values: quantities in SI units, (points, quantities); nan where there is no mechanism.
        marks: boundary points between states.
        taped: True if the points were computed by replaying a trace.
        reach: by load name, for each load that a table gives against a stroke: last argument of the table, and the
            stroke at
            each point (m or rad).
    """

    axes: tuple[SweepAxis, ...]
    shown: tuple[ShownQuantity, ...]
    points: Real
    state: Real
    why: list[str]
    values: Real
    marks: tuple[Border, ...]
    taped: bool
    reach: Mapping[str, Sequence[tuple[float, float]]]

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(len(axis.values) for axis in self.axes)


FORMAT = 1
TITLE, BORDERS = N_("Parameter sweep"), N_("Boundaries between states")


def points_table(sweep: SweepResults, *, words: bool = False) -> Table:
    """Return the table of results, with one row for each point.

    Args:
        sweep: results of the sweep.
        words: True to write states in the reader's language, False as in files.
    """
    names = [translated(word) for word in STATE_WORDS] if words else list(STATES)
    columns = [Column(axis.words, sweep.points[:, k], NUMBER) for k, axis in enumerate(sweep.axes)]
    columns += [Column(quantity.name, sweep.values[:, k], quantity.dimension) for k, quantity in enumerate(sweep.shown)]
    columns.append(Column(N_("mechanism"), [names[n] for n in sweep.state.tolist()]))
    why = [_reason_text(*both) for both in zip(sweep.why, sweep.state.tolist(), strict=True)] if words else sweep.why
    columns.append(Column(N_("reason"), why))
    return Table("sweep", translated(TITLE), tuple(columns))


def borders_table(sweep: SweepResults, *, words: bool = False) -> Table:
    """Return the table of boundary points between states, with one row for each point.

    Args:
        sweep: results of the sweep.
        words: True to write states in the reader's language, False as in files.
    """
    names = [translated(word) for word in STATE_WORDS] if words else list(STATES)
    columns = [
        Column(axis.words, np.array([mark.at[k] for mark in sweep.marks]), NUMBER, digits=9)
        for k, axis in enumerate(sweep.axes)
    ]
    columns += [
        Column(N_("state before the boundary"), [names[mark.before] for mark in sweep.marks]),
        Column(N_("state after the boundary"), [names[mark.after] for mark in sweep.marks]),
        Column(N_("reason"), [_reason_text(m.why, max(m.before, m.after)) if words else m.why for m in sweep.marks]),
    ]
    return Table("borders", translated(BORDERS), tuple(columns))


def sections(sweep: SweepResults, problem: Problem) -> Iterator[tuple[str, Any]]:
    """Yield the top-level entries of result.json for a sweep, as (key, value).

    Quantities are in SI units and radians, parameters in the units of the file.
    """
    yield "format", FORMAT
    yield "problem", problem.name
    yield "title", problem.title
    yield (
        "parameters",
        [{"name": axis.name, "unit": axis.unit, "si": axis.factor, "values": axis.values} for axis in sweep.axes],
    )
    yield "order", "values and mechanism go through the points with the last parameter changing first"
    yield "taped", sweep.taped
    yield "states", list(STATES)
    yield "mechanism", sweep.state
    yield "why", {str(k): text for k, text in enumerate(sweep.why) if text}
    yield (
        "quantities",
        [
            {
                "name": quantity.name,
                "unit": _si_unit(quantity.dimension),
                "kind": _quantity_kind(quantity),
                "values": sweep.values[:, k],
            }
            for k, quantity in enumerate(sweep.shown)
        ],
    )
    yield (
        "borders",
        [
            {
                "at": list(mark.at),
                "along": sweep.axes[mark.along].name,
                "before": STATES[mark.before],
                "after": STATES[mark.after],
                "why": mark.why,
            }
            for mark in sweep.marks
        ],
    )


def _reason_text(text: str, state: int) -> str:
    """Return the reason for a state in the reader's language.

    The name of an exceeded limit is replaced by a text. Any other reason is returned unchanged.
    """
    kind, _space, thing = text.partition(" ")
    if state == LIMIT and kind == "pressure":
        return _("pressure angle of link {link}").format(link=thing)
    if state == LIMIT and kind == "slot":
        return _("travel beyond the end of the slot of pair {link}").format(link=thing)
    return text


def _quantity_kind(quantity: Any) -> str:
    return (
        "of the mechanism"
        if quantity.whole
        else "range over the cycle"
        if quantity.ranges
        else "largest over the cycle"
    )


def _si_unit(dimension: Any) -> str:
    bases = {"m": dimension.length, "kg": dimension.mass, "s": dimension.time, "rad": dimension.angle}
    named = {DIMENSIONS["force"].dimension: "N", DIMENSIONS["moment of force"].dimension: "N*m"}
    return named.get(dimension, product_text(bases))
