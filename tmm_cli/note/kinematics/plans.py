"""Velocities of a position: those of the driving links, then of each group by its vector equations and the plan."""

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
from tmm_cli.note.blocks import Block, listed, said
from tmm_cli.note.kinematics import equations as words
from tmm_cli.note.kinematics.equations import equations, of_known_link
from tmm_cli.note.kinematics.higher_pairs import begun
from tmm_cli.note.kinematics.on_paper import Here, Vector


def velocities(here: Here, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the velocities of a position in the order in which the plan is drawn."""
    known: set[str] = set()
    for step in steps:
        if step.group is None:
            yield from _driving(here, step)
            known |= words.points_of(step)
    yield from words.scale(
        here.v,
        [vector for step in steps for vector in _known(here, step)],
        _(
            "The velocity plan begins at its pole {pole}. The segment {segment} represents {v}; the scale "
            "factor of the plan is"
        ),
        _("All points are at rest in this position."),
    )
    for step in steps:
        if step.group is not None:
            yield from _group(here, step, known)
            known |= words.points_of(step)
    yield from words.remaining(here, here.v, known)


def _driving(here: Here, step: SolutionStep) -> Iterable[Block]:
    """Write the velocities of points of an input link."""
    turned = words.further(step)
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
        points = listed(words.name_of(about.point) for about in turned)
        yield said(one if len(turned) == 1 else several, points=points, line=line)
    elif here.first and step.equations:
        text = _("Link {link} does not rotate: all its points move with the given velocity {v}.")
        yield said(text, link=step.links[0], v=here.v.of(step.equations[0].point).symbol)
    for about in turned:
        yield _turned(here, about)


def _turned(here: Here, about: SameLinkEquation) -> Block:
    """Return v = ω l of a point relative to another point of its link."""
    found = here.v.relative(about.point, about.base)
    return here.v.found(found, here.rate("ω", about.link) * here.length(about.point, about.base))


def _known(here: Here, step: SolutionStep) -> Iterable[Vector]:
    """Yield the velocities that are known before the plan is drawn."""
    for equation in (*step.equations, *(step.after if step.group is None else ())):
        if equation.known and isinstance(equation, FixedGuideEquation):
            yield here.v.of(equation.point)
        elif equation.known and not isinstance(equation, FixedGuideEquation):
            yield here.v.relative(equation.point, equation.base)


def _group(here: Here, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write a group: ratios of higher pairs, equations, their solution, further points."""
    points, together, found = words.sought(step, known), words.solved(step), {*known}
    yield from begun(here, step, "ω")
    for about in words.direct(step):
        yield from _known_about(here, about, found)
        found.add(about.point.name)
    if here.first and together:
        one = _("Group {group}: the velocity of point {points} is found from the equations")
        several = _("Group {group}: the velocities of points {points} are found from the equations")
        yield words.introduced(step, points, one, several)
        yield from equations(here, step, together, "v", found)
        for link in dict.fromkeys(e.link for e in together if isinstance(e, SameLinkEquation) and e.idle):
            yield said(_("Link {link} does not rotate, so all its points have the same velocity."), link=link)
        yield said(_("The plan gives:")) if step.on_paper else words.not_on_paper()
    for spot in points:
        yield here.v.read(here.v.of(spot))
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known and not equation.base.fixed:
            yield here.v.read(here.v.relative(equation.point, equation.base))
    yield from words.turning(
        here,
        together,
        "ω",
        lambda about: here.v.relative(about.point, about.base),
        _("Vector {v}, transferred to point {point}, shows that link {link} rotates {sense}."),
        _("Link {link} rotates {sense}."),
    )
    yield from words.turning_as_one(here, step, "ω")
    for about in words.further(step):
        yield from _known_about(here, about, found)


def _known_about(here: Here, about: SameLinkEquation, found: Collection[str]) -> Iterable[Block]:
    """Write the velocity of a point of a link whose rotation is known."""
    yield from of_known_link(here, about, "v", found)
    yield _turned(here, about)
    if not about.base.fixed:
        yield here.v.read(here.v.of(about.point))


# Accelerations of a position: normal and Coriolis parts from velocities, the rest by vector equations and the plan.


def accelerations(here: Here, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    """Write the accelerations of a position in the order in which the plan is drawn."""
    known: set[str] = set()
    driving, groups = ([step for step in steps if (step.group is None) is first] for first in (True, False))
    for step in driving:
        yield from _driving_accelerations(here, step)
        known |= words.points_of(step)
    for step in groups:
        yield from _before(here, step, known)
        if step == groups[0]:
            yield from _scale(here, [*driving, step])
        yield from _solved(here, step, known)
        known |= words.points_of(step)
    if not groups:
        yield from _scale(here, steps)
    yield from words.remaining(here, here.a, known)


def _driving_accelerations(here: Here, step: SolutionStep) -> Iterable[Block]:
    """Write the accelerations of points of an input link."""
    for equation in step.equations:
        a = here.a.of(equation.point)
        text = _("Input link {link} moves uniformly, so {a} = 0.")
        if a.segment:
            text = _("All points of link {link} have the acceleration {a} of the driver.")
        yield said(text, link=step.links[0], a=a.symbol)
    turned = words.further(step)
    if turned and here.first:
        even = _(
            "Input link {link} rotates uniformly: the accelerations of its points are purely normal, directed "
            "towards the axis of rotation."
        )
        uneven = _(
            "Input link {link} does not rotate uniformly: the accelerations of its points have normal and "
            "tangential components."
        )
        yield said(uneven if step.links[0] in here.epsilon else even, link=step.links[0])
    for about in turned:
        yield from _parts(here, about)
        yield from _whole(here, about)


def _parts(here: Here, about: SameLinkEquation) -> Iterable[Block]:
    """Write the normal and tangential acceleration of a point of a link whose rotation is known."""
    yield _normal(here, about)
    tangential = _part(here, about, "τ")
    if tangential.segment or about.link in here.epsilon:
        yield here.a.found(tangential, here.rate("ε", about.link) * here.length(about.point, about.base))


def _normal(here: Here, about: SameLinkEquation) -> Block:
    length = here.length(about.point, about.base)
    return here.a.found(_part(here, about, "n"), here.rate("ω", about.link) ** 2 * length)


def _part(here: Here, equation: SameLinkEquation | MovingGuideEquation, above: str) -> Vector:
    return here.a.part(equation.point, equation.base, above)


def _whole(here: Here, about: SameLinkEquation) -> Iterable[Block]:
    """Write the acceleration of a point whose two components are known."""
    a = here.a.of(about.point)
    if about.base.fixed and not _part(here, about, "τ").segment:
        yield words.equal(a.symbol, _part(here, about, "n").symbol)
    else:
        yield here.a.read(a)


def _coriolis(here: Here, along: MovingGuideEquation) -> Block:
    """Return the Coriolis acceleration 2 ω v."""
    sliding = here.v.relative(along.point, along.base)
    return here.a.found(_part(here, along, "k"), 2 * here.rate("ω", along.slide.carrier) * sliding.leaf)


def _scale(here: Here, steps: Sequence[SolutionStep]) -> Iterable[Block]:
    return words.scale(
        here.a,
        [vector for step in steps for vector in _known_accelerations(here, step)],
        _(
            "The acceleration plan begins at its pole {pole}. The segment {segment} represents {a}; the scale "
            "factor of the plan is"
        ),
        _("All accelerations are zero in this position."),
    )


def _known_accelerations(here: Here, step: SolutionStep) -> Iterable[Vector]:
    """Yield the accelerations that are known before the plan is drawn."""
    if step.group is None:
        yield from (here.a.of(equation.point) for equation in step.equations)
    for about in step.after if step.group is None else ():
        if not about.idle:
            yield here.a.of(about.point) if about.link not in here.epsilon else _part(here, about, "n")
    for equation in step.equations:
        if isinstance(equation, MovingGuideEquation):
            yield _part(here, equation, "k")
        elif isinstance(equation, SameLinkEquation) and not equation.idle:
            yield _part(here, equation, "n")


def _before(here: Here, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write the equations of a group and the components known from velocities and higher pairs."""
    points, together = words.sought(step, known), words.solved(step)
    yield from begun(here, step, "ε")
    if here.first and together:
        one = _("Group {group}: the acceleration of point {points} is found from the equations")
        several = _("Group {group}: the accelerations of points {points} are found from the equations")
        yield words.introduced(step, points, one, several)
        yield from equations(here, step, together, "a", {*known, *(about.point.name for about in words.direct(step))})
        if any(_has_known_part(here, equation) for equation in together):
            yield said(_("From the velocities:"))
    for about in words.direct(step):
        yield from _parts(here, about)
    for equation in together:
        if _has_known_part(here, equation):
            assert not isinstance(equation, FixedGuideEquation)
            yield _normal(here, equation) if isinstance(equation, SameLinkEquation) else _coriolis(here, equation)


def _has_known_part(here: Here, equation: VectorEquation) -> bool:
    """Return True if an equation has a normal or a Coriolis component."""
    if isinstance(equation, MovingGuideEquation):
        return equation.slide.carrier in here.omega
    return isinstance(equation, SameLinkEquation) and not equation.idle


def _solved(here: Here, step: SolutionStep, known: Collection[str]) -> Iterable[Block]:
    """Write the accelerations that the plan of a group gives."""
    points, together = words.sought(step, known), words.solved(step)
    for about in words.direct(step):
        yield from _whole(here, about)
    if here.first and together:
        yield said(_("The plan gives:")) if step.on_paper else words.not_on_paper()
    for equation in together:
        if not isinstance(equation, FixedGuideEquation) and not equation.known:
            yield here.a.read(_part(here, equation, "τ" if isinstance(equation, SameLinkEquation) else "r"))
    for spot in points:
        yield here.a.read(here.a.of(spot))
    yield from words.turning(
        here,
        together,
        "ε",
        lambda about: _part(here, about, "τ"),
        _("Vector {a}, transferred to point {point}, shows that {epsilon} is {sense}."),
        _("Angular acceleration {epsilon} is {sense}."),
    )
    yield from words.turning_as_one(here, step, "ε")
    found = {*known, *words.points_of(step)}
    for about in words.further(step):
        yield from of_known_link(here, about, "a", found - {about.point.name})
        yield from _parts(here, about)
        yield from _whole(here, about)
