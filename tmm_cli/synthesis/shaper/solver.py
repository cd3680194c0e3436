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

from tmm_cli.language import N_, _
from tmm_cli.synthesis.mean_ratio import theta_of
from tmm_cli.synthesis.measures import crank_turns, pressure, ratio, stroke
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Value, given
from tmm_cli.synthesis.shaper.drawing import construction
from tmm_cli.synthesis.slotted_lever.solver import HALF_A_TURN, QUICK_RETURN
from tmm_cli.tolerances import DEAD_SWING

PARAMETERS: Final = dict.fromkeys(("OA", "OC", "CD", "DE", "y"), "length")
QUANTITIES: Final = {  # that a task may give: kind and what they are called
    "stroke": ("length", N_("stroke H of the ram")), "k": ("number", N_("k")), "OC": ("length", N_("frame OC")),
    "frame_ratio": ("number", N_("OC/CD")), "OA": ("length", N_("crank OA")), "DE": ("length", N_("rod DE")),
    "rod_ratio": ("number", N_("DE/CD")), "pressure": ("angle", N_("largest pressure angle of the ram")),
}  # fmt: skip
FRAMES: Final = ("OC", "frame_ratio", "OA")
RODS: Final = ("DE", "rod_ratio", "pressure")


@dataclass(frozen=True)
class Task:
    """Stroke, k; frame OC, its ratio to CD or the crank OA; rod DE, its ratio or the pressure angle (m, rad)."""

    stroke: Any
    k: Any
    OC: Any = None
    frame_ratio: Any = None
    OA: Any = None
    DE: Any = None
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
    if task.OA is not None:
        frame = np.asarray(task.OA) / sine
    else:
        frame = lever * task.frame_ratio if task.OC is None else np.asarray(task.OC)
    rise = lever * half_height
    if task.pressure is not None:
        rod = rise / np.sin(task.pressure)
    else:
        rod = lever * task.rod_ratio if task.DE is None else np.asarray(task.DE)
    level = lever * (1 - half_height) - frame
    return Found(frame * sine, frame, lever, rod, level, theta, np.arcsin(np.minimum(rise / rod, 1)))


def refuse(task: Task) -> None:
    """Raises Infeasible with the reason."""
    if not task.k > 1:
        raise Infeasible("k", QUICK_RETURN)
    half = float(theta_of(task.k)) / 2
    if not np.pi - 2 * half > DEAD_SWING:
        raise Infeasible("k", HALF_A_TURN)
    f = find(task)
    if not f.frame < f.lever / (1 + np.sin(half)):
        raise Infeasible(_given_of(task, FRAMES), _("the stone would pass the hinge D of the rod"))
    steepest = f.pressure if task.pressure is None else task.pressure
    if not steepest < np.pi / 2 - half:  # where the lever turns back, half its swing from the middle
        reason = _("the ram would turn back before the lever does: the rod is too steep")
        raise Infeasible(_given_of(task, RODS), reason)


def _given_of(task: Task, keys: tuple[str, ...]) -> str:
    return next(key for key in keys if getattr(task, key) is not None)


def solve(task: Task) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(task)
    f = find(task)
    kind, text = QUANTITIES["pressure"]
    found = (
        Value("OA", f.crank, "length", N_("crank OA")),
        Value("OC", f.frame, "length", N_("frame OC, C below O")),
        Value("CD", f.lever, "length", N_("slotted lever CD")),
        Value("DE", f.rod, "length", N_("rod DE")),
        Value("y", f.level, "length", N_("guide of the ram above O, y")),
        Value("", f.theta, "angle", N_("theta = D1CD2")),
        *((Value("", f.pressure, kind, text),) if task.pressure is None else ()),
        Value("", f.lever / (1 + np.sin(f.theta / 2)), "length", N_("longest OC that leaves the stone on CD")),
    )
    demands = (
        Demand(N_("crank turns fully (1: yes)"), 1.0, "number", crank_turns, asked=False),
        Demand(N_("stroke H of the ram"), float(task.stroke), "length", stroke),
        Demand(N_("k"), float(task.k), "number", ratio),
        Demand(text, float(f.pressure), kind, pressure, task.pressure is not None, of="pressure"),
    )
    source = N_("D is equally high in the lever's extreme positions: CD = H/(2 sin(theta/2)), theta = pi (k - 1)/"
               "(k + 1), OA = OC sin(theta/2); the guide midway in the height of D's arc")  # fmt: skip
    return Outcome(given(task, QUANTITIES), found, source, demands, (construction(f),), output="slide")
