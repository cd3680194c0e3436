"""result.json: everything that was found, in SI and radians, and its schema.

Arrays have one entry a position, null where a position cannot be reached or is dead. Vectors are two arrays, x and y.
A further part is a line in MOTION_PARTS (json_motion) or here.
"""

from __future__ import annotations

import cmath
from collections.abc import Collection, Iterator
from typing import Any

from tmm_cli.language import ENGLISH, spoken
from tmm_cli.mechanics.analysis import Results, run_checks
from tmm_cli.mechanics.structure import ChainResults, space
from tmm_cli.problem import UnitSystem
from tmm_cli.reports.json_motion import MOTION_PARTS, WHEEL
from tmm_cli.reports.json_structure import ASSEMBLIES, PROBLEM, SPACE, SPATIAL, STRUCTURE
from tmm_cli.reports.properties import properties_shown
from tmm_cli.reports.shapes import (
    FLAG,
    INTEGER,
    NAMES,
    NUMBER,
    TEXT,
    Field,
    JsonType,
    contents,
    list_of,
    map_of,
    optional,
    properties,
    record,
)
from tmm_cli.reports.synthesis_tables import synthesis_json as synthesis_json
from tmm_cli.reports.table import plain
from tmm_cli.reports.understood import doubts
from tmm_cli.reports.warnings import collect_warnings
from tmm_cli.synthesis import measured_on

FORMAT = 1
SI = UnitSystem({"length": "m", "angle": "rad"})


def _synthesis(results: Results) -> dict[str, Any]:
    assert results.problem.synthesis is not None
    return synthesis_json(results.problem.synthesis, measured_on(results), long=False)


FIRST = (
    Field("structure", STRUCTURE, "links, pairs and Assur groups", lambda r: r),
    Field("space", SPACE, "the planar linkage counted in space", lambda r: space(r.linkage, r.structure)),
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
    with spoken(ENGLISH):
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
