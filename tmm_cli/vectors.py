"""Planar vectors as complex numbers: x + iy, metres; turning is multiplying."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Real = NDArray[Any]  # float arrays of any precision; positions on the last axis
Vector = NDArray[Any]  # complex arrays, likewise


ROUNDING = 16  # units of the last place that a construction of a few steps may lose
PI = "3.14159265358979323846264338327950288"


def pi(values: Any) -> Any:
    """Pi in the precision of an array."""
    return np.finfo(getattr(values, "dtype", float)).dtype.type(PI)


def dot(a: Any, b: Any) -> Any:
    """Scalar product a.b."""
    return a.real * b.real + a.imag * b.imag


def cross(a: Any, b: Any) -> Any:
    """z component of a x b: positive when b lies to the left of a."""
    return a.real * b.imag - a.imag * b.real


def square(a: Any) -> Any:
    """The square of its length."""
    return a.real * a.real + a.imag * a.imag


def along(a: Any, amount: Any) -> Any:
    """The vector a scaled by a real amount (no complex product, so no spurious rounding)."""
    return a * amount


def unit(angle: Any) -> Any:
    """e^(i angle)."""
    return np.cos(angle) + 1j * np.sin(angle)


def settled(values: Any, size: Any) -> Any:
    """Numbers or vectors computed from others of a size; parts that are zero within the rounding of these are 0."""
    values = np.asarray(values)
    least = ROUNDING * np.finfo(values.dtype).eps * size
    if not np.iscomplexobj(values):
        return np.where(np.abs(values) > least, values, values.dtype.type(0))[()]
    return (settled(values.real, size) + 1j * settled(values.imag, size))[()]


def left(a: Any) -> Any:
    """a turned through +90 degrees."""
    return 1j * a
