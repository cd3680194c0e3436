"""What is true of a linkage whatever positions are asked for: assembly, range, strokes, dead positions, names of links.

Each of them is found when it is first asked for, so the structure alone moves nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from tmm_cli.linkage import Linkage
from tmm_cli.refused import Refused
from tmm_cli.structure.assur import Structure
from tmm_cli.structure.naming import roles

if TYPE_CHECKING:  # what moves the linkage is imported when it is moved
    from tmm_cli.groups.base import Kernel
    from tmm_cli.quality import DeadPosition, Range
    from tmm_cli.strokes import Strokes


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A linkage with its structure. What needs the assembly raises NoAssembly, Undecided, Misfit, TooLarge."""

    linkage: Linkage
    structure: Structure

    @cached_property
    def kernels(self) -> tuple[Kernel, ...]:
        """The groups in the assemblies of the sketch, in solving order."""
        from tmm_cli.assembly import assemble

        return assemble(self.linkage, self.structure)

    @cached_property
    def assembles(self) -> bool:
        """Whether there is such an assembly."""
        try:
            return bool(self.kernels) or True
        except Refused:
            return False

    @cached_property
    def way(self) -> Range:
        """How far the driver can go."""
        from tmm_cli.quality import find_range

        return find_range(self.linkage, self.kernels)

    @cached_property
    def dead(self) -> tuple[DeadPosition, ...]:
        """Dead positions inside that way."""
        from tmm_cli.quality import find_dead

        return find_dead(self.linkage, self.kernels, self.way)

    @cached_property
    def output(self) -> str | None:
        """The main output link."""
        from tmm_cli.strokes import output_link

        return output_link(self.linkage, self.structure.groups)

    @cached_property
    def outputs(self) -> tuple[str, ...]:
        """All output links."""
        return tuple(o.link for o in self.linkage.outputs) or tuple(x for x in (self.output,) if x)

    @cached_property
    def strokes(self) -> Strokes | None:
        """Strokes of the main output."""
        from tmm_cli.strokes import find_strokes, resisted

        return find_strokes(self.linkage, self.kernels, self.way, resisted(self.linkage, self.output))

    @cached_property
    def further(self) -> tuple[Strokes, ...]:
        """Strokes of the other outputs."""
        from tmm_cli.strokes import find_strokes

        if not self.way.full:
            return ()
        found = [find_strokes(self.linkage, self.kernels, self.way, link=link) for link in self.outputs[1:]]
        return tuple(s for s in found if s is not None)

    @cached_property
    def roles(self) -> dict[str, str]:
        """What each link is called. A crank differs from a rocker by a full turn: where a name hangs on that the
        linkage is moved, and where it cannot be assembled yet names come from the pairs alone."""
        return roles(self.linkage, self._turns)

    @property
    def turned(self) -> bool:
        """Whether the names took a turn of the linkage."""
        return "roles" in vars(self) and "_turning" in vars(self)

    def _turns(self, link: str) -> bool:
        if not self.assembles:
            return link == self.linkage.driver.link and self.linkage.driver.kind == "turn"
        return self._turning.get(link, False)

    @cached_property
    def _turning(self) -> dict[str, bool]:
        """Which links turn through 360 degrees while the driver goes its way."""
        import numpy as np

        from tmm_cli.motion import Law, move, towards

        linkage, way = self.linkage, self.way
        turned = {d.link: way.full and d.kind == "turn" for d in linkage.cranks}
        groups = [k.group for k in self.kernels]
        hung = [g for g in groups if any(linkage.hinged_to_frame(link) for link in g.links)]
        if hung and way.full:
            q = np.linspace(way.start, way.end, 720 * way.turns + 1)
            kernels = towards(self.kernels, [link for group in hung for link in group.links])
            motion = move(linkage, kernels, q, Law(way.start, 1.0, 0.0, 1), 0)
            for link in (link for group in hung for link in group.links):
                angle = np.unwrap(np.angle(motion.poses[link].z))
                turned[link] = bool(abs(angle[-1] - angle[0]) > np.pi)
        return turned
