"""What a file gives for its law of motion: motor, flywheel, what drives a single run; as tables of words."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _, numeral
from tmm_cli.mechanics.dynamics import Kloss, Linear, Motor, Profile, RunTask, SteadyTask
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    DENSITY,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    SPEED,
)
from tmm_cli.problem import Problem
from tmm_cli.reports.given_parts import show
from tmm_cli.reports.table import Table, table_of_words

Fact = tuple[str, str]


def law_of_motion(problem: Problem, task: SteadyTask | RunTask) -> Iterable[Table]:
    """Motor and flywheel, and the rows of what drives."""
    rows = [*(_steady(problem, task) if task.cyclic else _run(problem, task))]
    title, note = _("Data of the law of motion"), _("Moments, inertia and speeds are reduced to the driver.")
    yield table_of_words("machine", title, (_("what"), _("value")), rows, (note,))
    drive = None if task.cyclic else _profile(task)
    if drive is not None and len(drive.arguments) > 1:
        yield _rows(problem, drive)


def _steady(problem: Problem, task: SteadyTask) -> Iterable[Fact]:
    if task.motor is None:
        yield _("mean speed"), show(problem, task.mean, ANGULAR_SPEED)
    else:
        yield from _motor(problem, task.motor, turns=True)
    if task.delta is not None:
        yield _("fluctuation delta that is wanted"), numeral(task.delta, ".4g")
    if task.flywheel:
        yield _("given flywheel"), show(problem, task.flywheel, INERTIA)
    if task.ratio != 1:
        yield _("speed of the flywheel's shaft over that of the driver"), numeral(task.ratio, ".6g")
    size = task.size
    told = {"density": show(problem, size.density, DENSITY), "width": numeral(size.width, ".4g")}
    text = _("disk, {density}, width {width} of its diameter")
    if size.shape == "rim":
        text = _("rim, {density}, width {width} and height {height} of its mean diameter")
    if task.flywheel or task.delta is not None:
        yield _("form of the flywheel"), text.format(**told, height=numeral(size.height, ".4g"))


def _run(problem: Problem, task: RunTask) -> Iterable[Fact]:
    turns = problem.linkage.driver.kind == "turn"
    yield _("speed at the beginning"), show(problem, task.speed, ANGULAR_SPEED if turns else SPEED)
    if task.motor is not None:
        yield from _motor(problem, task.motor, turns=turns)
    drive = _profile(task)
    if drive is not None and len(drive.arguments) == 1:
        yield _("what drives"), show(problem, drive.values[0], MOMENT if turns else FORCE)
    if task.brake:
        yield _("brake"), show(problem, task.brake, MOMENT if turns else FORCE)
    if task.flywheel:
        yield _("given flywheel"), show(problem, task.flywheel, INERTIA if turns else MASS)


def _profile(task: RunTask) -> Profile | None:
    return task.drive if isinstance(task.drive, Profile) else None


def _motor(problem: Problem, motor: Motor, *, turns: bool) -> Iterable[Fact]:
    """By its own numbers, as the note's formulas have them."""
    speed, size = (ANGULAR_SPEED, MOMENT) if turns else (SPEED, FORCE)
    match motor:
        case Kloss():
            yield _("motor"), _("asynchronous, by the formula of Kloss")
            yield _("its synchronous speed"), show(problem, motor.synchronous, speed)
            yield _("its largest moment"), show(problem, motor.breakdown, size)
            yield _("its slip at the largest moment"), numeral(motor.slip, ".4g")
        case Linear():
            yield _("motor"), _("with a linear characteristic")
            yield _("its moment at rest"), show(problem, motor.stall, size)
            yield _("its speed without load"), show(problem, motor.free, speed)


def _rows(problem: Problem, drive: Profile) -> Table:
    """Moments, or forces, that a run is driven with."""
    turns = problem.linkage.driver.kind == "turn"
    place, size = (ANGLE, MOMENT) if turns else (LENGTH, FORCE)
    head, measure = (_("time, s"), NUMBER) if drive.against == "time" else (_("way of the driver"), place)
    rows = [
        (show(problem, at, measure), show(problem, value, size))
        for at, value in zip(drive.arguments, drive.values, strict=True)
    ]
    return table_of_words("drive", _("What drives the run"), (head, _("size")), rows)
