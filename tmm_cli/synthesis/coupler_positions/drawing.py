"""The construction of a coupler's guidance: positions, bisectors, pivots; Burmester's curves for four positions."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import Arc, Construction, Curve, Segment, Spot, Style, swept
from tmm_cli.synthesis.coupler_positions.burmester import Dyads, Poses
from tmm_cli.synthesis.coupler_positions.lines import frame, lines

CURVES: Final[tuple[tuple[Style, str], ...]] = (("bold", "m"), ("dashed", "k1"))  # centre points, circle points
TITLES: Final = (  # by how many pivots were given
    N_("Pivots on the bisectors of the places of the pins"),
    N_("Pivot on the bisectors of the places of its pin; pin on those of its pivot, seen from the coupler"),
    N_("Pins on the bisectors of the places of the pivots, seen from the coupler in position 1"),
)
BY_PIN: Final = N_("dashed: bisectors of the places of the pin")
BY_PIVOT: Final = N_("dashed: bisectors of the pivot and its places ′, turned back with the coupler to position 1")


def construction(
    poses: Poses, one: Dyads, other: Dyads, by_pivot: tuple[bool, bool] = (False, False)
) -> tuple[Construction, ...]:
    """The four-bar in its first position, the others thin, arcs of pins, and how its dyads were found.

    by_pivot: of each dyad, whether its pivot was given: then the pivot's places seen from the plane in position 1 lie
    on a circle about its pin (inversion). Else the places of its pin lie on a circle about its pivot. With four
    positions the curves, near the mechanism and on a sheet of their own.
    """
    rows = [(np.asarray(poses.on_frame(x.pin), complex), complex(x.pivot)) for x in (one, other)]
    count = len(poses.places)
    segments: list[Segment] = []
    spots: list[Spot] = []
    arcs: list[Arc] = []
    for k, (name, pin) in enumerate((("A", "B"), ("D", "C"))):
        dyad, inverted = (one, other)[k], by_pivot[k]
        places, pivot = rows[k]
        first = complex(places[0])
        arcs.append(swept(pivot, places))
        segments.append(Segment(pivot, first, "link", "l1" if name == "A" else "l3"))
        spots += [Spot(name, pivot, "support"), Spot(f"{pin}1", first, "hinge")]
        spots += [Spot(f"{pin}{n + 1}", complex(places[n]), "dot") for n in range(1, count)]
        if count == 4:
            continue
        row, centre = [complex(z) for z in places], pivot
        if inverted:
            local = np.asarray(poses.in_plane(dyad.pivot), complex)
            row, centre = [complex(z) for z in np.asarray(poses.on_frame(local), complex)[:, 0]], first
            arcs.append(swept(centre, np.array(row), "dashed"))
            spots += [Spot(f"{name}{n + 1}′", row[n], "dot") for n in range(1, count)]
        for before, here in pairwise(row):
            segments += [Segment(before, here, "thin"), Segment((before + here) / 2, centre, "dashed")]
    (b, a), (c, d) = rows
    segments += [Segment(a, d, "axis", "l4"), Segment(complex(b[0]), complex(c[0]), "link", "l2")]
    for k in range(count):
        p = complex(poses.places[k])
        if k:
            segments.append(Segment(complex(b[k]), complex(c[k]), "link2"))
        segments += [Segment(complex(b[k]), p, "thin"), Segment(p, complex(c[k]), "thin")]
        spots.append(Spot(f"P{k + 1}", p, "dot"))
    values = tuple(
        (name, float(abs(z)), "length")
        for name, z in (("l1", b[0] - a), ("l2", c[0] - b[0]), ("l3", c[0] - d), ("l4", d - a))
    )
    if count < 4:
        notes = sorted({BY_PIVOT if given else BY_PIN for given in by_pivot})
        return (Construction(TITLES[sum(by_pivot)], tuple(segments), tuple(arcs), tuple(spots), tuple(notes),
                             chain="four-bar", values=values),)  # fmt: skip
    found = lines(poses, [s.at for s in spots])
    curves = tuple(Curve(line, *kind) for kind, row in zip(CURVES, found, strict=True) for line in row)
    note = N_("red: centre points m (pivots); dashed: circle points k1 (pins), in position 1")
    near = Construction(
        N_("Four positions: pivots on the centre-point curve, pins on the circle-point curve"), tuple(segments),
        tuple(arcs), tuple(spots), (note,), curves, chain="four-bar", values=values,
    )  # fmt: skip
    few = [s for s in spots if s.name in ("A", "D", "B1", "C1")]
    links = [s for s in segments if s.style == "link"]
    wide = Construction(
        N_("Centre-point curve and circle-point curve of the four positions (Burmester)"), tuple(links), (), tuple(few),
        (note,), curves, "curves", chain="four-bar",
        around=frame([s.at for s in few], [line for row in found for line in row]),
    )  # fmt: skip
    return near, wide
