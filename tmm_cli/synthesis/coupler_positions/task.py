"""Synthesis of a four-bar from positions of its coupler: solution and keys of the task."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import sin
from typing import Annotated, Any, Final, Literal

import numpy as np
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from tmm_cli.language import N_, Phrase, _
from tmm_cli.mechanics.numerics import SAME_POSITION, zero_within_rounding
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector, make_complex
from tmm_cli.synthesis import four_bar
from tmm_cli.synthesis.blocks import TaskBlock, choose_key_set
from tmm_cli.synthesis.coupler_positions.burmester import (
    CouplerPositionsTask,
    DyadData,
    Dyads,
    GuidanceQuality,
    dyads_by_rotation,
)
from tmm_cli.synthesis.coupler_positions.drawings import draw_construction
from tmm_cli.synthesis.coupler_positions.dyads import DEFECTS, are_sensible, find_dyads
from tmm_cli.synthesis.record import (
    Demand,
    Listing,
    NamedValue,
    SolutionQuality,
    SynthesisOutcome,
    distance_beyond_rounding,
)

# Four-bar whose coupler takes 2, 3 or 4 given positions; AB drives, DC follows.
#
# 2 and 3 positions: the pin (B, C: in coupler axes) or the pivot (A, D) of each dyad is given; with 2 positions
# also its length. 4 positions: dyads on Burmester's curves, given by the rotation of AB and DC from position 1 to 2,
# by a point near a pivot, or those with the best transmission angle. All positions must belong to one assembly and be
# reached in order while AB rotates in one direction.


NAMES: Final = {
    "Ax": N_("x coordinate of pivot A"),
    "Ay": N_("y coordinate of pivot A"),
    "Dx": N_("x coordinate of pivot D"),
    "Dy": N_("y coordinate of pivot D"),
    "l1": N_("driver l1 = AB"),
    "l2": N_("coupler l2 = BC"),
    "l3": N_("follower l3 = DC"),
    "l4": N_("frame l4 = AD"),
    "Px": N_("x coordinate of point P in the coupler axes (origin B)"),
    "Py": N_("y coordinate of point P in the coupler axes (origin B)"),
    "Cx": N_("x coordinate of pin C in position 1"),
    "Cy": N_("y coordinate of pin C in position 1"),
    "phi1": N_("angle of AB in position 1"),
}
PARAMETERS: Final = {name: "angle" if name == "phi1" else "length" for name in NAMES}
GIVEN: Final[
    dict[str, dict[str, Any]]
] = {  # descriptions of the data of a dyad, by fields of DyadData; points have x and y
    "AB": {
        "pin": (N_("x coordinate of B in the coupler axes"), N_("y coordinate of B in the coupler axes")),
        "pivot": (NAMES["Ax"], NAMES["Ay"]),
        "length": N_("length of AB"),
        "turn": N_("rotation of AB from position 1 to 2"),
        "near": (N_("preferred x coordinate of pivot A"), N_("preferred y coordinate of pivot A")),
    },
    "DC": {
        "pin": (N_("x coordinate of C in the coupler axes"), N_("y coordinate of C in the coupler axes")),
        "pivot": (NAMES["Dx"], NAMES["Dy"]),
        "length": N_("length of DC"),
        "turn": N_("rotation of DC from position 1 to 2"),
        "near": (N_("preferred x coordinate of pivot D"), N_("preferred y coordinate of pivot D")),
    },
}
BRANCH: Final = {"AB": N_("solution branch of AB"), "DC": N_("solution branch of DC")}
AWAY: Final = {"AB": N_("distance of A from the preferred point"), "DC": N_("distance of D from the preferred point")}
SOURCES: Final = {  # by the number of positions; 1: four with equal angles
    1: N_("all points of a coupler that does not rotate move on equal circles; A and D are centres of such circles"),
    2: N_(
        "each pivot lies on the perpendicular bisector of the segment between the two pin positions, and "
        "its distance from the pin is the link length"
    ),
    3: N_(
        "each pivot is the centre of the circle through the three pin positions; if the pivot is given, "
        "the pin is found in the same way with the coupler held fixed (inversion)"
    ),
    4: N_(
        "the pins lie on the circle-point curve and the pivots on the centre-point curve of four positions "
        "(Burmester): W (e^(i beta) - 1) + Z (e^(i alpha) - 1) = P - P1"
    ),
}
LISTED: Final = 360  # tabulated rotations for each branch of Burmester's curves


def refuse(task: CouplerPositionsTask) -> None:
    """Raise Infeasible, with the reason, if no four-bar satisfies the task."""
    find_dyads(task)


def solve(task: CouplerPositionsTask) -> SynthesisOutcome:
    """Find the four-bar, draw its construction and tabulate Burmester's curves. Raises Infeasible."""
    first, second, rating = find_dyads(task)
    numbers = _compute_parameters(task, first, second)
    values = [NamedValue(name, float(numbers[name]), kind, NAMES[name]) for name, kind in PARAMETERS.items()]
    values += [
        NamedValue(
            "", float(rating.least), "angle", N_("smallest transmission angle between the first and last position")
        ),
        NamedValue("", float(rating.turn), "angle", N_("rotation of AB from the first to the last position")),
        NamedValue("", DEFECTS[int(rating.defect)], "word", N_("defects")),
    ]
    count = len(task.places)
    notes, listings = [], []
    if task.still:
        notes.append(
            N_(
                "the coupler does not rotate: any parallelogram with these links AB and DC guides it. The length "
                "and direction of AD are free; AD was taken perpendicular to AB in the middle of its range"
            )
        )
    elif count == 4:
        values += [*_list_curve_values(task, "AB", first), *_list_curve_values(task, "DC", second)]
        listings.append(_tabulate_curve(task))
    by_pivot = [name in task.sides and task.sides[name].pivot is not None for name in ("AB", "DC")]
    drawn = draw_construction(task.poses, first, second, (by_pivot[0], by_pivot[1]))
    source, demands = SOURCES[1 if task.still else count], tuple(_list_demands(task, first, second, rating))
    l1, l2, l3, l4 = (float(numbers[name]) for name in ("l1", "l2", "l3", "l4"))
    links = four_bar.FourBarLinks(l1, l2, l3, l4)
    quality = SolutionQuality(
        np.pi / 2 - float(rating.least),
        crank=bool(four_bar.classify_four_bar(links).turns[0]),
        defect=("", "branch", "order", "order")[int(rating.defect)],
    )
    return SynthesisOutcome(
        tuple(_list_given_values(task)),
        tuple(values),
        source,
        demands,
        drawn,
        tuple(notes),
        tuple(listings),
        quality=quality,
    )


def _compute_parameters(task: CouplerPositionsTask, first: Dyads, second: Dyads) -> dict[str, Any]:
    """Return the values of all parameters (SI, rad) in extended precision, by name."""
    b, c = (task.poses.on_frame(x.pin)[..., 0] for x in (first, second))
    a, d = first.pivot, second.pivot
    size = task.size + np.max(np.abs(np.asarray(task.places))) + np.abs(a) + np.abs(d)
    a, b, c, d = (zero_within_rounding(x, size) for x in (a, b, c, d))
    span = second.pin - first.pin
    p = zero_within_rounding(-first.pin * np.conj(span) / np.abs(span), size)
    parameters = {"Ax": a.real, "Ay": a.imag, "Dx": d.real, "Dy": d.imag, "Px": p.real, "Py": p.imag}
    parameters |= {"l1": np.abs(b - a), "l2": np.abs(span), "l3": np.abs(c - d), "l4": np.abs(d - a)}
    return parameters | {"Cx": c.real, "Cy": c.imag, "phi1": np.arctan2((b - a).imag, (b - a).real)}


def _list_curve_values(task: CouplerPositionsTask, name: str, dyad: Dyads) -> Iterator[NamedValue]:
    """Yield the rotation and the branch of a dyad on Burmester's curves.

    With these two values a problem file can specify the same dyad.
    """
    side = task.sides.get(name, DyadData())
    if side.turn is None:
        pins = task.poses.on_frame(dyad.pin)
        turn = float(np.angle(complex((pins[1] - dyad.pivot) / (pins[0] - dyad.pivot))))
        ends = [dyads_by_rotation(task.poses, np.asarray(turn, np.longdouble), branch).pivot for branch in (0, 1)]
        branch = int(np.argmin(np.nan_to_num(np.abs(np.array(ends, complex) - complex(dyad.pivot)), nan=np.inf)))
        yield NamedValue("", turn, "angle", GIVEN[name]["turn"])
        yield NamedValue("", str(branch + 1), "word", BRANCH[name])
    if side.near is not None:
        distance = distance_beyond_rounding(complex(dyad.pivot) - complex(side.near), task.size)
        yield NamedValue("", distance, "length", AWAY[name])


def _tabulate_curve(task: CouplerPositionsTask) -> Listing:
    """Tabulate the pivots and pins on Burmester's curves, by the rotation of the link and the branch."""
    columns = (
        ("branch", N_("solution branch"), "name"),
        ("turn", N_("rotation from position 1 to 2"), "angle"),
        ("pivot_x", N_("x coordinate of the pivot"), "length"),
        ("pivot_y", N_("y coordinate of the pivot"), "length"),
        ("pin_x", N_("x coordinate of the pin in the coupler axes"), "length"),
        ("pin_y", N_("y coordinate of the pin in the coupler axes"), "length"),
        ("first_x", N_("x coordinate of the pin in position 1"), "length"),
        ("first_y", N_("y coordinate of the pin in position 1"), "length"),
        ("length", N_("length of the link"), "length"),
    )
    turns = -np.pi + 2 * np.pi * np.arange(1, LISTED + 1) / LISTED
    rows = []
    for branch in (0, 1):
        dyads = dyads_by_rotation(task.poses, turns, branch)
        first = task.poses.on_frame(dyads.pin)[..., 0]
        for k in np.flatnonzero(are_sensible(task, dyads)):
            a, b, b1 = (complex(x[k]) for x in (dyads.pivot, dyads.pin, first))
            coordinates = (a.real, a.imag, b.real, b.imag, b1.real, b1.imag)
            rows.append((str(branch + 1), float(turns[k]), *coordinates, abs(b1 - a)))
    title = N_("Burmester's curves: pivots and pins")
    return Listing("curve", title, columns, tuple(rows), long=True)


def _describe_position(k: int) -> tuple[str, str, str]:
    """Return the texts that describe x, y and the angle of required position k in tables."""
    return (
        Phrase("position {number}: x coordinate of P", number=k + 1),
        Phrase("position {number}: y coordinate of P", number=k + 1),
        Phrase("position {number}: angle of the coupler", number=k + 1),
    )


def _list_demands(task: CouplerPositionsTask, first: Dyads, second: Dyads, rating: GuidanceQuality) -> Iterator[Demand]:
    b = task.poses.on_frame(first.pin)
    phi = np.angle(np.asarray((b - first.pivot) / (second.pivot - first.pivot), complex))
    span = complex(second.pin - first.pin)
    local, slope = complex(-first.pin) * np.conj(span) / abs(span), float(np.angle(span))
    for k, (place, angle) in enumerate(zip(task.places, task.angles, strict=True)):
        at = {"phi": float(phi[k]), "local": local, "slope": slope, "near": float(angle)}
        x, y, turned = _describe_position(k)
        yield Demand(x, complex(place).real, "length", partial(_measure_pose, "x", at), at=task.size)
        yield Demand(y, complex(place).imag, "length", partial(_measure_pose, "y", at), at=task.size)
        yield Demand(turned, float(angle), "angle", partial(_measure_pose, "angle", at), at=1.0)
    measure = partial(four_bar.transmission_angle, float(rating.worst))
    name = N_("smallest transmission angle between the first and last position")
    yield Demand(name, float(rating.least), "angle", measure, asked=False, at=1.0)


def _measure_pose(coordinate: str, at: dict[str, Any], results: Any) -> float:
    """Return a coordinate (x, y or angle) of the coupler of the analysed mechanism in a required position.

    at: angle of AB in this position, and data to find the point and the direction of the coupler.
    """
    pins = four_bar.pin_positions(results, np.array([at["phi"]]))
    if pins is None:
        return float("nan")
    b, c = pins[1][0], pins[2][0]
    along = (c - b) / abs(c - b)
    place = b + along * at["local"]
    turned = at["near"] + float(np.angle(complex(along) * np.exp(-1j * (at["near"] + at["slope"]))))
    return float({"x": place.real, "y": place.imag, "angle": turned}[coordinate])


def _list_given_values(task: CouplerPositionsTask) -> Iterator[NamedValue]:
    for k, (place, angle) in enumerate(zip(task.places, task.angles, strict=True)):
        x, y, turned = _describe_position(k)
        yield from _list_coordinates(place, x, y)
        yield NamedValue("", angle, "angle", turned)
    for name, side in task.sides.items():
        texts = GIVEN[name]
        for field_name in ("pin", "pivot", "length", "turn", "near"):
            value = getattr(side, field_name)
            if value is not None and isinstance(texts[field_name], tuple):
                yield from _list_coordinates(value, *texts[field_name])
            elif value is not None:
                yield NamedValue("", value, "length" if field_name == "length" else "angle", texts[field_name])
    if task.within is not None:
        yield from _list_coordinates(
            task.within[0],
            N_("x coordinate of the first corner of the box for free pivots"),
            N_("y coordinate of the first corner of the box for free pivots"),
        )
        yield from _list_coordinates(
            task.within[1],
            N_("x coordinate of the opposite corner of the box for free pivots"),
            N_("y coordinate of the opposite corner of the box for free pivots"),
        )


def _list_coordinates(place: Any, x: str, y: str) -> tuple[NamedValue, NamedValue]:
    return NamedValue("", place.real, "length", x), NamedValue("", place.imag, "length", y)


def _check_position(position: Any) -> Any:
    if not isinstance(position, list) or len(position) != 3 or any(isinstance(x, list | dict | bool) for x in position):
        raise PydanticCustomError("position", "expected a point and an angle: [x, y, angle]")
    return position


Position = Annotated[list[Value], BeforeValidator(_check_position)]
SideName = Literal["left", "right"]
DYADS = ("AB", "DC")


class CouplerPositionsBlock(TaskBlock):
    """Keys of the task `coupler-positions`: 2, 3 or 4 positions of the coupler, and given quantities of the links AB
    and DC.
    """

    task: Literal["coupler-positions"]
    positions: list[Position] = Field(
        min_length=2, max_length=4, description="2 to 4 positions in order, each as [x, y, angle] of the coupler axes"
    )
    B: Vector | None = Field(default=None, description="pin B of link AB in the coupler axes; or give pivot A instead")
    C: Vector | None = Field(default=None, description="pin C of link DC in the coupler axes; or give pivot D instead")
    A: Vector | None = Field(default=None, description="pivot A of link AB on the frame")
    D: Vector | None = Field(default=None, description="pivot D of link DC on the frame")
    AB: Value | None = Field(default=None, description="length of the link (only with two positions)")
    DC: Value | None = Field(default=None, description="length of the link (only with two positions)")
    AB_side: SideName = Field(
        default="left",
        description=(
            "side of the segment from position 1 to 2 of the given end on which the other end of the link lies "
            "(only with two positions)"
        ),
    )
    DC_side: SideName = "left"
    AB_turn: Value | None = Field(
        default=None,
        description=(
            "rotation of AB from position 1 to 2 (only with four positions); default: the rotation with the "
            "best transmission angle"
        ),
    )
    DC_turn: Value | None = Field(
        default=None,
        description=(
            "rotation of DC from position 1 to 2 (only with four positions); default: the rotation with the "
            "best transmission angle"
        ),
    )
    A_near: Vector | None = Field(
        default=None,
        description=(
            "desired location of pivot A, given instead of AB_turn (four positions only): the point of the "
            "centre-point curve nearest to it becomes A"
        ),
    )
    D_near: Vector | None = Field(
        default=None,
        description=(
            "point instead of DC_turn (only with four positions): pivot D is the point of the centre-point "
            "curve nearest to it"
        ),
    )
    pivots_within: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=2,
        description=(
            "opposite corners of the box in which pivots that are not given must lie (only with four positions)"
        ),
    )
    AB_branch: Literal[1, 2] = Field(
        default=1, description="number of the solution if two links have this rotation: 1 or 2"
    )
    DC_branch: Literal[1, 2] = 1
    defects: Literal["refuse", "keep"] = Field(
        default="refuse",
        description="what to do with solutions that have branch, order or circuit defects: refuse or keep",
    )


BLOCK = CouplerPositionsBlock


def read(block: CouplerPositionsBlock, values: ValueReader) -> CouplerPositionsTask:
    """Convert the keys of the task to quantities in SI and radians. Raises ProblemError."""
    count = len(block.positions)
    poses = [
        (
            make_complex(*(values.number(pose[i], LENGTH, ("positions", k, i)) for i in (0, 1))),
            values.number(pose[2], ANGLE, ("positions", k, 2)),
        )
        for k, pose in enumerate(block.positions)
    ]
    for k, (place, angle) in enumerate(poses):
        same = [m for m in range(k) if poses[m][0] == place and abs(sin((poses[m][1] - angle) / 2)) < SAME_POSITION]
        if same:
            raise ProblemError(
                _("this position is given twice"),
                path=("positions", k),
                found=_("position {number}").format(number=same[0] + 1),
                allowed=_("a different position, e.g. rotated by 20 deg"),
            )
    sides = {name: side for name in DYADS if (side := _read_dyad(block, values, name, count)) is not None}
    origins, angles = zip(*poses, strict=True)
    return CouplerPositionsTask(
        tuple(origins), tuple(angles), sides, block.defects == "keep", _read_box(block, values, count, sides)
    )


def _read_box(
    block: CouplerPositionsBlock, values: ValueReader, count: int, sides: dict[str, DyadData]
) -> tuple[complex, complex] | None:
    """Read the corners of the rectangle for the pivots that are not given; None if the key is omitted."""
    if block.pivots_within is None:
        return None
    if count != 4 or len(sides) == 2:
        why = _("number of positions: {count}").format(count=count) if count != 4 else _("both links are given")
        raise ProblemError(
            _("pivots_within applies only to pivots that are not given"),
            path=("pivots_within",),
            found=why,
            allowed=_("four positions, and AB or DC not given"),
            key=True,
        )
    corner, opposite = (values.vector(v, LENGTH, ("pivots_within", k)) for k, v in enumerate(block.pivots_within))
    return corner, opposite


def _read_dyad(block: CouplerPositionsBlock, values: ValueReader, name: str, count: int) -> DyadData | None:
    """Read the given quantities of a dyad; None if there are none.

    Raises:
        ProblemError: too few or too many quantities are given.
    """
    pivot, pin, turn, near = name[0], name[1], f"{name}_turn", f"{name[0]}_near"
    sets = {2: ((pin, name), (pivot, name)), 3: ((pin,), (pivot,)), 4: ((turn,), (near,), ())}[count]
    refusal = _("these keys do not determine link {link}; number of positions: {count}").format(link=name, count=count)
    keys = choose_key_set(block, sets, (pivot, pin, name, turn, near), refusal)
    if not keys:
        return None
    dyad_data: dict[str, Any] = {
        field: values.vector(getattr(block, key), LENGTH, (key,))
        for field, key in (("pivot", pivot), ("pin", pin), ("near", near))
        if key in keys
    }
    for field, key, want in (("length", name, LENGTH), ("turn", turn, ANGLE)):
        if key in keys:
            dyad_data[field] = values.number(getattr(block, key), want, (key,))
    return DyadData(side=getattr(block, f"{name}_side"), branch=getattr(block, f"{name}_branch") - 1, **dyad_data)
