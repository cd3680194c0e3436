"""Toothed wheels, racks and cams of a problem file."""

from __future__ import annotations

import math

from tmm_cli.camlaw import CamLaw, Piece
from tmm_cli.linkage import FRAME, Hinge, Link, Mesh, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.sense import Sense, check_name
from tmm_cli.problem.units import ANGLE, LENGTH, NUMBER
from tmm_cli.vectors import cross, unit

MESHES = 1e-6  # of the distance of the axes: pitch circles that miss one another by less touch
MANY_TEETH = 100_000


def build_meshes(
    shape: schema.File, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense
) -> tuple[Mesh, ...]:
    """All higher pairs: gears, racks, cams."""
    maker = _Maker(links, hinges, slides, sense)
    taken = {h.point for h in hinges} | {s.name for s in slides}
    found: list[Mesh] = []

    def named(block: str, name: str) -> Path:
        path: Path = (block, name)
        check_name(name, path, "point")
        if name in taken:
            raise ProblemError("another pair has this name", path=path, found=quote(name), key=True)
        taken.add(name)
        return path

    found += [maker.gear(name, gear, named("gears", name)) for name, gear in shape.gears.items()]
    found += [maker.rack(name, rack, named("racks", name)) for name, rack in shape.racks.items()]
    found += [maker.cam(name, cam, named("cams", name)) for name, cam in shape.cams.items()]
    return tuple(found)


class _Maker:
    def __init__(
        self, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense
    ) -> None:
        self.links, self.hinges, self.slides, self.sense = links, hinges, slides, sense

    def axis(self, link: str, carrier: str, path: Path, what: str) -> complex:
        """Where a link is hinged to the carrier, in the carrier's axes (m)."""
        for hinge in self.hinges:
            if {link, carrier} <= set(hinge.links):
                return self.links[carrier].points[hinge.point]
        where = "the frame" if carrier == FRAME else f"link {carrier}"
        raise ProblemError(
            f"{what} is not hinged to {where}", path=path, found=quote(link),
            allowed="a link with a hinge there; carrier: the link that carries the axes",
        )  # fmt: skip

    def gear(self, name: str, given: schema.Gear, path: Path) -> Mesh:
        i, j = (self.sense.known(n, self.links, (*path, "between", k), "link") for k, n in enumerate(given.between))
        carrier = self.sense.known(given.carrier, self.links, (*path, "carrier"), "link")
        if len({i, j, carrier}) < 3:
            raise ProblemError(
                "wheels and carrier are three different links", path=(*path, "between"),
                found=f"{i}, {j} on {carrier}", allowed="carrier: the link that carries both axes",
            )  # fmt: skip
        axes = [self.axis(n, carrier, (*path, "between", k), f"wheel {n}") for k, n in enumerate((i, j))]
        distance = abs(axes[1] - axes[0])
        if distance == 0 and not given.inner:
            raise ProblemError("both wheels turn about one axis", path=(*path, "between"), found=f"{i}, {j}")
        size = self._ratio(given, path)
        self._meshes(given, distance, size, path)
        ratio = size if given.inner else -size
        if ratio == 1:
            raise ProblemError(
                "an inner mesh of equal wheels has no place where they touch", path=path, found="ratio 1", key=True
            )
        return Mesh(
            name, "gear", i, j, carrier, ratio, self.sense.number(given.offset, ANGLE, (*path, "offset")),
            pressure=self._pressure(given.pressure, path),
        )  # fmt: skip

    def _pressure(self, value: object, path: Path) -> float:
        angle = self.sense.number(value, ANGLE, (*path, "pressure"))
        if not 0 <= angle < math.pi / 2:
            raise ProblemError(
                "a pressure angle of teeth lies between 0 and 90 deg", path=(*path, "pressure"), found=str(value)
            )
        return angle

    def _ratio(self, given: schema.Gear, path: Path) -> float:
        """First radius over second; all that is given must agree."""
        found: list[tuple[str, float]] = []
        for key in ("teeth", "radii"):
            pair = getattr(given, key)
            if pair is None:
                continue
            if len(pair) != 2:
                raise ProblemError(
                    "two numbers are wanted, for both wheels", path=(*path, key), found=str(pair), allowed="[20, 40]"
                )
            if key == "teeth":
                for k, teeth in enumerate(pair):
                    if not 1 <= teeth <= MANY_TEETH:
                        raise ProblemError(
                            "a number of teeth is wanted", path=(*path, key, k), found=str(teeth), allowed="1 and more"
                        )
                found.append((key, pair[0] / pair[1]))
            else:
                r = [self.sense.positive(v, LENGTH, (*path, key, k)) for k, v in enumerate(pair)]
                found.append((key, r[0] / r[1]))
        if given.ratio is not None:
            found.append(("ratio", self.sense.positive(given.ratio, NUMBER, (*path, "ratio"))))
        if not found:
            raise ProblemError("teeth, radii or ratio is wanted", path=path, found="none", allowed="teeth: [20, 40]",
                               key=True)  # fmt: skip
        first, size = found[0]
        for key, other in found[1:]:
            if abs(other - size) > MESHES * size:
                raise ProblemError(
                    "contradictory gear ratios", path=(*path, key), found=f"{other:.6g}, by {first} {size:.6g}",
                    allowed="one of them",
                )  # fmt: skip
        return size

    def _meshes(self, given: schema.Gear, distance: float, size: float, path: Path) -> None:
        """Whether the pitch circles touch at the distance of the axes."""
        radii = None
        if given.radii is not None:
            key = "radii"
            radii = [self.sense.positive(v, LENGTH, (*path, key, k)) for k, v in enumerate(given.radii)]
        elif given.module is not None:
            key = "module"
            if given.teeth is None:
                raise ProblemError("a module needs numbers of teeth", path=(*path, key), allowed="teeth: [20, 40]")
            module = self.sense.positive(given.module, LENGTH, (*path, key))
            radii = [module * teeth / 2 for teeth in given.teeth]
        if radii is None:
            if given.inner and size == 1:
                return
            if distance == 0:
                raise ProblemError("both wheels turn about one axis", path=(*path, "between"), found=str(given.between))
            return
        wanted = abs(radii[0] - radii[1]) if given.inner else radii[0] + radii[1]
        if abs(wanted - distance) > MESHES * max(wanted, distance):
            units = self.sense.units
            shown = [f"{units.from_si(v, LENGTH):.6g} {units.symbol(LENGTH)}" for v in (distance, wanted)]
            raise ProblemError(
                f"wheels {given.between[0]} and {given.between[1]} do not mesh: their axes are {shown[0]} apart",
                path=(*path, key), found=f"{'difference' if given.inner else 'sum'} of the pitch radii {shown[1]}",
                allowed=f"a distance of {shown[1]}" + ("" if given.inner else ", or inner: true"),
            )  # fmt: skip

    def rack(self, name: str, given: schema.Rack, path: Path) -> Mesh:
        wheel, rack, carrier = (
            self.sense.known(getattr(given, key), self.links, (*path, key), "link")
            for key in ("wheel", "rack", "carrier")
        )
        axis = self.axis(wheel, carrier, (*path, "wheel"), f"wheel {wheel}")
        slide = self._slide(rack, carrier, (*path, "rack"), "the rack")
        radius = self.sense.positive(given.radius, LENGTH, (*path, "radius"))
        # the line of the guide and the forward direction of the rack, both on the carrier where it carries the guide
        on_guide = slide.carrier == carrier
        high = float(cross(unit(slide.direction), axis - slide.through)) if on_guide else 0.0
        side = {"left": 1.0, "right": -1.0}[given.side] if given.side else math.copysign(1.0, high)
        if given.side is None and abs(high) < 1e-9 * radius:
            raise ProblemError(
                "on which side of the rack is the wheel?", path=(*path, "side"),
                found="its axis is on the guide's line",
                allowed="side: left or right, looking along the guide",
            )  # fmt: skip
        forward = 1.0 if slide.runner == rack else -1.0
        return Mesh(
            name, "rack", wheel, rack, carrier, side * forward * radius,
            self.sense.number(given.offset, LENGTH, (*path, "offset")), slide.name,
            pressure=self._pressure(given.pressure, path),
        )  # fmt: skip

    def _slide(self, link: str, carrier: str, path: Path, what: str) -> Slide:
        for slide in self.slides:
            if {slide.carrier, slide.runner} == {link, carrier}:
                return slide
        where = "the frame" if carrier == FRAME else f"link {carrier}"
        raise ProblemError(
            f"{what} does not slide on {where}", path=path, found=quote(link), allowed=f"a link that slides on {where}"
        )

    def cam(self, name: str, given: schema.Cam, path: Path) -> Mesh:
        cam, follower = (
            self.sense.known(getattr(given, k), self.links, (*path, k), "link") for k in ("cam", "follower")
        )
        self.axis(cam, FRAME, (*path, "cam"), f"cam {cam}")
        slides = any({s.carrier, s.runner} == {follower, FRAME} for s in self.slides)
        if not slides:
            self.axis(follower, FRAME, (*path, "follower"), f"follower {follower}")
        slide = self._slide(follower, FRAME, (*path, "follower"), "the follower").name if slides else ""
        want = LENGTH if slides else ANGLE
        pieces = []
        for k, piece in enumerate(given.law):
            spot: Path = (*path, "law", k)
            over = self.sense.positive(piece.over, ANGLE, (*spot, "over"))
            pieces.append(Piece(over, self.sense.number(piece.rise, want, (*spot, "rise")), piece.law))
        turn, rise = sum(p.over for p in pieces), sum(p.rise for p in pieces)
        units = self.sense.units
        if abs(turn - 2 * math.pi) > 1e-9:
            raise ProblemError(
                "the pieces of the law do not make a full turn", path=(*path, "law"),
                found=f"{units.from_si(turn, ANGLE):.6g} {units.symbol(ANGLE)}",
                allowed=f"{units.from_si(2 * math.pi, ANGLE):.6g} {units.symbol(ANGLE)} together",
            )  # fmt: skip
        if abs(rise) > 1e-9 * max(abs(p.rise) for p in pieces):
            raise ProblemError(
                "after a turn the follower is not back where it was", path=(*path, "law"),
                found=f"it has gone {units.from_si(rise, want):.6g} {units.symbol(want)}",
                allowed="rises that add up to 0",
            )  # fmt: skip
        law = CamLaw(tuple(pieces), self.sense.number(given.start, ANGLE, (*path, "start")))
        offset = self.sense.number(given.offset, want, (*path, "offset"))
        return Mesh(name, "cam", cam, follower, FRAME, offset=offset, slide=slide, law=law)
