"""The part of result.json that comes from balancing."""

from __future__ import annotations

import numpy as np

from tmm_cli.results.shapes import NUMBER, SERIES, TEXT, VECTOR, Field, list_of, optional, record

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
CORRECTION = record(
    "a mass that balances a shaft",
    Field("at", NUMBER, "place of its plane, m", lambda mass: mass[0].at),
    Field("size", NUMBER, "mass times radius, kg*m", lambda mass: abs(mass[1])),
    Field("angle", NUMBER, "rad", lambda mass: float(np.angle(mass[1]))),
)
BALANCING = record(
    "balancing",
    Field("pivot", TEXT, "moments are about this point; empty: about the origin"),
    Field("before", SHAKING, "at the positions"),
    Field("counterweights", list_of(COUNTERWEIGHT), "that leave the least force", "cycle.counterweights"),
    Field("after", SHAKING, "at the positions, with counterweights"),
    Field("left", NUMBER, "largest force over the cycle with counterweights, over that without", "cycle.left"),
    Field("rotor", list_of(CORRECTION), "masses on the shaft",
          lambda found: zip(found.task.rotor.planes, found.corrections.tolist(), strict=True),
          lambda found: found.task.rotor is not None),
)  # fmt: skip
