"""Tables of the cycle: driver, outputs and balancing moment; motion of points and links; extremes; instantaneous
centres.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_cli.language import N_, Phrase, _
from tmm_cli.mechanics.analysis import Results, moving_centres, moving_points, select_links as chosen_links
from tmm_cli.mechanics.forces import reduced_driving_moment
from tmm_cli.mechanics.kinematics import InstantCentre, LinkMotion, Motion, output_run
from tmm_cli.mechanics.linkage import Driver, Linkage
from tmm_cli.mechanics.numerics import Real, pi
from tmm_cli.mechanics.quantities import (
    ANGLE,
    FORCE,
    LENGTH,
    LINK,
    MOMENT,
    NUMBER,
    POINT,
    SLIDE,
    Dimension,
    NamedValues,
    coordinate_dimension,
    quantity_columns,
)
from tmm_cli.reports.table import Column, Table

OUTPUT_HEADERS = {
    "run": N_("s of link {link}"),
    "v": N_("v of link {link}"),
    "a": N_("a of link {link}"),
    "angle": N_("angle of link {link}"),
    "omega": N_("omega of link {link}"),
    "epsilon": N_("epsilon of link {link}"),
}
COORDINATE_HEADERS = {
    "run": "{link}",
    "v": N_("v of {link}"),
    "a": N_("a of {link}"),
}


def sign_convention(linkage: Linkage) -> str:
    """Return the sign convention of positions, speeds and moments as a note below a table."""
    if linkage.driver.kind == "slide":
        return _(
            "Displacement, speed and F_b of a driving slider are positive along its guide, whatever its "
            "direction of motion; angles and moments are positive counterclockwise."
        )
    return _(
        "Angles, angular speeds and moments are positive counterclockwise, whatever the direction of "
        "rotation of the driver: a negative M_b acts clockwise."
    )


def driver_columns(results: Results) -> list[Column]:
    """Return the two columns at the left of every table by position: number of the position and driver coordinate."""
    assert results.motion is not None
    name = _("phi") if results.linkage.driver.kind == "turn" else _("driver")
    return [
        Column(N_("position"), [str(n) for n in results.numbers]),
        _driver_column(results, results.linkage.driver, name, results.motion.q),
    ]


def _driver_column(results: Results, driver: Driver, name: str, q: Real) -> Column:
    """Return the column of a driver coordinate. The angle of a crank that rotates fully is reduced to one cycle."""
    full = driver.kind == "turn" and results.driver_range is not None and results.driver_range.full
    return Column(name, np.mod(q, 2 * results.linkage.turns * pi(q)) if full else q, coordinate_dimension(driver.kind))


def cycle_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the cycle: driver coordinates, motion of the outputs and balancing load at each position.

    If some positions have no velocities or forces, a last column gives the reasons.
    """
    motion = results.motion
    assert motion is not None
    columns = driver_columns(results)
    for driver in results.linkage.others:
        name = _("phi of link {link}") if driver.kind == "turn" else _("driver, link {link}")
        columns.append(_driver_column(results, driver, name.format(link=driver.link), motion.drives[driver.link].value))
    for link in results.mechanism.outputs:
        if results.linkage.output_carrier(link) not in motion.poses:  # with --of only some links move
            continue
        columns += [Column(name, values, dimension) for name, values, dimension in output_motion(results, motion, link)]
    columns += _balance_columns(results)
    if not bool(np.all(motion.moving & ~results.locked)):
        columns.append(Column(N_("state"), position_states(results)))
    yield Table("cycle", _("Cycle"), tuple(columns), notes=(sign_convention(results.linkage), *_flywheel_note(results)))


def output_motion(results: Results, motion: Motion, link: str) -> Iterable[tuple[str, Real, Dimension]]:
    """Yield displacement (or angle), speed and acceleration of an output, each as header, values (positions,) and
    dimension.
    """
    run, first, second = output_run(motion, link)
    v = first * motion.rate
    a = second * motion.rate**2 + first * motion.acceleration
    words = OUTPUT_HEADERS if link in results.linkage.links else COORDINATE_HEADERS
    quantities = LINK if results.linkage.output_swings(link) else SLIDE
    for quantity, values in zip(quantities, (run, v, a), strict=False):
        yield Phrase(words[quantity.name], link=link), values, quantity.dimension


def _balance_columns(results: Results) -> Iterable[Column]:
    """Yield columns of the balancing load by the force plan, by the Zhukovsky lever, and the difference between both.

    With several drivers they are preceded by the balancing load of each driver. Both methods then give the sum of the
    balancing loads, reduced to the first driver.
    """
    reactions, lever, motion = results.reactions, results.lever, results.motion
    if reactions is None or lever is None or motion is None:
        return
    difference = Column(N_("difference, %"), lever.difference * 100, NUMBER, digits=2)
    if len(reactions.balances) == 1:
        balance = reactions.balance
        if balance.kind == "moment":
            yield Column(N_("M_b, force plan"), balance.moment, MOMENT)
            yield Column(N_("M_b, Zhukovsky lever"), lever.balancing, MOMENT)
        else:
            yield Column(N_("F_b, force plan"), balance.force, FORCE)
            yield Column(N_("F_b, Zhukovsky lever"), lever.balancing / balance.arm, FORCE)
        yield difference
        return
    for balance in reactions.balances:
        turns, link = balance.moment is not None, balance.driver.link
        name = _("M_b of link {link}") if turns else _("F_b of link {link}")
        yield Column(name.format(link=link), balance.generalized, MOMENT if turns else FORCE)
    first = results.linkage.driver
    dimension = MOMENT if first.kind == "turn" else FORCE
    yield Column(
        Phrase("sum reduced to link {link}, force plan", link=first.link),
        reduced_driving_moment(motion, reactions),
        dimension,
    )
    yield Column(Phrase("sum reduced to link {link}, Zhukovsky lever", link=first.link), lever.balancing, dimension)
    yield difference


def has_flywheel(results: Results) -> bool:
    """Return True if there is a flywheel, so that the driving moment differs from the balancing moment, and no
    brake.
    """
    if results.single is not None:
        return bool(results.single.task.flywheel) and not results.single.task.brake
    return results.steady is not None and bool(results.steady.steady.law.flywheel)


def _flywheel_note(results: Results) -> Iterable[str]:
    """Yield a note on the driving moment of a machine with a flywheel, which differs from the balancing moment."""
    if results.reactions is None or not has_flywheel(results):
        return
    if results.linkage.driver.kind == "turn":
        yield _(
            "M_b is the moment that drives the links without the flywheel; the driving moment of the machine "
            "is M_d = M_b + J_f epsilon."
        )
    else:
        yield _(
            "F_b is the force that drives the links without the flywheel; the driving force of the machine is "
            "F_d = F_b + m_f a."
        )


def position_states(results: Results) -> list[str]:
    """Return the state of each position as text; empty for an ordinary position.

    The text says why a position has no velocities or forces, or that at a change point they are limit values.
    """
    motion = results.motion
    assert motion is not None
    limits = np.zeros(np.shape(motion.q), dtype=bool) if motion.limits is None else motion.limits
    states = np.where(motion.moving, "", _("not reached: the driver has stopped")).astype(object)
    states[results.locked & motion.moving] = _("self-locking by friction")
    states[limits] = _("change point: limit values")
    for text, groups in (
        (_("group {group} is in a dead position"), motion.dead),
        (_("group {group} cannot be assembled"), motion.missing),
    ):
        for group, lost in reversed(list(groups.items())):
            states[lost & (~motion.moving | results.locked) & ~limits] = text.format(group=group)
    return list(states)


# Long tables: several things at every position, a row for each.


def long_table(
    results: Results,
    name: str,
    title: str,
    labels: Mapping[Phrase, Sequence[str]],
    quantities: Sequence[Sequence[NamedValues]],
    note: str = "",
) -> Table:
    """Return a table with a row for each position and each object (point, link, pair).

    Args:
        results: results with a motion.
        name: name of the table.
        title: title of the table.
        labels: columns that identify the objects: by heading, the text for each object.
        quantities: numerical columns of each object, from `quantity_columns`; all objects have the same headings.
        note: note below the table.
    """
    count, number = len(results.numbers), len(quantities)
    head = [Column(c.header, _repeat_values(c.values, number), c.dimension) for c in driver_columns(results)]
    columns = [*head, *(Column(header, list(texts) * count) for header, texts in labels.items())]
    for same in zip(*quantities, strict=True):
        parts = [np.nan if values is None else values for __, values, __ in same]
        stacked = np.stack([p if np.shape(p) == (count,) else np.broadcast_to(p, (count,)) for p in parts], axis=1)
        header, __, dimension = same[0]
        columns.append(Column(header, stacked.ravel(), dimension))
    return Table(name, title, tuple(columns), long=True, notes=(note,) if note else ())


def _repeat_values(values: Any, number: int) -> Any:
    """Repeat each value `number` times. A list stays a list, so that texts and integers keep their type."""
    return [v for v in values for _ in range(number)] if isinstance(values, list) else np.repeat(values, number)


# Motion of named points, centres of mass, links and sliding pairs, with transfer functions; a row a position.


def kinematics_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of the motion of points and centres of mass, of links, and of prismatic pairs."""
    motion = results.motion
    assert motion is not None
    linkage, requested = results.linkage, results.of
    points = dict(sorted(moving_points(linkage, motion, requested).items()))
    points |= moving_centres(linkage, motion, requested)
    if requested:
        points = {name: points[name] for name in requested if name in points}
    if points:
        values = [quantity_columns(POINT, point) for point in points.values()]
        yield long_table(results, "points", _("Points and centres of mass"), {N_("point"): list(points)}, values)
    links = chosen_links(linkage, requested)
    if links:
        values = [quantity_columns(LINK, _angle_within_half_turn(motion.link(name))) for name in links]
        table = long_table(
            results, "link-motion", _("Motion of links"), {N_("link"): links}, values, sign_convention(linkage)
        )
        yield _with_rpm(table) if any(mesh.kind != "cam" for mesh in linkage.meshes) else table
    slides = () if requested else linkage.slides
    if slides:
        values = [quantity_columns(SLIDE, motion.slide(slide)) for slide in slides]
        title = _("Prismatic pairs: motion of the slider along the guide")
        yield long_table(results, "slides", title, {N_("pair"): [slide.name for slide in slides]}, values)


def _with_rpm(table: Table) -> Table:
    """Insert a column of angular speeds in rpm after the column in rad/s, because rpm is the usual unit for gears."""
    k = next(k for k, column in enumerate(table.columns) if column.header == "omega")
    turns = replace(table.columns[k], header=_("n"), unit="rpm")
    return replace(table, columns=(*table.columns[: k + 1], turns, *table.columns[k + 1 :]))


def _angle_within_half_turn(turning: LinkMotion) -> LinkMotion:
    """Return the motion of a link with its angle reduced to the range -180 to 180 deg."""
    half = pi(turning.angle)
    turns = np.ceil((turning.angle - half) / (2 * half))
    return replace(turning, angle=turning.angle - 2 * half * turns)


# Extreme places of points, links and stones; largest and smallest forces.


SEAM_OF_TURN = 1e-6  # rad: just before the end of a turn is its beginning


def extremes_tables(results: Results) -> Iterable[Table]:
    """Yield the table of the least and largest value of each quantity over the cycle.

    The angle of a link that rotates fully has no extremes and is omitted.
    """
    extremes = results.extremes
    if not extremes:
        return
    driver, units = results.linkage.driver, results.problem.units
    place, full = coordinate_dimension(driver.kind), results.turns > 0
    words = {
        "x": _("x of point {name}"),
        "y": _("y of point {name}"),
        "angle": _("angle of link {name}"),
        "s": _("s in pair {name}"),
        "R": _("R in pair {name}"),
        "M": _("couple in pair {name}"),
        "R pin": _("force of the pin on the link (pin, link): {name}"),
        "M_b": _("M_b of link {name}"),
        "F_b": _("F_b of link {name}"),
    }

    def shown(values: Sequence[float]) -> list[float]:
        return [units.from_si(value, extreme.dimension) for value, extreme in zip(values, extremes or (), strict=True)]

    def places(values: Sequence[float]) -> list[float]:
        turn = 2 * np.pi * max(results.turns, 1)
        return [abs(float(np.mod(q + SEAM_OF_TURN, turn)) - SEAM_OF_TURN) if full else q for q in values]

    low, high = [extreme.low for extreme in extremes], [extreme.high for extreme in extremes]
    columns = (
        Column(N_("item"), [words[extreme.kind].format(name=extreme.name) for extreme in extremes]),
        Column(N_("smallest value"), shown(low), NUMBER),
        Column(N_("driver position at the smallest value"), places([extreme.low_at for extreme in extremes]), place),
        Column(N_("largest value"), shown(high), NUMBER),
        Column(N_("driver position at the largest value"), places([extreme.high_at for extreme in extremes]), place),
        Column(N_("range"), shown([most - least for most, least in zip(high, low, strict=True)]), NUMBER),
        Column(N_("unit"), [units.spelt(extreme.dimension) for extreme in extremes]),
    )
    title = _("Largest and smallest forces") if results.reactions is not None else _("Extreme positions")
    yield Table(
        "extremes",
        title,
        columns,
        notes=(_("The extremes are those of the whole cycle, including values between the computed positions."),),
    )


# Instantaneous centres in the positions in detail, and the mechanical advantage over the cycle.


NO_SPEED = 1e-9  # of the largest ratio of speeds: where an output is so slow it stands


def centre_name(links: tuple[str, str]) -> str:
    """Return the name of the instantaneous centre of two links, e.g. P13 for links 1 and 3."""
    return "P" + ("" if all(len(link) == 1 for link in links) else ",").join(links)


def centres_tables(results: Results) -> Iterable[Table]:
    """Yield the table of instantaneous centres, then the table of the mechanical advantage."""
    numbered_centres = [(k, centre) for k, centres in (results.centres or {}).items() for centre in centres]
    points = [centre.place for __, centre in numbered_centres]
    away = [None if c.direction is None else float(np.angle(c.direction) % np.pi) for __, c in numbered_centres]
    columns = (
        Column(N_("position"), [str(results.numbers[k]) for k, __ in numbered_centres]),
        Column(N_("centre"), [centre_name(centre.links) for __, centre in numbered_centres]),
        Column(N_("x"), [None if p is None else p.real for p in points], LENGTH),
        Column(N_("y"), [None if p is None else p.imag for p in points], LENGTH),
        Column(N_("direction angle if the centre is at infinity"), away, ANGLE),
        Column(N_("located by"), [_centre_method(centre) for __, centre in numbered_centres]),
    )
    note = _("P13 is the point at which links 1 and 3 have equal velocities; 0 is the frame.")
    yield Table("centres", _("Instantaneous centres"), columns, notes=(note,))
    yield from _advantage_table(results)


def _centre_method(centre: InstantCentre) -> str:
    if centre.pair:
        return _("pair {pair}").format(pair=centre.pair)
    if centre.place is None and centre.direction is None:
        return _("the links have no relative motion")
    if not centre.lines:
        return _("velocities")
    lines = [" ".join(map(centre_name, line)) for line in centre.lines]
    return lines[0] if len(lines) == 1 else _("{one} and {other}").format(one=lines[0], other=lines[1])


def _advantage_table(results: Results) -> Iterable[Table]:
    """Yield the table of the mechanical advantage of each output, without weights, inertia and friction."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    columns = []
    for link in results.mechanism.outputs if not linkage.others else ():
        slope = np.abs(output_run(motion, link)[1])
        bounded = slope > NO_SPEED * np.max(slope, where=np.isfinite(slope), initial=0.0)
        gained = np.where(bounded, 1 / np.where(bounded, slope, 1.0), np.nan)
        columns.append(Column(Phrase(N_("link {link}, SI units"), link=link), gained, NUMBER))
    if columns:
        note = _(
            "Load moment or force that an output link can overcome per unit of moment or force on the driver "
            "(N*m or N per N*m or N), without weights, inertia and friction. At the ends of a stroke it grows "
            "without limit."
        )
        table = (*driver_columns(results), *columns)
        yield Table("advantage", _("Mechanical advantage"), table, notes=(note,))
