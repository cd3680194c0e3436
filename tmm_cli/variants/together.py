"""Variants of a linkage of any class solved together: the ordinary stages on arrays, an element for each variant and
place.

For what the tape cannot hold: groups that are found by iteration, toothed wheels, cams, friction, several drivers,
loads of working strokes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.batch import Asked, solved
from tmm_cli.family import Iterated
from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import Pose
from tmm_cli.groups.track import State
from tmm_cli.linkage import Linkage, Sketch
from tmm_cli.mechanism import Mechanism
from tmm_cli.mobile import mobile
from tmm_cli.motion import Law, move
from tmm_cli.stack import changed, numbers
from tmm_cli.strokes import Strokes, output_link
from tmm_cli.tape import DependsOnData
from tmm_cli.tape.varied import Varied
from tmm_cli.variants.sketch import sketch_of
from tmm_cli.variants.start import start_of
from tmm_cli.variants.strokes import Elements, find_strokes, spread
from tmm_cli.variants.walk import Step, Walked, kernels_of, walk
from tmm_cli.variants.way import Make, Places, Variant, Way
from tmm_cli.vectors import Real, Vector

Program = Callable[[Real, Places], Mapping[str, Real]]
OTHER, SAME = 1e-4, 1e-12  # relative: other numbers, and what leaves a number as it was
SINGLE = (".table", "acceleration")  # numbers that every variant has alike


@dataclass(frozen=True)
class Started:
    """In the place of a track: a state for each element from which Newton's method starts; gap: above 0 where lost."""

    state: State
    gap: Real

    def start(self, q: Real) -> tuple[State, Real]:
        return self.state, self.gap

    def in_dead(self, q: Real, rounding: float) -> Real:
        return np.zeros(np.shape(q), dtype=bool)

    def side(self, q: Real) -> Real:
        return np.ones(np.shape(q))


@dataclass(frozen=True)
class Followed:
    """In the place of a winding: about which angle each link of a group has, for each element."""

    about: Mapping[str, Real]

    def followed(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> tuple[Pose, ...]:
        found = []
        for link, pose in zip(links, poses, strict=True):
            angle = np.angle(pose.z)
            turns = np.round((self.about[link] - angle) / (2 * np.pi))
            found.append(replace(pose, turn=angle + 2 * np.pi * turns))
        return tuple(found)


class Together:
    """Called with numbers (variants, n) and places; gives what is asked, (variants, places), by name.

    All variants have the assembly that is led to from the first linkage's. Raises DependsOnData where a number that
    varies is none of those that arrays can stand for, Iterated where each variant must go through its whole range, and
    what assembly raises.
    """

    def __init__(
        self, make: Make, first: Sequence[float], asked: Asked, *, forces: bool = False, turns: int = 0,
        other: Sequence[float] = (),
    ) -> None:  # fmt: skip
        """turns: after which all of them come round again; 0: after as many as the first one.

        other: further numbers of those that have some values only, nan for all others.
        """
        self.other = np.array(other) if other else np.full(len(first), np.nan)
        self.make, self.first, self.asked, self.forces = make, np.array(first), asked, forces
        self.variant = make(first)
        self.ordinary = ordinary = self.variant.linkage
        self.structure = mobile(ordinary)
        self.kernels = assemble(ordinary, self.structure)
        alone = {path for path in self._varying() if any(part in path for part in SINGLE)}
        if not self.variant.ends and not turns:
            alone |= self._varying() & {f"linkage.{path}" for path in _of_cycle(ordinary)}
        if alone:
            raise DependsOnData(min(alone))
        self.turns = 1 if self.variant.ends else turns or Mechanism(ordinary, self.structure).way.turns
        at = np.array([ordinary.sketch.at])
        poses = move(ordinary, self.kernels, at, Law(float(at[0]), 1.0, 0.0, 1), 0).poses
        links = [n for kernel in self.kernels for n in kernel.group.links]
        self.home = Step(
            at[0], {n: poses[n].x[0] for n in links},
            {n: (np.angle(poses[n].z) if (turn := poses[n].turn) is None else turn)[0] for n in links},
        )  # fmt: skip
        wound = any(getattr(kernel, "winding", None) is not None for kernel in self.kernels)
        self.walks = wound or any(isinstance(kernel, Newton) for kernel in self.kernels)
        self.by_strokes = forces and any(
            x.working_stroke_only or (x.table is not None and x.table.against != "crank angle") for x in ordinary.loads
        )
        if self.walks and self.ordinary.others and self._varying_sketch():
            raise DependsOnData("linkage.sketch.at")
        if forces:
            start_of(self.variant, 0.0)
        if self.by_strokes and self.variant.ends and ordinary.driver.kind == "turn" and not ordinary.driver.stroke:
            raise Iterated  # whether it has strokes hangs on whether its crank turns fully

    def _varying(self) -> set[str]:
        """Paths of the numbers that vary; one that is written with what varies may be the same for all."""
        written = {path for path, x in numbers(self.make([Varied(x, x) for x in self.first])) if isinstance(x, Varied)}
        steps = OTHER * np.sqrt(np.arange(2.0, len(self.first) + 2)) * np.where(self.first, self.first, 1.0)
        steps = np.where(np.isnan(self.other), self.first + steps, self.other)
        before, after = (dict(numbers(self.make(x.tolist()))) for x in (self.first, steps))
        return {path for path in written if abs(before[path] - after[path]) > SAME * abs(before[path])}

    def _varying_sketch(self) -> bool:
        """Whether the place of the sketch varies."""
        return isinstance(self.make([Varied(x, x) for x in self.first]).linkage.sketch.at, Varied)

    def varied(self, columns: Real) -> Variant:
        """A variant of arrays (variants,), for numbers (variants, n)."""
        varied = self.make([Varied(x, c) for x, c in zip(self.first, columns.T, strict=True)])
        arrays = {path: number.stand for path, number in numbers(varied) if isinstance(number, Varied)}
        found: Variant = changed(varied, arrays)
        sketch = self.ordinary.sketch
        if self.ordinary.others:  # they pass through the places of the sketch together
            at: Any = found.linkage.sketch.at
            sketch = replace(sketch, at=at.stand if isinstance(at, Varied) else at)
        return replace(found, linkage=replace(found.linkage, sketch=sketch))

    def linkage(self, columns: Real) -> Linkage:
        """The same without its way."""
        return self.varied(columns).linkage

    def way(self, columns: Real) -> Way:
        """The drivers' ways."""
        return Way.of(self.varied(columns), len(columns), self.turns)

    def without(self, part: str) -> Self:
        """The same: what is not wanted costs little here."""
        return self

    def sketch(self, numbers: Real) -> Sketch:
        """How one variant looks at the place of the sketch."""
        one = numbers[None, :]
        walked = self._walked(one, self.way(one))
        linkage = self.make([float(number) for number in numbers]).linkage
        if self.walks:  # which is known at the place where they start from
            linkage = replace(linkage, sketch=self.ordinary.sketch)
        kernels = []
        for kernel in kernels_of(linkage, self.kernels):
            if walked is not None and isinstance(kernel, Newton):
                links, home = kernel.group.links, walked.home
                x, turn = (
                    np.stack([part[n][:, home] for n in links], axis=-1) for part in (walked.x, walked.turn)
                )  # fmt: skip
                kernel = replace(kernel, start=State(x, turn))
            kernels.append(kernel)
        return sketch_of(linkage, kernels)

    def about(self, numbers: Real) -> Program:
        """The same for variants near one, whose groups are not followed anew but start from where its own are."""
        one = numbers[None, :]
        walked = self._walked(one, self.way(one))
        return lambda columns, places: self._found(columns, places, walked and walked.repeated(len(columns)))

    def __call__(self, columns: Real, places: Places) -> dict[str, Real]:
        return self._found(columns, places, self._walked(columns, self.way(columns)))

    def _walked(self, columns: Real, way: Way) -> Walked | None:
        road = way.with_sketch(float(self.home.q))
        return walk(self.linkage, self.first, columns, self.kernels, self.home, road) if self.walks else None

    def _found(self, columns: Real, places: Places, walked: Walked | None) -> dict[str, Real]:
        varied, elements = self.varied(columns), self._elements(columns, walked)
        way, strokes, working = Way.of(varied, len(columns), self.turns), None, None
        begins = self.forces and varied.accelerated and varied.begins
        if (self.by_strokes or begins) and way.closed:
            link = output_link(self.ordinary, self.structure.groups)
            strokes = find_strokes(elements, way, self.ordinary, link)
            working = _first_of(strokes, len(columns))
        start = start_of(varied, working) if self.forces else None  # nothing else hangs on where its law begins
        if start is not None:
            lost = np.isnan(start)  # it has no working stroke, but how far it can go is known all the same
            way = Way.of(varied, len(columns), self.turns, np.where(lost, self.ordinary.sketch.at, start))
            start = np.repeat(np.broadcast_to(start, len(columns)), places.count)
        q = way.at(places)
        flat, kernels = elements(q)
        with np.errstate(all="ignore"):
            found = solved(
                flat, self.structure.again(flat), kernels, q.ravel(), self.asked, self.forces,
                spread(strokes if self.by_strokes else None, q.shape[1]), blank=False, start=start,
            )  # fmt: skip
        return {name: np.broadcast_to(value, q.size).reshape(q.shape) for name, value in found.items()}

    def _elements(self, columns: Real, walked: Walked | None) -> Elements:
        """The linkage and its groups with an element for each of some places q (variants, places).

        For another look at as many places the linkage is not made anew.
        """
        made: dict[int, tuple[Linkage, tuple[Kernel, ...]]] = {}

        def elements(q: Real) -> tuple[Linkage, tuple[Kernel, ...]]:
            if q.shape[1] not in made:
                flat = self.linkage(np.repeat(columns, q.shape[1], axis=0))
                made[q.shape[1]] = flat, kernels_of(flat, self.kernels)
            flat, kernels = made[q.shape[1]]
            return flat, kernels if walked is None else self._from(walked, kernels, q)

        return elements

    def _from(self, walked: Walked, kernels: tuple[Kernel, ...], q: Real) -> tuple[Kernel, ...]:
        """The groups, each starting from the nearest of the places where it was met on its way."""
        x, turn, lost = walked.near(q)
        share = np.mean(walked.lost, axis=1, keepdims=True)
        gap = np.where(lost, share, -1.0).ravel()

        def on(values: Mapping[str, Vector], links: Sequence[str]) -> Vector:
            found: Vector = np.stack([values[n].ravel() for n in links], axis=-1)
            return found

        found: list[Kernel] = []
        for kernel, own in zip(self.kernels, kernels, strict=True):
            links = own.group.links
            if isinstance(own, Newton):
                found.append(replace(own, track=Started(State(on(x, links), on(turn, links)), gap)))
            elif isinstance(own, Closed) and getattr(kernel, "winding", None) is not None:
                found.append(replace(own, winding=Followed({n: turn[n].ravel() for n in links})))
            else:
                found.append(own)
        return tuple(found)


def _first_of(strokes: Strokes | None, variants: int) -> Real:
    """Where the first stroke of each variant begins; nan where it has none."""
    if strokes is None:
        return np.full(variants, np.nan)
    first = strokes.strokes[0]
    return np.where(np.asarray(first.length) < 0, np.nan, first.start)


def _of_cycle(linkage: Linkage) -> set[str]:
    """Numbers on which it hangs after how many turns all comes round: ratios of toothed wheels, speeds of drivers."""
    ratios = {f"meshes[{k}].ratio" for k, mesh in enumerate(linkage.meshes) if mesh.kind == "gear"}
    speeds = {"driver.rate", *(f"others[{k}].rate" for k in range(len(linkage.others)))} if linkage.others else set()
    return ratios | speeds
