"""A function that a linkage is to generate: turned into angles, and its precision points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.numerics import DEAD_COSINE_DOUBLE, PI, least
from tmm_cli.synthesis.four_bar import FourBar, sharpest, turning
from tmm_cli.synthesis.four_bar_by_angles import freudenstein, freudenstein as least_squares
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import EXACT, Bars, parallelogram

FUNCTIONS: Final[Mapping[str, Callable[[Any], Any]]] = {
    "log10(x)": np.log10,
    "ln(x)": np.log,
    "exp(x)": np.exp,
    "sqrt(x)": np.sqrt,
    "1/x": np.reciprocal,
    "x^2": np.square,
    "x^3": lambda x: x * x * x,
    "x^1.5": lambda x: x * np.sqrt(x),
    "sin(x)": np.sin,
    "cos(x)": np.cos,
    "tan(x)": np.tan,
}
ANGLES: Final = ("sin(x)", "cos(x)", "tan(x)")  # their x is an angle


@dataclass(frozen=True)
class Function:
    """y(x), straight between the rows of its table, from x[0] to x[1]; input, output: angles (rad) at these ends."""

    x: tuple[float, float]
    phi: tuple[float, float]
    psi: tuple[float, float]
    name: str = ""
    table: tuple[tuple[float, float], ...] = ()

    def value(self, x: Any) -> Any:
        if self.name:
            return FUNCTIONS[self.name](x)
        rows = np.asarray(self.table, dtype=float)
        return np.interp(np.asarray(x, dtype=float), rows[:, 0], rows[:, 1])

    def wanted(self, phi: Any) -> Any:
        """The output angle for an input angle."""
        start, end = self.value(np.asarray(self.x[0])), self.value(np.asarray(self.x[1]))
        x = self.x[0] + (phi - self.phi[0]) / (self.phi[1] - self.phi[0]) * (self.x[1] - self.x[0])
        return self.psi[0] + (self.value(x) - start) / (end - start) * (self.psi[1] - self.psi[0])

    def corners(self) -> Any:
        """Input angles of the rows of the table within the range; there it may have corners."""
        x = np.asarray([row[0] for row in self.table], dtype=float)
        share = (x - float(self.x[0])) / (float(self.x[1]) - float(self.x[0]))
        share = share[(share > 0) & (share < 1)]
        return float(self.phi[0]) + share * (float(self.phi[1]) - float(self.phi[0]))

    def precision(self, count: int) -> tuple[Any, Any]:
        """Angles at the precision points: Chebyshev's spacing, x = middle - half range cos((2j - 1) pi/(2 n))."""
        turns = np.arange(1, 2 * count, 2) / np.longdouble(2 * count)
        share = ((1 - np.cos(turns * np.longdouble(PI))) / 2).astype(float)
        phi = self.phi[0] + share * (self.phi[1] - self.phi[0])
        return phi, self.wanted(phi)


# Keys of lengths and zero angles.


LENGTHS: Final = {  # that a task may give, as its ZEROS: kind and what they are called
    "l1": ("length", N_("input l1 = AB")),
    "l2": ("length", N_("coupler l2 = BC")),
    "l3": ("length", N_("output l3 = DC")),
    "l4": ("length", N_("frame l4 = AD")),
}
ZEROS: Final = {
    "phi0": ("angle", N_("phi0, zero of the input angle, from AD")),
    "psi0": ("angle", N_("psi0, zero of the output angle, from AD")),
}


# Four-bars by pairs of angles, what each is worth, and which of them is taken.


SCAN: Final = 1500  # four-bars through two pairs that are compared, and
LONGEST: Final = 10.0  # the largest l1/l4 or l4/l1 of them
_POSITIVE: Final = np.geomspace(1 / LONGEST, LONGEST, SCAN // 2)
RATIOS: Final = np.concatenate([-_POSITIVE[::-1], _POSITIVE])  # their l4/l1, negative for a crank the other way
SHORT, LONG = 1e-6, 1e6  # lengths over l4 that still make a four-bar


@dataclass(frozen=True)
class AnglePairsTask:
    """Given angles (rad); lengths (m) by name: one, or two of l1, l3, l4 with two pairs, l4 and l1 or l3 with three;
    zero angles, None: to find.

    choose: transmission, crank, or the number of a solution; keep: whether defects are put up with.
    """

    phi: tuple[float, ...]
    psi: tuple[float, ...]
    lengths: dict[str, float]
    phi0: float | None = 0.0
    psi0: float | None = 0.0
    choose: str = "transmission"
    keep: bool = False
    function: Function | None = None

    @property
    def span(self) -> tuple[float, float]:
        """First and last input angle that are used."""
        return self.function.phi if self.function else (self.phi[0], self.phi[-1])

    @property
    def free(self) -> bool:
        """Whether two pairs and one length leave l1/l4 free."""
        return len(self.phi) == 2 and len(self.lengths) == 1

    @property
    def approximate(self) -> bool:
        """Whether there are more pairs than a four-bar can pass."""
        return len(self.phi) > 3 + (self.phi0 is None) + (self.psi0 is None)


class Quality(NamedTuple):
    """Of four-bars (arrays of one shape): the least transmission angle (rad) over the range and the input angle there
    (from AD), the defect ("", locks, branch), whether the input turns fully, whether a link is the other way than its
    given zero says.
    """

    least: Any
    worst: Any
    defect: Any
    crank: Any
    reversed: Any


def quality(found: Bars, task: AnglePairsTask) -> Quality:
    """What four-bars are worth."""
    l1, l2, l3, phi0 = (np.asarray(x, dtype=float) for x in (found.l1, found.l2, found.l3, found.phi0))
    l4 = np.ones(np.shape(l1))
    with np.errstate(all="ignore"):
        ends = np.sort(phi0[..., None] + np.asarray(task.span, dtype=float), axis=-1)
        size, worst = sharpest((l1, l2, l3, l4), ends[..., 0], ends[..., 1])
        terms = (l2 * l2 + l3 * l3 + 1 + l1 * l1) / (2 * l2 * l3)
        b, c = found.at((..., None)).pins(np.asarray(task.phi, EXACT), np.asarray(task.psi, EXACT))
        sides = np.sign(np.asarray(((c - b) * np.conj(c - 1)).imag, dtype=float))
        branch = np.any(sides != sides[..., :1], axis=-1) & (not task.approximate)  # they are compared with one only
        turned = np.zeros(np.shape(branch), dtype=bool)
        for given, zero in ((task.phi0, found.phi0), (task.psi0, found.psi0)):
            if given is not None:
                turned |= np.cos(np.asarray(given - zero, dtype=float)) < 0
    defect = np.where(branch, "branch", np.where(1 - size <= DEAD_COSINE_DOUBLE * terms, "locks", ""))
    turns = turning(FourBar(l1, l2, l3, l4)).turns[..., 0]
    return Quality(np.arccos(np.minimum(1.0, size)), worst, defect[()], turns, turned)


def through(task: AnglePairsTask) -> Bars:
    """All four-bars that are found for the task, over l4; the best of those whose ratio l4/l1 is free, or of those
    that pass no pairs exactly.
    """
    if len(task.phi) == 3 and len(task.lengths) == 2:
        found = _of_circle(task)
        return found.at(real(found))
    if len(task.phi) > 2 and (one := parallelogram(task.phi, task.psi, task.phi0, task.psi0)) is not None:
        return one.at(None)
    if task.approximate:
        found, __ = least_squares.minima(task.phi, task.psi, task.phi0, task.psi0)
        found = found.at(real(found))
        return found.at(np.argsort(quality(found, task).defect != "", kind="stable")[:1])
    if task.free:
        found = _best_of_ratios(task)
    elif len(task.phi) == 2:
        found = _of_lengths(task)
    else:
        found = freudenstein.solutions(task.phi, task.psi, task.phi0, task.psi0).at(0)
    return found.at(real(found))


def of_ratios(task: AnglePairsTask, ratios: Any) -> Bars:
    """The four-bars through two pairs with l4/l1 = |ratio|; a negative one is a crank drawn the other way."""
    return _of_two(task, np.broadcast_to([1.0, 0.0, 0.0], (len(ratios), 3)), ratios)


def _of_lengths(task: AnglePairsTask) -> Bars:
    """The four-bars through two pairs with two given lengths; either link may be drawn the other way."""
    a, b = sorted(task.lengths)
    ratio, sense = task.lengths[b] / task.lengths[a], np.array([1.0, -1.0])
    one, zero = np.ones(2), np.zeros(2)
    if b == "l3":  # p = ratio q
        return _of_two(task, np.stack([one, -ratio * sense, zero], axis=-1), zero)
    return _of_two(task, np.stack([one, zero, zero] if a == "l1" else [zero, one, zero], axis=-1), ratio * sense)


def _of_circle(task: AnglePairsTask) -> Bars:
    """The four-bar through three pairs with l4 and l1 (or l3): B turned back about D by the output angles (C about A by
    the input angles) has three places, and the centre of the circle through them is C (B) with its zero angle.
    """
    phi, psi = (np.asarray(x, EXACT) + (zero or 0.0) for x, zero in ((task.phi, task.phi0), (task.psi, task.psi0)))
    by_input = "l1" in task.lengths
    own, back, base = (phi, psi, -1.0) if by_input else (psi, phi, 1.0)
    length = EXACT(task.lengths["l1" if by_input else "l3"]) / task.lengths["l4"]
    places = (base + length * np.exp(1j * own)) * np.exp(-1j * back)
    rows = np.stack([2 * places.real, 2 * places.imag, np.ones_like(phi)], axis=-1)
    x, y, __ = freudenstein.solve_linear(rows, np.abs(places) ** 2)
    found, zero, l2 = np.hypot(x, y), np.arctan2(y, x), np.abs(places[0] - x - 1j * y)
    one = (length, l2, found, task.phi0, zero) if by_input else (found, l2, length, zero, task.psi0)
    return Bars(*one).at(None)


def _of_two(task: AnglePairsTask, known: Any, value: Any) -> Bars:
    """The four-bars through two pairs with conditions known . (p, q, s) = value, (n, 3) and (n,)."""
    phi0, psi0 = task.phi0 or 0.0, task.psi0 or 0.0
    phi, psi = (
        np.broadcast_to(np.asarray(row, EXACT) + zero, (len(known), 2))
        for row, zero in ((task.phi, phi0), (task.psi, psi0))
    )
    values = freudenstein.two(phi, psi, known, value)
    found = freudenstein.bars(np.concatenate([values, np.zeros((len(phi), 2))], -1), phi, psi)
    return found._replace(phi0=found.phi0 + phi0, psi0=found.psi0 + psi0)


def _best_of_ratios(task: AnglePairsTask) -> Bars:
    """The four-bar of best transmission through two pairs, l1/l4 being free."""

    def badness(ratios: Any) -> Any:
        found = of_ratios(task, ratios)
        mark = quality(found, task)
        return np.where(real(found), np.where(mark.defect != "", 4.0, 2.0 * mark.reversed) - mark.least, 9.0)

    values = badness(RATIOS)
    k = int(np.argmin(values))
    best = RATIOS[k]
    low, high = (RATIOS[min(max(k + step, 0), len(RATIOS) - 1)] for step in (-1, 1))
    if low * high > 0:
        place, value = least(badness, low, high)
        best = place if value <= values[k] else best
    return of_ratios(task, np.array([best]))


def real(found: Bars) -> Any:
    """Whether there are such four-bars, with links neither infinite nor of no length."""
    numbers = np.stack([np.asarray(x, dtype=float) for x in found])
    lengths = numbers[:3]
    with np.errstate(all="ignore"):
        return np.isfinite(numbers).all(0) & (lengths > SHORT).all(0) & (lengths < LONG).all(0)


def chosen(task: AnglePairsTask, found: Bars) -> int:
    """Which of the four-bars is taken; one at least must have no defect, or defects be put up with."""
    if task.choose.isdigit():
        return int(task.choose) - 1
    mark = quality(found, task)
    crank = mark.crank & (task.choose == "crank")
    fair = np.flatnonzero((mark.defect == "") | task.keep)
    return int(max(fair, key=lambda k: (mark.defect[k] == "", crank[k], not mark.reversed[k], mark.least[k])))
