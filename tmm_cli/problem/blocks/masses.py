"""Masses of links in a problem file: their keys, and how they are added to a linkage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import Link, Linkage
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, squared_length
from tmm_cli.mechanics.quantities import ACCELERATION, FORCE, INERTIA, MASS
from tmm_cli.problem.errors import Path
from tmm_cli.problem.schema_types import Place, Strict, Value
from tmm_cli.problem.values import FileSection, ValueReader, make_complex

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class PointMassKeys(Strict):
    """A point mass on a link."""

    mass: Value
    at: Place = Field(
        description="position: name of a point, [x, y] in the coordinate axes of the link, or {on: CD, at: 0.5}"
    )


class MassKeys(Strict):
    """Mass properties of a link."""

    mass: Value | None = None
    weight: Value | None = Field(default=None, description="weight, given instead of `mass`: m = G / g")
    inertia: Value = Field(default=0, description="moment of inertia about the centre of mass")
    centre: Place | None = Field(
        default=None,
        description="position: name of a point, [x, y] in the coordinate axes of the link, or {on: CD, at: 0.5}",
    )
    points: list[PointMassKeys] = Field(
        default_factory=list, max_length=50, description="point masses on the link, in addition to `mass` or alone"
    )


STANDARD_GRAVITY = 9.81


def add_masses(linkage: Linkage, shape: schema.File, values: ValueReader) -> Linkage:
    """Add masses, moments of inertia, centres of mass and gravity to a linkage. Raises ProblemError."""
    gravity = _build_gravity(shape.gravity, values)
    links = dict(linkage.links)
    for name, keys in shape.masses.items():
        section = FileSection(keys, ("masses", name), values)
        values.known_name(name, linkage.moving, section.path, "link", key=True)
        links[name] = _add_point_masses(_add_mass(links[name], section, gravity), section)
        _refuse_ambiguous_centre(links, name, section)
    return replace(linkage, links=links, gravity=gravity)


def _add_mass(link: Link, section: FileSection, gravity: complex) -> Link:
    """Add mass, moment of inertia and centre of mass to a link. If the file gives point masses on the link, it may
    omit the mass.
    """
    keys: MassKeys = section.keys
    if keys.points and keys.mass is None and keys.weight is None:
        return replace(
            link, inertia=section.positive("inertia", INERTIA, zero=True), centre=next(iter(link.points.values()))
        )
    if section.one_of("mass", "weight") == "mass":
        mass = section.positive("mass", MASS, zero=True)
    else:
        mass = section.positive("weight", FORCE, zero=True) / (abs(gravity) or STANDARD_GRAVITY)
    inertia = section.positive("inertia", INERTIA, zero=True)
    if keys.centre is None and len(link.points) > 1 and mass > 0:
        a, b = list(link.points)[:2]
        allowed = _("centre: {a}, centre: [x, y], or centre: {{on: {a}{b}, at: 0.5}}").format(a=a, b=b)
        raise section.refusal("centre", _("the centre of mass of this link is not given"), allowed=allowed)
    centre = (
        next(iter(link.points.values())) if keys.centre is None else section.place("centre", link.points, link.name)
    )
    return replace(link, mass=mass, inertia=inertia, centre=centre)


def _add_point_masses(link: Link, section: FileSection) -> Link:
    """Add the point masses of a link to its mass, centre of mass and moment of inertia (parallel-axis theorem)."""
    bodies = [(link.mass, link.centre)] if link.mass > 0 else []
    for k, keys in enumerate(section.keys.points):
        mass_section = FileSection(keys, (*section.path, "points", k), section.values)
        bodies.append((mass_section.positive("mass", MASS), mass_section.place("at", link.points, link.name)))
    if not section.keys.points:
        return link
    if len(bodies) == 1:  # exactly there, and with nothing about its centre, in every precision
        return replace(link, mass=bodies[0][0], centre=bodies[0][1])
    mass = sum(m for m, __ in bodies)
    centre = sum(m * at for m, at in bodies) / mass
    return replace(
        link, mass=mass, centre=centre, inertia=link.inertia + sum(m * squared_length(at - centre) for m, at in bodies)
    )


def _refuse_ambiguous_centre(links: Mapping[str, Link], name: str, section: FileSection) -> None:
    """Refuse a point named S3 that is not the centre of mass of link 3, which has this name in tables and plans."""
    point, massed = f"S{name}", links[name]
    owners = [link for link in links if point in links[link].points]
    if (
        massed.mass
        and owners
        and (owners != [name] or abs(massed.points[point] - massed.centre) > SAME_DRIVER_POSITION)
    ):
        raise section.refusal(
            "centre",
            _(
                "the centre of mass of this link is called {point} in tables and drawings, but another point has "
                "this name"
            ).format(point=point),
            allowed=_("centre: {point}, or another name of the point").format(point=point),
        )


def _build_gravity(keys: Any, values: ValueReader) -> complex:
    path: Path = ("gravity",)
    if keys is None:
        return complex(0.0, -STANDARD_GRAVITY)
    if isinstance(keys, list):
        return values.vector(keys, ACCELERATION, path)
    return make_complex(0.0, -values.positive(keys, ACCELERATION, path, zero=True))
