"""Selection of points, links and centres of mass (S3 of link 3) by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.mechanics.errors import UnknownNameError
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.groups import GroupSolver, solvers_towards
from tmm_cli.mechanics.kinematics import Motion, PointMotion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.quantities import BALANCING, LINK, POINT, REACTION, Quantity

PointOnLink = tuple[str, complex]  # a link and a point in its axes, m


def named_points(linkage: Linkage) -> dict[str, PointOnLink]:
    """Return the link and the local coordinates of every named point of the moving links."""
    return {
        point: (link, local)
        for link in reversed(linkage.moving)
        for point, local in linkage.links[link].points.items()
        if point not in linkage.links[FRAME].points
    }


def mass_centres(linkage: Linkage) -> dict[str, PointOnLink]:
    """Return the link and the local coordinates of every centre of mass; S3 is that of link 3."""
    links = linkage.links
    return {f"S{name}": (name, links[name].centre) for name in linkage.moving if np.any(links[name].mass != 0)}


def refuse_unknown_names(linkage: Linkage, names: Sequence[str]) -> None:
    """Raise UnknownNameError for a name that is not a point, centre of mass or moving link."""
    allowed = {**named_points(linkage), **mass_centres(linkage), **dict.fromkeys(linkage.moving)}
    for name in names:
        if name not in allowed:
            raise UnknownNameError(name, tuple(allowed))


def point_places(linkage: Linkage, kernels: Sequence[GroupSolver], names: Sequence[str]) -> Mapping[str, PointOnLink]:
    """Return the link and the local coordinates of the named points and centres of mass.

    For a point shared by several links, the link is the one that requires the fewest groups to be solved.
    """
    points, centres = named_points(linkage), mass_centres(linkage)
    points_on_links: dict[str, PointOnLink] = {}
    for name in names:
        if name in points:
            link = min(
                (link for link in linkage.moving if name in linkage.links[link].points),
                key=lambda link: (len(solvers_towards(kernels, [link])), link != points[name][0]),
            )
            points_on_links[name] = link, linkage.local(link, name)
        elif name in centres:
            points_on_links[name] = centres[name]
    return points_on_links


def moving_points(linkage: Linkage, motion: Motion, names: Sequence[str] = ()) -> dict[str, PointMotion]:
    """Return the motion of the named points, or of all points if `names` is empty."""
    points = named_points(linkage)
    return {name: motion.named(name) for name in (dict.fromkeys(names) if names else points) if name in points}


def moving_centres(linkage: Linkage, motion: Motion, names: Sequence[str] = ()) -> dict[str, PointMotion]:
    """Return the motion of the named centres of mass, or of all centres if `names` is empty."""
    centres = mass_centres(linkage)
    points = named_points(linkage)
    chosen = [name for name in dict.fromkeys(names) if name not in points] if names else centres
    return {name: motion.centre(centres[name][0]) for name in chosen if name in centres}


def select_links(linkage: Linkage, names: Sequence[str]) -> tuple[str, ...]:
    """Return the links among the names, in the order of the file, or all moving links if `names` is empty.

    A name that is both a point and a link means the point.
    """
    points = {**named_points(linkage), **mass_centres(linkage)}
    if not names:
        return linkage.moving
    return tuple(link for link in linkage.moving if link in names and link not in points)


def carrying_links(linkage: Linkage, kernels: Sequence[GroupSolver], names: Sequence[str]) -> set[str]:
    """Return the links on which the named points, links and centres of mass lie, so that their motion must be
    solved.
    """
    return {link for link, _ in point_places(linkage, kernels, names).values()} | set(select_links(linkage, names))


def leading_values(
    motion: Motion, reactions: Reactions | None, *, first: bool = False
) -> Iterator[tuple[Quantity, str, Any]]:
    """Yield the main quantities of links, points, centres of mass, pairs and drivers.

    Args:
        motion: solved motion.
        reactions: reactions in the pairs; None to leave out forces.
        first: True to compute the motion of a point that several links share from the first of them in the file. By
            default it is computed from the link that loses the fewest digits. While operations are traced, that link is
            unknown, because it depends on numbers.

    Yields:
        The quantity, the name of its object, and the values.
    """
    linkage, listed = motion.linkage, set(motion.linkage.links[FRAME].points)
    for name in linkage.moving:
        points = [point for point in linkage.links[name].points if point not in listed]
        listed.update(points)
        yield from _leading_of(LINK, name, motion.link(name))
        for point in points:
            yield from _leading_of(POINT, point, motion.named_on(name, point) if first else motion.named(point))
        yield from _leading_of(POINT, f"S{name}", motion.centre(name))
    for reaction in reactions.all if reactions is not None else ():
        yield from _leading_of(REACTION, reaction.pair.name, reaction)
    for balance in reactions.balances if reactions is not None else ():
        yield from _leading_of((BALANCING,), balance.driver.link, balance)


def _leading_of(quantities: Iterable[Quantity], name: str, record: Any) -> Iterator[tuple[Quantity, str, Any]]:
    for quantity in quantities:
        if quantity.leading and quantity.there(record):
            yield quantity, name, quantity.value(record)
