"""The scenes of `tmm bench stability` with their answers in 50 digits, which ship with the package."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any

from tmm_cli.bench.families import BY_NAME, Family, Numbers, Scene
from tmm_cli.bench.methods.case import QUANTITIES, Compared
from tmm_cli.bench.references import exact

KEYS: dict[Compared, str] = {
    "positions": "position", "velocities": "velocity", "accelerations": "acceleration", "reactions": "reaction",
    "balancing": "balancing",
}  # fmt: skip


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


def known(family: str, chosen: int | None = None, every: int = 1) -> Iterator[Known]:
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
