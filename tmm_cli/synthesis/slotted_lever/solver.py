"""Slotted lever by k and the extreme positions of its end B: the crank's pin touches both from O on their bisector.

In an extreme position OA is square to CB, so that the lever swings by theta = pi (k - 1)/(k + 1) = B1CB2, and
    CB = B1B2/(2 sin(theta/2)),  OA = OC sin(theta/2);
the stone moves between OC - OA and OC + OA from C. OC is free. The force on the stone is the lever's moment over its
distance from C, so the longest OC that leaves the stone on CB gives the least force: OC (1 + sin(theta/2)) = CB.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_, _
from tmm_cli.synthesis.mean_ratio import k_of, theta_of
from tmm_cli.synthesis.measures import crank_turns, end_angle, ratio, stroke
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Value, given
from tmm_cli.synthesis.slotted_lever.drawing import construction, family
from tmm_cli.tolerances import DEAD_SWING
from tmm_cli.vectors import settled, unit

PARAMETERS: Final = {**dict.fromkeys(("OA", "OC", "CB", "xO", "yO", "xC", "yC"), "length"), "phi": "angle"}
QUANTITIES: Final = {  # that a task may give: kind and what they are called
    "CB": ("length", N_("lever CB")), "k": ("number", N_("k")), "swing": ("angle", N_("swing of the lever")),
    "OC": ("length", N_("frame OC")), "OA": ("length", N_("crank OA")),
}  # fmt: skip
QUICK_RETURN: Final = N_(
    "a lever that swings goes back faster: k is the time of the slow stroke over that of the quick one"
)
HALF_A_TURN: Final = N_("the lever of a crank that turns fully swings by less than 180 deg")


@dataclass(frozen=True)
class Task:
    """Places b1, b2 (m) of the lever's end, or its length (m) with the place of C and the direction (rad) from C to O.

    k or the swing (rad). side: of the way from b1 to b2 on which C lies, 1 left, -1 right; with the length 1 turns the
    lever clockwise from b1 to b2. OC (m), or the crank OA (m), or bounds of OC and which is chosen: force (the longest
    with the stone on CB) or shortest.
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


def find(task: Task) -> Found:
    """The lengths and places. Where there is no such mechanism (`refuse` says why) they mean nothing."""
    theta = task.theta
    sine = np.sin(theta / 2)
    if task.CB is None:
        way = np.asarray(task.b2) - task.b1
        lever = np.abs(way) / 2 / sine
        c = (np.asarray(task.b1) + task.b2) / 2 + task.side * 1j * way / 2 / np.tan(theta / 2)
        along = -task.side * 1j * way / np.abs(way)
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
    size = lever + frame + np.abs(c)
    along, c = settled(along, 1.0), settled(c, size)
    return Found(frame * sine, frame, lever, settled(c + frame * along, size), c, psi1, psi2, theta, longest)


def refuse(task: Task) -> None:
    """Raises Infeasible with the reason."""
    if task.k is not None and not task.k > 1:
        raise Infeasible("k", QUICK_RETURN)
    if task.swing is not None and not task.swing > 0:
        raise Infeasible("swing", _("a lever that does not swing has no strokes"))
    if not np.pi - task.theta > DEAD_SWING:
        raise Infeasible("k" if task.swing is None else "swing", HALF_A_TURN)
    if task.CB is None and abs(task.b2 - task.b1) == 0:
        raise Infeasible("B2", _("B1 and B2 are the same place"), search=False)
    if task.within is not None and not 0 < task.within[0] <= task.within[1]:
        raise Infeasible("within", _("these are no bounds of a distance, the smaller one first"))
    if task.within is not None and task.within[0] > find(task).longest:
        raise Infeasible(("within", 0), _("within these bounds the stone always passes B"))


def solve(task: Task) -> Outcome:
    """The task of one file. Raises Infeasible."""
    refuse(task)
    f = find(task)
    demands = (
        Demand(N_("crank turns fully (1: yes)"), 1.0, "number", crank_turns, asked=False),
        Demand(N_("k"), float(k_of(f.theta)), "number", ratio, task.k is not None),
        Demand(N_("swing of the lever"), float(f.theta), "angle", stroke, task.swing is not None),
        *(Demand(text, float(v), "angle", partial(end_angle, near=float(v)), at=1.0)
          for text, v in ((N_("angle of CB1"), f.psi1), (N_("angle of CB2"), f.psi2))),
    )  # fmt: skip
    notes = (N_("the stone passes B: the slot goes on beyond it"),) if f.frame > f.longest * (1 + 1e-12) else ()
    free = family(task, f) if task.within is not None and task.within[0] < task.within[1] else None
    drawings, listings = ((construction(f), free[0]), (free[1],)) if free else ((construction(f),), ())
    source = N_("OA is square to the lever in its extreme positions: B1CB2 = theta = pi (k - 1)/(k + 1), CB1 = CB2, O "
               "on the bisector, OA = OC sin(theta/2)")  # fmt: skip
    return Outcome(_given(task), _found(task, f), source, demands, drawings, notes, listings, output="swing")


def _given(task: Task) -> tuple[Value, ...]:
    values: list[Value] = []
    if task.CB is None:
        for x, y, place in ((N_("B1, x"), N_("B1, y"), task.b1), (N_("B2, x"), N_("B2, y"), task.b2)):
            values += [Value("", np.real(place), "length", x), Value("", np.imag(place), "length", y)]
    values += given(task, QUANTITIES)
    if task.within is not None:
        force = N_("least force: the longest that leaves the stone on CB")
        values += [
            Value("", task.within[0], "length", N_("frame OC, at least")),
            Value("", task.within[1], "length", N_("frame OC, at most")),
            Value("", force if task.choose == "force" else N_("the shortest"), "word", N_("choice of OC")),
        ]
    return tuple(values)


def _found(task: Task, f: Found) -> tuple[Value, ...]:
    away = f.o - f.c
    return (
        Value("OA", f.crank, *QUANTITIES["OA"]),
        Value("OC", f.frame, *QUANTITIES["OC"]),
        Value("CB", f.lever, *QUANTITIES["CB"]),
        Value("xO", np.real(f.o), "length", N_("hinge O of the crank, x")),
        Value("yO", np.imag(f.o), "length", N_("hinge O of the crank, y")),
        Value("xC", np.real(f.c), "length", N_("hinge C of the lever, x")),
        Value("yC", np.imag(f.c), "length", N_("hinge C of the lever, y")),
        Value("phi", np.arctan2(np.imag(away), np.real(away)), "angle",
              N_("direction from C to O, of crank and lever when they are in line")),
        Value("", f.theta, "angle", N_("theta = B1CB2")),
        Value("", f.frame - f.crank, "length", N_("stone from C, at least")),
        Value("", f.frame + f.crank, "length", N_("stone from C, at most")),
        Value("", f.longest, "length", N_("longest OC that leaves the stone on CB")),
        # in the slow stroke the crank turns as the lever does
        Value("", N_("counterclockwise") if task.side > 0 else N_("clockwise"), "word",
              N_("crank for a slow stroke from B1 to B2")),
    )  # fmt: skip
