"""Outcome of an optimal synthesis: best candidate, constraints, diagram of the search, required and reached motion."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from tmm_cli.batch import DriverSamples
from tmm_cli.language import N_, Phrase
from tmm_cli.mechanics.numerics import NO_VIOLATION, Real, Vector, find_minima
from tmm_cli.synthesis.construction import Diagram, DiagramLine
from tmm_cli.synthesis.measures import driver_completes_range
from tmm_cli.synthesis.optimal import many_starts
from tmm_cli.synthesis.optimal.candidates import Candidates
from tmm_cli.synthesis.optimal.evolution import EvolutionResult
from tmm_cli.synthesis.optimal.quantities.base import MechanismQuantity
from tmm_cli.synthesis.optimal.quantities.transmission import AssemblyReserve
from tmm_cli.synthesis.optimal.refinement import BestCandidate
from tmm_cli.synthesis.record import Demand, Listing, NamedValue, SynthesisOutcome

CURVE = 361  # points of a drawn path or law
NONE = np.zeros(0)

Read = Callable[[DriverSamples, str], Real]


def draw_history(
    evolved: EvolutionResult, to_shown: Callable[[Real], Real], polished: float, quantity: str, kind: str
) -> Diagram:
    """Plot the course of the search against the generation.

    The upper panel shows the objective of the leading candidate of each generation (faint line), the best objective so
    far among the candidates that satisfy the constraints, and the solution (dot). The lower panel shows the constraint
    violation of the leading candidates. With equality constraints, early leading candidates violate them, because the
    tolerance for the violation decreases step by step.

    If all combinations of discrete values were evaluated (`evolved.every`), the horizontal axis is the number of the
    candidate, the faint line shows the feasible candidates, and there is no lower panel.

    Args:
        evolved: result of the search.
        to_shown: function that converts objective values of the search to the values of the quantity.
        polished: value of the objective for the solution.
        quantity, kind: description of the objective, and name of its dimension.
    """
    objective, violation = evolved.history.T
    if evolved.every:
        leading, found_label = (
            N_("candidates, evaluated at the positions of the search"),
            N_("best candidate after exact evaluation"),
        )
        across, title = N_("candidate"), N_("All candidates in order")
    else:
        leading, found_label = (
            N_("leading candidate (rises where a new population starts)"),
            N_("solution after local refinement"),
        )
        across, title = N_("generation"), N_("Best candidate by generation")
    number = np.arange(len(objective))
    feasible = np.where(np.isfinite(objective) & ((violation == 0) | (not evolved.every)), objective, np.nan)
    kept = np.fmin.accumulate(np.where(violation == 0, feasible, np.nan))
    lines = [DiagramLine(leading, number, to_shown(feasible), faint=True)]
    if np.any(np.isfinite(kept)):
        lines.append(DiagramLine(N_("best candidate so far that satisfies the constraints"), number, to_shown(kept)))
    lines.append(DiagramLine(found_label, np.array([len(number)]), np.array([polished]), dots=True))
    missed = np.isfinite(violation) & (violation > NO_VIOLATION)
    violated = DiagramLine(N_("relative constraint violation"), number, np.where(missed, violation, np.nan))
    return Diagram(
        "history",
        title,
        (across, "number"),
        (Phrase("objective: {quantity}", quantity=quantity), kind),
        tuple(lines),
        lower=(violated,) if np.any(missed) and not evolved.every else (),
        lower_y=(N_("relative constraint violation"), "number"),
    )


def compare_reached(candidates: Candidates, x: Real, n: int) -> tuple[Listing, Diagram]:
    """Tabulate and plot the required and the reached values of quantity `n`.

    Args:
        candidates: evaluator of the candidates.
        x: fractions of the ranges of the parameters, shape (n,).
        n: index of the quantity.
    """
    two = x[None]

    def read(positions: DriverSamples, key: str) -> Real:
        outputs: Real = candidates.run(two, positions)[f"{n}.{key}"][0]
        return outputs

    quantity = candidates.quantity(n, candidates.numbers(x))
    return (_compare_law if quantity.of == "law" else _compare_path)(candidates, n, quantity, read)


def _make_table_name(candidates: Candidates, n: int) -> str:
    return f"{candidates.quantities[n].of}-{n}" if n else candidates.quantities[n].of


def _compare_law(candidates: Candidates, n: int, quantity: MechanismQuantity, read: Read) -> tuple[Listing, Diagram]:
    swings = candidates.overs[n].swings
    at, required = np.array(quantity.places), np.array(quantity.wanted)
    low, high = float(np.min(at)), float(np.max(at))
    if candidates.closed:
        high = max(high, low + candidates.cycle)
    else:
        low, high = min(candidates.ends[0], low), max(candidates.ends[1], high)
    q = np.linspace(low, high, CURVE)
    run, reached = read(DriverSamples(NONE, q), "run"), read(DriverSamples(NONE, at), "run")
    if quantity.relative:
        run, reached = run - reached[0], reached - reached[0]
    if swings:
        reached = required + np.angle(np.exp(1j * (reached - required)))
        run = np.unwrap(run)
        run = run + 2 * np.pi * np.round((reached[0] - np.interp(at[0], q, run)) / (2 * np.pi))
    kind = "angle" if swings else "length"
    place = "angle" if candidates.linkage.driver.kind == "turn" else "length"
    columns = (
        ("at", N_("driver position"), place),
        ("wanted", N_("required value"), kind),
        ("reached", N_("reached"), kind),
        ("off", N_("deviation"), kind),
    )
    rows = tuple(zip(quantity.places, required.tolist(), reached.tolist(), (reached - required).tolist(), strict=True))
    lines = (
        DiagramLine(N_("mechanism found"), q, run),
        DiagramLine(N_("required value"), at, required, dots=True),
        DiagramLine(N_("reached"), at, reached, dots=True),
    )
    up = (N_("angle of the link") if swings else N_("displacement of the link"), kind)
    title = N_("Law of motion over the whole range of the driver")
    drawn = Diagram(_make_table_name(candidates, n), title, (N_("driver"), place), up, lines)
    return Listing(_make_table_name(candidates, n), N_("Required and reached law of motion"), columns, rows), drawn


def _compare_path(candidates: Candidates, n: int, quantity: MechanismQuantity, read: Read) -> tuple[Listing, Diagram]:
    required = np.array(quantity.wanted)

    def spots(positions: DriverSamples) -> Vector:
        return read(positions, "px") + 1j * read(positions, "py")

    path = spots(DriverSamples(np.linspace(0, 1, CURVE), NONE))
    if quantity.places:
        reached = spots(DriverSamples(NONE, np.array(quantity.places)))
    else:
        fractions = _find_closest_fractions(
            lambda shares: spots(DriverSamples(shares, NONE)), required, candidates.closed
        )
        reached = spots(DriverSamples(fractions, NONE))
    rows: tuple[tuple[float, ...], ...] = tuple(
        (w.real, w.imag, p.real, p.imag, abs(p - w)) for w, p in zip(required.tolist(), reached.tolist(), strict=True)
    )
    columns: tuple[tuple[str, str, str], ...] = (
        ("x", N_("x"), "length"),
        ("y", N_("y"), "length"),
        ("x_reached", N_("reached x"), "length"),
        ("y_reached", N_("reached y"), "length"),
        ("off", N_("deviation"), "length"),
    )
    if quantity.places:
        rows = tuple((q, *row) for q, row in zip(quantity.places, rows, strict=True))
        columns = (
            ("at", N_("driver position"), "angle" if candidates.linkage.driver.kind == "turn" else "length"),
            *columns,
        )
    lines = (
        DiagramLine(N_("path"), path.real, path.imag),
        DiagramLine(N_("required value"), required.real, required.imag, dots=True),
        DiagramLine(N_("reached"), reached.real, reached.imag, dots=True),
    )
    drawn = Diagram(
        _make_table_name(candidates, n),
        N_("Path of the point over the whole range of the driver"),
        (N_("x"), "length"),
        (N_("y"), "length"),
        lines,
        equal=True,
    )
    title = (
        N_("Required points, and points reached at these positions of the driver")
        if quantity.places
        else N_("Required points, and the nearest points of the path")
    )
    return Listing(_make_table_name(candidates, n), title, columns, rows), drawn


def _find_closest_fractions(path: Callable[[Real], Vector], points: Vector, closed: bool) -> Real:
    """Return the fractions of the driver range at which a path is closest to each of the points."""
    shares, step = np.linspace(0, 1, CURVE), 1 / (CURVE - 1)
    near = shares[np.argmin(np.abs(path(shares) - points[:, None]), axis=1)]
    low, high = near - step, near + step
    ends = (low, high) if closed else (np.maximum(low, 0.0), np.minimum(high, 1.0))
    fractions: Real = find_minima(lambda some: np.abs(path(some) - np.resize(points, len(some))), *ends)[0]
    return fractions


# The outcome: best candidate, constraints, search, path or law reached.


ACTIVE = 1e-6  # relative: a constraint closer to its bound is active


def outcome_of(candidates: Candidates, best: BestCandidate) -> SynthesisOutcome:
    """Return the outcome of a search whose best candidate satisfies all constraints.

    It contains the solution, its tables and diagrams, and the values to be measured on the mechanism.
    """
    task, evolved, linkage = candidates.task, best.evolved, candidates.linkage
    kinds = [quantity.kind(linkage, candidates.groups) for quantity in candidates.quantities]
    ends = task.make(best.numbers.tolist()).ends
    ends = None if ends is None else (float(ends[0]), float(ends[1]))
    demands = [Demand(AssemblyReserve.text, 1.0, "number", partial(driver_completes_range, ends=ends), asked=False)]
    for n in range(len(candidates.quantities)):
        if n == 1:  # the assembly constraint
            continue
        quantity = candidates.quantity(n, best.numbers)
        constraint = candidates.constraints[n - 1] if n else None
        is_required = constraint is not None and constraint.equal
        value = constraint.least if constraint is not None and is_required else best.values[n]
        deviates = kinds[n] in ("length", "angle") and quantity.moves
        demands.append(
            Demand(
                quantity.title(linkage),
                value or 0.0,
                kinds[n],
                partial(quantity.measure, ends=ends),
                asked=is_required,
                at=1e-6 if deviates else 0.0,
                open=quantity.open,
                of=quantity.of,
            )
        )
    listings = [_tabulate_constraints(candidates, best, kinds)]
    title = candidates.quantities[0].title(linkage)
    drawings = [draw_history(evolved, partial(_convert_objective, candidates), best.values[0], title, kinds[0])]
    for n, quantity in enumerate(candidates.quantities):
        if quantity.wanted:
            listing, drawn = compare_reached(candidates, best.x, n)
            listings.append(listing)
            drawings.insert(0, drawn)
    sketch = candidates.sketch(best.x)
    notes = []
    if evolved.stopped:
        notes.append(
            N_("the user stopped the search: the solution is the best candidate found so far, after local refinement")
        )
    elif best.ends is not None and not best.ends.agree:
        notes.append(
            Phrase(
                (
                    "the minimum is uncertain. Independent starts: {count}; starts that reached this value: {same}; "
                    "starts that came within {share} % of it: {near}. Try another seed, e.g. seed: {seed}"
                ),
                count=best.ends.count,
                same=best.ends.same,
                near=best.ends.near,
                share=f"{100 * many_starts.NEAR:g}",
                seed=task.seed + 1,
            )
        )
    objectives = evolved.objective[np.isfinite(evolved.objective)]
    if (task.objective.forces or not task.objective.moves) and len(objectives) and not np.ptp(objectives):
        notes.append(
            N_(
                "the objective has the same value for all candidates: the solution satisfies the constraints, but "
                "nothing was minimised"
            )
        )
    if sketch is not None:
        notes.append(
            N_(
                "the sketch in the file does not match the mechanism found; the mechanism was assembled like "
                "similar linkages that match the sketch"
            )
        )
    return SynthesisOutcome(
        _list_bounds(candidates, ends),
        _list_solution_values(candidates, best),
        _describe_source(candidates, best),
        tuple(demands),
        tuple(drawings),
        tuple(notes),
        tuple(listings),
        sketch,
    )


def _list_bounds(candidates: Candidates, ends: tuple[float, float] | None) -> tuple[NamedValue, ...]:
    """List the bounds of the parameters and the range of the driver."""
    bounds = []
    for p in candidates.task.parameters:
        bounds.append(NamedValue(p.name, p.low, p.kind, N_("lower bound")))
        bounds.append(NamedValue(p.name, p.high, p.kind, N_("upper bound")))
    bounds += [
        NamedValue(p.name, len(p.values), "number", N_("number of admissible values"))
        for p in candidates.task.parameters
        if p.values
    ]
    if ends is not None:
        kind = "length" if candidates.linkage.driver.kind == "slide" else "angle"
        bounds.append(NamedValue("from", ends[0], kind, N_("start of the driver's range")))
        bounds.append(NamedValue("to", ends[1], kind, N_("end of the driver's range")))
    return tuple(bounds)


def _list_solution_values(candidates: Candidates, best: BestCandidate) -> tuple[NamedValue, ...]:
    """List the parameter values found; the description states whether a value lies at a bound."""
    numbers = []
    for p, number, share in zip(candidates.task.parameters, best.numbers.tolist(), best.x.tolist(), strict=True):
        if share < ACTIVE:
            text = N_("value found, at the lower bound")
        elif share > 1 - ACTIVE:
            text = N_("value found, at the upper bound")
        else:
            text = N_("value found, one of the admissible values") if p.values else N_("value found, within the bounds")
        numbers.append(NamedValue(p.name, number, p.kind, text))
    return tuple(numbers)


def _describe_source(candidates: Candidates, best: BestCandidate) -> str:
    if many_starts.is_least_squares(candidates):
        return N_(
            "differential evolution (R. Storn, K. Price 1997) and random starting points, then nonlinear least "
            "squares (K. Levenberg 1944, D. Marquardt 1963)"
        )
    if not best.evolved.every:
        return N_(
            "differential evolution (R. Storn, K. Price 1997; constraints by K. Deb 2000), then sequential "
            "quadratic programming with exact peak values"
        )
    if best.evolved.stopped:
        return N_("evaluation of all candidates in order, stopped before the end")
    return N_("evaluation of all candidates")


def _tabulate_constraints(candidates: Candidates, best: BestCandidate, kinds: list[str]) -> Listing:
    """Tabulate the objective and every constraint: bound, value, margin and state."""
    linkage, objective, target = candidates.linkage, candidates.task.objective, candidates.task.target
    side = (
        N_("as close as possible to")
        if target is not None
        else N_("largest value")
        if objective.lowest
        else N_("smallest value")
    )
    first = (
        objective.title(linkage),
        _name_subject(objective),
        side,
        target,
        best.values[0],
        None,
        kinds[0],
        N_("objective"),
    )
    rows: list[tuple[Any, ...]] = [first]
    for n, constraint in enumerate(candidates.constraints[1:], 2):
        value, quantity = best.values[n], constraint.quantity
        both = (N_("at least"), constraint.least, 1), (N_("at most"), constraint.most, -1)
        for words, bound, sign in both[: 1 if constraint.equal else 2]:
            if bound is None:
                continue
            margin = sign * (value - bound)
            active = margin <= ACTIVE * constraint.scale
            left: float | None = 0.0 if active else margin
            state = N_("active") if active else N_("not active")
            if constraint.equal:
                words = state = N_("equality, satisfied")
                left = None
            rows.append((quantity.title(linkage), _name_subject(quantity), words, bound, value, left, kinds[n], state))
    columns = (
        ("quantity", N_("quantity"), "word"),
        ("of", N_("link, pair or point"), "name"),
        ("limit", N_("condition"), "word"),
        ("bound", N_("bound"), "mixed"),
        ("value", N_("value"), "mixed"),
        ("margin", N_("margin"), "mixed"),
        ("unit", N_("unit"), "unit"),
        ("state", N_("state of the constraint"), "word"),
    )
    return Listing("constraints", N_("Objective and constraints"), columns, tuple(rows))


def _name_subject(quantity: MechanismQuantity) -> str:
    return quantity.name or ", ".join(quantity.links)


def _convert_objective(candidates: Candidates, f: Real) -> Real:
    """Convert objective values of the search to values of the quantity: relative distances from a target, or negated
    margins.
    """
    target = candidates.task.target
    if target is not None:
        return target * (1 + f) if target else f
    return -f if candidates.task.objective.lowest else f
