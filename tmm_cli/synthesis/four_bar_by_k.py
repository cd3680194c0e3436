"""Four-bar by k and both extreme positions of its rocker: the choice of the pivot A on its arcs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.roots import roots
from tmm_cli.synthesis.crank_slider import k_of
from tmm_cli.synthesis.four_bar_arcs import ARC, END, Asked, Found, arcs, at, bound, places, whole
from tmm_cli.synthesis.four_bar_family import construction, diagrams, listing, on_arcs
from tmm_cli.synthesis.four_bar_instead import (
    SOUND,
    frame_on_line,
    largest_k,
    length_and_k,
    nearest_end,
    nearest_frame,
    swings,
)
from tmm_cli.synthesis.four_bar_level import level_places, nearest_sound
from tmm_cli.synthesis.four_bar_nearest import nearest_k, not_level
from tmm_cli.synthesis.measures import crank_turns, end_angle, pressure, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Shown, Value

__all__ = ["PARAMETERS", "Asked", "Found", "arcs", "at", "bound", "choose", "places", "solve"]
PARAMETERS: Final = {**dict.fromkeys(("l1", "l2", "l4", "xA", "yA"), "length"), "phi2": "angle"}
W: Final = "synthesis_four_bar_by_k"
STEP: Final = 1e-14  # the least step of a derivative, relative
SAME: Final = 1e-6  # of the sizes: a pivot of one arc is that near to itself, and to none of the other
OVER: Final = 1 + 1e-5  # k: the least that is told as more than 1
INSIDE: Final = 4e-5  # of a range of lengths: how far from its ends a length is told
CHOSEN: Final = ("level", "l1", "l2", "l4")  # ways to choose A that not every arc offers


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
    if asked.choose == "level":
        fair = [float(w) for w in level_places(asked) if 1 < w < bound(asked, side)]
        return [w for w in fair if abs((f := at(asked, w, side)).a.imag) < SAME * (f.l2 + asked.l3)]
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
    return bool(low + 2 * (low - 1) < w < high - 2 * END * (high - 1))


def _plain(asked: Asked) -> Asked:
    """The same in ordinary precision, for searching; the answer is polished in that of the data."""
    plain: dict[str, Any] = {
        name: complex(value) if name in ("support", "near") else float(value)
        for name, value in vars(asked).items() if value is not None and name not in ("choose", "sense")
    }  # fmt: skip
    return replace(asked, **plain)


def choose(asked: Asked) -> Found:
    """The pivot that was asked for; the one of best transmission where several are. Raises Infeasible.

    It is looked for with D in the origin: a support that is far away takes no digits.
    """
    found = _from_support(_centred(asked), asked.support)
    return replace(found, a=asked.support + found.a)


def _centred(asked: Asked) -> Asked:
    """The same with D in the origin."""
    near = None if asked.near is None else asked.near - asked.support
    return replace(asked, support=0 * asked.support, near=near)


def _from_support(asked: Asked, support: Any) -> Found:
    """The same with D in the origin; support: where D is, for messages."""
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
        if asked.choose == "near":
            _dead_end(plain, support)
        return at(asked, w, side)
    value = equation(at(asked, w, side), asked)
    for _ in range(4):  # the same in the precision of the data
        step = max(1e-7 * (w - 1), STEP * w)
        beyond = equation(at(asked, w + step, side), asked)
        better = w - step * value / (beyond - value) if beyond != value else w
        residual = equation(at(asked, better, side), asked)
        if not (np.abs(residual) < np.abs(value) and inside(plain, better, side)):
            break
        w, value = better, residual
    return at(asked, w, side)


def _dead_end(asked: Asked, support: Any) -> None:
    """At the ends of the arcs the rocker is dead: the nearest pivot where it is far from that."""
    a, most = nearest_sound([at(asked, places(asked, side), side) for side in arcs(asked)], asked.near, SOUND)
    a += complex(support)
    values = {"x": (a.real, "length"), "y": (a.imag, "length"), "pressure": (max(most, SOUND), "angle")}
    raise Infeasible("near", f"{W}.near_end", f"{W}.near_inside", values)


def _not_there(asked: Asked) -> None:
    """No pivot of the arcs is what was asked for: says what there is."""
    if asked.choose == "level":
        error = not_level(asked, EQUATIONS["level"])
        if not {"k", "turn"} & set(error.values):
            error.nearest, error.values = f"{error.nearest}_near", error.values | nearest_frame(asked)
        raise error
    h, name = float(asked.l3 * np.sin(asked.swing / 2)), asked.choose
    if name == "l1" and asked.k == 1:
        values = {"l1": (h, "length"), **frame_on_line(asked)}
        if (k := nearest_k(asked, EQUATIONS["l1"])) is not None:
            raise Infeasible("l1", f"{W}.l1_same", f"{W}.l1_above", values | {"k": k})
        raise Infeasible("l1", f"{W}.l1_same", f"{W}.l1_others", values)
    if name in ("l1", "l2"):
        last = [float(getattr(at(asked, places(asked, side)[-1], side), name)) for side in arcs(asked)]
        words = "l4_range_line" if asked.k == 1 else "l4_range"
        raise Infeasible(name, f"{W}.{name}_none", f"{W}.{words}", _within(asked, h, *last))
    l3 = float(asked.l3)
    if asked.k == 1:
        raise Infeasible("l4", f"{W}.l4_none", f"{W}.l4_range_line", _within(asked, l3))
    ends = [l3, *(float(at(asked, places(asked, side)[-1], side).l4) for side in arcs(asked))]
    values = _within(asked, *ends) | {"l3": (l3, "length")}
    inner = min(ends) < l3 < max(ends)  # there A would be C1
    before, after = _within(asked, min(ends), l3)["high"], _within(asked, l3, max(ends))["low"]
    if inner and before[0] < asked.l4 < after[0]:
        raise Infeasible("l4", f"{W}.l4_none", f"{W}.l4_beside", {"before": before, "after": after})
    raise Infeasible("l4", f"{W}.l4_none", f"{W}.l4_range_but" if inner else f"{W}.l4_range", values)


def _within(asked: Asked, *ends: float) -> dict[str, Shown]:
    """A range of lengths (m) a little inside its ends, where the rocker is dead."""
    low, high = min(ends), max(ends)
    width = low if asked.k == 1 else high - low
    first, last = INSIDE * min(low, width), INSIDE * width
    return {"low": (max(low + first, SMALLEST), "length", "least"), "high": (high - last, "length", "most")}


def refuse(asked: Asked) -> None:
    """Raises Infeasible with the reason and what could be met."""
    if not asked.l3 > 0:  # of the others the range is told that there is
        raise Infeasible("l3", f"{W}.positive", f"{W}.at_least", {"least": (SMALLEST, "length")})
    if not asked.k >= 1:
        _refuse_small(asked)
    psi1 = float(asked.psi1)
    if not 0 < asked.swing <= np.pi - 2 * ARC and (ranges := swings(asked)):
        ends: dict[str, Shown] = {}
        if asked.choose != "best" and (psi2 := nearest_end(_plain(asked), ranges, _chooses)):
            raise Infeasible("psi2", f"{W}.swing", f"{W}.swing_{psi2[2]}", {"psi2": psi2})
        if asked.choose != "best" or asked.k == 1:  # more than the swing must change
            raise Infeasible("psi2", f"{W}.swing", f"{W}.swing_as", {"psi2": (sum(ranges[0]) / 2, "angle")})
        for n, (near, far) in enumerate(ranges):
            sides = ("least", "most") if near < far else ("most", "least")
            ends |= {f"near{n}": (near, "angle", sides[0]), f"far{n}": (far, "angle", sides[1])}
        raise Infeasible("psi2", f"{W}.swing", f"{W}.swing_range{len(ranges)}", ends)
    theta, half = float(asked.theta), float(asked.swing) / 2
    _refuse_sense(asked, theta, half)
    if theta > np.pi / 2 + half - ARC:
        way = 1 if asked.psi2 > asked.psi1 else -1
        swing = psi1 + way * (2 * theta - np.pi + 2 * ARC)
        values: dict[str, Shown] = {
            "k": (float(k_of(np.pi / 2 + half - ARC)), "number", "most"),
            "psi2": (swing, "angle", "least" if way > 0 else "most"),
        }
        if asked.choose in CHOSEN:
            if (k := nearest_k(_centred(asked), EQUATIONS[asked.choose])) is not None:
                raise Infeasible("k", f"{W}.k_above", f"{W}.k_most_alone", {"k": k})
            pair = {} if asked.choose == "level" else length_and_k(_plain(_centred(asked)))
            words = "k_most_length" if pair else "k_most_best"
            raise Infeasible("k", f"{W}.k_above", f"{W}.{words}", {"k": values["k"], **pair}, whole=True)
        if asked.choose == "near":
            if (largest := largest_k(_plain(asked), _chooses)) is None:
                raise Infeasible("k", f"{W}.k_above", f"{W}.k_most_best", values, whole=True)
            raise Infeasible("k", f"{W}.k_above", f"{W}.k_most_alone", {"k": (largest, "number", "most")})
        words = "k_most_alone" if theta > np.pi - 2 * ARC else "k_most" if way > 0 else "k_most_down"
        raise Infeasible("k", f"{W}.k_above", f"{W}.{words}", values)
    if theta == 0 and asked.choose == "best":
        values = {"pressure": (half, "angle"), "k": (1.0, "number", "above"), **frame_on_line(asked)}
        raise Infeasible("k", f"{W}.best_none", f"{W}.best_others", values)


def _refuse_sense(asked: Asked, theta: float, half: float) -> None:
    """Only the arc beyond C1C2 gives a crank that turns against the rocker in the slow stroke, up to some k."""
    way, most, other = 1 if asked.psi2 > asked.psi1 else -1, np.pi / 2 - half - ARC, np.pi / 2 + half - ARC
    if asked.sense != -way or theta <= most:
        return
    values: dict[str, Shown] = {"other": (float(k_of(other)), "number", "most")}
    turned = _chooses(replace(asked, sense=-asked.sense))
    if (k := _most_k(asked, float(k_of(most)) if most > 0 else 1.0)) is not None:
        values["k"] = k
    if turned or not k:
        values["turn"] = ("cw" if asked.sense > 0 else "ccw", "word")
    words = "sense_most" if turned and k else "k_most_alone" if k else "sense_both" if theta > other else "sense_other"
    raise Infeasible("turns", f"{W}.sense", f"{W}.{words}", values)


def _most_k(asked: Asked, most: float) -> Shown | None:
    """The k nearest to a larger one, `most` or less, with which A is what it was chosen to be; None: there is none."""
    if asked.choose in CHOSEN:
        return nearest_k(_plain(_centred(asked)), EQUATIONS[asked.choose])
    if asked.choose == "best":
        return None if most < 2 * OVER - 1 else (most, "number", "most")
    k = largest_k(_plain(replace(asked, k=most)), _chooses)
    return None if k is None else (k, "number", "most")


def _chooses(asked: Asked) -> bool:
    """Whether the task is solved."""
    one = _plain(_centred(asked))
    if not (one.l3 > 0 and one.k >= 1 and 0 < one.swing <= np.pi - 2 * ARC) or (one.k == 1 and one.choose == "best"):
        return False
    if one.choose in LEAST:
        places_by = [(_best(one, side, one.choose), side) for side in arcs(one)]
        w, side = min(places_by, key=lambda place: LEAST[one.choose](at(one, *place), one), default=(None, 0))
        return w is not None and (one.choose == "best" or inside(one, w, side))
    return any(len(_crossings(one, side, EQUATIONS[one.choose])) for side in arcs(one))


def _refuse_small(asked: Asked) -> None:
    """k below 1: the same strokes the other way round, where they are possible, or the nearest k that is."""
    least = next((k for k in (1.0, OVER) if _chooses(replace(asked, k=k))), None)
    values: dict[str, Shown] = {"least": (1.0, "number", "above" if least == OVER else "least")}
    turned = replace(asked, k=1 / asked.k if asked.k > 0 else OVER)
    if asked.k > 0 and _chooses(turned):
        values["k"] = (1 / asked.k, "number", "most")
        raise Infeasible("k", f"{W}.k_below", f"{W}.k_least" if least else f"{W}.k_same", values)
    if least and not asked.k > 0:
        raise Infeasible("k", f"{W}.k_below", f"{W}.k_zero", values)
    try:
        refuse(turned)
        choose(turned)
    except Infeasible as error:
        k = _most_k(turned, float(turned.k)) if asked.choose in CHOSEN else error.values.get("k")
        if k is None:  # what no k would mend is told first
            raise
        words = "k_range" if least else "k_most_alone" if k[2] == "most" else "k_more"
        raise Infeasible("k", f"{W}.k_below", f"{W}.{words}", values | {"k": k}) from None


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
        found += on_arcs(asked, _plain(asked), f)
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
    family = [at(plain, whole(plain, side), side) for side in arcs(plain)]
    drawings = (construction(plain, chosen, family), *diagrams(plain, chosen, family))
    notes = () if asked.k > 1 else (f"{W}.line",)
    return Outcome(tuple(given), tuple(found), f"{W}.source", tuple(demands), drawings, notes, (listing(family),))
