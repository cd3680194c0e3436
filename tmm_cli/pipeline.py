"""Which stage needs which: structure -> assembly -> range and strokes -> motion -> forces -> lever.

Only what is asked for is computed: the structure alone moves nothing, kinematics carries no loads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import Linkage
from tmm_cli.mobile import mobile
from tmm_cli.motion import Law, Motion, move
from tmm_cli.problem.record import Problem
from tmm_cli.quality import DeadPosition, Range, find_dead, find_range
from tmm_cli.refused import NoStrokes, NoSuchPosition, Refused
from tmm_cli.structure.assur import Structure
from tmm_cli.structure.naming import roles
from tmm_cli.vectors import Real

if TYPE_CHECKING:  # what only motion or forces need is imported when they are asked for
    from tmm_cli.assemblies import Assemblies
    from tmm_cli.forces.applied import Applied
    from tmm_cli.forces.energy import Energy
    from tmm_cli.forces.friction import Losses, Rubbed
    from tmm_cli.forces.lever import Lever
    from tmm_cli.forces.plan import Reactions
    from tmm_cli.pressure import Pressure
    from tmm_cli.strokes import Strokes, Travel

CYCLE = 720  # places over which losses are summed up

Stage = Literal["structure", "kinematics", "forces"]


@dataclass(frozen=True)
class Results:
    """What the stages found; a stage that was not asked for is None. numbers: those of the positions in the cycle."""

    problem: Problem
    structure: Structure
    roles: dict[str, str]
    kernels: tuple[Kernel, ...]
    way: Range | None = None
    dead: tuple[DeadPosition, ...] = ()
    strokes: Strokes | None = None
    numbers: tuple[int, ...] = ()
    motion: Motion | None = None
    loads: tuple[Applied, ...] = ()
    reactions: Reactions | None = None
    lever: Lever | None = None
    friction: Rubbed | None = None
    losses: Losses | None = None
    energy: Energy | None = None
    pressure: tuple[Pressure, ...] = ()
    further: tuple[Strokes, ...] = ()
    travels: tuple[Travel, ...] = ()
    assemblies: tuple[Assemblies, ...] | None = None

    @property
    def linkage(self) -> Linkage:
        return self.problem.linkage

    @property
    def asked(self) -> Real:
        """The driver's places of all positions of the file, whether they were computed or not (rad or m)."""
        from tmm_cli.strokes import places

        assert self.way is not None
        return places(self.problem.request, self.way, self.strokes, self.linkage.driver.sense)

    @property
    def start(self) -> float:
        """The driver's place at position 0."""
        return float(self.asked[0])

    def closely(self, count: int) -> Real:
        """Places close together over the whole of what is asked: a turn from position 0 on, or first to last."""
        driver = self.linkage.driver
        if self.way is not None and self.way.full and driver.kind == "turn":
            return self.start + driver.sense * np.linspace(0, 2 * np.pi * self.way.turns, count)
        asked = self.asked
        return np.linspace(np.min(asked), np.max(asked), count)[:: driver.sense]

    @property
    def locked(self) -> Real:
        """Positions where friction locks the mechanism."""
        assert self.motion is not None
        return np.zeros(np.shape(self.motion.q), dtype=bool) if self.friction is None else self.friction.locked

    @property
    def lever_holds(self) -> bool:
        """Whether the lever agrees with the force plan within the limit, wherever it could be computed."""
        if self.lever is None or self.motion is None:
            return True
        difference = self.lever.difference[self.motion.moving & ~self.locked]
        return bool(np.all(difference <= self.problem.lever_limit))


def solve(problem: Problem, stage: Stage = "forces", positions: Sequence[int] | None = None) -> Results:
    """Run the stages up to the one asked for, at all positions of the file or at those numbered.

    Raises Refused: WrongMobility, NoSuchPosition, NoStrokes, and what assembly raises.
    """
    linkage = problem.linkage
    structure = mobile(linkage)
    if stage == "structure":
        return _structure_only(problem, structure)
    from tmm_cli.pressure import find_pressure
    from tmm_cli.strokes import find_strokes, find_travel, output_link, places, resisted

    kernels = assemble(linkage, structure)
    way = find_range(linkage, kernels)
    strokes = find_strokes(linkage, kernels, way, resisted(linkage, output_link(linkage, structure.groups)))
    _need_strokes(problem, strokes, way)
    q = places(problem.request, way, strokes, linkage.driver.sense)
    numbers = tuple(range(len(q))) if positions is None else tuple(positions)
    for number in numbers:
        if not 0 <= number < len(q):
            raise NoSuchPosition(number, len(q))
    law = _law(linkage, float(q[0]))
    motion = move(linkage, kernels, q[list(numbers)], law)
    motion = _refined(problem, motion, q, numbers, law)
    named = roles(linkage, turning_links(linkage, kernels, way))
    dead = find_dead(linkage, kernels, way)
    results = Results(problem, structure, named, kernels, way, dead, strokes, numbers, motion)
    results = replace(results, pressure=find_pressure(linkage, kernels, way, motion, problem.pressure_limits))
    outputs = [o.link for o in linkage.outputs] or [link for link in (output_link(linkage, structure.groups),) if link]
    if way.full:
        found = [find_strokes(linkage, kernels, way, link=link) for link in outputs[1:]]
        results = replace(results, further=tuple(s for s in found if s is not None))
    else:
        travels = [find_travel(linkage, kernels, q, link) for link in outputs]
        results = replace(results, travels=tuple(t for t in travels if t is not None))
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
    loads = applied(motion, results.strokes)
    reactions = react(motion, results.structure, loads)
    if motion.finer is not None and motion.where is not None:
        from tmm_cli.splice import spliced

        exact = applied(motion.finer, results.strokes)
        structure = results.structure.again(motion.finer.linkage)
        loads = spliced(loads, exact, motion.where)
        reactions = spliced(reactions, react(motion.finer, structure, exact), motion.where)
    rubbed, lost = None, None
    if results.linkage.friction:
        from tmm_cli.forces.friction import losses, rub

        rubbed = rub(motion, results.structure, loads, reactions)
        loads, reactions = rubbed.loads, rubbed.reactions
        if cycle:
            whole = at_positions(results, results.closely(CYCLE + 1))
            acting = applied(whole, results.strokes)
            everywhere = rub(whole, results.structure, acting, react(whole, results.structure, acting))
            lost = losses(everywhere, whole)
    drivers = power(motion, reactions)
    return replace(
        results, loads=loads, reactions=reactions, lever=lever(motion, loads, drivers), friction=rubbed, losses=lost,
        energy=energy(motion, loads, drivers),
    )  # fmt: skip


def at_positions(results: Results, q: Real) -> Motion:
    """The same motion at other places of the driver (trajectories)."""
    return move(results.linkage, results.kernels, q, _law(results.linkage, results.start))


def _law(linkage: Linkage, start: float) -> Law:
    """The first driver's motion: its speed is that of position 0, or with several drivers that of the sketch."""
    driver = linkage.driver
    at = linkage.sketch.at if linkage.others else start
    return Law(at, driver.rate, driver.acceleration, driver.sense)


def at_places(results: Results, q: Real) -> Results:
    """The same results at other places of the driver (diagrams); with forces if they have them."""
    moved = replace(results, motion=at_positions(results, q), numbers=tuple(range(len(q))))
    return moved if results.reactions is None else with_forces(moved, cycle=False)


def turning_links(linkage: Linkage, kernels: tuple[Kernel, ...], way: Range) -> dict[str, bool]:
    """Which links turn through 360 degrees while the driver goes its way."""
    turned = {d.link: way.full and d.kind == "turn" for d in linkage.cranks}
    hung = [d for d in kernels if any(linkage.hinged_to_frame(link) for link in d.group.links)]
    if hung and way.full:
        motion = move(
            linkage, kernels, np.linspace(way.start, way.end, 720 * way.turns + 1), Law(way.start, 1.0, 0.0, 1)
        )
        for dyad in hung:
            for link in dyad.group.links:
                angle = np.unwrap(np.angle(motion.poses[link].z))
                turned[link] = bool(abs(angle[-1] - angle[0]) > np.pi)
    return turned


def _structure_only(problem: Problem, structure: Structure) -> Results:
    """Names of links need a turn of the driver; where it cannot be assembled yet, names come from the pairs alone."""
    linkage = problem.linkage
    try:
        kernels = assemble(linkage, structure)
    except Refused:  # kinematics will say what is wrong; the structure stands without it
        turns = {linkage.driver.link: linkage.driver.kind == "turn"}
        return Results(problem, structure, roles(linkage, turns), ())
    way = find_range(linkage, kernels)
    return Results(problem, structure, roles(linkage, turning_links(linkage, kernels, way)), kernels, way)


def _need_strokes(problem: Problem, strokes: Strokes | None, way: Range) -> None:
    """Refuse what rests on strokes that are not there, rather than quietly doing without."""
    if strokes is not None and strokes.strokes:
        return
    link = strokes.link if strokes else None
    if problem.request.start == "working stroke" and way.full:
        raise NoStrokes(link, ("positions", "from"))
    for load in problem.linkage.loads:
        if load.working_stroke_only and way.full:
            raise NoStrokes(link, ("loads", load.name, "when"))
        if load.table is not None and load.table.against == "stroke":
            raise NoStrokes(link, ("loads", load.name, "force" if load.force else "moment"))
