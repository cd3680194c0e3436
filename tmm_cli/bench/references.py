"""Linkages with answers in 50 digits, which ship with the package (tests/write_bench_references.py writes them)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from tmm_cli.bench.methods.case import QUANTITIES, Answers, Case, Compared
from tmm_cli.bench.scenes import BY_NAME, Family, Numbers, Scene
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.numerics import Real
from tmm_cli.problem import Tree, build_problem, read_text
from tmm_cli.synthesis import solve

REFERENCE_NAMES = ("crank-slider", "crank-rocker", "shaper", "six-bar", "press-class-iii")


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
    results = solve(build_problem(tree_of(name)), "kinematics")
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


# The scenes of `tmm bench stability` with their answers in 50 digits, which ship with the package.


KEYS: dict[Compared, str] = {
    "positions": "position",
    "velocities": "velocity",
    "accelerations": "acceleration",
    "reactions": "reaction",
    "balancing": "balancing",
}


@dataclass(frozen=True)
class Known:
    """A scene and what is true there, longdouble: of its watched point and pair.

    largest: what errors are counted in, the larger of the value here and in the harmless scene of the same numbers.
    """

    family: Family
    seed: int
    distance: Decimal
    scene: Scene
    exact: Mapping[Compared, Any]
    largest: Mapping[Compared, float]


@dataclass(frozen=True)
class Seed:
    """Numbers of a family's linkage, and the answers at every distance."""

    numbers: Numbers
    scenes: tuple[Mapping[str, Any], ...]


@cache
def seeds(family: str) -> tuple[Seed, ...]:
    """What the file of a family holds."""
    text = (files("tmm_cli.bench") / "data" / "stability" / f"{family}.json").read_text(encoding="utf-8")
    return tuple(
        Seed({key: Decimal(value) for key, value in seed["numbers"].items()}, tuple(seed["scenes"]))
        for seed in json.loads(text)["seeds"]
    )


def known_scenes(family: str, chosen: int | None = None, every: int = 1) -> Iterator[Known]:
    """All scenes of a family, or of its first so many seeds; every second distance and so on, the last one always."""
    of = BY_NAME[family]
    for number, seed in enumerate(seeds(family)[:chosen]):
        true = [{quantity: exact([scene[key]])[0] for quantity, key in KEYS.items()} for scene in seed.scenes]
        for k, scene in enumerate(seed.scenes):
            if k % every and k != len(seed.scenes) - 1:
                continue
            of_all = [true[k], true[0]] if of.unit in ("rad", "share") else [true[k]]
            largest = {quantity: max(float(abs(one[quantity])) for one in of_all) for quantity in QUANTITIES}
            distance = Decimal(scene["distance"])
            yield Known(of, number, distance, of.scene(seed.numbers, distance), true[k], largest)
