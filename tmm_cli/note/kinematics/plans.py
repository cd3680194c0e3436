"""Velocities and accelerations of one position, in the order in which the plans are drawn.

The driving links come first, then each group with its vector equations and the values that the plan gives. Normal and
Coriolis accelerations are computed from the velocities.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.mechanics.plans import (
    FixedGuideEquation,
    MovingGuideEquation,
    SameLinkEquation,
    SolutionStep,
    VectorEquation,
)
from tmm_cli.note.blocks import Block, join_inline, write_sentence
from tmm_cli.note.kinematics import equations as words
from tmm_cli.note.kinematics.equations import write_equations, write_point_of_known_link
from tmm_cli.note.kinematics.higher_pairs import write_higher_pairs
from tmm_cli.note.kinematics.on_paper import DrawnVector, PositionPlans


def write_velocities(position: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the velocities of a position in the order in which the plan is drawn."""
    known_names: set[str] = set()
    for step in steps:
        if step.group is None:
            yield from _write_driver_velocities(position, step)
            known_names |= words.solved_points(step)
    yield from words.write_scale(
        position.v,
        [vector for step in steps for vector in _known_velocities(position, step)],
        _(
            "The velocity plan begins at its pole {pole}. The segment {segment} represents {v}; the scale "
            "factor of the plan is"
        ),
        _("All points are at rest in this position."),
    )
    for step in steps:
        if step.group is not None:
            yield from _write_group_velocities(position, step, known_names)
            known_names |= words.solved_points(step)
    yield from words.write_remaining_points(position, position.v, known_names)


def _write_driver_velocities(position: PositionPlans, step: SolutionStep) -> Iterable[Block]:
    """Write the velocities of the points of an input link."""
    turned = words.further_points(step)
    if position.first and turned:
        for_one = _(
            "The velocity of point {points} of the input link is perpendicular to {line} and directed in the "
            "sense in which the link rotates:"
        )
        for_several = _(
            "The velocities of points {points} of the input link are perpendicular to the radii of the points "
            "and directed in the sense in which the link rotates:"
        )
        line = turned[0].base.at + turned[0].point.at
        points = join_inline(words.point_symbol(about.point) for about in turned)
        yield write_sentence(for_one if len(turned) == 1 else for_several, points=points, line=line)
    elif position.first and step.equations:
        text = _("Link {link} does not rotate: all its points move with the given velocity {v}.")
        yield write_sentence(text, link=step.links[0], v=position.v.vector_of(step.equations[0].point).symbol)
    for about in turned:
        yield _rotational_velocity(position, about)


def _rotational_velocity(position: PositionPlans, about: SameLinkEquation) -> Block:
    """Return the line that computes the velocity v = ω l of a point relative to another point of its link."""
    velocity = position.v.relative(about.point, about.base)
    return position.v.write_magnitude(
        velocity, position.rate("ω", about.link) * position.length(about.point, about.base)
    )


def _known_velocities(position: PositionPlans, step: SolutionStep) -> Iterable[DrawnVector]:
    """Yield the velocities that are known before the plan is drawn."""
    for equation in (*step.equations, *(step.after if step.group is None else ())):
        if equation.known and isinstance(equation, FixedGuideEquation):
            yield position.v.vector_of(equation.point)
        elif equation.known and not isinstance(equation, FixedGuideEquation):
            yield position.v.relative(equation.point, equation.base)


def _write_group_velocities(
    position: PositionPlans, step: SolutionStep, known_names: Collection[str]
) -> Iterable[Block]:
    """Write the velocities of a group.

    Those that follow from higher pairs come first, then those from vector equations and the plan, then those of further
    points.
    """
    points, together, solved_names = (
        words.unknown_points(step, known_names),
        words.simultaneous_equations(step),
        {*known_names},
    )
    yield from write_higher_pairs(position, step, "ω")
    for about in words.direct_equations(step):
        yield from _write_velocity_on_known_link(position, about, solved_names)
        solved_names.add(about.point.name)
    if position.first and together:
        for_one = _("Group {group}: the velocity of point {points} is found from the equations")
        for_several = _("Group {group}: the velocities of points {points} are found from the equations")
        yield words.introduce_equations(step, points, for_one, for_several)
        yield from write_equations(position, step, together, "v", solved_names)
        for link in dict.fromkeys(e.link for e in together if isinstance(e, SameLinkEquation) and e.idle):
            yield write_sentence(_("Link {link} does not rotate, so all its points have the same velocity."), link=link)
        yield write_sentence(_("The plan gives:")) if step.on_paper else words.explain_numerical_solution()
    for spot in points:
        yield position.v.measure(position.v.vector_of(spot))
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known and not equation.base.fixed:
            yield position.v.measure(position.v.relative(equation.point, equation.base))
    yield from words.write_rotation(
        position,
        together,
        "ω",
        lambda about: position.v.relative(about.point, about.base),
        _("Vector {v}, transferred to point {point}, shows that link {link} rotates {sense}."),
        _("Link {link} rotates {sense}."),
    )
    yield from words.write_common_rotation(position, step, "ω")
    for about in words.further_points(step):
        yield from _write_velocity_on_known_link(position, about, solved_names)


def _write_velocity_on_known_link(
    position: PositionPlans, about: SameLinkEquation, solved_names: Collection[str]
) -> Iterable[Block]:
    """Write the velocity of a point of a link whose rotation is known.

    solved_names: names of the points whose velocities are known.
    """
    yield from write_point_of_known_link(position, about, "v", solved_names)
    yield _rotational_velocity(position, about)
    if not about.base.fixed:
        yield position.v.measure(position.v.vector_of(about.point))


# Accelerations of a position: normal and Coriolis parts from velocities, the rest by vector equations and the plan.


def write_accelerations(position: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the accelerations of a position in the order in which the plan is drawn."""
    known_names: set[str] = set()
    driving, groups = ([step for step in steps if (step.group is None) is first] for first in (True, False))
    for step in driving:
        yield from _write_driver_accelerations(position, step)
        known_names |= words.solved_points(step)
    for step in groups:
        yield from _write_equations_and_components(position, step, known_names)
        if step == groups[0]:
            yield from _write_acceleration_scale(position, [*driving, step])
        yield from _write_plan_solution(position, step, known_names)
        known_names |= words.solved_points(step)
    if not groups:
        yield from _write_acceleration_scale(position, steps)
    yield from words.write_remaining_points(position, position.a, known_names)


def _write_driver_accelerations(position: PositionPlans, step: SolutionStep) -> Iterable[Block]:
    """Write the accelerations of the points of an input link."""
    for equation in step.equations:
        a = position.a.vector_of(equation.point)
        text = _("Input link {link} moves uniformly, so {a} = 0.")
        if a.segment:
            text = _("All points of link {link} have the acceleration {a} of the driver.")
        yield write_sentence(text, link=step.links[0], a=a.symbol)
    turned = words.further_points(step)
    if turned and position.first:
        even = _(
            "Input link {link} rotates uniformly: the accelerations of its points are purely normal, directed "
            "towards the axis of rotation."
        )
        uneven = _(
            "Input link {link} does not rotate uniformly: the accelerations of its points have normal and "
            "tangential components."
        )
        yield write_sentence(uneven if step.links[0] in position.epsilon else even, link=step.links[0])
    for about in turned:
        yield from _write_components(position, about)
        yield from _write_total_acceleration(position, about)


def _write_components(position: PositionPlans, about: SameLinkEquation) -> Iterable[Block]:
    """Write the normal and the tangential acceleration of a point of a link whose rotation is known."""
    yield _normal_acceleration(position, about)
    tangential = _component(position, about, "τ")
    if tangential.segment or about.link in position.epsilon:
        yield position.a.write_magnitude(
            tangential, position.rate("ε", about.link) * position.length(about.point, about.base)
        )


def _normal_acceleration(position: PositionPlans, about: SameLinkEquation) -> Block:
    length = position.length(about.point, about.base)
    return position.a.write_magnitude(_component(position, about, "n"), position.rate("ω", about.link) ** 2 * length)


def _component(position: PositionPlans, equation: SameLinkEquation | MovingGuideEquation, above: str) -> DrawnVector:
    return position.a.component(equation.point, equation.base, above)


def _write_total_acceleration(position: PositionPlans, about: SameLinkEquation) -> Iterable[Block]:
    """Write the acceleration of a point whose two components are known."""
    a = position.a.vector_of(about.point)
    if about.base.fixed and not _component(position, about, "τ").segment:
        yield words.write_equality(a.symbol, _component(position, about, "n").symbol)
    else:
        yield position.a.measure(a)


def _coriolis_acceleration(position: PositionPlans, along: MovingGuideEquation) -> Block:
    """Return the Coriolis acceleration 2 ω v of a sliding block."""
    sliding = position.v.relative(along.point, along.base)
    return position.a.write_magnitude(
        _component(position, along, "k"), 2 * position.rate("ω", along.slide.carrier) * sliding.leaf
    )


def _write_acceleration_scale(position: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    return words.write_scale(
        position.a,
        [vector for step in steps for vector in _known_accelerations(position, step)],
        _(
            "The acceleration plan begins at its pole {pole}. The segment {segment} represents {a}; the scale "
            "factor of the plan is"
        ),
        _("All accelerations are zero in this position."),
    )


def _known_accelerations(position: PositionPlans, step: SolutionStep) -> Iterable[DrawnVector]:
    """Yield the accelerations and components that are known before the plan is drawn."""
    if step.group is None:
        yield from (position.a.vector_of(equation.point) for equation in step.equations)
    for about in step.after if step.group is None else ():
        if not about.idle:
            yield (
                position.a.vector_of(about.point)
                if about.link not in position.epsilon
                else _component(position, about, "n")
            )
    for equation in step.equations:
        if isinstance(equation, MovingGuideEquation):
            yield _component(position, equation, "k")
        elif isinstance(equation, SameLinkEquation) and not equation.idle:
            yield _component(position, equation, "n")


def _write_equations_and_components(
    position: PositionPlans, step: SolutionStep, known_names: Collection[str]
) -> Iterable[Block]:
    """Write the vector equations of a group for accelerations.

    Components that are known from velocities or from higher pairs are computed before the plan is drawn.
    """
    points, together = words.unknown_points(step, known_names), words.simultaneous_equations(step)
    yield from write_higher_pairs(position, step, "ε")
    if position.first and together:
        for_one = _("Group {group}: the acceleration of point {points} is found from the equations")
        for_several = _("Group {group}: the accelerations of points {points} are found from the equations")
        yield words.introduce_equations(step, points, for_one, for_several)
        yield from write_equations(
            position, step, together, "a", {*known_names, *(about.point.name for about in words.direct_equations(step))}
        )
        if any(_has_known_component(position, equation) for equation in together):
            yield write_sentence(_("From the velocities:"))
    for about in words.direct_equations(step):
        yield from _write_components(position, about)
    for equation in together:
        if _has_known_component(position, equation):
            assert not isinstance(equation, FixedGuideEquation)
            yield (
                _normal_acceleration(position, equation)
                if isinstance(equation, SameLinkEquation)
                else _coriolis_acceleration(position, equation)
            )


def _has_known_component(position: PositionPlans, equation: VectorEquation) -> bool:
    """Return True if an equation has a normal or a Coriolis component."""
    if isinstance(equation, MovingGuideEquation):
        return equation.slide.carrier in position.omega
    return isinstance(equation, SameLinkEquation) and not equation.idle


def _write_plan_solution(position: PositionPlans, step: SolutionStep, known_names: Collection[str]) -> Iterable[Block]:
    """Write the accelerations of a group that follow from its acceleration plan."""
    points, together = words.unknown_points(step, known_names), words.simultaneous_equations(step)
    for about in words.direct_equations(step):
        yield from _write_total_acceleration(position, about)
    if position.first and together:
        yield write_sentence(_("The plan gives:")) if step.on_paper else words.explain_numerical_solution()
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known:
            yield position.a.measure(
                _component(position, equation, "τ" if isinstance(equation, SameLinkEquation) else "r")
            )
    for spot in points:
        yield position.a.measure(position.a.vector_of(spot))
    yield from words.write_rotation(
        position,
        together,
        "ε",
        lambda about: _component(position, about, "τ"),
        _("Vector {a}, transferred to point {point}, shows that the angular acceleration {epsilon} is {sense}."),
        _("Angular acceleration {epsilon} is {sense}."),
    )
    yield from words.write_common_rotation(position, step, "ε")
    solved_names = {*known_names, *words.solved_points(step)}
    for about in words.further_points(step):
        yield from write_point_of_known_link(position, about, "a", solved_names - {about.point.name})
        yield from _write_components(position, about)
        yield from _write_total_acceleration(position, about)
