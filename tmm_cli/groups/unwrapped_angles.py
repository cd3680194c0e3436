"""Angles followed through full turns: which of the angles 2 pi apart a link has at each place of the driver.

A toothed wheel's place depends on how often its partner has gone round; nothing else does, so only links that wheels
depend on are followed. A position is still found alone: the number of turns comes from a table made once.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np

from tmm_cli.groups.state import Pose
from tmm_cli.vectors import Real, pi

TAU = 2 * np.pi


@dataclass(frozen=True)
class Winding:
    """Angles of links (rad, unwrapped) at places q of the driver that grow; when closed they go on by full cycles."""

    q: Real
    angles: Mapping[str, Real]
    closed: bool

    def followed(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> tuple[Pose, ...]:
        """The same poses with their angles followed through full turns."""
        found = []
        for link, pose in zip(links, poses, strict=True):
            if link not in self.angles:
                found.append(pose)
                continue
            angle = np.arctan2(pose.z.imag, pose.z.real)
            turned = angle + 2 * pi(angle) * np.round((self._about(link, q) - angle) / TAU)
            found.append(replace(pose, unwrapped=turned))
        return tuple(found)

    def sure(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> Real:
        """Where the table tells the turns of such poses: it is less than a quarter of a turn off."""
        off = [
            np.abs(pose.turned - self._about(n, q)) for n, pose in zip(links, poses, strict=True) if n in self.angles
        ]
        sure: Real = reduce(np.maximum, off) < np.pi / 2
        return sure

    def _about(self, link: str, q: Real) -> Real:
        """The angle of a link at places q, by the table."""
        cycle = self.q[-1] - self.q[0]
        whole = np.floor((q - self.q[0]) / cycle) if self.closed else np.zeros(np.shape(q))
        table = self.angles[link]
        about: Real = np.interp((q - whole * cycle).astype(float), self.q, table) + whole * (table[-1] - table[0])
        return about
