"""Four-bar by k and both extreme positions C1, C2 of its rocker: the family of pivots A, and a choice in it.

C1C2 = 2 h is seen from A under theta = pi (k - 1)/(k + 1): A lies on one of two arcs of equal circles, on D's side of
C1C2 or beyond it. With beta the angle A C2 C1, w = l2/h is a place along the arc that theta = 0 does not spoil:
    sin(beta + theta/2) = w sin(theta/2),
    l1 = (AC2 - AC1)/2 = h cos(beta + theta/2)/cos(theta/2),  l2 = AC2 - l1 = w h.
The triangles A C1 D and A C2 D make the crank turn fully; both positions belong to one motion when C1 and C2 lie on one
side of AD, so that the rocker does not pass its dead position, and AC2 > AC1 is the order of the positions:
    0 < beta < pi/2 - psi/2 - theta beyond C1C2,  0 < beta < pi/2 - |psi/2 - theta/2| - theta/2 on D's side.
Along each arc l4 = AD is monotonic, for the nearest and the farthest place of a circle lie on the line to its centre;
l2 grows from h on, l1 falls from h on (with k = 1 it is h everywhere).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.roots import roots
from tmm_cli.synthesis.crank_slider import k_of, theta_of
from tmm_cli.synthesis.four_bar_family import construction, diagrams
from tmm_cli.synthesis.measures import crank_turns, end_angle, pressure, ratio, stroke
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Shown, Value
from tmm_cli.vectors import pi

PARAMETERS: Final = {**dict.fromkeys(("l1", "l2", "l4", "xA", "yA"), "length"), "phi2": "angle"}
W: Final = "synthesis_four_bar_by_k"
SIDES: Final = (-1, 1)  # the arc on D's side of C1C2, the arc beyond
END: Final = 1e-9  # of an arc: how near its ends a pivot is looked for
ARC: Final = 1e-5  # rad: on a shorter arc the rocker is dead as good as everywhere
SLACK: Final = 1 - 1e-9  # of that, for rounding
STEP: Final = 1e-14  # the least step of a derivative, relative
SCAN: Final = 100  # values of theta that are tried for level supports
LEVEL: Final = 1e-6  # rad of theta, from where a pivot is level first: an end of an arc
FARTHEST: Final = 1e6  # l2 over half C1C2 where the arc is a straight line


@dataclass(frozen=True)
class Asked:
    """Rocker l3 (m), its extreme angles (rad), k, its support D; and the choice of A.

    psi1: where crank and coupler overlap, psi2: where they are in line. choose: best, level, near (a
    place), l1, l2 or l4 (m). sense: of the crank (1: counterclockwise) with the slow stroke from psi1 to psi2; 0: any.
    """

    l3: Any
    psi1: Any
    psi2: Any
    k: Any
    support: Any = 0j
    choose: str = "best"
    l1: Any = None
    l2: Any = None
    l4: Any = None
    near: Any = None
    sense: int = 0

    @property
    def swing(self) -> Any:
        return np.abs(np.asarray(self.psi2) - self.psi1)

    @property
    def theta(self) -> Any:
        return theta_of(self.k)


@dataclass(frozen=True)
class Found:
    """Lengths (m), the pivot a (complex, m), the slope of a over w, the largest pressure angle and beta (rad).

    side: -1 on D's side of C1C2, 1 beyond; sense: of the crank whose slow stroke leads from psi1 to psi2.
    """

    w: Any
    side: Any
    l1: Any
    l2: Any
    l4: Any
    a: Any
    slope: Any
    pressure: Any
    beta: Any
    sense: Any


def widest(asked: Asked, side: Any) -> Any:
    """The bound of beta on an arc; negative where the arc has no pivot."""
    half, theta = asked.swing / 2, asked.theta
    return np.where(
        np.asarray(side) > 0, pi(1.0 * half) / 2 - half - theta,
        pi(1.0 * half) / 2 - np.abs(half - theta / 2) - theta / 2,
    )  # fmt: skip


def bound(asked: Asked, side: Any) -> Any:
    """The bound of w on an arc that has pivots."""
    sine = np.sin(asked.theta / 2)
    most = np.sin(widest(asked, side) + asked.theta / 2) / np.where(sine > 0, sine, 1.0)
    return np.where(sine > 0, np.minimum(most, FARTHEST), FARTHEST)


def at(asked: Asked, w: Any, side: Any) -> Found:
    """The four-bar whose pivot A stands at a place of an arc."""
    half, theta, l3 = asked.swing / 2, asked.theta, asked.l3
    h, s, c = l3 * np.sin(half), np.sin(theta / 2), np.cos(theta / 2)
    sine = w * s
    cosine = np.sqrt((1 - sine) * (1 + sine))
    l1, l2 = h * cosine / c, h * w
    turn = c * cosine + s * sine + 1j * side * s * (w * c - cosine)  # e^(i beta), of the side
    local = l3 * np.cos(half) + 1j * h - 1j * (l1 + l2) * turn  # D at 0, the middle of the swing along x, C1 below
    slope = -1j * (cosine + 1j * side * sine) ** 2 * h / (c * cosine)
    l4 = np.abs(local)
    sines = [np.abs((l2 * l2 + l3 * l3) - (l4 + sign * l1) ** 2) / (2 * l2 * l3) for sign in (-1, 1)]
    way = np.where(np.asarray(asked.psi2) > asked.psi1, 1, -1)
    middle = (np.asarray(asked.psi1) + asked.psi2) / 2
    frame = np.cos(middle) + 1j * np.sin(middle)
    a, slope = ((np.where(way > 0, z, np.conj(z)) * frame)[()] for z in (local, slope))
    return Found(
        w, side, l1, l2, l4, asked.support + a, slope, np.arcsin(np.minimum(np.maximum(*sines), 1)),
        np.arctan2(s * (w * c - cosine), c * cosine + s * sine), -side * way,
    )  # fmt: skip


def arcs(asked: Asked) -> list[int]:
    """The sides whose arcs have pivots; with k = 1 both are the same straight line."""
    if asked.k == 1:
        return [-1]
    way = 1 if asked.psi2 > asked.psi1 else -1
    return [side for side in SIDES if widest(asked, side) >= ARC * SLACK and asked.sense in (0, -side * way)]


def places(asked: Asked, side: int, count: int = 400) -> Any:
    """Places w along an arc, close together where the mechanism changes fast, from end to end."""
    theta, most = float(asked.theta), float(bound(asked, side))
    by_ratio = 1 + np.geomspace(END, 1, count) * (most - 1)
    if theta < 1e-9:
        return by_ratio
    beta = float(widest(asked, side)) * np.linspace(END, 1 - END, count)
    by_angle = np.sin(beta + theta / 2) / np.sin(theta / 2)
    ends = 1 + END * (most - 1), most - END * (most - 1)
    return np.unique(np.clip(np.concatenate((by_ratio, by_angle)), *ends))


def _pressure(found: Found, _: Asked) -> Any:
    return found.pressure


def _away(found: Found, asked: Asked) -> Any:
    return np.abs(found.a - asked.near)


def _rise(f: Found, asked: Asked) -> Any:
    """Proportional to the rise of the sine of the largest pressure angle over w."""
    half, theta, l3 = asked.swing / 2, asked.theta, asked.l3
    h, s, c = l3 * np.sin(half), np.sin(theta / 2), np.cos(theta / 2)
    l1_rise = -f.w * (h * s / c) ** 2 / f.l1
    l4_rise = np.real(np.conj(f.a - asked.support) * f.slope) / f.l4
    found = []
    for sign in (-1, 1):
        reach = f.l4 + sign * f.l1
        over = f.l2 * f.l2 + l3 * l3 - reach * reach
        rise = 2 * (f.l2 * h - reach * (l4_rise + sign * l1_rise)) - over * h / f.l2
        found.append((np.abs(over), np.sign(over) * rise))
    (near, near_rise), (far, far_rise) = found
    return np.where(near > far, near_rise, far_rise)[()]


# what is least at the pivot that is asked for, and what vanishes there
LEAST: Final[Mapping[str, Callable[[Found, Asked], Any]]] = {"best": _pressure, "near": _away}
EQUATIONS: Final[Mapping[str, Callable[[Found, Asked], Any]]] = {
    "l1": lambda found, asked: found.l1 - asked.l1,
    "l2": lambda found, asked: found.l2 - asked.l2,
    "l4": lambda found, asked: found.l4 - asked.l4,
    "level": lambda found, asked: np.imag(found.a - asked.support),
    "best": _rise,
    "near": lambda found, asked: np.real(np.conj(found.a - asked.near) * found.slope),
}


def _crossings(asked: Asked, side: int, function: Any) -> list[Any]:
    """Where a function of what is found vanishes along an arc."""
    w = places(asked, side)
    values = function(at(asked, w, side), asked)
    here = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    if not here.size:
        return []
    return list(roots(lambda x: function(at(asked, x, side), asked), w[here], w[here + 1]))


def _best(asked: Asked, side: int, choice: str) -> Any:
    """Where something of what is found is least along an arc: where its slope vanishes, or an end of the arc."""
    w = places(asked, side)
    here = int(np.argmin(LEAST[choice](at(asked, w, side), asked)))
    if here in (0, len(w) - 1):
        return w[here]
    around = w[[here - 1]], w[[here + 1]]
    return roots(lambda x: EQUATIONS[choice](at(asked, x, side), asked), *around)[0]


def inside(asked: Asked, w: Any, side: int) -> bool:
    """Whether a place is not one of the ends of an arc."""
    low, high = places(asked, side)[[0, -1]]
    near = END * (high - 1)
    return bool(low + 2 * near < w < high - 2 * near)


def _plain(asked: Asked) -> Asked:
    """The same in ordinary precision, for searching; the answer is polished in that of the data."""
    plain: dict[str, Any] = {
        name: complex(value) if name in ("support", "near") else float(value)
        for name, value in vars(asked).items() if value is not None and name not in ("choose", "sense")
    }  # fmt: skip
    return replace(asked, **plain)


def choose(asked: Asked) -> Found:
    """The pivot that was asked for; the one of best transmission where several are. Raises Infeasible."""
    plain = _plain(asked)
    equation, goal = EQUATIONS[asked.choose], LEAST.get(asked.choose, _pressure)
    if asked.choose in LEAST:
        found = [(_best(plain, side, asked.choose), side) for side in arcs(plain)]
    else:
        found = [(w, side) for side in arcs(plain) for w in _crossings(plain, side, equation)]
    if not found:
        _not_there(plain)
    w, side = min(found, key=lambda one: float(goal(at(plain, *one), plain)))
    if not inside(plain, w, side):
        return _at_end(asked, w, side)
    for _ in range(4):  # the same in the precision of the data
        step = max(1e-7 * (w - 1), STEP * w)
        value, beyond = (equation(at(asked, x, side), asked) for x in (w, w + step))
        if beyond == value:
            break
        w = w - step * value / (beyond - value)
    return at(asked, w, side)


def _at_end(asked: Asked, w: Any, side: int) -> Found:
    """At the ends of the arcs the rocker is dead; far away on an arc that is nearly straight it is not."""
    plain = _plain(asked)
    if asked.choose != "near":
        return at(asked, w, side)
    other = at(plain, _best(plain, side, "best") if plain.k > 1 else 3.0, side)
    values = {"x": (other.a.real, "length"), "y": (other.a.imag, "length")}
    raise Infeasible("near", f"{W}.near_end", f"{W}.near_inside", values)


def _not_there(asked: Asked) -> None:
    """No pivot of the arcs is what was asked for: says what there is."""
    if asked.choose == "level":
        raise _not_level(asked)
    h, name = float(asked.l3 * np.sin(asked.swing / 2)), asked.choose
    if name == "l1" and asked.k == 1:
        raise Infeasible("l1", f"{W}.l1_same", f"{W}.l1_others", {"l1": (h, "length")})
    if name in ("l1", "l2"):
        last = [float(getattr(at(asked, places(asked, side)[-1], side), name)) for side in arcs(asked)]
        bounds: dict[str, Shown] = {"low": (min(h, *last), "length", "above"), "high": (max(h, *last), "length", "below")}
        raise Infeasible(name, f"{W}.{name}_none", f"{W}.{'l4_range_line' if asked.k == 1 else 'l4_range'}", bounds)
    l3 = float(asked.l3)
    if asked.k == 1:
        raise Infeasible("l4", f"{W}.l4_none", f"{W}.l4_range_line", {"low": (l3, "length", "above")})
    ends = [l3, *(float(at(asked, places(asked, side)[-1], side).l4) for side in arcs(asked))]
    values = {
        "low": (min(ends), "length", "above"), "high": (max(ends), "length", "below"), "l3": (l3, "length"),
    }  # fmt: skip
    inner = min(ends) < l3 < max(ends)  # there A would be C1
    raise Infeasible("l4", f"{W}.l4_none", f"{W}.l4_range_but" if inner else f"{W}.l4_range", values)


def refuse(asked: Asked) -> None:
    """Raises Infeasible with the reason and what could be met."""
    for name in ("l1", "l2", "l3", "l4"):
        value = getattr(asked, name)
        if value is not None and not value > 0:
            raise Infeasible(name, f"{W}.positive", f"{W}.more_than_zero")
    if not asked.k >= 1:
        _refuse_small(asked)
    psi1, widest_swing = float(asked.psi1), np.pi - 2 * ARC
    if not 0 < asked.swing <= widest_swing:
        ends = {"low": (psi1 - widest_swing, "angle", "least"), "high": (psi1 + widest_swing, "angle", "most")}
        raise Infeasible("psi2", f"{W}.swing", f"{W}.swing_range", {"psi1": (psi1, "angle"), **ends})
    theta, half = float(asked.theta), float(asked.swing) / 2
    if theta > np.pi / 2 + half - ARC:
        way = 1 if asked.psi2 > asked.psi1 else -1
        swing = psi1 + way * (2 * theta - np.pi + 2 * ARC)
        values = {
            "k": (float(k_of(np.pi / 2 + half - ARC)), "number", "most"),
            "psi2": (swing, "angle", "least" if way > 0 else "most"),
        }
        words = "k_most_alone" if theta > np.pi - 2 * ARC else "k_most" if way > 0 else "k_most_down"
        raise Infeasible("k", f"{W}.k_above", f"{W}.{words}", values)
    if not arcs(asked):  # only the arc beyond C1C2 gives this sense
        most = np.pi / 2 - half - ARC
        values = {"k": (float(k_of(most)), "number", "most")}
        raise Infeasible("turns", f"{W}.sense", f"{W}.sense_most" if most > 0 else f"{W}.sense_other", values)
    if theta == 0 and asked.choose == "best":
        raise Infeasible("k", f"{W}.best_none", f"{W}.best_others", {"pressure": (half, "angle")})


def _refuse_small(asked: Asked) -> None:
    """k below 1: the same strokes the other way round, where they are possible, or the largest k that is."""
    if not asked.k > 0:
        raise Infeasible("k", f"{W}.k_below", f"{W}.k_zero")
    try:
        refuse(replace(asked, k=1 / asked.k))
    except Infeasible as error:
        if "k" not in error.values:
            raise
        raise Infeasible("k", f"{W}.k_below", f"{W}.k_range", {"k": error.values["k"]}) from None
    raise Infeasible("k", f"{W}.k_below", f"{W}.k_least", {"k": (1 / asked.k, "number", "most")})


def _not_level(asked: Asked) -> Infeasible:
    """No pivot is as high as D: how near they come, and the nearest k for which one is."""

    def gap(k: float) -> float:
        """The offset from D that is nearest to none; 0 where a pivot is level."""
        tried = replace(asked, k=k)
        offsets = [np.imag(at(tried, places(tried, side), side).a - asked.support) for side in arcs(tried)]
        if any(np.min(row) <= 0 <= np.max(row) for row in offsets):
            return 0.0
        every = np.concatenate([*offsets, [np.inf]])
        return float(every[np.argmin(np.abs(every))])

    offset = gap(float(asked.k))
    values: dict[str, Shown] = {"offset": (abs(offset), "length")}
    words = "level_higher" if offset > 0 else "level_lower"
    theta = float(asked.theta)
    least, most = 1e-3, np.pi / 2 + float(asked.swing) / 2 - 2 * ARC
    shares = np.linspace(0, 1, SCAN)[1:]
    tried = sorted([*(theta + (most - theta) * shares), *(theta + (least - theta) * shares)], key=lambda x: abs(x - theta))
    good = next((x for x in tried if gap(float(k_of(x))) == 0), None)
    if good is None:
        return Infeasible("choose", f"{W}.level_none", f"{W}.{words}", values)
    inside, outside = good, theta
    for _ in range(30):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if gap(float(k_of(middle))) == 0 else (inside, middle)
    up = good > theta
    inside += (1 if up else -1) * LEVEL
    values["k"] = (float(k_of(inside)), "number", "least" if up else "most")
    return Infeasible("choose", f"{W}.level_none", f"{W}.{words}_{'more' if up else 'less'}", values)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(asked)
    f = choose(asked)
    kinds = {
        "l3": "length", "psi1": "angle", "psi2": "angle", "k": "number", "l1": "length", "l2": "length", "l4": "length",
    }  # fmt: skip
    given = [
        Value(n, getattr(asked, n), kind, f"{W}.{n}") for n, kind in kinds.items() if getattr(asked, n) is not None
    ]
    given.append(Value("", None, "word", f"{W}.choose", f"{W}.choose_{asked.choose}"))
    lengths = {"l1": f.l1, "l2": f.l2, "l4": f.l4, "xA": np.real(f.a), "yA": np.imag(f.a)}
    found = [Value(name, value, "length", f"{W}.{name}") for name, value in lengths.items()]
    at_c2 = asked.support + asked.l3 * (np.cos(asked.psi2) + 1j * np.sin(asked.psi2)) - f.a
    found += [
        Value("phi2", np.arctan2(at_c2.imag, at_c2.real), "angle", f"{W}.phi2"),
        Value("", asked.theta, "angle", f"{W}.theta"),
        Value("", f.pressure, "angle", f"{W}.pressure"),
    ]
    if asked.choose == "near":
        found.append(Value("", np.abs(f.a - asked.near), "length", f"{W}.away"))
    if asked.k > 1:
        found += _on_arcs(asked, f)
    demands = [
        Demand(f"{W}.crank_turns", 1.0, "number", crank_turns, asked=False),
        Demand(f"{W}.k", float(asked.k), "number", ratio),
        Demand(f"{W}.swing_is", float(asked.swing), "angle", stroke),
        *(Demand(f"{W}.{n}", float(v), "angle", partial(end_angle, near=float(v)), at=1.0)
          for n, v in (("psi1", asked.psi1), ("psi2", asked.psi2))),
        Demand(f"{W}.pressure", float(f.pressure), "angle", pressure, asked=False),
    ]  # fmt: skip
    plain = _plain(asked)
    chosen = at(plain, float(f.w), f.side)
    family = [at(plain, places(plain, side), side) for side in arcs(plain)]
    drawings = (construction(plain, chosen, family), *diagrams(plain, chosen, family))
    notes = () if asked.k > 1 else (f"{W}.line",)
    return Outcome(tuple(given), tuple(found), f"{W}.source", tuple(demands), drawings, notes)


def _on_arcs(asked: Asked, f: Found) -> list[Value]:
    """Where the pivot stands, what that means for the crank, and how far the admissible arcs reach."""
    values = [
        Value("", f.beta, "angle", f"{W}.beta"),
        Value("", None, "word", f"{W}.side", f"{W}.side_{'beyond' if f.side > 0 else 'inside'}"),
        Value("", None, "word", f"{W}.sense_is", f"{W}.{'ccw' if f.sense > 0 else 'cw'}"),
    ]
    for side in arcs(asked):
        name = "beyond" if side > 0 else "inside"
        last = at(_plain(asked), places(asked, side)[-1], side)
        values.append(Value("", widest(asked, side), "angle", f"{W}.arc_{name}"))
        values.append(Value("", last.l4, "length", f"{W}.end_{name}"))
    return values
