"""Layout of a scheme: dimensions in whole millimetres with which its groups can be assembled, chosen at random.

All lengths are in mm and all angles in degrees, as in the problem file; only the angles of link axes are in radians.
The first crank has the direction CRANK_AT[0]. Cranks are short, so that they are likely to rotate fully.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import combinations
from random import Random

from tmm_cli.mechanics.numerics import cross
from tmm_cli.synthesis.schemes.schemes import PlacedGroup, Scheme

CRANK, CRANK_AT = 60, (60, 120, 30)  # mm; deg, of the first, second and third crank
LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"  # O is the crank's pivot, and I looks like 1
NEAREST = 30  # mm: closer points cannot be distinguished in a drawing
LONGEST = 420  # mm: longer than the links of course projects
WEIGHT = 3.0  # a transmission angle of 0 costs as much as this length of links (m)


@dataclass(frozen=True)
class PrismaticLayout:
    """Dimensions of a prismatic pair: a point of the runner moves along a line of the carrier.

    Attributes:
        carrier, runner: numbers of the link with the guide and of the link that slides.
        through, angle: a point (complex, mm) and the direction (deg) of the line in the carrier's axes.
        point: name of the runner's point.
    """

    carrier: int
    runner: int
    through: complex
    angle: int
    point: str


@dataclass(frozen=True)
class SchemeLayout:
    """Dimensions of a scheme, and its sketch.

    Attributes:
        points: points of each link in its own axes (complex, mm), by link and name; the points of the frame are in the
            axes of the drawing.
        slides: prismatic pairs.
        places: points of the moving links in the sketch (complex, mm), by name.
        angles: angles in the sketch (deg) of the slotted links of RPR groups, by link.
        cranks: crank angles in the sketch (deg).
        cost: rating of the layout; lower is better.
    """

    points: dict[int, dict[str, complex]]
    slides: tuple[PrismaticLayout, ...]
    places: dict[str, complex]
    angles: dict[int, int]
    cranks: tuple[int, ...]
    cost: float


class UnfitLayout(Exception):  # noqa: N818
    """Raised if a random layout cannot be used, e.g. because a link would be too long."""


@dataclass
class LayoutDraft:
    """A layout while its links are being placed one after another; a subclass places the groups.

    Attributes:
        scheme: the scheme.
        random: random number generator.
        points: points of each link (complex, mm), by link and name.
        axis_angle: angle of each link's x axis (rad), by link.
        slides: prismatic pairs: carrier, runner, point of the guide (complex, mm), its direction (rad), name of the
            point.
        slotted_links: slotted links of RPR groups.
        penalties: penalties of the groups.
        names: letters for further points.
    """

    scheme: Scheme
    random: Random
    points: dict[int, dict[str, complex]] = field(default_factory=dict)
    axis_angle: dict[int, float] = field(default_factory=dict)
    slides: list[tuple[int, int, complex, float, str]] = field(default_factory=list)
    slotted_links: list[int] = field(default_factory=list)
    penalties: list[float] = field(default_factory=list)
    names: Iterator[str] = field(default_factory=lambda: iter(LETTERS))

    @property
    def cranks(self) -> range:
        return range(1, self.scheme.cranks + 1)

    def pivot(self, crank: int) -> complex:
        """Return the pivot of a crank on the frame (complex, mm)."""
        return next(iter(self.points[crank].values()))

    # --- random choices

    def random_vector(self, shortest: float, longest: float, low: float = 0.0, high: float = 360.0) -> complex:
        """Return a random vector (complex, mm) with its length (mm) and direction (deg) within limits."""
        angle = math.radians(self.random.uniform(low, high))
        return cmath.rect(self.random.uniform(shortest, longest), angle)

    def random_side(self) -> int:
        return self.random.choice((1, -1))

    # --- links

    def place_link(self, link: int, turn: float, **points: complex) -> None:
        """Place a link whose axes are rotated by `turn` (rad); its first point is the origin of its axes."""
        self.axis_angle[link] = turn
        self.points[link] = dict(points)

    def place_bar(self, link: int, first: str, A: complex, second: str, B: complex) -> None:
        """Place a link with two hinges; its x axis points from the first to the second."""
        self.place_link(link, cmath.phase(B - A), **{first: A, second: B})

    def new_hinge(self, link: int) -> complex | None:
        """Return a point (complex, mm) for another hinge of a link; None for the frame, which can have hinges
        anywhere.
        """
        points = list(self.points[link].values())
        if link == 0:
            return None
        if link in self.cranks:
            first = len(points) == 1
            return points[0] + cmath.rect(CRANK, self.axis_angle[link]) * (
                1 if first else self.random_vector(1, 1, 70, 290)
            )
        if len(points) == 1:
            return points[0] + self.random_vector(60, 140)
        A, B = self.random.sample(points, 2)
        along = (B - A) / max(abs(B - A), 1.0)
        if self.random.random() < 0.5:
            return B + along * self.random.uniform(50, 140)
        return (A + B) / 2 + 1j * along * self.random_side() * self.random.uniform(60, 140)

    def centre_of(self, link: int) -> complex | None:
        """Return the mean of the points of a link (complex, mm); None for the frame."""
        points = list(self.points[link].values())
        return None if link == 0 else sum(points) / len(points)

    def new_hinges(self, X: int, Y: int, shortest: float, longest: float) -> tuple[complex, complex]:
        """Return points (complex, mm) for a hinge on each of two links.

        A hinge on the frame is placed at a random distance (mm) from the other one.
        """
        A, B = self.new_hinge(X), self.new_hinge(Y)
        if A is None:
            assert B is not None
            A = B + self.random_vector(shortest, longest)
        elif B is None:
            B = A + self.random_vector(shortest, longest)
        return A, B

    def guide_direction(self, carrier: int, turn: float, spread: float) -> float:
        """Return a random direction (rad) for a guide.

        Args:
            carrier: link with the guide. The direction is rounded to 15 degrees on the frame, to 1 degree on other
                links.
            turn: mean direction (rad).
            spread: largest deviation from it (deg).
        """
        turn += math.radians(self.random.uniform(-spread, spread))
        step = math.radians(15 if carrier == 0 else 1)
        return self.axis_angle[carrier] + step * round((turn - self.axis_angle[carrier]) / step)

    def add_slide(self, carrier: int, runner: int, through: complex, turn: float, point: str) -> None:
        self.slides.append((carrier, runner, through, turn, point))

    def add_transmission_penalty(self, transmission: float) -> None:
        """Add the penalty of a group for the sine of its transmission angle. Raises UnfitLayout if the sine is less
        than 0.5.
        """
        if abs(transmission) < 0.5:
            raise UnfitLayout
        self.penalties.append((1 - min(1.0, abs(transmission))) ** 2)

    def add_reserve_penalty(self, reserve: float) -> None:
        """Add the penalty of a group for its remaining range of motion (mm).

        There is no penalty if this range is at least the diameter of the crank circle.
        """
        self.penalties.append((1 - max(0.0, min(1.0, reserve / (2 * CRANK)))) ** 2)

    def name_hinge(self, link: int, place: complex) -> str:
        """Add a hinge with a new name to an existing link, and return the name."""
        name = next(self.names)
        self.points[link][name] = complex(round(place.real), round(place.imag)) if link == 0 else place
        return name

    # --- dimensions

    def to_layout(self) -> SchemeLayout:
        """Round the draft to whole millimetres and degrees.

        Raises:
            UnfitLayout: a link is too long, or two points are too close together.
        """
        all_points = {name: place for points in self.points.values() for name, place in points.items()}
        if any(abs(p - q) < NEAREST for p, q in combinations(all_points.values(), 2)):
            raise UnfitLayout
        spans = [
            max((abs(p - q) for p, q in combinations(points.values(), 2)), default=0.0)
            for link, points in self.points.items()
            if link
        ]
        if max(spans) > LONGEST:
            raise UnfitLayout
        points = {
            link: {name: self.to_link_axes(link, place) for name, place in link_points.items()}
            for link, link_points in self.points.items()
        }
        slides = tuple(
            PrismaticLayout(
                carrier,
                runner,
                self.to_link_axes(carrier, through),
                _wrap_line_angle(round(math.degrees(turn - self.axis_angle[carrier]))),
                point,
            )
            for carrier, runner, through, turn, point in self.slides
        )
        moving = {name: round_to_mm(place) for name, place in all_points.items() if name not in self.points[0]}
        angles = {link: round(math.degrees(self.axis_angle[link])) for link in self.slotted_links}
        cranks = tuple(CRANK_AT[crank - 1] for crank in self.cranks)
        return SchemeLayout(points, slides, moving, angles, cranks, sum(spans) / 1000 + WEIGHT * sum(self.penalties))

    def to_link_axes(self, link: int, place: complex) -> complex:
        """Return a point in the axes of a link, rounded to whole millimetres."""
        origin = next(iter(self.points[link].values())) if link else 0j
        return round_to_mm((place - origin) * cmath.rect(1, -self.axis_angle[link]))


def round_to_mm(place: complex) -> complex:
    """Round the coordinates of a point to whole millimetres."""
    return complex(round(place.real), round(place.imag))


def _wrap_line_angle(angle: int) -> int:
    """Return the direction of a line between -90 (excluded) and 90 degrees."""
    return 90 - (90 - angle) % 180


# Layout of a scheme: links are placed in assembled position; their dimensions follow, in whole millimetres.
#
# Many layouts are tried from one seed, so that a scheme always has the same ones; they are sorted by the
# transmission angles of their groups and the lengths of their links.


TRIALS = 250


def find_layouts(scheme: Scheme, seed: int = 1) -> tuple[SchemeLayout, ...]:
    """Return layouts of a scheme, best first. The same seed always gives the same layouts."""
    random = Random(seed)
    layouts = (_GroupPlacer(scheme, random).place_groups() for _ in range(TRIALS))
    return tuple(sorted((x for x in layouts if x is not None), key=lambda layout: layout.cost))


class _GroupPlacer(LayoutDraft):
    """Layout in progress that places the groups of the scheme one after another, with a method for each type of
    group.
    """

    def place_groups(self) -> SchemeLayout | None:
        self.points, self.axis_angle = {0: {}}, {0: 0.0}
        pivot = 0j
        for crank in self.cranks:
            name = "O" if crank == 1 else f"O{crank}"
            pivot = 0j if crank == 1 else round_to_mm(pivot + self.random_vector(220, 320, -25, 25))
            self.points[0][name] = pivot
            self.points[crank] = {name: pivot}
            self.axis_angle[crank] = math.radians(CRANK_AT[crank - 1])
        build = {
            "RRR": self.rrr,
            "RRP": self.rrp,
            "RPR": self.rpr,
            "PRP": self.prp,
            "RPP": self.rpp,
            "III": self.iii,
            "IV": self.iv,
        }
        try:
            for group in self.scheme.groups:
                build[group.type.name](group)
            return self.to_layout()
        except UnfitLayout:
            return None

    def rrr(self, group: PlacedGroup) -> None:
        (a, b), (X, Y) = group.links, _find_supporting_links(group)
        A, C = self.new_hinges(X, Y, 200, 380)
        base = C - A
        B = A + base * complex(self.random.uniform(0.2, 0.8), self.random_side() * self.random.uniform(0.35, 0.9))
        nA, nB, nC = self.name_hinge(X, A), next(self.names), self.name_hinge(Y, C)
        self.place_bar(a, nA, A, nB, B)
        self.place_bar(b, nC, C, nB, B)
        self.add_transmission_penalty(cross(B - A, B - C) / (abs(B - A) * abs(B - C)))
        legs = abs(B - A), abs(B - C)
        self.add_reserve_penalty(min(sum(legs) - abs(base), abs(base) - abs(legs[0] - legs[1])))

    def rrp(self, group: PlacedGroup) -> None:
        (a, b), (X, Y) = group.links, _find_supporting_links(group)
        A, middle = self.new_hinge(X), self.centre_of(Y)
        if middle is not None:
            if A is None:
                A = middle + self.random_vector(40, 300)
            B = A + self.random_vector(160, 300) if self.random.random() < 0.5 else middle + self.random_vector(40, 150)
        else:
            assert A is not None
            B = A + self.random_vector(160, 300)
        turn = self.guide_direction(Y, cmath.phase(B - A), 30)
        nA, nB = self.name_hinge(X, A), next(self.names)
        self.place_bar(a, nA, A, nB, B)
        self.place_link(b, self.axis_angle[Y], **{nB: B})
        self.add_slide(Y, b, B, turn, nB)
        self.add_transmission_penalty(math.cos(cmath.phase(B - A) - turn))
        # distance from the guide, also for a guide on a rotating crank
        along = cmath.rect(1, turn)
        off = abs(cross(along, A - B))
        if Y in self.cranks:
            off = abs(A - self.pivot(Y)) + abs(cross(along, B - self.pivot(Y)))
        self.add_reserve_penalty(abs(B - A) - off)

    def rpr(self, group: PlacedGroup) -> None:
        (a, b), (X, Y) = group.links, _find_supporting_links(group)
        A, B = self.new_hinges(X, Y, 140, 260)
        nA, nB = self.name_hinge(X, A), self.name_hinge(Y, B)
        turn = cmath.phase(A - B)
        self.place_link(a, turn, **{nA: A})
        self.place_link(b, turn, **{nB: B})
        self.add_slide(b, a, B, turn, nA)
        self.slotted_links.append(b)
        self.add_transmission_penalty(abs(A - B) / (2 * CRANK))

    def prp(self, group: PlacedGroup) -> None:
        (a, b), (X, Y) = group.links, _find_supporting_links(group)
        middles = [x for x in (self.centre_of(X), self.centre_of(Y)) if x is not None]
        C = sum(middles) / len(middles) + self.random_vector(60, 220)
        leading, other = (X, Y) if X in self.cranks or (Y not in self.cranks and X > Y) else (Y, X)
        slotted = leading in self.cranks
        if slotted:  # the slot of a slotted crank passes through its pivot
            C = self.pivot(leading) + cmath.rect(self.random.uniform(120, 260), self.axis_angle[leading])
        turns = {leading: self.axis_angle[leading] if slotted else self.guide_direction(leading, 0, 180)}
        turns[other] = self.guide_direction(other, turns[leading] + math.pi / 2, 35)
        name = next(self.names)
        for link, support in ((a, X), (b, Y)):
            self.place_link(link, self.axis_angle[support], **{name: C})
            self.add_slide(support, link, C, turns[support], name)
        self.add_transmission_penalty(math.sin(turns[X] - turns[Y]))

    def rpp(self, group: PlacedGroup) -> None:
        (a, b), (X, Y) = group.links, _find_supporting_links(group)
        A, middle = self.new_hinge(X), self.centre_of(Y)
        if A is None:
            assert middle is not None
            A = middle + self.random_vector(80, 220)
        along = self.guide_direction(Y, 0, 180)
        across = along + math.pi / 2 + math.radians(self.random.choice((-30, -15, 0, 0, 0, 15, 30)))
        E = A + cmath.rect(self.random.uniform(50, 130), across)
        nA, nE = self.name_hinge(X, A), next(self.names)
        self.place_link(a, self.axis_angle[Y], **{nA: A})
        self.place_link(b, self.axis_angle[Y], **{nE: E})
        self.add_slide(b, a, E, across, nA)
        self.add_slide(Y, b, E, along, nE)
        self.add_transmission_penalty(math.sin(across - along))

    def iii(self, group: PlacedGroup) -> None:
        held = _find_supporting_links(group)
        ends, names = [], []
        for link in held:
            end = self.new_hinge(link)
            ends.append(end)
            names.append("" if end is None else self.name_hinge(link, end))
        placed_ends = [end for end in ends if end is not None]
        middle = sum(placed_ends) / len(placed_ends) + self.random_vector(120, 260)
        start = self.random.uniform(0, 360)
        corners = [middle + self.random_vector(60, 90, start + 120 * k, start + 120 * k) for k in range(3)]
        outer = [
            end if end is not None else corner + self.random_vector(120, 240)
            for end, corner in zip(ends, corners, strict=True)
        ]
        ternary, *legs = group.links
        inner = {next(self.names): corner for corner in corners}
        self.place_link(ternary, cmath.phase(corners[1] - corners[0]), **inner)
        for leg, A, at, (name, B) in zip(legs, outer, names, inner.items(), strict=True):
            self.place_bar(leg, at or self.name_hinge(0, A), A, name, B)
        # the ternary link is in a dead position if the lines of its legs meet in one point
        ways = [(corner - A) / abs(corner - A) for corner, A in zip(corners, outer, strict=True)]
        rows = [(w.real, w.imag, cross(c - middle, w) / 75) for w, c in zip(ways, corners, strict=True)]
        self.add_transmission_penalty(_compute_determinant(rows))

    def iv(self, group: PlacedGroup) -> None:
        first, left, second, right = group.links
        X, Y = _find_supporting_links(group)
        P, Q = self.new_hinges(X, Y, 300, 380)
        along = math.degrees(cmath.phase(Q - P))
        A, D = (
            P + self.random_vector(80, 150, along + 30, along + 100),
            P + self.random_vector(80, 150, along - 60, along - 10),
        )
        B, C = (
            Q + self.random_vector(80, 150, along + 100, along + 150),
            Q + self.random_vector(80, 150, along + 190, along + 250),
        )
        nP, nA, nB, nC, nD, nQ = self.name_hinge(X, P), *(next(self.names) for _ in range(4)), self.name_hinge(Y, Q)
        self.place_link(first, cmath.phase(A - P), **{nP: P, nA: A, nD: D})
        self.place_bar(left, nA, A, nB, B)
        self.place_link(second, cmath.phase(B - Q), **{nQ: Q, nB: B, nC: C})
        self.place_bar(right, nD, D, nC, C)


def _find_supporting_links(group: PlacedGroup) -> list[int]:
    """Return the links to which a group is attached, in the order of its external pairs."""
    return [support for support, _, _ in group.outer]


def _compute_determinant(rows: list[tuple[float, float, float]]) -> float:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
