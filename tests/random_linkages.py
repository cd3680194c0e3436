"""Random linkages that are assembled to begin with: poses first, then dimensions that fit them.

`linkage` makes class II from dyads alone; `any_linkage` makes all classes, with wheels, racks, cams, cylinders, several
drivers, springs, masses and loads.
"""

from __future__ import annotations

import cmath
import copy
import math

import numpy as np

from tmm_cli.mechanics.elements.dampers import Damper
from tmm_cli.mechanics.elements.springs import Spring
from tmm_cli.mechanics.groups import RISE_LAWS, CamLaw, CamLawPiece, NewtonSolver, Pose
from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Link, Linkage, Load, Mesh, Sketch, Slide
from tmm_cli.mechanics.numerics import singular_value_ratio
from tmm_cli.mechanics.structure import analyse_structure

TYPES = ("RRR", "RRP", "RPR", "PRP", "RPP")
HIGH = ("III", "IV", "VI")  # four, four and six links in one group
OTHERS = ("gear", "geared five-bar", "rack", "pinion", "cam", "swinging follower", "cylinder", "arm")
DRIVERS = ("crank", "cylinder", "swinging cylinder")
SOUND = 0.02  # least singular value over the largest of every group at the sketch


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
                name,
                carrier,
                runner,
                self.local(carrier, through),
                along - cmath.phase(zc),
                self.local(runner, where),
                cmath.phase(zr / zc),
                f"Z{name}",
            )
        )

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
    }
    sketch = Sketch(
        cmath.phase(maker.poses["1"][1]),
        {
            p: o + q * z
            for n, (o, z) in maker.poses.items()
            if n != FRAME
            for p, q in maker.points[n].items()
            if p not in maker.points[FRAME]
        },
        {n: cmath.phase(z) for n, (_, z) in maker.poses.items() if n != FRAME},
    )
    last = str(2 * len(kinds) + 1)
    loads = (
        Load("F", last, complex(*random.uniform(-1, 1, 2)), complex(*random.uniform(-50, 50, 2))),
        Load("M", "2", moment=float(random.uniform(-20, 20))),
        Load("T", "1", complex(*random.uniform(-1, 1, 2)), complex(*random.uniform(-50, 50, 2)), follows=True),
    )
    driver = Driver("1", "turn", "O", float(random.uniform(0.5, 10)), float(random.uniform(-2, 2)), 1)
    hinges = tuple(Hinge(name, tuple(joined)) for name, joined in maker.hinges.items())
    return Linkage(links, hinges, tuple(maker.slides), driver, sketch, loads)


class Anything(Maker):
    """Puts groups of every kind on links that are there already."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.drivers: list[Driver] = []
        self.meshes: list[Mesh] = []
        self.count = 0
        self.points[FRAME]["origin"] = 0j

    def new(self, links: int) -> list[str]:
        names = [str(self.count + k + 1) for k in range(links)]
        self.count += links
        for name in names:
            self.link(name)
        return names

    def turn(self, link: str) -> float:
        return cmath.phase(self.poses[link][1])

    def pair(self, kind: str, one: str, other: str) -> None:
        name = f"P{sum(map(len, self.points.values()))}"
        if kind == "R":
            self.hinge(name, one, other)
        else:
            self.slide(name.lower(), one, other)

    def run(self, slide: Slide) -> float:
        """Of the running point along its guide, in the sketch."""
        (carrier, z), (runner, turned) = self.poses[slide.carrier], self.poses[slide.runner]
        along = cmath.exp(1j * slide.direction) * z
        return ((runner + slide.at * turned - carrier - slide.through * z) / along).real

    def choose(self, items):
        return items[int(self.random.integers(len(items)))]

    def hinged(self) -> list[tuple[str, str, str]]:
        """(wheel, its carrier, their hinge), the wheel placed after its carrier or the other way round."""
        return [(a, b, name) for name, links in self.hinges.items() for a in links for b in links if a != b]

    def drive(self, link: str, base: str, kind: str, joint: str) -> None:
        random = self.random
        at = self.run(self.slides[-1]) if kind == "slide" else self.turn(link) - self.turn(base)
        self.drivers.append(
            Driver(
                link,
                kind,
                joint,
                float(random.uniform(0.5, 5)),
                float(random.uniform(-1, 1)),
                self.choose((1, -1)),
                base=base,
                at=at,
            )
        )

    def driver(self, kind: str) -> None:
        if kind == "crank":
            (link,) = self.new(1)
            self.hinge("O", FRAME, link)
            self.points[link]["A"] = self.place()
            self.drive(link, FRAME, "turn", "O")
        elif kind == "cylinder":
            (link,) = self.new(1)
            self.slide("z", FRAME, link)
            self.drive(link, FRAME, "slide", "z")
        else:
            self.cylinder()

    def cylinder(self) -> None:
        """Three links: the barrel and the rocker are hung up, the rod is driven out of the barrel."""
        known = list(self.poses)
        barrel, rod, rocker = self.new(3)
        self.pair("R", self.choose(known), barrel)
        self.pair("P", barrel, rod)
        self.drive(rod, barrel, "slide", self.slides[-1].name)
        self.pair("R", rod, rocker)
        self.pair("R", self.choose(known), rocker)

    def assur(self, links: int) -> None:
        """A group without wheels by its graph; pairs slide where that leaves every angle in one place only."""
        known = list(self.poses)
        names = self.new(links)
        if links == 4:
            a, b, c, d = names
            inner = [(a, b), (a, c), (a, d)] if self.grade == "III" else [(a, b), (b, c), (c, d), (d, a)]
            leads = [b, c, d] if self.grade == "III" else [a, c]
        else:
            a, b, c, d, e, f = names
            inner, leads = self.choose(
                (
                    ([(a, b), (a, c), (a, d), (b, e), (b, f)], [c, d, e, f]),
                    ([(a, b), (b, c), (c, a), (a, d), (b, e), (c, f)], [d, e, f]),
                    ([(a, b), (b, c), (c, d), (d, a), (a, e), (c, f)], [e, f, b]),
                    ([(a, b), (b, c), (c, d), (d, e), (e, a), (a, f), (c, f)], [e, d]),
                    ([(a, b), (b, c), (c, d), (d, e), (e, f), (f, a)], [a, c, e]),
                )
            )
        joined = {name: name for name in names} | dict.fromkeys(known, FRAME)
        for one, other in [*inner, *((lead, self.choose(known)) for lead in leads)]:
            kind = "P" if self.random.random() < 0.25 and joined[one] != joined[other] else "R"
            if kind == "P":
                keep, gone = sorted((joined[one], joined[other]), key=lambda n: n != FRAME)
                joined = {n: keep if at == gone else at for n, at in joined.items()}
            self.pair(kind, *((one, other) if self.random.random() < 0.5 else (other, one)))

    def ratio(self) -> float:
        return float(self.choose((-3, -2, -1.5, -1, -0.5, 2, 3, 0.5, 1 / 3)))

    def mesh(self, kind: str, i: str, j: str, carrier: str, ratio: float, **more) -> None:
        wheels = self.turn(i) - self.turn(carrier)
        other = self.run(more["on"]) if "on" in more else self.turn(j) - self.turn(carrier)
        self.meshes.append(
            Mesh(
                f"m{len(self.meshes)}",
                kind,
                i,
                j,
                carrier,
                ratio,
                other - ratio * wheels,
                more["on"].name if "on" in more else "",
                pressure=self.choose((0.0, math.radians(20))),
            )
        )

    def wheels(self, kind: str) -> None:
        known = list(self.poses)
        if kind in ("gear", "rack"):
            i, carrier, _ = self.choose(self.hinged())
        if kind == "gear":
            (j,) = self.new(1)
            self.pair("R", carrier, j)
            self.mesh("gear", i, j, carrier, self.ratio())
        elif kind == "rack":
            (j,) = self.new(1)
            self.pair("P", carrier, j)
            self.mesh("rack", i, j, carrier, self.choose((0.4, -0.7)), on=self.slides[-1])
        elif kind == "pinion":
            slide = self.choose(self.slides)
            carrier, j = self.choose(((slide.carrier, slide.runner), (slide.runner, slide.carrier)))
            (i,) = self.new(1)
            self.pair("R", carrier, i)
            self.mesh("rack", i, j, carrier, self.choose((0.8, -0.9)), on=slide)
        else:
            arm, planet, rod = self.new(3)
            sun = self.choose(known)
            self.pair("R", sun, arm)
            self.pair("R", arm, planet)
            self.mesh("gear", sun, planet, arm, self.ratio())
            self.pair("R", planet, rod)
            self.pair("R", rod, self.choose(known))

    def cam(self, kind: str) -> None:
        i = self.choose([w for w, carrier, _ in self.hinged() if carrier == FRAME])
        (j,) = self.new(1)
        over = self.random.uniform(0.5, 1.5, 4)
        rise = float(self.random.uniform(0.1, 0.5))
        shapes = [
            name for name in RISE_LAWS if name not in ("linear", "parabolic", "cosine")
        ]  # with a second derivative
        law = CamLaw(
            tuple(
                CamLawPiece(float(part), lift, self.choose(shapes))
                for part, lift in zip(over / over.sum() * 2 * math.pi, (rise, 0.0, -rise, 0.0), strict=True)
            ),
            self.angle(),
        )
        self.pair("P" if kind == "cam" else "R", FRAME, j)
        lift = float(law(np.array(self.turn(i)))[0])
        at = self.run(self.slides[-1]) if kind == "cam" else self.turn(j)
        slide = self.slides[-1].name if kind == "cam" else ""
        self.meshes.append(Mesh(f"m{len(self.meshes)}", "cam", i, j, FRAME, 0.0, at - lift, slide, law))

    def arm(self) -> None:
        """A link that is driven in its hinge on another one."""
        base = self.choose(list(self.poses))
        (link,) = self.new(1)
        self.pair("R", base, link)
        self.drive(link, base, "turn", list(self.hinges)[-1])

    def add(self, kind: str) -> None:
        if kind in TYPES:
            self.dyad(kind)
        elif kind in HIGH:
            self.grade = kind
            self.assur(6 if kind == "VI" else 4)
        elif kind in ("cam", "swinging follower"):
            self.cam(kind)
        elif kind == "cylinder":
            self.cylinder()
        elif kind == "arm":
            self.arm()
        else:
            self.wheels(kind)

    def dyad(self, kind: str) -> None:
        known = list(self.poses)
        a, b = self.new(2)
        ends = [known[k] for k in self.random.choice(len(known), 2, replace=False)]
        for pair, one, other in zip(kind, (a, a, b), (ends[0], b, ends[1]), strict=True):
            self.pair(pair, one, other)
        for name in (a, b):
            self.points[name][f"W{name}"] = self.place()

    def fits(self, kind: str) -> bool:
        """Whether there is something that a group of this kind can be put on."""
        if kind in ("gear", "rack"):
            return bool(self.hinges)
        if kind in ("cam", "swinging follower"):
            return any(carrier == FRAME for _, carrier, _ in self.hinged())
        return kind != "pinion" or bool(self.slides)

    def sound(self) -> bool:
        """Whether its groups are far from dead positions, by their equations at the sketch."""
        it = self.linkage()
        structure = analyse_structure(it)
        if not structure.sound:
            return False
        poses = {
            name: Pose(np.array([o]), np.array([z]), np.array([cmath.phase(z)])) for name, (o, z) in self.poses.items()
        }
        for group in structure.groups:
            kernel = NewtonSolver.of(group, it)
            if float(singular_value_ratio(kernel.matrix(poses))[0]) < SOUND / len(group.links):
                return False
        return True

    def linkage(self) -> Linkage:
        first, *others = self.drivers
        links = {name: Link(name, points) for name, points in self.points.items()}
        hinges = tuple(Hinge(name, tuple(joined)) for name, joined in self.hinges.items())
        sketch = Sketch(
            first.at,
            {
                p: o + q * z
                for n, (o, z) in self.poses.items()
                if n != FRAME
                for p, q in self.points[n].items()
                if p not in self.points[FRAME]
            },
            {n: cmath.phase(z) for n, (_, z) in self.poses.items() if n != FRAME},
        )
        return Linkage(
            links, hinges, tuple(self.slides), first, sketch, others=tuple(others), meshes=tuple(self.meshes)
        )


def any_linkage(seed: int, kinds: tuple[str, ...], driver: str = "crank") -> Linkage:
    """Groups of the given kinds one after another on links chosen at random; what cannot be put on is left out."""
    maker = Anything(seed)
    while True:
        first = copy.deepcopy(maker)
        first.driver(driver)
        if first.sound():
            break
        maker.random = first.random
    maker = first
    for kind in kinds:
        for _ in range(60):
            if not maker.fits(kind):
                break
            more = copy.deepcopy(maker)
            more.add(kind)
            if more.sound():
                maker = more
                break
            maker.random = more.random
    return loaded(maker.linkage(), maker.random)


def loaded(it: Linkage, random: np.random.Generator) -> Linkage:
    """With masses, loads, springs and dampers anywhere."""

    def place() -> complex:
        return complex(*random.uniform(-1, 1, 2))

    def some(count: int) -> list[str]:
        return [str(name) for name in random.choice(list(it.links), count, replace=False)]

    links = {
        name: Link(
            name, x.points, *((0, 0) if name == FRAME or random.random() < 0.2 else random.uniform(0.1, 2, 2)), place()
        )
        for name, x in it.links.items()
    }
    loads = tuple(
        Load(f"F{k}", str(random.choice(it.moving)), place(), 50 * place(), float(random.uniform(-20, 20)), k == 2)
        for k in range(3)
    )
    springs = (
        Spring("s1", *some(2), place(), place(), False, *(float(x) for x in random.uniform(0.5, 20, 4))),
        Spring("s2", *some(2), place(), place(), True, *(float(x) for x in random.uniform(0.5, 2, 4))),
    )
    dampers = (
        Damper("d1", *some(2), place(), place(), False, *(float(x) for x in random.uniform(0.5, 5, 2))),
        Damper("d2", *some(2), place(), place(), True, *(float(x) for x in random.uniform(0.5, 2, 2))),
    )
    return Linkage(
        links,
        it.hinges,
        it.slides,
        it.driver,
        it.sketch,
        loads,
        others=it.others,
        meshes=it.meshes,
        elements=(*springs, *dampers),
    )
