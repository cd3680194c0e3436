"""The parts of result.json that need no motion: structure, mobility in space, chains, assemblies of groups."""

from __future__ import annotations

from operator import methodcaller
from typing import NamedTuple

from tmm_cli.mechanics.linkage import Link
from tmm_cli.mechanics.structure import basic_schemes, classification, contours, is_dependent, six_bar_schemes
from tmm_cli.reports.shapes import FLAG, INTEGER, NAMES, NUMBER, TEXT, Field, inside, list_of, map_of, optional, record
from tmm_cli.reports.structure_tables import motion_of_link

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
    Field("inner", NAMES, "inner pairs", lambda group: [pair.name for pair in group.inner]),
    Field("outer", NAMES, "outer pairs", lambda group: [pair.name for pair in group.outer]),
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
        lambda results: classification(results.structure),
    ),
    Field(
        "dependent_contours",
        NUMBER,
        "contours closed by redundant links or pairs",
        lambda r: sum(is_dependent(c, r.structure) for c in contours(r.structure.pairs, r.structure.links)),
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
        lambda space: contours(space.chain.pairs, space.chain.links),
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
