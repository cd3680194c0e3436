"""Every quantity stands once: tables, result.json, its schema, bounds of rounding and `prepare` read the same list."""

from pathlib import Path

import numpy as np
import pytest

from tmm_cli import load, prepare, solve
from tmm_cli.accuracy.digits import quantities
from tmm_cli.quantities import BALANCE, BALANCING, ENERGY, LINK, LOAD, POINT, REACTION, SLIDE, columns
from tmm_cli.results.as_json import schema, to_json
from tmm_cli.results.reports import tables

PROBLEMS = Path(__file__).parent.parent / "problems"
THINGS = {  # where the things of a kind stand in result.json, and what may be left out there
    "kinematics.points": (POINT, set()),
    "kinematics.centres": (POINT, set()),
    "kinematics.links": (LINK, set()),
    "kinematics.slides": (SLIDE, set()),
    "forces.reactions": (REACTION, {q.name for q in REACTION if q.goes_with}),
    "forces.drivers": (BALANCE, set()),
}


@pytest.fixture(scope="module")
def shaper():
    return solve(load(str(PROBLEMS / "shaper.yaml")))


@pytest.mark.parametrize("place", THINGS)
def test_result_json_has_every_quantity_of_every_thing_and_the_schema_says_its_unit(shaper, place):
    listed, may_be_left_out = THINGS[place]
    part, things = place.split(".")
    described = schema()["properties"][part]["properties"][things]["additionalProperties"]["properties"]
    for name, thing in to_json(shaper)[part][things].items():
        assert {q.name for q in listed} - may_be_left_out <= set(thing), name
    for quantity in listed:
        assert quantity.unit in described[quantity.name]["description"]
    assert {q.name for q in LOAD} <= set(to_json(shaper)["forces"]["loads"][0])
    assert {q.name for q in ENERGY} <= set(to_json(shaper)["energy"])


def test_a_table_has_the_headers_of_its_quantities(shaper):
    shown = {table.name: [column.header for column in table.columns] for table in tables(shaper)}
    for name, listed in (("points", POINT), ("link-motion", LINK), ("slides", SLIDE), ("reactions", REACTION)):
        headers = [header for quantity in listed for header in quantity.headers]
        assert shown[name][-len(headers) :] == headers


def test_a_vector_has_its_components_and_its_size_in_a_table(shaper):
    found = {header: values for header, values, __ in columns(POINT, shaper.motion.named("E"))}
    v = shaper.motion.named("E").v
    np.testing.assert_array_equal([found["vx"], found["vy"], found["v"]], [v.real, v.imag, np.abs(v)])


def test_bounds_and_prepare_read_the_same_values(shaper):
    bounded, batch = quantities(shaper), prepare(load(str(PROBLEMS / "shaper.yaml")))(shaper.motion.q)
    for quantity in (q for q in (*POINT, REACTION[0], BALANCING) if q.leading):
        for kind, name, component in (key for key in bounded if key[0] == quantity.name):
            value = np.asarray(batch[f"{quantity.symbol}.{name}" if quantity.symbol else f"{name}.{kind}"])
            part = {"x": value.real, "y": value.imag, "": value}[component]
            np.testing.assert_allclose(part, bounded[kind, name, component], rtol=0, atol=1e-9 * np.max(np.abs(value)))
