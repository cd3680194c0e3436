"""Four-bars through pairs of input and output angles, or for a function: all solutions, and the choice of one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.numerics import DEAD_COSINE_DOUBLE, find_minima
from tmm_cli.synthesis.four_bar import LEAST_USABLE, FourBarLinks, classify_four_bar, extreme_cosine
from tmm_cli.synthesis.four_bar_by_angles import freudenstein
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import EXACT, FourBarRatios, find_parallelogram
from tmm_cli.synthesis.four_bar_by_angles.generated_function import GeneratedFunction
from tmm_cli.synthesis.four_bar_by_angles.least_squares import FitBounds, fit_least_squares

# Lengths and zero angles of a task.


LENGTHS: Final = {  # lengths that a task may give (zero angles: ZEROS): kind and description
    "l1": ("length", N_("input link l1 = AB")),
    "l2": ("length", N_("coupler l2 = BC")),
    "l3": ("length", N_("output link l3 = DC")),
    "l4": ("length", N_("frame l4 = AD")),
}
ZEROS: Final = {
    "phi0": ("angle", N_("zero angle phi0 of the input link, measured from AD")),
    "psi0": ("angle", N_("zero angle psi0 of the output link, measured from AD")),
}

LIMITS: Final = {
    "link_ratio": ("number", N_("largest ratio of the longest to the shortest link")),
    "transmission": ("angle", N_("required smallest transmission angle")),
}


# Four-bars through pairs of angles: solution, quality, choice.


SCAN: Final = 1500  # four-bars through two pairs that are compared
LONGEST: Final = 10.0  # largest l1/l4 or l4/l1
_POSITIVE: Final = np.geomspace(1 / LONGEST, LONGEST, SCAN // 2)
RATIOS: Final = np.concatenate([-_POSITIVE[::-1], _POSITIVE])  # l4/l1, negative for a crank in the opposite direction
SHORT, LONG = 1e-6, 1e6  # limits of lengths over l4
LARGEST_RATIO: Final = 10.0  # longest to shortest link of a least-squares fit
LISTED: Final = 6  # minima of a least-squares fit
AT_BOUND: Final = 1e-5  # relative, and rad


@dataclass(frozen=True)
class AnglePairsTask:
    """Given quantities of a four-bar that must pass through pairs of input and output angles.

    Attributes:
        phi, psi: input and output angles (rad), measured from the zero angles.
        lengths: given lengths (m), by name: one; or with two pairs two of l1, l3, l4; or with three pairs l4 and l1 or
            l3.
        phi0, psi0: zero angles of the input and the output link, measured from AD (rad); None if unknown.
        choose: solution to take: `transmission` (best transmission angle), `crank` (one with a crank), or its number;
            empty for the best transmission angle, and for the least error of a least-squares fit.
        keep: True if solutions with branch or order defects are accepted.
        function: function from which the pairs are taken; None if the pairs are given.
        link_ratio: largest ratio of the longest to the shortest link of a least-squares fit.
        transmission: required smallest transmission angle over the range (rad); None if there is no requirement.
    """

    phi: tuple[float, ...]
    psi: tuple[float, ...]
    lengths: dict[str, float]
    phi0: float | None = 0.0
    psi0: float | None = 0.0
    choose: str = ""
    keep: bool = False
    function: GeneratedFunction | None = None
    link_ratio: float = LARGEST_RATIO
    transmission: float | None = None

    @property
    def span(self) -> tuple[float, float]:
        """First and last input angle of the range (rad)."""
        return self.function.phi if self.function else (self.phi[0], self.phi[-1])

    @property
    def free(self) -> bool:
        """True if l4/l1 may have any value, as with two pairs of angles and one given length."""
        return len(self.phi) == 2 and len(self.lengths) == 1

    @property
    def approximate(self) -> bool:
        """True if there are more pairs than a four-bar can pass through exactly."""
        return len(self.phi) > 3 + (self.phi0 is None) + (self.psi0 is None)


class FourBarQuality(NamedTuple):
    """Quality of four-bars; arrays of one shape.

    Attributes:
        least: smallest transmission angle over the range (rad).
        worst: input angle at which it occurs, measured from AD (rad).
        defect: "" for none, "branch" (some pairs belong to the other assembly) or "locks" (the input link locks between
            pairs).
        crank: True if the input link rotates fully.
        reversed: True if a link points opposite to its given zero direction.
    """

    least: Any
    worst: Any
    defect: Any
    crank: Any
    reversed: Any


def rate_four_bars(four_bars: FourBarRatios, task: AnglePairsTask) -> FourBarQuality:
    """Return the quality of four-bars: transmission angle, defects, full rotation of the input link."""
    l1, l2, l3, phi0 = (np.asarray(x, dtype=float) for x in (four_bars.l1, four_bars.l2, four_bars.l3, four_bars.phi0))
    l4 = np.ones(np.shape(l1))
    with np.errstate(all="ignore"):
        ends = np.sort(phi0[..., None] + np.asarray(task.span, dtype=float), axis=-1)
        cosine, worst = extreme_cosine((l1, l2, l3, l4), ends[..., 0], ends[..., 1])
        terms = (l2 * l2 + l3 * l3 + 1 + l1 * l1) / (2 * l2 * l3)
        b, c = four_bars.at((..., None)).pins(np.asarray(task.phi, EXACT), np.asarray(task.psi, EXACT))
        sides = np.sign(np.asarray(((c - b) * np.conj(c - 1)).imag, dtype=float))
        branch = np.any(sides != sides[..., :1], axis=-1) & (
            not task.approximate
        )  # an approximate fit uses one assembly only
        turned = np.zeros(np.shape(branch), dtype=bool)
        for given_zero, zero in ((task.phi0, four_bars.phi0), (task.psi0, four_bars.psi0)):
            if given_zero is not None:
                turned |= np.cos(np.asarray(given_zero - zero, dtype=float)) < 0
    defect = np.where(branch, "branch", np.where(1 - cosine <= DEAD_COSINE_DOUBLE * terms, "locks", ""))
    turns = classify_four_bar(FourBarLinks(l1, l2, l3, l4)).turns[..., 0]
    return FourBarQuality(np.arccos(np.minimum(1.0, cosine)), worst, defect[()], turns, turned)


def four_bars_through(task: AnglePairsTask) -> FourBarRatios:
    """Find all four-bars that satisfy the task, with lengths relative to l4.

    Only the best one is returned if l4/l1 is free. If the pairs can be reached only approximately, these are the best
    local minima of the error, those without defects first.
    """
    if len(task.phi) == 3 and len(task.lengths) == 2:
        four_bars = _find_by_circle(task)
        return four_bars.at(are_real(four_bars))
    if len(task.phi) > 2 and (parallel := find_parallelogram(task.phi, task.psi, task.phi0, task.psi0)) is not None:
        return parallel.at(None)
    if task.approximate:
        bounds = FitBounds(task.link_ratio, max(LEAST_USABLE, task.transmission or 0.0), task.span)
        four_bars, __ = fit_least_squares(task.phi, task.psi, task.phi0, task.psi0, bounds)
        four_bars = four_bars.at(are_real(four_bars))
        faults = ~are_admissible(task, four_bars)
        return four_bars.at(np.argsort(faults, kind="stable")[:LISTED])
    if task.free:
        four_bars = _find_best_ratio(task)
    elif len(task.phi) == 2:
        four_bars = _find_by_two_lengths(task)
    else:
        four_bars = freudenstein.solve_exact_pairs(task.phi, task.psi, task.phi0, task.psi0).at(0)
    return four_bars.at(are_real(four_bars))


def four_bars_of_ratios(task: AnglePairsTask, ratios: Any) -> FourBarRatios:
    """Find the four-bars that pass through two pairs of angles, for given ratios l4/l1.

    Args:
        task: given quantities.
        ratios: values of l4/l1, shape (n,); negative if the crank points opposite to its zero direction.
    """
    return _solve_two_pairs(task, np.broadcast_to([1.0, 0.0, 0.0], (len(ratios), 3)), ratios)


def _find_by_two_lengths(task: AnglePairsTask) -> FourBarRatios:
    """Find the four-bars that pass through two pairs of angles and have two given lengths.

    Solutions in which a link points opposite to its zero direction are included.
    """
    a, b = sorted(task.lengths)
    ratio, sense = task.lengths[b] / task.lengths[a], np.array([1.0, -1.0])
    ones, zeros = np.ones(2), np.zeros(2)
    if b == "l3":  # p = ratio q
        return _solve_two_pairs(task, np.stack([ones, -ratio * sense, zeros], axis=-1), zeros)
    return _solve_two_pairs(
        task, np.stack([ones, zeros, zeros] if a == "l1" else [zeros, ones, zeros], axis=-1), ratio * sense
    )


def _find_by_circle(task: AnglePairsTask) -> FourBarRatios:
    """Find the four-bar that passes through three pairs and has the given lengths l4 and l1 (or l3).

    B is rotated back about D by the output angles (or C about A by the input angles). The centre of the circle through
    its three positions is C (or B), which gives the zero angle of that link.
    """
    phi, psi = (np.asarray(x, EXACT) + (zero or 0.0) for x, zero in ((task.phi, task.phi0), (task.psi, task.psi0)))
    by_input = "l1" in task.lengths
    link_angles, inverse_angles, base = (phi, psi, -1.0) if by_input else (psi, phi, 1.0)
    length = EXACT(task.lengths["l1" if by_input else "l3"]) / task.lengths["l4"]
    points = (base + length * np.exp(1j * link_angles)) * np.exp(-1j * inverse_angles)
    rows = np.stack([2 * points.real, 2 * points.imag, np.ones_like(phi)], axis=-1)
    x, y, __ = freudenstein.solve_linear(rows, np.abs(points) ** 2)
    other_length, zero, l2 = np.hypot(x, y), np.arctan2(y, x), np.abs(points[0] - x - 1j * y)
    ratios = (length, l2, other_length, task.phi0, zero) if by_input else (other_length, l2, length, zero, task.psi0)
    return FourBarRatios(*ratios).at(None)


def _solve_two_pairs(task: AnglePairsTask, coefficients: Any, value: Any) -> FourBarRatios:
    """Find the four-bars that pass through two pairs of angles and satisfy a linear condition on p, q, s.

    Args:
        task: given quantities.
        coefficients, value: condition coefficients . (p, q, s) = value of Freudenstein's equation, shapes (n, 3) and
            (n,).
    """
    phi0, psi0 = task.phi0 or 0.0, task.psi0 or 0.0
    phi, psi = (
        np.broadcast_to(np.asarray(row, EXACT) + zero, (len(coefficients), 2))
        for row, zero in ((task.phi, phi0), (task.psi, psi0))
    )
    values = freudenstein.solve_two_pairs(phi, psi, coefficients, value)
    four_bars = freudenstein.lengths_from_pqs(np.concatenate([values, np.zeros((len(phi), 2))], -1), phi, psi)
    return four_bars._replace(phi0=four_bars.phi0 + phi0, psi0=four_bars.psi0 + psi0)


def _find_best_ratio(task: AnglePairsTask) -> FourBarRatios:
    """Find the four-bar with the best transmission angle that passes through two pairs, over all ratios l4/l1."""

    def badness(ratios: Any) -> Any:
        four_bars = four_bars_of_ratios(task, ratios)
        rating = rate_four_bars(four_bars, task)
        return np.where(
            are_real(four_bars), np.where(rating.defect != "", 4.0, 2.0 * rating.reversed) - rating.least, 9.0
        )

    values = badness(RATIOS)
    k = int(np.argmin(values))
    best = RATIOS[k]
    low, high = (RATIOS[min(max(k + step, 0), len(RATIOS) - 1)] for step in (-1, 1))
    if low * high > 0:
        place, value = find_minima(badness, low, high)
        best = place if value <= values[k] else best
    return four_bars_of_ratios(task, np.array([best]))


def are_real(four_bars: FourBarRatios) -> Any:
    """Return True for each four-bar that exists and whose link lengths are neither zero nor infinite."""
    numbers = np.stack([np.asarray(x, dtype=float) for x in four_bars])
    lengths = numbers[:3]
    with np.errstate(all="ignore"):
        return np.isfinite(numbers).all(0) & (lengths > SHORT).all(0) & (lengths < LONG).all(0)


def are_admissible(task: AnglePairsTask, four_bars: FourBarRatios) -> Any:
    """Return True for each four-bar that the task accepts.

    It must have the required transmission angle, and no defects unless the task accepts them.
    """
    rating = rate_four_bars(four_bars, task)
    enough = rating.least >= (task.transmission or 0.0) - AT_BOUND
    return ((rating.defect == "") | task.keep) & enough


def bounds_reached(task: AnglePairsTask, four_bar: FourBarRatios) -> tuple[bool, bool]:
    """Return two truth values: whether a fitted four-bar lies at the bound of its ratio of links, and at that of its
    transmission angle.
    """
    lengths = np.array([*(float(x) for x in four_bar[:3]), 1.0])
    least = float(rate_four_bars(four_bar, task).least)
    ratio = float(lengths.max() / lengths.min())
    return ratio > task.link_ratio * (1 - AT_BOUND), abs(least - max(LEAST_USABLE, task.transmission or 0)) < AT_BOUND


def choose_four_bar(task: AnglePairsTask, four_bars: FourBarRatios) -> int:
    """Return the index of the four-bar that the task selects.

    At least one four-bar must be without defects, unless the task accepts defects.
    """
    if task.choose.isdigit():
        return int(task.choose) - 1
    rating = rate_four_bars(four_bars, task)
    crank = rating.crank & (task.choose == "crank")
    admissible = np.flatnonzero(are_admissible(task, four_bars))
    if task.approximate and task.choose != "transmission":  # the least error comes first
        return int(max(admissible, key=lambda k: (rating.defect[k] == "", crank[k], -k)))
    return int(
        max(admissible, key=lambda k: (rating.defect[k] == "", crank[k], not rating.reversed[k], rating.least[k]))
    )
