"""Vector equations of a linkage's velocities and accelerations on paper: driving links, then groups in solving order.

Points of a link lead from one of them to each other; a stone leads from the point of its guide under it. What is known
before the equations of a group are solved, and how many magnitudes are not, follows from who is joined to whom.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Mesh, Slide
from tmm_cli.mechanics.structure import Group

MOST_UNKNOWNS = 2  # unknown magnitudes on known lines that a polygon gives


@dataclass(frozen=True)
class PlanPoint:
    """A point of a link, of the frame if it does not move. at: the named point in the same place (A of A3)."""

    name: str
    at: str
    link: str

    @property
    def fixed(self) -> bool:
        return self.link == FRAME


@dataclass(frozen=True)
class SameLinkEquation:
    """A point of a link, found from another one of it.

    known: so is what the link turns with. idle: it does not turn, and both points move as one.
    """

    point: PlanPoint
    base: PlanPoint
    link: str
    known: bool
    idle: bool


@dataclass(frozen=True)
class MovingGuideEquation:
    """A stone, found from the point of its moving guide under it. known: so is how it slides."""

    point: PlanPoint
    base: PlanPoint
    slide: Slide
    known: bool


@dataclass(frozen=True)
class FixedGuideEquation:
    """A point that runs along a guide of the frame. known: so is how it runs."""

    point: PlanPoint
    slide: Slide
    known: bool


VectorEquation = SameLinkEquation | MovingGuideEquation | FixedGuideEquation


@dataclass(frozen=True)
class HigherPairRatio:
    """A higher pair that gives what a link turns with, or how a sliding pair slides."""

    mesh: Mesh
    link: str = ""
    slide: Slide | None = None


@dataclass(frozen=True)
class SolutionStep:
    """A driving link on the frame, or a group with the drivers between its links.

    ratios come before the equations, which are solved together; after: further points of the links. same: links that
    turn as one, each time with one that is known before if there is one. on_paper: no more magnitudes are unknown than
    a polygon gives.
    """

    links: tuple[str, ...]
    drivers: tuple[Driver, ...]
    group: Group | None = None
    ratios: tuple[HigherPairRatio, ...] = ()
    equations: tuple[VectorEquation, ...] = ()
    after: tuple[SameLinkEquation, ...] = ()
    same: tuple[tuple[str, ...], ...] = ()
    on_paper: bool = True


def solution_steps(linkage: Linkage, groups: Sequence[Group]) -> list[SolutionStep]:
    """Driving links on the frame, then the groups in their order."""
    way = _EquationBuilder(linkage, solution_rank(linkage, groups))
    return [*(way.driving(driver) for driver in linkage.cranks), *(way.group(group) for group in groups)]


def motion_points(linkage: Linkage, link: str) -> list[str]:
    """Points of a link that tell its motion: those it shares with others, or all when it shares fewer than two."""
    points = list(linkage.links[link].points)
    shared = {h.point for h in linkage.hinges if link in h.links}
    running = {s.at for s in linkage.slides if s.runner == link}
    told = [p for p in points if p in shared or linkage.local(link, p) in running]
    return told if len(told) > 1 else points


def solution_rank(linkage: Linkage, groups: Iterable[Group]) -> dict[str, int]:
    """When named points are found: -1 those of the frame, 0 of driving links, then by the number of the first group."""
    rank = {FRAME: -1} | {driver.link: 0 for driver in linkage.cranks}
    rank |= {link: number for number, group in enumerate(groups, 1) for link in group.links}
    points = {point for link in linkage.links.values() for point in link.points}
    return {point: min(rank.get(link, len(rank)) for link in linkage.carriers(point)) for point in points}


class _EquationBuilder:
    """Through a linkage, with what is known so far.

    turns: for each link the first that turns as it does. known: those of them whose turning is known, and names of
    sliding pairs in which it is known how they slide.
    """

    def __init__(self, linkage: Linkage, rank: Mapping[str, int]) -> None:
        self.linkage, self.rank = linkage, rank
        self.turns = {link: link for link in linkage.links}
        for slide in linkage.slides:
            one, other = sorted((self.turns[slide.carrier], self.turns[slide.runner]), key=list(linkage.links).index)
            self.turns = {link: one if first == other else first for link, first in self.turns.items()}
        self.known = {FRAME}
        self.slid: set[str] = set()

    def driving(self, driver: Driver) -> SolutionStep:
        """A link that is driven from the frame."""
        link = driver.link
        self.known.add(self.turns[link])
        if driver.kind == "turn":
            return SolutionStep((link,), (driver,), after=self._others(link, self._spot(driver.joint), ()))
        slide = self.linkage.slide(driver.joint)
        self.slid.add(slide.name)
        base = self._running(link, slide)
        after = self._others(link, base, (base.name,))
        return SolutionStep((link,), (driver,), equations=(FixedGuideEquation(base, slide, True),), after=after)

    def group(self, group: Group) -> SolutionStep:
        """A group, when all that it hangs on is known."""
        before = [link for link in self.turns if self.turns[link] in self.known]
        for driver in group.drivers:
            if driver.kind == "slide":
                self.slid.add(driver.joint)
            else:
                self.known.add(self.turns[driver.link])
        ratios = self._ratios(group)
        spots = {link: self._of_group(group, link) for link in group.links}
        base = {link: min(own, key=self._order) for link, own in spots.items() if own}
        equations: list[VectorEquation] = [
            self._about(spot, base[link], link) for link in base for spot in spots[link] if spot != base[link]
        ]
        equations += self._of_slides(group)
        turned = {self.turns[link] for link in group.links} - self.known
        unknown = len(turned) + sum(not e.known for e in equations if not isinstance(e, SameLinkEquation))
        self.known |= turned
        self.slid |= {pair.slide.name for pair in (*group.inner, *group.outer) if pair.slide is not None}
        told = [spot.name for own in spots.values() for spot in own]
        after = [about for link in base for about in self._others(link, base[link], told)]
        return SolutionStep(
            group.links,
            group.drivers,
            group,
            ratios,
            tuple(equations),
            tuple(after),
            self._same(group, before),
            unknown <= MOST_UNKNOWNS,
        )

    def _spot(self, point: str) -> PlanPoint:
        return PlanPoint(point, point, FRAME if FRAME in self.linkage.carriers(point) else self.linkage.owner(point))

    def _running(self, link: str, slide: Slide) -> PlanPoint:
        """The point of a link that tells how it runs on the frame."""
        if slide.runner == link and slide.point in self.linkage.links[link].points:
            return self._spot(slide.point)
        return self._spot(next(iter(self.linkage.links[link].points)))

    def _order(self, spot: PlanPoint) -> float:
        return -1 if spot.fixed else self.rank[spot.at] if spot.name == spot.at else float("inf")

    def _of_group(self, group: Group, link: str) -> list[PlanPoint]:
        """Points of a link in the pairs of its group, those that are found first before the others."""
        found: list[PlanPoint] = []
        for pair in (*group.outer, *group.inner):
            if link not in (pair.i, pair.j) or not pair.lower:
                continue
            slide = pair.slide
            if slide is None:
                found.append(self._spot(pair.point))
            elif FRAME in (slide.carrier, slide.runner):
                found.append(self._running(link, slide))
            else:
                found.append(self._spot(slide.point) if link == slide.runner else coincident_point(slide))
        return sorted(dict.fromkeys(found), key=self._order)

    def _about(self, point: PlanPoint, base: PlanPoint, link: str) -> SameLinkEquation:
        return SameLinkEquation(point, base, link, self.turns[link] in self.known, self.turns[link] == FRAME)

    def _of_slides(self, group: Group) -> Iterable[VectorEquation]:
        for slide in (pair.slide for pair in (*group.outer, *group.inner) if pair.slide is not None):
            known = slide.name in self.slid
            if FRAME in (slide.carrier, slide.runner):
                yield FixedGuideEquation(
                    self._running(slide.runner if slide.carrier == FRAME else slide.carrier, slide), slide, known
                )
                continue
            if slide.carrier not in group.links:  # its guide is known as a whole
                points = motion_points(self.linkage, slide.carrier)
                yield self._about(coincident_point(slide), min(map(self._spot, points), key=self._order), slide.carrier)
            yield MovingGuideEquation(self._spot(slide.point), coincident_point(slide), slide, known)

    def _others(self, link: str, base: PlanPoint, told: Collection[str]) -> tuple[SameLinkEquation, ...]:
        """Further points of a link that tell its motion; not the free ends of cylinders and rods that swing."""
        points = [p for p in motion_points(self.linkage, link) if p not in told and p != base.name]
        if not base.fixed and any(link in (slide.carrier, slide.runner) for slide in self.linkage.slides):
            running = {slide.point for slide in self.linkage.slides}
            points = [p for p in points if len(self.linkage.carriers(p)) > 1 or p in running]
        return tuple(self._about(self._spot(p), base, link) for p in points if not self._spot(p).fixed)

    def _same(self, group: Group, before: Collection[str]) -> tuple[tuple[str, ...], ...]:
        """Links of the group that turn as one, after one that is known before."""
        found = []
        for first in dict.fromkeys(self.turns[link] for link in group.links):
            earlier = [link for link in before if self.turns[link] == first][:1]
            links = [*earlier, *(link for link in group.links if self.turns[link] == first)]
            if first != FRAME and len(links) > 1:
                found.append(tuple(links))
        return tuple(found)

    def _ratios(self, group: Group) -> tuple[HigherPairRatio, ...]:
        """Higher pairs of the group in which one quantity only is unknown, one after another."""
        meshes = [pair.mesh for pair in (*group.outer, *group.inner) if pair.mesh is not None]
        found: list[HigherPairRatio] = []
        for _ in meshes:
            for mesh in meshes:
                slide = self.linkage.slide(mesh.slide) if mesh.slide else None
                wheels = (mesh.i, mesh.carrier) if slide is not None else (mesh.i, mesh.j, mesh.carrier)
                links = [link for link in wheels if self.turns[link] not in self.known]
                slides = [] if slide is None or slide.name in self.slid else [slide]
                if len(links) + len(slides) == 1 and mesh not in [ratio.mesh for ratio in found]:
                    found.append(HigherPairRatio(mesh, links[0]) if links else HigherPairRatio(mesh, slide=slides[0]))
                    self.known |= {self.turns[link] for link in links}
                    self.slid |= {s.name for s in slides}
        return tuple(found)


def coincident_point(slide: Slide) -> PlanPoint:
    """The point of a moving guide that is under its stone."""
    return PlanPoint(f"{slide.point}{slide.carrier}", slide.point, slide.carrier)
