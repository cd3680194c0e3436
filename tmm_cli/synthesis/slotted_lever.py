"""Synthesis of a slotted-lever mechanism from its time ratio k (or swing angle) and the extreme positions of the
lever.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import DEAD_SWING, unit, zero_within_rounding
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.problem import ProblemError, Value as FileValue, ValueReader, Vector
from tmm_cli.synthesis.blocks import Range, TaskBlock, choose_key_set, read_numbers
from tmm_cli.synthesis.construction import (
    Angle,
    Arc,
    Diagram,
    DiagramLine,
    GeometricConstruction,
    LetteredPoint,
    Segment,
    circle_extent,
    full_circle,
)
from tmm_cli.synthesis.measures import (
    driver_completes_range,
    k_of,
    output_stroke,
    stroke_end_angle,
    theta_of,
    time_ratio,
)
from tmm_cli.synthesis.record import (
    Demand,
    Infeasible,
    Listing,
    NamedValue,
    SolutionQuality,
    SynthesisOutcome,
    given_values,
)

FAMILY_SIZE: Final = 61  # tabulated lengths OC


def lever_elements(
    f: SlottedLeverSolution, end: str
) -> tuple[list[Segment], list[Arc], list[LetteredPoint], list[Angle]]:
    """Return the drawing elements of the slotted lever and its crank in both extreme positions.

    Args:
        f: dimensions of the mechanism.
        end: letter of the lever's end.

    Returns:
        Lines, arcs, points and angles. The crank circle touches the lever in both positions.
    """
    c, o = complex(f.c), complex(f.o)
    lever, crank, frame = float(f.lever), float(f.crank), float(f.frame)
    ways = [complex(np.exp(1j * float(psi))) for psi in (f.psi1, f.psi2)]
    pins = [c + frame * float(np.cos(f.theta / 2)) * direction for direction in ways]
    ends = [c + lever * direction for direction in ways]
    first, last = sorted((float(f.psi1), float(f.psi1) + float(np.angle(ways[1] / ways[0]))))
    axis = (o - c) / abs(o - c)
    top = c + 1.1 * max(lever, frame + crank) * axis
    segments = [
        Segment(c, ends[0], "link", f"C{end}"),
        Segment(o, pins[0], "link", "OA"),
        Segment(c, ends[1], "link2"),
        Segment(o, pins[1], "link2", "OA"),
        Segment(c, o, "axis", "OC"),
        Segment(o, top, "axis"),
    ]
    arcs = [full_circle(o, crank), Arc(c, lever, first, last, "dashed")]
    spots = [
        LetteredPoint("C", c, "support"),
        LetteredPoint("O", o, "support"),
        LetteredPoint("A1", pins[0], "stone", ways[0]),
        LetteredPoint("A2", pins[1], "stone", ways[1]),
        LetteredPoint(f"{end}1", ends[0], "hinge"),
        LetteredPoint(f"{end}2", ends[1], "hinge"),
    ]
    corners = [Angle(pin, o, c, right=True) for pin in pins]
    return segments, arcs, spots, [Angle(c, ends[0], ends[1], "θ"), *corners]


def draw_construction(f: SlottedLeverSolution) -> GeometricConstruction:
    """Draw the geometric construction of a slotted lever in both extreme positions.

    The pivot C is the apex of the isosceles triangle on B1B2, and the crank pivot O lies on its bisector.
    """
    segments, arcs, spots, angles = lever_elements(f, "B")
    b1, b2 = spots[-2].at, spots[-1].at
    segments.append(Segment(b1, b2, "dashed"))
    return GeometricConstruction(
        N_("Extreme positions of the slotted lever"),
        tuple(segments),
        tuple(arcs),
        tuple(spots),
        (N_("{O}{A}1 ⊥ {C}{B}1, {O}{A}2 ⊥ {C}{B}2"),),
        angles=tuple(angles),
        chain="slotted-lever",
        wishes=(circle_extent(complex(f.o), float(f.crank)),),
        values=(
            ("OA", float(f.crank), "length"),
            ("OC", float(f.frame), "length"),
            ("CB", float(f.lever), "length"),
            ("θ", float(f.theta), "angle"),
        ),
    )


def tabulate_family(task: SlottedLeverTask, f: SlottedLeverSolution) -> tuple[Diagram, Listing]:
    """Draw and tabulate the mechanisms with OC between its given limits.

    For each length OC the table gives the crank OA, and the smallest and the largest distance of the sliding block from
    C.
    """
    assert task.within is not None
    low, high = (float(x) for x in task.within)
    frame = np.linspace(low, high, FAMILY_SIZE)
    crank = frame * float(np.sin(f.theta / 2))
    rows = (
        ("OA", N_("crank OA"), crank),
        ("nearest", N_("smallest distance of the sliding block from C"), frame - crank),
        ("farthest", N_("largest distance of the sliding block from C"), frame + crank),
    )
    chosen = np.array([f.crank, f.frame - f.crank, f.frame + f.crank], dtype=float)
    lines = (
        *(DiagramLine(text, frame, values) for __, text, values in rows),
        DiagramLine(N_("slotted lever CB"), frame, np.full(FAMILY_SIZE, float(f.lever))),
        DiagramLine(N_("chosen"), np.full(3, float(f.frame)), chosen, dots=True),
    )
    title = N_("Crank OA and distance of the sliding block from C, against OC")
    drawn = Diagram("family-lengths", title, (N_("frame OC"), "length"), (N_("length"), "length"), lines)
    columns = (("OC", N_("frame OC"), "length"), *((name, text, "length") for name, text, __ in rows))
    values = np.stack((frame, *(values for *__, values in rows)), axis=-1).tolist()
    title = N_("Slotted-lever mechanisms with OC within the given limits")
    return drawn, Listing("family", title, columns, tuple(map(tuple, values)), long=True)


# Slotted lever by k and the extreme positions of its end B: the crank circle touches both, O is on their bisector.
#
# In an extreme position OA is perpendicular to CB, so the lever swings by theta = pi (k - 1)/(k + 1) = B1CB2, and
#     CB = B1B2/(2 sin(theta/2)),  OA = OC sin(theta/2);
# the sliding block moves between OC - OA and OC + OA from C. OC is free. The force on the
# block is the lever's moment over its distance from C, so the longest OC with the block on CB gives the smallest force:
# OC (1 + sin(theta/2)) = CB.


PARAMETERS: Final = {**dict.fromkeys(("OA", "OC", "CB", "xO", "yO", "xC", "yC"), "length"), "phi": "angle"}
QUANTITIES: Final = {  # quantities that a task may give: kind and description
    "CB": ("length", N_("slotted lever CB")),
    "k": ("number", N_("k (time ratio)")),
    "swing": ("angle", N_("swing angle of the lever")),
    "OC": ("length", N_("frame OC")),
    "OA": ("length", N_("crank OA")),
}
QUICK_RETURN: Final = N_(
    "k must be greater than 1: a swinging lever returns faster, and k is the duration of the slow "
    "stroke divided by that of the fast one"
)
HALF_A_TURN: Final = N_("with a fully rotating crank the swing angle of the lever must be less than 180 deg")


@dataclass(frozen=True)
class SlottedLeverTask:
    """Given quantities of a slotted-lever mechanism; None if not given.

    Attributes:
        b1, b2: extreme positions of the lever's end B (complex, m).
        CB: length of the lever (m), instead of b1 and b2.
        c, axis: with CB, the lever's pivot C (complex, m) and the direction from C to O (rad).
        side: side of the line from b1 to b2 on which C lies, 1 left, -1 right. With CB, 1 means that the lever rotates
            counterclockwise from B1 to B2.
        k, swing: time ratio, or the swing angle (rad).
        OC, OA, within: distance OC (m), or the crank OA (m), or limits of OC (m).
        choose: choice of OC between its limits: `force` (the longest with the sliding block on CB) or `shortest`.
    """

    b1: Any = None
    b2: Any = None
    CB: Any = None
    c: Any = 0j
    axis: Any = 0.0
    side: int = -1
    k: Any = None
    swing: Any = None
    OC: Any = None
    OA: Any = None
    within: tuple[Any, Any] | None = None
    choose: str = "force"

    @property
    def theta(self) -> Any:
        return theta_of(self.k) if self.swing is None else np.asarray(self.swing)


@dataclass(frozen=True)
class SlottedLeverSolution:
    """Dimensions of a slotted-lever mechanism.

    Attributes:
        crank, frame, lever: lengths of OA, OC and CB (m).
        o, c: pivots of the crank and of the lever (complex, m).
        psi1, psi2: angles of CB1 and CB2 (rad).
        theta: swing angle of the lever (rad).
        longest: longest OC for which the sliding block stays on CB (m).
    """

    crank: Any
    frame: Any
    lever: Any
    o: Any
    c: Any
    psi1: Any
    psi2: Any
    theta: Any
    longest: Any


def find_slotted_lever(task: SlottedLeverTask) -> SlottedLeverSolution:
    """Find the dimensions of a slotted-lever mechanism.

    The numbers returned are meaningless if no such mechanism exists; `refuse` checks this.
    """
    theta = task.theta
    sine = np.sin(theta / 2)
    if task.CB is None:
        segment = np.asarray(task.b2) - task.b1
        lever = np.abs(segment) / 2 / sine
        c = (np.asarray(task.b1) + task.b2) / 2 + task.side * 1j * segment / 2 / np.tan(theta / 2)
        along = -task.side * 1j * segment / np.abs(segment)
        psi1, psi2 = np.angle(task.b1 - c), np.angle(task.b2 - c)
    else:
        lever, c = np.asarray(task.CB), task.c
        along = unit(task.axis)
        psi1, psi2 = task.axis - task.side * theta / 2, task.axis + task.side * theta / 2
    longest = lever / (1 + sine)
    if task.OA is not None:
        frame = np.asarray(task.OA) / sine
    elif task.within is None:
        frame = np.asarray(task.OC)
    elif task.choose == "force":
        frame = np.minimum(task.within[1], longest)
    else:
        frame = np.asarray(task.within[0])
    extent = lever + frame + np.abs(c)
    along, c = zero_within_rounding(along, 1.0), zero_within_rounding(c, extent)
    return SlottedLeverSolution(
        frame * sine, frame, lever, zero_within_rounding(c + frame * along, extent), c, psi1, psi2, theta, longest
    )


def refuse(task: SlottedLeverTask) -> None:
    """Raise Infeasible, with the reason, if no slotted-lever mechanism satisfies the task."""
    if task.k is not None and not task.k > 1:
        raise Infeasible("k", QUICK_RETURN)
    if task.swing is not None and not task.swing > 0:
        raise Infeasible("swing", _("the swing angle must be greater than 0"))
    if not np.pi - task.theta > DEAD_SWING:
        raise Infeasible("k" if task.swing is None else "swing", HALF_A_TURN)
    if task.CB is None and abs(task.b2 - task.b1) == 0:
        raise Infeasible("B2", _("B1 and B2 are the same point"), search=False)
    if task.within is not None and not 0 < task.within[0] <= task.within[1]:
        raise Infeasible("within", _("expected two positive limits of OC, the smaller one first"))
    if task.within is not None and task.within[0] > find_slotted_lever(task).longest:
        raise Infeasible(
            ("within", 0),
            _(
                "for every OC within these limits the sliding block passes beyond the lever's end B. Reduce the "
                "lower limit"
            ),
        )


def solve(task: SlottedLeverTask) -> SynthesisOutcome:
    """Find the slotted-lever mechanism and draw its construction. Raises Infeasible."""
    refuse(task)
    f = find_slotted_lever(task)
    demands = (
        Demand(N_("crank rotates fully (1: yes)"), 1.0, "number", driver_completes_range, asked=False),
        Demand(N_("k (time ratio)"), float(k_of(f.theta)), "number", time_ratio, task.k is not None),
        Demand(N_("swing angle of the lever"), float(f.theta), "angle", output_stroke, task.swing is not None),
        *(
            Demand(text, float(v), "angle", partial(stroke_end_angle, near=float(v)), at=1.0)
            for text, v in (
                (N_("angle of the lever in position CB1"), f.psi1),
                (N_("angle of the lever in position CB2"), f.psi2),
            )
        ),
    )
    notes = (
        (N_("the sliding block passes beyond the lever's end B: the slot must extend beyond B"),)
        if f.frame > f.longest * (1 + 1e-12)
        else ()
    )
    free = tabulate_family(task, f) if task.within is not None and task.within[0] < task.within[1] else None
    drawings, listings = ((draw_construction(f), free[0]), (free[1],)) if free else ((draw_construction(f),), ())
    source = N_(
        "in the extreme positions OA is perpendicular to the lever: B1CB2 = theta = pi (k - 1)/(k + 1), "
        "CB1 = CB2, O lies on the bisector, OA = OC sin(theta/2)"
    )
    return SynthesisOutcome(
        _list_given_values(task),
        _list_solution_values(task, f),
        source,
        demands,
        drawings,
        notes,
        listings,
        output="swing",
        quality=SolutionQuality(0.0),  # the sliding block drives the lever at right angles to it
    )


def _list_given_values(task: SlottedLeverTask) -> tuple[NamedValue, ...]:
    values: list[NamedValue] = []
    if task.CB is None:
        for x, y, place in (
            (N_("x coordinate of B1"), N_("y coordinate of B1"), task.b1),
            (N_("x coordinate of B2"), N_("y coordinate of B2"), task.b2),
        ):
            values += [NamedValue("", np.real(place), "length", x), NamedValue("", np.imag(place), "length", y)]
    values += given_values(task, QUANTITIES)
    if task.within is not None:
        force = N_("least force: the longest OC for which the sliding block stays on CB")
        values += [
            NamedValue("", task.within[0], "length", N_("lower limit of OC")),
            NamedValue("", task.within[1], "length", N_("upper limit of OC")),
            NamedValue("", force if task.choose == "force" else N_("the shortest OC"), "word", N_("choice of OC")),
        ]
    return tuple(values)


def _list_solution_values(task: SlottedLeverTask, f: SlottedLeverSolution) -> tuple[NamedValue, ...]:
    away = f.o - f.c
    return (
        NamedValue("OA", f.crank, *QUANTITIES["OA"]),
        NamedValue("OC", f.frame, *QUANTITIES["OC"]),
        NamedValue("CB", f.lever, *QUANTITIES["CB"]),
        NamedValue("xO", np.real(f.o), "length", N_("x coordinate of the crank pivot O")),
        NamedValue("yO", np.imag(f.o), "length", N_("y coordinate of the crank pivot O")),
        NamedValue("xC", np.real(f.c), "length", N_("x coordinate of the pivot C of the slotted lever")),
        NamedValue("yC", np.imag(f.c), "length", N_("y coordinate of the pivot C of the slotted lever")),
        NamedValue(
            "phi",
            np.arctan2(np.imag(away), np.real(away)),
            "angle",
            N_("direction from C to O; crank and lever have this direction when they are in line"),
        ),
        NamedValue("", f.theta, "angle", N_("angle theta = B1CB2")),
        NamedValue("", f.frame - f.crank, "length", N_("smallest distance of the sliding block from C")),
        NamedValue("", f.frame + f.crank, "length", N_("largest distance of the sliding block from C")),
        NamedValue("", f.longest, "length", N_("longest OC for which the sliding block stays on CB")),
        # in the slow stroke crank and lever rotate in the same sense
        NamedValue(
            "",
            N_("counterclockwise") if task.side > 0 else N_("clockwise"),
            "word",
            N_("sense of rotation of the crank for a slow stroke from B1 to B2"),
        ),
    )


# Keys of the task.


END_KEYS = (("B1", "B2"), ("CB",))
SWING_KEYS = (("k",), ("swing",))
FRAME_KEYS = (("OC",), ("OA",), ("within",))


class SlottedLeverBlock(TaskBlock):
    """Keys of the task `slotted-lever`: the extreme positions of the lever's end B (or its length), and k or the swing
    angle.
    """

    task: Literal["slotted-lever"]
    B1: Vector | None = Field(default=None, description="one extreme position of the lever's end B")
    B2: Vector | None = Field(default=None, description="other extreme position of the lever's end B")
    C: Literal["left", "right"] | None = Field(
        default=None,
        description="side of the line from B1 to B2 on which the lever's pivot C lies: left or right; default right",
    )
    CB: FileValue | None = Field(default=None, description="length of the lever, instead of its extreme positions")
    support: Vector | None = Field(default=None, description="pivot C of the lever, only with CB; default [0, 0]")
    axis: FileValue | None = Field(default=None, description="direction from C to O, only with CB; default 90 deg")
    k: FileValue | None = Field(
        default=None,
        description="time ratio (coefficient of change of mean speed) k = (180° + θ)/(180° - θ), more than 1",
    )
    swing: FileValue | None = Field(default=None, description="swing angle of the lever, instead of k")
    OC: FileValue | None = Field(default=None, description="distance OC between the fixed hinges")
    OA: FileValue | None = Field(default=None, description="crank OA, instead of OC")
    within: Range | None = Field(default=None, description="limits of OC, [from, to], instead of OC")
    choose: Literal["least force", "shortest"] | None = Field(
        default=None,
        description=(
            "choice of OC between its limits: the longest for which the sliding block stays on CB (least "
            "force), or the shortest"
        ),
    )


BLOCK = SlottedLeverBlock


def read(block: SlottedLeverBlock, values: ValueReader) -> SlottedLeverTask:
    """Convert the keys of the task to quantities in SI and radians. Raises ProblemError."""
    ends, *__ = (choose_key_set(block, sets) for sets in (END_KEYS, SWING_KEYS, FRAME_KEYS))
    _check_companions(block, {"C": ("B1", "B2"), "support": ("CB",), "axis": ("CB",), "choose": ("within",)})
    fields = read_numbers(block, values, QUANTITIES)
    if ends == ("CB",):
        fields["c"] = values.vector(block.support or [0, 0], LENGTH, ("support",))
        fields["axis"] = values.number("90 deg" if block.axis is None else block.axis, ANGLE, ("axis",))
    else:
        fields |= {name.lower(): values.vector(getattr(block, name), LENGTH, (name,)) for name in ends}
    if block.within is not None:
        low, high = (values.number(v, LENGTH, ("within", n)) for n, v in enumerate(block.within))
        fields["within"] = (low, high)
    choose = "shortest" if block.choose == "shortest" else "force"
    return SlottedLeverTask(**fields, side=1 if block.C == "left" else -1, choose=choose)


def _check_companions(block: SlottedLeverBlock, needs: dict[str, tuple[str, ...]]) -> None:
    for key, others in needs.items():
        lacking = [other for other in others if getattr(block, other) is None]
        if getattr(block, key) is not None and lacking:
            raise ProblemError(
                _("{key} may only be given together with {others}").format(key=key, others=_(" and ").join(others)),
                path=(key,),
                found=_("{key} without {lacking}").format(key=key, lacking=_(" and ").join(lacking)),
                allowed=_("add {others}, or remove {key}").format(others=_(" and ").join(others), key=key),
                key=True,
            )
