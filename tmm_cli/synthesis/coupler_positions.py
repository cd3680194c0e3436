"""Four-bar whose coupler takes 2, 3 or 4 given positions; AB drives, DC follows.

2 and 3 positions: the pin (B, C: in the coupler's axes) or the pivot (A, D) of each of both dyads is given; with 2 also
its length. 4 positions: dyads on Burmester's curves, by the turn of AB and DC from position 1 to 2, by the nearness of
a pivot, or those of best transmission. Positions must be on one assembly, reached in order by turning AB one way.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis import guidance, loop
from tmm_cli.synthesis.burmester import DEFECTS, Dyads, Marks, by_turn, marks
from tmm_cli.synthesis.coupler_dyads import SAME, Asked, Side, best, dyad, exists, of_near, of_turn, parallel, still
from tmm_cli.synthesis.coupler_nearest import refuse_defect, refuse_point, refuse_turn
from tmm_cli.synthesis.nearest_positions import told
from tmm_cli.synthesis.record import Demand, Infeasible, Listing, Outcome, Value
from tmm_cli.vectors import settled

__all__ = ["PARAMETERS", "Asked", "Side", "both", "solve"]
PARAMETERS: Final = {
    **dict.fromkeys(("Ax", "Ay", "Dx", "Dy", "l1", "l2", "l3", "l4", "Px", "Py", "Cx", "Cy"), "length"),
    "phi1": "angle",
}
W: Final = "synthesis_coupler_positions"
ROUNDED: Final = 2e-6  # by which a length may grow when it is told
LISTED: Final = 360  # turns that are listed of each branch of Burmester's curves


def both(asked: Asked) -> tuple[Dyads, Dyads]:
    """Dyads AB and DC. Raises Infeasible."""
    if len(asked.places) < 4:
        return dyad(asked, "AB"), dyad(asked, "DC")
    if still(asked.poses):
        return parallel(asked)
    given = {}
    for name, side in asked.sides.items():
        given[name] = of_near(asked, name) if side.near is not None else of_turn(asked, name)
    for name, found in given.items():
        if not exists(asked, found):
            refuse_turn(asked, name, given)
    return (given["AB"], given["DC"]) if len(given) == 2 else best(asked, given)


def turn_of(asked: Asked, found: Dyads) -> tuple[float, int]:
    """The turn (rad) of a dyad through four positions from 1 to 2, and its branch (1 or 2)."""
    pins = asked.poses.on_frame(found.pin)
    turn = float(np.angle(complex((pins[1] - found.pivot) / (pins[0] - found.pivot))))
    away = [abs(by_turn(asked.poses, np.asarray(turn, np.longdouble), branch).pivot - found.pivot) for branch in (0, 1)]
    return turn, 1 + int(np.nan_to_num(away[1], nan=np.inf) < np.nan_to_num(away[0], nan=np.inf))


def _curve(asked: Asked) -> Listing:
    """Pivots and circle points of Burmester's curves by the turn of their link and its branch."""
    columns = (
        (f"{W}.column_branch", "name"), (f"{W}.column_turn", "angle"), (f"{W}.column_pivot_x", "length"),
        (f"{W}.column_pivot_y", "length"), (f"{W}.column_pin_x", "length"), (f"{W}.column_pin_y", "length"),
        (f"{W}.column_first_x", "length"), (f"{W}.column_first_y", "length"), (f"{W}.column_length", "length"),
    )  # fmt: skip
    turns = -np.pi + 2 * np.pi * np.arange(1, LISTED + 1) / LISTED
    rows = []
    for branch in (0, 1):
        found = by_turn(asked.poses, turns, branch)
        first = asked.poses.on_frame(found.pin)[..., 0]
        for k in np.flatnonzero(exists(asked, found)):
            a, b, b1 = (complex(x[k]) for x in (found.pivot, found.pin, first))
            rows.append(
                (str(branch + 1), float(turns[k]), a.real, a.imag, b.real, b.imag, b1.real, b1.imag, abs(b1 - a))
            )
    return Listing("curve", f"{W}.curve", columns, tuple(rows), long=True)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    try:
        return _solved(asked)
    except Infeasible as error:
        raise _told(asked, error) from None


def _told(asked: Asked, error: Infeasible) -> Infeasible:
    """The refusal with what is solved; of a link that is too short and not all that must change, with the rest too."""
    found = told(asked, error, _solves)
    if found.nearest == f"{W}.longer" and found.then is None:
        name, (length, _, *side) = found.values["name"][0], found.values["length"]
        length *= 1 + ROUNDED * len(side)  # a plain number is told as it is
        longer = replace(asked, sides={**asked.sides, name: replace(asked.sides[name], length=length)})
        try:
            _solved(longer)
        except Infeasible as then:
            found.then = _told(longer, then)
    return found


def _solves(asked: Asked) -> bool:
    """Whether the task is solved, without a search for what a refusal would tell."""
    try:
        one, other = both(asked)
    except Infeasible:
        return False
    apart = min(abs(one.pin - other.pin), abs(one.pivot - other.pivot)) > SAME * asked.size
    return bool(apart) and (asked.keep or int(marks(asked.poses, one, other).defect) == 0)


def _solved(asked: Asked) -> Outcome:
    one, other = both(asked)
    ends = [("B and C", one.pin - other.pin), ("A and D", one.pivot - other.pivot)]
    for names, gap in ends[:: -1 if any(side.pivot is not None for side in asked.sides.values()) else 1]:
        if not abs(gap) > SAME * asked.size:
            refuse_point(asked, one, other, names)
    mark = marks(asked.poses, one, other)
    defect = DEFECTS[int(mark.defect)]
    if defect and not asked.keep:
        refuse_defect(asked, one, other, defect)
    plain = float if not isinstance(asked.angles[0], np.longdouble) else np.longdouble
    numbers = lengths(asked, one, other)
    values = [Value(name, plain(numbers[name]), kind, f"{W}.{name}") for name, kind in PARAMETERS.items()]
    values += [
        Value("", float(mark.least), "angle", f"{W}.transmission"),
        Value("", float(mark.way), "angle", f"{W}.way"),
        Value("", None, "word", f"{W}.defect", f"{W}.{defect or 'sound'}"),
    ]
    free = len(asked.places) == 4 and still(asked.poses)
    four = len(asked.places) == 4 and not free
    for name, found in (("AB", one), ("DC", other)) if four else ():
        side = asked.sides.get(name, Side())
        if side.turn is None:
            turn, branch = turn_of(asked, found)
            values += [
                Value("", turn, "angle", f"{W}.{name}_turn"),
                Value("", None, "word", f"{W}.{name}_branch", str(branch)),
            ]
        if side.near is not None:
            away = float(abs(complex(found.pivot) - complex(side.near)))
            values.append(Value("", away, "length", f"{W}.{name[0]}_away"))
    by_pivot = {name for name, side in asked.sides.items() if side.pivot is not None}
    drawn = guidance.construction(asked.poses, one, other, W, ("AB" in by_pivot, "DC" in by_pivot))
    return Outcome(
        _given(asked), tuple(values), f"{W}.source_{'still' if free else len(asked.places)}",
        _demands(asked, one, other, mark), drawn, (f"{W}.any_parallelogram",) if free else (),
        (_curve(asked),) if four else (),
    )  # fmt: skip


def lengths(asked: Asked, one: Dyads, other: Dyads) -> dict[str, Any]:
    """All parameters in extended precision."""
    b, c = (asked.poses.on_frame(x.pin)[..., 0] for x in (one, other))
    a, d = one.pivot, other.pivot
    size = asked.size + np.max(np.abs(np.asarray(asked.places))) + np.abs(a) + np.abs(d)
    a, b, c, d = (settled(x, size) for x in (a, b, c, d))
    span = other.pin - one.pin
    p = settled(-one.pin * np.conj(span) / np.abs(span), size)
    found = {"Ax": a.real, "Ay": a.imag, "Dx": d.real, "Dy": d.imag, "Px": p.real, "Py": p.imag}
    found |= {"l1": np.abs(b - a), "l2": np.abs(span), "l3": np.abs(c - d), "l4": np.abs(d - a)}
    return found | {"Cx": c.real, "Cy": c.imag, "phi1": np.arctan2((b - a).imag, (b - a).real)}


def _demands(asked: Asked, one: Dyads, other: Dyads, mark: Marks) -> tuple[Demand, ...]:
    b = asked.poses.on_frame(one.pin)
    phi = np.angle(np.asarray((b - one.pivot) / (other.pivot - one.pivot), complex))
    span = complex(other.pin - one.pin)
    local, slope = complex(-one.pin) * np.conj(span) / abs(span), float(np.angle(span))
    found = []
    for k, (place, angle) in enumerate(zip(asked.places, asked.angles, strict=True)):
        at = {"phi": float(phi[k]), "local": local, "slope": slope, "near": float(angle)}
        for part, value in (("x", complex(place).real), ("y", complex(place).imag)):
            found.append(Demand(f"{W}.{part}{k + 1}", value, "length", partial(_pose, part, at), at=asked.size))
        found.append(Demand(f"{W}.angle{k + 1}", float(angle), "angle", partial(_pose, "angle", at), at=1.0))
    worst = float(mark.worst)
    found.append(
        Demand(f"{W}.transmission", float(mark.least), "angle", partial(_transmission, worst), asked=False, at=1.0)
    )
    return tuple(found)


def _pose(part: str, at: dict[str, Any], results: Any) -> float:
    """A coordinate of the coupler's position where AB stands at an angle from AD."""
    found = loop.pins(results, np.array([at["phi"]]))
    if found is None:
        return float("nan")
    b, c = found[1][0], found[2][0]
    along = (c - b) / abs(c - b)
    place = b + along * at["local"]
    turned = at["near"] + float(np.angle(complex(along) * np.exp(-1j * (at["near"] + at["slope"]))))
    return float({"x": place.real, "y": place.imag, "angle": turned}[part])


def _transmission(phi: float, results: Any) -> float:
    return float(loop.transmission(results, np.array([phi]))[0])


def _given(asked: Asked) -> tuple[Value, ...]:
    values = []
    for k, (place, angle) in enumerate(zip(asked.places, asked.angles, strict=True)):
        values += [Value("", place.real, "length", f"{W}.x{k + 1}"), Value("", place.imag, "length", f"{W}.y{k + 1}")]
        values.append(Value("", angle, "angle", f"{W}.angle{k + 1}"))
    for name, side in asked.sides.items():
        for point, at in ((name[1], side.pin), (name[0], side.pivot)):
            if at is not None:
                values += [
                    Value("", at.real, "length", f"{W}.{point}_x"),
                    Value("", at.imag, "length", f"{W}.{point}_y"),
                ]
        if side.length is not None:
            values.append(Value("", side.length, "length", f"{W}.{name}"))
        if side.turn is not None:
            values.append(Value("", side.turn, "angle", f"{W}.{name}_turn"))
        if side.near is not None:
            values += [
                Value("", part, "length", f"{W}.{name[0]}_near_{axis}")
                for axis, part in (("x", side.near.real), ("y", side.near.imag))
            ]
    if asked.within is not None:
        for corner, place in zip(("one", "other"), asked.within, strict=True):
            values += [
                Value("", place.real, "length", f"{W}.{corner}_x"),
                Value("", place.imag, "length", f"{W}.{corner}_y"),
            ]
    return tuple(values)
