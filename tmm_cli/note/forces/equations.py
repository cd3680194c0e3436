"""Moment equations and sums of projections as formulas, and the unknowns that they give."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tmm_cli.language import _
from tmm_cli.mechanics.forces import ForceSum, GuideComponent, MomentEquation, MomentTerm, Symbol
from tmm_cli.note.expression import ComputedQuantity, Expression, Leaf, Product, apply_sign, sum_terms, symbolic_formula
from tmm_cli.note.formula_tree import Letter, Node, Number, chain_of_equalities, row

MU = Symbol("μ", "l")
ALONG = 1e-12  # largest 1 - cos of the angle at which a force counts as parallel to the guide


def moment_equation(equation: MomentEquation, mu: float | None = None) -> Node:
    """Return a moment equation as a formula with the unknown first: ΣM_E = −R·h₃ + G·h₁ − ... = 0.

    mu: scale (m/mm) of the drawing if arms are measured on it in mm. Couples are then written as M/μ_l. If it is None,
    arms are in metres.
    """
    unknown = equation.found
    terms = [*([unknown] if unknown else []), *(t for t in equation.terms if t is not unknown)]
    return chain_of_equalities(
        (
            Letter(Symbol("ΣM", equation.about)),
            symbolic_formula(sum_terms(_moment_term(t, mu) for t in terms)),
            Number("0"),
        )
    )


def solve_moment_equation(equation: MomentEquation, unit: str = "", mu: float | None = None) -> ComputedQuantity | None:
    """Return the unknown of a moment equation, computed from the other terms.

    Args:
        equation: moment equation.
        unit: unit of moments if it is not N·m.
        mu: scale (m/mm) if arms are in millimetres of the drawing. A couple is then substituted as M/μ_l, and a sum of
            F·h is multiplied by μ_l to give a moment (MATI guidelines, equation 7).

    Returns:
        The unknown. If the equation has no single unknown, the sum of its moments, which is zero. None if no force has
        a moment.
    """
    unknown, sought = equation.found, equation.sought
    others: Expression = sum_terms(_moment_term(t, mu) for t in equation.terms if t is not unknown)
    unit = unit or _("N·m")
    if unknown is None or sought is None:
        unit = unit if mu is None else _("N·mm")
        return (
            ComputedQuantity(Symbol("ΣM", equation.about), others, 0.0, unit) if equation.terms and not sought else None
        )
    others = apply_sign(-unknown.moment, others)
    magnitude, arm = Leaf(unknown.acting.symbol, unknown.acting.size), _arm_leaf(unknown, mu)
    if unknown.acting.couple:
        if mu is None or not any(term.number for term in equation.terms):
            couples = apply_sign(
                -unknown.moment, sum_terms(_moment_term(t) for t in equation.terms if t is not unknown)
            )
            return ComputedQuantity(magnitude.symbol, couples, magnitude.value, unit)
        return ComputedQuantity(magnitude.symbol, others * Leaf(MU, mu), magnitude.value, unit)
    if sought.arm:
        return ComputedQuantity(arm.symbol, others / magnitude, arm.value, _("m") if mu is None else _("mm"))
    return ComputedQuantity(magnitude.symbol, others / arm, magnitude.value, _("N"))


def solve_guide_sum(forces: ForceSum) -> tuple[Node, ComputedQuantity]:
    """Return the sum of projections onto a guide, ΣF = R − G·cos α₁ + ... = 0, and the unknown that it gives."""
    unknown = forces.found
    components = [unknown, *(component for component in forces.parts if component is not unknown)]
    projections = [_projection(component, number) for number, component in enumerate(components)]
    terms = [
        apply_sign(component.along, projection) for component, projection in zip(components, projections, strict=True)
    ]
    whole = chain_of_equalities((Letter(Symbol("ΣF", forces.guide)), symbolic_formula(sum_terms(terms)), Number("0")))
    rest = apply_sign(-unknown.along, sum_terms(terms[1:]))
    if isinstance(projections[0], Product):  # the unknown force is not parallel to the guide
        rest = rest / projections[0].factors[1]
    return whole, ComputedQuantity(unknown.acting.symbol, rest, unknown.acting.size, _("N"))


def vector_sum_equation(vectors: Sequence[tuple[Symbol, int]]) -> Node:
    """Return the equation by which the sum of vectors is zero.

    vectors: symbol of each vector, with its number of underlines: 2 if it is known, 1 if only its line of action is
    known.
    """
    nodes = [node for symbol, lines in vectors for node in ("+", Letter(symbol, vector=True, lines=lines))]
    return chain_of_equalities((row(*nodes[1:]), Number("0")))


def _moment_term(term: MomentTerm, mu: float | None = None) -> Expression:
    force = Leaf(term.acting.symbol, term.acting.size)
    if term.number:
        return apply_sign(term.moment, force * _arm_leaf(term, mu))
    return apply_sign(term.moment, force if mu is None else force / Leaf(MU, mu))


def _arm_leaf(term: MomentTerm, mu: float | None) -> Leaf:
    """Return the moment arm of a force, in metres; if a scale (m/mm) is given, in millimetres of the drawing."""
    return Leaf(term.letter, term.arm if mu is None else term.arm / mu)


def _projection(component: GuideComponent, number: int) -> Expression:
    force = Leaf(component.acting.symbol, component.acting.size)
    if math.isclose(component.cosine, 1.0, rel_tol=ALONG):
        return force
    return force * Leaf(Symbol("cos α", str(number)), component.cosine)
