"""What an optimal synthesis tells: the best candidate, its constraints, the search, the path or law that it reaches."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from tmm_cli.language import N_, Phrase
from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.optimal import many_starts
from tmm_cli.synthesis.optimal.candidates import Candidates
from tmm_cli.synthesis.optimal.drawings import history, reached
from tmm_cli.synthesis.optimal.exact import Best
from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.quantities.transmission import Assembles
from tmm_cli.synthesis.record import Demand, Listing, Outcome, Value
from tmm_cli.vectors import Real

ACTIVE = 1e-6  # of its scale: a constraint this near to its bound holds the optimum


def outcome_of(candidates: Candidates, found: Best) -> Outcome:
    """The outcome of a search whose constraints are kept."""
    task, evolved, linkage = candidates.task, found.evolved, candidates.linkage
    kinds = [quantity.kind(linkage, candidates.groups) for quantity in candidates.quantities]
    ends = task.make(found.numbers.tolist()).ends
    ends = None if ends is None else (float(ends[0]), float(ends[1]))
    demands = [Demand(Assembles.text, 1.0, "number", partial(crank_turns, ends=ends), asked=False)]
    for n in range(len(candidates.quantities)):
        if n == 1:  # it goes its way
            continue
        quantity = candidates.quantity(n, found.numbers)
        constraint = candidates.constraints[n - 1] if n else None
        asked = constraint is not None and constraint.equal
        value = constraint.least if constraint is not None and asked else found.values[n]
        deviates = kinds[n] in ("length", "angle") and quantity.moves
        demands.append(Demand(
            quantity.title(linkage), value or 0.0, kinds[n], partial(quantity.measure, ends=ends), asked=asked,
            at=1e-6 if deviates else 0.0, open=quantity.open, of=quantity.of,
        ))  # fmt: skip
    listings = [_constraints(candidates, found, kinds)]
    title = candidates.quantities[0].title(linkage)
    drawings = [history(evolved, partial(_in_its_unit, candidates), found.values[0], title, kinds[0])]
    for n, quantity in enumerate(candidates.quantities):
        if quantity.wanted:
            listing, drawn = reached(candidates, found.x, n)
            listings.append(listing)
            drawings.insert(0, drawn)
    sketch = candidates.sketch(found.x)
    notes = []
    if evolved.stopped:
        notes.append(N_("stopped by hand: the best candidate so far, polished"))
    elif found.ends is not None and not found.ends.agree:
        notes.append(Phrase(
            "not sure to be the least: of {count} independent starts {same} ended at it and {near} within {share} % "
            "of it; try another seed, for example seed: {seed}",
            count=found.ends.count, same=found.ends.same, near=found.ends.near, share=f"{100 * many_starts.NEAR:g}",
            seed=task.seed + 1,
        ))  # fmt: skip
    objectives = evolved.objective[np.isfinite(evolved.objective)]
    if (task.objective.forces or not task.objective.moves) and len(objectives) and not np.ptp(objectives):
        notes.append(N_("the objective is the same for all candidates: what was found only keeps the constraints"))
    if sketch is not None:
        notes.append(N_(
            "the file's sketch does not show the mechanism that was found: it is assembled as linkages near it are "
            "that the sketch does show"
        ))  # fmt: skip
    return Outcome(
        _given(candidates, ends), _found(candidates, found), _source(candidates, found), tuple(demands),
        tuple(drawings), tuple(notes), tuple(listings), sketch,
    )  # fmt: skip


def _given(candidates: Candidates, ends: tuple[float, float] | None) -> tuple[Value, ...]:
    """Bounds of what varies, and of the driver."""
    given = []
    for p in candidates.task.parameters:
        given.append(Value(p.name, p.low, p.kind, N_("varies from")))
        given.append(Value(p.name, p.high, p.kind, N_("varies to")))
    given += [
        Value(p.name, len(p.values), "number", N_("number of values to choose from"))
        for p in candidates.task.parameters if p.values
    ]  # fmt: skip
    if ends is not None:
        kind = "length" if candidates.linkage.driver.kind == "slide" else "angle"
        given.append(Value("from", ends[0], kind, N_("the driver goes from")))
        given.append(Value("to", ends[1], kind, N_("the driver goes to")))
    return tuple(given)


def _found(candidates: Candidates, found: Best) -> tuple[Value, ...]:
    """The parameters, and whether they lie at a bound."""
    numbers = []
    for p, number, share in zip(candidates.task.parameters, found.numbers.tolist(), found.x.tolist(), strict=True):
        if share < ACTIVE:
            text = N_("found at its lower bound")
        elif share > 1 - ACTIVE:
            text = N_("found at its upper bound")
        else:
            text = N_("found among its values") if p.values else N_("found within its bounds")
        numbers.append(Value(p.name, number, p.kind, text))
    return tuple(numbers)


def _source(candidates: Candidates, found: Best) -> str:
    if many_starts.fits(candidates):
        return N_(
            "differential evolution (R. Storn, K. Price 1997) and random starts, then least squares (K. Levenberg "
            "1944, D. Marquardt 1963)"
        )
    if not found.evolved.every:
        return N_(
            "differential evolution (R. Storn, K. Price 1997; constraints by K. Deb 2000), then sequential quadratic "
            "programming on the exact peaks"
        )
    if found.evolved.stopped:
        return N_("candidates one after another, as far as the search came")
    return N_("all candidates, one after another")


def _constraints(candidates: Candidates, found: Best, kinds: list[str]) -> Listing:
    """The objective and every constraint: bound, value, margin, whether it is active."""
    linkage, objective, target = candidates.linkage, candidates.task.objective, candidates.task.target
    side = N_("near") if target is not None else N_("largest") if objective.lowest else N_("least")
    first = objective.title(linkage), _of(objective), side, target, found.values[0], None, kinds[0], N_("objective")
    rows: list[tuple[Any, ...]] = [first]
    for n, constraint in enumerate(candidates.constraints[1:], 2):
        value, quantity = found.values[n], constraint.quantity
        both = (N_("at least"), constraint.least, 1), (N_("at most"), constraint.most, -1)
        for words, bound, sign in both[: 1 if constraint.equal else 2]:
            if bound is None:
                continue
            margin = sign * (value - bound)
            active = margin <= ACTIVE * constraint.scale
            left: float | None = 0.0 if active else margin
            state = N_("active") if active else N_("not active")
            if constraint.equal:
                words = state = N_("equality, met")
                left = None
            rows.append((quantity.title(linkage), _of(quantity), words, bound, value, left, kinds[n], state))
    columns = (
        ("quantity", N_("quantity"), "word"), ("of", N_("of"), "name"), ("limit", N_("is to be"), "word"),
        ("bound", N_("bound"), "mixed"), ("value", N_("value"), "mixed"), ("margin", N_("margin"), "mixed"),
        ("unit", N_("unit"), "unit"), ("state", N_("state"), "word"),
    )  # fmt: skip
    return Listing("constraints", N_("Objective and constraints"), columns, tuple(rows))


def _of(quantity: Goal) -> str:
    return quantity.name or ", ".join(quantity.links)


def _in_its_unit(candidates: Candidates, f: Real) -> Real:
    """The history of the objective in its own unit; of a target as far above it as the best candidate is from it."""
    target = candidates.task.target
    if target is not None:
        return target * (1 + f) if target else f
    return -f if candidates.task.objective.lowest else f
