"""The mechanisms that are also written by hand, with what turns their linkages into the arguments of that code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.bench import handwritten
from tmm_cli.bench.references import reference
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import Linkage
from tmm_cli.variants.batch import Batch, everything, prepare
from tmm_cli.vectors import Real

Arguments = Callable[[Linkage], dict[str, Any]]


@dataclass(frozen=True)
class Mechanism:
    """A mechanism in both ways. code: by hand; longer: links that variants have longer."""

    name: str
    code: Callable[..., dict[str, Any]]
    arguments: Arguments
    longer: tuple[str, ...]

    def linkage(self) -> Linkage:
        """The reference of that name, its loads constant: the code by hand knows no tables and no strokes."""
        found = reference(self.name).case.linkage
        (load,) = found.loads
        force = load.force * (1 if load.table is None else load.table.values[0])
        return replace(found, loads=(replace(load, force=force, table=None, when="always"),))

    def variants(self, count: int, seed: int = 1) -> list[Linkage]:
        """Linkages whose moving links are up to 3 % longer; the first is the reference itself."""
        first, random = self.linkage(), np.random.default_rng(seed)
        found = [first]
        for _ in range(count - 1):
            links = dict(first.links)
            for name in self.longer:
                by, link = float(1 + 0.03 * random.random()), first.links[name]
                points = {point: place * by for point, place in link.points.items()}
                links[name] = replace(link, points=points, centre=link.centre * by)
            found.append(replace(first, links=links))
        return found

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What the code by hand gives."""
        first = self.linkage()
        return tuple(self.by_hand([first])(np.array([first.sketch.at])))

    def ours(self, linkages: Sequence[Linkage]) -> Batch:
        """The product, asked for what the code by hand gives."""

        def asked(motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
            found = everything(motion, reactions)
            return {name: found[name] for name in self.names}

        return prepare(linkages, asked)

    def by_hand(self, linkages: Sequence[Linkage]) -> Callable[[Real], dict[str, Any]]:
        """The code by hand with its arguments: numbers, or (variants, 1)."""
        each = [self.arguments(linkage) for linkage in linkages]
        first = each[0]
        arguments = {
            name: np.array([one[name] for one in each])[:, None]
            if np.ndim(first[name]) == 0 and any(one[name] != first[name] for one in each)
            else first[name]
            for name in first
        }
        return lambda q: self.code(q, **arguments)


def _masses(linkage: Linkage) -> dict[str, Any]:
    links = [linkage.links[name] for name in sorted(linkage.moving)]
    driver = linkage.driver
    return {
        "m": [link.mass for link in links], "J": [link.inertia for link in links], "w": driver.sense * driver.rate,
        "F": linkage.loads[0].force,
    }  # fmt: skip


def _length(linkage: Linkage, link: str, point: str) -> float:
    return abs(linkage.local(link, point))


def _crank_slider(linkage: Linkage) -> dict[str, Any]:
    all_of = _masses(linkage)
    (m1, m2, m3), rod = all_of["m"], linkage.links["2"]
    return {
        "r": _length(linkage, "1", "A"), "l": _length(linkage, "2", "B"), "s": 0.35, "m1": m1, "m2": m2,
        "J2": rod.inertia, "m3": m3, "w": all_of["w"], "F": all_of["F"],
    }  # fmt: skip


def _six_bar(linkage: Linkage) -> dict[str, Any]:
    return {
        "a": _length(linkage, "1", "A"), "b": _length(linkage, "2", "B"), "c": _length(linkage, "3", "B"),
        "d": linkage.local("0", "D").real, "e": _length(linkage, "4", "F"), "y": 0.2,
        "S2": complex(157.5, 30) / 350, **_masses(linkage),
    }  # fmt: skip


def _shaper(linkage: Linkage) -> dict[str, Any]:
    return {
        "a": _length(linkage, "1", "A"), "f": -linkage.local("0", "C").imag, "c": _length(linkage, "3", "D"),
        "e": _length(linkage, "4", "E"), "y": 0.27, "S5": linkage.links["5"].centre, "at": linkage.loads[0].at,
        **_masses(linkage),
    }  # fmt: skip


MECHANISMS = (
    Mechanism("crank-slider", handwritten.crank_slider, _crank_slider, ("1", "2")),
    Mechanism("six-bar", handwritten.six_bar, _six_bar, ("1", "2", "3", "4")),
    Mechanism("shaper", handwritten.shaper, _shaper, ("1", "3", "4")),
)
