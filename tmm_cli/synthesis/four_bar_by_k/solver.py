"""Four-bar by k and both extreme positions of its rocker: the choice of the pivot A on its arcs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.roots import roots
from tmm_cli.synthesis.four_bar_by_k.arcs import (
    ARC,
    Found,
    Task,
    arcs,
    at,
    bound,
    level_places,
    places,
    whole,
    widest,
)  # fmt: skip
from tmm_cli.synthesis.four_bar_by_k.drawing import construction, diagrams, listing, side_name
from tmm_cli.synthesis.mean_ratio import k_of
from tmm_cli.synthesis.measures import crank_turns, end_angle, pressure, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Shown, Value

PARAMETERS: Final = {**dict.fromkeys(("l1", "l2", "l4", "xA", "yA"), "length"), "phi2": "angle"}
QUANTITIES: Final = {  # that a task may give: kind and what they are called
    "l3": ("length", _("rocker l3")),
    "psi1": ("angle", _("rocker at C1 (crank over the coupler) psi1")),
    "psi2": ("angle", _("rocker at C2 (crank in line with the coupler) psi2")),
    "k": ("number", _("k")),
    "l1": ("length", _("crank l1")), "l2": ("length", _("coupler l2")), "l4": ("length", _("frame l4")),
}  # fmt: skip
SAME: Final = 1e-6  # of the sizes: a pivot of one arc is that near to itself, and to none of the other
INSIDE: Final = 4e-5  # of a range of lengths: how far from its ends, where the rocker is dead, a length is told
SOUND: Final = np.radians(80)  # the largest pressure angle of a pivot that is told instead of one with a dead rocker


def _pressure(found: Found, __: Task) -> Any:
    return found.pressure


def _away(found: Found, task: Task) -> Any:
    return np.abs(found.a - task.near)


def _rise(f: Found, task: Task) -> Any:
    """Proportional to the rise of the sine of the largest pressure angle over w."""
    half, theta, l3 = task.swing / 2, task.theta, task.l3
    h, s, c = l3 * np.sin(half), np.sin(theta / 2), np.cos(theta / 2)
    l1_rise = -f.w * (h * s / c) ** 2 / f.l1
    l4_rise = np.real(np.conj(f.a - task.support) * f.slope) / f.l4
    found = []
    for sign in (-1, 1):
        reach = f.l4 + sign * f.l1
        over = f.l2 * f.l2 + l3 * l3 - reach * reach
        rise = 2 * (f.l2 * h - reach * (l4_rise + sign * l1_rise)) - over * h / f.l2
        found.append((np.abs(over), np.sign(over) * rise))
    (near, near_rise), (far, far_rise) = found
    return np.where(near > far, near_rise, far_rise)[()]


# what is least at the pivot that is asked for, and what vanishes there
LEAST: Final[Mapping[str, Callable[[Found, Task], Any]]] = {"best": _pressure, "near": _away}
EQUATIONS: Final[Mapping[str, Callable[[Found, Task], Any]]] = {
    "l1": lambda found, task: found.l1 - task.l1,
    "l2": lambda found, task: found.l2 - task.l2,
    "l4": lambda found, task: found.l4 - task.l4,
    "level": lambda found, task: np.imag(found.a - task.support),
    "best": _rise,
    "near": lambda found, task: np.real(np.conj(found.a - task.near) * found.slope),
}


def _crossings(task: Task, side: int, function: Any) -> list[Any]:
    """Where a function of what is found vanishes along an arc."""
    if task.choose == "level":
        fair = [w for w in level_places(task) if 1 < w < bound(task, side)]
        return [w for w in fair if abs((f := at(task, w, side)).a.imag) < SAME * (f.l2 + task.l3)]
    w = places(task, side)
    values = function(at(task, w, side), task)
    here = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    if not here.size:
        return []
    return list(roots(lambda x: function(at(task, x, side), task), w[here], w[here + 1]))


def _best(task: Task, side: int, choice: str) -> Any:
    """Where something of what is found is least along an arc: where its slope vanishes, or an end of the arc."""
    w = places(task, side)
    here = int(np.argmin(LEAST[choice](at(task, w, side), task)))
    if here in (0, len(w) - 1):
        return w[here]
    around = w[[here - 1]], w[[here + 1]]
    return roots(lambda x: EQUATIONS[choice](at(task, x, side), task), *around)[0]


def choose(task: Task) -> Found:
    """The pivot that was asked for; the one of best transmission where several are. Raises Infeasible.

    It is looked for with D in the origin: a support that is far away takes no digits.
    """
    near = None if task.near is None else task.near - task.support
    centred = replace(task, support=0 * task.support, near=near)
    if task.choose in LEAST:
        found = [(_best(centred, side, task.choose), side) for side in arcs(centred)]
    else:
        found = [(w, side) for side in arcs(centred) for w in _crossings(centred, side, EQUATIONS[task.choose])]
    if not found:
        raise _not_there(centred)
    goal = LEAST.get(task.choose, _pressure)
    w, side = min(found, key=lambda one: float(goal(at(centred, *one), centred)))
    if task.choose == "near" and w in places(centred, side)[[0, -1]]:
        raise _dead(centred, complex(task.support))
    f = at(centred, w, side)
    return replace(f, a=task.support + f.a)


def _dead(task: Task, support: complex) -> Infeasible:
    """The nearest place is an end of an arc: tells the nearest pivot whose rocker is far from its dead position."""
    along = [at(task, places(task, side), side) for side in arcs(task)]
    a, angle = (np.concatenate([np.atleast_1d(getattr(f, name)) for f in along]) for name in ("a", "pressure"))
    most = max(float(np.min(angle)), SOUND)
    here = support + complex(a[np.argmin(np.where(angle <= most, np.abs(a - task.near), np.inf))])
    return Infeasible(
        "near", _("the nearest place of the admissible arcs is an end of them, where the rocker is dead"),
        _("[{x}, {y}]: the nearest pivot with a largest pressure angle of {most} or less"),
        {"x": (here.real, "length"), "y": (here.imag, "length"), "most": (most, "angle")},
    )  # fmt: skip


def _not_there(task: Task) -> Infeasible:
    """No pivot of the arcs is what was asked for: says what there is."""
    if task.choose == "level":
        return Infeasible("choose", _("no pivot of the admissible arcs is as high as D"), _("best transmission"))
    if task.choose == "l1" and task.k == 1:
        return Infeasible("l1", _("with k = 1 every crank is half of C1C2"), None)
    reason = {
        "l1": _("no pivot of the admissible arcs gives such a crank"),
        "l2": _("no pivot of the admissible arcs gives such a coupler"),
        "l4": _("no pivot of the admissible arcs is at this distance from D"),
    }[task.choose]
    first = float(task.l3 if task.choose == "l4" else task.l3 * np.sin(task.swing / 2))
    last = [float(getattr(at(task, places(task, side)[-1], side), task.choose)) for side in arcs(task)]
    return Infeasible(task.choose, reason, _within(task, float(getattr(task, task.choose)), first, last))


def _within(task: Task, given: float, first: float, last: list[float]) -> Shown:
    """The length (m) nearest to the given one, a little inside the ends of the arcs: there the rocker is dead.

    first: where both arcs begin; last: where each of them ends.
    """
    low, high = min(first, *last), max(first, *last)
    if low < first < high:
        low, high = (low, first) if given < first else (first, high)
    width = low if task.k == 1 else high - low
    if task.k > 1 and given > (low + high) / 2:
        return high - INSIDE * width, "length", "most"
    return max(low + INSIDE * min(low, width), SMALLEST), "length", "least"


def refuse(task: Task) -> None:
    """Raises Infeasible with the reason and what could be met."""
    if not task.l3 > 0:
        raise Infeasible("l3", _("there is no such link"), (SMALLEST, "length", "least"))
    if not task.k >= 1:
        raise Infeasible("k", _("k is the time of the working stroke over that of the idle one, the shorter"),
                         (1.0, "number", "above" if task.choose == "best" else "least"))  # fmt: skip
    theta, half, way = float(task.theta), float(task.swing) / 2, -1 if task.psi2 < task.psi1 else 1
    against = task.sense == -way  # in the slow stroke the crank turns against the rocker: only beyond C1C2
    if not 0 < task.swing <= np.pi - 2 * ARC:
        least, most = max(2 * SMALLEST / float(task.l3), 2 * (theta + ARC) - np.pi), np.pi - 2 * ARC
        if against:
            least, most = 2 * SMALLEST / float(task.l3), most - 2 * theta
        swing = most if half > 0 else least
        side = "most" if (half > 0) == (way > 0) else "least"
        raise Infeasible("psi2", _("a rocker swings by more than zero and less than 180 deg"),
                         (float(task.psi1) + way * swing, "angle", side))  # fmt: skip
    beyond, nearer = np.pi / 2 - half - ARC, np.pi / 2 + half - ARC  # the largest theta of either arc
    if theta > nearer:
        reason = _("k is too large for this swing: on the whole circle the rocker would pass its dead position, or "
                   "stand all but in it")  # fmt: skip
        raise Infeasible("k", reason, (float(k_of(beyond if against and beyond > 0 else nearer)), "number", "most"))
    if against and theta > beyond:
        raise Infeasible("turns", _("with this sense of the crank the slow stroke leads from psi2 to psi1"),
                         "cw" if task.sense > 0 else "ccw")  # fmt: skip
    if theta == 0 and task.choose == "best":
        raise Infeasible(
            "k", _("with k = 1 no pivot is the best: the pressure angle falls towards psi/2 the farther A is"),
            (1.0, "number", "above"),
        )  # fmt: skip


def solve(task: Task) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(task)
    f = choose(task)
    demands = [
        Demand(_("crank turns fully (1: yes)"), 1.0, "number", crank_turns, asked=False),
        Demand(_("k"), float(task.k), "number", ratio),
        Demand(_("swing psi of the rocker"), float(task.swing), "angle", stroke),
        *(Demand(QUANTITIES[n][1], float(v), "angle", partial(end_angle, near=float(v)), at=1.0)
          for n, v in (("psi1", task.psi1), ("psi2", task.psi2))),
        Demand(_("largest pressure angle"), float(f.pressure), "angle", pressure, asked=False, of="pressure"),
    ]  # fmt: skip
    family = [at(task, whole(task, side), side) for side in arcs(task)]
    source = _("circle through C1 and C2 on which C1C2 is seen under theta = pi (k - 1)/(k + 1); l1 = (AC2 - AC1)/2, "
               "l2 = AC2 - l1, l4 = AD; C1 and C2 on one side of AD")  # fmt: skip
    notes = () if task.k > 1 else (_("with k = 1 the circle is the line C1C2: A is any place of it beyond C1"),)
    return Outcome(
        _given(task), _found(task, f), source, tuple(demands),
        (construction(task, f, family), *diagrams(task, f, family)), notes, (listing(family),),
    )  # fmt: skip


def _given(task: Task) -> tuple[Value, ...]:
    choice = {
        "best": _("best transmission: the least largest pressure angle"),
        "level": _("supports level: A as high as D"),
        "l1": _("by the length of the crank"),
        "l2": _("by the length of the coupler"),
        "l4": _("by the length of the frame"),
        "near": _("nearest to a given place"),
    }[task.choose]
    given = [Value(n, getattr(task, n), *what) for n, what in QUANTITIES.items() if getattr(task, n) is not None]
    return *given, Value("", choice, "word", _("choice of A"))


def _found(task: Task, f: Found) -> tuple[Value, ...]:
    """The four-bar, where its pivot stands, what that means for the crank, and how far the admissible arcs reach."""
    at_c2 = task.support + task.l3 * (np.cos(task.psi2) + 1j * np.sin(task.psi2)) - f.a
    found = [
        Value("l1", f.l1, *QUANTITIES["l1"]),
        Value("l2", f.l2, *QUANTITIES["l2"]),
        Value("l4", f.l4, *QUANTITIES["l4"]),
        Value("xA", np.real(f.a), "length", _("pivot A of the crank, x")),
        Value("yA", np.imag(f.a), "length", _("pivot A of the crank, y")),
        Value("phi2", np.arctan2(at_c2.imag, at_c2.real), "angle", _("crank at C2, in line with the coupler")),
        Value("", task.theta, "angle", _("theta = C1AC2")),
        Value("", f.pressure, "angle", _("largest pressure angle")),
    ]
    if task.choose == "near":
        found.append(Value("", np.abs(f.a - task.near), "length", _("distance of A from the place that was wanted")))
    if task.k == 1:
        return tuple(found)
    turns = _("counterclockwise") if f.sense > 0 else _("clockwise")
    found += [
        Value("", f.beta, "angle", _("place on the arc, angle AC2C1")),
        Value("", side_name(f), "word", _("arc")),
        Value("", turns, "word", _("crank for a slow stroke from psi1 to psi2")),
    ]
    for side in arcs(task):
        beyond, inside = (_("admissible arc beyond C1C2: angle AC2C1 from 0 to"),
                          _("admissible arc on D's side: angle AC2C1 from 0 to"))  # fmt: skip
        last = at(task, places(task, side)[-1], side)
        found += [
            Value("", widest(task, side), "angle", beyond if side > 0 else inside),
            Value("", last.l4, "length", _("l4 at that end (l3 at the other)")),
        ]
    return tuple(found)
