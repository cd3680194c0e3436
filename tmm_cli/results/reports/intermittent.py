"""Intermittent motion: wheels that a link takes along on some strokes, stroke by stroke and over a cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.kinematics.intermittent import MOST_CYCLES, Intermittent, Part
from tmm_cli.language import N_, _
from tmm_cli.quantities import ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, NUMBER, TIME, Dimension, place_dimension
from tmm_cli.results.reports.quality import Row, of_rows
from tmm_cli.results.table import Column, Table


def tables(results: Results) -> Iterable[Table]:
    """Strokes, sums over a cycle, and the course of each wheel close together."""
    wheels = results.wheels
    assert wheels is not None
    place = place_dimension(results.linkage.driver.kind)
    yield _strokes(wheels, place, back=not results.turns)
    rows = [row for wheel in wheels for row in _cycle(wheel, place)]
    notes = [note for wheel in wheels for note in _notes(wheel)]
    yield Table("intermittent-cycle", _("Intermittent motion over a cycle"), of_rows(rows, results), notes=tuple(notes))
    yield _course(wheels, place)


def _strokes(wheels: Iterable[Intermittent], place: Dimension, *, back: bool) -> Table:
    """A row a part of the cycle; back: the driver goes there and back."""
    rows = [(wheel, part, wheel.jumps[k]) for wheel in wheels for k, part in enumerate(wheel.parts)]
    parts = [part for __, part, ___ in rows]
    columns = [
        Column(N_("wheel"), [wheel.task.name for wheel, __, ___ in rows]),
        Column(N_("state"), [_("driven") if part.ride.driven else _("stands") for part in parts]),
    ]
    if any(len(wheel.task.settings) > 1 for wheel in wheels):
        columns.append(Column(N_("setting"), [_setting(wheel, part) for wheel, part, __ in rows]))
    columns += [
        Column(N_("driver from"), [part.ride.start for part in parts], place),
        Column(N_("driver to"), [part.ride.end for part in parts], place),
        Column(N_("way of the driver"), [part.ride.way for part in parts], place),
        Column(N_("t"), [part.time for part in parts], TIME),
        Column(N_("wheel from"), [part.angles[0] for part in parts], ANGLE),
        Column(N_("wheel to"), [part.angles[-1] for part in parts], ANGLE),
        Column(N_("step"), [part.step for part in parts], ANGLE),
        Column(N_("jump of omega at the beginning"), [jump for __, ___, jump in rows], ANGULAR_SPEED),
    ]
    note = _("A wheel's angle is counted from the beginning of the cycle, counterclockwise.")
    if back:
        note = f"{note} {_('The driver is taken to turn back at once, and to be as fast on its way back.')}"
    return Table("intermittent", _("Intermittent motion"), tuple(columns), notes=(note,))


def _setting(wheel: Intermittent, part: Part) -> str:
    """The parameters of the file are told by their number alone."""
    values = wheel.task.settings[part.setting].values
    told = ", ".join(f"{name} = {value}" for name, value in values.items())
    return f"{part.setting + 1}: {told}" if told else str(part.setting + 1)


def _cycle(wheel: Intermittent, place: Dimension) -> Iterable[Row]:
    name = wheel.task.name
    yield _("wheel {name} turns in a cycle by").format(name=name), wheel.turn, ANGLE
    if wheel.cycles is not None:
        yield _("cycles in which it makes whole turns"), wheel.cycles, NUMBER
    yield _("way of the driver in a cycle"), wheel.way, place
    yield _("share of it on which the wheel stands"), wheel.standing, NUMBER
    for words, driven in ((_("time in which it is driven"), True), (_("time in which it stands"), False)):
        if np.isfinite(wheel.time(driven=driven)):
            yield words, wheel.time(driven=driven), TIME
    yield _("largest angular speed"), wheel.omega, ANGULAR_SPEED
    yield _("largest angular acceleration while it is driven"), wheel.epsilon, ANGULAR_ACCELERATION
    yield _("largest jump of omega where it is taken up and let go"), wheel.shock, ANGULAR_SPEED


def _notes(wheel: Intermittent) -> Iterable[str]:
    name = wheel.task.name
    if wheel.shock == 0:
        yield _("Wheel {name} is taken up and let go without shock: its angular speed does not jump.").format(name=name)
    else:
        yield _("Wheel {name} is taken up or let go with a shock: its angular speed jumps.").format(name=name)
    if wheel.cycles is None and wheel.turn:
        text = _("Wheel {name} makes no whole number of turns in {most} cycles or fewer.")
        yield text.format(name=name, most=MOST_CYCLES)


def _course(wheels: Iterable[Intermittent], place: Dimension) -> Table:
    every = [(wheel.task.name, part) for wheel in wheels for part in wheel.parts]
    columns = [Column(N_("wheel"), [name for name, part in every for __ in part.ways])]
    told = (
        (N_("way of the driver"), "ways", place), (N_("angle"), "angles", ANGLE),
        (N_("omega"), "omegas", ANGULAR_SPEED), (N_("epsilon"), "epsilons", ANGULAR_ACCELERATION),
    )  # fmt: skip
    for header, name, dimension in told:
        values = np.concatenate([getattr(part, name) for __, part in every])
        columns.append(Column(header, values, dimension))
    return Table("intermittent-course", _("Course of intermittent motion"), tuple(columns), long=True)
