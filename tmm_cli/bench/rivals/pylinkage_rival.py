"""Computation by pylinkage.

It computes only the kinematics of linkages that consist of a crank and RRR and RRP groups. Each position is found from
the one before.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from pylinkage.actuators import Crank
from pylinkage.components import Ground
from pylinkage.dyads import RRPDyad, RRRDyad
from pylinkage.simulation import Linkage
from pylinkage.solver import linkage_to_solver_data, simulate_with_kinematics

from tmm_cli.bench.methods.case import Case, Method, MethodAnswers, UnsupportedLinkageError
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, unit
from tmm_cli.mechanics.structure import Group, Pair


def prepare_pylinkage(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the computation of a case by pylinkage at equally spaced driver coordinates.

    Raises:
        MethodUnable: pylinkage cannot compute this linkage.
    """
    simulated, names = _build_simulation(case)
    own = [(k, name) for k, name in enumerate(names) if name in case.linkage.moving_points]

    def at(q: Real) -> MethodAnswers:
        x, v, a = ({name: part[:, k, 0] + 1j * part[:, k, 1] for k, name in own} for part in simulated(q))
        return MethodAnswers(x, v, a)

    return at


def prepare_pylinkage_alone(case: Case) -> Callable[[Real], object]:
    """Prepare pylinkage's own computation without conversion of its results.

    Raises:
        MethodUnable: pylinkage cannot compute this linkage.
    """
    return _build_simulation(case)[0]


def _build_simulation(case: Case) -> tuple[Callable[[Real], tuple[Any, Any, Any]], list[str]]:
    """Build the pylinkage model of a case.

    Its fastest documented solver is used: compiled by numba, called directly with arrays that are prepared once.

    Returns:
        Function of equally spaced driver coordinates, which returns arrays of positions, velocities and accelerations
        (positions, joints, 2); and the names of the joints.
    """
    driver = case.linkage.driver
    if driver.kind != "turn" or case.linkage.others:
        raise UnsupportedLinkageError("the driver must be a single crank")
    start = compute_motion(case.linkage, case.kernels, np.array([case.start]), case.law)
    coordinates = {point: complex(start.named(point).x[0]) for point in case.linkage.moving_points}
    parts: dict[str, Any] = {}
    for point, place in case.linkage.links[FRAME].points.items():
        parts[point] = Ground(place.real, place.imag, name=point)
    arm = case.linkage.links[driver.link].points
    ends = [point for point in arm if point != driver.joint]
    if len(ends) != 1:
        raise UnsupportedLinkageError("the crank must have one end point")
    radius = abs(arm[ends[0]] - arm[driver.joint])
    crank = parts[ends[0]] = Crank(parts[driver.joint], radius, 0.0, case.start, name=ends[0])
    guides: list[Any] = []
    for group in case.structure.groups:
        _add_group(group, case, parts, guides, coordinates)
    linkage = Linkage([*parts.values(), *guides])
    names = [component.name for component in linkage.components]
    joints: dict[tuple[float, float], tuple[Any, tuple[Any, ...]]] = {}

    def arrays(first: float, step: float) -> tuple[Any, tuple[Any, ...]]:
        """Return the joint coordinates one step before the first position, and the other arguments of the solver."""
        before = compute_motion(case.linkage, case.kernels, np.array([first - step]), case.law)
        for name in set(case.linkage.moving_points) & set(parts):
            at = complex(before.named(name).x[0])
            parts[name].x, parts[name].y = at.real, at.imag
        crank.angular_velocity = step
        data = linkage_to_solver_data(linkage)
        return data.positions, (
            np.zeros((len(names), 2)),
            np.zeros((len(names), 2)),
            data.constraints,
            data.joint_types,
            data.parent_indices,
            data.constraint_offsets,
            data.solve_order,
            np.array([case.law.sense * case.law.rate]),
            np.zeros(1),
            np.array([names.index(crank.name)], np.int32),
        )

    def at(q: Real) -> tuple[Any, Any, Any]:
        key = (float(q[0]), float(q[1] - q[0]) if len(q) > 1 else 0.0)
        if key not in joints:
            joints[key] = arrays(*key)
        positions, rest = joints[key]
        found: tuple[Any, Any, Any] = simulate_with_kinematics(positions.copy(), *rest, len(q), 1.0)
        return found

    return at, names


def _add_group(
    group: Group, case: Case, parts: dict[str, Any], guides: list[Any], points: Mapping[str, complex]
) -> None:
    """Add the internal hinge of a group to the pylinkage model."""
    local = case.linkage.local
    if group.type not in ("RRR", "RRP"):
        raise UnsupportedLinkageError(
            f"the program does not support group {group.title} of type {group.type or 'of class III'}"
        )
    point = group.inner[0].point
    x, y = points[point].real, points[point].imag

    def reach(pair: Pair) -> tuple[Any, float]:
        own = pair.i if pair.i in group.links else pair.j
        if pair.point not in parts:
            raise UnsupportedLinkageError(f"{group.title} depends on a point that is not an earlier joint")
        return parts[pair.point], float(abs(local(own, pair.point) - local(own, point)))

    turning = [pair for pair in group.outer if pair.kind == "R"]
    if group.type == "RRR":
        (one, r), (other, s) = (reach(pair) for pair in turning)
        parts[point] = RRRDyad(one, other, r, s, x, y, name=point)
        return
    slide = next(pair.slide for pair in group.outer if pair.slide is not None)
    if slide.carrier != FRAME or slide.at != local(slide.runner, point):
        raise UnsupportedLinkageError("guides must pass through hinges")
    one, r = reach(turning[0])
    line = [slide.through, slide.through + unit(slide.direction)]
    ends = [Ground(p.real, p.imag, name=f"guide {slide.name} {k}") for k, p in enumerate(line)]
    guides += ends
    parts[point] = RRPDyad(one, *ends, r, x, y, name=point)


METHOD = Method("pylinkage", "pylinkage", prepare_pylinkage, alone=prepare_pylinkage_alone)
