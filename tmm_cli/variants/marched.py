"""Groups that are found by iteration, of many variants at once: Newton's method from the ways of all of them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tmm_cli.assembly.search import CLOSE, sketched_angles
from tmm_cli.groups.base import Kernel, Poses
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.sequence import LinkStates
from tmm_cli.groups.state import Drive, Drives, Pose, State
from tmm_cli.groups.unrolled import Unrolled
from tmm_cli.linkage import Linkage
from tmm_cli.variants.batch import straight
from tmm_cli.variants.marches import CORRECTION, EACH_TURN, Marches, Varied, Ways
from tmm_cli.variants.variant import NoTapeError
from tmm_cli.vectors import Real, unit


@dataclass(frozen=True)
class Marched(Newton):
    """Such a group. lines: the same as straight lines; ways: of its free unknowns, nan where none was found."""

    lines: Unrolled = field(kw_only=True)
    ways: Ways = field(kw_only=True)

    def rebind(self, linkage: Linkage) -> Marched:
        lines = self.lines.rebind(linkage)
        return replace(self, group=lines.group, size=lines.size, constraints=lines.constraints, lines=lines)

    def take(self, rows: Real) -> Marched:
        """Of some variants."""
        return replace(self, ways=self.ways.take(rows))

    def begun(self, poses: Poses, q: Real, drives: Drives) -> tuple[State, Real]:
        posed = self.lines.posed(dict(zip(self.lines.free, self.ways(q), strict=True)), poses, drives)
        parts = [(posed[link].x, posed[link].turned) for link in self.group.links]
        x, turned = (np.stack(np.broadcast_arrays(*part), axis=-1) for part in zip(*parts, strict=True))
        return State(x, turned), np.full(x.shape[:-1], -1.0)

    def kept(self, found: LinkStates) -> Real:
        """Which variants lie along their ways, far from dead positions, and as their sketch surely shows them.

        found: of all variants, (variants, positions), from the place of the sketch on.
        """
        number = [kernel.group for kernel in found.kernels].index(self.group)
        at, later = found.placements[number], {link for k in found.kernels[number:] for link in k.group.links}
        start, _ = self.begun(found.poses, found.q, found.drives)
        z = np.stack([pose.z for pose in at.poses], axis=-1)
        known = {link: Pose(p.x[:, :1], p.z[:, :1]) for link, p in found.poses.items() if link not in later}
        drives = {link: Drive(d.value[:, :1], d.first[:, :1], d.second[:, :1]) for link, d in found.drives.items()}
        shown = sketched_angles(self, found.linkage, known, drives)
        with np.errstate(invalid="ignore"):
            followed = np.all(np.abs(z - unit(start.unwrapped)) < CORRECTION, axis=(1, 2))
            meant = np.all(np.abs(z[:, :1] - (z[:1, :1] if shown is None else unit(shown))) < CLOSE, axis=(1, 2))
            whole: Real = followed & meant & np.all((at.det * at.det[0, 0] > 0) & (at.margin > self.near), axis=1)
        return whole


def marched(varied: Varied, columns: Real, linkage: Linkage, kernels: tuple[Kernel, ...]) -> tuple[Kernel, ...]:
    """The groups of the first variant as those of all, whose numbers are rows of columns; still to be rebound.

    Raises NoTapeError, DependsOnData.
    """
    traces = [kernel.trace for kernel in kernels if isinstance(kernel, Newton) and not kernel.by_angle]
    if not traces:
        return kernels
    lines = straight(linkage, kernels)
    if lines is None or any(trace is None or not trace.closed or trace.dead.size for trace in traces):
        raise NoTapeError
    half = np.full((len(columns), 1), np.pi)
    ways = Marches(varied, columns[0].tolist(), linkage, lines)(columns, -half, half, EACH_TURN, closed=True)
    found: list[Kernel] = []
    first = 0
    for kernel, line in zip(kernels, lines, strict=True):
        if isinstance(kernel, Newton) and isinstance(line, Unrolled) and not line.linear:
            last = first + len(line.free)
            own = kernel.group, kernel.size, kernel.constraints, kernel.start, None, kernel.passive, kernel.order
            found.append(Marched(*own, lines=line, ways=ways.of(slice(first, last))))
            first = last
        else:
            found.append(kernel)
    return tuple(found)
