"""Four-bar whose coupler takes 2, 3 or 4 given positions; AB drives, DC follows.

2 and 3 positions: the pin (B, C: in the coupler's axes) or the pivot (A, D) of each of both dyads is given; with 2 also
its length. 4 positions: dyads on Burmester's curves, by the turn of AB and DC from position 1 to 2, or those of best
transmission. Positions must be on one assembly, reached in order by turning AB one way.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis import guidance, loop
from tmm_cli.synthesis.burmester import DEFECTS, Dyads, Marks, Poses, beside, by_turn, centre, marks
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Value

PARAMETERS: Final = {
    **dict.fromkeys(("Ax", "Ay", "Dx", "Dy", "l1", "l2", "l3", "l4", "Px", "Py", "Cx", "Cy"), "length"),
    "phi1": "angle",
}
W: Final = "synthesis_coupler_positions"
SAME: Final = 1e-9  # of the size: three places that are so near to a line have no circle
TURNS: Final = 240  # turns of AB, and of DC, that are compared on Burmester's curves
SHORTEST, LONGEST = 0.15, 2.0  # links that are compared, over the size of the task
SIDES: Final = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True)
class Side:
    """What is given of a dyad: its pin (coupler's axes) or its pivot (m); length (m) and side with two positions; turn
    from position 1 to 2 (rad) and branch (0 or 1) with four."""

    pin: Any = None
    pivot: Any = None
    length: Any = None
    side: str = "left"
    turn: Any = None
    branch: int = 0


@dataclass(frozen=True)
class Asked:
    """Places (m) and angles (rad) of the coupler; what is given of AB and of DC; keep: defects are put up with."""

    places: tuple[Any, ...]
    angles: tuple[Any, ...]
    sides: Mapping[str, Side] = field(default_factory=dict)
    keep: bool = False

    @property
    def poses(self) -> Poses:
        return Poses(np.asarray(self.places, np.clongdouble), np.asarray(self.angles, np.longdouble))

    @property
    def size(self) -> float:
        """The largest distance between positions, or of what is given of the coupler, m."""
        places = np.asarray(self.places, complex)
        given = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        return float(max(np.max(np.abs(places[:, None] - places)), *given, 0.0))


def dyad(asked: Asked, name: str) -> Dyads:
    """The dyad of two or three positions. Raises Infeasible."""
    side, poses = asked.sides[name], asked.poses
    pin_given = side.pin is not None
    key = name[1] if pin_given else name[0]
    given = side.pin if pin_given else side.pivot
    places = poses.on_frame(given) if pin_given else poses.in_plane(given)
    if len(asked.places) == 3:
        found = centre(places)
        reach = max(abs(places[k] - places[k - 1]) for k in range(3))
        if reach <= SAME * asked.size:
            raise Infeasible(key, f"{W}.still", f"{W}.elsewhere", {"point": (key, "word")})
        if not np.isfinite(found) or abs(found - places[0]) > asked.size / SAME:
            raise Infeasible(key, f"{W}.line", f"{W}.off_line", {"point": (key, "word")})
    else:
        half = abs(places[1] - places[0]) / 2
        if half <= SAME * asked.size:
            raise Infeasible(key, f"{W}.still", f"{W}.elsewhere", {"point": (key, "word")})
        if not side.length > half:
            values = {"length": (float(half), "length", "above"), "name": (name, "word")}
            raise Infeasible(name, f"{W}.short", f"{W}.longer", values)
        found = beside(places, side.length, SIDES[side.side])
    fixed = np.asarray(given, np.clongdouble)
    return Dyads(found, fixed) if pin_given else Dyads(fixed, found)


def of_turn(asked: Asked, name: str) -> Dyads:
    """The dyad of four positions that turns as wanted. Raises Infeasible with the nearest turn that one has."""
    side = asked.sides[name]
    found = by_turn(asked.poses, np.asarray(side.turn, np.longdouble), side.branch)
    if np.isfinite(found.pivot) and abs(found.pivot) < asked.size / SAME:
        return found
    steps = np.radians(np.arange(1, 3600) * 0.05)
    for step in steps:
        for turn in (side.turn + step, side.turn - step):
            if np.isfinite(by_turn(asked.poses, np.asarray(turn, np.longdouble), side.branch).pivot):
                raise Infeasible(f"{name}_turn", f"{W}.no_turn", f"{W}.nearest_turn", {"turn": (float(turn), "angle")})
    raise Infeasible(f"{name}_turn", f"{W}.no_turn", f"{W}.other_positions")


def both(asked: Asked) -> tuple[Dyads, Dyads]:
    """Dyads AB and DC. Raises Infeasible."""
    names = ("AB", "DC")
    if len(asked.places) < 4:
        return dyad(asked, "AB"), dyad(asked, "DC")
    given = {name: of_turn(asked, name) for name in names if name in asked.sides}
    if len(given) == 2:
        return given["AB"], given["DC"]
    return best(asked, given)


def best(asked: Asked, given: Mapping[str, Dyads]) -> tuple[Dyads, Dyads]:
    """Dyads on Burmester's curves with the best transmission, without defects if there are such."""
    turns = {name: (-np.pi + 2 * np.pi * (np.arange(TURNS) + 0.5) / TURNS) for name in ("AB", "DC")}
    picked: dict[str, tuple[float, int]] = {}
    step = np.pi / TURNS
    for _ in range(16):  # the whole curves first, then nearer and nearer to the best
        rows = {name: _rows(asked, given, turns[name], picked.get(name), name) for name in ("AB", "DC")}
        (one, of_one), (other, of_other) = rows["AB"], rows["DC"]
        if not len(of_one) or not len(of_other):
            raise Infeasible("positions", f"{W}.no_curve", f"{W}.other_positions")
        found = marks(asked.poses, one[:, None], other[None, :])
        score = found.least - 10.0 * (found.defect > 0) - 20.0 * ~_fair(asked, one[:, None], other[None, :])
        i, j = np.unravel_index(int(np.argmax(np.nan_to_num(score, nan=-99.0))), score.shape)
        picked = {"AB": of_one[i], "DC": of_other[j]}
        taken = one[int(i)], other[int(j)]
        turns = {name: picked[name][0] + step * np.linspace(-2, 2, 9) for name in picked}
        step /= 2
    return taken


def _rows(
    asked: Asked, given: Mapping[str, Dyads], turns: Any, picked: tuple[float, int] | None, name: str
) -> tuple[Dyads, list[tuple[float, int]]]:
    """Dyads at these turns, and turn and branch of each; that which is given alone."""
    if name in given:
        return Dyads(*(np.asarray(x)[None] for x in (given[name].pivot, given[name].pin))), [(0.0, 0)]
    branches = (0, 1) if picked is None else (picked[1],)
    parts = [by_turn(asked.poses, turns, branch) for branch in branches]
    pivot, pin = np.concatenate([p.pivot for p in parts]), np.concatenate([p.pin for p in parts])
    of = [(float(turn), branch) for branch in branches for turn in turns]
    length = np.abs(asked.poses.on_frame(pin)[..., 0] - pivot)
    with np.errstate(all="ignore"):
        good = np.isfinite(length) & (length < LONGEST * asked.size) & (length > SHORTEST * asked.size)
    return Dyads(pivot[good], pin[good]), [one for one, keep in zip(of, good, strict=True) if keep]


def _fair(asked: Asked, one: Dyads, other: Dyads) -> Any:
    """Whether frame and coupler are neither too short nor too long."""
    sizes = (np.abs(one.pivot - other.pivot), np.abs(one.pin - other.pin))
    return np.all([(x > SHORTEST * asked.size) & (x < LONGEST * asked.size) for x in sizes], axis=0)


def _refuse(asked: Asked, one: Dyads, other: Dyads, defect: str) -> None:
    """The defect by its name, and what helps: the other link as driver, another side."""
    if int(marks(asked.poses, other, one).defect) == 0:
        raise Infeasible("positions", f"{W}.has_{defect}", f"{W}.swap")
    if len(asked.places) == 2:
        for first in SIDES:
            for second in SIDES:
                sides = {"AB": first, "DC": second}
                turned = {k: Side(s.pin, s.pivot, s.length, sides[k]) for k, s in asked.sides.items()}
                tried = Asked(asked.places, asked.angles, turned)
                if int(marks(asked.poses, dyad(tried, "AB"), dyad(tried, "DC")).defect) == 0:
                    values = {"one": (first, "word"), "other": (second, "word")}
                    raise Infeasible("positions", f"{W}.has_{defect}", f"{W}.sides", values)
    free = len(asked.places) == 4 and not asked.sides
    raise Infeasible("positions", f"{W}.has_{defect}", f"{W}.{'other_positions' if free else 'other_points'}")


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    one, other = both(asked)
    for key, names, gap in (("C", "B and C", one.pin - other.pin), ("D", "A and D", one.pivot - other.pivot)):
        if not abs(gap) > SAME * asked.size:
            raise Infeasible(key, f"{W}.one_point", f"{W}.two_points", {"names": (names, "word")})
    mark = marks(asked.poses, one, other)
    defect = DEFECTS[int(mark.defect)]
    if defect and not asked.keep:
        _refuse(asked, one, other, defect)
    plain = float if not isinstance(asked.angles[0], np.longdouble) else np.longdouble
    numbers = lengths(asked, one, other)
    values = [Value(name, plain(numbers[name]), kind, f"{W}.{name}") for name, kind in PARAMETERS.items()]
    values += [
        Value("", float(mark.least), "angle", f"{W}.transmission"),
        Value("", float(mark.way), "angle", f"{W}.way"),
        Value("", None, "word", f"{W}.defect", f"{W}.{defect or 'sound'}"),
    ]
    by_pivot = {name for name, side in asked.sides.items() if side.pivot is not None}
    drawn = guidance.construction(asked.poses, one, other, W, ("AB" in by_pivot, "DC" in by_pivot))
    return Outcome(
        _given(asked), tuple(values), f"{W}.source_{len(asked.places)}", _demands(asked, one, other, mark), drawn
    )


def lengths(asked: Asked, one: Dyads, other: Dyads) -> dict[str, Any]:
    """All parameters in extended precision."""
    b, c = (asked.poses.on_frame(x.pin)[..., 0] for x in (one, other))
    a, d = one.pivot, other.pivot
    span = other.pin - one.pin
    p = -one.pin * np.conj(span) / np.abs(span)
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
    return tuple(values)
