"""Textbook formulas for one mechanism, as students type them in: a four-bar or a central crank-slider.

Only kinematics is computed. The angles follow from the law of cosines (two inverse cosines), or from the tangent of
half the angle by Freudenstein's equation. R. L. Norton, Design of Machinery, ch. 4 (4.5), 6 (6.7) and 7 (7.3); F.
Freudenstein, Trans. ASME 77 (1955).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.bench.methods.case import Case, MethodAnswers, UnsupportedLinkageError
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, cross, dot, unit

Angles = Callable[[Real, int], tuple[Real, Real]]


@dataclass(frozen=True)
class TextbookFourBar:
    """A four-bar for textbook formulas.

    Attributes:
        O, D: fixed pivots of the crank and the rocker, m.
        a, b, c: lengths of the crank OA, the coupler AB and the rocker DB, m.
        w: speed of the crank, rad/s.
    """

    O: complex  # noqa: E741
    D: complex
    a: float
    b: float
    c: float
    w: float

    def angles_by_cosines(self, q: Real, sign: int) -> tuple[Real, Real]:
        """Return the angles (rad) of coupler and rocker by the law of cosines.

        sign: 1 for the assembly with B to the left of AD, -1 for the other one.
        """
        base = self.D - self.O - self.a * unit(q)
        f = np.abs(base)
        at_a = np.arccos((self.b**2 + f**2 - self.c**2) / (2 * self.b * f))
        at_d = np.arccos((self.c**2 + f**2 - self.b**2) / (2 * self.c * f))
        along = np.angle(base)
        return along + sign * at_a, along + np.pi - sign * at_d

    def angles_by_freudenstein(self, q: Real, sign: int) -> tuple[Real, Real]:
        """Return the angles (rad) of coupler and rocker by Freudenstein's equation; sign 1: B to the left of AD.

        The constants K1 to K5 give two quadratic equations in the tangents of half the angles.
        """
        d, along = abs(self.D - self.O), np.angle(self.D - self.O)
        a, b, c, t = self.a, self.b, self.c, np.cos(q - along)
        k1, k2, k3 = d / a, d / c, (a * a - b * b + c * c + d * d) / (2 * a * c)
        k4, k5 = d / b, (c * c - d * d - a * a - b * b) / (2 * a * b)
        middle = -2 * np.sin(q - along)
        rocker = _half_angle(t - k1 - k2 * t + k3, middle, k1 - (k2 + 1) * t + k3, -sign)
        coupler = _half_angle(t - k1 + k4 * t + k5, middle, k1 + (k4 - 1) * t + k5, -sign)
        return along + coupler, along + rocker

    def solve_points(self, q: Real, angles: tuple[Real, Real]) -> MethodAnswers:
        """Return positions, velocities and accelerations of A and B from the angles of coupler and rocker, rad."""
        a, b, c, w = self.a, self.b, self.c, self.w
        three, four = angles
        w3 = a * w * np.sin(four - q) / (b * np.sin(three - four))
        w4 = a * w * np.sin(q - three) / (c * np.sin(four - three))
        A, B, E, F = c * np.sin(four), b * np.sin(three), b * np.cos(three), c * np.cos(four)
        C = a * w**2 * np.cos(q) + w3**2 * E - w4**2 * F
        G = -a * w**2 * np.sin(q) - w3**2 * B + w4**2 * A
        e4 = (C * E - B * G) / (A * E - B * F)
        crank, rocker = a * unit(q), c * unit(four)
        return MethodAnswers(
            {"A": self.O + crank, "B": self.D + rocker},
            {"A": 1j * w * crank, "B": 1j * w4 * rocker},
            {"A": -(w**2) * crank, "B": (1j * e4 - w4**2) * rocker},
        )


@dataclass(frozen=True)
class TextbookCrankSlider:
    """A central crank-slider for textbook formulas.

    Attributes:
        O: fixed pivot of the crank, m; the guide passes through it.
        a, b: lengths of the crank OA and the rod AB, m.
        along: direction of the guide, rad.
        w: speed of the crank, rad/s.
    """

    O: complex  # noqa: E741
    a: float
    b: float
    along: float
    w: float

    def angles_by_cosines(self, q: Real, sign: int) -> tuple[Real, Real]:
        """Return the angle of the rod (rad) by an inverse sine.

        It is returned twice, so that the result has the same form as that of a four-bar.
        """
        lean = np.arcsin(-self.a * np.sin(q - self.along) / self.b)
        rod = self.along + (lean if sign > 0 else np.pi - lean)
        return rod, rod

    def angles_by_freudenstein(self, q: Real, sign: int) -> tuple[Real, Real]:
        """Return the angle of the rod (rad) by the tangent of half the angle. It is returned twice, as for a four-bar.

        The tangent t follows from s t² - 2 t + s = 0, where s is the sine of the angle.
        """
        s = -self.a * np.sin(q - self.along) / self.b
        rod = self.along + _half_angle(s, -2 + 0 * s, s, -sign)
        return rod, rod

    def solve_points(self, q: Real, angles: tuple[Real, Real]) -> MethodAnswers:
        """Return positions, velocities and accelerations of A and B from the angle of the rod, rad.

        angles: angles as `angles_by_cosines` returns them; the first one is used.
        """
        a, b, w = self.a, self.b, self.w
        crank, rod = a * unit(q), b * unit(angles[0])
        unwrapped, lean = q - self.along, angles[0] - self.along
        w3 = -a * w * np.cos(unwrapped) / (b * np.cos(lean))
        e3 = (a * w**2 * np.sin(unwrapped) + b * w3**2 * np.sin(lean)) / (b * np.cos(lean))
        return MethodAnswers(
            {"A": self.O + crank, "B": self.O + crank + rod},
            {"A": 1j * w * crank, "B": 1j * w * crank + 1j * w3 * rod},
            {"A": -(w**2) * crank, "B": -(w**2) * crank + (1j * e3 - w3**2) * rod},
        )


def _half_angle(a: Real, b: Real, c: Real, sign: int) -> Real:
    """Return the angle 2 arctan t, where t is a root of a t² + b t + c = 0.

    sign: sign of the square root in the formula for the root.
    """
    angle: Real = 2 * np.arctan((-b + sign * np.sqrt(b * b - 4 * a * c)) / (2 * a))
    return angle


def recognise_mechanism(case: Case) -> TextbookFourBar | TextbookCrankSlider:
    """Return the mechanism of a case if the textbook has formulas for it.

    Raises:
        MethodUnable: The linkage is neither a four-bar nor a central crank-slider.
    """
    linkage = case.linkage
    driver, types = linkage.driver, [group.type for group in case.structure.groups]
    w = driver.sense * driver.rate
    if driver.kind == "turn" and types in (["RRR"], ["RRP"]) and not driver.acceleration and not linkage.meshes:
        local = linkage.local
        first = next(h.point for h in linkage.hinges if driver.link in h.links and FRAME not in h.links)
        a, b = case.structure.groups[0].links
        last = linkage.shared(a, b)
        pivot = local(FRAME, driver.joint)
        if last == "B" and first == "A" and local(driver.link, driver.joint) == 0:
            crank, rod = abs(local(driver.link, first)), abs(local(a, last) - local(a, first))
            if types == ["RRP"]:
                slide = linkage.slides[0]
                if slide.carrier == FRAME and slide.through == pivot and slide.at == local(b, last):
                    return TextbookCrankSlider(pivot, crank, rod, slide.direction, w)
            else:
                D = next(h.point for h in linkage.hinges if {FRAME, b} <= set(h.links))
                return TextbookFourBar(pivot, local(FRAME, D), crank, rod, abs(local(b, last) - local(b, D)), w)
    raise UnsupportedLinkageError("the textbook has formulas for a four-bar and a central crank-slider only")


def _prepare(
    case: Case, choose: Callable[[TextbookFourBar | TextbookCrankSlider], Angles]
) -> Callable[[Real], MethodAnswers]:
    mechanism = recognise_mechanism(case)
    angles, sign = choose(mechanism), _sketched_side(mechanism, case.linkage.sketch.points)
    return lambda q: mechanism.solve_points(q, angles(q, sign))


def _sketched_side(mechanism: TextbookFourBar | TextbookCrankSlider, points: Mapping[str, complex]) -> int:
    """Return the assembly that the sketch shows: 1 or -1.

    It is 1 if B lies to the left of AD, or for a crank-slider if B is ahead of A along the guide.
    """
    rod = points["B"] - points["A"]
    if isinstance(mechanism, TextbookCrankSlider):
        return 1 if dot(rod, unit(mechanism.along)) > 0 else -1
    return 1 if cross(mechanism.D - points["A"], rod) > 0 else -1


def prepare_cosines(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the textbook method by the law of cosines."""
    return _prepare(case, lambda mechanism: mechanism.angles_by_cosines)


def prepare_freudenstein(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the textbook method by Freudenstein's equation."""
    return _prepare(case, lambda mechanism: mechanism.angles_by_freudenstein)
