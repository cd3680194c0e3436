"""The nearest task that a coupler's positions, or a box for its pivots, must become for a four-bar to guide it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, marks
from tmm_cli.synthesis.burmester_search import Effort
from tmm_cli.synthesis.coupler_dyads import (
    EFFORTS,
    FAR,
    QUICK,
    SAME,
    SURE,
    THOROUGH,
    Asked,
    W,
    dyad,
    exists,
    of_near,
    of_turn,
    parallel,
    searched,
    still,
)  # fmt: skip
from tmm_cli.synthesis.coupler_points import LONGEST, both_points, moved
from tmm_cli.synthesis.record import Infeasible, Shown
from tmm_cli.synthesis.whole_position import whole_position
from tmm_cli.vectors import settled

FARTHEST: Final = 0.3  # change of a position: rad, or a share of the size of the task
NEAREST: Final = 0.03  # of that: the least change that is tried first
LEVELS: Final = 9  # changes that are tried;
BETWEEN: Final = 2  # and then between the last that does not help and the first that does
ROUGH: Final = 60  # of that gap: how finely changes are compared
FINE: Final = 44  # the same where a try is cheap
LONGER: Final = ((THOROUGH, 9), (None, 3))  # searches, and how many of them follow a limit
STRIDE: Final = 6.0  # from a step towards the limit to the next
LESS: Final = 1e-4  # a change that is less by this share is surely refused
INWARDS: Final = 1e-6  # rad, or a share of the size, from where there is a four-bar first
ROUNDED: Final = 1e-5  # what six digits may add to a value
ENDS: Final = (  # refusals without a value
    "other_positions", "other_points", "still_slider", "wider", "roomy", "off_line", "elsewhere",
)  # fmt: skip
MOVED: Final = {"off_line": LONGEST, "elsewhere": FAR}  # refusals of a point, and how far its link may reach
LARGEST: Final = 50.0  # radius, over the size of the task, on which places are told that lie on a line
BEYOND: Final = 1.05  # of the length at which a link only just reaches both places
SHARE: Final = 0.02  # by which a length is changed, and
TIMES: Final = 20.0  # how far
PARTS: Final = {"x": 1.0, "y": 1j, "angle": 0.0}

Change = tuple[int, str, float]  # number of the position, what of it, and the sense


def guiding(asked: Asked, *efforts: Effort | None) -> tuple[Dyads, Dyads] | None:
    """Dyads AB and DC if the task is solved; with short searches a four-bar may be missed, never invented."""
    with np.errstate(all="ignore"):
        given = _given(asked)
        if given is None or len(given) == 2:
            return None if given is None or not _accepted(asked, *given.values()) else (given["AB"], given["DC"])
        for loose in (False, True)[: 1 + asked.keep]:
            found = searched(asked, given, loose, efforts or EFFORTS[::-1])
            if found is not None and found[2] > SURE:
                return found[:2]
    return None


def soluble(asked: Asked, *efforts: Effort | None) -> bool:
    """Whether there are such dyads."""
    return guiding(asked, *efforts) is not None


def _given(asked: Asked) -> dict[str, Dyads] | None:
    """Dyads that the task gives; None: it gives some that are not to be had."""
    try:
        if len(asked.places) < 4:
            return {name: dyad(asked, name) for name in ("AB", "DC")}
        if still(asked.poses):
            return dict(zip(("AB", "DC"), parallel(asked), strict=True))
        found = {
            name: of_turn(asked, name) if side.near is None else of_near(asked, name)
            for name, side in sorted(asked.sides.items())
        }
    except Infeasible:
        return None
    return found if all(bool(exists(asked, one)) for one in found.values()) else None


def _accepted(asked: Asked, one: Dyads, other: Dyads) -> bool:
    apart = min(abs(one.pin - other.pin), abs(one.pivot - other.pivot)) > SAME * asked.size
    return bool(apart) and (asked.keep or int(marks(asked.poses, one, other).defect) == 0)


def told(asked: Asked, error: Infeasible, solves: Callable[[Asked], bool]) -> Infeasible:
    """The same refusal with the nearest box, or position, that is solved, where it is what must change."""
    if (pole := _pole(asked)) is not None:
        hinge = {"x": (pole.real, "length"), "y": (pole.imag, "length")}
        return Infeasible("positions", f"{W}.one_pole", f"{W}.hinge", hinge)
    if asked.within is not None and (found := _box(asked, error, solves)) is not None:
        return found
    words = error.nearest.removeprefix(f"{W}.")
    if words == "longer":
        return _longer(asked, error)
    if words in MOVED:
        values = moved(asked, "AB" if error.path[0] in ("A", "B") else "DC", MOVED[words])
        if values is not None:
            return Infeasible(error.path, error.reason, f"{W}.{words}_at", values)
    if words not in ENDS:
        return error
    keep = "_or_keep" if error.reason.startswith(f"{W}.has_") else ""
    four = len(asked.places) == 4 and not still(asked.poses)
    free, level = replace(asked, sides={}), 0
    if four and len(asked.sides) == 1:  # what does not help any links does not help these
        level = max(0, _scanned(free)[0] - 1) if not soluble(free, QUICK) else 0
    values = _position(asked, solves, level)
    if values is not None:
        return Infeasible(error.path, error.reason, f"{W}.position{keep}", error.values | values)
    if four and asked.sides:
        left = {"left": (", ".join(_keys(asked)), "word")}
        if soluble(free) and solves(free):
            return Infeasible(error.path, error.reason, f"{W}.left_out{keep}", error.values | left)
        if (values := _position(free, solves, level)) is not None:
            return Infeasible(error.path, error.reason, f"{W}.left_out_position{keep}", error.values | values | left)
        if (values := whole_position(free, solves, soluble)) is not None:
            return Infeasible(error.path, error.reason, f"{W}.left_out_whole{keep}", error.values | values | left)
    if four and not asked.sides:
        values = whole_position(asked, solves, soluble)
        if values is not None:
            return Infeasible(error.path, error.reason, f"{W}.whole{keep}", error.values | values)
    if len(asked.places) < 4 and (values := both_points(asked)) is not None:
        return Infeasible(error.path, error.reason, f"{W}.both_points{keep}", error.values | values)
    if words == "still_slider" and (values := _on_circle(asked)):
        return Infeasible(error.path, error.reason, f"{W}.on_circle", error.values | values)
    words = words if asked.within is None else "no_box"
    far: dict[str, Shown] = {"share": (f"{FARTHEST:g}", "word"), "turn": (FARTHEST, "angle")}
    return Infeasible(error.path, error.reason, f"{W}.{words}_far{keep}", error.values | far)


def _pole(asked: Asked) -> complex | None:
    """The point (m) about which three or four positions are turns of the coupler; None: there is none."""
    turns = np.exp(1j * (np.asarray(asked.angles[1:], float) - float(asked.angles[0])))
    places = np.asarray(asked.places, complex)
    if len(turns) < 2 or np.min(np.abs(turns - 1)) < SAME:
        return None
    poles = (places[1:] - places[0] * turns) / (1 - turns)
    size = float(np.max(np.abs(places))) + abs(poles[0])
    return complex(settled(poles[0], size)) if np.max(np.abs(poles - poles[0])) <= SAME * size else None


def _longer(asked: Asked, error: Infeasible) -> Infeasible:
    """A link that reaches both places, as the error tells, and so long that the four-bar is sound."""
    name, least = error.values["name"][0], float(error.values["length"][0])

    def with_length(share: float) -> Asked:
        side = replace(asked.sides[name], length=least * float(np.exp(share)))
        return replace(asked, sides={**asked.sides, name: side})

    shares = np.concatenate([[INWARDS], SHARE * np.arange(1, round(np.log(TIMES) / SHARE))])
    for n, share in enumerate(map(float, shares)):
        if soluble(with_length(share)):
            if n > 0:
                share = edge(lambda s: soluble(with_length(s)), share, float(shares[n - 1]), INWARDS)
                error.values["length"] = (least * float(np.exp(share + INWARDS)), "length", "least")
            return error
    error.values["length"] = (float(f"{least * BEYOND:.3g}"), "length")  # more must change, to what it is with this
    return error


def _on_circle(asked: Asked) -> dict[str, Shown]:
    """Places on a line: the second and third on the circle through the others that is as large as a link may be."""
    first, *between, last = (complex(place) for place in asked.places)
    radius, half = LARGEST * asked.size, abs(last - first) / 2
    if half == 0:
        return {}
    along = (last - first) / (2 * half)
    values: dict[str, Shown] = {"radius": (radius, "length"), "sizes": (f"{LARGEST:g}", "word")}
    for n, place in enumerate(between):
        at = ((place - first) * along.conjugate()).real
        rise = at * (2 * half - at) / (np.sqrt(radius**2 - (at - half) ** 2) + np.sqrt(radius**2 - half**2))
        on = first + along * complex(at, rise)
        values |= {f"x{n}": (on.real, "length", "exact"), f"y{n}": (on.imag, "length", "exact")}
    return values


def _keys(asked: Asked) -> list[str]:
    """Keys of a file that tell which links are wanted."""
    return [f"{name[0]}_near" if side.near is not None else f"{name}_turn" for name, side in asked.sides.items()]


def edge(good: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """Where what is good inside begins, but for a width."""
    while abs(inside - outside) > width:
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(middle) else (inside, middle)
    return inside


def limit(asked_by: Callable[[float], Asked], inside: float, outside: float, less: float) -> float:
    """The same of a change of a task that is not solved as it is, but for `less`; near it short searches miss what is
    there, and long ones are costly: there are few of those."""
    found = edge(lambda change: soluble(asked_by(change), QUICK), inside, outside, less / 4)
    sign = float(np.sign(outside - inside))
    for effort, tries in LONGER:
        step, nearer = less * sign, None
        for _ in range(tries):
            there = found + step if nearer is None else (found + nearer) / 2
            if soluble(asked_by(there), effort):
                found, step = there, STRIDE * step
            else:
                nearer = there
            if nearer is not None and abs(nearer - found) <= less:
                break
    return found


def _changed(asked: Asked, change: Change, size: float) -> Asked:
    which, part, sense = change
    if part == "angle":
        angles = list(asked.angles)
        angles[which] = angles[which] + sense * size
        return replace(asked, angles=tuple(angles))
    places = list(asked.places)
    places[which] = places[which] + sense * size * asked.size * PARTS[part]
    return replace(asked, places=tuple(places))


def _rough(
    good: Callable[[Change, float], bool], changes: list[Change], size: float, outside: float
) -> dict[Change, float]:
    """About how far each of these changes must go."""
    width = (size - outside) / ROUGH
    return {
        change: edge(lambda s, c=change: good(c, s), size, outside, width)  # type: ignore[misc]
        for change in changes
    }


def _cheap(asked: Asked) -> bool:
    return len(asked.places) < 4 or len(asked.sides) == 2


def _changes(asked: Asked) -> list[Change]:
    return [(k, part, sense) for k in range(1, len(asked.places)) for part in PARTS for sense in (1.0, -1.0)]


def _good(asked: Asked, change: Change, size: float) -> bool:
    return soluble(_changed(asked, change, size), QUICK)


def _scanned(asked: Asked, first: int = 0) -> tuple[int, list[Change], float, float]:
    """The first of the sizes of changes, from the first-th on, with some that help: its number, these, it and the size
    before; the number of sizes and none where there is no such."""
    sizes = FARTHEST * np.geomspace(NEAREST, 1, FINE if _cheap(asked) else LEVELS)
    outside = float(sizes[first - 1]) if first else 0.0
    for n, size in enumerate(map(float, sizes[first:]), first):
        if here := [change for change in _changes(asked) if _good(asked, change, size)]:
            return n, here, size, outside
        outside = size
    return len(sizes), [], outside, outside


def _position(asked: Asked, solves: Callable[[Asked], bool], first: int = 0) -> dict[str, Shown] | None:
    """Which angle or coordinate of a position changed least makes the task one that is solved, and to what.

    first: the number of the size of changes to begin with.
    """
    _, here, size, outside = _scanned(asked, first)
    if not here:
        return None

    def good(change: Change, size: float) -> bool:
        return _good(asked, change, size)

    rough = _rough(good, here, size, outside)
    for nearer in map(float, np.linspace(outside, min(rough.values()), BETWEEN + 2)[1:-1]) if not _cheap(asked) else ():
        if here := [change for change in _changes(asked) if good(change, nearer)]:
            rough = _rough(good, here, nearer, outside)
            break
    best = min(rough, key=lambda change: rough[change])
    which, part, sense = best
    length = 1.0 if part == "angle" else asked.size
    given = float(asked.angles[which]) if part == "angle" else float((asked.places[which] / PARTS[part]).real)
    less = LESS * max(abs(given) / length, rough[best]) / 2
    found = limit(lambda s: _changed(asked, best, s), rough[best], outside, less)
    for inwards in INWARDS * np.array([1.0, 4.0, 16.0, 64.0]):
        if solves(_changed(asked, best, found + inwards)):
            break
    else:
        return None
    end = given + sense * (found + inwards) * length
    side = "least" if sense > 0 else "most"
    if not soluble(_changed(asked, best, found + inwards + ROUNDED * abs(end) / length)):
        side = "exact"
    return {
        "which": (str(which + 1), "word"), "part": (part, "word"),
        "to": (end, "angle" if part == "angle" else "length", side),
    }  # fmt: skip


def _grown(within: tuple[complex, complex], by: float) -> tuple[complex, complex]:
    """A box whose sides have moved outwards (m), its corners in the order in which they were given."""
    one, other = within
    away = complex(*(1.0 if high >= low else -1.0 for low, high in ((one.real, other.real), (one.imag, other.imag))))
    return one - by * away, other + by * away


def _box(asked: Asked, error: Infeasible, solves: Callable[[Asked], bool]) -> Infeasible | None:
    """The least growth of the box on all sides with which the task is solved, and the pivots of the best four-bar
    anywhere; None: no box helps."""
    assert asked.within is not None
    pair = guiding(replace(asked, within=None), *EFFORTS)
    if pair is None:
        return None
    found = [complex(one.pivot) for one in pair]
    one, other = asked.within
    gaps = [
        gap for pivot in found for axis in ("real", "imag")
        for low, high in [sorted((getattr(one, axis), getattr(other, axis)))]
        for gap in (low - getattr(pivot, axis), getattr(pivot, axis) - high)
    ]  # fmt: skip
    most = max(0.0, *gaps) + INWARDS * asked.size

    def grown(by: float) -> Asked:
        return replace(asked, within=_grown((one, other), by))

    by = limit(grown, most, 0.0, LESS * max(abs(one), abs(other), most) / 4) + INWARDS * asked.size
    by = by if solves(grown(by)) else most
    corners = _grown((one, other), by)
    values: dict[str, Shown] = {"by": (by, "length", "least")}
    for name, corner, facing in (("one", corners[0], corners[1]), ("other", corners[1], corners[0])):
        for axis, part in (("x", "real"), ("y", "imag")):
            at = getattr(corner, part)
            values[f"{name}_{axis}"] = (at, "length", "most" if at <= getattr(facing, part) else "least")
    for point, pivot in zip("AD", found, strict=True):
        values |= {f"{point}x": (pivot.real, "length"), f"{point}y": (pivot.imag, "length")}
    return Infeasible("pivots_within", error.reason, f"{W}.box_grown", error.values | values)
