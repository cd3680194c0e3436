"""Every class II reference linkage, against 50 digits: relative to the largest value of each quantity in the cycle."""

from __future__ import annotations

import numpy as np
import pytest
from models import DATA, reference, reference_problem, results_of

NAMES = sorted(path.stem for path in (DATA / "reference").glob("*.json"))
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


@pytest.fixture(scope="module", params=NAMES)
def case(request):
    data = reference(request.param)
    return data["model"], data["reference"], results_of(reference_problem(data))


def test_every_point_and_centre_of_mass_moves_as_the_reference(case):
    model, rows, results = case
    for key in rows[0]["points"]:
        body, point = key.split(".")
        if point == f"S{body}":
            found = results.motion.centre(body)
        else:
            found = results.motion.point(body, complex(*model["bodies"][body]["points"][point]))
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
    _, rows, results = case
    for name, first in rows[0]["reactions"].items():
        found = results.reactions.of(name)
        assert {found.on, found.by} == {first["on"], first["by"]}
        assert deviation(found.onto(first["on"]), series(rows, "reactions", name, "F")) < TOLERANCE, name
        if "couple" in first:
            couple = found.couple if found.on == first["on"] else -found.couple
            assert deviation(couple, series(rows, "reactions", name, "couple")) < TOLERANCE, name


def test_the_balancing_moment_is_the_reference_by_plan_and_by_lever(case):
    _, rows, results = case
    expected = series(rows, "balancing")
    assert deviation(results.reactions.balance.moment, expected) < TOLERANCE
    assert deviation(results.lever.balancing, expected) < TOLERANCE
    assert np.max(results.lever.difference) < 1e-10


def test_a_position_alone_is_that_position_of_the_cycle_in_any_order(case):
    model, rows, results = case
    problem = reference_problem({"model": model, "reference": rows})
    alone = results_of(problem, positions=[7])
    backward = results_of(problem, positions=list(range(len(rows)))[::-1])
    for link in model["bodies"]:
        for other, k in ((alone, 0), (backward, len(rows) - 8)):
            for one, many in zip(_state(other, link), _state(results, link), strict=True):
                assert abs(one[k] - many[7]) <= 1e-15 * np.max(np.abs(many)), link
    for reaction in results.reactions.all:
        many = reaction.force
        for other, k in ((alone, 0), (backward, len(rows) - 8)):
            one = other.reactions.of(reaction.pair.name).force
            assert abs(one[k] - many[7]) <= 1e-15 * np.max(np.abs(many)), reaction.pair.name


def _state(results, link):
    centre, turning = results.motion.centre(link), results.motion.link(link)
    return centre.x, centre.v, centre.a, turning.omega, turning.epsilon
