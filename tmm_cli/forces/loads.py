"""All that acts on the links besides reactions: weights, inertia, the loads of the task."""

from __future__ import annotations

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.springs import spring_loads
from tmm_cli.linkage import Load
from tmm_cli.motion import Motion
from tmm_cli.strokes import Strokes, output_place
from tmm_cli.vectors import Real, pi


def applied(motion: Motion, strokes: Strokes | None) -> tuple[Applied, ...]:
    """All that acts on each moving link but friction, in the order of the links. Massless links carry nothing."""
    linkage = motion.linkage
    still = np.zeros(np.shape(motion.q))
    found = []
    for name in linkage.moving:
        link = linkage.links[name]
        if np.any(link.mass != 0):
            found.append(Applied(f"G{name}", "weight", name, link.centre, link.mass * linkage.gravity + still, still))
        if np.any(link.mass != 0) or np.any(link.inertia != 0):
            inertia = -link.mass * motion.centre(name).a
            moment = -link.inertia * motion.link(name).epsilon
            found.append(Applied(f"U{name}", "inertia", name, link.centre, inertia, moment, f"M{name}"))
    found += [_given(load, motion, strokes) for load in linkage.loads]
    found += [load for spring in linkage.springs for load in spring_loads(spring, motion)]
    order = {name: k for k, name in enumerate(linkage.links)}
    return tuple(sorted(found, key=lambda a: order[a.link]))


def _given(load: Load, motion: Motion, strokes: Strokes | None) -> Applied:
    size = np.ones(np.shape(motion.q))
    if load.table is not None:
        size = load.table(table_argument(load.table.against, motion, strokes))
    if load.working_stroke_only and strokes is not None and strokes.strokes:
        size = np.where(strokes.share(motion.q, motion.linkage.driver.sense), size, 0.0)
    turn = motion.poses[load.link].z if load.follows else 1.0
    return Applied(load.name, "load", load.link, load.at, load.force * size * turn, load.moment * size, load.name)


def table_argument(against: str, motion: Motion, strokes: Strokes | None) -> Real:
    """What a load is tabulated against: run of the output from where its working stroke starts, or the crank."""
    driver = motion.linkage.driver
    if against == "crank angle":
        turned: Real = np.mod(motion.q, 2 * pi(motion.q))
        return turned
    first = strokes.strokes[0] if strokes and strokes.strokes else None
    if against == "crank turn":
        start = first.start if first else motion.linkage.sketch.at
        cycle = strokes.cycle if strokes else 2 * np.pi
        return np.mod(driver.sense * (motion.q - start) + 1e-12, cycle) - 1e-12
    assert strokes is not None and first is not None
    run: Real = output_place(motion, strokes.link) - first.low
    if strokes.kind == "swing":
        run = np.angle(np.exp(1j * (run - first.run / 2))) + first.run / 2
    way: Real = run * np.sign(first.run)
    return way
