"""pylinkage: JSON of `mechanism_to_json` (pylinkage 0.8 and later, pylinkage/mechanism/serialization.py)."""

from __future__ import annotations

import cmath
import math

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats.imported_mechanism import (
    FRAME,
    FileNode,
    ImportedBody,
    ImportedDrive,
    ImportedMechanism,
    ImportedSlide,
)
from tmm_cli.problem.reader import read_text

JOINT_TYPES = ("ground", "revolute", "prismatic", "tracker")
LINK_TYPES = ("ground", "driver", "arc_driver", "link")


def recognised(text: str) -> bool:
    """Return True if the text is a JSON file of pylinkage."""
    return text.lstrip().startswith("{") and '"joints"' in text and '"links"' in text


def read(text: str, file: str) -> ImportedMechanism:
    """Read the mechanism from a JSON file of pylinkage. Raises ProblemError."""
    top = FileNode(tree := read_text(text, file), tree.data)
    joints: dict[str, FileNode] = {}
    for joint in top["joints"].items():
        if joints.setdefault(joint["id"].text(), joint) is not joint:
            raise joint["id"].refusal(_("this name occurs twice in the file"))
    links = top["links"].items()
    frame = _frame_joints(joints, links)
    positions = {name: _joint_place(joint) for name, joint in joints.items()}
    kinds = {name: _joint_type(joint) for name, joint in joints.items()}
    bodies: list[ImportedBody] = []
    drive, left = None, []
    notes = [_("Lengths have no unit in pylinkage; they were taken as millimetres.")]
    for link in links:
        kind, name = link["type"].one_of(LINK_TYPES), link["id"].text()
        if name in (body.name for body in bodies):
            raise link["id"].refusal(_("this name occurs twice in the file"))
        if kind == "ground":
            continue
        names = [joint_node.one_of(joints) for joint_node in link["joints"].items()]
        followed = [j for j in joints if kinds[j] == "tracker" and _referenced_joints(joints[j]) <= set(names)]
        names += [j for j in followed if j not in names]
        bodies.append(ImportedBody(name, tuple(names), _link_label(link, name)))
        if kind != "link":
            if drive is not None:
                raise link.refusal(_("expected exactly one input link"))
            rate = speed.number() if (speed := link.get("angular_velocity")) else math.tau / 360
            drive = ImportedDrive(name, rate)
            notes.append(_("The angular velocity of pylinkage, in rad per unit of time, was taken as rad/s."))
            if kind == "arc_driver":
                left.append(
                    _(
                        "In pylinkage link {link} is driven back and forth over an arc; here it moves over its whole "
                        "range."
                    ).format(link=name)
                )
    if drive is None:
        raise ProblemError(_("there is no driving link"), allowed="type: driver", file=file)
    slides = []
    for name, kind in kinds.items():
        if kind == "prismatic":
            joint, stone = joints[name], _block_name(name, [body.name for body in bodies])
            axis = vector.vector() if (vector := joint.get("axis")) else 1 + 0j
            if not axis:
                raise joint["axis"].refusal(_("this vector has no direction: its length is zero"))
            through = at.vector() if (at := joint.get("line_point")) else 0j
            bodies.append(ImportedBody(stone, (name,)))
            slides.append(ImportedSlide(stone, name, FRAME, through, cmath.phase(axis)))
            notes.append(
                _("Joint {joint} moves along a line of the frame; slider {link} was added for it.").format(
                    joint=name, link=stone
                )
            )
        if kind == "tracker" and not any(name in body.points for body in bodies):
            left.append(_("Point {point} follows two joints that are not on one link.").format(point=name))
    used = {point for body in bodies for point in body.points}
    left += [
        _("Joint {joint} belongs to no moving link.").format(joint=j)
        for j in joints
        if j not in used and kinds[j] != "tracker"
    ]
    title = named.text() if (named := top.get("name")) and named.data else ""
    return ImportedMechanism(
        "pylinkage",
        title,
        "mm",
        {j: z for j, z in positions.items() if j in used},
        tuple(j for j in frame if j in used),
        tuple(bodies),
        drive,
        tuple(slides),
        notes=tuple(dict.fromkeys(notes)),
        left=tuple(left),
    )


def _frame_joints(joints: dict[str, FileNode], links: list[FileNode]) -> tuple[str, ...]:
    """Return the joints on the frame: those of type ground, those of the ground link, and the pivots of drivers."""
    names = [name for name, joint in joints.items() if _joint_type(joint) == "ground"]
    for link in links:
        if link["type"].data == "ground":
            names += [joint_node.one_of(joints) for joint_node in link["joints"].items()]
        if motor := link.get("motor_joint"):
            names.append(motor.one_of(joints))
    return tuple(dict.fromkeys(names))


def _joint_type(joint: FileNode) -> str:
    type_node = joint.get("type")
    return type_node.one_of(JOINT_TYPES) if type_node else "revolute"


def _joint_place(joint: FileNode) -> complex:
    if joint["position"].data == [None, None]:
        raise joint["position"].refusal(
            _("the mechanism was saved before it was assembled: the positions of its joints are missing"),
            _("positions of all joints"),
        )
    return joint["position"].vector()


def _referenced_joints(joint: FileNode) -> set[str]:
    return {joint[key].text() for key in ("ref_joint1_id", "ref_joint2_id")}


def _link_label(link: FileNode, name: str) -> str:
    return called.text() if (called := link.get("name")) and called.data != name else ""


def _block_name(joint: str, names: list[str]) -> str:
    name = f"slider {joint}"
    while name in names:
        name += "'"
    return name
