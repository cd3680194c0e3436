"""Leads of a group: the outer hinges and guides by which it hangs on other links; the point of Assur of three leads."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from tmm_cli.plans.bodies import FAR, Loaded
from tmm_cli.plans.record import Kind
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.vectors import cross

STEEP = 0.02  # sine: lines that meet under less have their special point off any paper


@dataclass(frozen=True)
class Lead:
    """An outer pair with all links that turn as one with its own (they slide on one another).

    axis: along which the normal part of a hinge's reaction is, if it is parted. about: the point about which moments of
    these links give the tangential part. rest: a line (place and direction) that has what is not found by then.
    """

    pair: Pair
    links: tuple[str, ...]
    axis: complex | None = None
    about: str | None = None
    rest: tuple[complex, complex] | None = None

    @property
    def open_part(self) -> Kind:
        """Which part of the reaction has its line in `rest`."""
        if self.pair.slide is not None:
            return "reaction"
        return "tangential" if self.about is None else "normal"


def leads_of(here: Loaded, group: Group) -> tuple[Lead, ...]:
    """Its outer lower pairs, in its own order."""
    return tuple(_lead(here, group, pair) for pair in group.outer if pair.lower)


def hinges_of(pairs: Iterable[Pair], links: Collection[str]) -> list[str]:
    """Points in which these links are hinged to others."""
    return list(dict.fromkeys(p.point for p in pairs if p.kind == "R" and len({p.i, p.j} & {*links}) == 1))


def _lead(here: Loaded, group: Group, pair: Pair) -> Lead:
    own = group.own(pair)
    links = _sliding_together(group, own)
    inner = hinges_of(group.inner, links)
    if pair.slide is not None:
        hinges = hinges_of(group.inner, (own,))
        rest = (here.hinge(hinges[0]), 1j * here.guide(pair)) if len(hinges) == 1 else None
        return Lead(pair, links, rest=rest)
    at = here.hinge(pair.point)
    outer = [p for p in group.outer if group.own(p) in links]
    if len(inner) == 1 and len(outer) == 1:
        axis = here.hinge(inner[0]) - at
        return Lead(pair, links, axis, inner[0], (at, axis)) if axis else Lead(pair, links)
    driven = {link for driver in group.drivers for link in (driver.base, driver.link)}
    slides = [p for p in group.inner if own in (p.i, p.j)]
    if len(slides) == 1 and slides[0].slide is not None and own not in driven:
        axis = here.guide(slides[0])  # nothing else holds the link along its guide
        others = [p.point for p in outer if p != pair and p.kind == "R"]
        if not inner and len(others) == len(outer) - 1 == 1:
            return Lead(pair, links, axis, others[0])
        return Lead(pair, links, axis if len(group.outer) > 2 else None, rest=(at, 1j * axis))
    return Lead(pair, links)


def _sliding_together(group: Group, link: str) -> tuple[str, ...]:
    """Links that turn as one with a link of the group."""
    found = {link}
    for _ in group.links:
        for pair in group.inner:
            if pair.slide is not None and {pair.i, pair.j} & found:
                found |= {pair.i, pair.j}
    return tuple(n for n in group.links if n in found)


def assur_point(here: Loaded, group: Group, leads: Sequence[Lead]) -> tuple[Lead, complex] | None:
    """The lead that moments of a group with three leads give next, and where what is open of the other two meets."""
    if len(leads) != 3 or len(group.outer) != 3 or group.drivers or any(lead.rest is None for lead in leads):
        return None
    for lead in sorted(leads, key=lambda lead: lead.open_part == "normal"):
        (p, u), (q, v) = (other.rest for other in leads if other is not lead and other.rest is not None)
        sine = cross(u, v) / (abs(u) * abs(v))
        if abs(sine) > STEEP:
            centre = p + u * cross(q - p, v) / cross(u, v)
            if abs(centre - here.pair(lead.pair)) < FAR * here.size:
                return lead, complex(centre)
    return None
