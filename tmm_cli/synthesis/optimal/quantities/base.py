"""A quantity of a mechanism over its cycle, for many variants at once.

It is traced together with the linkage (`outputs`), then evaluated coarsely from positions around the cycle (`coarse`),
or finely from windows of positions around its peaks and zeros (`windows`, `fine`), to about 1e-12; and it is measured
on a mechanism that the ordinary stages have analysed (`measure`).
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

MOST_PEAKS = 4  # peaks of a curve that are evaluated finely
SCAN = 1440  # positions per revolution or stroke of an analysed mechanism
CLOSELY = "closely."  # prefix of outputs that only windows need

Read = Callable[[str], Real]  # an output by name, (variants, positions)
Curve = Callable[[str, Real], Real]  # an output of one candidate by name, at fractions of the driver range
Windows = list[tuple[Any, float, Read]]  # subject of a window, its start, its outputs


@dataclass(frozen=True)
class QuantityRange:
    """Range of the driver over which a quantity is evaluated.

    Attributes:
        swings: True if the motion of the output is an angle.
        closed: True if the driver rotates continuously.
        cycle: length of the cycle (rad).
        rough: True if forces may jump, so that their peaks are not smooth.
        traced: True if evaluating many positions is cheap.
    """

    linkage: Linkage
    swings: bool
    closed: bool = True
    cycle: float = 2 * np.pi
    rough: bool = False
    traced: bool = True


@dataclass(frozen=True)
class MechanismQuantity(ABC):
    """A quantity and the data that a task gives for it.

    Attributes:
        name: the pair, point or link.
        links: the links whose lengths count.
        places: driver coordinates (rad or m) of the required values; without them a path may pass through the points at
            any position.
        wanted: required values.
        norm: how deviations are combined.
        relative: True if a law counts from its first value.
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
    keys: ClassVar[tuple[str, ...]] = ()  # keys of a problem file besides `of`
    named: ClassVar[str] = ""  # the key that names the pair, point or link
    given: ClassVar[str] = ""  # the key with the required values
    forces: ClassVar[bool] = False  # requires the force plan
    moves: ClassVar[bool] = True  # depends on the driver range
    lowest: ClassVar[bool] = False  # its smallest value counts, and as an objective it is maximised

    @abstractmethod
    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        """Return the traced outputs that the quantity needs, by name."""

    @abstractmethod
    def coarse(self, read: Read, over: QuantityRange) -> Real:
        """Return the coarse value from positions over the driver range, or from the quantity's own `places`;
        (variants,).
        """

    @abstractmethod
    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        """Return candidate peaks of the quantity, (variants, peaks); the largest counts, with `lowest` the smallest.

        Args:
            parts: windows around the peaks.
            exact: outputs at the quantity's own `places`.
            step: distance of the positions in a window, as a fraction of the driver range.
        """

    @abstractmethod
    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        """Measure the quantity on an analysed mechanism that completes its range; see `measure`."""

    def measure(self, results: Results, ends: DriverEnds) -> float:
        """Measure the quantity on an analysed mechanism (SI, rad) between two ends of the driver range, or over the
        cycle.

        nan if the mechanism has no such quantity.
        """
        return self.measure_range(results, ends) if measures.completes_range(results, ends) else measures.NO_VALUE

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        """Return the windows to evaluate finely: what each shows, and its central index in a scan of one variant."""
        return []

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        """Refine the value of one candidate where windows are not accurate enough; value: the one from windows."""
        return value

    def smooth(self, pieces: Real) -> Real:
        """Return a function of the peaks to be minimised instead of them, differentiable where they are zero."""
        return pieces

    def open(self, results: Results) -> float:
        """Return the uncertainty of the measured value from rounding."""
        return 0.0

    def kind(self, linkage: Linkage, groups: Any) -> str:
        """Return the name of its dimension."""
        return self.dimension

    def title(self, linkage: Linkage) -> str:
        """Return its description."""
        return self.text

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> str | None:
        """Return why this quantity is not defined for a linkage, or None if it is."""
        return None

    def output(self, linkage: Linkage, groups: Any) -> str | None:
        """Return the link whose motion the quantity depends on."""
        return output_link(linkage, groups)

    def slides(self, linkage: Linkage, groups: Any) -> bool:
        """Return True if that link slides."""
        link = self.output(linkage, groups)
        return link is not None and not linkage.output_swings(link)

    def compute_outputs(self, results: Results, q: Real) -> Mapping[str, Any]:
        """Return the outputs at driver coordinates q of an analysed mechanism."""
        motion = motion_at(results, q)
        plan = solve_forces(motion, results.structure, results.strokes) if self.forces else None
        return self.outputs(motion, plan)


class ConstantQuantity(MechanismQuantity):
    """A quantity that is equal in all positions."""

    moves = False

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        return read("value")[:, 0]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        return exact("value")[:, :1]

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return float(self.compute_outputs(results, np.array([results.start]))["value"])


class PeakQuantity(MechanismQuantity):
    """The largest value of a curve in a cycle, or the sum of the largest values of several curves."""

    curves: ClassVar[tuple[str, ...]] = ("y",)

    def from_curve(self, y: Any) -> Any:
        """Convert values of the curve to the quantity (with `lowest`, to its negative)."""
        return y

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        peak_value: Real = self.from_curve(sum(np.max(read(name), axis=1) for name in self.curves))
        return -peak_value if self.lowest else peak_value

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        return [("y", k) for k in highest_peaks(read("y")[0], MOST_PEAKS, over.closed)]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        ys = [self.from_curve(read(name)) for name, _, read in parts]
        rough = over.rough and self.forces
        peaks: Real = np.stack([np.max(y, axis=1) if rough else window_peak(y) for y in ys], axis=1)
        return -peaks if self.lowest else peaks

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        if over.rough and self.forces:
            return highest_value(lambda shares: curve("y", shares), scan, closed=over.closed)
        return value

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        total = sum(
            highest_over_range(lambda q, n=name: np.asarray(self.compute_outputs(results, q)[n]), results, ends)  # type: ignore[misc]
            for name in self.curves
        )
        return -total if self.lowest else total


def motion_at(results: Results, q: Real) -> Motion:
    """Return the motion of an analysed mechanism at other driver coordinates."""
    return motion_at_positions(results, np.atleast_1d(q))


def highest_over_range(curve: Callable[[Real], Real], results: Results, ends: DriverEnds) -> float:
    """Return the largest value of a curve over the driver range; of a cycle from position 0 on."""
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
