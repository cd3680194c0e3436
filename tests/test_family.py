"""A file's linkage with parameters put in anew is the linkage that the file builds for them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from test_commands import ROOT

from tmm_cli.batch import (
    DriverSamples,
    NotTraceableError,
    SequentialVariants,
    TracedNumber,
    TracedVariants,
    Variant,
    prepare_batch,
    read_all,
    trace_function,
)
from tmm_cli.mechanics.linkage import Request
from tmm_cli.problem import (
    PhysicalValue,
    UnitSystem,
    ValueReader,
    VariedUnits,
    build_from_shape,
    evaluate_quantity,
    read_file,
    resolve_parameters,
    schema,
)


def maker(name, given):
    """The linkage of a file of the bank for other values of some parameters, and their values in the file."""
    tree = read_file(str(ROOT / "problems" / f"{name}.yaml"))
    shape = schema.File.model_validate(tree.data)
    known = resolve_parameters(shape.parameters, UnitSystem(shape.units))
    rest = {key: value for key, value in shape.parameters.items() if key not in given}

    def make(numbers):
        units = UnitSystem(shape.units)
        units = VariedUnits(units) if any(isinstance(x, TracedNumber) for x in numbers) else units
        varied = {key: PhysicalValue(x, known[key].dimension) for key, x in zip(given, numbers, strict=True)}
        values = ValueReader(varied | resolve_parameters(rest, units, varied), units)
        linkage = build_from_shape(shape, tree, values).linkage
        always = tuple(replace(load, when="always") for load in linkage.loads if load.table is None)
        linkage = replace(linkage, loads=always)
        return Variant(linkage, Request(start=linkage.sketch.at))

    return make, [known[key].value for key in given]


BANK = {
    "crank-rocker": ["l1", "l2", "l3", "l4"],
    "shaper": 3,
    "six-bar": 4,
    "crank-slider-offset": 3,
    "slotted-lever": 2,
    "course-2": 3,
}


@pytest.mark.parametrize("name", BANK)
def test_a_family_is_what_the_file_builds_for_the_same_numbers(name):
    tree = read_file(str(ROOT / "problems" / f"{name}.yaml"))
    given = BANK[name] if isinstance(BANK[name], list) else list(tree.data["parameters"])[: BANK[name]]
    make, first = maker(name, given)
    columns = np.array(first) * (1 + 0.02 * np.random.default_rng(1).uniform(-1, 1, (5, len(first))))
    q = np.linspace(0.1, 6.1, 12)
    found = TracedVariants(make, first, read_all, forces=True)(columns, DriverSamples(np.zeros(0), q))
    known = prepare_batch([make(row).linkage for row in columns], read_all)
    expected, sound = known(q), known.sound(q)["moving"]
    linkage = make(first).linkage
    if linkage.driver.acceleration:
        sound = sound & (q > linkage.sketch.at)  # before it starts there is no motion
    for key in expected:
        size = np.max(np.abs(expected[key][sound])) or 1.0
        assert np.max(np.abs((found[key] - expected[key])[sound])) < 1e-11 * size, key


ARITHMETIC = (
    "asin(a/b) + acos(a/b) + atan(a/b)",
    "sqrt(a^2 + b^2) - hypot(a, b)/2",
    "min(a, b, 2*a) + max(b, 3*a)",
    "a*tan(0.3)",
    "a^3/b^2",
    "atan2(a, b) - 30 deg",
    "abs(a - b)",
    "b*sin(60 deg) - a*cos(atan(a/b))",
    "(a/b)^-1",
)


@pytest.mark.parametrize("text", ARITHMETIC)
def test_arithmetic_of_a_file_on_numbers_that_vary(text):
    units = UnitSystem()
    a, b = np.array([[0.02], [0.06]]), np.array([[0.09], [0.07]])

    def value(x, y, own):
        length = units_of("1 mm")
        return evaluate_quantity(text, {"a": PhysicalValue(x, length), "b": PhysicalValue(y, length)}, own).value

    def units_of(sample):
        return evaluate_quantity(sample, {}, units).dimension

    found = trace_function(
        lambda x, y: {"y": value(TracedNumber(0.02, x), TracedNumber(0.09, y), VariedUnits(units)).placeholder}, 1, 1
    )(a, b)["y"]
    assert found[:, 0] == pytest.approx([value(x, y, units) for x, y in zip(a[:, 0], b[:, 0], strict=True)], rel=1e-13)


def test_groups_with_passive_constraints_are_not_on_the_tape_of_variants():
    name = "crossed-slots"
    make, first = maker(name, list(read_file(str(ROOT / f"problems/{name}.yaml")).data["parameters"])[:1])
    with pytest.raises(NotTraceableError):
        TracedVariants(make, first, read_all)


def test_groups_followed_beside_their_neighbours_are_those_followed_alone():
    make, first = maker("press-class-iii", ["OA", "CE", "FE"])
    columns = np.array(first) * (1 + 0.2 * np.random.default_rng(2).uniform(-1, 1, (3, 3)))
    q = np.linspace(0.1, 6.1, 12)
    found = SequentialVariants(make, first, read_all)(columns, DriverSamples(np.zeros(0), q))
    for k, row in enumerate(columns):
        linkage = make(row).linkage
        batch = replace(prepare_batch(linkage, read_all, forces=False), program=None)
        for key, alone in batch(q).items():
            assert np.allclose(found[key][k], alone, rtol=0, atol=1e-12 * np.nanmax(np.abs(alone)), equal_nan=True)
