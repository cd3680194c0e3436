"""Measurement of `tmm bench savings`: work and time saved by computing only what is requested.

Solutions are counted by wrapping the solvers; the calculation itself does not count them. A solution is a group at one
driver position, or one iteration of Newton's method there. Its velocities count as one more solution, and so do its
accelerations.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np

from tmm_cli.bench.measured import Measurement
from tmm_cli.drawing.run import sheet_files
from tmm_cli.mechanics.analysis import Results, mechanism, motion_at_positions, pipeline, with_forces
from tmm_cli.mechanics.assembly import assemble, assembling, sketch_matching
from tmm_cli.mechanics.forces import collect_loads
from tmm_cli.mechanics.groups import DYAD_SOLVERS, DriverMotion, GroupSolver, NewtonSolver, sequence, solvers_towards
from tmm_cli.mechanics.kinematics import compute_motion, driver_range, motion, pressure_angles, strokes
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import NUMBER
from tmm_cli.problem import Problem, build_problem, read_text, template_text
from tmm_cli.reports import Column, Table
from tmm_cli.synthesis import solve

STAGES = (assembling, sketch_matching, mechanism, motion, pipeline, pressure_angles, driver_range, strokes)


@dataclass
class SolutionCount:
    """Numbers of solutions of groups for positions (`places`), velocities and accelerations."""

    places: int = 0
    velocities: int = 0
    accelerations: int = 0

    @property
    def all(self) -> int:
        return self.places + self.velocities + self.accelerations


@contextmanager
def count_solutions() -> Iterator[SolutionCount]:
    """Context manager that counts the solutions of Assur groups computed inside it."""
    count = SolutionCount()
    replaced: list[tuple[Any, str, Any]] = []

    def watch(kind: type[GroupSolver], name: str, of: str, size: Callable[[tuple[Any, ...], Any], int]) -> None:
        original = getattr(kind, name)

        def watched(*arguments: Any, **named: Any) -> Any:
            solved = original(*arguments, **named)
            setattr(count, of, getattr(count, of) + size(arguments, solved))
            return solved

        replaced.append((kind, name, original))
        setattr(kind, name, watched)

    try:
        for dyad in DYAD_SOLVERS.values():
            watch(dyad, "closed", "places", lambda _, at: np.size(at.det))
        watch(NewtonSolver, "residuals", "places", lambda _, gaps: np.size(gaps[..., 0]))
        solvers: tuple[type[GroupSolver], ...] = (*DYAD_SOLVERS.values(), NewtonSolver)
        for kind in solvers:
            watch(kind, "rates", "velocities", lambda _, rates: np.size(rates[0].w))
            watch(kind, "accelerations", "accelerations", lambda _, accels: np.size(accels[0].e))
        yield count
    finally:
        for kind, name, original in reversed(replaced):
            setattr(kind, name, original)


@contextmanager
def _replace_in_stages(name: str, other: Any) -> Iterator[None]:
    """Context manager that replaces an object under this name in all modules that compute a stage."""
    replaced = [(stage, getattr(stage, name)) for stage in STAGES if hasattr(stage, name)]
    try:
        for stage, _ in replaced:
            setattr(stage, name, other)
        yield
    finally:
        for stage, original in replaced:
            setattr(stage, name, original)


@contextmanager
def with_all_orders() -> Iterator[None]:
    """Context manager in which every stage computes positions, velocities and accelerations, even if it needs fewer."""
    original = sequence.link_states

    def whole(linkage: Any, kernels: Any, q: Any, order: int = 2, **named: Any) -> Any:
        return original(linkage, kernels, q, 2, **named)

    with _replace_in_stages("link_states", whole):
        yield


@contextmanager
def without_closed_forms() -> Iterator[None]:
    """Context manager in which all Assur groups are solved by Newton's method."""
    with _replace_in_stages("CLOSED_FORM_SOLVERS", ()):
        yield


MEASURED = "shaper"  # the problem of `tmm new`
NEGLIGIBLE_MASS = 1e-300  # kg: all loads of such a link are computed, and are negligible
REPEATS, FEW_REPEATS = 7, 3
POSITIONS, FEW_POSITIONS = 3601, 721  # over the cycle, for savings that grow with their number

SAVING_TITLES = {
    "structure": "structure by counting alone",
    "groups": "only the groups required",
    "positions": "only the positions requested",
    "orders": "accelerations only where needed",
    "massless": "no loads on massless links",
    "closed": "closed form where available",
    "drawings": "drawings only on request",
}
COUNTED_NAMES = {"solutions": "solutions", "loads": "loads", "pictures": "pictures"}

Workload = Callable[[], Any]


@dataclass(frozen=True)
class Saving:
    """Effect of a measure that saves work.

    Attributes:
        name: name of the saving.
        counts: what is counted: solutions, loads or pictures.
        with_, without: counts with the saving and without it.
        seconds: times with the saving and without it, each the least of several runs.
    """

    name: str
    counts: str
    with_: int
    without: int
    seconds: tuple[float, float]

    @property
    def holds(self) -> bool:
        return self.with_ < self.without

    def to_dict(self) -> dict[str, Any]:
        """Return this saving as it is written to the JSON file, times in s."""
        return {
            "name": self.name,
            "counts": self.counts,
            "with": self.with_,
            "without": self.without,
            "seconds_with": self.seconds[0],
            "seconds_without": self.seconds[1],
            "holds": self.holds,
        }


@dataclass(frozen=True)
class Savings(Measurement):
    """Results of `tmm bench savings`.

    Attributes:
        problem, title: name and title of the problem on which the savings were measured.
        found: the savings.
    """

    problem: str
    title: str
    found: tuple[Saving, ...]

    @property
    def failures(self) -> tuple[str, ...]:
        """Names of the measures that save no work."""
        return tuple(SAVING_TITLES[saving.name] for saving in self.found if not saving.holds)

    def to_dict(self) -> dict[str, Any]:
        """Return the contents of the JSON file."""
        return {
            "problem": self.problem,
            "savings": [saving.to_dict() for saving in self.found],
            "holds": not self.failures,
        }

    @property
    def tables(self) -> tuple[Table, ...]:
        """Table of the savings: counts and times with each saving and without it."""
        found = self.found
        note = (
            "A solution is a group at one driver position, or an iteration of Newton's method there; "
            "its velocities and its accelerations count as one more each."
        )
        return (
            Table(
                "savings",
                "Savings by computing only what is requested",
                (
                    Column("saving", [SAVING_TITLES[s.name] for s in found]),
                    Column("counted", [COUNTED_NAMES[s.counts] for s in found]),
                    Column("with it", [str(s.with_) for s in found]),
                    Column("without", [str(s.without) for s in found]),
                    Column("with it, ms", [s.seconds[0] * 1e3 for s in found], NUMBER, digits=3),
                    Column("without, ms", [s.seconds[1] * 1e3 for s in found], NUMBER, digits=3),
                    Column("times faster", [s.seconds[1] / s.seconds[0] for s in found], NUMBER, digits=3),
                    Column("remark", ["" if s.holds else "saves nothing" for s in found]),
                ),
                notes=(note,),
            ),
        )


def measure_savings(*, reduced: bool = False, progress: Callable[[str], None] = lambda __: None) -> Savings:
    """Measure each saving on the shaper, the problem that `tmm new` writes.

    Args:
        reduced: True for fewer positions and repeats.
        progress: Called with the name of each saving.
    """
    problem = build_problem(read_text(template_text(MEASURED), f"{MEASURED}.yaml"))
    measured = []
    for saving in iterate_savings(problem, reduced):
        progress(saving.name)
        measured.append(saving)
    return Savings(problem.name, problem.title, tuple(measured), reduced=reduced)


def iterate_savings(problem: Problem, reduced: bool) -> Iterator[Saving]:
    """Yield the effect of each saving on a problem, measured by doing the work with the saving and without it."""
    repeats = FEW_REPEATS if reduced else REPEATS
    results = with_forces(solve(problem, "kinematics"), cycle=False)
    linkage, kernels = problem.linkage, results.kernels
    q = results.closely(FEW_POSITIONS if reduced else POSITIONS)
    law = DriverMotion(float(q[0]), 1.0, 0.0, 1)
    first = solvers_towards(kernels, results.structure.groups[0].links)
    light, weighed = _with_light_links(linkage, 0.0), _with_light_links(linkage, NEGLIGIBLE_MASS)
    with without_closed_forms():
        iterated = assemble(linkage, results.structure)

    def quality_of_all_orders() -> None:
        with with_all_orders():
            _compute_qualities(problem)

    for name, one, other in (
        ("structure", lambda: solve(problem, "structure"), lambda: _compute_structure(problem)),
        ("groups", lambda: compute_motion(linkage, first, q, law), lambda: compute_motion(linkage, kernels, q, law)),
        ("positions", lambda: _analyse_at(results, q[:1]), lambda: _analyse_at(results, q)),
        ("orders", lambda: _compute_qualities(problem), quality_of_all_orders),
    ):
        yield compare_work(name, one, other, repeats)
    yield compare_work(
        "massless", lambda: _count_loads(results, light), lambda: _count_loads(results, weighed), repeats, "loads"
    )
    closed, by_newton = (
        (lambda: compute_motion(linkage, kernels, q, law, 0)),
        (lambda: compute_motion(linkage, iterated, q, law, 0)),
    )
    yield compare_work("closed", closed, by_newton, repeats)
    yield compare_work("drawings", lambda: 0, lambda: _count_pictures(results), 1, "pictures")


def compare_work(
    name: str, with_saving: Workload, without_saving: Workload, repeats: int, counts: str = "solutions"
) -> Saving:
    """Do the same work with a saving and without it, alternately; compare the counts and the least times.

    Args:
        name: Name of the saving.
        with_saving, without_saving: The work to compare.
        repeats: Number of runs of each.
        counts: What is counted; if it is not "solutions", the work itself returns the count.
    """
    numbers, best = [0, 0], [math.inf, math.inf]
    for __ in range(repeats):
        for k, work in enumerate((with_saving, without_saving)):
            with count_solutions() as count:
                start = perf_counter()
                result_count = work()
                best[k] = min(best[k], perf_counter() - start)
            numbers[k] = count.all if counts == "solutions" else result_count
    return Saving(name, counts, numbers[0], numbers[1], (best[0], best[1]))


def _compute_structure(problem: Problem) -> object:
    """Compute the structure of a linkage and the range of its driver, which shows whether the driver is a crank or a
    rocker.
    """
    results = solve(problem, "structure")
    return results.driver_range, results.roles


def _analyse_at(results: Results, q: Real) -> object:
    """Compute kinematics and forces at driver coordinates q."""
    return with_forces(replace(results, motion=motion_at_positions(results, q)), cycle=False)


def _compute_qualities(problem: Problem) -> object:
    """Compute results that need no accelerations: range, strokes, dead positions, kinds of links (crank, rocker)."""
    results = solve(problem, "structure").mechanism
    return results.driver_range, results.strokes, results.dead, results.roles


def _with_light_links(linkage: Linkage, mass: float) -> Linkage:
    """Return a linkage in which all moving links except the last have the mass and the moment of inertia `mass`."""
    last = linkage.moving[-1]
    links = {
        name: link if name == last else replace(link, mass=mass, inertia=mass) for name, link in linkage.links.items()
    }
    return replace(linkage, links=links)


def _count_loads(results: Results, linkage: Linkage) -> int:
    """Compute the forces in a linkage; return the number of weights, inertia forces and inertia couples that act."""
    assert results.motion is not None
    motion = replace(results.motion, linkage=linkage, finer=None, where=None)
    inputs = replace(results.inputs, linkage=linkage)
    with_forces(replace(results, inputs=inputs, motion=motion), cycle=False)
    return sum(load.kind in ("weight", "inertia") for load in collect_loads(motion, results.strokes))


def _count_pictures(results: Results) -> int:
    """Draw all pictures and return their number."""
    return sum(1 for __ in sheet_files(with_forces(results)))
