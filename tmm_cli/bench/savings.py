"""What is saved by computing no more than what was asked for: counts and times, with each saving and without it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

from tmm_cli.bench.counting import all_orders, counted, no_closed_form
from tmm_cli.bench.measured import Measured
from tmm_cli.drawing.run import sheet_files
from tmm_cli.mechanics.analysis import Results, at_positions, with_forces
from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.forces import applied
from tmm_cli.mechanics.groups import DriverMotion, towards
from tmm_cli.mechanics.kinematics import move
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import NUMBER
from tmm_cli.problem import Problem, build_problem, read_text, template_text
from tmm_cli.reports import Column, Table
from tmm_cli.synthesis import solve

MEASURED = "shaper"  # the problem of `tmm new`
NOTHING = 1e-300  # kg: a link so light carries all its loads, and they are nothing
REPEATS, FEW = 7, 3
PLACES, FEW_PLACES = 3601, 721  # over the cycle, for what grows with their number

NAMED = {
    "structure": "structure alone is counted",
    "groups": "groups on the way only",
    "positions": "positions asked for only",
    "orders": "accelerations where needed",
    "massless": "massless links carry nothing",
    "closed": "closed form where there is one",
    "drawings": "drawings when asked for",
}
COUNTED = {"solutions": "solutions", "loads": "loads", "pictures": "pictures"}

Work = Callable[[], Any]


@dataclass(frozen=True)
class Saving:
    """One saving. with_, without: how many of what it saves (COUNTED); seconds of each, the best of several runs."""

    name: str
    counts: str
    with_: int
    without: int
    seconds: tuple[float, float]

    @property
    def holds(self) -> bool:
        return self.with_ < self.without

    def to_dict(self) -> dict[str, Any]:
        """Plain data, times in s."""
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
class Savings(Measured):
    """The whole measurement on a problem."""

    problem: str
    title: str
    found: tuple[Saving, ...]

    @property
    def failures(self) -> tuple[str, ...]:
        """What saves nothing."""
        return tuple(NAMED[saving.name] for saving in self.found if not saving.holds)

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return {
            "problem": self.problem,
            "savings": [saving.to_dict() for saving in self.found],
            "holds": not self.failures,
        }

    @property
    def tables(self) -> tuple[Table, ...]:
        """A row a saving: what was counted and how long it took, with it and without."""
        found = self.found
        note = (
            "A solution is a group at one place of the driver, or a round of Newton's method there; "
            "its velocities and its accelerations are one more each."
        )
        return (
            Table(
                "savings",
                "What is saved by computing no more than what is asked for",
                (
                    Column("saving", [NAMED[s.name] for s in found]),
                    Column("counted", [COUNTED[s.counts] for s in found]),
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
    """Every saving, on the problem that `tmm new` writes."""
    problem = build_problem(read_text(template_text(MEASURED), f"{MEASURED}.yaml"))
    found = []
    for saving in savings(problem, reduced):
        progress(saving.name)
        found.append(saving)
    return Savings(problem.name, problem.title, tuple(found), reduced=reduced)


def savings(problem: Problem, reduced: bool) -> Iterator[Saving]:
    """Every saving, each with the work that is done with it, and without."""
    repeats = FEW if reduced else REPEATS
    results = with_forces(solve(problem, "kinematics"), cycle=False)
    linkage, kernels = problem.linkage, results.kernels
    q = results.closely(FEW_PLACES if reduced else PLACES)
    law = DriverMotion(float(q[0]), 1.0, 0.0, 1)
    first = towards(kernels, results.structure.groups[0].links)
    light, weighed = _light(linkage, 0.0), _light(linkage, NOTHING)
    with no_closed_form():
        iterated = assemble(linkage, results.structure)

    def quality_of_all_orders() -> None:
        with all_orders():
            _quality(problem)

    for name, one, other in (
        ("structure", lambda: solve(problem, "structure"), lambda: _named(problem)),
        ("groups", lambda: move(linkage, first, q, law), lambda: move(linkage, kernels, q, law)),
        ("positions", lambda: _at(results, q[:1]), lambda: _at(results, q)),
        ("orders", lambda: _quality(problem), quality_of_all_orders),
    ):
        yield measured(name, one, other, repeats)
    yield measured("massless", lambda: _loaded(results, light), lambda: _loaded(results, weighed), repeats, "loads")
    closed, by_newton = (lambda: move(linkage, kernels, q, law, 0)), (lambda: move(linkage, iterated, q, law, 0))
    yield measured("closed", closed, by_newton, repeats)
    yield measured("drawings", lambda: 0, lambda: _pictures(results), 1, "pictures")


def measured(name: str, one: Work, other: Work, repeats: int, counts: str = "solutions") -> Saving:
    """Both ways, run alternately: the time of each at its best, and solutions, or how many of what the work gives."""
    numbers, best = [0, 0], [math.inf, math.inf]
    for __ in range(repeats):
        for k, work in enumerate((one, other)):
            with counted() as count:
                start = perf_counter()
                found = work()
                best[k] = min(best[k], perf_counter() - start)
            numbers[k] = count.all if counts == "solutions" else found
    return Saving(name, counts, numbers[0], numbers[1], (best[0], best[1]))


def _named(problem: Problem) -> object:
    """Structure with the range of the driver, from which a crank is told from a rocker."""
    results = solve(problem, "structure")
    return results.driver_range, results.roles


def _at(results: Results, q: Real) -> object:
    """Kinematics and forces at some places."""
    return with_forces(replace(results, motion=at_positions(results, q)), cycle=False)


def _quality(problem: Problem) -> object:
    """All that needs no accelerations: range, strokes, dead positions, pressure angles."""
    results = solve(problem, "structure").mechanism
    return results.driver_range, results.strokes, results.dead, results.roles


def _light(linkage: Linkage, mass: float) -> Linkage:
    """The same with masses of the last moving link alone; the others weigh nothing, or all but nothing."""
    last = linkage.moving[-1]
    links = {
        name: link if name == last else replace(link, mass=mass, inertia=mass) for name, link in linkage.links.items()
    }
    return replace(linkage, links=links)


def _loaded(results: Results, linkage: Linkage) -> int:
    """The number of forces and couples that weights and inertia give, with the force plan and lever under them."""
    assert results.motion is not None
    motion = replace(results.motion, linkage=linkage, finer=None, where=None)
    inputs = replace(results.inputs, linkage=linkage)
    with_forces(replace(results, inputs=inputs, motion=motion), cycle=False)
    return sum(load.kind in ("weight", "inertia") for load in applied(motion, results.strokes))


def _pictures(results: Results) -> int:
    """How many pictures are made."""
    return sum(1 for __ in sheet_files(with_forces(results)))
