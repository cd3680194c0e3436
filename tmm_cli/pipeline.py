"""Which stage needs which: structure -> assembly -> range and strokes -> motion -> forces -> lever.

Only what is asked for is computed: the structure alone moves nothing, kinematics carries no loads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_cli.asked import carriers, check
from tmm_cli.linkage import Linkage
from tmm_cli.mechanism import Mechanism
from tmm_cli.mobile import mobile
from tmm_cli.motion import Law, Motion, move, towards
from tmm_cli.problem.record import Problem, Synthesised
from tmm_cli.refused import NoStrokes, NoSuchPosition
from tmm_cli.structure.assur import Structure
from tmm_cli.vectors import Real

if TYPE_CHECKING:  # what only motion or forces need is imported when they are asked for
    from tmm_cli.assemblies import Assemblies
    from tmm_cli.forces.applied import Applied
    from tmm_cli.forces.energy import Energy
    from tmm_cli.forces.friction import Losses, Rubbed
    from tmm_cli.forces.lever import Lever
    from tmm_cli.forces.plan import Reactions
    from tmm_cli.groups.base import Kernel
    from tmm_cli.pressure import Pressure
    from tmm_cli.quality import DeadPosition, Range
    from tmm_cli.strokes import Strokes, Travel
    from tmm_cli.synthesis.check import Measured

CYCLE = 720  # places over which losses are summed up

Stage = Literal["structure", "kinematics", "forces"]


@dataclass(frozen=True)
class Results:
    """What the stages found; a stage that was not asked for is None. numbers: those of the positions in the cycle.

    of: names of what alone is asked for (points, links, centres of mass); all there is when empty. What does not depend
    on the positions is found when it is asked for.
    """

    problem: Problem
    structure: Structure
    mechanism: Mechanism
    numbers: tuple[int, ...] = ()
    motion: Motion | None = None
    loads: tuple[Applied, ...] = ()
    reactions: Reactions | None = None
    lever: Lever | None = None
    friction: Rubbed | None = None
    losses: Losses | None = None
    energy: Energy | None = None
    assemblies: tuple[Assemblies, ...] | None = None
    of: tuple[str, ...] = ()

    @property
    def roles(self) -> dict[str, str]:
        return self.mechanism.roles

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        """All groups in solving order; none where the sketch cannot be assembled."""
        return self.mechanism.kernels if self.mechanism.assembles else ()

    @property
    def way(self) -> Range | None:
        return self.mechanism.way if self.mechanism.assembles else None

    @property
    def strokes(self) -> Strokes | None:
        return self.mechanism.strokes

    @property
    def dead(self) -> tuple[DeadPosition, ...]:
        return () if self.of else self.mechanism.dead

    @property
    def further(self) -> tuple[Strokes, ...]:
        return () if self.of else self.mechanism.further

    @cached_property
    def travels(self) -> tuple[Travel, ...]:
        """How far the outputs go between the ends of what is asked for, where the driver does not turn fully."""
        from tmm_cli.strokes import find_travel

        if self.of or self.mechanism.way.full:
            return ()
        found = [find_travel(self.linkage, self.kernels, self.asked, link) for link in self.mechanism.outputs]
        return tuple(t for t in found if t is not None)

    @cached_property
    def pressure(self) -> tuple[Pressure, ...]:
        """Pressure angles of the driven links."""
        from tmm_cli.pressure import find_pressure

        if self.of or self.motion is None:
            return ()
        limits = self.problem.pressure_limits
        return find_pressure(self.linkage, self.kernels, self.mechanism.way, self.motion, limits)

    @property
    def linkage(self) -> Linkage:
        return self.problem.linkage

    @property
    def synthesis(self) -> Synthesised | None:
        """What the file's synthesis found, if it has one."""
        return self.problem.synthesis

    @cached_property
    def measured(self) -> tuple[Measured, ...]:
        """What the synthesis asked and foretold, on the mechanism."""
        from tmm_cli.synthesis.check import measured

        return () if self.synthesis is None or self.of else measured(self.synthesis.outcome, self)

    @cached_property
    def asked(self) -> Real:
        """The driver's places of all positions of the file, whether they were computed or not (rad or m)."""
        from tmm_cli.strokes import places

        request = self.problem.request
        strokes = self.strokes if request.start == "working stroke" else None
        return places(request, self.mechanism.way, strokes, self.linkage.driver.sense)

    @property
    def start(self) -> float:
        """The driver's place at position 0."""
        return float(self.asked[0])

    def closely(self, count: int) -> Real:
        """Places close together over the whole of what is asked: a turn from position 0 on, or first to last."""
        driver = self.linkage.driver
        if self.mechanism.way.full and driver.kind == "turn":
            return self.start + driver.sense * np.linspace(0, 2 * np.pi * self.mechanism.way.turns, count)
        asked = self.asked
        return np.linspace(np.min(asked), np.max(asked), count)[:: driver.sense]

    @property
    def locked(self) -> Real:
        """Positions where friction locks the mechanism."""
        assert self.motion is not None
        return np.zeros(np.shape(self.motion.q), dtype=bool) if self.friction is None else self.friction.locked

    @property
    def sound(self) -> bool:
        """Whether the checks hold: of the lever, and of what the synthesis asked."""
        return self.lever_holds and (self.motion is None or all(m.met for m in self.measured))

    @property
    def lever_holds(self) -> bool:
        """Whether the lever agrees with the force plan within the limit, wherever it could be computed."""
        if self.lever is None or self.motion is None:
            return True
        difference = self.lever.difference[self.motion.moving & ~self.locked]
        return bool(np.all(difference <= self.problem.lever_limit))


ON_DEMAND = ("kernels", "way", "output", "outputs", "strokes", "further", "dead", "roles")  # of the mechanism
OF_POSITIONS = ("travels", "pressure")


def given(results: Results, **found: Any) -> Results:
    """The same results with some of their parts given, those too that are found on demand (way, strokes, pressure...).

    The others of these are the parts of `results` itself; they are not found anew.
    """
    own = {f.name: found[f.name] for f in fields(Results) if f.name in found}
    new = replace(results, **own)
    mechanism = Mechanism(new.linkage, new.structure)
    for name in ON_DEMAND:
        vars(mechanism)[name] = found[name] if name in found else getattr(results.mechanism, name)
    new = replace(new, mechanism=mechanism)
    for name in OF_POSITIONS:
        vars(new)[name] = found[name] if name in found else getattr(results, name)
    return new


def solve(
    problem: Problem, stage: Stage = "forces", positions: Sequence[int] | None = None, of: Sequence[str] = ()
) -> Results:
    """Run the stages up to the one asked for, at all positions of the file or at those numbered.

    of: points, links, centres of mass; then kinematics solves the groups on the way to them only.
    Raises Refused: WrongMobility, NoSuchPosition, NoSuchName, NoStrokes, and what assembly raises.
    """
    linkage = problem.linkage
    structure = mobile(linkage)
    results = Results(problem, structure, Mechanism(linkage, structure), of=tuple(of))
    if stage == "structure":
        return results
    kernels = results.mechanism.kernels
    if of:
        check(linkage, of)
        kernels = towards(kernels, carriers(linkage, kernels, of))
    _need_strokes(results)
    q = results.asked
    numbers = tuple(range(len(q))) if positions is None else tuple(positions)
    for number in numbers:
        if not 0 <= number < len(q):
            raise NoSuchPosition(number, len(q))
    law = _law(linkage, float(q[0]))
    motion = move(linkage, kernels, q[list(numbers)], law)
    results = replace(results, numbers=numbers, motion=_refined(problem, motion, q, numbers, law))
    return results if stage == "kinematics" else with_forces(results)


def _refined(problem: Problem, motion: Motion, q: Real, numbers: tuple[int, ...], law: Law) -> Motion:
    """The motion with its positions near dead ones in extended precision, where the machine has it."""
    from tmm_cli.extended import WIDER, near_dead, refined

    where = near_dead(motion)
    if not WIDER or problem.extended is None or not np.any(where):
        return motion
    exact = problem.extended()
    asked = np.array(exact.request.places) if exact.request.places else q.astype(np.longdouble)
    return refined(motion, exact.linkage, asked[list(numbers)][where], law, where)


def with_forces(results: Results, *, cycle: bool = True) -> Results:
    """Add loads, the force plan and the lever to kinematics; with friction its losses over the cycle, if asked."""
    from tmm_cli.forces.energy import energy
    from tmm_cli.forces.lever import lever
    from tmm_cli.forces.loads import applied
    from tmm_cli.forces.plan import power, react

    motion = results.motion
    assert motion is not None
    strokes = results.strokes if any(x.working_stroke_only or x.table for x in results.linkage.loads) else None
    loads = applied(motion, strokes)
    reactions = react(motion, results.structure, loads)
    if motion.finer is not None and motion.where is not None:
        from tmm_cli.splice import spliced

        exact = applied(motion.finer, strokes)
        structure = results.structure.again(motion.finer.linkage)
        loads = spliced(loads, exact, motion.where)
        reactions = spliced(reactions, react(motion.finer, structure, exact), motion.where)
    rubbed, lost = None, None
    if results.linkage.friction:
        from tmm_cli.forces.friction import rub

        rubbed = rub(motion, results.structure, loads, reactions)
        loads, reactions = rubbed.loads, rubbed.reactions
        if cycle:
            lost = cycle_losses(results)
    drivers = power(motion, reactions)
    found = replace(
        results, loads=loads, reactions=reactions, lever=lever(motion, loads, drivers), friction=rubbed, losses=lost,
        energy=energy(motion, loads, drivers),
    )  # fmt: skip
    vars(found).update({name: vars(results)[name] for name in OF_POSITIONS if name in vars(results)})
    return found


def cycle_losses(results: Results, places: int = CYCLE) -> Losses:
    """What friction takes over the cycle, summed up over so many places."""
    from tmm_cli.forces.friction import losses, rub
    from tmm_cli.forces.loads import applied
    from tmm_cli.forces.plan import react

    whole = at_positions(results, results.closely(places + 1))
    acting = applied(whole, results.strokes)
    return losses(rub(whole, results.structure, acting, react(whole, results.structure, acting)), whole)


def at_positions(results: Results, q: Real, order: int = 2) -> Motion:
    """The same motion at other places of the driver (trajectories)."""
    return move(results.linkage, results.kernels, q, _law(results.linkage, results.start), order)


def _law(linkage: Linkage, start: float) -> Law:
    """The first driver's motion: its speed is that of position 0, or with several drivers that of the sketch."""
    driver = linkage.driver
    at = linkage.sketch.at if linkage.others else start
    return Law(at, driver.rate, driver.acceleration, driver.sense)


def at_places(results: Results, q: Real) -> Results:
    """The same results at other places of the driver (diagrams); with forces if they have them."""
    moved = replace(results, motion=at_positions(results, q), numbers=tuple(range(len(q))))
    return moved if results.reactions is None else with_forces(moved, cycle=False)


def _need_strokes(results: Results) -> None:
    """Refuse what rests on strokes that are not there, rather than quietly doing without."""
    problem, way = results.problem, results.mechanism.way
    loads = [x for x in problem.linkage.loads if x.working_stroke_only or (x.table and x.table.against == "stroke")]
    if problem.request.start != "working stroke" and not loads:
        return
    strokes = results.strokes
    if strokes is not None and strokes.strokes:
        return
    link = strokes.link if strokes else None
    if problem.request.start == "working stroke" and way.full:
        raise NoStrokes(link, ("positions", "from"))
    for load in loads:
        if load.working_stroke_only and way.full:
            raise NoStrokes(link, ("loads", load.name, "when"))
        if load.table is not None and load.table.against == "stroke":
            raise NoStrokes(link, ("loads", load.name, "force" if load.force else "moment"))
