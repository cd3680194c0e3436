"""What is true of a linkage whatever positions are computed: assembly, range, strokes, dead positions, names of links.

A Mechanism finds each of them when it is first asked for, so the structure alone moves nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.errors import LinkageError, NotOnFrameError
from tmm_cli.mechanics.groups import DriverMotion, GroupSolver, link_states, solvers_towards
from tmm_cli.mechanics.kinematics import (
    DeadPosition,
    DriverRange,
    OutputTravel,
    PressureAngle,
    SlotExcess,
    Strokes,
    compute_motion,
    driver_positions,
    find_dead_positions,
    find_pressure,
    find_range,
    find_slot_excess,
    find_strokes,
    find_travel,
    resisted_direction,
)
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Request, Sketch
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.structure import Structure, analyse_structure, link_roles, output_link

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis.intermittent import WheelTask
    from tmm_cli.mechanics.dynamics import BalancingTask, RunTask, SteadyTask


CACHED_PARTS = (
    "kernels",
    "driver_range",
    "asked",
    "dead",
    "output",
    "outputs",
    "strokes",
    "further",
    "travels",
    "pressure",
)


@dataclass(frozen=True)
class Inputs:
    """A linkage, the positions asked for, and what is allowed.

    pressure_limits: largest pressure angles on sliding and on turning links (rad); lever_limit: allowed difference of
    the lever, a share of one. extended: makes the same as double-doubles from the decimals that the file has;
    None where there are no others than the numbers themselves. sized: False while lengths are still to be found,
    as the structure alone does not need them. dynamics, balancing, wheels: what is asked of them.
    """

    linkage: Linkage
    request: Request = field(default_factory=Request)
    pressure_limits: tuple[float, float] = (math.radians(30), math.radians(45))
    lever_limit: float = 0.05
    extended: Callable[[], Inputs] | None = None
    sized: bool = True
    dynamics: SteadyTask | RunTask | None = None
    balancing: BalancingTask | None = None
    wheels: tuple[WheelTask, ...] = ()


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A linkage with its structure.

    What needs the assembly raises AssemblyError, AmbiguousSketchError, SketchMismatchError, GroupTooLargeError,
    ChangePointSearchError.
    """

    inputs: Inputs
    structure: Structure

    @property
    def linkage(self) -> Linkage:
        return self.inputs.linkage

    def known(self, **parts: Any) -> Mechanism:
        """A mechanism of which these parts are known; it finds the others itself."""
        other = Mechanism(self.inputs, self.structure)
        other.__dict__.update(parts)
        return other

    def changed(self, **parts: Any) -> Mechanism:
        """The mechanism with other parts; those that are not given are as they were found."""
        return self.known(**{name: getattr(self, name) for name in CACHED_PARTS} | parts)

    @cached_property
    def kernels(self) -> tuple[GroupSolver, ...]:
        """The groups in the assemblies of the sketch, in solving order."""
        return assemble(self.linkage, self.structure)

    @cached_property
    def assembles(self) -> bool:
        """Whether there is such an assembly; there is none while lengths are still to be found."""
        if not self.inputs.sized:
            return False
        try:
            return bool(self.kernels) or True
        except LinkageError:
            return False

    @cached_property
    def driver_range(self) -> DriverRange:
        """How far the driver can go."""
        return find_range(self.linkage, self.kernels)

    @cached_property
    def dead(self) -> tuple[DeadPosition, ...]:
        """Dead positions inside that range."""
        return find_dead_positions(self.linkage, self.kernels, self.driver_range)

    @cached_property
    def output(self) -> str | None:
        """The main output link."""
        return output_link(self.linkage, self.structure.groups)

    @cached_property
    def outputs(self) -> tuple[str, ...]:
        """All output links."""
        return tuple(o.link for o in self.linkage.outputs) or tuple(x for x in (self.output,) if x)

    @cached_property
    def strokes(self) -> Strokes | None:
        """Strokes of the main output, with those of further links on which loads depend."""
        main = None if self.output is None else self._strokes_of(self.output)
        if main is None:
            return None
        others = [self._strokes_of(link) for link in self.linkage.stroke_links]
        return replace(main, others=tuple(strokes for strokes in others if strokes is not None))

    def _strokes_of(self, link: str) -> Strokes | None:
        return find_strokes(self.linkage, self.kernels, self.driver_range, resisted_direction(self.linkage, link), link)

    @cached_property
    def further(self) -> tuple[Strokes, ...]:
        """Strokes of the other outputs."""
        if not self.driver_range.full:
            return ()
        found = [self._strokes_of(link) for link in self.outputs[1:]]
        return tuple(s for s in found if s is not None)

    @cached_property
    def asked(self) -> Real:
        """The driver's places of all positions that are asked for, whether they are computed or not (rad or m)."""
        request = self.inputs.request
        strokes = self.strokes if request.start == "working stroke" else None
        return driver_positions(request, self.driver_range, strokes, self.linkage.driver.sense)

    @cached_property
    def travels(self) -> tuple[OutputTravel, ...]:
        """How far the outputs go between the ends of what is asked for, where the driver does not turn fully."""
        if self.driver_range.full:
            return ()
        found = [find_travel(self.linkage, self.kernels, self.asked, link) for link in self.outputs]
        return tuple(t for t in found if t is not None)

    @cached_property
    def pressure(self) -> tuple[PressureAngle, ...]:
        """Largest pressure angles of the driven links."""
        return find_pressure(self.linkage, self.kernels, self.driver_range, self.inputs.pressure_limits)

    @cached_property
    def slots(self) -> tuple[SlotExcess, ...]:
        """How stones come to the ends of their guides, and beyond."""
        return find_slot_excess(self.linkage, self.kernels, self.driver_range, self.inputs.request.places)

    @cached_property
    def roles(self) -> dict[str, str]:
        """What each link is called. A crank differs from a rocker by a full turn: where a name hangs on that the
        linkage is moved, and where it cannot be assembled yet names come from the pairs alone."""

        def turns(link: str) -> bool:
            if not self.assembles:
                return link == self.linkage.driver.link and self.linkage.driver.kind == "turn"
            return self._turning.get(link, False)

        return link_roles(self.linkage, turns)

    @property
    def turned(self) -> bool:
        """Whether the names took a turn of the linkage."""
        return bool(self.roles) and "_turning" in vars(self)

    @cached_property
    def _turning(self) -> dict[str, bool]:
        """Which links turn through 360 degrees while the driver goes its way."""
        linkage, driver_range = self.linkage, self.driver_range
        turned = {d.link: driver_range.full and d.kind == "turn" for d in linkage.cranks}
        groups = [k.group for k in self.kernels]
        hung = [g for g in groups if any(linkage.hinged_to_frame(link) for link in g.links)]
        if hung and driver_range.full:
            q = np.linspace(driver_range.start, driver_range.end, 720 * driver_range.turns + 1)
            kernels = solvers_towards(self.kernels, [link for group in hung for link in group.links])
            motion = compute_motion(linkage, kernels, q, DriverMotion(driver_range.start, 1.0, 0.0, 1), 0)
            for link in (link for group in hung for link in group.links):
                angle = np.unwrap(np.angle(motion.poses[link].z))
                turned[link] = bool(abs(angle[-1] - angle[0]) > np.pi)
        return turned


# The same linkage with another driver: its Assur groups are others then.


def with_driver(linkage: Linkage, link: str) -> Linkage:
    """Driven by a link on the frame instead of the first driver, in the assembly of the sketch.

    Where the linkage cannot be assembled with its own driver the new one's place in the sketch is not known; the
    structure does not need it. Raises NotOnFrameError.
    """
    pivots = [h.point for h in linkage.hinges if FRAME in h.links and link in h.links]
    runs = [s.name for s in linkage.slides if {s.carrier, s.runner} == {FRAME, link}]
    if link == FRAME or not (pivots or runs):
        on_frame = [n for n in linkage.moving if linkage.hinged_to_frame(n) or linkage.slides_on_frame(n)]
        raise NotOnFrameError(link, tuple(on_frame))
    driver = Driver(link, "turn" if pivots else "slide", (pivots or runs)[0], linkage.driver.rate)
    return replace(linkage, driver=driver, sketch=_sketch_for_driver(linkage, driver))


def _sketch_for_driver(linkage: Linkage, driver: Driver) -> Sketch:
    try:
        kernels = assemble(linkage, analyse_structure(linkage))
    except LinkageError:
        return linkage.sketch
    motion = link_states(linkage, kernels, np.array([linkage.sketch.at]), 0)
    points = {
        point: complex(motion.spot(point)[0])
        for n in linkage.moving
        for point in linkage.links[n].points
        if point not in linkage.links[FRAME].points
    }
    angles = {name: float(np.angle(motion.poses[name].z)[0]) for name in linkage.moving}
    if driver.kind == "slide":
        return Sketch(float(motion.run(linkage.slide(driver.joint))[0]), points, angles)
    return Sketch(angles[driver.link], points, angles)
