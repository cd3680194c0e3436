"""Intermittent motion: each wheel over the cycles of all its settings."""

from __future__ import annotations

from collections.abc import Callable

from tmm_cli.analysis.mechanism import Inputs, Mechanism
from tmm_cli.assembly.rank import mobile
from tmm_cli.errors import LinkageError, MissingStrokesError, NoCycleError, SettingError
from tmm_cli.groups.sequence import LawOfMotion
from tmm_cli.kinematics.intermittent import Intermittent, Part, Ride, parts_of, rides_of_turns, rides_there_and_back
from tmm_cli.kinematics.intermittent_task import WheelTask
from tmm_cli.kinematics.strokes import find_strokes
from tmm_cli.linkage import Linkage

LawOf = Callable[[Linkage], LawOfMotion]  # how the driver of a linkage moves


def intermittent(mechanism: Mechanism, start: float, law_of: LawOf) -> tuple[Intermittent, ...]:
    """All wheels of the file, from the driver's place `start` on. Raises NoCycleError, MissingStrokesError,
    SettingError.
    """
    return tuple(_wheel(mechanism, task, start, law_of) for task in mechanism.inputs.wheels)


def _wheel(mechanism: Mechanism, task: WheelTask, start: float, law_of: LawOf) -> Intermittent:
    parts: list[Part] = []
    for number, setting in enumerate(task.settings):
        own, linkage = mechanism, setting.linkage
        try:
            if linkage is not None:
                own = Mechanism(Inputs(linkage), mobile(linkage))
            rides = _rides(own, task, start)
            parts += parts_of(own.linkage, own.kernels, task.link, rides, law_of(own.linkage), number, parts)
        except LinkageError as error:
            if linkage is None:
                raise
            raise SettingError(("intermittent", task.name, "settings", number), error) from None
    return Intermittent(task, tuple(parts))


def _rides(mechanism: Mechanism, task: WheelTask, start: float) -> list[Ride]:
    linkage, driver_range, block = mechanism.linkage, mechanism.driver_range, ("intermittent", task.name)
    by_link = task.when in ("forward", "backward")
    if driver_range.full and driver_range.repeats:
        strokes = mechanism.strokes
        if by_link:
            strokes = find_strokes(linkage, mechanism.kernels, driver_range, link=task.link)
        if strokes is None or not strokes.strokes:
            raise MissingStrokesError(task.link, (*block, "moves_with" if by_link else "when"))
        return rides_of_turns(task, strokes, linkage.driver.sense, start)
    if driver_range.full or not driver_range.inclusive or linkage.others:
        raise NoCycleError(block)
    if not by_link:
        raise MissingStrokesError(task.link, (*block, "when"))
    return rides_there_and_back(linkage, mechanism.kernels, task, driver_range)
