"""Velocities and accelerations from higher pairs: Willis's formula for gears, rolling on a rack, cam laws of motion."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.groups import carrier_axis
from tmm_cli.mechanics.linkage import FRAME, Mesh
from tmm_cli.mechanics.plans import FixedGuideEquation, HigherPairRatio, MovingGuideEquation, SolutionStep
from tmm_cli.note.blocks import Block, Equation, write_sentence
from tmm_cli.note.expression import ComputedQuantity, Expression, Function, Leaf, apply_sign, symbolic_formula
from tmm_cli.note.formula_tree import Letter, row
from tmm_cli.note.kinematics.equations import name_sense
from tmm_cli.note.kinematics.on_paper import DrawnVector, PositionPlans, unit_of, zero_equation


def write_higher_pairs(position: PositionPlans, step: SolutionStep, letter: str) -> Iterable[Block]:
    """Write the angular velocities or accelerations that the higher pairs of a group give. letter: ω or ε."""
    assert step.group is not None
    if step.ratios:
        yield write_sentence(_("The motion of group {group} follows from its higher pairs."), group=step.group.title)
    elif not position.first:
        yield write_sentence(_("Group {group}:"), group=step.group.title)
    for ratio in step.ratios:
        yield from _write_rate(position, step, ratio, letter)


def _write_rate(position: PositionPlans, step: SolutionStep, ratio: HigherPairRatio, letter: str) -> Iterable[Block]:
    """Write the angular velocity or acceleration of a link that follows from a higher pair.

    For a sliding rack or follower it is the velocity or acceleration in its prismatic pair.
    """
    mesh, first = ratio.mesh, position.first and letter == "ω"
    if mesh.kind == "gear":
        if first:
            yield from _write_gear_ratio(position, mesh)
        yield _gear_rate(position, mesh, ratio.link, letter)
    elif mesh.kind == "rack":
        if first:
            text = _("Gear {wheel} of radius {radius} rolls on the rack without slipping, so")
            yield write_sentence(text, wheel=mesh.i, radius=Symbol("r", mesh.i))
        yield _rolling_rate(position, step, ratio, letter)
    else:
        if position.first:
            yield _introduce_cam_law(mesh, letter)
        yield _follower_rate(position, step, ratio, letter)
    if letter == "ω" and position.omega.get(ratio.link):
        yield write_sentence(
            _("Link {link} rotates {sense}."), link=ratio.link, sense=name_sense(position.omega[ratio.link])
        )


def _signed_rate(position: PositionPlans, link: str, letter: str) -> Leaf | None:
    """Return the angular velocity or acceleration of a link with its sign; None if the link never rotates."""
    rates = position.rates(letter)
    return Leaf(Symbol(letter, link), rates[link]) if link in rates else None


def _subtract_rates(minuend: Expression | None, subtrahend: Expression | None) -> Expression | None:
    """Return the difference of two angular velocities or accelerations. None stands for a link that does not rotate."""
    if minuend is None or subtrahend is None:
        return minuend if subtrahend is None else -subtrahend
    return minuend - subtrahend


def _write_gear_ratio(position: PositionPlans, mesh: Mesh) -> Iterable[Block]:
    """Write the transmission ratio of two gears relative to their carrier."""
    linkage = position.motion.linkage
    a, b = (complex(carrier_axis(linkage, wheel, mesh.carrier)) for wheel in (mesh.i, mesh.j))
    pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
    radii = Leaf(Symbol("r", mesh.i), abs(pitch - a)) / Leaf(Symbol("r", mesh.j), abs(pitch - b))
    carrier_rotates = _signed_rate(position, mesh.carrier, "ω") is not None
    over, under, carrier = (Leaf(Symbol("ω", link)) for link in (mesh.j, mesh.i, mesh.carrier))
    share = over / under
    text = _(
        "Gears {i} and {j} with the pitch radii {ri} and {rj} are in mesh; their ratio (angular velocities "
        "are positive counterclockwise) is"
    )
    if carrier_rotates:
        share = (over - carrier) / (under - carrier)
        text = _(
            "Gears {i} and {j} with the pitch radii {ri} and {rj} are in mesh; their axes are on carrier "
            "{carrier}. By Willis's method all links are given the reverse rotation of the carrier, so that "
            "the carrier is at rest. The ratio of the gears (angular velocities are positive counterclockwise) "
            "is then"
        )
    ri, rj = Symbol("r", mesh.i), Symbol("r", mesh.j)
    yield write_sentence(text, i=mesh.i, j=mesh.j, carrier=mesh.carrier, ri=ri, rj=rj)
    yield Equation(row(Letter(_ratio_symbol(mesh)), "=", symbolic_formula(share)))
    yield ComputedQuantity(_ratio_symbol(mesh), apply_sign(mesh.ratio, radii), mesh.ratio)
    yield write_sentence(_("The required angular velocity is therefore:"))


def _ratio_symbol(mesh: Mesh) -> Symbol:
    return Symbol("u", mesh.j + mesh.i, "" if mesh.carrier == FRAME else f"({mesh.carrier})")


def _gear_rate(position: PositionPlans, mesh: Mesh, link: str, letter: str) -> Block:
    """Return the angular velocity or acceleration of one of two gears or of their carrier, from the other two links."""
    i, j, c = (_signed_rate(position, name, letter) for name in (mesh.i, mesh.j, mesh.carrier))
    u, rate = Leaf(_ratio_symbol(mesh), mesh.ratio), _signed_rate(position, link, letter)
    if rate is None:
        return zero_equation(Symbol(letter, link))
    forward = link == mesh.j
    other_gear = i if forward else j
    if link == mesh.carrier:
        expression = _subtract_rates(j, u * i if i else None)
        assert expression is not None
        expression = expression / (1 - u)
    elif other_gear is None and c is not None:
        expression = c * (1 - (u if forward else 1 / u))
    else:
        relative = _subtract_rates(other_gear, c)
        assert relative is not None
        share = u * relative if forward else relative / u
        expression = share if c is None else c + share
    return ComputedQuantity(rate.symbol, expression, rate.value, unit_of(letter))


def _sliding_vector(position: PositionPlans, step: SolutionStep, ratio: HigherPairRatio, letter: str) -> DrawnVector:
    """Return the velocity or acceleration in the prismatic pair of a rack or a cam follower."""
    slide, plan = position.motion.linkage.slide(ratio.mesh.slide), position.plan_of(letter)
    equation = next(
        (
            e
            for e in step.equations
            if isinstance(e, MovingGuideEquation | FixedGuideEquation) and e.slide.name == slide.name
        ),
        None,
    )
    if isinstance(equation, MovingGuideEquation):
        return (
            plan.relative(equation.point, equation.base)
            if letter == "ω"
            else plan.component(equation.point, equation.base, "r")
        )
    return plan.vector_of(equation.point if equation is not None else slide.point)


def _rolling_rate(position: PositionPlans, step: SolutionStep, ratio: HigherPairRatio, letter: str) -> Block:
    mesh = ratio.mesh
    run, radius = _sliding_vector(position, step, ratio, letter), Leaf(Symbol("r", mesh.i), abs(mesh.ratio))
    wheel, carrier = (_signed_rate(position, link, letter) for link in (mesh.i, mesh.carrier))
    turning = _subtract_rates(wheel, carrier)
    if turning is None:
        return zero_equation(run.symbol if ratio.slide is not None else Symbol(letter, ratio.link))
    if ratio.slide is not None:
        printed_unit = unit_of(position.plan_of(letter).kind.letter)
        return ComputedQuantity(run.symbol, radius * Function("abs", turning), run.size, printed_unit)
    alone = Symbol(letter, mesh.i if carrier is None else f"{mesh.i}{mesh.carrier}")
    value = abs((wheel.value if wheel else 0.0) - (carrier.value if carrier else 0.0))
    return ComputedQuantity(alone, run.leaf / radius, value, unit_of(letter))


def _introduce_cam_law(mesh: Mesh, letter: str) -> Block:
    text = _("The second derivative {second} from the law of motion gives")
    if letter == "ω" and mesh.slide:
        text = _(
            "The law of motion of follower {follower} gives the derivative {first} of its displacement with "
            "respect to the angle of cam {cam}:"
        )
    elif letter == "ω":
        text = _(
            "The law of motion of follower {follower} gives the derivative {first} of its angle with respect "
            "to the angle of cam {cam}:"
        )
    return write_sentence(
        text, follower=mesh.j, cam=mesh.i, first=_derivative_symbol(mesh, 1), second=_derivative_symbol(mesh, 2)
    )


def _derivative_symbol(mesh: Mesh, order: int) -> Symbol:
    return Symbol(("s" if mesh.slide else "ψ") + ("′" if order == 1 else "″"))


def _follower_rate(position: PositionPlans, step: SolutionStep, ratio: HigherPairRatio, letter: str) -> Block:
    mesh = ratio.mesh
    assert mesh.law is not None
    poses, cam, carrier = position.motion.poses, mesh.i, mesh.carrier
    __, first, second = (float(value[position.k]) for value in mesh.law(poses[cam].turned - poses[carrier].turned))
    omega, epsilon = (
        _subtract_rates(_signed_rate(position, cam, letter), _signed_rate(position, carrier, letter)) for letter in "ωε"
    )
    omega = Leaf(Symbol("ω", cam), 0.0) if omega is None else omega  # the cam is at rest
    by_law = Leaf(_derivative_symbol(mesh, 1), first)
    expression: Expression = by_law * omega
    if letter == "ε":
        expression = Leaf(_derivative_symbol(mesh, 2), second) * omega**2
        if epsilon is not None:
            expression = expression + by_law * epsilon
    if mesh.slide:
        return position.plan_of(letter).write_magnitude(
            _sliding_vector(position, step, ratio, letter), Function("abs", expression)
        )
    rate = _signed_rate(position, mesh.j, letter)
    if rate is None or rate.value == 0:
        return zero_equation(Symbol(letter, mesh.j))
    return ComputedQuantity(rate.symbol, expression, rate.value, unit_of(letter))
