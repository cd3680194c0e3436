"""What `tmm schemes` gives: tables and JSON of schemes and chains, and the problem files of schemes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.results.files import write_whole
from tmm_cli.results.skeleton import Skeleton, skeleton
from tmm_cli.results.table import Column, Table
from tmm_cli.structure import chains as kinematic
from tmm_cli.structure.assur import ROMAN
from tmm_cli.structure.chains import Chain
from tmm_cli.structure.schemes import (
    CLASSES,
    MOST_CRANKS,
    MOST_LINKS,
    MOST_SCHEMES,
    TYPES,
    Scheme,
    TooManySchemes,
    schemes,
)
from tmm_cli.words import say

MOST_FILES = 300  # each takes some tenths of a second
WORDS = ("binary", "ternary", "quaternary")

Written = Sequence[tuple[Path, Skeleton] | None]


def named_types(text: str) -> tuple[str, ...]:
    """Types of groups from a list of types and classes, `RRR,RRP` or `II,III`. Raises ProblemError."""
    found: list[str] = []
    for word in text.split(","):
        name = word.strip().upper()
        if name not in TYPES and name not in CLASSES:
            known = [*CLASSES, *(name for name in TYPES if name not in CLASSES)]
            raise ProblemError(
                "there is no such group", path=("--groups",), found=quote(word.strip()), allowed=", ".join(known),
                near=nearest(name, known),
            )  # fmt: skip
        found += CLASSES.get(name, (name,))
    return tuple(dict.fromkeys(found))


def wanted_schemes(links: int, mobility: int, types: Sequence[str]) -> tuple[Scheme, ...]:
    """The schemes, or a ProblemError that says what can be asked for."""
    if not 1 <= mobility <= MOST_CRANKS:
        raise ProblemError(
            "so many driving cranks are not built", path=("--mobility",), found=str(mobility),
            allowed=f"1 to {MOST_CRANKS}",
        )  # fmt: skip
    allowed = range(mobility + 2, MOST_LINKS + 1, 2)
    if links not in allowed:
        raise ProblemError(
            "no schemes are built of so many moving links", path=("--links",), found=str(links),
            allowed=f"for W = {mobility}: {', '.join(map(str, allowed))} (groups have an even number of links)",
        )  # fmt: skip
    try:
        return schemes(links, mobility, types)
    except TooManySchemes:
        raise ProblemError(
            "these are too many schemes", path=("--links",), found=f"more than {MOST_SCHEMES} of {links} links",
            allowed="fewer links, or fewer types of groups (--groups)",
        ) from None  # fmt: skip


def wanted_chains(links: int, mobility: int) -> tuple[Chain, ...]:
    """The chains, or a ProblemError that says what can be asked for."""
    most = kinematic.MOST_LINKS
    if not 1 <= mobility <= most - 3:
        raise ProblemError(
            "no chains are built of this mobility",
            path=("--mobility",),
            found=str(mobility),
            allowed=f"1 to {most - 3}",
        )
    allowed = range(mobility + 3, most + 1, 2)
    if links not in allowed:
        raise ProblemError(
            "no closed chains are built of so many links", path=("--chains",), found=str(links),
            allowed=f"for W = {mobility}: {', '.join(map(str, allowed))} (3(n - 1) - 2p = W)",
        )  # fmt: skip
    return kinematic.chains(links, mobility)


def write_skeletons(found: Sequence[Scheme], folder: Path, each: Iterable[Scheme]) -> Written:
    """A problem file a scheme in the folder, each whole; None where no pose could be assembled.

    each: the schemes once more, as a progress bar counts them. Nothing is written before all files are made, and no
    file that is there already with other contents is touched. Raises ProblemError.
    """
    if len(found) > MOST_FILES:
        raise ProblemError(
            "these are too many files", path=("--out",), found=f"{len(found)} schemes",
            allowed=f"at most {MOST_FILES}: fewer links, or fewer types of groups (--groups)",
        )  # fmt: skip
    digits = max(2, len(str(len(found))))
    made: list[tuple[Path, Skeleton] | None] = []
    for number, scheme in enumerate(each, 1):
        one = skeleton(scheme, say("schemes.scheme", number=number, formula=scheme.formula))
        name = f"scheme-{number:0{digits}d}-{scheme.name}.yaml"
        made.append(None if one is None else (folder / name, one))
    for path, one in filter(None, made):
        if path.exists() and path.read_bytes() != one.text.encode():
            raise ProblemError(
                "there is another file of that name, perhaps your own work", path=("--out",), found=str(path),
                allowed="another folder",
            )  # fmt: skip
    for path, one in filter(None, made):
        write_whole(path, one.text.encode())
    return made


def schemes_table(found: Sequence[Scheme], links: int, mobility: int, written: Written | None) -> Table:
    """Number, formula, groups, links and pairs, file."""
    columns = [
        Column(say("schemes.number"), [str(k + 1) for k in range(len(found))]),
        Column(say("schemes.formula"), [s.formula for s in found]),
        Column(say("schemes.groups"), [", ".join(s.types) for s in found]),
        Column(say("schemes.size"), [f"{s.links}/{len(s.joints)}" for s in found]),
        Column(say("schemes.turning"), [_pairs(s, "R") for s in found]),
        Column(say("schemes.sliding"), [_pairs(s, "P") for s in found]),
    ]
    notes = [say("schemes.count", count=len(found))]
    if written is not None:
        columns.append(Column(say("schemes.file"), [x[0].name if x else say("schemes.none") for x in written]))
    return Table("schemes", say("schemes.title", links=links, mobility=mobility), tuple(columns), notes=tuple(notes))


def _pairs(scheme: Scheme, kind: str) -> str:
    return " ".join(f"{i}-{j}" for i, j, this in scheme.joints if this == kind)


def chains_table(found: Sequence[Chain], links: int, mobility: int) -> Table:
    """How many chains there are of each assortment of links."""
    counts = _assortments(found)
    most = max((len(assortment) for assortment in counts), default=0)
    columns = [
        Column(_degree(k), [a[k] if k < len(a) else 0 for a in counts], NUMBER) for k in range(most)
    ]  # fmt: skip
    columns.append(Column(say("schemes.all"), [all_ for all_, _ in counts.values()], NUMBER))
    columns.append(Column(say("schemes.fractionated"), [parts for _, parts in counts.values()], NUMBER))
    title = say("schemes.chains", links=links, mobility=mobility, count=len(found))
    return Table("chains", title, tuple(columns), notes=(say("schemes.note"),))


def _degree(k: int) -> str:
    return say(f"schemes.{WORDS[k]}") if k < len(WORDS) else say("schemes.with", pairs=k + 2)


def _assortments(found: Iterable[Chain]) -> dict[tuple[int, ...], tuple[int, int]]:
    """Chains of each assortment, and the fractionated ones among them."""
    found = list(found)
    parts = Counter(chain.assortment for chain in found if chain.fractionated)
    return {key: (count, parts[key]) for key, count in Counter(chain.assortment for chain in found).items()}


def schemes_json(found: Sequence[Scheme], links: int, mobility: int, written: Written | None) -> dict[str, Any]:
    """Everything about the schemes as plain data."""
    rows = []
    for k, scheme in enumerate(found):
        row: dict[str, Any] = {
            "number": k + 1,
            "formula": scheme.formula,
            "mobility": scheme.mobility,
            "groups": [
                {"class": ROMAN[g.type.grade], "type": g.type.name, "links": list(g.links),
                 "attached_to": [known for known, _, _ in g.outer]}
                for g in scheme.groups
            ],
            "pairs": [{"links": [i, j], "kind": kind} for i, j, kind in scheme.joints],
        }  # fmt: skip
        one = written[k] if written is not None else None
        if written is not None:
            row["file"] = str(one[0]) if one else None
            row["solved"] = bool(one and one[1].solved)
        rows.append(row)
    return {"links": links, "mobility": mobility, "count": len(found), "schemes": rows}


def chains_json(found: Sequence[Chain], links: int, mobility: int) -> dict[str, Any]:
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
