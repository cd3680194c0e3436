"""The nearest value of one given number with which a four-bar guides a coupler that is refused as it is given."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.synthesis.coupler_positions import dyads
from tmm_cli.synthesis.coupler_positions.burmester import Dyads
from tmm_cli.synthesis.coupler_positions.dyads import SAME, SURE, Defective, exists, guiding
from tmm_cli.synthesis.coupler_positions.search import QUICK
from tmm_cli.synthesis.coupler_positions.task import Task
from tmm_cli.synthesis.nearest import COUNT, Number, nearest
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.vectors import settled

POSITION: Final = 0.3  # how far other positions are tried: rad, or sizes of the task
SIZES: Final = 3.0  # the same of points, lengths and sides of a box
SEARCHES: Final = 150  # changes that are tried of one kind of numbers, where each takes a search on Burmester's curves
SHORT: Final = 0.005  # of the size: a frame or a coupler that is worth while


def suggested(task: Task, error: Infeasible) -> Infeasible:
    """The same refusal with the number that helps: of what is at fault, else of the links, else of the positions."""
    if (pole := _pole(task)) is not None:
        reason = _("the coupler only turns about one point: every pivot would be there")
        text = _("a hinge at [{x}, {y}] in the place of a four-bar; or positions that are no turns about one point")
        return Infeasible("positions", reason, text, {"x": (pole.real, "length"), "y": (pole.imag, "length")})
    links, positions = list(_of_links(task)), list(_of_positions(task))
    at_fault = [number for number in [*links, *_of_box(task)] if number.key == error.path[0]]
    values = None
    for numbers in (at_fault, links, positions):
        count = COUNT if _closed(task) else min(COUNT, SEARCHES // (2 * len(numbers) or 1))
        values = values or nearest(numbers, solves, count)
    keep = isinstance(error, Defective)
    if values:
        text = _("{name} {value}; or defects: keep") if keep else _("{name} {value}")
    elif keep:
        text = _("defects: keep; no single number, changed alone, helps")
    else:
        text = _("other positions or links; no single number, changed alone, helps")
    return Infeasible(error.path, error.reason, text, error.values | (values or {}))


def _closed(task: Task) -> bool:
    """Whether the task is solved without a search."""
    return len(task.places) < 4 or len(task.sides) == 2 or task.still


def solves(task: Task) -> bool:
    """Whether the task has a four-bar of sensible size; a short search may miss one, never invent it."""
    with np.errstate(all="ignore"):
        try:
            if _closed(task):
                one, other, mark = guiding(task)
                return _sensible(task, one, other) and (task.keep or bool(mark.least > SURE))
            given = dyads.given_on_curves(task)
        except Infeasible:
            return False
        for loose in (False, True)[: 1 + task.keep]:
            found = dyads.searched(task, given, loose, (QUICK,))
            if found is not None and found[2] > SURE:
                return True
    return False


def _sensible(task: Task, one: Dyads, other: Dyads) -> bool:
    gap = min(abs(one.pin - other.pin), abs(one.pivot - other.pivot))
    return bool(gap > SHORT * task.size) and bool(exists(task, one)) and bool(exists(task, other))


def _pole(task: Task) -> complex | None:
    """The point (m) about which three or four positions are turns of the coupler; None: there is none."""
    turns = np.exp(1j * (np.asarray(task.angles[1:], float) - float(task.angles[0])))
    places = np.asarray(task.places, complex)
    if len(turns) < 2 or np.min(np.abs(turns - 1)) < SAME:
        return None
    poles = (places[1:] - places[0] * turns) / (1 - turns)
    size = float(np.max(np.abs(places))) + abs(poles[0])
    return complex(settled(poles[0], size)) if np.max(np.abs(poles - poles[0])) <= SAME * size else None


def _of_links(task: Task) -> Iterator[Number]:
    """Numbers that are given of AB and DC."""
    reach = SIZES * task.size
    for name, side in task.sides.items():
        put = partial(_with_side, task, name)
        if side.turn is not None:
            key = f"{name}_turn"
            yield Number(key, "angle", float(side.turn), np.pi, partial(put, "turn"), key)
        if side.length is not None:
            yield Number(name, "length", float(side.length), reach, partial(put, "length"), name)
        for key, field in ((name[1], "pin"), (name[0], "pivot"), (f"{name[0]}_near", "near")):
            if (place := getattr(side, field)) is not None:
                yield from _coordinates(key, complex(place), reach, partial(put, field), key)


def _with_side(task: Task, name: str, field: str, value: Any) -> Task:
    return replace(task, sides={**task.sides, name: replace(task.sides[name], **{field: value})})


def _of_box(task: Task) -> Iterator[Number]:
    """Coordinates of the corners of a box for pivots."""
    if task.within is None:
        return
    one, other = task.within
    reach, key = SIZES * task.size, "pivots_within"
    yield from _coordinates(_("corner 1"), one, reach, lambda place: replace(task, within=(place, other)), key)
    yield from _coordinates(_("corner 2"), other, reach, lambda place: replace(task, within=(one, place)), key)


def _of_positions(task: Task) -> Iterator[Number]:
    """Coordinates and angles of all positions but the first."""
    for k in range(1, len(task.places)):
        name = _("position {number}").format(number=k + 1)
        place, angle = complex(task.places[k]), float(task.angles[k])
        yield from _coordinates(name, place, POSITION * task.size, partial(_with_position, task, "places", k))
        words = _("{name}: angle").format(name=name)
        yield Number(words, "angle", angle, POSITION, partial(_with_position, task, "angles", k))


def _with_position(task: Task, field: str, k: int, value: Any) -> Task:
    row: Any = getattr(task, field)
    changed: Any = (*row[:k], value, *row[k + 1 :])
    return replace(task, **{field: changed})


def _coordinates(
    name: str, place: complex, reach: float, put: Callable[[complex], Task], key: str = ""
) -> tuple[Number, Number]:  # fmt: skip
    """x and y of a place; put: the task with another place."""
    x, y = _("{name}: x").format(name=name), _("{name}: y").format(name=name)
    return (
        Number(x, "length", place.real, reach, lambda value: put(complex(value, place.imag)), key),
        Number(y, "length", place.imag, reach, lambda value: put(complex(place.real, value)), key),
    )
