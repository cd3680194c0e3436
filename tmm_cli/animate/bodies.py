"""What moves as one on the page: links, boxes of sliders, springs, with their marks in their own axes.

A body is drawn once; the page puts it where it is in each frame.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any

import numpy as np

from tmm_cli.draw.paper.drawing import Area, Circle, Line, Mark
from tmm_cli.draw.paper.sheet import DARK, Sheet
from tmm_cli.draw.symbols.actuators import SPRING, Cylinder, coils, cylinders, gas, torsion
from tmm_cli.draw.symbols.fixed import support, support_side, wall
from tmm_cli.draw.symbols.forms import Form, by_points
from tmm_cli.draw.symbols.parts import GAP, MEASURED, body, box, mass_centre
from tmm_cli.draw.symbols.rigid import rigid
from tmm_cli.draw.symbols.scene import BEYOND, ON_LINE, Scene
from tmm_cli.draw.symbols.wheel_symbols import CHAIN, DASHED
from tmm_cli.draw.symbols.wheel_symbols import draw as draw_higher
from tmm_cli.draw.symbols.wheels import CamShape, Disc
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME, Slide
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, unit


@dataclass
class Body:
    """Where it is (mm on the sheet), its angle (rad, followed through turns), how much longer it is than drawn: each
    in every frame; its marks in its own axes.
    """

    place: Vector
    angle: Real
    stretch: Real
    marks: list[Mark] = field(default_factory=list)

    def own(self, at: complex) -> complex:
        """A place on the sheet in the first frame, in the body's axes."""
        return complex((at - self.place[0]) * np.exp(-1j * self.angle[0]))

    def take(self, marks: list[Mark]) -> None:
        """Marks drawn at the first frame move with the body from now on."""
        self.marks += [_turned(mark, self.own) for mark in marks]

    def at(self, own: Any, k: int) -> Any:
        """A place of the body on the sheet, in a frame."""
        local = np.real(own) * self.stretch[k] + 1j * np.imag(own)
        return self.place[k] + local * np.exp(1j * self.angle[k])


def _turned(mark: Mark, own: Callable[[complex], complex]) -> Mark:
    match mark:
        case Line():
            return replace(mark, places=tuple(map(own, mark.places)))
        case Area():
            return replace(mark, corners=tuple(map(own, mark.corners)))
        case Circle():
            return replace(mark, centre=own(mark.centre))
    return replace(mark, at=own(mark.at))


@dataclass
class Picture:
    """A mechanism taken apart into bodies by their names; links have theirs, the frame is one too."""

    sheet: Sheet
    motion: Motion
    scene: Scene
    bodies: dict[str, Body]
    forms: dict[str, Form]

    @classmethod
    def of(cls, sheet: Sheet, motion: Motion, scene: Scene) -> Picture:
        """A scene in its first frame, drawn on a sheet."""
        picture = cls(sheet, motion, scene, {}, {})
        picture._add(FRAME, np.zeros_like(motion.q) * 0j, np.zeros_like(motion.q))
        for link in scene.linkage.moving:
            pose = motion.poses[link].spread(motion.q.shape)
            angle = pose.turned if pose.unwrapped is not None else np.unwrap(pose.turned)
            picture._add(link, sheet.origin + pose.x / sheet.mu, angle)
        picture.forms = {link: by_points(sheet, scene, link) for link in scene.linkage.moving}
        for pair in scene.structure.pairs:
            if not pair.lower:
                picture._higher(pair)
        for link, form in picture.forms.items():
            picture._link(link, form)
        for pair in scene.structure.pairs:
            if pair.slide is not None:
                picture._sliding(pair, pair.slide)
        picture._springs()
        picture._hinges([pair for pair in scene.structure.pairs if pair.kind == "R"])
        return picture

    def _add(self, name: str, place: Vector, angle: Real, stretch: Real | None = None) -> Body:
        self.bodies[name] = Body(place, angle, np.ones(len(place)) if stretch is None else stretch)
        return self.bodies[name]

    @contextmanager
    def _on(self, name: str) -> Iterator[None]:
        """What is drawn meanwhile belongs to a body."""
        before = len(self.sheet.marks)
        yield
        self.bodies[name].take(self.sheet.marks[before:])

    def _spots(self, link: str, local: complex) -> Vector:
        """Places of a point of a link on the sheet."""
        if link == FRAME:
            return np.full(self.motion.q.shape, self.sheet.on(complex(local)))
        return self.sheet.origin + self.motion.poses[link].spread(self.motion.q.shape).at(local) / self.sheet.mu

    def _link(self, link: str, form: Form) -> None:
        with self._on(link):
            body(self.sheet, form, DARK, MEASURED)
        for pair in self.scene.structure.pairs:
            if not pair.lower and link in (pair.i, pair.j):
                found = self.scene.higher(pair)
                with self._on(link):
                    rigid(self.sheet, found, form, link, DARK, MEASURED.hinge)
        own = self.scene.linkage.links[link]
        if np.any(own.mass != 0) and all(abs(own.centre - local) > 0 for local in own.points.values()):
            at = self.sheet.on(self.scene.place(link, complex(own.centre)))
            with self._on(link):
                mass_centre(self.sheet, at)

    def _higher(self, pair: Pair) -> None:
        """Wheels turn with their links, racks and cams go with theirs."""
        found = self.scene.higher(pair)
        parts = {found.mesh.i, found.mesh.j} if isinstance(found, CamShape) else set()
        if not isinstance(found, CamShape):
            for disc in found.discs:
                with self._on(disc.link):
                    self._wheel(disc)
            if found.side != 0:
                parts = {found.mesh.j}
        span = None
        if found.mesh.slide:
            slide = self.scene.linkage.slide(found.mesh.slide)
            (low, high), here = self.scene.way(slide), self.scene.run(slide)
            span = here - high, here - low
        for link in sorted(parts):
            before = len(self.sheet.marks)
            draw_higher(self.sheet, found, {link: DARK}, span)
            # the place where they touch comes last with the second link; it and the first one's disk move otherwise
            shown = self.sheet.marks[before:-1] if link == found.mesh.j else self.sheet.marks[before:]
            self.bodies[link].take([m for m in shown if not (isinstance(m, Line) and m.style == DASHED)])

    def _wheel(self, disc: Disc) -> None:
        ways = unit(np.linspace(0, 2 * np.pi, 97))
        rim = self.sheet.on(disc.centre) + disc.radius / self.sheet.mu * ways
        self.sheet.line(rim.tolist(), DARK, 0.9, CHAIN, 2.3)
        if disc.ring:
            outer = self.sheet.on(disc.centre) + (disc.radius / self.sheet.mu + 3) * ways
            self.sheet.line(outer.tolist(), DARK, 1.2, z=2.3)

    def _sliding(self, pair: Pair, slide: Slide) -> None:
        """A cylinder's barrel and rod; else a box, on the frame between rails as long as its way."""
        if pair.name in cylinders(self.scene.linkage):
            found = Cylinder.of(self.sheet, self.scene, slide)
            before = len(self.sheet.marks)
            found.draw(self.sheet, dict.fromkeys((pair.i, pair.j), DARK))
            barrel, *rod = self.sheet.marks[before:]
            self.bodies[slide.carrier].take([barrel])
            self.bodies[slide.runner].take(rod)
            return
        if slide.carrier == FRAME:
            self._rails(slide)
        at, along = self.sheet.on(self.scene.at(pair)), self.scene.along(slide)
        angle = self.bodies[slide.carrier].angle + float(np.angle(unit(slide.direction)))
        name = f"{pair.name}|box"
        self._add(name, self._spots(slide.runner, slide.at), angle)
        size = MEASURED.box if FRAME in (slide.carrier, slide.runner) else MEASURED.stone
        with self._on(name):
            box(self.sheet, at, along, DARK, size, MEASURED)
        if slide.runner == FRAME:
            for side in (1j * along, -1j * along):
                middle = at + side * size[1] / 2
                with self._on(name):
                    wall(self.sheet, middle, along, side, size[0] / 2, ())

    def _rails(self, slide: Slide) -> None:
        low, high = (run / self.sheet.mu for run in self.scene.way(slide))
        along = self.scene.along(slide)
        middle = self.sheet.on(complex(slide.through)) + along * (low + high) / 2
        reach = (high - low + MEASURED.box[0]) / 2 + BEYOND / 2
        for side in (1j * along, -1j * along):
            rail = middle + side * (MEASURED.box[1] / 2 + GAP)
            with self._on(FRAME):
                wall(self.sheet, rail, along, side, reach, ())

    def _springs(self) -> None:
        """A spring that is stretched is a body that is; a spiral turns with its second link."""
        for spring in self.scene.linkage.springs:
            if spring.turns:
                with self._on(spring.j):
                    torsion(self.sheet, self.scene, spring)
                continue
            start, end = self._spots(spring.i, spring.at_i), self._spots(spring.j, spring.at_j)
            way = end - start
            length = np.abs(way)
            if length.min() < 0.5:
                continue
            name = f"{spring.name}|spring"
            self._add(name, start, np.unwrap(np.angle(way)), length / length[0])
            with self._on(name):
                (coils if spring.rate > 0 else gas)(self.sheet, complex(start[0]), complex(end[0]))
            for link, at, out in ((spring.i, start[0], -way[0]), (spring.j, end[0], way[0])):
                with self._on(link):
                    self.sheet.circle(complex(at), 0.75, "white", SPRING, 1.0, 6.1)
                    if link == FRAME:
                        wall(self.sheet, complex(at), 1j * out / abs(out), out / abs(out), 2.6, ())

    def _hinges(self, pairs: list[Pair]) -> None:
        """A circle for each turning pair of a place, bars that go on beyond it, supports of those on the frame."""
        for __, same in groupby(sorted(pairs, key=lambda pair: pair.point), key=lambda pair: pair.point):
            here = list(same)
            at = self.sheet.on(self.scene.at(here[0]))
            links = list(dict.fromkeys(link for pair in here for link in (pair.i, pair.j)))
            carrier = FRAME if FRAME in links else links[0]
            for number in reversed(range(len(here))):
                radius, z = MEASURED.hinge + 0.7 * number, 6 - 0.01 * number
                with self._on(carrier):
                    self.sheet.circle(at, radius, width=1.2, z=z)
            for link in links:
                along = self.forms[link].through(at) if link in self.forms else None
                if along is not None:
                    ends = [at - MEASURED.hinge * along, at + MEASURED.hinge * along]
                    with self._on(link):
                        self.sheet.line(ends, DARK, 0.8 * MEASURED.bar, z=6.2)
            if FRAME in links:
                stones = [place for link in links if link in self.forms for place in self.forms[link].boxes]
                look = MEASURED.raised() if any(abs(at - place) < ON_LINE for place in stones) else MEASURED
                out = support_side(self.sheet, at, (), look)
                with self._on(FRAME):
                    support(self.sheet, at, out, look)

    def layers(self) -> Iterator[tuple[str, list[Mark]]]:
        """Marks of bodies from below to above."""
        every = [(mark.z, name, mark) for name, own in self.bodies.items() for mark in own.marks]
        every.sort(key=lambda one: one[0])
        for name, layer in groupby(every, key=lambda one: one[1]):
            yield name, [mark for *__, mark in layer]
