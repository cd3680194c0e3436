"""The four-bar ABCD (A, D on the frame; AB = l1, BC = l2, CD = l3, DA = l4): type, transmission angle, and the four-bar
loop of a linkage.

A joint between adjacent links x and y of a four-bar, z and w being the other two, rotates fully if the distance that z
and w must span stays within their reach: x + y <= z + w and |x - y| >= |z - w|. The types are those of C. R. Barker, A
complete classification of planar four-bar linkages, Mechanism and Machine Theory 20 (1985): with the shortest link s
and the longest link l, s + l is less than the sum of the others (Grashof types, by the shortest link), greater (triple
rockers, by the longest link) or equal to it (change points).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import SAME_RATIO

# Links in the order frame, input, coupler, output. Indexed by the shortest link, then the longest, then the shortest.
FOUR_BAR_TYPES: Final = (
    "GCCC",
    "GCRR",
    "GRCR",
    "GRRC",
    "RRR1",
    "RRR2",
    "RRR3",
    "RRR4",
    "SCCC",
    "SCRR",
    "SRCR",
    "SRRC",
    "S2X",
    "S3X",
)
FIRST_CHANGE_POINT: Final = 8  # the first type with change points
POSITIONS_ONLY: Final = DriverMotion(0.0, 1.0, 0.0, 1)  # only positions are required


@dataclass(frozen=True)
class FourBarLinks:
    """Lengths (m) of links 1 to 4 in the order of connection; frame, driver: numbers (1 to 4) of two adjacent links."""

    l1: Any
    l2: Any
    l3: Any
    l4: Any
    frame: int = 4
    driver: int = 1

    @property
    def ordered(self) -> tuple[Any, Any, Any, Any]:
        """Lengths of frame, input link, coupler and output link."""
        links = (self.l1, self.l2, self.l3, self.l4)
        step = 1 if (self.driver - self.frame) % 4 == 1 else -1
        g, a, b, c = (links[(self.frame - 1 + step * k) % 4] for k in range(4))
        return g, a, b, c


@dataclass(frozen=True)
class FourBarType:
    """Type of four-bars and mobility of their links; arrays, `joints` and `turns` with one more axis at the end.

    Attributes:
        kind: index in FOUR_BAR_TYPES; -1 if the links do not close.
        excess: (p + q) - (s + l), m: positive for Grashof linkages.
        joints: True for each of the joints frame-input, input-coupler, coupler-output, output-frame that rotates fully.
        turns: True for each of input, coupler, output that rotates fully relative to the frame (with change points:
            that it can do so).
    """

    kind: Any
    excess: Any
    joints: Any
    turns: Any


def classify_four_bar(links: FourBarLinks) -> FourBarType:
    """Return the type of four-bars and which of their links rotate fully.

    Args:
        links: lengths (m), numbers or arrays of one shape.

    Returns:
        Type (C. R. Barker 1985), excess of Grashof's condition, joints and links that rotate fully. Lengths that differ
            only
        by rounding count as equal.
    """
    lengths = np.stack(np.broadcast_arrays(*links.ordered), axis=-1)
    total = lengths.sum(-1)
    same = SAME_RATIO * total
    order = np.argsort(lengths, axis=-1, kind="stable")
    ranked = np.take_along_axis(lengths, order, axis=-1)
    excess = (ranked[..., 2] - ranked[..., 3]) + (ranked[..., 1] - ranked[..., 0])
    shortest, longest = order[..., 0], order[..., 3]
    equal = np.abs(np.diff(ranked, axis=-1)) <= same[..., None]
    change = np.abs(excess) <= same
    pairs = equal[..., 0] & equal[..., 2]  # at a change point one pair of equal links implies the other
    kind = np.where(excess > 0, shortest, 4 + longest)
    kind = np.where(change, np.where(pairs, np.where(equal[..., 1], 13, 12), FIRST_CHANGE_POINT + shortest), kind)
    kind = np.where(2 * ranked[..., 3] >= total - same, -1, kind)
    joints = []
    for k in range(4):
        x, y, z, w = (lengths[..., (k + i) % 4] for i in range(4))
        joints.append((x + y <= z + w + same) & (np.abs(x - y) >= np.abs(z - w) - same) & (kind >= 0))
    a, b, c, d = joints
    # full rotations in both joints between frame and coupler cancel each other
    excess = np.where(change, 0.0, excess)[()]  # differs from zero by rounding only
    return FourBarType(kind, excess, np.stack(joints, -1), np.stack([a, (a ^ b) | (c ^ d), d], -1))


def cosine_bcd(l2: Any, l3: Any, square: Any) -> Any:
    """Return the cosine of the angle BCD from the square of BD. The transmission angle is BCD or 180° - BCD."""
    return (l2 * l2 + l3 * l3 - square) / (2 * l2 * l3)


def extreme_cosine(lengths: tuple[Any, Any, Any, Any], low: Any, high: Any) -> tuple[Any, Any]:
    """Return the largest |cos BCD| while AB rotates from `low` to `high` (rad from AD), and the angle of AB there.

    lengths: l1 to l4. BD, and with it BCD, is extreme at both ends and where B lies on the line AD.
    """
    l1, l2, l3, l4, low, high = (np.asarray(x)[..., None] for x in (*lengths, low, high))
    on_frame = np.pi * (np.ceil(low / np.pi) + np.arange(2))
    angles = np.concatenate([low, high, np.where(on_frame <= high, on_frame, low)], axis=-1)
    cosines = np.abs(cosine_bcd(l2, l3, l1 * l1 + l4 * l4 - 2 * l1 * l4 * np.cos(angles)))
    worst = np.argmax(cosines, axis=-1)[..., None]  # nan counts as the worst
    largest, angle = (np.take_along_axis(x, worst, axis=-1)[..., 0] for x in (cosines, angles))
    return largest, angle


@dataclass(frozen=True)
class FourBarPins:
    """Names of the pins of a four-bar in a linkage whose crank AB is the driver."""

    a: str
    b: str
    c: str
    d: str


def find_four_bar(linkage: Linkage) -> FourBarPins | None:
    """Find the four-bar that the crank of a linkage drives; None if there is none."""
    crank = linkage.driver.link
    a = linkage.shared(FRAME, crank)
    if a is None or linkage.driver.kind != "turn":
        return None
    for coupler in linkage.moving:
        b = linkage.shared(crank, coupler)
        for output in linkage.moving if b is not None and coupler != crank else ():
            c, d = linkage.shared(coupler, output), linkage.shared(FRAME, output)
            if output not in (crank, coupler) and b is not None and c is not None and d is not None:
                return FourBarPins(a, b, c, d)
    return None


def pin_positions(results: Results, phi: Any) -> tuple[Any, Any, Any, Any] | None:
    """Return A, B, C, D (m, complex) for angles phi (rad) of AB from AD; None if the linkage has no four-bar.

    A and D are single points; B and C have one point for each angle, nan if the four-bar cannot be assembled there.
    """
    linkage, loop = results.linkage, find_four_bar(results.linkage)
    if loop is None or not results.kernels:
        return None
    frame, crank = linkage.links[FRAME].points, linkage.links[linkage.driver.link].points
    base = np.angle(frame[loop.d] - frame[loop.a]) - np.angle(crank[loop.b] - crank[loop.a])
    motion = compute_motion(linkage, results.kernels, np.atleast_1d(phi) + base, POSITIONS_ONLY, 0)
    return frame[loop.a], motion.spot(loop.b), motion.spot(loop.c), frame[loop.d]


def output_angles(results: Results, phi: Any, near: Any) -> Any:
    """Return the angles of DC from AD (rad) at angles phi of AB, plus the whole turns that bring them nearest to
    `near`.
    """
    pins = pin_positions(results, phi)
    if pins is None:
        return np.full(np.shape(near), np.nan)
    a, _, c, d = pins
    return near + np.angle((c - d) / (d - a) * np.exp(-1j * np.asarray(near)))


def transmission_angle(phi: float, results: Results) -> float:
    """Return the transmission angle (rad, acute) at the angle phi of AB from AD."""
    pins = pin_positions(results, np.array([phi]))
    if pins is None:
        return float("nan")
    _, b, c, d = pins
    turned = ((c - b) * np.conj(c - d))[0]
    return float(np.arctan2(np.abs(turned.imag), np.abs(turned.real)))
