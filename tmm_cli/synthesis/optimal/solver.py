"""Search of an optimal synthesis: candidates, differential evolution, refinement of the best, outcome."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.synthesis.optimal import many_starts
from tmm_cli.synthesis.optimal.candidates import LOST, Candidates
from tmm_cli.synthesis.optimal.evolution import DiscreteChoices, EvolutionResult, evolve
from tmm_cli.synthesis.optimal.outcome import outcome_of
from tmm_cli.synthesis.optimal.quantities.base import MechanismQuantity
from tmm_cli.synthesis.optimal.refinement import BestCandidate, evaluate_exactly, refine_candidate
from tmm_cli.synthesis.optimal.task import OptimalTask
from tmm_cli.synthesis.record import Infeasible, SynthesisOutcome

PARAMETERS: Final[dict[str, str]] = {}
SHORTER = 20  # factor by which the evolution is shortened if many starting points follow
STARTS = 3  # distinct starting points of the refinement; one if candidates are evaluated one by one
HOPE = 1.0  # relative: worse starting points are not refined
APART = 0.02  # fraction of the ranges: distinct candidates are further apart
MISS_TOLERANCE = 1e-7  # relative violation that counts as satisfied
NEVER: Final = N_(
    "no mechanism within these bounds completes the range of its driver. Widen the bounds, or give "
    "another range with the key over"
)


def solve(task: OptimalTask) -> SynthesisOutcome:
    """Find the best mechanism. Raises Infeasible."""
    candidates = Candidates(task)
    best = find_best(candidates)
    if best.missed:
        raise _make_constraint_refusal(candidates, best)
    return outcome_of(candidates, best)


def find_best(candidates: Candidates) -> BestCandidate:
    """Search for the best candidates over the whole ranges of the parameters, and refine them.

    Raises:
        Infeasible: no candidate completes the range of its driver.
    """
    task = candidates.task
    choices = DiscreteChoices(candidates) if len(task.free) < len(task.parameters) else None
    if choices is not None and choices.few:
        evolved = choices.evaluate_all()
        return _refine_starts(candidates, choices.find_starts(), evolved)
    many = many_starts.is_least_squares(candidates)
    evolved = evolve(
        choices or candidates.evaluate,
        len(task.parameters),
        population=candidates.population,
        generations=max(1, candidates.generations // (SHORTER if many else 1)),
        seed=task.seed,
        equalities=any(constraint.equal for constraint in candidates.constraints),
        progress=task.progress,
    )
    starts = _choose_distinct_starts(candidates, evolved)
    if many and not evolved.stopped:
        many_result = many_starts.search_from_many(candidates, starts)
        led = _refine_starts(
            candidates, [*many_result.starts[:1], *starts[:1]], replace(evolved, stopped=many_result.stopped)
        )
        return replace(led, ends=many_result.ends)
    return _refine_starts(candidates, starts if choices is None else [*starts, *choices.find_starts()], evolved)


def _choose_distinct_starts(candidates: Candidates, evolved: EvolutionResult) -> list[Real]:
    """Return the best candidates of an evolution that differ clearly from one another, with admissible discrete
    values.
    """
    starts: list[Real] = []
    first = evolved.objective[0]
    population = candidates.shares(candidates.numbers(evolved.population))
    for x, f in zip(population, evolved.objective, strict=True):
        hopeful = f == first or not f - first > HOPE * abs(first)
        if hopeful and all(np.max(np.abs(x - s)) > APART for s in starts):
            starts.append(x)
        if len(starts) == (STARTS if candidates.traced else 1):
            break
    return starts


def _refine_starts(candidates: Candidates, starts: Iterable[Real], evolved: EvolutionResult) -> BestCandidate:
    """Return the best candidate among the starting points and the local optima near them.

    Raises:
        Infeasible: no candidate completes the range of its driver, or the objective is undefined for all of them.
    """
    refined: list[tuple[float, float, Real, list[float]]] = []

    def take(x: Real) -> None:
        try:
            values = evaluate_exactly(candidates, x)
        except ValueError:
            return
        both = zip(candidates.constraints, values[1:], strict=True)
        missed = float(sum(constraint.compute_violation(value) for constraint, value in both))
        missed += LOST * (candidates.constraints[0].compute_violation(values[1]) > MISS_TOLERANCE)
        refined.append(
            (
                missed if missed > MISS_TOLERANCE else 0.0,
                float(candidates.objective_value(np.array(values[0]))),
                x,
                values,
            )
        )

    try:
        for start in starts:
            take(start)
            if candidates.task.free:
                take(refine_candidate(candidates, start))
    except KeyboardInterrupt:
        if not refined:
            raise
        evolved = replace(evolved, stopped=True)
    goes = any(candidates.constraints[0].compute_violation(values[1]) <= MISS_TOLERANCE for *__, values in refined)
    refined = [entry for entry in refined if not np.isnan(entry[0] + entry[1])]
    if not refined:
        if goes or evolved.violation[0] == 0.0:
            raise Infeasible("objective", _explain_undefined(candidates, candidates.task.objective))
        raise Infeasible("vary", NEVER)
    missed, __, x, values = min(refined, key=lambda entry: entry[:2])
    return BestCandidate(x, candidates.numbers(x), values, missed, evolved)


def _explain_undefined(candidates: Candidates, quantity: MechanismQuantity) -> str:
    """Return the reason why a quantity is undefined for all candidates.

    For example, forces are undefined if the driver, with its acceleration, does not reach all positions of its range.
    """
    if quantity.forces and candidates.variant.accelerated:
        return N_(
            "with this acceleration the driver does not reach all positions of its range: it stops earlier, or "
            "some positions lie before position 0"
        )
    return N_("within the bounds no mechanism was found for which this quantity is defined")


def _make_constraint_refusal(candidates: Candidates, best: BestCandidate) -> Infeasible:
    """Return the error for the most violated constraint, with the nearest value that is possible under the other
    constraints.
    """
    both = zip(candidates.constraints, best.values[1:], strict=True)
    misses = [float(constraint.compute_violation(value)) for constraint, value in both]
    n = int(np.argmax(misses))
    constraint, value = candidates.constraints[n], best.values[n + 1]
    if misses[0] > MISS_TOLERANCE:
        return Infeasible("vary", NEVER)
    if np.isnan(value):
        return Infeasible(constraint.at, _explain_undefined(candidates, constraint.quantity))
    bound, at = constraint.find_violated_bound(value)
    others = tuple(other for other in candidates.task.constraints if other is not constraint)
    task = replace(candidates.task, objective=constraint.quantity, constraints=others, target=bound)
    near = _refine_starts(Candidates(task), [best.x], best.evolved)
    reason = _("within the bounds no mechanism was found that satisfies this constraint together with the others")
    if near.missed:
        return Infeasible(at, reason)
    side = 0 if constraint.equal else -1 if near.values[0] < bound else 1
    kind = constraint.quantity.kind(candidates.linkage, candidates.groups)
    return Infeasible(at, reason, (near.values[0], kind, side))
