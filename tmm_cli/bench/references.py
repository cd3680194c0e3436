"""Linkages with answers in 50 digits, which ship with the package (tests/write_bench_references.py writes them)."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from tmm_cli import solve
from tmm_cli.analysis.pipeline import Results
from tmm_cli.bench.methods.case import Answers, Case
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text
from tmm_cli.vectors import Real, Vector

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
def reference(name: str) -> Reference:
    """A reference by its name."""
    content = json.loads((files("tmm_cli.bench") / "data" / f"{name}.json").read_text(encoding="utf-8"))
    results = solve(build(read_text(content["problem"], f"{name}.yaml")), "kinematics")
    x, v, a, forces = (_series(content[key]) for key in ("positions", "velocities", "accelerations", "reactions"))
    balancing = np.array([np.longdouble(value) for value in content["balancing"]])
    return Reference(case_of(name, results), np.array(content["q"]), Answers(x, v, a, forces, balancing))


def _series(content: dict[str, Any]) -> dict[str, Vector]:
    found = {}
    for name, pairs in content.items():
        real, imag = (np.array([np.longdouble(pair[k]) for pair in pairs]) for k in (0, 1))
        found[name] = real + 1j * imag
    return found
