"""What an optimal synthesis tells: the best candidate, its constraints, the search, the path or law that it reaches."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.synthesis.candidates import Search, W
from tmm_cli.synthesis.goals import FORCES, LEAST, PLAIN, Goal
from tmm_cli.synthesis.history import diagram
from tmm_cli.synthesis.measured_goals import measure
from tmm_cli.synthesis.measures import Ends, crank_turns, ratio_open
from tmm_cli.synthesis.reached import reached
from tmm_cli.synthesis.record import Demand, Listing, Outcome, Value
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.synthesis.optimal import Best

ACTIVE = 1e-6  # of its scale: a constraint this near to its bound holds the optimum


def told(search: Search, found: Best) -> Outcome:
    """The outcome of a search whose constraints are kept."""
    asked, kinds = search.asked, [goal.kind(search.linkage, search.groups) for goal in search.goals]
    given = [
        Value(name, side[name], asked.kinds[name], f"{W}.{word}")
        for name in asked.low for word, side in (("low", asked.low), ("high", asked.high))
    ]  # fmt: skip
    given += [Value(name, len(own), "number", f"{W}.values") for name, own in asked.values.items()]
    numbers = []
    for name, x, share in zip(asked.low, found.numbers, found.x, strict=True):
        word = "at_low" if share < ACTIVE else "at_high" if share > 1 - ACTIVE else "parameter"
        word = "chosen" if word == "parameter" and name in asked.values else word
        numbers.append(Value(name, float(x), asked.kinds[name], f"{W}.{word}"))
    given_ends = asked.make([float(x) for x in found.numbers]).ends
    ends = None if given_ends is None else (float(given_ends[0]), float(given_ends[1]))
    if ends is not None:
        slides = search.linkage.driver.kind == "slide"
        given += [Value(name, x, "length" if slides else "angle", f"{W}.goes_{name}")
                  for name, x in zip(("from", "to"), ends, strict=True)]  # fmt: skip
    demands = [Demand(f"{W}.crank", 1.0, "number", partial(crank_turns, ends=ends), asked=False)]
    demands.append(_demand(search, 0, found.values[0], kinds[0], ends, asked=False))
    for n, limit in enumerate(search.limits[1:], 2):
        if limit.equal:
            demands.append(_demand(search, n, limit.least or 0.0, kinds[n], ends, asked=True))
        else:
            demands.append(_demand(search, n, found.values[n], kinds[n], ends, asked=False))
    listings, of = [_constraints(search, found, kinds)], _words(search, search.goals[0])
    drawings = [diagram(found.evolved, partial(_in_its_unit, search), found.values[0], of, kinds[0])]
    for n, goal in enumerate(search.goals):
        if goal.wanted:
            listing, drawn = reached(search, found.x, n)
            listings.append(listing)
            drawings.insert(0, drawn)
    notes = (f"{W}.stopped",) if found.evolved.stopped else ()
    objectives = found.evolved.objective[np.isfinite(found.evolved.objective)]
    if asked.objective.of in (*PLAIN, *FORCES) and len(objectives) and not np.ptp(objectives):
        notes = (*notes, f"{W}.constant")
    sketch = search.sketch(found.x)
    if sketch is not None:
        notes = (*notes, f"{W}.not_as_sketched")
    source = f"{W}.{('some' if found.evolved.stopped else 'every') if found.evolved.every else 'source'}"
    return Outcome(
        tuple(given), tuple(numbers), source, tuple(demands), tuple(drawings), notes, tuple(listings), sketch
    )  # fmt: skip


def _demand(search: Search, n: int, value: float, kind: str, ends: Ends, *, asked: bool) -> Demand:
    goal = search.goals[n]
    at = 1e-6 if kind in ("length", "angle") and goal.of not in PLAIN else 0.0
    return Demand(
        f"{W}.{_words(search, goal)}", value, kind, partial(measure, goal, ends=ends), asked=asked, at=at,
        open=ratio_open if goal.of == "k" else None,
    )  # fmt: skip


def _constraints(search: Search, found: Best, kinds: list[str]) -> Listing:
    """The objective and every constraint: bound, value, margin, whether it is active."""
    goal, target = search.goals[0], search.asked.target
    side = "target" if target is not None else "largest" if goal.of in LEAST else "smallest"
    best, state = found.values[0], f"{W}.objective"
    rows: list[tuple[Any, ...]] = [
        (f"{W}.{_words(search, goal)}", _of(goal), f"{W}.{side}", target, best, None, kinds[0], state)
    ]
    for n, limit in enumerate(search.limits[1:], 2):
        value = found.values[n]
        sides = (("equal", limit.least),) if limit.equal else (("least", limit.least), ("most", limit.most))
        for word, bound in sides:
            if bound is None:
                continue
            margin = None if limit.equal else value - bound if word == "least" else bound - value
            active = margin is not None and margin <= ACTIVE * limit.scale
            state = "equal" if limit.equal else "active" if active else "free"
            rows.append((f"{W}.{_words(search, limit.goal)}", _of(limit.goal), f"{W}.{word}", bound, value,
                         0.0 if active else margin, kinds[n], f"{W}.{state}"))  # fmt: skip
    kinds_of = ("word", "name", "word", "mixed", "mixed", "mixed", "unit", "word")
    headers = ("quantity", "of", "limit", "bound", "value", "margin", "unit", "state")
    columns = tuple((f"{W}.column_{header}", kind) for header, kind in zip(headers, kinds_of, strict=True))
    return Listing("constraints", f"{W}.constraints", columns, tuple(rows))


def _words(search: Search, goal: Goal) -> str:
    """Whose deviations are counted in two ways says in which; a driver that slides is balanced by a force."""
    if goal.of == "moment" and search.linkage.driver.kind == "slide":
        return "moment_slide"
    return f"{goal.of}_largest" if goal.wanted and goal.norm == "largest" else goal.of


def _of(goal: Goal) -> str:
    return goal.name or ", ".join(goal.links)


def _in_its_unit(search: Search, f: Real) -> Real:
    """The history of the objective in its own unit; of a target as far above it as the best candidate is from it."""
    if search.asked.target is not None:
        return search.asked.target * (1 + f) if search.asked.target else f
    return -f if search.asked.objective.of in LEAST else f
