"""Crank-slider from its stroke (tasks 1 to 4): h = H/r, L = l/r, nu = e/r, theta between the extreme cranks.

The triangle A B1 B2 of the crank's pivot and the slider's extreme positions has the sides L + 1, L - 1 and h, the
height nu on h, and the angle theta at A:
    h = sqrt((L + 1)^2 - nu^2) - sqrt((L - 1)^2 - nu^2) = 2 sqrt(1 + (L^2 - 1) sin^2(theta/2)),
    nu = (L^2 - 1) sin(theta) / h,   sin(lambda_max) = (1 + nu)/L.
All functions take floats or arrays of any precision. Differences of near numbers are nowhere taken.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from tmm_cli.roots import roots
from tmm_cli.synthesis.construction import Angle, Arc, Centre, Construction, Segment, Size, Spot, box
from tmm_cli.synthesis.measures import crank_turns, mean_speed, pressure, ratio, stroke
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Shown, Value
from tmm_cli.vectors import pi

PARAMETERS: Final = {"r": "length", "l": "length", "e": "length"}
W: Final = "synthesis_crank_slider"
INSIDE: Final = 1 - 1e-5  # of the largest offset, at which the crank all but does not turn
DRAWN: Final = 0.01  # rad: the least theta that shows on a drawing
USUAL: Final = np.radians(30)  # the largest pressure angle that is usual for a sliding link


@dataclass(frozen=True)
class Asked:
    """Stroke (m), or mean speed of the slider (m/s) with that of the crank (rad/s); and two more: ratio L and nu, L and
    k, pressure (largest angle, rad) and nu, pressure and k, e (m) and k. Floats or arrays; None: not given.
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
class Found:
    """Lengths r, l, e and the stroke (m), theta and the largest pressure angle (rad), L, nu, h, k.

    printed: nu by the approximation sqrt((h - 2)(L^2 - 1)) for small theta; error: of that, relative.
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


def theta_of(k: Any) -> Any:
    """The angle theta from k."""
    k = np.asarray(k)
    return pi(1.0 * k) * (k - 1) / (k + 1)


def k_of(theta: Any) -> Any:
    """The coefficient k from theta."""
    return (pi(theta) + theta) / (pi(theta) - theta)


def nu_of(length: Any, theta: Any) -> Any:
    """Offset nu for a ratio L and theta."""
    sine, cosine = np.sin(theta / 2), np.cos(theta / 2)
    more = (length - 1) * (length + 1)
    return more * sine * cosine / np.sqrt(1 + more * sine * sine)


def theta_between(length: Any, nu: Any) -> Any:
    """Theta for a ratio L and an offset nu, from the sides and the height of the triangle."""
    near, far = np.sqrt((length - 1 - nu) * (length - 1 + nu)), np.sqrt((length + 1 - nu) * (length + 1 + nu))
    return np.arctan2(4 * length * nu / (near + far), near * far + nu * nu)


def stroke_ratio(length: Any, nu: Any) -> Any:
    """h = H/r for a ratio L and an offset nu."""
    near, far = (length - 1 - nu) * (length - 1 + nu), (length + 1 - nu) * (length + 1 + nu)
    return 4 * length / (np.sqrt(near) + np.sqrt(far))


def largest_theta(length: Any) -> Any:
    """The bound of theta for a ratio L: beyond it the crank does not turn fully; tan(theta/2) = 1/sqrt(L)."""
    return 2 * np.arctan(1 / np.sqrt(length))


def least_pressure(theta: Any) -> Any:
    """The least possible largest pressure angle for theta, over all L; see `shortest`.

    The derivative of sin(lambda) over sigma vanishes where sin(sigma)^2 = s cos(sigma).
    """
    s = np.sin(theta / 2)
    cosine = 2 / (s + np.sqrt(s * s + 4))
    return np.arcsin(np.sqrt(s * cosine) * (2 - s / cosine) / np.cos(theta / 2))


def shortest(theta: Any, pressure: Any) -> Any:
    """The least ratio L for theta at which the largest pressure angle is the given one; nan where there is none.

    With sigma half the sum of the angles of both extreme rods with the guide, s = sin(theta/2), c = cos(theta/2):
    L = tan(sigma) c/s, nu = (sin(sigma)^2 - s^2)/(s cos(sigma)); so 1 + nu = L sin(lambda) becomes, with w =
    sin(sigma)/s, an equation that theta = 0 does not spoil: s (w^2 - 1) + sqrt(1 - s^2 w^2) = w c sin(lambda). It falls
    from w = 1 to the least of lambda.
    """
    theta, pressure = np.broadcast_arrays(theta, pressure)
    s, c, sine = np.sin(theta / 2), np.cos(theta / 2), np.sin(pressure)
    end = np.sqrt(2 / (s + np.sqrt(s * s + 4)) / np.where(s > 0, s, 1.0))
    end = np.where(s > 0, end, 2 / sine)

    def excess(w: Any) -> Any:
        return s * (w - 1) * (w + 1) + np.sqrt((1 - s * w) * (1 + s * w)) - w * c * sine

    good = (excess(end) <= 0) & (excess(np.ones_like(end)) > 0)
    w = roots(excess, np.ones_like(end, dtype=float), np.asarray(end, dtype=float))
    for _ in range(2):  # the same in the precision of the data
        slope = 2 * s * w - s * s * w / np.sqrt((1 - s * w) * (1 + s * w)) - c * sine
        step = np.where(slope < -1e-6, excess(w) / np.where(slope < 0, slope, -1.0), 0.0)
        w = w - step
    return np.where(good, w * c / np.sqrt((1 - s * w) * (1 + s * w)), np.nan)


def ratio_of_offset(height: Any, e: Any, theta: Any) -> Any:
    """L for a stroke H and an offset e: (2 r)^2 = H (H - 2 e tan(theta/2)), (2 l)^2 = H (H + 2 e cot(theta/2)).

    (l + r)(l - r) sin(theta) = H e is twice the triangle's area; the law of cosines gives the sums of the squares.
    """
    tangent = np.tan(theta / 2)
    return np.sqrt((height + 2 * e / tangent) / (height - 2 * e * tangent))


def find(asked: Asked) -> Found:
    """The lengths. Where there is no such mechanism (`refuse` says why) they mean nothing."""
    height = _stroke(asked)
    theta = None if asked.k is None else theta_of(asked.k)
    if asked.e is not None:
        length = ratio_of_offset(height, asked.e, theta)
    elif asked.ratio is not None:
        length = np.asarray(asked.ratio)
    elif theta is not None:
        length = shortest(theta, asked.pressure)
    else:
        length = (1 + np.asarray(asked.nu)) / np.sin(asked.pressure)
    nu = np.asarray(asked.nu) if theta is None else nu_of(length, theta)
    if theta is None:
        theta, h = theta_between(length, nu), stroke_ratio(length, nu)
    else:
        half = np.sin(theta / 2)
        h = 2 * np.sqrt(1 + (length - 1) * (length + 1) * half * half)
    r = height / h
    if asked.e is not None:
        nu = asked.e / r
    scale = h / np.sqrt(h + 2) / np.cos(theta / 2)  # of sqrt((h - 2)(L^2 - 1)) to nu, without taking 2 from h
    return Found(
        r, length * r, nu * r, height, length, nu, h, theta, k_of(theta), np.arcsin((1 + nu) / length), nu * scale,
        (scale - 1) * (nu != 0),
    )  # fmt: skip


def _stroke(asked: Asked) -> Any:
    """H, or from the mean speed of the slider: v = H omega/pi, which is H = 30 v/n."""
    if asked.stroke is not None:
        return np.asarray(asked.stroke)
    return pi(1.0 * asked.speed) * asked.speed / asked.crank_speed


def _refuse_offset(e: float, height: float, theta: float) -> None:
    """The crank's pivot lies on the circle between B2 and the normal through B2: 0 < e < H cot(theta)."""
    values: dict[str, Shown] = {"usual": (USUAL, "angle"), "straight": (1 / np.sin(USUAL), "number")}
    if not e > 0:
        if theta == 0:
            raise Infeasible("e", f"{W}.e_zero", f"{W}.e_instead", values, whole=True)
        values["e"] = (SMALLEST, "length")
        if not (theta < np.pi / 2 and np.tan(theta) * SMALLEST < height):
            values["k"] = (float(k_of(np.arctan2(height, SMALLEST))), "number", "below")
            raise Infeasible("e", f"{W}.e_zero", f"{W}.e_and_k", values, whole=True)
        usual = max(USUAL, float(least_pressure(theta)) * (1 + SMALLEST))
        one = find(Asked(stroke=height, k=float(k_of(theta)), pressure=usual))
        values |= {"usable": (float(one.e), "length"), "usual": (usual, "angle")}
        raise Infeasible("e", f"{W}.e_zero", f"{W}.e_more", values)
    most = float(k_of(np.arctan2(height, e)))
    if theta == 0:
        values |= {"least": (1.0, "number", "above"), "most": (most, "number", "below")}
        values["k"] = (_k_of_offset(e, height), "number")
        raise Infeasible("k", f"{W}.e_without", f"{W}.e_needs", values)
    if theta >= np.pi / 2:
        raise Infeasible("k", f"{W}.k_never", f"{W}.k_most_alone", {"k": (most, "number", "below")})
    if not np.tan(theta) * e < height:
        values = {"e": (height / np.tan(theta) * INSIDE, "length", "most"), "k": (most, "number", "below")}
        raise Infeasible("e", f"{W}.e_above", f"{W}.e_most", values)


def _k_of_offset(e: float, height: float) -> float:
    """The k of an offset at which the largest pressure angle is the usual one: it grows with theta up to 90 degrees."""

    def excess(theta: Any) -> Any:
        length, half = ratio_of_offset(height, e, theta), np.sin(theta / 2)
        nu = e / height * 2 * np.sqrt(1 + (length - 1) * (length + 1) * half * half)
        return (1 + nu) / length - np.sin(USUAL)

    most = np.array([np.arctan2(height, e)])
    return float(k_of(roots(excess, most * SMALLEST, most * INSIDE)[0]))


def refuse(asked: Asked) -> None:
    """Raises Infeasible with the reason and what could be met."""
    for name, kind in (("stroke", "length"), ("speed", "speed"), ("crank_speed", "angular speed")):
        value = getattr(asked, name)
        if value is not None and not value > 0:
            raise Infeasible(name, f"{W}.positive", f"{W}.at_least", {"least": (SMALLEST, kind)})
    length, nu, k, limit = asked.ratio, asked.nu, asked.k, asked.pressure
    if k is not None and not k >= 1:
        _refuse_small(asked)
    if nu is not None and not nu >= 0:
        raise Infeasible("nu", f"{W}.nu_below", f"{W}.nu_least", {"nu": (0.0, "number")})
    if length is not None and not length > 1:
        values: dict[str, Shown] = {"ratio": (1 + (nu or 0.0), "number", "above")}
        raise Infeasible("ratio", f"{W}.ratio_below", f"{W}.ratio_least", values)
    if length is not None and nu is not None and not nu < length - 1:
        values = {"nu": (length - 1, "number", "below"), "ratio": (nu + 1, "number", "above")}
        raise Infeasible("nu", f"{W}.nu_above", f"{W}.nu_most", values)
    theta = None if k is None else theta_of(k)
    if asked.e is not None and theta is not None:
        _refuse_offset(asked.e, float(_stroke(asked)), float(theta))
    if length is not None and theta is not None and not theta < largest_theta(length):
        most = float(k_of(largest_theta(length)))
        longest = float(1 / np.tan(theta / 2) ** 2)
        values = {
            "k": (most, "number", "below"), "ratio": (longest, "number", "below"), "given": (length, "number"),
        }  # fmt: skip
        possible = longest > 1 + 1e-5  # or it would be printed as what is refused
        raise Infeasible("k", f"{W}.k_above", f"{W}.k_most" if possible else f"{W}.k_most_alone", values)
    if limit is not None and not 0 < limit < np.pi / 2:
        low = SMALLEST if theta is None or theta >= np.pi / 2 else max(SMALLEST, float(least_pressure(theta)))
        values = {"low": (low, "angle", "least"), "high": (np.pi / 2, "angle", "below")}
        raise Infeasible("pressure", f"{W}.pressure_range", f"{W}.pressure_allowed", values)
    if limit is not None and theta is not None:
        if not theta < np.pi / 2:
            most = float(largest_k(limit))
            raise Infeasible("k", f"{W}.k_never", f"{W}.k_most_alone", {"k": (most, "number", "most")})
        least = float(least_pressure(theta))
        if limit < least:
            values = {"pressure": (least, "angle", "least"), "k": (float(largest_k(limit)), "number", "most")}
            raise Infeasible("pressure", f"{W}.pressure_below", f"{W}.pressure_least", values)


def _refuse_small(asked: Asked) -> None:
    """k below 1: the same strokes the other way round, where they are possible, or the largest k that is."""
    given: dict[str, Shown] = {"least": (1.0, "number", "above")}
    words = "least_offset" if asked.e is not None else "least"
    if asked.k > 0:
        given["k"] = (1 / asked.k, "number", "most")
        try:
            refuse(replace(asked, k=1 / asked.k))
        except Infeasible as error:
            if "k" not in error.values:
                raise
            given["k"], words = error.values["k"], words.replace("least", "range")
    else:
        words = words.replace("least", "zero")
    raise Infeasible("k", f"{W}.k_below", f"{W}.k_{words}", given)


def largest_k(pressure: Any) -> Any:
    """The largest k that a limit of the pressure angle allows at any L: `least_pressure` solved for theta."""
    pressure = np.asarray(pressure, dtype=float)
    low, high = np.zeros_like(pressure), np.full_like(pressure, np.pi / 2)
    return k_of(roots(lambda theta: least_pressure(theta) - pressure, low, high))


def solve(asked: Asked) -> Outcome:
    """The task of one file: what is asked, found, and to be measured. Raises Infeasible."""
    refuse(asked)
    found = find(asked)
    kinds = {"stroke": "length", "speed": "speed", "crank_speed": "angular speed", "pressure": "angle", "e": "length"}
    given = tuple(
        Value(name, value, kinds.get(name, "number"), f"{W}.{name}")
        for name, value in vars(asked).items() if value is not None
    )  # fmt: skip
    lengths = tuple(Value(name, getattr(found, name), "length", f"{W}.{name}") for name in PARAMETERS)
    rest = [name for name in ("stroke", "ratio", "nu", "k", "pressure") if getattr(asked, name) is None]
    kinds |= {"theta": "angle"}
    more = tuple(
        Value("", getattr(found, name), kinds.get(name, "number"), f"{W}.{name}") for name in ("h", *rest, "theta")
    )
    printed = tuple(Value("", getattr(found, name), "number", f"{W}.{name}") for name in ("printed", "error"))
    demands = [Demand(f"{W}.crank_turns", 1.0, "number", crank_turns, asked=False)]
    if asked.speed is not None:
        demands.append(Demand(f"{W}.speed", float(asked.speed), "speed", mean_speed))
    measured = (("stroke", "length", stroke), ("k", "number", ratio), ("pressure", "angle", pressure))
    for name, kind, measure in measured:
        demands.append(
            Demand(f"{W}.{name}", float(getattr(found, name)), kind, measure, getattr(asked, name) is not None)
        )
    return Outcome(given, lengths + more + printed, f"{W}.source", tuple(demands), (construction(found),))


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
        Segment(complex(near - 0.12 * height, -e), complex(far + 0.12 * height, -e), "guide"),
        Segment(o, pin1, "link", "r"), Segment(pin1, b1, "link", "l"),
        Segment(pin2, o, "link2", "r"), Segment(o, b2, "link2", "l − r"),
    ]  # fmt: skip
    arcs = [Arc(o, r, 0.0, 2 * np.pi, "dashed")]
    spots = [
        Spot("O", o, "support"), Spot("A1", pin1, "hinge"), Spot("A2", pin2, "hinge"),
        Spot("B1", b1, "slider"), Spot("B2", b2, "slider"),
    ]  # fmt: skip
    sizes = (Size(b2, b1, "H", 1 + 0j), *((Size(o, b2, "e", 1j),) if e > 0 else ()))
    plain = Construction(
        f"{W}.ends", tuple(segments), tuple(arcs), tuple(spots), sizes=sizes, wishes=(box(o, r),), chain="crank-slider",
        values=(("r", r, "length"), ("l", l, "length")),
    )  # fmt: skip
    if not theta > DRAWN:
        return plain
    middle, radius = (b1 + b2) / 2, height / 2 / float(np.sin(theta))
    centre = middle + 1j * height / 2 / np.tan(theta)
    over, first = complex(near, 2 * centre.imag + e), float(np.angle(b1 - centre))
    start, end = (first + float(np.mod(np.angle(z - centre) - first, 2 * np.pi)) for z in (over, b2))
    arcs += [Arc(centre, radius, first, first + 2 * np.pi, "dashed"), Arc(centre, radius, start, end, "bold")]
    return replace(
        plain, title=f"{W}.construction", segments=(*segments, Segment(b1, b2, "thin")), arcs=tuple(arcs),
        angles=(Angle(o, b1, b2, "θ"), Angle(b1, b2, centre, "90° − θ"), Angle(b2, b1, centre, "90° − θ")),
        centres=(Centre(centre, radius, (b1, b2)),), wishes=(box(o, r), (centre,), box(centre, radius)),
        values=(*plain.values, ("θ", theta, "angle")), notes=(f"{W}.bold", f"{W}.angles"),
    )  # fmt: skip
