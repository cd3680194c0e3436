"""A planar linkage in space: contours, redundant constraints, and pairs that would take them away."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.pipeline import Results
from tmm_cli.results.table import Column, Table
from tmm_cli.structure.contours import Contour, contours
from tmm_cli.structure.redundancy import space
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """Three small tables."""
    structure = results.structure
    yield contour_table(contours(structure.pairs, structure.links))
    found = space(results.linkage, structure)
    q = say("space.count", wanted=found.wanted, local=found.local, w=_signed(found.chain.mobility), q=found.redundant)
    facts = [(say("space.W"), found.chain.count), (say("space.q"), q)]
    if found.replacements:
        q = say("space.count", wanted=found.wanted, local=found.rank.local, w=_signed(found.proposed.mobility),
                q=found.redundant_then)  # fmt: skip
        facts += [(say("space.then", what=say("space.W")), found.proposed.count)]
        facts += [(say("space.then", what=say("space.q")), q)]
    note = () if found.replacements is not None else (say("space.none"),)
    yield Table(
        "space", say("space.title"),
        (Column(say("word.what"), [a for a, _ in facts]), Column(say("word.value"), [b for _, b in facts])),
        notes=note,
    )  # fmt: skip
    replaced = found.replacements or ()
    if replaced:
        yield Table(
            "replacements", say("replacements.title"),
            (
                Column(say("word.pair"), [r.pair.name for r in replaced]),
                Column(say("word.links"), [f"{r.pair.i} - {r.pair.j}" for r in replaced]),
                Column(say("replacements.was"), [say(f"kind.{r.was}") for r in replaced]),
                Column(say("replacements.kind"), [say(f"kind.{r.kind}") for r in replaced]),
                Column(say("chain.freedoms"), [str(r.freedoms) for r in replaced]),
            ),
            notes=(say("replacements.note"),),
        )  # fmt: skip


def contour_table(found: tuple[Contour, ...]) -> Table:
    """Independent contours by links and pairs."""
    return Table(
        "contours", say("contours.title"),
        (
            Column(say("contours.links"), [c.title for c in found]),
            Column(say("contours.pairs"), [", ".join(c.pairs) for c in found]),
        ),
    )  # fmt: skip


def _signed(number: int) -> str:
    return f"({number})" if number < 0 else str(number)
