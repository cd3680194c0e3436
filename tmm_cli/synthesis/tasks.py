"""Register of the synthesis tasks. A task is a module, or a package if one module would be too long. It has two parts:

    keys       `BLOCK`, the pydantic model of the keys; `read(block, values) -> Task`, which raises ProblemError;
               `parameters(block)`, if the names of the parameters that the task determines depend on the keys
    solution   `Task`, a frozen record in SI and radians; `PARAMETERS`, the kind of each parameter that the task
               determines; `refuse(task)`, which raises Infeasible with the reason; `solve(task) -> SynthesisOutcome`,
               which raises Infeasible as well

Only the keys depend on pydantic and on units. All tasks share record.py (outcome of a task), reading.py (the block in a
file, error messages with the nearest feasible value), measures.py (quantities measured on the mechanism, time ratio k)
and construction.py (records of drawings). To add a task, write a module or package and add a line here.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

TASKS: Final[Mapping[str, tuple[str, str]]] = {  # name in problem files: modules of its keys and of its solution
    "crank-slider": ("crank_slider", "crank_slider"),
    "grashof": ("grashof", "grashof"),
    "four-bar-by-angles": ("four_bar_by_angles.block", "four_bar_by_angles.solver"),
    "coupler-positions": ("coupler_positions.task", "coupler_positions.task"),
    "four-bar-by-k": ("four_bar_by_k.task", "four_bar_by_k.task"),
    "slotted-lever": ("slotted_lever", "slotted_lever"),
    "shaper": ("shaper", "shaper"),
    "optimal": ("optimal.block", "optimal.solver"),
}


def block_module(task: str) -> Any:
    """Import and return the module with the keys of a task; modules of other tasks are not imported."""
    return import_module(f"tmm_cli.synthesis.{TASKS[task][0]}")


def solver_module(task: str) -> Any:
    """Import and return the module with the solution of a task; modules of other tasks are not imported."""
    return import_module(f"tmm_cli.synthesis.{TASKS[task][1]}")
