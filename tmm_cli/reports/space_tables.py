"""Tables of a planar linkage treated as spatial, of spatial chains given by pairs, and of enumerated schemes and
chains.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tmm_cli.language import N_, _, printed
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.quantities import NUMBER
from tmm_cli.mechanics.structure import (
    AXLE_FREEDOMS,
    CONTACT_PAIRS,
    ROMAN,
    ChainCount,
    ChainResults,
    Contour,
    LocalFreedom,
    Structure,
    count_in_space,
    find_contours,
    is_dependent,
)
from tmm_cli.reports.structure_tables import reduction_sentences
from tmm_cli.reports.table import Column, Table, text_table
from tmm_cli.synthesis import GROUP_TYPES, KinematicChain, Scheme


def space_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of independent loops, of redundant constraints in space, and of pairs that would remove them."""
    structure = results.structure
    yield contour_table(find_contours(structure.pairs, structure.links), structure)
    space = count_in_space(results.linkage, structure)
    facts = [
        (_("mobility W by the Somov-Malyshev formula"), space.chain.count),
        (
            _("redundant constraints q = Wo + Wm - W"),
            redundancy_equation(space.wanted, space.local, space.chain.mobility, space.redundant),
        ),
    ]
    if space.replacements:
        q = redundancy_equation(space.wanted, space.rank.local, space.proposed.mobility, space.redundant_then)
        facts += [
            (
                _("mobility W by the Somov-Malyshev formula, with the pairs replaced as listed below"),
                space.proposed.count,
            )
        ]
        facts += [(_("redundant constraints q = Wo + Wm - W, with the pairs replaced as listed below"), q)]
    note = _(
        "No replacement of revolute pairs by cylindrical or spherical ones and of prismatic pairs by "
        "cylindrical or planar ones was found for which q = 0."
    )
    yield text_table(
        "space",
        _("Redundant constraints of the linkage as a spatial mechanism"),
        (_("item"), _("value")),
        facts,
        () if space.replacements is not None else (note,),
    )
    if space.replacements:
        note = _(
            "Pairs on the frame are kept, because they determine the position of shafts and guides. With these "
            "pairs the out-of-plane constraints are independent, as the rank of their equations shows."
        )
        title, notes = _("Replacements without redundant constraints"), [note]
        if space.redundant_then:
            title = _("Replacements without redundant out-of-plane constraints")
            notes.append(
                _("Redundant constraints in the plane remain: {redundant}.").format(
                    redundant="; ".join(reduction_sentences(structure))
                )
            )
        yield text_table(
            "replacements",
            title,
            (_("pair"), _("links"), _("present kind"), _("replacement"), _("degrees of freedom")),
            [
                (r.pair.name, f"{printed(r.pair.i)} - {printed(r.pair.j)}", _(r.was), _(r.kind), str(r.freedoms))
                for r in space.replacements
            ],
            tuple(notes),
        )


def contour_table(contours: Sequence[Contour], structure: Structure | None = None) -> Table:
    """Return the table of the loops of a mechanism, with the pairs in each loop.

    structure: structure of a planar linkage, in which some loops may be dependent; None for a spatial chain.
    """
    headers, rows = [_("loop"), _("pairs")], [[contour.title, ", ".join(contour.pairs)] for contour in contours]
    if structure is None or not any(is_dependent(contour, structure) for contour in contours):
        return text_table("contours", _("Independent loops"), headers, rows)
    kinds = [_("dependent") if is_dependent(contour, structure) else _("independent") for contour in contours]
    rows = [[*row, kind] for row, kind in zip(rows, kinds, strict=True)]
    note = _("A dependent loop repeats another one: the links or pairs that close it are redundant.")
    return text_table("contours", _("Loops"), [*headers, _("kind")], rows, (note,))


def redundancy_equation(required: int, local: int, mobility: int, redundant: int) -> str:
    """Return the equation of redundant constraints, q = Wo + Wm - W, with numbers: `1 + 0 - (-2) = 3`."""
    w = f"({mobility})" if mobility < 0 else str(mobility)
    return f"{required} + {local} - {w} = {redundant}"


# A chain given by pairs alone: mobility, pairs, contours, local freedoms, manoeuvrability.


def chain_tables(results: ChainResults) -> Iterable[Table]:
    """Yield the tables of a spatial chain given by its pairs: mobility, pairs, loops and local degrees of freedom."""
    count = results.chain
    yield text_table("structure", _("Structure"), (_("item"), _("value")), _chain_rows(count), _chain_notes(count))
    yield text_table(
        "pairs",
        _("Kinematic pairs"),
        (_("pair"), _("links"), _("kind"), _("degrees of freedom"), _("class")),
        [(p.name, f"{p.i} - {p.j}", _(p.kind), str(p.freedoms), ROMAN[p.pair_class]) for p in count.chain.pairs],
    )
    if count.contours:
        yield contour_table(count.contours)
    if count.local:
        yield text_table(
            "local",
            _("Local degrees of freedom"),
            (_("links"), _("degrees of freedom"), _("between pairs"), _("local motion")),
            [
                (", ".join(x.links), str(x.freedoms), ", ".join(p.name for p in x.ends), _local_freedom_text(x))
                for x in count.local
            ],
        )


def _chain_rows(count: ChainCount) -> Iterable[tuple[str, str]]:
    chain = count.chain
    yield _("number of moving links n"), str(len(chain.links))
    yield _("numbers of pairs with 1 to 5 degrees of freedom"), ", ".join(f"p{i} = {chain.p(i)}" for i in range(1, 6))
    yield _("mobility W by the Somov-Malyshev formula"), chain.count
    yield _("number of independent loops K = p - n"), str(len(chain.pairs) - len(chain.links))
    yield _("chain"), _chain_form(count)
    yield _("local degrees of freedom Wm"), str(count.local_mobility)
    yield _("mobility without local degrees of freedom, W - Wm"), str(count.effective)
    if count.wanted is not None and count.redundant is not None:
        q = redundancy_equation(count.wanted, count.local_mobility, count.mobility, count.redundant)
        yield _("redundant constraints q = Wo + Wm - W"), q
    if count.output is not None:
        yield _("manoeuvrability m: W with link {link} fixed").format(link=count.output), chain.held(count.output).count


def _chain_form(count: ChainCount) -> str:
    if count.form == "mixed":
        return _("closed, with open branches (links {links})").format(links=", ".join(count.branches))
    return _("open") if count.form == "open" else _("closed: every link lies in a loop")


def _chain_notes(count: ChainCount) -> Iterable[str]:
    seen = sum(x.freedoms for x in count.local)
    if count.given_local is not None and count.given_local < seen:
        yield _("Local degrees of freedom: {given} are given, {found} follow from the kinds of pairs.").format(
            given=count.given_local, found=seen
        )
    if count.immobile:
        yield _(
            "W - Wm < 1: by this count links {links} cannot move. If they move because of special dimensions, "
            "for example parallel axes, give the required mobility (wanted: 1); then the redundant constraints "
            "q are counted."
        ).format(links=", ".join(count.immobile))
    if count.redundant is not None and count.redundant > 0 and count.effective < 1:
        yield _(
            "q = {q}: the chain moves only if its dimensions are exact; according to the count of degrees of "
            "freedom it is immobile."
        ).format(q=count.redundant)
    if count.redundant is not None and count.redundant < 0:
        yield _("q < 0: the mobility exceeds the required one by {many}.").format(many=-count.redundant)
    m, idle = count.manoeuvrability, count.idle_manoeuvrability
    if m is not None and m < 1:
        yield _("m = {m}: with the output link fixed the chain cannot move; m >= 1 is required.").format(m=m)
    elif m is not None and m - idle < 1:
        yield _("m = {m}, of which local: {local}; the manipulator cannot avoid an obstacle.").format(m=m, local=idle)


def _local_freedom_text(freedom: LocalFreedom) -> str:
    kinds = freedom.kinds
    if kinds & CONTACT_PAIRS and kinds & {*AXLE_FREEDOMS}:
        return _("rotates about its own axis, like a roller")
    if freedom.freedoms == 1 and kinds == {"cylindrical", "spherical"}:
        return _("rotates about its own axis if the ball centre lies on it")
    if freedom.freedoms == 1 and len(freedom.ends) == 2 and kinds <= {"spherical", "planar"}:
        if kinds == {"spherical"}:
            return _("rotates about the line through both centres")
        if kinds == {"planar"}:
            return _("slides along both planes")
        return _("rotates about the normal to the plane through the centre")
    return _("moves while its neighbouring links are fixed")


# Schemes and kinematic chains as tables and as plain data.


DEGREES = (N_("binary links"), N_("ternary links"), N_("quaternary links"))

WrittenSchemes = Sequence[tuple[Path, bool] | None]
"""The file of each scheme and whether it was solved with its forces; None where no pose could be assembled."""


def schemes_table(
    schemes: Sequence[Scheme], links: int, mobility: int, written: WrittenSchemes | None, types: Iterable[str] = ()
) -> Table:
    """Return the table of enumerated schemes: structural formula, groups, numbers of links and pairs, file.

    Args:
        schemes: enumerated schemes.
        links: number of moving links.
        mobility: mobility W.
        written: file of each scheme; None if no files were written.
        types: types of the groups that were enumerated.
    """
    columns = [
        Column(N_("scheme"), [str(k + 1) for k in range(len(schemes))]),
        Column(N_("structural formula"), [s.formula for s in schemes]),
        Column(N_("groups"), [", ".join(s.types) for s in schemes]),
        Column(N_("links/pairs"), [f"{s.links}/{len(s.joints)}" for s in schemes]),
        Column(N_("revolute pairs"), [_scheme_pairs(s, "R") for s in schemes]),
        Column(N_("prismatic pairs"), [_scheme_pairs(s, "P") for s in schemes]),
    ]
    if written is not None:
        none = _("none: no position was found in which the scheme can be assembled")
        columns.append(Column(N_("file"), [file[0].name if file else none for file in written]))
    title = _("Schemes with {links} moving links, W = {mobility}").format(links=links, mobility=mobility)
    return Table(
        "schemes",
        title,
        tuple(columns),
        notes=(_("number of schemes: {count}").format(count=len(schemes)), *not_enumerated(types)),
    )


def not_enumerated(types: Iterable[str]) -> Iterable[str]:
    """Yield a sentence that names the groups of higher class which are not enumerated.

    There is none if only groups of class II were requested.
    """
    if any(GROUP_TYPES[name].grade > 2 for name in types):
        yield _(
            "Not enumerated: groups of classes III and IV with six links or more (e.g. class III of order 4) "
            "or with prismatic pairs, and groups of class V and higher. Only groups with four links and "
            "revolute pairs are listed."
        )


def _scheme_pairs(scheme: Scheme, kind: str) -> str:
    return " ".join(f"{i}-{j}" for i, j, kind_of_pair in scheme.joints if kind_of_pair == kind)


def chains_table(chains: Sequence[KinematicChain], links: int, mobility: int) -> Table:
    """Return a table with the number of kinematic chains for each combination of binary, ternary, ... links."""
    counts = _assortments(chains)
    most = max((len(assortment) for assortment in counts), default=0)
    names = [
        _(DEGREES[k]) if k < len(DEGREES) else _("links with {pairs} pairs").format(pairs=k + 2) for k in range(most)
    ]
    columns = [Column(name, [a[k] if k < len(a) else 0 for a in counts], NUMBER) for k, name in enumerate(names)]
    columns.append(Column(N_("number of chains"), [all_ for all_, __ in counts.values()], NUMBER))
    columns.append(Column(N_("of which fractionated"), [parts for __, parts in counts.values()], NUMBER))
    title = _("Kinematic chains of {links} links, W = {mobility}: {count}").format(
        links=links, mobility=mobility, count=len(chains)
    )
    note = _(
        "The chains have only revolute pairs, no compound hinges and no rigid subchains. A fractionated "
        "chain falls apart when one of its links is removed."
    )
    return Table("chains", title, tuple(columns), notes=(note,))


def _assortments(chains: Iterable[KinematicChain]) -> dict[tuple[int, ...], tuple[int, int]]:
    """Count the chains with the same numbers of binary, ternary, ... links, and the fractionated ones among them."""
    chains = list(chains)
    parts = Counter(chain.assortment for chain in chains if chain.fractionated)
    return {key: (count, parts[key]) for key, count in Counter(chain.assortment for chain in chains).items()}


def schemes_json(
    schemes: Sequence[Scheme], links: int, mobility: int, written: WrittenSchemes | None, types: Iterable[str] = ()
) -> dict[str, Any]:
    """Return the enumerated schemes as plain data; the arguments are those of `schemes_table`."""
    rows = []
    for k, scheme in enumerate(schemes):
        row: dict[str, Any] = {
            "number": k + 1,
            "formula": scheme.formula,
            "mobility": scheme.mobility,
            "groups": [
                {
                    "class": ROMAN[g.type.grade],
                    "type": g.type.name,
                    "links": list(g.links),
                    "attached_to": [link for link, *__ in g.outer],
                }
                for g in scheme.groups
            ],
            "pairs": [{"links": [i, j], "kind": kind} for i, j, kind in scheme.joints],
        }
        if written is not None:
            file, solved = written[k] or (None, False)
            row |= {"file": file and str(file), "solved": solved}
        rows.append(row)
    return {
        "links": links,
        "mobility": mobility,
        "count": len(schemes),
        "schemes": rows,
        "not_enumerated": list(not_enumerated(types)),
    }


def chains_json(chains: Sequence[KinematicChain], links: int, mobility: int) -> dict[str, Any]:
    """Return the enumerated kinematic chains as plain data; the links of a chain are numbered from 0."""
    return {
        "links": links,
        "mobility": mobility,
        "count": len(chains),
        "fractionated": sum(chain.fractionated for chain in chains),
        "assortments": [
            {"links_with_2_3_pairs_and_more": list(key), "count": count, "fractionated": parts}
            for key, (count, parts) in _assortments(chains).items()
        ],
        "chains": [{"pairs": [list(pair) for pair in c.pairs], "fractionated": c.fractionated} for c in chains],
    }
