"""Places, velocities and accelerations of points, links and sliding pairs."""

from __future__ import annotations

from functools import partial
from itertools import permutations
from typing import Any

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity, Solved
from tmm_cli.analysis.selection import mass_centres, named_points
from tmm_cli.kinematics.output import output_run
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    LENGTH,
    SPEED,
    place_dimension,
)
from tmm_cli.structure.assur import Structure


def motion(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """x, y, v, a of points and centres of mass; phi, omega, epsilon of links; v, a and Coriolis in sliding pairs."""
    found: dict[str, Quantity] = {}

    def put(quantity: Quantity) -> None:
        found[quantity.name] = quantity

    for point, place in {**named_points(linkage), **mass_centres(linkage)}.items():
        put(Quantity(f"x of {point}", "places", LENGTH, partial(_coordinate, point, place, "real"), against="range",
                     thing=point))  # fmt: skip
        put(Quantity(f"y of {point}", "places", LENGTH, partial(_coordinate, point, place, "imag"), against="range",
                     thing=point))  # fmt: skip
        put(Quantity(f"v of {point}", "velocities", SPEED, partial(_point, point, place, "v"), True, thing=point))
        put(Quantity(f"a of {point}", "accelerations", ACCELERATION, partial(_point, point, place, "a"), True,
                     thing=point))  # fmt: skip
    for link in linkage.moving:
        put(Quantity(f"phi of {link}", "places", ANGLE, partial(_link, link, "angle"), against="angle", thing=link))
        put(Quantity(f"omega of {link}", "velocities", ANGULAR_SPEED, partial(_link, link, "omega"), thing=link))
        put(Quantity(f"epsilon of {link}", "accelerations", ANGULAR_ACCELERATION, partial(_link, link, "epsilon"),
                     thing=link))  # fmt: skip
        if linkage.slides_on_frame(link) or linkage.hinged_to_frame(link):
            slides = linkage.slides_on_frame(link)
            put(Quantity(f"s of {link}", "places", place_dimension("slide" if slides else "turn"),
                         partial(_run, link), against="range" if slides else "angle", thing=link))  # fmt: skip
    for slide in linkage.slides:
        name = f"{slide.runner} on {slide.carrier}"
        put(Quantity(f"v of {name}", "velocities", SPEED, partial(_slide, slide.name, "v"), thing=slide.runner))
        put(Quantity(f"a of {name}", "accelerations", ACCELERATION, partial(_slide, slide.name, "a"),
                     thing=slide.runner))  # fmt: skip
        put(Quantity(f"Coriolis of {name}", "accelerations", ACCELERATION, partial(_slide, slide.name, "coriolis"),
                     True, thing=slide.runner))  # fmt: skip
    return found


def relative_angles(linkage: Linkage) -> dict[str, Quantity]:
    """`phi of 5 on 4`: rotation of a link relative to another one that moves and is hinged to it, rad."""
    found = {}
    for hinge in linkage.hinges:
        for link, base in permutations([name for name in hinge.links if name != FRAME], 2):
            name = f"phi of {link} on {base}"
            read = partial(_relative_angle, link, base)
            found[name] = Quantity(name, "places", ANGLE, read, against="angle", thing=link)
    return found


def _relative_angle(link: str, base: str, solution: Solved) -> Any:
    return solution.motion.link(link).angle - solution.motion.link(base).angle


def _point(point: str, place: tuple[str, complex], part: str, solution: Solved) -> Any:
    link = place[0]
    motion = solution.motion
    if point in motion.linkage.links[link].points:
        return getattr(motion.named(point), part)
    return getattr(motion.centre(link), part)


def _coordinate(point: str, place: tuple[str, complex], part: str, solution: Solved) -> Any:
    return getattr(_point(point, place, "x", solution), part)


def _link(link: str, part: str, solution: Solved) -> Any:
    return getattr(solution.motion.link(link), part)


def _run(link: str, solution: Solved) -> Any:
    return output_run(solution.motion, link)[0]


def _slide(name: str, part: str, solution: Solved) -> Any:
    return np.asarray(getattr(solution.motion.slide(solution.motion.linkage.slide(name)), part))
