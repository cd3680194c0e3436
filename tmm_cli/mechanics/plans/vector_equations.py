"""Vector equations of velocities and accelerations, as solved on paper: for the driving links, then group by
group.

An equation relates two points of one link, or a sliding block and the coincident point of its guide. Which
magnitudes are known before a group is solved, and how many are unknown, follows from the structure alone.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Mesh, Slide
from tmm_cli.mechanics.structure import Group

MOST_UNKNOWNS = 2  # unknown magnitudes that one vector polygon can give


@dataclass(frozen=True)
class PlanPoint:
    """Point on a velocity or acceleration plan.

    Attributes:
        name: its name, e.g. A, or A3 for the point of link 3 that coincides with A.
        at: name of the point with which it coincides: A for A3, and A for A itself.
        link: the link to which it belongs; the frame if it does not move.
    """

    name: str
    at: str
    link: str

    @property
    def fixed(self) -> bool:
        return self.link == FRAME


@dataclass(frozen=True)
class SameLinkEquation:
    """Vector equation that gives the motion of a point from that of another point (`base`) of the same link.

    known: True if the angular velocity of the link is known. idle: True if the link does not rotate, so that
    both points have the same velocity.
    """

    point: PlanPoint
    base: PlanPoint
    link: str
    known: bool
    idle: bool


@dataclass(frozen=True)
class MovingGuideEquation:
    """Vector equation that gives the motion of a sliding block from that of the coincident point (`base`) of its
    moving guide.

    known: True if the sliding motion is known.
    """

    point: PlanPoint
    base: PlanPoint
    slide: Slide
    known: bool


@dataclass(frozen=True)
class FixedGuideEquation:
    """Vector equation of a point that moves along a guide of the frame.

    known: True if the motion along the guide is known.
    """

    point: PlanPoint
    slide: Slide
    known: bool


VectorEquation = SameLinkEquation | MovingGuideEquation | FixedGuideEquation


@dataclass(frozen=True)
class HigherPairRatio:
    """Higher pair whose ratio gives the rotation of a link, or the motion in a prismatic pair."""

    mesh: Mesh
    link: str = ""
    slide: Slide | None = None


@dataclass(frozen=True)
class SolutionStep:
    """One step of the solution: a link driven from the frame, or an Assur group with the drivers between its
    links.

    Attributes:
        links: the links.
        drivers: their drivers.
        group: the group; None for a link driven from the frame.
        ratios: ratios of higher pairs, used before the equations.
        equations: equations that are solved simultaneously.
        after: equations of further points of the links, solved afterwards.
        same: sets of links that rotate together; the first may be a link solved in an earlier step.
        on_paper: True if one vector polygon gives all unknown magnitudes.
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
    """Return the steps of the solution: the links driven from the frame, then the groups in solution order."""
    builder = _EquationBuilder(linkage, solution_rank(linkage, groups))
    return [
        *(builder.driving_step(driver) for driver in linkage.cranks),
        *(builder.group_step(group) for group in groups),
    ]


def motion_points(linkage: Linkage, link: str) -> list[str]:
    """Return the points of a link for which vector equations are written.

    They are the points at which it is paired with other links, or all points if there are fewer than two.
    """
    points = list(linkage.links[link].points)
    shared = {h.point for h in linkage.hinges if link in h.links}
    running = {s.at for s in linkage.slides if s.runner == link}
    joints = [p for p in points if p in shared or linkage.local(link, p) in running]
    return joints if len(joints) > 1 else points


def solution_rank(linkage: Linkage, groups: Iterable[Group]) -> dict[str, int]:
    """Return, for each named point, the number of the step in which its motion becomes known.

    It is -1 for points of the frame, 0 for points of driving links, and for all others the number of the first group
    with this point.
    """
    rank = {FRAME: -1} | {driver.link: 0 for driver in linkage.cranks}
    rank |= {link: number for number, group in enumerate(groups, 1) for link in group.links}
    points = {point for link in linkage.links.values() for point in link.points}
    return {point: min(rank.get(link, len(rank)) for link in linkage.carriers(point)) for point in points}


class _EquationBuilder:
    """Builds the vector equations step by step, and records which motions are already known.

    Each set of links that rotate together is represented by its first link.

    Attributes:
        linkage: the linkage.
        rank: result of `solution_rank`.
        turns: representative of each link.
        known: representatives of the links whose rotation is known.
        slid: names of the prismatic pairs whose motion is known.
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

    def driving_step(self, driver: Driver) -> SolutionStep:
        link = driver.link
        self.known.add(self.turns[link])
        if driver.kind == "turn":
            return SolutionStep(
                (link,), (driver,), after=self._further_points(link, self._plan_point(driver.joint), ())
            )
        slide = self.linkage.slide(driver.joint)
        self.slid.add(slide.name)
        base = self._sliding_point(link, slide)
        after = self._further_points(link, base, (base.name,))
        return SolutionStep((link,), (driver,), equations=(FixedGuideEquation(base, slide, True),), after=after)

    def group_step(self, group: Group) -> SolutionStep:
        """Return the step of the solution for a group. The motion of the links to which it is attached must be
        known.
        """
        before = [link for link in self.turns if self.turns[link] in self.known]
        for driver in group.drivers:
            if driver.kind == "slide":
                self.slid.add(driver.joint)
            else:
                self.known.add(self.turns[driver.link])
        ratios = self._usable_ratios(group)
        spots = {link: self._paired_points(group, link) for link in group.links}
        base = {link: min(link_points, key=self._solution_order) for link, link_points in spots.items() if link_points}
        equations: list[VectorEquation] = [
            self._relate_points(spot, base[link], link) for link in base for spot in spots[link] if spot != base[link]
        ]
        equations += self._slide_equations(group)
        turned = {self.turns[link] for link in group.links} - self.known
        unknown = len(turned) + sum(not e.known for e in equations if not isinstance(e, SameLinkEquation))
        self.known |= turned
        self.slid |= {pair.slide.name for pair in (*group.inner, *group.outer) if pair.slide is not None}
        solved = [spot.name for link_points in spots.values() for spot in link_points]
        after = [about for link in base for about in self._further_points(link, base[link], solved)]
        return SolutionStep(
            group.links,
            group.drivers,
            group,
            ratios,
            tuple(equations),
            tuple(after),
            self._links_rotating_together(group, before),
            unknown <= MOST_UNKNOWNS,
        )

    def _plan_point(self, point: str) -> PlanPoint:
        return PlanPoint(point, point, FRAME if FRAME in self.linkage.carriers(point) else self.linkage.owner(point))

    def _sliding_point(self, link: str, slide: Slide) -> PlanPoint:
        """Return the point that represents the motion of a link along a guide of the frame."""
        if slide.runner == link and slide.point in self.linkage.links[link].points:
            return self._plan_point(slide.point)
        return self._plan_point(next(iter(self.linkage.links[link].points)))

    def _solution_order(self, spot: PlanPoint) -> float:
        return -1 if spot.fixed else self.rank[spot.at] if spot.name == spot.at else float("inf")

    def _paired_points(self, group: Group, link: str) -> list[PlanPoint]:
        """Return the points at which a link of a group is paired, in the order in which their motion becomes known."""
        points: list[PlanPoint] = []
        for pair in (*group.outer, *group.inner):
            if link not in (pair.i, pair.j) or not pair.lower:
                continue
            slide = pair.slide
            if slide is None:
                points.append(self._plan_point(pair.point))
            elif FRAME in (slide.carrier, slide.runner):
                points.append(self._sliding_point(link, slide))
            else:
                points.append(self._plan_point(slide.point) if link == slide.runner else coincident_point(slide))
        return sorted(dict.fromkeys(points), key=self._solution_order)

    def _relate_points(self, point: PlanPoint, base: PlanPoint, link: str) -> SameLinkEquation:
        return SameLinkEquation(point, base, link, self.turns[link] in self.known, self.turns[link] == FRAME)

    def _slide_equations(self, group: Group) -> Iterable[VectorEquation]:
        for slide in (pair.slide for pair in (*group.outer, *group.inner) if pair.slide is not None):
            solved = slide.name in self.slid
            if FRAME in (slide.carrier, slide.runner):
                yield FixedGuideEquation(
                    self._sliding_point(slide.runner if slide.carrier == FRAME else slide.carrier, slide), slide, solved
                )
                continue
            if slide.carrier not in group.links:  # the motion of its guide is already known
                points = motion_points(self.linkage, slide.carrier)
                yield self._relate_points(
                    coincident_point(slide), min(map(self._plan_point, points), key=self._solution_order), slide.carrier
                )
            yield MovingGuideEquation(self._plan_point(slide.point), coincident_point(slide), slide, solved)

    def _further_points(self, link: str, base: PlanPoint, solved: Collection[str]) -> tuple[SameLinkEquation, ...]:
        """Return the equations of the points of a link whose motion the preceding equations do not give.

        Free ends of cylinders and oscillating rods are left out.
        """
        points = [p for p in motion_points(self.linkage, link) if p not in solved and p != base.name]
        if not base.fixed and any(link in (slide.carrier, slide.runner) for slide in self.linkage.slides):
            running = {slide.point for slide in self.linkage.slides}
            points = [p for p in points if len(self.linkage.carriers(p)) > 1 or p in running]
        return tuple(
            self._relate_points(self._plan_point(p), base, link) for p in points if not self._plan_point(p).fixed
        )

    def _links_rotating_together(self, group: Group, before: Collection[str]) -> tuple[tuple[str, ...], ...]:
        """Return the sets of links of a group that rotate together.

        If the rotation of a link in a set was known before, the set begins with that link.
        """
        rotating = []
        for first in dict.fromkeys(self.turns[link] for link in group.links):
            earlier = [link for link in before if self.turns[link] == first][:1]
            links = [*earlier, *(link for link in group.links if self.turns[link] == first)]
            if first != FRAME and len(links) > 1:
                rotating.append(tuple(links))
        return tuple(rotating)

    def _usable_ratios(self, group: Group) -> tuple[HigherPairRatio, ...]:
        """Return the higher pairs of a group whose ratio contains only one unknown motion, in an order in which they
        can be used.
        """
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
