"""Links of a problem file with their revolute and prismatic pairs. Unused links, guides and points are refused."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import FRAME, Hinge, Link, Linkage, Slide, common_hinge
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, nearest_name, quote, to_latin, unknown_name_error
from tmm_cli.problem.values import FileSection, ValueReader, check_name, make_complex, unit_vector, vector_angle

MAX_PAIR_LENGTH = 80  # letters of the names of two points


@dataclass(frozen=True)
class LinksAndPairs:
    """Links of a mechanism with their revolute and prismatic pairs, before drivers, higher pairs and loads are added.

    Attributes:
        links: links by name, with the frame.
        hinges: revolute pairs.
        slides: prismatic pairs.
    """

    links: dict[str, Link]
    hinges: tuple[Hinge, ...]
    slides: tuple[Slide, ...]

    def hinge(self, link: str, base: str) -> str | None:
        """Return the name of the point at which two links are hinged to each other, or None."""
        return common_hinge(self.hinges, link, base)

    def slide(self, link: str, base: str) -> Slide | None:
        """Return the prismatic pair between two links, or None."""
        return next((s for s in self.slides if {s.carrier, s.runner} == {link, base}), None)

    def missing_pair_error(self, link: str, base: str, path: Path, kinds: str = "RP") -> ProblemError:
        """Return the error for a link without a suitable pair with its base link; it lists the links that have one.

        kinds: allowed kinds of pairs; R for revolute, P for prismatic.
        """
        pairs = [h.links for h in self.hinges if "R" in kinds]
        pairs += [(s.carrier, s.runner) for s in self.slides if "P" in kinds]
        joined = dict.fromkeys(n for links in pairs if base in links for n in links if n != base)
        hinges = {h.point for h in self.hinges}
        free = next((p for p in self.links[link].points if p not in hinges), None)
        if base == FRAME and free is not None and "R" in kinds:
            joined[_("for a hinge on the frame, write points: {{{point}: [x, y]}}").format(point=free)] = None
        return ProblemError(
            _("link {link} has no suitable pair with link {base}").format(link=link, base=base),
            path=path,
            found=quote(link),
            allowed=", ".join(joined) or None,
        )


def build_links(shape: schema.File, values: ValueReader) -> LinksAndPairs:
    """Build the links in their order in the file, revolute pairs at shared points, and prismatic pairs. Raises
    ProblemError.
    """
    reader = _LinkReader(shape, values)
    slides = reader.slides()
    owners: dict[str, list[str]] = {}
    for name, link in reader.links.items():
        for point in link.points:
            owners.setdefault(point, []).append(name)
    hinges = tuple(Hinge(point, tuple(names)) for point, names in owners.items() if len(names) > 1)
    return LinksAndPairs(reader.links, _attach_links(hinges, shape, values), slides)


def _attach_links(hinges: tuple[Hinge, ...], shape: schema.File, values: ValueReader) -> tuple[Hinge, ...]:
    """Set the link to which the other links are attached at each compound hinge, as the file specifies it."""
    links_at = {hinge.point: hinge.links for hinge in hinges}
    for point, hinge in shape.hinges.items():
        section = FileSection(hinge, ("hinges", point), values)
        values.known_name(point, links_at, section.path, "hinge", key=True)
        if len(links_at[point]) == 2:
            raise section.refusal(
                "",
                _("this hinge joins only two links, which form one pair, so no attachment is needed"),
                ", ".join(links_at[point]),
            )
        if hinge.attached_to not in links_at[point]:
            raise section.refusal(
                "attached_to",
                _("link {link} does not belong to hinge {point}").format(link=hinge.attached_to, point=point),
                found=quote(hinge.attached_to),
                allowed=", ".join(links_at[point]),
            )
    attached = {point: hinge.attached_to for point, hinge in shape.hinges.items()}
    return tuple(replace(hinge, attached_to=attached.get(hinge.point, "")) for hinge in hinges)


def refuse_attachments(linkage: Linkage, shape: schema.File, values: ValueReader) -> None:
    """Refuse a link named by the key `attached to` of a compound hinge if it makes the pairs unsuitable.

    They are unsuitable if the Assur groups change, or if a driver loses the pair through which it drives its link.

    Raises:
        ProblemError: the link is not suitable.
    """
    for hinge in linkage.hinges:
        if hinge.attached_to and not _keeps_groups(linkage, hinge, hinge.attached_to):
            allowed = [link for link in hinge.links if _keeps_groups(linkage, hinge, link)]
            raise FileSection(shape.hinges[hinge.point], ("hinges", hinge.point), values).refusal(
                "attached_to",
                _("if the links are attached to {link}, the mechanism splits into other Assur groups").format(
                    link=hinge.attached_to
                ),
                found=quote(hinge.attached_to),
                allowed=", ".join(allowed),
            )


def _keeps_groups(linkage: Linkage, hinge: Hinge, link: str) -> bool:
    """Return True if `link` can be the one to which the other links of a compound hinge are attached.

    The Assur groups must not change, and the drivers must keep the pairs through which they drive their links.
    """
    usual, attached = (
        replace(linkage, hinges=tuple(replace(hinge, attached_to=to) if h == hinge else h for h in linkage.hinges))
        for to in ("", link)
    )
    driven = [{d.base, d.link} for d in linkage.drivers if d.kind == "turn" and d.joint == hinge.point]
    groups = [{frozenset(group.links) for group in analyse_structure(changed).groups} for changed in (usual, attached)]
    return groups[0] == groups[1] and all(link in ends for ends in driven)


class _LinkReader:
    """Reader of the links of a file and of their prismatic pairs. The pairs are read last, because they refer to
    links.
    """

    def __init__(self, shape: schema.File, values: ValueReader) -> None:
        self.shape, self.values = shape, values
        frame = {}
        for name, place in shape.points.items():
            check_name(name, ("points", name), "point")
            frame[name] = values.vector(place, LENGTH, ("points", name))
        _refuse_lookalikes(shape)
        self.links = {FRAME: Link(FRAME, frame)}
        for name, link in shape.links.items():
            check_name(name, ("links", name), "link")
            if name == FRAME:
                raise ProblemError(
                    _("0 is the frame; its points are given in `points`"), path=("links", name), key=True
                )
            self.links[name] = Link(name, self.points(link, name), label=link.name or "")

    def points(self, link: schema.LinkKeys, name: str) -> dict[str, complex]:
        section, named = FileSection(link, ("links", name), self.values), link.points
        where: Path = (*section.path, "points")
        if isinstance(named, dict):
            if link.length is not None:
                raise section.refusal("length", _("the length already follows from the coordinates of the points"))
            points = {p: self.values.vector(xy, LENGTH, (*where, p)) for p, xy in named.items()}
        else:
            points = self.read_point_list(named, section)
        if not points:
            raise section.refusal("points", _("a link must have at least one point"), allowed="[A, B]")
        for number, point in enumerate(points):
            check_name(point, (*where, point if isinstance(named, dict) else number), "point")
        for point, place in link.also.items():
            check_name(point, (*section.path, "also", point), "point", points)
            points[point] = self.values.place(place, points, (*section.path, "also", point), name)
        return points

    def read_point_list(self, names: list[str], section: FileSection) -> dict[str, complex]:
        """Return the coordinates of the one or two points that a list of names defines.

        The first point is the origin of the link's axes; the second lies on the x axis at the distance `length`.
        """
        if len(set(names)) < len(names):
            raise section.refusal("points", _("the same point is listed twice"), str(names))
        if len(names) > 2:
            raise section.refusal(
                "points",
                _("for a link with three or more points, give their coordinates in the coordinate axes of the link"),
                ", ".join(names),
                f"{{{names[0]}: [0, 0], {names[1]}: [x, 0], {names[2]}: [x, y]}}",
            )
        if len(names) < 2:
            if section.keys.length is not None:
                raise section.refusal(
                    "length", _("`length` is the distance between two points, but this link has only one")
                )
            return dict.fromkeys(names, 0j)
        if section.keys.length is None:
            allowed = _("length: the distance from {first} to {second}").format(first=names[0], second=names[1])
            raise section.refusal("length", _("the length of this link is missing"), allowed=allowed)
        return {names[0]: 0j, names[1]: make_complex(section.positive("length", LENGTH), 0.0)}

    def slides(self) -> tuple[Slide, ...]:
        for name in self.shape.guides:
            check_name(name, ("guides", name), "guide")
        slides: list[Slide] = []
        for name, link in self.shape.links.items():
            many = isinstance(link.slides, list)
            for number, slide in enumerate(link.sliding):
                path: Path = ("links", name, "slides", number) if many else ("links", name, "slides")
                slides.append(self.slide(FileSection(slide, path, self.values), name, {s.name for s in slides}))
        return tuple(slides)

    def slide(self, section: FileSection, runner: str, taken: set[str]) -> Slide:
        keys: schema.SlideKeys = section.keys
        points, guides = self.links[runner].points, self.shape.guides
        point = keys.point or next(iter(points))
        self.values.known_name(point, points, (*section.path, "point"), f"point of link {runner}")
        if keys.on in guides:
            if any(key is not None for key in (keys.along, keys.through, keys.angle)):
                raise ProblemError(
                    _(
                        "the line of guide {on} is already given in `guides`; remove along, through and angle here"
                    ).format(on=keys.on),
                    path=section.path,
                )
            name, line = keys.on, FileSection(guides[keys.on], ("guides", keys.on), self.values)
            carrier = line.known_name("on", self.links, "link")
        elif keys.on in self.links:
            carrier, name, line = keys.on, f"{point}'", section
        else:
            among = _("guides: {guides}; links: {links}").format(
                guides=", ".join(guides) or _("none"), links=", ".join(self.links)
            )
            carriers = [*guides, *(n for n in self.links if n != runner)]
            raise unknown_name_error(
                keys.on, carriers, _("there is no guide or link of that name"), among, path=(*section.path, "on")
            )
        self.values.refuse_same((runner, carrier), (*section.path, "on"))
        through, angle, ends = self.guide(line, carrier)
        bounded = carrier != FRAME and not (keys.unbounded or line.keys.unbounded)
        turned = section.number("turned", ANGLE)
        name = name if name not in taken else f"{name}.{runner}"
        return Slide(name, carrier, runner, through, angle, points[point], turned, point, ends if bounded else None)

    def guide(self, section: FileSection, carrier: str) -> tuple[complex, float, tuple[str, str] | None]:
        """Return the line of a guide in the axes of its carrier.

        Returns:
            A point of the line (m), its direction (rad), and the two points in the key `along` (None without this key).
        """
        keys: schema.Guide | schema.SlideKeys = section.keys
        points = self.links[carrier].points
        along, placed = keys.along, keys.through is not None or keys.angle is not None
        if along is None and not placed and carrier != FRAME and len(points) == 2:
            along = "-".join(points)
        if along is not None and placed:
            raise section.refusal(
                "along", _("`along` already determines `through` and `angle`; remove one or the other")
            )
        ends = None
        if along is not None:
            first, second = ends = self.values.two_points(along, points, (*section.path, "along"))
            through, angle = points[first], vector_angle(points[second] - points[first])
        elif keys.through is not None:
            through = section.place("through", points, carrier)
            angle = 0.0 if keys.angle is None else section.number("angle", ANGLE)
        else:
            allowed = _("along: CD, or through: [x, y] and angle")
            raise section.refusal(
                "through", _("the position and direction of this guide are not given"), allowed=allowed
            )
        return through + 1j * section.number("offset", LENGTH) * unit_vector(angle), angle, ends


def _refuse_lookalikes(shape: schema.File) -> None:
    """Refuse two point names that look alike but consist of different letters, such as Latin A and Cyrillic А.

    One of them is probably a typing error.
    """
    named: dict[str, Path] = {name: ("points", name) for name in shape.points}
    for link, keys in shape.links.items():
        path: Path = ("links", link, "points")
        listed = isinstance(keys.points, list)
        named |= {name: (*path, number if listed else name) for number, name in enumerate(keys.points)}
        named |= {name: ("links", link, "also", name) for name in keys.also}
    alike: dict[str, str] = {}
    for name in sorted(named, key=str.isascii, reverse=True):  # then the one with Cyrillic letters is at fault
        other = alike.setdefault(to_latin(name), name)
        if other != name:
            raise ProblemError(
                _("this name looks like another one but is written with different letters"),
                path=named[name],
                found=quote(name),
                near=other,
                key=True,
            )


def refuse_unused(shape: schema.File, data: dict[str, Any], members: LinksAndPairs) -> None:
    """Refuse links without pairs, unused guides, and points that are named only once: these are probably mistakes."""
    links = members.links
    joined = {name for h in members.hinges for name in h.links} | {
        n for s in members.slides for n in (s.carrier, s.runner)
    }
    for name in shape.links:
        if name not in joined:
            raise ProblemError(
                _("this link is not joined to any other link"),
                path=("links", name),
                found=", ".join(links[name].points),
                allowed=_("a point shared with another link or the frame, or `slides`"),
                key=True,
            )
    used = {s.on for link in shape.links.values() for s in link.sliding}
    for guide in shape.guides:
        if guide not in used:
            raise ProblemError(_("nothing slides on this guide"), path=("guides", guide), found=quote(guide), key=True)
    shared = {h.point for h in members.hinges}
    alone = []
    for name, link in links.items():
        listed = list(link.points) if name == FRAME else shape.links[name].points
        running = {s.at for s in members.slides if s.runner == name}
        for number, point in enumerate(listed if isinstance(listed, list) else ()):
            if point not in shared and link.points[point] not in running:
                alone.append((name, number, point))
    if not alone:
        return
    everything = list(dict.fromkeys(p for link in links.values() for p in link.points))
    elsewhere = _points_used_elsewhere(shape, data, links, everything)
    for name, number, point in alone:
        if point not in elsewhere:
            path: Path = ("points", point) if name == FRAME else ("links", name, "points", number)
            raise ProblemError(
                _("this point is not used anywhere else"),
                path=path,
                found=quote(point),
                allowed=_(
                    "a point shared with another link or the frame; give a point that forms no pair under `also`, with "
                    "its coordinates"
                ),
                near=nearest_name(point, [p for p in everything if p != point and p not in links[name].points]),
                key=name == FRAME,
            )


def _points_used_elsewhere(
    shape: schema.File, data: dict[str, Any], links: dict[str, Link], everything: list[str]
) -> set[str]:
    """Return the names of points that occur in the file outside the lists of points of the links.

    A text may contain the name of one point, or the names of two points such as CD or C-D.
    """
    all_points, used = set(everything), set[str]()
    for word in _find_texts({**data, "parameters": {}, "title": "", "description": ""}):
        used.add(word)
        two = re.sub(r"[-–, ]", "", word)
        for k in range(1, len(two) if len(two) <= MAX_PAIR_LENGTH else 0):
            used |= {two[:k], two[k:]} if all_points >= {two[:k], two[k:]} else set()
    for slide in (s for link in shape.links.values() for s in link.sliding):
        if slide.on in links and slide.along is None and slide.through is None and slide.angle is None:
            used |= set(links[slide.on].points)  # its two points are the guide
    return used


def _find_texts(section: Any) -> Iterator[str]:
    """Yield every text of a file that may name a point, except those in the lists of points of the links."""
    if isinstance(section, dict):
        yield from section
        section = [value for key, value in section.items() if key != "points"]
    if isinstance(section, list):
        for value in section:
            yield from _find_texts(value)
    elif isinstance(section, str):
        yield section
