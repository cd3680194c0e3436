"""Synthesis: one file a task. A new task is a file here, one in problem/synthesis, one in words, and a line below.

The file here (numbers only, SI and radians) has PARAMETERS, kinds by name of what it may find, and
`solve(asked) -> Outcome`, which raises Infeasible. The file in problem/synthesis has the shape of the task's keys and
makes the record `asked` from them. All three files have the same name; words/synthesis_<name>.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

TASKS: Final[Mapping[str, str]] = {  # as problem files write them, and the name of the task's files
    "crank-slider": "crank_slider",
    "grashof": "grashof",
    "four-bar-by-angles": "four_bar_by_angles",
    "coupler-positions": "coupler_positions",
    "four-bar-by-k": "four_bar_by_k",
    "slotted-lever": "slotted_lever",
    "shaper": "shaper",
    "optimal": "optimal",
}


def task(name: str) -> Any:
    """The module of a task; only that of the file's own task is imported."""
    return import_module(f"{__name__}.{TASKS[name]}")
