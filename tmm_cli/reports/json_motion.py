"""The parts of result.json that come from motion and forces; all are read from Results."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_cli.mechanics.analysis import Results, moving_centres, moving_points, select_links
from tmm_cli.mechanics.kinematics import SlidingMotion
from tmm_cli.mechanics.linkage import Slide
from tmm_cli.mechanics.numerics import Vector
from tmm_cli.mechanics.quantities import BALANCE, ENERGY, LEVER_MOMENT, LINK, LOAD, POINT, REACTION, SLIDE
from tmm_cli.reports.cycle_tables import states
from tmm_cli.reports.json_fields import (
    FLAG,
    FLAGS,
    INTEGER,
    NUMBER,
    SERIES,
    TEXT,
    VECTOR,
    Field,
    fields_of,
    inside,
    list_of,
    map_of,
    optional,
    record,
)

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SingleRun


SHAKING = record(
    "by inertia alone",
    Field("force", VECTOR, "on the frame, N"),
    Field("moment", SERIES, "about `pivot`, N*m"),
)
COUNTERWEIGHT = record(
    "a counterweight",
    Field("link", TEXT, "its link", "place.link"),
    Field("size", NUMBER, "mass times radius, kg*m"),
    Field("angle", NUMBER, "from the x axis of the link, rad"),
    Field("radius", optional(NUMBER), "m; null where the file tells none", lambda w: w.place.radius or None),
    Field("mass", optional(NUMBER), "kg; null likewise"),
)
CORRECTION = record(
    "a mass that balances a shaft",
    Field("at", NUMBER, "place of its plane, m", lambda mass: mass[0].at),
    Field("size", NUMBER, "mass times radius, kg*m", lambda mass: abs(mass[1])),
    Field("angle", NUMBER, "rad", lambda mass: float(np.angle(mass[1]))),
)
BALANCING = record(
    "balancing",
    Field("pivot", TEXT, "moments are about this point; empty: about the origin"),
    Field("before", SHAKING, "at the positions"),
    Field("counterweights", list_of(COUNTERWEIGHT), "that leave the least force", "cycle.counterweights"),
    Field("after", SHAKING, "at the positions, with counterweights"),
    Field("left", NUMBER, "largest force over the cycle with counterweights, over that without", "cycle.left"),
    Field(
        "rotor",
        list_of(CORRECTION),
        "masses on the shaft",
        lambda found: zip(found.task.rotor.planes, found.corrections.tolist(), strict=True),
        lambda found: found.task.rotor is not None,
    ),
)


def _at_start(results: Results, name: str) -> float:
    """Speed or acceleration of the driver at position 0, in its sense; beside the block dynamics, as they are given."""
    driver = results.linkage.driver
    if driver.law is None:
        given: float = getattr(driver, name)
        return given
    start, law = np.array([results.start]), results.law
    return float(driver.sense * (law.speed if name == "rate" else law.accelerated)(start)[0])


LIMIT = record("a limit", Field("at", NUMBER, "place", "place"), Field("group", TEXT, "by which group"))
DRIVER = record(
    "the input",
    Field("link", TEXT, "driven link", "linkage.driver.link"),
    Field("kind", TEXT, "turn or slide", "linkage.driver.kind"),
    Field("sense", NUMBER, "+1 or -1", "linkage.driver.sense"),
    Field("rate", NUMBER, "rad/s or m/s, at position 0, in its sense", lambda r: _at_start(r, "rate")),
    Field(
        "acceleration", NUMBER, "rad/s^2 or m/s^2, at position 0, in its sense", lambda r: _at_start(r, "acceleration")
    ),
    Field("full_turn", FLAG, "whether the crank can turn fully", "driver_range.full"),
    Field(
        "range", list_of(NUMBER), "from, to: places of the driver", lambda r: (r.driver_range.start, r.driver_range.end)
    ),
    Field("limits", list_of(LIMIT), "where it is stopped", "driver_range.limits"),
)

PRESSURE = record(
    "where and how a link is driven",
    Field("group", TEXT, "the group"),
    Field("link", TEXT, "driven link"),
    Field("pair", TEXT, "driven in"),
    Field("slides", FLAG, "slides on what holds it, else turns"),
    Field("largest", NUMBER, "largest pressure angle, rad"),
    Field("at", NUMBER, "place of the driver there", "place"),
    Field("other", NUMBER, "the extreme on the other side, rad"),
    Field("other_at", NUMBER, "place of the driver there", "other_place"),
    Field("allowed", NUMBER, "rad"),
    Field("holds", FLAG, "within what is allowed"),
    Field("transmission", NUMBER, "least transmission angle, rad"),
    Field("gain", NUMBER, "force increase, 1/cos of the largest"),
    Field("angles", SERIES, "pressure angle, rad"),
)
DEAD = record(
    "a dead position",
    Field("at", NUMBER, "place of the driver", "place"),
    Field("group", TEXT, "the group"),
    Field("margin", NUMBER, "what is left of its margin there"),
)
STROKE = record(
    "a stroke",
    Field("start", NUMBER, "driver's place at its start"),
    Field("length", NUMBER, "how far the driver goes in it"),
    Field("from", NUMBER, "place of the output at its start", "low"),
    Field("run", NUMBER, "of the output, signed"),
    Field("working", FLAG, "working stroke"),
    Field(
        "rest",
        NUMBER,
        "how far the driver goes in the dwell after it, if there is one",
        there=lambda stroke: stroke.rest,
    ),
)
OUTPUT = record(
    "strokes of an output",
    Field("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    Field("kind", TEXT, "slide (runs and coordinates, m) or swing (rad)"),
    Field("travel", NUMBER, "stroke H, m, or swing psi, rad", lambda s: s.travel if s.strokes else None),
    Field("k", NUMBER, "coefficient of change of mean speed", lambda s: s.k if s.strokes else None),
    Field("rule", TEXT, "why that stroke is the working one"),
    Field("strokes", list_of(STROKE), "the working one first"),
)
TRAVEL = record(
    "extremes",
    Field("link", TEXT, "output link, or coordinate of a point, K.x or K.y"),
    Field("kind", TEXT, "slide or swing"),
    Field("low", NUMBER, "least run, m or rad"),
    Field("high", NUMBER, "greatest"),
    Field("low_at", NUMBER, "place of the driver there"),
    Field("high_at", NUMBER, "and there"),
)

POSITIONS = record(
    "which positions",
    Field("number", list_of(INTEGER), "numbers in the cycle, from 0", "numbers"),
    Field("driver", SERIES, "angle of the crank, rad, or run of the driven slider, m", "motion.q"),
    Field("time", SERIES, "s since position 0", "motion.time"),
    Field("rate", SERIES, "speed of the driver, rad/s or m/s", "motion.rate"),
    Field("placed", FLAGS, "can be assembled", "motion.placed"),
    Field("moving", FLAGS, "has velocities and forces", "motion.moving"),
    Field("state", list_of(TEXT), "what is wrong with a position, or nothing", states),
)


class SlideMotion(NamedTuple):
    """A sliding pair and how it moves."""

    slide: Slide
    motion: SlidingMotion


def _slides(results: Results) -> dict[str, SlideMotion]:
    assert results.motion is not None
    slides = () if results.of else results.linkage.slides
    return {slide.name: SlideMotion(slide, results.motion.slide(slide)) for slide in slides}


def _margins(results: Results) -> dict[str, Any]:
    assert results.motion is not None
    pairs = zip(results.motion.kernels, results.motion.placements, strict=True)
    return {kernel.group.title: placement.margin for kernel, placement in pairs}


POINT_MOTION = record("motion of a point", *fields_of(POINT))
SLIDE_MOTION = record(
    "motion of the runner along the carrier's guide",
    Field("runner", TEXT, "link", "slide.runner"),
    Field("carrier", TEXT, "link", "slide.carrier"),
    *inside("motion", fields_of(SLIDE)),
)
KINEMATICS = record(
    "motion",
    Field("output", optional(TEXT), "output link or coordinate", "mechanism.output"),
    Field(
        "points",
        map_of(POINT_MOTION),
        "every named point that moves",
        lambda r: moving_points(r.linkage, r.motion, r.of),
    ),
    Field(
        "centres",
        map_of(POINT_MOTION),
        "centres of mass, S and the link",
        lambda r: moving_centres(r.linkage, r.motion, r.of),
    ),
    Field(
        "links",
        map_of(record("a link", *fields_of(LINK))),
        "turning of every link",
        lambda r: {name: r.motion.link(name) for name in select_links(r.linkage, r.of)},
    ),
    Field("slides", map_of(SLIDE_MOTION), "sliding pairs", _slides),
    Field("margins", map_of(SERIES), "distance of each group from its dead position: 1 at best, 0 there", _margins),
)


def _pins(results: Results) -> dict[str, dict[str, Vector]]:
    """At a compound hinge, what the pin does to each link."""
    assert results.reactions is not None
    found: dict[str, dict[str, Vector]] = {}
    for pin in results.reactions.pins(results.linkage):
        found.setdefault(pin.point, {})[pin.link] = pin.force
    return found


APPLIED = record(
    "G weight, U inertia force with its couple, or a load of the file",
    Field("name", TEXT, "name"),
    Field("kind", TEXT, "weight, inertia, load, friction"),
    Field("link", TEXT, "link"),
    *fields_of(LOAD),
)
PAIR_REACTION = record(
    "what link `by` does to link `on`", Field("on", TEXT, "link"), Field("by", TEXT, "link"), *fields_of(REACTION)
)
DRIVER_BALANCE = record(
    "what balances a driver",
    Field("kind", TEXT, "moment or force: which the frame's reaction belongs to"),
    *fields_of(BALANCE),
)
FORCES = record(
    "force plan",
    Field("loads", list_of(APPLIED), "everything applied", "reactions.applied"),
    Field("reactions", map_of(PAIR_REACTION), "by pair", lambda r: {x.pair.name: x for x in r.reactions.directed}),
    Field("compound_hinges", map_of(map_of(VECTOR)), "force of the pin on each link, by link, N", _pins),
    Field("balancing", DRIVER_BALANCE, "what balances the first driver", "reactions.balance"),
    Field(
        "drivers",
        map_of(DRIVER_BALANCE),
        "what balances each driver, by its link",
        lambda r: {balance.driver.link: balance for balance in r.reactions.balances},
    ),
)

LEVER_ITEM = record(
    "one of them",
    Field("name", TEXT, "name"),
    Field("link", TEXT, "link"),
    Field("kind", TEXT, "force or couple", lambda item: "force" if item.end is not None else "couple"),
    Field("size", SERIES, "N or N*m"),
    Field("arm", SERIES, "m per rad; for a couple omega / omega_1"),
    *fields_of((LEVER_MOMENT,)),
)
LEVER = record(
    "the Zhukovsky lever",
    Field("balancing", SERIES, "moment, N*m, or force of a driven slider, N", "lever.balancing"),
    Field("difference", SERIES, "from the force plan, relative to the largest in the cycle", "lever.difference"),
    Field("limit", NUMBER, "allowed difference", "problem.lever_limit"),
    Field("holds", FLAG, "below the limit at every position", "lever_holds"),
    Field("items", list_of(LEVER_ITEM), "forces and couples on the lever", "lever.items"),
)
MECHANISM_ENERGY = record(
    "power balance, and the mechanism reduced to its first driver",
    *inside("energy", fields_of(ENERGY)),
    Field("locked", FLAGS, "locked by friction", "friction.locked", "friction"),
    Field("efficiency", NUMBER, "with friction: over the cycle", "losses.efficiency", "losses"),
    Field("friction_work", map_of(NUMBER), "work of friction over the cycle, J, by pair", "losses.pairs", "losses"),
)


def _whole(results: Results) -> bool:
    """Whether all is asked for, not some points and links only."""
    return results.motion is not None and not results.of


RUN_STEPS = 49


def _along_run(name: str, run: SingleRun) -> Vector:
    """One of its functions of the driver's place, in even steps."""
    found: Vector = getattr(run, name)(run.evenly(RUN_STEPS))
    return found


SINGLE = record(
    "a single run; SI",
    Field("ending", TEXT, "what ended it: way, standstill, time", "run.ending"),
    Field("lasts", NUMBER, "s", lambda r: r.run.time[-1]),
    Field("driven", NUMBER, "work of what drives, J", lambda r: r.run.driven[-1]),
    Field("loaded", NUMBER, "work of the loads, J", lambda r: r.run.loaded[-1]),
    Field("braked", NUMBER, "work of the brake, J", lambda r: r.run.braked[-1]),
    Field(
        "place",
        list_of(NUMBER),
        "of the driver, in even steps from the beginning to the end of the run",
        lambda r: r.evenly(RUN_STEPS),
    ),
    *(
        Field(key, list_of(NUMBER), text, partial(_along_run, key))
        for key, text in (
            ("time", "there, s"),
            ("speed", "of the driver there"),
            ("accelerated", "its acceleration there"),
            ("kinetic", "kinetic energy there, J"),
        )
    ),
)


TANGENT = record(
    "a tangent to the energy-mass diagram",
    Field("x", NUMBER, "way of the driver at which it touches"),
    Field("inertia", NUMBER, "reduced inertia of the links there, kg*m^2"),
    Field("energy", NUMBER, "work of all moments there, J"),
    Field("slope", NUMBER, "omega^2/2, J/(kg*m^2)"),
    Field("offset", NUMBER, "energy that it cuts off where the inertia is zero, J"),
)
STEADY = record(
    "steady running; ways, works and moments begin at position 0 and go in the sense of the driver",
    *inside(
        "running",
        (
            Field("work", NUMBER, "of the loads in a cycle, J", "steady.machine.work_of_cycle"),
            Field("moment", NUMBER, "mean driving moment, N*m", "steady.moment"),
            Field("slowest", NUMBER, "least speed of the driver, rad/s", lambda r: r.steady.speeds[0]),
            Field("fastest", NUMBER, "largest speed, rad/s", lambda r: r.steady.speeds[1]),
            Field("period", NUMBER, "of a cycle, s", "steady.law.period"),
            Field("delta", NUMBER, "fluctuation of speed", "steady.delta"),
            Field(
                "own", NUMBER, "fluctuation with the given flywheel alone; null where the machine stops", "steady.own"
            ),
            Field("flywheel", NUMBER, "its inertia, reduced to the driver, kg*m^2", "steady.law.flywheel"),
            Field("on_shaft", NUMBER, "its inertia on its own shaft, kg*m^2", "steady.on_shaft"),
            Field("wittenbauer", NUMBER, "flywheel by Wittenbauer's tangents, kg*m^2", "steady.wittenbauer"),
            Field("mertsalov", NUMBER, "flywheel by Mertsalov, kg*m^2", "steady.mertsalov"),
            Field(
                "first_group",
                NUMBER,
                "by Mertsalov, the flywheel with the links of constant speed ratio, kg*m^2",
                "steady.first_group",
            ),
            Field(
                "constant",
                NUMBER,
                "reduced inertia of the links of constant speed ratio, kg*m^2",
                "steady.machine.constant",
            ),
            Field("errors", list_of(NUMBER), "of both, shares of the exact one", lambda r: r.steady.errors),
            Field("diameter", NUMBER, "of the flywheel, m", "steady.diameter"),
            Field("width", NUMBER, "of the flywheel, m", "steady.width"),
            Field("mass", NUMBER, "of the flywheel, kg", "steady.mass"),
            Field("tangents", list_of(TANGENT), "of the largest and of the least speed", "steady.tangents"),
        ),
    ),
    Field("driving", SERIES, "driving moment, N*m", lambda r: r.steady.driving(r.motion.q)),
    Field("excess", SERIES, "work of all moments, J", lambda r: r.steady.work(r.motion.q)),
)

MOTION_PARTS = (
    Field("driver", DRIVER, "the input", lambda r: r, "motion"),
    Field("turns", NUMBER, "turns of the driver after which everything repeats", "driver_range.turns", "motion"),
    Field("pressure", list_of(PRESSURE), "driven links of the groups", there=_whole),
    Field("dead_positions", list_of(DEAD), "inside the range of the driver", "dead", _whole),
    Field(
        "output",
        optional(OUTPUT),
        "strokes of the output; null when none is named or found on the frame",
        "strokes",
        _whole,
    ),
    Field("further_outputs", list_of(OUTPUT), "of the others, as the first one", "further", _whole),
    Field(
        "travels",
        list_of(TRAVEL),
        "outputs where the driver does not turn fully, over the positions asked",
        there=_whole,
    ),
    Field("positions", POSITIONS, "which positions", lambda r: r, "motion"),
    Field("kinematics", KINEMATICS, "motion", lambda r: r, "motion"),
    Field("forces", FORCES, "force plan", lambda r: r, "lever"),
    Field("lever", LEVER, "the Zhukovsky lever", lambda r: r, "lever"),
    Field("dynamics", STEADY, "steady running; its cycle begins at position 0", lambda r: r, "steady"),
    Field("run", SINGLE, "a single run", there="single", read="single"),
    Field("balancing", BALANCING, "what shakes the frame at constant speed of the driver", there="balancing"),
    Field(
        "energy",
        MECHANISM_ENERGY,
        "power balance, and the mechanism reduced to its first driver",
        lambda r: r,
        "energy",
    ),
)


# The part of result.json that comes from intermittent motion.


PART = record(
    "a part of the cycle",
    Field("driven", FLAG, "whether the wheel is driven, else it stands", "ride.driven"),
    Field("setting", INTEGER, "which of the settings, from 0"),
    Field("start", NUMBER, "driver's place at its beginning", "ride.start"),
    Field("end", NUMBER, "driver's place at its end", "ride.end"),
    Field("time", NUMBER, "that it takes, s; null where the driver's speed changes"),
    Field("from", NUMBER, "angle of the wheel at its beginning, rad", lambda part: part.angles[0]),
    Field("step", NUMBER, "of the wheel, rad"),
    Field("omega", NUMBER, "largest angular speed, rad/s"),
    Field("epsilon", NUMBER, "largest angular acceleration, rad/s^2"),
)
WHEEL = record(
    "a wheel that a link takes along",
    Field("name", TEXT, "of the wheel", "task.name"),
    Field("link", TEXT, "that moves it", "task.link"),
    Field("when", TEXT, "as the file says", "task.when"),
    Field(
        "settings",
        list_of(map_of(TEXT)),
        "values of parameters as the file writes them",
        lambda wheel: [setting.values for setting in wheel.task.settings],
    ),
    Field("turn", NUMBER, "in a cycle, rad"),
    Field("way", NUMBER, "of the driver in a cycle, there and back"),
    Field("standing", NUMBER, "share of that way on which it stands"),
    Field("cycles", optional(INTEGER), "in which it makes whole turns; null where there are none"),
    Field("omega", NUMBER, "largest angular speed, rad/s"),
    Field("epsilon", NUMBER, "largest angular acceleration while it is driven, rad/s^2"),
    Field("shock", NUMBER, "largest jump of angular speed, rad/s; zero where it is taken up and let go without shock"),
    Field("parts", list_of(PART), "one after another"),
)
