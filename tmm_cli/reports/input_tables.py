"""Tables of the input data of a file: points, pairs, drivers, gears, cams, load elements, friction, law of motion."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.dynamics import DriveProfile, KlossMotor, LinearMotor, MotorCharacteristic, RunTask, SteadyTask
from tmm_cli.mechanics.linkage import FRAME, Driver, Mesh, SpeedTable
from tmm_cli.mechanics.numerics import to_float
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    DENSITY,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    SPEED,
    Dimension,
    coordinate_dimension,
)
from tmm_cli.problem import Problem
from tmm_cli.reports.elements.view import element_view
from tmm_cli.reports.file_summary import describe_interpolation
from tmm_cli.reports.input_load_tables import FILE_WORDS, load_tables, mass_table
from tmm_cli.reports.synthesis_tables import parameter_table
from tmm_cli.reports.table import Table, format_value, format_vector, link_name, text_table

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import WheelTask


def input_data_tables(problem: Problem) -> Iterable[Table]:
    """Yield tables of everything that the problem file specifies."""
    if problem.synthesis is not None and problem.synthesis.names:
        yield parameter_table(problem.synthesis, problem.units)
    yield _point_table(problem)
    if problem.linkage.slides:
        yield _prismatic_pair_table(problem)
    yield text_table("facts", _("Driver, positions and limits"), (_("quantity"), _("value")), _fact_rows(problem))
    if problem.linkage.driver.law is not None:
        yield speed_table(problem, problem.linkage.driver.law)
    yield from component_tables(problem)
    if any(np.any(link.mass != 0) for link in problem.linkage.links.values()):
        yield mass_table(problem)
    if problem.linkage.loads:
        yield from load_tables(problem)
    if problem.dynamics is not None:
        yield from law_of_motion_tables(problem, problem.dynamics)


def _point_table(problem: Problem) -> Table:
    rows = [
        (link_name(name), point, format_vector(problem, local))
        for name, link in problem.linkage.links.items()
        for point, local in link.points.items()
    ]
    note = _(
        "Lengths are in {unit}. A point that belongs to two links is a hinge; a point that belongs to "
        "three or more links is a compound hinge."
    )
    return text_table(
        "points",
        _("Coordinates of the points in the coordinate axes of their links"),
        (_("link"), _("point"), _("coordinates")),
        rows,
        (note.format(unit=problem.units.spelt(LENGTH)),),
    )


def _prismatic_pair_table(problem: Problem) -> Table:
    return text_table(
        "slides",
        _("Prismatic pairs"),
        (
            _("pair"),
            _("link"),
            _("point"),
            _("slides on link"),
            _("point of the guide"),
            _("angle of the guide"),
            _("angle of the link relative to the link with the guide"),
        ),
        [
            (
                s.name,
                s.runner,
                s.point,
                link_name(s.carrier),
                format_vector(problem, s.through),
                format_value(problem, s.direction, ANGLE),
                format_value(problem, s.turned, ANGLE),
            )
            for s in problem.linkage.slides
        ],
    )


def _fact_rows(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage, units = problem.linkage, problem.units
    driver, measure = linkage.driver, coordinate_dimension(linkage.driver.kind)
    dimensions = (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA)
    yield _("units of numbers given without a unit"), ", ".join(units.spelt(dimension) for dimension in dimensions)
    yield _("unit of speeds given without a unit"), units.spelt(ANGULAR_SPEED if driver.kind == "turn" else SPEED)
    if driver.kind == "slide":
        text = _("link {link}, {speed}")
    elif driver.sense > 0:
        text = _("link {link}, {speed}, counterclockwise")
    else:
        text = _("link {link}, {speed}, clockwise")
    yield _("driver"), text.format(link=driver.link, speed=driver_speed(driver))
    yield _("gravitational acceleration"), f"[{linkage.gravity.real:.6g}, {linkage.gravity.imag:.6g}] {spelt('m/s^2')}"
    if linkage.turns > 1:
        yield _("period of the loads"), _("turns of the crank: {turns}").format(turns=linkage.turns)
    for wheel in problem.wheels:
        yield _("wheel {name}").format(name=wheel.name), _wheel_text(wheel)
    yield _("positions"), _positions_text(problem, measure)
    sketch = linkage.sketch
    sketch_texts = [format_value(problem, sketch.at, measure)]
    sketch_texts += [f"{name} {format_vector(problem, place)}" for name, place in sketch.points.items()]
    sketch_texts += [f"{name} {format_value(problem, angle, ANGLE)}" for name, angle in sketch.angles.items()]
    yield _("driver coordinate and points of the sketch"), ", ".join(sketch_texts)
    yield from ((_("law of motion") if not row else "", line) for row, line in enumerate(_law_of_motion_lines(problem)))
    yield _("limit of the check by the Zhukovsky lever"), f"{numeral(100 * problem.lever_limit, '.6g')} %"


def _wheel_text(wheel: WheelTask) -> str:
    """Describe which link moves an intermittent wheel, in which strokes, and with which settings."""
    words = {
        "forward": _("moves with link {link} while the link rotates counterclockwise; otherwise at rest"),
        "backward": _("moves with link {link} while the link rotates clockwise; otherwise at rest"),
        "working stroke": _("moves with link {link} in the working stroke; otherwise at rest"),
        "idle stroke": _("moves with link {link} in the return stroke; otherwise at rest"),
    }
    texts = [words[wheel.when].format(link=wheel.link)]
    if len(wheel.settings) > 1:
        settings = [", ".join(f"{name} = {value}" for name, value in s.values.items()) for s in wheel.settings]
        text = _("settings alternate, one for each cycle of the driver: {settings}")
        texts.append(text.format(settings="; ".join(setting or _("as in the file") for setting in settings)))
    return "; ".join(texts)


def _law_of_motion_lines(problem: Problem) -> Iterable[str]:
    """Yield sentences on how the law of motion is determined."""
    task = problem.dynamics
    if task is None:
        yield _("given; it is computed only if the file has a `dynamics` block")
        return
    if not task.cyclic:
        yield _("single run, computed by integration over time")
        return
    yield _("steady motion, computed from the reduced moment of inertia and the reduced moment over the cycle")
    if task.motor is not None:
        yield _("driving moment from the motor characteristic")
    else:
        speed = format_value(problem, task.mean, ANGULAR_SPEED)
        yield _("constant driving moment, for which the total work over the cycle is zero; mean speed {speed}").format(
            speed=speed
        )
    if task.flywheel:
        inertia = format_value(problem, task.flywheel, INERTIA)
        yield _("flywheel {inertia}, reduced to the driver").format(inertia=inertia)
    if task.delta is not None:
        yield _("a flywheel is designed for delta = {delta}").format(delta=numeral(task.delta, ".4g"))
    yield _("forces are computed with the speeds and accelerations of this law")


def _positions_text(problem: Problem, measure: Dimension) -> str:
    request, driver = problem.request, problem.linkage.driver
    if request.places:
        return ", ".join(format_value(problem, q, measure) for q in request.places[:12])
    if driver.stroke is not None:
        a, b = (format_value(problem, q, measure) for q in driver.stroke)
        return _("{count} positions from {a} to {b}").format(count=request.count, a=a, b=b)
    if driver.kind == "slide":
        return _("{count} positions over the whole travel").format(count=request.count)
    start = (
        _(FILE_WORDS[request.start])
        if isinstance(request.start, str)
        else format_value(problem, request.start, measure)
    )
    return _("{count} positions; first position: {start}").format(count=request.count, start=start)


# Drivers, wheels, cams, load elements and friction of a file, as tables of words.


def driver_speed(driver: Driver) -> str:
    """Return the speed of a driver as text, with its acceleration if it has one."""
    if driver.law is not None:
        return _("given by a table, argument: crank angle")
    turns = driver.kind == "turn"
    text = f"{numeral(driver.rate, '.6g')} {spelt('rad/s' if turns else 'm/s')}"
    if driver.acceleration:
        text += f", {numeral(driver.acceleration, '.6g')} {spelt('rad/s^2' if turns else 'm/s^2')}"
    return text


def speed_table(problem: Problem, law: SpeedTable) -> Table:
    """Return the table of speeds of the driver, with accelerations given in the file or computed from the speeds."""
    squares = law.squares
    angles = np.array([float(to_float(row)) for row in squares.arguments])
    after = squares.slope(angles) / 2 * problem.linkage.driver.sense
    gains = after if law.accelerations is None else law.accelerations(angles)
    speeds = np.sqrt(squares(angles))
    rows = [
        (
            format_value(problem, at, ANGLE),
            format_value(problem, speed, ANGULAR_SPEED),
            format_value(problem, gain, ANGULAR_ACCELERATION),
        )
        for at, speed, gain in zip(angles, speeds, gains, strict=True)
    ]
    head = (_("crank angle"), _("speed"), _("acceleration"))
    note = _("Between rows: {between}.").format(between=describe_interpolation(law))
    return text_table("speeds", _("Speed of the driver, positive in its direction of motion"), head, rows, (note,))


def component_tables(problem: Problem) -> Iterable[Table]:
    """Yield tables of the drivers, gears and racks, cams, load elements and friction that the file contains."""
    linkage = problem.linkage
    if linkage.others or linkage.driver.base != FRAME:
        yield text_table(
            "drivers",
            _("Drivers; the sketch shows all of them at the same moment"),
            (
                _("link"),
                _("link relative to which the motion is given"),
                _("driving pair"),
                _("motion"),
                _("speed"),
                _("direction"),
                _("coordinate in the sketch"),
            ),
            [_driver_row(problem, driver) for driver in linkage.drivers],
        )
    wheels = [_gear_row(problem, mesh) for mesh in linkage.meshes if mesh.kind != "cam"]
    if wheels:
        note, title = _("Angles of the gears are measured relative to the link on which they are mounted."), _("Gears")
        if any(mesh.kind == "rack" for mesh in linkage.meshes):
            title = _("Gears and racks")
            note = _(
                "Angles of the gears are measured relative to the link on which they are mounted; the displacement "
                "of a rack is given in {unit} per radian of the gear."
            )
        yield text_table(
            "meshes",
            title,
            (
                _("pair"),
                _("kind"),
                _("links"),
                _("mounted on link"),
                _("law of motion"),
                _("pitch radii"),
                _("pressure angle"),
            ),
            wheels,
            (note.format(unit=problem.units.spelt(LENGTH)),),
        )
    cams = [row for mesh in linkage.meshes if mesh.kind == "cam" for row in _cam_rows(problem, mesh)]
    if cams:
        note = _(
            "A translating follower is treated as flat-faced: the force on it acts along the guide, at the "
            "distance ds/da from the cam axis, where a is the cam angle. An oscillating follower is loaded by "
            "a couple."
        )
        yield text_table(
            "cams",
            _("Cams and the laws of motion of their followers"),
            (
                _("pair"),
                _("cam"),
                _("follower"),
                _("segment"),
                _("cam angle at the beginning"),
                _("cam angle at the end"),
                _("rise"),
                _("law of motion"),
                _("follower position at the end of the segment"),
            ),
            cams,
            (note,),
        )
    for block, elements in linkage.elements_by_block.items():
        yield element_view(block).table(problem, elements)
    if linkage.friction:
        slides = {slide.name for slide in linkage.slides}
        yield text_table(
            "friction",
            _("Friction"),
            (_("pair"), _("coefficient"), _("journal radius")),
            [
                (
                    f.pair,
                    numeral(f.coefficient, ".6g"),
                    _("none (prismatic pair)") if f.pair in slides else format_value(problem, f.radius, LENGTH),
                )
                for f in linkage.friction
            ],
        )


def _driver_row(problem: Problem, driver: Driver) -> tuple[str, ...]:
    senses = {"turn": (_("clockwise"), _("counterclockwise")), "slide": (_("retracting"), _("extending"))}
    at = problem.linkage.sketch.at if driver is problem.linkage.driver else driver.at
    return (
        driver.link,
        link_name(driver.base),
        driver.joint,
        _("rotates") if driver.kind == "turn" else _("slides"),
        driver_speed(driver),
        senses[driver.kind][driver.sense > 0],
        format_value(problem, at, coordinate_dimension(driver.kind)),
    )


def _gear_row(problem: Problem, mesh: Mesh) -> tuple[str, ...]:
    """Return the table row of two gears in mesh, or of a gear and a rack, with the equation that relates their
    motions.
    """
    linkage = problem.linkage
    if mesh.kind == "rack":
        kind = _("gear and rack")
        step = problem.units.from_si(mesh.ratio, LENGTH)
        law, offset = f"s_{mesh.j} = {numeral(step, '.6g')} phi_{mesh.i}", format_value(problem, mesh.offset, LENGTH)
        radii = format_value(problem, abs(mesh.ratio), LENGTH)
    else:
        kind = _("internal gearing") if mesh.ratio > 0 else _("external gearing")
        law, offset = (
            f"phi_{mesh.j} = {numeral(mesh.ratio, '.6g')} phi_{mesh.i}",
            format_value(problem, mesh.offset, ANGLE),
        )
        points = [linkage.shared(mesh.carrier, link) for link in (mesh.i, mesh.j)]
        a, b = (complex(np.ravel(linkage.local(mesh.carrier, p))[0]) for p in points if p is not None)
        pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
        radii = ", ".join(format_value(problem, abs(pitch - axis), LENGTH) for axis in (a, b))
    if mesh.offset:
        law += f" + {offset}"
    return (
        mesh.name,
        kind,
        f"{link_name(mesh.i)}, {link_name(mesh.j)}",
        link_name(mesh.carrier),
        law,
        radii,
        format_value(problem, mesh.pressure, ANGLE),
    )


def _cam_rows(problem: Problem, mesh: Mesh) -> Iterable[tuple[str, ...]]:
    """Yield a table row for each segment of the law of motion of a cam."""
    assert mesh.law is not None
    measure = LENGTH if mesh.slide else ANGLE
    at, run = mesh.law.start, mesh.offset
    for number, piece in enumerate(mesh.law.pieces):
        name = (mesh.name, mesh.i, mesh.j) if number == 0 else ("", "", "")
        end, run = at + piece.over, run + piece.rise
        law = piece.shape if piece.rise else _("dwell")
        yield (
            *name,
            str(number + 1),
            format_value(problem, at, ANGLE),
            format_value(problem, end, ANGLE),
            format_value(problem, piece.rise, measure),
            law,
            format_value(problem, run, measure),
        )
        at = end


# Law of motion of a file: motor, flywheel, driving moment of a single run.


Fact = tuple[str, str]


def law_of_motion_tables(problem: Problem, task: SteadyTask | RunTask) -> Iterable[Table]:
    """Yield the table of motor and flywheel, then the table of the driving moment of a single run, if the file gives
    one.
    """
    rows = [*(_steady_rows(problem, task) if task.cyclic else _run_rows(problem, task))]
    title, note = (
        _("Input data for the law of motion"),
        _("Moments, moments of inertia and speeds are reduced to the driver."),
    )
    yield text_table("machine", title, (_("quantity"), _("value")), rows, (note,))
    drive = None if task.cyclic else _drive_profile(task)
    if drive is not None and len(drive.arguments) > 1:
        yield _drive_table(problem, drive)


def _steady_rows(problem: Problem, task: SteadyTask) -> Iterable[Fact]:
    if task.motor is None:
        yield _("mean speed"), format_value(problem, task.mean, ANGULAR_SPEED)
    else:
        yield from _motor_rows(problem, task.motor, turns=True)
    if task.delta is not None:
        yield _("required coefficient of fluctuation delta"), numeral(task.delta, ".4g")
    if task.flywheel:
        yield _("specified flywheel"), format_value(problem, task.flywheel, INERTIA)
    if task.ratio != 1:
        yield _("ratio of the speed of the flywheel shaft to that of the driver"), numeral(task.ratio, ".6g")
    flywheel = task.size
    fields = {"density": format_value(problem, flywheel.density, DENSITY), "width": numeral(flywheel.width, ".4g")}
    text = _("disk: density {density}, width {width} times the diameter")
    if flywheel.shape == "rim":
        text = _("rim: density {density}, width {width} and height {height} times the mean diameter")
    if task.flywheel or task.delta is not None:
        yield _("shape of the flywheel"), text.format(**fields, height=numeral(flywheel.height, ".4g"))


def _run_rows(problem: Problem, task: RunTask) -> Iterable[Fact]:
    turns = problem.linkage.driver.kind == "turn"
    yield _("initial speed"), format_value(problem, task.speed, ANGULAR_SPEED if turns else SPEED)
    if task.motor is not None:
        yield from _motor_rows(problem, task.motor, turns=turns)
    drive = _drive_profile(task)
    if drive is not None and len(drive.arguments) == 1:
        yield _("driving moment or force"), format_value(problem, drive.values[0], MOMENT if turns else FORCE)
    if task.brake:
        yield _("braking moment or force"), format_value(problem, task.brake, MOMENT if turns else FORCE)
    if task.flywheel:
        yield _("specified flywheel"), format_value(problem, task.flywheel, INERTIA if turns else MASS)


def _drive_profile(task: RunTask) -> DriveProfile | None:
    return task.drive if isinstance(task.drive, DriveProfile) else None


def _motor_rows(problem: Problem, motor: MotorCharacteristic, *, turns: bool) -> Iterable[Fact]:
    """Yield the names and values of those parameters of a motor that occur in the formulas of the note."""
    speed, torque = (ANGULAR_SPEED, MOMENT) if turns else (SPEED, FORCE)
    match motor:
        case KlossMotor():
            yield _("motor"), _("asynchronous motor, by Kloss's formula")
            yield _("synchronous speed"), format_value(problem, motor.synchronous, speed)
            yield _("breakdown torque"), format_value(problem, motor.breakdown, torque)
            yield _("slip at breakdown torque"), numeral(motor.slip, ".4g")
        case LinearMotor():
            yield _("motor"), _("motor with a linear characteristic")
            yield _("stall torque or force"), format_value(problem, motor.stall, torque)
            yield _("no-load speed"), format_value(problem, motor.free, speed)


def _drive_table(problem: Problem, drive: DriveProfile) -> Table:
    """Return the table of the driving moment or force of a single run."""
    turns = problem.linkage.driver.kind == "turn"
    place, force = (ANGLE, MOMENT) if turns else (LENGTH, FORCE)
    head, measure = (_("time, s"), NUMBER) if drive.against == "time" else (_("travel of the driver"), place)
    rows = [
        (format_value(problem, at, measure), format_value(problem, value, force))
        for at, value in zip(drive.arguments, drive.values, strict=True)
    ]
    return text_table("drive", _("Driving moment or force of the single run"), (head, _("magnitude")), rows)
