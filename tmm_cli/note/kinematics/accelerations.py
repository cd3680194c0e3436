"""Accelerations of a position: normal and Coriolis parts from velocities, the rest by vector equations and the plan."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, said
from tmm_cli.note.kinematics import words
from tmm_cli.note.kinematics.equations import equations, of_known_link
from tmm_cli.note.kinematics.on_paper import Here, Vector
from tmm_cli.note.kinematics.ratios import begun
from tmm_cli.plans.vector_equations import About, Along, OnGuide, Step, VectorEquation


def accelerations(here: Here, steps: Sequence[Step]) -> Iterable[Block]:
    """All that the plan gives, in the order in which it is drawn."""
    known: set[str] = set()
    driving, groups = ([step for step in steps if (step.group is None) is first] for first in (True, False))
    for step in driving:
        yield from _driving(here, step)
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


def _driving(here: Here, step: Step) -> Iterable[Block]:
    """Points of a driving link."""
    for equation in step.equations:
        a = here.a.of(equation.point)
        text = _("The driving link {link} moves uniformly, so that {a} = 0.")
        if a.segment:
            text = _("All points of link {link} have the acceleration {a} of the drive.")
        yield said(text, link=step.links[0], a=a.symbol)
    turned = words.further(step)
    if turned and here.first:
        even = _(
            "Driving link {link} turns uniformly: the accelerations of its points are normal ones, towards its axis."
        )
        uneven = _("Driving link {link} does not turn uniformly: the accelerations of its points have normal and "
                   "tangential parts.")  # fmt: skip
        yield said(uneven if step.links[0] in here.epsilon else even, link=step.links[0])
    for about in turned:
        yield from _parts(here, about)
        yield from _whole(here, about)


def _parts(here: Here, about: About) -> Iterable[Block]:
    """Normal and tangential part of a point's acceleration about another of a link whose rotation is known."""
    yield _normal(here, about)
    tangential = _part(here, about, "τ")
    if tangential.segment or about.link in here.epsilon:
        yield here.a.found(tangential, here.rate("ε", about.link) * here.length(about.point, about.base))


def _normal(here: Here, about: About) -> Block:
    length = here.length(about.point, about.base)
    return here.a.found(_part(here, about, "n"), here.rate("ω", about.link) ** 2 * length)


def _part(here: Here, equation: About | Along, above: str) -> Vector:
    return here.a.part(equation.point, equation.base, above)


def _whole(here: Here, about: About) -> Iterable[Block]:
    """The acceleration of a point both of whose parts are known."""
    a = here.a.of(about.point)
    if about.base.fixed and not _part(here, about, "τ").segment:
        yield words.equal(a.symbol, _part(here, about, "n").symbol)
    else:
        yield here.a.read(a)


def _coriolis(here: Here, along: Along) -> Block:
    """2 ω v."""
    sliding = here.v.relative(along.point, along.base)
    return here.a.found(_part(here, along, "k"), 2 * here.rate("ω", along.slide.carrier) * sliding.leaf)


def _scale(here: Here, steps: Sequence[Step]) -> Iterable[Block]:
    return words.scale(
        here.a, [vector for step in steps for vector in _known(here, step)],
        _("The plan of accelerations begins at its pole {pole}. The segment {segment} stands for {a}; the scale "
          "factor of the plan is"),
        _("Nothing accelerates in this position."),
    )  # fmt: skip


def _known(here: Here, step: Step) -> Iterable[Vector]:
    """Vectors that are known before the plan is drawn."""
    if step.group is None:
        yield from (here.a.of(equation.point) for equation in step.equations)
    for about in step.after if step.group is None else ():
        if not about.idle:
            yield here.a.of(about.point) if about.link not in here.epsilon else _part(here, about, "n")
    for equation in step.equations:
        if isinstance(equation, Along):
            yield _part(here, equation, "k")
        elif isinstance(equation, About) and not equation.idle:
            yield _part(here, equation, "n")


def _before(here: Here, step: Step, known: Collection[str]) -> Iterable[Block]:
    """What is known from velocities and from higher pairs, and the equations."""
    points, together = words.sought(step, known), words.solved(step)
    yield from begun(here, step, "ε")
    if here.first and together:
        one = _("Group {group}: the acceleration of point {points} is found from")
        several = _("Group {group}: the accelerations of points {points} are found from")
        yield words.introduced(step, points, one, several)
        yield from equations(here, step, together, "a", {*known, *(about.point.name for about in words.direct(step))})
        if any(_has_known_part(here, equation) for equation in together):
            yield said(_("The velocities give:"))
    for about in words.direct(step):
        yield from _parts(here, about)
    for equation in together:
        if _has_known_part(here, equation):
            assert not isinstance(equation, OnGuide)
            yield _normal(here, equation) if isinstance(equation, About) else _coriolis(here, equation)


def _has_known_part(here: Here, equation: VectorEquation) -> bool:
    """A normal part, or that of Coriolis."""
    if isinstance(equation, Along):
        return equation.slide.carrier in here.omega
    return isinstance(equation, About) and not equation.idle


def _solved(here: Here, step: Step, known: Collection[str]) -> Iterable[Block]:
    """What the plan gives."""
    points, together = words.sought(step, known), words.solved(step)
    for about in words.direct(step):
        yield from _whole(here, about)
    if here.first and together:
        yield said(_("The plan gives:")) if step.on_paper else words.not_on_paper()
    for equation in together:
        if not isinstance(equation, OnGuide) and not equation.known:
            yield here.a.read(_part(here, equation, "τ" if isinstance(equation, About) else "r"))
    for spot in points:
        yield here.a.read(here.a.of(spot))
    yield from words.turning(
        here, together, "ε", lambda about: _part(here, about, "τ"),
        _("Vector {a}, carried over to point {point}, shows that {epsilon} is {sense}."),
        _("Angular acceleration {epsilon} is {sense}."),
    )  # fmt: skip
    yield from words.turning_as_one(here, step, "ε")
    found = {*known, *words.points_of(step)}
    for about in words.further(step):
        yield from of_known_link(here, about, "a", found - {about.point.name})
        yield from _parts(here, about)
        yield from _whole(here, about)
