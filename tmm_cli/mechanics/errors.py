"""What a stage may refuse.

A stage says what is wrong in numbers and names; the words are put where files are known.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tmm_cli.mechanics.structure import Group, Structure


class LinkageError(Exception):
    """A linkage or a request for which a stage has no answer."""


class MobilityError(LinkageError):
    """The linkage and its drivers do not fit: mobility is not their number, or they cannot move it."""

    def __init__(self, structure: Structure) -> None:
        super().__init__(f"W = {structure.mobility}")
        self.structure = structure


class AssemblyError(LinkageError):
    """The sketch cannot be assembled.

    residual: how much (m) a group in closed form is short of closing at the sketch's place; others only fail to.
    """

    def __init__(self, group: Group, residual: float | None = None) -> None:
        super().__init__(group.title)
        self.group, self.residual = group, residual


class AmbiguousSketchError(LinkageError):
    """The sketch does not tell two assemblies apart.

    choices: for points (m) and links (rad) that would tell, the values in the two assemblies that are nearest to the
    sketch; none in a dead position. count: how many assemblies there are.
    """

    def __init__(
        self, group: Group, choices: Mapping[str, tuple[complex | float, complex | float]], count: int = 2
    ) -> None:
        super().__init__(group.title)
        self.group, self.choices, self.count = group, choices, count


class SketchMismatchError(LinkageError):
    """A sketched point (m) or angle (rad) is far from where it comes to lie in the nearest assembly."""

    def __init__(self, name: str, sketched: complex | float, found: complex | float) -> None:
        super().__init__(name)
        self.name, self.sketched, self.found = name, sketched, found


class GroupTooLargeError(LinkageError):
    """A group of more links than iteration is tried on; most: how many it may have."""

    def __init__(self, group: Group, most: int) -> None:
        super().__init__(group.title)
        self.group, self.most = group, most


class ChangePointSearchError(LinkageError):
    """The change points of a group depend on too many groups over too many turns of the driver.

    groups: how many groups are computed; turns: over how many turns; most: the budget, groups times turns.
    """

    def __init__(self, group: Group, groups: int, turns: int, most: int) -> None:
        super().__init__(group.title)
        self.group, self.groups, self.turns, self.most = group, groups, turns, most


class UnknownPositionError(LinkageError):
    """A position number beyond those of the file."""

    def __init__(self, number: int, count: int) -> None:
        super().__init__(str(number))
        self.number, self.count = number, count


class UnknownNameError(LinkageError):
    """Something is asked for by a name that nothing has; allowed: those that are."""

    def __init__(self, name: str, allowed: tuple[str, ...]) -> None:
        super().__init__(name)
        self.name, self.allowed = name, allowed


class MissingStrokesError(LinkageError):
    """Strokes of the output are needed, by the key at `path` of the file, but it has none.

    limits: range of a driver that does not turn fully, or moves between two ends (rad, or m).
    """

    def __init__(self, link: str | None, path: tuple[str, ...], limits: tuple[float, float] | None = None) -> None:
        super().__init__(".".join(path))
        self.link, self.path, self.limits = link, path, limits


class TableBeyondCycleError(LinkageError):
    """A row of a load's table, given by its path in the file, that the crank never reaches.

    argument: of the row (rad); cycle: the table may reach from 0 to here (rad).
    """

    def __init__(self, path: tuple[str | int, ...], argument: float, cycle: float) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.argument, self.cycle = path, argument, cycle


class NotOnFrameError(LinkageError):
    """A link that cannot drive from the frame; allowed: those that can."""

    def __init__(self, link: str, allowed: tuple[str, ...]) -> None:
        super().__init__(link)
        self.link, self.allowed = link, allowed


class SpeedTableError(LinkageError):
    """A table of the driver's speeds, from `first` to `last` (rad), does not reach a position.

    at: its place; None where the table just does not go all round the cycle.
    """

    def __init__(self, at: float | None, first: float, last: float, cycle: float) -> None:
        super().__init__(at)
        self.at, self.first, self.last, self.cycle = at, first, last, cycle


class NoTurnError(LinkageError):
    """Loads come again after several turns of a crank that does not turn fully."""

    def __init__(self, turns: int) -> None:
        super().__init__(turns)
        self.turns = turns


class NoCycleError(LinkageError):
    """A law of motion, or balancing, by the block at `path` of the file, is wanted where there is no cycle: the driver
    slides, does not turn fully, or is not alone.
    """

    def __init__(self, path: tuple[str, ...] = ("dynamics",)) -> None:
        super().__init__(".".join(path))
        self.path = path


class OutOfRangeError(LinkageError):
    """A run is to go where the driver does not come: beyond its range from `start` to `end` (rad, or m)."""

    def __init__(self, start: float, end: float) -> None:
        super().__init__(start, end)
        self.start, self.end = start, end


class SpeedDependentForceError(LinkageError):
    """A law of motion is wanted where what acts hangs on it in more than the inertia; path: of it in the file."""

    def __init__(self, path: tuple[str, ...]) -> None:
        super().__init__(".".join(path))
        self.path = path


class StandstillError(LinkageError):
    """The machine comes to rest at the way `place` of its cycle (rad): its energy is used up there."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class NoInertiaError(LinkageError):
    """A single run has no law of motion: nothing has inertia that moves with the driver at the way `place`."""

    def __init__(self, place: float) -> None:
        super().__init__(place)
        self.place = place


class LostDigitsError(LinkageError):
    """The law of motion is lost in rounding: a motor changes the speed by too small a `share` of itself in a cycle."""

    def __init__(self, share: float) -> None:
        super().__init__(share)
        self.share = share


class WeakMotorError(LinkageError):
    """A motor gives `most` (N m, or N) at its best, and the loads of a cycle want `wanted` in the mean.

    place: where on the way of the cycle (rad) they want most.
    """

    def __init__(self, wanted: float, most: float, place: float) -> None:
        super().__init__(wanted, most)
        self.wanted, self.most, self.place = wanted, most, place


class LongRunError(LinkageError):
    """A run that integration does not bring to its end in so many evaluations: its time (s) and way then."""

    def __init__(self, time: float, way: float, count: int) -> None:
        super().__init__(f"{time:g} s")
        self.time, self.way, self.count = time, way, count


class RunawayError(LinkageError):
    """Loads push a machine on, with `pushing` (N m, or N) in the mean, and its motor holds `most` at its best.

    place: where on the way of its cycle (rad) they push most, or the machine is quickest, as far as it was followed;
    speed: there (rad/s, or m/s), nan where it was not: `pushing` is no less than `most` then. idle: speed at which the
    motor neither drives nor holds.
    """

    def __init__(self, pushing: float, most: float, idle: float, place: float, speed: float = nan) -> None:
        super().__init__(pushing, most)
        self.pushing, self.most, self.idle, self.place, self.speed = pushing, most, idle, place, speed


class NoFlywheelError(LinkageError):
    """The fluctuation is smaller than wanted without any: its size is `own`. It is nan where no flywheel is enough."""

    def __init__(self, wanted: float, own: float) -> None:
        super().__init__(wanted, own)
        self.wanted, self.own = wanted, own


class CounterweightError(LinkageError):
    """No counterweights of the radii that are told balance: their own masses, on pivots that move, want ever more."""


class SettingError(LinkageError):
    """One of the settings that take turns, by its path in the file, is refused: `error` says why."""

    def __init__(self, path: tuple[str | int, ...], error: LinkageError) -> None:
        super().__init__(".".join(map(str, path)))
        self.path, self.error = path, error
