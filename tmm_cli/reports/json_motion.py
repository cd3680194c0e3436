"""Sections of result.json on motion, forces, law of motion, balancing and intermittent motion."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_cli.mechanics.analysis import Results, moving_centres, moving_points, select_links
from tmm_cli.mechanics.kinematics import SlidingMotion
from tmm_cli.mechanics.linkage import Slide
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.quantities import BALANCE, ENERGY, LEVER_MOMENT, LINK, LOAD, POINT, REACTION, SLIDE
from tmm_cli.reports.cycle_tables import position_states
from tmm_cli.reports.json_fields import (
    FLAG,
    FLAGS,
    INTEGER,
    NUMBER,
    SERIES,
    TEXT,
    VECTOR,
    JsonField,
    attribute_fields,
    json_record,
    list_of,
    map_of,
    optional,
    quantity_fields,
)

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SingleRun


SHAKING = json_record(
    "force and moment of the inertia forces on the frame",
    JsonField("force", VECTOR, "shaking force, N"),
    JsonField("moment", SERIES, "shaking moment about `pivot`, N*m"),
)
COUNTERWEIGHT = json_record(
    "a counterweight",
    JsonField("link", TEXT, "its link", "place.link"),
    JsonField("size", NUMBER, "mass times radius, kg*m"),
    JsonField("angle", NUMBER, "from the x axis of the link, rad"),
    JsonField("radius", optional(NUMBER), "radius in m; null if the file gives none", lambda w: w.place.radius or None),
    JsonField("mass", optional(NUMBER), "mass in kg; null if the file gives no radius"),
)
CORRECTION = json_record(
    "a mass that balances a shaft",
    JsonField("at", NUMBER, "position of its plane along the shaft, m", lambda mass: mass[0].at),
    JsonField("size", NUMBER, "mass times radius, kg*m", lambda mass: abs(mass[1])),
    JsonField("angle", NUMBER, "rad", lambda mass: float(np.angle(mass[1]))),
)
BALANCING = json_record(
    "balancing",
    JsonField("pivot", TEXT, "moments are about this point; empty: about the origin"),
    JsonField("before", SHAKING, "at the positions"),
    JsonField("counterweights", list_of(COUNTERWEIGHT), "that leave the least force", "cycle.counterweights"),
    JsonField("after", SHAKING, "at the positions, with counterweights"),
    JsonField("left", NUMBER, "largest force over the cycle with counterweights, over that without", "cycle.left"),
    JsonField(
        "rotor",
        list_of(CORRECTION),
        "masses on the shaft",
        lambda found: zip(found.task.rotor.planes, found.corrections.tolist(), strict=True),
        lambda found: found.task.rotor is not None,
    ),
)


def _initial_rate(results: Results, name: str) -> float:
    """Return the speed or acceleration of the driver at position 0, positive if it is in the direction of motion.

    name: `rate` for the speed, or `acceleration`.
    """
    driver = results.linkage.driver
    if driver.law is None:
        rate: float = getattr(driver, name)
        return rate
    start, law = np.array([results.start]), results.law
    return float(driver.sense * (law.speed if name == "rate" else law.accelerated)(start)[0])


LIMIT = json_record(
    "a limit", JsonField("at", NUMBER, "driver coordinate", "place"), JsonField("group", TEXT, "group that limits it")
)
DRIVER = json_record(
    "the driver",
    JsonField("link", TEXT, "link of the driver", "linkage.driver.link"),
    JsonField("kind", TEXT, "turn or slide", "linkage.driver.kind"),
    JsonField("sense", NUMBER, "+1 or -1", "linkage.driver.sense"),
    JsonField(
        "rate",
        NUMBER,
        "speed at position 0, positive in the direction of motion, rad/s or m/s",
        lambda r: _initial_rate(r, "rate"),
    ),
    JsonField(
        "acceleration",
        NUMBER,
        "acceleration at position 0, positive in the direction of motion, rad/s^2 or m/s^2",
        lambda r: _initial_rate(r, "acceleration"),
    ),
    JsonField("full_turn", FLAG, "true if the crank can make a full turn", "driver_range.full"),
    JsonField(
        "range",
        list_of(NUMBER),
        "least and largest driver coordinate",
        lambda r: (r.driver_range.start, r.driver_range.end),
    ),
    JsonField("limits", list_of(LIMIT), "limits of the range", "driver_range.limits"),
)

PRESSURE = json_record(
    "pressure angle of a driven link",
    JsonField("group", TEXT, "the group"),
    JsonField("link", TEXT, "driven link"),
    JsonField("pair", TEXT, "pair through which it is driven"),
    JsonField("slides", FLAG, "true if the link slides, false if it rotates"),
    JsonField("largest", NUMBER, "largest pressure angle, rad"),
    JsonField("at", NUMBER, "driver coordinate at the largest pressure angle", "place"),
    JsonField("other", NUMBER, "extreme pressure angle on the other side, rad"),
    JsonField("other_at", NUMBER, "driver coordinate at the other extreme", "other_place"),
    JsonField("allowed", NUMBER, "allowed pressure angle, rad"),
    JsonField("holds", FLAG, "true if the pressure angle is within the limit"),
    JsonField("transmission", NUMBER, "least transmission angle, rad"),
    JsonField("gain", NUMBER, "force amplification, 1/cos of the largest pressure angle"),
    JsonField("angles", SERIES, "pressure angle, rad"),
)
DEAD = json_record(
    "a dead position",
    JsonField("at", NUMBER, "driver coordinate", "place"),
    JsonField("group", TEXT, "the group"),
    JsonField("margin", NUMBER, "margin of the group at this coordinate"),
)
STROKE = json_record(
    "a stroke",
    JsonField("start", NUMBER, "driver coordinate at the start"),
    JsonField("length", NUMBER, "travel of the driver during the stroke"),
    JsonField("from", NUMBER, "position of the output at the start", "low"),
    JsonField("run", NUMBER, "travel of the output, signed"),
    JsonField("working", FLAG, "working stroke"),
    JsonField(
        "rest",
        NUMBER,
        "travel of the driver during the dwell after the stroke, if there is one",
        there=lambda stroke: stroke.rest,
    ),
)
OUTPUT = json_record(
    "strokes of an output",
    JsonField("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    JsonField("kind", TEXT, "slide (displacement or coordinate, m) or swing (angle, rad)"),
    JsonField("travel", NUMBER, "stroke H, m, or swing angle psi, rad", lambda s: s.travel if s.strokes else None),
    JsonField("k", NUMBER, "time ratio k (coefficient of change of mean speed)", lambda s: s.k if s.strokes else None),
    JsonField("rule", TEXT, "rule by which the working stroke was chosen"),
    JsonField("strokes", list_of(STROKE), "strokes, the working stroke first"),
)
TRAVEL = json_record(
    "travel of an output",
    JsonField("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    JsonField("kind", TEXT, "slide or swing"),
    JsonField("low", NUMBER, "least displacement, coordinate or angle, m or rad"),
    JsonField("high", NUMBER, "largest displacement, coordinate or angle, m or rad"),
    JsonField("low_at", NUMBER, "driver coordinate at the least value"),
    JsonField("high_at", NUMBER, "driver coordinate at the largest value"),
)

POSITIONS = json_record(
    "computed positions",
    JsonField("number", list_of(INTEGER), "numbers in the cycle, from 0", "numbers"),
    JsonField("driver", SERIES, "angle of the crank, rad, or displacement of the driving slider, m", "motion.q"),
    JsonField("time", SERIES, "time since position 0, s", "motion.time"),
    JsonField("rate", SERIES, "speed of the driver, rad/s or m/s", "motion.rate"),
    JsonField("placed", FLAGS, "true if the mechanism can be assembled", "motion.placed"),
    JsonField("moving", FLAGS, "true if there are velocities and forces", "motion.moving"),
    JsonField("state", list_of(TEXT), "why a position has no velocities or forces; empty otherwise", position_states),
)


class SlideMotion(NamedTuple):
    """A prismatic pair together with the relative motion in it."""

    slide: Slide
    motion: SlidingMotion


def _slide_motions(results: Results) -> dict[str, SlideMotion]:
    assert results.motion is not None
    slides = () if results.of else results.linkage.slides
    return {slide.name: SlideMotion(slide, results.motion.slide(slide)) for slide in slides}


def _group_margins(results: Results) -> dict[str, Any]:
    assert results.motion is not None
    pairs = zip(results.motion.kernels, results.motion.placements, strict=True)
    return {kernel.group.title: placement.margin for kernel, placement in pairs}


POINT_MOTION = json_record("motion of a point", *quantity_fields(POINT))
SLIDE_MOTION = json_record(
    "motion of the runner along the carrier's guide",
    JsonField("runner", TEXT, "link", "slide.runner"),
    JsonField("carrier", TEXT, "link", "slide.carrier"),
    *attribute_fields("motion", quantity_fields(SLIDE)),
)
KINEMATICS = json_record(
    "motion",
    JsonField("output", optional(TEXT), "output link or coordinate", "mechanism.output"),
    JsonField(
        "points",
        map_of(POINT_MOTION),
        "every named point that moves",
        lambda r: moving_points(r.linkage, r.motion, r.of),
    ),
    JsonField(
        "centres",
        map_of(POINT_MOTION),
        "centres of mass; the name is S and the link",
        lambda r: moving_centres(r.linkage, r.motion, r.of),
    ),
    JsonField(
        "links",
        map_of(json_record("a link", *quantity_fields(LINK))),
        "rotation of every link",
        lambda r: {name: r.motion.link(name) for name in select_links(r.linkage, r.of)},
    ),
    JsonField("slides", map_of(SLIDE_MOTION), "prismatic pairs", _slide_motions),
    JsonField(
        "margins", map_of(SERIES), "distance of each group from its dead position: 1 at best, 0 there", _group_margins
    ),
)


def _pin_forces(results: Results) -> dict[str, dict[str, Vector]]:
    """Return, for every compound hinge, the force that the pin exerts on each link, by point and link."""
    assert results.reactions is not None
    forces: dict[str, dict[str, Vector]] = {}
    for pin in results.reactions.pins(results.linkage):
        forces.setdefault(pin.point, {})[pin.link] = pin.force
    return forces


APPLIED = json_record(
    "G weight, U inertia force with its couple, or a load of the file",
    JsonField("name", TEXT, "name"),
    JsonField("kind", TEXT, "weight, inertia, load, friction"),
    JsonField("link", TEXT, "link"),
    *quantity_fields(LOAD),
)
PAIR_REACTION = json_record(
    "reaction of link `by` on link `on`",
    JsonField("on", TEXT, "link"),
    JsonField("by", TEXT, "link"),
    *quantity_fields(REACTION),
)
DRIVER_BALANCE = json_record(
    "balancing load of a driver",
    JsonField("kind", TEXT, "moment or force: the balancing load to which the reaction of the frame belongs"),
    *quantity_fields(BALANCE),
)
FORCES = json_record(
    "force plan",
    JsonField("loads", list_of(APPLIED), "all loads", "reactions.applied"),
    JsonField("reactions", map_of(PAIR_REACTION), "by pair", lambda r: {x.pair.name: x for x in r.reactions.directed}),
    JsonField("compound_hinges", map_of(map_of(VECTOR)), "force of the pin on each link, by link, N", _pin_forces),
    JsonField("balancing", DRIVER_BALANCE, "balancing load of the first driver", "reactions.balance"),
    JsonField(
        "drivers",
        map_of(DRIVER_BALANCE),
        "balancing load of each driver, by its link",
        lambda r: {balance.driver.link: balance for balance in r.reactions.balances},
    ),
)

LEVER_ITEM = json_record(
    "a force or couple on the lever",
    JsonField("name", TEXT, "name"),
    JsonField("link", TEXT, "link"),
    JsonField("kind", TEXT, "force or couple", lambda item: "force" if item.end is not None else "couple"),
    JsonField("size", SERIES, "N or N*m"),
    JsonField("arm", SERIES, "m per rad; for a couple omega / omega_1"),
    *quantity_fields((LEVER_MOMENT,)),
)
LEVER = json_record(
    "the Zhukovsky lever",
    JsonField(
        "balancing", SERIES, "balancing moment, N*m, or balancing force of a driving slider, N", "lever.balancing"
    ),
    JsonField(
        "difference",
        SERIES,
        "difference from the force plan, relative to the largest value in the cycle",
        "lever.difference",
    ),
    JsonField("limit", NUMBER, "allowed difference", "problem.lever_limit"),
    JsonField("holds", FLAG, "true if the difference is below the limit at every position", "lever_holds"),
    JsonField("items", list_of(LEVER_ITEM), "forces and couples on the lever", "lever.items"),
)
MECHANISM_ENERGY = json_record(
    "power balance, and the mechanism reduced to its first driver",
    *attribute_fields("energy", quantity_fields(ENERGY)),
    JsonField("locked", FLAGS, "locked by friction", "friction.locked", "friction"),
    JsonField("efficiency", NUMBER, "efficiency over the cycle, with friction", "losses.efficiency", "losses"),
    JsonField("friction_work", map_of(NUMBER), "work of friction over the cycle, J, by pair", "losses.pairs", "losses"),
)


def _computes_everything(results: Results) -> bool:
    """Return True if the motion of all points and links was requested, and not only that of some."""
    return results.motion is not None and not results.of


RUN_STEPS = 49


def _run_values(name: str, run: SingleRun) -> Vector:
    """Return a quantity of a single run at RUN_STEPS evenly spaced driver coordinates. name: a method of SingleRun."""
    values: Vector = getattr(run, name)(run.evenly(RUN_STEPS))
    return values


SINGLE = json_record(
    "a single run; SI",
    JsonField("ending", TEXT, "reason for the end: way, standstill, time", "run.ending"),
    JsonField("lasts", NUMBER, "duration, s", lambda r: r.run.time[-1]),
    JsonField("driven", NUMBER, "work of the driving forces, J", lambda r: r.run.driven[-1]),
    JsonField("loaded", NUMBER, "work of the loads, J", lambda r: r.run.loaded[-1]),
    JsonField("braked", NUMBER, "work of the brake, J", lambda r: r.run.braked[-1]),
    JsonField(
        "place",
        list_of(NUMBER),
        "driver coordinates, evenly spaced from the beginning to the end of the run",
        lambda r: r.evenly(RUN_STEPS),
    ),
    *(
        JsonField(key, list_of(NUMBER), text, partial(_run_values, key))
        for key, text in (
            ("time", "time at these coordinates, s"),
            ("speed", "speed of the driver at these coordinates"),
            ("accelerated", "acceleration of the driver at these coordinates"),
            ("kinetic", "kinetic energy at these coordinates, J"),
        )
    ),
)


TANGENT = json_record(
    "a tangent to the energy-mass diagram",
    JsonField("x", NUMBER, "travel of the driver at the point of tangency"),
    JsonField("inertia", NUMBER, "reduced inertia of the links there, kg*m^2"),
    JsonField("energy", NUMBER, "work of all moments there, J"),
    JsonField("slope", NUMBER, "omega^2/2, J/(kg*m^2)"),
    JsonField("offset", NUMBER, "energy at which it crosses the axis of zero inertia, J"),
)
STEADY = json_record(
    "steady running; travel and work begin at position 0, and moments are positive in the direction of the driver",
    *attribute_fields(
        "running",
        (
            JsonField("work", NUMBER, "work of the loads in a cycle, J", "steady.machine.work_of_cycle"),
            JsonField("moment", NUMBER, "mean driving moment, N*m", "steady.moment"),
            JsonField("slowest", NUMBER, "least speed of the driver, rad/s", lambda r: r.steady.speeds[0]),
            JsonField("fastest", NUMBER, "largest speed, rad/s", lambda r: r.steady.speeds[1]),
            JsonField("period", NUMBER, "duration of a cycle, s", "steady.law.period"),
            JsonField("delta", NUMBER, "coefficient of fluctuation of speed", "steady.delta"),
            JsonField(
                "own",
                NUMBER,
                "coefficient of fluctuation with the given flywheel alone; null if the machine stops",
                "steady.own",
            ),
            JsonField(
                "flywheel", NUMBER, "inertia of the flywheel, reduced to the driver, kg*m^2", "steady.law.flywheel"
            ),
            JsonField("on_shaft", NUMBER, "inertia of the flywheel on its own shaft, kg*m^2", "steady.on_shaft"),
            JsonField("wittenbauer", NUMBER, "flywheel by Wittenbauer's tangents, kg*m^2", "steady.wittenbauer"),
            JsonField("mertsalov", NUMBER, "flywheel by Mertsalov, kg*m^2", "steady.mertsalov"),
            JsonField(
                "first_group",
                NUMBER,
                "by Mertsalov, the flywheel with the links of constant speed ratio, kg*m^2",
                "steady.first_group",
            ),
            JsonField(
                "constant",
                NUMBER,
                "reduced inertia of the links of constant speed ratio, kg*m^2",
                "steady.machine.constant",
            ),
            JsonField(
                "errors", list_of(NUMBER), "relative errors of both graphical methods", lambda r: r.steady.errors
            ),
            JsonField("diameter", NUMBER, "diameter of the flywheel, m", "steady.diameter"),
            JsonField("width", NUMBER, "width of the flywheel, m", "steady.width"),
            JsonField("mass", NUMBER, "mass of the flywheel, kg", "steady.mass"),
            JsonField(
                "tangents", list_of(TANGENT), "tangents for the largest and for the least speed", "steady.tangents"
            ),
        ),
    ),
    JsonField("driving", SERIES, "driving moment, N*m", lambda r: r.steady.driving(r.motion.q)),
    JsonField("excess", SERIES, "work of all moments, J", lambda r: r.steady.work(r.motion.q)),
)

MOTION_SECTIONS = (
    JsonField("driver", DRIVER, "the driver", lambda r: r, "motion"),
    JsonField("turns", NUMBER, "turns of the driver after which the motion repeats", "driver_range.turns", "motion"),
    JsonField("pressure", list_of(PRESSURE), "driven links of the groups", there=_computes_everything),
    JsonField(
        "dead_positions", list_of(DEAD), "dead positions within the range of the driver", "dead", _computes_everything
    ),
    JsonField(
        "output",
        optional(OUTPUT),
        "strokes of the output; null if no output is named in the file or found on the frame",
        "strokes",
        _computes_everything,
    ),
    JsonField("further_outputs", list_of(OUTPUT), "strokes of the further outputs", "further", _computes_everything),
    JsonField(
        "travels",
        list_of(TRAVEL),
        "travel of the outputs over the requested positions, if the driver does not rotate fully",
        there=_computes_everything,
    ),
    JsonField("positions", POSITIONS, "computed positions", lambda r: r, "motion"),
    JsonField("kinematics", KINEMATICS, "motion", lambda r: r, "motion"),
    JsonField("forces", FORCES, "force plan", lambda r: r, "lever"),
    JsonField("lever", LEVER, "the Zhukovsky lever", lambda r: r, "lever"),
    JsonField("dynamics", STEADY, "steady running; its cycle begins at position 0", lambda r: r, "steady"),
    JsonField("run", SINGLE, "a single run", there="single", read="single"),
    JsonField("balancing", BALANCING, "shaking force and moment at constant speed of the driver", there="balancing"),
    JsonField(
        "energy",
        MECHANISM_ENERGY,
        "power balance, and the mechanism reduced to its first driver",
        lambda r: r,
        "energy",
    ),
)


# The part of result.json that comes from intermittent motion.


WHEEL_PERIOD = json_record(
    "a part of the cycle",
    JsonField("driven", FLAG, "true if the wheel is driven, false if it is at rest", "ride.driven"),
    JsonField("setting", INTEGER, "index of the setting, from 0"),
    JsonField("start", NUMBER, "driver coordinate at the beginning", "ride.start"),
    JsonField("end", NUMBER, "driver coordinate at the end", "ride.end"),
    JsonField("time", NUMBER, "duration, s; null if the speed of the driver changes"),
    JsonField("from", NUMBER, "angle of the wheel at the beginning, rad", lambda part: part.angles[0]),
    JsonField("step", NUMBER, "rotation of the wheel, rad"),
    JsonField("omega", NUMBER, "largest angular speed, rad/s"),
    JsonField("epsilon", NUMBER, "largest angular acceleration, rad/s^2"),
)
INTERMITTENT_WHEEL = json_record(
    "a wheel that a link drives intermittently",
    JsonField("name", TEXT, "name of the wheel", "task.name"),
    JsonField("link", TEXT, "link that drives it", "task.link"),
    JsonField("when", TEXT, "when the link drives it, as in the file", "task.when"),
    JsonField(
        "settings",
        list_of(map_of(TEXT)),
        "values of parameters as written in the file",
        lambda wheel: [setting.values for setting in wheel.task.settings],
    ),
    JsonField("turn", NUMBER, "rotation in a cycle, rad"),
    JsonField("way", NUMBER, "travel of the driver in a cycle, forward and back"),
    JsonField("standing", NUMBER, "fraction of that travel with the wheel at rest"),
    JsonField("cycles", optional(INTEGER), "number of cycles for a whole number of turns; null if there is none"),
    JsonField("omega", NUMBER, "largest angular speed, rad/s"),
    JsonField("epsilon", NUMBER, "largest angular acceleration while it is driven, rad/s^2"),
    JsonField("shock", NUMBER, "largest jump of angular speed, rad/s; zero if it starts and stops without impact"),
    JsonField("parts", list_of(WHEEL_PERIOD), "periods of motion and rest, in order"),
)
