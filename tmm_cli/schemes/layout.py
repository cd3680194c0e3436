"""A pose for a scheme: links put down assembled first, then the dimensions that fit them, in whole millimetres.

Many poses are tried from one seed, so that a scheme has the same poses always; they are put in order by the
transmission angles of their groups and the lengths of their links.
"""

from __future__ import annotations

import cmath
import math
from random import Random

from tmm_cli.schemes.draft import CRANK, CRANK_AT, Draft, SchemeLayout, Unfit, whole
from tmm_cli.schemes.schemes import Placed, Scheme
from tmm_cli.vectors import cross

TRIALS = 250


def layouts(scheme: Scheme, seed: int = 1) -> tuple[SchemeLayout, ...]:
    """Poses of a scheme, the best first."""
    random = Random(seed)
    found = (_GroupByGroup(scheme, random).layout() for _ in range(TRIALS))
    return tuple(sorted((x for x in found if x is not None), key=lambda layout: layout.cost))


class _GroupByGroup(Draft):
    """A pose of the whole scheme, its groups put down one after another."""

    def layout(self) -> SchemeLayout | None:
        self.where, self.turn = {0: {}}, {0: 0.0}
        pivot = 0j
        for crank in self.cranks:
            name = "O" if crank == 1 else f"O{crank}"
            pivot = 0j if crank == 1 else whole(pivot + self.polar(220, 320, -25, 25))
            self.where[0][name] = pivot
            self.where[crank] = {name: pivot}
            self.turn[crank] = math.radians(CRANK_AT[crank - 1])
        build = {"RRR": self.rrr, "RRP": self.rrp, "RPR": self.rpr, "PRP": self.prp, "RPP": self.rpp,
                 "III": self.iii, "IV": self.iv}  # fmt: skip
        try:
            for group in self.scheme.groups:
                build[group.type.name](group)
            return self.measured()
        except Unfit:
            return None

    def rrr(self, group: Placed) -> None:
        (a, b), (X, Y) = group.links, _held(group)
        A, C = self.hinges(X, Y, 200, 380)
        base = C - A
        B = A + base * complex(self.random.uniform(0.2, 0.8), self.side() * self.random.uniform(0.35, 0.9))
        nA, nB, nC = self.name(X, A), next(self.names), self.name(Y, C)
        self.bar(a, nA, A, nB, B)
        self.bar(b, nC, C, nB, B)
        self.lose(cross(B - A, B - C) / (abs(B - A) * abs(B - C)))
        legs = abs(B - A), abs(B - C)
        self.spare(min(sum(legs) - abs(base), abs(base) - abs(legs[0] - legs[1])))

    def rrp(self, group: Placed) -> None:
        (a, b), (X, Y) = group.links, _held(group)
        A, middle = self.hinge(X), self.near(Y)
        if middle is not None:
            if A is None:
                A = middle + self.polar(40, 300)
            B = A + self.polar(160, 300) if self.random.random() < 0.5 else middle + self.polar(40, 150)
        else:
            assert A is not None
            B = A + self.polar(160, 300)
        turn = self.direction(Y, cmath.phase(B - A), 30)
        nA, nB = self.name(X, A), next(self.names)
        self.bar(a, nA, A, nB, B)
        self.link(b, self.turn[Y], **{nB: B})
        self.slide(Y, b, B, turn, nB)
        self.lose(math.cos(cmath.phase(B - A) - turn))
        # off the guide, or off the guide of a crank that turns about its pivot
        along = cmath.rect(1, turn)
        off = abs(cross(along, A - B))
        if Y in self.cranks:
            off = abs(A - self.pivot(Y)) + abs(cross(along, B - self.pivot(Y)))
        self.spare(abs(B - A) - off)

    def rpr(self, group: Placed) -> None:
        (a, b), (X, Y) = group.links, _held(group)
        A, B = self.hinges(X, Y, 140, 260)
        nA, nB = self.name(X, A), self.name(Y, B)
        turn = cmath.phase(A - B)
        self.link(a, turn, **{nA: A})
        self.link(b, turn, **{nB: B})
        self.slide(b, a, B, turn, nA)
        self.slotted.append(b)
        self.lose(abs(A - B) / (2 * CRANK))

    def prp(self, group: Placed) -> None:
        (a, b), (X, Y) = group.links, _held(group)
        middles = [x for x in (self.near(X), self.near(Y)) if x is not None]
        C = sum(middles) / len(middles) + self.polar(60, 220)
        one, other = (X, Y) if X in self.cranks or (Y not in self.cranks and X > Y) else (Y, X)
        slotted = one in self.cranks
        if slotted:  # a slotted crank has its slot through its pivot
            C = self.pivot(one) + cmath.rect(self.random.uniform(120, 260), self.turn[one])
        turns = {one: self.turn[one] if slotted else self.direction(one, 0, 180)}
        turns[other] = self.direction(other, turns[one] + math.pi / 2, 35)
        name = next(self.names)
        for link, known in ((a, X), (b, Y)):
            self.link(link, self.turn[known], **{name: C})
            self.slide(known, link, C, turns[known], name)
        self.lose(math.sin(turns[X] - turns[Y]))

    def rpp(self, group: Placed) -> None:
        (a, b), (X, Y) = group.links, _held(group)
        A, middle = self.hinge(X), self.near(Y)
        if A is None:
            assert middle is not None
            A = middle + self.polar(80, 220)
        along = self.direction(Y, 0, 180)
        across = along + math.pi / 2 + math.radians(self.random.choice((-30, -15, 0, 0, 0, 15, 30)))
        E = A + cmath.rect(self.random.uniform(50, 130), across)
        nA, nE = self.name(X, A), next(self.names)
        self.link(a, self.turn[Y], **{nA: A})
        self.link(b, self.turn[Y], **{nE: E})
        self.slide(b, a, E, across, nA)
        self.slide(Y, b, E, along, nE)
        self.lose(math.sin(across - along))

    def iii(self, group: Placed) -> None:
        held = _held(group)
        ends, names = [], []
        for link in held:
            end = self.hinge(link)
            ends.append(end)
            names.append("" if end is None else self.name(link, end))
        known = [end for end in ends if end is not None]
        middle = sum(known) / len(known) + self.polar(120, 260)
        start = self.random.uniform(0, 360)
        corners = [middle + self.polar(60, 90, start + 120 * k, start + 120 * k) for k in range(3)]
        outer = [end if end is not None else corner + self.polar(120, 240)
                 for end, corner in zip(ends, corners, strict=True)]  # fmt: skip
        ternary, *legs = group.links
        inner = {next(self.names): corner for corner in corners}
        self.link(ternary, cmath.phase(corners[1] - corners[0]), **inner)
        for leg, A, at, (name, B) in zip(legs, outer, names, inner.items(), strict=True):
            self.bar(leg, at or self.name(0, A), A, name, B)
        # the ternary link is lost when the lines of its legs meet in one point
        ways = [(corner - A) / abs(corner - A) for corner, A in zip(corners, outer, strict=True)]
        rows = [(w.real, w.imag, cross(c - middle, w) / 75) for w, c in zip(ways, corners, strict=True)]
        self.lose(_determinant(rows))

    def iv(self, group: Placed) -> None:
        one, left, other, right = group.links
        X, Y = _held(group)
        P, Q = self.hinges(X, Y, 300, 380)
        along = math.degrees(cmath.phase(Q - P))
        A, D = P + self.polar(80, 150, along + 30, along + 100), P + self.polar(80, 150, along - 60, along - 10)
        B, C = Q + self.polar(80, 150, along + 100, along + 150), Q + self.polar(80, 150, along + 190, along + 250)
        nP, nA, nB, nC, nD, nQ = self.name(X, P), *(next(self.names) for _ in range(4)), self.name(Y, Q)
        self.link(one, cmath.phase(A - P), **{nP: P, nA: A, nD: D})
        self.bar(left, nA, A, nB, B)
        self.link(other, cmath.phase(B - Q), **{nQ: Q, nB: B, nC: C})
        self.bar(right, nD, D, nC, C)


def _held(group: Placed) -> list[int]:
    """The links that a group is attached to, in the order of its outer pairs."""
    return [known for known, _, _ in group.outer]


def _determinant(rows: list[tuple[float, float, float]]) -> float:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
