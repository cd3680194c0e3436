"""Synthesis: one task, one room. A room is a package here with the name of its task:

    block.py   the task's keys in a problem file: `Shape`, and `read(shape, values) -> Task`, which raises ProblemError;
               `parameters(shape)`, where what may be found depends on what is asked
    solver.py  its numbers, SI and radians: the frozen record `Task`, PARAMETERS (kinds by name of what may be found),
               `refuse(task)`, which raises Infeasible with the reason, and `solve(task) -> Outcome`, which does so too

and further files where one would be too long. block.py is the edge: it alone knows pydantic and units. What rooms share
stands beside them: record.py (what a task gives), refusals.py (the nearest value that is feasible), measures.py (what
is measured on the mechanism), mean_ratio.py (k), construction.py (drawings as records). A new task is a new room, and a
line here.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

TASKS: Final[Mapping[str, str]] = {  # as problem files write them, and the room
    "crank-slider": "crank_slider",
    "grashof": "grashof",
    "four-bar-by-angles": "four_bar_by_angles",
    "coupler-positions": "coupler_positions",
    "four-bar-by-k": "four_bar_by_k",
    "slotted-lever": "slotted_lever",
    "shaper": "shaper",
    "optimal": "optimal",
}
PACKAGES: Final = {"coupler_positions", "four_bar_by_angles", "four_bar_by_k", "optimal"}  # the others are a module


def solver(task: str) -> Any:
    """The numbers of a task; only the room of the file's own task is imported."""
    return _module(task, "solver")


def block(task: str) -> Any:
    """The keys of a task; only the room of the file's own task is imported."""
    return _module(task, "block")


def _module(task: str, part: str) -> Any:
    """A part of a task: a module of its package, or its one module."""
    room = f"tmm_cli.synthesis.{TASKS[task]}"
    return import_module(f"{room}.{part}" if TASKS[task] in PACKAGES else room)
