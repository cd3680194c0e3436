"""Why no four-bar passes some pairs of angles in order, and the nearest change with which one does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import Final

import numpy as np

from tmm_cli.synthesis import freudenstein
from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.pair_changes import (
    LINKS,
    WIDEST,
    Change,
    fewer_points,
    fit,
    length,
    numbers,
    together,
    with_fewer,
)
from tmm_cli.synthesis.pairs import LONG, Asked, quality
from tmm_cli.synthesis.record import Infeasible, Shown

W: Final = "synthesis_four_bar_by_angles"
FIRST: Final = (0.1, 0.4)  # of all changes, which are tried before the others
PARTS: Final = (8, 24)  # into which the way to the nearest change is divided again and again, with two pairs, with more
FINER: Final = 25  # times, with more than two pairs, are the changes tried again that are nearer than one that will do
SHARP: Final = 0.01  # of INWARDS: how near to the nearest change that leads
INWARDS: Final = 2e-6  # rad, or a share of a length, from where there is one first;
INWARDS_ALL: Final = 1e-4  # of a change of all output angles, each of which is rounded
ROUNDED: Final = 2e-5  # of a number: by so much it may be rounded when it is told
BEYOND: Final = 1e-7  # a change so much less is refused, or its links are too long
USABLE: Final = np.radians(30)  # a transmission angle that will do: at a limit the four-bar is all but dead
NEARLY: Final = 0.9  # of the best transmission angle there is: what is told where none will do
TRIED: Final = 120  # changes farther inside that are looked at for that
DEGREE: Final = np.radians(1)


def refuse_found(asked: Asked, found: list[Bars]) -> None:
    """None of what was found is any good: raises Infeasible, with the nearest single number that helps."""
    defects = {quality(one, asked).defect for one in found}
    if found:
        reason = "all_both" if len(defects) > 1 else "all_branch" if defects == {"branch"} else "all_locks"
    else:
        reason = "endless" if _endless(asked) else "none"
    alone = "" if found else "_alone"
    last: tuple[str | int, ...] = ("output",) if asked.function else ("pairs", len(asked.psi) - 1)
    changes = [length(asked)] if len(asked.lengths) == 2 else []
    near = _first(chain(changes, numbers(asked)))
    if near is None and asked.function and (count := fewer_points(asked)):
        raise Infeasible("output", f"{W}.{reason}", f"{W}.points_fewer{alone}", {"count": (str(count), "word")})
    if near is None and asked.function:
        near = _first(numbers(asked, 2 * WIDEST))
    points = ""
    if near is None and asked.function:  # fewer points and one angle
        fewer = ((task, _first(numbers(task))) for task in with_fewer(asked))
        task, near = next((one for one in fewer if one[1] is not None), (asked, None))
        points = str(len(task.phi))
    if near is not None:
        change, move = near
        words, values = _told(change, move)
        if points:
            words, values = f"points_{words}", values | {"count": (points, "word")}
        key = (
            last if len(change.key) == 1 and change.kind == "angle" else change.key[: len(last)]
        )  # a zero is not given
        raise Infeasible(key, f"{W}.{reason}", f"{W}.{words}{alone}", values)
    if not asked.function and (values := _together(asked)):
        raise Infeasible("pairs", f"{W}.{reason}", f"{W}.all_{len(asked.psi)}{alone}", values)
    raise Infeasible(last, f"{W}.{reason}", f"{W}.other{alone}")


def refuse_inputs(asked: Asked, which: Sequence[int], error: Infeasible) -> None:
    """The input does not go on one way, less than a turn: raises the error, with the nearest of these input angles (of
    a function: of its ends) with which it does, and a sound four-bar passes.
    """
    inputs = [change for change in numbers(asked, np.pi) if "input" in change.words and change.key[1] in which]
    near = [found for change in inputs if (found := _first([change])) is not None]
    if not near:
        raise error
    words, values = _told(*min(near, key=lambda one: abs(one[1])))
    raise Infeasible(error.path, error.reason, f"{W}.{words}_alone", values | error.values)


def _first(changes: Iterable[Change]) -> tuple[Change, float] | None:
    """The first number that helps, and its least change."""
    return next(((change, move) for change in changes for move in _nearest(change)), None)


def _together(asked: Asked) -> dict[str, Shown]:
    """All output angles, by the change of them all that moves none of them far; {}: there is none."""
    near = [(change, next(_nearest(change), None)) for change in together(asked)]
    found = [change.all(move) for change, move in near if change.all is not None and move is not None]
    if not found:
        return {}
    moves = [max(abs(a - float(b)) for a, b in zip(psi, asked.psi, strict=True)) for psi in found]
    best = int(np.argmin(moves))
    return {f"psi{k + 1}": (psi, "angle") for k, psi in enumerate(found[best])} | {"most": (moves[best], "angle")}


def _endless(asked: Asked) -> bool:
    """Whether four-bars pass the pairs whose links are infinitely long beside the frame."""
    if len(asked.phi) < 3:
        return False
    found = freudenstein.solutions([asked.phi], [asked.psi], asked.phi0, asked.psi0)
    lengths = np.stack([np.asarray(x, dtype=float) for x in (found.l1, found.l2, found.l3)])
    return bool(np.any(np.isfinite(lengths) & (lengths >= LONG)))


def _nearest(change: Change) -> Iterator[float]:
    """Changes from which on there is a sound four-bar, the nearest first; it stays sound as the number is rounded."""
    for near in _scanned(change, change.step, change.count):
        if change.pairs > 2 and change.all is None:  # nearer ones may have been stepped over
            finer = change.step / FINER
            yield from _scanned(change, finer, int(abs(near) / finer))
        yield near


def _scanned(change: Change, step: float, count: int) -> Iterator[float]:
    """The same among so many changes in such steps on either side."""
    sizes, inside = step * np.arange(1, count + 1), {1.0: False, -1.0: False}
    for some in np.split(sizes, [round(share * count) for share in FIRST]):
        moves = np.stack([some, -some], axis=-1).ravel()
        for move, here in zip(moves.tolist(), fit(change, moves).sensible.tolist(), strict=True):
            sign = float(np.sign(move))
            if here and not inside[sign]:
                near = _edge(change, move, move - sign * step) + sign * _inwards(change)
                rounded = near + sign * ROUNDED * (abs(change.value(near)) if change.kind == "angle" else 1.0)
                if np.all(fit(change, [near, (near + rounded) / 2, rounded], closely=True).sensible):
                    yield near
            inside[sign] = here


def _inwards(change: Change) -> float:
    return INWARDS if change.all is None else INWARDS_ALL


def _edge(change: Change, inside: float, outside: float) -> float:
    """Where what is good inside begins."""
    parts = PARTS[change.pairs > 2]
    for _ in range(int(np.ceil(np.log(change.step / (SHARP * _inwards(change))) / np.log(parts)))):
        places = np.linspace(outside, inside, parts + 1)
        good = fit(change, places[1:-1], closely=True).sensible
        last = int(np.flatnonzero([True, *~good])[-1])
        outside, inside = places[last], places[last + 1]
    return float(inside)


def _told(change: Change, near: float) -> tuple[str, dict[str, Shown]]:
    """The key of the words of a change, and its numbers."""
    sign = float(np.sign(near))
    values: dict[str, Shown] = {
        "value": (change.value(near), change.kind, "least" if sign > 0 else "most"), "links": (f"{LINKS:g}", "word"),
        "what": (f"{W}.what_{change.words}", "said"),
    }  # fmt: skip
    words = "nearest"
    if change.kind == "length":
        words = "nearest_more" if sign > 0 else "nearest_less"
    long = bool(fit(change, [near - sign * (INWARDS + BEYOND)], closely=True).good[0])
    usable = _usable(change, near)
    if usable is not None:
        values |= {"usable": (usable[0], change.kind), "transmission": (usable[1], "angle")}
    return words + ("_long" if long else "") + ("_usable" if usable else ""), values


def _usable(change: Change, near: float) -> tuple[float, float] | None:
    """A plain number beyond the limit with a transmission angle that will do, or nearly the best one, and that angle
    (rad) in whole degrees; None where the limit itself is as good.
    """
    sign, limit = float(np.sign(near)), change.value(near)
    if change.kind == "angle":
        values = DEGREE * sign * (np.ceil(sign * limit / DEGREE) + np.arange(TRIED)) + 0.0  # none of them is -0
    else:
        values = np.array([float(f"{x:.3g}") for x in limit * np.exp(sign * change.step * np.arange(1, TRIED))])
    moves = change.move(values)
    moves = moves[np.abs(moves) <= change.step * change.count]
    found, own = fit(change, moves), float(fit(change, [near], closely=True).least[0])
    if not np.any(found.sensible):
        return None
    enough = min(USABLE, NEARLY * float(np.max(found.least[found.sensible])))
    k = int(np.argmax(found.sensible & (found.least >= enough)))
    told = DEGREE * np.floor(found.least[k] / DEGREE)
    return (float(values[k]), float(told)) if told > own + DEGREE / 2 and own < USABLE else None
