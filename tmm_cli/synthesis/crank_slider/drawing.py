"""Drawing of a crank-slider from its stroke: its extreme positions and where the crank's pivot may be."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import Angle, Arc, Centre, Construction, Segment, Size, Spot, box, circle

if TYPE_CHECKING:
    from tmm_cli.synthesis.crank_slider.solver import Found

DRAWN: Final = 0.01  # rad: the least theta that shows on a drawing


def construction(found: Found) -> Construction:
    """The extreme positions, and the circle on which B1B2 is seen under theta, with O on it at the distance e.

    B1 is the far extreme position (the rod in line with the crank), B2 the near one; the crank's pivot O is the origin.
    It may be on the circle from B2 to the place over B2, where e = H cot(theta).
    """
    r, l, e, height, theta = (float(getattr(found, n)) for n in ("r", "l", "e", "stroke", "theta"))  # noqa: E741
    near, far = (float(np.sqrt((x - e) * (x + e))) for x in (l - r, l + r))
    o, b1, b2 = 0j, complex(far, -e), complex(near, -e)
    pin1, pin2 = r * b1 / abs(b1), -r * b2 / abs(b2)
    segments = [
        Segment(complex(near - 0.12 * height, -e), complex(far + 0.12 * height, -e), "axis"),
        Segment(o, pin1, "link", "r"), Segment(pin1, b1, "link", "l"),
        Segment(pin2, o, "link2", "r"), Segment(o, b2, "link2", "l − r"),
    ]  # fmt: skip
    arcs = [circle(o, r)]
    spots = [
        Spot("O", o, "support"), Spot("A1", pin1, "hinge"), Spot("A2", pin2, "hinge"),
        Spot("B1", b1, "slider"), Spot("B2", b2, "slider"),
    ]  # fmt: skip
    sizes = (Size(b2, b1, "H", 1 + 0j), *((Size(o, b2, "e", 1j),) if e > 0 else ()))
    plain = Construction(
        N_("Extreme positions of the slider"), tuple(segments), tuple(arcs), tuple(spots), sizes=sizes,
        wishes=(box(o, r),), chain="crank-slider", values=(("r", r, "length"), ("l", l, "length")),
    )  # fmt: skip
    if not theta > DRAWN:
        return plain
    middle, radius = (b1 + b2) / 2, height / 2 / float(np.sin(theta))
    centre = middle + 1j * height / 2 / np.tan(theta)
    over, first = complex(near, 2 * centre.imag + e), float(np.angle(b1 - centre))
    start, end = (first + float(np.mod(np.angle(z - centre) - first, 2 * np.pi)) for z in (over, b2))
    arcs += [Arc(centre, radius, first, first + 2 * np.pi, "dashed"), Arc(centre, radius, start, end, "bold")]
    return replace(
        plain,
        title=N_("Extreme positions of the slider, and the circle on which {B}1{B}2 is seen under theta"),
        segments=(*segments, Segment(b1, b2, "thin")), arcs=tuple(arcs),
        angles=(Angle(o, b1, b2, "θ"), Angle(b1, b2, centre, "90° − θ"), Angle(b2, b1, centre, "90° − θ")),
        centres=(Centre(centre, radius, (b1, b2)),), wishes=(box(o, r), (centre,), box(centre, radius)),
        values=(*plain.values, ("θ", theta, "angle")),
        notes=(N_("red: where {O} may be, so that the crank turns fully"), N_("{M}{B}1{B}2 = {M}{B}2{B}1 = 90° − θ")),
    )  # fmt: skip
