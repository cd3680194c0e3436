"""result.json: all results in SI units and radians, and its JSON Schema.

Arrays have one entry per position: null where the position cannot be reached or is dead. A vector consists of two
arrays, x and y. To add a section, add a field to MOTION_SECTIONS (json_motion), SECTIONS_BEFORE_MOTION or
SECTIONS_AFTER_MOTION.
"""

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
    "the problem",
    JsonField("name", TEXT, "name of the file"),
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
    JsonField("name", TEXT, "key of the link in the file", "link.name"),
    JsonField("role", TEXT, "crank, rocker, coupler, ..."),
    JsonField("label", TEXT, "name given in the file", "link.label"),
    JsonField("points", NAMES, "points of the link", "link.points"),
    JsonField("motion", TEXT, "rotation, translation or plane motion"),
)
PAIR_LINKS = JsonField("links", NAMES, "first and second link", lambda pair: (pair.i, pair.j))
PAIR = json_record(
    "a pair",
    JsonField("name", TEXT, "point or guide; further pairs of a compound hinge have primes"),
    JsonField("kind", TEXT, "R revolute, P prismatic, G gears, K gear and rack, C cam and follower"),
    PAIR_LINKS,
    JsonField("point", TEXT, "hinge, or point that slides"),
    JsonField("freedoms", NUMBER, "degrees of freedom in the plane"),
    JsonField("class", NUMBER, "5 for a lower pair, 4 for a higher one", "pair_class"),
    JsonField("code", TEXT, "1в revolute, 1п prismatic; empty for a higher pair"),
)
PASSIVE = json_record(
    "redundant constraints of a pair",
    JsonField("pair", TEXT, "pair"),
    JsonField("constraints", NUMBER, "number of redundant constraints"),
    JsonField("links", NAMES, "links of the pair, the redundant one last"),
    JsonField("among", NAMES, "links whose reactions are indeterminate"),
)
GROUP = json_record(
    "an Assur group",
    JsonField("links", NAMES, "links"),
    JsonField("class", TEXT, "class, a Roman numeral", lambda group: group.roman),
    JsonField("order", NUMBER, "order: number of external pairs"),
    JsonField("type", TEXT, "RRR, RRP, RPR, PRP, RPP"),
    JsonField("name", TEXT, "name, e.g. II(2,3)", "title"),
    JsonField("type_number", NUMBER, "1 to 5 for a class II group of two links", there="type_number"),
    JsonField("letters", TEXT, "type in Russian letters: ВВВ, ВВП, ВПВ, ПВП or ВПП", there="type_number"),
    JsonField("inner", NAMES, "internal pairs", lambda group: [pair.name for pair in group.inner]),
    JsonField("outer", NAMES, "external pairs", lambda group: [pair.name for pair in group.outer]),
)
RIGID_LINKS = json_record(
    "links that are rigidly connected",
    JsonField("links", NAMES, "links; 0 is the frame"),
    JsonField("redundant", NUMBER, "redundant constraints q among them", "constraints"),
)
REDUNDANT_LINK = json_record(
    "a redundant link, or several that are rigidly connected",
    JsonField("links", NAMES, "links"),
    JsonField("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
)
REDUNDANT_PAIR = json_record(
    "a pair with redundant constraints",
    JsonField("pair", TEXT, "pair"),
    JsonField("redundant", NUMBER, "redundant constraints q that it adds", "constraints"),
    JsonField("left", NUMBER, "number of its other constraints"),
)
REDUCTION = json_record(
    "redundant links and pairs, and rigidly connected links",
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
        "mobility by rank of the constraint equations",
        lambda results: results.structure.mobility + results.structure.redundant,
    ),
    JsonField("passive", list_of(PASSIVE), "redundant constraints", "structure.passive"),
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
        "basic_schemes",
        map_of(TEXT),
        "basic mechanisms of the contours of four links, by contour",
        lambda r: basic_schemes(r.structure),
    ),
    JsonField("formula", TEXT, "structural formula", "structure.formula"),
    JsonField("class", TEXT, "class of the mechanism", lambda results: results.structure.roman),
    JsonField(
        "groups", list_of(GROUP), "groups in solving order, without redundant links and pairs", "structure.groups"
    ),
    JsonField(
        "reduction",
        REDUCTION,
        "links and pairs omitted from the groups and the structural formula",
        "structure.reduction",
        lambda results: bool(results.structure.reduction),
    ),
)

CONTOUR = json_record(
    "a contour",
    JsonField("links", NAMES, "links in order, beginning with the one nearest the frame"),
    JsonField("pairs", NAMES, "pairs between these links"),
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
    JsonField("was", TEXT, "present kind"),
    JsonField("kind", TEXT, "kind of its replacement"),
    JsonField("freedoms", NUMBER, "degrees of freedom of the replacement"),
)
PROPOSED = json_record(
    "the count with the replacements",
    *attribute_fields("proposed", CHAIN),
    JsonField("local", NUMBER, "local mobility Wm", "rank.local"),
    JsonField("redundant", NUMBER, "redundant constraints q", "redundant_then"),
)
SPACE = json_record(
    "the planar linkage as a spatial mechanism",
    *attribute_fields("chain", CHAIN),
    JsonField("wanted", NUMBER, "required mobility Wo"),
    JsonField("local", NUMBER, "local mobility Wm"),
    JsonField("redundant", NUMBER, "redundant constraints q = Wo + Wm - W"),
    JsonField(
        "contours",
        list_of(CONTOUR),
        "independent contours",
        lambda space: find_contours(space.chain.pairs, space.chain.links),
    ),
    JsonField(
        "replacements", optional(list_of(REPLACEMENT)), "replacements of pairs for which q = 0; null: none found"
    ),
    JsonField(
        "proposed",
        optional(PROPOSED),
        "the count with the replacements",
        lambda space: None if space.replacements is None else space,
    ),
)

CHAIN_PAIR = json_record(
    "a pair",
    JsonField("name", TEXT, "name"),
    PAIR_LINKS,
    JsonField(
        "kind", optional(TEXT), "kind; null if only its degrees of freedom are given", lambda pair: pair.kind or None
    ),
    JsonField("freedoms", NUMBER, "1 to 5"),
    JsonField("class", NUMBER, "number of its constraints", "pair_class"),
)
LOCAL_FREEDOM = json_record(
    "a local freedom",
    JsonField("links", NAMES, "links that move alone"),
    JsonField("freedoms", NUMBER, "number of local freedoms"),
    JsonField("pairs", NAMES, "pairs between which they move", lambda local: [pair.name for pair in local.ends]),
)
SPATIAL = json_record(
    "a chain given by pairs alone",
    *attribute_fields("chain", CHAIN),
    JsonField("form", TEXT, "open, closed, or mixed: with open branches"),
    JsonField("contours", list_of(CONTOUR), "independent contours"),
    JsonField("branches", NAMES, "links in no contour"),
    JsonField("pairs", list_of(CHAIN_PAIR), "pairs", "chain.pairs"),
    JsonField("local_freedoms", list_of(LOCAL_FREEDOM), "local freedoms found from the kinds of pairs", "local"),
    JsonField("local", NUMBER, "local mobility Wm, as given or as found", "local_mobility"),
    JsonField("wanted", NUMBER, "required mobility Wo, as given"),
    JsonField("redundant", NUMBER, "q = Wo + Wm - W"),
    JsonField("output", optional(TEXT), "output link"),
    JsonField("manoeuvrability", NUMBER, "mobility with the output link fixed"),
)

PLACE = json_record("coordinates, m", JsonField("x", NUMBER, "x", "real"), JsonField("y", NUMBER, "y", "imag"))
ASSEMBLY = json_record(
    "an assembly",
    JsonField("angles", map_of(NUMBER), "angles of the links of the group, rad"),
    JsonField("points", map_of(PLACE), "points of the links of the group, m"),
    JsonField("margin", NUMBER, "distance from a dead position: 0 there"),
    JsonField("sketch", FLAG, "true for the assembly of the sketch", "of_sketch"),
)
GROUP_ASSEMBLIES = json_record(
    "a group",
    JsonField("group", TEXT, "name, e.g. II(2,3)", "group.title"),
    JsonField("method", TEXT, "method: closed form, polynomial, angles, many starts"),
    JsonField("complete", FLAG, "true if it is proved that there are no others"),
    JsonField("most", NUMBER, "largest possible number of assemblies, if known"),
    JsonField("moves", FLAG, "true if the group is movable here"),
    JsonField("assemblies", list_of(ASSEMBLY), "real assemblies"),
)
ASSEMBLIES = json_record(
    "a position",
    JsonField("position", optional(INTEGER), "number of the position; null: position of the sketch", "number"),
    JsonField("driver", NUMBER, "driver coordinate, rad or m", "q"),
    JsonField(
        "undecided",
        optional(TEXT),
        "group whose assembly the sketch does not determine",
        lambda here: here.undecided and here.undecided.title,
    ),
    JsonField(
        "lost", NAMES, "groups that depend on links without a position", lambda here: [g.title for g in here.lost]
    ),
    JsonField(
        "groups", list_of(GROUP_ASSEMBLIES), "groups in solving order; the preceding links are placed as in the sketch"
    ),
)


FORMAT_VERSION = 1
SI = UnitSystem({"length": "m", "angle": "rad"})


def _synthesis_section(results: Results) -> dict[str, Any]:
    assert results.problem.synthesis is not None
    return synthesis_json(results.problem.synthesis, measure_problem(results), long=False)


SECTIONS_BEFORE_MOTION = (
    JsonField("structure", STRUCTURE, "links, pairs and Assur groups", lambda r: r),
    JsonField(
        "space", SPACE, "the planar linkage as a spatial mechanism", lambda r: count_in_space(r.linkage, r.structure)
    ),
    JsonField(
        "synthesis",
        JsonType({"type": "object"}),
        "input data, solution and measured values of the synthesis",
        _synthesis_section,
        lambda r: r.problem.synthesis is not None and r.motion is not None,
    ),
)
PROPERTY = json_record(
    "a property requested in the block `shows`",
    JsonField("property", TEXT, "name given in the file", "name"),
    JsonField("value", NUMBER, "value, SI"),
    JsonField("unit", TEXT, "unit of the value; empty for a number", lambda one: SI.symbol(one.dimension)),
    JsonField("expected", optional(NUMBER), "expected value; null if the file gives none"),
)
CHECK = json_record(
    "a value compared with its limit",
    JsonField("check", TEXT, "slot, pressure, load, near dead, lever", "kind"),
    JsonField("of", TEXT, "pair, link, load or group; empty: the whole mechanism"),
    JsonField("detail", TEXT, "end of the slot, group of the link, or stroke in which the load drives"),
    JsonField("at", NUMBER, "driver coordinate, rad or m; null if there is none"),
    JsonField(
        "value",
        NUMBER,
        "m beyond the end of the slot, rad of pressure angle, J with which the load drives, margin "
        "of the group, difference of the lever",
    ),
    JsonField("limit", NUMBER, "largest (for margins: smallest) allowed value"),
    JsonField("holds", FLAG, "true if the value is within the limit"),
)
CENTRE = json_record(
    "the instantaneous centre of two links",
    JsonField("links", NAMES, "both links"),
    JsonField("x", optional(NUMBER), "x, m; null at infinity", lambda c: None if c.place is None else c.place.real),
    JsonField("y", optional(NUMBER), "y, m; null at infinity", lambda c: None if c.place is None else c.place.imag),
    JsonField(
        "direction",
        optional(NUMBER),
        "direction of a centre at infinity, rad; otherwise null",
        lambda c: None if c.direction is None else cmath.phase(c.direction),
    ),
    JsonField("pair", TEXT, "pair that locates it; empty if there is none"),
)
EXTREME = json_record(
    "a quantity",
    JsonField(
        "kind", TEXT, "x, y of a point; angle of a link; s of a slide; R, M in a pair; R pin; M_b, F_b of a driver"
    ),
    JsonField("name", TEXT, "name of the point, link, pair or driver"),
    JsonField("low", NUMBER, "least value, SI"),
    JsonField("low_at", NUMBER, "driver coordinate at the least value, rad or m"),
    JsonField("high", NUMBER, "largest value, SI"),
    JsonField("high_at", NUMBER, "driver coordinate at the largest value, rad or m"),
)
SECTIONS_AFTER_MOTION = (
    JsonField(
        "intermittent",
        list_of(INTERMITTENT_WHEEL),
        "intermittently driven wheels, over a cycle",
        "wheels",
        "wheels",
    ),
    JsonField(
        "centres",
        map_of(list_of(CENTRE)),
        "instantaneous centres, by position",
        lambda r: {str(r.numbers[k]): here for k, here in r.centres.items()},
        "centres",
    ),
    JsonField("extremes", list_of(EXTREME), "with --extremes: over the whole cycle", there="extremes"),
    JsonField("assemblies", list_of(ASSEMBLIES), "real assemblies of the groups, by position", there="assemblies"),
    JsonField(
        "properties",
        list_of(PROPERTY),
        "properties requested in the block `shows`",
        shown_properties,
        lambda r: r.problem.shows,
    ),
    JsonField("checks", list_of(CHECK), "checks", run_checks, "lever"),
    JsonField("warnings", NAMES, "warnings as sentences", lambda r: [*find_slips(r.problem), *collect_warnings(r)]),
)
LARGE_SECTIONS = ("positions", "kinematics", "forces", "lever", "energy")


def to_json(results: Results | ChainResults) -> dict[str, Any]:
    """Return the whole content of result.json as plain data (dicts, lists, numbers and texts)."""
    with words_of_files():
        return {key: json_value(section) for key, section in sections(results)}


def sections(results: Results | ChainResults, digits: dict[str, Any] | None = None) -> Iterator[tuple[str, Any]]:
    """Yield the key and the content of each section of result.json; NumPy arrays are not converted.

    digits: content of the section `digits`; None to omit it.
    """
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
    """Yield the key and the content of each section on motion and forces; NumPy arrays are not converted.

    parts: keys of the large sections to include. All other sections are always included.
    """
    return record_items(
        [field for field in MOTION_SECTIONS if field.key in parts or field.key not in LARGE_SECTIONS], results
    )


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of result.json."""
    computed = {"type": "object", "properties": field_schemas(MOTION_SECTIONS)}
    digits = json_record(
        "",
        JsonField("number", list_of(INTEGER), "numbers of the examined positions, one per array entry"),
        JsonField("scale", NUMBER, "scale of the drawing for `paper`, m per mm"),
        JsonField("bound", JsonType(computed), "bound of the rounding error; null: unknown"),
        JsonField(
            "lengths",
            JsonType(computed),
            "change of each number if every length is off by 0.1 %: worst case, to first order",
        ),
        JsonField(
            "paper",
            JsonType(computed),
            "change of each number if every coordinate is off by 0.5 mm on paper: worst case, to first order",
        ),
    )
    parts = (
        JsonField("problem", PROBLEM, "the problem"),
        *SECTIONS_BEFORE_MOTION,
        JsonField("chain", SPATIAL, "a chain given by pairs alone"),
        *MOTION_SECTIONS,
        JsonField(
            "digits",
            digits,
            "accuracy of the numbers of this file, under the same keys and in the same units",
        ),
        *SECTIONS_AFTER_MOTION,
        JsonField(
            "part",
            TEXT,
            "part of a run whose results are here, e.g. p2 with -p 2, no-drawings with --no-drawings",
        ),
        JsonField("files", NAMES, "names of the files written beside this file"),
    )
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "result.json of tmm",
        "description": "SI and radians. Arrays have one entry per position; null: not reached, or dead. "
        "Quantities per unit of the driver's motion are per rad for a crank, per m for a driving slider.",
        "type": "object",
        "required": ["tmm", "problem", "warnings"],
        "properties": {
            "tmm": {"description": "version of this format", "const": FORMAT_VERSION},
            **field_schemas(parts),
        },
    }
