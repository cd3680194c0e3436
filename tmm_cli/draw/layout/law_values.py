"""Tables of values on the large sheet of the law of motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.layout.tables import table
from tmm_cli.draw.layout.values import Quantity, over_positions
from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.language import _, translated
from tmm_cli.plans.record import Lettered, Symbol
from tmm_cli.problem.units import on_paper
from tmm_cli.quantities import ANGULAR_ACCELERATION, ANGULAR_SPEED, INERTIA, MOMENT, NUMBER
from tmm_cli.results.reports import walk
from tmm_cli.results.terminal import cells

FIGURES = 4  # of each number


def law_tables(results: Results) -> Iterator[tuple[str, Drawing]]:
    """What was found, then the machine reduced to its driver and its law of motion in all positions."""
    running = results.steady
    if running is None or results.motion is None:
        return
    units = results.problem.units
    for found in walk(results, ("dynamics",)):
        columns = [cells(replace(column, digits=FIGURES), units, range(found.rows)) for column in found.columns]
        heads = [translated(column.header) for column in found.columns]
        rows = [[*told, on_paper(unit)] for *told, unit in zip(*columns, strict=True)]
        yield "table-dynamics", table(found.title, heads, rows)
    yield "table-law", over_positions(results, _("Law of motion of the driver"), _columns(results))


def _columns(results: Results) -> list[Quantity]:
    running, motion = results.steady, results.motion
    assert running is not None and motion is not None
    law, way = running.steady.law, running.way(motion.q)
    machine, sense = running.steady.machine, running.sense
    return [
        (Symbol("J"), machine.inertia(way), INERTIA), (Symbol("M"), sense * machine.moment(way), MOMENT),
        (Lettered("M_d"), sense * law.driving(way), MOMENT), (_("A, J"), running.steady.work(way), NUMBER),
        (Symbol("ω"), motion.rate, ANGULAR_SPEED), (Symbol("ε"), motion.acceleration, ANGULAR_ACCELERATION),
        (_("t, s"), motion.time, NUMBER),
    ]  # fmt: skip
