"""After how many turns of the driver everything is back where it was: toothed wheels and further drivers take part."""

from __future__ import annotations

import math
from fractions import Fraction

from tmm_cli.linkage import Linkage

MOST = 60  # turns; a cycle that is longer is not a cycle for anybody who looks at it
TEETH = 500  # denominators of ratios that are looked for


def turns_of_cycle(linkage: Linkage) -> int | None:
    """Turns of the first driver in a cycle; None when there are more than anyone counts, or none at all."""
    turns = 1
    for mesh in linkage.meshes:
        if mesh.kind == "gear":
            turns = math.lcm(turns, _denominator(mesh.ratio) or MOST + 1)
    lead = linkage.driver
    for driver in linkage.others:
        if driver.kind != "turn" or not lead.rate or driver.acceleration or lead.acceleration:
            return None
        turns = math.lcm(turns, _denominator(driver.rate / lead.rate) or MOST + 1)
    return turns if turns <= MOST else None


def _denominator(ratio: float) -> int | None:
    near = Fraction(ratio).limit_denominator(TEETH)
    return near.denominator if abs(float(near) - ratio) <= 1e-12 * max(1.0, abs(ratio)) else None
