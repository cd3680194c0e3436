"""What a file was understood to say, as tables of words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    SPEED,
    Dimension,
    place_dimension,
)
from tmm_cli.problem import Problem
from tmm_cli.reports.given_dynamics import law_of_motion
from tmm_cli.reports.given_loads import loads, masses
from tmm_cli.reports.given_parts import FILE_WORDS, parts, show, show_vector, speed, speeds
from tmm_cli.reports.stages import link_name
from tmm_cli.reports.synthesis_tables import parameters
from tmm_cli.reports.table import Table, table_of_words

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import WheelTask


def input_tables(problem: Problem) -> Iterable[Table]:
    """The file in full."""
    if problem.synthesis is not None and problem.synthesis.names:
        yield parameters(problem.synthesis, problem.units)
    yield _points(problem)
    if problem.linkage.slides:
        yield _slides(problem)
    yield table_of_words("facts", _("Driver, positions, limits"), (_("what"), _("value")), _facts(problem))
    if problem.linkage.driver.law is not None:
        yield speeds(problem, problem.linkage.driver.law)
    yield from parts(problem)
    if any(np.any(link.mass != 0) for link in problem.linkage.links.values()):
        yield masses(problem)
    if problem.linkage.loads:
        yield from loads(problem)
    if problem.dynamics is not None:
        yield from law_of_motion(problem, problem.dynamics)


def _points(problem: Problem) -> Table:
    rows = [
        (link_name(name), point, show_vector(problem, local))
        for name, link in problem.linkage.links.items()
        for point, local in link.points.items()
    ]
    note = _("Lengths in {unit}. A point on two links is a hinge; on three and more, a compound hinge.")
    return table_of_words(
        "points",
        _("Points, each in the axes of its link"),
        (_("link"), _("point"), _("place")),
        rows,
        (note.format(unit=problem.units.spelt(LENGTH)),),
    )


def _slides(problem: Problem) -> Table:
    return table_of_words(
        "slides",
        _("Sliding pairs"),
        (_("pair"), _("link"), _("point"), _("slides on"), _("guide through"), _("guide's angle"), _("turned by")),
        [
            (
                s.name,
                s.runner,
                s.point,
                link_name(s.carrier),
                show_vector(problem, s.through),
                show(problem, s.direction, ANGLE),
                show(problem, s.turned, ANGLE),
            )
            for s in problem.linkage.slides
        ],
    )


def _facts(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage, units = problem.linkage, problem.units
    driver, measure = linkage.driver, place_dimension(linkage.driver.kind)
    dimensions = (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA)
    yield _("bare numbers are in"), ", ".join(units.spelt(dimension) for dimension in dimensions)
    yield _("a bare speed is in"), units.spelt(ANGULAR_SPEED if driver.kind == "turn" else SPEED)
    if driver.kind == "slide":
        text = _("link {link}, {speed}")
    elif driver.sense > 0:
        text = _("link {link}, {speed} counterclockwise")
    else:
        text = _("link {link}, {speed} clockwise")
    yield _("driver"), text.format(link=driver.link, speed=speed(driver))
    yield _("gravity"), f"[{linkage.gravity.real:.6g}, {linkage.gravity.imag:.6g}] {spelt('m/s^2')}"
    if linkage.turns > 1:
        yield _("loads come again after"), _("{turns} turns of the crank").format(turns=linkage.turns)
    for wheel in problem.wheels:
        yield _("wheel {name}").format(name=wheel.name), _wheel(wheel)
    yield _("positions"), _positions(problem, measure)
    sketch = linkage.sketch
    places = [show(problem, sketch.at, measure)]
    places += [f"{name} {show_vector(problem, place)}" for name, place in sketch.points.items()]
    places += [f"{name} {show(problem, angle, ANGLE)}" for name, angle in sketch.angles.items()]
    yield _("sketch, driver at"), ", ".join(places)
    yield from ((_("law of motion") if not row else "", told) for row, told in enumerate(_law(problem)))
    yield _("limit of the lever check"), f"{numeral(100 * problem.lever_limit, '.6g')} %"


def _wheel(wheel: WheelTask) -> str:
    """What takes it along, and when."""
    words = {
        "forward": _("moves with link {link} while that turns counterclockwise, and stands else"),
        "backward": _("moves with link {link} while that turns clockwise, and stands else"),
        "working stroke": _("moves with link {link} in the working stroke, and stands else"),
        "idle stroke": _("moves with link {link} in the idle stroke, and stands else"),
    }
    told = [words[wheel.when].format(link=wheel.link)]
    if len(wheel.settings) > 1:
        settings = [", ".join(f"{name} = {value}" for name, value in s.values.items()) for s in wheel.settings]
        text = _("settings take turns, one a cycle of the driver: {settings}")
        told.append(text.format(settings="; ".join(own or _("as the file says") for own in settings)))
    return "; ".join(told)


def _law(problem: Problem) -> Iterable[str]:
    """What is computed of it."""
    task = problem.dynamics
    if task is None:
        yield _("given; without a block `dynamics` nothing of it is computed")
        return
    if not task.cyclic:
        yield _("of a single run, integrated by time")
        return
    yield _("of steady running, from the reduced inertia and the reduced moment over the cycle")
    if task.motor is not None:
        yield _("driven by the characteristic of its motor")
    else:
        speed = show(problem, task.mean, ANGULAR_SPEED)
        yield _("driven by a constant moment that leaves no work over the cycle, mean speed {speed}").format(
            speed=speed
        )
    if task.flywheel:
        given = show(problem, task.flywheel, INERTIA)
        yield _("with a flywheel of {inertia}, reduced to the driver").format(inertia=given)
    if task.delta is not None:
        yield _("a flywheel is found that keeps delta = {delta}").format(delta=numeral(task.delta, ".4g"))
    yield _("forces with the speeds and accelerations of this law")


def _positions(problem: Problem, measure: Dimension) -> str:
    request, driver = problem.request, problem.linkage.driver
    if request.places:
        return ", ".join(show(problem, q, measure) for q in request.places[:12])
    if driver.stroke is not None:
        a, b = (show(problem, q, measure) for q in driver.stroke)
        return _("{count} from {a} to {b}").format(count=request.count, a=a, b=b)
    if driver.kind == "slide":
        return _("{count} from one end of its way to the other").format(count=request.count)
    start = _(FILE_WORDS[request.start]) if isinstance(request.start, str) else show(problem, request.start, measure)
    return _("{count} from {start}").format(count=request.count, start=start)
