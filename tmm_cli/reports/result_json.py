"""result.json: all results in SI units and radians, and its JSON Schema.

Arrays have one entry per position: null where the position cannot be reached or is dead. A vector is two arrays, x, y.
To add a section, add a line to MOTION_PARTS (json_motion), to FIRST or to LAST."""

from __future__ import annotations

import cmath
from collections.abc import Collection, Iterator
from operator import methodcaller
from typing import Any, NamedTuple

from tmm_cli.language import words_of_files
from tmm_cli.mechanics.analysis import Results, run_checks
from tmm_cli.mechanics.linkage import Link
from tmm_cli.mechanics.structure import (
    ChainResults,
    basic_schemes,
    classify_linkage,
    count_in_space,
    find_contours,
    is_dependent,
    six_bar_schemes,
)
from tmm_cli.problem import UnitSystem
from tmm_cli.reports.file_summary import doubts
from tmm_cli.reports.json_fields import (
    FLAG,
    INTEGER,
    NAMES,
    NUMBER,
    TEXT,
    Field,
    JsonType,
    contents,
    inside,
    list_of,
    map_of,
    optional,
    properties,
    record,
)
from tmm_cli.reports.json_motion import MOTION_PARTS, WHEEL
from tmm_cli.reports.properties import properties_shown
from tmm_cli.reports.structure_tables import motion_of_link
from tmm_cli.reports.synthesis_tables import synthesis_json as synthesis_json
from tmm_cli.reports.table import plain
from tmm_cli.reports.warnings import collect_warnings
from tmm_cli.synthesis import measure_problem

PROBLEM = record(
    "what was computed",
    Field("name", TEXT, "of the file"),
    Field("title", TEXT, "title"),
    Field("description", TEXT, "description"),
)


class LinkInRole(NamedTuple):
    """A moving link and what it is in the mechanism."""

    link: Link
    role: str
    motion: str


LINK = record(
    "a link",
    Field("name", TEXT, "its key in the file", "link.name"),
    Field("role", TEXT, "crank, rocker, coupler, ..."),
    Field("label", TEXT, "the file's own name", "link.label"),
    Field("points", NAMES, "its points", "link.points"),
    Field("motion", TEXT, "rotation, translation or plane motion"),
)
ENDS = Field("links", NAMES, "first and second link", lambda pair: (pair.i, pair.j))
PAIR = record(
    "a pair",
    Field("name", TEXT, "point or guide; a compound hinge's further pairs have primes"),
    Field("kind", TEXT, "R turning, P sliding, G wheels, K rack, C cam"),
    ENDS,
    Field("point", TEXT, "hinge or running point"),
    Field("freedoms", NUMBER, "relative freedoms in the plane"),
    Field("class", NUMBER, "5 of a lower pair, 4 of a higher one", "pair_class"),
    Field("code", TEXT, "1в revolute, 1п prismatic; empty for a higher pair"),
)
PASSIVE = record(
    "conditions that only repeat others",
    Field("pair", TEXT, "pair"),
    Field("constraints", NUMBER, "how many"),
    Field("links", NAMES, "its links, the passive one last"),
    Field("among", NAMES, "links that hold each other"),
)
GROUP = record(
    "an Assur group",
    Field("links", NAMES, "links"),
    Field("class", TEXT, "roman", lambda group: group.roman),
    Field("order", NUMBER, "number of outer pairs"),
    Field("type", TEXT, "RRR, RRP, RPR, PRP, RPP"),
    Field("name", TEXT, "II(2,3)", "title"),
    Field("type_number", NUMBER, "1 to 5 for a class II group of two links", there="type_number"),
    Field("letters", TEXT, "its type as ВВВ, ВВП, ВПВ, ПВП, ВПП", there="type_number"),
    Field("inner", NAMES, "internal pairs", lambda group: [pair.name for pair in group.inner]),
    Field("outer", NAMES, "external pairs", lambda group: [pair.name for pair in group.outer]),
)
RIGID = record(
    "links that are rigid to one another",
    Field("links", NAMES, "links; 0 is the frame"),
    Field("redundant", NUMBER, "redundant constraints q among them", "constraints"),
)
REDUNDANT_LINK = record(
    "a redundant link, or several that are rigid to one another",
    Field("links", NAMES, "links"),
    Field("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
)
REDUNDANT_PAIR = record(
    "a pair with redundant constraints",
    Field("pair", TEXT, "pair"),
    Field("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
    Field("left", NUMBER, "its constraints that are left"),
)
REDUCTION = record(
    "what is redundant or rigid",
    Field("rigid", list_of(RIGID), "sets of links that count as one"),
    Field("links", list_of(REDUNDANT_LINK), "redundant links"),
    Field("pairs", list_of(REDUNDANT_PAIR), "redundant pairs"),
)


STRUCTURE = record(
    "links, pairs and Assur groups",
    Field("mobility", NUMBER, "Chebyshev, W = 3n - 2 p1 - p2", "structure.mobility"),
    Field(
        "links",
        list_of(LINK),
        "moving links",
        lambda r: [LinkInRole(r.linkage.links[n], r.roles[n], motion_of_link(r, n)) for n in r.structure.links],
    ),
    Field("pairs", list_of(PAIR), "pairs", "structure.pairs"),
    Field(
        "true_mobility",
        NUMBER,
        "by rank, where dimensions leave more than the count",
        lambda results: results.structure.mobility + results.structure.redundant,
    ),
    Field("passive", list_of(PASSIVE), "passive constraints", "structure.passive"),
    Field("n", NUMBER, "moving links", lambda results: len(results.structure.links)),
    Field("p1", NUMBER, "lower pairs", lambda results: len(results.structure.pairs) - results.structure.higher),
    Field("p2", NUMBER, "higher pairs", "structure.higher"),
    Field("contours", NUMBER, "independent contours K = p - n", "structure.contours"),
    Field(
        "classification",
        NAMES,
        "closed or open; elementary, simple, complex; of one type or several",
        lambda results: classify_linkage(results.structure),
    ),
    Field(
        "dependent_contours",
        NUMBER,
        "contours closed by redundant links or pairs",
        lambda r: sum(is_dependent(c, r.structure) for c in find_contours(r.structure.pairs, r.structure.links)),
        lambda r: bool(r.structure.reduction),
    ),
    Field(
        "six_bar",
        NAMES,
        "Watt I, II or Stephenson I, II, III; several where a compound hinge can be drawn in several ways",
        lambda r: six_bar_schemes(r.structure),
        lambda r: bool(six_bar_schemes(r.structure)),
    ),
    Field(
        "basic_schemes", map_of(TEXT), "of the contours of four links, by contour", lambda r: basic_schemes(r.structure)
    ),
    Field("formula", TEXT, "formula of structure", "structure.formula"),
    Field("class", TEXT, "class of the mechanism", lambda results: results.structure.roman),
    Field("groups", list_of(GROUP), "in solving order, of what is not redundant", "structure.groups"),
    Field(
        "reduction",
        REDUCTION,
        "what the groups and the formula leave out",
        "structure.reduction",
        lambda results: bool(results.structure.reduction),
    ),
)

CONTOUR = record(
    "a contour",
    Field("links", NAMES, "from the one nearest the frame round"),
    Field("pairs", NAMES, "between them"),
)


CHAIN = (
    Field("mobility", NUMBER, "Somov-Malyshev, W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5"),
    Field("n", NUMBER, "moving links", lambda chain: len(chain.links)),
    Field("p1", NUMBER, "pairs with 1 freedom", lambda chain: chain.p(1)),
    *(Field(f"p{k}", NUMBER, f"pairs with {k} freedoms", methodcaller("p", k)) for k in range(2, 6)),
    Field("K", NUMBER, "independent contours", lambda chain: len(chain.pairs) - len(chain.links)),
)
REPLACEMENT = record(
    "a pair",
    Field("pair", TEXT, "name", "pair.name"),
    *inside("pair", (ENDS,)),
    Field("was", TEXT, "kind"),
    Field("kind", TEXT, "kind it is to have"),
    Field("freedoms", NUMBER, "of that kind"),
)
PROPOSED = record(
    "the same count with them",
    *inside("proposed", CHAIN),
    Field("local", NUMBER, "Wm", "rank.local"),
    Field("redundant", NUMBER, "q", "redundant_then"),
)
SPACE = record(
    "the planar linkage counted in space",
    *inside("chain", CHAIN),
    Field("wanted", NUMBER, "mobility Wo"),
    Field("local", NUMBER, "local mobility Wm"),
    Field("redundant", NUMBER, "redundant constraints q = Wo + Wm - W"),
    Field(
        "contours",
        list_of(CONTOUR),
        "independent contours",
        lambda space: find_contours(space.chain.pairs, space.chain.links),
    ),
    Field(
        "replacements", optional(list_of(REPLACEMENT)), "pairs to give more freedoms, so that q = 0; null: none found"
    ),
    Field(
        "proposed",
        optional(PROPOSED),
        "the same count with them",
        lambda space: None if space.replacements is None else space,
    ),
)

CHAIN_PAIR = record(
    "a pair",
    Field("name", TEXT, "name"),
    ENDS,
    Field("kind", optional(TEXT), "null when only freedoms are given", lambda pair: pair.kind or None),
    Field("freedoms", NUMBER, "1 to 5"),
    Field("class", NUMBER, "number of its constraints", "pair_class"),
)
LOCAL_FREEDOM = record(
    "one of them",
    Field("links", NAMES, "that move alone"),
    Field("freedoms", NUMBER, "how many"),
    Field("pairs", NAMES, "that hold them", lambda local: [pair.name for pair in local.ends]),
)
SPATIAL = record(
    "a chain given by pairs alone",
    *inside("chain", CHAIN),
    Field("form", TEXT, "open, closed, or mixed: with open branches"),
    Field("contours", list_of(CONTOUR), "independent contours"),
    Field("branches", NAMES, "links in no contour"),
    Field("pairs", list_of(CHAIN_PAIR), "pairs", "chain.pairs"),
    Field("local_freedoms", list_of(LOCAL_FREEDOM), "found from the kinds of pairs", "local"),
    Field("local", NUMBER, "local mobility Wm, as given or as found", "local_mobility"),
    Field("wanted", NUMBER, "mobility Wo, as given"),
    Field("redundant", NUMBER, "q = Wo + Wm - W"),
    Field("output", optional(TEXT), "link held"),
    Field("manoeuvrability", NUMBER, "mobility with the output held"),
)

PLACE = record("m", Field("x", NUMBER, "x", "real"), Field("y", NUMBER, "y", "imag"))
ASSEMBLY = record(
    "an assembly",
    Field("angles", map_of(NUMBER), "of the group's links, rad"),
    Field("points", map_of(PLACE), "of the group's links, m"),
    Field("margin", NUMBER, "distance from a dead position: 0 there"),
    Field("sketch", FLAG, "that of the sketch", "of_sketch"),
)
GROUP_ASSEMBLIES = record(
    "a group",
    Field("group", TEXT, "II(2,3)", "group.title"),
    Field("method", TEXT, "closed form, polynomial, angles, many starts"),
    Field("complete", FLAG, "whether it is proved that there are no others"),
    Field("most", NUMBER, "so many are possible, if known"),
    Field("moves", FLAG, "moves by itself here: assemblies without end"),
    Field("assemblies", list_of(ASSEMBLY), "real ones"),
)
ASSEMBLIES = record(
    "a place",
    Field("position", optional(INTEGER), "its number; null: the place of the sketch", "number"),
    Field("driver", NUMBER, "rad or m", "q"),
    Field(
        "undecided",
        optional(TEXT),
        "group that the sketch does not decide",
        lambda here: here.undecided and here.undecided.title,
    ),
    Field("lost", NAMES, "groups whose neighbours cannot be placed", lambda here: [g.title for g in here.lost]),
    Field("groups", list_of(GROUP_ASSEMBLIES), "in solving order, links before placed as in the sketch"),
)


FORMAT = 1
SI = UnitSystem({"length": "m", "angle": "rad"})


def _synthesis(results: Results) -> dict[str, Any]:
    assert results.problem.synthesis is not None
    return synthesis_json(results.problem.synthesis, measure_problem(results), long=False)


FIRST = (
    Field("structure", STRUCTURE, "links, pairs and Assur groups", lambda r: r),
    Field("space", SPACE, "the planar linkage counted in space", lambda r: count_in_space(r.linkage, r.structure)),
    Field(
        "synthesis",
        JsonType({"type": "object"}),
        "what the file's synthesis asked, found and measured",
        _synthesis,
        lambda r: r.problem.synthesis is not None and r.motion is not None,
    ),
)
PROPERTY = record(
    "a property that the file shows",
    Field("property", TEXT, "in its words", "name"),
    Field("value", NUMBER, "SI"),
    Field("unit", TEXT, "of the value; empty for a number", lambda one: SI.symbol(one.dimension)),
    Field("expected", optional(NUMBER), "what the file expects; null where it expects nothing"),
)
CHECK = record(
    "a number against its limit",
    Field("check", TEXT, "slot, pressure, load, near dead, lever", "kind"),
    Field("of", TEXT, "pair, link, load or group; empty: the whole mechanism"),
    Field("detail", TEXT, "end of the slot, group of the link, stroke in which the load drives"),
    Field("at", NUMBER, "place of the driver, rad or m; null where there is none"),
    Field(
        "value",
        NUMBER,
        "m beyond the end of the slot, rad of pressure angle, J with which the load drives, margin "
        "of the group, difference of the lever",
    ),
    Field("limit", NUMBER, "the most, of margins the least"),
    Field("holds", FLAG, "within its limit"),
)
CENTRE = record(
    "of two links",
    Field("links", NAMES, "the two"),
    Field("x", optional(NUMBER), "m; null at infinity", lambda c: None if c.place is None else c.place.real),
    Field("y", optional(NUMBER), "m", lambda c: None if c.place is None else c.place.imag),
    Field(
        "direction",
        optional(NUMBER),
        "in which it is at infinity, rad; null elsewhere",
        lambda c: None if c.direction is None else cmath.phase(c.direction),
    ),
    Field("pair", TEXT, "that shows it; empty where there is none"),
)
EXTREME = record(
    "a quantity",
    Field("kind", TEXT, "x, y of a point; angle of a link; s of a slide; R, M in a pair; R pin; M_b, F_b of a driver"),
    Field("name", TEXT, "of what"),
    Field("low", NUMBER, "least value, SI"),
    Field("low_at", NUMBER, "driver's place there, rad or m"),
    Field("high", NUMBER, "largest value, SI"),
    Field("high_at", NUMBER, "driver's place there"),
)
LAST = (
    Field(
        "intermittent",
        list_of(WHEEL),
        "wheels that a link takes along on some strokes, over a cycle",
        "wheels",
        "wheels",
    ),
    Field(
        "centres",
        map_of(list_of(CENTRE)),
        "asked for: instantaneous centres, by the numbers of positions",
        lambda r: {str(r.numbers[k]): here for k, here in r.centres.items()},
        "centres",
    ),
    Field("extremes", list_of(EXTREME), "with --extremes: over the whole cycle", there="extremes"),
    Field(
        "assemblies",
        list_of(ASSEMBLIES),
        "with --assemblies: real assemblies of the groups, by places of the driver",
        there="assemblies",
    ),
    Field("properties", list_of(PROPERTY), "what the file shows", properties_shown, lambda r: r.problem.shows),
    Field("checks", list_of(CHECK), "what is worth a second look", run_checks, "lever"),
    Field("warnings", NAMES, "sentences", lambda r: [*doubts(r.problem), *collect_warnings(r)]),
)
LARGE = ("positions", "kinematics", "forces", "lever", "energy")


def to_json(results: Results | ChainResults) -> dict[str, Any]:
    """The whole content of result.json as plain data."""
    with words_of_files():
        return {key: plain(part) for key, part in sections(results)}


def sections(results: Results | ChainResults, digits: dict[str, Any] | None = None) -> Iterator[tuple[str, Any]]:
    """The parts of result.json one after the other, with arrays as they are. digits: the section of that name."""
    yield "tmm", FORMAT
    yield "problem", PROBLEM.content(results.problem)
    if isinstance(results, ChainResults):
        yield "chain", SPATIAL.content(results.chain)
        if results.problem.shows:
            yield "properties", list_of(PROPERTY).content(properties_shown(results))
        yield "warnings", []
        return
    yield from contents(FIRST, results)
    yield from numbers(results)
    if digits is not None:
        yield "digits", digits
    yield from contents(LAST, results)


def numbers(results: Results, parts: Collection[str] = LARGE) -> Iterator[tuple[str, Any]]:
    """What was computed, part by part, as arrays; of the large parts those named alone."""
    return contents([part for part in MOTION_PARTS if part.key in parts or part.key not in LARGE], results)


def schema() -> dict[str, Any]:
    """A JSON Schema (draft 2020-12). SI and radians throughout; forces of pairs act on link `on`."""
    computed = {"type": "object", "properties": properties(MOTION_PARTS)}
    digits = record(
        "",
        Field("number", list_of(INTEGER), "positions that were judged: arrays below have one entry for each"),
        Field("scale", NUMBER, "of a drawing on A4, m a mm: that of `paper`"),
        Field(
            "bound",
            JsonType(computed),
            "how far each number may be from the truth by rounding; null: it is not known at all",
        ),
        Field(
            "lengths", JsonType(computed), "its change when every length changes by 0.1 %, worst case to first order"
        ),
        Field("paper", JsonType(computed), "its change when every coordinate is 0.5 mm off on paper, likewise"),
    )
    parts = (
        Field("problem", PROBLEM, "what was computed"),
        *FIRST,
        Field("chain", SPATIAL, "a chain given by pairs alone"),
        *MOTION_PARTS,
        Field(
            "digits",
            digits,
            "how far the numbers of this file, which are float64 in full, are to be trusted: in their places and units",
        ),
        *LAST,
        Field("part", TEXT, "what of a run is here, where not all is: -p 2 gives p2, --no-drawings no-drawings"),
        Field("files", NAMES, "written beside this file"),
    )
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "result.json of tmm",
        "description": "SI and radians. Arrays have one entry a position; null: not reached, or dead. "
        "Per unit of the driver's motion: rad for a crank, m for a driven slider.",
        "type": "object",
        "required": ["tmm", "problem", "warnings"],
        "properties": {"tmm": {"description": "version of this format", "const": FORMAT}, **properties(parts)},
    }
