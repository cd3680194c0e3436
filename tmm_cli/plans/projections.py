"""Sums of forces along guides: what no equation of moments gives, the part of a reaction along a guide and what drives.

The guide itself does nothing along its direction, so the forces on one of its two links must come to nothing there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.linkage import FRAME
from tmm_cli.plans.bodies import DRIVE, Acting, Loaded
from tmm_cli.plans.leads import Lead
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.tolerances import NO_FORCE
from tmm_cli.vectors import dot


@dataclass(frozen=True)
class Part:
    """What acts, and its part along the guide (N)."""

    acting: Acting
    along: float

    @property
    def cosine(self) -> float:
        """Of the acute angle between the force and the guide."""
        return min(1.0, abs(self.along) / self.acting.size)


@dataclass(frozen=True)
class ForceSum:
    """The parts along a guide of all that acts on a link come to nothing; what is across it is left out."""

    link: str
    guide: str
    direction: complex
    parts: tuple[Part, ...]
    found: Part

    @property
    def value(self) -> float:
        """Of what is found, from the others, N; it is along the guide."""
        others = sum(part.along for part in self.parts if part is not self.found)
        return -others if self.found.along > 0 else others


def along_guides(
    here: Loaded, group: Group, leads: Sequence[Lead], axes: Mapping[str, complex]
) -> tuple[ForceSum, ...]:
    """Normal parts of leads that slide on the group, then what drives a cylinder of it."""
    found: list[ForceSum] = []
    for lead in leads:
        own = group.own(lead.pair)
        guides = [p for p in group.inner if p.slide is not None and own in (p.i, p.j)]
        if lead.pair.name in axes and len(guides) == 1 and len(lead.links) > 1 and not _driven(group, guides[0]):
            found += _sum(here, axes, own, guides[0], lead.pair.name, "normal")
    for guide in (p for p in group.inner if p.slide is not None and _driven(group, p)):
        sides = [n for n in (guide.i, guide.j) if any(n in (p.i, p.j) for p in group.outer)] or [guide.j]
        found += _sum(here, axes, sides[0], guide, DRIVE, "reaction")
    return tuple(found)


def of_driver(here: Loaded, pair: Pair) -> tuple[ForceSum, ...]:
    """What drives a slider on the frame."""
    return tuple(_sum(here, {}, pair.j if pair.i == FRAME else pair.i, pair, DRIVE, "reaction"))


def _driven(group: Group, guide: Pair) -> bool:
    return any({d.link, d.base} == {guide.i, guide.j} for d in group.drivers)


def _sum(here: Loaded, axes: Mapping[str, complex], link: str, guide: Pair, pair: str, kind: str) -> Iterable[ForceSum]:
    """None where what is sought is nothing."""
    u = here.guide(guide)
    forces = [a for a in here.acting((link,), axes) if not a.couple]
    largest = max((a.size for a in forces), default=0.0)
    parts = [Part(a, float(dot(u, a.force))) for a in forces]
    parts = [part for part in parts if abs(part.along) > NO_FORCE * largest]
    sought = [part for part in parts if (part.acting.pair, part.acting.kind) == (pair, kind)]
    if sought:
        yield ForceSum(link, guide.name, u, tuple(parts), sought[0])
