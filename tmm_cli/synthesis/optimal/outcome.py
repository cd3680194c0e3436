"""What an optimal synthesis tells: the best candidate, its constraints, the search, the path or law that it reaches."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.optimal.closely import Best
from tmm_cli.synthesis.optimal.drawings import history, reached
from tmm_cli.synthesis.optimal.quantities.assembles import Assembles
from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.search import Search
from tmm_cli.synthesis.record import Demand, Listing, Outcome, Value
from tmm_cli.vectors import Real

ACTIVE = 1e-6  # of its scale: a constraint this near to its bound holds the optimum


def outcome_of(search: Search, found: Best) -> Outcome:
    """The outcome of a search whose constraints are kept."""
    task, evolved = search.task, found.evolved
    kinds = [quantity.kind(search.linkage, search.groups) for quantity in search.quantities]
    ends = task.make(found.numbers.tolist()).ends
    ends = None if ends is None else (float(ends[0]), float(ends[1]))
    demands = [Demand(Assembles.text, 1.0, "number", partial(crank_turns, ends=ends), asked=False)]
    for n, quantity in enumerate(search.quantities):
        if n == 1:  # it goes its way
            continue
        constraint = search.constraints[n - 1] if n else None
        asked = constraint is not None and constraint.equal
        value = constraint.least if constraint is not None and asked else found.values[n]
        deviates = kinds[n] in ("length", "angle") and quantity.moves
        demands.append(Demand(
            quantity.title(search.linkage), value or 0.0, kinds[n], partial(quantity.measure, ends=ends), asked=asked,
            at=1e-6 if deviates else 0.0, open=quantity.open, of=quantity.of,
        ))  # fmt: skip
    listings = [_constraints(search, found, kinds)]
    title = search.quantities[0].title(search.linkage)
    drawings = [history(evolved, partial(_in_its_unit, search), found.values[0], title, kinds[0])]
    for n, quantity in enumerate(search.quantities):
        if quantity.wanted:
            listing, drawn = reached(search, found.x, n)
            listings.append(listing)
            drawings.insert(0, drawn)
    sketch = search.sketch(found.x)
    notes = []
    if evolved.stopped:
        notes.append(_("stopped by hand: the best candidate so far, polished"))
    objectives = evolved.objective[np.isfinite(evolved.objective)]
    if (task.objective.forces or not task.objective.moves) and len(objectives) and not np.ptp(objectives):
        notes.append(
            _("the objective is the same for all candidates: what was found only keeps the constraints")
        )  # fmt: skip
    if sketch is not None:
        notes.append(_("the file's sketch does not show the mechanism that was found: it is assembled as linkages near "
                       "it are that the sketch does show"))  # fmt: skip
    return Outcome(
        _given(search, ends), _found(search, found), _source(search, found), tuple(demands), tuple(drawings),
        tuple(notes), tuple(listings), sketch,
    )  # fmt: skip


def _given(search: Search, ends: tuple[float, float] | None) -> tuple[Value, ...]:
    """Bounds of what varies, and of the driver."""
    task = search.task
    given = []
    for name, kind in task.kinds.items():
        given += [
            Value(name, task.low[name], kind, _("varies from")),
            Value(name, task.high[name], kind, _("varies to")),
        ]
    given += [
        Value(name, len(own), "number", _("number of values to choose from")) for name, own in task.values.items()
    ]
    if ends is not None:
        kind = "length" if search.linkage.driver.kind == "slide" else "angle"
        given.append(Value("from", ends[0], kind, _("the driver goes from")))
        given.append(Value("to", ends[1], kind, _("the driver goes to")))
    return tuple(given)


def _found(search: Search, found: Best) -> tuple[Value, ...]:
    """The parameters, and whether they lie at a bound."""
    task = search.task
    numbers = []
    for name, number, share in zip(task.low, found.numbers.tolist(), found.x.tolist(), strict=True):
        if share < ACTIVE:
            text = _("found at its lower bound")
        elif share > 1 - ACTIVE:
            text = _("found at its upper bound")
        else:
            text = _("found among its values") if name in task.values else _("found within its bounds")
        numbers.append(Value(name, number, task.kinds[name], text))
    return tuple(numbers)


def _source(search: Search, found: Best) -> str:
    if not found.evolved.every:
        return _("differential evolution (R. Storn, K. Price 1997; constraints by K. Deb 2000), then sequential "
                 "quadratic programming on the exact peaks")  # fmt: skip
    if found.evolved.stopped:
        return _("candidates one after another, as far as the search came")
    return _("all candidates, one after another")


def _constraints(search: Search, found: Best, kinds: list[str]) -> Listing:
    """The objective and every constraint: bound, value, margin, whether it is active."""
    objective, target = search.task.objective, search.task.target
    side = _("near") if target is not None else _("largest") if objective.lowest else _("least")
    rows: list[tuple[Any, ...]] = [
        (objective.title(search.linkage), _of(objective), side, target, found.values[0], None, kinds[0], _("objective"))
    ]
    for n, constraint in enumerate(search.constraints[1:], 2):
        value, least, most = found.values[n], constraint.least, constraint.most
        sides: list[tuple[str, float | None, float]] = []  # words, bound, how far the value is inside it
        if constraint.equal:
            sides = [(_("equality, met"), least, 0.0)]
        else:
            sides += [] if least is None else [(_("at least"), least, value - least)]
            sides += [] if most is None else [(_("at most"), most, most - value)]
        for words, bound, margin in sides:
            active = margin <= ACTIVE * constraint.scale
            state = words if constraint.equal else _("active") if active else _("not active")
            left = None if constraint.equal else 0.0 if active else margin
            rows.append((constraint.quantity.title(search.linkage), _of(constraint.quantity), words, bound, value, left,
                         kinds[n], state))  # fmt: skip
    columns = (
        ("quantity", _("quantity"), "word"), ("of", _("of"), "name"), ("limit", _("is to be"), "word"),
        ("bound", _("bound"), "mixed"), ("value", _("value"), "mixed"), ("margin", _("margin"), "mixed"),
        ("unit", _("unit"), "unit"), ("state", _("state"), "word"),
    )  # fmt: skip
    return Listing("constraints", _("Objective and constraints"), columns, tuple(rows))


def _of(quantity: Goal) -> str:
    return quantity.name or ", ".join(quantity.links)


def _in_its_unit(search: Search, f: Real) -> Real:
    """The history of the objective in its own unit; of a target as far above it as the best candidate is from it."""
    target = search.task.target
    if target is not None:
        return target * (1 + f) if target else f
    return -f if search.task.objective.lowest else f
