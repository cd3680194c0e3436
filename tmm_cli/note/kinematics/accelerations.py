"""Accelerations of a position: normal and Coriolis parts from velocities, the rest by vector equations and the plan."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, listed, said
from tmm_cli.note.expression import Constant, Found, Leaf
from tmm_cli.note.kinematics.equations import equations, of_known_link, vector
from tmm_cli.note.kinematics.on_paper import Here, Vector, drawn, large, unit, zero
from tmm_cli.note.kinematics.ratios import accelerations as by_ratio
from tmm_cli.note.kinematics.words import (
    begun,
    direct,
    equal,
    further,
    name_of,
    not_on_paper,
    once_a_link,
    points_of,
    remaining,
    sense,
    solved,
    sought,
    turning_as_one,
)
from tmm_cli.plans.record import Symbol
from tmm_cli.plans.vector_equations import About, Along, OnGuide, Step, VectorEquation

TWO = Constant(2)


def accelerations(here: Here, steps: Sequence[Step]) -> Iterable[Block]:
    """All that the plan gives, in the order in which it is drawn."""
    known: set[str] = set()
    driving, groups = ([step for step in steps if (step.group is None) is first] for first in (True, False))
    for step in driving:
        yield from _driving(here, step)
        known |= points_of(step)
    for step in groups:
        yield from _before(here, step, known)
        if step == groups[0]:
            yield from _scale(here, [*driving, step])
        yield from _solved(here, step, known)
        known |= points_of(step)
    if not groups:
        yield from _scale(here, steps)
    yield from remaining(here, here.a, known)


def _driving(here: Here, step: Step) -> Iterable[Block]:
    """Points of a driving link."""
    for equation in step.equations:
        a = here.a.of(equation.point)
        if a.segment:
            yield said(
                _("All points of link {link} have the acceleration {a} of the drive."), link=step.links[0], a=a.symbol
            )
        else:
            text = _("The driving link {link} moves uniformly, so that {a} = 0.")
            yield said(text, link=step.links[0], a=a.symbol)
    turned = further(step)
    if turned and here.first:
        even = _(
            "Driving link {link} turns uniformly: the accelerations of its points are normal ones, towards its axis."
        )
        uneven = _(
            "Driving link {link} does not turn uniformly: the accelerations of its points have normal and "
            "tangential parts."
        )
        yield said(uneven if step.links[0] in here.epsilon else even, link=step.links[0])
    for about in turned:
        yield from _parts(here, about)
        yield from _whole(here, about)


def _parts(here: Here, about: About) -> Iterable[Block]:
    """Normal and tangential part of a point's acceleration about another of a link whose rotation is known."""
    yield _normal(here, about)
    tangential, epsilon = _part(here, about, "τ"), here.epsilon.get(about.link, 0.0)
    if tangential.segment:
        product = Leaf(Symbol("ε", about.link), abs(epsilon)) * here.length(about.point, about.base)
        yield Found(tangential.symbol, product, tangential.size, unit("a"))
    elif about.link in here.epsilon:
        yield zero(tangential.symbol)


def _normal(here: Here, about: About) -> Block:
    found, omega = _part(here, about, "n"), abs(here.omega.get(about.link, 0.0))
    if not found.segment:
        return zero(found.symbol)
    product = Leaf(Symbol("ω", about.link), omega) ** 2 * here.length(about.point, about.base)
    return Found(found.symbol, product, found.size, unit("a"))


def _part(here: Here, equation: About | Along, above: str) -> Vector:
    return here.a.part(equation.point, equation.base, above)


def _whole(here: Here, about: About) -> Iterable[Block]:
    """The acceleration of a point both of whose parts are known."""
    a = here.a.of(about.point)
    if about.base.fixed and not _part(here, about, "τ").segment:
        yield equal(a.symbol, _part(here, about, "n").symbol)
    else:
        yield here.a.read(a)


def _coriolis(here: Here, along: Along) -> Block:
    """2 ω v."""
    found, link = _part(here, along, "k"), along.slide.carrier
    if not found.segment:
        return zero(found.symbol)
    omega = Leaf(Symbol("ω", link), abs(here.omega[link]))
    product = TWO * omega * here.v.relative(along.point, along.base).leaf
    return Found(found.symbol, product, found.size, unit("a"))


def _scale(here: Here, steps: Sequence[Step]) -> Iterable[Block]:
    """Of the plan, by the first vector on it that is known."""
    first = large([vector for step in steps for vector in _known(here, step)])
    if first is None:
        yield said(_("Nothing accelerates in this position."))
        return
    yield said(
        _("The plan of accelerations begins at its pole {pole}. The segment {segment} stands for {a}; the scale "
          "factor of the plan is"),
        pole=Symbol(here.a.sort.pole), segment=drawn(first), a=first.symbol,
    )  # fmt: skip
    yield here.a.scaled(first)


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
    assert step.group is not None
    title, points, together = step.group.title, sought(step, known), solved(step)
    yield from begun(here, step, by_ratio)
    if here.first and together:
        one = _("Group {group}: the acceleration of point {points} is found from")
        several = _("Group {group}: the accelerations of points {points} are found from")
        none = _("Group {group}: what is not known yet is found from")
        text = none if not points else one if len(points) == 1 else several
        yield said(text, group=title, points=listed(map(name_of, points)))
        yield from equations(step, together, "a", {*known, *(about.point.name for about in direct(step))}, here.omega)
        if any(_has_known_part(here, equation) for equation in together):
            yield said(_("The velocities give:"))
    for about in direct(step):
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
    points, together = sought(step, known), solved(step)
    for about in direct(step):
        yield from _whole(here, about)
    if here.first and together:
        yield said(_("The plan gives:")) if step.on_paper else not_on_paper()
    for equation in together:
        if not isinstance(equation, OnGuide) and not equation.known:
            yield here.a.read(_part(here, equation, "τ" if isinstance(equation, About) else "r"))
    for spot in points:
        yield here.a.read(here.a.of(spot))
    yield from _rates(here, together)
    yield from turning_as_one(step, here.epsilon, "ε", explained=here.first and not step.ratios)
    found = {*known, *points_of(step)}
    for about in further(step):
        yield from of_known_link(here, about, "a", found - {about.point.name})
        yield from _parts(here, about)
        yield from _whole(here, about)


def _rates(here: Here, together: Sequence[VectorEquation]) -> Iterable[Block]:
    """Angular accelerations, each once, with its sense."""
    for about in once_a_link(together):
        symbol, value = Symbol("ε", about.link), here.epsilon.get(about.link, 0.0)
        a = _part(here, about, "τ")
        if not a.segment or not value:
            yield zero(symbol)
            continue
        quotient = a.leaf / here.length(about.point, about.base)
        yield Found(symbol, quotient, abs(value), unit("ε"))
        if here.first:
            text = _("Vector {a}, carried over to point {point}, shows that {epsilon} is {sense}.")
            yield said(text, a=vector(a.symbol), point=name_of(about.point), epsilon=symbol, sense=sense(value))
        else:
            yield said(_("Angular acceleration {epsilon} is {sense}."), epsilon=symbol, sense=sense(value))
