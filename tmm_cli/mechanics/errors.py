"""Errors that the stages of the calculation raise.

A stage reports what is wrong in numbers and names; the messages are composed where problem files are known
(`tmm_cli.problem`).
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tmm_cli.mechanics.structure import Group, Structure


class LinkageError(Exception):
    """Base of all errors of a linkage, or of a request that a stage cannot answer."""


class MobilityError(LinkageError):
    """The mobility differs from the number of drivers, or the drivers cannot move the linkage."""

    def __init__(self, structure: Structure) -> None:
        super().__init__(f"W = {structure.mobility}")
        self.structure = structure


class AssemblyError(LinkageError):
    """The linkage cannot be assembled in the position of the sketch.

    residual: by how much (m) a group in closed form fails to close there; None for other groups.
    """

    def __init__(self, group: Group, residual: float | None = None) -> None:
        super().__init__(group.title)
        self.group, self.residual = group, residual


class AmbiguousSketchError(LinkageError):
    """The sketch agrees with more than one assembly of a group.

    choices: points (m) and links (rad) that would decide, by name, each with its values in the two assemblies nearest
    to the sketch; empty in a dead position. count: number of assemblies.
    """

    def __init__(
        self, group: Group, choices: Mapping[str, tuple[complex | float, complex | float]], count: int = 2
    ) -> None:
        super().__init__(group.title)
        self.group, self.choices, self.count = group, choices, count


class SketchMismatchError(LinkageError):
    """A sketched point (m) or angle (rad) is far from its position in the nearest assembly."""

    def __init__(self, name: str, sketched: complex | float, found: complex | float) -> None:
        super().__init__(name)
        self.name, self.sketched, self.found = name, sketched, found


class GroupTooLargeError(LinkageError):
    """A group has more links than the iterative solution accepts; most: the largest number accepted."""

    def __init__(self, group: Group, most: int) -> None:
        super().__init__(group.title)
        self.group, self.most = group, most


class ChangePointSearchError(LinkageError):
    """The change points of a group depend on too many groups over too many turns of the driver.

    groups: number of groups to compute; turns: number of turns; most: largest product of the two.
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
    """A requested name does not exist; allowed: the names that do."""

    def __init__(self, name: str, allowed: tuple[str, ...]) -> None:
        super().__init__(name)
        self.name, self.allowed = name, allowed


class MissingStrokesError(LinkageError):
    """The key at `path` of the file needs the strokes of an output that has none.

    limits: range (rad or m) of a driver that cannot make a full turn, or that moves between two ends.
    """

    def __init__(self, link: str | None, path: tuple[str, ...], limits: tuple[float, float] | None = None) -> None:
        super().__init__(".".join(path))
        self.link, self.path, self.limits = link, path, limits


class TableBeyondCycleError(LinkageError):
    """The crank never reaches a row of a load table; path: of the row in the file.

    argument: crank angle of the row (rad); cycle: largest angle that the table may contain (rad).
    """

    def __init__(self, path: tuple[str | int, ...], argument: float, cycle: float) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.argument, self.cycle = path, argument, cycle


class NotOnFrameError(LinkageError):
    """A link cannot be the driver because it is not connected to the frame; allowed: the links that can."""

    def __init__(self, link: str, allowed: tuple[str, ...]) -> None:
        super().__init__(link)
        self.link, self.allowed = link, allowed


class SpeedTableError(LinkageError):
    """A table of driver speeds, from `first` to `last` (rad), does not cover a position.

    at: driver coordinate of that position (rad); None if the table merely does not cover the whole cycle.
    """

    def __init__(self, at: float | None, first: float, last: float, cycle: float) -> None:
        super().__init__(at)
        self.at, self.first, self.last, self.cycle = at, first, last, cycle


class NoTurnError(LinkageError):
    """Loads repeat after several turns, but the crank cannot make a full turn."""

    def __init__(self, turns: int) -> None:
        super().__init__(turns)
        self.turns = turns


class NoCycleError(LinkageError):
    """The block at `path` of the file (law of motion, balancing) needs a cycle, and there is none: the driver slides,
    cannot make a full turn, or is one of several.
    """

    def __init__(self, path: tuple[str, ...] = ("dynamics",)) -> None:
        super().__init__(".".join(path))
        self.path = path


class OutOfRangeError(LinkageError):
    """A run goes beyond the range of the driver, from `start` to `end` (rad or m)."""

    def __init__(self, start: float, end: float) -> None:
        super().__init__(start, end)
        self.start, self.end = start, end


class SpeedDependentForceError(LinkageError):
    """A law of motion is requested, but forces other than inertia depend on the speed; path: of the first such key."""

    def __init__(self, path: tuple[str, ...]) -> None:
        super().__init__(".".join(path))
        self.path = path


class StandstillError(LinkageError):
    """The machine stops: its kinetic energy is used up at the driver coordinate `place` of the cycle (rad)."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class NoInertiaError(LinkageError):
    """A single run has no law of motion: at the driver coordinate `place` nothing with inertia moves."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class LostDigitsError(LinkageError):
    """The law of motion is lost in rounding: in a cycle the motor changes the speed by too small a fraction `share`."""

    def __init__(self, share: float) -> None:
        super().__init__(share)
        self.share = share


class WeakMotorError(LinkageError):
    """The largest driving moment or force `most` (N m or N) is less than the mean `wanted` that the loads require.

    place: driver coordinate (rad) at which they require most.
    """

    def __init__(self, wanted: float, most: float, place: float) -> None:
        super().__init__(wanted, most)
        self.wanted, self.most, self.place = wanted, most, place


class LongRunError(LinkageError):
    """Integration of a run does not finish within `count` evaluations; time (s) and way (driver coordinate) reached."""

    def __init__(self, time: float, way: float, count: int) -> None:
        super().__init__(f"{time:g} s")
        self.time, self.way, self.count = time, way, count


class RunawayError(LinkageError):
    """The loads accelerate the machine beyond control of its motor: mean driving moment or force `pushing` (N m or N)
    of the loads against the largest braking moment or force `most`.

    place: driver coordinate of the cycle (rad) at which the loads drive most, or the machine is fastest, as far as it
    was computed; speed: the speed there (rad/s or m/s), nan where it was not computed (then `pushing` is at least
    `most`). idle: speed at which the motor neither drives nor brakes.
    """

    def __init__(self, pushing: float, most: float, idle: float, place: float, speed: float = nan) -> None:
        super().__init__(pushing, most)
        self.pushing, self.most, self.idle, self.place, self.speed = pushing, most, idle, place, speed


class NoFlywheelError(LinkageError):
    """The coefficient of fluctuation without a flywheel, `own`, is already below the required one; nan: no flywheel
    suffices.
    """

    def __init__(self, wanted: float, own: float) -> None:
        super().__init__(wanted, own)
        self.wanted, self.own = wanted, own


class CounterweightError(LinkageError):
    """Balancing has no solution with counterweights of the given radii: each added mass on a moving pivot requires
    more.
    """


class SettingError(LinkageError):
    """One of several alternating settings, at `path` of the file, is invalid; error: the reason."""

    def __init__(self, path: tuple[str | int, ...], error: LinkageError) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.error = path, error
