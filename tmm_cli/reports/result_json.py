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
from tmm_cli.reports.file_summary import find_slips
from tmm_cli.reports.json_fields import (
    FLAG,
    INTEGER,
    NAMES,
    NUMBER,
    TEXT,
    JsonField,
    JsonType,
    attribute_fields,
    field_schemas,
    json_record,
    list_of,
    map_of,
    optional,
    record_items,
)
from tmm_cli.reports.json_motion import INTERMITTENT_WHEEL, MOTION_SECTIONS
from tmm_cli.reports.properties import shown_properties
from tmm_cli.reports.structure_tables import motion_of_link
from tmm_cli.reports.synthesis_tables import synthesis_json as synthesis_json
from tmm_cli.reports.table import json_value
from tmm_cli.reports.warnings import collect_warnings
from tmm_cli.synthesis import measure_problem

PROBLEM = json_record(
    "what was computed",
    JsonField("name", TEXT, "of the file"),
    JsonField("title", TEXT, "title"),
    JsonField("description", TEXT, "description"),
)


class LinkRole(NamedTuple):
    """A moving link with its role in the mechanism and its kind of motion."""

    link: Link
    role: str
    motion: str


LINK = json_record(
    "a link",
    JsonField("name", TEXT, "its key in the file", "link.name"),
    JsonField("role", TEXT, "crank, rocker, coupler, ..."),
    JsonField("label", TEXT, "the file's own name", "link.label"),
    JsonField("points", NAMES, "its points", "link.points"),
    JsonField("motion", TEXT, "rotation, translation or plane motion"),
)
PAIR_LINKS = JsonField("links", NAMES, "first and second link", lambda pair: (pair.i, pair.j))
PAIR = json_record(
    "a pair",
    JsonField("name", TEXT, "point or guide; a compound hinge's further pairs have primes"),
    JsonField("kind", TEXT, "R turning, P sliding, G wheels, K rack, C cam"),
    PAIR_LINKS,
    JsonField("point", TEXT, "hinge or running point"),
    JsonField("freedoms", NUMBER, "relative freedoms in the plane"),
    JsonField("class", NUMBER, "5 of a lower pair, 4 of a higher one", "pair_class"),
    JsonField("code", TEXT, "1в revolute, 1п prismatic; empty for a higher pair"),
)
PASSIVE = json_record(
    "conditions that only repeat others",
    JsonField("pair", TEXT, "pair"),
    JsonField("constraints", NUMBER, "how many"),
    JsonField("links", NAMES, "its links, the passive one last"),
    JsonField("among", NAMES, "links that hold each other"),
)
GROUP = json_record(
    "an Assur group",
    JsonField("links", NAMES, "links"),
    JsonField("class", TEXT, "roman", lambda group: group.roman),
    JsonField("order", NUMBER, "number of outer pairs"),
    JsonField("type", TEXT, "RRR, RRP, RPR, PRP, RPP"),
    JsonField("name", TEXT, "II(2,3)", "title"),
    JsonField("type_number", NUMBER, "1 to 5 for a class II group of two links", there="type_number"),
    JsonField("letters", TEXT, "its type as ВВВ, ВВП, ВПВ, ПВП, ВПП", there="type_number"),
    JsonField("inner", NAMES, "internal pairs", lambda group: [pair.name for pair in group.inner]),
    JsonField("outer", NAMES, "external pairs", lambda group: [pair.name for pair in group.outer]),
)
RIGID_LINKS = json_record(
    "links that are rigid to one another",
    JsonField("links", NAMES, "links; 0 is the frame"),
    JsonField("redundant", NUMBER, "redundant constraints q among them", "constraints"),
)
REDUNDANT_LINK = json_record(
    "a redundant link, or several that are rigid to one another",
    JsonField("links", NAMES, "links"),
    JsonField("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
)
REDUNDANT_PAIR = json_record(
    "a pair with redundant constraints",
    JsonField("pair", TEXT, "pair"),
    JsonField("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
    JsonField("left", NUMBER, "its constraints that are left"),
)
REDUCTION = json_record(
    "what is redundant or rigid",
    JsonField("rigid", list_of(RIGID_LINKS), "sets of links that count as one"),
    JsonField("links", list_of(REDUNDANT_LINK), "redundant links"),
    JsonField("pairs", list_of(REDUNDANT_PAIR), "redundant pairs"),
)


STRUCTURE = json_record(
    "links, pairs and Assur groups",
    JsonField("mobility", NUMBER, "Chebyshev, W = 3n - 2 p1 - p2", "structure.mobility"),
    JsonField(
        "links",
        list_of(LINK),
        "moving links",
        lambda r: [LinkRole(r.linkage.links[n], r.roles[n], motion_of_link(r, n)) for n in r.structure.links],
    ),
    JsonField("pairs", list_of(PAIR), "pairs", "structure.pairs"),
    JsonField(
        "true_mobility",
        NUMBER,
        "by rank, where dimensions leave more than the count",
        lambda results: results.structure.mobility + results.structure.redundant,
    ),
    JsonField("passive", list_of(PASSIVE), "passive constraints", "structure.passive"),
    JsonField("n", NUMBER, "moving links", lambda results: len(results.structure.links)),
    JsonField("p1", NUMBER, "lower pairs", lambda results: len(results.structure.pairs) - results.structure.higher),
    JsonField("p2", NUMBER, "higher pairs", "structure.higher"),
    JsonField("contours", NUMBER, "independent contours K = p - n", "structure.contours"),
    JsonField(
        "classification",
        NAMES,
        "closed or open; elementary, simple, complex; of one type or several",
        lambda results: classify_linkage(results.structure),
    ),
    JsonField(
        "dependent_contours",
        NUMBER,
        "contours closed by redundant links or pairs",
        lambda r: sum(is_dependent(c, r.structure) for c in find_contours(r.structure.pairs, r.structure.links)),
        lambda r: bool(r.structure.reduction),
    ),
    JsonField(
        "six_bar",
        NAMES,
        "Watt I, II or Stephenson I, II, III; several where a compound hinge can be drawn in several ways",
        lambda r: six_bar_schemes(r.structure),
        lambda r: bool(six_bar_schemes(r.structure)),
    ),
    JsonField(
        "basic_schemes", map_of(TEXT), "of the contours of four links, by contour", lambda r: basic_schemes(r.structure)
    ),
    JsonField("formula", TEXT, "formula of structure", "structure.formula"),
    JsonField("class", TEXT, "class of the mechanism", lambda results: results.structure.roman),
    JsonField("groups", list_of(GROUP), "in solving order, of what is not redundant", "structure.groups"),
    JsonField(
        "reduction",
        REDUCTION,
        "what the groups and the formula leave out",
        "structure.reduction",
        lambda results: bool(results.structure.reduction),
    ),
)

CONTOUR = json_record(
    "a contour",
    JsonField("links", NAMES, "from the one nearest the frame round"),
    JsonField("pairs", NAMES, "between them"),
)


CHAIN = (
    JsonField("mobility", NUMBER, "Somov-Malyshev, W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5"),
    JsonField("n", NUMBER, "moving links", lambda chain: len(chain.links)),
    JsonField("p1", NUMBER, "pairs with 1 freedom", lambda chain: chain.p(1)),
    *(JsonField(f"p{k}", NUMBER, f"pairs with {k} freedoms", methodcaller("p", k)) for k in range(2, 6)),
    JsonField("K", NUMBER, "independent contours", lambda chain: len(chain.pairs) - len(chain.links)),
)
REPLACEMENT = json_record(
    "a pair",
    JsonField("pair", TEXT, "name", "pair.name"),
    *attribute_fields("pair", (PAIR_LINKS,)),
    JsonField("was", TEXT, "kind"),
    JsonField("kind", TEXT, "kind it is to have"),
    JsonField("freedoms", NUMBER, "of that kind"),
)
PROPOSED = json_record(
    "the same count with them",
    *attribute_fields("proposed", CHAIN),
    JsonField("local", NUMBER, "Wm", "rank.local"),
    JsonField("redundant", NUMBER, "q", "redundant_then"),
)
SPACE = json_record(
    "the planar linkage counted in space",
    *attribute_fields("chain", CHAIN),
    JsonField("wanted", NUMBER, "mobility Wo"),
    JsonField("local", NUMBER, "local mobility Wm"),
    JsonField("redundant", NUMBER, "redundant constraints q = Wo + Wm - W"),
    JsonField(
        "contours",
        list_of(CONTOUR),
        "independent contours",
        lambda space: find_contours(space.chain.pairs, space.chain.links),
    ),
    JsonField(
        "replacements", optional(list_of(REPLACEMENT)), "pairs to give more freedoms, so that q = 0; null: none found"
    ),
    JsonField(
        "proposed",
        optional(PROPOSED),
        "the same count with them",
        lambda space: None if space.replacements is None else space,
    ),
)

CHAIN_PAIR = json_record(
    "a pair",
    JsonField("name", TEXT, "name"),
    PAIR_LINKS,
    JsonField("kind", optional(TEXT), "null when only freedoms are given", lambda pair: pair.kind or None),
    JsonField("freedoms", NUMBER, "1 to 5"),
    JsonField("class", NUMBER, "number of its constraints", "pair_class"),
)
LOCAL_FREEDOM = json_record(
    "one of them",
    JsonField("links", NAMES, "that move alone"),
    JsonField("freedoms", NUMBER, "how many"),
    JsonField("pairs", NAMES, "that hold them", lambda local: [pair.name for pair in local.ends]),
)
SPATIAL = json_record(
    "a chain given by pairs alone",
    *attribute_fields("chain", CHAIN),
    JsonField("form", TEXT, "open, closed, or mixed: with open branches"),
    JsonField("contours", list_of(CONTOUR), "independent contours"),
    JsonField("branches", NAMES, "links in no contour"),
    JsonField("pairs", list_of(CHAIN_PAIR), "pairs", "chain.pairs"),
    JsonField("local_freedoms", list_of(LOCAL_FREEDOM), "found from the kinds of pairs", "local"),
    JsonField("local", NUMBER, "local mobility Wm, as given or as found", "local_mobility"),
    JsonField("wanted", NUMBER, "mobility Wo, as given"),
    JsonField("redundant", NUMBER, "q = Wo + Wm - W"),
    JsonField("output", optional(TEXT), "link held"),
    JsonField("manoeuvrability", NUMBER, "mobility with the output held"),
)

PLACE = json_record("m", JsonField("x", NUMBER, "x", "real"), JsonField("y", NUMBER, "y", "imag"))
ASSEMBLY = json_record(
    "an assembly",
    JsonField("angles", map_of(NUMBER), "of the group's links, rad"),
    JsonField("points", map_of(PLACE), "of the group's links, m"),
    JsonField("margin", NUMBER, "distance from a dead position: 0 there"),
    JsonField("sketch", FLAG, "that of the sketch", "of_sketch"),
)
GROUP_ASSEMBLIES = json_record(
    "a group",
    JsonField("group", TEXT, "II(2,3)", "group.title"),
    JsonField("method", TEXT, "closed form, polynomial, angles, many starts"),
    JsonField("complete", FLAG, "whether it is proved that there are no others"),
    JsonField("most", NUMBER, "so many are possible, if known"),
    JsonField("moves", FLAG, "moves by itself here: assemblies without end"),
    JsonField("assemblies", list_of(ASSEMBLY), "real ones"),
)
ASSEMBLIES = json_record(
    "a place",
    JsonField("position", optional(INTEGER), "its number; null: the place of the sketch", "number"),
    JsonField("driver", NUMBER, "rad or m", "q"),
    JsonField(
        "undecided",
        optional(TEXT),
        "group that the sketch does not decide",
        lambda here: here.undecided and here.undecided.title,
    ),
    JsonField("lost", NAMES, "groups whose neighbours cannot be placed", lambda here: [g.title for g in here.lost]),
    JsonField("groups", list_of(GROUP_ASSEMBLIES), "in solving order, links before placed as in the sketch"),
)


FORMAT_VERSION = 1
SI = UnitSystem({"length": "m", "angle": "rad"})


def _synthesis_section(results: Results) -> dict[str, Any]:
    assert results.problem.synthesis is not None
    return synthesis_json(results.problem.synthesis, measure_problem(results), long=False)


SECTIONS_BEFORE_MOTION = (
    JsonField("structure", STRUCTURE, "links, pairs and Assur groups", lambda r: r),
    JsonField("space", SPACE, "the planar linkage counted in space", lambda r: count_in_space(r.linkage, r.structure)),
    JsonField(
        "synthesis",
        JsonType({"type": "object"}),
        "what the file's synthesis asked, found and measured",
        _synthesis_section,
        lambda r: r.problem.synthesis is not None and r.motion is not None,
    ),
)
PROPERTY = json_record(
    "a property that the file shows",
    JsonField("property", TEXT, "in its words", "name"),
    JsonField("value", NUMBER, "SI"),
    JsonField("unit", TEXT, "of the value; empty for a number", lambda one: SI.symbol(one.dimension)),
    JsonField("expected", optional(NUMBER), "what the file expects; null where it expects nothing"),
)
CHECK = json_record(
    "a number against its limit",
    JsonField("check", TEXT, "slot, pressure, load, near dead, lever", "kind"),
    JsonField("of", TEXT, "pair, link, load or group; empty: the whole mechanism"),
    JsonField("detail", TEXT, "end of the slot, group of the link, stroke in which the load drives"),
    JsonField("at", NUMBER, "place of the driver, rad or m; null where there is none"),
    JsonField(
        "value",
        NUMBER,
        "m beyond the end of the slot, rad of pressure angle, J with which the load drives, margin "
        "of the group, difference of the lever",
    ),
    JsonField("limit", NUMBER, "the most, of margins the least"),
    JsonField("holds", FLAG, "within its limit"),
)
CENTRE = json_record(
    "of two links",
    JsonField("links", NAMES, "the two"),
    JsonField("x", optional(NUMBER), "m; null at infinity", lambda c: None if c.place is None else c.place.real),
    JsonField("y", optional(NUMBER), "m", lambda c: None if c.place is None else c.place.imag),
    JsonField(
        "direction",
        optional(NUMBER),
        "in which it is at infinity, rad; null elsewhere",
        lambda c: None if c.direction is None else cmath.phase(c.direction),
    ),
    JsonField("pair", TEXT, "that shows it; empty where there is none"),
)
EXTREME = json_record(
    "a quantity",
    JsonField(
        "kind", TEXT, "x, y of a point; angle of a link; s of a slide; R, M in a pair; R pin; M_b, F_b of a driver"
    ),
    JsonField("name", TEXT, "of what"),
    JsonField("low", NUMBER, "least value, SI"),
    JsonField("low_at", NUMBER, "driver's place there, rad or m"),
    JsonField("high", NUMBER, "largest value, SI"),
    JsonField("high_at", NUMBER, "driver's place there"),
)
SECTIONS_AFTER_MOTION = (
    JsonField(
        "intermittent",
        list_of(INTERMITTENT_WHEEL),
        "wheels that a link takes along on some strokes, over a cycle",
        "wheels",
        "wheels",
    ),
    JsonField(
        "centres",
        map_of(list_of(CENTRE)),
        "asked for: instantaneous centres, by the numbers of positions",
        lambda r: {str(r.numbers[k]): here for k, here in r.centres.items()},
        "centres",
    ),
    JsonField("extremes", list_of(EXTREME), "with --extremes: over the whole cycle", there="extremes"),
    JsonField(
        "assemblies",
        list_of(ASSEMBLIES),
        "with --assemblies: real assemblies of the groups, by places of the driver",
        there="assemblies",
    ),
    JsonField("properties", list_of(PROPERTY), "what the file shows", shown_properties, lambda r: r.problem.shows),
    JsonField("checks", list_of(CHECK), "what is worth a second look", run_checks, "lever"),
    JsonField("warnings", NAMES, "sentences", lambda r: [*find_slips(r.problem), *collect_warnings(r)]),
)
LARGE_SECTIONS = ("positions", "kinematics", "forces", "lever", "energy")


def to_json(results: Results | ChainResults) -> dict[str, Any]:
    """Return the whole content of result.json as plain data."""
    with words_of_files():
        return {key: json_value(part) for key, part in sections(results)}


def sections(results: Results | ChainResults, digits: dict[str, Any] | None = None) -> Iterator[tuple[str, Any]]:
    """Yield the sections of result.json with arrays as they are. digits: content of the section of that name."""
    yield "tmm", FORMAT_VERSION
    yield "problem", PROBLEM.content(results.problem)
    if isinstance(results, ChainResults):
        yield "chain", SPATIAL.content(results.chain)
        if results.problem.shows:
            yield "properties", list_of(PROPERTY).content(shown_properties(results))
        yield "warnings", []
        return
    yield from record_items(SECTIONS_BEFORE_MOTION, results)
    yield from computed_sections(results)
    if digits is not None:
        yield "digits", digits
    yield from record_items(SECTIONS_AFTER_MOTION, results)


def computed_sections(results: Results, parts: Collection[str] = LARGE_SECTIONS) -> Iterator[tuple[str, Any]]:
    """Yield the computed sections with arrays as they are; of the large ones, only those in `parts`."""
    return record_items(
        [part for part in MOTION_SECTIONS if part.key in parts or part.key not in LARGE_SECTIONS], results
    )


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of result.json: SI, radians; the reaction of a pair acts on link `on`."""
    computed = {"type": "object", "properties": field_schemas(MOTION_SECTIONS)}
    digits = json_record(
        "",
        JsonField("number", list_of(INTEGER), "positions that were judged: arrays below have one entry for each"),
        JsonField("scale", NUMBER, "of a drawing on A4, m a mm: that of `paper`"),
        JsonField(
            "bound",
            JsonType(computed),
            "how far each number may be from the truth by rounding; null: it is not known at all",
        ),
        JsonField(
            "lengths", JsonType(computed), "its change when every length changes by 0.1 %, worst case to first order"
        ),
        JsonField("paper", JsonType(computed), "its change when every coordinate is 0.5 mm off on paper, likewise"),
    )
    parts = (
        JsonField("problem", PROBLEM, "what was computed"),
        *SECTIONS_BEFORE_MOTION,
        JsonField("chain", SPATIAL, "a chain given by pairs alone"),
        *MOTION_SECTIONS,
        JsonField(
            "digits",
            digits,
            "how far the numbers of this file, which are float64 in full, are to be trusted: in their places and units",
        ),
        *SECTIONS_AFTER_MOTION,
        JsonField("part", TEXT, "what of a run is here, where not all is: -p 2 gives p2, --no-drawings no-drawings"),
        JsonField("files", NAMES, "written beside this file"),
    )
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "result.json of tmm",
        "description": "SI and radians. Arrays have one entry a position; null: not reached, or dead. "
        "Per unit of the driver's motion: rad for a crank, m for a driven slider.",
        "type": "object",
        "required": ["tmm", "problem", "warnings"],
        "properties": {
            "tmm": {"description": "version of this format", "const": FORMAT_VERSION},
            **field_schemas(parts),
        },
    }
