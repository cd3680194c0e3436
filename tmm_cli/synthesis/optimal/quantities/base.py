"""Base classes of the quantities of a mechanism in an optimal synthesis, evaluated for many variants at once.

The outputs from which a quantity is computed are recorded together with the motion of the linkage (`outputs`). The
value is then computed approximately from positions around the cycle (`coarse`), or to about 1e-12 from windows, i.e. a
few closely spaced positions around each peak and zero (`windows`, `fine`). It can also be measured on a mechanism after
an ordinary analysis (`measure`).
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
        linkage: the linkage.
        swings: True if the coordinate of the output link is an angle.
        closed: True if the range is a full cycle.
        cycle: length of the cycle or range (rad or m).
        rough: True if forces may jump, so that their peaks are not smooth.
        traced: True if many positions can be evaluated at low cost.
    """

    linkage: Linkage
    swings: bool
    closed: bool = True
    cycle: float = 2 * np.pi
    rough: bool = False
    traced: bool = True


@dataclass(frozen=True)
class MechanismQuantity(ABC):
    """A quantity of the mechanism, with the data that the task specifies for it.

    Attributes:
        name: the pair, point or link concerned.
        links: links whose lengths are added.
        places: driver coordinates (rad or m) of the required values; empty if the path may pass the required points at
            any position.
        wanted: required values (SI, rad).
        norm: how deviations are combined: `least squares` or `largest`.
        relative: True if a law of motion is measured from its first value.
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
        """Return the values from which the quantity is computed, by name, as functions of the recorded motion and
        reactions.
        """

    @abstractmethod
    def coarse(self, read: Read, over: QuantityRange) -> Real:
        """Return the approximate value, shape (variants,), from samples of the driver range or from the coordinates
        `places`.
        """

    @abstractmethod
    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        """Return accurate values of the peaks, shape (variants, peaks).

        The value of the quantity is the largest peak, or with `lowest` the smallest.

        Args:
            parts: windows around the peaks.
            exact: function that reads outputs at the coordinates `places`.
            over: range of the driver.
            step: spacing of the positions in a window, as a fraction of the driver range.
        """

    @abstractmethod
    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        """Measure the quantity (SI, rad) on an analysed mechanism; called by `measure` if the driver completes the
        range.

        Args:
            results: analysis of the mechanism.
            ends: range of the driver (rad or m); None for a cycle.
        """

    def measure(self, results: Results, ends: DriverEnds) -> float:
        """Measure the quantity (SI, rad) on an analysed mechanism; nan if its driver does not complete the range.

        Args:
            results: analysis of the mechanism.
            ends: range of the driver (rad or m); None for a cycle.
        """
        return self.measure_range(results, ends) if measures.completes_range(results, ends) else measures.NO_VALUE

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        """Return the windows of positions in which the quantity must be evaluated accurately.

        Args:
            read: function that reads outputs of one variant at closely spaced positions (a scan).
            over: range of the driver.

        Returns:
            For each window a name of its curve, and the index of its middle in the scan.
        """
        return []

    def refine_value(self, value: float, curve: Curve, scan: Real, over: QuantityRange) -> float:
        """Refine the value of one candidate where windows of positions are not accurate enough; unchanged by default.

        Args:
            value: value computed from the windows.
            curve: function that returns an output, by name, at fractions of the driver range.
            scan: closely spaced fractions of the driver range, at which the peaks were located.
            over: range of the driver.
        """
        return value

    def smooth(self, pieces: Real) -> Real:
        """Convert peaks to differentiable values that have the same minimum; needed if a peak has a kink where it is
        zero.
        """
        return pieces

    def open(self, results: Results) -> float:
        """Return the uncertainty of the measured value of the quantity, which is due to rounding."""
        return 0.0

    def kind(self, linkage: Linkage, groups: Any) -> str:
        """Return the name of the quantity's dimension."""
        return self.dimension

    def title(self, linkage: Linkage) -> str:
        """Return the description of the quantity, for tables and diagrams."""
        return self.text

    def unfit(self, linkage: Linkage, groups: Any, *, closed: bool) -> str | None:
        """Return the reason why the quantity is undefined for a linkage; None if it is defined.

        Args:
            linkage: the linkage.
            groups: its Assur groups.
            closed: True if the range of the driver is a full cycle.
        """
        return None

    def output(self, linkage: Linkage, groups: Any) -> str | None:
        """Return the link on whose motion the quantity depends; None if there is none."""
        return output_link(linkage, groups)

    def slides(self, linkage: Linkage, groups: Any) -> bool:
        """Return True if the link on whose motion the quantity depends slides."""
        link = self.output(linkage, groups)
        return link is not None and not linkage.output_swings(link)

    def compute_outputs(self, results: Results, q: Real) -> Mapping[str, Any]:
        """Return the outputs of an analysed mechanism at driver coordinates q (rad or m), by name."""
        motion = motion_at(results, q)
        plan = solve_forces(motion, results.structure, results.strokes) if self.forces else None
        return self.outputs(motion, plan)


class ConstantQuantity(MechanismQuantity):
    """A quantity with the same value in all positions."""

    moves = False

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        return read("value")[:, 0]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        return exact("value")[:, :1]

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return float(self.compute_outputs(results, np.array([results.start]))["value"])


class PeakQuantity(MechanismQuantity):
    """The largest value of a curve over the driver range, or the sum of the largest values of several curves."""

    curves: ClassVar[tuple[str, ...]] = ("y",)

    def from_curve(self, y: Any) -> Any:
        """Convert values of the curve to values of the quantity; if `lowest` is True, multiplied by -1."""
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
    """Return the motion of an analysed mechanism at driver coordinates q (rad or m)."""
    return motion_at_positions(results, np.atleast_1d(q))


def highest_over_range(curve: Callable[[Real], Real], results: Results, ends: DriverEnds) -> float:
    """Return the largest value of a curve over the range of the driver.

    Args:
        curve: function of the driver coordinates (rad or m).
        results: analysis of the mechanism.
        ends: range of the driver; None for a cycle, which starts at position 0.
    """
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
