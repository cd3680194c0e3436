"""Masses and loads of a problem file."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from tmm_cli.language import _
from tmm_cli.linkage import Linkage, Load, LoadTable
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.tree import Path
from tmm_cli.problem.values import Part, ValueReader, check_name, direction, planar
from tmm_cli.quantities import ACCELERATION, ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, Dimension
from tmm_cli.structure.assur import analyse
from tmm_cli.structure.naming import output_link

STANDARD_GRAVITY = 9.81


def with_masses(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """The linkage with masses, inertias, centres of mass and gravity."""
    gravity = _gravity(shape.gravity, values)
    links = dict(linkage.links)
    for name, given in shape.masses.items():
        part = Part(given, ("masses", name), values)
        values.known(name, linkage.moving, part.path, "link", key=True)
        link = links[name]
        if part.one_of("mass", "weight") == "mass":
            mass = part.positive("mass", MASS, zero=True)
        else:
            mass = part.positive("weight", FORCE, zero=True) / (abs(gravity) or STANDARD_GRAVITY)
        inertia = part.positive("inertia", INERTIA, zero=True)
        if given.centre is None and len(link.points) > 1 and mass > 0:
            a, b = list(link.points)[:2]
            allowed = _("centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}").format(a=a, b=b)
            raise part.refusal("centre", _("where is the centre of mass of this link?"), allowed=allowed)
        centre = next(iter(link.points.values())) if given.centre is None else part.place("centre", link.points, name)
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
    loads = []
    for name, given in shape.loads.items():
        part = Part(given, ("loads", name), values)
        check_name(name, part.path, "load")
        link = part.known("on", linkage.moving, "link")
        points = linkage.links[link].points
        at = next(iter(points.values())) if given.at is None else part.place("at", points, link)
        if given.force is None and given.moment is None:
            raise part.refusal("", _("a load has a force or a moment"), "neither")
        force, table = _component("force", FORCE, linkage, part)
        moment, moment_table = _component("moment", MOMENT, linkage, part)
        if (table is not None and moment_table is not None) or ((table or moment_table) and force and moment):
            raise part.refusal("", _("a tabulated load is a force or a moment"), "both", _("two loads"))
        point = given.at if isinstance(given.at, str) else ""
        follows, table = given.axes == "link", table or moment_table
        loads.append(Load(name, link, at, force, moment, follows, given.when, table, point))
    return tuple(loads)


def _component(key: str, want: Dimension, linkage: Linkage, load: Part) -> tuple[Any, LoadTable | None]:
    """A force (complex) or a moment in SI; of a table the direction, or one, and the table."""
    given, force = getattr(load.given, key), key == "force"
    part = Part(given, (*load.path, key), load.values)
    if given is None:
        return 0j if force else 0.0, None
    if not isinstance(given, schema.Tabulated):
        return load.values.vector(given, want, part.path) if force else load.number(key, want), None
    if force == (given.angle is None):
        angled = _("a force by its size has an angle, a moment has none")
        raise part.refusal("angle", angled, allowed=_("angle: 180 deg"))
    if (given.against is None) != (given.table is None):
        raise part.refusal(
            "against", _("a table has two columns: what it is against, and the size"),
            allowed=_("against: stroke, crank angle or crank turn, and table: [[argument, size], ...]"),
        )  # fmt: skip
    along = direction(part.number("angle", ANGLE)) if force else 1.0
    if part.one_of("size", "table") == "size":
        return along * part.number("size", want), None
    return along, _table(given, want, linkage, load.values, part.path)


def _table(given: schema.Tabulated, want: Dimension, linkage: Linkage, values: ValueReader, path: Path) -> LoadTable:
    argument = ANGLE
    if linkage.driver.kind == "slide":
        raise ProblemError(
            _("a table is against a crank, or the strokes that it gives: this driver slides"), path=(*path, "against"),
            found=str(given.against), allowed=_("size: one value"),
        )  # fmt: skip
    if given.against == "stroke":
        link = output_link(linkage, analyse(linkage).groups)
        argument = ANGLE if link is None or linkage.output_swings(link) else LENGTH
    rows = given.table or []
    path = (*path, "table")
    arguments = [values.number(row[0], argument, (*path, k, 0)) for k, row in enumerate(rows)]
    sizes = [values.number(row[1], want, (*path, k, 1)) for k, row in enumerate(rows)]
    for k in range(1, len(arguments)):
        if arguments[k] <= arguments[k - 1]:
            raise ProblemError(_("the first column must grow"), path=(*path, k, 0), found=str(rows[k][0]))
    return LoadTable(given.against or "stroke", tuple(arguments), tuple(sizes))
