"""Four-bars through 2 to 5 pairs of angles, what each is worth, and which of them is taken."""

from __future__ import annotations

from collections.abc import Sequence
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
_POSITIVE: Final = np.geomspace(1 / LONGEST, LONGEST, SCAN // 2)
RATIOS: Final = np.concatenate([-_POSITIVE[::-1], _POSITIVE])  # their l4/l1, negative for a crank the other way
DEAD: Final = 4e-15  # of the terms of the cosine of a transmission angle: what is so near to 1 is rounding
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
    """Of one four-bar, or of many (arrays): the least transmission angle (rad) over the range and the input angle there
    (from AD), the defect ("", locks, branch), whether the input turns fully, whether a link is the other way than its
    given zero says.
    """

    least: Any
    worst: Any
    defect: Any
    crank: Any
    reversed: Any

    def __getitem__(self, at: Any) -> Quality:
        return Quality(*(value[at] for value in vars(self).values()))


@dataclass(frozen=True)
class Many:
    """Tasks alike but for their angles (rad; (tasks, pairs), span (tasks, 2), zeros (tasks,) or None: to find) and for
    the ratio of two lengths, with two pairs: row . (p, q, s) = value, (tasks, 3) and (tasks,).
    """

    phi: Any
    psi: Any
    span: Any
    phi0: Any
    psi0: Any
    row: Any = None
    value: Any = None

    def __getitem__(self, at: Any) -> Many:
        return Many(*(None if value is None else value[at] for value in vars(self).values()))


def many(tasks: Sequence[Asked]) -> Many:
    """The same tasks as arrays."""
    phi, psi = (np.array([getattr(task, name) for task in tasks], freudenstein.EXACT) for name in ("phi", "psi"))
    span = np.array([task.span for task in tasks], dtype=float)
    zeros = (
        None if getattr(tasks[0], name) is None else np.array([getattr(task, name) for task in tasks])
        for name in ("phi0", "psi0")
    )
    found = Many(phi, psi, span, *zeros)
    if len(tasks[0].lengths) < 2:
        return found
    a, b = sorted(tasks[0].lengths)
    ratio = np.array([task.lengths[b] / task.lengths[a] for task in tasks])
    zero, one = np.zeros_like(ratio), np.ones_like(ratio)
    row = (one, -ratio, zero) if b == "l3" else (one, zero, zero) if a == "l1" else (zero, one, zero)  # p = ratio q
    return replace(found, row=np.stack(row, axis=-1), value=zero if b == "l3" else ratio)


def qualities(found: Bars, asked: Many) -> Quality:
    """What four-bars (of a task each) are worth; BD, and with it the angle BCD, is extreme at the ends and on AD."""
    l1, l2, l3, phi0 = (np.asarray(x, dtype=float)[:, None] for x in (found.l1, found.l2, found.l3, found.phi0))
    with np.errstate(all="ignore"):
        ends = np.sort(phi0 + asked.span, axis=1)
        on_frame = np.pi * (np.ceil(ends[:, :1] / np.pi) + np.arange(3))
        places = np.concatenate([ends, np.where(on_frame <= ends[:, 1:], on_frame, ends[:, :1])], axis=1)
        cosines = (l2 * l2 + l3 * l3 - (1 + l1 * l1 - 2 * l1 * np.cos(places))) / (2 * l2 * l3)
        terms = (l2 * l2 + l3 * l3 + 1 + l1 * l1) / (2 * l2 * l3)
        k = np.argmax(np.abs(cosines), axis=1)[:, None]
        sharpest = np.take_along_axis(np.abs(cosines), k, axis=1)[:, 0]
        b, c = found[:, None].pins(asked.phi, asked.psi)
        sides = np.sign(np.asarray(((c - b) * np.conj(c - 1)).imag, dtype=float))
        branch = np.any(sides != sides[:, :1], axis=1)
        turned = np.zeros(len(k), dtype=bool)
        for given, zero in ((asked.phi0, found.phi0), (asked.psi0, found.psi0)):
            if given is not None:
                turned |= np.cos(np.asarray(given - zero, dtype=float)) < 0
    defect = np.where(branch, "branch", np.where(1 - sharpest <= DEAD * terms[:, 0], "locks", ""))
    turns = four_bar(FourBar(l1[:, 0], l2[:, 0], l3[:, 0], np.ones(len(k)))).turns[:, 0]
    worst = np.take_along_axis(places, k, axis=1)[:, 0]
    return Quality(np.arccos(np.minimum(1.0, sharpest)), worst, defect, turns, turned)


def quality(one: Bars, asked: Asked) -> Quality:
    """What one four-bar (single numbers) is worth."""
    mark = qualities(one[None], many([asked]))[0]
    return Quality(*(value.item() for value in vars(mark).values()))


def solutions(asked: Many, ratios: Any) -> Bars:
    """All four-bars (tasks, solutions) through the pairs, over l4, nan where there is no more; ratios: l4/l1, negative
    for a crank drawn the other way, that are tried where two pairs leave it free.
    """
    if asked.phi.shape[1] > 2:
        return freudenstein.solutions(asked.phi, asked.psi, asked.phi0, asked.psi0)
    tasks, free = len(asked.phi), asked.row is None
    count = len(ratios) if free else 2
    each = asked[np.repeat(np.arange(tasks), count)]
    if free:
        each = replace(each, row=np.broadcast_to([1.0, 0.0, 0.0], (tasks * count, 3)), value=np.tile(ratios, tasks))
    else:  # either link may be drawn the other way
        sense = np.tile([1.0, -1.0], tasks)
        in_row = np.where(each.value == 0, sense, 1.0)
        each = replace(each, row=each.row * np.stack([sense**2, in_row, sense**2], -1), value=each.value * sense)
    found = _of_two(each)
    return Bars(*(value.reshape(tasks, count) for value in vars(found).values()))


def _of_two(asked: Many) -> Bars:
    phi0, psi0 = (0.0 if zero is None else zero[:, None] for zero in (asked.phi0, asked.psi0))
    phi, psi = asked.phi + phi0, asked.psi + psi0
    values = freudenstein.two(phi, psi, asked.row, asked.value)
    found = freudenstein.bars(np.concatenate([values, np.zeros((len(phi), 2))], -1), phi, psi)
    given_phi, given_psi = (np.broadcast_to(zero, (len(phi), 1))[:, 0] for zero in (phi0, psi0))
    return replace(found, phi0=found.phi0 + given_phi, psi0=found.psi0 + given_psi)


def through(asked: Asked) -> list[Bars]:
    """All four-bars that are found for the task, over l4; the best of those whose ratio l4/l1 is free."""
    if len(asked.phi) > 2 and (one := parallelogram(asked.phi, asked.psi, asked.phi0, asked.psi0)) is not None:
        return [one]
    if len(asked.phi) == 2 and len(asked.lengths) == 1:
        return _best_of_two(asked)
    found = solutions(many([asked]), None)
    return [found[0, k] for k in range(found.l1.shape[1]) if real(found[0, k])]


def of_ratio(asked: Asked, ratio: float) -> Bars:
    """The four-bar through two pairs with l4/l1 = |ratio|; a negative one is a crank drawn the other way."""
    return solutions(many([asked]), np.array([ratio]))[0, 0]


def _best_of_two(asked: Asked) -> list[Bars]:
    """The four-bar of best transmission through two pairs, l1/l4 being free."""
    one = many([asked])

    def badness(ratios: Any) -> Any:
        found = solutions(one, ratios)[0]
        mark = qualities(found, one[np.zeros(len(ratios), dtype=int)])
        return np.where(real(found), np.where(mark.defect != "", 4.0, 2.0 * mark.reversed) - mark.least, 9.0)

    values = badness(RATIOS)
    k = int(np.argmin(values))
    best = RATIOS[k]
    low, high = (RATIOS[min(max(k + step, 0), len(RATIOS) - 1)] for step in (-1, 1))
    if low * high > 0:
        place, value = least(badness, low, high)
        best = place if value <= values[k] else best
    found = of_ratio(asked, best)
    return [found] if real(found) else []


def real(found: Bars) -> Any:
    """Whether there is such a four-bar, with links neither infinite nor of no length."""
    numbers = np.stack([np.asarray(x, dtype=float) for x in vars(found).values()])
    lengths = numbers[:3]
    with np.errstate(all="ignore"):
        return (np.isfinite(numbers).all(0) & (lengths > SHORT).all(0) & (lengths < LONG).all(0))[()]


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
