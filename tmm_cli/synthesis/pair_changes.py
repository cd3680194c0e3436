"""Changes of one number of a task of pairs of angles, and what four-bars there are with each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.pairs import RATIOS, Asked, many, qualities, quality, real, solutions
from tmm_cli.synthesis.parallelogram import parallelogram

STEP: Final = np.radians(0.25)  # by which an angle is changed for the nearest task,
WIDEST: Final = np.radians(60)  # and how far;
COARSE: Final = np.radians(1)  # so with two pairs, where one of so many
FEW: Final = 14  # of the four-bars through each is looked at then
SHARE: Final = 0.02  # by which a length, or all output angles, are changed, and
TIMES: Final = 100.0  # how far;
FACTOR: Final = 5.0  # so the steps of all output angles
WHEELS: Final = (0.25, 0.5, 0.75, 1.25, 1.5, 2.0, 3.0, -0.25, -0.5, -0.75, -1.0, -1.5, -2.0)  # ratios of steps
LINKS: Final = 50.0  # the longest link over the shortest of a four-bar that is worth while


@dataclass(frozen=True)
class Change:
    """Of the number at `key` of the block. given: in SI, rad; task: what is asked with the change (of lengths: of the
    logarithm), None where it cannot be; step, count: which changes are tried on either side; all: of a change of all
    output angles, what they are then; pairs: how many there are.
    """

    key: tuple[str | int, ...]
    words: str
    kind: str
    given: float
    task: Callable[[float], Asked | None]
    step: float = STEP
    count: int = round(WIDEST / STEP)
    all: Callable[[float], tuple[float, ...]] | None = None
    pairs: int = 2

    def value(self, move: Any) -> Any:
        """The number that a change makes."""
        return self.given * np.exp(move) if self.kind == "length" else self.given + move

    def move(self, value: Any) -> Any:
        """The change that makes a number."""
        return np.log(value / self.given) if self.kind == "length" else value - self.given


@dataclass(frozen=True)
class Fit:
    """Of many changes (arrays): whether there is a four-bar without defects, whether the links of the best are of
    sensible length too, and its least transmission angle (rad)."""

    good: Any
    sensible: Any
    least: Any


def fit(change: Change, moves: Any, closely: bool = False) -> Fit:
    """What the changes are worth; closely: with all four-bars looked at among which the task itself seeks the best."""
    tasks = [change.task(float(move)) for move in moves]
    here = [k for k, task in enumerate(tasks) if task is not None]
    found = Fit(*(np.zeros(len(tasks), dtype=kind) for kind in (bool, bool, float)))
    if here:
        own = _fit([task for task in tasks if task is not None], closely)
        for name, values in vars(own).items():
            getattr(found, name)[here] = values
    return found


def _fit(tasks: list[Asked], closely: bool) -> Fit:
    given = many(tasks)
    found = solutions(given, RATIOS if closely else RATIOS[::FEW])
    count, roots = found.l1.shape
    flat = Bars(*(np.asarray(value).ravel() for value in vars(found).values()))
    mark = qualities(flat, given[np.repeat(np.arange(count), roots)])
    with_crank = tasks[0].choose == "crank"
    worth = 4.0 * (with_crank & mark.crank) + 2.0 * ~mark.reversed + mark.least / np.pi  # as `chosen` orders them
    fair = real(flat) & ((mark.defect == "") | tasks[0].keep)
    worth = np.where(fair, worth + 8.0 * (mark.defect == ""), -1.0).reshape(count, roots)
    best = np.arange(count), np.argmax(worth, axis=1)
    good, least, taken = worth[best] >= 0, mark.least.reshape(count, roots)[best], found[best]
    links = np.stack([np.ones(count), *(np.asarray(x, dtype=float) for x in (taken.l1, taken.l2, taken.l3))])
    sensible = good & (np.max(links, axis=0) <= LINKS * np.min(links, axis=0))
    for k, task in enumerate(tasks):
        if (any_one := parallelogram(task.phi, task.psi, task.phi0, task.psi0)) is not None:
            own = quality(any_one, task)
            good[k] = sensible[k] = task.keep or not own.defect
            least[k] = own.least
    return Fit(good, sensible, least)


def numbers(asked: Asked, widest: float = WIDEST) -> Iterator[Change]:
    """Changes of single angles: of the last output, of the others, of inputs, of zero angles that are given."""
    step = COARSE if len(asked.phi) == 2 else STEP
    size: dict[str, Any] = {"step": step, "count": round(widest / step), "pairs": len(asked.phi)}
    for name, key in (("psi", "output"), ("phi", "input")):
        ends = getattr(asked.function, name) if asked.function else getattr(asked, name)
        for which in range(len(ends))[::-1]:
            place = (key, which) if asked.function else ("pairs", which, int(key == "input"))
            word = f"first_{key}" if asked.function else f"{key}_{which + 1}"
            word = f"last_{key}" if which == len(ends) - 1 else word
            yield Change(place, word, "angle", float(ends[which]), partial(_moved, asked, name, which), **size)
    for name in ("psi0", "phi0"):
        if (zero := getattr(asked, name)) is not None:
            yield Change((name,), name, "angle", float(zero), partial(_turned, asked, name), **size)


def _moved(asked: Asked, name: str, which: int, move: float) -> Asked | None:
    """One angle changed; None where the input does not go on the same way, less than a turn."""

    def changed(row: Any) -> Any:
        return (*row[:which], row[which] + move, *row[which + 1 :])

    if asked.function:
        function = replace(asked.function, **{name: changed(getattr(asked.function, name))})
        swing, own = (ends[1] - ends[0] for ends in (getattr(function, name), getattr(asked.function, name)))
        if not (swing * own > 0 and abs(swing) < 2 * np.pi):
            return None
        phi, psi = function.precision(len(asked.phi))
        return replace(asked, function=function, phi=tuple(phi), psi=tuple(psi))
    row = changed(getattr(asked, name))
    if name == "phi":
        steps = np.diff(np.asarray(row, dtype=float))
        if not (np.all(steps > 0) or np.all(steps < 0)) or abs(np.sum(steps)) >= 2 * np.pi:
            return None
    return replace(asked, **{name: row})


def _turned(asked: Asked, name: str, move: float) -> Asked:
    return replace(asked, **{name: getattr(asked, name) + move})


def length(asked: Asked) -> Change:
    """The second of two lengths, with two pairs."""
    name = list(asked.lengths)[-1]

    def task(share: float) -> Asked:
        return replace(asked, lengths=asked.lengths | {name: asked.lengths[name] * float(np.exp(share))})

    return Change((name,), name, "length", float(asked.lengths[name]), task, SHARE, round(np.log(TIMES) / SHARE))


def together(asked: Asked) -> Iterator[Change]:
    """Changes of all output angles of pairs: of their steps from the first one, and towards steps in a ratio to those
    of the input, nearly as a wheel would make them; most four-bars are near to that.
    """
    psi, phi = (np.asarray(row, dtype=float) for row in (asked.psi, asked.phi))

    def change(end: Any, most: float) -> Change:
        def angles(move: float) -> tuple[float, ...]:
            return tuple((psi + move * (end - psi)).tolist())

        def task(move: float) -> Asked | None:
            return replace(asked, psi=angles(move)) if 0 < move < most else None

        return Change(("pairs",), "all", "number", 0.0, task, SHARE, round(most / SHARE), angles, len(psi))

    yield change(np.full_like(psi, psi[0]), 1.0)
    yield change(2 * psi - psi[0], FACTOR - 1)
    for ratio in WHEELS:
        yield change(ratio * phi + np.mean(psi - ratio * phi), 1.0)


def fewer_points(asked: Asked) -> int | None:
    """The most precision points of a function, fewer than are asked, with which there is a sound four-bar."""
    return next((len(task.phi) for task in with_fewer(asked) if _fit([task], True).sensible[0]), None)


def with_fewer(asked: Asked) -> Iterator[Asked]:
    """The same function with fewer and fewer precision points, down to two."""
    assert asked.function
    for count in range(len(asked.phi) - 1, 1, -1):
        phi, psi = asked.function.precision(count)
        zeros: dict[str, Any] = {"psi0": asked.psi0, "phi0": asked.phi0}
        for name in ("psi0", "phi0")[: 5 - max(count, 3)]:  # as they are taken where they are not given
            if zeros[name] is None and not (count == 4 and any(zero is not None for zero in zeros.values())):
                zeros[name] = 0.0
        yield replace(asked, phi=tuple(phi), psi=tuple(psi), **zeros)
