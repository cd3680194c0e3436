"""Dyads AB and DC of a four-bar whose coupler takes 2, 3 or 4 positions: from what is given, or the best of a curve."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.roots import least
from tmm_cli.synthesis.burmester import Dyads, Poses, beside, by_turn, centre, marks
from tmm_cli.synthesis.record import Infeasible

W: Final = "synthesis_coupler_positions"
SAME: Final = 1e-9  # of the size: three places that are so near to a line have no circle
TURNS: Final = 240  # turns of AB, and of DC, that are compared on Burmester's curves
FINE: Final = 1440  # turns among which the pivot nearest to a place is sought
SHORTEST, LONGEST = 0.15, 2.0  # links that are compared, over the size of the task
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
        """The largest distance between positions, or of what is given of the coupler, m."""
        places = np.asarray(self.places, complex)
        given = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        return float(max(np.max(np.abs(places[:, None] - places)), *given, 0.0))

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


def exists(asked: Asked, found: Dyads) -> Any:
    """Whether there are such dyads, with links that are neither infinite nor of no length."""
    with np.errstate(all="ignore"):
        length = np.abs(asked.poses.on_frame(found.pin)[..., 0] - found.pivot)
        there = np.isfinite(found.pivot) & (np.abs(found.pivot) < asked.size / SAME)
        return there & np.isfinite(length) & (length > SAME * asked.size)


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


def best(asked: Asked, given: Mapping[str, Dyads]) -> tuple[Dyads, Dyads]:
    """Dyads on Burmester's curves with the best transmission, without defects if there are such."""
    count = TURNS if asked.within is None else FINE  # a box may be small
    turns = {name: (-np.pi + 2 * np.pi * (np.arange(count) + 0.5) / count) for name in ("AB", "DC")}
    picked: dict[str, tuple[float, int]] = {}
    step = np.pi / count
    for _ in range(16):  # the whole curves first, then nearer and nearer to the best
        here = {name: rows(asked, given, turns[name], picked.get(name), name) for name in ("AB", "DC")}
        (one, of_one), (other, of_other) = here["AB"], here["DC"]
        if not len(of_one) or not len(of_other):
            _refuse_empty(asked)
        found = marks(asked.poses, one[:, None], other[None, :])
        good = fair(asked, one[:, None], other[None, :])
        if asked.within is not None and not np.any(good):
            raise Infeasible("pivots_within", f"{W}.no_room", f"{W}.roomy")
        score = found.least - 10.0 * (found.defect > 0) - 20.0 * ~good
        i, j = np.unravel_index(int(np.argmax(np.nan_to_num(score, nan=-99.0))), score.shape)
        picked = {"AB": of_one[i], "DC": of_other[j]}
        taken = one[int(i)], other[int(j)]
        turns = {name: picked[name][0] + step * np.linspace(-2, 2, 9) for name in picked}
        step /= 2
    return taken


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
    """No link is to be had: because of the box, with the pivot that is nearest to it, or at all."""
    if asked.within is not None:
        grid = -np.pi + 2 * np.pi * (np.arange(FINE) + 0.5) / FINE
        found = [rows(replace(asked, within=None), {}, grid, (0.0, branch), "AB")[0] for branch in (0, 1)]
        pivots = np.asarray(np.concatenate([x.pivot for x in found]), complex)
        if len(pivots):
            place = complex(pivots[int(np.argmin(asked.outside(pivots)))])
            values = {"x": (place.real, "length"), "y": (place.imag, "length")}
            raise Infeasible("pivots_within", f"{W}.none_within", f"{W}.wider", values)
    raise Infeasible("positions", f"{W}.no_curve", f"{W}.other_positions")
