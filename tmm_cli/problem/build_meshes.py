"""Toothed wheels, racks and cams of a problem file."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tmm_cli.errors import _
from tmm_cli.linkage import FRAME, Hinge, Link, Mesh, Slide
from tmm_cli.pairs.cam_law import CamLaw, Piece
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.tree import Path
from tmm_cli.problem.values import ValueReader, check_name, unjoined
from tmm_cli.quantities import ANGLE, LENGTH, NUMBER
from tmm_cli.vectors import cross, unit

MESHES = 1e-6  # of the distance of the axes: pitch circles that miss one another by less touch
IN_PHASE = 5e-7  # rad: wheels that come round a ring to one place but for less fit, as offsets are rounded
MANY_TEETH = 100_000
WHOLE = 1e-9  # teeth: a number that arithmetic gave is whole but for rounding


def build_meshes(
    shape: schema.File,
    links: dict[str, Link],
    hinges: tuple[Hinge, ...],
    slides: tuple[Slide, ...],
    values: ValueReader,
) -> tuple[Mesh, ...]:
    """All higher pairs: gears, racks, cams."""
    maker = _Maker(links, hinges, slides, values)
    taken = {h.point for h in hinges} | {s.name for s in slides}
    found: list[Mesh] = []

    def named(block: str, name: str) -> Path:
        path: Path = (block, name)
        check_name(name, path, "pair", taken)
        taken.add(name)
        return path

    found += [maker.gear(name, gear, named("gears", name)) for name, gear in shape.gears.items()]
    _no_contradiction(found)
    found += [maker.rack(name, rack, named("racks", name)) for name, rack in shape.racks.items()]
    found += [maker.cam(name, cam, named("cams", name)) for name, cam in shape.cams.items()]
    return tuple(found)


def _no_contradiction(gears: list[Mesh]) -> None:
    """Refuse wheels on one carrier that mesh in a ring with ratios that let none of them turn, or out of phase."""
    # by carrier and wheel: the train, in which the angle of each wheel is a slope times that of one of them and a phase
    trains: dict[tuple[str, str], dict[str, tuple[float, float]]] = {}
    for gear in gears:
        one, other = (trains.setdefault((gear.carrier, n), {n: (1.0, 0.0)}) for n in (gear.i, gear.j))
        slope, phase = one[gear.i]
        wanted, angle = gear.ratio * slope, gear.ratio * phase + gear.offset
        found, there = other[gear.j]
        if one is not other:
            for wheel, (own, place) in other.items():
                one[wheel] = own * wanted / found, place + own * (angle - there) / found
                trains[gear.carrier, wheel] = one
        elif abs(wanted - found) > MESHES * max(abs(wanted), abs(found)) or abs(angle - there) > IN_PHASE:
            raise ProblemError(
                _("gear {name} contradicts those before it: the wheels lock one another").format(name=gear.name),
                path=("gears", gear.name), allowed=_("ratios and offsets that agree round a ring, or one gear less"),
                key=True,
            )  # fmt: skip


class _Maker:
    def __init__(
        self, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], values: ValueReader
    ) -> None:
        self.links, self.hinges, self.slides, self.values = links, hinges, slides, values

    def known(self, names: Sequence[str], path: Path) -> list[str]:
        """Names of links, all of them different."""
        for name in names:
            self.values.known(name, self.links, path, "link")
        self.values.different(names, path)
        return list(names)

    def axis(self, link: str, carrier: str, path: Path) -> complex:
        """Where a link is hinged to the carrier, in the carrier's axes (m)."""
        for hinge in self.hinges:
            if {link, carrier} <= set(hinge.links):
                return self.links[carrier].points[hinge.point]
        raise unjoined(link, carrier, self.hinges, (), path)

    def slide(self, link: str, carrier: str) -> Slide | None:
        """The sliding pair of a link and the carrier."""
        return next((s for s in self.slides if {s.carrier, s.runner} == {link, carrier}), None)

    def gear(self, name: str, given: schema.Gear, path: Path) -> Mesh:
        i, j, carrier = self.known([*given.between, given.carrier], (*path, "between"))
        first, second = (self.axis(n, carrier, (*path, "between", k)) for k, n in enumerate((i, j)))
        distance = abs(second - first)
        if distance == 0:
            raise ProblemError(
                _("wheels {i} and {j} turn about one axis").format(i=i, j=j), path=(*path, "between"), found=f"{i}, {j}"
            )
        ratio = self.ratio(given, distance, path)
        offset = self.values.number(given.offset, ANGLE, (*path, "offset"))
        return Mesh(name, "gear", i, j, carrier, ratio, offset, pressure=self.pressure(given.pressure, path))

    def pressure(self, value: object, path: Path) -> float:
        angle = self.values.number(value, ANGLE, (*path, "pressure"))
        if not 0 <= angle < math.pi / 2:
            raise ProblemError(
                _("a pressure angle of teeth lies between 0 and 90 deg"), path=(*path, "pressure"), found=str(value)
            )
        return angle

    def ratio(self, given: schema.Gear, distance: float, path: Path) -> float:
        """First radius over second, negative for an outer mesh; all that is given must agree."""
        teeth, radii = None, None
        found: dict[str, float] = {}
        if given.teeth is not None:
            teeth = [self.teeth(v, (*path, "teeth", k)) for k, v in enumerate(given.teeth)]
            found["teeth"] = teeth[0] / teeth[1]
        if given.radii is not None:
            radii = [self.values.positive(v, LENGTH, (*path, "radii", k)) for k, v in enumerate(given.radii)]
            found["radii"] = radii[0] / radii[1]
        if given.ratio is not None:
            found["ratio"] = self.values.positive(given.ratio, NUMBER, (*path, "ratio"))
        if not found or (given.module is not None and teeth is None):
            raise ProblemError(
                _("teeth, radii or ratio is wanted, with a module teeth"), path=path, allowed=_("teeth: [20, 40]"),
                key=True,
            )  # fmt: skip
        size = next(iter(found.values()))
        if any(abs(other - size) > MESHES * size for other in found.values()):
            raise ProblemError(
                _("contradictory gear ratios of wheels {i} and {j}").format(i=given.between[0], j=given.between[1]),
                path=path, found=", ".join(f"by {key} {value:.6g}" for key, value in found.items()), key=True,
            )  # fmt: skip
        if not 1 / MANY_TEETH <= size <= MANY_TEETH or (given.inner and size == 1):
            raise ProblemError(_("no pair of wheels has this ratio"), path=path, found=f"{size:.6g}", key=True)
        if given.module is not None and teeth is not None and radii is None:
            module = self.values.positive(given.module, LENGTH, (*path, "module"))
            radii = [module * number / 2 for number in teeth]
        if radii is not None:
            self.touching(abs(radii[0] - radii[1]) if given.inner else radii[0] + radii[1], distance, given, path)
        return size if given.inner else -size

    def teeth(self, value: object, path: Path) -> float:
        """A number of teeth, which is whole."""
        teeth = self.values.positive(value, NUMBER, path)
        whole = round(float(teeth))
        if abs(float(teeth) - whole) > WHOLE:
            raise ProblemError(_("a number of teeth is whole"), path=path, found=quote(value))
        return float(whole) if isinstance(teeth, float) else teeth

    def touching(self, wanted: float, distance: float, given: schema.Gear, path: Path) -> None:
        """Refuse pitch circles that do not touch at the distance of the axes."""
        if abs(wanted - distance) <= MESHES * max(wanted, distance):
            return
        units = self.values.units
        apart, needed = (f"{units.from_si(v, LENGTH):.6g} {units.symbol(LENGTH)}" for v in (distance, wanted))
        raise ProblemError(
            _("wheels {i} and {j} do not mesh: their axes are {distance} apart").format(
                i=given.between[0], j=given.between[1], distance=apart
            ),
            path=path, allowed=_("a distance of {wanted}").format(wanted=needed), key=True,
        )  # fmt: skip

    def rack(self, name: str, given: schema.Rack, path: Path) -> Mesh:
        wheel, rack, carrier = self.known((given.wheel, given.rack, given.carrier), path)
        axis = self.axis(wheel, carrier, (*path, "wheel"))
        slide = self.slide(rack, carrier)
        if slide is None:
            raise unjoined(rack, carrier, (), self.slides, (*path, "rack"))
        radius = self.values.positive(given.radius, LENGTH, (*path, "radius"))
        # the line of the guide and the forward direction of the rack, both on the carrier where it carries the guide
        on_guide = slide.carrier == carrier
        high = float(cross(unit(slide.direction), axis - slide.through)) if on_guide else 0.0
        side = {"left": 1.0, "right": -1.0}[given.side] if given.side else math.copysign(1.0, high)
        if given.side is None and abs(high) < 1e-9 * radius:
            raise ProblemError(
                _("on which side of the rack is the wheel?"), path=(*path, "side"),
                allowed=_("side: left or right, looking along the guide"),
            )  # fmt: skip
        forward = 1.0 if slide.runner == rack else -1.0
        return Mesh(
            name, "rack", wheel, rack, carrier, side * forward * radius,
            self.values.number(given.offset, LENGTH, (*path, "offset")), slide.name,
            pressure=self.pressure(given.pressure, path),
        )  # fmt: skip

    def cam(self, name: str, given: schema.Cam, path: Path) -> Mesh:
        cam, follower, __ = self.known((given.cam, given.follower, FRAME), path)
        self.axis(cam, FRAME, (*path, "cam"))
        slide = self.slide(follower, FRAME)
        if slide is None:
            self.axis(follower, FRAME, (*path, "follower"))
        want = ANGLE if slide is None else LENGTH
        pieces = []
        for k, piece in enumerate(given.law):
            spot: Path = (*path, "law", k)
            over = self.values.positive(piece.over, ANGLE, (*spot, "over"))
            pieces.append(Piece(over, self.values.number(piece.rise, want, (*spot, "rise")), piece.law))
        turn, rise = sum(p.over for p in pieces), sum(p.rise for p in pieces)
        if abs(turn - 2 * math.pi) > 1e-9:
            raise ProblemError(
                _("the pieces of the law do not make a full turn"), path=(*path, "law"),
                found=f"{math.degrees(turn):.6g} deg", allowed="360 deg",
            )  # fmt: skip
        if abs(rise) > 1e-9 * max(abs(p.rise) for p in pieces):
            raise ProblemError(
                _("after a turn the follower is not back where it was"), path=(*path, "law"),
                allowed=_("rises that add up to 0"),
            )  # fmt: skip
        law = CamLaw(tuple(pieces), self.values.number(given.start, ANGLE, (*path, "start")))
        offset = self.values.number(given.offset, want, (*path, "offset"))
        return Mesh(name, "cam", cam, follower, FRAME, offset=offset, slide=slide.name if slide else "", law=law)
