"""Random class II linkages that are assembled to begin with: poses first, then lengths that fit them."""

from __future__ import annotations

import cmath
import math

import numpy as np

from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Linkage, Load, Sketch, Slide

TYPES = ("RRR", "RRP", "RPR", "PRP", "RPP")


class Maker:
    """Puts links at random poses and joins them where they are."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.poses: dict[str, tuple[complex, complex]] = {FRAME: (0j, 1 + 0j)}
        self.points: dict[str, dict[str, complex]] = {FRAME: {}}
        self.hinges: dict[str, list[str]] = {}
        self.slides: list[Slide] = []

    def place(self) -> complex:
        return complex(*self.random.uniform(-1, 1, 2))

    def angle(self) -> float:
        return float(self.random.uniform(-math.pi, math.pi))

    def link(self, name: str) -> None:
        self.poses[name] = (self.place(), cmath.exp(1j * self.angle()))
        self.points[name] = {}

    def local(self, link: str, where: complex) -> complex:
        origin, z = self.poses[link]
        return (where - origin) / z

    def hinge(self, name: str, *links: str, where: complex | None = None) -> None:
        where = self.place() if where is None else where
        for link in links:
            self.points[link][name] = self.local(link, where)
        self.hinges.setdefault(name, []).extend(links)

    def slide(self, name: str, one: str, other: str) -> None:
        """Either link carries the guide; the guide is offset and inclined as it falls."""
        carrier, runner = (one, other) if self.random.random() < 0.5 else (other, one)
        where, along = self.place(), self.angle()
        through = where + self.random.uniform(-1, 1) * cmath.exp(1j * along)
        zc, zr = self.poses[carrier][1], self.poses[runner][1]
        self.points[runner][f"Z{name}"] = self.local(runner, where)
        self.slides.append(
            Slide(
                name, carrier, runner, self.local(carrier, through), along - cmath.phase(zc), self.local(runner, where),
                cmath.phase(zr / zc), f"Z{name}",
            )
        )  # fmt: skip

    def group(self, kind: str, number: int) -> None:
        a, b = f"{2 * number}", f"{2 * number + 1}"
        known = list(self.poses)
        for name in (a, b):
            self.link(name)
        ends = self.random.choice(len(known), 2, replace=False)
        outer = [known[k] for k in ends]
        for pair, (own, other), name in zip(
            kind, ((a, outer[0]), (a, b), (b, outer[1])), (f"P{number}", f"Q{number}", f"R{number}"), strict=True
        ):
            shared = [h for h, links in self.hinges.items() if other in links and not {a, b} & set(links)]
            if pair == "R" and other in outer and shared and self.random.random() < 0.3:
                compound = shared[0]
                origin, z = self.poses[other]
                self.hinge(compound, own, where=origin + z * self.points[other][compound])
            elif pair == "R":
                self.hinge(name, other, own)
            else:
                self.slide(name.lower(), other, own)
        # a point that is watched, so that the sketch can tell both assemblies apart
        for name in (a, b):
            self.points[name][f"W{name}"] = complex(*self.random.uniform(-1, 1, 2))


def linkage(seed: int, kinds: tuple[str, ...]) -> Linkage:
    """A crank with the given groups one after another on links chosen at random, with masses and loads."""
    maker = Maker(seed)
    maker.link("1")
    maker.hinge("O", FRAME, "1")
    maker.points["1"]["A"] = maker.place()
    for number, kind in enumerate(kinds, 1):
        maker.group(kind, number)
    random = maker.random
    links = {
        name: Link(
            name, points, *(random.uniform(0.1, 2, 2) if name != FRAME else (0, 0)), complex(*random.uniform(-1, 1, 2))
        )
        for name, points in maker.points.items()
    }  # fmt: skip
    sketch = Sketch(
        cmath.phase(maker.poses["1"][1]),
        {p: o + q * z for n, (o, z) in maker.poses.items() if n != FRAME for p, q in maker.points[n].items()
         if p not in maker.points[FRAME]},
        {n: cmath.phase(z) for n, (_, z) in maker.poses.items() if n != FRAME},
    )  # fmt: skip
    last = str(2 * len(kinds) + 1)
    loads = (
        Load("F", last, complex(*random.uniform(-1, 1, 2)), complex(*random.uniform(-50, 50, 2))),
        Load("M", "2", moment=float(random.uniform(-20, 20))),
        Load("T", "1", complex(*random.uniform(-1, 1, 2)), complex(*random.uniform(-50, 50, 2)), follows=True),
    )
    driver = Driver("1", "turn", "O", float(random.uniform(0.5, 10)), float(random.uniform(-2, 2)), 1)
    hinges = tuple(Hinge(name, tuple(joined)) for name, joined in maker.hinges.items())
    return Linkage(links, hinges, tuple(maker.slides), driver, sketch, loads)
