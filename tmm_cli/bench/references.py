"""Linkages with answers in 50 digits, which ship with the package (tests/write_bench_references.py writes them)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.bench.methods.case import Answers, Case
from tmm_cli.library import solve
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text
from tmm_cli.problem.tree import Tree
from tmm_cli.vectors import Real

NAMES = ("crank-slider", "crank-rocker", "shaper", "six-bar", "press-class-iii")


@dataclass(frozen=True)
class Reference:
    """A case, places q of its driver (rad) and what is true there (longdouble, as many digits as it has)."""

    case: Case
    q: Real
    exact: Answers


def case_of(name: str, results: Results) -> Case:
    """What methods are given of a problem that was solved to kinematics at least."""
    return Case(name, results.linkage, results.structure, results.kernels, results.start, results.strokes)


@cache
def _content(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((files("tmm_cli.bench") / "data" / f"{name}.json").read_text(encoding="utf-8"))
    return found


def tree_of(name: str) -> Tree:
    """The problem file of a reference, as it was read."""
    return read_text(_content(name)["problem"], f"{name}.yaml")


@cache
def reference(name: str) -> Reference:
    """A reference by its name."""
    content = _content(name)
    results = solve(build(tree_of(name)), "kinematics")
    x, v, a, forces = (
        {point: exact(values) for point, values in content[key].items()}
        for key in ("positions", "velocities", "accelerations", "reactions")
    )
    return Reference(
        case_of(name, results), np.array(content["q"]), Answers(x, v, a, forces, exact(content["balancing"]))
    )


def exact(written: Sequence[Any]) -> Any:
    """Numbers of 50 digits, or vectors of two of them, in longdouble."""
    found = np.array(written, dtype=np.longdouble)
    return found if found.ndim == 1 else found[:, 0] + 1j * found[:, 1]
