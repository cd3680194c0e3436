"""Export of mechanisms to other programs: a function for each format, registered in EXPORTS.

The format pylinkage is JSON for its `mechanism_from_json`: lengths in mm, the mechanism in the position of the sketch.
"""

from __future__ import annotations

import cmath
import json
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, results_at
from tmm_cli.mechanics.linkage import FRAME, Linkage, Slide
from tmm_cli.problem import ProblemError


def export_pylinkage(results: Results) -> tuple[str, list[str]]:
    """Export a mechanism to pylinkage.

    Returns:
        JSON text, and a list of the input data that the format cannot contain (masses and loads).

    Raises:
        ProblemError: pylinkage does not support such a mechanism.
    """
    linkage = results.linkage
    _refuse_unsupported(linkage)
    motion = results_at(results, np.array([linkage.sketch.at])).motion
    assert motion is not None

    def place(point: str) -> list[float]:
        return _coordinates(complex(motion.named(point).x[0]))

    frame = linkage.links[FRAME].points
    slides = {slide.runner: slide for slide in linkage.slides}
    links = [name for name in linkage.moving if name not in slides]
    points = list(dict.fromkeys([*frame, *(point for name in links for point in linkage.links[name].points)]))
    on_line = {slide.point: slide for slide in slides.values()}
    joints = [_joint(point, place(point), point in frame, on_line.get(point)) for point in points]
    driver = linkage.driver
    pivot = linkage.shared(FRAME, driver.link)
    exported_links: list[dict[str, Any]] = [{"id": "ground", "type": "ground", "joints": list(frame)}]
    for name in links:
        link: dict[str, Any] = {"id": name, "type": "link", "joints": list(linkage.links[name].points)}
        if name == driver.link:
            link |= {
                "type": "driver",
                "angular_velocity": driver.sense * driver.rate,
                "initial_angle": float(linkage.sketch.at),
                "motor_joint": pivot,
            }
        exported_links.append(link)
    data = {"name": results.problem.title, "joints": joints, "links": exported_links, "ground": "ground"}
    omitted = [_("masses and loads")] if linkage.acting or any(np.any(x.mass) for x in linkage.links.values()) else []
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n", omitted


def _coordinates(z: complex) -> list[float]:
    return [1000 * component + 0.0 for component in (float(z.real), float(z.imag))]


def _refuse_unsupported(linkage: Linkage) -> None:
    reason = None
    if linkage.driver.kind != "turn" or linkage.driver.base != FRAME or linkage.others:
        reason = _("pylinkage supports a single driver only: a crank on the frame")
    elif linkage.meshes:
        reason = _("pylinkage does not support gears and cams")
    elif any(slide.carrier != FRAME or len(linkage.links[slide.runner].points) > 1 for slide in linkage.slides):
        reason = _("pylinkage supports only sliders with one hinge on a straight guide of the frame")
    if reason:
        raise ProblemError(reason)


def _joint(point: str, place: list[float], fixed: bool, slide: Slide | None) -> dict[str, Any]:
    joint: dict[str, Any] = {"id": point, "type": "ground" if fixed else "revolute", "position": place}
    if slide is not None:
        along = cmath.rect(1, float(slide.direction))
        joint |= {
            "type": "prismatic",
            "axis": [along.real, along.imag],
            "line_point": _coordinates(slide.through),
            "slide_distance": 0.0,
        }
    return joint


# Files that other programs read: a format is a function in a file here and an entry below.


EXPORTS: Final[dict[str, Callable[[Results], tuple[str, list[str]]]]] = {
    "pylinkage": export_pylinkage
}  # text, what is left
