"""Tables of the structure: mobility, links, pairs and Assur groups."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

import numpy as np

from tmm_cli.language import N_, _, printed
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import (
    Structure,
    basic_schemes,
    classify_linkage,
    find_contours,
    is_dependent,
    is_parallelogram_coupler,
    link_motion,
    six_bar_schemes,
)
from tmm_cli.reports.table import Table, text_table

DIRECTION_POSITIONS, SAME_DIRECTION = 9, 1e-6  # of the driver at which a direction is looked at; rad
ROLES = {
    "crank": N_("crank"),
    "rocker": N_("rocker"),
    "coupler": N_("coupler"),
    "slider": N_("slider"),
    "stone": N_("sliding block"),
    "slotted link": N_("slotted link"),
    "rod": N_("rod"),
    "rocking slider": N_("rocking slider"),
    "wheel": N_("gear wheel"),
    "planet": N_("planet"),
    "carrier": N_("carrier"),
    "rack": N_("rack"),
    "cam": N_("cam"),
    "follower": N_("follower"),
    "cylinder": N_("cylinder"),
    "piston": N_("piston"),
}
COMMON_LABELS = {
    *ROLES.values(),
    N_("connecting rod"),
    N_("crankshaft"),
    N_("lever"),
    N_("stone"),
    N_("toothed wheel"),
    N_("piston rod"),
    N_("ram"),
    N_("wheel"),
}  # names that files give to links and that every language has
PAIRS = {
    "R": N_("revolute (R)"),
    "P": N_("prismatic (P)"),
    "G": N_("gears (G)"),
    "K": N_("gear and rack (K)"),
    "C": N_("cam and follower (C)"),
}
HIGHER_PAIRS = {
    "G": N_("gears: {count}"),
    "K": N_("gears with racks: {count}"),
    "C": N_("cams with followers: {count}"),
}
CLASSIFICATIONS = {
    "open": N_("open"),
    "closed": N_("closed"),
    "elementary": N_("elementary: the driver alone"),
    "simple": N_("simple: the driver and one group"),
    "complex": N_("complex: the driver and several groups"),
    "same type": N_("groups of the same type"),
    "several types": N_("groups of several types"),
    "combined": N_("combined: some groups of the same type, others not"),
}
SIX_BARS = {
    "Watt I": N_("Watt I"),
    "Watt II": N_("Watt II"),
    "Stephenson I": N_("Stephenson I"),
    "Stephenson II": N_("Stephenson II"),
    "Stephenson III": N_("Stephenson III"),
}
SCHEMES = {
    "hinged four-bar": N_("hinged four-bar"),
    "crank-slider": N_("crank-slider mechanism"),
    "slotted-lever": N_("slotted-link mechanism"),
    "sine": N_("sine mechanism (Scotch yoke)"),
    "tangent": N_("tangent mechanism"),
    "double slotted-link": N_("double slotted-link mechanism (Oldham coupling)"),
    "double-slider": N_("double-slider mechanism (elliptic trammel)"),
}


def structure_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of mobility, links, pairs and Assur groups."""
    structure, linkage = results.structure, results.linkage
    yield text_table("structure", _("Structure"), (_("item"), _("value")), _structure_rows(structure))
    links, roles = [linkage.links[name] for name in structure.links], results.roles
    note = _("Crank and rocker are distinguished only after the motion is computed.")
    yield text_table(
        "links",
        _("Links"),
        (_("link"), _("role"), _("name of the link"), _("points"), _("motion")),
        [
            (
                x.name,
                _(ROLES[roles[x.name]]),
                translate_label(x.label),
                ", ".join(x.points),
                describe_link_motion(results, x.name),
            )
            for x in links
        ],
        (note,) if results.motion is None and results.mechanism.turned else (),
    )
    yield text_table(
        "pairs",
        _("Kinematic pairs"),
        (_("pair"), _("links"), _("kind"), _("location"), _("degrees of freedom"), _("class"), _("code")),
        [
            (
                p.name,
                f"{printed(p.i)} - {printed(p.j)}",
                _(PAIRS[p.kind]),
                _("on the frame") if FRAME in (p.i, p.j) else _("between moving links"),
                str(p.freedoms),
                str(p.pair_class),
                p.code,
            )
            for p in structure.pairs
        ],
    )
    yield text_table(
        "groups",
        _("Assur groups, in solving order"),
        (
            _("group"),
            _("class"),
            _("order of the group"),
            _("type"),
            _("internal pairs"),
            _("external pairs"),
            _("mobility"),
            _("number of the type"),
            _("letter code"),
        ),
        [
            (
                ", ".join(map("+".join, g.bodies)),
                g.roman,
                str(g.order),
                g.type,
                ", ".join(p.name for p in g.inner),
                ", ".join(f"{p.name} ({printed(p.i)}-{printed(p.j)})" for p in g.outer),
                mobility_equation(g.count),
                str(g.type_number or ""),
                g.letters,
            )
            for g in structure.groups
        ],
    )


def mobility_with_rollers(structure: Structure) -> str:
    """Return the mobility formula in which each roller counts as a link hinged to its follower.

    The text also states how many of its degrees of freedom are local (idle): the rotations of the rollers.
    """
    rollers = [pair.mesh.roller for pair in structure.pairs if pair.mesh is not None and pair.mesh.roller]
    n, higher = len(structure.links) + len(rollers), structure.higher
    mobility = mobility_equation((n, len(structure.pairs) - higher + len(rollers), higher))
    text = _(
        "{mobility}, of which Wm = {local} is local: the rotation of rollers ({rollers}) does not move other links"
    )
    return text.format(mobility=mobility, local=len(rollers), rollers=", ".join(rollers))


def reduction_sentences(structure: Structure) -> Iterable[str]:
    """Yield sentences on links and pairs that the structural formula omits as redundant, or counts as one rigid link.

    Each sentence gives the number q of their redundant constraints.
    """
    for rigid in structure.reduction.rigid:
        links = ", ".join(link for link in rigid.links if link != FRAME)
        if FRAME in rigid.links:
            text = _("rigidly attached to the frame and counted as part of it: {links}")
            if rigid.constraints:
                text = _(
                    "rigidly attached to the frame and counted as part of it: {links}; redundant constraints q = {q}"
                )
        else:
            text = _("links {links} are rigidly connected and count as one")
            if rigid.constraints:
                text = _("links {links} are rigidly connected and count as one; redundant constraints q = {q}")
        yield text.format(links=links, q=rigid.constraints)
    for link in structure.reduction.links:
        text = _("link {links} is redundant; redundant constraints q = {q}")
        if len(link.links) > 1:
            text = _("links {links} are redundant; redundant constraints q = {q}")
        yield text.format(links=", ".join(link.links), q=link.constraints)
    for pair in structure.reduction.pairs:
        text = _("pair {pair} is redundant; redundant constraints q = {q}")
        if pair.left:
            text = _("pair {pair} counts as a higher pair, because one of its two constraints is redundant: q = {q}")
        yield text.format(pair=pair.pair, q=pair.constraints)


def indeterminate_reactions(structure: Structure) -> Iterable[str]:
    """Yield a note on reactions that are statically indeterminate because of redundant constraints."""
    among = dict.fromkeys(link for passive in structure.passive for link in passive.among)
    if among:
        yield _(
            "Redundant constraints make the reactions between links {links} statically indeterminate: the "
            "smallest possible ones are given. The balancing load is not affected."
        ).format(links=", ".join(among))


def mobility_equation(count: tuple[int, int, int]) -> str:
    """Return Chebyshev's formula with numbers: `3*3 - 2*4 = 1`. count: moving links, lower pairs, higher pairs."""
    n, lower, higher = count
    held = f" - {higher}" if higher else ""
    return f"3*{n} - 2*{lower}{held} = {3 * n - 2 * lower - higher}"


def mobility_by_classes(count: tuple[int, int, int]) -> str:
    """Return the formula 3n - 2 p5 - p4 with numbers: `3*3 - 2*4 - 0 = 1`. count: moving links, lower pairs, higher
    pairs.
    """
    n, lower, higher = count
    return f"3*{n} - 2*{lower} - {higher} = {3 * n - 2 * lower - higher}"


def generalised_mobility(count: tuple[int, int, int]) -> str:
    """Return the generalised mobility formula with numbers: `3*3 - 2*4 - 1*0 = 1`.

    A free link has H = 3 degrees of freedom. count: moving links, lower pairs, higher pairs.
    """
    n, lower, higher = count
    return f"3*{n} - 2*{lower} - 1*{higher} = {3 * n - 2 * lower - higher}"


def mobility_with_replacements(count: tuple[int, int, int]) -> str:
    """Return the mobility formula in which each higher pair is replaced by a link with two revolute pairs: `3*5 - 2*7 =
    1`.

    count: moving links, lower pairs, higher pairs.
    """
    n, lower, higher = count
    return mobility_equation((n + higher, lower + 2 * higher, 0))


def motion_of_link(results: Results, name: str) -> str:
    """Return the kind of motion of a link relative to the frame: rotation, translation or plane motion.

    A parallelogram and an antiparallelogram can have the same lengths, so the motion of the coupler is computed to tell
    them apart.
    """
    motion = link_motion(results.linkage, name)
    if motion == "plane motion" and is_parallelogram_coupler(results.linkage, name) and _keeps_direction(results, name):
        return "translation"
    return motion


def describe_link_motion(results: Results, name: str) -> str:
    """Describe the motion of a link relative to the frame, with its pivot or its guide."""
    linkage = results.linkage
    motion = motion_of_link(results, name)
    if motion == "rotation":
        return _("rotates about {point}").format(point=linkage.shared(FRAME, name))
    guides = [slide.name for slide in linkage.slides if {slide.carrier, slide.runner} == {FRAME, name}]
    if guides:
        return _("slides along guide {guide}").format(guide=guides[0])
    return _("translation") if motion == "translation" else _("plane motion")


def _keeps_direction(results: Results, name: str) -> bool:
    """Return True if a link does not rotate while the driver moves over its range, like the coupler of a
    parallelogram.
    """
    reach = results.driver_range
    if reach is None:
        return False
    motion = motion_at_positions(results, np.linspace(reach.start, reach.end, DIRECTION_POSITIONS), 0)
    turned = np.angle(motion.poses[name].z / motion.poses[name].z[motion.placed][:1])[motion.placed]
    return bool(turned.size) and bool(np.all(np.abs(turned) < SAME_DIRECTION))


def describe_schemes(structure: Structure) -> str:
    """Return the names of the basic mechanisms that the loops of four links form, and the name of the six-bar scheme.

    The text is empty if none of them has a name.
    """
    names = [f"{_(SCHEMES[scheme])} {title}" for title, scheme in basic_schemes(structure).items()]
    six_bar = six_bar_schemes(structure)
    if six_bar:
        names.append(_("six-bar: {names}").format(names=_(" or ").join(_(SIX_BARS[scheme]) for scheme in six_bar)))
    return ", ".join(names)


def describe_classification(structure: Structure) -> str:
    """Return the type of the chain and of the structure as text: `closed, complex: the driver and several groups`."""
    return ", ".join(_(CLASSIFICATIONS[word]) for word in classify_linkage(structure))


def describe_contours(structure: Structure) -> str:
    """Return the number of loops K = p - n as text, with the number of dependent loops among them, if any."""
    dependent = sum(is_dependent(contour, structure) for contour in find_contours(structure.pairs, structure.links))
    if not dependent:
        return str(structure.contours)
    return _("{count}, including dependent ones: {dependent}").format(count=structure.contours, dependent=dependent)


def describe_primary_mechanisms(structure: Structure) -> str:
    """Return the names of the primary mechanisms, one for each driver, and their total mobility."""
    names = ", ".join(map(structure.driver_title, structure.drivers))
    return _("{names}; total mobility W = {w}").format(names=names, w=len(structure.drivers))


def translate_label(label: str) -> str:
    """Return the label of a link; a common label such as `crank` is translated into the current language."""
    return _(label) if label in COMMON_LABELS else label


def _structure_rows(structure: Structure) -> Iterable[tuple[str, str]]:
    n, higher, w = len(structure.links), structure.higher, structure.mobility
    lower = len(structure.pairs) - higher
    turning = sum(p.kind == "R" for p in structure.pairs)
    yield _("number of moving links n"), str(n)
    yield (
        _("number of lower pairs p1"),
        _("{all} (revolute: {r}, prismatic: {p})").format(all=lower, r=turning, p=lower - turning),
    )
    if higher:
        kinds: Counter[str] = Counter(pair.kind for pair in structure.pairs)
        counts = ", ".join(_(text).format(count=kinds[kind]) for kind, text in HIGHER_PAIRS.items() if kinds[kind])
        yield _("number of higher pairs p2"), f"{higher} ({counts})"
        yield _("mobility W = 3n - 2 p1 - p2"), f"3*{n} - 2*{lower} - {higher} = {w}"
    else:
        yield _("mobility W = 3n - 2 p1"), f"3*{n} - 2*{lower} = {w}"
    count = (n, lower, higher)
    yield _("mobility by pair classes, W = 3n - 2 p5 - p4"), mobility_by_classes(count)
    yield _("generalised formula W = Hn - sum((H - i) p_i), H = 3"), generalised_mobility(count)
    if higher:
        text = _("{mobility} (each higher pair is replaced by a link with two revolute pairs)")
        yield (
            _("mobility W with higher pairs replaced by links"),
            text.format(mobility=mobility_with_replacements(count)),
        )
    if any(pair.mesh is not None and pair.mesh.roller for pair in structure.pairs):
        yield _("mobility W with rollers counted as links"), mobility_with_rollers(structure)
    if structure.passive:
        yield _("true mobility W, by the rank of the constraint equations"), str(w + structure.redundant)
    yield _("number of independent loops K = p - n"), describe_contours(structure)
    yield _("structural formula"), structure.formula
    if len(structure.drivers) > 1:
        yield _("primary mechanisms"), describe_primary_mechanisms(structure)
    for sentence in reduction_sentences(structure):
        yield "", sentence
    if structure.reduction:
        yield _("mobility W by the structural formula"), mobility_equation(structure.count)
    yield _("type of chain and of structure"), describe_classification(structure)
    yield _("class of the mechanism"), structure.roman
    schemes = describe_schemes(structure)
    if schemes:
        yield _("basic mechanisms"), schemes
