"""Arcs of the crank pivot A for four-bars with a given k and given extreme positions DC1, DC2 of the rocker.

From A the segment C1C2 = 2 h is seen at the angle theta = pi (k - 1)/(k + 1), so A lies on one of two arcs of equal
circles: on the same side of C1C2 as D, or on the other side. Let beta be the angle AC2C1. The ratio w = l2/h serves as
a coordinate along the arc, because it remains regular at theta = 0:
    sin(beta + theta/2) = w sin(theta/2),
    l1 = (AC2 - AC1)/2 = h cos(beta + theta/2)/cos(theta/2),  l2 = AC2 - l1 = w h.
The triangles AC1D and AC2D ensure that the crank rotates fully. Both positions belong to one motion if C1 and C2 lie on
the same side of AD, so that the rocker does not pass its dead position. AC2 > AC1 determines the order of the
positions:
    0 < beta < pi/2 - psi/2 - theta on the other side of C1C2,
    0 < beta < pi/2 - |psi/2 - theta/2| - theta/2 on the side of D.
Along each arc l4 = AD is monotonic, as the nearest and the farthest point of a circle lie on the line through its
centre. The length l2 increases from h, and l1 decreases from h (with k = 1 it equals h everywhere).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.mechanics.numerics import unit, zero_within_rounding
from tmm_cli.synthesis.four_bar import cosine_bcd as cosine_of
from tmm_cli.synthesis.measures import theta_of

SIDES: Final = (-1, 1)  # the arc on D's side of C1C2, the arc beyond
END_MARGIN: Final = 1e-9  # fraction of an arc: distance from its ends at which the search starts
SHORTEST_ARC: Final = (
    2e-3  # rad: on a shorter arc the rocker is so close to a dead position that k is not determined to 1e-9
)
SLACK: Final = 1 - 1e-9  # relative, for rounding
LINE: Final = 50.0  # l2 over half C1C2: how far the straight line of k = 1 is tabulated
STRAIGHT: Final = 1e-9  # rad: for a smaller theta, pivots are spaced by w alone
FARTHEST: Final = 1e6  # l2 over half C1C2: limit for a straight arc


@dataclass(frozen=True)
class FourBarByKTask:
    """Given quantities of a four-bar with a given time ratio k.

    Attributes:
        l3: length of the rocker DC (m).
        psi1: rocker angle at which the coupler overlaps the crank (rad).
        psi2: rocker angle at which crank and coupler are in line (rad).
        k: time ratio.
        support: pivot D of the rocker (complex, m).
        choose: condition for the crank pivot A: `best` (smallest value of the largest pressure angle), `level` (A as
            high as D), `near` (nearest to a point), or the name of the quantity given: l1, l2, l4, xA, yA or pressure.
        l1, l2, l4, pressure, near, xA, yA: value for this condition (m, rad; `near` is complex).
        sense: sense of rotation of the crank in the slow stroke from psi1 to psi2: 1 counterclockwise, -1 clockwise, 0
            any.
    """

    l3: Any
    psi1: Any
    psi2: Any
    k: Any
    support: Any = 0j
    choose: str = "best"
    l1: Any = None
    l2: Any = None
    l4: Any = None
    pressure: Any = None
    near: Any = None
    xA: Any = None  # noqa: N815  as files call it
    yA: Any = None  # noqa: N815
    sense: int = 0

    @property
    def swing(self) -> Any:
        return np.abs(np.asarray(self.psi2) - self.psi1)

    @property
    def theta(self) -> Any:
        return theta_of(self.k)


@dataclass(frozen=True)
class FourBarByKSolution:
    """A four-bar with its crank pivot A on one of the arcs; floats or arrays.

    Attributes:
        w: coordinate along the arc, l2 divided by half of C1C2.
        side: -1 if A lies on the same side of C1C2 as D, 1 if on the other side.
        l1, l2, l4: lengths of crank, coupler and frame (m).
        a: pivot A (complex, m).
        slope: derivative of `a` with respect to w (complex, m).
        pressure: largest pressure angle (rad).
        beta: angle AC2C1 (rad).
        sense: sense of rotation of the crank in the slow stroke from psi1 to psi2: 1 counterclockwise, -1 clockwise.
    """

    w: Any
    side: Any
    l1: Any
    l2: Any
    l4: Any
    a: Any
    slope: Any
    pressure: Any
    beta: Any
    sense: Any


def largest_beta(task: FourBarByKTask, side: Any) -> Any:
    """Return the upper limit of the angle beta = AC2C1 (rad) on an arc; negative if the arc has no admissible pivot."""
    half, theta = task.swing / 2, task.theta
    return np.where(np.asarray(side) > 0, np.pi / 2 - half - theta, np.pi / 2 - np.abs(half - theta / 2) - theta / 2)


def largest_w(task: FourBarByKTask, side: Any) -> Any:
    """Return the upper limit of the coordinate w = l2/h along an arc with admissible pivots, where h is half of
    C1C2.
    """
    sine = np.sin(task.theta / 2)
    most = np.sin(largest_beta(task, side) + task.theta / 2) / np.where(sine > 0, sine, 1.0)
    return np.where(sine > 0, np.minimum(most, FARTHEST), FARTHEST)


def four_bar_at(task: FourBarByKTask, w: Any, side: Any) -> FourBarByKSolution:
    """Compute the four-bar whose crank pivot A has the coordinate w on an arc.

    Args:
        task: given quantities.
        w: coordinate along the arc, at least 1; number or array.
        side: arc, -1 on the same side of C1C2 as D, 1 on the other side.
    """
    half, theta, l3 = task.swing / 2, task.theta, task.l3
    h, s, c = l3 * np.sin(half), np.sin(theta / 2), np.cos(theta / 2)
    sine = w * s
    cosine = np.sqrt((1 - sine) * (1 + sine))
    l1, l2 = h * cosine / c, h * w
    turn = c * cosine + s * sine + 1j * side * s * (w * c - cosine)  # e^(i beta), with the sign of the side
    local = l3 * np.cos(half) + 1j * h - 1j * (l1 + l2) * turn  # D at 0, bisector of the swing along x, C1 below
    slope = -1j * (cosine + 1j * side * sine) ** 2 * h / (c * cosine)
    l4 = np.abs(local)
    sines = [np.abs(cosine_of(l2, l3, (l4 + sign * l1) ** 2)) for sign in (-1, 1)]  # where A, B and D are in line
    sense = np.where(np.asarray(task.psi2) > task.psi1, 1, -1)
    middle = (np.asarray(task.psi1) + task.psi2) / 2
    frame = unit(middle)
    a, slope = ((np.where(sense > 0, z, np.conj(z)) * frame)[()] for z in (local, slope))
    a = zero_within_rounding(task.support + a, l4 + np.abs(task.support))
    return FourBarByKSolution(
        w,
        side,
        l1,
        l2,
        l4,
        a,
        slope,
        np.arcsin(np.minimum(np.maximum(*sines), 1)),
        np.arctan2(s * (w * c - cosine), c * cosine + s * sine),
        -side * sense,
    )


def admissible_arcs(task: FourBarByKTask) -> list[int]:
    """Return the sides (-1, 1) of the arcs that have admissible pivots.

    With k = 1 both arcs are the same straight line, and the result is [-1].
    """
    if task.k == 1:
        return [-1]
    sense = 1 if task.psi2 > task.psi1 else -1
    return [
        side for side in SIDES if largest_beta(task, side) >= SHORTEST_ARC * SLACK and task.sense in (0, -side * sense)
    ]


def sample_arc(task: FourBarByKTask, side: int, count: int = 400) -> Any:
    """Return coordinates w along an arc without its ends, more closely spaced where the mechanism changes fast."""
    theta, most = float(task.theta), float(largest_w(task, side))
    first = END_MARGIN * min(1.0, most - 1)
    samples = 1 + np.geomspace(first, most - 1, count)
    if theta > STRAIGHT:
        beta = float(largest_beta(task, side)) * np.linspace(END_MARGIN, 1 - END_MARGIN, count)
        by_angle = np.sin(beta + theta / 2) / np.sin(theta / 2)
        samples = np.unique(np.clip(np.concatenate((samples, by_angle)), 1 + first, most - END_MARGIN * (most - 1)))
    return samples


def sample_whole_arc(task: FourBarByKTask, side: int, count: int = 121) -> Any:
    """Return coordinates w along an arc with its ends, more closely spaced near them, where the pressure angle changes
    fast.

    The coordinates are evenly spaced both in the angle at C2 and in the logarithm of w, because on a nearly straight
    arc the angle hardly changes.
    """
    share = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    theta, most = float(task.theta), float(largest_w(task, side))
    if theta < STRAIGHT:
        return np.exp(share * np.log(LINE))
    by_angle = np.sin(share * float(largest_beta(task, side)) + theta / 2) / np.sin(theta / 2)
    return np.unique(np.clip(np.concatenate((by_angle, np.exp(share * np.log(most)))), 1.0, most))


def pivots_on_line(task: FourBarByKTask) -> list[Any]:
    """Return the coordinates w of the pivots A on a required horizontal or vertical line, admissible or not.

    With D as origin, A = t + i height with a real unknown t. The segment C1C2 is seen from A at the angle theta if z =
    conj(C1 - A)(C2 - A) satisfies sin(theta) Re z = +- cos(theta) Im z. This is a quadratic equation in t for each
    sign, as the line intersects each of the two circles twice. For a vertical line (given xA) the task is rotated by 90
    degrees.
    """
    l3, middle, half = task.l3, (task.psi1 + task.psi2) / 2, (task.psi2 - task.psi1) / 2
    sine, cosine = np.sin(task.theta), np.cos(task.theta)
    direction, height = unit(middle) * (1j if task.choose == "xA" else 1), line_offset(task)
    both, apart = 2 * l3 * np.cos(half) * direction, 2j * l3 * np.sin(half) * direction  # C1 + C2, C2 - C1
    real = l3 * l3 * np.cos(2 * half) + height * (height - both.imag)  # real and imaginary part of z at t = 0
    imag = l3 * l3 * np.sin(2 * half) + height * apart.real
    roots = []
    for sign in (-1, 1):
        a, b, c = sine, sign * cosine * apart.imag - sine * both.real, sine * real - sign * cosine * imag
        inner = b * b - 4 * a * c
        if inner >= 0:
            larger = -(b + np.copysign(np.sqrt(inner), b)) / 2
            roots += [larger / a] if a > 0 else []
            roots += [c / larger] if larger != 0 else []
    ends = ((both + sign * apart) / 2 - 1j * height for sign in (-1, 1))
    return list(sum(np.abs(end - np.array(roots)) for end in ends) / (2 * l3 * np.abs(np.sin(half))))


def line_offset(task: FourBarByKTask) -> Any:
    """Return the distance (m) of the required line from D: its height, or its horizontal distance if xA is given."""
    return task.xA if task.choose == "xA" else task.yA if task.choose == "yA" else 0.0
