"""pylinkage: JSON of `mechanism_to_json` (pylinkage 0.8 and later, pylinkage/mechanism/serialization.py)."""

from __future__ import annotations

import cmath
import math

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats.imported_mechanism import FRAME, Body, Drive, Foreign, Node, Slide
from tmm_cli.problem.reader import read_text

JOINTS = ("ground", "revolute", "prismatic", "tracker")
LINKS = ("ground", "driver", "arc_driver", "link")


def recognised(text: str) -> bool:
    """Whether the text is of this format."""
    return text.lstrip().startswith("{") and '"joints"' in text and '"links"' in text


def read(text: str, file: str) -> Foreign:
    """The mechanism of a file. Raises ProblemError."""
    top = Node(tree := read_text(text, file), tree.data)
    joints: dict[str, Node] = {}
    for joint in top["joints"].items():
        if joints.setdefault(joint["id"].text(), joint) is not joint:
            raise joint["id"].refused(_("a name is given twice"))
    links = top["links"].items()
    frame = _frame(joints, links)
    places = {name: _place(joint) for name, joint in joints.items()}
    kinds = {name: _kind(joint) for name, joint in joints.items()}
    bodies: list[Body] = []
    drive, left = None, []
    notes = [_("Lengths have no unit in pylinkage: they are taken for millimetres.")]
    for link in links:
        kind, name = link["type"].one_of(LINKS), link["id"].text()
        if name in (body.name for body in bodies):
            raise link["id"].refused(_("a name is given twice"))
        if kind == "ground":
            continue
        own = [one.one_of(joints) for one in link["joints"].items()]
        followed = [j for j in joints if kinds[j] == "tracker" and _refs(joints[j]) <= set(own)]
        own += [j for j in followed if j not in own]
        bodies.append(Body(name, tuple(own), _label(link, name)))
        if kind != "link":
            if drive is not None:
                raise link.refused(_("one driving link is wanted"))
            rate = speed.number() if (speed := link.get("angular_velocity")) else math.tau / 360
            drive = Drive(name, rate)
            notes.append(_("The angular velocity of pylinkage, rad per unit of time, is taken for rad/s."))
            if kind == "arc_driver":
                left.append(
                    _("Link {link} is driven to and fro over an arc there; here it goes its whole way.").format(
                        link=name
                    )
                )
    if drive is None:
        raise ProblemError(_("no link is driven"), allowed="type: driver", file=file)
    slides = []
    for name, kind in kinds.items():
        if kind == "prismatic":
            joint, stone = joints[name], _stone(name, [body.name for body in bodies])
            axis = vector.vector() if (vector := joint.get("axis")) else 1 + 0j
            if not axis:
                raise joint["axis"].refused(_("a direction is wanted"))
            through = at.vector() if (at := joint.get("line_point")) else 0j
            bodies.append(Body(stone, (name,)))
            slides.append(Slide(stone, name, FRAME, through, cmath.phase(axis)))
            notes.append(
                _("Joint {joint} runs on a line of the frame: slider {link} is put there.").format(
                    joint=name, link=stone
                )
            )
        if kind == "tracker" and not any(name in body.points for body in bodies):
            left.append(_("Point {point} follows two joints that are not on one link.").format(point=name))
    used = {point for body in bodies for point in body.points}
    left += [
        _("Joint {joint} is on no moving link.").format(joint=j)
        for j in joints
        if j not in used and kinds[j] != "tracker"
    ]
    title = named.text() if (named := top.get("name")) and named.data else ""
    return Foreign(
        "pylinkage",
        title,
        "mm",
        {j: z for j, z in places.items() if j in used},
        tuple(j for j in frame if j in used),
        tuple(bodies),
        drive,
        tuple(slides),
        notes=tuple(dict.fromkeys(notes)),
        left=tuple(left),
    )


def _frame(joints: dict[str, Node], links: list[Node]) -> tuple[str, ...]:
    """Joints of the frame: those called so, of its link, and those that a driver turns about."""
    found = [name for name, joint in joints.items() if _kind(joint) == "ground"]
    for link in links:
        if link["type"].data == "ground":
            found += [one.one_of(joints) for one in link["joints"].items()]
        if motor := link.get("motor_joint"):
            found.append(motor.one_of(joints))
    return tuple(dict.fromkeys(found))


def _kind(joint: Node) -> str:
    given = joint.get("type")
    return given.one_of(JOINTS) if given else "revolute"


def _place(joint: Node) -> complex:
    if joint["position"].data == [None, None]:
        raise joint["position"].refused(_("the mechanism was saved before it was assembled"), _("places of all joints"))
    return joint["position"].vector()


def _refs(joint: Node) -> set[str]:
    return {joint[key].text() for key in ("ref_joint1_id", "ref_joint2_id")}


def _label(link: Node, name: str) -> str:
    return called.text() if (called := link.get("name")) and called.data != name else ""


def _stone(joint: str, names: list[str]) -> str:
    found = f"slider {joint}"
    while found in names:
        found += "'"
    return found
