"""Why no four-bar passes pairs of angles in order, and the nearest value of one given number with which one does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final, NoReturn

import numpy as np

from tmm_cli.errors import _
from tmm_cli.synthesis.four_bar_by_angles import freudenstein
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars
from tmm_cli.synthesis.four_bar_by_angles.pairs import LONG, Task, chosen, quality, through
from tmm_cli.synthesis.nearest import Number, nearest
from tmm_cli.synthesis.record import Infeasible

REACH: Final = np.radians(60)  # of other angles that are tried
TIMES: Final = 20.0  # of other lengths, over the given one
NO_NUMBER: Final = _("other angles; no single number, changed alone, helps")
NO_NUMBER_OR_KEEP: Final = _("other angles, or defects: keep; no single number, changed alone, helps")
LINKS: Final = 50.0  # the longest link over the shortest of a four-bar that is worth while


def refuse_found(task: Task, found: Bars) -> NoReturn:
    """None of what was found is any good: raises Infeasible."""
    key: tuple[str | int, ...] = ("output",) if task.function else ("pairs", len(task.psi) - 1)
    values = next((row for number in _numbers(task) if (row := nearest([number], solved))), None)
    text = _("{name} {value}") if values else NO_NUMBER
    if found.size:
        text = _("{name} {value}; or defects: keep") if values else NO_NUMBER_OR_KEEP
    raise Infeasible(key, _reason(task, found), text, values)


def refuse_inputs(task: Task, key: tuple[str | int, ...], reason: str, which: tuple[int, int]) -> NoReturn:
    """The input does not go on one way, or comes round: raises Infeasible with one of these two input angles (of a
    function: of its ends) with which it does, and a sound four-bar passes."""
    values = nearest([_angle(task, "phi", number, np.pi) for number in which], solved)
    text = _("input angles that only grow, or only fall, by less than a turn in all")
    raise Infeasible(key, reason, _("{name} {value}") if values else text, values)


def solved(task: Task) -> bool:
    """Whether the task has a solution with links of sensible length."""
    found = through(task)
    at = chosen(task, found)
    if not 0 <= at < found.size:
        return False
    one = found.at(at)
    links = np.array([1.0, *map(float, one[:3])])
    return bool(np.max(links) <= LINKS * np.min(links)) and (task.keep or not quality(one, task).defect)


def _reason(task: Task, found: Bars) -> str:
    defects = set(quality(found, task).defect.tolist())
    if not found.size and _endless(task):
        return _("the links of the four-bars through these pairs are infinitely long beside the frame")
    if not found.size:
        return _("no four-bar passes through these pairs")
    if len(defects) > 1:
        return _("every four-bar through these pairs has a branch defect, or its input locks on the way")
    if defects == {"branch"}:
        return _("branch defect: every four-bar through these pairs has some of them on its other assembly")
    return _("order defect: the input of every four-bar through these pairs locks on the way")


def _endless(task: Task) -> bool:
    """Whether four-bars pass the pairs whose links are infinitely long beside the frame."""
    if len(task.phi) < 3:
        return False
    found = freudenstein.solutions(task.phi, task.psi, task.phi0, task.psi0)
    lengths = np.asarray(found[:3], dtype=float)
    return bool(np.any(np.isfinite(lengths) & (lengths >= LONG)))


def _numbers(task: Task) -> Iterator[Number]:
    """The second of two lengths; angles, outputs first and the last of them first; zero angles that are given."""
    if len(task.lengths) == 2:
        key = list(task.lengths)[-1]
        length = task.lengths[key]

        def with_length(value: float) -> Task | None:
            return replace(task, lengths=task.lengths | {key: value}) if value > 0 else None

        yield Number(key, "length", length, TIMES * length, with_length)
    for name in ("psi", "phi"):
        ends = getattr(task.function, name) if task.function else getattr(task, name)
        yield from (_angle(task, name, which, REACH) for which in reversed(range(len(ends))))
    for name in ("psi0", "phi0"):
        if (zero := getattr(task, name)) is not None:
            yield Number(name, "angle", float(zero), REACH, partial(_with_zero, task, name))


def _with_zero(task: Task, name: str, value: Any) -> Task:
    return replace(task, **{name: value})


def _angle(task: Task, name: str, which: int, reach: float) -> Number:
    """One input or output angle, of a function one end of its range."""
    given = getattr(task.function, name) if task.function else getattr(task, name)
    if which in (0, len(given) - 1):
        words = {
            ("phi", True): _("the first input angle"), ("psi", True): _("the first output angle"),
            ("phi", False): _("the last input angle"), ("psi", False): _("the last output angle"),
        }[name, which == 0]  # fmt: skip
    else:
        text = _("input angle {number}:") if name == "phi" else _("output angle {number}:")
        words = text.format(number=which + 1)

    def changed(value: float) -> Task | None:
        row: Any = (*given[:which], value, *given[which + 1 :])
        found = of_function(task, name, row) if task.function else replace(task, **{name: row})
        return found if in_order(found) else None

    return Number(words, "angle", float(given[which]), reach, changed)


def of_function(task: Task, name: str, ends: Any) -> Task:
    """The same with another range of the input (phi) or the output (psi) of its function."""
    assert task.function
    function = replace(task.function, **{name: ends})
    with np.errstate(all="ignore"):
        phi, psi = function.precision(len(task.phi))
    return replace(task, function=function, phi=tuple(phi), psi=tuple(psi))


def in_order(task: Task) -> bool:
    """Whether the input only grows, or only falls, by less than a turn."""
    steps = np.diff(np.asarray(task.phi, dtype=float))
    return bool(np.all(steps > 0) or np.all(steps < 0)) and abs(task.span[1] - task.span[0]) < 2 * np.pi
