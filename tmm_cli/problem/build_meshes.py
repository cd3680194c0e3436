"""Toothed wheels, racks and cams of a problem file."""

from __future__ import annotations

import math

from tmm_cli.camlaw import CamLaw, Piece
from tmm_cli.linkage import FRAME, Hinge, Link, Mesh, Slide
from tmm_cli.problem import schema, schema_more
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.sense import Sense, check_name
from tmm_cli.problem.units import ANGLE, LENGTH, NUMBER
from tmm_cli.vectors import cross, unit

MESHES = 1e-6  # of the distance of the axes: pitch circles that miss one another by less touch
IN_PHASE = (
    5e-7  # rad: wheels that come round a ring to the same place but for less fit together, as offsets are rounded
)
MANY_TEETH = 100_000
WHOLE = 1e-9  # teeth: a number that arithmetic gave is whole but for rounding


def build_meshes(
    shape: schema.File, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense
) -> tuple[Mesh, ...]:
    """All higher pairs: gears, racks, cams."""
    maker = _Maker(links, hinges, slides, sense)
    taken = {h.point for h in hinges} | {s.name for s in slides}
    found: list[Mesh] = []

    def named(block: str, name: str) -> Path:
        path: Path = (block, name)
        check_name(name, path, "pair")
        if name in taken:
            raise ProblemError(
                "another pair has this name", path=path, found=quote(name),
                allowed="a name that no hinge, guide, gear, rack or cam has", key=True,
            )  # fmt: skip
        taken.add(name)
        return path

    found += [maker.gear(name, gear, named("gears", name)) for name, gear in shape.gears.items()]
    _no_contradiction(found, sense)
    found += [maker.rack(name, rack, named("racks", name)) for name, rack in shape.racks.items()]
    found += [maker.cam(name, cam, named("cams", name)) for name, cam in shape.cams.items()]
    return tuple(found)


def _no_contradiction(gears: list[Mesh], sense: Sense) -> None:
    """Refuse wheels on one carrier that mesh in a ring with ratios that let none of them turn, or out of phase."""
    turn: dict[tuple[str, str], dict[str, float]] = {}  # of each wheel a turn of the first one of its train
    phase: dict[tuple[str, str], dict[str, float]] = {}  # angle (rad) of each wheel where that of the first is zero
    trains: dict[tuple[str, str], tuple[str, str]] = {}
    used: dict[tuple[str, str], list[Mesh]] = {}
    for gear in gears:
        one, other = ((gear.carrier, n) for n in (gear.i, gear.j))
        for end in (one, other):
            if end not in trains:
                trains[end], turn[end], phase[end], used[end] = end, {end[1]: 1.0}, {end[1]: 0.0}, []
        first, second = trains[one], trains[other]
        asked = gear.ratio * turn[first][gear.i]
        angle = gear.ratio * phase[first][gear.i] + gear.offset
        if first == second:
            found = turn[first][gear.j]
            if abs(asked - found) > MESHES * max(abs(asked), abs(found)):
                ring = _ring([*used[first], gear])
                wheels = list(dict.fromkeys(n for mesh in ring for n in (mesh.i, mesh.j)))
                ahead, behind = (f"{v / turn[first][gear.i]:.6g}" for v in (asked, found))
                raise ProblemError(
                    f"contradictory gear ratios: wheels {', '.join(wheels)} lock one another",
                    path=("gears", gear.name),
                    found=f"a turn of {gear.i} turns {gear.j} by {ahead} in gear {gear.name}, by {behind} through "
                    f"{', '.join(mesh.name for mesh in ring if mesh is not gear)}",
                    allowed="gears round a ring whose ratios agree (an outer mesh changes the sense), or one gear less",
                    key=True,
                )  # fmt: skip
            if abs(angle - phase[first][gear.j]) > IN_PHASE:
                raise _out_of_phase(gear, _ring([*used[first], gear]), angle, phase[first][gear.j], sense)
            continue
        scale = asked / turn[second][gear.j]
        shift = (angle - phase[second][gear.j]) / turn[second][gear.j]
        phase[first] |= {wheel: turn[second][wheel] * shift + value for wheel, value in phase[second].items()}
        turn[first] |= {wheel: scale * value for wheel, value in turn[second].items()}
        used[first] += [*used[second], gear]
        trains = {end: first if train == second else train for end, train in trains.items()}


def _out_of_phase(gear: Mesh, ring: list[Mesh], asked: float, found: float, sense: Sense) -> ProblemError:
    """The refusal of a gear whose offset puts its second wheel elsewhere than the others of its ring do."""
    wheels = list(dict.fromkeys(n for mesh in ring for n in (mesh.i, mesh.j)))

    def shown(angle: float, digits: int = 6) -> str:
        return f"{sense.units.from_si(angle, ANGLE):.{digits}g} {sense.units.symbol(ANGLE)}"

    return ProblemError(
        f"contradictory offsets: wheels {', '.join(wheels)} do not fit together", path=("gears", gear.name),
        found=f"gear {gear.name} puts {gear.j} {shown(asked - found)} further than "
        f"{', '.join(mesh.name for mesh in ring if mesh is not gear)}",
        allowed=f"offset: {shown(gear.offset + found - asked, 9)}, or one gear less", key=True,
    )  # fmt: skip


def _ring(gears: list[Mesh]) -> list[Mesh]:
    """The gears of a train in which each wheel meshes twice: what is left when the loose ends are taken off."""
    while True:
        ends = [n for mesh in gears for n in (mesh.i, mesh.j)]
        kept = [mesh for mesh in gears if ends.count(mesh.i) > 1 and ends.count(mesh.j) > 1]
        if len(kept) == len(gears):
            return gears
        gears = kept


class _Maker:
    def __init__(
        self, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense
    ) -> None:
        self.links, self.hinges, self.slides, self.sense = links, hinges, slides, sense

    @staticmethod
    def three(links: dict[str, str], path: Path) -> None:
        """Refuse a pair whose parts are not three different links; links: by what they are."""
        if len(set(links.values())) < len(links):
            *most, last = links
            raise ProblemError(
                f"{', '.join(most)} and {last} are three different links", path=path,
                found=", ".join(f"{what} {link}" for what, link in links.items()), allowed="another link", key=True,
            )  # fmt: skip

    def axis(self, link: str, carrier: str, path: Path, what: str, carried: bool = True) -> complex:
        """Where a link is hinged to the carrier, in the carrier's axes (m)."""
        for hinge in self.hinges:
            if {link, carrier} <= set(hinge.links):
                return self.links[carrier].points[hinge.point]
        where = "the frame" if carrier == FRAME else f"link {carrier}"
        hinged = dict.fromkeys(n for h in self.hinges if carrier in h.links for n in h.links if n != carrier)
        raise ProblemError(
            f"{what} is not hinged to {where}", path=path, found=quote(link),
            allowed=f"a link hinged to {where}: {', '.join(hinged) or 'there is none'}"
            + ("; carrier: the link that carries the axes" if carried else ""),
        )  # fmt: skip

    def gear(self, name: str, given: schema_more.Gear, path: Path) -> Mesh:
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
            raise self._one_axis(i, j, carrier, path)
        size = self._ratio(given, path)
        if not 1 / MANY_TEETH <= size <= MANY_TEETH:
            raise ProblemError(
                "no pair of wheels has this ratio", path=(*path, "ratio"), found=f"{size:.6g}",
                allowed=f"{1 / MANY_TEETH:g} to {MANY_TEETH}",
            )  # fmt: skip
        self._meshes(given, distance, size, path)
        if distance == 0:
            raise self._one_axis(i, j, carrier, path)
        ratio = size if given.inner else -size
        if ratio == 1:
            raise ProblemError(
                "an inner mesh of equal wheels has no place where they touch", path=path, found="ratio 1",
                allowed="wheels of different size", key=True,
            )  # fmt: skip
        return Mesh(
            name, "gear", i, j, carrier, ratio, self.sense.number(given.offset, ANGLE, (*path, "offset")),
            pressure=self._pressure(given.pressure, path),
        )  # fmt: skip

    def _one_axis(self, i: str, j: str, carrier: str, path: Path) -> ProblemError:
        where = "the frame" if carrier == FRAME else f"link {carrier}"
        return ProblemError(
            f"wheels {i} and {j} turn about one axis of {where}", path=(*path, "between"), found=f"{i}, {j}",
            allowed="axes some way apart",
        )  # fmt: skip

    def _pressure(self, value: object, path: Path) -> float:
        angle = self.sense.number(value, ANGLE, (*path, "pressure"))
        if not 0 <= angle < math.pi / 2:
            raise ProblemError(
                "a pressure angle of teeth lies between 0 and 90 deg", path=(*path, "pressure"), found=str(value),
                allowed="0 and more, less than 90 deg; 20 deg is usual",
            )  # fmt: skip
        return angle

    def _ratio(self, given: schema_more.Gear, path: Path) -> float:
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
                first, second = (self._teeth(v, (*path, key, k)) for k, v in enumerate(pair))
                found.append((key, first / second))
            else:
                r = [self.sense.positive(v, LENGTH, (*path, key, k)) for k, v in enumerate(pair)]
                found.append((key, r[0] / r[1]))
        if given.ratio is not None:
            found.append(("ratio", self.sense.positive(given.ratio, NUMBER, (*path, "ratio"))))
        if not found and given.module is not None:
            raise ProblemError("a module needs numbers of teeth", path=(*path, "module"), found=str(given.module),
                               allowed="teeth: [20, 40]")  # fmt: skip
        if not found:
            raise ProblemError("teeth, radii or ratio is wanted", path=path, found="none", allowed="teeth: [20, 40]",
                               key=True)  # fmt: skip
        known, size = found[0]
        for key, other in found[1:]:
            if abs(other - size) > MESHES * size:
                raise ProblemError(
                    f"contradictory gear ratios of wheels {' and '.join(given.between)}", path=(*path, key),
                    found=f"by {key} {other:.6g}, by {known} {size:.6g}", allowed=f"{known} or {key}, or both alike",
                )  # fmt: skip
        return size

    def _teeth(self, value: object, path: Path) -> float:
        """A number of teeth, which is whole."""
        teeth = self.sense.number(value, NUMBER, path)
        if not 1 <= teeth <= MANY_TEETH:
            raise ProblemError("a number of teeth is wanted", path=path, found=quote(value), allowed="1 and more")
        whole = round(float(teeth))
        if abs(float(teeth) - whole) > WHOLE:
            near = f"{math.floor(float(teeth))} or {math.ceil(float(teeth))}"
            told = quote(value) if isinstance(value, float) else f"{quote(value)}, which is {float(teeth):.6g}"
            raise ProblemError("a number of teeth is whole", path=path, found=told, allowed=near)
        return float(whole) if isinstance(teeth, float) else teeth

    def _meshes(self, given: schema_more.Gear, distance: float, size: float, path: Path) -> None:
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
            radii = [module * self._teeth(v, (*path, "teeth", k)) / 2 for k, v in enumerate(given.teeth)]
        if radii is None:
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

    def rack(self, name: str, given: schema_more.Rack, path: Path) -> Mesh:
        wheel, rack, carrier = (
            self.sense.known(getattr(given, key), self.links, (*path, key), "link")
            for key in ("wheel", "rack", "carrier")
        )
        self.three({"wheel": wheel, "rack": rack, "carrier": carrier}, path)
        axis = self.axis(wheel, carrier, (*path, "wheel"), f"wheel {wheel}")
        slide = self._slide(rack, carrier, (*path, "rack"))
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

    def _slide(self, link: str, carrier: str, path: Path) -> Slide:
        for slide in self.slides:
            if {slide.carrier, slide.runner} == {link, carrier}:
                return slide
        where = "the frame" if carrier == FRAME else f"link {carrier}"
        raise ProblemError(
            f"rack {link} does not slide on {where}", path=path, found=quote(link),
            allowed=f"a link that slides on {where}: {', '.join(self.sliding_on(carrier)) or 'there is none'}; "
            "carrier: the link that holds wheel and rack",
        )  # fmt: skip

    def sliding_on(self, carrier: str) -> list[str]:
        """The links that have a sliding pair with the carrier."""
        ends = [(s.carrier, s.runner) for s in self.slides] + [(s.runner, s.carrier) for s in self.slides]
        return list(dict.fromkeys(other for one, other in ends if one == carrier))

    def cam(self, name: str, given: schema_more.Cam, path: Path) -> Mesh:
        cam, follower = (
            self.sense.known(getattr(given, k), self.links, (*path, k), "link") for k in ("cam", "follower")
        )
        self.three({"cam": cam, "follower": follower, "frame": FRAME}, path)
        self.axis(cam, FRAME, (*path, "cam"), f"cam {cam}", carried=False)
        slides = follower in self.sliding_on(FRAME)
        hinged = {n for h in self.hinges if FRAME in h.links for n in h.links if n not in (FRAME, cam)}
        if not slides and follower not in hinged:
            here = [n for n in self.links if n in hinged or n in self.sliding_on(FRAME)]
            raise ProblemError(
                f"follower {follower} neither slides on the frame nor is hinged to it", path=(*path, "follower"),
                found=quote(follower), allowed=", ".join(here) or "a link with a guide or a hinge on the frame",
            )  # fmt: skip
        slide = self._slide(follower, FRAME, (*path, "follower")).name if slides else ""
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
