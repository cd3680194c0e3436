"""Synthesis of a crank-slider from its stroke (or mean speed) and two more quantities."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import find_roots
from tmm_cli.problem import Value as FileValue, ValueReader
from tmm_cli.synthesis.blocks import TaskBlock, choose_key_set, read_numbers
from tmm_cli.synthesis.construction import (
    Angle,
    Arc,
    CircleCentre,
    DimensionLine,
    GeometricConstruction,
    LetteredPoint,
    Segment,
    circle_extent,
    full_circle,
)
from tmm_cli.synthesis.measures import (
    driver_completes_range,
    k_of,
    largest_pressure_angle,
    mean_output_speed,
    output_stroke,
    theta_of,
    time_ratio,
)
from tmm_cli.synthesis.record import Demand, Infeasible, NamedValue, SolutionQuality, SynthesisOutcome, given_values

SMALLEST_DRAWN_THETA: Final = 0.01  # rad: smallest theta visible in a drawing


def draw_construction(solution: CrankSliderSolution) -> GeometricConstruction:
    """Draw the geometric construction of a crank-slider.

    It shows the mechanism in both extreme positions of the slider, and the circle from whose points the segment B1B2 is
    seen at the angle theta. B1 is the extreme position with the rod in line with the crank, B2 the one with the rod
    folded over the crank. The crank pivot O, at the origin, lies on the circle at the offset e from the line B1B2; it
    may lie between B2 and the point of the circle above B2, where e = H cot(theta).
    """
    r, l, e, height, theta = (float(getattr(solution, n)) for n in ("r", "l", "e", "stroke", "theta"))  # noqa: E741
    near, far = (float(np.sqrt((x - e) * (x + e))) for x in (l - r, l + r))
    o, b1, b2 = 0j, complex(far, -e), complex(near, -e)
    pin1, pin2 = r * b1 / abs(b1), -r * b2 / abs(b2)
    segments = [
        Segment(complex(near - 0.12 * height, -e), complex(far + 0.12 * height, -e), "axis"),
        Segment(o, pin1, "link", "r"),
        Segment(pin1, b1, "link", "l"),
        Segment(pin2, o, "link2", "r"),
        Segment(o, b2, "link2", "l − r"),
    ]
    arcs = [full_circle(o, r)]
    spots = [
        LetteredPoint("O", o, "support"),
        LetteredPoint("A1", pin1, "hinge"),
        LetteredPoint("A2", pin2, "hinge"),
        LetteredPoint("B1", b1, "slider"),
        LetteredPoint("B2", b2, "slider"),
    ]
    sizes = (DimensionLine(b2, b1, "H", 1 + 0j), *((DimensionLine(o, b2, "e", 1j),) if e > 0 else ()))
    plain = GeometricConstruction(
        N_("Extreme positions of the slider"),
        tuple(segments),
        tuple(arcs),
        tuple(spots),
        sizes=sizes,
        wishes=(circle_extent(o, r),),
        chain="crank-slider",
        values=(("r", r, "length"), ("l", l, "length")),
    )
    if not theta > SMALLEST_DRAWN_THETA:
        return plain
    middle, radius = (b1 + b2) / 2, height / 2 / float(np.sin(theta))
    centre = middle + 1j * height / 2 / np.tan(theta)
    over, first = complex(near, 2 * centre.imag + e), float(np.angle(b1 - centre))
    start, end = (first + float(np.mod(np.angle(z - centre) - first, 2 * np.pi)) for z in (over, b2))
    arcs += [Arc(centre, radius, first, first + 2 * np.pi, "dashed"), Arc(centre, radius, start, end, "bold")]
    return replace(
        plain,
        title=N_("Extreme positions of the slider, and the circle from which {B}1{B}2 is seen at the angle theta"),
        segments=(*segments, Segment(b1, b2, "thin")),
        arcs=tuple(arcs),
        angles=(Angle(o, b1, b2, "θ"), Angle(b1, b2, centre, "90° − θ"), Angle(b2, b1, centre, "90° − θ")),
        centres=(CircleCentre(centre, radius, (b1, b2)),),
        wishes=(circle_extent(o, r), (centre,), circle_extent(centre, radius)),
        values=(*plain.values, ("θ", theta, "angle")),
        notes=(N_("red: points {O} for which the crank rotates fully"), N_("{M}{B}1{B}2 = {M}{B}2{B}1 = 90° − θ")),
    )


# Crank-slider from its stroke (tasks 1 to 4): h = H/r, L = l/r, nu = e/r, theta between the extreme cranks.
#
# The triangle A B1 B2 of the crank's pivot and the slider's extreme positions has the sides L + 1, L - 1 and h, the
# height nu on h, and the angle theta at A:
#     h = sqrt((L + 1)^2 - nu^2) - sqrt((L - 1)^2 - nu^2) = 2 sqrt(1 + (L^2 - 1) sin^2(theta/2)),
#     nu = (L^2 - 1) sin(theta) / h,   sin(lambda_max) = (1 + nu)/L.
# All functions take floats or arrays, and avoid differences of nearly equal numbers.


PARAMETERS: Final = {"r": "length", "l": "length", "e": "length"}
QUANTITIES: Final = {  # quantities that a task may give: kind and description
    "stroke": ("length", N_("stroke H")),
    "speed": ("speed", N_("mean speed of the slider")),
    "crank_speed": ("angular speed", N_("crank speed")),
    "ratio": ("number", N_("rod-to-crank ratio L = l/r")),
    "nu": ("number", N_("relative offset nu = e/r")),
    "k": ("number", N_("k (time ratio)")),
    "pressure": ("angle", N_("largest pressure angle lambda")),
    "e": ("length", N_("guide offset e")),
}
FOUND_QUANTITIES: Final = {
    "r": ("length", N_("crank r")),
    "l": ("length", N_("connecting rod l")),
    "e": QUANTITIES["e"],
    "h": ("number", N_("stroke-to-crank ratio h = H/r")),
    "theta": ("angle", N_("angle theta between the crank's extreme positions")),
    "printed": ("number", N_("nu by the approximation sqrt((h - 2)(L^2 - 1)) for small theta")),
    "error": ("number", N_("relative error of this approximation")),
}


@dataclass(frozen=True)
class CrankSliderTask:
    """Given quantities of a crank-slider; floats or arrays, None if not given.

    Either the stroke is given, or the mean speed of the slider and the crank speed. In addition one of these pairs is
    given: ratio and nu, ratio and e, ratio and k, pressure and nu, pressure and k, e and k.

    Attributes:
        stroke: stroke H of the slider (m).
        speed, crank_speed: mean speed of the slider (m/s) and crank speed (rad/s).
        ratio: rod-to-crank ratio L = l/r.
        nu: relative offset e/r.
        k: time ratio.
        pressure: largest pressure angle (rad).
        e: offset of the guide (m).
    """

    stroke: Any = None
    speed: Any = None
    crank_speed: Any = None
    ratio: Any = None
    nu: Any = None
    k: Any = None
    pressure: Any = None
    e: Any = None


@dataclass(frozen=True)
class CrankSliderSolution:
    """Dimensions and properties of a crank-slider; floats or arrays.

    Attributes:
        r, l, e: crank, connecting rod, offset of the guide (m).
        stroke: stroke H of the slider (m).
        ratio, nu, h: ratios L = l/r, e/r and H/r.
        theta: angle between the crank's extreme positions (rad).
        k: time ratio.
        pressure: largest pressure angle (rad).
        printed: nu by the approximation sqrt((h - 2)(L^2 - 1)) for small theta, as textbooks print it.
        error: relative error of this approximation.
    """

    r: Any
    l: Any  # noqa: E741  its name in every course
    e: Any
    stroke: Any
    ratio: Any
    nu: Any
    h: Any
    theta: Any
    k: Any
    pressure: Any
    printed: Any
    error: Any


def nu_of(length: Any, theta: Any) -> Any:
    """Return the relative offset nu = e/r.

    Args:
        length: ratio L = l/r.
        theta: angle between the extreme crank positions (rad).
    """
    sine, cosine = np.sin(theta / 2), np.cos(theta / 2)
    more = (length - 1) * (length + 1)
    return more * sine * cosine / np.sqrt(1 + more * sine * sine)


def theta_between(length: Any, nu: Any) -> Any:
    """Return the angle theta (rad) between the extreme crank positions.

    Args:
        length: ratio L = l/r.
        nu: relative offset e/r.
    """
    near, far = np.sqrt((length - 1 - nu) * (length - 1 + nu)), np.sqrt((length + 1 - nu) * (length + 1 + nu))
    return np.arctan2(4 * length * nu / (near + far), near * far + nu * nu)


def stroke_ratio(length: Any, nu: Any) -> Any:
    """Return the ratio h = H/r of the stroke to the crank length.

    Args:
        length: ratio L = l/r.
        nu: relative offset e/r.
    """
    near, far = (length - 1 - nu) * (length - 1 + nu), (length + 1 - nu) * (length + 1 + nu)
    return 4 * length / (np.sqrt(near) + np.sqrt(far))


def largest_theta(length: Any) -> Any:
    """Return the upper limit of the angle theta (rad) between the extreme crank positions.

    The limit is tan(theta/2) = 1/sqrt(L) for the ratio L = l/r (`length`). With a larger theta the crank does not
    rotate fully.
    """
    return 2 * np.arctan(1 / np.sqrt(length))


def smallest_pressure(theta: Any) -> Any:
    """Return the smallest possible value of the largest pressure angle (rad), over all ratios L = l/r.

    In the notation of `shortest_rod`, the derivative of sin(lambda) with respect to sigma vanishes where sin(sigma)^2 =
    s cos(sigma).

    Args:
        theta: angle between the extreme crank positions (rad).
    """
    s = np.sin(theta / 2)
    cosine = 2 / (s + np.sqrt(s * s + 4))
    return np.arcsin(np.sqrt(s * cosine) * (2 - s / cosine) / np.cos(theta / 2))


def shortest_rod(theta: Any, pressure: Any) -> Any:
    """Return the smallest ratio L = l/r with this angle theta and this largest pressure angle (rad); nan if there is
    none.

    Let sigma be half the sum of the angles between the guide and the rod in both extreme positions, s = sin(theta/2)
    and c = cos(theta/2). Then L = tan(sigma) c/s and nu = (sin(sigma)^2 - s^2)/(s cos(sigma)). With w = sin(sigma)/s
    the condition 1 + nu = L sin(lambda) becomes s (w^2 - 1) + sqrt(1 - s^2 w^2) = w c sin(lambda), which remains
    regular at theta = 0. The difference of its two sides decreases from w = 1 to the value of w at which lambda is
    smallest.
    """
    theta, pressure = np.broadcast_arrays(theta, pressure)
    s, c, sine = np.sin(theta / 2), np.cos(theta / 2), np.sin(pressure)
    end = np.sqrt(2 / (s + np.sqrt(s * s + 4)) / np.where(s > 0, s, 1.0))
    end = np.where(s > 0, end, 2 / sine)

    def excess(w: Any) -> Any:
        return s * (w - 1) * (w + 1) + np.sqrt((1 - s * w) * (1 + s * w)) - w * c * sine

    good = (excess(end) <= 0) & (excess(np.ones_like(end)) > 0)
    w = find_roots(excess, np.ones_like(end), end)
    return np.where(good, w * c / np.sqrt((1 - s * w) * (1 + s * w)), np.nan)


def ratio_of_offset(height: Any, e: Any, theta: Any) -> Any:
    """Return the ratio L = l/r for a stroke H and an offset e (m), and an angle theta (rad).

    The formulas are (2 r)^2 = H (H - 2 e tan(theta/2)) and (2 l)^2 = H (H + 2 e cot(theta/2)). They follow from twice
    the area of the triangle of the extreme positions, (l + r)(l - r) sin(theta) = H e, and from the law of cosines.
    """
    tangent = np.tan(theta / 2)
    return np.sqrt((height + 2 * e / tangent) / (height - 2 * e * tangent))


def crank_of_offset(height: Any, e: Any, length: Any) -> Any:
    """Return the crank length r (m) for a stroke H (m), an offset e (m) and a ratio L = l/r (`length`); nan if there is
    none.

    The triangle of the extreme positions has the sides r (L + 1) and r (L - 1) and twice the area H e. Hence r^2 =
    ((L^2 + 1) H^2 + sqrt((L^2 + 1)^2 H^4 - 4 L^2 H^2 (H^2 + 4 e^2)))/(8 L^2), with the radicand H^2 ((L^2 - 1)^2 H^2 -
    16 L^2 e^2). With a minus sign before the root the crank would not rotate fully.
    """
    more = (length - 1) * (length + 1) * height
    under = (more - 4 * length * e) * (more + 4 * length * e)
    with np.errstate(invalid="ignore"):
        return np.sqrt(height * ((length * length + 1) * height + np.sqrt(under)) / 8) / length


def find_crank_slider(task: CrankSliderTask) -> CrankSliderSolution:
    """Find the dimensions of a crank-slider from the triangle of its extreme positions and theta = pi (k - 1)/(k +
    1).

    The numbers returned are meaningless if no such mechanism exists; `refuse` checks this.
    """
    height = _find_stroke(task)
    theta = None if task.k is None else theta_of(task.k)
    if task.ratio is not None:
        length = np.asarray(task.ratio)
    elif task.e is not None:
        length = ratio_of_offset(height, task.e, theta)
    elif theta is not None:
        length = shortest_rod(theta, task.pressure)
    else:
        length = (1 + np.asarray(task.nu)) / np.sin(task.pressure)
    if theta is not None:
        nu = nu_of(length, theta)
    elif task.nu is not None:
        nu = np.asarray(task.nu)
    else:
        nu = task.e / crank_of_offset(height, task.e, length)
    if theta is None:
        theta, h = theta_between(length, nu), stroke_ratio(length, nu)
    else:
        half = np.sin(theta / 2)
        h = 2 * np.sqrt(1 + (length - 1) * (length + 1) * half * half)
    r = height / h
    if task.e is not None:
        nu = task.e / r
    scale = (
        h / np.sqrt(h + 2) / np.cos(theta / 2)
    )  # ratio of sqrt((h - 2)(L^2 - 1)) to nu, without the difference h - 2
    return CrankSliderSolution(
        r,
        length * r,
        nu * r,
        height,
        length,
        nu,
        h,
        theta,
        k_of(theta),
        np.arcsin((1 + nu) / length),
        nu * scale,
        (scale - 1) * (nu != 0),
    )


def _find_stroke(task: CrankSliderTask) -> Any:
    """Return the stroke H (m). If the mean speed v is given instead, H = pi v/omega."""
    if task.stroke is not None:
        return np.asarray(task.stroke)
    return np.pi * task.speed / task.crank_speed


def refuse(task: CrankSliderTask) -> None:
    """Raise Infeasible, with the reason, if no crank-slider satisfies the task."""
    ratio, nu, pressure, e = task.ratio, task.nu, task.pressure, task.e
    if nu is not None and not nu >= 0:
        raise Infeasible(
            "nu",
            _(
                "the offset is a distance and cannot be negative; to place the guide on the other side, mirror the "
                "mechanism"
            ),
        )
    if e is not None and ratio is None and not e > 0:
        raise Infeasible("e", _("with zero offset k is always 1, and the lengths remain undetermined"))
    if e is not None and not e >= 0:
        raise Infeasible(
            "e",
            _(
                "the offset is a distance and cannot be negative; to place the guide on the other side, mirror the "
                "mechanism"
            ),
        )
    if ratio is not None and not ratio > 1:
        raise Infeasible("ratio", _("the crank rotates fully only if the rod is longer than the crank"))
    if ratio is not None and nu is not None and not nu < ratio - 1:
        raise Infeasible("nu", _("the crank does not rotate fully: this requires l > r + e"))
    if ratio is not None and e is not None and not 2 * np.sqrt(ratio) * e < (ratio - 1) * _find_stroke(task):
        raise Infeasible("e", _("the crank does not rotate fully: this requires l > r + e"))
    theta = 0.0 if task.k is None else _refuse_k(task)
    if pressure is not None and not pressure < np.pi / 2:
        raise Infeasible("pressure", _("the largest pressure angle must be less than 90 deg"))
    if pressure is not None and pressure < smallest_pressure(theta):
        raise Infeasible(
            "pressure", _("with this k the largest pressure angle exceeds the given one for every rod length")
        )


def _refuse_k(task: CrankSliderTask) -> float:
    """Return the angle theta (rad) between the extreme crank positions that follows from the time ratio k.

    Raises:
        Infeasible: k exceeds its limit.
    """
    theta, limit = float(theta_of(task.k)), np.pi / 2
    if not task.k >= 1:
        raise Infeasible(
            "k",
            _(
                "k must be 1 or more: it is the duration of the working stroke divided by that of the shorter "
                "return stroke"
            ),
        )
    if task.e is not None and theta == 0:
        raise Infeasible("k", _("if there is an offset, k must be greater than 1"))
    if task.ratio is not None:
        limit = float(largest_theta(task.ratio))
    elif task.e is not None:  # O lies on the circle between B2 and the point above it: e < H cot(theta)
        limit = float(np.arctan2(_find_stroke(task), task.e))
    if theta >= np.pi / 2:
        raise Infeasible("k", _("in a crank-slider whose crank rotates fully, k must be less than 3"))
    if theta >= limit and task.ratio is not None:
        raise Infeasible("k", _("the crank does not rotate fully: k is too large for this ratio L = l/r"))
    if theta >= limit:
        raise Infeasible("k", _("the crank does not rotate fully: k is too large for this stroke and offset"))
    return theta


def solve(task: CrankSliderTask) -> SynthesisOutcome:
    """Find the crank-slider and draw its construction. Raises Infeasible."""
    refuse(task)
    solution = find_crank_slider(task)
    lengths = tuple(NamedValue(name, getattr(solution, name), *FOUND_QUANTITIES[name]) for name in PARAMETERS)
    rest = [name for name in ("stroke", "ratio", "nu", "k", "pressure") if getattr(task, name) is None]
    more = tuple(
        NamedValue("", getattr(solution, name), *(QUANTITIES | FOUND_QUANTITIES)[name])
        for name in ("h", *rest, "theta", "printed", "error")
    )
    demands = [Demand(N_("crank rotates fully (1: yes)"), 1.0, "number", driver_completes_range, asked=False)]
    if task.speed is not None:
        demands.append(Demand(N_("mean speed of the slider"), float(task.speed), "speed", mean_output_speed))
    for name, measure in (("stroke", output_stroke), ("k", time_ratio), ("pressure", largest_pressure_angle)):
        kind, text = QUANTITIES[name]
        predicted = float(getattr(solution, name))
        demands.append(Demand(text, predicted, kind, measure, getattr(task, name) is not None, of=name))
    return SynthesisOutcome(
        given_values(task, QUANTITIES),
        lengths + more,
        N_(
            "triangle of the crank pivot and the extreme positions of the slider: the sides l + r and l - r "
            "enclose the angle theta = pi (k - 1)/(k + 1); the third side is the stroke H, and the altitude to "
            "it is e; sin(lambda) = (r + e)/l"
        ),
        tuple(demands),
        (draw_construction(solution),),
        output="slide",
        quality=SolutionQuality(float(solution.pressure), slides=True, limited=task.pressure is not None),
    )


# Keys of the task.


STROKE_KEYS = (("stroke",), ("speed", "crank_speed"))
KEY_PAIRS = (("ratio", "nu"), ("ratio", "e"), ("ratio", "k"), ("pressure", "nu"), ("pressure", "k"), ("e", "k"))


class CrankSliderBlock(TaskBlock):
    """Keys of the task `crank-slider`: the stroke or mean speed, and two of L, nu, e, k and the pressure angle."""

    task: Literal["crank-slider"]
    stroke: FileValue | None = Field(default=None, description="stroke H of the slider")
    speed: FileValue | None = Field(default=None, description="mean speed of the slider, instead of the stroke")
    crank_speed: FileValue | None = Field(
        default=None, description="crank speed, given together with the mean speed, e.g. 300 rpm"
    )
    ratio: FileValue | None = Field(default=None, description="L = l/r, ratio of rod to crank")
    nu: FileValue | None = Field(default=None, description="nu = e/r, ratio of guide offset to crank")
    k: FileValue | None = Field(
        default=None,
        description="time ratio (coefficient of change of mean speed) k = (180° + θ)/(180° - θ), 1 or more",
    )
    pressure: FileValue | None = Field(
        default=None, description="largest admissible pressure angle; the shortest rod that satisfies it is found"
    )
    e: FileValue | None = Field(default=None, description="offset of the guide from the crank pivot")


BLOCK = CrankSliderBlock


def read(block: CrankSliderBlock, values: ValueReader) -> CrankSliderTask:
    """Convert the keys of the task to quantities in SI and radians.

    Raises:
        ProblemError: the keys do not determine a crank-slider.
    """
    for sets in (STROKE_KEYS, KEY_PAIRS):
        choose_key_set(block, sets)
    return CrankSliderTask(**read_numbers(block, values, QUANTITIES))
