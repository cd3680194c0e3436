"""A planar linkage in space: contours, redundant constraints, and pairs that would take them away."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import _, printed
from tmm_cli.results.reports.structure import left_out
from tmm_cli.results.table import Table, table_of_words
from tmm_cli.structure.assur import Structure
from tmm_cli.structure.contours import Contour, contours, is_dependent
from tmm_cli.structure.redundancy import space


def tables(results: Results) -> Iterable[Table]:
    """Three small tables."""
    structure = results.structure
    yield contour_table(contours(structure.pairs, structure.links), structure)
    found = space(results.linkage, structure)
    facts = [
        (_("W by Somov-Malyshev"), found.chain.count),
        (_("redundant constraints q = Wo + Wm - W"),
         redundancy(found.wanted, found.local, found.chain.mobility, found.redundant)),
    ]  # fmt: skip
    if found.replacements:
        q = redundancy(found.wanted, found.rank.local, found.proposed.mobility, found.redundant_then)
        facts += [(_("W by Somov-Malyshev, with the pairs below"), found.proposed.count)]
        facts += [(_("redundant constraints q = Wo + Wm - W, with the pairs below"), q)]
    note = _(
        "No replacement of turning pairs by cylindrical or spherical ones and of sliding pairs "
        "by cylindrical or planar ones was found that leaves q = 0."
    )
    yield table_of_words(
        "space", _("The same pairs in space: redundant constraints"), (_("what"), _("value")), facts,
        () if found.replacements is not None else (note,),
    )  # fmt: skip
    if found.replacements:
        note = _(
            "Pairs on the frame stay, they position shafts and guides. Out of the plane, the "
            "conditions of these pairs are independent (checked by rank)."
        )
        title, notes = _("Pairs that leave no redundant constraints"), [note]
        if found.redundant_then:
            title = _("Pairs that leave no redundant constraints out of the plane")
            notes.append(_("In the plane: {redundant}.").format(redundant="; ".join(left_out(structure))))
        yield table_of_words(
            "replacements", title,
            (_("pair"), _("links"), _("is"), _("becomes"), _("freedoms")),
            [(r.pair.name, f"{printed(r.pair.i)} - {printed(r.pair.j)}", _(r.was), _(r.kind), str(r.freedoms))
             for r in found.replacements],
            tuple(notes),
        )  # fmt: skip


def contour_table(found: Sequence[Contour], structure: Structure | None = None) -> Table:
    """Contours by links and pairs; of a planar linkage with redundant links or pairs, which of them are dependent."""
    headers, rows = [_("contour"), _("pairs")], [[contour.title, ", ".join(contour.pairs)] for contour in found]
    if structure is None or not any(is_dependent(contour, structure) for contour in found):
        return table_of_words("contours", _("Independent contours"), headers, rows)
    kinds = [_("dependent") if is_dependent(contour, structure) else _("independent") for contour in found]
    rows = [[*row, kind] for row, kind in zip(rows, kinds, strict=True)]
    note = _("A dependent contour repeats another one: the links or pairs that close it are redundant.")
    return table_of_words("contours", _("Contours"), [*headers, _("kind")], rows, (note,))


def redundancy(wanted: int, local: int, mobility: int, redundant: int) -> str:
    """Redundant constraints as they are counted."""
    w = f"({mobility})" if mobility < 0 else str(mobility)
    return f"{wanted} + {local} - {w} = {redundant}"
