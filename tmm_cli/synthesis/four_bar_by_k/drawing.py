"""Drawings of the four-bars by k: circles with their admissible arcs, link lengths and pressure angle along them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import (
    Angle,
    Centre,
    Construction,
    Curve,
    Diagram,
    Line,
    Segment,
    Spot,
    box,
    circle,
)  # fmt: skip
from tmm_cli.synthesis.four_bar_by_k.arcs import Found, Task
from tmm_cli.synthesis.record import Listing

LINKS: Final = ("l1", "l2", "l3", "l4")
LONGEST: Final = 20.0  # the whole family is on the diagrams when no rod is longer than this many of the chosen one
CUT: Final = 4.0  # (and of the rocker); else rods up to this many of that


def construction(task: Task, found: Found, family: Sequence[Found]) -> Construction:
    """Both extreme positions, the circles on which C1C2 is seen under theta, and the pivots that may be A."""
    d, a = complex(task.support), complex(found.a)
    c1, c2 = (complex(d + task.l3 * np.exp(1j * psi)) for psi in (task.psi1, task.psi2))
    way1, way2 = (c1 - a) / abs(c1 - a), (c2 - a) / abs(c2 - a)
    pin1, pin2 = a - found.l1 * way1, a + found.l1 * way2
    segments = [
        Segment(d, c1, "link", "l3"), Segment(pin1, a, "link", "l1"), Segment(a, c1, "link", "l2 − l1"),
        Segment(d, c2, "link2", "l3"), Segment(a, pin2, "link2", "l1"), Segment(pin2, c2, "link2", "l2"),
        Segment(d, a, "axis", "l4"), Segment(c1, c2, "thin"),
    ]  # fmt: skip
    spots = [
        Spot("D", d, "support"), Spot("A", a, "support"), Spot("B1", pin1, "hinge"), Spot("B2", pin2, "hinge"),
        Spot("C1", c1, "hinge"), Spot("C2", c2, "hinge"),
    ]  # fmt: skip
    middle, theta, half = (c1 + c2) / 2, float(task.theta), abs(c2 - c1) / 2
    arcs = [circle(a, float(found.l1))]
    angles = [Angle(d, c1, c2, "ψ")]
    centres, wishes = [], [box(a, float(found.l1))]
    if theta > 0:
        out, radius = (middle - d) / abs(middle - d), half / float(np.sin(theta))
        angles.append(Angle(a, c1, c2, "θ"))
        for f in sorted(family, key=lambda one: int(one.side) != int(found.side)):
            centre = middle + int(f.side) * out * half / float(np.tan(theta))
            arcs.append(circle(centre, radius))
            if int(f.side) == int(found.side):
                centres.append(Centre(centre, radius, (c1, c2)))
                name = "90° − θ" if theta < np.pi / 2 else "θ − 90°"
                angles += [Angle(c1, c2, centre, name), Angle(c2, c1, centre, name)]
                wishes.append((centre,))
            wishes.append(box(centre, radius))
    values = [(name, float(getattr(task if name == "l3" else found, name)), "length") for name in LINKS]
    values += [("ψ", float(task.swing), "angle"), ("θ", theta, "angle")]
    curves = [Curve(tuple(complex(z) for z in f.a), "bold") for f in family]
    notes = [N_("red: where {A} may be, so that the crank turns fully")]
    if theta > 0:
        notes.append(N_("{M}{C}1{C}2 = {M}{C}2{C}1 = |90° − θ|"))
    return Construction(
        N_("Extreme positions of the rocker, and the circles on which {C}1{C}2 is seen under theta"),
        tuple(segments), tuple(arcs), tuple(spots), tuple(notes), tuple(curves), angles=tuple(angles),
        centres=tuple(centres), wishes=tuple(wishes), chain="four-bar", values=tuple(values),
    )  # fmt: skip


def diagrams(task: Task, found: Found, family: Sequence[Found]) -> tuple[Diagram, Diagram]:
    """Largest pressure angle, and the lengths of crank and frame, over that of the coupler along the arcs."""
    size, most = max(float(found.l2), float(task.l3)), max(float(np.max(f.l2)) for f in family)
    if most > LONGEST * size:
        most = CUT * size
    pressures, lengths = [], []
    for f in family:
        if task.k == 1:
            angle, frame = N_("A on the line C2C1 beyond C1"), N_("frame l4")
        elif int(f.side) > 0:
            angle, frame = N_("A beyond C1C2"), N_("frame l4, A beyond C1C2")
        else:
            angle, frame = N_("A on D's side of C1C2"), N_("frame l4, A on D's side of C1C2")
        x = np.asarray(f.l2)
        kept = x <= most
        pressures.append(Line(angle, x[kept], np.asarray(f.pressure)[kept]))
        lengths.append(Line(frame, x[kept], np.asarray(f.l4)[kept]))
    longest = max(family, key=lambda one: float(np.max(one.l2)))
    kept = np.asarray(longest.l2) <= most
    lengths.append(Line(N_("crank l1"), longest.l2[kept], longest.l1[kept]))
    dot = np.array([found.l2], dtype=float)
    both = np.array([found.l1, found.l4], dtype=float)
    pressures.append(Line(N_("chosen"), dot, np.array([found.pressure], dtype=float), dots=True))
    lengths.append(Line(N_("chosen"), np.repeat(dot, 2), both, dots=True))
    across, title = (N_("coupler l2"), "length"), N_("Largest pressure angle along the admissible arcs")
    drawn = Diagram("family-pressure", title, across, (N_("largest pressure angle"), "angle"), tuple(pressures))
    title = N_("Lengths of the links along the admissible arcs")
    return drawn, Diagram("family-lengths", title, across, (N_("length"), "length"), tuple(lengths))


def listing(family: Sequence[Found]) -> Listing:
    """The family in numbers, from end to end of every arc, where the rocker is dead."""
    columns = (
        ("side", N_("arc"), "word"), ("beta", N_("place on the arc, angle AC2C1"), "angle"),
        ("xA", N_("pivot A of the crank, x"), "length"), ("yA", N_("pivot A of the crank, y"), "length"),
        ("l1", N_("crank l1"), "length"), ("l2", N_("coupler l2"), "length"), ("l4", N_("frame l4"), "length"),
        ("pressure", N_("largest pressure angle"), "angle"), ("transmission", N_("least transmission angle"), "angle"),
    )  # fmt: skip
    rows: list[tuple[Any, ...]] = []
    for f in family:
        across = (np.maximum(f.beta, 0.0), f.a.real, f.a.imag, f.l1, f.l2, f.l4, f.pressure, np.pi / 2 - f.pressure)
        values = np.stack([np.broadcast_to(np.asarray(x, dtype=float), np.shape(f.w)) for x in across], axis=-1)
        rows += [(side_name(f), *row) for row in values.tolist()]
    return Listing(
        "family", N_("All pivots A of the admissible arcs, from end to end"), columns, tuple(rows), long=True
    )


def side_name(found: Found) -> str:
    """Which of the two arcs it is on."""
    return N_("beyond C1C2") if int(found.side) > 0 else N_("on D's side of C1C2")
