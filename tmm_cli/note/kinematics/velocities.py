"""Velocities of a position: those of the driving links, then of each group by its vector equations and the plan."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.note.blocks import Block, listed, said
from tmm_cli.note.kinematics import words
from tmm_cli.note.kinematics.equations import equations, of_known_link
from tmm_cli.note.kinematics.on_paper import Here, Vector
from tmm_cli.note.kinematics.ratios import begun
from tmm_cli.plans.vector_equations import About, OnGuide, Step


def velocities(here: Here, steps: Sequence[Step]) -> Iterable[Block]:
    """All that the plan gives, in the order in which it is drawn."""
    known: set[str] = set()
    for step in steps:
        if step.group is None:
            yield from _driving(here, step)
            known |= words.points_of(step)
    yield from words.scale(
        here.v, [vector for step in steps for vector in _known(here, step)],
        _("The plan of velocities begins at its pole {pole}. The segment {segment} stands for {v}; the scale factor "
          "of the plan is"),
        _("All points are at rest in this position."),
    )  # fmt: skip
    for step in steps:
        if step.group is not None:
            yield from _group(here, step, known)
            known |= words.points_of(step)
    yield from words.remaining(here, here.v, known)


def _driving(here: Here, step: Step) -> Iterable[Block]:
    """Points of a driving link."""
    turned = words.further(step)
    if here.first and turned:
        one = _("The velocity of point {points} of the driving link is perpendicular to {line}, in the sense of its "
                "rotation:")  # fmt: skip
        several = _("The velocities of points {points} of the driving link are perpendicular to their radii, in the "
                    "sense of its rotation:")  # fmt: skip
        line = turned[0].base.at + turned[0].point.at
        points = listed(words.name_of(about.point) for about in turned)
        yield said(one if len(turned) == 1 else several, points=points, line=line)
    elif here.first and step.equations:
        text = _("Link {link} does not turn: all its points move with the given velocity {v}.")
        yield said(text, link=step.links[0], v=here.v.of(step.equations[0].point).symbol)
    for about in turned:
        yield _turned(here, about)


def _turned(here: Here, about: About) -> Block:
    """v = ω l of a point about another one of its link."""
    found = here.v.relative(about.point, about.base)
    return here.v.found(found, here.rate("ω", about.link) * here.length(about.point, about.base))


def _known(here: Here, step: Step) -> Iterable[Vector]:
    """Vectors that are known before the plan is drawn."""
    for equation in (*step.equations, *(step.after if step.group is None else ())):
        if equation.known and isinstance(equation, OnGuide):
            yield here.v.of(equation.point)
        elif equation.known and not isinstance(equation, OnGuide):
            yield here.v.relative(equation.point, equation.base)


def _group(here: Here, step: Step, known: Collection[str]) -> Iterable[Block]:
    """Ratios, equations, what they give, further points."""
    points, together, found = words.sought(step, known), words.solved(step), {*known}
    yield from begun(here, step, "ω")
    for about in words.direct(step):
        yield from _known_about(here, about, found)
        found.add(about.point.name)
    if here.first and together:
        one = _("Group {group}: the velocity of point {points} is found from")
        several = _("Group {group}: the velocities of points {points} are found from")
        yield words.introduced(step, points, one, several)
        yield from equations(here, step, together, "v", found)
        for link in dict.fromkeys(e.link for e in together if isinstance(e, About) and e.idle):
            yield said(_("Link {link} does not turn, so that all its points move as one."), link=link)
        yield said(_("The plan gives:")) if step.on_paper else words.not_on_paper()
    for spot in points:
        yield here.v.read(here.v.of(spot))
    for equation in together:
        if not isinstance(equation, OnGuide) and not equation.known and not equation.base.fixed:
            yield here.v.read(here.v.relative(equation.point, equation.base))
    yield from words.turning(
        here, together, "ω", lambda about: here.v.relative(about.point, about.base),
        _("Vector {v}, carried over to point {point}, turns link {link} {sense}."), _("Link {link} turns {sense}."),
    )  # fmt: skip
    yield from words.turning_as_one(here, step, "ω")
    for about in words.further(step):
        yield from _known_about(here, about, found)


def _known_about(here: Here, about: About, found: Collection[str]) -> Iterable[Block]:
    """A point of a link whose rotation is known."""
    yield from of_known_link(here, about, "v", found)
    yield _turned(here, about)
    if not about.base.fixed:
        yield here.v.read(here.v.of(about.point))
