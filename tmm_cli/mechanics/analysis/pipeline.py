"""Stages of the analysis: structure, assembly, driver range and strokes, motion, forces, Zhukovsky lever.

Only the requested stages are computed. Positions near a dead position are computed again in double-doubles (31 digits).
At a distance eps (rad) from a dead position, rounding a length of the file to the nearest float64 number changes
velocities by the relative amount 1e-16/eps, whatever the method; with 31 digits this does not matter. The results are
then rounded to float64.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_cli.mechanics.analysis.mechanism import Inputs, Mechanism
from tmm_cli.mechanics.analysis.optional_stages import balancing_stage, driver_motion, intermittent_stage, law_of_motion
from tmm_cli.mechanics.analysis.selection import carrying_links, refuse_unknown_names
from tmm_cli.mechanics.assembly import analyse_mobile_structure
from tmm_cli.mechanics.errors import (
    MissingStrokesError,
    NoTurnError,
    SpeedTableError,
    TableBeyondCycleError,
    UnknownPositionError,
)
from tmm_cli.mechanics.forces import (
    AppliedLoad,
    Energy,
    FrictionLosses,
    FrictionSolution,
    Reactions,
    ZhukovskyLever,
    collect_loads,
    compute_energy,
    compute_lever,
    compute_losses,
    find_locked_ranges,
    reduced_driving_moment,
    solve_friction,
    solve_reactions,
)
from tmm_cli.mechanics.groups import GroupSolver, LawOfMotion, solvers_towards
from tmm_cli.mechanics.kinematics import (
    DeadPosition,
    DriverRange,
    Motion,
    OutputTravel,
    PressureAngle,
    SlotExcess,
    Strokes,
    compute_motion,
    fill_in_limits,
    pressure_at,
    splice_positions,
)
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, Real, to_double_double, to_float
from tmm_cli.mechanics.structure import Structure

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis.extremes import QuantityExtreme
    from tmm_cli.mechanics.analysis.intermittent import IntermittentMotion
    from tmm_cli.mechanics.assembly import Assemblies
    from tmm_cli.mechanics.dynamics import BalancingResults, SingleRun, SteadyRunning
    from tmm_cli.mechanics.kinematics import InstantCentre


def is_near_dead(motion: Motion) -> Real:
    """Return True at positions that should be computed in double-doubles, (positions,).

    There some group is too close to a dead position for float64, but not exactly in it.
    """
    near = np.zeros(np.shape(motion.q), dtype=bool)
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        near |= at.margin < kernel.blurred
    return near & motion.moving


def refine_near_dead(motion: Motion, linkage: Linkage, q: Real, law: LawOfMotion, where: Real) -> Motion:
    """Replace the positions of a motion that are close to dead positions by values computed in double-doubles.

    Args:
        motion: the motion in float64; its assemblies are kept.
        linkage: the linkage in double-doubles.
        q: driver coordinates of these positions in double-doubles.
        law: law of motion of the driver.
        where: mask of these positions, (positions,).
    """
    closer = compute_motion(linkage, tuple(kernel.rebind(linkage) for kernel in motion.kernels), q, law)
    if not bool(np.all(closer.moving)):
        return motion
    return replace(splice_positions(motion, closer, where), finer=closer, where=where)


# Checks that the strokes, rotations and speeds on which loads, positions and tables depend exist.


def refuse_missing_data(mechanism: Mechanism) -> None:
    """Raise an error if loads, positions or tables depend on strokes, rotations or speeds that do not exist.

    Raises:
        MissingStrokesError, NoTurnError, TableBeyondCycleError, SpeedTableError.
    """
    _refuse_missing_strokes(mechanism)
    _refuse_long_load_tables(mechanism)
    _refuse_short_speed_table(mechanism)


def _refuse_missing_strokes(mechanism: Mechanism) -> None:
    """Raise an error for positions or loads that are counted from strokes, if the output link has none."""
    request, driver_range = mechanism.inputs.request, mechanism.driver_range
    loads = [x for x in mechanism.linkage.loads if x.working_stroke_only or (x.table and x.table.against == "stroke")]
    if request.start != "working stroke" and not loads:
        return
    strokes = mechanism.strokes
    if request.start == "working stroke" and driver_range.full and (strokes is None or not strokes.strokes):
        raise MissingStrokesError(strokes.link if strokes else None, ("positions", "from"))
    for load in loads:
        load_strokes = strokes.of_link(load.stroke_link) if strokes else None
        if load.working_stroke_only and driver_range.full and (load_strokes is None or not load_strokes.strokes):
            raise MissingStrokesError(load_strokes.link if load_strokes else None, ("loads", load.name, "when"))
        if load.table is not None and load.table.against == "stroke":
            load_strokes = strokes.of_link(load.table.stroke_link) if strokes else None
            if load_strokes is None or not load_strokes.strokes:
                limits = None if driver_range.full else (driver_range.start, driver_range.end)
                path = ("loads", load.name, load.table.key)
                raise MissingStrokesError(load_strokes.link if load_strokes else None, path, limits)


def _refuse_long_load_tables(mechanism: Mechanism) -> None:
    """Raise an error for a load table that extends beyond the cycle."""
    turns = mechanism.linkage.turns
    if turns > 1 and not mechanism.driver_range.full:
        raise NoTurnError(turns)
    for load in mechanism.linkage.loads:
        if load.table is None or load.table.against == "stroke":
            continue
        strokes = mechanism.strokes if load.table.against == "crank turn" else None
        cycle = 2 * np.pi * turns if strokes is None else strokes.cycle
        for row, argument in enumerate(load.table.arguments):
            if not -SAME_DRIVER_POSITION <= argument <= cycle + SAME_DRIVER_POSITION:
                path = ("loads", load.name, load.table.key, "table", row, 0)
                raise TableBeyondCycleError(path, float(argument), cycle)


def _refuse_short_speed_table(mechanism: Mechanism) -> None:
    """Raise an error for a speed table of the driver that does not cover all positions."""
    law, requested = mechanism.linkage.driver.law, mechanism.asked
    if law is None:
        return
    unknown = ~np.isfinite(driver_motion(mechanism.linkage, float(requested[0])).speed(requested))
    goes_round = mechanism.driver_range.full and not mechanism.inputs.request.places
    if np.any(unknown) or (goes_round and not law.squares.closed):
        first = float(to_float(law.squares.arguments[0]))
        at = float(requested[np.argmax(unknown)]) if np.any(unknown) else None
        raise SpeedTableError(
            at, first, float(to_float(law.squares.arguments[-1])), 2 * np.pi * mechanism.linkage.turns
        )


# Stages in their order: structure, assembly, range and strokes, motion, forces, lever.


CYCLE_SAMPLES = 720  # positions at which friction losses are computed

Stage = Literal["structure", "kinematics", "forces"]


@dataclass(frozen=True, eq=False)
class Results:
    """Results of the analysis. Those of stages that were not requested are None or empty.

    Properties that do not depend on the positions are computed on request.

    Attributes:
        inputs: input data.
        structure: structure of the linkage.
        mechanism: properties that do not depend on the positions.
        numbers: numbers of the computed positions.
        motion: motion at these positions.
        loads, reactions, lever: loads on the links, reactions in the pairs, Zhukovsky lever.
        friction, losses: reactions with friction, and friction losses over the cycle.
        energy: kinetic energy and powers.
        running: steady running or single run.
        balancing: result of the balancing task.
        wheels: motion of the wheels in the block `intermittent`.
        assemblies, extremes: only if requested.
        centres: instantaneous centres by index of the position, only if requested.
        of: names of the requested points, links and centres of mass; empty for all.
        problem: any object of the caller.
    """

    inputs: Inputs
    structure: Structure
    mechanism: Mechanism
    numbers: tuple[int, ...] = ()
    motion: Motion | None = None
    loads: tuple[AppliedLoad, ...] = ()
    reactions: Reactions | None = None
    lever: ZhukovskyLever | None = None
    friction: FrictionSolution | None = None
    losses: FrictionLosses | None = None
    energy: Energy | None = None
    running: SteadyRunning | SingleRun | None = None
    balancing: BalancingResults | None = None
    wheels: tuple[IntermittentMotion, ...] | None = None
    assemblies: tuple[Assemblies, ...] | None = None
    centres: Mapping[int, Sequence[InstantCentre]] | None = None
    extremes: tuple[QuantityExtreme, ...] | None = None
    of: tuple[str, ...] = ()
    problem: Any = None

    @property
    def linkage(self) -> Linkage:
        return self.inputs.linkage

    @property
    def roles(self) -> dict[str, str]:
        return self.mechanism.roles

    @property
    def kernels(self) -> tuple[GroupSolver, ...]:
        """Group solvers in solution order; none if the linkage cannot be assembled as in the sketch."""
        return self.mechanism.kernels if self.mechanism.assembles else ()

    @property
    def driver_range(self) -> DriverRange | None:
        return self.mechanism.driver_range if self.mechanism.assembles else None

    @property
    def strokes(self) -> Strokes | None:
        return self.mechanism.strokes

    @property
    def dead(self) -> tuple[DeadPosition, ...]:
        return () if self.of else self.mechanism.dead

    @property
    def further(self) -> tuple[Strokes, ...]:
        return () if self.of else self.mechanism.further

    @property
    def swinging(self) -> tuple[Strokes, ...]:
        """Strokes of all output links that move back and forth."""
        return tuple(strokes for strokes in (self.strokes, *self.further) if strokes is not None and strokes.strokes)

    @property
    def travels(self) -> tuple[OutputTravel, ...]:
        return () if self.of else self.mechanism.travels

    @property
    def slots(self) -> tuple[SlotExcess, ...]:
        return () if self.of else self.mechanism.slots

    @cached_property
    def pressure(self) -> tuple[PressureAngle, ...]:
        """Pressure angles of the driven links: the largest over the driver range, and those at the positions."""
        if self.of or self.motion is None:
            return ()
        return tuple(
            p if p.angles.size else replace(p, angles=pressure_at(self.motion, p.group, p.link))
            for p in self.mechanism.pressure
        )

    @property
    def asked(self) -> Real:
        """Driver coordinates of all requested positions (rad or m), even of those that were not computed."""
        return self.mechanism.asked

    @property
    def start(self) -> float:
        """Driver coordinate of position 0, rad or m."""
        return float(self.asked[0])

    @property
    def turns(self) -> int:
        """Revolutions of the driver after which the motion repeats; 0 if the driver does not rotate fully."""
        reach = self.driver_range
        return reach.turns if reach is not None and reach.full and self.linkage.driver.kind == "turn" else 0

    @property
    def counts_strokes(self) -> bool:
        """True if strokes are counted from position 0, rather than as working and idle strokes.

        If the loads repeat after several revolutions, as in a four-stroke engine, working and idle strokes do not
        alternate.
        """
        return self.linkage.turns > 1 and not any(load.working_stroke_only for load in self.linkage.loads)

    def closely(self, count: int) -> Real:
        """Return `count` evenly spaced driver coordinates.

        They extend over a cycle from position 0, or from the first to the last position if the driver does not rotate
        fully.
        """
        driver = self.linkage.driver
        if self.turns:
            return self.start + driver.sense * np.linspace(0, 2 * np.pi * self.turns, count)
        requested = self.asked
        return np.linspace(np.min(requested), np.max(requested), count)[:: driver.sense]

    @property
    def law(self) -> LawOfMotion:
        """Law of motion of the first driver."""
        return driver_motion(self.linkage, self.start) if self.running is None else self.running

    @property
    def steady(self) -> SteadyRunning | None:
        """Result of steady running; None if it was not computed."""
        return self.running if self.running is not None and self.running.task.cyclic else None

    @property
    def single(self) -> SingleRun | None:
        """Result of a single run; None if it was not computed."""
        return self.running if self.running is not None and not self.running.task.cyclic else None

    @property
    def locked(self) -> Real:
        """True at positions where the mechanism is self-locking, (positions,)."""
        assert self.motion is not None
        return np.zeros(np.shape(self.motion.q), dtype=bool) if self.friction is None else self.friction.locked

    @property
    def lever_holds(self) -> bool:
        """True if the Zhukovsky lever agrees with the force plan, within the limit, at all computed positions."""
        if self.lever is None or self.motion is None:
            return True
        difference = self.lever.difference[self.motion.moving & ~self.locked]
        return bool(np.all(difference <= self.inputs.lever_limit))


def solve(
    inputs: Inputs,
    stage: Stage = "forces",
    positions: Sequence[int] | None = None,
    of: Sequence[str] = (),
    problem: Any = None,
) -> Results:
    """Run the stages of the analysis up to the requested one.

    Args:
        inputs: linkage, positions and limits.
        stage: last stage to run.
        positions: numbers of positions; None for all.
        of: names of points, links and centres of mass; only the groups on which they depend are solved.
        problem: object of the caller, kept in the results.

    Raises:
        LinkageError: MobilityError, UnknownPositionError, UnknownNameError, MissingStrokesError, and errors of
            assembly.
    """
    structure = analyse_mobile_structure(inputs.linkage)
    results = Results(inputs, structure, Mechanism(inputs, structure), of=tuple(of), problem=problem)
    if stage == "structure":
        return results
    kernels = results.mechanism.kernels
    if of:
        refuse_unknown_names(inputs.linkage, of)
        kernels = solvers_towards(kernels, carrying_links(inputs.linkage, kernels, of))
    refuse_missing_data(results.mechanism)
    if inputs.dynamics is not None:
        results = replace(results, running=law_of_motion(results.mechanism, inputs.dynamics))
    numbers = tuple(range(len(results.asked))) if positions is None else tuple(positions)
    for number in numbers:
        if not 0 <= number < len(results.asked):
            raise UnknownPositionError(number, len(results.asked))
    results = replace(results, numbers=numbers, motion=_solve_motion(results, kernels, numbers))
    if inputs.wheels and not of:
        results = replace(results, wheels=intermittent_stage(results.mechanism, results.running))
    if stage == "kinematics":
        return results
    results = with_forces(results)
    if inputs.balancing is None or results.motion is None:
        return results
    return replace(results, balancing=balancing_stage(results.mechanism, results.motion.q, inputs.balancing))


def _solve_motion(results: Results, kernels: tuple[GroupSolver, ...], numbers: tuple[int, ...]) -> Motion:
    """Solve the motion; if the inputs allow it, positions near dead positions are solved in double-doubles."""
    law = results.law
    motion = compute_motion(results.linkage, kernels, results.asked[list(numbers)], law)
    where = is_near_dead(motion)
    if results.inputs.extended is None or not np.any(where):
        return fill_in_limits(motion)
    exact = results.inputs.extended()
    requested: Any = exact.request.places
    requested = np.stack(requested) if requested else to_double_double(results.asked)
    return fill_in_limits(refine_near_dead(motion, exact.linkage, requested[list(numbers)][where], law, where))


def with_forces(results: Results, *, cycle: bool = True) -> Results:
    """Add loads, reactions, Zhukovsky lever and energy to results of kinematics.

    If there is friction and `cycle` is True, the friction losses over the cycle are added too.
    """
    motion = results.motion
    assert motion is not None
    strokes = results.strokes if results.linkage.by_strokes else None
    loads = collect_loads(motion, strokes)
    bare = motion if motion.bare is None else motion.bare  # reactions have no limit values at change points
    reactions = solve_reactions(bare, results.structure, loads if motion.bare is None else collect_loads(bare, strokes))
    reactions = replace(reactions, applied=loads)
    if motion.finer is not None and motion.where is not None:
        exact = collect_loads(motion.finer, strokes)
        structure = results.structure.rebind(motion.finer.linkage)
        loads = splice_positions(loads, exact, motion.where)
        reactions = splice_positions(reactions, solve_reactions(motion.finer, structure, exact), motion.where)
    friction, losses = None, None
    if results.linkage.friction:
        friction = solve_friction(bare, results.structure, loads, reactions)
        loads, reactions = friction.loads, friction.reactions
        if cycle:
            losses = cycle_losses(results)
    drivers = reduced_driving_moment(motion, reactions)
    return replace(
        results,
        loads=loads,
        reactions=reactions,
        lever=compute_lever(motion, loads, drivers),
        friction=friction,
        losses=losses,
        energy=compute_energy(motion, loads, drivers),
    )


def cycle_losses(results: Results, samples: int = CYCLE_SAMPLES, *, ranges: bool = True) -> FrictionLosses:
    """Integrate the friction losses over the cycle with `samples` steps.

    ranges: also find the ranges in which the mechanism is self-locking.
    """
    whole = motion_at_positions(results, results.closely(samples + 1))
    friction = _solve_friction_at(results, whole)
    losses = compute_losses(friction, whole)
    if not losses.locked or not ranges:
        return losses
    q = whole.q
    if results.linkage.driver.sense < 0:
        q = q[::-1]
        friction = replace(friction, locked=friction.locked[::-1], pair=friction.pair[::-1])

    def locked_at(q: Real) -> Real:
        return _solve_friction_at(results, motion_at_positions(results, q)).locked

    return replace(losses, ranges=find_locked_ranges(q, friction, locked_at, cyclic=results.turns > 0))


def _solve_friction_at(results: Results, motion: Motion) -> FrictionSolution:
    acting = collect_loads(motion, results.strokes)
    return solve_friction(motion, results.structure, acting, solve_reactions(motion, results.structure, acting))


def motion_at_positions(results: Results, q: Real, order: int = 2) -> Motion:
    """Compute the motion of an analysed mechanism at other driver coordinates q (rad or m), (positions,).

    order: highest order of the derivatives, 0 for positions only.
    """
    return fill_in_limits(compute_motion(results.linkage, results.kernels, q, results.law, order))


def results_at(results: Results, q: Real) -> Results:
    """Compute the results at other driver coordinates q, with forces if `results` has them."""
    moved = replace(results, motion=motion_at_positions(results, q), numbers=tuple(range(len(q))))
    return moved if results.reactions is None else with_forces(moved, cycle=False)
