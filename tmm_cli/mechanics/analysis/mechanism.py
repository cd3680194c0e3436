"""Properties of a mechanism that do not depend on the requested positions.

They are the assembly, the driver range, strokes, dead positions and link names. Each is computed when it is
first requested, so a request for the structure alone solves no motion.
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
    """Input data of an analysis.

    Attributes:
        linkage: the linkage.
        request: requested positions.
        pressure_limits: allowed pressure angles on sliding and on rotating links, rad.
        lever_limit: allowed relative difference between the lever and the force plan.
        extended: function that returns the same inputs in double-doubles, from the decimal numbers of the file;
            None if there is no file.
        sized: False if some lengths are still unknown, so that only the structure can be analysed.
        dynamics: task for the law of motion, or None.
        balancing: balancing task, or None.
        wheels: wheels with intermittent motion.
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
    """Linkage with its structure. All other properties are computed when they are first requested.

    Properties for which the linkage must be assembled raise AssemblyError, AmbiguousSketchError,
    SketchMismatchError, GroupTooLargeError or ChangePointSearchError.
    """

    inputs: Inputs
    structure: Structure

    @property
    def linkage(self) -> Linkage:
        return self.inputs.linkage

    def with_known(self, **parts: Any) -> Mechanism:
        """Return a copy of the mechanism in which the given properties already have values, so they are not
        computed.
        """
        other = Mechanism(self.inputs, self.structure)
        other.__dict__.update(parts)
        return other

    def with_changed(self, **parts: Any) -> Mechanism:
        """Return a copy of the mechanism with the given properties replaced; the values of all other properties are
        kept.
        """
        return self.with_known(**{name: getattr(self, name) for name in CACHED_PARTS} | parts)

    @cached_property
    def kernels(self) -> tuple[GroupSolver, ...]:
        """Group solvers in solution order, each for the assembly shown in the sketch."""
        return assemble(self.linkage, self.structure)

    @cached_property
    def assembles(self) -> bool:
        """True if the linkage can be assembled as in the sketch; False while lengths are unknown."""
        if not self.inputs.sized:
            return False
        try:
            return bool(self.kernels) or True
        except LinkageError:
            return False

    @cached_property
    def driver_range(self) -> DriverRange:
        """Range in which the driver can move."""
        return find_range(self.linkage, self.kernels)

    @cached_property
    def dead(self) -> tuple[DeadPosition, ...]:
        """Dead positions inside the driver range."""
        return find_dead_positions(self.linkage, self.kernels, self.driver_range)

    @cached_property
    def output(self) -> str | None:
        """Name of the main output link; None if there is none."""
        return output_link(self.linkage, self.structure.groups)

    @cached_property
    def outputs(self) -> tuple[str, ...]:
        """Names of all output links."""
        return tuple(o.link for o in self.linkage.outputs) or tuple(x for x in (self.output,) if x)

    @cached_property
    def strokes(self) -> Strokes | None:
        """Strokes of the main output link; `others` holds the strokes of further links on which loads depend."""
        main = None if self.output is None else self._strokes_of(self.output)
        if main is None:
            return None
        others = [self._strokes_of(link) for link in self.linkage.stroke_links]
        return replace(main, others=tuple(strokes for strokes in others if strokes is not None))

    def _strokes_of(self, link: str) -> Strokes | None:
        return find_strokes(self.linkage, self.kernels, self.driver_range, resisted_direction(self.linkage, link), link)

    @cached_property
    def further(self) -> tuple[Strokes, ...]:
        """Strokes of the output links other than the main one."""
        if not self.driver_range.full:
            return ()
        strokes = [self._strokes_of(link) for link in self.outputs[1:]]
        return tuple(s for s in strokes if s is not None)

    @cached_property
    def asked(self) -> Real:
        """Driver coordinates of all requested positions (rad or m), even of those that are not computed."""
        request = self.inputs.request
        strokes = self.strokes if request.start == "working stroke" else None
        return driver_positions(request, self.driver_range, strokes, self.linkage.driver.sense)

    @cached_property
    def travels(self) -> tuple[OutputTravel, ...]:
        """Travel of each output link over the requested positions, if the driver does not rotate fully."""
        if self.driver_range.full:
            return ()
        travels = [find_travel(self.linkage, self.kernels, self.asked, link) for link in self.outputs]
        return tuple(t for t in travels if t is not None)

    @cached_property
    def pressure(self) -> tuple[PressureAngle, ...]:
        """Largest pressure angle of each driven link."""
        return find_pressure(self.linkage, self.kernels, self.driver_range, self.inputs.pressure_limits)

    @cached_property
    def slots(self) -> tuple[SlotExcess, ...]:
        """Largest travel of each sliding block beyond the ends of its slot, or its closest approach to them."""
        return find_slot_excess(self.linkage, self.kernels, self.driver_range, self.inputs.request.places)

    @cached_property
    def roles(self) -> dict[str, str]:
        """Kind of each link: crank, rocker, ...

        A crank differs from a rocker in that it rotates fully, so the motion is solved if it is needed to tell them
        apart. If the linkage cannot be assembled, the kinds follow from the pairs alone.
        """

        def turns(link: str) -> bool:
            if not self.assembles:
                return link == self.linkage.driver.link and self.linkage.driver.kind == "turn"
            return self._rotates_fully.get(link, False)

        return link_roles(self.linkage, turns)

    @property
    def turned(self) -> bool:
        """True if the motion had to be solved to tell cranks from rockers."""
        return bool(self.roles) and "_rotates_fully" in vars(self)

    @cached_property
    def _rotates_fully(self) -> dict[str, bool]:
        """For each link, True if it rotates through 360 degrees over the driver range."""
        linkage, driver_range = self.linkage, self.driver_range
        turned = {d.link: driver_range.full and d.kind == "turn" for d in linkage.cranks}
        groups = [k.group for k in self.kernels]
        on_frame = [g for g in groups if any(linkage.hinged_to_frame(link) for link in g.links)]
        if on_frame and driver_range.full:
            q = np.linspace(driver_range.start, driver_range.end, 720 * driver_range.turns + 1)
            kernels = solvers_towards(self.kernels, [link for group in on_frame for link in group.links])
            motion = compute_motion(linkage, kernels, q, DriverMotion(driver_range.start, 1.0, 0.0, 1), 0)
            for link in (link for group in on_frame for link in group.links):
                angle = np.unwrap(np.angle(motion.poses[link].z))
                turned[link] = bool(abs(angle[-1] - angle[0]) > np.pi)
        return turned


# The same linkage with another driver, and so with other Assur groups.


def with_driver(linkage: Linkage, link: str) -> Linkage:
    """Return the linkage driven by another link on the frame, in the assembly of the sketch.

    If the linkage cannot be assembled with its original driver, the sketch coordinate is left unchanged; the
    structure does not depend on it.

    Raises:
        NotOnFrameError: the link is not paired with the frame.
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
