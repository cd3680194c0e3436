"""What is saved by computing no more than what was asked for: counts and times, with each saving and without it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.bench.counting import Count, all_orders, counted, no_closed_form
from tmm_cli.forces.loads import applied
from tmm_cli.linkage import Linkage
from tmm_cli.motion import Law, move, towards
from tmm_cli.pipeline import Results, at_positions, solve, with_forces
from tmm_cli.problem.record import Problem
from tmm_cli.refused import Refused
from tmm_cli.vectors import Real

NOTHING = 1e-300  # kg: a link so light carries all its loads, and they are nothing
REPEATS, FEW = 7, 3
PLACES, FEW_PLACES = 3601, 721  # over the cycle, for what grows with their number

Work = Callable[[], object]
Size = Callable[[Count, object], int]


@dataclass(frozen=True)
class Saving:
    """One saving. with_, without: how many of what it saves; seconds of each, the best of several runs.

    counts: what was counted. why: why it cannot be had here; then nothing was measured.
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


def savings(problem: Problem, *, reduced: bool = False) -> Iterator[Saving]:
    """Every saving, measured on a problem. Raises Refused."""
    repeats = FEW if reduced else REPEATS
    results = with_forces(solve(problem, "kinematics"), cycle=False)
    linkage, groups = problem.linkage, results.structure.groups

    def compare(name: str, one: Work, other: Work | None = None, undone: Undone = nullcontext, **how: Any) -> Saving:
        return _measured(name, (one, nullcontext), (other or one, undone), repeats, **how)

    places = results.closely(FEW_PLACES if reduced else PLACES)
    first = towards(results.kernels, groups[0].links if groups else ())
    law = Law(float(places[0]), 1.0, 0.0, 1)
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
        yield compare("orders", lambda: _quality(problem), undone=all_orders)
    else:  # only a driver: there is nothing to be solved
        yield from (Saving(name, why="no_groups") for name in ("structure", "positions", "orders"))
    light, weighed = _light(linkage, 0.0), _light(linkage, NOTHING)
    yield Saving("massless", why="no_groups") if len(linkage.moving) < 2 else compare(
        "massless", lambda: _loaded(results, light), lambda: _loaded(results, weighed), counts="loads",
        size=lambda _, found: int(str(found)),
    )  # fmt: skip
    yield _closed_form(results, places, compare)
    yield compare(
        "drawings", lambda: _pictures(results, False), lambda: _pictures(results, True), counts="pictures",
        size=lambda _, found: int(str(found)), repeats=1,
    )  # fmt: skip


Undone = Callable[[], AbstractContextManager[Any]]


def _measured(
    name: str, one: tuple[Work, Undone], other: tuple[Work, Undone], most: int, *, counts: str = "solutions",
    size: Size = lambda count, _: count.all, repeats: int = 0,
) -> Saving:  # fmt: skip
    """Both ways, run alternately: what they count once, the time of each at its best."""
    numbers, best = [], [np.inf, np.inf]
    for k, (work, undone) in enumerate((one, other)):
        with undone(), counted() as count:
            start = time.perf_counter()
            found = work()
            best[k] = time.perf_counter() - start
        numbers.append(size(count, found))
    for _ in range((repeats or most) - 1):
        for k, (work, undone) in enumerate((one, other)):
            with undone():
                start = time.perf_counter()
                work()
                best[k] = min(best[k], time.perf_counter() - start)
    return Saving(name, counts, numbers[0], numbers[1], (best[0], best[1]))


def _named(problem: Problem) -> object:
    """Structure with the range of the driver, from which a crank is told from a rocker."""
    results = solve(problem, "structure")
    return results.way, results.roles


def _at(results: Results, q: Real) -> object:
    """Kinematics and forces at some places."""
    return with_forces(replace(results, motion=at_positions(results, q)), cycle=False)


def _quality(problem: Problem) -> object:
    """All that needs no accelerations: range, strokes, dead positions, pressure angles."""
    results = solve(problem, "structure").mechanism
    return results.way, results.strokes, results.dead, results.roles


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
    problem = replace(results.problem, linkage=linkage)
    with_forces(replace(results, problem=problem, motion=motion), cycle=False)
    return sum(load.kind in ("weight", "inertia") for load in applied(motion, results.strokes))


def _closed_form(results: Results, q: Real, compare: Callable[..., Saving]) -> Saving:
    from tmm_cli.groups.base import Closed

    if not any(isinstance(kernel, Closed) for kernel in results.kernels):
        return Saving("closed", why="no_dyads")
    from tmm_cli.assembly import assemble

    linkage = results.linkage
    try:
        with no_closed_form():
            iterated = assemble(linkage, results.structure)
    except Refused:
        return Saving("closed", why="not_iterated")
    law = Law(float(q[0]), 1.0, 0.0, 1)
    return compare(
        "closed", lambda: move(linkage, results.kernels, q, law, 0), lambda: move(linkage, iterated, q, law, 0)
    )


def _pictures(results: Results, drawn: bool) -> int:
    """How many pictures are made."""
    if not drawn:
        return 0
    from tmm_cli.draw import files

    return sum(1 for _ in files(with_forces(results)))
