"""Errors that the calculation raises.

They contain numbers and names only. Their messages are composed in `tmm_cli.problem`, where the problem file is known.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tmm_cli.mechanics.structure import Group, Structure


class LinkageError(Exception):
    """The linkage cannot be analysed, or a request cannot be fulfilled. Base class of the errors of the calculation."""


class MobilityError(LinkageError):
    """The mobility differs from the number of drivers, or the drivers cannot move the linkage.

    structure: the structure of the linkage.
    """

    def __init__(self, structure: Structure) -> None:
        super().__init__(f"W = {structure.mobility}")
        self.structure = structure


class AssemblyError(LinkageError):
    """A group cannot be assembled in the position of the sketch.

    residual: distance (m) by which the group fails to close. It is None for groups that are solved by iteration.
    """

    def __init__(self, group: Group, residual: float | None = None) -> None:
        super().__init__(group.title)
        self.group, self.residual = group, residual


class AmbiguousSketchError(LinkageError):
    """The sketch agrees with more than one assembly of a group.

    choices: points (m) and angles of links (rad) that would decide, by name, each with its values in the two assemblies
    nearest to the sketch; empty in a dead position. count: number of assemblies.
    """

    def __init__(
        self, group: Group, choices: Mapping[str, tuple[complex | float, complex | float]], count: int = 2
    ) -> None:
        super().__init__(group.title)
        self.group, self.choices, self.count = group, choices, count


class SketchMismatchError(LinkageError):
    """A sketched point (m) or angle (rad) is far from its computed value.

    name: the point or link. sketched: its value in the sketch. found: its value in the nearest assembly.
    """

    def __init__(self, name: str, sketched: complex | float, found: complex | float) -> None:
        super().__init__(name)
        self.name, self.sketched, self.found = name, sketched, found


class GroupTooLargeError(LinkageError):
    """A group has more links than can be solved by iteration; most: the largest number of links allowed."""

    def __init__(self, group: Group, most: int) -> None:
        super().__init__(group.title)
        self.group, self.most = group, most


class ChangePointSearchError(LinkageError):
    """The search for change points of a group would take too long.

    groups: number of groups that must be solved in the search. turns: number of driver turns to be searched. most:
    largest allowed product of these two numbers.
    """

    def __init__(self, group: Group, groups: int, turns: int, most: int) -> None:
        super().__init__(group.title)
        self.group, self.groups, self.turns, self.most = group, groups, turns, most


class UnknownPositionError(LinkageError):
    """A position number is greater than the number of positions in the file."""

    def __init__(self, number: int, count: int) -> None:
        super().__init__(str(number))
        self.number, self.count = number, count


class UnknownNameError(LinkageError):
    """A requested name does not exist; allowed: the existing names."""

    def __init__(self, name: str, allowed: tuple[str, ...]) -> None:
        super().__init__(name)
        self.name, self.allowed = name, allowed


class MissingStrokesError(LinkageError):
    """The key at `path` of the file requires strokes of an output, but the output has none.

    link: the output. limits: range (rad or m) of a driver that moves between two ends; otherwise None.
    """

    def __init__(self, link: str | None, path: tuple[str, ...], limits: tuple[float, float] | None = None) -> None:
        super().__init__(".".join(path))
        self.link, self.path, self.limits = link, path, limits


class TableBeyondCycleError(LinkageError):
    """A row of a load table is never reached by the crank.

    path: path of the row in the file. argument: crank angle of the row (rad). cycle: largest crank angle allowed (rad).
    """

    def __init__(self, path: tuple[str | int, ...], argument: float, cycle: float) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.argument, self.cycle = path, argument, cycle


class NotOnFrameError(LinkageError):
    """A link cannot be the driver because it is not connected to the frame; allowed: the links that are."""

    def __init__(self, link: str, allowed: tuple[str, ...]) -> None:
        super().__init__(link)
        self.link, self.allowed = link, allowed


class SpeedTableError(LinkageError):
    """A table of driver speeds does not cover a position, or the whole cycle.

    at: driver coordinate of the position (rad); None if only the cycle is not covered. first, last: first and last
    argument of the table (rad). cycle: length of the cycle (rad).
    """

    def __init__(self, at: float | None, first: float, last: float, cycle: float) -> None:
        super().__init__(at)
        self.at, self.first, self.last, self.cycle = at, first, last, cycle


class NoTurnError(LinkageError):
    """Loads repeat after several turns of the crank, but the crank cannot make a full turn."""

    def __init__(self, turns: int) -> None:
        super().__init__(turns)
        self.turns = turns


class NoCycleError(LinkageError):
    """The block at `path` of the file (law of motion, balancing) requires a cycle, but there is none.

    The driver slides, cannot make a full turn, or is one of several.
    """

    def __init__(self, path: tuple[str, ...] = ("dynamics",)) -> None:
        super().__init__(".".join(path))
        self.path = path


class OutOfRangeError(LinkageError):
    """A single run would leave the range of the driver, from `start` to `end` (rad or m)."""

    def __init__(self, start: float, end: float) -> None:
        super().__init__(start, end)
        self.start, self.end = start, end


class SpeedDependentForceError(LinkageError):
    """A law of motion is requested, but forces other than inertia depend on the speed.

    path: path in the file of the first such force.
    """

    def __init__(self, path: tuple[str, ...]) -> None:
        super().__init__(".".join(path))
        self.path = path


class StandstillError(LinkageError):
    """The machine stops: its kinetic energy falls to zero at the driver coordinate `place` of the cycle (rad)."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class NoInertiaError(LinkageError):
    """A single run has no law of motion: at the driver coordinate `place` no moving link has inertia."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class LostDigitsError(LinkageError):
    """The law of motion of a machine with a motor cannot be computed accurately.

    Within a cycle the speed changes so little that the change is lost in rounding. share: largest relative change of
    the speed.
    """

    def __init__(self, share: float) -> None:
        super().__init__(share)
        self.share = share


class WeakMotorError(LinkageError):
    """The driving moment or force never reaches the mean value that the loads require.

    wanted: required mean (N m or N). most: largest driving moment or force. place: driver coordinate (rad) at which the
    loads require most.
    """

    def __init__(self, wanted: float, most: float, place: float) -> None:
        super().__init__(wanted, most)
        self.wanted, self.most, self.place = wanted, most, place


class LongRunError(LinkageError):
    """The integration of a single run did not finish.

    time: time reached (s). way: driver coordinate reached. count: number of evaluations made.
    """

    def __init__(self, time: float, way: float, count: int) -> None:
        super().__init__(f"{time:g} s")
        self.time, self.way, self.count = time, way, count


class RunawayError(LinkageError):
    """The loads accelerate the machine, and its motor cannot brake it.

    Attributes:
        pushing: mean driving moment or force of the loads (N m or N).
        most: largest braking moment or force of the motor.
        idle: speed at which the motor neither drives nor brakes.
        place: driver coordinate of the cycle (rad) at which the loads drive most, or at which the machine is fastest,
            as far as its motion was computed.
        speed: speed at `place` (rad/s or m/s). It is nan if the motion was not computed because `pushing` already
            exceeds or equals `most`.
    """

    def __init__(self, pushing: float, most: float, idle: float, place: float, speed: float = nan) -> None:
        super().__init__(pushing, most)
        self.pushing, self.most, self.idle, self.place, self.speed = pushing, most, idle, place, speed


class NoFlywheelError(LinkageError):
    """No flywheel is needed, or none is sufficient.

    wanted: required coefficient of fluctuation of speed. own: the coefficient without a flywheel, which is already
    below `wanted`; nan if no flywheel is sufficient.
    """

    def __init__(self, wanted: float, own: float) -> None:
        super().__init__(wanted, own)
        self.wanted, self.own = wanted, own


class CounterweightError(LinkageError):
    """Balancing with counterweights of these radii has no solution.

    Every mass added on a moving pivot requires further masses.
    """


class SettingError(LinkageError):
    """One of several alternating settings is invalid.

    path: path of the setting in the file. error: the reason.
    """

    def __init__(self, path: tuple[str | int, ...], error: LinkageError) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.error = path, error
