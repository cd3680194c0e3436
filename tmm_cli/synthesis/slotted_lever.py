"""Slotted lever by k and the extreme positions of its end B: the crank's pin touches both from O on their bisector.

In an extreme position OA is square to CB, so that the lever swings by theta = pi (k - 1)/(k + 1) = B1CB2, and
    CB = B1B2/(2 sin(theta/2)),  OA = OC sin(theta/2);
the stone moves between OC - OA and OC + OA from C. OC is free. The force on the stone is the lever's moment over its
distance from C, so the longest OC that leaves the stone on CB gives the least force: OC (1 + sin(theta/2)) = CB.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.construction import Angle, Arc, Construction, Diagram, Line, Segment, Spot, box
from tmm_cli.synthesis.crank_slider import k_of, theta_of
from tmm_cli.synthesis.measures import crank_turns, end_angle, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Listing, Outcome, Shown, Value
from tmm_cli.vectors import settled

PARAMETERS: Final = {**dict.fromkeys(("OA", "OC", "CB", "xO", "yO", "xC", "yC"), "length"), "phi": "angle"}
W: Final = "synthesis_slotted_lever"
FAMILY: Final = 61  # lengths of OC within bounds that are listed
ANY: Final = 0.1  # m: a distance, where any will do
STRAIGHT: Final = 1e-6  # rad: a lever that swings by so little less than half a turn is dead at both ends


@dataclass(frozen=True)
class Asked:
    """Places b1, b2 (m) of the lever's end, or its length (m) with the place of C and the direction (rad) from C to O.

    k or the swing (rad). side: of the way from b1 to b2 on which C lies, 1 left, -1 right; with the length 1 turns the
    lever clockwise from b1 to b2. OC (m), or the crank OA (m), or bounds of OC and which is chosen: force (the longest
    with the stone on CB) or shortest.
    """

    b1: Any = None
    b2: Any = None
    length: Any = None
    c: Any = 0j
    axis: Any = 0.0
    side: int = -1
    k: Any = None
    swing: Any = None
    frame: Any = None
    crank: Any = None
    within: tuple[Any, Any] | None = None
    choose: str = "force"

    @property
    def theta(self) -> Any:
        return theta_of(self.k) if self.swing is None else np.asarray(self.swing)


@dataclass(frozen=True)
class Found:
    """Lengths (m), places O and C (m), angles of CB1 and CB2 (rad); longest: OC that leaves the stone on CB."""

    crank: Any
    frame: Any
    lever: Any
    o: Any
    c: Any
    psi1: Any
    psi2: Any
    theta: Any
    longest: Any


def find(asked: Asked) -> Found:
    """The lengths and places. Where there is no such mechanism (`refuse` says why) they mean nothing."""
    theta = asked.theta
    sine = np.sin(theta / 2)
    if asked.length is None:
        way = np.asarray(asked.b2) - asked.b1
        lever = np.abs(way) / 2 / sine
        c = (np.asarray(asked.b1) + asked.b2) / 2 + asked.side * 1j * way / 2 / np.tan(theta / 2)
        along = -asked.side * 1j * way / np.abs(way)
        psi1, psi2 = np.angle(asked.b1 - c), np.angle(asked.b2 - c)
    else:
        lever, c = np.asarray(asked.length), asked.c
        along = np.cos(asked.axis) + 1j * np.sin(asked.axis)
        psi1, psi2 = asked.axis - asked.side * theta / 2, asked.axis + asked.side * theta / 2
    longest = lever / (1 + sine)
    if asked.crank is not None:
        frame = np.asarray(asked.crank) / sine
    elif asked.within is None:
        frame = np.asarray(asked.frame)
    elif asked.choose == "force":
        frame = np.minimum(asked.within[1], longest)
    else:
        frame = np.asarray(asked.within[0])
    size = lever + frame + np.abs(c)
    along, c = settled(along, 1.0), settled(c, size)
    return Found(frame * sine, frame, lever, settled(c + frame * along, size), c, psi1, psi2, theta, longest)


def refuse(asked: Asked) -> None:
    """Raises Infeasible with the reason and what could be met."""
    if asked.k is not None and not asked.k > 1:
        values: dict[str, Shown] = {"least": (1.0, "number", "above")}
        if turned := STRAIGHT < asked.k < 1 and _solved(replace(asked, k=1 / asked.k)):
            values["k"] = (1 / asked.k, "number", "most")
        raise Infeasible("k", f"{W}.k_below", f"{W}.k_least" if turned else f"{W}.k_more", values)
    if asked.k is not None and not np.pi - asked.theta > STRAIGHT:
        values = {"k": (float(k_of(np.pi - STRAIGHT)), "number", "below")}
        raise Infeasible("k", f"{W}.swing_range", f"{W}.k_most", values)
    if asked.swing is not None and not 0 < asked.swing < np.pi - STRAIGHT:
        values = {"least": (SMALLEST, "angle", "least"), "most": (np.pi - STRAIGHT, "angle", "below")}
        raise Infeasible("swing", f"{W}.swing_range", f"{W}.swing_allowed", values)
    for name, value in (("CB", asked.length), ("OC", asked.frame), ("OA", asked.crank)):
        if value is not None and not value > 0:
            values = {"least": (SMALLEST, "length")}
            if name == "CB" and (lever := _shortest_lever(asked)) > SMALLEST:
                values["lever"] = (lever, "length", "least")
                words = "lever_least" if asked.within is not None else "lever_usable"
                raise Infeasible(name, f"{W}.positive", f"{W}.{words}", values)
            raise Infeasible(name, f"{W}.positive", f"{W}.at_least", values)
    if asked.length is None and abs(asked.b2 - asked.b1) == 0:
        way = _shortest_lever(asked) * 2 * float(np.sin(asked.theta / 2))  # so that the stone is on CB
        way = way if way > SMALLEST else ANY
        values = {"x": (asked.b1.real + way, "length", "least"), "y": (asked.b1.imag, "length")}
        raise Infeasible("B2", f"{W}.same", f"{W}.other_place", values)
    if asked.within is not None:
        low, high = asked.within
        longest = float(find(replace(asked, within=(1.0, 1.0))).longest)
        if not 0 < low <= high:
            first, last = max(SMALLEST, min(low, high, longest)), max(low, high)
            last = last if last > 0 else max(SMALLEST, longest)
            values = {"first": (first, "length", "most"), "last": (last, "length", "least")}
            raise Infeasible("within", f"{W}.bounds", f"{W}.bounds_order", values)
        if low > longest:
            raise Infeasible("within", f"{W}.too_long", f"{W}.longest_most", {"longest": (longest, "length", "most")})


def _solved(asked: Asked) -> bool:
    try:
        refuse(asked)
    except Infeasible:
        return False
    return True


def _shortest_lever(asked: Asked) -> float:
    """The least CB (m) that has the stone on it, for what is given of OC, or of OA."""
    sine = float(np.sin(asked.theta / 2))
    frame = asked.within[0] if asked.within is not None else asked.frame if asked.crank is None else asked.crank / sine
    return float(frame) * (1 + sine)


def sense(asked: Asked) -> int:
    """Of the crank whose slow stroke leads from B1 to B2: that in which the lever turns then."""
    return asked.side


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(asked)
    f = find(asked)
    given = [
        Value("", part, "length", f"{W}.{name}_{axis}")
        for name in ("b1", "b2") if getattr(asked, name) is not None
        for axis, part in (("x", np.real(getattr(asked, name))), ("y", np.imag(getattr(asked, name))))
    ]  # fmt: skip
    kinds = {"length": "length", "k": "number", "swing": "angle", "frame": "length", "crank": "length"}
    given += [
        Value(n, getattr(asked, n), kind, f"{W}.{n}") for n, kind in kinds.items() if getattr(asked, n) is not None
    ]
    if asked.within is not None:
        given += [Value("", v, "length", f"{W}.{n}") for n, v in zip(("low", "high"), asked.within, strict=True)]
        given.append(Value("", None, "word", f"{W}.choose", f"{W}.choose_{asked.choose}"))
    lengths = {
        "OA": f.crank, "OC": f.frame, "CB": f.lever, "xO": np.real(f.o), "yO": np.imag(f.o), "xC": np.real(f.c),
        "yC": np.imag(f.c),
    }  # fmt: skip
    found = [Value(name, value, "length", f"{W}.{name}") for name, value in lengths.items()]
    away = f.o - f.c
    found += [
        Value("phi", np.arctan2(np.imag(away), np.real(away)), "angle", f"{W}.phi"),
        Value("", f.theta, "angle", f"{W}.theta"),
        Value("", f.frame - f.crank, "length", f"{W}.nearest"),
        Value("", f.frame + f.crank, "length", f"{W}.farthest"),
        Value("", f.longest, "length", f"{W}.longest"),
        Value("", None, "word", f"{W}.sense", f"{W}.{'ccw' if sense(asked) > 0 else 'cw'}"),
    ]
    demands = (
        Demand(f"{W}.crank_turns", 1.0, "number", crank_turns, asked=False),
        Demand(f"{W}.k", float(k_of(f.theta)), "number", ratio, asked.k is not None),
        Demand(f"{W}.swing", float(f.theta), "angle", stroke, asked.swing is not None),
        *(Demand(f"{W}.{n}", float(v), "angle", partial(end_angle, near=float(v)), at=1.0)
          for n, v in (("psi1", f.psi1), ("psi2", f.psi2))),
    )  # fmt: skip
    notes = (f"{W}.passes",) if f.frame > f.longest * (1 + 1e-12) else ()
    free = family(asked, f) if asked.within is not None and asked.within[0] < asked.within[1] else None
    drawings, listings = ((construction(f), free[0]), (free[1],)) if free else ((construction(f),), ())
    return Outcome(tuple(given), tuple(found), f"{W}.source", demands, drawings, notes, listings)


def family(asked: Asked, f: Found) -> tuple[Diagram, Listing]:
    """OA and the stone's distances from C over the free distance OC within its bounds, drawn and in numbers."""
    assert asked.within is not None
    low, high = (float(x) for x in asked.within)
    frame = np.linspace(low, high, FAMILY)
    crank = frame * float(np.sin(f.theta / 2))
    rows = {"OA": crank, "nearest": frame - crank, "farthest": frame + crank}
    lines = [Line(f"{W}.{name}", frame, values) for name, values in rows.items()]
    lines.append(Line(f"{W}.length", frame, np.full(FAMILY, float(f.lever))))
    own = np.array([f.crank, f.frame - f.crank, f.frame + f.crank], dtype=float)
    lines.append(Line(f"{W}.chosen", np.full(3, float(f.frame)), own, dots=True))
    across, up = (f"{W}.OC", "length"), (f"{W}.lengths", "length")
    columns = tuple((f"{W}.{name}", "length") for name in ("OC", *rows))
    values = np.stack((frame, *rows.values()), axis=-1).tolist()
    return (
        Diagram("family-lengths", f"{W}.family_lengths", across, up, tuple(lines)),
        Listing("family", f"{W}.family", columns, tuple(map(tuple, values)), long=True),
    )


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
    arcs = [Arc(o, crank, 0.0, 2 * np.pi, "dashed"), Arc(c, lever, first, last, "dashed")]
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
        f"{W}.construction", tuple(segments), tuple(arcs), tuple(spots), (f"{W}.square",), angles=tuple(angles),
        chain="slotted-lever", wishes=(box(complex(f.o), float(f.crank)),),
        values=(("OA", float(f.crank), "length"), ("OC", float(f.frame), "length"), ("CB", float(f.lever), "length"),
                ("θ", float(f.theta), "angle")),
    )  # fmt: skip
