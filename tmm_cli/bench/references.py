"""Reference linkages with results to 50 digits, which are stored as package data.

tests/write_bench_references.py and tests/write_stability_references.py write the data.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from tmm_cli.bench.linkage_families import FAMILIES_BY_NAME, LinkageFamily, LinkageScene, Numbers
from tmm_cli.bench.methods.case import QUANTITIES, Case, Compared, MethodAnswers
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.numerics import Real
from tmm_cli.problem import Tree, build_problem, read_text
from tmm_cli.synthesis import solve

REFERENCE_NAMES = ("crank-slider", "crank-rocker", "shaper", "six-bar", "press-class-iii")


@dataclass(frozen=True)
class Reference:
    """A reference linkage with its exact results.

    Attributes:
        case: the linkage.
        q: driver coordinates, rad.
        exact: results at q as longdouble, rounded from 50 digits.
    """

    case: Case
    q: Real
    exact: MethodAnswers


def make_case(name: str, results: Results) -> Case:
    """Return the linkage of a problem as input of the compared methods.

    results: results of tmm, at least up to kinematics.
    """
    return Case(name, results.linkage, results.structure, results.kernels, results.start, results.strokes)


@cache
def _read_data(name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((files("tmm_cli.bench") / "data" / f"{name}.json").read_text(encoding="utf-8"))
    return content


def load_problem_tree(name: str) -> Tree:
    """Return the contents of the problem file of a reference linkage."""
    return read_text(_read_data(name)["problem"], f"{name}.yaml")


@cache
def load_reference(name: str) -> Reference:
    """Return the reference linkage of this name with its exact results."""
    content = _read_data(name)
    results = solve(build_problem(load_problem_tree(name)), "kinematics")
    x, v, a, forces = (
        {point: to_longdouble(values) for point, values in content[key].items()}
        for key in ("positions", "velocities", "accelerations", "reactions")
    )
    return Reference(
        make_case(name, results),
        np.array(content["q"]),
        MethodAnswers(x, v, a, forces, to_longdouble(content["balancing"])),
    )


def to_longdouble(written: Sequence[Any]) -> Any:
    """Convert decimal texts to longdouble; pairs of texts are the components of vectors and become complex numbers."""
    numbers = np.array(written, dtype=np.longdouble)
    return numbers if numbers.ndim == 1 else numbers[:, 0] + 1j * numbers[:, 1]


# Scenes of `tmm bench stability` with their answers to 50 digits.


KEYS: dict[Compared, str] = {
    "positions": "position",
    "velocities": "velocity",
    "accelerations": "acceleration",
    "reactions": "reaction",
    "balancing": "balancing",
}


@dataclass(frozen=True)
class KnownScene:
    """A linkage near a critical position with its exact results, longdouble.

    Attributes:
        family: family to which the linkage belongs.
        seed: number of the member of the family.
        distance: distance from the critical position.
        scene: the linkage and its driver coordinate.
        exact: exact values at the compared point and pair.
        largest: reference values of relative errors. Each is the exact value, or the exact value of the same family
            member far from the critical position, whichever is larger.
    """

    family: LinkageFamily
    seed: int
    distance: Decimal
    scene: LinkageScene
    exact: Mapping[Compared, Any]
    largest: Mapping[Compared, float]


@dataclass(frozen=True)
class FamilyMember:
    """A member of a linkage family.

    Attributes:
        numbers: numbers that define the linkage.
        scenes: exact results at each distance, as read from the data file.
    """

    numbers: Numbers
    scenes: tuple[Mapping[str, Any], ...]


@cache
def load_family_members(family: str) -> tuple[FamilyMember, ...]:
    """Read the members of a linkage family from its data file."""
    text = (files("tmm_cli.bench") / "data" / "stability" / f"{family}.json").read_text(encoding="utf-8")
    return tuple(
        FamilyMember({key: Decimal(value) for key, value in seed["numbers"].items()}, tuple(seed["scenes"]))
        for seed in json.loads(text)["seeds"]
    )


def load_known_scenes(family: str, chosen: int | None = None, stride: int = 1) -> Iterator[KnownScene]:
    """Yield linkages of a family at increasingly critical positions, with exact results.

    Args:
        family: Name of the family.
        chosen: Number of members, the first ones; None for all.
        stride: Step through the distances; the last distance is always included.
    """
    linkage_family = FAMILIES_BY_NAME[family]
    for number, seed in enumerate(load_family_members(family)[:chosen]):
        true = [{quantity: to_longdouble([scene[key]])[0] for quantity, key in KEYS.items()} for scene in seed.scenes]
        for k, scene in enumerate(seed.scenes):
            if k % stride and k != len(seed.scenes) - 1:
                continue
            of_all = [true[k], true[0]] if linkage_family.unit in ("rad", "share") else [true[k]]
            largest = {quantity: max(float(abs(values[quantity])) for values in of_all) for quantity in QUANTITIES}
            distance = Decimal(scene["distance"])
            yield KnownScene(
                linkage_family, number, distance, linkage_family.scene(seed.numbers, distance), true[k], largest
            )
