"""Vector equations of velocities and accelerations, as solved on paper: driving links, then groups in
solution order.

Points of a link are related to one another; a sliding block is related to the coincident point of its
guide. What is known before the equations of a group are solved, and how many magnitudes are unknown,
follows from the structure alone.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Mesh, Slide
from tmm_cli.mechanics.structure import Group

MOST_UNKNOWNS = 2  # unknown magnitudes that one vector polygon can give


@dataclass(frozen=True)
class PlanPoint:
    """Point of a link; link is the frame if it does not move. at: named point at the same place (A for A3)."""

    name: str
    at: str
    link: str

    @property
    def fixed(self) -> bool:
        return self.link == FRAME


@dataclass(frozen=True)
class SameLinkEquation:
    """Equation of a point through another point of the same link.

    known: the angular velocity of the link is known. idle: the link does not rotate, so both points move
    alike.
    """

    point: PlanPoint
    base: PlanPoint
    link: str
    known: bool
    idle: bool


@dataclass(frozen=True)
class MovingGuideEquation:
    """Equation of a sliding block through the coincident point of its moving guide. known: the sliding motion is
    known.
    """

    point: PlanPoint
    base: PlanPoint
    slide: Slide
    known: bool


@dataclass(frozen=True)
class FixedGuideEquation:
    """Equation of a point on a guide of the frame. known: its motion along the guide is known."""

    point: PlanPoint
    slide: Slide
    known: bool


VectorEquation = SameLinkEquation | MovingGuideEquation | FixedGuideEquation


@dataclass(frozen=True)
class HigherPairRatio:
    """Higher pair that gives the rotation of a link, or the motion in a prismatic pair."""

    mesh: Mesh
    link: str = ""
    slide: Slide | None = None


@dataclass(frozen=True)
class SolutionStep:
    """One step of the solution: a driving link on the frame, or a group with the drivers between its links.

    ratios: ratios of higher pairs, used before the equations. equations: solved together. after: equations of
    further points. same: links that rotate together, with one that was known before if there is one.
    on_paper: no more magnitudes are unknown than a polygon gives.
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
    """Return the steps: driving links on the frame, then the groups in their order."""
    builder = _EquationBuilder(linkage, solution_rank(linkage, groups))
    return [*(builder.driving(driver) for driver in linkage.cranks), *(builder.group(group) for group in groups)]


def motion_points(linkage: Linkage, link: str) -> list[str]:
    """Return the points that determine the motion of a link: those it shares with others, or all if fewer than
    two.
    """
    points = list(linkage.links[link].points)
    shared = {h.point for h in linkage.hinges if link in h.links}
    running = {s.at for s in linkage.slides if s.runner == link}
    joints = [p for p in points if p in shared or linkage.local(link, p) in running]
    return joints if len(joints) > 1 else points


def solution_rank(linkage: Linkage, groups: Iterable[Group]) -> dict[str, int]:
    """Return when each named point is solved: -1 on the frame, 0 on driving links, then the number of its first
    group.
    """
    rank = {FRAME: -1} | {driver.link: 0 for driver in linkage.cranks}
    rank |= {link: number for number, group in enumerate(groups, 1) for link in group.links}
    points = {point for link in linkage.links.values() for point in link.points}
    return {point: min(rank.get(link, len(rank)) for link in linkage.carriers(point)) for point in points}


class _EquationBuilder:
    """Builds the equations step by step, with what is known so far.

    turns: for each link the first link that rotates with it. known: such first links with known rotation.
    slid: names of prismatic pairs with known motion.
    """

    def __init__(self, linkage: Linkage, rank: Mapping[str, int]) -> None:
        self.linkage, self.rank = linkage, rank
        self.turns = {link: link for link in linkage.links}
        for slide in linkage.slides:
            earlier, other = sorted(
                (self.turns[slide.carrier], self.turns[slide.runner]), key=list(linkage.links).index
            )
            self.turns = {link: earlier if first == other else first for link, first in self.turns.items()}
        self.known = {FRAME}
        self.slid: set[str] = set()

    def driving(self, driver: Driver) -> SolutionStep:
        """Return the step of the solution for a link driven from the frame."""
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
        """Return the step of a group whose external pairs have known motion."""
        before = [link for link in self.turns if self.turns[link] in self.known]
        for driver in group.drivers:
            if driver.kind == "slide":
                self.slid.add(driver.joint)
            else:
                self.known.add(self.turns[driver.link])
        ratios = self._ratios(group)
        spots = {link: self._of_group(group, link) for link in group.links}
        base = {link: min(link_points, key=self._order) for link, link_points in spots.items() if link_points}
        equations: list[VectorEquation] = [
            self._about(spot, base[link], link) for link in base for spot in spots[link] if spot != base[link]
        ]
        equations += self._of_slides(group)
        turned = {self.turns[link] for link in group.links} - self.known
        unknown = len(turned) + sum(not e.known for e in equations if not isinstance(e, SameLinkEquation))
        self.known |= turned
        self.slid |= {pair.slide.name for pair in (*group.inner, *group.outer) if pair.slide is not None}
        solved = [spot.name for link_points in spots.values() for spot in link_points]
        after = [about for link in base for about in self._others(link, base[link], solved)]
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
        """Point of a link that determines its motion along a guide of the frame."""
        if slide.runner == link and slide.point in self.linkage.links[link].points:
            return self._spot(slide.point)
        return self._spot(next(iter(self.linkage.links[link].points)))

    def _order(self, spot: PlanPoint) -> float:
        return -1 if spot.fixed else self.rank[spot.at] if spot.name == spot.at else float("inf")

    def _of_group(self, group: Group, link: str) -> list[PlanPoint]:
        """Return the points at which a link is paired within its group, in the order in which they are solved."""
        points: list[PlanPoint] = []
        for pair in (*group.outer, *group.inner):
            if link not in (pair.i, pair.j) or not pair.lower:
                continue
            slide = pair.slide
            if slide is None:
                points.append(self._spot(pair.point))
            elif FRAME in (slide.carrier, slide.runner):
                points.append(self._running(link, slide))
            else:
                points.append(self._spot(slide.point) if link == slide.runner else coincident_point(slide))
        return sorted(dict.fromkeys(points), key=self._order)

    def _about(self, point: PlanPoint, base: PlanPoint, link: str) -> SameLinkEquation:
        return SameLinkEquation(point, base, link, self.turns[link] in self.known, self.turns[link] == FRAME)

    def _of_slides(self, group: Group) -> Iterable[VectorEquation]:
        for slide in (pair.slide for pair in (*group.outer, *group.inner) if pair.slide is not None):
            solved = slide.name in self.slid
            if FRAME in (slide.carrier, slide.runner):
                yield FixedGuideEquation(
                    self._running(slide.runner if slide.carrier == FRAME else slide.carrier, slide), slide, solved
                )
                continue
            if slide.carrier not in group.links:  # its guide is known as a whole
                points = motion_points(self.linkage, slide.carrier)
                yield self._about(coincident_point(slide), min(map(self._spot, points), key=self._order), slide.carrier)
            yield MovingGuideEquation(self._spot(slide.point), coincident_point(slide), slide, solved)

    def _others(self, link: str, base: PlanPoint, solved: Collection[str]) -> tuple[SameLinkEquation, ...]:
        """Equations of further points of a link, without free ends of cylinders and oscillating rods."""
        points = [p for p in motion_points(self.linkage, link) if p not in solved and p != base.name]
        if not base.fixed and any(link in (slide.carrier, slide.runner) for slide in self.linkage.slides):
            running = {slide.point for slide in self.linkage.slides}
            points = [p for p in points if len(self.linkage.carriers(p)) > 1 or p in running]
        return tuple(self._about(self._spot(p), base, link) for p in points if not self._spot(p).fixed)

    def _same(self, group: Group, before: Collection[str]) -> tuple[tuple[str, ...], ...]:
        """Return links of the group that rotate together, after one that was known before."""
        rotating = []
        for first in dict.fromkeys(self.turns[link] for link in group.links):
            earlier = [link for link in before if self.turns[link] == first][:1]
            links = [*earlier, *(link for link in group.links if self.turns[link] == first)]
            if first != FRAME and len(links) > 1:
                rotating.append(tuple(links))
        return tuple(rotating)

    def _ratios(self, group: Group) -> tuple[HigherPairRatio, ...]:
        """Return higher pairs of the group with a single unknown, in the order in which they can be used."""
        meshes = [pair.mesh for pair in (*group.outer, *group.inner) if pair.mesh is not None]
        ratios: list[HigherPairRatio] = []
        for _ in meshes:
            for mesh in meshes:
                slide = self.linkage.slide(mesh.slide) if mesh.slide else None
                wheels = (mesh.i, mesh.carrier) if slide is not None else (mesh.i, mesh.j, mesh.carrier)
                links = [link for link in wheels if self.turns[link] not in self.known]
                slides = [] if slide is None or slide.name in self.slid else [slide]
                if len(links) + len(slides) == 1 and mesh not in [ratio.mesh for ratio in ratios]:
                    ratios.append(HigherPairRatio(mesh, links[0]) if links else HigherPairRatio(mesh, slide=slides[0]))
                    self.known |= {self.turns[link] for link in links}
                    self.slid |= {s.name for s in slides}
        return tuple(ratios)


def coincident_point(slide: Slide) -> PlanPoint:
    """Return the point of a moving guide that coincides with its sliding block."""
    return PlanPoint(f"{slide.point}{slide.carrier}", slide.point, slide.carrier)
