"""Masses and loads of a problem file."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tmm_cli.errors import _
from tmm_cli.linkage import Linkage, Load, LoadTable
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.tree import Path
from tmm_cli.problem.values import ValueReader, check_name, direction, planar
from tmm_cli.quantities import ACCELERATION, ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, Dimension
from tmm_cli.structure.assur import analyse
from tmm_cli.structure.naming import output_link

STANDARD_GRAVITY = 9.81


def with_masses(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """The linkage with masses, inertias, centres of mass and gravity."""
    gravity = _gravity(shape.gravity, values)
    links = dict(linkage.links)
    moving = dict.fromkeys(linkage.moving, 0)
    for name, given in shape.masses.items():
        path: Path = ("masses", name)
        values.known(name, moving, path, "link", key=True)
        link = links[name]
        if values.one_of(given, ("mass", "weight"), path) == "mass":
            mass = values.positive(given.mass, MASS, (*path, "mass"), zero=True)
        else:
            weight = values.positive(given.weight, FORCE, (*path, "weight"), zero=True)
            mass = weight / (abs(gravity) or STANDARD_GRAVITY)
        inertia = values.positive(given.inertia, INERTIA, (*path, "inertia"), zero=True)
        if given.centre is None and len(link.points) > 1 and mass > 0:
            a, b = list(link.points)[:2]
            raise ProblemError(
                _("where is the centre of mass of this link?"), path=(*path, "centre"),
                allowed=_("centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}").format(a=a, b=b),
            )  # fmt: skip
        centre = next(iter(link.points.values()))
        if given.centre is not None:
            centre = values.place(given.centre, link.points, (*path, "centre"), name)
        links[name] = replace(link, mass=mass, inertia=inertia, centre=centre)
    return replace(linkage, links=links, gravity=gravity)


def _gravity(given: Any, values: ValueReader) -> complex:
    path: Path = ("gravity",)
    if given is None:
        return complex(0.0, -STANDARD_GRAVITY)
    if isinstance(given, list):
        return values.vector(given, ACCELERATION, path)
    return planar(0.0, -values.positive(given, ACCELERATION, path, zero=True))


def build_loads(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[Load, ...]:
    """The loads of the task, in the order of the file."""
    moving = dict.fromkeys(linkage.moving, 0)
    loads = []
    for name, given in shape.loads.items():
        path: Path = ("loads", name)
        check_name(name, path, "load")
        link = values.known(given.on, moving, (*path, "on"), "link")
        points = linkage.links[link].points
        at = next(iter(points.values()))
        if given.at is not None:
            at = values.place(given.at, points, (*path, "at"), link)
        if given.force is None and given.moment is None:
            raise ProblemError(_("a load has a force or a moment"), path=path, found="neither", key=True)
        force, table = _component(given.force, FORCE, linkage, values, (*path, "force"))
        moment, moment_table = _component(given.moment, MOMENT, linkage, values, (*path, "moment"))
        if (table is not None and moment_table is not None) or ((table or moment_table) and force and moment):
            raise ProblemError(
                _("a tabulated load is a force or a moment"), path=path, found="both", allowed=_("two loads"), key=True
            )
        point = given.at if isinstance(given.at, str) else ""
        loads.append(
            Load(
                name, link, at, force, moment, given.axes == "link", given.when,
                table or moment_table, point,
            )
        )  # fmt: skip
    return tuple(loads)


def _component(
    given: Any, want: Dimension, linkage: Linkage, values: ValueReader, path: Path
) -> tuple[Any, LoadTable | None]:
    """A force (complex) or a moment in SI; of a table the direction, or one, and the table."""
    force = want == FORCE
    if given is None:
        return 0j if force else 0.0, None
    if not isinstance(given, schema.Tabulated):
        return values.vector(given, want, path) if force else values.number(given, want, path), None
    if force == (given.angle is None):
        raise ProblemError(
            _("a force by its size has an angle, a moment has none"), path=(*path, "angle"), allowed=_("angle: 180 deg")
        )
    if (given.against is None) != (given.table is None):
        raise ProblemError(
            _("a table has two columns: what it is against, and the size"), path=(*path, "against"),
            allowed=_("against: stroke, crank angle or crank turn, and table: [[argument, size], ...]"),
        )  # fmt: skip
    along = direction(values.number(given.angle, ANGLE, (*path, "angle"))) if force else 1.0
    if values.one_of(given, ("size", "table"), path) == "size":
        return along * values.number(given.size, want, (*path, "size")), None
    return along, _table(given, want, linkage, values, path)


def _table(given: schema.Tabulated, want: Dimension, linkage: Linkage, values: ValueReader, path: Path) -> LoadTable:
    argument = ANGLE
    if given.against == "stroke":
        link = output_link(linkage, analyse(linkage).groups)
        argument = LENGTH if link is not None and linkage.slides_on_frame(link) else ANGLE
    rows = given.table or []
    path = (*path, "table")
    arguments = [values.number(row[0], argument, (*path, k, 0)) for k, row in enumerate(rows)]
    sizes = [values.number(row[1], want, (*path, k, 1)) for k, row in enumerate(rows)]
    for k in range(1, len(arguments)):
        if arguments[k] <= arguments[k - 1]:
            raise ProblemError(_("the first column must grow"), path=(*path, k, 0), found=str(rows[k][0]))
    return LoadTable(given.against or "stroke", tuple(arguments), tuple(sizes))
