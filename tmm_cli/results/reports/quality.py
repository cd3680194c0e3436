"""Range of the driver, strokes of the output, dead positions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.kinematics.driver_range import SCAN
from tmm_cli.kinematics.output import OutputCurve, Travel
from tmm_cli.kinematics.strokes import Stroke, Strokes
from tmm_cli.language import N_, _
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER, Dimension, place_dimension
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import CAME_BACK, SEAM_OF_EXTREMES

Row = tuple[str, Any, Dimension]


def tables(results: Results) -> Iterable[Table]:
    """One row a fact; values keep their own dimension."""
    driver_range = results.driver_range
    assert driver_range is not None
    place = place_dimension(results.linkage.driver.kind)
    rows: list[Row] = []
    if driver_range.turns > 1:
        rows.append((_("turns of the driver in a cycle"), driver_range.turns, NUMBER))
    if not driver_range.full:
        rows += [(_("driver can go from"), driver_range.start, place), (_("driver can go to"), driver_range.end, place)]
    for strokes in (results.strokes, *results.further):
        if strokes is not None and strokes.strokes:
            rows += _strokes(results, strokes, place)
        elif strokes is not None and driver_range.full and results.linkage.output_swings(strokes.link):
            rows.append(
                (_("link {link} turns in a cycle by").format(link=strokes.link), _turned(results, strokes), ANGLE)
            )
    for travel in results.travels:
        rows += _travel(results.linkage, travel, place)
    if results.losses is not None and results.losses.efficiency is not None:
        rows.append((_("efficiency over the cycle"), results.losses.efficiency, NUMBER))
    rows += [(_("dead position of {group}").format(group=dead.group), dead.place, place) for dead in results.dead]
    if rows:
        yield Table("quality", _("Quality"), of_rows(rows, results))


def _strokes(results: Results, strokes: Strokes, place: Dimension) -> Iterable[Row]:
    """Strokes of an output that goes there and back as the driver turns."""
    linkage = results.linkage
    link, run = strokes.link, place_dimension(strokes.kind)
    point, guide = linkage.output_point(link), linkage.output_guide(link)
    name = _("swing psi of link {link}") if guide is None else _("stroke H of link {link}")
    if point is not None:
        name = _("travel of {link}")
    elif guide is not None and FRAME not in (guide.carrier, guide.runner):
        name = _("stroke H of link {link} along link {carrier}")
    yield name.format(link=link, carrier=guide.carrier if guide is not None else ""), strokes.travel, run
    arm = linkage.output_arm(link)
    if arm is not None:
        yield _("stroke H = psi l of point {point}").format(point=arm[0]), strokes.travel * arm[1], LENGTH
    yield _("coefficient of change of mean speed k"), strokes.k, NUMBER
    if len(strokes.strokes) == 2:
        yield _("1/k = T_idle/T_working"), 1 / strokes.k, NUMBER
        yield _("stroke angle theta = 180 deg (k - 1)/(k + 1)"), np.pi * (strokes.k - 1) / (strokes.k + 1), ANGLE
    every: list[tuple[int, Stroke]] = [(0, stroke) for stroke in strokes.strokes]
    if results.counts_strokes:
        every = list(enumerate(_in_order(results, strokes), 1))
    for number, stroke in every:
        starts, lasts, dwell = _of_stroke(stroke, number)
        yield starts, stroke.start, place
        then = _("link {link} is then at") if point is None else _("{link} is then at")
        yield then.format(link=link), stroke.low, run
        yield lasts, stroke.length, place
        if stroke.rest:
            yield dwell, stroke.rest, place


def _in_order(results: Results, strokes: Strokes) -> list[Stroke]:
    """From position 0 on; the first of them begins before it where it is within a stroke."""

    def gone(stroke: Stroke) -> float:
        way = results.linkage.driver.sense * (stroke.start - results.start)
        return float(np.mod(way + SEAM_OF_EXTREMES, strokes.cycle)) - SEAM_OF_EXTREMES

    found = sorted(strokes.strokes, key=gone)
    return found if gone(found[0]) <= SEAM_OF_EXTREMES else [found[-1], *found[:-1]]


def _of_stroke(stroke: Stroke, number: int) -> tuple[str, str, str]:
    """What its start, its length and the dwell after it are called; number: 0 of one that is not counted."""
    if number:
        names = _("stroke {number} starts at"), _("stroke {number} lasts"), _("dwell after stroke {number}")
        starts, lasts, dwell = (name.format(number=number) for name in names)
        return starts, lasts, dwell
    if stroke.working:
        return _("working stroke starts at"), _("working stroke lasts"), _("dwell after the working stroke")
    return _("idle stroke starts at"), _("idle stroke lasts"), _("dwell after the idle stroke")


def _turned(results: Results, strokes: Strokes) -> float:
    """By how much (rad) an output turns that does not come back."""
    curve = OutputCurve(results.linkage, results.kernels, strokes.link)
    angle = np.unwrap(curve.place(results.closely(SCAN * round(strokes.cycle / (2 * np.pi)) + 1)))
    turned = abs(float(angle[-1] - angle[0]))
    whole = 2 * np.pi * round(turned / (2 * np.pi))  # whatever repeats has turned by whole turns
    return whole if abs(turned - whole) < CAME_BACK else turned


def _travel(linkage: Linkage, travel: Travel, place: Dimension) -> Iterable[Row]:
    """How far an output goes over the positions asked."""
    link, run = travel.link, place_dimension(travel.kind)
    point, guide = linkage.output_point(link), linkage.output_guide(link)
    name, extremes = _("swing psi of link {link} over the positions asked"), _("extreme position of link {link}")
    if point is not None:
        name, extremes = _("travel of {link} over the positions asked"), _("extreme of {link}")
    elif guide is not None and FRAME not in (guide.carrier, guide.runner):
        name = _("stroke H of link {link} along link {carrier} over the positions asked")
    elif guide is not None:
        name = _("stroke H of link {link} over the positions asked")
    carrier = guide.carrier if guide is not None else ""
    yield name.format(link=link, carrier=carrier), travel.high - travel.low, run
    for extreme, at in ((travel.low, travel.low_at), (travel.high, travel.high_at)):
        yield extremes.format(link=link), extreme, run
        yield _("with the driver at"), at, place


def of_rows(rows: Sequence[Row], results: Results) -> tuple[Column, ...]:
    """Rows of different dimensions: the unit stands in a column of its own."""
    units = results.problem.units
    return (
        Column(N_("what"), [name for name, __, __ in rows]),
        Column(N_("value"), [units.from_si(float(value), dim) for __, value, dim in rows], NUMBER),
        Column(N_("unit"), [units.spelt(dim) for __, __, dim in rows]),
    )
