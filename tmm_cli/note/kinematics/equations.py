"""Vector equations in symbols, and sentences shared by velocities and accelerations."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.linkage import FRAME, Slide
from tmm_cli.mechanics.plans import (
    FixedGuideEquation,
    MovingGuideEquation,
    PlanPoint,
    SameLinkEquation,
    SolutionStep,
    VectorEquation,
    links_with_mass,
)
from tmm_cli.note.blocks import Block, Equation, join_inline, write_sentence
from tmm_cli.note.expression import ComputedQuantity, Leaf
from tmm_cli.note.formula_tree import LINE, Letter, Node, Number, Words, row, width
from tmm_cli.note.kinematics.on_paper import (
    DrawnPlan,
    DrawnVector,
    PositionPlans,
    find_scale_vector,
    segment_symbol,
    unit_of,
    vector_letter,
    zero_equation,
)


def name_sense(value: float) -> str:
    """Return the sense of rotation in words."""
    return _("counterclockwise") if value > 0 else _("clockwise")


def point_symbol(spot: PlanPoint) -> Symbol:
    """Return the symbol of a point; a point under a sliding block has the number of its link as subscript."""
    return Symbol(spot.at, spot.name[len(spot.at) :])


def direct_equations(step: SolutionStep) -> list[SameLinkEquation]:
    """Return the points of a group that follow from known ones before its equations are solved."""
    return [e for e in step.equations if isinstance(e, SameLinkEquation) and e.known and not e.idle]


def simultaneous_equations(step: SolutionStep) -> list[VectorEquation]:
    """Return the equations that are solved together, without those that follow directly or from a higher pair."""
    alone = direct_equations(step)
    return [e for e in step.equations if e not in alone and not (isinstance(e, FixedGuideEquation) and e.known)]


def unknown_points(step: SolutionStep, known: Collection[str]) -> list[PlanPoint]:
    """Return the points that the equations give, without those that move like others."""
    together = simultaneous_equations(step)
    others = [e for e in step.equations if e not in together or (isinstance(e, SameLinkEquation) and e.idle)]
    spots = [s for e in together for s in ([e.point] if isinstance(e, FixedGuideEquation) else [e.point, e.base])]
    taken = {*known, *(e.point.name for e in others)}
    return list(dict.fromkeys(s for s in spots if not s.fixed and s.name not in taken))


def rotation_equations(together: Iterable[VectorEquation]) -> list[SameLinkEquation]:
    """Return, for each link of unknown rotation, the equation that gives its rotation."""
    found: dict[str, SameLinkEquation] = {}
    for one in together:
        if isinstance(one, SameLinkEquation) and not one.known:
            found.setdefault(one.link, one)
    return list(found.values())


def further_points(step: SolutionStep) -> list[SameLinkEquation]:
    """Return the further points of rotating links."""
    return [about for about in step.after if not about.idle]


def solved_points(step: SolutionStep) -> set[str]:
    """Return the names of the points that a step gives."""
    found = {
        s.name for e in step.equations for s in ([e.point] if isinstance(e, FixedGuideEquation) else [e.point, e.base])
    }
    return found | {about.point.name for about in further_points(step)}


def write_equality(*symbols: Symbol) -> Block:
    """Return an equation of equal symbols."""
    letters = [Letter(one) for one in symbols]
    return Equation(row(letters[0], *(part for one in letters[1:] for part in ("=", one))))


def introduce_equations(step: SolutionStep, points: Sequence[PlanPoint], one: str, several: str) -> Block:
    """Return the sentence that introduces the equations of a group: for one point, several points, or none."""
    assert step.group is not None
    text = (
        one
        if len(points) == 1
        else several
        if points
        else _("Group {group}: the remaining unknowns are found from the equations")
    )
    return write_sentence(text, group=step.group.title, points=join_inline(map(point_symbol, points)))


def write_scale(plan: DrawnPlan, vectors: Sequence[DrawnVector], text: str, at_rest: str) -> Iterable[Block]:
    """Write the scale of a plan, set by the first sufficiently large known vector."""
    first = find_scale_vector(vectors)
    if first is None:
        yield write_sentence(at_rest)
        return
    yield write_sentence(
        text, pole=Symbol(plan.kind.pole), segment=segment_symbol(first), v=first.symbol, a=first.symbol
    )
    yield plan.compute_scale(first)


def write_rotation(
    here: PositionPlans,
    together: Iterable[VectorEquation],
    letter: str,
    vector_of: Callable[[SameLinkEquation], DrawnVector],
    carried: str,
    told: str,
) -> Iterable[Block]:
    """Write the rate of rotation of each link with its sense.

    carried: sentence of the first detailed position, where the method is explained. told: sentence of the others.
    """
    for about in rotation_equations(together):
        value, found = here.rates(letter).get(about.link, 0.0), vector_of(about)
        rate = Leaf(Symbol(letter, about.link), abs(value))
        if not found.segment or not value:
            yield zero_equation(rate.symbol)
            continue
        yield ComputedQuantity(
            rate.symbol, found.leaf / here.length(about.point, about.base), rate.value, unit_of(letter)
        )
        yield write_sentence(
            carried if here.first else told,
            v=vector_letter(found.symbol),
            a=vector_letter(found.symbol),
            epsilon=rate.symbol,
            point=point_symbol(about.point),
            link=about.link,
            sense=name_sense(value),
        )


def write_common_rotation(here: PositionPlans, step: SolutionStep, letter: str) -> Iterable[Block]:
    """Write that links rotate together."""
    for links in step.same:
        if links[0] in here.rates(letter):
            if here.first and not step.ratios:
                yield write_sentence(_("Links {links} rotate together:"), links=", ".join(links))
            yield write_equality(*(Symbol(letter, link) for link in links))


def write_remaining_points(here: PositionPlans, plan: DrawnPlan, known: Collection[str]) -> Iterable[Block]:
    """Write the points that no equation needed and the centres of mass, found by similarity."""
    linkage = here.motion.linkage
    names = [p for p in linkage.moving_points if p not in known] + [f"S{link}" for link in links_with_mass(linkage)]
    if not names:
        return
    if here.first:
        yield write_sentence(
            _(
                "The ends of the vectors of all other points and of the centres of mass are found by similarity: "
                "the image of a link on the plan is similar to the link."
            )
        )
    named = [point for point in (*linkage.moving_points, *known) if point in known and point in plan.ends]
    for name in names:
        vector = plan.vector_of(name)
        twin = next((other for other in named if vector.segment and plan.moves_alike(name, other)), None)
        yield plan.measure(vector) if twin is None else write_equality(vector.symbol, plan.vector_of(twin).symbol)


def explain_numerical_solution() -> Block:
    """Return the sentence on a group that no vector polygon can solve."""
    return write_sentence(
        _(
            "These equations contain more unknown magnitudes than a vector polygon can give, and none of them "
            "can be found before the others. The equations of the group were therefore solved together by a "
            "numerical method; the plan shows the solution:"
        )
    )


# Vector equations in letters, with what is known of each vector: two lines under one known whole, one line under one
# whose line is known; and the lines that are known.


WHOLE, DIRECTION, UNKNOWN = 2, 1, 0  # lines under a vector


def write_equations(
    here: PositionPlans, step: SolutionStep, chosen: Sequence[VectorEquation], letter: str, known: Collection[str]
) -> Iterable[Block]:
    """Write vector equations of a step, and the directions of their vectors.

    letter: v or a (accelerations have components). known: names of points already found.
    """
    lined = {
        e.point.name
        for e in step.equations
        if isinstance(e, FixedGuideEquation) or (isinstance(e, SameLinkEquation) and e.base.fixed and letter == "v")
    }
    told: dict[Node, None] = {}
    for equation in chosen:
        if isinstance(equation, FixedGuideEquation):
            told[row(vector_letter(Symbol(letter, equation.point.name)), "∥", name_guide(equation.slide))] = None
            continue
        terms = list(_relative_vectors(equation, letter, here.omega))
        base = Letter(Symbol(letter, equation.base.name), True, _underlines(equation.base, known, lined))
        point = Letter(Symbol(letter, equation.point.name), True, _underlines(equation.point, known, lined))
        yield Equation(row(point, "=", base, *(node for term, __ in terms for node in ("+", term))))
        for spot in (equation.base, equation.point):
            if spot.fixed:
                told[row(vector_letter(Symbol(letter, spot.name)), "=", Number("0"))] = None
        told |= dict.fromkeys(direction for __, direction in terms)
    yield from _write_side_by_side(list(told))


def write_point_of_known_link(
    here: PositionPlans, about: SameLinkEquation, letter: str, known: Collection[str]
) -> Iterable[Block]:
    """Write, where the method is explained, the equation of a point of a link whose rotation is known."""
    if here.first:
        text = _("Point {point} belongs to link {link}, whose rotation is known:")
        yield write_sentence(text, point=point_symbol(about.point), link=about.link)
        if not about.base.fixed:
            yield from write_equations(here, SolutionStep((), ()), [about], letter, known)


def _write_side_by_side(told: Sequence[Node]) -> Iterable[Block]:
    """Write short statements side by side, as many per line as fit."""
    shown: Node | None = None
    for one in told:
        longer = one if shown is None else row(shown, Words(",  "), one)
        if shown is not None and width(longer) > LINE:
            yield Equation(shown)
            longer = one
        shown = longer
    if shown is not None:
        yield Equation(shown)


def _underlines(spot: PlanPoint, known: Collection[str], lined: Collection[str]) -> int:
    if spot.fixed or spot.name in known:
        return WHOLE
    return DIRECTION if spot.name in lined else UNKNOWN


def _relative_vectors(
    equation: SameLinkEquation | MovingGuideEquation, letter: str, turning: Collection[str]
) -> Iterable[tuple[Node, Node]]:
    """Yield the relative vectors of an equation, each with the line it is parallel or perpendicular to."""
    index = equation.point.name + equation.base.name
    sought = WHOLE if equation.known else DIRECTION
    if isinstance(equation, MovingGuideEquation):
        way = name_guide(equation.slide)
        if letter == "v":
            yield _vector_and_line(Symbol("v", index), sought, "∥", way)
            return
        if equation.slide.carrier in turning:
            yield _vector_and_line(Symbol("a", index, "k"), WHOLE, "⟂", way)
        yield _vector_and_line(Symbol("a", index, "r"), sought, "∥", way)
        return
    if equation.idle:
        return
    way = Words(equation.base.at + equation.point.at)
    if letter == "a":
        yield _vector_and_line(Symbol("a", index, "n"), WHOLE, "∥", way)
    yield _vector_and_line(Symbol(letter, index, "τ" if letter == "a" else ""), sought, "⟂", way)


def _vector_and_line(symbol: Symbol, lines: int, sign: str, way: Node) -> tuple[Node, Node]:
    return Letter(symbol, True, lines), row(vector_letter(symbol), sign, way)


def name_guide(slide: Slide) -> Node:
    """Return the name of a guide: its own on the frame, its end points on a link."""
    if slide.ends is not None:
        return Words("".join(slide.ends))
    if slide.carrier == FRAME:
        return Words(slide.name.partition(".")[0])
    return Words(_("guide of link {link}").format(link=slide.carrier))
