"""What the stages lean on: one search for roots, one map over records, registers that know all that a file may ask."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from tmm_cli import load
from tmm_cli.mechanics.groups import CLOSED_FORM_SOLVERS
from tmm_cli.mechanics.numerics import bisect, find_roots, map_record, record_leaves
from tmm_cli.mechanics.structure import analyse_structure


@pytest.mark.parametrize("kind", [np.float64, np.longdouble])
def test_roots_are_found_to_the_last_bit_of_their_own_precision(kind):
    low, high = np.array([1, 0.5], kind), np.array([2, 3], kind)
    found = find_roots(lambda x: x * x - 2, low, high)
    assert found.dtype == kind
    assert np.all(np.abs(found - np.sqrt(kind(2))) <= np.finfo(kind).eps)


def test_bisection_ends_with_neighbours_of_which_the_condition_holds_at_one():
    limits = np.array([0.3, 0.7])
    inside, outside = bisect(lambda x: x < limits, np.zeros(2), np.ones(2))
    assert np.all((inside < limits) & (outside >= limits))
    assert np.all(outside - inside <= np.spacing(outside))


@dataclass(frozen=True)
class Part:
    sizes: tuple[Any, ...]
    named: dict[str, Any] = field(default_factory=dict)
    kept: Any = 0.0


def test_a_map_over_records_meets_every_leaf_at_its_path():
    record = Part((1.0, Part((2.0,))), {"a": 3.0}, 4.0)
    assert dict(record_leaves(record)) == {
        "sizes[0]": 1.0,
        "sizes[1].sizes[0]": 2.0,
        "sizes[1].kept": 0.0,
        "named.a": 3.0,
        "kept": 4.0,
    }
    assert map_record(lambda path, value: value + 1, record, skip=("kept",)) == Part(
        (2.0, Part((3.0,))), {"a": 4.0}, 4.0
    )
    sums = map_record(lambda path, one, other: one + other, record, record)
    assert dict(record_leaves(sums)) == {path: 2 * value for path, value in record_leaves(record)}


@pytest.mark.parametrize("name", ["shaper", "cylinder", "excavator", "press-class-iii"])
def test_a_group_is_of_one_closed_type_at_most(name):
    for group in analyse_structure(load(f"problems/{name}.yaml").linkage).groups:
        assert sum(kind.fits(group) for kind in CLOSED_FORM_SOLVERS) <= 1
