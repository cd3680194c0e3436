"""The part of result.json that lists all real assemblies of the groups, and its schema."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tmm_cli.assemblies import Assemblies


def assemblies_json(places: Iterable[Assemblies]) -> list[dict[str, Any]]:
    """One entry a place of the driver."""
    return [
        {
            "position": here.number,
            "driver": here.q,
            "undecided": None if here.undecided is None else here.undecided.title,
            "lost": [group.title for group in here.lost],
            "groups": [
                {
                    "group": g.group.title, "method": g.method, "complete": g.complete, "most": g.most,
                    "moves": g.moves,
                    "assemblies": [
                        {
                            "angles": dict(a.angles),
                            "points": {name: {"x": p.real, "y": p.imag} for name, p in a.points.items()},
                            "margin": a.margin, "sketch": a.of_sketch,
                        }
                        for a in g.assemblies
                    ],
                }
                for g in here.groups
            ],
        }
        for here in places
    ]  # fmt: skip
