"""From the shape of a problem file to a linkage: names are looked up, numbers get their units."""

from __future__ import annotations

import cmath
from copy import copy
from dataclasses import replace
from functools import partial
from pathlib import PurePath
from typing import Any

from pydantic import ValidationError

from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Linkage, Mesh, Output, Sketch, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.build_drivers import build_drivers
from tmm_cli.problem.build_loads import build_loads, with_masses
from tmm_cli.problem.build_positions import build_request
from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.expressions import resolve_parameters
from tmm_cli.problem.reader import Tree, read_file
from tmm_cli.problem.record import Problem, Synthesised
from tmm_cli.problem.sense import Sense, check_name, direction, phase, planar
from tmm_cli.problem.stray import nothing_stray
from tmm_cli.problem.units import (
    ANGLE,
    LENGTH,
    NUMBER,
    Quantity,
    UnitSystem,
)

UNTOLD_SKETCH = cmath.pi / 3  # where assemblies are compared when a file says nothing of them


def load(path: str) -> Problem:
    """Read, check and build a problem file. Raises ProblemError, located in the file."""
    return build(read_file(path))


def is_chain(tree: Tree) -> bool:
    """Whether the file gives a chain by pairs alone (structure.spatial) and no planar linkage."""
    part = tree.data.get("structure")
    named = isinstance(part, dict) and "spatial" in part
    return named or ("structure" in tree.data and "links" not in tree.data)


def build(tree: Tree, *, extended: bool = False, known: Synthesised | None = None) -> Problem:
    """A problem from a file that has been read; extended: with its numbers in longdouble.

    known: what its synthesis found already, where that was a search.
    """
    if is_chain(tree):
        raise ProblemError(
            "a chain given by pairs alone has no dimensions: there is only its structure", path=("structure",),
            allowed="tmm structure, tmm run, tmm check", key=True,
        ).located(tree.file, tree)  # fmt: skip
    if "synthesis" in tree.data and "links" not in tree.data:
        raise ProblemError(
            "there is no linkage that could use what is found", path=("synthesis",),
            allowed="tmm synthesis, or links and a driver", key=True,
        ).located(tree.file, tree)  # fmt: skip
    try:
        shape = schema.File.model_validate(tree.data)
    except ValidationError as error:
        from tmm_cli.problem.refusals import shape_error  # only a bad file needs its words

        raise shape_error(error, tree) from None
    try:
        return _Builder(shape, tree, extended, known).problem()
    except ProblemError as error:
        raise error.located(tree.file, tree) from None


class _Builder:
    """Builds the parts of one linkage in the order in which they need each other."""

    def __init__(self, shape: schema.File, tree: Tree, extended: bool, known: Synthesised | None = None) -> None:
        self.shape, self.tree = shape, tree
        try:
            units = _extended_units(shape.units) if extended else UnitSystem(shape.units)
        except ProblemError as error:
            raise error.at("units") from None
        self.synthesis = None
        if shape.synthesis is not None:
            from tmm_cli.problem.synthesis.build import with_synthesis  # few files have it

            parameters, self.synthesis = with_synthesis(shape.synthesis, shape.parameters, units, self.variant, known)
        else:
            try:
                parameters = resolve_parameters(shape.parameters, units)
            except ProblemError as error:
                raise error.at("parameters") from None
        self.sense = Sense(parameters, units)

    def variant(self, parameters: dict[str, Quantity], units: UnitSystem) -> Problem:
        """The file with other parameters, for a synthesis that searches."""
        other = copy(self)
        other.sense, other.synthesis = Sense(parameters, units), None
        return other.problem()

    def problem(self) -> Problem:
        shape = self.shape
        links = self.links()
        slides = self.slides(links)
        hinges = self.hinges(links)
        nothing_stray(shape, self.tree.data, links, hinges, slides)
        drivers = build_drivers(shape, links, hinges, slides, self.sense)
        meshes = self.meshes(links, hinges, slides)
        outputs = self.outputs(links)
        driver = drivers[0]
        linkage = Linkage(
            links, hinges, slides, driver, self.sketch(links, driver), output=outputs[0] if outputs else None,
            others=drivers[1:], meshes=meshes, outputs=outputs,
        )  # fmt: skip
        if self.synthesis is not None and self.synthesis.outcome.sketch is not None:
            linkage = replace(linkage, sketch=self.synthesis.outcome.sketch)
        linkage = with_masses(linkage, shape, self.sense)
        linkage = self.sprung(replace(linkage, loads=build_loads(linkage, shape, self.sense)))
        limit = self.sense.positive(shape.checks.lever, NUMBER, ("checks", "lever"), zero=True)
        allowed, given = self.allowed()
        file = self.tree.file
        return Problem(
            PurePath(file).stem, shape.title or PurePath(file).stem, linkage,
            build_request(shape, driver, self.sense), self.sense.units,
            limit, shape.description, file, allowed, given, self.tree, self.synthesis,
            partial(build, self.tree, extended=True, known=self.synthesis),
        )  # fmt: skip

    def meshes(self, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...]) -> tuple[Mesh, ...]:
        """Higher pairs; few files have any, and only those import what reads them."""
        if not (self.shape.gears or self.shape.racks or self.shape.cams):
            return ()
        from tmm_cli.problem.build_meshes import build_meshes

        return build_meshes(self.shape, links, hinges, slides, self.sense)

    def sprung(self, linkage: Linkage) -> Linkage:
        """With springs and friction, if there are any."""
        if not self.shape.springs and self.shape.friction is None:
            return linkage
        from tmm_cli.problem.build_springs import build_friction, build_springs

        linkage = replace(linkage, springs=build_springs(linkage, self.shape, self.sense))
        return replace(linkage, friction=build_friction(linkage, self.shape, self.sense))

    def allowed(self) -> tuple[tuple[float, float], tuple[bool, bool]]:
        """Largest pressure angles on sliding and turning links, and whether the file says them."""
        angles, said = list(Problem.pressure_limits), [False, False]
        for number, key in enumerate(("pressure_sliding", "pressure_turning")):
            value = getattr(self.shape.checks, key)
            if value is not None:
                angles[number], said[number] = self.sense.positive(value, ANGLE, ("checks", key)), True
        return (angles[0], angles[1]), (said[0], said[1])

    def links(self) -> dict[str, Link]:
        frame = {}
        for name, place in self.shape.points.items():
            check_name(name, ("points", name), "point")
            frame[name] = self.sense.vector(place, LENGTH, ("points", name))
        links = {FRAME: Link(FRAME, frame)}
        for name, link in self.shape.links.items():
            path: Path = ("links", name)
            check_name(name, path, "link")
            if name == FRAME:
                raise ProblemError(
                    "0 is the frame", path=path, found="a moving link 0", allowed="another number; see points", key=True
                )
            links[name] = Link(name, self.points(link, name), label=link.name or "")
        return links

    def points(self, link: schema.Link, name: str) -> dict[str, complex]:
        path: Path = ("links", name)
        given = link.points
        if isinstance(given, dict):
            if link.length is not None:
                raise ProblemError(
                    "coordinates say the length already", path=(*path, "length"), allowed="length or coordinates",
                )  # fmt: skip
            points = {p: self.sense.vector(xy, LENGTH, (*path, "points", p)) for p, xy in given.items()}
        else:
            points = self.listed(given, link, path)
        if not points:
            raise ProblemError("a link has at least one point", path=(*path, "points"), found="none", allowed="[A, B]")
        for point in points:
            spot = (*path, "points", point) if isinstance(given, dict) else (*path, "points", list(points).index(point))
            check_name(point, spot, "point")
        for point, place in link.also.items():
            check_name(point, (*path, "also", point), "point")
            if point in points:
                raise ProblemError(
                    "this point is there already", path=(*path, "also", point), found=quote(point), key=True
                )
            points[point] = self.sense.place(place, points, (*path, "also", point), name)
        return points

    def listed(self, given: list[str], link: schema.Link, path: Path) -> dict[str, complex]:
        if len(set(given)) < len(given) or not given:
            raise ProblemError(
                "a point is named twice" if given else "a link has at least one point",
                path=(*path, "points"), found=str(given), allowed="different names",
            )  # fmt: skip
        if len(given) > 2:
            raise ProblemError(
                "three points and more need coordinates in the link's own axes", path=(*path, "points"),
                found=", ".join(given), allowed=f"{{{given[0]}: [0, 0], {given[1]}: [x, 0], {given[2]}: [x, y]}}",
            )  # fmt: skip
        if len(given) == 1:
            if link.length is not None:
                raise ProblemError(
                    "a length belongs to two points", path=(*path, "length"), found=f"one point, {given[0]}",
                    allowed=f"points: [{given[0]}, ...]",
                )  # fmt: skip
            return {given[0]: 0j}
        if link.length is None:
            raise ProblemError(
                "the length of this link is missing", path=(*path, "length"),
                allowed=f"length: the distance from {given[0]} to {given[1]}",
            )  # fmt: skip
        return {given[0]: 0j, given[1]: planar(self.sense.positive(link.length, LENGTH, (*path, "length")), 0.0)}

    def slides(self, links: dict[str, Link]) -> tuple[Slide, ...]:
        for name in self.shape.guides:
            check_name(name, ("guides", name), "guide")
        found: list[Slide] = []
        for name, link in self.shape.links.items():
            many = isinstance(link.slides, list)
            given = link.slides if isinstance(link.slides, list) else [link.slides] if link.slides else []
            for number, slide in enumerate(given):
                path: Path = ("links", name, "slides", number) if many else ("links", name, "slides")
                found.append(self.slide(slide, name, links, path, {s.name for s in found}))
        return tuple(found)

    def slide(self, slide: schema.Slide, runner: str, links: dict[str, Link], path: Path, taken: set[str]) -> Slide:
        point = slide.point or next(iter(links[runner].points))
        self.sense.known(point, links[runner].points, (*path, "point"), f"point of link {runner}")
        guides = self.shape.guides
        if slide.on in guides:
            for key in ("along", "through", "angle"):
                if getattr(slide, key) is not None:
                    raise ProblemError(
                        f"guide {slide.on} says where it runs already", path=(*path, key), allowed="on, point, turned",
                        key=True,
                    )  # fmt: skip
            guide, name = guides[slide.on], slide.on
            where: Path = ("guides", slide.on)
            carrier = self.sense.known(guide.on, links, (*where, "on"), "link")
        elif slide.on in links:
            carrier, name, where = slide.on, f"{point}'", path
            guide = schema.Guide(
                on=carrier, along=slide.along, through=slide.through, angle=slide.angle, offset=slide.offset
            )
        else:
            names = [*guides, *(n for n in links if n != runner)]
            raise ProblemError(
                "there is no such guide or link", path=(*path, "on"), found=quote(slide.on),
                allowed=f"guides: {', '.join(guides) or 'none'}; links: {', '.join(links)}",
                near=nearest(slide.on, names),
            )  # fmt: skip
        if carrier == runner:
            raise ProblemError("a link cannot slide on itself", path=(*path, "on"), found=quote(slide.on))
        through, angle = self.guide(guide, carrier, links, where)
        turned = self.sense.number(slide.turned, ANGLE, (*path, "turned"))
        name = name if name not in taken else f"{name}.{runner}"
        return Slide(name, carrier, runner, through, angle, links[runner].points[point], turned, point)

    def guide(self, guide: schema.Guide, carrier: str, links: dict[str, Link], path: Path) -> tuple[complex, float]:
        points = links[carrier].points
        if (
            guide.along is None
            and guide.through is None
            and guide.angle is None
            and carrier != FRAME
            and len(points) == 2
        ):
            guide = guide.model_copy(update={"along": "-".join(points)})
        if guide.along is not None:
            if guide.through is not None or guide.angle is not None:
                raise ProblemError(
                    "along says through and angle already", path=(*path, "along"), allowed="one of the two"
                )
            first, second = self.sense.two_points(guide.along, points, (*path, "along"), carrier)
            through, angle = points[first], phase(points[second] - points[first])
        elif guide.through is not None:
            through = self.sense.place(guide.through, points, (*path, "through"), carrier)
            angle = 0.0 if guide.angle is None else self.sense.number(guide.angle, ANGLE, (*path, "angle"))
        else:
            raise ProblemError(
                "where does this guide run?", path=(*path, "through"), allowed="along: CD, or through: [x, y] and angle"
            )
        return through + 1j * self.sense.number(guide.offset, LENGTH, (*path, "offset")) * direction(angle), angle

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
                "the driver's place in the sketch is missing", path=("sketch", "at"), allowed=f"at: {wanted}",
            )  # fmt: skip
        at = self.sense.number(given.pop("at"), wanted, ("sketch", "at"))
        if driver.stroke is not None and not driver.stroke[0] <= at <= driver.stroke[1]:
            raise ProblemError(
                "the sketch shows the driver beyond its stroke", path=("sketch", "at"),
                found=str(self.shape.sketch["at"]), allowed="a place of the stroke, or another stroke",
            )  # fmt: skip
        owners = {p: n for n, link in links.items() for p in link.points}
        points, angles = {}, {}
        for name, value in given.items():
            path: Path = ("sketch", name)
            if name in owners and isinstance(value, list):
                points[name] = self.sense.vector(_two(value, path), LENGTH, path)
            elif name in links and name != FRAME and not isinstance(value, list):
                angles[name] = self.sense.number(value, ANGLE, path)
            else:
                self.sense.known(name, {**owners, **links}, path, "point or link", key=True)
                raise ProblemError(
                    "a point has coordinates and a link has an angle", path=path, found=quote(value),
                    allowed="[x, y]" if name in owners else "an angle",
                )  # fmt: skip
        return Sketch(at, points, angles)

    def outputs(self, links: dict[str, Link]) -> tuple[Output, ...]:
        moving = {n: 0 for n in links if n != FRAME}
        found = []
        for number, given in enumerate(self.shape.output):
            path: Path = ("output", number) if len(self.shape.output) > 1 else ("output",)
            found.append(Output(self.sense.known(given.link, moving, path, "link"), given.working))
        return tuple(found)


def _extended_units(names: dict[str, str]) -> UnitSystem:
    from tmm_cli.problem.extended import ExtendedUnits  # only near dead positions

    return ExtendedUnits(names)


def _two(value: list[Any], path: Path) -> list[Any]:
    if len(value) != 2:
        raise ProblemError("two coordinates [x, y] are wanted", path=path, found=quote(value))
    return value
