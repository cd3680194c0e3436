"""Drawings of a four-bar found from positions of its coupler: construction of the dyads, Burmester's curves."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import (
    Arc,
    ConstructionCurve,
    GeometricConstruction,
    LetteredPoint,
    Segment,
    Style,
    swept_arc,
)
from tmm_cli.synthesis.coupler_positions.burmester import CouplerPoses, Dyads
from tmm_cli.synthesis.coupler_positions.curve import burmester_lines, sheet_extent

CURVES: Final[tuple[tuple[Style, str], ...]] = (("bold", "m"), ("dashed", "k1"))  # centre points, circle points
TITLES: Final = (  # by the number of given pivots
    N_("Pivots on the perpendicular bisectors between the pin positions"),
    N_(
        "One pivot on the perpendicular bisectors between its pin positions; one pin on those between its "
        "pivot positions relative to the coupler"
    ),
    N_("Pins on the perpendicular bisectors between the pivot positions relative to the coupler in position 1"),
)
BY_PIN: Final = N_("dashed: perpendicular bisectors between the pin positions")
BY_PIVOT: Final = N_(
    "dashed: perpendicular bisectors between the pivot and its positions ′, which are rotated back "
    "with the coupler to position 1"
)


def draw_construction(
    poses: CouplerPoses, ab_dyad: Dyads, dc_dyad: Dyads, by_pivot: tuple[bool, bool] = (False, False)
) -> tuple[GeometricConstruction, ...]:
    """Draw the four-bar in position 1, the other positions in thin lines, the arcs of the pins, and the
    construction.

    If the pivot of a dyad is given, its positions relative to the coupler in position 1 lie on a circle about the pin
    (inversion). Otherwise the positions of the pin lie on a circle about the pivot. With four positions Burmester's
    curves are drawn near the mechanism, and as a whole on a second sheet.

    Args:
        poses: required positions of the coupler.
        ab_dyad, dc_dyad: dyads AB and DC.
        by_pivot: for each dyad, True if its pivot is given.
    """
    rows = [(np.asarray(poses.on_frame(x.pin), complex), complex(x.pivot)) for x in (ab_dyad, dc_dyad)]
    count = len(poses.places)
    segments: list[Segment] = []
    spots: list[LetteredPoint] = []
    arcs: list[Arc] = []
    for k, (name, pin) in enumerate((("A", "B"), ("D", "C"))):
        dyad, inverted = (ab_dyad, dc_dyad)[k], by_pivot[k]
        pin_points, pivot = rows[k]
        first = complex(pin_points[0])
        arcs.append(swept_arc(pivot, pin_points))
        segments.append(Segment(pivot, first, "link", "l1" if name == "A" else "l3"))
        spots += [LetteredPoint(name, pivot, "support"), LetteredPoint(f"{pin}1", first, "hinge")]
        spots += [LetteredPoint(f"{pin}{n + 1}", complex(pin_points[n]), "dot") for n in range(1, count)]
        if count == 4:
            continue
        row, centre = [complex(z) for z in pin_points], pivot
        if inverted:
            local = np.asarray(poses.in_plane(dyad.pivot), complex)
            row, centre = [complex(z) for z in np.asarray(poses.on_frame(local), complex)[:, 0]], first
            arcs.append(swept_arc(centre, np.array(row), "dashed"))
            spots += [LetteredPoint(f"{name}{n + 1}′", row[n], "dot") for n in range(1, count)]
        for before, point in pairwise(row):
            segments += [Segment(before, point, "thin"), Segment((before + point) / 2, centre, "dashed")]
    (b, a), (c, d) = rows
    segments += [Segment(a, d, "axis", "l4"), Segment(complex(b[0]), complex(c[0]), "link", "l2")]
    for k in range(count):
        p = complex(poses.places[k])
        if k:
            segments.append(Segment(complex(b[k]), complex(c[k]), "link2"))
        segments += [Segment(complex(b[k]), p, "thin"), Segment(p, complex(c[k]), "thin")]
        spots.append(LetteredPoint(f"P{k + 1}", p, "dot"))
    values = tuple(
        (name, float(abs(z)), "length")
        for name, z in (("l1", b[0] - a), ("l2", c[0] - b[0]), ("l3", c[0] - d), ("l4", d - a))
    )
    if count < 4:
        notes = sorted({BY_PIVOT if pivot_given else BY_PIN for pivot_given in by_pivot})
        return (
            GeometricConstruction(
                TITLES[sum(by_pivot)],
                tuple(segments),
                tuple(arcs),
                tuple(spots),
                tuple(notes),
                chain="four-bar",
                values=values,
            ),
        )
    curve_lines = burmester_lines(poses, [s.at for s in spots])
    curves = tuple(
        ConstructionCurve(line, *kind) for kind, row in zip(CURVES, curve_lines, strict=True) for line in row
    )
    note = N_("red: centre-point curve m (pivots); dashed: circle-point curve k1 (pins), in position 1")
    near = GeometricConstruction(
        N_("Four positions: pivots on the centre-point curve, pins on the circle-point curve"),
        tuple(segments),
        tuple(arcs),
        tuple(spots),
        (note,),
        curves,
        chain="four-bar",
        values=values,
    )
    few = [s for s in spots if s.name in ("A", "D", "B1", "C1")]
    links = [s for s in segments if s.style == "link"]
    wide = GeometricConstruction(
        N_("Centre-point curve and circle-point curve of the four positions (Burmester)"),
        tuple(links),
        (),
        tuple(few),
        (note,),
        curves,
        "curves",
        chain="four-bar",
        around=sheet_extent([s.at for s in few], [line for row in curve_lines for line in row]),
    )
    return near, wide
