"""Drawings of the four-bars by k: circles with their admissible arcs, link lengths and pressure angle along them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.construction import Angle, Arc, Centre, Construction, Curve, Diagram, Line, Segment, Spot, box
from tmm_cli.synthesis.four_bar_arcs import arcs, at, places, widest
from tmm_cli.synthesis.record import Listing, Value

W: Final = "synthesis_four_bar_by_k"
LINKS: Final = ("l1", "l2", "l3", "l4")
LONGEST: Final = 20.0  # the whole family is on the diagrams when no rod is longer than this many of the chosen one
CUT: Final = 4.0  # (and of the rocker); else rods up to this many of that


def on_arcs(asked: Any, plain: Any, found: Any) -> list[Value]:
    """Where the pivot stands, what that means for the crank, and how far the admissible arcs reach. plain: the same in
    ordinary precision."""
    values = [
        Value("", found.beta, "angle", f"{W}.beta"),
        Value("", None, "word", f"{W}.side", f"{W}.side_{'beyond' if found.side > 0 else 'inside'}"),
        Value("", None, "word", f"{W}.sense_is", f"{W}.{'ccw' if found.sense > 0 else 'cw'}"),
    ]
    for side in arcs(asked):
        name = "beyond" if side > 0 else "inside"
        last = at(plain, places(asked, side)[-1], side)
        values.append(Value("", widest(asked, side), "angle", f"{W}.arc_{name}"))
        values.append(Value("", last.l4, "length", f"{W}.end_{name}"))
    return values


def construction(asked: Any, found: Any, family: Sequence[Any]) -> Construction:
    """Both extreme positions, the circles on which C1C2 is seen under theta, and the pivots that may be A."""
    d, a = complex(asked.support), complex(found.a)
    c1, c2 = (complex(d + asked.l3 * np.exp(1j * psi)) for psi in (asked.psi1, asked.psi2))
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
    middle, theta, half = (c1 + c2) / 2, float(asked.theta), abs(c2 - c1) / 2
    arcs = [Arc(a, float(found.l1), 0.0, 2 * np.pi, "dashed")]
    angles = [Angle(d, c1, c2, "ψ")]
    centres, wishes = [], [box(a, float(found.l1))]
    if theta > 0:
        out, radius = (middle - d) / abs(middle - d), half / float(np.sin(theta))
        angles.append(Angle(a, c1, c2, "θ"))
        for f in sorted(family, key=lambda one: int(one.side) != int(found.side)):
            centre = middle + int(f.side) * out * half / float(np.tan(theta))
            arcs.append(Arc(centre, radius, 0.0, 2 * np.pi, "dashed"))
            if int(f.side) == int(found.side):
                centres.append(Centre(centre, radius, (c1, c2)))
                name = "90° − θ" if theta < np.pi / 2 else "θ − 90°"
                angles += [Angle(c1, c2, centre, name), Angle(c2, c1, centre, name)]
                wishes.append((centre,))
            wishes.append(box(centre, radius))
    values = [(name, float(getattr(asked if name == "l3" else found, name)), "length") for name in LINKS]
    values += [("ψ", float(asked.swing), "angle"), ("θ", theta, "angle")]
    curves = [Curve(tuple(complex(z) for z in f.a), "bold") for f in family]
    return Construction(
        f"{W}.construction", tuple(segments), tuple(arcs), tuple(spots),
        (f"{W}.bold", f"{W}.angles") if theta > 0 else (f"{W}.bold",),
        tuple(curves), angles=tuple(angles), centres=tuple(centres), wishes=tuple(wishes), chain="four-bar",
        values=tuple(values),
    )  # fmt: skip


def diagrams(asked: Any, found: Any, family: Sequence[Any]) -> tuple[Diagram, Diagram]:
    """Largest pressure angle, and the lengths of crank and frame, over that of the coupler along the arcs."""
    size, most = max(float(found.l2), float(asked.l3)), max(float(np.max(f.l2)) for f in family)
    if most > LONGEST * size:
        most = CUT * size
    pressures, lengths = [], []
    for number, f in enumerate(family):
        name = "line" if asked.k == 1 else "beyond" if int(f.side) > 0 else "inside"
        x = np.asarray(f.l2)
        kept = x <= most
        pressures.append(Line(f"{W}.pressure_{name}", x[kept], np.asarray(f.pressure)[kept]))
        lengths.append(Line(f"{W}.l4_{name}", x[kept], np.asarray(f.l4)[kept]))
        if number == len(family) - 1:
            longest = max(family, key=lambda one: float(np.max(one.l2)))
            kept = np.asarray(longest.l2) <= most
            lengths.append(Line(f"{W}.l1", longest.l2[kept], longest.l1[kept]))
    dot = np.array([found.l2], dtype=float)
    pressures.append(Line(f"{W}.chosen", dot, np.array([found.pressure], dtype=float), dots=True))
    both = np.array([found.l1, found.l4], dtype=float)
    lengths.append(Line(f"{W}.chosen", np.repeat(dot, 2), both, dots=True))
    across = (f"{W}.l2", "length")
    return (
        Diagram("family-pressure", f"{W}.family_pressure", across, (f"{W}.pressure", "angle"), tuple(pressures)),
        Diagram("family-lengths", f"{W}.family_lengths", across, (f"{W}.lengths", "length"), tuple(lengths)),
    )


def listing(family: Sequence[Any]) -> Listing:
    """The family in numbers, from end to end of every arc, where the rocker is dead."""
    lengths = ("l1", "l2", "l4")
    columns = (
        (f"{W}.side", "word"), (f"{W}.beta", "angle"), (f"{W}.xA", "length"), (f"{W}.yA", "length"),
        *((f"{W}.{name}", "length") for name in lengths), (f"{W}.pressure", "angle"), (f"{W}.transmission", "angle"),
    )  # fmt: skip
    rows = []
    for f in family:
        side = f"{W}.side_{'beyond' if int(f.side) > 0 else 'inside'}"
        across = (
            np.maximum(f.beta, 0.0),
            f.a.real,
            f.a.imag,
            *(getattr(f, name) for name in lengths),
            f.pressure,
            np.pi / 2 - f.pressure,
        )
        values = np.stack([np.broadcast_to(np.asarray(x, dtype=float), np.shape(f.w)) for x in across], axis=-1)
        rows += [(side, *row) for row in values.tolist()]
    return Listing("family", f"{W}.family", columns, tuple(rows), long=True)
