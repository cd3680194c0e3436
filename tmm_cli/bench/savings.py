"""What is saved by computing no more than what was asked for: counts and times, with each saving and without it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli import solve
from tmm_cli.analysis.pipeline import Results, at_positions, with_forces
from tmm_cli.bench.counting import all_orders, counted, no_closed_form
from tmm_cli.bench.measured import Measured
from tmm_cli.errors import LinkageError, _
from tmm_cli.forces.loads import applied
from tmm_cli.groups.sequence import DriverMotion, towards
from tmm_cli.kinematics.motion import move
from tmm_cli.linkage import Linkage
from tmm_cli.problem.record import Problem
from tmm_cli.vectors import Real

NOTHING = 1e-300  # kg: a link so light carries all its loads, and they are nothing
REPEATS, FEW = 7, 3
PLACES, FEW_PLACES = 3601, 721  # over the cycle, for what grows with their number

NAMED = {
    "structure": _("structure alone is counted"), "groups": _("groups on the way only"),
    "positions": _("positions asked for only"), "orders": _("accelerations where needed"),
    "massless": _("massless links carry nothing"), "closed": _("closed form where there is one"),
    "drawings": _("drawings when asked for"),
}  # fmt: skip
COUNTED = {"solutions": _("solutions"), "loads": _("loads"), "pictures": _("pictures")}
WHY_NOT = {
    "one_group": _("all groups are on the way to the first"), "no_groups": _("there are no groups"),
    "no_dyads": _("no group has a closed form"), "not_iterated": _("iteration does not find the assembly"),
}  # fmt: skip

Work = Callable[[], Any]


@dataclass(frozen=True)
class Saving:
    """One saving. with_, without: how many of what it saves; seconds of each, the best of several runs.

    counts: what was counted (COUNTED). why: why it cannot be had here (WHY_NOT); then nothing was measured.
    """

    name: str
    counts: str = "solutions"
    with_: int = 0
    without: int = 0
    seconds: tuple[float, float] = (0.0, 0.0)
    why: str = ""

    @property
    def holds(self) -> bool:
        return bool(self.why) or self.with_ < self.without

    def to_dict(self) -> dict[str, Any]:
        """Plain data, times in s."""
        if self.why:
            return {"name": self.name, "why_not": self.why}
        return {
            "name": self.name, "counts": self.counts, "with": self.with_, "without": self.without,
            "seconds_with": self.seconds[0], "seconds_without": self.seconds[1], "holds": self.holds,
        }  # fmt: skip


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
            "problem": self.problem, "savings": [saving.to_dict() for saving in self.found],
            "holds": not self.failures,
        }  # fmt: skip


def measure(problem: Problem, *, reduced: bool = False) -> Savings:
    """Every saving, measured on a problem. Raises LinkageError."""
    return Savings(problem.name, problem.title, tuple(savings(problem, reduced=reduced)), reduced=reduced)


def savings(problem: Problem, *, reduced: bool = False) -> Iterator[Saving]:
    """Every saving, measured on a problem. Raises LinkageError."""
    repeats = FEW if reduced else REPEATS
    results = with_forces(solve(problem, "kinematics"), cycle=False)
    linkage, groups = problem.linkage, results.structure.groups

    def compare(name: str, one: Work, other: Work) -> Saving:
        return _measured(name, one, other, repeats)

    places = results.closely(FEW_PLACES if reduced else PLACES)
    first = towards(results.kernels, groups[0].links if groups else ())
    law = DriverMotion(float(places[0]), 1.0, 0.0, 1)
    if groups:
        yield compare("structure", lambda: solve(problem, "structure"), lambda: _named(problem))
    if len(first) < len(results.kernels):
        yield compare(
            "groups", lambda: move(linkage, first, places, law), lambda: move(linkage, results.kernels, places, law)
        )
    else:
        yield Saving("groups", why="one_group")
    if groups:
        yield compare("positions", lambda: _at(results, places[:1]), lambda: _at(results, places))
        yield compare("orders", lambda: _quality(problem), lambda: _quality_of_all_orders(problem))
    else:  # only a driver: there is nothing to be solved
        yield from (Saving(name, why="no_groups") for name in ("structure", "positions", "orders"))
    light, weighed = _light(linkage, 0.0), _light(linkage, NOTHING)
    if len(linkage.moving) < 2:
        yield Saving("massless", why="no_groups")
    else:
        yield _measured(
            "massless", lambda: _loaded(results, light), lambda: _loaded(results, weighed), repeats, "loads"
        )
    yield _closed_form(results, places, compare)
    yield _measured("drawings", lambda: 0, lambda: _pictures(results), 1, "pictures")


def _measured(name: str, one: Work, other: Work, repeats: int, counts: str = "solutions") -> Saving:
    """Both ways, run alternately: the time of each at its best, and solutions, or how many of what the work gives."""
    numbers, best = [0, 0], [np.inf, np.inf]
    for __ in range(repeats):
        for k, work in enumerate((one, other)):
            with counted() as count:
                start = time.perf_counter()
                found = work()
                best[k] = min(best[k], time.perf_counter() - start)
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


def _quality_of_all_orders(problem: Problem) -> object:
    with all_orders():
        return _quality(problem)


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


def _closed_form(results: Results, q: Real, compare: Callable[..., Saving]) -> Saving:
    from tmm_cli.groups.base import Closed

    if not any(isinstance(kernel, Closed) for kernel in results.kernels):
        return Saving("closed", why="no_dyads")
    from tmm_cli.assembly.choose import assemble

    linkage = results.linkage
    try:
        with no_closed_form():
            iterated = assemble(linkage, results.structure)
    except LinkageError:
        return Saving("closed", why="not_iterated")
    law = DriverMotion(float(q[0]), 1.0, 0.0, 1)
    return compare(
        "closed", lambda: move(linkage, results.kernels, q, law, 0), lambda: move(linkage, iterated, q, law, 0)
    )


def _pictures(results: Results) -> int:
    """How many pictures are made."""
    from tmm_cli.draw import files

    return sum(1 for __ in files(with_forces(results)))
