"""Every reference linkage, against 50 digits: relative to the largest value of each quantity in the cycle."""

from __future__ import annotations

import numpy as np
import pytest
from models import DATA, reference, reference_problem, results_of

# positions 1 to 5 of this one belong to another assembly than position 0: each is solved from a sketch of its own
CLASS_III = "stephenson3_class_three_group"
NAMES = [name for name in sorted(path.stem for path in (DATA / "reference").glob("*.json")) if name != CLASS_III]
ROWS = [f"{CLASS_III} {k}" for k in range(6)]
TOLERANCE = 1e-12


def deviation(found, expected):
    """The largest error over the cycle, against the largest expected value (itself where that is exactly nothing)."""
    largest = np.max(np.abs(expected))
    return np.max(np.abs(found - expected)) / (largest if largest > 1e-30 else 1.0)


def series(rows, *keys):
    """Numbers of one quantity over all positions; pairs of numbers are complex."""
    values = []
    for row in rows:
        for key in keys:
            row = row[key]
        values.append(complex(float(row[0]), float(row[1])) if isinstance(row, list) else float(row))
    return np.array(values)


@pytest.fixture(scope="module", params=[*NAMES, *ROWS])
def case(request):
    name, _, row = request.param.partition(" ")
    data = reference(name)
    return (
        solved_row(data, int(row)) if row else (data["model"], data["reference"], results_of(reference_problem(data)))
    )


def solved_row(data, k):
    """One position alone, sketched as the reference found it."""
    model, row = data["model"], data["reference"][k]
    problem = reference_problem({"model": model, "reference": [row]})
    problem["sketch"] = {"at": float(row["input"])}
    for key, motion in row["points"].items():
        body, point = key.split(".")
        if point != f"S{body}" and point not in model["ground"]:
            problem["sketch"][point] = [float(v) for v in motion["x"]]
    return model, [row], results_of(problem)


def named(results, name, joint):
    """A pair of the reference by its name there (a sliding pair on a link is named for its point here)."""
    return results.reactions.of(name if name in {p.name for p in results.structure.pairs} else f"{joint['pj']}'")


def test_every_point_and_centre_of_mass_moves_as_the_reference(case):
    _, rows, results = case
    for key in rows[0]["points"]:
        body, point = key.split(".")
        found = results.motion.centre(body) if point == f"S{body}" else results.motion.named(point)
        for quantity in "xva":
            assert deviation(getattr(found, quantity), series(rows, "points", key, quantity)) < TOLERANCE, (
                key,
                quantity,
            )


def test_every_link_turns_as_the_reference(case):
    _, rows, results = case
    for name in rows[0]["links"]:
        found = results.motion.link(name)
        angle = series(rows, "links", name, "angle")
        assert np.max(np.abs(np.angle(np.exp(1j * (found.angle - angle))))) < TOLERANCE, name
        assert deviation(found.omega, series(rows, "links", name, "omega")) < TOLERANCE, name
        assert deviation(found.epsilon, series(rows, "links", name, "eps")) < TOLERANCE, name


def test_every_reaction_is_that_of_the_lagrange_multipliers(case):
    model, rows, results = case
    joints = {joint["name"]: joint for joint in model["joints"]}
    for name, first in rows[0]["reactions"].items():
        found = named(results, name, joints[name])
        assert {found.on, found.by} == {first["on"], first["by"]}
        assert deviation(found.onto(first["on"]), series(rows, "reactions", name, "F")) < TOLERANCE, name
        if "couple" in first:
            couple = found.couple if found.on == first["on"] else -found.couple
            assert deviation(couple, series(rows, "reactions", name, "couple")) < TOLERANCE, name


def test_the_balancing_moment_is_the_reference_by_plan_and_by_lever(case):
    _, rows, results = case
    expected = series(rows, "balancing")
    assert deviation(results.reactions.balance.generalized, expected) < TOLERANCE
    assert deviation(results.lever.balancing, expected) < TOLERANCE
    assert np.max(results.lever.difference) < 1e-10


def test_the_class_iii_reference_starts_next_to_a_dead_position():
    """2.0e-5 rad from where its driver turns back: doubles for its data alone change omega by 3.3e-12 (in 50 digits).

    It is met all the same, because such positions are computed from the decimals of the file in extended precision.
    """
    _, (row,), results = solved_row(reference(CLASS_III), 0)
    assert 2.0e-5 < results.driver_range.end - float(row["input"]) < 2.1e-5
    assert results.motion.finer is not None


@pytest.mark.parametrize("name", NAMES)
def test_a_position_alone_is_that_position_of_the_cycle_in_any_order(name):
    data = reference(name)
    model, rows, results = data["model"], data["reference"], results_of(reference_problem(data))
    chosen = min(7, len(rows) - 1)
    problem = reference_problem({"model": model, "reference": rows})
    alone = results_of(problem, positions=[chosen])
    backward = results_of(problem, positions=list(range(len(rows)))[::-1])
    for link in model["bodies"]:
        for other, k in ((alone, 0), (backward, len(rows) - 1 - chosen)):
            for one, many in zip(_state(other, link), _state(results, link), strict=True):
                assert abs(one[k] - many[chosen]) <= 1e-15 * np.max(np.abs(many)), link
    for reaction in results.reactions.all:
        many = reaction.force
        for other, k in ((alone, 0), (backward, len(rows) - 1 - chosen)):
            one = other.reactions.of(reaction.pair.name).force
            assert abs(one[k] - many[chosen]) <= 1e-15 * np.max(np.abs(many)), reaction.pair.name


def _state(results, link):
    centre, turning = results.motion.centre(link), results.motion.link(link)
    return centre.x, centre.v, centre.a, turning.omega, turning.epsilon
