"""The same linkage drawn otherwise: mirrored, turned, moved, with other axes in its links, of another size, renamed, in
another order, run backward.

Each gives the linkage that a student would have written for the other drawing; what must come of it is in the tests.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np

from tmm_cli.mechanics.elements.dampers import Damper
from tmm_cli.mechanics.elements.springs import Spring
from tmm_cli.mechanics.groups import CamLaw, CamLawPiece
from tmm_cli.mechanics.linkage import FRAME, Hinge, Linkage, Mesh, Output


def mirrored(it: Linkage) -> Linkage:
    """Mirror image in the x axis."""

    def back(z):
        return z.conjugate()

    def mesh(m: Mesh) -> Mesh:
        if m.kind == "gear":
            return replace(m, offset=-m.offset)
        if m.kind == "rack":
            return replace(m, ratio=-m.ratio)
        # the follower goes through the pieces of the cam's law from the last to the first
        sense = -1 if m.slide else 1
        pieces = tuple(replace(piece, rise=sense * piece.rise) for piece in reversed(m.law.pieces))
        return replace(m, law=CamLaw(pieces, -m.law.start, -m.law.sense), offset=m.offset * (1 if m.slide else -1))

    def driver(d):
        return d if d.kind == "slide" else replace(d, sense=-d.sense, at=-d.at)

    def load(x):
        window = x.window and (-x.window[1], -x.window[0])
        if x.resists:  # sizes only
            return replace(x, at=back(x.at), window=window)
        return replace(x, at=back(x.at), force=back(x.force), moment=-x.moment, window=window)

    return replace(
        it,
        links={
            n: replace(x, points={p: back(z) for p, z in x.points.items()}, centre=back(x.centre))
            for n, x in it.links.items()
        },
        slides=tuple(
            replace(s, through=back(s.through), at=back(s.at), direction=-s.direction, turned=-s.turned)
            for s in it.slides
        ),
        driver=driver(it.driver),
        others=tuple(driver(d) for d in it.others),
        meshes=tuple(mesh(m) for m in it.meshes),
        sketch=replace(
            it.sketch,
            at=it.sketch.at * (1 if it.driver.kind == "slide" else -1),
            points={p: back(z) for p, z in it.sketch.points.items()},
            angles={n: -a for n, a in it.sketch.angles.items()},
        ),
        loads=tuple(load(x) for x in it.loads),
        elements=tuple(
            replace(
                s,
                at_i=back(s.at_i),
                at_j=back(s.at_j),
                **({"free": -s.free, "preload": -s.preload} if s.turns and isinstance(s, Spring) else {}),
            )
            for s in it.elements
        ),
        gravity=back(it.gravity),
    )


def turned(it: Linkage, by: float) -> Linkage:
    """The whole drawing turned about the frame's origin, gravity with it."""
    z = cmath.exp(1j * by)
    it = replace(it, driver=replace(it.driver, at=it.sketch.at))

    def slide(s):
        if s.carrier == FRAME:
            return replace(s, through=s.through * z, direction=s.direction + by, turned=s.turned + by)
        if s.runner == FRAME:
            return replace(s, at=s.at * z, turned=s.turned - by)
        return s

    def driver(d):
        return replace(d, at=d.at + by) if d.kind == "turn" and d.base == FRAME else d

    angles = {n: math.remainder(a + by, 2 * math.pi) for n, a in it.sketch.angles.items()}
    drivers = [driver(d) for d in it.drivers]
    at = drivers[0].at
    places = angles | {FRAME: 0.0}
    before = dict(it.sketch.angles) | {FRAME: 0.0}
    for old, new in zip(it.drivers, drivers, strict=True):
        if new.base == FRAME and new.kind == "turn":  # a driver's angle is as large as it is said to be
            places[new.link], before[new.link] = new.at, old.at

    def mesh(m: Mesh) -> Mesh:
        if m.kind == "cam":
            on_frame = {m.i: -by, m.carrier: by}.get(FRAME, 0.0)  # the law is of the angle of the cam from the carrier
            law = replace(m.law, start=m.law.start + on_frame)
            return replace(m, law=law, offset=m.offset if m.slide else m.offset + by)

        def row(at):
            wheels = at[m.i] - at[m.carrier]
            return (at[m.j] - at[m.carrier] if m.kind == "gear" else 0.0) - m.ratio * wheels

        return replace(m, offset=m.offset + row(places) - row(before))

    def spring(s):
        s = replace(s, at_i=s.at_i * (z if s.i == FRAME else 1), at_j=s.at_j * (z if s.j == FRAME else 1))
        return _twisted(s, by)

    return replace(
        it,
        links={
            n: x if n != FRAME else replace(x, points={p: q * z for p, q in x.points.items()})
            for n, x in it.links.items()
        },
        slides=tuple(slide(s) for s in it.slides),
        driver=drivers[0],
        others=tuple(drivers[1:]),
        meshes=tuple(mesh(m) for m in it.meshes),
        sketch=replace(it.sketch, at=at, points={p: q * z for p, q in it.sketch.points.items()}, angles=angles),
        loads=tuple(
            replace(
                x,
                force=x.force if x.follows or x.resists else x.force * z,
                window=x.window and (x.window[0] + by, x.window[1] + by),
            )
            for x in it.loads
        ),
        elements=tuple(spring(s) for s in it.elements),
        gravity=it.gravity * z,
    )


def _twisted(spring, by):
    """A torsion spring on the frame has its free angle from the frame's axes, which do not turn with the drawing."""
    if not spring.turns or not isinstance(spring, Spring):
        return spring
    return replace(spring, free=spring.free + by * ((spring.i == FRAME) - (spring.j == FRAME)))


def moved(it: Linkage, by: complex) -> Linkage:
    """The whole drawing beside its place (m)."""

    def slide(s):
        if s.carrier == FRAME:
            return replace(s, through=s.through + by)
        return replace(s, at=s.at + by) if s.runner == FRAME else s

    frame = it.links[FRAME]
    return replace(
        it,
        links={**it.links, FRAME: replace(frame, points={p: z + by for p, z in frame.points.items()})},
        slides=tuple(slide(s) for s in it.slides),
        sketch=replace(it.sketch, points={p: z + by for p, z in it.sketch.points.items()}),
        elements=tuple(
            replace(s, at_i=s.at_i + by * (s.i == FRAME), at_j=s.at_j + by * (s.j == FRAME)) for s in it.elements
        ),
    )


def with_other_axes(it: Linkage, seed: int, *, driver: bool = True) -> tuple[Linkage, dict[str, float]]:
    """Axes of every link turned about, and moved by, anything; and by which angles (rad) they were turned.

    driver: those of the first driver too, from which its place is counted.
    """
    random = np.random.default_rng(seed)
    turns = {n: 0.0 if n == FRAME else float(random.uniform(-3, 3)) for n in it.links}
    if not driver:
        turns[it.driver.link] = turns[it.driver.base] = 0.0
    offsets = {n: 0j if n == FRAME else complex(*random.uniform(-0.2, 0.2, 2)) for n in it.links}

    def own(link, place):
        return (place - offsets[link]) * cmath.exp(-1j * turns[link])

    def at_place(d):
        return replace(d, at=d.at + turns[d.link] - turns[d.base]) if d.kind == "turn" else d

    it = replace(it, driver=replace(it.driver, at=it.sketch.at))
    drivers = [at_place(d) for d in it.drivers]
    places = {n: math.remainder(a + turns[n], 2 * math.pi) for n, a in it.sketch.angles.items()} | {FRAME: 0.0}
    before = dict(it.sketch.angles) | {FRAME: 0.0}
    for old, new in zip(it.drivers, drivers, strict=True):
        if new.base == FRAME and new.kind == "turn":
            places[new.link], before[new.link] = new.at, old.at

    def mesh(m: Mesh) -> Mesh:
        if m.kind == "cam":
            law = replace(m.law, start=m.law.start + turns[m.i] - turns[m.carrier])
            return replace(m, law=law, offset=m.offset + (0.0 if m.slide else turns[m.j] - turns[m.carrier]))

        def row(at):
            return (at[m.j] - at[m.carrier] if m.kind == "gear" else 0.0) - m.ratio * (at[m.i] - at[m.carrier])

        return replace(m, offset=m.offset + row(places) - row(before))

    def load(x):
        force = x.force * cmath.exp(-1j * turns[x.link]) if x.follows and not x.resists else x.force
        return replace(x, at=own(x.link, x.at), force=force)

    return replace(
        it,
        links={
            n: replace(x, points={p: own(n, z) for p, z in x.points.items()}, centre=own(n, x.centre))
            for n, x in it.links.items()
        },
        slides=tuple(
            replace(
                s,
                through=own(s.carrier, s.through),
                at=own(s.runner, s.at),
                direction=s.direction - turns[s.carrier],
                turned=s.turned + turns[s.runner] - turns[s.carrier],
            )
            for s in it.slides
        ),
        driver=drivers[0],
        others=tuple(drivers[1:]),
        meshes=tuple(mesh(m) for m in it.meshes),
        sketch=replace(
            it.sketch,
            at=drivers[0].at if it.driver.kind == "turn" else it.sketch.at,
            angles={n: places[n] for n in it.sketch.angles},
        ),
        loads=tuple(load(x) for x in it.loads),
        elements=tuple(
            replace(
                s,
                at_i=own(s.i, s.at_i),
                at_j=own(s.j, s.at_j),
                **({"free": s.free + turns[s.j] - turns[s.i]} if s.turns and isinstance(s, Spring) else {}),
            )
            for s in it.elements
        ),
    ), turns


def sized(it: Linkage, size: float) -> Linkage:
    """All lengths and the forces of loads, weights and springs so many times larger; masses as they were."""

    def driver(d):
        if d.kind == "turn":
            return d
        return replace(d, rate=d.rate * size, acceleration=d.acceleration * size, at=d.at * size)

    def mesh(m: Mesh) -> Mesh:
        if m.kind == "rack":
            return replace(m, ratio=m.ratio * size, offset=m.offset * size)
        if m.kind == "cam" and m.slide:
            pieces = tuple(CamLawPiece(p.over, p.rise * size, p.shape) for p in m.law.pieces)
            return replace(m, offset=m.offset * size, law=replace(m.law, pieces=pieces))
        return m

    def element(s):
        s = replace(s, at_i=s.at_i * size, at_j=s.at_j * size)
        if isinstance(s, Damper):
            if s.turns:
                return replace(s, linear=s.linear * size**2, quadratic=s.quadratic * size**2)
            return replace(s, quadratic=s.quadratic / size)
        if s.turns:
            return replace(s, rate=s.rate * size**2, preload=s.preload * size**2, damping=s.damping * size**2)
        return replace(s, free=s.free * size, preload=s.preload * size)

    return replace(
        it,
        links={
            n: replace(
                x,
                points={p: z * size for p, z in x.points.items()},
                centre=x.centre * size,
                inertia=x.inertia * size**2,
            )
            for n, x in it.links.items()
        },
        slides=tuple(replace(s, through=s.through * size, at=s.at * size) for s in it.slides),
        driver=driver(it.driver),
        others=tuple(driver(d) for d in it.others),
        meshes=tuple(mesh(m) for m in it.meshes),
        sketch=replace(
            it.sketch,
            at=it.sketch.at * (size if it.driver.kind == "slide" else 1),
            points={p: z * size for p, z in it.sketch.points.items()},
        ),
        loads=tuple(replace(x, at=x.at * size, force=x.force * size, moment=x.moment * size**2) for x in it.loads),
        elements=tuple(element(s) for s in it.elements),
        gravity=it.gravity * size,
    )


def renamed(it: Linkage, seed: int) -> tuple[Linkage, dict[str, str], dict[str, str]]:
    """Links and points with other names, all records in another order; the new names of links and of points."""
    random = np.random.default_rng(seed)

    def shuffled(items):
        items = list(items)
        return [items[k] for k in random.permutation(len(items))]

    names = {FRAME: FRAME} | {old: f"L{k}" for k, old in enumerate(shuffled(it.moving))}
    points = {p: f"Q{k}" for k, p in enumerate(shuffled(dict.fromkeys(p for x in it.links.values() for p in x.points)))}

    def driver(d):
        joint = points[d.joint] if d.kind == "turn" else d.joint
        return replace(d, link=names[d.link], base=names[d.base], joint=joint, end=points.get(d.end, ""))

    def output_name(link: str) -> str:
        point, dot, axis = link.rpartition(".")
        return f"{points[point]}.{axis}" if dot else names[link] if link else ""

    def output(o: Output) -> Output:
        return replace(o, link=output_name(o.link))

    links = {
        names[n]: replace(
            it.links[n], name=names[n], points={points[p]: z for p, z in shuffled(it.links[n].points.items())}
        )
        for n in (FRAME, *shuffled(it.moving))
    }
    return (
        replace(
            it,
            links=links,
            hinges=tuple(
                Hinge(points[h.point], tuple(names[n] for n in shuffled(h.links)), names.get(h.attached_to, ""))
                for h in shuffled(it.hinges)
            ),
            slides=tuple(
                replace(s, carrier=names[s.carrier], runner=names[s.runner], point=points.get(s.point, ""))
                for s in shuffled(it.slides)
            ),
            driver=driver(it.driver),
            others=tuple(driver(d) for d in shuffled(it.others)),
            meshes=tuple(replace(m, i=names[m.i], j=names[m.j], carrier=names[m.carrier]) for m in shuffled(it.meshes)),
            sketch=replace(
                it.sketch,
                points={points[p]: z for p, z in shuffled(it.sketch.points.items())},
                angles={names[n]: a for n, a in shuffled(it.sketch.angles.items())},
            ),
            loads=tuple(
                replace(
                    x,
                    link=names[x.link],
                    base=names[x.base],
                    point=points.get(x.point, ""),
                    stroke_link=output_name(x.stroke_link),
                    table=x.table and replace(x.table, stroke_link=output_name(x.table.stroke_link)),
                )
                for x in shuffled(it.loads)
            ),
            elements=tuple(replace(s, i=names[s.i], j=names[s.j]) for s in shuffled(it.elements)),
            friction=tuple(replace(f, pair=points.get(f.pair, f.pair)) for f in shuffled(it.friction)),
            output=it.output and output(it.output),
            outputs=tuple(output(o) for o in it.outputs),
        ),
        names,
        points,
    )


def reversed_in_time(it: Linkage) -> Linkage:
    """Run backward through the sketch: what damps and what resists would drive."""

    def driver(d):
        return replace(d, sense=-d.sense, acceleration=-d.acceleration)

    return replace(
        it,
        driver=driver(it.driver),
        others=tuple(driver(d) for d in it.others),
        elements=tuple(
            replace(s, linear=-s.linear, quadratic=-s.quadratic)
            if isinstance(s, Damper)
            else replace(s, damping=-s.damping)
            for s in it.elements
        ),
        loads=tuple(replace(x, force=-x.force, moment=-x.moment) if x.resists else x for x in it.loads),
    )
