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
    """Return "counterclockwise" for a positive value, otherwise "clockwise"."""
    return _("counterclockwise") if value > 0 else _("clockwise")


def point_symbol(spot: PlanPoint) -> Symbol:
    """Return the symbol of a point.

    A point of a guide under a sliding block has the number of its link as subscript.
    """
    return Symbol(spot.at, spot.name[len(spot.at) :])


def direct_equations(step: SolutionStep) -> list[SameLinkEquation]:
    """Return the equations of a group that are solved one by one.

    They are those of points of links whose angular velocity and acceleration are already known.
    """
    return [e for e in step.equations if isinstance(e, SameLinkEquation) and e.known and not e.idle]


def simultaneous_equations(step: SolutionStep) -> list[VectorEquation]:
    """Return the equations of a group that must be solved together."""
    alone = direct_equations(step)
    return [e for e in step.equations if e not in alone and not (isinstance(e, FixedGuideEquation) and e.known)]


def unknown_points(step: SolutionStep, known_names: Collection[str]) -> list[PlanPoint]:
    """Return the points whose velocity or acceleration follows from the simultaneous equations of a group.

    Points of a link that does not rotate are left out, because they move like its other points.
    """
    together = simultaneous_equations(step)
    others = [e for e in step.equations if e not in together or (isinstance(e, SameLinkEquation) and e.idle)]
    spots = [s for e in together for s in ([e.point] if isinstance(e, FixedGuideEquation) else [e.point, e.base])]
    excluded = {*known_names, *(e.point.name for e in others)}
    return list(dict.fromkeys(s for s in spots if not s.fixed and s.name not in excluded))


def rotation_equations(together: Iterable[VectorEquation]) -> list[SameLinkEquation]:
    """Return one equation for each link of unknown rotation. From it the angular velocity or acceleration follows."""
    by_link: dict[str, SameLinkEquation] = {}
    for equation in together:
        if isinstance(equation, SameLinkEquation) and not equation.known:
            by_link.setdefault(equation.link, equation)
    return list(by_link.values())


def further_points(step: SolutionStep) -> list[SameLinkEquation]:
    """Return the equations of further points of a group, which are not needed to solve it.

    Points of links that do not rotate are left out, because they move like the other points of their links.
    """
    return [about for about in step.after if not about.idle]


def solved_points(step: SolutionStep) -> set[str]:
    """Return the names of the points whose velocity and acceleration follow from a step of the solution."""
    names = {
        s.name for e in step.equations for s in ([e.point] if isinstance(e, FixedGuideEquation) else [e.point, e.base])
    }
    return names | {about.point.name for about in further_points(step)}


def write_equality(*symbols: Symbol) -> Block:
    """Return the equation a = b = ... of these symbols."""
    letters = [Letter(symbol) for symbol in symbols]
    return Equation(row(letters[0], *(node for symbol in letters[1:] for node in ("=", symbol))))


def introduce_equations(step: SolutionStep, points: Sequence[PlanPoint], for_one: str, for_several: str) -> Block:
    """Return the sentence before the equations of a group.

    Args:
        step: step of the solution that belongs to a group.
        points: points whose motion follows from the equations.
        for_one: sentence for one point.
        for_several: sentence for several points. If there are no points, a sentence on the remaining unknowns is
            returned.
    """
    assert step.group is not None
    text = (
        for_one
        if len(points) == 1
        else for_several
        if points
        else _("Group {group}: the remaining unknowns are found from the equations")
    )
    return write_sentence(text, group=step.group.title, points=join_inline(map(point_symbol, points)))


def write_scale(plan: DrawnPlan, vectors: Sequence[DrawnVector], text: str, at_rest: str) -> Iterable[Block]:
    """Write the scale of a velocity or acceleration plan.

    Args:
        plan: the plan.
        vectors: known vectors; the first one that is not too small sets the scale.
        text: sentence before the scale.
        at_rest: sentence instead of the scale if all vectors are zero.
    """
    first = find_scale_vector(vectors)
    if first is None:
        yield write_sentence(at_rest)
        return
    yield write_sentence(
        text, pole=Symbol(plan.kind.pole), segment=segment_symbol(first), v=first.symbol, a=first.symbol
    )
    yield plan.compute_scale(first)


def write_rotation(
    position: PositionPlans,
    together: Iterable[VectorEquation],
    letter: str,
    vector_of: Callable[[SameLinkEquation], DrawnVector],
    explained: str,
    brief: str,
) -> Iterable[Block]:
    """Write the angular velocity or acceleration of each link with its sense.

    Args:
        position: position with its plans.
        together: equations solved together.
        letter: ω or ε.
        vector_of: function that returns the vector from which the angular velocity or acceleration of a link follows.
        explained: sentence in the first detailed position, where the method is explained.
        brief: sentence in the other positions.
    """
    for about in rotation_equations(together):
        value, vector = position.rates(letter).get(about.link, 0.0), vector_of(about)
        rate = Leaf(Symbol(letter, about.link), abs(value))
        if not vector.segment or not value:
            yield zero_equation(rate.symbol)
            continue
        yield ComputedQuantity(
            rate.symbol, vector.leaf / position.length(about.point, about.base), rate.value, unit_of(letter)
        )
        yield write_sentence(
            explained if position.first else brief,
            v=vector_letter(vector.symbol),
            a=vector_letter(vector.symbol),
            epsilon=rate.symbol,
            point=point_symbol(about.point),
            link=about.link,
            sense=name_sense(value),
        )


def write_common_rotation(position: PositionPlans, step: SolutionStep, letter: str) -> Iterable[Block]:
    """Write the equal angular velocities or accelerations of links that rotate together."""
    for links in step.same:
        if links[0] in position.rates(letter):
            if position.first and not step.ratios:
                yield write_sentence(_("Links {links} rotate together:"), links=", ".join(links))
            yield write_equality(*(Symbol(letter, link) for link in links))


def write_remaining_points(position: PositionPlans, plan: DrawnPlan, known_names: Collection[str]) -> Iterable[Block]:
    """Write the vectors of centres of mass and of points that no equation needed; they are found by similarity.

    known_names: names of the points whose vectors are already written.
    """
    linkage = position.motion.linkage
    names = [p for p in linkage.moving_points if p not in known_names] + [
        f"S{link}" for link in links_with_mass(linkage)
    ]
    if not names:
        return
    if position.first:
        yield write_sentence(
            _(
                "The ends of the vectors of all other points and of the centres of mass are found by similarity: "
                "the image of a link on the plan is similar to the link."
            )
        )
    named = [point for point in (*linkage.moving_points, *known_names) if point in known_names and point in plan.ends]
    for name in names:
        vector = plan.vector_of(name)
        twin = next((other for other in named if vector.segment and plan.moves_alike(name, other)), None)
        yield plan.measure(vector) if twin is None else write_equality(vector.symbol, plan.vector_of(twin).symbol)


def explain_numerical_solution() -> Block:
    """Return the sentence for a group whose equations no vector polygon can solve."""
    return write_sentence(
        _(
            "These equations contain more unknown magnitudes than a vector polygon can give, and none of them "
            "can be found before the others. The equations of the group were therefore solved together by a "
            "numerical method; the plan shows the solution:"
        )
    )


# Vector equations in symbols: two underlines for a vector known completely, one for a vector with known direction.


WHOLE, DIRECTION, UNKNOWN = 2, 1, 0  # underlines of a vector


def write_equations(
    position: PositionPlans,
    step: SolutionStep,
    chosen: Sequence[VectorEquation],
    letter: str,
    known_names: Collection[str],
) -> Iterable[Block]:
    """Write vector equations of velocities or accelerations, and the directions of their vectors.

    Args:
        position: position with its plans.
        step: step of the solution to which the equations belong.
        chosen: equations to write.
        letter: v or a. Relative accelerations are written as sums of their components.
        known_names: names of points whose velocity or acceleration is known.
    """
    lined = {
        e.point.name
        for e in step.equations
        if isinstance(e, FixedGuideEquation) or (isinstance(e, SameLinkEquation) and e.base.fixed and letter == "v")
    }
    statements: dict[Node, None] = {}
    for equation in chosen:
        if isinstance(equation, FixedGuideEquation):
            statements[row(vector_letter(Symbol(letter, equation.point.name)), "∥", name_guide(equation.slide))] = None
            continue
        terms = list(_relative_vectors(equation, letter, position.omega))
        base = Letter(Symbol(letter, equation.base.name), True, _underlines(equation.base, known_names, lined))
        point = Letter(Symbol(letter, equation.point.name), True, _underlines(equation.point, known_names, lined))
        yield Equation(row(point, "=", base, *(node for term, __ in terms for node in ("+", term))))
        for spot in (equation.base, equation.point):
            if spot.fixed:
                statements[row(vector_letter(Symbol(letter, spot.name)), "=", Number("0"))] = None
        statements |= dict.fromkeys(direction for __, direction in terms)
    yield from _write_side_by_side(list(statements))


def write_point_of_known_link(
    position: PositionPlans, about: SameLinkEquation, letter: str, known_names: Collection[str]
) -> Iterable[Block]:
    """Write the equation of a point of a link whose rotation is known.

    It is written in the first detailed position only.
    """
    if position.first:
        text = _("Point {point} belongs to link {link}, whose rotation is known:")
        yield write_sentence(text, point=point_symbol(about.point), link=about.link)
        if not about.base.fixed:
            yield from write_equations(position, SolutionStep((), ()), [about], letter, known_names)


def _write_side_by_side(statements: Sequence[Node]) -> Iterable[Block]:
    """Write short statements side by side, as many on each line as fit."""
    line: Node | None = None
    for statement in statements:
        longer = statement if line is None else row(line, Words(",  "), statement)
        if line is not None and width(longer) > LINE:
            yield Equation(line)
            longer = statement
        line = longer
    if line is not None:
        yield Equation(line)


def _underlines(spot: PlanPoint, known_names: Collection[str], lined: Collection[str]) -> int:
    if spot.fixed or spot.name in known_names:
        return WHOLE
    return DIRECTION if spot.name in lined else UNKNOWN


def _relative_vectors(
    equation: SameLinkEquation | MovingGuideEquation, letter: str, turning: Collection[str]
) -> Iterable[tuple[Node, Node]]:
    """Yield each relative vector of an equation, and the statement of its direction, e.g. v_BA ⟂ AB."""
    index = equation.point.name + equation.base.name
    underlines = WHOLE if equation.known else DIRECTION
    if isinstance(equation, MovingGuideEquation):
        line = name_guide(equation.slide)
        if letter == "v":
            yield _vector_and_line(Symbol("v", index), underlines, "∥", line)
            return
        if equation.slide.carrier in turning:
            yield _vector_and_line(Symbol("a", index, "k"), WHOLE, "⟂", line)
        yield _vector_and_line(Symbol("a", index, "r"), underlines, "∥", line)
        return
    if equation.idle:
        return
    line = Words(equation.base.at + equation.point.at)
    if letter == "a":
        yield _vector_and_line(Symbol("a", index, "n"), WHOLE, "∥", line)
    yield _vector_and_line(Symbol(letter, index, "τ" if letter == "a" else ""), underlines, "⟂", line)


def _vector_and_line(symbol: Symbol, underlines: int, sign: str, line: Node) -> tuple[Node, Node]:
    return Letter(symbol, True, underlines), row(vector_letter(symbol), sign, line)


def name_guide(slide: Slide) -> Node:
    """Return the printed name of a guide: its own name on the frame, otherwise its end points or its link."""
    if slide.ends is not None:
        return Words("".join(slide.ends))
    if slide.carrier == FRAME:
        return Words(slide.name.partition(".")[0])
    return Words(_("guide of link {link}").format(link=slide.carrier))
