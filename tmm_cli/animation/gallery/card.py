"""Cards of the gallery: structure, purposes, properties and moving picture of one mechanism each."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from tmm_cli.animation.gallery.moving_picture import MovingPicture, draw_chain, draw_moving_picture
from tmm_cli.language import N_, _, signed, typeset
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.kinematics import OutputTravel, Strokes, output_run
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.quantities import ANGLE, NUMBER, Dimension, coordinate_dimension
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.problem import Tree, UnitSystem, build_any_problem, build_chain, is_chain, read_file
from tmm_cli.reports import PROPERTY_TOLERANCE, shown_properties, with_unit
from tmm_cli.synthesis import count, solve

LEAST_TIME_RATIO = 1.1  # coefficient of change of mean speed, from which one stroke is the quick one
STILL_FRACTION, LEAST_DWELL = (
    0.01,
    60,
)  # share of a stroke, and degrees of the crank about an end of it: a crank-slider's are 25

PURPOSES: Final = {
    "slides": N_("reciprocating output link"),
    "swings": N_("oscillating output link"),
    "turns": N_("rotating output link"),
    "carried": N_("general plane motion of the output link"),
    "point": N_("path generation"),
    "quick": N_("quick return"),
    "strokes": N_("several strokes in a cycle"),
    "dwell": N_("output link with dwell"),
    "outputs": N_("several output links"),
    "drivers": N_("several input links"),
    "space": N_("spatial mechanism"),
}


def purposes(results: Results) -> tuple[str, ...]:
    """Return the purposes of a mechanism, as keys of PURPOSES in their order.

    They are found from its computed motion.
    """
    keys = set(_iterate_purposes(results))
    return tuple(key for key in PURPOSES if key in keys)


def _iterate_purposes(results: Results) -> Iterable[str]:
    outputs, linkage = results.mechanism.outputs, results.linkage
    back = results.swinging
    for link in outputs:
        if linkage.output_point(link) is not None:
            yield "point"
        elif linkage.output_guide(link) is not None:
            yield "slides"
        elif not linkage.hinged_to_frame(link):
            yield "carried"
        else:
            swings = any(strokes.link == link for strokes in back) or not results.turns
            yield "swings" if swings else "turns"
    for strokes in back:
        if strokes.k >= LEAST_TIME_RATIO or 0 < strokes.k <= 1 / LEAST_TIME_RATIO:
            yield "quick"
        if len(strokes.strokes) > 2:
            yield "strokes"
        if any(stroke.rest for stroke in strokes.strokes) or _has_dwell(results, strokes.link):
            yield "dwell"
    if len(outputs) > 1:
        yield "outputs"
    if len(linkage.drivers) > 1:
        yield "drivers"


def _has_dwell(results: Results, link: str) -> bool:
    """Return True if the output hardly moves near an end of its stroke while the crank rotates."""
    motion = motion_at_positions(results, results.closely(360 * results.turns + 1)[:-1])
    run = output_run(motion, link)[0]
    run = np.unwrap(run) if results.linkage.output_swings(link) else run
    for near in (run - np.min(run), np.max(run) - run):
        still = np.flatnonzero(np.r_[near, near] > STILL_FRACTION * np.ptp(run))  # twice: it may go over the seam
        if np.max(np.diff(still), initial=0) > LEAST_DWELL:
            return True
    return False


# What a card says of a problem file: class, groups, purposes, properties, the mechanism that turns.


LONGEST_TEXT = 1500  # letters of what a file says of itself
DIGITS = 4

Value = tuple[str, float, Dimension]


@dataclass(frozen=True)
class Fact:
    """A property of a mechanism.

    Attributes:
        name: name of the property.
        formatted: value with its unit, formatted for the reader.
        number: the same value as a number in that unit, for searches.
    """

    name: str
    formatted: str
    number: float


@dataclass(frozen=True)
class Card:
    """Card of one mechanism in the gallery. Its texts are not escaped for HTML.

    Attributes:
        file: path of the problem file.
        language: language of the problem file; empty if the file does not give it.
        title: title of the problem.
        reference: source of the problem, e.g. a textbook.
        about: description of the mechanism.
        number: class of the mechanism as a Roman numeral; empty for spatial chains.
        formula: structural formula.
        groups: class and type of each kind of Assur group, e.g. "II RRR".
        purposes: keys of PURPOSES.
        facts: properties of the mechanism.
        turning: moving picture of the mechanism; a diagram of links and pairs for a spatial chain.
    """

    file: str
    language: str
    title: str
    reference: str
    about: str
    number: str
    formula: str
    groups: tuple[str, ...]
    purposes: tuple[str, ...]
    facts: tuple[Fact, ...]
    turning: MovingPicture


def make_card(file: str) -> Card:
    """Make the gallery card of a problem file.

    Raises:
        ProblemError: The file cannot be read or solved.
    """
    tree = read_file(file)
    if is_chain(tree):
        return _chain_card(file, tree, count(build_chain(tree)))
    problem = build_any_problem(tree).whole
    results = solve(problem, "forces" if problem.shows else "kinematics")
    structure = results.structure
    groups = dict.fromkeys(f"{group.roman} {group.type}" for group in structure.groups)
    return Card(
        file,
        _file_language(tree),
        problem.title,
        problem.reference,
        problem.description or leading_comment(file),
        structure.roman,
        structure.formula.replace("->", "→"),
        tuple(groups),
        purposes(results),
        tuple(_format_facts(_facts(results), problem.units)),
        draw_moving_picture(results),
    )


def _chain_card(file: str, tree: Tree, results: ChainResults) -> Card:
    problem = results.problem
    values = list(_shown_properties(results))
    if all(task.of != "W" for task in problem.shows.values()):
        values.insert(0, (_("spatial mobility W"), float(results.chain.mobility), NUMBER))
    return Card(
        file,
        _file_language(tree),
        problem.title,
        problem.reference,
        problem.description or leading_comment(file),
        "",
        typeset(f"W = {results.chain.chain.count}"),
        (),
        ("space",),
        tuple(_format_facts(values, problem.units)),
        draw_chain(results.chain.chain),
    )


def leading_comment(file: str) -> str:
    """Return the comment lines at the beginning of a file as one text. They usually describe the problem."""
    lines = []
    with open(file, encoding="utf-8-sig") as stream:
        for line in stream:
            if not line.startswith("#"):
                break
            lines.append(line.lstrip("#").strip())
    text = re.sub(r"\s+", " ", " ".join(lines)).strip()
    return text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}…"


def _file_language(tree: Tree) -> str:
    return str(tree.data.get("lang", ""))


def _facts(results: Results) -> Iterator[Value]:
    """Yield the properties on a card: quantities that the file requests, mobility, strokes and pressure angle."""
    structure, linkage = results.structure, results.linkage
    yield from _shown_properties(results)
    yield _("mobility W"), float(structure.mobility + structure.redundant), NUMBER
    if structure.redundant:
        yield _("redundant constraints"), float(structure.redundant), NUMBER
    for strokes in results.swinging:
        yield _stroke_name(linkage, strokes), strokes.travel, coordinate_dimension(strokes.kind)
        yield _("time ratio k"), strokes.k, NUMBER
    for travel in results.travels:
        yield _stroke_name(linkage, travel), travel.high - travel.low, coordinate_dimension(travel.kind)
    if results.pressure:
        yield _("largest pressure angle"), max(strokes.largest for strokes in results.pressure), ANGLE


def _stroke_name(linkage: Linkage, motion: Strokes | OutputTravel) -> str:
    link = motion.link
    if linkage.output_point(link) is not None:
        return _("travel of {link}").format(link=link)
    if linkage.output_guide(link) is not None:
        return _("stroke H of link {link}").format(link=link)
    return _("swing angle ψ of link {link}").format(link=link)


def _shown_properties(results: Results | ChainResults) -> Iterable[Value]:
    for property_shown in shown_properties(results):
        yield (
            property_shown.name,
            0.0 if abs(property_shown.value) <= PROPERTY_TOLERANCE else property_shown.value,
            property_shown.dimension,
        )


def _format_facts(values: Iterable[Value], units: UnitSystem) -> Iterator[Fact]:
    """Yield the properties in the units of the file.

    Undefined values are omitted. If several properties have the same name, only the first is kept.
    """
    listed = set[str]()
    for name, value, dimension in values:
        if name not in listed and math.isfinite(value):
            number = float(f"{units.from_si(value, dimension):.{DIGITS}g}") + 0.0
            yield Fact(name, signed(with_unit(units, value, dimension, DIGITS).strip()), number)
        listed.add(name)
