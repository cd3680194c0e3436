"""The same linkage with another driver: its Assur groups are others then."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.assembly.choose import assemble
from tmm_cli.errors import LinkageError, NotOnFrameError
from tmm_cli.groups.sequence import link_states
from tmm_cli.linkage import FRAME, Driver, Linkage, Sketch
from tmm_cli.structure.assur import analyse


def redriven(linkage: Linkage, link: str) -> Linkage:
    """Driven by a link on the frame instead of the first driver, in the assembly of the sketch.

    Where the linkage cannot be assembled with its own driver the new one's place in the sketch is not known; the
    structure does not need it. Raises NotOnFrameError.
    """
    pivots = [h.point for h in linkage.hinges if FRAME in h.links and link in h.links]
    runs = [s.name for s in linkage.slides if {s.carrier, s.runner} == {FRAME, link}]
    if link == FRAME or not (pivots or runs):
        on_frame = [n for n in linkage.moving if linkage.hinged_to_frame(n) or linkage.slides_on_frame(n)]
        raise NotOnFrameError(link, tuple(on_frame))
    driver = Driver(link, "turn" if pivots else "slide", (pivots or runs)[0], linkage.driver.rate)
    return replace(linkage, driver=driver, sketch=_sketch(linkage, driver))


def _sketch(linkage: Linkage, driver: Driver) -> Sketch:
    try:
        kernels = assemble(linkage, analyse(linkage))
    except LinkageError:
        return linkage.sketch
    motion = link_states(linkage, kernels, np.array([linkage.sketch.at]), 0)
    points = {
        point: complex(motion.spot(point)[0]) for n in linkage.moving for point in linkage.links[n].points
        if point not in linkage.links[FRAME].points
    }  # fmt: skip
    angles = {name: float(np.angle(motion.poses[name].z)[0]) for name in linkage.moving}
    if driver.kind == "slide":
        return Sketch(float(motion.run(linkage.slide(driver.joint))[0]), points, angles)
    return Sketch(angles[driver.link], points, angles)
