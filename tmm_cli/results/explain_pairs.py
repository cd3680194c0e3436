"""What `tmm explain` says of drivers, toothed wheels, racks, cams, springs and friction."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.linkage import FRAME, Driver, Mesh, Spring
from tmm_cli.problem.dimensions import (
    ANGLE,
    DAMPING,
    FORCE,
    LENGTH,
    MOMENT,
    STIFFNESS,
    TORSION,
    TORSION_DAMPING,
    Dimension,
)
from tmm_cli.problem.record import Problem
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say

Rows = Sequence[tuple[str, ...]]


def further(problem: Problem) -> Iterable[Table]:
    """A table for each block that the file has of these."""
    linkage = problem.linkage
    if linkage.others or linkage.driver.base != FRAME:
        yield _drivers(problem)
    keys: tuple[str, ...]
    wheels = [_mesh(problem, mesh) for mesh in linkage.meshes if mesh.kind != "cam"]
    if wheels:
        keys = ("word.pair", "explain.mesh", "word.links", "explain.carrier", "explain.mesh_ratio",
                "explain.pitch_radii", "explain.teeth_pressure")  # fmt: skip
        yield _table("meshes", wheels, keys, say("explain.meshes_note", unit=problem.units.symbol(LENGTH)))
    cams = [row for mesh in linkage.meshes if mesh.kind == "cam" for row in _cam(problem, mesh)]
    if cams:
        keys = ("word.pair", "explain.cam", "explain.follower", "explain.piece", "explain.from_angle",
                "explain.to_angle", "explain.rise", "explain.law", "explain.run_after")  # fmt: skip
        yield _table("cams", cams, keys, say("explain.cam_note"))
    if linkage.springs:
        keys = ("forces.name", "explain.between", "explain.ends", "explain.rate", "explain.free", "explain.preload",
                "explain.damping")  # fmt: skip
        yield _table("springs", [_spring(problem, spring) for spring in linkage.springs], keys)
    if linkage.friction:
        slides = {slide.name for slide in linkage.slides}
        rubbing = [
            (
                f.pair, f"{f.coefficient:.6g}",
                say("explain.guide") if f.pair in slides else show(problem, f.radius, LENGTH),
            )
            for f in linkage.friction
        ]  # fmt: skip
        yield _table("friction", rubbing, ("word.pair", "explain.mu", "explain.journal"))


def show(problem: Problem, value: float, dimension: Dimension) -> str:
    """A value with its unit, of the file where it has one for this dimension."""
    number = problem.units.from_si(float(np.ravel(value)[0]), dimension)
    return f"{number + 0.0:.6g} {problem.units.symbol(dimension)}"


def _table(name: str, rows: Rows, keys: tuple[str, ...], note: str = "") -> Table:
    columns = tuple(Column(say(key), [row[k] for row in rows]) for k, key in enumerate(keys))
    return Table(name, say(f"explain.{name}"), columns, notes=(note,) if note else ())


def _on(link: str) -> str:
    return say("explain.frame") if link == FRAME else link


def _drivers(problem: Problem) -> Table:
    linkage = problem.linkage
    rows = []
    for driver in linkage.drivers:
        turns = driver.kind == "turn"
        at = linkage.sketch.at if driver is linkage.driver else driver.at
        rows.append(
            (
                driver.link, _on(driver.base), driver.joint, say("pressure.turns" if turns else "pressure.slides"),
                _speed(driver), _sense(driver), show(problem, at, ANGLE if turns else LENGTH),
            )
        )  # fmt: skip
    keys = ("word.link", "explain.on_link", "explain.in_pair", "explain.kind", "explain.speed_is", "explain.sense",
            "explain.start")  # fmt: skip
    return _table("drivers", rows, keys)


def _speed(driver: Driver) -> str:
    turns = driver.kind == "turn"
    speed = f"{driver.rate:.6g} {'rad/s' if turns else 'm/s'}"
    return speed + (f", {driver.acceleration:.6g} {'rad/s2' if turns else 'm/s2'}" if driver.acceleration else "")


def _sense(driver: Driver) -> str:
    if driver.kind == "turn":
        return say("explain.ccw" if driver.sense > 0 else "explain.cw")
    return say("explain.out" if driver.sense > 0 else "explain.in")


def _mesh(problem: Problem, mesh: Mesh) -> tuple[str, ...]:
    """A row of two wheels, or of a wheel and a rack, with the equation of their motion."""
    linkage = problem.linkage
    if mesh.kind == "rack":
        kind = say("explain.rack_and_wheel")
        step = problem.units.from_si(mesh.ratio, LENGTH)
        law, offset = f"s_{mesh.j} = {step:.6g} phi_{mesh.i}", show(problem, mesh.offset, LENGTH)
        radii = show(problem, abs(mesh.ratio), LENGTH)
    else:
        kind = say("explain.inner_gear" if mesh.ratio > 0 else "explain.outer_gear")
        law, offset = f"phi_{mesh.j} = {mesh.ratio:.6g} phi_{mesh.i}", show(problem, mesh.offset, ANGLE)
        points = [linkage.shared(mesh.carrier, link) for link in (mesh.i, mesh.j)]
        a, b = (complex(np.ravel(linkage.local(mesh.carrier, p))[0]) for p in points if p is not None)
        pitch = (a - mesh.ratio * b) / (1 - mesh.ratio)
        radii = ", ".join(show(problem, abs(pitch - axis), LENGTH) for axis in (a, b))
    if mesh.offset:
        law += f" + {offset}"
    return (
        mesh.name, kind, f"{_on(mesh.i)}, {_on(mesh.j)}", _on(mesh.carrier), law, radii,
        show(problem, mesh.pressure, ANGLE),
    )  # fmt: skip


def _cam(problem: Problem, mesh: Mesh) -> Iterable[tuple[str, ...]]:
    """The pieces of a cam's law, a row each."""
    assert mesh.law is not None
    measure = LENGTH if mesh.slide else ANGLE
    at, run = mesh.law.start, mesh.offset
    for number, piece in enumerate(mesh.law.pieces):
        name = (mesh.name, mesh.i, mesh.j) if number == 0 else ("", "", "")
        end, run = at + piece.over, run + piece.rise
        law = piece.shape if piece.rise else say("explain.dwell")
        yield (
            *name, str(number + 1), show(problem, at, ANGLE), show(problem, end, ANGLE),
            show(problem, piece.rise, measure), law, show(problem, run, measure),
        )  # fmt: skip
        at = end


def _spring(problem: Problem, spring: Spring) -> tuple[str, ...]:
    between = f"{_on(spring.i)}, {_on(spring.j)}"
    units = problem.units

    def place(at: complex) -> str:
        at = complex(np.ravel(at)[0])
        return f"[{units.from_si(at.real, LENGTH) + 0.0:.6g}, {units.from_si(at.imag, LENGTH) + 0.0:.6g}]"

    if spring.turns:
        measures = (TORSION, ANGLE, MOMENT, TORSION_DAMPING)
        ends = ""
    else:
        measures = (STIFFNESS, LENGTH, FORCE, DAMPING)
        ends = f"{place(spring.at_i)}, {place(spring.at_j)}"
    rate, free, preload, damping = (
        show(problem, value, measure)
        for value, measure in zip(
            (spring.rate, spring.free, spring.preload, spring.damping), measures, strict=True
        )
    )  # fmt: skip
    if not spring.rate:
        rate, free = say("explain.constant"), ""
    return spring.name, between, ends, rate, free, preload if spring.preload else "", damping if spring.damping else ""
