"""Quantities of a linkage by name, with functions that read their values from results."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import partial
from itertools import permutations
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from tmm_cli.mechanics.analysis.selection import mass_centres, named_points
from tmm_cli.mechanics.kinematics import output_run
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_JERK,
    ANGULAR_SPEED,
    FORCE,
    JERK,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
    Dimension,
    coordinate_dimension,
)
from tmm_cli.mechanics.structure import Structure, output_link

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis.intermittent import IntermittentMotion, WheelTask


QuantityStage = Literal["structure", "places", "velocities", "accelerations", "forces", "balance"]
STAGES: tuple[QuantityStage, ...] = ("structure", "places", "velocities", "accelerations", "forces", "balance")


class SolvedState(Protocol):
    """Results from which quantities are read: of one linkage at its positions, or of many variants at once."""

    @property
    def linkage(self) -> Any: ...

    @property
    def motion(self) -> Any: ...

    @property
    def reactions(self) -> Any: ...

    @property
    def strokes(self) -> Any: ...


@dataclass(frozen=True, eq=False)
class SolvedVariants:
    """Solved variants of a linkage, in the form from which quantities are read (see `SolvedState`)."""

    linkage: Any
    motion: Any = None
    reactions: Any = None
    strokes: Any = None


@dataclass(frozen=True)
class NamedQuantity:
    """Quantity of a linkage by name.

    Attributes:
        name: its name, e.g. "v of E".
        stage: stage of the analysis that computes it.
        dimension: its dimension.
        read: function that returns the values from results, SI, (positions,) or (variants, positions); complex for a
            vector; (1,) or (variants, 1) if `whole`.
        vector: True for a vector.
        whole: True if the quantity describes the whole mechanism rather than one position.
        against: what relative errors refer to: the largest magnitude in the cycle ("largest"), the difference between
            largest and least value ("range", for coordinates), one radian ("angle", modulo 360 degrees), or nothing
            because the value must be exact ("exact", such as the class).
        thing: link, point or pair to which it belongs.
        on: link on which a reaction acts.
        otherwise: the same reaction, if a compound hinge is divided into pairs in another way, as students may do.
    """

    name: str
    stage: QuantityStage
    dimension: Dimension
    read: Callable[[SolvedState], Any]
    vector: bool = False
    whole: bool = False
    against: Literal["largest", "range", "angle", "exact"] = "largest"
    thing: str = ""
    on: str = ""
    otherwise: NamedQuantity | None = None

    @property
    def order(self) -> int:
        """Index of the stage that computes the quantity; stages are numbered in the order of computation."""
        return STAGES.index(self.stage)


QuantityMaker = Callable[["Linkage", "Structure"], "dict[str, NamedQuantity]"]  # all quantities of a kind, by name


# Quantities of the whole mechanism: mobility, class, stroke or swing angle, time ratio.


def mechanism_quantities(linkage: Linkage, structure: Structure) -> dict[str, NamedQuantity]:
    """Return the quantities that describe the whole mechanism.

    They are W, class, n (links), p1 and p2 (lower and higher pairs), passive (redundant constraints), strokes (their
    number), H (stroke; of a rocker the arc psi l of its first point), psi (swing angle) and k (time ratio).
    """
    exact = {
        "W": structure.mobility + structure.redundant,
        "class": structure.mechanism_class,
        "n": len(structure.links),
        "p1": len(structure.pairs) - structure.higher,
        "p2": structure.higher,
        "passive": structure.redundant,
    }
    quantities = {
        name: NamedQuantity(name, "structure", NUMBER, _read_constant(value), whole=True, against="exact")
        for name, value in exact.items()
    }
    output = output_link(linkage, structure.groups)
    slides = output is not None and linkage.slides_on_frame(output)
    name, dimension = ("H", LENGTH) if slides else ("psi", ANGLE)
    quantities[name] = NamedQuantity(name, "places", dimension, _read_stroke, whole=True)
    if output is not None and not slides and linkage.output_arm(output) is not None:
        quantities["H"] = NamedQuantity("H", "places", LENGTH, partial(_read_arc, output), whole=True)
    quantities["strokes"] = NamedQuantity("strokes", "places", NUMBER, _read_stroke_count, whole=True, against="exact")
    quantities["k"] = NamedQuantity("k", "places", NUMBER, _read_time_ratio, whole=True)
    return quantities


def _read_constant(value: int) -> Any:
    return lambda solution: np.array([float(value)])


def _read_stroke(solution: SolvedState) -> Any:
    strokes = solution.strokes
    if strokes is None or not strokes.strokes:
        return np.array([np.nan])
    return np.abs(strokes.strokes[0].run) + np.zeros(1)


def _read_arc(output: str, solution: SolvedState) -> Any:
    """Return the arc H = psi l (m) that a point of a rocker describes at the distance l from the pivot."""
    arm = solution.linkage.output_arm(output)
    return _read_stroke(solution) * (np.nan if arm is None else arm[1])


def _read_time_ratio(solution: SolvedState) -> Any:
    strokes = solution.strokes
    if strokes is None or len(strokes.strokes) < 2:
        return np.array([np.nan])
    working, idle = (sum(s.length for s in strokes.strokes[first::2]) for first in (0, 1))  # they alternate
    return np.asarray(working / idle) + np.zeros(1)


def _read_stroke_count(solution: SolvedState) -> Any:
    strokes = solution.strokes
    return np.array([float("nan") if strokes is None else float(len(strokes.strokes))])


# Positions, velocities and accelerations of points, links and sliding pairs.


def motion_quantities(linkage: Linkage, structure: Structure) -> dict[str, NamedQuantity]:
    """Return the quantities of motion.

    They are x, y, v, a of points and centres of mass; phi, omega, epsilon of links; s of links on the frame; v,
    a and the Coriolis acceleration in prismatic pairs.
    """
    quantities: dict[str, NamedQuantity] = {}

    def put(quantity: NamedQuantity) -> None:
        quantities[quantity.name] = quantity

    for point, place in {**named_points(linkage), **mass_centres(linkage)}.items():
        put(
            NamedQuantity(
                f"x of {point}",
                "places",
                LENGTH,
                partial(_read_coordinate, point, place, "real"),
                against="range",
                thing=point,
            )
        )
        put(
            NamedQuantity(
                f"y of {point}",
                "places",
                LENGTH,
                partial(_read_coordinate, point, place, "imag"),
                against="range",
                thing=point,
            )
        )
        put(
            NamedQuantity(
                f"v of {point}", "velocities", SPEED, partial(_read_point, point, place, "v"), True, thing=point
            )
        )
        put(
            NamedQuantity(
                f"a of {point}",
                "accelerations",
                ACCELERATION,
                partial(_read_point, point, place, "a"),
                True,
                thing=point,
            )
        )
        if not linkage.driver.law:
            put(
                NamedQuantity(
                    f"jerk of {point}", "accelerations", JERK, partial(_read_jerk, point, place), True, thing=point
                )
            )
    for link in linkage.moving:
        if not linkage.driver.law and f"jerk of {link}" not in quantities:
            angular = partial(_read_angular_jerk, link)
            put(NamedQuantity(f"jerk of {link}", "accelerations", ANGULAR_JERK, angular, thing=link))
        put(
            NamedQuantity(
                f"phi of {link}", "places", ANGLE, partial(_read_link, link, "angle"), against="angle", thing=link
            )
        )
        put(
            NamedQuantity(
                f"omega of {link}", "velocities", ANGULAR_SPEED, partial(_read_link, link, "omega"), thing=link
            )
        )
        put(
            NamedQuantity(
                f"epsilon of {link}",
                "accelerations",
                ANGULAR_ACCELERATION,
                partial(_read_link, link, "epsilon"),
                thing=link,
            )
        )
        if linkage.slides_on_frame(link) or linkage.hinged_to_frame(link):
            slides = linkage.slides_on_frame(link)
            put(
                NamedQuantity(
                    f"s of {link}",
                    "places",
                    coordinate_dimension("slide" if slides else "turn"),
                    partial(_read_run, link),
                    against="range" if slides else "angle",
                    thing=link,
                )
            )
            guide = linkage.output_guide(link)
            if guide is not None and f"v of {link}" not in quantities:  # as the table of the cycle prints it
                speed, acceleration = (partial(_read_slide, guide.name, field) for field in ("v", "a"))
                put(NamedQuantity(f"v of {link}", "velocities", SPEED, speed, thing=link))
                put(NamedQuantity(f"a of {link}", "accelerations", ACCELERATION, acceleration, thing=link))
    for slide in linkage.slides:
        name = f"{slide.runner} on {slide.carrier}"
        put(
            NamedQuantity(
                f"v of {name}", "velocities", SPEED, partial(_read_slide, slide.name, "v"), thing=slide.runner
            )
        )
        put(
            NamedQuantity(
                f"a of {name}", "accelerations", ACCELERATION, partial(_read_slide, slide.name, "a"), thing=slide.runner
            )
        )
        put(
            NamedQuantity(
                f"Coriolis of {name}",
                "accelerations",
                ACCELERATION,
                partial(_read_slide, slide.name, "coriolis"),
                True,
                thing=slide.runner,
            )
        )
    return quantities


def relative_angles(linkage: Linkage) -> dict[str, NamedQuantity]:
    """Return `phi of 5 on 4`: the angle of a link relative to another moving link hinged to it, rad."""
    angles = {}
    for hinge in linkage.hinges:
        for link, base in permutations([name for name in hinge.links if name != FRAME], 2):
            name = f"phi of {link} on {base}"
            read = partial(_read_relative_angle, link, base)
            angles[name] = NamedQuantity(name, "places", ANGLE, read, against="angle", thing=link)
    return angles


def _read_relative_angle(link: str, base: str, solution: SolvedState) -> Any:
    return solution.motion.link(link).angle - solution.motion.link(base).angle


def _read_point(point: str, place: tuple[str, complex], field: str, solution: SolvedState) -> Any:
    link = place[0]
    motion = solution.motion
    if point in motion.linkage.links[link].points:
        return getattr(motion.named(point), field)
    return getattr(motion.centre(link), field)


def _read_jerk(point: str, place: tuple[str, complex], solution: SolvedState) -> Any:
    link, motion = place[0], solution.motion
    return motion.jerk(point) if point in motion.linkage.links[link].points else motion.jerk_of_centre(link)


def _read_angular_jerk(link: str, solution: SolvedState) -> Any:
    return solution.motion.angular_jerk(link)


def _read_coordinate(point: str, place: tuple[str, complex], component: str, solution: SolvedState) -> Any:
    return getattr(_read_point(point, place, "x", solution), component)


def _read_link(link: str, field: str, solution: SolvedState) -> Any:
    return getattr(solution.motion.link(link), field)


def _read_run(link: str, solution: SolvedState) -> Any:
    return output_run(solution.motion, link)[0]


def _read_slide(name: str, field: str, solution: SolvedState) -> Any:
    return np.asarray(getattr(solution.motion.slide(solution.motion.linkage.slide(name)), field))


# Inertia forces and couples, reactions, balancing moments and forces.


NEARLY_ZERO = 0.05  # of the largest reaction: below it the point of application cannot be drawn


def force_quantities(linkage: Linkage, structure: Structure) -> dict[str, NamedQuantity]:
    """Return the quantities of forces.

    They are U and M, inertia force and couple of a link; R_34, force of link 3 on link 4; the arm of a guide
    reaction; R_A, force of the pin of a compound hinge; M_b or F_b, balancing moment or force.
    """
    quantities: dict[str, NamedQuantity] = {}

    def put(quantity: NamedQuantity) -> None:
        quantities.setdefault(quantity.name, quantity)

    for name in linkage.moving:
        link = linkage.links[name]
        if np.any(link.mass != 0):
            put(NamedQuantity(f"U of {name}", "forces", FORCE, partial(_read_inertia, name, "force"), True, thing=name))
        if np.any(link.inertia != 0):
            put(NamedQuantity(f"M of {name}", "forces", MOMENT, partial(_read_inertia, name, "moment"), thing=name))
    common_links = _common_links(linkage, structure)
    for pair in structure.pairs:
        alone = sum({other.i, other.j} == {pair.i, pair.j} for other in structure.pairs) == 1
        for by, on in ((pair.i, pair.j), (pair.j, pair.i)):
            called = _reaction_name(by, on) if alone else f"{_reaction_name(by, on)} in {pair.name}"
            force = NamedQuantity(
                called, "forces", FORCE, partial(_read_reaction, pair.name, on), True, thing=pair.name, on=on
            )
            if pair.point in common_links and pair.kind == "R":
                common = common_links[pair.point]
                read = partial(_read_pin_force, pair.point, common, 1 if on == common else -1)
                force = replace(force, otherwise=replace(force, read=read))
            put(force)
            if pair.slide is not None:
                put(NamedQuantity(f"arm of {called}", "forces", LENGTH, partial(_read_arm, pair.name), thing=pair.name))
    for hinge in linkage.hinges:
        if hinge.point in common_links:
            common = common_links[hinge.point]
            put(
                NamedQuantity(
                    f"R_{hinge.point}", "forces", FORCE, partial(_read_pin_force, hinge.point, common, -1), True
                )
            )
            for by, on in permutations([link for link in hinge.links if link != common], 2):
                force = NamedQuantity(
                    _reaction_name(by, on), "forces", FORCE, partial(_read_pin_force, hinge.point, on, 1), True
                )
                put(replace(force, otherwise=replace(force, read=partial(_read_pin_force, hinge.point, by, -1))))
    for driver in linkage.drivers:
        suffix = "" if len(linkage.drivers) == 1 else f" of {driver.link}"
        if driver.kind == "turn":
            put(
                NamedQuantity(
                    f"M_b{suffix}", "balance", MOMENT, partial(_read_balance, driver.link, "moment"), thing=driver.link
                )
            )
        if driver.kind == "slide" or driver.base == FRAME:
            put(
                NamedQuantity(
                    f"F_b{suffix}", "balance", FORCE, partial(_read_balance, driver.link, "force"), thing=driver.link
                )
            )
    return quantities


def _common_links(linkage: Linkage, structure: Structure) -> dict[str, str]:
    """Return by point the link of each compound hinge that forms a pair with every other link there."""
    common = {}
    for hinge in linkage.hinges:
        ends = [{pair.i, pair.j} for pair in structure.pairs if pair.kind == "R" and pair.point == hinge.point]
        if len(ends) > 1:
            (common[hinge.point],) = set.intersection(*ends)
    return common


def _reaction_name(by: str, on: str) -> str:
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def _read_pin_force(point: str, link: str, sense: int, solution: SolvedState) -> Any:
    """Return the force of the pin of a compound hinge on one of its links (sense 1), or the opposite force (-1)."""
    return sense * solution.reactions.pin_force(point, link)


def _read_inertia(link: str, field: str, solution: SolvedState) -> Any:
    return next(getattr(x, field) for x in solution.reactions.applied if x.link == link and x.kind == "inertia")


def _read_reaction(pair: str, on: str, solution: SolvedState) -> Any:
    return solution.reactions.of(pair).onto(on)


def _read_arm(pair: str, solution: SolvedState) -> Any:
    """Return the distance (m) of a guide reaction's line of action from the sliding point; nan for a nearly zero
    force.
    """
    reaction = solution.reactions.of(pair)
    magnitude = np.abs(reaction.force)
    assert reaction.arm is not None
    return np.where(magnitude > NEARLY_ZERO * np.max(magnitude, axis=-1, keepdims=True), reaction.arm, np.nan)


def _read_balance(link: str, field: str, solution: SolvedState) -> Any:
    return next(getattr(balance, field) for balance in solution.reactions.balances if balance.driver.link == link)


# Quantities of wheels with intermittent motion.


WheelReader = Callable[["IntermittentMotion"], float]
WHEEL_READERS: tuple[tuple[str, Dimension, WheelReader], ...] = (
    ("turn", ANGLE, lambda wheel: abs(wheel.turn)),
    ("standing", NUMBER, lambda wheel: wheel.standing),
    ("cycles", NUMBER, lambda wheel: np.nan if wheel.cycles is None else wheel.cycles),
    ("largest omega", ANGULAR_SPEED, lambda wheel: wheel.omega),
    ("largest epsilon", ANGULAR_ACCELERATION, lambda wheel: wheel.epsilon),
    ("shock", ANGULAR_SPEED, lambda wheel: wheel.shock),
)


def wheel_quantities(tasks: Iterable[WheelTask]) -> dict[str, NamedQuantity]:
    """Return the quantities of wheels with intermittent motion.

    They are the rotation per cycle and with each setting, the fraction of the driver travel in which the wheel rests,
    the number of cycles to a whole number of revolutions, the largest angular velocity and acceleration, and the shock.
    """
    readers = []
    for number, task in enumerate(tasks):
        for name, dimension, reader in WHEEL_READERS:
            readers.append((f"{name} of {task.name}", dimension, partial(_read_wheel, number, reader)))
        for k in range(len(task.settings)):
            readers.append(
                (f"step {k + 1} of {task.name}", ANGLE, partial(_read_wheel, number, partial(_step_angle, k)))
            )
    return {name: NamedQuantity(name, "velocities", dimension, read, whole=True) for name, dimension, read in readers}


def _read_wheel(number: int, reader: WheelReader, results: Any) -> Any:
    return np.array([float(reader(results.wheels[number]))])


def _step_angle(setting: int, wheel: IntermittentMotion) -> float:
    return abs(wheel.of_setting(setting))


# All quantities by name. To add a kind, write a function that returns it and list it in QUANTITY_MAKERS.


QUANTITY_MAKERS: tuple[QuantityMaker, ...] = (mechanism_quantities, motion_quantities, force_quantities)


def list_quantities(linkage: Linkage, structure: Structure) -> dict[str, NamedQuantity]:
    """Return all quantities of a linkage, by name, that a problem file can request or answers of students may
    contain.
    """
    return {name: quantity for kind in QUANTITY_MAKERS for name, quantity in kind(linkage, structure).items()}
