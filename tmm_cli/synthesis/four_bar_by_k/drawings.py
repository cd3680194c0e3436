"""Drawings and table of a four-bar with a given time ratio k: extreme positions, admissible arcs, four-bars along the
arcs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import (
    Angle,
    CircleCentre,
    ConstructionCurve,
    Diagram,
    DiagramLine,
    GeometricConstruction,
    LetteredPoint,
    Segment,
    circle_extent,
    full_circle,
)
from tmm_cli.synthesis.four_bar_by_k.arcs import (
    FourBarByKSolution,
    FourBarByKTask,
)
from tmm_cli.synthesis.record import Listing

LINKS: Final = ("l1", "l2", "l3", "l4")
LONGEST: Final = 20.0  # times the chosen rod: diagrams show the whole family if no rod is longer
CUT: Final = 4.0  # times the longer of rod and rocker: longest rod shown otherwise


def draw_construction(
    task: FourBarByKTask, solution: FourBarByKSolution, family: Sequence[FourBarByKSolution]
) -> GeometricConstruction:
    """Draw both extreme positions, the circles from which C1C2 is seen at the angle theta, and the admissible arcs of
    A.
    """
    d, a = complex(task.support), complex(solution.a)
    c1, c2 = (complex(d + task.l3 * np.exp(1j * psi)) for psi in (task.psi1, task.psi2))
    way1, way2 = (c1 - a) / abs(c1 - a), (c2 - a) / abs(c2 - a)
    pin1, pin2 = a - solution.l1 * way1, a + solution.l1 * way2
    segments = [
        Segment(d, c1, "link", "l3"),
        Segment(pin1, a, "link", "l1"),
        Segment(a, c1, "link", "l2 − l1"),
        Segment(d, c2, "link2", "l3"),
        Segment(a, pin2, "link2", "l1"),
        Segment(pin2, c2, "link2", "l2"),
        Segment(d, a, "axis", "l4"),
        Segment(c1, c2, "thin"),
    ]
    spots = [
        LetteredPoint("D", d, "support"),
        LetteredPoint("A", a, "support"),
        LetteredPoint("B1", pin1, "hinge"),
        LetteredPoint("B2", pin2, "hinge"),
        LetteredPoint("C1", c1, "hinge"),
        LetteredPoint("C2", c2, "hinge"),
    ]
    middle, theta, half = (c1 + c2) / 2, float(task.theta), abs(c2 - c1) / 2
    arcs = [full_circle(a, float(solution.l1))]
    angles = [Angle(d, c1, c2, "ψ")]
    centres, wishes = [], [circle_extent(a, float(solution.l1))]
    if theta > 0:
        out, radius = (middle - d) / abs(middle - d), half / float(np.sin(theta))
        angles.append(Angle(a, c1, c2, "θ"))
        for f in sorted(family, key=lambda member: int(member.side) != int(solution.side)):
            centre = middle + int(f.side) * out * half / float(np.tan(theta))
            arcs.append(full_circle(centre, radius))
            if int(f.side) == int(solution.side):
                centres.append(CircleCentre(centre, radius, (c1, c2)))
                name = "90° − θ" if theta < np.pi / 2 else "θ − 90°"
                angles += [Angle(c1, c2, centre, name), Angle(c2, c1, centre, name)]
                wishes.append((centre,))
            wishes.append(circle_extent(centre, radius))
    values = [(name, float(getattr(task if name == "l3" else solution, name)), "length") for name in LINKS]
    values += [("ψ", float(task.swing), "angle"), ("θ", theta, "angle")]
    curves = [ConstructionCurve(tuple(complex(z) for z in f.a), "bold") for f in family]
    notes = [N_("red: points {A} for which the crank rotates fully")]
    if theta > 0:
        notes.append(N_("{M}{C}1{C}2 = {M}{C}2{C}1 = |90° − θ|"))
    return GeometricConstruction(
        N_("Extreme positions of the rocker, and the circles from which {C}1{C}2 is seen at the angle theta"),
        tuple(segments),
        tuple(arcs),
        tuple(spots),
        tuple(notes),
        tuple(curves),
        angles=tuple(angles),
        centres=tuple(centres),
        wishes=tuple(wishes),
        chain="four-bar",
        values=tuple(values),
    )


def draw_diagrams(
    task: FourBarByKTask, solution: FourBarByKSolution, family: Sequence[FourBarByKSolution]
) -> tuple[Diagram, Diagram]:
    """Plot the largest pressure angle, and the lengths of crank and frame, against the coupler length along the
    arcs.
    """
    size, most = max(float(solution.l2), float(task.l3)), max(float(np.max(f.l2)) for f in family)
    if most > LONGEST * size:
        most = CUT * size
    pressures, lengths = [], []
    for f in family:
        if task.k == 1:
            angle, frame = N_("A on the line C2C1, beyond C1"), N_("frame l4")
        elif int(f.side) > 0:
            angle, frame = N_("A and D on opposite sides of C1C2"), N_("frame l4, A and D on opposite sides of C1C2")
        else:
            angle, frame = N_("A and D on the same side of C1C2"), N_("frame l4, A and D on the same side of C1C2")
        x = np.asarray(f.l2)
        kept = x <= most
        pressures.append(DiagramLine(angle, x[kept], np.asarray(f.pressure)[kept]))
        lengths.append(DiagramLine(frame, x[kept], np.asarray(f.l4)[kept]))
    longest = max(family, key=lambda member: float(np.max(member.l2)))
    kept = np.asarray(longest.l2) <= most
    lengths.append(DiagramLine(N_("crank l1"), longest.l2[kept], longest.l1[kept]))
    dot = np.array([solution.l2], dtype=float)
    both = np.array([solution.l1, solution.l4], dtype=float)
    pressures.append(DiagramLine(N_("chosen"), dot, np.array([solution.pressure], dtype=float), dots=True))
    lengths.append(DiagramLine(N_("chosen"), np.repeat(dot, 2), both, dots=True))
    across, title = (N_("coupler l2"), "length"), N_("Largest pressure angle along the admissible arcs")
    drawn = Diagram("family-pressure", title, across, (N_("largest pressure angle"), "angle"), tuple(pressures))
    title = N_("Lengths of the links along the admissible arcs")
    return drawn, Diagram("family-lengths", title, across, (N_("length"), "length"), tuple(lengths))


def tabulate_family(family: Sequence[FourBarByKSolution]) -> Listing:
    """Tabulate the four-bars along every arc, including its ends, where the rocker is in a dead position."""
    columns = (
        ("side", N_("arc"), "word"),
        ("beta", N_("position on the arc: angle AC2C1"), "angle"),
        ("xA", N_("x coordinate of the crank pivot A"), "length"),
        ("yA", N_("y coordinate of the crank pivot A"), "length"),
        ("l1", N_("crank l1"), "length"),
        ("l2", N_("coupler l2"), "length"),
        ("l4", N_("frame l4"), "length"),
        ("pressure", N_("largest pressure angle"), "angle"),
        ("transmission", N_("smallest transmission angle"), "angle"),
    )
    rows: list[tuple[Any, ...]] = []
    for f in family:
        across = (np.maximum(f.beta, 0.0), f.a.real, f.a.imag, f.l1, f.l2, f.l4, f.pressure, np.pi / 2 - f.pressure)
        values = np.stack([np.broadcast_to(np.asarray(x, dtype=float), np.shape(f.w)) for x in across], axis=-1)
        rows += [(side_name(f), *row) for row in values.tolist()]
    return Listing("family", N_("Four-bars with the pivot A on the admissible arcs"), columns, tuple(rows), long=True)


def side_name(solution: FourBarByKSolution) -> str:
    """Return the name of the arc on which the crank pivot lies."""
    return N_("on the side of C1C2 opposite to D") if int(solution.side) > 0 else N_("on the same side of C1C2 as D")
