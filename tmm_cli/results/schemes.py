"""Schemes and kinematic chains as tables and as plain data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tmm_cli.language import N_, _
from tmm_cli.quantities import NUMBER
from tmm_cli.results.table import Column, Table
from tmm_cli.schemes.chains import KinematicChain
from tmm_cli.schemes.schemes import TYPES, Scheme
from tmm_cli.structure.assur import ROMAN

DEGREES = (N_("binary"), N_("ternary"), N_("quaternary"))

Written = Sequence[tuple[Path, bool] | None]
"""The file of each scheme and whether it was solved with its forces; None where no pose could be assembled."""


def schemes_table(
    found: Sequence[Scheme], links: int, mobility: int, written: Written | None, types: Iterable[str] = ()
) -> Table:
    """Number, formula, groups, links and pairs, file. types: the types of groups that were enumerated."""
    columns = [
        Column(N_("scheme"), [str(k + 1) for k in range(len(found))]),
        Column(N_("formula of structure"), [s.formula for s in found]),
        Column(N_("groups"), [", ".join(s.types) for s in found]),
        Column(N_("links/pairs"), [f"{s.links}/{len(s.joints)}" for s in found]),
        Column(N_("turning pairs"), [_pairs(s, "R") for s in found]),
        Column(N_("sliding pairs"), [_pairs(s, "P") for s in found]),
    ]
    if written is not None:
        none = _("none: no pose was found that assembles")
        columns.append(Column(N_("file"), [one[0].name if one else none for one in written]))
    title = _("Schemes with {links} moving links, W = {mobility}").format(links=links, mobility=mobility)
    return Table(
        "schemes", title, tuple(columns), notes=(_("{count} schemes").format(count=len(found)), *not_enumerated(types))
    )


def not_enumerated(types: Iterable[str]) -> Iterable[str]:
    """A sentence about the groups that are missing where a class higher than II was requested."""
    if any(TYPES[name].grade > 2 for name in types):
        yield _(
            "Not enumerated: groups of classes III and IV with six links or more (order 4 of class III is one) or with "
            "sliding pairs, and groups of class V and higher. Listed are those with four links and turning pairs only."
        )


def _pairs(scheme: Scheme, kind: str) -> str:
    return " ".join(f"{i}-{j}" for i, j, this in scheme.joints if this == kind)


def chains_table(found: Sequence[KinematicChain], links: int, mobility: int) -> Table:
    """How many chains there are of each assortment of links."""
    counts = _assortments(found)
    most = max((len(assortment) for assortment in counts), default=0)
    names = [_(DEGREES[k]) if k < len(DEGREES) else _("with {pairs} pairs").format(pairs=k + 2) for k in range(most)]
    columns = [Column(name, [a[k] if k < len(a) else 0 for a in counts], NUMBER) for k, name in enumerate(names)]
    columns.append(Column(N_("chains"), [all_ for all_, __ in counts.values()], NUMBER))
    columns.append(Column(N_("of them fractionated"), [parts for __, parts in counts.values()], NUMBER))
    title = _("Kinematic chains of {links} links, W = {mobility}: {count}").format(
        links=links, mobility=mobility, count=len(found)
    )
    note = _("Turning pairs, no compound hinges, no rigid part. Fractionated: falls apart without one of its links.")
    return Table("chains", title, tuple(columns), notes=(note,))


def _assortments(found: Iterable[KinematicChain]) -> dict[tuple[int, ...], tuple[int, int]]:
    """Chains of each assortment, and the fractionated ones among them."""
    found = list(found)
    parts = Counter(chain.assortment for chain in found if chain.fractionated)
    return {key: (count, parts[key]) for key, count in Counter(chain.assortment for chain in found).items()}


def schemes_json(
    found: Sequence[Scheme], links: int, mobility: int, written: Written | None, types: Iterable[str] = ()
) -> dict[str, Any]:
    """Everything about the schemes as plain data."""
    rows = []
    for k, scheme in enumerate(found):
        row: dict[str, Any] = {
            "number": k + 1,
            "formula": scheme.formula,
            "mobility": scheme.mobility,
            "groups": [
                {"class": ROMAN[g.type.grade], "type": g.type.name, "links": list(g.links),
                 "attached_to": [known for known, *__ in g.outer]}
                for g in scheme.groups
            ],
            "pairs": [{"links": [i, j], "kind": kind} for i, j, kind in scheme.joints],
        }  # fmt: skip
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
    """Everything about the chains as plain data; links of a chain are numbered from 0."""
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
