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
    "by inertia alone",
    JsonField("force", VECTOR, "on the frame, N"),
    JsonField("moment", SERIES, "about `pivot`, N*m"),
)
COUNTERWEIGHT = json_record(
    "a counterweight",
    JsonField("link", TEXT, "its link", "place.link"),
    JsonField("size", NUMBER, "mass times radius, kg*m"),
    JsonField("angle", NUMBER, "from the x axis of the link, rad"),
    JsonField("radius", optional(NUMBER), "m; null where the file tells none", lambda w: w.place.radius or None),
    JsonField("mass", optional(NUMBER), "kg; null likewise"),
)
CORRECTION = json_record(
    "a mass that balances a shaft",
    JsonField("at", NUMBER, "place of its plane, m", lambda mass: mass[0].at),
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
    """Return speed ("rate") or acceleration of the driver at position 0, in its sense, as the file gives them."""
    driver = results.linkage.driver
    if driver.law is None:
        given: float = getattr(driver, name)
        return given
    start, law = np.array([results.start]), results.law
    return float(driver.sense * (law.speed if name == "rate" else law.accelerated)(start)[0])


LIMIT = json_record("a limit", JsonField("at", NUMBER, "place", "place"), JsonField("group", TEXT, "by which group"))
DRIVER = json_record(
    "the input",
    JsonField("link", TEXT, "driven link", "linkage.driver.link"),
    JsonField("kind", TEXT, "turn or slide", "linkage.driver.kind"),
    JsonField("sense", NUMBER, "+1 or -1", "linkage.driver.sense"),
    JsonField("rate", NUMBER, "rad/s or m/s, at position 0, in its sense", lambda r: _initial_rate(r, "rate")),
    JsonField(
        "acceleration",
        NUMBER,
        "rad/s^2 or m/s^2, at position 0, in its sense",
        lambda r: _initial_rate(r, "acceleration"),
    ),
    JsonField("full_turn", FLAG, "whether the crank can turn fully", "driver_range.full"),
    JsonField(
        "range", list_of(NUMBER), "from, to: places of the driver", lambda r: (r.driver_range.start, r.driver_range.end)
    ),
    JsonField("limits", list_of(LIMIT), "where it is stopped", "driver_range.limits"),
)

PRESSURE = json_record(
    "where and how a link is driven",
    JsonField("group", TEXT, "the group"),
    JsonField("link", TEXT, "driven link"),
    JsonField("pair", TEXT, "driven in"),
    JsonField("slides", FLAG, "slides on what holds it, else turns"),
    JsonField("largest", NUMBER, "largest pressure angle, rad"),
    JsonField("at", NUMBER, "place of the driver there", "place"),
    JsonField("other", NUMBER, "the extreme on the other side, rad"),
    JsonField("other_at", NUMBER, "place of the driver there", "other_place"),
    JsonField("allowed", NUMBER, "rad"),
    JsonField("holds", FLAG, "within what is allowed"),
    JsonField("transmission", NUMBER, "least transmission angle, rad"),
    JsonField("gain", NUMBER, "force increase, 1/cos of the largest"),
    JsonField("angles", SERIES, "pressure angle, rad"),
)
DEAD = json_record(
    "a dead position",
    JsonField("at", NUMBER, "place of the driver", "place"),
    JsonField("group", TEXT, "the group"),
    JsonField("margin", NUMBER, "what is left of its margin there"),
)
STROKE = json_record(
    "a stroke",
    JsonField("start", NUMBER, "driver's place at its start"),
    JsonField("length", NUMBER, "how far the driver goes in it"),
    JsonField("from", NUMBER, "place of the output at its start", "low"),
    JsonField("run", NUMBER, "of the output, signed"),
    JsonField("working", FLAG, "working stroke"),
    JsonField(
        "rest",
        NUMBER,
        "how far the driver goes in the dwell after it, if there is one",
        there=lambda stroke: stroke.rest,
    ),
)
OUTPUT = json_record(
    "strokes of an output",
    JsonField("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    JsonField("kind", TEXT, "slide (runs and coordinates, m) or swing (rad)"),
    JsonField("travel", NUMBER, "stroke H, m, or swing psi, rad", lambda s: s.travel if s.strokes else None),
    JsonField("k", NUMBER, "coefficient of change of mean speed", lambda s: s.k if s.strokes else None),
    JsonField("rule", TEXT, "why that stroke is the working one"),
    JsonField("strokes", list_of(STROKE), "the working one first"),
)
TRAVEL = json_record(
    "extremes",
    JsonField("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    JsonField("kind", TEXT, "slide or swing"),
    JsonField("low", NUMBER, "least run, m or rad"),
    JsonField("high", NUMBER, "greatest"),
    JsonField("low_at", NUMBER, "place of the driver there"),
    JsonField("high_at", NUMBER, "and there"),
)

POSITIONS = json_record(
    "which positions",
    JsonField("number", list_of(INTEGER), "numbers in the cycle, from 0", "numbers"),
    JsonField("driver", SERIES, "angle of the crank, rad, or run of the driven slider, m", "motion.q"),
    JsonField("time", SERIES, "s since position 0", "motion.time"),
    JsonField("rate", SERIES, "speed of the driver, rad/s or m/s", "motion.rate"),
    JsonField("placed", FLAGS, "can be assembled", "motion.placed"),
    JsonField("moving", FLAGS, "has velocities and forces", "motion.moving"),
    JsonField("state", list_of(TEXT), "what is wrong with a position, or nothing", position_states),
)


class SlideMotion(NamedTuple):
    """A prismatic pair and its motion."""

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
        "centres of mass, S and the link",
        lambda r: moving_centres(r.linkage, r.motion, r.of),
    ),
    JsonField(
        "links",
        map_of(json_record("a link", *quantity_fields(LINK))),
        "turning of every link",
        lambda r: {name: r.motion.link(name) for name in select_links(r.linkage, r.of)},
    ),
    JsonField("slides", map_of(SLIDE_MOTION), "sliding pairs", _slide_motions),
    JsonField(
        "margins", map_of(SERIES), "distance of each group from its dead position: 1 at best, 0 there", _group_margins
    ),
)


def _pin_forces(results: Results) -> dict[str, dict[str, Vector]]:
    """Return the force of each compound hinge's pin on each link, by point and link."""
    assert results.reactions is not None
    found: dict[str, dict[str, Vector]] = {}
    for pin in results.reactions.pins(results.linkage):
        found.setdefault(pin.point, {})[pin.link] = pin.force
    return found


APPLIED = json_record(
    "G weight, U inertia force with its couple, or a load of the file",
    JsonField("name", TEXT, "name"),
    JsonField("kind", TEXT, "weight, inertia, load, friction"),
    JsonField("link", TEXT, "link"),
    *quantity_fields(LOAD),
)
PAIR_REACTION = json_record(
    "what link `by` does to link `on`",
    JsonField("on", TEXT, "link"),
    JsonField("by", TEXT, "link"),
    *quantity_fields(REACTION),
)
DRIVER_BALANCE = json_record(
    "what balances a driver",
    JsonField("kind", TEXT, "moment or force: which the frame's reaction belongs to"),
    *quantity_fields(BALANCE),
)
FORCES = json_record(
    "force plan",
    JsonField("loads", list_of(APPLIED), "everything applied", "reactions.applied"),
    JsonField("reactions", map_of(PAIR_REACTION), "by pair", lambda r: {x.pair.name: x for x in r.reactions.directed}),
    JsonField("compound_hinges", map_of(map_of(VECTOR)), "force of the pin on each link, by link, N", _pin_forces),
    JsonField("balancing", DRIVER_BALANCE, "what balances the first driver", "reactions.balance"),
    JsonField(
        "drivers",
        map_of(DRIVER_BALANCE),
        "what balances each driver, by its link",
        lambda r: {balance.driver.link: balance for balance in r.reactions.balances},
    ),
)

LEVER_ITEM = json_record(
    "one of them",
    JsonField("name", TEXT, "name"),
    JsonField("link", TEXT, "link"),
    JsonField("kind", TEXT, "force or couple", lambda item: "force" if item.end is not None else "couple"),
    JsonField("size", SERIES, "N or N*m"),
    JsonField("arm", SERIES, "m per rad; for a couple omega / omega_1"),
    *quantity_fields((LEVER_MOMENT,)),
)
LEVER = json_record(
    "the Zhukovsky lever",
    JsonField("balancing", SERIES, "moment, N*m, or force of a driven slider, N", "lever.balancing"),
    JsonField("difference", SERIES, "from the force plan, relative to the largest in the cycle", "lever.difference"),
    JsonField("limit", NUMBER, "allowed difference", "problem.lever_limit"),
    JsonField("holds", FLAG, "below the limit at every position", "lever_holds"),
    JsonField("items", list_of(LEVER_ITEM), "forces and couples on the lever", "lever.items"),
)
MECHANISM_ENERGY = json_record(
    "power balance, and the mechanism reduced to its first driver",
    *attribute_fields("energy", quantity_fields(ENERGY)),
    JsonField("locked", FLAGS, "locked by friction", "friction.locked", "friction"),
    JsonField("efficiency", NUMBER, "with friction: over the cycle", "losses.efficiency", "losses"),
    JsonField("friction_work", map_of(NUMBER), "work of friction over the cycle, J, by pair", "losses.pairs", "losses"),
)


def _computes_everything(results: Results) -> bool:
    """Return True unless only some points and links were requested."""
    return results.motion is not None and not results.of


RUN_STEPS = 49


def _run_values(name: str, run: SingleRun) -> Vector:
    """Return a function of the driver coordinate (its `name` in the run) at RUN_STEPS even steps."""
    found: Vector = getattr(run, name)(run.evenly(RUN_STEPS))
    return found


SINGLE = json_record(
    "a single run; SI",
    JsonField("ending", TEXT, "what ended it: way, standstill, time", "run.ending"),
    JsonField("lasts", NUMBER, "s", lambda r: r.run.time[-1]),
    JsonField("driven", NUMBER, "work of what drives, J", lambda r: r.run.driven[-1]),
    JsonField("loaded", NUMBER, "work of the loads, J", lambda r: r.run.loaded[-1]),
    JsonField("braked", NUMBER, "work of the brake, J", lambda r: r.run.braked[-1]),
    JsonField(
        "place",
        list_of(NUMBER),
        "of the driver, in even steps from the beginning to the end of the run",
        lambda r: r.evenly(RUN_STEPS),
    ),
    *(
        JsonField(key, list_of(NUMBER), text, partial(_run_values, key))
        for key, text in (
            ("time", "there, s"),
            ("speed", "of the driver there"),
            ("accelerated", "its acceleration there"),
            ("kinetic", "kinetic energy there, J"),
        )
    ),
)


TANGENT = json_record(
    "a tangent to the energy-mass diagram",
    JsonField("x", NUMBER, "way of the driver at which it touches"),
    JsonField("inertia", NUMBER, "reduced inertia of the links there, kg*m^2"),
    JsonField("energy", NUMBER, "work of all moments there, J"),
    JsonField("slope", NUMBER, "omega^2/2, J/(kg*m^2)"),
    JsonField("offset", NUMBER, "energy that it cuts off where the inertia is zero, J"),
)
STEADY = json_record(
    "steady running; ways, works and moments begin at position 0 and go in the sense of the driver",
    *attribute_fields(
        "running",
        (
            JsonField("work", NUMBER, "of the loads in a cycle, J", "steady.machine.work_of_cycle"),
            JsonField("moment", NUMBER, "mean driving moment, N*m", "steady.moment"),
            JsonField("slowest", NUMBER, "least speed of the driver, rad/s", lambda r: r.steady.speeds[0]),
            JsonField("fastest", NUMBER, "largest speed, rad/s", lambda r: r.steady.speeds[1]),
            JsonField("period", NUMBER, "of a cycle, s", "steady.law.period"),
            JsonField("delta", NUMBER, "fluctuation of speed", "steady.delta"),
            JsonField(
                "own", NUMBER, "fluctuation with the given flywheel alone; null where the machine stops", "steady.own"
            ),
            JsonField("flywheel", NUMBER, "its inertia, reduced to the driver, kg*m^2", "steady.law.flywheel"),
            JsonField("on_shaft", NUMBER, "its inertia on its own shaft, kg*m^2", "steady.on_shaft"),
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
            JsonField("errors", list_of(NUMBER), "of both, shares of the exact one", lambda r: r.steady.errors),
            JsonField("diameter", NUMBER, "of the flywheel, m", "steady.diameter"),
            JsonField("width", NUMBER, "of the flywheel, m", "steady.width"),
            JsonField("mass", NUMBER, "of the flywheel, kg", "steady.mass"),
            JsonField("tangents", list_of(TANGENT), "of the largest and of the least speed", "steady.tangents"),
        ),
    ),
    JsonField("driving", SERIES, "driving moment, N*m", lambda r: r.steady.driving(r.motion.q)),
    JsonField("excess", SERIES, "work of all moments, J", lambda r: r.steady.work(r.motion.q)),
)

MOTION_SECTIONS = (
    JsonField("driver", DRIVER, "the input", lambda r: r, "motion"),
    JsonField("turns", NUMBER, "turns of the driver after which everything repeats", "driver_range.turns", "motion"),
    JsonField("pressure", list_of(PRESSURE), "driven links of the groups", there=_computes_everything),
    JsonField("dead_positions", list_of(DEAD), "inside the range of the driver", "dead", _computes_everything),
    JsonField(
        "output",
        optional(OUTPUT),
        "strokes of the output; null when none is named or found on the frame",
        "strokes",
        _computes_everything,
    ),
    JsonField("further_outputs", list_of(OUTPUT), "of the others, as the first one", "further", _computes_everything),
    JsonField(
        "travels",
        list_of(TRAVEL),
        "outputs where the driver does not turn fully, over the positions asked",
        there=_computes_everything,
    ),
    JsonField("positions", POSITIONS, "which positions", lambda r: r, "motion"),
    JsonField("kinematics", KINEMATICS, "motion", lambda r: r, "motion"),
    JsonField("forces", FORCES, "force plan", lambda r: r, "lever"),
    JsonField("lever", LEVER, "the Zhukovsky lever", lambda r: r, "lever"),
    JsonField("dynamics", STEADY, "steady running; its cycle begins at position 0", lambda r: r, "steady"),
    JsonField("run", SINGLE, "a single run", there="single", read="single"),
    JsonField("balancing", BALANCING, "what shakes the frame at constant speed of the driver", there="balancing"),
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
    JsonField("driven", FLAG, "whether the wheel is driven, else it stands", "ride.driven"),
    JsonField("setting", INTEGER, "which of the settings, from 0"),
    JsonField("start", NUMBER, "driver's place at its beginning", "ride.start"),
    JsonField("end", NUMBER, "driver's place at its end", "ride.end"),
    JsonField("time", NUMBER, "that it takes, s; null where the driver's speed changes"),
    JsonField("from", NUMBER, "angle of the wheel at its beginning, rad", lambda part: part.angles[0]),
    JsonField("step", NUMBER, "of the wheel, rad"),
    JsonField("omega", NUMBER, "largest angular speed, rad/s"),
    JsonField("epsilon", NUMBER, "largest angular acceleration, rad/s^2"),
)
INTERMITTENT_WHEEL = json_record(
    "a wheel that a link takes along",
    JsonField("name", TEXT, "of the wheel", "task.name"),
    JsonField("link", TEXT, "that moves it", "task.link"),
    JsonField("when", TEXT, "as the file says", "task.when"),
    JsonField(
        "settings",
        list_of(map_of(TEXT)),
        "values of parameters as the file writes them",
        lambda wheel: [setting.values for setting in wheel.task.settings],
    ),
    JsonField("turn", NUMBER, "in a cycle, rad"),
    JsonField("way", NUMBER, "of the driver in a cycle, there and back"),
    JsonField("standing", NUMBER, "share of that way on which it stands"),
    JsonField("cycles", optional(INTEGER), "in which it makes whole turns; null where there are none"),
    JsonField("omega", NUMBER, "largest angular speed, rad/s"),
    JsonField("epsilon", NUMBER, "largest angular acceleration while it is driven, rad/s^2"),
    JsonField(
        "shock", NUMBER, "largest jump of angular speed, rad/s; zero where it is taken up and let go without shock"
    ),
    JsonField("parts", list_of(WHEEL_PERIOD), "one after another"),
)
