"""pylinkage: kinematics of linkages made of a crank and of RRR and RRP groups, step by step from one position on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tmm_cli.accuracy.case import Answers, Case, Method, Unable
from tmm_cli.linkage import FRAME
from tmm_cli.motion import move
from tmm_cli.structure.assur import Group, Pair
from tmm_cli.vectors import Real, unit


def prepare(case: Case) -> Callable[[Real], Answers]:
    """Its fastest route, `step_fast_with_kinematics`, for places q at equal steps. Raises Unable."""
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.simulation import Linkage

    driver = case.linkage.driver
    if driver.kind != "turn" or case.linkage.others:
        raise Unable("a crank is the only driver")
    start = move(case.linkage, case.kernels, np.array([case.start]), case.law)
    places = {point: complex(start.named(point).x[0]) for point in case.points}
    parts: dict[str, Any] = {}
    for point, place in case.linkage.links[FRAME].points.items():
        parts[point] = Ground(place.real, place.imag, name=point)
    arm = case.linkage.links[driver.link].points
    ends = [point for point in arm if point != driver.joint]
    if len(ends) != 1:
        raise Unable("a crank has one end")
    radius = abs(arm[ends[0]] - arm[driver.joint])
    crank = parts[ends[0]] = Crank(parts[driver.joint], radius, 0.0, case.start, name=ends[0])
    extra: list[Any] = []
    for group in case.structure.groups:
        _add(group, case, parts, extra, places)
    linkage = Linkage([*parts.values(), *extra])
    names = [component.name for component in linkage.components]
    linkage.set_input_velocity(crank, omega=case.law.sense * case.law.rate)
    before: dict[tuple[float, float], dict[str, complex]] = {}

    def at(q: Real) -> Answers:
        step = float(q[1] - q[0]) if len(q) > 1 else 0.0
        key = (float(q[0]), step)
        if key not in before:  # where it starts from, one step earlier
            motion = move(case.linkage, case.kernels, q[:1] - step, case.law)
            before[key] = {point: complex(motion.named(point).x[0]) for point in case.points}
        for name, was in before[key].items():
            if name in parts:
                parts[name].x, parts[name].y = was.real, was.imag
        crank.angular_velocity = step
        linkage.compile()
        x, v, a = linkage.step_fast_with_kinematics(len(q))
        own = [(k, name) for k, name in enumerate(names) if name in case.points]
        one, two, three = ({name: p[:, k, 0] + 1j * p[:, k, 1] for k, name in own} for p in (x, v, a))
        return Answers(one, two, three)

    return at


def _add(group: Group, case: Case, parts: dict[str, Any], extra: list[Any], places: Mapping[str, complex]) -> None:
    """The inner hinge of a group."""
    from pylinkage.components import Ground
    from pylinkage.dyads import RRPDyad, RRRDyad

    local = case.linkage.local
    if group.type not in ("RRR", "RRP"):
        raise Unable(f"it has no group {group.title} of type {group.type or 'of class III'}")
    point = group.inner[0].point
    x, y = places[point].real, places[point].imag

    def reach(pair: Pair) -> tuple[Any, float]:
        own = pair.i if pair.i in group.links else pair.j
        if pair.point not in parts:
            raise Unable(f"{group.title} hangs on a point that is not a joint before")
        return parts[pair.point], float(abs(local(own, pair.point) - local(own, point)))

    turning = [pair for pair in group.outer if pair.kind == "R"]
    if group.type == "RRR":
        (one, r), (other, s) = (reach(pair) for pair in turning)
        parts[point] = RRRDyad(one, other, r, s, x, y, name=point)
        return
    slide = next(pair.slide for pair in group.outer if pair.slide is not None)
    if slide.carrier != FRAME or slide.at != local(slide.runner, point):
        raise Unable("it knows guides through hinges only")
    one, r = reach(turning[0])
    guide = [slide.through, slide.through + unit(slide.direction)]
    ends = [Ground(p.real, p.imag, name=f"guide {slide.name} {k}") for k, p in enumerate(guide)]
    extra += ends
    parts[point] = RRPDyad(one, *ends, r, x, y, name=point)


METHOD = Method("pylinkage", "pylinkage", prepare)
