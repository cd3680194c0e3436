"""The force analysis of the note: the order in which it finds things, what it says of vectors, friction, positions."""

import re
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path

import numpy as np
import pytest
from bank import NAMES, solved
from models import PROBLEMS, solved_text

from tmm_cli import load, solve
from tmm_cli.language import spoken
from tmm_cli.mechanics.forces import Symbol, load_symbols, reaction_symbol
from tmm_cli.note import Block, ComputedQuantity, Equation, Expression, Heading, Leaf, Letter, Paragraph, Row, Subject
from tmm_cli.note.forces import chapter as forces

FRICTION = "friction: {coefficient: 0.1, radius: 15}"


def chapter(name: str) -> list[Block]:
    return list(forces.write_forces(Subject(solved(name), drawn=False)))


def section(found: list[Block], title: str) -> list[Block]:
    at = next(number for number, block in enumerate(found) if isinstance(block, Heading) and block.text == title)
    return list(takewhile(lambda block: not isinstance(block, Heading), found[at + 1 :]))


def leaves(expression: Expression) -> Iterator[Leaf]:
    if isinstance(expression, Leaf):
        yield expression
    for part in getattr(expression, "terms", ()):
        yield from leaves(part[1])
    for part in getattr(expression, "factors", ()):
        yield from leaves(part)
    for name in ("over", "under", "of"):
        if hasattr(expression, name):
            yield from leaves(getattr(expression, name))


def under(block: Equation) -> dict[str, int]:
    """Lines under the vectors of a sum, by their names."""
    rows = [block.node] if isinstance(block.node, Row) else block.node.nodes
    return {n.symbol.name: n.lines for r in rows for n in r.nodes if isinstance(n, Letter) and n.vector}


def opposite(name: Symbol, links: list[str]) -> Symbol:
    """R₄₃ of R₃₄."""
    by = next(a for a in links for b in links if reaction_symbol(a, b).below == name.below)
    on = next(b for b in links if reaction_symbol(by, b).below == name.below)
    return reaction_symbol(on, by)


@pytest.mark.parametrize("name", NAMES)
def test_no_reaction_is_put_in_before_it_is_found(name):
    links = list(solved(name).linkage.links)
    known: set[Symbol] = set()
    for block in chapter(name):
        if isinstance(block, Heading) and block.text.startswith("Loads on the links"):
            known = set()
        if not isinstance(block, ComputedQuantity) or block.name.letter == "ΣM":
            continue
        found, expression = block.name, block.expression
        for leaf in leaves(expression):
            if leaf.symbol.letter == "R" and leaf.symbol != found:
                assert {leaf.symbol, opposite(leaf.symbol, links)} & known, f"{leaf.symbol.name} for {found.name}"
        known.add(found)
        known |= {Symbol("R", found.below)} if found.above else set()


def at_one_position(name: str, *, at: str) -> list[Block]:
    """The force analysis of a problem of the bank at one driver angle (deg)."""
    text = re.sub(
        "(?m)^positions: .*", f"positions: {{count: 1, from: {at}}}", (PROBLEMS / f"{name}.yaml").read_text("utf-8")
    )
    return list(forces.write_forces(Subject(solved_text(text), drawn=False)))


@pytest.mark.parametrize("at", ["0", "30", "90"])
def test_a_sine_mechanism_has_a_force_analysis_at_any_one_position(at):
    """At 0 deg all its moving points coincide, and nothing has a moment about the hinge of the sliding block."""
    found = [b for b in at_one_position("sine", at=at) if isinstance(b, ComputedQuantity)]
    assert all(block.printed()[1] for block in found)


def test_moments_that_cancel_are_written_out():
    """With the crank at 0 deg the four reactions of a four-cylinder engine have moments about the shaft that cancel."""
    driving = section(at_one_position("engine-four", at="0"), "Input link 1")
    (equation,) = [b for b in driving if isinstance(b, Equation) and "ΣM" in repr(b)]
    assert [name for name in ("R₂₁", "R₄₁", "R₆₁", "R₈₁") if name in names(equation)] == ["R₂₁", "R₄₁", "R₆₁", "R₈₁"]
    (moment,) = [b for b in driving if isinstance(b, ComputedQuantity) and b.name.letter == "M"]
    assert moment.result == 0
    assert not any("Nothing has a moment" in str(b.line) for b in driving if isinstance(b, Paragraph))


def names(equation: Equation) -> list[str]:
    """The letters of an equation."""
    rows = [equation.node] if isinstance(equation.node, Row) else equation.node.nodes
    return [n.symbol.name for row in rows for n in row.nodes if isinstance(n, Letter)]


def test_groups_come_from_the_last_to_the_driving_link():
    headings = [block.text for block in chapter("shaper") if isinstance(block, Heading)]
    assert headings == [
        "Force analysis",
        "Loads on the links",
        "Group of links 4, 5",
        "Group of links 2, 3",
        "Input link 1",
        "Check by the Zhukovsky lever",
        "Forces in all positions",
    ]


def test_lines_under_a_vector_say_what_is_known_of_it():
    sums = [block for block in section(chapter("shaper"), "Group of links 4, 5") if isinstance(block, Equation)]
    whole = next(vectors for vectors in map(under, sums) if "R₃₄ⁿ" in vectors)
    assert whole == {"R₃₄ⁿ": 1, "R₃₄ᵗ": 2, "G₄": 2, "U₄": 2, "G₅": 2, "U₅": 2, "F": 2, "R₀₅": 1}


def test_a_stone_between_two_guides_takes_two_polygons():
    sums = [block for block in section(chapter("course-2"), "Group of links 4, 5") if isinstance(block, Equation)]
    first, second = [vectors for vectors in map(under, sums) if vectors]
    assert first == {"G₅": 2, "U₅": 2, "Q": 2, "R₄₅": 1, "R₀₅": 1}, "two sizes unknown"
    assert second["R₀₅"] == 2 and second["R₃₄"] == 0, "then a size and a direction"


def test_nothing_is_written_where_nothing_acts():
    assert not chapter("five-point-line")


def test_links_whose_reactions_are_found_together_are_said_to_be():
    said = " ".join(str(block.line) for block in chapter("class-iv") if isinstance(block, Paragraph))
    assert "solved together" in said
    checks = [b for b in chapter("class-iv") if isinstance(b, ComputedQuantity) and b.name.letter == "ΣM"]
    assert len(checks) == 4 and all(check.result == 0 for check in checks)


@pytest.fixture(scope="module")
def rubbing(tmp_path_factory):
    """The shaper with friction, two positions in detail."""
    text = (PROBLEMS / "shaper.yaml").read_text(encoding="utf-8")
    text = text.replace("output: 5", f"{FRICTION}\noutput: 5").replace("detail: [3]", "detail: [3, 8]")
    file = tmp_path_factory.mktemp("friction") / "shaper.yaml"
    file.write_text(text, encoding="utf-8")
    return solve(load(str(file)))


def test_friction_is_told_pair_by_pair_with_what_it_costs(rubbing):
    found = [
        block for block in forces.write_forces(Subject(rubbing, drawn=False)) if isinstance(block, ComputedQuantity)
    ]
    rubbed = {s.name.below for s in found if s.name.letter == "T"}
    assert rubbed == {one.pair + rubbing.reactions.of(one.pair).on for one in rubbing.linkage.friction}
    without = [s.result for s in found if s.name == Symbol("M", "b", "0")]
    free = solved("shaper").reactions.balance.moment
    assert without == pytest.approx([abs(free[3]), abs(free[8])])
    efficiency = next(s for s in found if s.name.letter == "η")
    assert efficiency.result == rubbing.losses.efficiency and efficiency.printed()


def test_the_method_is_explained_once_and_sections_are_named_after_their_positions(rubbing):
    found = list(forces.write_forces(Subject(rubbing, drawn=False)))
    headings = [block.text for block in found if isinstance(block, Heading)]
    assert [re.findall(r"position (\d)", text) for text in headings].count(["3"]) == 5
    said = [str(block.line) for block in found if isinstance(block, Paragraph)]
    once = ("d'Alembert", "acceleration of gravity", "angular acceleration", "closed polygon. Vectors", "rigid lever")
    for words in once:
        assert sum(words in text for text in said) == 1, words


def test_friction_of_a_hinge_and_of_the_guide_beside_it_have_letters_of_their_own(rubbing):
    letters = [load_symbols(load)[0] for load in rubbing.loads if load.kind == "friction"]
    assert {"TA2", "TA1", "TA'2", "TA'3"} <= {letter.plain for letter in letters}
    assert len({*letters}) == len(letters)


@pytest.mark.parametrize("load", ["M3", "G3", "U3", "Q3", "P3", "Mb", "Mc"])
@pytest.mark.parametrize("language", ["en", "ru"])
def test_a_couple_may_have_the_name_of_another_quantity(load, language):
    """The couple M on the link is replaced by forces M / l at its two points, whatever both are called; a formula
    whose value is not that of its numbers is refused when it is printed."""
    text = (Path(__file__).parent / "data" / "couple-named-m3.yaml").read_text().replace("M3:", f"{load}:")
    results = solved_text(text)
    with spoken(language):
        found = [b for b in forces.write_forces(Subject(results, drawn=False)) if isinstance(b, ComputedQuantity)]
        for block in found:
            block.printed()
    inertia = next(a for a in results.loads if a.link == "3" and a.kind == "inertia")
    (k,) = Subject(results, drawn=False).detail
    pairs = {b.name: b.result for b in found if b.name.letter == "P"}
    wanted = [abs(inertia.moment[k]) / 0.18, 40 / 0.18]
    assert list(pairs.values())[1:] == pytest.approx(wanted) and len(pairs) == 3
    symbols = [symbol for a in results.loads for symbol in set(load_symbols(a)) if np.any(a.force) or np.any(a.moment)]
    assert len(symbols) == len(set(symbols))
