"""A link held by two guides: where two straight lines of known links meet. Shared by PRP and RPP."""

from __future__ import annotations

import numpy as np

from tmm_cli.groups.state import Accel, Rate
from tmm_cli.tolerances import ROUNDINGS
from tmm_cli.vectors import Real, Vector, cross, dot, roundoff


def meet(P: Vector, u: Vector, Q: Vector, v: Vector) -> tuple[Vector, Real]:
    """The common point of the lines through P along u and through Q along v, and u x v (0 when parallel)."""
    det = cross(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        return P + u * (cross(Q - P, v) / det), det


def parallel(det: Real) -> tuple[Real, Real]:
    """Residual and slack of two guides: they are parallel within rounding, or not."""
    return -np.abs(det), np.full(np.shape(det), ROUNDINGS * roundoff(det))


def turned_apart(u: Vector, v: Vector, wu: Real, wv: Real) -> Real:
    """Rate of the residual -|u x v| when the two guides turn."""
    rate: Real = -np.sign(cross(u, v)) * (wv - wu) * dot(u, v)
    return rate


def slide_rate(v1: Vector, u1: Vector, v2: Vector, u2: Vector, det: Real) -> Vector:
    """Velocity of the common point when the two guides carry it with v1 and v2 and it runs along u1 and u2."""
    velocity: Vector = v1 + u1 * (cross(v2 - v1, u2) / det)
    return velocity


def slide_acceleration(point: Vector, vP: Vector, guide: tuple[Vector, Vector, Rate, Accel]) -> Vector:
    """Acceleration that a guide gives a point running on it, without the unknown part along the guide (Coriolis in)."""
    origin, u, rate, accel = guide
    arm = point - origin
    sliding = dot(u, vP - rate.at(arm))
    acceleration: Vector = accel.at(arm, rate.w) + 2j * rate.w * sliding * u
    return acceleration


def split(rest: Vector, u1: Vector, u2: Vector, det: Real) -> tuple[Vector, Vector]:
    """The two forces across u1 and across u2 that balance `rest`."""
    return 1j * u1 * (-dot(rest, u2) / det), 1j * u2 * (dot(rest, u1) / det)
