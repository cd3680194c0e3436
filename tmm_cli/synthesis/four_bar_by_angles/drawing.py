"""The construction of a four-bar by pairs of angles: all positions turned back to the first input."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_cli.language import N_
from tmm_cli.synthesis.construction import Arc, Construction, Segment, Spot, swept
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars


def construction(one: Bars, given_phi: Any, given_psi: Any, size: float) -> Construction:
    """All positions turned back about A to the first input: C1, C2', C3' ... lie on a circle about B1."""
    phi, psi = np.asarray(given_phi, float), np.asarray(given_psi, float)
    b, c = (np.asarray(x, dtype=complex) * size for x in one.pins(phi, psi))
    back = c * np.exp(-1j * (phi - phi[0]))
    a, d = 0j, complex(size)
    segments = [
        Segment(a, d, "axis", "l4"), Segment(a, complex(b[0]), "link", "l1"),
        Segment(complex(b[0]), complex(c[0]), "link", "l2"), Segment(d, complex(c[0]), "link", "l3"),
    ]  # fmt: skip
    spots = [Spot("A", a, "support"), Spot("D", d, "support"), Spot("B1", complex(b[0]), "hinge"),
             Spot("C1", complex(c[0]), "hinge")]  # fmt: skip
    arcs = [swept(complex(b[0]), back, "dashed", beyond=0.3)]
    for name, row, centre in (("C", c, d), ("B", b, a)):
        arcs.append(swept(centre, row))
        for k in range(1, len(row)):
            segments.append(Segment(centre, complex(row[k]), "thin"))
            spots.append(Spot(f"{name}{k + 1}", complex(row[k]), "dot"))
    before = complex(c[0])
    for k in range(1, len(back)):
        here = complex(back[k])
        arc = sorted((float(np.angle(c[k])), float(np.angle(c[k]) - phi[k] + phi[0])))
        arcs.append(Arc(a, float(abs(c[k])), arc[0], arc[1], "dashed"))
        segments += [Segment(before, here, "thin"), Segment((before + here) / 2, complex(b[0]), "dashed")]
        spots.append(Spot(f"C{k + 1}′", here, "dot"))
        before = here
    lengths = (("l1", float(abs(b[0]))), ("l2", float(abs(c[0] - b[0]))), ("l3", float(abs(c[0] - d))), ("l4", size))
    values = tuple((name, value, "length") for name, value in lengths)
    title = N_(
        "Pairs turned back about {A} to the first input: {B}1 is the centre of the circle through {C}1, {C}2′ ..."
    )
    note = N_("dashed: bisectors, and arcs {C}{C}′ about {A} by the input's turn back")
    return Construction(
        title, tuple(segments), tuple(arcs), tuple(spots), (note,), chain="four-bar", values=values
    )  # fmt: skip
