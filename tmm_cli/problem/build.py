"""From the shape of a problem file to a linkage: names are looked up, numbers get their units."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import PurePath
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from tmm_cli.errors import _
from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Linkage, Mesh, Output, Sketch, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.build_drivers import build_drivers
from tmm_cli.problem.build_loads import build_loads, with_masses
from tmm_cli.problem.build_positions import build_request
from tmm_cli.problem.errors import ProblemError, nearest, placed_in, quote, under
from tmm_cli.problem.expressions import resolve_parameters
from tmm_cli.problem.record import Problem
from tmm_cli.problem.stray import nothing_stray
from tmm_cli.problem.tree import Path, Tree
from tmm_cli.problem.units import PhysicalValue, UnitSystem
from tmm_cli.problem.values import ValueReader, check_name, direction, phase, planar
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER

Model = TypeVar("Model", bound=BaseModel)
UNTOLD_SKETCH = cmath.pi / 3  # where assemblies are compared when a file says nothing of them


def is_chain(tree: Tree) -> bool:
    """Whether the file gives a chain by pairs alone (structure.spatial) and no planar linkage."""
    part = tree.data.get("structure")
    named = isinstance(part, dict) and "spatial" in part
    return named or ("structure" in tree.data and "links" not in tree.data)


def build(tree: Tree, *, extended: bool = False) -> Problem:
    """A problem from a file that has been read and has no task of synthesis (see synthesis.reading).

    extended: with its numbers as double-doubles. Raises ProblemError.
    """
    shape = checked_shape(tree)
    with placed_in(tree):
        units = unit_system(shape.units, extended=extended)
        problem = Builder(shape, tree, ValueReader(parameters(shape.parameters, units), units)).problem()
    return replace(problem, extended=partial(build, tree, extended=True))


def checked_shape(tree: Tree) -> schema.File:
    """The file in the shape of a linkage. Raises ProblemError."""
    if is_chain(tree):
        raise ProblemError(
            _("a chain given by pairs alone has no dimensions: there is only its structure"), path=("structure",),
            allowed=_("tmm structure, tmm run, tmm check"), key=True,
        ).located(tree.file, tree)  # fmt: skip
    return validated(schema.File, tree)


def validated(model: type[Model], tree: Tree) -> Model:
    """The file in the shape of a model. Raises ProblemError."""
    try:
        return model.model_validate(tree.data)
    except ValidationError as error:
        from tmm_cli.problem.refusals import shape_error  # only a bad file needs its words

        raise shape_error(error, tree, model) from None


def unit_system(names: Mapping[str, str], *, extended: bool = False) -> UnitSystem:
    """What bare numbers of a file mean; extended: with numbers as double-doubles. Raises ProblemError."""
    with under("units"):
        if not extended:
            return UnitSystem(names)
        from tmm_cli.problem.extended import ExtendedUnits  # only near dead positions

        return ExtendedUnits(names)


def parameters(
    raw: Mapping[str, object], units: UnitSystem, given: Mapping[str, PhysicalValue] | None = None
) -> dict[str, PhysicalValue]:
    """The parameters of a file, which may rest on others that are given. Raises ProblemError."""
    with under("parameters"):
        return resolve_parameters(raw, units, given)


class Builder:
    """Builds the parts of one linkage in the order in which they need each other."""

    def __init__(self, shape: schema.File, tree: Tree, values: ValueReader) -> None:
        self.shape, self.tree, self.values = shape, tree, values

    def problem(self) -> Problem:
        shape = self.shape
        links = self.links()
        slides = self.slides(links)
        hinges = self.hinges(links)
        nothing_stray(shape, self.tree.data, links, hinges, slides)
        drivers = build_drivers(shape, links, hinges, slides, self.values)
        meshes = self.meshes(links, hinges, slides)
        outputs = self.outputs(links)
        driver = drivers[0]
        linkage = Linkage(
            links, hinges, slides, driver, self.sketch(links, driver), output=outputs[0] if outputs else None,
            others=drivers[1:], meshes=meshes, outputs=outputs,
        )  # fmt: skip
        linkage = with_masses(linkage, shape, self.values)
        linkage = self.sprung(replace(linkage, loads=build_loads(linkage, shape, self.values)))
        limit = self.values.positive(shape.checks.lever, NUMBER, ("checks", "lever"), zero=True)
        allowed, given = self.allowed()
        file = self.tree.file
        return Problem(
            PurePath(file).stem, shape.title or PurePath(file).stem, linkage,
            build_request(shape, driver, self.values), self.values.units,
            limit, shape.description, file, allowed, given, self.tree,
        )  # fmt: skip

    def meshes(self, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...]) -> tuple[Mesh, ...]:
        """Higher pairs; few files have any, and only those import what reads them."""
        if not (self.shape.gears or self.shape.racks or self.shape.cams):
            return ()
        from tmm_cli.problem.build_meshes import build_meshes

        return build_meshes(self.shape, links, hinges, slides, self.values)

    def sprung(self, linkage: Linkage) -> Linkage:
        """With springs and friction, if there are any."""
        if not self.shape.springs and self.shape.friction is None:
            return linkage
        from tmm_cli.problem.build_springs import build_friction, build_springs

        linkage = replace(linkage, springs=build_springs(linkage, self.shape, self.values))
        return replace(linkage, friction=build_friction(linkage, self.shape, self.values))

    def allowed(self) -> tuple[tuple[float, float], tuple[bool, bool]]:
        """Largest pressure angles on sliding and turning links, and whether the file says them."""
        angles, said = list(Problem.pressure_limits), [False, False]
        for number, key in enumerate(("pressure_sliding", "pressure_turning")):
            value = getattr(self.shape.checks, key)
            if value is not None:
                angles[number], said[number] = self.values.positive(value, ANGLE, ("checks", key)), True
        return (angles[0], angles[1]), (said[0], said[1])

    def links(self) -> dict[str, Link]:
        frame = {}
        for name, place in self.shape.points.items():
            check_name(name, ("points", name), "point")
            frame[name] = self.values.vector(place, LENGTH, ("points", name))
        links = {FRAME: Link(FRAME, frame)}
        for name, link in self.shape.links.items():
            path: Path = ("links", name)
            check_name(name, path, "link")
            if name == FRAME:
                raise ProblemError(_("0 is the frame; see points"), path=path, key=True)
            links[name] = Link(name, self.points(link, name), label=link.name or "")
        return links

    def points(self, link: schema.Link, name: str) -> dict[str, complex]:
        path: Path = ("links", name)
        given = link.points
        if isinstance(given, dict):
            if link.length is not None:
                raise ProblemError(_("coordinates say the length already"), path=(*path, "length"))
            points = {p: self.values.vector(xy, LENGTH, (*path, "points", p)) for p, xy in given.items()}
        else:
            points = self.listed(given, link, path)
        if not points:
            raise ProblemError(_("a link has at least one point"), path=(*path, "points"), allowed="[A, B]")
        for point in points:
            spot = (*path, "points", point) if isinstance(given, dict) else (*path, "points", list(points).index(point))
            check_name(point, spot, "point")
        for point, place in link.also.items():
            check_name(point, (*path, "also", point), "point", points)
            points[point] = self.values.place(place, points, (*path, "also", point), name)
        return points

    def listed(self, given: list[str], link: schema.Link, path: Path) -> dict[str, complex]:
        if len(set(given)) < len(given):
            raise ProblemError(_("a point is named twice"), path=(*path, "points"), found=str(given))
        if len(given) > 2:
            raise ProblemError(
                _("three points and more need coordinates in the link's own axes"), path=(*path, "points"),
                found=", ".join(given), allowed=f"{{{given[0]}: [0, 0], {given[1]}: [x, 0], {given[2]}: [x, y]}}",
            )  # fmt: skip
        if len(given) < 2:
            if link.length is not None:
                raise ProblemError(_("a length belongs to two points"), path=(*path, "length"))
            return dict.fromkeys(given, 0j)
        if link.length is None:
            raise ProblemError(
                _("the length of this link is missing"), path=(*path, "length"),
                allowed=_("length: the distance from {first} to {second}").format(first=given[0], second=given[1]),
            )  # fmt: skip
        return {given[0]: 0j, given[1]: planar(self.values.positive(link.length, LENGTH, (*path, "length")), 0.0)}

    def slides(self, links: dict[str, Link]) -> tuple[Slide, ...]:
        for name in self.shape.guides:
            check_name(name, ("guides", name), "guide")
        found: list[Slide] = []
        for name, link in self.shape.links.items():
            many = isinstance(link.slides, list)
            for number, slide in enumerate(link.sliding):
                path: Path = ("links", name, "slides", number) if many else ("links", name, "slides")
                found.append(self.slide(slide, name, links, path, {s.name for s in found}))
        return tuple(found)

    def slide(self, slide: schema.Slide, runner: str, links: dict[str, Link], path: Path, taken: set[str]) -> Slide:
        point = slide.point or next(iter(links[runner].points))
        self.values.known(point, links[runner].points, (*path, "point"), f"point of link {runner}")
        guides = self.shape.guides
        if slide.on in guides:
            if any(told is not None for told in (slide.along, slide.through, slide.angle)):
                raise ProblemError(_("guide {on} says where it runs already").format(on=slide.on), path=path)
            guide, name = guides[slide.on], slide.on
            where: Path = ("guides", slide.on)
            carrier = self.values.known(guide.on, links, (*where, "on"), "link")
        elif slide.on in links:
            carrier, name, where = slide.on, f"{point}'", path
            guide = schema.Guide(
                on=carrier, along=slide.along, through=slide.through, angle=slide.angle, offset=slide.offset
            )
        else:
            names = [*guides, *(n for n in links if n != runner)]
            raise ProblemError(
                _("there is no such guide or link"), path=(*path, "on"), found=quote(slide.on),
                allowed=_("guides: {guides}; links: {links}").format(
                    guides=", ".join(guides) or _("none"), links=", ".join(links)
                ),
                near=nearest(slide.on, names),
            )  # fmt: skip
        self.values.different((runner, carrier), (*path, "on"))
        through, angle = self.guide(guide, carrier, links, where)
        turned = self.values.number(slide.turned, ANGLE, (*path, "turned"))
        name = name if name not in taken else f"{name}.{runner}"
        return Slide(name, carrier, runner, through, angle, links[runner].points[point], turned, point)

    def guide(self, guide: schema.Guide, carrier: str, links: dict[str, Link], path: Path) -> tuple[complex, float]:
        points = links[carrier].points
        along, placed = guide.along, guide.through is not None or guide.angle is not None
        if along is None and not placed and carrier != FRAME and len(points) == 2:
            along = "-".join(points)
        if along is not None and placed:
            raise ProblemError(_("along says through and angle already"), path=(*path, "along"))
        if along is not None:
            first, second = self.values.two_points(along, points, (*path, "along"))
            through, angle = points[first], phase(points[second] - points[first])
        elif guide.through is not None:
            through = self.values.place(guide.through, points, (*path, "through"), carrier)
            angle = 0.0 if guide.angle is None else self.values.number(guide.angle, ANGLE, (*path, "angle"))
        else:
            raise ProblemError(
                _("where does this guide run?"), path=(*path, "through"),
                allowed=_("along: CD, or through: [x, y] and angle"),
            )  # fmt: skip
        return through + 1j * self.values.number(guide.offset, LENGTH, (*path, "offset")) * direction(angle), angle

    @staticmethod
    def hinges(links: dict[str, Link]) -> tuple[Hinge, ...]:
        owners: dict[str, list[str]] = {}
        for name, link in links.items():
            for point in link.points:
                owners.setdefault(point, []).append(name)
        return tuple(Hinge(point, tuple(names)) for point, names in owners.items() if len(names) > 1)

    def sketch(self, links: dict[str, Link], driver: Driver) -> Sketch:
        given = dict(self.shape.sketch)
        wanted = ANGLE if driver.kind == "turn" else LENGTH
        if not given:
            return Sketch(UNTOLD_SKETCH if driver.kind == "turn" else 0.0)
        if "at" not in given:
            raise ProblemError(
                _("the driver's place in the sketch is missing"), path=("sketch", "at"),
                allowed=_("at: {wanted}").format(wanted=wanted),
            )  # fmt: skip
        at = self.values.number(given.pop("at"), wanted, ("sketch", "at"))
        if driver.stroke is not None and not driver.stroke[0] <= at <= driver.stroke[1]:
            raise ProblemError(
                _("the sketch shows the driver beyond its stroke"), path=("sketch", "at"),
                found=str(self.shape.sketch["at"]),
            )  # fmt: skip
        owners = {p: n for n, link in links.items() for p in link.points}
        points, angles = {}, {}
        for name, value in given.items():
            path: Path = ("sketch", name)
            if name in owners and isinstance(value, list):
                points[name] = self.values.vector(value, LENGTH, path)
            elif name in links and name != FRAME and not isinstance(value, list):
                angles[name] = self.values.number(value, ANGLE, path)
            else:
                self.values.known(name, {**owners, **links}, path, "point or link", key=True)
                raise ProblemError(
                    _("a point has coordinates and a link has an angle"), path=path, found=quote(value),
                    allowed="[x, y]" if name in owners else _("an angle"),
                )  # fmt: skip
        return Sketch(at, points, angles)

    def outputs(self, links: dict[str, Link]) -> tuple[Output, ...]:
        moving = {n: 0 for n in links if n != FRAME}
        found = []
        for number, given in enumerate(self.shape.output):
            path: Path = ("output", number) if len(self.shape.output) > 1 else ("output",)
            found.append(Output(self.values.known(given.link, moving, path, "link"), given.working))
        return tuple(found)
