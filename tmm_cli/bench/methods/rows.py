"""Equations of pairs as rows, and their derivatives by the places of links: of all pairs at once, or of those cut open.

E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, ch. 3; J. Garcia de Jalon, E. Bayo, Kinematic
and Dynamic Simulation of Multibody Systems, ch. 2 and 3.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tmm_cli.groups.state import Drives, Poses, Rates
from tmm_cli.linkage import Linkage
from tmm_cli.pairs import PAIRS
from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.driven import Driven
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Rows:
    """Two rows a pair, then the driver's if it is one of them. size (m): what lengths are counted in."""

    linkage: Linkage
    pairs: tuple[Pair, ...]
    driven: bool = False
    size: float = 1.0

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What each pair, and the driver, asks of its links."""
        found = tuple(PAIRS[pair.kind](pair, self.linkage) for pair in self.pairs)
        return (*found, Driven.of(self.linkage.driver, self.linkage)) if self.driven else found

    @cached_property
    def scale(self) -> Real:
        """What makes each row a pure number."""
        return np.array([1 / self.size if length else 1.0 for c in self.constraints for length in c.lengths])

    def residuals(self, poses: Poses, drives: Drives) -> Real:
        """What each row is short of zero, (positions, rows)."""
        return np.stack([row for c in self.constraints for row in c.residuals(poses, drives)], axis=-1) * self.scale

    def matrix(self, poses: Poses) -> Real:
        """Derivatives by x, y and angle of each moving link, (positions, rows, 3 links)."""
        first = {name: 3 * k for k, name in enumerate(self.linkage.moving)}
        J = np.zeros((len(poses[self.linkage.driver.link].x), len(self.scale), 3 * len(first)))
        for number, constraint in enumerate(self.constraints):
            for link, parts in constraint.jacobian_rows(poses).items():
                if link in first:
                    at = first[link]
                    for row, (along, around) in enumerate(parts, 2 * number):
                        J[:, row, at], J[:, row, at + 1], J[:, row, at + 2] = along.real, along.imag, around
        return J * self.scale[:, None]

    def velocity_terms(self, poses: Poses, rates: Rates) -> Real:
        """Second derivatives when no link accelerates, (positions, rows)."""
        return np.stack([row for c in self.constraints for row in c.velocity_terms(poses, rates)], axis=-1) * self.scale

    def reactions(self, poses: Poses, multipliers: Real) -> dict[str, Vector]:
        """Multipliers as forces on the second link of each pair, N."""
        found: dict[str, Vector] = {}
        pushes = list(np.moveaxis(multipliers * self.scale, -1, 0))
        for number, (pair, constraint) in enumerate(zip(self.pairs, self.constraints, strict=False)):
            force = constraint.reaction(poses, pushes[2 * number : 2 * number + 2]).force
            found[pair.name] = force if pair.j == constraint.links[1] else -force
        return found


def by_links(linkage: Linkage, parts: Mapping[str, tuple[Vector, Real]]) -> Real:
    """A vector and a number of each moving link, of its origin and its angle, in the columns of the matrix."""
    found = [part for at, around in map(parts.__getitem__, linkage.moving) for part in (at.real, at.imag, around)]
    return np.stack(found, axis=-1)
