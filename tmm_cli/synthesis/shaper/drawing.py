"""Drawing of a crank shaper in its extreme positions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import Construction, Segment, Size, Spot
from tmm_cli.synthesis.slotted_lever.drawing import lever_parts
from tmm_cli.synthesis.slotted_lever.solver import Found as Lever

if TYPE_CHECKING:
    from tmm_cli.synthesis.shaper.solver import Found


def construction(f: Found) -> Construction:
    """The lever in its extreme positions, the guide midway in D's arc, the ram at both ends of its stroke; O at 0."""
    middle, half = np.pi / 2, float(f.theta) / 2
    lever = Lever(
        f.crank, f.frame, f.lever, 0j, complex(0, -float(f.frame)), middle + half, middle - half, f.theta, f.lever
    )
    segments, arcs, spots, angles = lever_parts(lever, "D")
    reach = float(f.rod * np.cos(f.pressure))
    d1, d2 = (spot.at for spot in spots[-2:])
    e1, e2 = (complex(d.real + reach, float(f.level)) for d in (d1, d2))
    stroke = abs(e2 - e1)
    ends = sorted((e1.real, e2.real))
    segments += [
        Segment(d1, e1, "link", "DE"), Segment(d2, e2, "link2", "DE"), Segment(d1, d2, "dashed"),
        Segment(complex(ends[0] - 0.12 * stroke, e1.imag), complex(ends[1] + 0.12 * stroke, e1.imag), "axis"),
    ]  # fmt: skip
    spots += [Spot("E1", e1, "slider"), Spot("E2", e2, "slider")]
    top = complex(0, float(f.lever) - float(f.frame))  # of D's arc
    sizes = (Size(e1, e2, "H", 1 + 0j), Size(lever.o, e2, "y", 1j))
    lengths = {"OA": f.crank, "OC": f.frame, "CD": f.lever, "DE": f.rod}
    return Construction(
        N_("Extreme positions of the shaper"), tuple(segments), tuple(arcs), tuple(spots),
        (N_("guide midway between {D}1{D}2 and the top of the arc"),), angles=tuple(angles), sizes=sizes,
        chain="shaper", wishes=((top,),),
        values=(*((name, float(value), "length") for name, value in lengths.items()), ("θ", float(f.theta), "angle")),
    )  # fmt: skip
