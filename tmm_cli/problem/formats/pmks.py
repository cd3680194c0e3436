"""Mechanisms of PMKS+ (app.pmksplus.com): records of a saved file, and their conversion to a mechanism.

Meaning of the records: mechanism-builder.ts, legacy-production-connections.ts, transcoder-data.ts and
docs/force-analysis-units.md of PMKS-Web/Planar-Mechanism-Kinematic-Simulator.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, nearest_name, quote
from tmm_cli.problem.formats.imported_mechanism import (
    FRAME,
    ImportedBody,
    ImportedDrive,
    ImportedLoad,
    ImportedMechanism,
    ImportedSlide,
    LengthUnit,
)

MAX_RECORDS = 500  # joints, links
METRES: Final[dict[LengthUnit, float]] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
POUND, POUND_FORCE = 0.45359237, 4.4482216152605
# kg, kg*m^2 and N in the stored unit: cm goes with g and kg*cm^2, in with lbm, lbm*in^2 and lbf, m with kg and kg*m^2
KILOGRAMS: Final[dict[LengthUnit, float]] = {"cm": 1e-3, "m": 1.0, "in": POUND}
INERTIA_UNITS: Final[dict[LengthUnit, float]] = {"cm": 1e-4, "m": 1.0, "in": POUND * 0.0254**2}
UNIT_NAMES: Final[dict[LengthUnit, str]] = {"cm": "g, kg*cm^2, N", "m": "kg, kg*m^2, N", "in": "lbm, lbm*in^2, lbf"}


@dataclass(frozen=True)
class PmksJoint:
    """Record of a joint in a PMKS+ file.

    Attributes:
        id: name of the joint.
        place: position (unit of length of the file).
        slides: True for a sliding joint.
        ground: True if the joint is on the frame.
        input: True if the joint is driven.
        angle: angle of a guide on the frame (rad).
        welded: True if the links do not rotate relative to the guide; at a revolute joint, if they form one link.
        carrier: link with the slot; empty if there is none.
        slot: the two joints of the carrier between which the slot lies.
        mass: mass of the sliding block (unit of mass of the file).
        speed: speed of the drive (rpm, or units of length per second); 0 for the speed of the file.
    """

    id: str
    place: complex
    slides: bool = False
    ground: bool = False
    input: bool = False
    angle: float = 0.0
    welded: bool = False
    carrier: str = ""
    slot: tuple[str, str] = ("", "")
    mass: float = 0.0
    speed: float = 0.0


@dataclass(frozen=True)
class PmksLink:
    """Record of a link in a PMKS+ file.

    Attributes:
        id: name of the link in the file.
        joints: names of its joints.
        piston: True for a sliding block of an older version, which has a sliding joint and a pin.
        mass, inertia, centre: mass properties in the units of the file.
        name: name shown by PMKS+.
        parts: names of the links welded to this one.
    """

    id: str
    joints: tuple[str, ...]
    piston: bool = False
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    name: str = ""
    parts: tuple[str, ...] = ()


@dataclass(frozen=True)
class PmksForce:
    """Record of a force in a PMKS+ file, drawn as an arrow between two points.

    Attributes:
        id: name of the force.
        link: loaded link.
        start, end: ends of the arrow (unit of length of the file); the force acts at `start`.
        turns: True if the force rotates with the link.
        outward: True if the force points from `start` to `end`; False for the opposite direction.
        size: magnitude (N or lbf).
    """

    id: str
    link: str
    start: complex
    end: complex
    turns: bool
    outward: bool
    size: float


@dataclass(frozen=True)
class PmksFile:
    """Content of a PMKS+ file.

    Attributes:
        joints, links, forces: records of the file.
        rpm: speed of driven cranks (rpm, positive counterclockwise).
        gravity: True if gravity is switched on.
        length: unit of length.
        linear: speed of driven sliders (units of length per second).
        notes: sentences on how unclear data were interpreted.
        left: sentences on what is not imported.
        title: title of the mechanism.
    """

    joints: tuple[PmksJoint, ...]
    links: tuple[PmksLink, ...]
    forces: tuple[PmksForce, ...]
    rpm: float
    gravity: bool
    length: LengthUnit
    linear: float = 5.0
    notes: tuple[str, ...] = ()
    left: tuple[str, ...] = ()
    title: str = ""


def import_pmks(saved: PmksFile, file: str) -> ImportedMechanism:
    """Convert the content of a PMKS+ file to an imported mechanism. Raises ProblemError."""
    _refuse_wrong_names(saved, file)
    return _PmksMechanism.of(_replace_old_blocks(saved, file), file).build_mechanism()


def _refuse_wrong_names(saved: PmksFile, file: str) -> None:
    """Refuse names that occur twice or that refer to no record."""
    for records in (saved.joints, saved.links):
        if len(records) > MAX_RECORDS:
            raise ProblemError(
                _("there are too many items or characters; at most {max_length} are allowed").format(
                    max_length=MAX_RECORDS
                ),
                file=file,
            )
    joints, links = [joint.id for joint in saved.joints], [link.id for link in saved.links]
    link_names = {*links, *(name for link in saved.links for name in link.parts)}
    for names in (joints, links):
        for k, name in enumerate(names):
            if name in names[:k]:
                raise ProblemError(_("this name occurs twice in the file"), found=quote(name), file=file)
    referenced = [(("forces", force.id), force.link) for force in saved.forces]
    referenced += [(("joints", joint.id), joint.carrier) for joint in saved.joints if joint.carrier]
    for path, name in referenced:
        if name not in link_names:
            raise ProblemError(
                _("there is no link of that name"),
                path=path,
                found=quote(name),
                near=nearest_name(name, link_names),
                file=file,
            )
    on = [(("links", link.id), joint) for link in saved.links for joint in link.joints]
    on += [(("joints", joint.id), end) for joint in saved.joints if joint.carrier for end in joint.slot]
    for path, name in on:
        if name not in joints:
            raise ProblemError(_("there is no joint of that name"), path=path, found=name, file=file)


def _replace_old_blocks(saved: PmksFile, file: str) -> PmksFile:
    """Replace each sliding block of an older version, with its sliding joint and its pin, by one joint."""
    joints = {joint.id: joint for joint in saved.joints}
    links, renamed = [link for link in saved.links if not link.piston], dict[str, str]()
    for block in (link for link in saved.links if link.piston):
        rails = [joints[name] for name in block.joints if joints[name].slides]
        pins = [joints[name] for name in block.joints if not joints[name].slides]
        if len(rails) != 1 or len(pins) != 1:
            raise ProblemError(
                _("expected a sliding block with one sliding joint and one pin"),
                path=("links", block.id),
                found=", ".join(block.joints),
                file=file,
            )
        (rail,), (pin,) = rails, pins
        others = [link.id for link in links if rail.id in link.joints and pin.id not in link.joints]
        carrier = rail.carrier or (others[0] if others and not rail.ground else "")
        joints[pin.id] = replace(
            rail,
            id=pin.id,
            ground=not carrier,
            input=rail.input or pin.input,
            welded=pin.welded,
            carrier=carrier,
            mass=block.mass,
            speed=rail.speed or pin.speed,
        )
        renamed[rail.id] = pin.id
        del joints[rail.id]
    for name, joint in joints.items():
        a, b = joint.slot
        joints[name] = replace(joint, slot=(renamed.get(a, a), renamed.get(b, b)))
    kept = [replace(link, joints=tuple(name for name in link.joints if name not in renamed)) for link in links]
    return replace(saved, joints=tuple(joints.values()), links=tuple(kept))


@dataclass(frozen=True)
class _PmksMechanism:
    """Converter of a PMKS+ file.

    Attributes:
        saved: content of the file.
        file: name of the file, for messages.
        joints: joints by name.
        owner: for each link record, the link that it is welded to (or itself).
        frame: links that are pinned to the frame at two points.
        left: sentences on what is not imported.
    """

    saved: PmksFile
    file: str
    joints: dict[str, PmksJoint]
    owner: dict[str, str]
    frame: frozenset[str]
    left: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, saved: PmksFile, file: str) -> _PmksMechanism:
        joints = {joint.id: joint for joint in saved.joints}
        owner = {name: link.id for link in saved.links for name in (link.id, *link.parts)}
        frame = set[str]()
        while True:  # a joint of a frame link is on the frame too
            fixed = {name for name, joint in joints.items() if joint.ground and not joint.slides}
            more = {
                link.id
                for link in saved.links
                if link.id not in frame and len({joints[name].place for name in link.joints if name in fixed}) > 1
            }
            if not more:
                return cls(saved, file, joints, owner, frozenset(frame))
            frame |= more
            for link in saved.links:
                for name in link.joints if link.id in more else ():
                    joints[name] = joints[name] if joints[name].slides else replace(joints[name], ground=True)

    def build_mechanism(self) -> ImportedMechanism:
        """Build the imported mechanism. Raises ProblemError."""
        slides = list(self._slides())
        blocks = [
            ImportedBody(name, (joint.id,), mass=joint.mass * KILOGRAMS[self.saved.length])
            for name, joint in ((self._block(joint), joint) for joint in self.joints.values())
            if name
        ]
        bodies = [self._body(link) for link in self.saved.links if link.id not in self.frame]
        used = {name for body in bodies for name in body.points}
        blocks = [block for block in blocks if block.points[0] in used]
        slides = [slide for slide in slides if slide.point in used]
        drive = self._drive(slides)
        pushes = list(self._pushes())
        attached = used.union(*(link.joints for link in self.saved.links if link.id in self.frame))
        self.left.extend(
            _("Joint {name} belongs to no moving link.").format(name=name)
            for name in self.joints
            if name not in attached
        )
        notes = [
            *self.saved.notes,
            _(
                "Masses, moments of inertia about the centre of mass and forces were read in these units: {units}."
            ).format(units=UNIT_NAMES[self.saved.length]),
        ]
        notes += [
            _("Link {name} is pinned to the frame at two points, so it is part of the frame.").format(name=name)
            for name in sorted(self.frame)
        ]
        return ImportedMechanism(
            "PMKS+",
            self.saved.title,
            self.saved.length,
            {name: joint.place for name, joint in self.joints.items() if name in used},
            tuple(name for name, joint in self.joints.items() if joint.ground and not joint.slides and name in used),
            (*bodies, *blocks),
            drive,
            tuple(slides),
            tuple(pushes),
            None if self.saved.gravity else 0j,
            notes=tuple(notes),
            left=(*self.saved.left, *self.left),
        )

    def _riders(self, joint: PmksJoint) -> list[str]:
        """Return the moving links that a joint connects; for a sliding joint, without the link that has the slot."""
        carrier = self._carrier(joint) if joint.slides else ""
        return [
            link.id
            for link in self.saved.links
            if joint.id in link.joints and link.id not in self.frame and link.id != carrier
        ]

    def _carrier(self, joint: PmksJoint) -> str:
        owner = self.owner[joint.carrier] if joint.carrier else FRAME
        return FRAME if owner in self.frame else owner

    def _block(self, joint: PmksJoint) -> str:
        """Return the name of the sliding block of a joint.

        It is empty if the links of the joint do not rotate relative to the guide, so that no separate block is needed.
        """
        return f"block_{joint.id}" if joint.slides and not joint.welded else ""

    def _slides(self) -> Iterator[ImportedSlide]:
        for joint in self.joints.values():
            riders = self._riders(joint)
            if not joint.slides:
                if joint.welded and len(riders) > 1:
                    raise self._refused(
                        joint, _("this joint is welded, but its links are not recorded as one link"), ", ".join(riders)
                    )
                continue
            carrier = self._carrier(joint)
            if not joint.ground and not joint.carrier:
                raise self._refused(joint, _("this sliding joint has no guide on the frame or on a link"))
            through, angle = self._slot(joint) if any(joint.slot) else (joint.place, joint.angle)
            if joint.welded and len(riders) > 1:
                raise self._refused(
                    joint, _("these links slide together, but are not recorded as one link"), ", ".join(riders)
                )
            if riders:
                yield ImportedSlide(self._block(joint) or riders[0], joint.id, carrier, through, angle)

    def _slot(self, joint: PmksJoint) -> tuple[complex, float]:
        """Return the position of a point on the slot of a joint, and the angle of the slot (rad)."""
        carrier = next(link for link in self.saved.links if link.id == self.owner[joint.carrier])
        if joint.ground:
            raise self._refused(joint, _("this slot is recorded both on the frame and on a link"), quote(joint.carrier))
        if joint.id in carrier.joints or any(end not in carrier.joints for end in joint.slot):
            raise self._refused(
                joint,
                _("the slot must lie between two joints of another link"),
                ", ".join((joint.carrier, *joint.slot)),
            )
        a, b = (self.joints[end].place for end in joint.slot)
        if a == b:
            raise self._refused(joint, _("the slot has no direction: its joints coincide"), ", ".join(joint.slot))
        return a, cmath.phase(b - a)

    def _body(self, link: PmksLink) -> ImportedBody:
        mass, inertia = link.mass * KILOGRAMS[self.saved.length], link.inertia * INERTIA_UNITS[self.saved.length]
        centre = link.centre
        for joint in (self.joints[name] for name in link.joints):
            if joint.slides and joint.welded and joint.mass and self._carrier(joint) != link.id:
                block, apart = joint.mass * KILOGRAMS[self.saved.length], abs(joint.place - centre)
                inertia += mass * block / (mass + block) * (apart * METRES[self.saved.length]) ** 2
                mass, centre = mass + block, (mass * centre + block * joint.place) / (mass + block)
        label = link.name if link.name != link.id else ""
        return ImportedBody(link.id, link.joints, label, mass, inertia, centre if mass else None)

    def _drive(self, slides: list[ImportedSlide]) -> ImportedDrive:
        driven = [joint for joint in self.joints.values() if joint.input]
        if len(driven) != 1:
            raise ProblemError(
                _("expected exactly one driving joint"),
                found=", ".join(joint.id for joint in driven) or "0",
                file=self.file,
            )
        (joint,) = driven
        if joint.slides:
            slide = next((slide for slide in slides if slide.point == joint.id), None)
            if slide is None:
                raise self._refused(joint, _("expected exactly one input link"), "0")
            at = ((joint.place - slide.through) * cmath.rect(1, -slide.angle)).real
            return ImportedDrive(slide.runner, joint.speed or self.saved.linear, "length/s", on=slide.carrier, at=at)
        cranks = self._riders(joint)
        if not joint.ground:
            raise self._refused(
                joint,
                _("a motor between two moving links cannot be imported"),
                ", ".join(cranks),
                _("a crank on the frame; otherwise write the block `driver` by hand"),
            )
        if len(cranks) != 1:
            raise self._refused(joint, _("expected exactly one input link"), ", ".join(cranks) or "0")
        return ImportedDrive(cranks[0], joint.speed or self.saved.rpm, "rpm")

    def _pushes(self) -> Iterator[ImportedLoad]:
        newton = POUND_FORCE if self.saved.length == "in" else 1.0
        for force in self.saved.forces:
            along = (force.end - force.start) * (1 if force.outward else -1)
            body = self.owner[force.link]
            if body in self.frame:
                self.left.append(_("Force {name} acts on the frame.").format(name=force.id))
            elif along and force.size:
                yield ImportedLoad(
                    force.id, body, force.start, newton * force.size * along / abs(along), turns=force.turns
                )
            elif force.size:
                self.left.append(_("Force {name} has no direction.").format(name=force.id))

    def _refused(self, joint: PmksJoint, message: str, found: str = "", allowed: str = "") -> ProblemError:
        return ProblemError(message, path=("joints", joint.id), found=found, allowed=allowed or None, file=self.file)
