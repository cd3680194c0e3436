"""The four-bar ABCD (A, D on the frame; AB = l1, BC = l2, CD = l3, DA = l4): which links turn fully, transmission, and
its loop in a linkage.

A joint of a four-bar between links x and y, with z and w the others, turns fully when the distance that z and w must
bridge stays within their reach: x + y <= z + w and |x - y| >= |z - w|. The types are those of C. R. Barker, A complete
classification of planar four-bar linkages, Mechanism and Machine Theory 20 (1985): with the shortest link s and the
longest l, s + l less than the sum of the others (Grashof, by the shortest link), more (triple rockers, by the
longest), or the same (change points).
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

# In the order frame, input, coupler, output: by the shortest link, the longest, the shortest again.
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
POSITIONS_ONLY: Final = DriverMotion(0.0, 1.0, 0.0, 1)  # only places are asked for


@dataclass(frozen=True)
class FourBarLinks:
    """Lengths (m) of links 1 to 4 as they are joined round; frame, driver: numbers (1 to 4) of two adjacent ones."""

    l1: Any
    l2: Any
    l3: Any
    l4: Any
    frame: int = 4
    driver: int = 1

    @property
    def ordered(self) -> tuple[Any, Any, Any, Any]:
        """Frame, input, coupler, output."""
        links = (self.l1, self.l2, self.l3, self.l4)
        step = 1 if (self.driver - self.frame) % 4 == 1 else -1
        g, a, b, c = (links[(self.frame - 1 + step * k) % 4] for k in range(4))
        return g, a, b, c


@dataclass(frozen=True)
class FourBarType:
    """kind: number in TYPES, -1 where the links do not close; excess: (p + q) - (s + l), m: positive for Grashof.

    joints: whether those of frame-input, input-coupler, coupler-output, output-frame turn fully; turns: whether input,
    coupler, output turn fully against the frame (at change points: whether they can). Arrays, joints and turns with a
    last axis more.
    """

    kind: Any
    excess: Any
    joints: Any
    turns: Any


def classify_four_bar(links: FourBarLinks) -> FourBarType:
    """Type and turning links of four-bars."""
    lengths = np.stack(np.broadcast_arrays(*links.ordered), axis=-1)
    total = lengths.sum(-1)
    same = SAME_RATIO * total
    order = np.argsort(lengths, axis=-1, kind="stable")
    ranked = np.take_along_axis(lengths, order, axis=-1)
    excess = (ranked[..., 2] - ranked[..., 3]) + (ranked[..., 1] - ranked[..., 0])
    shortest, longest = order[..., 0], order[..., 3]
    equal = np.abs(np.diff(ranked, axis=-1)) <= same[..., None]
    change = np.abs(excess) <= same
    pairs = equal[..., 0] & equal[..., 2]  # at a change point one pair of equal links brings the other
    kind = np.where(excess > 0, shortest, 4 + longest)
    kind = np.where(change, np.where(pairs, np.where(equal[..., 1], 13, 12), FIRST_CHANGE_POINT + shortest), kind)
    kind = np.where(2 * ranked[..., 3] >= total - same, -1, kind)
    joints = []
    for k in range(4):
        x, y, z, w = (lengths[..., (k + i) % 4] for i in range(4))
        joints.append((x + y <= z + w + same) & (np.abs(x - y) >= np.abs(z - w) - same) & (kind >= 0))
    a, b, c, d = joints
    # full turns in both joints on the way from the frame to the coupler take each other away
    excess = np.where(change, 0.0, excess)[()]  # zero but for rounding
    return FourBarType(kind, excess, np.stack(joints, -1), np.stack([a, (a ^ b) | (c ^ d), d], -1))


def cosine_bcd(l2: Any, l3: Any, square: Any) -> Any:
    """Of the angle BCD, from the square of BD; the transmission angle is BCD, or what it lacks of two right angles."""
    return (l2 * l2 + l3 * l3 - square) / (2 * l2 * l3)


def extreme_cosine(lengths: tuple[Any, Any, Any, Any], low: Any, high: Any) -> tuple[Any, Any]:
    """The largest size of the cosine of BCD while AB turns from low to high (rad from AD), and the angle of AB there.

    lengths: l1 to l4. BD, and with it BCD, is extreme at both ends, and where B lies on AD.
    """
    l1, l2, l3, l4, low, high = (np.asarray(x)[..., None] for x in (*lengths, low, high))
    on_frame = np.pi * (np.ceil(low / np.pi) + np.arange(2))
    places = np.concatenate([low, high, np.where(on_frame <= high, on_frame, low)], axis=-1)
    sizes = np.abs(cosine_bcd(l2, l3, l1 * l1 + l4 * l4 - 2 * l1 * l4 * np.cos(places)))
    worst = np.argmax(sizes, axis=-1)[..., None]  # what is no number is the worst
    size, place = (np.take_along_axis(x, worst, axis=-1)[..., 0] for x in (sizes, places))
    return size, place


@dataclass(frozen=True)
class FourBarPins:
    """The four-bar in a linkage that the crank AB drives: names of its pins."""

    a: str
    b: str
    c: str
    d: str


def find_four_bar(linkage: Linkage) -> FourBarPins | None:
    """The four-bar that the crank drives; None where there is none."""
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
    """A, B, C, D (m) where AB stands at angles phi (rad) from AD; A, D single, B, C a place for each angle, nan where
    it cannot be assembled.
    """
    linkage, loop = results.linkage, find_four_bar(results.linkage)
    if loop is None or not results.kernels:
        return None
    frame, crank = linkage.links[FRAME].points, linkage.links[linkage.driver.link].points
    base = np.angle(frame[loop.d] - frame[loop.a]) - np.angle(crank[loop.b] - crank[loop.a])
    motion = compute_motion(linkage, results.kernels, np.atleast_1d(phi) + base, POSITIONS_ONLY, 0)
    return frame[loop.a], motion.spot(loop.b), motion.spot(loop.c), frame[loop.d]


def output_angles(results: Results, phi: Any, near: Any) -> Any:
    """Angles of DC from AD (rad) at those phi of AB, of all whole turns the one nearest to `near`."""
    found = pin_positions(results, phi)
    if found is None:
        return np.full(np.shape(near), np.nan)
    a, _, c, d = found
    return near + np.angle((c - d) / (d - a) * np.exp(-1j * np.asarray(near)))


def transmission_angle(phi: float, results: Results) -> float:
    """The transmission angle (rad, acute) where AB stands at phi from AD."""
    found = pin_positions(results, np.array([phi]))
    if found is None:
        return float("nan")
    _, b, c, d = found
    turned = ((c - b) * np.conj(c - d))[0]
    return float(np.arctan2(np.abs(turned.imag), np.abs(turned.real)))
