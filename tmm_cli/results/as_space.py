"""The parts of result.json that count in space: of a planar linkage, and of a chain given by pairs alone."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tmm_cli.structure.contours import Contour
from tmm_cli.structure.redundancy import Space
from tmm_cli.structure.spatial import Chain, Findings


def space_json(space: Space, contours: Iterable[Contour]) -> dict[str, Any]:
    """A planar linkage in space: as it is, and as proposed."""
    return {
        **_count(space.chain),
        "wanted": space.wanted,
        "local": space.local,
        "redundant": space.redundant,
        "contours": _contours(contours),
        "replacements": None if space.replacements is None else [
            {"pair": r.pair.name, "links": [r.pair.i, r.pair.j], "was": r.was, "kind": r.kind, "freedoms": r.freedoms}
            for r in space.replacements
        ],
        "proposed": None if space.replacements is None else {
            **_count(space.proposed), "local": space.rank.local, "redundant": space.redundant_then
        },
    }  # fmt: skip


def chain_json(found: Findings) -> dict[str, Any]:
    """A chain given by pairs alone."""
    return {
        **_count(found.chain),
        "form": found.form,
        "contours": _contours(found.contours),
        "branches": list(found.branches),
        "pairs": [
            {"name": p.name, "links": [p.i, p.j], "kind": p.kind or None, "freedoms": p.freedoms, "class": p.grade}
            for p in found.chain.pairs
        ],
        "local_freedoms": [
            {"links": list(x.links), "freedoms": x.freedoms, "pairs": [p.name for p in x.ends]} for x in found.local
        ],
        "local": found.local_mobility,
        "wanted": found.wanted,
        "redundant": found.redundant,
        "output": found.output,
        "manoeuvrability": found.manoeuvrability,
    }


def _count(chain: Chain) -> dict[str, Any]:
    return {
        "mobility": chain.mobility,
        "n": len(chain.links),
        **{f"p{i}": chain.p(i) for i in range(1, 6)},
        "K": len(chain.pairs) - len(chain.links),
    }


def _contours(contours: Iterable[Contour]) -> list[dict[str, Any]]:
    return [{"links": list(c.links), "pairs": list(c.pairs)} for c in contours]
