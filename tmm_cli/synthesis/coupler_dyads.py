"""Dyads AB and DC of a four-bar whose coupler takes 2, 3 or 4 positions: from what is given, or the best of a curve."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.roots import least
from tmm_cli.synthesis import burmester_search
from tmm_cli.synthesis.burmester import Dyads, Poses, beside, by_turn, centre, unit
from tmm_cli.synthesis.burmester_search import Effort, Limits
from tmm_cli.synthesis.record import Infeasible, Shown

W: Final = "synthesis_coupler_positions"
SAME: Final = 1e-9  # of the size: three places that are so near to a line have no circle
TURNS: Final = 240  # turns of AB, and of DC, that are compared for a suggestion
FINE: Final = 1440  # turns among which the pivot nearest to a place is sought
SHORTEST, LONGEST = 0.15, 2.0  # links that are compared, over the size of the task
FAR, NEAR = 100.0, 10.0  # reach of a given turn, over that size: beyond it is refused; of what is told instead
SURE: Final = 1e-6  # rad: with less than that of transmission it is not sure that a four-bar passes
ROOM: Final = 0.9  # of the box, for the frame of a parallelogram
QUICK: Final = Effort(60, 16, 8, (), 96, 5, 10)  # finds a sound four-bar in most tasks that have one, in 0.02 s
THOROUGH: Final = Effort(120, 40, 12, ((4, 6, 5), (1, 10, 8)), 256, 9, 24)
EFFORTS: Final = (None, THOROUGH, QUICK)  # another layout of the curves may find a strip that one passes over
SIDES: Final = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True)
class Side:
    """What is given of a dyad: its pin (coupler's axes) or its pivot (m); length (m) and side with two positions; with
    four the turn from position 1 to 2 (rad) and branch (0 or 1), or a place (m) that its pivot shall be near to."""

    pin: Any = None
    pivot: Any = None
    length: Any = None
    side: str = "left"
    turn: Any = None
    branch: int = 0
    near: Any = None


@dataclass(frozen=True)
class Asked:
    """Places (m) and angles (rad) of the coupler; what is given of AB and of DC; keep: defects are put up with.

    within: opposite corners (m) of a box in which pivots lie that are free with four positions.
    """

    places: tuple[Any, ...]
    angles: tuple[Any, ...]
    sides: Mapping[str, Side] = field(default_factory=dict)
    keep: bool = False
    within: tuple[complex, complex] | None = None

    @property
    def poses(self) -> Poses:
        return Poses(np.asarray(self.places, np.clongdouble), np.asarray(self.angles, np.longdouble))

    @property
    def size(self) -> float:
        """The largest distance between positions, or of what is given of the coupler, m; where all that is nothing, of
        pivots that are given, or a length."""
        places = np.asarray(self.places, complex)
        given = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        found = float(max(np.max(np.abs(places[:, None] - places)), *given, 0.0))
        if found == 0:
            away = [abs(complex(s.pivot) - places[0]) for s in self.sides.values() if s.pivot is not None]
            found = float(max([*away, *(s.length for s in self.sides.values() if s.length is not None), 0.0]))
        return found

    def outside(self, places: Any) -> Any:
        """How far places lie outside the box (m), 0 within."""
        if self.within is None:
            return np.zeros(np.shape(places))
        one, other = self.within
        gaps = []
        for part in ("real", "imag"):
            low, high = sorted((getattr(one, part), getattr(other, part)))
            at = np.asarray(getattr(np.asarray(places), part), float)
            gaps.append(np.maximum(np.maximum(low - at, at - high), 0.0))
        return np.hypot(*gaps)


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


def of_turn(asked: Asked, name: str, turn: Any = None) -> Dyads:
    """The dyad of four positions that turns as wanted, or by `turn` (rad); nan where there is none."""
    side = asked.sides[name]
    return by_turn(asked.poses, np.asarray(side.turn if turn is None else turn, np.longdouble), side.branch)


def reach(asked: Asked, found: Dyads) -> Any:
    """How far pivots (from place 1) and pins reach, over the size of the task; inf where there is no dyad."""
    with np.errstate(all="ignore"):
        ends = (found.pivot - asked.poses.places[..., 0], found.pin)
        largest = np.maximum(*(np.abs(x) for x in ends)) / asked.size
    return np.where(np.isnan(largest), np.inf, largest)


def exists(asked: Asked, found: Dyads, far: float = FAR) -> Any:
    """Whether there are such dyads, with ends that are not far away and links of some length."""
    with np.errstate(all="ignore"):
        length = np.abs(asked.poses.on_frame(found.pin)[..., 0] - found.pivot)
        return (reach(asked, found) < far) & np.isfinite(length) & (length > SAME * asked.size)


def of_near(asked: Asked, name: str) -> Dyads:
    """The dyad of four positions whose pivot is the place of the centre-point curve nearest to the wanted one."""
    wanted = complex(asked.sides[name].near)

    def away(turns: Any, branch: int) -> Any:
        found = by_turn(asked.poses, np.asarray(turns, np.longdouble), branch)
        distance = np.abs(np.asarray(found.pivot, complex) - wanted)
        return np.where(exists(asked, found) & np.isfinite(distance), distance, np.inf)

    grid = -np.pi + 2 * np.pi * (np.arange(FINE) + 0.5) / FINE
    step, found = grid[1] - grid[0], []
    for branch in (0, 1):
        turn = float(grid[int(np.argmin(away(grid, branch)))])
        turn, distance = least(partial(away, branch=branch), turn - step, turn + step)
        found.append((distance, turn, branch))
    distance, turn, branch = min(found)
    if not np.isfinite(distance):
        raise Infeasible(f"{name[0]}_near", f"{W}.no_curve", f"{W}.other_positions")
    return by_turn(asked.poses, np.asarray(turn, np.longdouble), branch)


def limits(asked: Asked, given: Mapping[str, Dyads]) -> Limits:
    """What is sensible beside the dyads that are given."""
    first, size = asked.poses.places[0], asked.size
    ends = [max((float(abs(x)) for x in row), default=0.0) for row in (
        [one.pivot - first for one in given.values()], [one.pin for one in given.values()])]  # fmt: skip
    return Limits(
        SHORTEST * size, LONGEST * size, LONGEST * size + ends[0], LONGEST * size + ends[1],
        None if asked.within is None else asked.outside,
    )  # fmt: skip


def searched(
    asked: Asked, given: Mapping[str, Dyads], loose: bool = False, efforts: tuple[Effort | None, ...] = EFFORTS
) -> tuple[Dyads, Dyads, float] | None:
    """The best dyads beside those that are given and their transmission angle (rad), of the first search with a sound
    four-bar, else of the last; None: there are none. loose: branches are not asked for."""
    found, bounds = None, limits(asked, given)
    for effort in efforts:
        found = burmester_search.best(asked.poses, asked.size, bounds, dict(given), loose, effort)
        if found is None or found[2] > SURE:
            break
    return found


def best(asked: Asked, given: Mapping[str, Dyads]) -> tuple[Dyads, Dyads]:
    """Dyads on Burmester's curves with the best transmission, without defects if there are such. Raises Infeasible."""
    bounds = limits(asked, given)
    for loose in (False, True):  # without a sound one: one whose branches only are not the same
        found = searched(asked, given, loose, EFFORTS[: 1 if loose else None])
        if found is None:
            _refuse_empty(asked)
        elif found[2] > SURE:
            return found[:2]
    assert found is not None
    frame, coupler = abs(found[0].pivot - found[1].pivot), abs(found[0].pin - found[1].pin)
    if bounds.shortest <= min(frame, coupler) and frame <= bounds.frame and coupler <= bounds.coupler:
        return found[:2]
    if asked.within is not None:
        raise Infeasible("pivots_within", f"{W}.no_room", f"{W}.roomy")
    raise Infeasible("positions", f"{W}.no_curve", f"{W}.other_positions")


def still(poses: Poses) -> bool:
    """Whether the coupler does not turn between any positions."""
    return bool(np.all(np.abs(unit(poses.angles - poses.angles[0]) - 1) < SAME))


def parallel(asked: Asked) -> tuple[Dyads, Dyads]:
    """Four positions of one angle: the coupler of any parallelogram whose arms are that of P on its circle.

    AD, which is free, stands across the arms in the middle of their way. Raises Infeasible.
    """
    places, angles = asked.poses.places, asked.poses.angles
    middle = min((centre(places[[k for k in range(4) if k != out]]) for out in range(4)), key=lambda z: float(
        np.nan_to_num(abs(z), nan=np.inf)))  # fmt: skip
    arms = places - middle
    radius = abs(arms[0])
    if not (np.isfinite(radius) and radius < FAR * asked.size):
        raise Infeasible("positions", f"{W}.still_line", f"{W}.still_slider")
    if np.max(np.abs(np.abs(arms) - radius)) > SAME * radius:
        other = centre(places[:3])
        on = other + abs(places[0] - other) * (places[3] - other) / abs(places[3] - other)
        values = {"x": (float(on.real), "length", "exact"), "y": (float(on.imag), "length", "exact")}
        turns = _other_turns(asked, (places[1] - other) / (places[0] - other))
        words = "still_on_turn" if turns else "still_on"
        raise Infeasible(("positions", 3), f"{W}.still_off", f"{W}.{words}", values | turns)
    if turns := _other_turns(asked, arms[1] / arms[0]):
        first = turns["names"][0].split()[0]
        raise Infeasible(first, f"{W}.still_turn", f"{W}.still_turns", turns)
    steps = np.mod(np.angle(np.asarray(arms[1:] / arms[:-1], complex)), 2 * np.pi)
    way = min(float(steps.sum()), float((steps - 2 * np.pi).sum()), key=abs)
    frame = 1j * arms[0] / radius * np.exp(0.5j * way) * min(radius, asked.size)
    if asked.within is not None:
        low, high = asked.within
        frame *= min(1.0, ROOM * min(abs((high - low).real), abs((high - low).imag)) / float(abs(frame)))
        middles = [(low + high) / 2 + sign * frame / 2 for sign in (-1, 1)]
    else:
        middles = [middle + sign * frame / 2 for sign in (-1, 1)]
    pivots = [
        asked.sides[name].near if name in asked.sides and asked.sides[name].near is not None else at
        for name, at in zip(("AB", "DC"), middles, strict=True)
    ]
    one, other = (Dyads(a, (a - middle) * unit(-angles[0])) for a in (np.asarray(a, np.clongdouble) for a in pivots))
    return one, other


def _other_turns(asked: Asked, arm: Any) -> dict[str, Shown]:
    """The turn (rad) that brings an arm of a coupler that does not turn on to its second place, and the keys of links
    that are asked to turn otherwise; {}: there is none."""
    turn = float(np.angle(complex(arm)))
    names = [
        f"{name}_turn" for name, side in asked.sides.items()
        if side.turn is not None and abs(np.exp(1j * (float(side.turn) - turn)) - 1) > SAME
    ]  # fmt: skip
    return {"names": (" and ".join(names), "word"), "turn": (turn, "angle", "exact")} if names else {}


def rows(
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
        good &= asked.outside(pivot) <= 0
    kept = np.flatnonzero(good)
    kept = kept[:: 1 + len(kept) // (4 * TURNS)]
    return Dyads(pivot[kept], pin[kept]), [of[k] for k in kept]


def fair(asked: Asked, one: Dyads, other: Dyads) -> Any:
    """Whether frame and coupler are neither too short nor too long."""
    sizes = (np.abs(one.pivot - other.pivot), np.abs(one.pin - other.pin))
    return np.all([(x > SHORTEST * asked.size) & (x < LONGEST * asked.size) for x in sizes], axis=0)


def _refuse_empty(asked: Asked) -> None:
    """No link is to be had: because of the box, or at all."""
    if asked.within is not None:
        grid = -np.pi + 2 * np.pi * (np.arange(FINE) + 0.5) / FINE
        plain = Asked(asked.places, asked.angles, asked.sides, asked.keep)
        if any(rows(plain, {}, grid, (0.0, branch), "AB")[1] for branch in (0, 1)):
            raise Infeasible("pivots_within", f"{W}.none_within", f"{W}.wider")
    raise Infeasible("positions", f"{W}.no_curve", f"{W}.other_positions")
