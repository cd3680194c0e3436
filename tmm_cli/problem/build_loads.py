"""Masses and loads of a problem file."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tmm_cli.linkage import Linkage, Load, Table
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.sense import Sense, check_name, direction, planar
from tmm_cli.problem.units import ACCELERATION, ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, Dimension
from tmm_cli.structure.assur import analyse

STANDARD_GRAVITY = 9.81


def with_masses(linkage: Linkage, shape: schema.File, sense: Sense) -> Linkage:
    """The linkage with masses, inertias, centres of mass and gravity."""
    gravity = _gravity(shape.gravity, sense)
    links = dict(linkage.links)
    moving = dict.fromkeys(linkage.moving, 0)
    for name, given in shape.masses.items():
        path: Path = ("masses", name)
        sense.known(name, moving, path, "link", key=True)
        link = links[name]
        if (given.mass is None) == (given.weight is None):
            raise ProblemError(
                "mass or weight is wanted", path=path, found="both" if given.mass is not None else "neither",
                allowed="mass: 22 kg, or weight: 220 N", key=True,
            )  # fmt: skip
        if given.mass is not None:
            mass = sense.positive(given.mass, MASS, (*path, "mass"), zero=True)
        else:
            mass = sense.positive(given.weight, FORCE, (*path, "weight"), zero=True) / (
                abs(gravity) or STANDARD_GRAVITY
            )
        inertia = sense.positive(given.inertia, INERTIA, (*path, "inertia"), zero=True)
        if given.centre is None and len(link.points) > 1 and mass > 0:
            a, b = list(link.points)[:2]
            raise ProblemError(
                "where is the centre of mass of this link?", path=(*path, "centre"),
                allowed=f"centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}",
            )  # fmt: skip
        centre = next(iter(link.points.values()))
        if given.centre is not None:
            centre = sense.place(given.centre, link.points, (*path, "centre"), name)
        links[name] = replace(link, mass=mass, inertia=inertia, centre=centre)
    return replace(linkage, links=links, gravity=gravity)


def _gravity(given: Any, sense: Sense) -> complex:
    path: Path = ("gravity",)
    if given is None:
        return complex(0.0, -STANDARD_GRAVITY)
    if isinstance(given, list):
        if len(given) != 2:
            raise ProblemError("two components [x, y] are wanted", path=path, found=quote(given))
        return sense.vector(given, ACCELERATION, path)
    if isinstance(given, bool | dict):
        raise ProblemError("a number or [x, y] is wanted", path=path, found=quote(given))
    return planar(0.0, -sense.positive(given, ACCELERATION, path, zero=True))


def build_loads(linkage: Linkage, shape: schema.File, sense: Sense) -> tuple[Load, ...]:
    """The loads of the task, in the order of the file."""
    moving = dict.fromkeys(linkage.moving, 0)
    loads = []
    for name, given in shape.loads.items():
        path: Path = ("loads", name)
        check_name(name, path, "load")
        link = sense.known(given.on, moving, (*path, "on"), "link")
        points = linkage.links[link].points
        at = next(iter(points.values()))
        if given.at is not None:
            at = sense.place(given.at, points, (*path, "at"), link)
        if given.force is None and given.moment is None:
            raise ProblemError("a load has a force or a moment", path=path, found="neither", key=True)
        force, table = _force(given.force, linkage, sense, (*path, "force"))
        moment, moment_table = _moment(given.moment, linkage, sense, (*path, "moment"))
        if (table is not None and moment_table is not None) or ((table or moment_table) and force and moment):
            raise ProblemError(
                "a tabulated load is a force or a moment", path=path, found="both", allowed="two loads", key=True
            )
        point = given.at if isinstance(given.at, str) else ""
        loads.append(
            Load(
                name, link, at, force, moment, given.axes == "link", given.when == "working stroke",
                table or moment_table, point,
            )
        )  # fmt: skip
    return tuple(loads)


def _force(given: Any, linkage: Linkage, sense: Sense, path: Path) -> tuple[complex, Table | None]:
    if given is None:
        return 0j, None
    if not isinstance(given, schema.Tabulated):
        return sense.vector(given, FORCE, path), None
    if given.angle is None:
        raise ProblemError("the direction of the force is missing", path=(*path, "angle"), allowed="angle: 180 deg")
    along = direction(sense.number(given.angle, ANGLE, (*path, "angle")))
    if given.table is None:
        return along * _size(given, FORCE, sense, path), None
    return along, _table(given, FORCE, linkage, sense, path)


def _moment(given: Any, linkage: Linkage, sense: Sense, path: Path) -> tuple[float, Table | None]:
    if given is None:
        return 0.0, None
    if not isinstance(given, schema.Tabulated):
        return sense.number(given, MOMENT, path), None
    if given.angle is not None:
        raise ProblemError("a moment has no angle", path=(*path, "angle"), key=True)
    if given.table is None:
        return _size(given, MOMENT, sense, path), None
    return 1.0, _table(given, MOMENT, linkage, sense, path)


def _size(given: schema.Tabulated, want: Dimension, sense: Sense, path: Path) -> float:
    if given.size is None:
        raise ProblemError("its size is missing", path=(*path, "size"), allowed="size, or against and table")
    if given.against is not None:
        raise ProblemError("the table is missing", path=(*path, "table"), allowed="rows [argument, size]")
    return sense.number(given.size, want, (*path, "size"))


def _table(given: schema.Tabulated, want: Dimension, linkage: Linkage, sense: Sense, path: Path) -> Table:
    if given.size is not None:
        raise ProblemError("the table gives the size already", path=(*path, "size"), allowed="size or table", key=True)
    if given.against is None:
        raise ProblemError(
            "what is the table's first column?", path=(*path, "against"), allowed="stroke, crank angle, crank turn"
        )
    argument = ANGLE
    if given.against == "stroke":
        from tmm_cli.strokes import output_link  # few files tabulate a load against the stroke

        link = output_link(linkage, analyse(linkage).groups)
        argument = LENGTH if link is not None and linkage.slides_on_frame(link) else ANGLE
    rows = given.table or []
    table_path: Path = (*path, "table")
    if len(rows) < 2:
        raise ProblemError("a table has at least two rows", path=table_path, found=str(len(rows)))
    arguments = [sense.number(row[0], argument, (*table_path, k, 0)) for k, row in enumerate(rows)]
    for k in range(1, len(arguments)):
        if arguments[k] <= arguments[k - 1]:
            raise ProblemError(
                "the first column must grow", path=(*table_path, k, 0), found=str(rows[k][0]),
                allowed=f"more than {rows[k - 1][0]}",
            )  # fmt: skip
    values = [sense.number(row[1], want, (*table_path, k, 1)) for k, row in enumerate(rows)]
    return Table(given.against, tuple(arguments), tuple(values))
