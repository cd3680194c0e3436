"""PMKS+ (app.pmksplus.com): what its saved links and its CSV files say, made into a mechanism."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.problem.formats.foreign import FRAME, Body, Drive, Foreign, Length, Push, Slide

MOST = 500  # joints, links
INCH, POUND = 0.0254, 4.4482216152605


@dataclass(frozen=True)
class Joint:
    """angle: of the guide of one that slides, rad."""

    id: str
    place: complex
    slides: bool = False
    ground: bool = False
    input: bool = False
    angle: float = 0.0


@dataclass(frozen=True)
class Link:
    """piston: a stone, which has the joint that slides and the one that it turns on, both in one place."""

    id: str
    joints: tuple[str, ...]
    piston: bool = False
    mass: float = 0.0
    inertia: float = 0.0
    centre: complex = 0j
    name: str = ""


@dataclass(frozen=True)
class Force:
    """From a place to another one; outward: it points so, else the other way. size in N, or in lbf."""

    id: str
    link: str
    start: complex
    end: complex
    turns: bool
    outward: bool
    size: float


@dataclass(frozen=True)
class Saved:
    """A file of PMKS+. rpm: positive counterclockwise; gravity: whether links have weight."""

    joints: tuple[Joint, ...]
    links: tuple[Link, ...]
    forces: tuple[Force, ...]
    rpm: float
    gravity: bool
    length: Length
    pounds: bool = False
    notes: tuple[str, ...] = ()


def foreign(saved: Saved, file: str) -> Foreign:
    """The mechanism. Raises ProblemError."""
    joints = {joint.id: joint for joint in saved.joints}
    for each in (saved.joints, saved.links):
        if len(each) > MOST:
            raise ProblemError(_("this is too long: at most {max_length}").format(max_length=MOST), file=file)
    links = {link.id: link for link in saved.links}
    for ids in ([joint.id for joint in saved.joints], [link.id for link in saved.links]):
        for k, name in enumerate(ids):
            if name in ids[:k]:
                raise ProblemError(_("a name is given twice"), found=quote(name), file=file)
    for force in saved.forces:
        if force.link not in links:
            raise ProblemError(_("there is no link of that name"), path=("forces", force.id), found=quote(force.link),
                               near=nearest(force.link, links), file=file)  # fmt: skip
    for link in saved.links:
        for joint in link.joints:
            if joint not in joints:
                raise ProblemError(_("a joint that is not there"), path=("links", link.id), found=joint, file=file)
    bodies, slides = [], []
    for link in saved.links:
        rails = [joints[name] for name in link.joints if joints[name].slides]
        stone = link.piston or len(link.joints) == len(rails)
        own = tuple(name for name in link.joints if not joints[name].slides)
        for rail in rails if stone else ():
            others = [one for one in saved.links if one is not link and rail.id in one.joints]
            carrier = FRAME if rail.ground or not others else others[0].id
            slides.append(Slide(link.id, own[0] if own else rail.id, carrier, rail.place, rail.angle))
        kept = own if stone and own else link.joints
        bodies.append(
            Body(link.id, kept, link.name if link.name != link.id else "", link.mass, link.inertia,
                 None if stone or not link.mass else link.centre)
        )  # fmt: skip
    drive = _drive(saved, joints, file)
    unit = POUND if saved.pounds else 1.0
    pushes = []
    for force in saved.forces:
        along = (force.end - force.start) * (1 if force.outward else -1)
        if along:
            at = force.start
            pushes.append(Push(force.id, force.link, at, unit * force.size * along / abs(along), turns=force.turns))
    used = {name for body in bodies for name in body.points}
    frame = tuple(name for name, joint in joints.items() if joint.ground and not joint.slides and name in used)
    places = {name: joint.place for name, joint in joints.items() if name in used}
    notes = (*saved.notes, _("Masses are taken for kg, moments of inertia for kg*m^2, about the centre of mass."))
    return Foreign(
        "PMKS+", "", saved.length, places, frame, tuple(bodies), drive, tuple(slides), tuple(pushes),
        None if saved.gravity else 0j, notes=notes,
    )  # fmt: skip


def _drive(saved: Saved, joints: dict[str, Joint], file: str) -> Drive:
    driven = [joint for joint in saved.joints if joint.input]
    if len(driven) != 1:
        raise ProblemError(_("one driving joint is wanted"), found=str(len(driven)), file=file)
    joint = driven[0]
    if joint.slides or not joint.ground:
        raise ProblemError(
            _("a driving slider, or one that is driven from a moving link, is not taken over"), found=joint.id,
            allowed=_("a crank on the frame; else write the block `driver` by hand"), file=file,
        )  # fmt: skip
    cranks = [link.id for link in saved.links if joint.id in link.joints]
    if len(cranks) != 1:
        raise ProblemError(_("one driving link is wanted"), found=", ".join(cranks), file=file)
    return Drive(cranks[0], saved.rpm, "rpm")
