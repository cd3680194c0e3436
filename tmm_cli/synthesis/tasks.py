"""Register of the synthesis tasks. A task is one module, or a package where one module would be too long:

    keys       `BLOCK`, the pydantic model of its keys, and `read(block, values) -> Task`, which raises ProblemError;
               `parameters(block)`, where the parameters that it finds depend on the keys
    solution   in SI and radians: a frozen record of the task, `PARAMETERS` (kind of each parameter that it may find),
               `refuse(task)`, which raises Infeasible with the reason, and `solve(task) -> SynthesisOutcome`, which
               raises it too

Only the keys know pydantic and units. The tasks share record.py (outcome of a task), reading.py (the block in a file,
refusals with the nearest feasible value), measures.py (quantities measured on the mechanism, time ratio k) and
construction.py (drawings as records). A new task is a new module or package, and a line here.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

TASKS: Final[Mapping[str, tuple[str, str]]] = {  # name in problem files: modules of its keys and of its solution
    "crank-slider": ("crank_slider", "crank_slider"),
    "grashof": ("grashof", "grashof"),
    "four-bar-by-angles": ("four_bar_by_angles.angle_pairs", "four_bar_by_angles.solver"),
    "coupler-positions": ("coupler_positions.task", "coupler_positions.task"),
    "four-bar-by-k": ("four_bar_by_k.task", "four_bar_by_k.task"),
    "slotted-lever": ("slotted_lever", "slotted_lever"),
    "shaper": ("shaper", "shaper"),
    "optimal": ("optimal.block", "optimal.solver"),
}


def block_module(task: str) -> Any:
    """Import the module with the keys of a task, and none of the other tasks."""
    return import_module(f"tmm_cli.synthesis.{TASKS[task][0]}")


def solver_module(task: str) -> Any:
    """Import the module with the solution of a task, and none of the other tasks."""
    return import_module(f"tmm_cli.synthesis.{TASKS[task][1]}")
