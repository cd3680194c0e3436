"""Drawings of a slotted lever: its extreme positions, and the family that bounds of OC allow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import Angle, Arc, Construction, Diagram, Line, Segment, Spot, box, circle
from tmm_cli.synthesis.record import Listing

if TYPE_CHECKING:
    from tmm_cli.synthesis.slotted_lever.solver import Found, Task

FAMILY: Final = 61  # lengths of OC within bounds that are listed


def lever_parts(f: Found, end: str) -> tuple[list[Segment], list[Arc], list[Spot], list[Angle]]:
    """The lever in its extreme positions, the bisector, the pin's circle that touches both; end: letter of its end."""
    c, o = complex(f.c), complex(f.o)
    lever, crank, frame = float(f.lever), float(f.crank), float(f.frame)
    ways = [complex(np.exp(1j * float(psi))) for psi in (f.psi1, f.psi2)]
    pins = [c + frame * float(np.cos(f.theta / 2)) * way for way in ways]
    ends = [c + lever * way for way in ways]
    first, last = sorted((float(f.psi1), float(f.psi1) + float(np.angle(ways[1] / ways[0]))))
    axis = (o - c) / abs(o - c)
    top = c + 1.1 * max(lever, frame + crank) * axis
    segments = [
        Segment(c, ends[0], "link", f"C{end}"), Segment(o, pins[0], "link", "OA"),
        Segment(c, ends[1], "link2"), Segment(o, pins[1], "link2", "OA"),
        Segment(c, o, "axis", "OC"), Segment(o, top, "axis"),
    ]  # fmt: skip
    arcs = [circle(o, crank), Arc(c, lever, first, last, "dashed")]
    spots = [
        Spot("C", c, "support"), Spot("O", o, "support"), Spot("A1", pins[0], "stone", ways[0]),
        Spot("A2", pins[1], "stone", ways[1]), Spot(f"{end}1", ends[0], "hinge"), Spot(f"{end}2", ends[1], "hinge"),
    ]  # fmt: skip
    corners = [Angle(pin, o, c, right=True) for pin in pins]
    return segments, arcs, spots, [Angle(c, ends[0], ends[1], "θ"), *corners]


def construction(f: Found) -> Construction:
    """Both extreme positions, with C by the isosceles triangle on B1B2 and O on the bisector."""
    segments, arcs, spots, angles = lever_parts(f, "B")
    b1, b2 = spots[-2].at, spots[-1].at
    segments.append(Segment(b1, b2, "dashed"))
    return Construction(
        N_("Extreme positions of the slotted lever"), tuple(segments), tuple(arcs), tuple(spots),
        (N_("{O}{A}1 ⊥ {C}{B}1, {O}{A}2 ⊥ {C}{B}2"),), angles=tuple(angles), chain="slotted-lever",
        wishes=(box(complex(f.o), float(f.crank)),),
        values=(("OA", float(f.crank), "length"), ("OC", float(f.frame), "length"), ("CB", float(f.lever), "length"),
                ("θ", float(f.theta), "angle")),
    )  # fmt: skip


def family(task: Task, f: Found) -> tuple[Diagram, Listing]:
    """OA and the stone's distances from C over the free distance OC within its bounds, drawn and in numbers."""
    assert task.within is not None
    low, high = (float(x) for x in task.within)
    frame = np.linspace(low, high, FAMILY)
    crank = frame * float(np.sin(f.theta / 2))
    rows = (
        ("OA", N_("crank OA"), crank), ("nearest", N_("stone from C, at least"), frame - crank),
        ("farthest", N_("stone from C, at most"), frame + crank),
    )  # fmt: skip
    own = np.array([f.crank, f.frame - f.crank, f.frame + f.crank], dtype=float)
    lines = (
        *(Line(text, frame, values) for __, text, values in rows),
        Line(N_("lever CB"), frame, np.full(FAMILY, float(f.lever))),
        Line(N_("chosen"), np.full(3, float(f.frame)), own, dots=True),
    )  # fmt: skip
    title = N_("Crank OA and distance of the stone from C, over OC within its bounds")
    drawn = Diagram("family-lengths", title, (N_("frame OC"), "length"), (N_("length"), "length"), lines)
    columns = (("OC", N_("frame OC"), "length"), *((name, text, "length") for name, text, __ in rows))
    values = np.stack((frame, *(values for *__, values in rows)), axis=-1).tolist()
    title = N_("Slotted levers for OC within its bounds")
    return drawn, Listing("family", title, columns, tuple(map(tuple, values)), long=True)
