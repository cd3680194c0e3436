"""Values of a file with their units, and words that a file may say, as people read them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from tmm_cli.language import N_, _, numeral, spelt
from tmm_cli.mechanics.linkage import FRAME, Driver, Mesh, SpeedTable, Spring
from tmm_cli.mechanics.numerics import rounded
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    DAMPING,
    FORCE,
    LENGTH,
    MOMENT,
    STIFFNESS,
    TORSION,
    TORSION_DAMPING,
    Dimension,
    place_dimension,
)
from tmm_cli.problem import Problem
from tmm_cli.reports.stages import link_name
from tmm_cli.reports.table import Table, table_of_words, with_unit
from tmm_cli.reports.understood import between_rows

FILE_WORDS: Final = {  # that a file may say, where they are shown
    "always": N_("always"),
    "working stroke": N_("working stroke"),
    "stroke": N_("stroke"),
    "share of stroke": N_("share of the stroke"),
    "crank angle": N_("crank angle"),
    "crank turn": N_("crank turn"),
}


def show(problem: Problem, value: float, dimension: Dimension) -> str:
    """A value with its unit, of the file where it has one for this dimension."""
    return with_unit(problem.units, float(np.ravel(value)[0]), dimension)


def show_vector(problem: Problem, value: complex, dimension: Dimension = LENGTH) -> str:
    """Both components in the unit of the file: `[120, 0]`."""
    value = complex(np.ravel(value)[0])
    return f"[{', '.join(f'{problem.units.from_si(v, dimension) + 0.0:.6g}' for v in (value.real, value.imag))}]"


# Drivers, wheels, cams, springs and friction of a file, as tables of words.


def speed(driver: Driver) -> str:
    """A driver's speed, and its acceleration where it has one."""
    if driver.law is not None:
        return _("by a table against the crank angle")
    turns = driver.kind == "turn"
    told = f"{numeral(driver.rate, '.6g')} {spelt('rad/s' if turns else 'm/s')}"
    if driver.acceleration:
        told += f", {numeral(driver.acceleration, '.6g')} {spelt('rad/s^2' if turns else 'm/s^2')}"
    return told


def speeds(problem: Problem, law: SpeedTable) -> Table:
    """The rows of a table of speeds, with the accelerations that follow from them, or are given."""
    squares = law.squares
    places = np.array([float(rounded(row)) for row in squares.arguments])
    after = squares.slope(places) / 2 * problem.linkage.driver.sense
    gains = after if law.accelerations is None else law.accelerations(places)
    speeds = np.sqrt(squares(places))
    rows = [
        (show(problem, at, ANGLE), show(problem, speed, ANGULAR_SPEED), show(problem, gain, ANGULAR_ACCELERATION))
        for at, speed, gain in zip(places, speeds, gains, strict=True)
    ]
    head = (_("crank angle"), _("speed"), _("acceleration"))
    note = _("Between rows: {between}.").format(between=between_rows(law))
    return table_of_words("speeds", _("Speed of the driver, in its sense"), head, rows, (note,))


def parts(problem: Problem) -> Iterable[Table]:
    """A table for each block that the file has of these."""
    linkage = problem.linkage
    if linkage.others or linkage.driver.base != FRAME:
        yield table_of_words(
            "drivers",
            _("Drivers; they pass through the places of the sketch together"),
            (_("link"), _("driven from"), _("in pair"), _("it"), _("speed"), _("sense"), _("in the sketch at")),
            [_driver(problem, driver) for driver in linkage.drivers],
        )
    wheels = [_mesh(problem, mesh) for mesh in linkage.meshes if mesh.kind != "cam"]
    if wheels:
        note, title = _("Angles are those of the wheels from the link that holds them."), _("Toothed wheels")
        if any(mesh.kind == "rack" for mesh in linkage.meshes):
            title = _("Toothed wheels and racks")
            note = _(
                "Angles are those of the wheels from the link that holds them; a rack's run is in {unit} "
                "for an angle in rad."
            )
        yield table_of_words(
            "meshes",
            title,
            (_("pair"), _("kind"), _("links"), _("held by"), _("law"), _("pitch radii"), _("pressure angle")),
            wheels,
            (note.format(unit=problem.units.spelt(LENGTH)),),
        )
    cams = [row for mesh in linkage.meshes if mesh.kind == "cam" for row in _cam(problem, mesh)]
    if cams:
        note = _(
            "Of a sliding follower the force is taken as that of a flat face: along the guide, ds/da "
            "from the cam's axis. A swinging one is loaded by a couple."
        )
        yield table_of_words(
            "cams",
            _("Cams, by the law of the follower"),
            (
                _("pair"),
                _("cam"),
                _("follower"),
                _("piece"),
                _("cam from"),
                _("to"),
                _("rise"),
                _("law"),
                _("follower then at"),
            ),
            cams,
            (note,),
        )
    if linkage.springs:
        yield table_of_words(
            "springs",
            _("Springs"),
            (_("name"), _("between"), _("ends"), _("stiffness"), _("free at"), _("preload"), _("damping")),
            [_spring(problem, spring) for spring in linkage.springs],
        )
    if linkage.friction:
        slides = {slide.name for slide in linkage.slides}
        yield table_of_words(
            "friction",
            _("Friction"),
            (_("pair"), _("coefficient"), _("journal's radius")),
            [
                (
                    f.pair,
                    numeral(f.coefficient, ".6g"),
                    _("a guide") if f.pair in slides else show(problem, f.radius, LENGTH),
                )
                for f in linkage.friction
            ],
        )


def _driver(problem: Problem, driver: Driver) -> tuple[str, ...]:
    senses = {"turn": (_("clockwise"), _("counterclockwise")), "slide": (_("in"), _("out"))}
    at = problem.linkage.sketch.at if driver is problem.linkage.driver else driver.at
    return (
        driver.link,
        link_name(driver.base),
        driver.joint,
        _("turns") if driver.kind == "turn" else _("slides"),
        speed(driver),
        senses[driver.kind][driver.sense > 0],
        show(problem, at, place_dimension(driver.kind)),
    )


def _mesh(problem: Problem, mesh: Mesh) -> tuple[str, ...]:
    """A row of two wheels, or of a wheel and a rack, with the equation of their motion."""
    linkage = problem.linkage
    if mesh.kind == "rack":
        kind = _("wheel and rack")
        step = problem.units.from_si(mesh.ratio, LENGTH)
        law, offset = f"s_{mesh.j} = {numeral(step, '.6g')} phi_{mesh.i}", show(problem, mesh.offset, LENGTH)
        radii = show(problem, abs(mesh.ratio), LENGTH)
    else:
        kind = _("inner mesh") if mesh.ratio > 0 else _("outer mesh")
        law, offset = f"phi_{mesh.j} = {numeral(mesh.ratio, '.6g')} phi_{mesh.i}", show(problem, mesh.offset, ANGLE)
        points = [linkage.shared(mesh.carrier, link) for link in (mesh.i, mesh.j)]
        a, b = (complex(np.ravel(linkage.local(mesh.carrier, p))[0]) for p in points if p is not None)
        pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
        radii = ", ".join(show(problem, abs(pitch - axis), LENGTH) for axis in (a, b))
    if mesh.offset:
        law += f" + {offset}"
    return (
        mesh.name,
        kind,
        f"{link_name(mesh.i)}, {link_name(mesh.j)}",
        link_name(mesh.carrier),
        law,
        radii,
        show(problem, mesh.pressure, ANGLE),
    )


def _cam(problem: Problem, mesh: Mesh) -> Iterable[tuple[str, ...]]:
    """The pieces of a cam's law, a row each."""
    assert mesh.law is not None
    measure = LENGTH if mesh.slide else ANGLE
    at, run = mesh.law.start, mesh.offset
    for number, piece in enumerate(mesh.law.pieces):
        name = (mesh.name, mesh.i, mesh.j) if number == 0 else ("", "", "")
        end, run = at + piece.over, run + piece.rise
        law = piece.shape if piece.rise else _("dwell")
        yield (
            *name,
            str(number + 1),
            show(problem, at, ANGLE),
            show(problem, end, ANGLE),
            show(problem, piece.rise, measure),
            law,
            show(problem, run, measure),
        )
        at = end


def _spring(problem: Problem, spring: Spring) -> tuple[str, ...]:
    between = f"{link_name(spring.i)}, {link_name(spring.j)}"
    if spring.turns:
        ends, measures = "", (TORSION, ANGLE, MOMENT, TORSION_DAMPING)
    else:
        ends = f"{show_vector(problem, spring.at_i)}, {show_vector(problem, spring.at_j)}"
        measures = (STIFFNESS, LENGTH, FORCE, DAMPING)
    values = (spring.rate, spring.free, spring.preload, spring.damping)
    rate, free, preload, damping = (show(problem, v, measure) for v, measure in zip(values, measures, strict=True))
    if not spring.rate:
        rate, free = _("constant force"), ""
    return spring.name, between, ends, rate, free, preload if spring.preload else "", damping if spring.damping else ""
