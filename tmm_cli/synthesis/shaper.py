"""Synthesis of a crank shaper from its stroke and its time ratio k."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import DEAD_SWING
from tmm_cli.problem import Value as FileValue, ValueReader
from tmm_cli.synthesis.blocks import TaskBlock, choose_key_set, read_numbers
from tmm_cli.synthesis.construction import DimensionLine, GeometricConstruction, LetteredPoint, Segment
from tmm_cli.synthesis.measures import (
    driver_completes_range,
    largest_pressure_angle,
    output_stroke,
    theta_of,
    time_ratio,
)
from tmm_cli.synthesis.record import Demand, Infeasible, NamedValue, SolutionQuality, SynthesisOutcome, given_values
from tmm_cli.synthesis.slotted_lever import HALF_A_TURN, QUICK_RETURN, SlottedLeverSolution as Lever, lever_elements


def draw_construction(f: ShaperSolution) -> GeometricConstruction:
    """Draw the geometric construction of a shaper, with the crank pivot O at the origin.

    It shows the lever and the ram in both extreme positions. The guide of the ram bisects the height of D's arc.
    """
    middle, half = np.pi / 2, float(f.theta) / 2
    lever = Lever(
        f.crank, f.frame, f.lever, 0j, complex(0, -float(f.frame)), middle + half, middle - half, f.theta, f.lever
    )
    segments, arcs, spots, angles = lever_elements(lever, "D")
    reach = float(f.rod * np.cos(f.pressure))
    d1, d2 = (spot.at for spot in spots[-2:])
    e1, e2 = (complex(d.real + reach, float(f.level)) for d in (d1, d2))
    stroke = abs(e2 - e1)
    ends = sorted((e1.real, e2.real))
    segments += [
        Segment(d1, e1, "link", "DE"),
        Segment(d2, e2, "link2", "DE"),
        Segment(d1, d2, "dashed"),
        Segment(complex(ends[0] - 0.12 * stroke, e1.imag), complex(ends[1] + 0.12 * stroke, e1.imag), "axis"),
    ]
    spots += [LetteredPoint("E1", e1, "slider"), LetteredPoint("E2", e2, "slider")]
    top = complex(0, float(f.lever) - float(f.frame))  # top of D's arc
    sizes = (DimensionLine(e1, e2, "H", 1 + 0j), DimensionLine(lever.o, e2, "y", 1j))
    lengths = {"OA": f.crank, "OC": f.frame, "CD": f.lever, "DE": f.rod}
    return GeometricConstruction(
        N_("Extreme positions of the shaper"),
        tuple(segments),
        tuple(arcs),
        tuple(spots),
        (N_("the guide lies midway between {D}1{D}2 and the top of the arc"),),
        angles=tuple(angles),
        sizes=sizes,
        chain="shaper",
        wishes=((top,),),
        values=(*((name, float(value), "length") for name, value in lengths.items()), ("θ", float(f.theta), "angle")),
    )


# Crank shaper (six-bar: crank, sliding block, slotted lever CD, rod DE, ram) from its stroke and k.
#
# D has the same height in both extreme positions of the lever, so the stroke is the chord of D's arc for any DE:
#     CD = H/(2 sin(theta/2)),  OA = OC sin(theta/2),  theta = pi (k - 1)/(k + 1).
# The height of D's arc is CD (1 - cos(theta/2)) = 2 CD sin^2(theta/4). A guide at half of it has the smallest angle:
#     sin(lambda) = CD sin^2(theta/4)/DE.


PARAMETERS: Final = dict.fromkeys(("OA", "OC", "CD", "DE", "y"), "length")
QUANTITIES: Final = {  # quantities that a task may give: kind and description
    "stroke": ("length", N_("stroke H of the ram")),
    "k": ("number", N_("k (time ratio)")),
    "OC": ("length", N_("frame OC")),
    "frame_ratio": ("number", N_("ratio OC/CD")),
    "OA": ("length", N_("crank OA")),
    "DE": ("length", N_("connecting rod DE")),
    "rod_ratio": ("number", N_("ratio DE/CD")),
    "pressure": ("angle", N_("largest pressure angle on the ram")),
}
STEEP_MARGIN: Final = np.radians(1)
LOWERED: Final = N_(
    "with so large a pressure angle the ram would reverse before the lever: the rod was taken longer, and the pressure "
    "angle is smaller than the limit in the file"
)
FRAME_KEYS: Final = ("OC", "frame_ratio", "OA")
ROD_KEYS: Final = ("DE", "rod_ratio", "pressure")


@dataclass(frozen=True)
class ShaperTask:
    """Given quantities of a crank shaper; None if not given.

    Attributes:
        stroke: stroke of the ram (m).
        k: time ratio.
        OC, frame_ratio, OA: frame OC (m), or the ratio OC/CD, or the crank OA (m).
        DE, rod_ratio, pressure: connecting rod DE (m), or the ratio DE/CD, or the largest pressure angle on the ram
            (rad).
    """

    stroke: Any
    k: Any
    OC: Any = None
    frame_ratio: Any = None
    OA: Any = None
    DE: Any = None
    rod_ratio: Any = None
    pressure: Any = None


@dataclass(frozen=True)
class ShaperSolution:
    """Dimensions of a crank shaper.

    Attributes:
        crank, frame, lever, rod: lengths of OA, OC, CD and DE (m).
        level: height of the ram's guide above O (m).
        theta: swing angle of the lever (rad).
        pressure: largest pressure angle on the ram (rad).
    """

    crank: Any
    frame: Any
    lever: Any
    rod: Any
    level: Any
    theta: Any
    pressure: Any


def find_shaper(task: ShaperTask) -> ShaperSolution:
    """Find the dimensions of a crank shaper.

    The numbers returned are meaningless if no such mechanism exists; `refuse` checks this.
    """
    theta = theta_of(task.k)
    sine, half_height = np.sin(theta / 2), np.sin(theta / 4) ** 2
    lever = np.asarray(task.stroke) / (2 * sine)
    if task.OA is not None:
        frame = np.asarray(task.OA) / sine
    else:
        frame = lever * task.frame_ratio if task.OC is None else np.asarray(task.OC)
    rise = lever * half_height
    if task.pressure is not None:
        rod = rise / np.sin(np.minimum(task.pressure, steepest_rod(theta)))
    else:
        rod = lever * task.rod_ratio if task.DE is None else np.asarray(task.DE)
    level = lever * (1 - half_height) - frame
    return ShaperSolution(frame * sine, frame, lever, rod, level, theta, np.arcsin(np.minimum(rise / rod, 1)))


def steepest_rod(theta: Any) -> Any:
    """Return the largest pressure angle (rad) up to which the rod is shortened: beyond it the ram reverses before the
    lever, half its swing angle theta (rad) from the middle.
    """
    return (np.pi - theta) / 2 - STEEP_MARGIN


def refuse(task: ShaperTask) -> None:
    """Raise Infeasible, with the reason, if no crank shaper satisfies the task."""
    if not task.k > 1:
        raise Infeasible("k", QUICK_RETURN)
    half = float(theta_of(task.k)) / 2
    if not np.pi - 2 * half > DEAD_SWING:
        raise Infeasible("k", HALF_A_TURN)
    f = find_shaper(task)
    if not f.frame < f.lever / (1 + np.sin(half)):
        raise Infeasible(
            _find_given_key(task, FRAME_KEYS),
            _("the sliding block would pass beyond the hinge D of the connecting rod"),
        )
    if task.pressure is not None and not 0 < task.pressure < np.pi / 2:
        raise Infeasible("pressure", _("the largest pressure angle must be less than 90 deg"))
    if not f.pressure < np.pi / 2 - half:  # where the lever reverses, half its swing from the middle
        reason = _("the ram would reverse before the lever: the connecting rod is too steep")
        raise Infeasible(_find_given_key(task, ROD_KEYS), reason)


def _find_given_key(task: ShaperTask, keys: tuple[str, ...]) -> str:
    return next(key for key in keys if getattr(task, key) is not None)


def solve(task: ShaperTask) -> SynthesisOutcome:
    """Find the crank shaper and draw its construction. Raises Infeasible."""
    refuse(task)
    f = find_shaper(task)
    kind, text = QUANTITIES["pressure"]
    lowered = task.pressure is not None and float(f.pressure) < task.pressure * (1 - 1e-9)
    rows = (
        NamedValue("OA", f.crank, "length", N_("crank OA")),
        NamedValue("OC", f.frame, "length", N_("frame OC (C below O)")),
        NamedValue("CD", f.lever, "length", N_("slotted lever CD")),
        NamedValue("DE", f.rod, "length", N_("connecting rod DE")),
        NamedValue("y", f.level, "length", N_("height y of the ram's guide above O")),
        NamedValue("", f.theta, "angle", N_("angle theta = D1CD2")),
        *((NamedValue("", f.pressure, kind, text),) if task.pressure is None or lowered else ()),
        NamedValue(
            "", f.lever / (1 + np.sin(f.theta / 2)), "length", N_("longest OC for which the sliding block stays on CD")
        ),
    )
    asked = task.pressure is not None and not lowered
    demands = (
        Demand(N_("crank rotates fully (1: yes)"), 1.0, "number", driver_completes_range, asked=False),
        Demand(N_("stroke H of the ram"), float(task.stroke), "length", output_stroke),
        Demand(N_("k (time ratio)"), float(task.k), "number", time_ratio),
        Demand(
            text,
            float(f.pressure),
            kind,
            largest_pressure_angle,
            asked,
            of="pressure",
        ),
    )
    source = N_(
        "D has the same height in both extreme positions of the lever: CD = H/(2 sin(theta/2)), theta = pi "
        "(k - 1)/(k + 1), OA = OC sin(theta/2); the guide is at half the height of D's arc"
    )
    return SynthesisOutcome(
        given_values(task, QUANTITIES),
        rows,
        source,
        demands,
        (draw_construction(f),),
        (LOWERED,) if lowered else (),
        output="slide",
        quality=SolutionQuality(float(f.pressure), slides=True, limited=task.pressure is not None),
    )


# Keys of the task.


class ShaperBlock(TaskBlock):
    """Keys of the task `shaper`: stroke, k, the frame OC (or its ratio, or the crank), the rod DE (or its ratio, or a
    limit of the pressure angle).
    """

    task: Literal["shaper"]
    stroke: FileValue = Field(description="stroke H of the ram")
    k: FileValue = Field(
        description="time ratio (coefficient of change of mean speed) k = (180° + θ)/(180° - θ), more than 1"
    )
    OC: FileValue | None = Field(default=None, description="distance OC between the fixed hinges")
    frame_ratio: FileValue | None = Field(default=None, description="ratio OC/CD, instead of OC")
    OA: FileValue | None = Field(default=None, description="crank OA, instead of OC")
    DE: FileValue | None = Field(default=None, description="connecting rod DE")
    rod_ratio: FileValue | None = Field(default=None, description="ratio DE/CD, instead of DE")
    pressure: FileValue | None = Field(
        default=None,
        description=(
            "largest admissible pressure angle on the ram, instead of DE; the shortest rod that satisfies it, and with "
            "which the ram reverses with the lever, is found"
        ),
    )


BLOCK = ShaperBlock


def read(block: ShaperBlock, values: ValueReader) -> ShaperTask:
    """Convert the keys of the task to quantities in SI and radians. Raises ProblemError."""
    for ways in (FRAME_KEYS, ROD_KEYS):
        choose_key_set(block, [(key,) for key in ways])
    return ShaperTask(**read_numbers(block, values, QUANTITIES))
