"""Chains of dyads of any length, for measuring how time grows with the number of links."""

from __future__ import annotations

import cmath

from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Linkage, Sketch

CRANK, COUPLER, ROCKER, BEYOND = 0.04, 0.3, 0.2, 0.9  # m; the next coupler hangs at that share of its rocker's length
AT = 1.0  # rad, the crank in the sketch


def chain(dyads: int) -> Linkage:
    """A crank and so many RRR groups, each on the rocker of the one before it: 2 dyads + 1 moving links."""
    links = {FRAME: Link(FRAME, {"O": 0j}), "1": Link("1", {"O": 0j, "P0": CRANK + 0j}, 0.5, 1e-4, CRANK / 2 + 0j)}
    hinges = [Hinge("O", (FRAME, "1"))]
    points: dict[str, complex] = {"P0": CRANK * cmath.exp(1j * AT)}
    angles = {"1": AT}
    before, hung = "1", points["P0"]
    for k in range(1, dyads + 1):
        coupler, rocker = str(2 * k), str(2 * k + 1)
        b = hung + COUPLER * cmath.exp(0.3j)
        d = b - ROCKER * cmath.exp(1.6j)
        links[FRAME].points[f"D{k}"] = d  # type: ignore[index]
        links[coupler] = Link(coupler, {f"P{k - 1}": 0j, f"B{k}": COUPLER + 0j}, 1.0, 0.01, COUPLER / 2 + 0j)
        links[rocker] = Link(
            rocker, {f"D{k}": 0j, f"B{k}": ROCKER + 0j, f"P{k}": BEYOND * ROCKER * cmath.exp(-0.2j)}, 1.0, 0.01,
            ROCKER / 2 + 0j,
        )  # fmt: skip
        hinges += [
            Hinge(f"P{k - 1}", (before, coupler)),
            Hinge(f"B{k}", (coupler, rocker)),
            Hinge(f"D{k}", (FRAME, rocker)),
        ]
        hung = d + BEYOND * ROCKER * cmath.exp(1.4j)
        points |= {f"B{k}": b, f"P{k}": hung}
        angles |= {coupler: 0.3, rocker: 1.6}
        before = rocker
    driver = Driver("1", "turn", "O", 10.0, 0.0, 1)
    return Linkage(links, tuple(hinges), (), driver, Sketch(AT, points, angles))
