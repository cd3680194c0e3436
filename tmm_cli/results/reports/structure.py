"""Structure: mobility, links, pairs, Assur groups."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results
from tmm_cli.results.table import Column, Table
from tmm_cli.structure.assur import ROMAN, Structure
from tmm_cli.structure.contours import classification
from tmm_cli.words import say


def _passive(structure: Structure) -> Iterable[tuple[str, str]]:
    """Passive constraints and the true mobility, where the count is not the truth."""
    if structure.passive:
        yield say("structure.true"), str(structure.mobility + structure.redundant)
    for passive in structure.passive:
        i, j = passive.links
        yield (
            say("structure.passive"),
            say("structure.where", count=passive.constraints, pair=passive.pair, i=i, j=j,
                among=", ".join(passive.among)),
        )  # fmt: skip


def tables(results: Results) -> Iterable[Table]:
    """Four small tables."""
    structure, linkage = results.structure, results.linkage
    turning = sum(p.kind == "R" for p in structure.pairs)
    lower = len(structure.pairs) - structure.higher
    facts = (
        (say("structure.n"), str(len(structure.links))),
        (
            say("structure.p1"),
            say("structure.kinds", all=lower, r=turning, p=lower - turning),
        ),
        *_higher(structure),
        (
            say("structure.W2" if structure.higher else "structure.W"),
            say(
                "structure.chebyshev2" if structure.higher else "structure.chebyshev",
                n=len(structure.links),
                p=lower,
                p2=structure.higher,
                w=structure.mobility,
            ),
        ),
        *_passive(structure),
        (say("structure.K"), str(structure.contours)),
        (say("structure.formula"), structure.formula),
        (say("structure.chain"), ", ".join(say(f"class.{word}") for word in classification(structure))),
        (say("structure.class"), ROMAN[min(structure.mechanism_class, 10)]),
    )
    yield Table(
        "structure", say("structure.title"),
        (Column(say("word.what"), [a for a, _ in facts]), Column(say("word.value"), [b for _, b in facts])),
    )  # fmt: skip
    links, roles = [linkage.links[name] for name in structure.links], results.roles
    yield Table(
        "links", say("links.title"),
        (
            Column(say("word.link"), [x.name for x in links]),
            Column(say("links.role"), [say(f"role.{roles[x.name]}") for x in links]),
            Column(say("links.label"), [x.label for x in links]),
            Column(say("links.points"), [", ".join(x.points) for x in links]),
        ),
        notes=(say("links.turned"),) if results.motion is None and results.mechanism.turned else (),
    )  # fmt: skip
    pairs = structure.pairs
    yield Table(
        "pairs", say("pairs.title"),
        (
            Column(say("word.pair"), [p.name for p in pairs]),
            Column(say("word.links"), [f"{p.i} - {p.j}" for p in pairs]),
            Column(say("pairs.kind"), [say(f"pairs.{p.kind}") for p in pairs]),
            Column(say("pairs.place"), [say("pairs.frame" if FRAME in (p.i, p.j) else "pairs.moving") for p in pairs]),
        ),
    )  # fmt: skip
    groups = structure.groups
    yield Table(
        "groups", say("groups.title"),
        (
            Column(say("word.group"), [", ".join(g.links) for g in groups]),
            Column(say("groups.class"), [ROMAN[min(g.grade, 10)] for g in groups]),
            Column(say("groups.order"), [str(g.order) for g in groups]),
            Column(say("groups.type"), [g.type for g in groups]),
            Column(say("groups.inner"), [", ".join(p.name for p in g.inner) for g in groups]),
            Column(say("groups.outer"), [", ".join(f"{p.name} ({p.i}-{p.j})" for p in g.outer) for g in groups]),
        ),
    )  # fmt: skip


def _higher(structure: Structure) -> Iterable[tuple[str, str]]:
    """How many higher pairs there are, and of which kind."""
    if structure.higher:
        kinds = (("G", "structure.wheels"), ("K", "structure.racks"), ("C", "structure.cams"))
        counts = [(key, sum(p.kind == kind for p in structure.pairs)) for kind, key in kinds]
        told = ", ".join(say(key, count=count) for key, count in counts if count)
        yield say("structure.p2"), f"{structure.higher} ({told})"
