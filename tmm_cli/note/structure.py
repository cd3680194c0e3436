"""Chapter on structure: links, pairs, mobility, Assur groups, structural formula, class."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.drawing.sheets import count_pair_letters, mechanism_parts
from tmm_cli.language import _, printed, typeset
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.structure import Group, Structure
from tmm_cli.note.blocks import (
    Block,
    Equation,
    Figure,
    Heading,
    Line,
    Link,
    Ref,
    Rows,
    cells,
    paragraph,
    refer_to_blocks,
    write_sentence,
    write_table,
)
from tmm_cli.note.expression import ComputedQuantity, Expression, Leaf
from tmm_cli.note.formula_tree import Words
from tmm_cli.note.subject import NONE, Subject, join_with_no_break_spaces
from tmm_cli.reports import (
    PAIRS,
    ROLES,
    describe_classification,
    describe_contours,
    describe_link_motion,
    describe_primary_mechanisms,
    describe_schemes,
    generalised_mobility,
    link_name,
    mobility_by_classes,
    mobility_with_replacements,
    mobility_with_rollers,
    reduction_sentences,
)

W, N, LOWER, HIGHER = Symbol("W"), Symbol("n"), Symbol("p", "1"), Symbol("p", "2")


def write_structure(subject: Subject) -> Iterable[Block]:
    """Write the chapter on structure."""
    structure = subject.results.structure
    yield Heading(_("Structure of the mechanism"))
    yield from subject.figures(
        "structure", _("The structural scheme is shown in figure {figure}."), _("Structural scheme of the mechanism")
    )
    yield write_sentence(
        _("The moving links are listed in table {links}, the kinematic pairs in table {pairs}."),
        links=Ref("links"),
        pairs=Ref("pairs"),
    )
    yield _link_table(subject)
    yield _pair_table(structure)
    yield from _write_mobility(structure)
    yield from _write_groups(subject)


def _link_table(subject: Subject) -> Rows:
    linkage, roles = subject.results.linkage, subject.results.roles
    rows = tuple(
        cells(
            name,
            _(ROLES[roles[name]]),
            describe_link_motion(subject.results, name),
            ", ".join(linkage.links[name].points),
        )
        for name in subject.results.structure.links
    )
    return Rows(_("Moving links"), cells(_("link"), _("kind"), _("motion"), _("points")), rows, "links")


def _pair_table(structure: Structure) -> Rows:
    rows = tuple(
        cells(
            p.name,
            f"{link_name(p.i)} – {link_name(p.j)}",
            _(PAIRS[p.kind]),
            str(p.freedoms),
            str(p.pair_class),
            p.code or NONE,
        )
        for p in structure.pairs
    )
    return Rows(
        _("Kinematic pairs"),
        cells(_("pair"), _("links"), _("kind"), _("degrees of freedom"), _("class"), _("code")),
        rows,
        "pairs",
    )


def _write_mobility(structure: Structure) -> Iterable[Block]:
    higher = structure.higher
    n, lower = len(structure.links), len(structure.pairs) - structure.higher
    turning = sum(pair.kind == "R" for pair in structure.pairs)
    yield write_sentence(
        _(
            "The mobility {w} of the mechanism is found by Chebyshev's formula {source}, in which {n} is the "
            "number of moving links, {lower} the number of lower pairs (revolute: {turning}, prismatic: "
            "{sliding}) and {higher} the number of higher pairs:"
        ),
        source=Link("artobolevskii"),
        w=W,
        n=N,
        lower=LOWER,
        higher=HIGHER,
        turning=str(turning),
        sliding=str(lower - turning),
    )
    yield ComputedQuantity(W, chebyshev_formula(n, lower, higher), structure.mobility, whole=True)
    classes = _("With the pairs counted by class, W = 3n - 2 p5 - p4 = {count}.")
    yield paragraph(typeset(classes.format(count=mobility_by_classes((n, lower, higher)))))
    general = _("The generalised formula W = Hn - sum((H - i) p_i) with H = 3 gives {count}.")
    yield paragraph(typeset(general.format(count=generalised_mobility((n, lower, higher)))))
    if higher:
        text = _("With each higher pair replaced by a link with two revolute pairs: W = {count}.")
        yield paragraph(typeset(text.format(count=mobility_with_replacements((n, lower, higher)))))
    if any(pair.mesh is not None and pair.mesh.roller for pair in structure.pairs):
        text = _("If rollers are counted as links, W = {count}.").format(count=mobility_with_rollers(structure))
        yield paragraph(typeset(text))
    if structure.passive:
        yield write_sentence(
            _(
                "The rank of the equations shows redundant constraints (number: {count}; {pairs}), which only "
                "repeat other constraints because of the special dimensions of the mechanism; its true mobility is "
                "{w} = {true}."
            ),
            count=str(structure.redundant),
            w=W,
            pairs=", ".join(_("pair {name}").format(name=p.pair) for p in structure.passive),
            true=str(structure.mobility + structure.redundant),
        )
    if structure.reduction:
        yield write_sentence(
            _(
                "In the structural formula some links or pairs are left out or merged: {what}. The remaining links "
                "and pairs give:"
            ),
            what="; ".join(reduction_sentences(structure)),
        )
        yield ComputedQuantity(W, chebyshev_formula(*structure.count), len(structure.drivers), whole=True)


def chebyshev_formula(n: int, lower: int, higher: int) -> Expression:
    """Return Chebyshev's formula 3n − 2p₁ − p₂ with its values."""
    held = 2 * Leaf(LOWER, lower)
    return 3 * Leaf(N, n) - held - Leaf(HIGHER, higher)


def _write_groups(subject: Subject) -> Iterable[Block]:
    structure = subject.results.structure
    if structure.groups:
        head = cells(
            _("group"),
            _("class"),
            _("order of the group"),
            _("type"),
            _("internal pairs"),
            _("external pairs"),
            _("mobility"),
        )
        rows = tuple(_group_row(group) for group in structure.groups)
        yield from write_table(
            _(
                "When the input links and the frame are removed, the Assur groups of table {table} remain; the "
                "mobility of each group is zero."
            ),
            Rows(_("Assur groups in the order in which they are attached"), head, rows, "groups"),
        )
    yield paragraph(_("The structural formula of the mechanism is:"))
    yield Equation(Words(structure.formula.replace("->", "→")))
    if len(structure.drivers) > 1:
        yield paragraph(_("Primary mechanisms: {names}.").format(names=describe_primary_mechanisms(structure)))
    yield paragraph(
        _("Type of the kinematic chain and of the structure: {words}.").format(words=describe_classification(structure))
    )
    yield paragraph(
        typeset(_("Number of independent loops K = p - n: {count}.").format(count=describe_contours(structure)))
    )
    text = _(
        "The class of a mechanism is the highest class of its groups {source}; this mechanism is of class {number}."
    )
    yield write_sentence(text, source=Link("frolov"), number=structure.roman)
    schemes = describe_schemes(structure)
    if schemes:
        yield paragraph(_("The mechanism contains these basic mechanisms: {schemes}.").format(schemes=schemes))
    yield from _draw_parts(subject)


def _draw_parts(subject: Subject) -> Iterable[Block]:
    """Write the drawings of the primary mechanisms and Assur groups."""
    drawn = subject.drawings("groups")
    if drawn:
        yield refer_to_blocks(
            _("The only part of the mechanism is shown in figure {first}."),
            _("The parts of the mechanism are shown in figures {first} and {last}."),
            _("The parts of the mechanism are shown in figures {first} to {last}."),
            list(drawn),
        )
    for mechanism_part, (stem, drawing) in zip(mechanism_parts(subject.results.structure), drawn.items(), strict=False):
        text = _("Primary mechanism {title}") if mechanism_part.group is None else _("Group {title}")
        text = _("Redundant link {title}") if mechanism_part.redundant else text
        yield Figure(text.format(title=mechanism_part.title), drawing, stem)


def _group_row(group: Group) -> tuple[Line, ...]:
    n, lower, higher = group.count
    formula = f"3·{n} − 2·{lower}" + (f" − {higher}" if higher else "") + f" = {group.mobility}"
    external = [(pair.name, pair.other(group.own(pair))) for pair in group.outer]
    outer = ", ".join(
        join_with_no_break_spaces(_("{pair} (to {link})").format(pair=pair, link=printed(link)))
        for pair, link in external
    )
    inner = ", ".join(pair.name for pair in group.inner) or NONE
    roman, order = group.roman, str(group.order)
    kind = count_pair_letters(group.type) + (f" ({group.letters}, {group.type_number})" if group.type_number else "")
    return cells(group.title, roman, order, kind, inner, outer, formula)
