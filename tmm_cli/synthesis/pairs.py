"""Four-bars through 2 to 5 pairs of angles, what each is worth, and which of them is taken."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from tmm_cli.roots import least
from tmm_cli.synthesis import freudenstein
from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.functions import Function
from tmm_cli.synthesis.grashof import FourBar, four_bar
from tmm_cli.synthesis.parallelogram import parallelogram

SCAN: Final = 1500  # four-bars through two pairs that are compared, and
LONGEST: Final = 10.0  # the largest l1/l4 or l4/l1 of them
SHORT, LONG = 1e-6, 1e6  # lengths over l4 that still make a four-bar


@dataclass(frozen=True)
class Asked:
    """Given angles (rad); lengths (m) by name: one, or two of l1, l3, l4 with two pairs; zero angles, None: to find.

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


@dataclass(frozen=True)
class Quality:
    """Of one four-bar: its least transmission angle (rad) over the range and the input angle there (from AD), its
    defect ("", locks, branch), whether its input turns fully, whether a link is the other way than its given zero says.
    """

    least: float
    worst: float
    defect: str
    crank: bool
    reversed: bool


def quality(one: Bars, asked: Asked) -> Quality:
    """What one four-bar (single numbers) is worth; BD, and with it the angle BCD, is extreme at the ends and on AD."""
    l1, l2, l3, phi0 = (float(x) for x in (one.l1, one.l2, one.l3, one.phi0))
    low, high = sorted((phi0 + asked.span[0], phi0 + asked.span[1]))
    places = np.array([low, high, *(np.pi * np.arange(np.ceil(low / np.pi), np.floor(high / np.pi) + 1))])
    cosines = (l2 * l2 + l3 * l3 - (1 + l1 * l1 - 2 * l1 * np.cos(places))) / (2 * l2 * l3)
    k = int(np.argmax(np.abs(cosines)))
    angle = float(np.arccos(min(1.0, abs(cosines[k]))))
    b, c = one.pins(np.asarray(asked.phi), np.asarray(asked.psi))
    sides = np.sign(np.asarray(((c - b) * np.conj(c - 1)).imag, dtype=float))
    defect = "branch" if len(set(sides.tolist())) > 1 else "locks" if abs(cosines[k]) >= 1 else ""
    turns = four_bar(FourBar(l1, l2, l3, 1.0)).turns[0]
    zeros = ((asked.phi0, one.phi0), (asked.psi0, one.psi0))
    turned = any(given is not None and np.cos(float(found) - float(given)) < 0 for given, found in zeros)
    return Quality(angle, float(places[k]), defect, bool(turns), turned)


def through(asked: Asked, scan: int = SCAN) -> list[Bars]:
    """All four-bars that are found for the task, over l4; scan: how many are compared where one length is free."""
    if len(asked.phi) > 2:
        if (one := parallelogram(asked.phi, asked.psi, asked.phi0, asked.psi0)) is not None:
            return [one]
        found = freudenstein.solutions([asked.phi], [asked.psi], asked.phi0, asked.psi0)
        return [found[0, k] for k in range(found.l1.shape[1]) if real(found[0, k])]
    phi, psi = (np.asarray([row], freudenstein.EXACT) for row in (asked.phi, asked.psi))
    phi, psi = phi + (asked.phi0 or 0.0), psi + (asked.psi0 or 0.0)
    lengths = asked.lengths
    if len(lengths) == 2:
        a, b = sorted(lengths)
        ways = []
        for ratio in (lengths[b] / lengths[a], -lengths[b] / lengths[a]):
            row = [1.0, -ratio, 0] if b == "l3" else [1.0, 0, 0] if a == "l1" else [0, 1.0, 0]  # p = ratio q, p, or q
            ways.append(_of_two(phi, psi, np.array([row]), np.array([0.0 if b == "l3" else ratio]), asked))
        return [one for one in ways if real(one)]
    return _best_of_two(asked, scan)


def _of_two(phi: Any, psi: Any, row: Any, value: Any, asked: Asked) -> Bars:
    values = freudenstein.two(phi, psi, row, value)
    zero = np.zeros((1, 2), freudenstein.EXACT)
    found = freudenstein.bars(np.concatenate([values, zero], -1), phi, psi)[0]
    return replace(found, phi0=found.phi0 + (asked.phi0 or 0.0), psi0=found.psi0 + (asked.psi0 or 0.0))


def of_ratio(asked: Asked, ratio: float) -> Bars:
    """The four-bar through two pairs with l4/l1 = |ratio|; a negative one is a crank drawn the other way."""
    phi, psi = (np.asarray([row], freudenstein.EXACT) for row in (asked.phi, asked.psi))
    return _of_two(
        phi + (asked.phi0 or 0.0), psi + (asked.psi0 or 0.0), np.array([[1.0, 0, 0]]), np.array([ratio]), asked
    )


def _best_of_two(asked: Asked, scan: int) -> list[Bars]:
    """The four-bar of best transmission through two pairs, l1/l4 being free."""

    def badness(p: float) -> float:
        one = of_ratio(asked, p)
        if not real(one):
            return 9.0
        q = quality(one, asked)
        return (4.0 if q.defect else 2.0 if q.reversed else 0.0) - q.least

    tried = np.geomspace(1 / LONGEST, LONGEST, scan // 2)
    tried = np.concatenate([-tried[::-1], tried])
    values = np.array([badness(p) for p in tried])
    k = int(np.argmin(values))
    low, high = (tried[min(max(k + step, 0), len(tried) - 1)] for step in (-1, 1))
    if low * high > 0:
        best, value = least(lambda ps: np.array([badness(p) for p in ps]), low, high)
        if value <= values[k]:
            return [of_ratio(asked, best)]
    one = of_ratio(asked, tried[k])
    return [one] if real(one) else []


def real(one: Bars) -> bool:
    """Whether there is such a four-bar, with links neither infinite nor of no length."""
    numbers = np.array([float(x) for x in vars(one).values()])
    return bool(np.all(np.isfinite(numbers)) and np.all(numbers[:3] > SHORT) and np.all(numbers[:3] < LONG))


def chosen(asked: Asked, found: list[Bars]) -> int:
    """Which of the four-bars is taken, -1: none has no defect."""
    marks = [quality(one, asked) for one in found]
    if asked.choose.isdigit():
        return int(asked.choose) - 1
    fair = [k for k, mark in enumerate(marks) if asked.keep or not mark.defect]
    if not fair:
        return -1
    with_crank = asked.choose == "crank"
    return max(fair, key=lambda k: (
        not marks[k].defect, with_crank and marks[k].crank, not marks[k].reversed, marks[k].least))  # fmt: skip
