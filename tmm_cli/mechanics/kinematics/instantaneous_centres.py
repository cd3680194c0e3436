"""Instantaneous centres of all pairs of links, and their construction by Kennedy's theorem.

The centres are computed from velocities, which works for every linkage. Their construction is described too: the three
centres of three links are collinear, so that a centre is the intersection of two lines through known centres (A. B. W.
Kennedy, The Mechanics of Machinery, 1886).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tmm_cli.mechanics.groups import LinkStates
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import cross, unit
from tmm_cli.mechanics.structure import Pair, Structure

FAR = 1e6  # sizes of the mechanism: a more distant centre is at infinity
STILL = 1e-10  # fraction of the largest velocity: below it there is no relative motion
SHARP = 1e-3  # rad: least angle of two lines of a construction
NEAR = 1e-6  # fraction of the size: centres closer together coincide

LinkPair = tuple[str, str]
CentreLine = tuple[LinkPair, LinkPair]
CentrePlace = tuple[complex | None, complex | None]  # position (m), or unit vector towards infinity


@dataclass(frozen=True)
class InstantCentre:
    """Instantaneous centre of two links in one position.

    Attributes:
        links: names of the two links.
        place: position of the centre (m); None if it is at infinity, or if the links have no relative motion.
        direction: unit vector towards a centre at infinity, otherwise None.
        pair: name of a kinematic pair of the two links that determines the centre; otherwise empty.
        lines: two lines whose intersection is the centre, each through two known centres.
    """

    links: LinkPair
    place: complex | None
    direction: complex | None
    pair: str = ""
    lines: tuple[CentreLine, ...] = ()


def find_centres(states: LinkStates, structure: Structure, k: int) -> list[InstantCentre]:
    """Find all instantaneous centres in position k.

    Returns:
        The centres determined by pairs, then the other centres in the order of their construction.
    """
    names = (FRAME, *states.linkage.moving)
    size = _linkage_size(states, k)
    motion = {name: _velocity_about_origin(states, name, k) for name in names}
    least = STILL * max(max(abs(v), abs(w) * size) for v, w in motion.values())
    centre_of = {(i, j): _relative_centre(motion[i], motion[j], size, least) for i, j in combinations(names, 2)}
    pairs = {
        _ordered_links(p.i, p.j, names): p for p in reversed(structure.pairs) if p.kind != "C"
    }  # a cam pair does not determine a centre
    for links, pair in pairs.items():
        centre_of[links] = _pair_centre(states, pair, k) or centre_of[links]
    centres = [InstantCentre(links, *centre_of[links], pair=pairs[links].name) for links in centre_of if links in pairs]
    known = {centre.links for centre in centres}
    while True:
        step = [
            InstantCentre(links, *centre_of[links], lines=lines)
            for links in centre_of
            if links not in known and (lines := _crossing_lines(links, names, centre_of, known, size))
        ]
        if not step:
            break
        centres += step
        known |= {centre.links for centre in step}
    return [*centres, *(InstantCentre(links, *centre_of[links]) for links in centre_of if links not in known)]


def _pair_centre(states: LinkStates, pair: Pair, k: int) -> CentrePlace | None:
    """Return the instantaneous centre that a hinge or a guide determines; None for a higher pair.

    It is defined even if the links have no relative motion.
    """
    if pair.slide is not None:
        guide = complex(states.poses[pair.slide.carrier].z[k]) * complex(unit(pair.slide.direction))
        return None, 1j * guide
    link = pair.j if pair.j != FRAME else pair.i
    return (complex(states.poses[link].at(states.linkage.local(link, pair.point))[k]), None) if pair.lower else None


def _linkage_size(states: LinkStates, k: int) -> float:
    linkage = states.linkage
    points = [
        complex(states.poses[n].at(complex(p))[k]) for n in linkage.moving for p in linkage.links[n].points.values()
    ]
    points += [complex(p) for p in linkage.links[FRAME].points.values()]
    return max(abs(p - points[0]) for p in points) or 1.0


def _relative_centre(
    motion: tuple[complex, float], other_motion: tuple[complex, float], size: float, least: float
) -> CentrePlace:
    """Compute the centre of two links, or its direction at infinity, from their motions.

    Args:
        motion, other_motion: for each link, velocity of its point at the origin of the drawing, and angular velocity.
        size: size of the mechanism (m).
        least: velocity below which there is no relative motion.
    """
    slip, turn = motion[0] - other_motion[0], motion[1] - other_motion[1]
    if abs(turn) * size <= max(least, abs(slip) / FAR):
        return None, None if abs(slip) <= least else 1j * slip / abs(slip)
    return 1j * slip / turn, None


def _velocity_about_origin(states: LinkStates, name: str, k: int) -> tuple[complex, float]:
    """Return the velocity of the point of a link at the origin of the drawing, and the angular velocity of the link.

    Both are per unit velocity of the driver.
    """
    if name == FRAME:
        return 0j, 0.0
    pose, rate = states.poses[name], states.first[name]
    v, w, x = (np.broadcast_to(component, np.shape(states.q))[k] for component in (rate.v, rate.w, pose.x))
    return complex(v - 1j * w * x), float(w)


def _crossing_lines(
    links: LinkPair,
    names: tuple[str, ...],
    centre_of: dict[LinkPair, CentrePlace],
    known: set[LinkPair],
    size: float,
) -> tuple[CentreLine, ...]:
    """Find two lines, each through two known centres, whose intersection is the instantaneous centre of these links.

    If the two centres of a line coincide, this line alone is returned, because the required centre coincides with them.
    """
    i, j = links
    candidates: list[tuple[CentreLine, complex]] = []
    for k in names:
        if k in links:
            continue
        line = _ordered_links(i, k, names), _ordered_links(k, j, names)
        if not known.issuperset(line):
            continue
        along = _line_direction(centre_of[line[0]], centre_of[line[1]], size)
        if along is None:
            continue
        if along == 0:  # both centres coincide: a compound hinge
            return (line,)
        candidates.append((line, along))
    for (line_a, along), (line_b, across) in combinations(candidates, 2):
        if abs(cross(along, across)) > SHARP:
            return line_a, line_b
    return ()


def _ordered_links(i: str, j: str, names: tuple[str, ...]) -> LinkPair:
    return (i, j) if names.index(i) < names.index(j) else (j, i)


def _line_direction(centre: CentrePlace, other_centre: CentrePlace, size: float) -> complex | None:
    """Return the direction of the line through two centres; 0 if they coincide, None if both are at infinity."""
    (p, u), (q, v) = centre, other_centre
    if p is not None and q is not None:
        return (q - p) / abs(q - p) if abs(q - p) > NEAR * size else 0j
    if p is None and q is None:
        return None
    return u if p is None else v
