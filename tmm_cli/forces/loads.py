"""All that acts on the links besides reactions: weights, inertia, the loads of the task."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.springs import spring_loads
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.strokes import Strokes, output_place
from tmm_cli.tolerances import SEAM
from tmm_cli.vectors import Real, pi


def applied(motion: Motion, strokes: Strokes | None) -> tuple[Applied, ...]:
    """All that acts on each moving link but friction, in the order of the links."""
    order = {name: k for k, name in enumerate(motion.linkage.links)}
    found = [load for kind in KINDS for load in kind(motion, strokes)]
    return tuple(sorted(found, key=lambda a: order[a.link]))


def weights_and_inertia(motion: Motion, strokes: Strokes | None) -> Iterable[Applied]:
    """Weights in the centres of mass, and inertia about them. Massless links carry nothing."""
    still = np.zeros(np.shape(motion.q))
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        if np.any(link.mass != 0):
            weight = link.mass * motion.linkage.gravity + still
            yield Applied(f"G{name}", "weight", name, link.centre, weight, still)
        if np.any(link.mass != 0) or np.any(link.inertia != 0):
            inertia = -link.mass * motion.centre(name).a
            moment = -link.inertia * motion.link(name).epsilon
            yield Applied(f"U{name}", "inertia", name, link.centre, inertia, moment, f"M{name}")


def given_loads(motion: Motion, strokes: Strokes | None) -> Iterable[Applied]:
    """The loads of the task; those of working strokes act always where there are none."""
    for load in motion.linkage.loads:
        size = np.ones(np.shape(motion.q))
        if load.table is not None:
            size = load.table(table_argument(load.table.against, motion, strokes))
        if load.working_stroke_only and strokes is not None and strokes.strokes:
            size = np.where(strokes.share(motion.q, motion.linkage.driver.sense), size, 0.0)
        turned = motion.poses[load.link].z if load.follows else 1.0
        force, moment = load.force * size * turned, load.moment * size
        yield Applied(load.name, "load", load.link, load.at, force, moment, load.name)


def table_argument(against: str, motion: Motion, strokes: Strokes | None) -> Real:
    """What a load is tabulated against: run of the output from where its working stroke starts, or the crank."""
    driver = motion.linkage.driver
    if against == "crank angle":
        return _turned(motion.q, 2 * pi(motion.q))
    first = strokes.strokes[0] if strokes and strokes.strokes else None
    if against == "crank turn":
        start = first.start if first else motion.linkage.sketch.at
        cycle = strokes.cycle if strokes else 2 * np.pi
        return _turned(driver.sense * (motion.q - start), cycle)
    assert strokes is not None and first is not None
    run: Real = output_place(motion, strokes.link) - first.low
    if strokes.kind == "swing":
        run = np.angle(np.exp(1j * (run - first.run / 2))) + first.run / 2
    worked: Real = run * np.sign(first.run)
    return worked


def _turned(angle: Real, cycle: Real | float) -> Real:
    """An angle within its cycle. A table may jump from its end to its beginning: rounding does not take a place there
    to the other side."""
    seam = SEAM * (1 + np.abs(angle))
    within: Real = np.mod(angle + seam, cycle) - seam
    return within


KINDS = (weights_and_inertia, given_loads, spring_loads)  # what acts on links, each from a motion and its strokes
