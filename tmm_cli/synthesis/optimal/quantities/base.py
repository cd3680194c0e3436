"""A quantity of a mechanism over its cycle, for many variants at once.

It is written on the tape with the linkage (`outputs`), and then read off coarsely, from places all round the cycle
(`coarse`), or finely, from windows of places about its peaks and zeros (`windows`, `fine`), where it is exact to some
1e-12; and it is measured on a mechanism that was analysed by the ordinary stages (`measure`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from tmm_cli.batch import solve_forces
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real, find_minima, highest_peaks, highest_value, locate_extreme, window_peak
from tmm_cli.mechanics.structure import output_link
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import DriverEnds

MOST_PEAKS = 4  # of a curve that are looked at closely
SCAN = 1440  # places in a turn, or in a stroke, of an analysed mechanism
CLOSELY = "closely."  # begins the names of outputs that are wanted for windows alone

Read = Callable[[str], Real]  # an output by name, (variants, places)
Curve = Callable[[str, Real], Real]  # of one candidate: an output by name, at shares of the driver range
Windows = list[tuple[Any, float, Read]]  # what a window is of, its first place, its outputs


@dataclass(frozen=True)
class QuantityRange:
    """What a quantity is read over: closed when the driver turns on and on; cycle: of the driver (rad).

    swings: the output's run is an angle. rough: forces may jump, so that there is nothing smooth about their peaks.
    traced: many places cost little.
    """

    linkage: Linkage
    swings: bool
    closed: bool = True
    cycle: float = 2 * np.pi
    rough: bool = False
    traced: bool = True


@dataclass(frozen=True)
class MechanismQuantity(ABC):
    """What a task asks of it. name: of the pair, the point or the link; links: those whose lengths count.

    places: of the driver (rad or m), with the wanted values there; a path without places is to pass through the points
    in any of its positions. norm: how deviations are counted.
    """

    name: str = ""
    links: tuple[str, ...] = ()
    places: tuple[float, ...] = ()
    wanted: tuple[Any, ...] = ()
    norm: Literal["least squares", "largest"] = "least squares"
    relative: bool = False

    of: ClassVar[str]  # its name in files
    text: ClassVar[str]
    dimension: ClassVar[str] = "length"
    keys: ClassVar[tuple[str, ...]] = ()  # of a problem file, beside `of`
    named: ClassVar[str] = ""  # the one of them that says of what it is: pair, point or link
    given: ClassVar[str] = ""  # the one of them that says what is wanted
    forces: ClassVar[bool] = False  # wants the force plan
    moves: ClassVar[bool] = True  # hangs on where the driver goes
    lowest: ClassVar[bool] = False  # its least value in a cycle counts, and as an objective it is made largest

    @abstractmethod
    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        """What is to be written down for it."""

    @abstractmethod
    def coarse(self, read: Read, over: QuantityRange) -> Real:
        """From places all over the driver range (for `places`: from those), (variants,)."""

    @abstractmethod
    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        """Pieces of the quantity, (variants, pieces); the largest counts (of `lowest`: the least).

        exact: outputs at the quantity's own places; step: of places in windows. Places are shares of the range.
        """

    @abstractmethod
    def measured(self, results: Results, ends: DriverEnds) -> float:
        """On an analysed mechanism that goes its whole way, see `measure`."""

    def measure(self, results: Results, ends: DriverEnds) -> float:
        """On an analysed mechanism (SI, rad), over the driver range between two ends, else over its cycle.

        nan where the mechanism has none.
        """
        return self.measured(results, ends) if measures.completes_range(results, ends) else measures.NO_VALUE

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        """What to look at closely, and about which place of a scan of one variant."""
        return []

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        """The quantity of one candidate where windows may not be exact enough; value: from those."""
        return value

    def smooth(self, pieces: Real) -> Real:
        """Of pieces what is made least in their place, with derivatives where they are zero."""
        return pieces

    def open(self, results: Results) -> float:
        """By how much of it rounding leaves the measured value open."""
        return 0.0

    def kind(self, linkage: Linkage, groups: Any) -> str:
        """Its dimension by name."""
        return self.dimension

    def title(self, linkage: Linkage) -> str:
        """What it is called."""
        return self.text

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> str | None:
        """Why a linkage has no such quantity."""
        return None

    def output(self, linkage: Linkage, groups: Any) -> str | None:
        """The link whose run it rests on."""
        return output_link(linkage, groups)

    def slides(self, linkage: Linkage, groups: Any) -> bool:
        """Whether that link slides."""
        link = self.output(linkage, groups)
        return link is not None and not linkage.output_swings(link)

    def outputs_of(self, results: Results, q: Real) -> Mapping[str, Any]:
        """What is written down for it at places of an analysed mechanism."""
        motion = motion_at(results, q)
        plan = solve_forces(motion, results.structure, results.strokes) if self.forces else None
        return self.outputs(motion, plan)


class ConstantQuantity(MechanismQuantity):
    """The same in all positions, its `value`."""

    moves = False

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        return read("value")[:, 0]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        return exact("value")[:, :1]

    def measured(self, results: Results, ends: DriverEnds) -> float:
        return float(self.outputs_of(results, np.array([results.start]))["value"])


class PeakQuantity(MechanismQuantity):
    """The largest value of a curve in a cycle, or the sum of those of several."""

    curves: ClassVar[tuple[str, ...]] = ("y",)

    def from_curve(self, y: Any) -> Any:
        """The quantity of a place from its curve, whose opposite it is for `lowest`."""
        return y

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        found: Real = self.from_curve(sum(np.max(read(name), axis=1) for name in self.curves))
        return -found if self.lowest else found

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        return [("y", k) for k in highest_peaks(read("y")[0], MOST_PEAKS, over.closed)]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        ys = [self.from_curve(read(name)) for name, _, read in parts]
        rough = over.rough and self.forces
        found: Real = np.stack([np.max(y, axis=1) if rough else window_peak(y) for y in ys], axis=1)
        return -found if self.lowest else found

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        if over.rough and self.forces:
            return highest_value(lambda shares: curve("y", shares), scan, closed=over.closed)
        return value

    def measured(self, results: Results, ends: DriverEnds) -> float:
        total = sum(
            highest_over_range(lambda q, n=name: np.asarray(self.outputs_of(results, q)[n]), results, ends)  # type: ignore[misc]
            for name in self.curves
        )
        return -total if self.lowest else total


def motion_at(results: Results, q: Real) -> Motion:
    """Of an analysed mechanism at other places of its driver."""
    return motion_at_positions(results, np.atleast_1d(q))


def highest_over_range(curve: Callable[[Real], Real], results: Results, ends: DriverEnds) -> float:
    """The largest value of a curve over the driver range: in a cycle from position 0 on."""
    assert results.driver_range is not None
    driver, turns = results.linkage.driver, results.driver_range.turns
    if ends is None and not results.driver_range.full:
        ends = results.driver_range.start, results.driver_range.end
    low, high = ends or sorted((results.start, results.start + driver.sense * 2 * np.pi * turns))
    q = np.linspace(low, high, SCAN * turns + 1)
    y = curve(q)
    k, step = int(np.nanargmax(y)), q[1] - q[0]
    if (ends or driver.acceleration) and k in (0, len(q) - 1):
        return float(y[k])
    place, value = find_minima(lambda x: -curve(x), q[k] - step, q[k] + step)
    place = locate_extreme(lambda x: -curve(x), place, step)
    return float(max(curve(np.array([place]))[0], -value, y[k]))
