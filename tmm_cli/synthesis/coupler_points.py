"""The nearest other pin or pivot of a link with which a four-bar guides a coupler through two or three positions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, beside, centre, marks
from tmm_cli.synthesis.coupler_dyads import FAR, SAME, SHORTEST, SIDES, Asked, Side, dyad, exists, fair
from tmm_cli.synthesis.record import Infeasible, Shown

RINGS: Final = np.geomspace(0.01, 3.0, 80)  # about a given point, over the size of the task, and
ROUND: Final = 48  # places on each
ROOM: Final = 1e-4  # of a ring: so far around a place the four-bar must be sound too
HALVINGS: Final = 40
ROUNDS: Final = 24  # of directions, each half as far apart as in the one before,
FAN: Final = np.linspace(-1, 1, 9)
INWARDS: Final = 1e-6  # of the size, from where there is a sound four-bar first
SURELY: Final = 1e-9  # of the size: so far around what is told there is one
ROUNDED: Final = 1e-5  # what six digits may add to a value
GRID: Final = np.linspace(-1.4, 1.4, 15)  # over that size: points of both links that are tried, along both axes
PLAIN: Final = np.radians(5)  # of transmission: where any place will do, one that is on no edge
USABLE: Final = np.radians(30)  # a transmission angle that will do for them
SENSIBLE: Final = 2.0  # the longest link of theirs, over the size
MOVES: Final = 0.05  # over the size: so far a point must move at least that is told for a pole
LONGEST: Final = 50.0  # reach, over the size of the task, that is told for a point whose places lie on a line


def sound(asked: Asked, one: Any, other: Any, far: float = FAR, least: float = 0.0) -> Any:
    """Whether four-bars are without defects, of a sensible size and of some transmission (rad), broadcast together."""
    with np.errstate(all="ignore"):
        gaps = np.minimum(np.abs(one.pin - other.pin), np.abs(one.pivot - other.pivot))
        found = marks(asked.poses, one, other)
        good = (found.defect == 0) & (found.least >= least) & (gaps > SAME * asked.size)
        return good & exists(asked, one, far) & exists(asked, other, far)


def pair(name: str, own: Dyads, other: Dyads) -> tuple[Dyads, Dyads]:
    """AB and DC from the dyad of that name and the other."""
    return (own, other) if name == "AB" else (other, own)


def by_points(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Another pin or pivot, the one that is nearer to what was asked."""
    found = []
    for name, rest in (("DC", one), ("AB", other)):
        near = _nearest(asked, name, _with(asked, name, rest))
        if near is not None:
            found.append((near[0], _letter(asked.sides[name], name), near[1]))
    if not found:
        return "other_points", {}
    _, letter, values = min(found, key=lambda row: row[0])
    return "point", values | {"point": (letter, "word")}


def moved(asked: Asked, name: str, far: float = LONGEST) -> dict[str, Shown] | None:
    """The nearest place of a point of a link that is not to be had, with a sound four-bar that reaches `far` sizes;
    with such a link at all where the other one is not to be had either.
    """
    try:
        rest = dyad(asked, "DC" if name == "AB" else "AB")
    except Infeasible:
        rest = None
    usable = _with(asked, name, rest, far, PLAIN if far == FAR else 0.0)

    def good(points: Any) -> Any:
        with np.errstate(all="ignore"):
            return usable(points) & (_moves(asked, asked.sides[name], points) > MOVES * asked.size)

    near = _nearest(asked, name, good)
    if near is None:
        return None
    return near[1] | {"point": (_letter(asked.sides[name], name), "word"), "sizes": (f"{far:g}", "word")}


def parted(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Where both pins, or both pivots, are one: the nearest place of a point that makes a sound four-bar with a frame
    and a coupler of sensible length."""
    for name, rest in (("DC", one), ("AB", other)):
        alone = _with(asked, name, rest, least=PLAIN)

        def good(points: Any, name: str = name, rest: Dyads = rest, alone: Any = alone) -> Any:
            return alone(points) & fair(asked, *pair(name, _links(asked, name, points), rest))

        near = _nearest(asked, name, good)
        if near is not None:
            return "elsewhere_at", near[1] | {"point": (_letter(asked.sides[name], name), "word")}
    side = asked.sides["DC"]
    place = complex(side.pin if side.pin is not None else side.pivot) + 2 * SHORTEST * asked.size
    values: dict[str, Shown] = {"x": (place.real, "length"), "y": (place.imag, "length")}
    return "elsewhere_at", values | {"point": (_letter(side, "DC"), "word")}


def _moves(asked: Asked, side: Side, points: Any) -> Any:
    """How far (m) points move from the first position to another, or pivots against the coupler."""
    places = _places(asked, side, points)
    return np.max(np.abs(places - places[..., :1]), axis=-1)


def _places(asked: Asked, side: Side, points: Any) -> Any:
    return asked.poses.on_frame(points) if side.pin is not None else asked.poses.in_plane(points)


def _links(asked: Asked, name: str, points: Any) -> Dyads:
    """Links of a name with their point at these places (m)."""
    side, points = asked.sides[name], np.asarray(points, np.clongdouble)
    places = _places(asked, side, points)
    with np.errstate(all="ignore"):
        end = centre(places) if len(asked.places) == 3 else beside(places, side.length, SIDES[side.side])
    return Dyads(end, points) if side.pin is not None else Dyads(points, end)


def both_points(asked: Asked) -> dict[str, Shown] | None:
    """Places of the points of both links with a sound four-bar of sensible size, as near to those given as some tried
    over the whole task are; with two positions beside the given lengths."""
    links, away, letters = [], [], []
    middle = np.mean(np.asarray(asked.places, complex))
    for name in ("AB", "DC"):
        side = asked.sides[name]
        points = asked.size * (GRID[:, None] + 1j * GRID).ravel() + (0 if side.pin is not None else middle)
        own = _links(asked, name, points)
        with np.errstate(all="ignore"):
            length = np.abs(asked.poses.on_frame(own.pin)[..., 0] - own.pivot) / asked.size
            here = exists(asked, own) & (length > SHORTEST) & ((length < SENSIBLE) | (len(asked.places) == 2))
        links.append(own[here])
        away.append(np.abs(points[here] - complex(side.pin if side.pin is not None else side.pivot)))
        letters.append(_letter(side, name))
    one, other = links[0][:, None], links[1][None, :]
    with np.errstate(all="ignore"):
        least = np.where(sound(asked, one, other), marks(asked.poses, one, other).least, 0.0)
    if not np.max(least, initial=0.0) > 0:
        return None
    good = least >= min(USABLE, float(np.max(least)))
    cost = np.where(good, away[0][:, None] + away[1][None, :], np.inf)
    rows = np.unravel_index(int(np.argmin(cost)), cost.shape)
    values: dict[str, Shown] = {"first": (letters[0], "word"), "second": (letters[1], "word")}
    for n, (own, row) in enumerate(zip(links, rows, strict=True)):
        side = asked.sides[("AB", "DC")[n]]
        place = complex((own.pin if side.pin is not None else own.pivot)[row])
        values |= {f"x{n}": (place.real, "length"), f"y{n}": (place.imag, "length")}
    return values


def _letter(side: Side, name: str) -> str:
    return name[1] if side.pin is not None else name[0]


def _with(asked: Asked, name: str, rest: Dyads | None, far: float = FAR, least: float = 0.0) -> Callable[[Any], Any]:
    """Whether the four-bar of other places of the point (m) is sound."""

    def good(points: Any) -> Any:
        own = _links(asked, name, points)
        if rest is None or asked.keep:
            gaps = np.inf if rest is None else np.minimum(abs(own.pin - rest.pin), abs(own.pivot - rest.pivot))
            return exists(asked, own, far) & (gaps > SAME * asked.size)
        return sound(asked, *pair(name, own, rest), far, least)

    return good


def _nearest(asked: Asked, name: str, good: Callable[[Any], Any]) -> tuple[float, dict[str, Shown]] | None:
    """Distance (m) and coordinates of the nearest place that is good: of the first ring with a good place, drawn in
    along its direction and its neighbours until it is not good."""
    side = asked.sides[name]
    given = complex(side.pin if side.pin is not None else side.pivot)
    angles = 2 * np.pi * np.arange(ROUND) / ROUND
    radii = asked.size * RINGS[:, None, None]
    around = ROOM * np.array([0, 1, 1j, -1, -1j])
    here = np.all(good(given + radii * (np.exp(1j * angles)[:, None] + around)), axis=-1)
    if not np.any(here):
        return None
    ring = int(np.argmax(np.any(here, axis=-1)))
    outer, inner = (asked.size * RINGS[ring], asked.size * RINGS[ring - 1] if ring else 0.0)
    angles = angles[here[ring]]
    reach = _drawn(good, given, angles, outer, inner)
    angle, radius = float(angles[np.argmin(reach)]), float(np.min(reach))
    step, tried = 2 * np.pi / ROUND, [(float(angles[0]), float(outer)), (angle, radius)]
    for _ in range(ROUNDS):
        fan = angle + step * FAN
        fan = fan[good(given + radius * np.exp(1j * fan))]
        if len(fan):
            reach = _drawn(good, given, fan, radius, 0.0)
            angle, radius = float(fan[np.argmin(reach)]), float(np.min(reach))
            tried.append((angle, radius))
        step /= 2
    surely = SURELY * asked.size * np.array([0, 1, 1j, -1, -1j])  # the nearest may lie in a spike of no width
    every = (
        given + (radius + inwards * asked.size) * np.exp(1j * angle)
        for angle, radius in tried[::-1] for inwards in INWARDS * np.array([1.0, 4.0, 16.0, 64.0])
    )  # fmt: skip
    place = next((place for place in every if np.all(good(place + surely))), given + outer * np.exp(1j * angles[0]))
    way = np.array([place.real - given.real, place.imag - given.imag])
    signs = np.where(way < 0, -1.0, 1.0)
    more = ROUNDED * np.array([abs(place.real), abs(place.imag)]) * signs
    whole = bool(np.all(good(place + np.array([more[0], 1j * more[1], more[0] + 1j * more[1]]))))
    ends = ["exact" if not whole else "least" if sign > 0 else "most" for sign in signs]
    return abs(place - given), {
        "x": (float(place.real), "length", ends[0]), "y": (float(place.imag), "length", ends[1])
    }  # fmt: skip


def _drawn(good: Callable[[Any], Any], given: complex, angles: Any, outer: float, inner: float) -> Any:
    """Least radii in these directions, all good at the outer one."""
    inside, outside = np.full(len(angles), outer), np.full(len(angles), inner)
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        here = good(given + middle * np.exp(1j * angles))
        inside, outside = np.where(here, middle, inside), np.where(here, outside, middle)
    return inside
