"""What is asked for by name: points, links, centres of mass (S3 of link 3), and the link that carries each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.refused import NoSuchName

if TYPE_CHECKING:
    from tmm_cli.groups.base import Kernel

Place = tuple[str, complex]  # a link and a place in its axes, m


def named_points(linkage: Linkage) -> dict[str, Place]:
    """Every named point of a moving link, once, with its link and place on it."""
    return {
        point: (link, local)
        for link in reversed(linkage.moving)
        for point, local in linkage.links[link].points.items()
        if point not in linkage.links[FRAME].points
    }


def mass_centres(linkage: Linkage) -> dict[str, Place]:
    """Centres of mass of the links that have one, named S3 after the link."""
    links = linkage.links
    return {f"S{name}": (name, links[name].centre) for name in linkage.moving if _heavy(links[name].mass)}


def _heavy(mass: float) -> bool:
    import numpy as np

    return bool(np.any(mass != 0))


def check(linkage: Linkage, names: Sequence[str]) -> None:
    """Raises NoSuchName."""
    known = {**named_points(linkage), **mass_centres(linkage), **dict.fromkeys(linkage.moving)}
    for name in names:
        if name not in known:
            raise NoSuchName(name, tuple(known))


def places(linkage: Linkage, kernels: Sequence[Kernel], names: Sequence[str]) -> Mapping[str, Place]:
    """The points and centres of mass among the names; a point on the link that takes the fewest groups to reach."""
    from tmm_cli.motion import towards

    points, centres = named_points(linkage), mass_centres(linkage)
    found: dict[str, Place] = {}
    for name in names:
        if name in points:
            link = min(
                (link for link in linkage.moving if name in linkage.links[link].points),
                key=lambda link: (len(towards(kernels, [link])), link != points[name][0]),
            )
            found[name] = link, linkage.local(link, name)
        elif name in centres:
            found[name] = centres[name]
    return found


def links(linkage: Linkage, names: Sequence[str]) -> tuple[str, ...]:
    """The links among the names, in the order of the file; a point of the same name comes first."""
    points = {**named_points(linkage), **mass_centres(linkage)}
    return tuple(link for link in linkage.moving if link in names and link not in points)


def carriers(linkage: Linkage, kernels: Sequence[Kernel], names: Sequence[str]) -> set[str]:
    """All links that must be placed for what is asked."""
    return {link for link, _ in places(linkage, kernels, names).values()} | set(links(linkage, names))
