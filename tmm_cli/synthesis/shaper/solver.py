"""Crank shaper (six-bar: crank, stone, slotted lever CD, rod DE, ram) from its stroke and k.

D is equally high in both extreme positions of the lever, so the ram's stroke is the chord of D's arc whatever DE is:
    CD = H/(2 sin(theta/2)),  OA = OC sin(theta/2),  theta = pi (k - 1)/(k + 1).
D's arc is CD (1 - cos(theta/2)) = 2 CD sin^2(theta/4) high. A guide at half of it has the least pressure angle:
    sin(lambda) = CD sin^2(theta/4)/DE.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.synthesis.mean_ratio import k_of, theta_of
from tmm_cli.synthesis.measures import crank_turns, pressure, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Value
from tmm_cli.synthesis.shaper.drawing import construction
from tmm_cli.synthesis.slotted_lever.solver import QUICK_RETURN, STRAIGHT

PARAMETERS: Final = dict.fromkeys(("OA", "OC", "CD", "DE", "y"), "length")
QUANTITIES: Final = {  # that a task may give: kind and what they are called
    "stroke": ("length", _("stroke H of the ram")), "k": ("number", _("k")), "frame": ("length", _("frame OC")),
    "frame_ratio": ("number", _("OC/CD")), "crank": ("length", _("crank OA")), "rod": ("length", _("rod DE")),
    "rod_ratio": ("number", _("DE/CD")), "pressure": ("angle", _("largest pressure angle of the ram")),
}  # fmt: skip
KEYS: Final = {  # in the block
    "frame": "OC", "frame_ratio": "frame_ratio", "crank": "OA", "rod": "DE", "rod_ratio": "rod_ratio",
}  # fmt: skip
NO_MOTION: Final = _("there is no such motion")


@dataclass(frozen=True)
class Task:
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


def find(task: Task) -> Found:
    """The lengths. Where there is no such mechanism (`refuse` says why) they mean nothing."""
    theta = theta_of(task.k)
    sine, half_height = np.sin(theta / 2), np.sin(theta / 4) ** 2
    lever = np.asarray(task.stroke) / (2 * sine)
    if task.crank is not None:
        frame = np.asarray(task.crank) / sine
    else:
        frame = lever * task.frame_ratio if task.frame is None else np.asarray(task.frame)
    rise = lever * half_height
    if task.pressure is not None:
        rod = rise / np.sin(task.pressure)
    else:
        rod = lever * task.rod_ratio if task.rod is None else np.asarray(task.rod)
    level = lever * (1 - half_height) - frame
    return Found(frame * sine, frame, lever, rod, level, theta, np.arcsin(np.minimum(rise / rod, 1)))


def refuse(task: Task) -> None:
    """Raises Infeasible with the reason and what could be met."""
    for name in ("frame", "frame_ratio", "crank"):
        value = getattr(task, name)
        if value is not None and not value > 0:
            raise Infeasible(KEYS[name], NO_MOTION, (SMALLEST, QUANTITIES[name][0], "least"))
    if not task.k > 1:
        raise Infeasible("k", QUICK_RETURN, (1.0, "number", "above"))
    half = float(theta_of(task.k)) / 2
    if not np.pi - 2 * half > STRAIGHT:
        raise Infeasible("k", _("the lever of a crank that turns fully swings by less than 180 deg"),
                         (float(k_of(np.pi - STRAIGHT)), "number", "below"))  # fmt: skip
    most = 1 / (1 + np.sin(half))  # OC/CD
    if not task.stroke > 0:
        frame = float(task.frame or 0.0) if task.crank is None else float(task.crank / np.sin(half))
        least = 2 * np.sin(half) * frame / most
        raise Infeasible("stroke", NO_MOTION,
                         (least, "length", "above") if least > SMALLEST else (SMALLEST, "length", "least"))  # fmt: skip
    f = find(task)
    lever = float(f.lever)
    longest = {"frame": lever * most, "frame_ratio": most, "crank": lever * most * np.sin(half)}
    if not f.frame < lever * most:
        name = next(name for name in longest if getattr(task, name) is not None)
        raise Infeasible(KEYS[name], _("the stone would pass the hinge D of the rod"),
                         (longest[name], QUANTITIES[name][0], "below"))  # fmt: skip
    _refuse_rod(task, half, lever)


def _refuse_rod(task: Task, half: float, lever: float) -> None:
    """A rod so steep where the lever turns back, half its swing from the middle, that the ram turns back before."""
    steep, steepest = _("the ram would turn back before the lever does: the rod is too steep there"), np.pi / 2 - half
    if task.pressure is not None:
        if not task.pressure > 0:
            raise Infeasible("pressure", _("a largest pressure angle is more than zero"), (SMALLEST, "angle", "least"))
        if not task.pressure < steepest:
            raise Infeasible("pressure", steep, (steepest, "angle", "below"))
        return
    share = float(np.sin(half / 2) ** 2 / np.cos(half))
    name, value, least = (
        ("rod", task.rod, lever * share) if task.rod is not None else ("rod_ratio", task.rod_ratio, share)
    )
    if not value > least:
        limit = (least, QUANTITIES[name][0], "above") if least > SMALLEST else (SMALLEST, QUANTITIES[name][0], "least")
        raise Infeasible(KEYS[name], steep if value > 0 else NO_MOTION, limit)


def solve(task: Task) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(task)
    f = find(task)
    given = tuple(
        Value(name, value, *QUANTITIES[name]) for name, value in vars(task).items() if value is not None
    )  # fmt: skip
    kind, text = QUANTITIES["pressure"]
    found = (
        Value("OA", f.crank, "length", _("crank OA")),
        Value("OC", f.frame, "length", _("frame OC, C below O")),
        Value("CD", f.lever, "length", _("slotted lever CD")),
        Value("DE", f.rod, "length", _("rod DE")),
        Value("y", f.level, "length", _("guide of the ram above O, y")),
        Value("", f.theta, "angle", _("theta = D1CD2")),
        *((Value("", f.pressure, kind, text),) if task.pressure is None else ()),
        Value("", f.lever / (1 + np.sin(f.theta / 2)), "length", _("longest OC that leaves the stone on CD")),
    )
    demands = (
        Demand(_("crank turns fully (1: yes)"), 1.0, "number", crank_turns, asked=False),
        Demand(_("stroke H of the ram"), float(task.stroke), "length", stroke),
        Demand(_("k"), float(task.k), "number", ratio),
        Demand(text, float(f.pressure), kind, pressure, task.pressure is not None, of="pressure"),
    )
    source = _("D is equally high in the lever's extreme positions: CD = H/(2 sin(theta/2)), theta = pi (k - 1)/"
               "(k + 1), OA = OC sin(theta/2); the guide midway in the height of D's arc")  # fmt: skip
    return Outcome(given, found, source, demands, (construction(f),))
