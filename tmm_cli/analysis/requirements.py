"""What loads, positions and tables of a file rest on: refused where it is not there, not quietly done without."""

from __future__ import annotations

import numpy as np

from tmm_cli.analysis.mechanism import Mechanism
from tmm_cli.analysis.on_request import driver_motion
from tmm_cli.double_double import rounded
from tmm_cli.errors import MissingStrokesError, NoTurnError, SpeedsEndError, TableBeyondCycleError
from tmm_cli.tolerances import SAME_PLACE


def refuse_unmet(mechanism: Mechanism) -> None:
    """Raises MissingStrokesError, NoTurnError, TableBeyondCycleError, SpeedsEndError."""
    _need_strokes(mechanism)
    _need_rows(mechanism)
    _need_speeds(mechanism)


def _need_strokes(mechanism: Mechanism) -> None:
    """Strokes of the output, of which positions are counted, or in which loads act."""
    request, driver_range = mechanism.inputs.request, mechanism.driver_range
    loads = [x for x in mechanism.linkage.loads if x.working_stroke_only or (x.table and x.table.against == "stroke")]
    if request.start != "working stroke" and not loads:
        return
    strokes = mechanism.strokes
    if request.start == "working stroke" and driver_range.full and (strokes is None or not strokes.strokes):
        raise MissingStrokesError(strokes.link if strokes else None, ("positions", "from"))
    for load in loads:
        own = strokes.of_link(load.stroke_link) if strokes else None
        if load.working_stroke_only and driver_range.full and (own is None or not own.strokes):
            raise MissingStrokesError(own.link if own else None, ("loads", load.name, "when"))
        if load.table is not None and load.table.against == "stroke":
            own = strokes.of_link(load.table.stroke_link) if strokes else None
            if own is None or not own.strokes:
                limits = None if driver_range.full else (driver_range.start, driver_range.end)
                path = ("loads", load.name, load.table.key)
                raise MissingStrokesError(own.link if own else None, path, limits)


def _need_rows(mechanism: Mechanism) -> None:
    """A crank that comes to all rows of a load's table, rather than a table that is quietly cut."""
    turns = mechanism.linkage.turns
    if turns > 1 and not mechanism.driver_range.full:
        raise NoTurnError(turns)
    for load in mechanism.linkage.loads:
        if load.table is None or load.table.against == "stroke":
            continue
        strokes = mechanism.strokes if load.table.against == "crank turn" else None
        cycle = 2 * np.pi * turns if strokes is None else strokes.cycle
        for row, argument in enumerate(load.table.arguments):
            if not -SAME_PLACE <= argument <= cycle + SAME_PLACE:
                path = ("loads", load.name, load.table.key, "table", row, 0)
                raise TableBeyondCycleError(path, float(argument), cycle)


def _need_speeds(mechanism: Mechanism) -> None:
    """A table of the driver's speeds that reaches over all positions."""
    law, asked = mechanism.linkage.driver.law, mechanism.asked
    if law is None:
        return
    unknown = ~np.isfinite(driver_motion(mechanism.linkage, float(asked[0])).speed(asked))
    goes_round = mechanism.driver_range.full and not mechanism.inputs.request.places
    if np.any(unknown) or (goes_round and not law.squares.closed):
        first = float(rounded(law.squares.arguments[0]))
        at = float(asked[np.argmax(unknown)]) if np.any(unknown) else None
        raise SpeedsEndError(at, first, float(rounded(law.squares.arguments[-1])), 2 * np.pi * mechanism.linkage.turns)
