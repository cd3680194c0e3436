"""All that acts on the links besides reactions: weights, inertia, the loads of the task."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.given import given_loads
from tmm_cli.forces.springs import spring_loads
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.strokes import Strokes

BALANCING = ("Mb", "M_b", "Fb", "F_b")  # as the balancing moment and force are written


def applied(motion: Motion, strokes: Strokes | None) -> tuple[Applied, ...]:
    """All that acts on each moving link but friction, in the order of the links."""
    order = {name: k for k, name in enumerate(motion.linkage.links)}
    found = [load for kind in KINDS for load in kind(motion, strokes)]
    symbols = {*BALANCING, *(name for load in found if load.kind != "load" for name in (load.name, load.couple_name))}
    found = [replace(a, ambiguous=True) if a.kind == "load" and a.name.rstrip("'") in symbols else a for a in found]
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


KINDS = (weights_and_inertia, given_loads, spring_loads)  # what acts on links, each from a motion and its strokes
