"""Tables of strokes and driver range, pressure angles, requested properties, checks, and assemblies of groups."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tmm_cli.language import N_, Phrase, _, numeral
from tmm_cli.mechanics.analysis import Check, Results, run_checks
from tmm_cli.mechanics.assembly import Assemblies, GroupAssemblies, name_assembly_files
from tmm_cli.mechanics.kinematics import SCAN, OutputCurve, OutputTravel, Stroke, Strokes
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import CAME_BACK, NO_PRESSURE, SAME_DRIVER_POSITION, SEAM_OF_EXTREMES
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, NUMBER, Dimension, coordinate_dimension
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.problem import Problem
from tmm_cli.reports.properties import shown_properties
from tmm_cli.reports.table import Column, Table, text_table, with_unit

SCAN_OFFSET = 0.4  # steps of the scan: so far beside change points and dead positions, which lie at whole angles

ValueRow = tuple[str, Any, Dimension]


def quality_tables(results: Results) -> Iterable[Table]:
    """Yield the table of driver range, strokes and travels of outputs, efficiency and dead positions."""
    driver_range = results.driver_range
    assert driver_range is not None
    place = coordinate_dimension(results.linkage.driver.kind)
    rows: list[ValueRow] = []
    if driver_range.turns > 1:
        rows.append((_("turns of the driver per cycle"), driver_range.turns, NUMBER))
    if not driver_range.full:
        rows += [
            (_("smallest driver coordinate"), driver_range.start, place),
            (_("largest driver coordinate"), driver_range.end, place),
        ]
    for strokes in (results.strokes, *results.further):
        if strokes is not None and strokes.strokes:
            rows += _stroke_rows(results, strokes, place)
        elif strokes is not None and driver_range.full and results.linkage.output_swings(strokes.link):
            rows.append(
                (
                    _("rotation of link {link} per cycle").format(link=strokes.link),
                    _rotation_angle(results, strokes),
                    ANGLE,
                )
            )
    for travel in results.travels:
        rows += _travel_rows(results.linkage, travel, place)
    if results.losses is not None and results.losses.efficiency is not None:
        rows.append((_("efficiency over the cycle"), results.losses.efficiency, NUMBER))
    rows += [
        (_("driver position at the dead position of {group}").format(group=dead.group), dead.place, place)
        for dead in results.dead
    ]
    if rows:
        yield Table("quality", _("Characteristics of the mechanism"), value_columns(rows, results))


def _stroke_rows(results: Results, strokes: Strokes, place: Dimension) -> Iterable[ValueRow]:
    """Yield the table rows for the strokes of an output that moves forward and back."""
    linkage = results.linkage
    link, run = strokes.link, coordinate_dimension(strokes.kind)
    point, guide = linkage.output_point(link), linkage.output_guide(link)
    name = _("swing angle ψ of link {link}") if guide is None else _("stroke H of link {link}")
    if point is not None:
        name = _("travel of {link}")
    elif guide is not None and FRAME not in (guide.carrier, guide.runner):
        name = _("stroke H of link {link} along link {carrier}")
    yield name.format(link=link, carrier=guide.carrier if guide is not None else ""), strokes.travel, run
    arm = linkage.output_arm(link)
    if arm is not None:
        yield (
            _("stroke H = psi*l of point {point}, where l is its distance from the pivot").format(point=arm[0]),
            strokes.travel * arm[1],
            LENGTH,
        )
    yield _("time ratio k"), strokes.k, NUMBER
    if len(strokes.strokes) == 2:
        yield _("1/k = T_return/T_working"), 1 / strokes.k, NUMBER
        yield _("angle theta = 180 deg (k - 1)/(k + 1)"), np.pi * (strokes.k - 1) / (strokes.k + 1), ANGLE
    numbered: list[tuple[int, Stroke]] = [(0, stroke) for stroke in strokes.strokes]
    if results.counts_strokes:
        numbered = list(enumerate(_strokes_in_order(results, strokes), 1))
    for number, stroke in numbered:
        starts, lasts, dwell = _stroke_names(stroke, number)
        yield starts, stroke.start, place
        then = (
            _("position of link {link} at this driver position")
            if point is None
            else _("{link} at this driver position")
        )
        yield then.format(link=link), stroke.low, run
        yield lasts, stroke.length, place
        if stroke.rest:
            yield dwell, stroke.rest, place


def _strokes_in_order(results: Results, strokes: Strokes) -> list[Stroke]:
    """Return the strokes in the order of motion, beginning with the stroke in which position 0 lies."""

    def gone(stroke: Stroke) -> float:
        travel = results.linkage.driver.sense * (stroke.start - results.start)
        return float(np.mod(travel + SEAM_OF_EXTREMES, strokes.cycle)) - SEAM_OF_EXTREMES

    ordered = sorted(strokes.strokes, key=gone)
    return ordered if gone(ordered[0]) <= SEAM_OF_EXTREMES else [ordered[-1], *ordered[:-1]]


def _stroke_names(stroke: Stroke, number: int) -> tuple[str, str, str]:
    """Return the row headings for the start, travel and dwell of a stroke. number: 0 if strokes are not numbered."""
    if number:
        names = (
            _("driver position at the start of stroke {number}"),
            _("driver travel during stroke {number}"),
            _("dwell after stroke {number}"),
        )
        starts, lasts, dwell = (name.format(number=number) for name in names)
        return starts, lasts, dwell
    if stroke.working:
        return (
            _("driver position at the start of the working stroke"),
            _("driver travel during the working stroke"),
            _("dwell after the working stroke"),
        )
    return (
        _("driver position at the start of the return stroke"),
        _("driver travel during the return stroke"),
        _("dwell after the return stroke"),
    )


def _rotation_angle(results: Results, strokes: Strokes) -> float:
    """Return the angle (rad) by which an output that never reverses rotates in a cycle."""
    curve = OutputCurve(results.linkage, results.kernels, strokes.link)
    q = results.closely(SCAN * round(strokes.cycle / (2 * np.pi)) + 1)
    if results.turns:  # not from a change point on: where two hinges coincide, a link has no angle
        q = q + SCAN_OFFSET * (q[1] - q[0])
    angle = curve.place(q)
    angle = np.unwrap(angle[np.isfinite(angle)])
    turned = abs(float(angle[-1] - angle[0]))
    whole = 2 * np.pi * round(turned / (2 * np.pi))  # whatever repeats has turned by whole turns
    return whole if abs(turned - whole) < CAME_BACK else turned


def _travel_rows(linkage: Linkage, travel: OutputTravel, place: Dimension) -> Iterable[ValueRow]:
    """Yield the table rows for the travel of an output over the requested positions."""
    link, run = travel.link, coordinate_dimension(travel.kind)
    point, guide = linkage.output_point(link), linkage.output_guide(link)
    name, extremes = (
        _("swing angle ψ of link {link} over the requested positions"),
        _("extreme position of link {link}"),
    )
    if point is not None:
        name, extremes = _("travel of {link} over the requested positions"), _("extreme position of {link}")
    elif guide is not None and FRAME not in (guide.carrier, guide.runner):
        name = _("stroke H of link {link} along link {carrier} over the requested positions")
    elif guide is not None:
        name = _("stroke H of link {link} over the requested positions")
    carrier = guide.carrier if guide is not None else ""
    yield name.format(link=link, carrier=carrier), travel.high - travel.low, run
    for extreme, at in ((travel.low, travel.low_at), (travel.high, travel.high_at)):
        yield extremes.format(link=link), extreme, run
        yield _("driver position at this extreme position"), at, place


def value_columns(rows: Sequence[ValueRow], results: Results) -> tuple[Column, ...]:
    """Return the columns item, value and unit of a table whose rows have different units."""
    units = results.problem.units
    return (
        Column(N_("item"), [name for name, __, __ in rows]),
        Column(N_("value"), [units.from_si(float(value), dim) for __, value, dim in rows], NUMBER),
        Column(N_("unit"), [units.spelt(dim) for __, __, dim in rows]),
    )


# Pressure and transmission angles of every group over the driver's way, with what is allowed.


def pressure_tables(results: Results) -> Iterable[Table]:
    """Yield the table of pressure and transmission angles, with a row for each driven link."""
    angles = results.pressure
    if not angles:
        return
    driver, driver_range = results.linkage.driver, results.driver_range
    coordinates = [p.place if p.largest > NO_PRESSURE else math.nan for p in angles]
    other_coordinates = [p.other_place for p in angles]
    if driver.kind == "turn" and driver_range is not None and driver_range.full:
        coordinates = [place % (2 * math.pi * driver_range.turns) for place in coordinates]
        other_coordinates = [place % (2 * math.pi * driver_range.turns) for place in other_coordinates]
    note = (
        _("The allowed pressure angles are those given in the file.")
        if any(results.problem.limits_set)
        else _(
            "Allowed pressure angles, unless the file gives others: 30 deg for a sliding link, 45 deg for a "
            "rotating one."
        )
    )
    yield Table(
        "pressure",
        _("Pressure angles"),
        (
            Column(N_("group"), [p.group for p in angles]),
            Column(N_("driven link"), [p.link for p in angles]),
            Column(N_("motion of the link"), [_("slides") if p.slides else _("rotates") for p in angles]),
            Column(N_("driven through pair"), [p.pair for p in angles]),
            Column(N_("largest angle"), [p.largest for p in angles], ANGLE),
            Column(N_("driver position at the largest angle"), coordinates, coordinate_dimension(driver.kind)),
            Column(N_("extreme angle on the other side"), [p.other for p in angles], ANGLE),
            Column(
                N_("driver position at the extreme angle on the other side"),
                other_coordinates,
                coordinate_dimension(driver.kind),
            ),
            Column(N_("smallest transmission angle"), [p.transmission for p in angles], ANGLE),
            Column(N_("force amplification factor"), [p.gain for p in angles], NUMBER),
            Column(N_("allowed"), [p.allowed for p in angles], ANGLE),
            Column(N_("assessment"), [_("within the limit") if p.holds else _("above the limit") for p in angles]),
        ),
        notes=(note,),
    )


# Properties that the file shows, beside what it expects.


def properties_tables(results: Results | ChainResults) -> Iterable[Table]:
    """Yield the table of the properties requested in the block `shows`."""
    rows, units = shown_properties(results), results.problem.units
    if not rows:
        return
    columns = [
        Column(N_("property"), [row.name for row in rows]),
        Column(N_("value"), [units.from_si(row.value, row.dimension) for row in rows], NUMBER),
    ]
    if any(row.expected is not None for row in rows):
        expected = [None if r.expected is None else units.from_si(r.expected, r.dimension) for r in rows]
        columns.append(Column(N_("expected"), expected, NUMBER))
    columns.append(Column(N_("unit"), [units.spelt(row.dimension) for row in rows]))
    yield Table("properties", _("Properties"), tuple(columns))


# What is worth a second look: each check with its number, the limit, and where the driver is then.


def checks_tables(results: Results) -> Iterable[Table]:
    """Yield the table of checks, with the actual value, the limit and the assessment of each."""
    rows = [
        (
            *_check_texts(check, results),
            _check_coordinate(check, results),
            _("OK") if check.holds else _("outside the limit"),
        )
        for check in run_checks(results)
    ]
    if rows:
        headers = (_("check"), _("object"), _("actual"), _("limit"), _("driver position"), _("assessment"))
        yield text_table("checks", _("Checks"), headers, rows)


def _check_coordinate(check: Check, results: Results) -> str:
    if check.at is None:
        return ""
    at = check.at if abs(check.at) > SAME_DRIVER_POSITION else 0.0
    units, dimension = results.problem.units, coordinate_dimension(results.linkage.driver.kind)
    place, none = (with_unit(units, each, dimension, 4) for each in (at, 0.0))
    again = with_unit(units, 2 * math.pi * results.turns, dimension, 4) if results.turns else ""
    return none if place == again else place


def _check_texts(check: Check, results: Results) -> tuple[str, str, str, str]:
    """Return the cells of a check: its name, the object checked, the actual value and the limit."""
    units = results.problem.units
    match check.kind:
        case "slot":
            slide = results.linkage.slide(check.of)
            slot = _("link {runner} in slot {slot} of link {carrier}").format(
                runner=slide.runner, slot="".join(slide.ends or ()), carrier=slide.carrier
            )
            actual = _("{far} before {point}") if check.holds else _("{far} beyond {point}")
            far = with_unit(units, abs(check.value), LENGTH, 4)
            return (
                _("position of the sliding block in its slot"),
                slot,
                actual.format(far=far, point=check.detail),
                _("ends of the slot"),
            )
        case "pressure":
            link = _("link {link} of {group}").format(link=check.of, group=check.detail)
            most = _("at most {angle}").format(angle=with_unit(units, check.limit, ANGLE, 4))
            return _("pressure angle"), link, with_unit(units, check.value, ANGLE, 4), most
        case "load":
            actual = _("acts only with the motion or only against it")
            if not check.holds:
                actual = (
                    _("drives in the working stroke ({work} J), resists in the return stroke")
                    if check.detail == "working"
                    else _("resists in the working stroke, drives in the return stroke ({work} J)")
                ).format(work=numeral(check.value, ".6g"))
            required = _(
                "the load must oppose the motion in both strokes; if it acts in one stroke only, write `when: "
                "working stroke`"
            )
            return _("load without `when`"), _("load {load}").format(load=check.of), actual, required
        case "near dead":
            limit = _("at least {margin}").format(margin=numeral(check.limit, ".6g"))
            actual = numeral(check.value if check.value > 1e-12 else 0.0, ".3g")
            return _("margin to dead positions and change points"), check.of, actual, limit
        case "lever":
            limit = _("at most {share} %").format(share=numeral(100 * check.limit, ".6g"))
            value = 100 * check.value
            return (
                _("Zhukovsky lever and force plan"),
                "",
                f"{numeral(0.0 if check.at is None else value, '.3g')} %",
                limit,
            )


# All real assemblies of each group at a place of the driver; a table a group, a row an assembly.


def assemblies_tables(results: Results) -> Iterable[Table]:
    """Yield a table of the real assemblies of each Assur group in each requested position.

    The groups follow in the order in which they are solved.
    """
    for stem, assemblies, group in name_assembly_files(results.assemblies or ()):
        yield _assembly_table(stem, assemblies, group, results)


def describe_position(problem: Problem, q: float, number: int | None) -> str:
    """Return the number of a position and its driver coordinate as text.

    Args:
        problem: problem that contains the position.
        q: driver coordinate (rad or m).
        number: number of the position; None for the position that the sketch shows.
    """
    crank = problem.linkage.driver.kind == "turn"
    measure = coordinate_dimension(problem.linkage.driver.kind)
    value = problem.units.from_si(q % math.tau if crank else q, measure)
    at = f"{numeral(round(value, 9) + 0.0, '.6g')} {problem.units.spelt(measure)}"
    if number is None:
        text = (
            _("position of the sketch, crank at {place}") if crank else _("position of the sketch, driver at {place}")
        )
        return text.format(place=at)
    text = _("position {number}, crank at {place}") if crank else _("position {number}, driver at {place}")
    return text.format(number=number, place=at)


def assembly_notes(group: GroupAssemblies) -> Iterable[str]:
    """Yield notes on whether the list of assemblies is proved complete, and on special cases."""
    number = len(group.assemblies)
    if group.moves:
        yield _("The group is movable in this position: it has infinitely many assemblies, of which one is shown.")
    elif group.method == "polynomial":
        yield _("The list is complete: the assemblies are the real roots of a polynomial of degree {most}.").format(
            most=group.most
        )
    elif group.method == "closed form" and group.most == 2:
        yield _("The list is complete: a group of class II is solved in closed form.")
    elif group.method in ("closed form", "angles"):
        yield _("The list is complete: the equations of the group have a single solution.")
    else:
        yield _(
            "The assemblies were found by Newton's method from many initial guesses; it is not proved that the "
            "list is complete."
        )
    if number == 0 and group.complete:
        yield _("The group cannot be assembled in this position of the driver.")
    if group.dead and not group.moves:
        yield _("If the margin is 0, the group is in a dead position: two assemblies coincide.")


def _assembly_table(stem: str, position: Assemblies, group: GroupAssemblies, results: Results) -> Table:
    assemblies = group.assemblies
    names = list(assemblies[0].points) if assemblies else []
    columns = [
        Column(N_("group"), [group.group.title] * len(assemblies)),
        Column(N_("assembly"), [str(k + 1) for k in range(len(assemblies))]),
        Column(N_("source of the assembly"), [_("sketch") if a.of_sketch else "" for a in assemblies]),
        Column(N_("margin"), [a.margin for a in assemblies], NUMBER, digits=3),
        *(
            Column(Phrase("angle of link {link}", link=n), [a.angles[n] for a in assemblies], ANGLE)
            for n in group.group.links
        ),
    ]
    for name in names:
        columns.append(Column(Phrase("{point} x", point=name), [a.points[name].real for a in assemblies], LENGTH))
        columns.append(Column(Phrase("{point} y", point=name), [a.points[name].imag for a in assemblies], LENGTH))
    title = _("Real assemblies of {group}, {place}: {count}").format(
        group=group.group.title,
        count=len(assemblies),
        place=describe_position(results.problem, position.q, position.number),
    )
    return Table(stem, title, tuple(columns), notes=tuple(assembly_notes(group)))
