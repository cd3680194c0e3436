"""Limits of velocities and accelerations in dead positions that the mechanism passes smoothly.

In a change point of a parallelogram two branches of its motion cross. The equations for velocities are singular there,
but along each branch the motion is an analytic function of the driver coordinate, so its value, velocity and
acceleration in the change point follow by interpolation from positions on either side. L. N. Trefethen, Approximation
Theory and Approximation Practice (2013), ch. 5. Reactions in general grow without bound.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.groups.sequence import LinkStates, link_states
from tmm_cli.kinematics.motion import Motion
from tmm_cli.tolerances import LIMIT_AGREES, LIMIT_ROUNDED
from tmm_cli.vectors import Real, mapped

NODES = 16  # on both sides of a change point; an even number, so that none lies in it
RADII = (0.1, 0.05)  # rad, and of a slider this share of the largest group: how far the outer nodes are
STATES = ("poses", "first", "second")
SIZES = ("x", "z", "unwrapped", "v", "w", "a", "e")  # of poses, rates and accelerations: what is compared alike
PLACES: Real = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
WEIGHTS: Real = chebyshev.chebvander(np.zeros(1), NODES - 1)[0] @ np.linalg.inv(chebyshev.chebvander(PLACES, NODES - 1))
"""Values at the nodes to the value in the middle between them."""


def with_limits(motion: Motion) -> Motion:
    """Put the limits of positions, velocities and accelerations into change points that are passed smoothly.

    `moving` stays False in these positions, as forces have no limit there in general; the mask `limits` says which they
    are, and `bare` is the motion without them.
    """
    if motion.order < 2 or not motion.dead:
        return motion
    dead = np.any(list(motion.dead.values()), axis=0) & ~motion.moving & np.isfinite(motion.rate)
    if not np.any(dead):
        return motion
    places = np.flatnonzero(dead)
    limits, smooth = _limits(motion, np.asarray(motion.q, dtype=float)[places])
    if not np.any(smooth):
        return motion
    filled = places[smooth]

    def put(_path: str, values: Any, limit: Any) -> Any:
        if not isinstance(values, np.ndarray):
            return values
        found, own = values.copy(), limit[smooth]
        known = np.abs(values[..., filled] - own) <= LIMIT_ROUNDED * np.maximum(np.abs(own), 1.0)
        found[..., filled] = np.where(known, values[..., filled], own)  # a place that is known needs no interpolation
        return found

    parts = {name: mapped(put, getattr(motion, name), getattr(limits, name)) for name in STATES}
    mask = np.zeros(np.shape(motion.q), dtype=bool)
    mask[filled] = True
    return replace(motion, **parts, limits=mask, bare=motion)


def _limits(motion: Motion, q: Real) -> tuple[LinkStates, Real]:
    """States of links in the middle of nodes about places q, and which of these are passed smoothly."""
    size = float(np.max([np.max(kernel.size) for kernel in motion.kernels], initial=0.0)) or 1.0
    unit = 1.0 if motion.linkage.driver.kind == "turn" else size
    smooth = np.ones(len(q), dtype=bool)
    found = []
    for radius in RADII:
        nodes = q[:, None] + radius * unit * PLACES
        states = link_states(motion.linkage, motion.kernels, nodes.ravel(), 2)
        smooth &= np.all(states.moving.reshape(nodes.shape), axis=1)

        def middle(_path: str, values: Any, shape: tuple[int, ...] = nodes.shape) -> Any:
            if not isinstance(values, np.ndarray):
                return values
            return np.broadcast_to(values, shape[0] * shape[1]).reshape(shape) @ WEIGHTS

        with np.errstate(invalid="ignore"):
            states = replace(states, **{name: mapped(middle, getattr(states, name)) for name in STATES})
        found.append(states)
    far, near = found
    return far, smooth & _agree(far, near, size)


def _agree(one: LinkStates, other: LinkStates, size: float) -> Real:
    """Whether two states of all links are the same at each place; size: of the mechanism (m)."""
    gaps: dict[str, Any] = dict.fromkeys(SIZES, 0.0)
    largest: dict[str, Any] = dict.fromkeys(SIZES, 0.0)

    def compare(path: str, values: Any, beside: Any) -> Any:
        if isinstance(values, np.ndarray):
            kind = path.rpartition(".")[2]
            gaps[kind] = np.maximum(gaps[kind], np.abs(values - beside))
            largest[kind] = np.maximum(largest[kind], np.abs(values))
        return values

    for name in STATES:
        mapped(compare, getattr(one, name), getattr(other, name))
    speed = np.maximum(largest["v"], largest["w"] * size)
    gain = np.maximum(np.maximum(largest["a"], largest["e"] * size), speed**2 / size)
    scales = {
        "x": np.maximum(largest["x"], size), "z": 1.0, "unwrapped": np.maximum(largest["unwrapped"], 1.0),
        "v": speed, "w": speed / size, "a": gain, "e": gain / size,
    }  # fmt: skip
    with np.errstate(invalid="ignore"):
        agree: Real = np.all(
            [np.broadcast_to(gaps[k] <= LIMIT_AGREES * scales[k], np.shape(speed)) for k in SIZES], axis=0
        )
    return agree
