"""Synthesis of a four-bar from the time ratio k and both extreme positions of its rocker: choice of the crank pivot
A.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import find_roots, unit, zero_within_rounding
from tmm_cli.mechanics.quantities import LENGTH
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector
from tmm_cli.synthesis.blocks import TaskBlock, read_numbers
from tmm_cli.synthesis.four_bar_by_k.arcs import (
    SHORTEST_ARC,
    FourBarByKSolution,
    FourBarByKTask,
    admissible_arcs,
    four_bar_at,
    largest_beta,
    largest_w,
    line_offset,
    pivots_on_line,
    sample_arc,
    sample_whole_arc,
)
from tmm_cli.synthesis.four_bar_by_k.drawings import draw_construction, draw_diagrams, side_name, tabulate_family
from tmm_cli.synthesis.measures import (
    driver_completes_range,
    largest_pressure_angle,
    output_stroke,
    stroke_end_angle,
    time_ratio,
)
from tmm_cli.synthesis.record import (
    SMALLEST,
    Demand,
    Infeasible,
    NamedValue,
    SolutionQuality,
    SynthesisOutcome,
    distance_beyond_rounding,
    given_values,
)

PARAMETERS: Final = {**dict.fromkeys(("l1", "l2", "l4", "xA", "yA"), "length"), "phi2": "angle"}
QUANTITIES: Final = {  # quantities that a task may give: kind and description
    "l3": ("length", N_("rocker l3")),
    "psi1": ("angle", N_("rocker angle psi1 at C1 (crank and coupler overlap)")),
    "psi2": ("angle", N_("rocker angle psi2 at C2 (crank and coupler in line)")),
    "k": ("number", N_("k (time ratio)")),
    "l1": ("length", N_("crank l1")),
    "l2": ("length", N_("coupler l2")),
    "l4": ("length", N_("frame l4")),
    "xA": ("length", N_("x coordinate of the crank pivot A")),
    "yA": ("length", N_("y coordinate of the crank pivot A")),
    "pressure": ("angle", N_("largest pressure angle")),
}
ON_LINE: Final = ("level", "xA", "yA")
SAME: Final = 1e-6  # relative: tells a pivot of this arc from one of the other arc


def _get_pressure(four_bar: FourBarByKSolution, __: FourBarByKTask) -> Any:
    return four_bar.pressure


def _compute_extent(four_bar: FourBarByKSolution, __: FourBarByKTask) -> Any:
    return four_bar.l2 + four_bar.l4


def _compute_distance(four_bar: FourBarByKSolution, task: FourBarByKTask) -> Any:
    return np.abs(four_bar.a - task.near)


def _compute_pressure_slope(f: FourBarByKSolution, task: FourBarByKTask) -> Any:
    """Return a positive multiple of the derivative of the sine of the largest pressure angle with respect to w."""
    half, theta, l3 = task.swing / 2, task.theta, task.l3
    h, s, c = l3 * np.sin(half), np.sin(theta / 2), np.cos(theta / 2)
    l1_rise = -f.w * (h * s / c) ** 2 / f.l1
    l4_rise = np.real(np.conj(f.a - task.support) * f.slope) / f.l4
    branches = []
    for sign in (-1, 1):
        reach = f.l4 + sign * f.l1
        over = f.l2 * f.l2 + l3 * l3 - reach * reach
        rise = 2 * (f.l2 * h - reach * (l4_rise + sign * l1_rise)) - over * h / f.l2
        branches.append((np.abs(over), np.sign(over) * rise))
    (near, near_rise), (far, far_rise) = branches
    return np.where(near > far, near_rise, far_rise)[()]


# Functions that the required pivot minimises, and functions that vanish there.
OBJECTIVES: Final[Mapping[str, Callable[[FourBarByKSolution, FourBarByKTask], Any]]] = {
    "best": _get_pressure,
    "near": _compute_distance,
}
EQUATIONS: Final[Mapping[str, Callable[[FourBarByKSolution, FourBarByKTask], Any]]] = {
    "l1": lambda found, task: found.l1 - task.l1,
    "l2": lambda found, task: found.l2 - task.l2,
    "pressure": lambda found, task: found.pressure - task.pressure,
    "l4": lambda found, task: found.l4 - task.l4,
    **dict.fromkeys(("level", "yA"), lambda found, task: np.imag(found.a - task.support) - line_offset(task)),
    "xA": lambda found, task: np.real(found.a - task.support) - line_offset(task),
    "best": _compute_pressure_slope,
    "near": lambda found, task: np.real(np.conj(found.a - task.near) * found.slope),
}


def _find_crossings(task: FourBarByKTask, side: int, function: Any) -> list[Any]:
    """Return the coordinates w along an arc at which a function of the four-bar vanishes."""
    if task.choose in ON_LINE:
        fair = [w for w in pivots_on_line(task) if 1 < w < largest_w(task, side)]
        return [w for w in fair if abs(function(f := four_bar_at(task, w, side), task)) < SAME * (f.l2 + task.l3)]
    w = sample_arc(task, side)
    values = function(four_bar_at(task, w, side), task)
    crossings = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    if not crossings.size:
        return []
    return list(find_roots(lambda x: function(four_bar_at(task, x, side), task), w[crossings], w[crossings + 1]))


def _find_minimum(task: FourBarByKTask, side: int, choice: str) -> Any:
    """Return the coordinate w along an arc at which an objective is smallest.

    It is a zero of the derivative of the objective, or an end of the arc.
    """
    w = sample_arc(task, side)
    best = int(np.argmin(OBJECTIVES[choice](four_bar_at(task, w, side), task)))
    if best in (0, len(w) - 1):
        return w[best]
    around = w[[best - 1]], w[[best + 1]]
    return find_roots(lambda x: EQUATIONS[choice](four_bar_at(task, x, side), task), *around)[0]


def choose_pivot(task: FourBarByKTask) -> FourBarByKSolution:
    """Find the crank pivot A that satisfies the task.

    Of several pivots the one with the best transmission angle is taken; if the pressure angle is given, the pivot of
    the smallest mechanism; if a point is given, the pivot nearest to it. The search uses D as origin, so that a distant
    pivot D causes no loss of digits.

    Raises:
        Infeasible: no pivot satisfies the task.
    """
    _check_numbers(task)
    beside = {
        key: getattr(task, key) - place
        for key, place in (("near", task.support), ("xA", np.real(task.support)), ("yA", np.imag(task.support)))
        if getattr(task, key) is not None
    }
    centred = replace(task, support=0 * task.support, **beside)
    if task.choose in OBJECTIVES:
        pivots = [(_find_minimum(centred, side, task.choose), side) for side in admissible_arcs(centred)]
    else:
        pivots = [
            (w, side)
            for side in admissible_arcs(centred)
            for w in _find_crossings(centred, side, EQUATIONS[task.choose])
        ]
    if not pivots and task.choose == "pressure":
        raise _make_pressure_refusal(centred)
    if not pivots:
        level = task.choose == "level"
        reason = _("no pivot A on the admissible arcs satisfies this condition")
        raise Infeasible("choose" if level else task.choose, reason, "best transmission" if level else None)
    goal = _compute_extent if task.choose == "pressure" else OBJECTIVES.get(task.choose, _get_pressure)
    w, side = min(pivots, key=lambda pivot: float(goal(four_bar_at(centred, *pivot), centred)))
    if task.choose == "near" and w in sample_arc(centred, side)[[0, -1]]:
        reason = _(
            "the nearest point of the admissible arcs is the end of an arc, where the rocker reaches a dead position"
        )
        raise Infeasible("near", reason)
    f = four_bar_at(centred, w, side)
    return replace(f, a=zero_within_rounding(task.support + f.a, f.l4 + np.abs(task.support)))


def _make_pressure_refusal(task: FourBarByKTask) -> Infeasible:
    """Return the error for a largest pressure angle that no admissible pivot gives."""
    least = min(
        float(four_bar_at(task, _find_minimum(task, side, "best"), side).pressure) for side in admissible_arcs(task)
    )
    reason = _("no pivot A on the admissible arcs gives this largest pressure angle")
    return Infeasible("pressure", reason, (least, "angle", 1) if task.pressure < least else None)


def refuse(task: FourBarByKTask) -> None:
    """Raise Infeasible, with the reason, if no crank pivot satisfies the task."""
    choose_pivot(task)


def _check_numbers(task: FourBarByKTask) -> None:
    if not task.k >= 1:
        raise Infeasible(
            "k",
            _(
                "k must be 1 or more: it is the duration of the working stroke divided by that of the shorter "
                "return stroke"
            ),
        )
    theta, half, sense = float(task.theta), float(task.swing) / 2, -1 if task.psi2 < task.psi1 else 1
    against = task.sense == -sense  # crank and rocker rotate in opposite senses in the slow stroke: only beyond C1C2
    if not SMALLEST <= task.swing <= np.pi - 2 * SHORTEST_ARC:
        raise Infeasible("psi2", _("the swing angle of the rocker must be greater than 0 and less than 180 deg"))
    if theta > np.pi / 2 + half - SHORTEST_ARC:  # the largest theta of the arc on D's side
        raise Infeasible(
            "k",
            _(
                "k is too large for this swing angle: for every pivot A on the circle the rocker would pass "
                "through a dead position or nearly reach it"
            ),
        )
    if against and theta > np.pi / 2 - half - SHORTEST_ARC:  # of the other arc
        raise Infeasible(
            "turns",
            _("with this sense of rotation of the crank the slow stroke leads from psi2 to psi1"),
            "cw" if task.sense > 0 else "ccw",
        )
    if task.pressure is not None and not 0 < task.pressure < np.pi / 2:
        raise Infeasible("pressure", _("the largest pressure angle must be less than 90 deg"))
    if theta == 0 and task.choose == "best":
        raise Infeasible(
            "k",
            _(
                "with k = 1 there is no best pivot: the farther away A is, the closer the largest pressure angle "
                "comes to psi/2"
            ),
        )
    if theta == 0 and task.choose == "l1":
        raise Infeasible("l1", _("with k = 1 the crank length is always half of C1C2"))


def solve(task: FourBarByKTask) -> SynthesisOutcome:
    """Find the four-bar, draw its construction and tabulate the four-bars along the arcs. Raises Infeasible."""
    f = choose_pivot(task)
    demands = [
        Demand(N_("crank rotates fully (1: yes)"), 1.0, "number", driver_completes_range, asked=False),
        Demand(N_("k (time ratio)"), float(task.k), "number", time_ratio),
        Demand(N_("swing angle psi of the rocker"), float(task.swing), "angle", output_stroke),
        *(
            Demand(QUANTITIES[n][1], float(v), "angle", partial(stroke_end_angle, near=float(v)), at=1.0)
            for n, v in (("psi1", task.psi1), ("psi2", task.psi2))
        ),
        Demand(
            N_("largest pressure angle"),
            float(f.pressure),
            "angle",
            largest_pressure_angle,
            asked=task.pressure is not None,
            of="pressure",
        ),
    ]
    family = [four_bar_at(task, sample_whole_arc(task, side), side) for side in admissible_arcs(task)]
    source = N_(
        "A lies on the circle from which C1C2 is seen at the angle theta = pi (k - 1)/(k + 1); l1 = (AC2 - "
        "AC1)/2, l2 = AC2 - l1, l4 = AD; C1 and C2 lie on the same side of AD"
    )
    notes = (
        () if task.k > 1 else (N_("with k = 1 the circle becomes the line C1C2: A may be any of its points beyond C1"),)
    )
    return SynthesisOutcome(
        _list_given_values(task),
        _list_solution_values(task, f),
        source,
        tuple(demands),
        (draw_construction(task, f, family), *draw_diagrams(task, f, family)),
        notes,
        (tabulate_family(family),),
        output="swing",
        quality=SolutionQuality(float(f.pressure), limited=task.pressure is not None),
    )


def _list_given_values(task: FourBarByKTask) -> tuple[NamedValue, ...]:
    choice = {
        "best": N_("best transmission angle: the largest pressure angle is as small as possible"),
        "level": N_("pivots at the same height: A as high as D"),
        "pressure": N_("by the largest pressure angle; if two mechanisms have it, the smaller one"),
        "l1": N_("by the length of the crank"),
        "l2": N_("by the length of the coupler"),
        "l4": N_("by the length of the frame"),
        "near": N_("pivot nearest to a given point"),
        "xA": N_("by the x coordinate of A"),
        "yA": N_("by the y coordinate of A"),
    }[task.choose]
    return *given_values(task, QUANTITIES), NamedValue("", choice, "word", N_("choice of the pivot A"))


def _list_solution_values(task: FourBarByKTask, f: FourBarByKSolution) -> tuple[NamedValue, ...]:
    """List the four-bar, its crank pivot and sense of rotation, and the ends of the admissible arcs."""
    at_c2 = task.support + task.l3 * unit(task.psi2) - f.a
    rows = [
        NamedValue("l1", f.l1, *QUANTITIES["l1"]),
        NamedValue("l2", f.l2, *QUANTITIES["l2"]),
        NamedValue("l4", f.l4, *QUANTITIES["l4"]),
        NamedValue("xA", np.real(f.a), *QUANTITIES["xA"]),
        NamedValue("yA", np.imag(f.a), *QUANTITIES["yA"]),
        NamedValue(
            "phi2",
            np.arctan2(at_c2.imag, at_c2.real),
            "angle",
            N_("crank angle at C2, where crank and coupler are in line"),
        ),
        NamedValue("", task.theta, "angle", N_("angle theta = C1AC2")),
        NamedValue("", f.pressure, "angle", N_("largest pressure angle")),
    ]
    if task.choose == "near":
        distance = distance_beyond_rounding(f.a - task.near, f.l4)
        rows.append(NamedValue("", distance, "length", N_("distance of A from the required point")))
    if task.k == 1:
        return tuple(rows)
    turns = N_("counterclockwise") if f.sense > 0 else N_("clockwise")
    rows += [
        NamedValue("", f.beta, "angle", N_("position on the arc: angle AC2C1")),
        NamedValue("", side_name(f), "word", N_("arc")),
        NamedValue("", turns, "word", N_("sense of rotation of the crank for a slow stroke from psi1 to psi2")),
    ]
    for side in admissible_arcs(task):
        beyond, inside = (
            N_("admissible arc, A and D on opposite sides of C1C2: largest angle AC2C1"),
            N_("admissible arc, A and D on the same side of C1C2: largest angle AC2C1"),
        )
        last = four_bar_at(task, sample_arc(task, side)[-1], side)
        rows += [
            NamedValue("", largest_beta(task, side), "angle", beyond if side > 0 else inside),
            NamedValue("", last.l4, "length", N_("frame l4 at this end of the arc (at the other end l4 = l3)")),
        ]
    return tuple(rows)


CHOICES = {"best transmission": "best", "supports level": "level"}
CHOICE_KEYS = ("choose", "pressure", "l1", "l2", "l4", "near", "xA", "yA")


class FourBarByKBlock(TaskBlock):
    """Keys of the task `four-bar-by-k`: k, the rocker and its two extreme angles, and one condition for the crank pivot
    A.
    """

    task: Literal["four-bar-by-k"]
    l3: Value = Field(description="length of the rocker DC")
    psi1: Value = Field(description="angle of the rocker DC when crank and coupler overlap")
    psi2: Value = Field(description="angle of the rocker DC when crank and coupler are in line")
    k: Value = Field(
        description="time ratio (coefficient of change of mean speed) k = (180° + θ)/(180° - θ), 1 or more"
    )
    support: Vector = Field(default=(0, 0), description="pivot D of the rocker; default [0, 0]")
    choose: Literal["best transmission", "supports level"] | None = Field(
        default=None, description="condition for the crank pivot A; default: best transmission angle"
    )
    pressure: Value | None = Field(
        default=None,
        description=(
            "condition for A: largest pressure angle; of two possible pivots, the one that gives the smaller "
            "mechanism is taken"
        ),
    )
    l1: Value | None = Field(default=None, description="condition for A: length of the crank AB")
    l2: Value | None = Field(default=None, description="condition for A: length of the coupler BC")
    l4: Value | None = Field(default=None, description="condition for A: length of the frame AD")
    near: Vector | None = Field(
        default=None, description="condition for A: a point; A is the admissible pivot nearest to it"
    )
    xA: Value | None = Field(default=None, description="condition for A: its x coordinate")  # noqa: N815  as the parameter is called
    yA: Value | None = Field(default=None, description="condition for A: its y coordinate")  # noqa: N815
    turns: Literal["ccw", "cw"] | None = Field(
        default=None, description="sense of rotation of the crank in the slow stroke from psi1 to psi2; default: any"
    )


BLOCK = FourBarByKBlock


def read(block: FourBarByKBlock, values: ValueReader) -> FourBarByKTask:
    """Convert the keys of the task to quantities in SI and radians. Raises ProblemError."""
    conditions = [name for name in CHOICE_KEYS if getattr(block, name) is not None]
    if len(conditions) > 1:
        raise ProblemError(
            _("give only one condition for the pivot A"),
            found=_(" and ").join(conditions),
            allowed=_("one of {ways}").format(ways=", ".join(CHOICE_KEYS)),
            key=True,
        )
    fields = read_numbers(block, values, QUANTITIES)
    for key in ("support", "near"):
        if getattr(block, key) is not None:
            fields[key] = values.vector(getattr(block, key), LENGTH, (key,))
    condition = conditions[0] if conditions else "choose"
    choice = CHOICES[block.choose or "best transmission"] if condition == "choose" else condition
    return FourBarByKTask(**fields, choose=choice, sense={"ccw": 1, "cw": -1, None: 0}[block.turns])
