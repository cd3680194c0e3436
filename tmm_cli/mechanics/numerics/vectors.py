"""Planar vectors as complex numbers x + iy (m), rotated by multiplication; and nested records of arrays."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_cli.mechanics.numerics.double_double import EPS, PI, DoubleDouble
from tmm_cli.mechanics.numerics.tolerances import CONSTRUCTION_ROUNDINGS, NO_VECTOR

Real = NDArray[Any]  # float arrays of any precision; positions on the last axis
Vector = NDArray[Any]  # complex arrays of any precision; positions on the last axis
Record = TypeVar("Record")


def pi(values: Any) -> Any:
    """Return pi in the precision of an array (float64, longdouble or double-double)."""
    if isinstance(values, DoubleDouble):
        return DoubleDouble.decimal(PI)
    return np.finfo(getattr(values, "dtype", float)).dtype.type(PI)


def largest_magnitude(values: Any) -> float:
    """Return the largest absolute value, ignoring nan; zero for an empty array."""
    return float(np.nanmax(np.abs(values), initial=0.0))


def without_rounding(values: Any, beside: float) -> Real:
    """Replace values by zero if, compared with the magnitude `beside`, they are only rounding errors."""
    return np.where(np.abs(values) <= NO_VECTOR * beside, 0.0, values)


def roundoff(values: Any) -> float:
    """Return the unit roundoff of the number type of an array (2^-53 for float64)."""
    return EPS if isinstance(values, DoubleDouble) else float(np.finfo(values.real.dtype).eps) / 2


def dot(a: Any, b: Any) -> Any:
    """Return the scalar product of the vectors a and b."""
    return a.real * b.real + a.imag * b.imag


def cross(a: Any, b: Any) -> Any:
    """Return the z component of the vector product a x b: positive if b points to the left of a."""
    return a.real * b.imag - a.imag * b.real


def squared_length(a: Any) -> Any:
    """Return the squared length |a|^2 of a vector."""
    return a.real * a.real + a.imag * a.imag


def scaled(a: Any, amount: Any) -> Any:
    """Multiply the vector a by a real factor, without the rounding of a complex product."""
    return a * amount


def unit(angle: Any) -> Any:
    """Return the unit vector in the direction of an angle (rad), e^(i angle)."""
    return np.cos(angle) + 1j * np.sin(angle)


def zero_within_rounding(values: Any, size: Any) -> Any:
    """Replace numbers, or components of vectors, by zero if they may be only rounding errors.

    size: magnitude of the values from which they were computed.
    """
    values = values if isinstance(values, DoubleDouble) else np.asarray(values)
    if np.iscomplexobj(values):
        return (zero_within_rounding(values.real, size) + 1j * zero_within_rounding(values.imag, size))[()]
    return np.where(np.abs(values) > 2 * CONSTRUCTION_ROUNDINGS * roundoff(values) * size, values, 0.0)[()]


def rotated_left(a: Any) -> Any:
    """Return the vector a rotated by 90 degrees counterclockwise."""
    return 1j * a


def map_record(
    change: Callable[..., Any], record: Record, *others: Any, skip: Collection[str] = (), path: str = ""
) -> Record:
    """Return a copy of a nested record in which `change` has replaced each leaf.

    A record is a dataclass, mapping, tuple or list of records; anything else is a leaf. The path of a leaf reads
    links.2.points.A or loads[0].force.

    Args:
        change: called as change(path, leaf, *leaves of the other records at the same path); returns the new leaf.
        others: records of the same structure.
        skip: names of fields that are left unchanged.
        path: path of the record itself.
    """

    def at(name: str, child: Any, rest: Any) -> Any:
        return map_record(change, child, *rest, skip=skip, path=name)

    mapped: Any
    if is_dataclass(record) and not isinstance(record, type):
        names = [f.name for f in fields(record) if f.init and f.name not in skip]
        new = {n: at(f"{path}.{n}" if path else n, getattr(record, n), [getattr(o, n) for o in others]) for n in names}
        mapped = replace(record, **new)
    elif isinstance(record, Mapping):
        mapped = {key: at(f"{path}.{key}", child, [o[key] for o in others]) for key, child in record.items()}
    elif isinstance(record, tuple | list):
        rows = enumerate(zip(record, *others, strict=True))
        mapped = type(record)(at(f"{path}[{k}]", child, rest) for k, (child, *rest) in rows)
    else:
        mapped = change(path, record, *others)
    whole: Record = mapped
    return whole


def record_leaves(record: Any, skip: Collection[str] = (), path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of each leaf of a nested record; see `map_record`."""
    if is_dataclass(record) and not isinstance(record, type):
        for f in fields(record):
            if f.name not in skip:
                yield from record_leaves(getattr(record, f.name), skip, f"{path}.{f.name}" if path else f.name)
    elif isinstance(record, Mapping):
        for key, value in record.items():
            yield from record_leaves(value, skip, f"{path}.{key}")
    elif isinstance(record, tuple | list):
        for k, value in enumerate(record):
            yield from record_leaves(value, skip, f"{path}[{k}]")
    else:
        yield path, record
