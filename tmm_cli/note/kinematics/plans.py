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


def write_velocities(here: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the velocities of a position in the order in which the plan is drawn."""
    known: set[str] = set()
    for step in steps:
        if step.group is None:
            yield from _write_driver_velocities(here, step)
            known |= words.solved_points(step)
    yield from words.write_scale(
        here.v,
        [vector for step in steps for vector in _known_velocities(here, step)],
        _(
            "The velocity plan begins at its pole {pole}. The segment {segment} represents {v}; the scale "
            "factor of the plan is"
        ),
        _("All points are at rest in this position."),
    )
    for step in steps:
        if step.group is not None:
            yield from _write_group_velocities(here, step, known)
            known |= words.solved_points(step)
    yield from words.write_remaining_points(here, here.v, known)


def _write_driver_velocities(here: PositionPlans, step: SolutionStep) -> Iterable[Block]:
    """Write the velocities of points of an input link."""
    turned = words.further_points(step)
    if here.first and turned:
        one = _(
            "The velocity of point {points} of the input link is perpendicular to {line} and directed in the "
            "sense of its rotation:"
        )
        several = _(
            "The velocities of points {points} of the input link are perpendicular to their radii and directed "
            "in the sense of its rotation:"
        )
        line = turned[0].base.at + turned[0].point.at
        points = join_inline(words.point_symbol(about.point) for about in turned)
        yield write_sentence(one if len(turned) == 1 else several, points=points, line=line)
    elif here.first and step.equations:
        text = _("Link {link} does not rotate: all its points move with the given velocity {v}.")
        yield write_sentence(text, link=step.links[0], v=here.v.vector_of(step.equations[0].point).symbol)
    for about in turned:
        yield _rotational_velocity(here, about)


def _rotational_velocity(here: PositionPlans, about: SameLinkEquation) -> Block:
    """Return the velocity v = ω l of a point relative to another point of its link."""
    found = here.v.relative(about.point, about.base)
    return here.v.write_magnitude(found, here.rate("ω", about.link) * here.length(about.point, about.base))


def _known_velocities(here: PositionPlans, step: SolutionStep) -> Iterable[DrawnVector]:
    """Yield the velocities that are known before the plan is drawn."""
    for equation in (*step.equations, *(step.after if step.group is None else ())):
        if equation.known and isinstance(equation, FixedGuideEquation):
            yield here.v.vector_of(equation.point)
        elif equation.known and not isinstance(equation, FixedGuideEquation):
            yield here.v.relative(equation.point, equation.base)


def _write_group_velocities(here: PositionPlans, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write the velocities of a group: ratios of higher pairs, vector equations, plan values, further points."""
    points, together, found = words.unknown_points(step, known), words.simultaneous_equations(step), {*known}
    yield from write_higher_pairs(here, step, "ω")
    for about in words.direct_equations(step):
        yield from _write_velocity_on_known_link(here, about, found)
        found.add(about.point.name)
    if here.first and together:
        one = _("Group {group}: the velocity of point {points} is found from the equations")
        several = _("Group {group}: the velocities of points {points} are found from the equations")
        yield words.introduce_equations(step, points, one, several)
        yield from write_equations(here, step, together, "v", found)
        for link in dict.fromkeys(e.link for e in together if isinstance(e, SameLinkEquation) and e.idle):
            yield write_sentence(_("Link {link} does not rotate, so all its points have the same velocity."), link=link)
        yield write_sentence(_("The plan gives:")) if step.on_paper else words.explain_numerical_solution()
    for spot in points:
        yield here.v.measure(here.v.vector_of(spot))
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known and not equation.base.fixed:
            yield here.v.measure(here.v.relative(equation.point, equation.base))
    yield from words.write_rotation(
        here,
        together,
        "ω",
        lambda about: here.v.relative(about.point, about.base),
        _("Vector {v}, transferred to point {point}, shows that link {link} rotates {sense}."),
        _("Link {link} rotates {sense}."),
    )
    yield from words.write_common_rotation(here, step, "ω")
    for about in words.further_points(step):
        yield from _write_velocity_on_known_link(here, about, found)


def _write_velocity_on_known_link(
    here: PositionPlans, about: SameLinkEquation, found: Collection[str]
) -> Iterable[Block]:
    """Write the velocity of a point of a link whose rotation is known.

    solved: names of the points whose velocities are known.
    """
    yield from write_point_of_known_link(here, about, "v", found)
    yield _rotational_velocity(here, about)
    if not about.base.fixed:
        yield here.v.measure(here.v.vector_of(about.point))


# Accelerations of a position: normal and Coriolis parts from velocities, the rest by vector equations and the plan.


def write_accelerations(here: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the accelerations of a position in the order in which the plan is drawn."""
    known: set[str] = set()
    driving, groups = ([step for step in steps if (step.group is None) is first] for first in (True, False))
    for step in driving:
        yield from _write_driver_accelerations(here, step)
        known |= words.solved_points(step)
    for step in groups:
        yield from _write_equations_and_components(here, step, known)
        if step == groups[0]:
            yield from _write_acceleration_scale(here, [*driving, step])
        yield from _write_plan_solution(here, step, known)
        known |= words.solved_points(step)
    if not groups:
        yield from _write_acceleration_scale(here, steps)
    yield from words.write_remaining_points(here, here.a, known)


def _write_driver_accelerations(here: PositionPlans, step: SolutionStep) -> Iterable[Block]:
    """Write the accelerations of points of an input link."""
    for equation in step.equations:
        a = here.a.vector_of(equation.point)
        text = _("Input link {link} moves uniformly, so {a} = 0.")
        if a.segment:
            text = _("All points of link {link} have the acceleration {a} of the driver.")
        yield write_sentence(text, link=step.links[0], a=a.symbol)
    turned = words.further_points(step)
    if turned and here.first:
        even = _(
            "Input link {link} rotates uniformly: the accelerations of its points are purely normal, directed "
            "towards the axis of rotation."
        )
        uneven = _(
            "Input link {link} does not rotate uniformly: the accelerations of its points have normal and "
            "tangential components."
        )
        yield write_sentence(uneven if step.links[0] in here.epsilon else even, link=step.links[0])
    for about in turned:
        yield from _write_components(here, about)
        yield from _write_total_acceleration(here, about)


def _write_components(here: PositionPlans, about: SameLinkEquation) -> Iterable[Block]:
    """Write the normal and the tangential acceleration of a point of a link whose rotation is known."""
    yield _normal_acceleration(here, about)
    tangential = _component(here, about, "τ")
    if tangential.segment or about.link in here.epsilon:
        yield here.a.write_magnitude(tangential, here.rate("ε", about.link) * here.length(about.point, about.base))


def _normal_acceleration(here: PositionPlans, about: SameLinkEquation) -> Block:
    length = here.length(about.point, about.base)
    return here.a.write_magnitude(_component(here, about, "n"), here.rate("ω", about.link) ** 2 * length)


def _component(here: PositionPlans, equation: SameLinkEquation | MovingGuideEquation, above: str) -> DrawnVector:
    return here.a.component(equation.point, equation.base, above)


def _write_total_acceleration(here: PositionPlans, about: SameLinkEquation) -> Iterable[Block]:
    """Write the acceleration of a point whose two components are known."""
    a = here.a.vector_of(about.point)
    if about.base.fixed and not _component(here, about, "τ").segment:
        yield words.write_equality(a.symbol, _component(here, about, "n").symbol)
    else:
        yield here.a.measure(a)


def _coriolis_acceleration(here: PositionPlans, along: MovingGuideEquation) -> Block:
    """Return the Coriolis acceleration 2 ω v of a sliding block."""
    sliding = here.v.relative(along.point, along.base)
    return here.a.write_magnitude(_component(here, along, "k"), 2 * here.rate("ω", along.slide.carrier) * sliding.leaf)


def _write_acceleration_scale(here: PositionPlans, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    return words.write_scale(
        here.a,
        [vector for step in steps for vector in _known_accelerations(here, step)],
        _(
            "The acceleration plan begins at its pole {pole}. The segment {segment} represents {a}; the scale "
            "factor of the plan is"
        ),
        _("All accelerations are zero in this position."),
    )


def _known_accelerations(here: PositionPlans, step: SolutionStep) -> Iterable[DrawnVector]:
    """Yield the accelerations and components that are known before the plan is drawn."""
    if step.group is None:
        yield from (here.a.vector_of(equation.point) for equation in step.equations)
    for about in step.after if step.group is None else ():
        if not about.idle:
            yield here.a.vector_of(about.point) if about.link not in here.epsilon else _component(here, about, "n")
    for equation in step.equations:
        if isinstance(equation, MovingGuideEquation):
            yield _component(here, equation, "k")
        elif isinstance(equation, SameLinkEquation) and not equation.idle:
            yield _component(here, equation, "n")


def _write_equations_and_components(here: PositionPlans, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write the equations of a group, and the components known from velocities and higher pairs."""
    points, together = words.unknown_points(step, known), words.simultaneous_equations(step)
    yield from write_higher_pairs(here, step, "ε")
    if here.first and together:
        one = _("Group {group}: the acceleration of point {points} is found from the equations")
        several = _("Group {group}: the accelerations of points {points} are found from the equations")
        yield words.introduce_equations(step, points, one, several)
        yield from write_equations(
            here, step, together, "a", {*known, *(about.point.name for about in words.direct_equations(step))}
        )
        if any(_has_known_component(here, equation) for equation in together):
            yield write_sentence(_("From the velocities:"))
    for about in words.direct_equations(step):
        yield from _write_components(here, about)
    for equation in together:
        if _has_known_component(here, equation):
            assert not isinstance(equation, FixedGuideEquation)
            yield (
                _normal_acceleration(here, equation)
                if isinstance(equation, SameLinkEquation)
                else _coriolis_acceleration(here, equation)
            )


def _has_known_component(here: PositionPlans, equation: VectorEquation) -> bool:
    """Return True if an equation has a normal or a Coriolis component."""
    if isinstance(equation, MovingGuideEquation):
        return equation.slide.carrier in here.omega
    return isinstance(equation, SameLinkEquation) and not equation.idle


def _write_plan_solution(here: PositionPlans, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write the accelerations that the plan of a group gives."""
    points, together = words.unknown_points(step, known), words.simultaneous_equations(step)
    for about in words.direct_equations(step):
        yield from _write_total_acceleration(here, about)
    if here.first and together:
        yield write_sentence(_("The plan gives:")) if step.on_paper else words.explain_numerical_solution()
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known:
            yield here.a.measure(_component(here, equation, "τ" if isinstance(equation, SameLinkEquation) else "r"))
    for spot in points:
        yield here.a.measure(here.a.vector_of(spot))
    yield from words.write_rotation(
        here,
        together,
        "ε",
        lambda about: _component(here, about, "τ"),
        _("Vector {a}, transferred to point {point}, shows that {epsilon} is {sense}."),
        _("Angular acceleration {epsilon} is {sense}."),
    )
    yield from words.write_common_rotation(here, step, "ε")
    found = {*known, *words.solved_points(step)}
    for about in words.further_points(step):
        yield from write_point_of_known_link(here, about, "a", found - {about.point.name})
        yield from _write_components(here, about)
        yield from _write_total_acceleration(here, about)
