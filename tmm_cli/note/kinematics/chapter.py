"""Chapter on kinematics: drivers, positions, strokes; plans of the detailed positions; tables of all positions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.drawing.paper import SheetPicture
from tmm_cli.language import _, symbol
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.kinematics import OutputTravel, Strokes
from tmm_cli.mechanics.linkage import FRAME, Driver
from tmm_cli.mechanics.numerics import NO_VECTOR, Real, largest_magnitude, without_rounding
from tmm_cli.mechanics.plans import MovingGuideEquation, SolutionStep, solution_steps
from tmm_cli.note.blocks import (
    Block,
    Equation,
    Figure,
    Heading,
    Line,
    Ref,
    Rows,
    join_inline,
    write_sentence,
    write_table,
)
from tmm_cli.note.expression import ComputedQuantity, Constant, Function, Leaf
from tmm_cli.note.formula_tree import Letter, Number, Words, row
from tmm_cli.note.kinematics.equations import name_sense, point_symbol
from tmm_cli.note.kinematics.on_paper import PositionPlans, unit_of
from tmm_cli.note.kinematics.plans import write_accelerations, write_velocities
from tmm_cli.note.subject import Subject, table_over_positions
from tmm_cli.reports import describe_interpolation, output_motion, position_states

ROUND = 1e-9  # relative deviation from a round number of rpm within which the speed was given in rpm


def write_drivers(subject: Subject) -> Iterable[Block]:
    """Describe the motion of each input link."""
    running = subject.results.running
    for driver in subject.results.linkage.drivers:
        if running is not None:
            yield write_sentence(
                _(
                    "The velocity of input link {link} follows from its law of motion, which is determined below. Only "
                    "velocity ratios are needed for this, and they do not depend on the velocity."
                ),
                link=driver.link,
            )
            continue
        yield from (
            _write_rotating_driver(subject, driver) if driver.kind == "turn" else _write_sliding_driver(subject, driver)
        )


def _write_rotating_driver(subject: Subject, driver: Driver) -> Iterable[Block]:
    subscript = driver.link if driver.base == FRAME else driver.link + driver.base
    omega, n = Symbol("ω", "0" if driver.acceleration else subscript), driver.rate * 30 / np.pi
    rpm = abs(n - float(f"{n:.7g}")) <= ROUND * n
    text = _("Input link {link} rotates about point {point} {sense} with the angular velocity")
    if driver.law is not None:
        text = _(
            "Input link {link} rotates about point {point} {sense}; its angular velocity is given by a table ({how})."
        )
    elif driver.base != FRAME:
        text = _(
            "Input link {link} rotates about point {point} of link {base} {sense} with the relative angular velocity"
        )
    elif rpm:
        text = _("Input link {link} rotates about point {point} {sense} at {n} = {speed} rpm; its angular velocity is")
    how = "" if driver.law is None else describe_interpolation(driver.law)
    yield write_sentence(
        text,
        link=driver.link,
        point=driver.joint,
        base=driver.base,
        sense=name_sense(driver.sense),
        how=how,
        n=Symbol("n", subscript),
        speed=subject.text(n, 6),
    )
    if driver.law is not None:
        return
    if rpm:
        yield ComputedQuantity(
            omega, Constant(float(np.pi), "π") * Leaf(Symbol("n", subscript), n) / 30, driver.rate, unit_of("ω")
        )
    else:
        yield _value_equation(subject, omega, driver.rate)
    if driver.acceleration:
        yield write_sentence(_("This is the value in position 0; the angular acceleration is constant:"))
        yield _value_equation(subject, Symbol("ε", subscript), driver.acceleration)


def _write_sliding_driver(subject: Subject, driver: Driver) -> Iterable[Block]:
    slide = subject.results.linkage.slide(driver.joint)
    subscript = slide.point if driver.base == FRAME else f"{slide.point}{slide.point}{slide.carrier}"
    text = _("Input link {link} slides along its guide on the frame with the velocity")
    if driver.base != FRAME:
        text = _("Input link {link} moves along link {base} (a piston in its cylinder) with the relative velocity")
    yield write_sentence(text, link=driver.link, base=driver.base)
    yield _value_equation(subject, Symbol("v", "0" if driver.acceleration else subscript), driver.rate)
    if driver.acceleration:
        yield write_sentence(_("This is the value in position 0; the acceleration is constant:"))
        yield _value_equation(subject, Symbol("a", subscript), driver.acceleration)


def _value_equation(subject: Subject, name: Symbol, value: float) -> Block:
    return Equation(row(Letter(name), "=", Number(subject.text(value)), Words(f" {unit_of(name.letter)}")))


def write_driver_speed(position: PositionPlans) -> Iterable[Block]:
    """Write the velocity of the first driver in a position. Nothing is written if it is constant."""
    results, motion = position.subject.results, position.motion
    driver, turns = motion.linkage.driver, motion.linkage.driver.kind == "turn"
    if driver.law is not None or results.running is not None:
        yield write_sentence(
            _("By the law of motion, the velocity and the acceleration of the input link in this position are")
        )
        for letter, values in zip("ωε" if turns else "va", (motion.rate, motion.acceleration), strict=True):
            value = float(np.broadcast_to(values, motion.q.shape)[position.k])
            yield _value_equation(position.subject, Symbol(letter, driver.link), value)
        return
    if not driver.acceleration:
        return
    letter, rate, coordinate = ("ω", "ε", "φ") if turns else ("v", "a", "s")
    begins = results.linkage.sketch.at if results.linkage.others else results.start
    displacement = driver.sense * (float(motion.q[position.k]) - begins)
    run, start, now = (
        Leaf(Symbol(f"Δ{coordinate}"), displacement),
        Leaf(Symbol(letter, "0"), driver.rate),
        Symbol(letter, driver.link),
    )
    yield write_sentence(
        _(
            "The input link has moved through {gone} since position 0; its velocity {speed} follows from the "
            "constant acceleration:"
        ),
        gone=run.symbol,
        speed=now,
    )
    root = Function("sqrt", start**2 + 2 * Leaf(Symbol(rate, driver.link), driver.acceleration) * run)
    yield ComputedQuantity(now, root, abs(float(motion.rate[position.k])), unit_of(letter))


def write_positions(subject: Subject) -> Iterable[Block]:
    """Write the number of positions, the plan of positions, and the extreme positions and stroke of the output."""
    results = subject.results
    request, count = results.inputs.request, len(results.asked)
    full = results.driver_range is not None and results.driver_range.full and results.linkage.driver.kind == "turn"
    text = _("The motion is studied in {count} positions of the input link.")
    if request.places:
        text = _("The mechanism is studied in {count} given positions of the input link.")
    elif full and request.start == "working stroke":
        text = _("The cycle is divided into {count} equal parts; position 0 is the beginning of the working stroke.")
    elif full:
        text = _("The cycle is divided into {count} equal parts.")
    if count > 1:
        yield write_sentence(text, count=str(count))
    for drawing in subject.drawings("positions").values():
        if isinstance(drawing, SheetPicture) and drawing.mu is not None:
            text = _("The scale factor of the plan of positions is {mu} = {value} m/mm.")
            yield write_sentence(text, mu=Symbol("μ", "l"), value=subject.text(drawing.mu))
    yield from subject.figures(
        "positions", _("The plan of positions is shown in figure {figure}."), _("Plan of positions of the mechanism")
    )
    for strokes in results.swinging:
        yield from _write_extremes(subject, strokes)
    for travel in results.travels:
        yield from _write_travel(subject, travel)


def _write_extremes(subject: Subject, strokes: Strokes) -> Iterable[Block]:
    """Write the extreme positions of the output, its stroke or swing angle, and the time ratio."""
    angles = ", ".join(f"{subject.text(_degrees(s.start % strokes.cycle))}°" for s in strokes.strokes)
    slides = strokes.kind == "slide"
    range, letter = (strokes.travel, "H") if slides else (float(np.degrees(strokes.travel)), "ψ")
    equation = (Letter(Symbol(letter)), "=", Number(subject.text(range)), Words(" " + _("m") if slides else "°"))
    text = _(
        "The output ({output}) is in its extreme positions at the input angles {phi} = {places}; its swing "
        "angle is {size}."
    )
    if slides:
        text = _(
            "The output ({output}) is in its extreme positions at the input angles {phi} = {places}; its "
            "stroke is {size}."
        )
    yield write_sentence(
        text, output=name_output(subject, strokes.link), phi=Symbol("φ"), places=angles, size=row(*equation)
    )
    if not np.isfinite(strokes.k):
        return
    working = sum(s.length for s in strokes.working)
    idle = sum(s.length for s in strokes.strokes if not s.working)
    text = _(
        "The input link rotates through {working} during the working stroke and through {idle} during the "
        "return stroke; the time ratio {k} (coefficient of change of mean speed) is"
    )
    if len(strokes.strokes) > 2:
        text = _(
            "The input link rotates through {working} during all working strokes of a cycle and through {idle} "
            "during all return strokes; the time ratio {k} (coefficient of change of mean speed) is"
        )
    yield write_sentence(text, k=Symbol("k"), working=Symbol("φ", symbol("w")), idle=Symbol("φ", symbol("i")))
    ratio = Leaf(Symbol("φ", symbol("w")), working, angle=True) / Leaf(Symbol("φ", symbol("i")), idle, angle=True)
    yield ComputedQuantity(Symbol("k"), ratio, strokes.k)


def _write_travel(subject: Subject, travel: OutputTravel) -> Iterable[Block]:
    slides = travel.kind == "slide"
    ends = (travel.low, travel.high)
    low, high = (f"{subject.text(end)} {_('m')}" if slides else f"{subject.text(_degrees(end))}°" for end in ends)
    text = _("In this range the output ({output}) moves from {low} to {high}.")
    yield write_sentence(text, output=name_output(subject, travel.link), low=low, high=high)


def _degrees(angle: float) -> float:
    """Convert an angle from radians to degrees. Rounding errors of a zero are removed."""
    degrees = float(np.degrees(angle))
    return 0.0 if abs(degrees) < NO_VECTOR else degrees


def name_output(subject: Subject, link: str) -> str:
    """Return the output as text: "link 4", or the coordinate of a point."""
    return _("link {link}").format(link=link) if link in subject.results.linkage.links else link


def write_driver_coordinate(position: PositionPlans) -> Block:
    """Write the angle or displacement of the input link in a position."""
    driver, q, number = (
        position.motion.linkage.driver,
        float(position.motion.q[position.k]),
        position.subject.position_number(position.k),
    )
    if driver.kind == "turn":
        text = _("In position {number} the input link is at the angle {phi} = {angle}° to the x axis.")
        angle = position.subject.text(_degrees(q % (2 * np.pi)))
        return write_sentence(text, number=number, phi=Symbol("φ", driver.link), angle=angle)
    text = _("In position {number} the displacement of the input link is {run} = {place} m.")
    return write_sentence(text, number=number, run=Symbol("s", driver.link), place=position.subject.text(q))


BESIDE = 6  # columns of angular velocities and accelerations in one table


Column = tuple[Line, Real]  # heading, and values in all positions in the unit of the heading


def write_tables(subject: Subject) -> Iterable[Block]:
    """Write the tables of all positions and the diagrams of motion and pressure angles."""
    results, motion = subject.results, subject.motion
    for link in results.mechanism.outputs:
        letters = ("φ", "ω", "ε") if results.linkage.output_swings(link) else ("s", "v", "a")
        units = ("°", unit_of("ω"), unit_of("ε")) if letters[0] == "φ" else (_("m"), unit_of("v"), unit_of("a"))
        columns = []
        for letter, per, (__, values, ___) in zip(letters, units, output_motion(results, motion, link), strict=True):
            cleaned = without_rounding(values, largest_magnitude(values))
            columns.append(((Symbol(letter, link), f", {per}"), np.degrees(cleaned) if per == "°" else cleaned))
        caption = _("Motion of the output ({output})").format(output=name_output(subject, link))
        text = _("The motion of the output in all positions is given in table {table}.")
        yield from write_table(text, _position_table(subject, caption, columns, f"output-{link}"))
    yield from _write_rate_tables(subject)
    for stem, drawing in subject.drawings("diagrams").items():
        if stem.startswith("diagrams"):
            yield write_sentence(_("The diagrams of motion are shown in figure {figure}."), figure=Ref(stem))
            yield Figure(_("Diagrams of motion over the cycle"), drawing, stem)
        elif stem.startswith("pressure"):
            yield write_sentence(_("The pressure angles are shown in figure {figure}."), figure=Ref(stem))
            yield Figure(_("Pressure angles over the cycle"), drawing, stem)


def _write_rate_tables(subject: Subject) -> Iterable[Block]:
    """Write the angular velocities and accelerations of links in all positions, in one table if it is not too wide."""
    velocities, accelerations = _rate_columns(subject, "ω", "omega"), _rate_columns(subject, "ε", "epsilon")
    if velocities and accelerations and len(velocities) + len(accelerations) <= BESIDE:
        text = _("The angular velocities and accelerations of the links are given in table {table}.")
        caption = _("Angular velocities and accelerations of the links")
        yield from write_table(text, _position_table(subject, caption, [*velocities, *accelerations], "rates"))
        return
    if velocities:
        rows = _position_table(subject, _("Angular velocities of the links"), velocities, "omega")
        yield from write_table(_("The angular velocities of the links are given in table {table}."), rows)
    if accelerations:
        rows = _position_table(subject, _("Angular accelerations of the links"), accelerations, "epsilon")
        yield from write_table(_("The angular accelerations of the links are given in table {table}."), rows)


def _rate_columns(subject: Subject, letter: str, name: str) -> list[Column]:
    """Return the columns of angular velocities or accelerations of links.

    Links that always rotate together share a column. Links whose value is constant are left out.

    Args:
        subject: results that the note describes.
        letter: letter of the quantity, ω or ε.
        name: name of the quantity in the motion of a link, omega or epsilon.
    """
    motion = subject.motion
    rates = {link: np.asarray(getattr(motion.link(link), name), float) for link in motion.linkage.moving}
    most = max(map(largest_magnitude, rates.values()), default=0.0)
    together: list[tuple[list[str], Real]] = []
    for link, values in rates.items():
        if not largest_magnitude(values) > NO_VECTOR * most:
            continue
        same_links = next(
            (links for links, shared in together if largest_magnitude(values - shared) <= NO_VECTOR * most), None
        )
        if same_links is None:
            together.append(([link], without_rounding(values, most)))
        else:
            same_links.append(link)
    varied = [(links, v) for links, v in together if len(v) == 1 or np.nanmax(v) - np.nanmin(v) > NO_VECTOR * most]
    return [
        ((*join_inline((Symbol(letter, link) for link in links), " = "), f", {unit_of(letter)}"), values)
        for links, values in varied
    ]


def _position_table(subject: Subject, caption: str, columns: Sequence[Column], key: str) -> Rows:
    """Return a table with a row for each position.

    Its first columns are the driver coordinates. If the mechanism cannot be assembled in some position, a last column
    gives the state of the mechanism.
    """
    all_columns, states = (*_driver_columns(subject), *columns), position_states(subject.results)
    texts = [
        (head, [subject.format_result(float(value)) if np.isfinite(value) else "–" for value in values])
        for head, values in all_columns
    ]
    return table_over_positions(
        subject, caption, [*texts, *([((_("state of the mechanism"),), states)] if any(states) else [])], key
    )


def _driver_columns(subject: Subject) -> Iterable[Column]:
    """Yield the columns of the driver coordinates.

    The angle of a crank that makes full turns is printed from 0 to 360°. If a cycle of the loads takes several turns,
    it is printed from 0 to the end of these turns.
    """
    results = subject.results
    several, cycle = bool(results.linkage.others), 2 * np.pi * results.linkage.turns
    for driver in results.linkage.drivers:
        value = np.asarray(subject.motion.drives[driver.link].value, float)
        link = driver.link if several else ""
        if driver.kind == "slide":
            yield ((Symbol("s", link or driver.link), f", {_('m')}"), value)
            continue
        full = results.driver_range is not None and results.driver_range.full
        yield ((Symbol("φ", link), ", °"), np.degrees(np.mod(value, cycle) if full else value))


def write_kinematics(subject: Subject) -> Iterable[Block]:
    """Write the chapter on kinematics. It is empty if the mechanism cannot move."""
    results = subject.results
    if results.motion is None:
        return
    yield Heading(_("Kinematic analysis"))
    yield Heading(_("Input links and positions"), 2)
    yield from write_drivers(subject)
    yield from write_positions(subject)
    steps = solution_steps(results.linkage, results.structure.all_groups)
    for k in subject.detail:
        yield from _write_position(PositionPlans(subject, k, k == subject.detail[0]), steps)
    yield Heading(_("Kinematics of all positions"), 2)
    yield from write_tables(subject)


def _write_position(position: PositionPlans, steps: list[SolutionStep]) -> Iterable[Block]:
    subject, number = position.subject, position.subject.position_number(position.k)
    yield Heading(_("Velocities, position {number}").format(number=number), 2)
    if position.first:
        yield write_sentence(
            _(
                "Velocities are found from velocity plans: first for the input links, then for the groups in the "
                "order of the structural formula. A vector underlined twice is known in magnitude and direction, a "
                "vector underlined once in direction only."
            )
        )
        slid = next((e for step in steps for e in step.equations if isinstance(e, MovingGuideEquation)), None)
        if slid is not None:
            yield write_sentence(
                _(
                    "The symbol of the point of the guide that coincides with the sliding block in this position "
                    "contains the number of the guide's link: {under} of link {link} coincides with {point}. The "
                    "distances from {under} to other points of the link are those in this position."
                ),
                under=point_symbol(slid.base),
                link=slid.slide.carrier,
                point=slid.point.at,
            )
    yield write_driver_coordinate(position)
    yield from write_driver_speed(position)
    yield from subject.figures(
        "velocity",
        _("The velocity plan is shown in figure {figure}."),
        _("Velocity plan, position {number}").format(number=number),
        position.k,
    )
    yield from write_velocities(position, steps)
    yield Heading(_("Accelerations, position {number}").format(number=number), 2)
    if position.first:
        yield write_sentence(
            _(
                "The acceleration of a point relative to another point of its link has a normal component, directed "
                "towards that other point, and a tangential one, perpendicular to the line between them."
            )
        )
        if any(isinstance(e, MovingGuideEquation) for step in steps for e in step.equations):
            yield write_sentence(
                _(
                    "The acceleration of the sliding block relative to the coincident point of the guide has a "
                    "component along the guide and, if the guide rotates, the Coriolis component; its direction is "
                    "that of the relative velocity rotated by 90° in the sense of rotation of the guide."
                )
            )
    yield from subject.figures(
        "acceleration",
        _("The acceleration plan is shown in figure {figure}."),
        _("Acceleration plan, position {number}").format(number=number),
        position.k,
    )
    yield from write_accelerations(position, steps)
