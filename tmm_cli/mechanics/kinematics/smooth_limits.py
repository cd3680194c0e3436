"""Limits of velocities and accelerations in dead positions that the mechanism passes smoothly.

In a change point of a parallelogram two branches of its motion cross. The equations for velocities are singular there,
but along each branch the motion is an analytic function of the driver coordinate. Its position, velocity and
acceleration in the change point therefore follow by interpolation from positions on either side. L. N. Trefethen,
Approximation Theory and Approximation Practice (2013), ch. 5. Reactions in general grow without bound there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.mechanics.groups import LinkStates, link_states
from tmm_cli.mechanics.kinematics.motion import Motion
from tmm_cli.mechanics.numerics import LIMIT_AGREES, LIMIT_ROUNDED, Real, map_record

NODES = 16  # about a change point; an even number, so that none coincides with it
RADII = (0.1, 0.05)  # rad, or for a slider sizes of the largest group: distance of the outer nodes
STATE_FIELDS = ("poses", "first", "second")
COMPARED_FIELDS = (
    "x",
    "z",
    "unwrapped",
    "v",
    "w",
    "a",
    "e",
)  # fields of poses, rates and accelerations that are compared
CHEBYSHEV_NODES: Real = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
WEIGHTS: Real = chebyshev.chebvander(np.zeros(1), NODES - 1)[0] @ np.linalg.inv(
    chebyshev.chebvander(CHEBYSHEV_NODES, NODES - 1)
)
"""Weights of the values at the nodes for the interpolated value in the middle."""


def fill_in_limits(motion: Motion) -> Motion:
    """Fill in limit values of positions, velocities and accelerations in change points that are passed smoothly.

    `moving` stays False in these positions, because forces in general have no limit there. In the result `limits` is
    the mask of these positions, and `bare` the motion without the limit values.
    """
    if motion.order < 2 or not motion.dead:
        return motion
    dead = np.any(list(motion.dead.values()), axis=0) & ~motion.moving & np.isfinite(motion.rate)
    if not np.any(dead):
        return motion
    dead_positions = np.flatnonzero(dead)
    limits, smooth = _interpolate_limits(motion, np.asarray(motion.q, dtype=float)[dead_positions])
    if not np.any(smooth):
        return motion
    filled = dead_positions[smooth]

    def put(_path: str, values: Any, limit: Any) -> Any:
        if not isinstance(values, np.ndarray):
            return values
        replaced, limit_values = values.copy(), limit[smooth]
        agrees = np.abs(values[..., filled] - limit_values) <= LIMIT_ROUNDED * np.maximum(np.abs(limit_values), 1.0)
        replaced[..., filled] = np.where(agrees, values[..., filled], limit_values)  # a known value is kept
        return replaced

    parts = {name: map_record(put, getattr(motion, name), getattr(limits, name)) for name in STATE_FIELDS}
    mask = np.zeros(np.shape(motion.q), dtype=bool)
    mask[filled] = True
    return replace(motion, **parts, limits=mask, bare=motion)


def _interpolate_limits(motion: Motion, q: Real) -> tuple[LinkStates, Real]:
    """Interpolate the states at driver coordinates q from positions on either side.

    Returns:
        The states, and True where the mechanism passes the position smoothly.
    """
    size = float(np.max([np.max(kernel.size) for kernel in motion.kernels], initial=0.0)) or 1.0
    unit = 1.0 if motion.linkage.driver.kind == "turn" else size
    smooth = np.ones(len(q), dtype=bool)
    interpolated = []
    for radius in RADII:
        nodes = q[:, None] + radius * unit * CHEBYSHEV_NODES
        states = link_states(motion.linkage, motion.kernels, nodes.ravel(), 2)
        smooth &= np.all(states.moving.reshape(nodes.shape), axis=1)

        def middle(_path: str, values: Any, shape: tuple[int, ...] = nodes.shape) -> Any:
            if not isinstance(values, np.ndarray):
                return values
            return np.broadcast_to(values, shape[0] * shape[1]).reshape(shape) @ WEIGHTS

        with np.errstate(invalid="ignore"):
            states = replace(states, **{name: map_record(middle, getattr(states, name)) for name in STATE_FIELDS})
        interpolated.append(states)
    far, near = interpolated
    return far, smooth & _limits_agree(far, near, size)


def _limits_agree(states: LinkStates, other_states: LinkStates, size: float) -> Real:
    """Return True where two states of all links agree within the tolerance. size: size of the mechanism (m)."""
    gaps: dict[str, Any] = dict.fromkeys(COMPARED_FIELDS, 0.0)
    largest: dict[str, Any] = dict.fromkeys(COMPARED_FIELDS, 0.0)

    def compare(path: str, values: Any, beside: Any) -> Any:
        if isinstance(values, np.ndarray):
            kind = path.rpartition(".")[2]
            gaps[kind] = np.maximum(gaps[kind], np.abs(values - beside))
            largest[kind] = np.maximum(largest[kind], np.abs(values))
        return values

    for name in STATE_FIELDS:
        map_record(compare, getattr(states, name), getattr(other_states, name))
    speed = np.maximum(largest["v"], largest["w"] * size)
    gain = np.maximum(np.maximum(largest["a"], largest["e"] * size), speed**2 / size)
    scales = {
        "x": np.maximum(largest["x"], size),
        "z": 1.0,
        "unwrapped": np.maximum(largest["unwrapped"], 1.0),
        "v": speed,
        "w": speed / size,
        "a": gain,
        "e": gain / size,
    }
    with np.errstate(invalid="ignore"):
        agree: Real = np.all(
            [np.broadcast_to(gaps[k] <= LIMIT_AGREES * scales[k], np.shape(speed)) for k in COMPARED_FIELDS], axis=0
        )
    return agree
