"""A chain given by pairs alone: mobility, pairs, contours, local freedoms, manoeuvrability."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.chain import ChainResults
from tmm_cli.results.reports.space import _signed, contour_table
from tmm_cli.results.table import Column, Table
from tmm_cli.structure.assur import ROMAN
from tmm_cli.structure.spatial import Findings, LocalFreedom
from tmm_cli.words import say


def tables(results: ChainResults) -> Iterable[Table]:
    """Up to four small tables."""
    found = results.chain
    facts = list(_facts(found))
    yield Table(
        "structure", say("structure.title"),
        (Column(say("word.what"), [a for a, _ in facts]), Column(say("word.value"), [b for _, b in facts])),
        notes=tuple(_notes(found)),
    )  # fmt: skip
    pairs = found.chain.pairs
    yield Table(
        "pairs", say("pairs.title"),
        (
            Column(say("word.pair"), [p.name for p in pairs]),
            Column(say("word.links"), [f"{p.i} - {p.j}" for p in pairs]),
            Column(say("pairs.kind"), [say(f"kind.{p.kind}") if p.kind else "" for p in pairs]),
            Column(say("chain.freedoms"), [str(p.freedoms) for p in pairs]),
            Column(say("groups.class"), [ROMAN[p.grade] for p in pairs]),
        ),
    )  # fmt: skip
    if found.contours:
        yield contour_table(found.contours)
    if found.local:
        yield Table(
            "local", say("local.title"),
            (
                Column(say("word.links"), [", ".join(x.links) for x in found.local]),
                Column(say("chain.freedoms"), [str(x.freedoms) for x in found.local]),
                Column(say("local.between"), [", ".join(p.name for p in x.ends) for x in found.local]),
                Column(say("local.what"), [_how(x) for x in found.local]),
            ),
        )  # fmt: skip


def _facts(found: Findings) -> Iterable[tuple[str, str]]:
    chain = found.chain
    yield say("structure.n"), str(len(chain.links))
    yield say("chain.p"), ", ".join(f"p{i} = {chain.p(i)}" for i in range(1, 6))
    yield say("space.W"), chain.count
    yield say("structure.K"), str(len(chain.pairs) - len(chain.links))
    yield say("chain.form"), say(f"chain.{found.form}", links=", ".join(found.branches))
    yield say("chain.local"), str(found.local_mobility)
    yield say("chain.general"), str(found.mobility - found.local_mobility)
    if found.redundant is not None:
        yield (
            say("space.q"),
            say(
                "space.count",
                wanted=found.wanted,
                local=found.local_mobility,
                w=_signed(found.mobility),
                q=found.redundant,
            ),
        )
    if found.output is not None:
        yield say("chain.m", link=found.output), chain.held(found.output).count


def _notes(found: Findings) -> Iterable[str]:
    seen = sum(x.freedoms for x in found.local)
    if found.given_local is not None and found.given_local < seen:
        yield say("chain.few_local", given=found.given_local, found=seen)
    if found.redundant is not None and found.redundant < 0:
        yield say("chain.too_free", many=-found.redundant)
    if found.manoeuvrability is not None:
        useful = found.manoeuvrability - found.idle_manoeuvrability
        if found.manoeuvrability < 1:
            yield say("chain.stuck", m=found.manoeuvrability)
        elif useful < 1:
            yield say("chain.idle", m=found.manoeuvrability, local=found.idle_manoeuvrability)


def _how(part: LocalFreedom) -> str:
    kinds = {p.kind for p in part.ends}
    if part.freedoms == 1 and len(part.ends) == 2 and kinds <= {"spherical", "planar"}:
        return say(f"local.{'+'.join(sorted(kinds))}")
    return say("local.count")
