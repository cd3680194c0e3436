"""Type and transmission angle of a four-bar, and the search for a four-bar in a linkage.

The four-bar is ABCD with A and D on the frame: AB = l1, BC = l2, CD = l3, DA = l4. The joint between the adjacent links
x and y rotates fully if the other two links z and w can span every distance between its ends: x + y <= z + w and |x -
y| >= |z - w|. The types are from C. R. Barker, A complete classification of planar four-bar linkages, Mechanism and
Machine Theory 20 (1985). With the shortest link s and the longest link l, the sum s + l is compared with the sum of the
other two: smaller for Grashof types (named by the shortest link), greater for triple rockers (named by the longest
link), equal for types with change points.
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
LEAST_USABLE: Final = np.radians(5)  # rad: with a smaller transmission angle a mechanism does not move under load
POSITIONS_ONLY: Final = DriverMotion(0.0, 1.0, 0.0, 1)  # only positions are required


@dataclass(frozen=True)
class FourBarLinks:
    """Link lengths of a four-bar, with the choice of the frame and of the driver.

    Attributes:
        l1, l2, l3, l4: lengths (m) in the order in which the links are connected; numbers or arrays of one shape.
        frame, driver: numbers (1 to 4) of the frame and of the driver, which must be adjacent.
    """

    l1: Any
    l2: Any
    l3: Any
    l4: Any
    frame: int = 4
    driver: int = 1

    @property
    def ordered(self) -> tuple[Any, Any, Any, Any]:
        """Lengths (m) of the frame, the input link, the coupler and the output link."""
        links = (self.l1, self.l2, self.l3, self.l4)
        step = 1 if (self.driver - self.frame) % 4 == 1 else -1
        g, a, b, c = (links[(self.frame - 1 + step * k) % 4] for k in range(4))
        return g, a, b, c


@dataclass(frozen=True)
class FourBarType:
    """Type of one or several four-bars, and the joints and links that rotate fully.

    Attributes:
        kind: index in FOUR_BAR_TYPES; -1 if the links do not form a closed loop.
        excess: (p + q) - (s + l), m, for the shortest link s, the longest l and the other two p, q; positive for
            Grashof types.
        joints: True for each joint that rotates fully, shape (..., 4): frame-input, input-coupler, coupler-output,
            output-frame.
        turns: True for each link that rotates fully relative to the frame, shape (..., 3): input link, coupler, output
            link. With change points True means that the link can rotate fully.
    """

    kind: Any
    excess: Any
    joints: Any
    turns: Any


def classify_four_bar(links: FourBarLinks) -> FourBarType:
    """Return the type of four-bars and which of their links rotate fully.

    Lengths that differ only by rounding count as equal.

    Args:
        links: lengths (m), numbers or arrays of one shape.

    Returns:
        Type after C. R. Barker (1985), excess of Grashof's condition (m), and the joints and links that rotate fully.
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
    """Return cos BCD by the law of cosines. The transmission angle is BCD or 180° - BCD.

    Args:
        l2, l3: lengths of BC and CD (m).
        square: square of the distance BD (m^2).
    """
    return (l2 * l2 + l3 * l3 - square) / (2 * l2 * l3)


def extreme_cosine(lengths: tuple[Any, Any, Any, Any], low: Any, high: Any) -> tuple[Any, Any]:
    """Return the largest |cos BCD| while AB rotates over a range, and the angle of AB at which it occurs (rad).

    The distance BD, and with it the angle BCD, has its extremes at the ends of the range and where B lies on the line
    AD.

    Args:
        lengths: l1 to l4 (m).
        low, high: limits of the angle of AB, measured from AD (rad).
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
    """Names of the hinges A, B, C, D of a four-bar whose crank AB drives a linkage."""

    a: str
    b: str
    c: str
    d: str


def find_four_bar(linkage: Linkage) -> FourBarPins | None:
    """Return the hinges of the four-bar that the crank of a linkage drives; None if there is no such four-bar."""
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
    """Return the positions of A, B, C and D (complex, m) at given angles of AB.

    Args:
        results: analysis of a linkage with a four-bar.
        phi: angles of AB, measured from AD (rad), shape (positions,).

    Returns:
        A and D as single points; B and C with shape (positions,), nan where the four-bar cannot be assembled. None if
        the linkage has no four-bar.
    """
    linkage, loop = results.linkage, find_four_bar(results.linkage)
    if loop is None or not results.kernels:
        return None
    frame, crank = linkage.links[FRAME].points, linkage.links[linkage.driver.link].points
    base = np.angle(frame[loop.d] - frame[loop.a]) - np.angle(crank[loop.b] - crank[loop.a])
    motion = compute_motion(linkage, results.kernels, np.atleast_1d(phi) + base, POSITIONS_ONLY, 0)
    return frame[loop.a], motion.spot(loop.b), motion.spot(loop.c), frame[loop.d]


def output_angles(results: Results, phi: Any, near: Any) -> Any:
    """Return the angles of DC, measured from AD, at given angles of AB (rad), shape (positions,); nan without a
    four-bar.

    Args:
        results: analysis of the linkage.
        phi: angles of AB, measured from AD (rad).
        near: expected angles of DC (rad). Full turns are added to bring each result closest to them.
    """
    pins = pin_positions(results, phi)
    if pins is None:
        return np.full(np.shape(near), np.nan)
    a, _, c, d = pins
    return near + np.angle((c - d) / (d - a) * np.exp(-1j * np.asarray(near)))


def transmission_angle(phi: float, results: Results) -> float:
    """Return the acute transmission angle (rad) at an angle of AB, measured from AD; nan if the linkage has no
    four-bar.
    """
    pins = pin_positions(results, np.array([phi]))
    if pins is None:
        return float("nan")
    _, b, c, d = pins
    turned = ((c - b) * np.conj(c - d))[0]
    return float(np.arctan2(np.abs(turned.imag), np.abs(turned.real)))
