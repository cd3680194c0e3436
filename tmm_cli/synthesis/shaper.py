"""Crank shaper (six-bar: crank, stone, slotted lever CD, rod DE, ram) from its stroke and k.

D is equally high in both extreme positions of the lever, so the ram's stroke is the chord of D's arc whatever DE is:
    CD = H/(2 sin(theta/2)),  OA = OC sin(theta/2),  theta = pi (k - 1)/(k + 1).
D's arc is CD (1 - cos(theta/2)) = 2 CD sin^2(theta/4) high. A guide at half of it has the least pressure angle:
    sin(lambda) = CD sin^2(theta/4)/DE.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis import slotted_lever
from tmm_cli.synthesis.construction import Construction, Segment, Size, Spot
from tmm_cli.synthesis.crank_slider import USUAL, k_of, theta_of
from tmm_cli.synthesis.measures import crank_turns, pressure, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Shown, Value

PARAMETERS: Final = dict.fromkeys(("OA", "OC", "CD", "DE", "y"), "length")
W: Final = "synthesis_shaper"
SHORT: Final = 1e-3  # rad: a swing that leaves room for all that can be asked; a share of one so near to half a turn
HALVINGS: Final = 60
ROUNDED: Final = 2e-5  # by which a stroke may grow when it is told


@dataclass(frozen=True)
class Asked:
    """Stroke, k; frame OC, its ratio to CD or the crank OA; rod DE, its ratio or the pressure angle (m, rad)."""

    stroke: Any
    k: Any
    frame: Any = None
    frame_ratio: Any = None
    crank: Any = None
    rod: Any = None
    rod_ratio: Any = None
    pressure: Any = None


@dataclass(frozen=True)
class Found:
    """Lengths (m), level: of the guide over O (m), theta and the largest pressure angle of the ram (rad)."""

    crank: Any
    frame: Any
    lever: Any
    rod: Any
    level: Any
    theta: Any
    pressure: Any


def find(asked: Asked) -> Found:
    """The lengths. Where there is no such mechanism (`refuse` says why) they mean nothing."""
    theta = theta_of(asked.k)
    sine, half_height = np.sin(theta / 2), np.sin(theta / 4) ** 2
    lever = np.asarray(asked.stroke) / (2 * sine)
    if asked.crank is not None:
        frame = np.asarray(asked.crank) / sine
    else:
        frame = lever * asked.frame_ratio if asked.frame is None else np.asarray(asked.frame)
    rise = lever * half_height
    if asked.pressure is not None:
        rod = rise / np.sin(asked.pressure)
    else:
        rod = lever * asked.rod_ratio if asked.rod is None else np.asarray(asked.rod)
    level = lever * (1 - half_height) - frame
    return Found(frame * sine, frame, lever, rod, level, theta, np.arcsin(np.minimum(rise / rod, 1)))


def refuse(asked: Asked) -> None:
    """Raises Infeasible with the reason and what could be met."""
    names = {
        "stroke": "stroke", "frame": "OC", "frame_ratio": "frame_ratio", "crank": "OA", "rod": "DE",
        "rod_ratio": "rod_ratio",
    }  # fmt: skip
    for name, key in names.items():
        value = getattr(asked, name)
        if value is not None and not value > 0 and name not in ("rod", "rod_ratio", "stroke"):
            kind = "number" if name == "frame_ratio" else "length"
            raise Infeasible(key, f"{W}.positive", f"{W}.at_least", {"least": (SMALLEST, kind)})
    if not asked.k > 1:
        _refuse_small(asked)
    half = float(theta_of(asked.k)) / 2
    if not np.pi - 2 * half > slotted_lever.STRAIGHT:
        refuse(replace(asked, k=float(k_of(SHORT))))  # what no k would mend is told first
        raise Infeasible("k", f"{W}.straight", f"{W}.k_most", {"k": (_largest_k(asked), "number", "below")})
    most, share = 1 / (1 + np.sin(half)), np.sin(half / 2) ** 2 / np.cos(half)
    if not asked.stroke > 0:
        _refuse_stroke(asked, 2 * float(np.sin(half)), most, share)
    if asked.pressure is not None and not 0 < asked.pressure < np.pi / 2:
        values: dict[str, Shown] = {"low": (SMALLEST, "angle"), "high": (np.pi / 2 - half, "angle", "below")}
        values["usual"] = (USUAL, "angle")
        words = "pressure_allowed" if np.pi / 2 - half > USUAL else "pressure_steep"
        raise Infeasible("pressure", f"{W}.pressure_range", f"{W}.{words}", values)
    f = find(asked)
    lever = float(f.lever)
    short: dict[str, Shown] = {
        name: (limit, kind, "above") if limit > SMALLEST else (SMALLEST, kind)
        for name, limit, kind in (("rod", lever * share, "length"), ("rod_ratio", share, "number"))
    }
    for name, limit in short.items():
        if getattr(asked, name) is not None and not getattr(asked, name) > 0:
            raise Infeasible(names[name], f"{W}.positive", f"{W}.rod_least", {"least": limit})
    if not f.frame < lever * most:
        limits: dict[str, Shown] = {
            "frame": (lever * most, "length", "below"), "frame_ratio": (most, "number", "below"),
            "crank": (lever * most * np.sin(half), "length", "below"),
        }  # fmt: skip
        by = next(name for name in limits if getattr(asked, name) is not None)
        raise Infeasible(names[by], f"{W}.frame_above", f"{W}.frame_most", {"most": limits[by]})
    if not f.pressure < np.pi / 2 - half:  # beyond, the ram turns back before the lever does
        if asked.pressure is not None:
            values = {"most": (np.pi / 2 - half, "angle", "below")}
            raise Infeasible("pressure", f"{W}.turns_back", f"{W}.pressure_most", values)
        name = "rod" if asked.rod_ratio is None else "rod_ratio"
        raise Infeasible(names[name], f"{W}.turns_back", f"{W}.rod_least", {"least": short[name]})


def _refuse_small(asked: Asked) -> None:
    """k of 1 or less: the same strokes the other way round, or the largest k that the other numbers allow."""
    values: dict[str, Shown] = {"least": (1.0, "number", "above")}
    words = "k_more"
    if 0 < asked.k < 1:
        try:
            refuse(replace(asked, k=1 / asked.k))
            values["k"], words = (1 / asked.k, "number", "most"), "k_least"
        except Infeasible:
            refuse(replace(asked, k=float(k_of(SHORT))))  # what no k would mend is told first
            values["k"], words = (_largest_k(asked), "number", "below"), "k_range"
    raise Infeasible("k", f"{W}.k_below", f"{W}.{words}", values)


def _largest_k(asked: Asked) -> float:
    """Up to which k the other numbers make a shaper; a lesser k leaves more room for all of them."""

    def good(theta: float) -> bool:
        try:
            refuse(replace(asked, k=k_of(theta)))
        except Infeasible:
            return False
        return True

    low, high = SHORT, np.pi - slotted_lever.STRAIGHT
    if good(np.pi - slotted_lever.STRAIGHT * (1 + SHORT)) or not good(low):
        return float(k_of(high))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if good(middle) else (low, middle)
    return float(k_of(low))


def _refuse_stroke(asked: Asked, chord: float, most: float, share: float) -> None:
    """No stroke: the least that the frame or the crank leaves, if the rod is long enough for it. chord: H/CD; most:
    OC/CD; share: the least DE/CD.
    """
    frame = float(asked.crank) / (chord / 2) if asked.crank is not None else float(asked.frame or 0.0)
    least = max(SMALLEST, frame / most * chord)
    fits = asked.rod is None or asked.rod * chord > least * share
    values: dict[str, Shown] = {"least": (least, "length", *(("above",) if frame else ()))}
    if not fits:
        rod = least / chord * share * (1 + ROUNDED)
        values["rod"] = (rod, "length", "above") if rod > SMALLEST else (SMALLEST, "length")
    raise Infeasible("stroke", f"{W}.positive", f"{W}.at_least" if fits else f"{W}.with_rod", values, whole=not fits)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(asked)
    f = find(asked)
    kinds = {"stroke": "length", "frame": "length", "crank": "length", "rod": "length", "pressure": "angle"}
    given = tuple(
        Value(name, value, kinds.get(name, "number"), f"{W}.{name}")
        for name, value in vars(asked).items() if value is not None
    )  # fmt: skip
    lengths = {"OA": f.crank, "OC": f.frame, "CD": f.lever, "DE": f.rod, "y": f.level}
    found = [Value(name, value, "length", f"{W}.{name}") for name, value in lengths.items()]
    found.append(Value("", f.theta, "angle", f"{W}.theta"))
    if asked.pressure is None:
        found.append(Value("", f.pressure, "angle", f"{W}.pressure"))
    found.append(Value("", f.lever / (1 + np.sin(f.theta / 2)), "length", f"{W}.longest"))
    demands = (
        Demand(f"{W}.crank_turns", 1.0, "number", crank_turns, asked=False),
        Demand(f"{W}.stroke", float(asked.stroke), "length", stroke),
        Demand(f"{W}.k", float(asked.k), "number", ratio),
        Demand(f"{W}.pressure", float(f.pressure), "angle", pressure, asked.pressure is not None),
    )
    return Outcome(given, tuple(found), f"{W}.source", demands, (construction(f),))


def construction(f: Found) -> Construction:
    """The lever in its extreme positions, the guide midway in D's arc, the ram at both ends of its stroke; O at 0."""
    middle, half = np.pi / 2, float(f.theta) / 2
    lever = slotted_lever.Found(
        f.crank, f.frame, f.lever, 0j, complex(0, -float(f.frame)), middle + half, middle - half, f.theta, f.lever
    )
    segments, arcs, spots, angles = slotted_lever.lever_parts(lever, "D")
    reach = float(f.rod * np.cos(f.pressure))
    d1, d2 = (spot.at for spot in spots[-2:])
    e1, e2 = (complex(d.real + reach, float(f.level)) for d in (d1, d2))
    stroke = abs(e2 - e1)
    ends = sorted((e1.real, e2.real))
    segments += [
        Segment(d1, e1, "link", "DE"), Segment(d2, e2, "link2", "DE"), Segment(d1, d2, "dashed"),
        Segment(complex(ends[0] - 0.12 * stroke, e1.imag), complex(ends[1] + 0.12 * stroke, e1.imag), "guide"),
    ]  # fmt: skip
    spots += [Spot("E1", e1, "slider"), Spot("E2", e2, "slider")]
    top = complex(0, float(f.lever) - float(f.frame))  # of D's arc
    sizes = (Size(e1, e2, "H", 1 + 0j), Size(lever.o, e2, "y", 1j))
    lengths = {"OA": f.crank, "OC": f.frame, "CD": f.lever, "DE": f.rod}
    return Construction(
        f"{W}.construction", tuple(segments), tuple(arcs), tuple(spots), (f"{W}.midway",), angles=tuple(angles),
        sizes=sizes, chain="shaper", wishes=((top,),),
        values=(*((name, float(value), "length") for name, value in lengths.items()), ("θ", float(f.theta), "angle")),
    )  # fmt: skip
