"""The note: every formula with numbers put in is true, every number is one of the results or of the file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from bank import NAMES, moved, solved, written
from formulas import formula, formulas, maths
from models import DATA, PROBLEMS
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.language import spoken
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Symbol, find_transmitted_forces
from tmm_cli.mechanics.quantities import DIMENSIONS
from tmm_cli.note import (
    EXACT,
    MOST_FIGURES,
    ComputedQuantity,
    Function,
    Heading,
    Leaf,
    Rows,
    Sum,
    evaluate,
    html,
    largest_term,
    note,
)
from tmm_cli.reports import json_text, sections

LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
FIGURES = r"(?<![\w.,′'])[−-]?\d+(?:\.\d+)?(?![\w.]*\w)"
COUNTED = 100  # whole numbers below it count or name something


@cache
def page(name: str) -> str:
    return html(written(name)).decode()


@pytest.mark.parametrize("name", NAMES)
def test_every_formula_gives_its_printed_result_within_its_last_digit(name):
    read = formulas(page(name))
    wrong = ["".join(re.sub(r"<[^>]+>", " ", one.source).split()) for one in read if not one.true]
    assert not wrong
    alone = [one for one in maths(page(name)) if formula(one) is None and re.search(r"<mo>=</mo><mn>[^=]*</math>", one)]
    substituted = [block for block in written(name).blocks if isinstance(block, ComputedQuantity)]
    assert len(read) + len(alone) >= len(substituted) > 0, "each of them was read, or has a result only"


def test_a_formula_with_a_sign_changed_is_not_written():
    changed = [
        block
        for block in written("shaper").blocks
        if isinstance(block, ComputedQuantity) and isinstance(block.expression, Sum)
    ]
    assert changed
    for found in changed:
        (sign, first), *others = found.expression.terms
        wrong = replace(found, expression=Sum(((-sign, first), *others)))
        with pytest.raises(ValueError, match="is not"):
            wrong.printed()


G, ARM = Leaf(Symbol("G"), 1234.5678), Leaf(Symbol("h"), 0.31)


@pytest.mark.parametrize(
    "expression",
    [
        G * Function("sin", Leaf(Symbol("φ"), np.pi - 1e-9, angle=True)) * ARM,
        ARM * (G - Leaf(Symbol("F"), 1234.5678 * (1 - 1e-12))),
        (G * ARM - G * ARM) / Leaf(Symbol("m"), 1e-3),
        Function("sqrt", G * G - Leaf(Symbol("F"), 1234.5678) ** 2),
        G * ARM - G * Leaf(Symbol("k"), 0.31 * (1 + 3e-9)),
    ],
)
def test_what_cancels_but_for_rounding_is_printed_as_zero(expression):
    """Wherever in the expression: with 8 figures put in, all digits of its value may be wrong."""
    for result in (evaluate(expression, EXACT), 2.6e-14, 0.0):
        figures, text = ComputedQuantity(Symbol("M"), expression, result).printed()
        assert abs(float(text)) <= 1e-6 * largest_term(expression) and figures <= MOST_FIGURES
    with pytest.raises(ValueError, match=r"M: .* is not 100\.0"):
        ComputedQuantity(Symbol("M"), expression, 100.0).printed()


def test_a_sign_changed_in_the_page_is_seen():
    text = next(one for one in maths(page("shaper")) if formula(one))
    changed = re.sub(r"(.*)<mo>−</mo>(<mn>[1-9])", r"\1<mo>+</mo>\2", text)
    assert changed != text and formula(text).true and not formula(changed).true


def leaves(content: Any) -> Iterator[float]:
    """Numbers of nested content, of its texts and names too."""
    match content:
        case dict():
            for key, value in content.items():
                yield from leaves(key)
                yield from leaves(value)
        case list() | tuple():
            for value in content:
                yield from leaves(value)
        case str():
            yield from (float(text) for text in re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", content))
        case int() | float():
            yield float(content)


def vectors(content: Any) -> Iterator[float]:
    """Sizes and directions (0 to 2π) of what has two components, each an array, one a position."""
    if isinstance(content, dict) and isinstance(content.get("x"), list):
        pair = np.array([content["x"], content["y"]], dtype=float)
        yield from np.hypot(*pair)
        yield from np.arctan2(*pair[::-1]) % (2 * np.pi)
    for value in content.values() if isinstance(content, dict) else content if isinstance(content, list) else ():
        yield from vectors(value)


def known(results: Results) -> np.ndarray:
    """Numbers of result.json, of the file and of what was read from it; in SI, units of the file, percent and rpm."""
    record = json.loads("".join(json_text(sections(results))))
    found = [*leaves(record), *vectors(record)]
    found += leaves(results.problem.source.data)
    found += [abs(results.linkage.gravity), np.angle(results.linkage.gravity)]
    for link in results.linkage.links.values():
        found += [float(np.ravel(abs(a - b))[0]) for a, b in combinations(link.points.values(), 2)]
        found += [float(np.ravel(link.mass)[0]), float(np.ravel(link.inertia)[0])]
        places = [*link.points.values(), link.centre, *(s.through for s in results.linkage.slides)]
        found += [float(np.ravel(part)[0]) for z in places for part in (np.real(z), np.imag(z))]
    for own in results.linkage.loads:
        if own.table is not None:  # a pressure of the file is a force in it
            found += [*own.table.arguments, *own.table.values]
    for force in find_transmitted_forces(results.motion, results.reactions) if results.reactions else ():
        found += [*force.useful, *np.arccos(np.clip(force.useful / np.maximum(force.driving, 1e-300), 0, 1))]
    task = results.problem.dynamics
    if task is not None:  # the same of what drives, and a motor's numbers are reduced to the driver
        found += [task.flywheel, *(vars(task.motor).values() if task.motor is not None else ())]
        drive = getattr(task, "drive", None)
        found += [*drive.arguments, *drive.values] if drive is not None else []
    for mesh in results.linkage.meshes:
        found.append(mesh.offset)  # a formula in the file
        if mesh.law is not None:  # where its pieces begin and end
            found += [*np.cumsum([mesh.law.start, *(piece.over for piece in mesh.law.pieces)])]
            found += [*np.cumsum([mesh.offset, *(piece.rise for piece in mesh.law.pieces)])]
    for table in (one.table for one in results.linkage.loads if one.table is not None):
        found += [*table.arguments, *table.values]
    units = results.problem.units
    own = {float(units.from_si(1.0, kind.dimension)) for kind in DIMENSIONS.values()}
    every = np.outer(found, sorted(own | {1.0, 100.0, 180 / np.pi, 30 / np.pi}))
    return np.unique(np.abs(every[np.isfinite(every)]))


def printed(text: str) -> list[str]:
    """Figures in sentences, lists and tables; not in formulas, headings, contents and literature."""
    body = text.partition("<body>")[2]
    for apart in ("nav", "header", "ol", "h1", "h2", "svg", "caption", "figcaption", 'math display="block"'):
        body = re.sub(rf"<{apart}[ >].*?</{apart.partition(' ')[0]}>", " ", body, flags=re.S)
    body = re.sub(r"·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", lambda power: f"e{power[1].translate(LOWERED)}", body)
    body = re.sub(r"<p>If moment arms and segments are measured.*?</p>", " ", body)  # as drawn: test_course_notation.py
    return re.findall(FIGURES, re.sub(r"<[^>]+>", " ", body))


def half_a_digit(figures: str) -> float:
    """Half of the last digit; zeros at the end of a whole number may be no figures of it."""
    digits = figures.lstrip("−-")
    if "." in digits:
        return 0.5 * 10.0 ** -len(digits.partition(".")[2])
    return 0.5 * 10.0 ** (len(digits) - len(digits.rstrip("0")))


@pytest.mark.parametrize("name", NAMES)
def test_every_number_in_a_sentence_or_table_is_one_of_the_results_or_of_the_file(name):
    truths, unknown = known(solved(name)), []
    for figures in printed(page(name)):
        value = abs(float(figures.replace("−", "-")))
        slack = half_a_digit(figures) + 1e-9 * value
        low, high = np.searchsorted(truths, [value - slack, value + slack])
        if low == high and not ("." not in figures and value < COUNTED):
            unknown.append(figures)
    assert not unknown


HOSTILE = '<script>alert(1)</script><img src=x onerror="alert(1)">&amp;{title}\\frac{1}{2}=1+1'


def hostile() -> Results:
    """The shaper with markup in every text that a file can give."""
    problem = load(str(PROBLEMS / "shaper.yaml"))
    people = ("student", "group", "teacher", "institution", "department", "code")
    texts = problem.title_texts.model_copy(update=dict.fromkeys(people, HOSTILE))
    links = {name: replace(link, label=HOSTILE) for name, link in problem.linkage.links.items()}
    loads = tuple(replace(load, name=HOSTILE) for load in problem.linkage.loads)
    return solve(
        replace(
            problem,
            title=HOSTILE,
            description=HOSTILE,
            title_texts=texts,
            linkage=replace(problem.linkage, links=links, loads=loads),
            extended=None,
        )
    )


def test_texts_of_the_file_are_data_in_the_page():
    text = html(note(hostile())).decode()
    assert "<script" not in text and "<img" not in text
    assert text.count("&lt;script&gt;alert(1)&lt;/script&gt;&lt;img src=x onerror=&quot;alert(1)&quot;&gt;") > 8
    assert "default-src 'none';style-src 'sha256-" in text, "and nothing could run or be loaded if it were not"
    assert not re.search(r'(src|href|xlink:href)="(?!#)', text), "it opens without a network"
    assert not re.search(r"<\w+[^>]*\son\w+=", text)


def test_every_source_of_the_list_is_referred_to():
    listed = re.search(r'<ol class="sources">.*?</ol>', page("shaper"), re.S)
    assert listed
    places = re.findall(r'<li id="(\w+)">', listed[0])
    assert places and all(f'[<a href="#{place}">' in page("shaper") for place in places)


def test_what_a_note_refers_to_is_in_it():
    for name in ("shaper", "press-synthesis", "planetary-dwell-press"):
        text = html(note(solved(name))).decode()
        assert set(re.findall(r'href="#([^"]+)"', text)) <= set(re.findall(r'id="([^"]+)"', text))


def test_a_note_without_loads_has_no_chapter_on_forces():
    headings = {block.text for block in written("four-positions").blocks if isinstance(block, Heading)}
    assert "Kinematic analysis" in headings and "Force analysis" not in headings


def test_usual_names_of_links_are_said_in_the_reader_s_language():
    problem = moved("press-class-iii").problem
    links = dict(problem.linkage.links)
    links |= {"5": replace(links["5"], label="тяга"), "6": replace(links["6"], label="")}
    results = solve(replace(problem, linkage=replace(problem.linkage, links=links)), "kinematics")
    with spoken("ru"):
        sizes = next(block for block in note(results, drawn=False).blocks if isinstance(block, Rows))
    names = ["".join(map(str, cells[1])) for cells in sizes.rows]
    assert names == ["кривошип", "рычаг", "шатун", "ползун", "тяга", "качающийся ползун", "коромысло"]


def test_a_large_group_is_told_in_the_table_as_in_the_drawings():
    groups = next(
        block for block in written("press-class-iii").blocks if isinstance(block, Rows) and block.key == "groups"
    )
    assert ("5R1P",) in groups.rows[0], "not RRRRRP"


def test_the_note_of_a_mechanism_of_fifteen_links_is_written(tmp_path):
    done = tmm("note", DATA / "radial-seven.yaml", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "radial-seven" / "note.html").read_text(encoding="utf-8")
    assert all(f"II({k},{k + 1})" in text for k in range(2, 16, 2))
