"""Tables of a linkage counted in space, of spatial chains given by pairs, and of enumerated schemes and chains."""

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
    """Yield the independent contours, the redundant constraints in space, and pairs that would remove them."""
    structure = results.structure
    yield contour_table(find_contours(structure.pairs, structure.links), structure)
    found = count_in_space(results.linkage, structure)
    facts = [
        (_("W by Somov-Malyshev"), found.chain.count),
        (
            _("redundant constraints q = Wo + Wm - W"),
            redundancy_equation(found.wanted, found.local, found.chain.mobility, found.redundant),
        ),
    ]
    if found.replacements:
        q = redundancy_equation(found.wanted, found.rank.local, found.proposed.mobility, found.redundant_then)
        facts += [(_("W by Somov-Malyshev, with the replacements below"), found.proposed.count)]
        facts += [(_("redundant constraints q = Wo + Wm - W, with the replacements below"), q)]
    note = _(
        "No replacement of revolute pairs by cylindrical or spherical ones and of prismatic pairs by "
        "cylindrical or planar ones was found for which q = 0."
    )
    yield text_table(
        "space",
        _("The linkage counted in space: redundant constraints"),
        (_("item"), _("value")),
        facts,
        () if found.replacements is not None else (note,),
    )
    if found.replacements:
        note = _(
            "Pairs on the frame are kept, because they position shafts and guides. The out-of-plane "
            "constraints of these pairs are independent (checked by rank)."
        )
        title, notes = _("Replacements without redundant constraints"), [note]
        if found.redundant_then:
            title = _("Replacements without redundant out-of-plane constraints")
            notes.append(_("In the plane: {redundant}.").format(redundant="; ".join(reduction_sentences(structure))))
        yield text_table(
            "replacements",
            title,
            (_("pair"), _("links"), _("present kind"), _("replacement"), _("degrees of freedom")),
            [
                (r.pair.name, f"{printed(r.pair.i)} - {printed(r.pair.j)}", _(r.was), _(r.kind), str(r.freedoms))
                for r in found.replacements
            ],
            tuple(notes),
        )


def contour_table(found: Sequence[Contour], structure: Structure | None = None) -> Table:
    """Return the table of contours; structure: a planar linkage, in which contours may be dependent."""
    headers, rows = [_("loop"), _("pairs")], [[contour.title, ", ".join(contour.pairs)] for contour in found]
    if structure is None or not any(is_dependent(contour, structure) for contour in found):
        return text_table("contours", _("Independent loops"), headers, rows)
    kinds = [_("dependent") if is_dependent(contour, structure) else _("independent") for contour in found]
    rows = [[*row, kind] for row, kind in zip(rows, kinds, strict=True)]
    note = _("A dependent loop repeats another one: the links or pairs that close it are redundant.")
    return text_table("contours", _("Loops"), [*headers, _("kind")], rows, (note,))


def redundancy_equation(wanted: int, local: int, mobility: int, redundant: int) -> str:
    """Return the count of redundant constraints, q = Wo + Wm - W, with its numbers."""
    w = f"({mobility})" if mobility < 0 else str(mobility)
    return f"{wanted} + {local} - {w} = {redundant}"


# A chain given by pairs alone: mobility, pairs, contours, local freedoms, manoeuvrability.


def chain_tables(results: ChainResults) -> Iterable[Table]:
    """Yield the tables of a chain given by its pairs: mobility, pairs, contours and local freedoms."""
    found = results.chain
    yield text_table("structure", _("Structure"), (_("item"), _("value")), _chain_rows(found), _chain_notes(found))
    yield text_table(
        "pairs",
        _("Kinematic pairs"),
        (_("pair"), _("links"), _("kind"), _("degrees of freedom"), _("class")),
        [(p.name, f"{p.i} - {p.j}", _(p.kind), str(p.freedoms), ROMAN[p.pair_class]) for p in found.chain.pairs],
    )
    if found.contours:
        yield contour_table(found.contours)
    if found.local:
        yield text_table(
            "local",
            _("Local degrees of freedom"),
            (_("links"), _("degrees of freedom"), _("between pairs"), _("local motion")),
            [
                (", ".join(x.links), str(x.freedoms), ", ".join(p.name for p in x.ends), _local_freedom_text(x))
                for x in found.local
            ],
        )


def _chain_rows(found: ChainCount) -> Iterable[tuple[str, str]]:
    chain = found.chain
    yield _("moving links n"), str(len(chain.links))
    yield _("numbers of pairs with 1 to 5 degrees of freedom"), ", ".join(f"p{i} = {chain.p(i)}" for i in range(1, 6))
    yield _("W by Somov-Malyshev"), chain.count
    yield _("independent loops K = p - n"), str(len(chain.pairs) - len(chain.links))
    yield _("chain"), _chain_form(found)
    yield _("local degrees of freedom Wm"), str(found.local_mobility)
    yield _("mobility without local degrees of freedom, W - Wm"), str(found.effective)
    if found.wanted is not None and found.redundant is not None:
        q = redundancy_equation(found.wanted, found.local_mobility, found.mobility, found.redundant)
        yield _("redundant constraints q = Wo + Wm - W"), q
    if found.output is not None:
        yield _("manoeuvrability m: W with link {link} fixed").format(link=found.output), chain.held(found.output).count


def _chain_form(found: ChainCount) -> str:
    if found.form == "mixed":
        return _("closed, with open branches (links {links})").format(links=", ".join(found.branches))
    return _("open") if found.form == "open" else _("closed: every link lies in a loop")


def _chain_notes(found: ChainCount) -> Iterable[str]:
    seen = sum(x.freedoms for x in found.local)
    if found.given_local is not None and found.given_local < seen:
        yield _("Local degrees of freedom: {given} are given, {found} follow from the kinds of pairs.").format(
            given=found.given_local, found=seen
        )
    if found.immobile:
        yield _(
            "W - Wm < 1: by this count links {links} cannot move. If they move owing to special dimensions, "
            "for example parallel axes, give the required mobility (wanted: 1): then the redundant constraints "
            "q are counted."
        ).format(links=", ".join(found.immobile))
    if found.redundant is not None and found.redundant > 0 and found.effective < 1:
        yield _("q = {q}: the chain moves only if its dimensions are exact; by the count it cannot move.").format(
            q=found.redundant
        )
    if found.redundant is not None and found.redundant < 0:
        yield _("q < 0: the mobility exceeds the required one by {many}.").format(many=-found.redundant)
    m, idle = found.manoeuvrability, found.idle_manoeuvrability
    if m is not None and m < 1:
        yield _("m = {m}: with the output link fixed the chain cannot move; m >= 1 is required.").format(m=m)
    elif m is not None and m - idle < 1:
        yield _("m = {m}, of which local: {local}; the arm cannot move around an obstacle.").format(m=m, local=idle)


def _local_freedom_text(part: LocalFreedom) -> str:
    kinds = part.kinds
    if kinds & CONTACT_PAIRS and kinds & {*AXLE_FREEDOMS}:
        return _("rotates about its own axis as a roller")
    if part.freedoms == 1 and kinds == {"cylindrical", "spherical"}:
        return _("rotates about its own axis if the ball centre lies on it")
    if part.freedoms == 1 and len(part.ends) == 2 and kinds <= {"spherical", "planar"}:
        if kinds == {"spherical"}:
            return _("rotates about the line through both centres")
        if kinds == {"planar"}:
            return _("slides along both planes")
        return _("rotates about the normal to the plane through the centre")
    return _("moves while its neighbours are fixed")


# Schemes and kinematic chains as tables and as plain data.


DEGREES = (N_("binary"), N_("ternary"), N_("quaternary"))

WrittenSchemes = Sequence[tuple[Path, bool] | None]
"""The file of each scheme and whether it was solved with its forces; None where no pose could be assembled."""


def schemes_table(
    found: Sequence[Scheme], links: int, mobility: int, written: WrittenSchemes | None, types: Iterable[str] = ()
) -> Table:
    """Return the table of schemes: formula, groups, links and pairs, file. types: group types that were enumerated."""
    columns = [
        Column(N_("scheme"), [str(k + 1) for k in range(len(found))]),
        Column(N_("structural formula"), [s.formula for s in found]),
        Column(N_("groups"), [", ".join(s.types) for s in found]),
        Column(N_("links/pairs"), [f"{s.links}/{len(s.joints)}" for s in found]),
        Column(N_("revolute pairs"), [_scheme_pairs(s, "R") for s in found]),
        Column(N_("prismatic pairs"), [_scheme_pairs(s, "P") for s in found]),
    ]
    if written is not None:
        none = _("none: no position was found in which it can be assembled")
        columns.append(Column(N_("file"), [one[0].name if one else none for one in written]))
    title = _("Schemes with {links} moving links, W = {mobility}").format(links=links, mobility=mobility)
    return Table(
        "schemes", title, tuple(columns), notes=(_("schemes: {count}").format(count=len(found)), *not_enumerated(types))
    )


def not_enumerated(types: Iterable[str]) -> Iterable[str]:
    """Yield a sentence on the missing groups if a class higher than II was requested."""
    if any(GROUP_TYPES[name].grade > 2 for name in types):
        yield _(
            "Not enumerated: groups of classes III and IV with six links or more (e.g. class III of order 4) "
            "or with prismatic pairs, and groups of class V and higher. Only groups with four links and "
            "revolute pairs are listed."
        )


def _scheme_pairs(scheme: Scheme, kind: str) -> str:
    return " ".join(f"{i}-{j}" for i, j, this in scheme.joints if this == kind)


def chains_table(found: Sequence[KinematicChain], links: int, mobility: int) -> Table:
    """Return the number of kinematic chains for each assortment of links."""
    counts = _assortments(found)
    most = max((len(assortment) for assortment in counts), default=0)
    names = [_(DEGREES[k]) if k < len(DEGREES) else _("with {pairs} pairs").format(pairs=k + 2) for k in range(most)]
    columns = [Column(name, [a[k] if k < len(a) else 0 for a in counts], NUMBER) for k, name in enumerate(names)]
    columns.append(Column(N_("chains"), [all_ for all_, __ in counts.values()], NUMBER))
    columns.append(Column(N_("including fractionated"), [parts for __, parts in counts.values()], NUMBER))
    title = _("Kinematic chains of {links} links, W = {mobility}: {count}").format(
        links=links, mobility=mobility, count=len(found)
    )
    note = _(
        "Revolute pairs, no compound hinges, no rigid subchains. A fractionated chain falls apart when one "
        "of its links is removed."
    )
    return Table("chains", title, tuple(columns), notes=(note,))


def _assortments(found: Iterable[KinematicChain]) -> dict[tuple[int, ...], tuple[int, int]]:
    """Return the number of chains and of fractionated chains by assortment of links."""
    found = list(found)
    parts = Counter(chain.assortment for chain in found if chain.fractionated)
    return {key: (count, parts[key]) for key, count in Counter(chain.assortment for chain in found).items()}


def schemes_json(
    found: Sequence[Scheme], links: int, mobility: int, written: WrittenSchemes | None, types: Iterable[str] = ()
) -> dict[str, Any]:
    """Return the schemes as plain data."""
    rows = []
    for k, scheme in enumerate(found):
        row: dict[str, Any] = {
            "number": k + 1,
            "formula": scheme.formula,
            "mobility": scheme.mobility,
            "groups": [
                {
                    "class": ROMAN[g.type.grade],
                    "type": g.type.name,
                    "links": list(g.links),
                    "attached_to": [known for known, *__ in g.outer],
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
        "count": len(found),
        "schemes": rows,
        "not_enumerated": list(not_enumerated(types)),
    }


def chains_json(found: Sequence[KinematicChain], links: int, mobility: int) -> dict[str, Any]:
    """Return the chains as plain data; the links of a chain are numbered from 0."""
    return {
        "links": links,
        "mobility": mobility,
        "count": len(found),
        "fractionated": sum(chain.fractionated for chain in found),
        "assortments": [
            {"links_with_2_3_pairs_and_more": list(key), "count": count, "fractionated": parts}
            for key, (count, parts) in _assortments(found).items()
        ],
        "chains": [{"pairs": [list(pair) for pair in c.pairs], "fractionated": c.fractionated} for c in found],
    }
