"""Generated linkages for the measurements: chains of dyads, and families of linkages near a critical position."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Link, Linkage, Load, Sketch, Slide

CHAIN_CRANK, COUPLER, ROCKER, BEYOND = (
    0.04,
    0.3,
    0.2,
    0.9,
)  # m; the next coupler is attached at that fraction of the rocker length
AT = 1.0  # rad, the crank in the sketch


def dyad_chain(dyads: int) -> Linkage:
    """Make a linkage of a crank and a chain of RRR dyads, each attached to the rocker of the one before.

    With n dyads the linkage has 2 n + 1 moving links.
    """
    links = {
        FRAME: Link(FRAME, {"O": 0j}),
        "1": Link("1", {"O": 0j, "P0": CHAIN_CRANK + 0j}, 0.5, 1e-4, CHAIN_CRANK / 2 + 0j),
    }
    hinges = [Hinge("O", (FRAME, "1"))]
    points: dict[str, complex] = {"P0": CHAIN_CRANK * cmath.exp(1j * AT)}
    angles = {"1": AT}
    before, hung = "1", points["P0"]
    for k in range(1, dyads + 1):
        coupler, rocker = str(2 * k), str(2 * k + 1)
        b = hung + COUPLER * cmath.exp(0.3j)
        d = b - ROCKER * cmath.exp(1.6j)
        links[FRAME].points[f"D{k}"] = d  # type: ignore[index]
        links[coupler] = Link(coupler, {f"P{k - 1}": 0j, f"B{k}": COUPLER + 0j}, 1.0, 0.01, COUPLER / 2 + 0j)
        links[rocker] = Link(
            rocker,
            {f"D{k}": 0j, f"B{k}": ROCKER + 0j, f"P{k}": BEYOND * ROCKER * cmath.exp(-0.2j)},
            1.0,
            0.01,
            ROCKER / 2 + 0j,
        )
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


# Families of linkages near a critical position, each by the distance from it.
#
# A scene is made from exact decimals (numbers of a linkage, a critical driver coordinate to 50 digits, a distance),
# which are rounded to float64. The rounded data are the input of every method, and the answers to 50 digits are for
# them (tests/write_stability_references.py writes them). So the rounding of a distance is no error of a method.


Numbers = Mapping[str, Decimal]
NEAR = tuple(Decimal(10) ** -k for k in range(1, 16))  # rad, or fractions of a length
LONGER = tuple(Decimal(10) ** k for k in range(1, 13))
SIZES = tuple(Decimal(10) ** k for k in (0, 1, -1, 3, -3, 5, -5, 7, -7, 9, -9))
DecimalPoint = tuple[Decimal, Decimal]
CRANK = Driver("1", "turn", "O", 10.0)  # rad/s


@dataclass(frozen=True)
class LinkageScene:
    """A linkage at one driver coordinate, and the quantities of it that are compared.

    Attributes:
        linkage: the linkage.
        q: driver coordinate, rad.
        point: point whose position, velocity and acceleration are compared.
        pair: pair whose reaction is compared.
    """

    linkage: Linkage
    q: float
    point: str = "B"
    pair: str = "B"


@dataclass(frozen=True)
class LinkageFamily:
    """A family of linkages that approach a critical position.

    Attributes:
        name: name of the family, and of its data file.
        title: title in charts.
        scene: function of the numbers of the family (dimensions, critical driver coordinate) and of the distance; it
            returns a linkage at one driver coordinate.
        distances: distances from the critical position, in order of increasing difficulty.
        unit: unit of the distance; "share" is a fraction of a length, "ratio" a ratio of lengths.
        fixed: True if only the driver coordinate depends on the distance, and not the linkage.
    """

    name: str
    title: str
    scene: Callable[[Numbers, Decimal], LinkageScene]
    distances: tuple[Decimal, ...]
    unit: Literal["rad", "share", "ratio", "m"] = "rad"
    fixed: bool = False


def _make_bar(name: str, ends: tuple[str, str], length: float, mass: float) -> Link:
    """Make a uniform bar along the x axis of its link; ends: names of its end points."""
    points = {ends[0]: 0j, ends[1]: complex(length)}
    return Link(name, points, mass, mass * length * length / 12, complex(length / 2))


def _to_complex(place: DecimalPoint) -> complex:
    return complex(float(place[0]), float(place[1]))


def intersect_circles(A: complex, b: float, D: complex, c: float, side: float) -> complex:
    """Return an intersection of two circles about A and D with radii b and c; for side 1 the one to the left of AD.

    It is used for sketches only, because it is inaccurate if the circles nearly touch.
    """
    base = D - A
    d = abs(base)
    x = (d * d + b * b - c * c) / (2 * d)
    return A + base / d * complex(x, side * math.sqrt(max(b * b - x * x, 0.0)))


def transmission_sine(A: complex, b: float, D: complex, c: float) -> float:
    """Return the sine of the transmission angle of a four-bar with coupler b from A and rocker c from D.

    It is 0 if the coupler and the rocker do not reach each other.
    """
    cosine = (b * b + c * c - abs(D - A) ** 2) / (2 * b * c)
    return math.sqrt(max(1 - cosine * cosine, 0.0))


def four_bar_linkage(
    a: Decimal, b: Decimal, c: Decimal, pivots: tuple[DecimalPoint, DecimalPoint], side: float, at: float
) -> Linkage:
    """Make a four-bar with crank OA = a, coupler AB = b and rocker DB = c, which is loaded by a moment.

    Args:
        a, b, c: Lengths, m.
        pivots: Coordinates of O and D, m.
        side: 1 if B lies to the left of AD, otherwise -1.
        at: Crank angle of the sketch, rad.
    """
    la, lb, lc = float(a), float(b), float(c)
    o, d = (_to_complex(place) for place in pivots)
    A = o + la * complex(math.cos(at), math.sin(at))
    links = {
        FRAME: Link(FRAME, {"O": o, "D": d}),
        "1": _make_bar("1", ("O", "A"), la, 1.0),
        "2": _make_bar("2", ("A", "B"), lb, 3.0),
        "3": _make_bar("3", ("D", "B"), lc, 2.0),
    }
    hinges = (
        Hinge("O", (FRAME, "1")),
        Hinge("A", ("1", "2")),
        Hinge("B", ("2", "3")),
        Hinge("D", (FRAME, "3")),
    )
    sketch = Sketch(at, {"A": A, "B": intersect_circles(A, lb, d, lc, side)})
    return Linkage(links, hinges, (), CRANK, sketch, (Load("M", "3", moment=-40 * lc),))


def crank_slider_linkage(r: Decimal, length: Decimal, pivot: DecimalPoint, at: float) -> Linkage:
    """Make a central crank-slider with crank OA = r and connecting rod AB = length, with a force on the piston."""
    lr, ll = float(r), float(length)
    o = _to_complex(pivot)
    A = o + lr * complex(math.cos(at), math.sin(at))
    B = o + (A - o).real + math.sqrt(ll * ll - (A - o).imag ** 2)
    links = {
        FRAME: Link(FRAME, {"O": o}),
        "1": _make_bar("1", ("O", "A"), lr, 1.0),
        "2": _make_bar("2", ("A", "B"), ll, 3.0),
        "3": Link("3", {"B": 0j}, 2.0),
    }
    hinges = (Hinge("O", (FRAME, "1")), Hinge("A", ("1", "2")), Hinge("B", ("2", "3")))
    slide = Slide("x", FRAME, "3", o, 0.0, 0j, 0.0, "B")
    load = Load("F", "3", force=-200 + 0j)
    return Linkage(links, hinges, (slide,), CRANK, Sketch(at, {"A": A, "B": B}), (load,))


def slotted_lever_linkage(a: Decimal, pivots: tuple[DecimalPoint, DecimalPoint], far: Decimal, at: float) -> Linkage:
    """Make a slotted-lever mechanism: crank OA = a, sliding block at A, slotted link CK loaded by a moment.

    Args:
        a: Length of the crank, m.
        pivots: Coordinates of O and C, m.
        far: Length CK, m; K lies on the same side of C as A.
        at: Crank angle of the sketch, rad.
    """
    la, lk = float(a), float(far)
    o, c = (_to_complex(place) for place in pivots)
    A = o + la * complex(math.cos(at), math.sin(at))
    u = (A - c) / abs(A - c)
    links = {
        FRAME: Link(FRAME, {"O": o, "C": c}),
        "1": _make_bar("1", ("O", "A"), la, 1.0),
        "2": Link("2", {"A": 0j}, 0.5, 1e-3),
        "3": _make_bar("3", ("C", "K"), lk, 3.0),
    }
    hinges = (Hinge("O", (FRAME, "1")), Hinge("A", ("1", "2")), Hinge("C", (FRAME, "3")))
    slide = Slide("s", "3", "2", 0j, 0.0, 0j, 0.0, "A")
    sketch = Sketch(at, {"A": A, "K": c + lk * u}, {"3": math.atan2(u.imag, u.real)})
    return Linkage(links, hinges, (slide,), CRANK, sketch, (Load("M", "3", moment=-20.0),), keep_side=True)


def triad_linkage(n: Numbers) -> Linkage:
    """Make a crank OA and a triad: a ternary link PQR on three bars AP, CQ and DR, with a moment on CQ."""
    at = float(n["at"])
    z = {key: complex(float(n[key + "x"]), float(n[key + "y"])) for key in "OCDQRPqr"}
    la, leg = float(n["a"]), float(n["leg"])
    links = {
        FRAME: Link(FRAME, {"O": z["O"], "C": z["C"], "D": z["D"]}),
        "1": _make_bar("1", ("O", "A"), la, 0.8),
        "2": Link("2", {"P": 0j, "Q": z["Q"], "R": z["R"]}, 4.0, 0.02, complex(0.123, 0.05)),
        "3": _make_bar("3", ("A", "P"), leg, 1.1),
        "4": _make_bar("4", ("C", "Q"), leg, 1.1),
        "5": _make_bar("5", ("D", "R"), leg, 1.1),
    }
    hinges = (
        Hinge("O", (FRAME, "1")),
        Hinge("A", ("1", "3")),
        Hinge("P", ("2", "3")),
        Hinge("C", (FRAME, "4")),
        Hinge("Q", ("2", "4")),
        Hinge("D", (FRAME, "5")),
        Hinge("R", ("2", "5")),
    )
    A = z["O"] + la * complex(math.cos(at), math.sin(at))
    sketch = Sketch(at, {"A": A, "P": z["P"], "Q": z["q"], "R": z["r"]})
    return Linkage(links, hinges, (), CRANK, sketch, (Load("M", "4", moment=-20.0),))


# families


def _pivot_coordinates(n: Numbers) -> tuple[DecimalPoint, DecimalPoint]:
    return (n["Ox"], n["Oy"]), (n["Dx"], n["Dy"])


def _dead_position_scene(n: Numbers, distance: Decimal) -> LinkageScene:
    """Return a four-bar near a position in which coupler and rocker are in line.

    The distance from this position is an angle of the crank, rad.
    """
    sense = n["sense"]
    at = float(n["critical"] + sense * n["back"])
    linkage = four_bar_linkage(n["a"], n["b"], n["c"], _pivot_coordinates(n), float(n["side"]), at)
    return LinkageScene(linkage, float(n["critical"] + sense * distance))


def _collinear_scene(n: Numbers, distance: Decimal) -> LinkageScene:
    """Return a four-bar in whose sketch three points of the crank and coupler are nearly collinear.

    The distance from the collinear position is an angle, rad.
    """
    q = float(n["critical"] + n["sense"] * distance)
    return LinkageScene(four_bar_linkage(n["a"], n["b"], n["c"], _pivot_coordinates(n), float(n["side"]), q), q)


def _outer_tangent_scene(n: Numbers, share: Decimal) -> LinkageScene:
    """Return a four-bar in which coupler b and rocker c are nearly stretched: AD is less than b + c by the fraction
    `share`.
    """
    return _tangent_scene(n, (n["b"] + n["c"]) * (1 - share))


def _inner_tangent_scene(n: Numbers, share: Decimal) -> LinkageScene:
    """Return a four-bar in which coupler b and rocker c nearly overlap: AD exceeds |b - c| by the fraction `share`."""
    return _tangent_scene(n, abs(n["b"] - n["c"]) * (1 + share))


def _tangent_scene(n: Numbers, base: Decimal) -> LinkageScene:
    """Return a four-bar whose pivot D is at the distance `base` from A."""
    pivots = (n["Ox"], n["Oy"]), (n["Ax"] + n["ux"] * base, n["Ay"] + n["uy"] * base)
    o, d = (_to_complex(place) for place in pivots)
    a, b, c, q = float(n["a"]), float(n["b"]), float(n["c"]), float(n["q"])
    angles = [q + off for off in (-1.2, -0.8, -0.5, -0.3, 0.3, 0.5, 0.8, 1.2)]
    shapes = {at: transmission_sine(o + a * complex(math.cos(at), math.sin(at)), b, d, c) for at in angles}
    return LinkageScene(
        four_bar_linkage(n["a"], n["b"], n["c"], pivots, float(n["side"]), max(angles, key=shapes.__getitem__)), q
    )


def _block_over_pivot_scene(n: Numbers, share: Decimal) -> LinkageScene:
    """Return a slotted-lever mechanism whose sliding block is close to the pivot of the slotted link.

    share: distance of the block from this pivot, divided by the crank length OA.
    """
    C = n["Ax"] + n["a"] * share * n["ux"], n["Ay"] + n["a"] * share * n["uy"]
    q = float(n["q"])
    return LinkageScene(slotted_lever_linkage(n["a"], ((n["Ox"], n["Oy"]), C), n["far"], q + 1.0), q, "K", "A")


def _short_rod_scene(n: Numbers, share: Decimal) -> LinkageScene:
    """Return a crank-slider near its critical crank angle, with a rod longer than the crank by the fraction `share`."""
    q = float(n["critical"] + n["lean"] * share.sqrt())
    return LinkageScene(crank_slider_linkage(n["r"], n["r"] * (1 + share), (n["Ox"], n["Oy"]), 0.7), q, "B", "A")


def _long_rod_scene(n: Numbers, ratio: Decimal) -> LinkageScene:
    return LinkageScene(crank_slider_linkage(n["r"], n["r"] * ratio, (n["Ox"], n["Oy"]), 0.7), float(n["q"]), "B", "A")


def _size_scene(n: Numbers, size: Decimal) -> LinkageScene:
    """Return a four-bar or a crank-slider of the size `size`, m."""
    q, pivot = float(n["q"]), (n["Ox"] * size, n["Oy"] * size)
    if "r" in n:
        return LinkageScene(crank_slider_linkage(n["r"] * size, n["l"] * size, pivot, 0.7), q, "B", "A")
    pivots = pivot, (n["Dx"] * size, n["Dy"] * size)
    return LinkageScene(four_bar_linkage(n["a"] * size, n["b"] * size, n["c"] * size, pivots, float(n["side"]), 0.7), q)


def _fold_scene(n: Numbers, distance: Decimal) -> LinkageScene:
    """Return a linkage with a class III group near a position in which two of its assemblies coincide."""
    return LinkageScene(triad_linkage(n), float(n["critical"] + n["sense"] * distance), "Q", "C")


FAMILIES: tuple[LinkageFamily, ...] = (
    LinkageFamily("dead-position", "Dead position of the driven four-bar", _dead_position_scene, NEAR, fixed=True),
    LinkageFamily("change-point", "Change point of a parallelogram", _dead_position_scene, NEAR, fixed=True),
    LinkageFamily("outer-tangent", "Circles touching from outside, d → b + c", _outer_tangent_scene, NEAR, "share"),
    LinkageFamily("inner-tangent", "Circles touching from inside, d → |b - c|", _inner_tangent_scene, NEAR, "share"),
    LinkageFamily(
        "stone-over-pivot", "Sliding block over the pivot of its slotted link", _block_over_pivot_scene, NEAR, "share"
    ),
    LinkageFamily("short-rod", "Rod slightly longer than its crank", _short_rod_scene, NEAR[:12], "share"),
    LinkageFamily("long-rod", "Rod much longer than its crank", _long_rod_scene, LONGER, "ratio"),
    LinkageFamily("size", "Size", _size_scene, SIZES, "m"),
    LinkageFamily("three-in-line", "Start with three points in line", _collinear_scene, NEAR),
    LinkageFamily("two-assemblies-lost", "Class III group losing two assemblies", _fold_scene, NEAR, fixed=True),
)
FAMILIES_BY_NAME = {family.name: family for family in FAMILIES}
