"""The part of result.json that comes from balancing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.results.shapes import NUMBER, SERIES, TEXT, VECTOR, Field, list_of, optional, record

if TYPE_CHECKING:  # few files ask for it
    from tmm_cli.analysis.balancing import Balancing

SHAKING = record(
    "by inertia alone",
    Field("force", VECTOR, "on the frame, N"),
    Field("moment", SERIES, "about `pivot`, N*m"),
)
COUNTERWEIGHT = record(
    "a counterweight",
    Field("link", TEXT, "its link", "place.link"),
    Field("size", NUMBER, "mass times radius, kg*m"),
    Field("angle", NUMBER, "from the x axis of the link, rad"),
    Field("radius", optional(NUMBER), "m; null where the file tells none", lambda w: w.place.radius or None),
    Field("mass", optional(NUMBER), "kg; null likewise"),
)


def _corrections(found: Balancing) -> list[dict[str, Any]]:
    rotor = found.task.rotor
    assert rotor is not None
    return [
        {"at": plane.at, "size": abs(size), "angle": float(np.angle(size))}
        for plane, size in zip(rotor.planes, found.corrections.tolist(), strict=True)
    ]


CORRECTION = record(
    "a mass that balances a shaft",
    Field("at", NUMBER, "place of its plane, m", lambda c: c["at"]),
    Field("size", NUMBER, "mass times radius, kg*m", lambda c: c["size"]),
    Field("angle", NUMBER, "rad", lambda c: c["angle"]),
)
BALANCING = record(
    "balancing",
    Field("pivot", TEXT, "moments are about this point; empty: about the origin"),
    Field("before", SHAKING, "at the positions"),
    Field("counterweights", list_of(COUNTERWEIGHT), "that leave the least force", "cycle.counterweights"),
    Field("after", SHAKING, "at the positions, with counterweights"),
    Field("left", NUMBER, "largest force over the cycle with counterweights, over that without", "cycle.left"),
    Field(
        "rotor", list_of(CORRECTION), "masses on the shaft", _corrections, lambda found: found.task.rotor is not None
    ),
)
