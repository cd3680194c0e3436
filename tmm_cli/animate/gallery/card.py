"""What a card says of a problem file: class, groups, purposes, properties, the mechanism that turns."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.animate.gallery.chains import scheme
from tmm_cli.animate.gallery.purposes import purposes
from tmm_cli.animate.gallery.turning import Turning, turning
from tmm_cli.kinematics.output import Travel
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.language import _, signed, typeset
from tmm_cli.library import count, problem_of, solve
from tmm_cli.linkage import Linkage
from tmm_cli.problem.build import is_chain
from tmm_cli.problem.build_chain import build_chain
from tmm_cli.problem.reader import read_file
from tmm_cli.problem.tree import Tree
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import ANGLE, NUMBER, Dimension, place_dimension
from tmm_cli.results.properties import MET, properties_shown
from tmm_cli.results.table import with_unit

LONGEST = 1500  # letters of what a file says of itself
DIGITS = 4

Value = tuple[str, float, Dimension]


@dataclass(frozen=True)
class Fact:
    """A property: its words, its value with the unit for people, and the number (in that unit) for searches."""

    name: str
    told: str
    number: float


@dataclass(frozen=True)
class Card:
    """A mechanism; texts are as the file has them, and may be anything.

    number: of its class, empty in space; groups: with class and type, II RRR; purposes: keys of PURPOSES.
    language: of the file. turning: of a chain given by pairs alone, which has no dimensions, its scheme.
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
    turning: Turning


def card(file: str) -> Card:
    """The card of a problem file. Raises ProblemError."""
    tree = read_file(file)
    if is_chain(tree):
        return _of_chain(file, tree, count(build_chain(tree)))
    problem = problem_of(tree).whole
    results = solve(problem, "forces" if problem.shows else "kinematics")
    structure = results.structure
    groups = dict.fromkeys(f"{group.roman} {group.type}" for group in structure.groups)
    return Card(
        file, _language(tree), problem.title, problem.reference, problem.description or remark(file),
        structure.roman, structure.formula.replace("->", "→"), tuple(groups),
        purposes(results), tuple(_told(_facts(results), problem.units)), turning(results),
    )  # fmt: skip


def _of_chain(file: str, tree: Tree, results: ChainResults) -> Card:
    problem = results.problem
    values = list(_shown(results))
    if all(task.of != "W" for task in problem.shows.values()):
        values.insert(0, (_("mobility W in space"), float(results.chain.mobility), NUMBER))
    return Card(
        file, _language(tree), problem.title, problem.reference, problem.description or remark(file), "",
        typeset(f"W = {results.chain.chain.count}"), (), ("space",), tuple(_told(values, problem.units)),
        scheme(results.chain.chain),
    )  # fmt: skip


def remark(file: str) -> str:
    """The remark at the head of a file, where people say what it is."""
    lines = []
    with open(file, encoding="utf-8-sig") as stream:
        for line in stream:
            if not line.startswith("#"):
                break
            lines.append(line.lstrip("#").strip())
    text = re.sub(r"\s+", " ", " ".join(lines)).strip()
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}…"


def _language(tree: Tree) -> str:
    return str(tree.data.get("lang", ""))


def _facts(results: Results) -> Iterator[Value]:
    """What the file shows; what every mechanism has."""
    structure, linkage = results.structure, results.linkage
    yield from _shown(results)
    yield _("mobility W"), float(structure.mobility + structure.redundant), NUMBER
    if structure.redundant:
        yield _("passive constraints"), float(structure.redundant), NUMBER
    for one in results.swinging:
        yield _stroke(linkage, one), one.travel, place_dimension(one.kind)
        yield _("coefficient of change of mean speed k"), one.k, NUMBER
    for travel in results.travels:
        yield _stroke(linkage, travel), travel.high - travel.low, place_dimension(travel.kind)
    if results.pressure:
        yield _("largest pressure angle"), max(one.largest for one in results.pressure), ANGLE


def _stroke(linkage: Linkage, found: Strokes | Travel) -> str:
    link = found.link
    if linkage.output_point(link) is not None:
        return _("travel of {link}").format(link=link)
    if linkage.output_guide(link) is not None:
        return _("stroke H of link {link}").format(link=link)
    return _("swing psi of link {link}").format(link=link)


def _shown(results: Results | ChainResults) -> Iterable[Value]:
    for one in properties_shown(results):
        yield one.name, 0.0 if abs(one.value) <= MET else one.value, one.dimension


def _told(values: Iterable[Value], units: UnitSystem) -> Iterator[Fact]:
    """With the units of the file; of one name the first, and none that has no value."""
    told = set[str]()
    for name, value, dimension in values:
        if name not in told and math.isfinite(value):
            number = float(f"{units.from_si(value, dimension):.{DIGITS}g}") + 0.0
            yield Fact(name, signed(with_unit(units, value, dimension, DIGITS).strip()), number)
        told.add(name)
