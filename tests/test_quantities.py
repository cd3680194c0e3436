"""Every quantity stands once: tables, result.json, its schema, bounds of rounding and `prepare` read the same list."""

import json

import numpy as np
import pytest
from bank import solved
from models import PROBLEMS

from tmm_cli import load, prepare, solve
from tmm_cli.drawing.sheets import detailed_drawings, draw_lever, draw_motion_plans
from tmm_cli.mechanics.accuracy import list_values
from tmm_cli.mechanics.quantities import (
    BALANCE,
    BALANCING,
    ENERGY,
    LINK,
    LOAD,
    POINT,
    REACTION,
    SLIDE,
    quantity_columns,
)
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import assess_accuracy, schema, tables, terminal_cells, to_json

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
    return solved("shaper")


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
    without_dampers = {q.name for q in ENERGY if not q.goes_with}
    assert without_dampers <= set(to_json(shaper)["energy"])


def test_a_table_has_the_headers_of_its_quantities(shaper):
    shown = {table.name: [column.header for column in table.columns] for table in tables(shaper)}
    for name, listed in (("points", POINT), ("link-motion", LINK), ("slides", SLIDE), ("reactions", REACTION)):
        headers = [header for quantity in listed for header in quantity.headers]
        assert shown[name][-len(headers) :] == headers


def test_a_vector_has_its_components_and_its_size_in_a_table(shaper):
    found = {header: values for header, values, __ in quantity_columns(POINT, shaper.motion.named("E"))}
    v = shaper.motion.named("E").v
    np.testing.assert_array_equal([found["vx"], found["vy"], found["v"]], [v.real, v.imag, np.abs(v)])


def test_bounds_and_prepare_read_the_same_values(shaper):
    bounded, batch = list_values(shaper), prepare(load(str(PROBLEMS / "shaper.yaml")))(shaper.motion.q)
    for quantity in (q for q in (*POINT, REACTION[0], BALANCING) if q.leading):
        for kind, name, component in (key for key in bounded if key[0] == quantity.name):
            value = np.asarray(batch[f"{quantity.symbol}.{name}" if quantity.symbol else f"{name}.{kind}"])
            part = {"x": value.real, "y": value.imag, "": value}[component]
            np.testing.assert_allclose(part, bounded[kind, name, component], rtol=0, atol=1e-9 * np.max(np.abs(value)))


BALANCED = """tmm: 1
gravity: 0
points: {O: [0, 0]}
guides: {x: {through: [0, 0], angle: 0}, y: {through: [0, 0], angle: 90}}
links:
  1: {points: [O, A], length: 60}
  2: {points: [A, B], length: 200}
  3: {points: [B], slides: {on: x}}
  4: {points: [A, K], length: 100}
  5: {points: [K], slides: {on: y}}
driver: {link: 1, speed: 10 rad/s}
sketch: {at: 30, B: [250, 0], K: [0, 120]}
loads:
  F: {on: 3, force: [-1000.3, 0]}
  F1: {on: 3, force: [300.2, 0]}
  F2: {on: 3, force: [700.1, 0]}
  Q: {on: 5, force: [0, -500]}
"""


def test_a_force_that_is_zero_but_for_rounding_has_neither_direction_nor_arm():
    """Three forces that balance each other leave the rod AB and its slider without any; the rod AK bears Q."""
    results = solve(build_problem(read_text(BALANCED, "balanced.yaml")))
    reactions, table = to_json(results)["forces"]["reactions"], {t.name: t for t in tables(results)}["reactions"]
    assert 0 < max(np.abs(results.reactions.of("B").force)) < 1e-12
    for pair in ("B", "x"):
        assert reactions[pair]["angle"] == [None] * 12
    assert reactions["x"]["arm"] == [None] * 12
    np.testing.assert_allclose(reactions["K"]["angle"][1:3], np.angle(results.reactions.of("K").force[1:3]), rtol=0)
    (told,) = assess_accuracy(results).with_bounds([table])
    angles = next(column for column in told.columns if column.header == "angle")
    shown = dict(
        zip(told.columns[2].values, terminal_cells(angles, results.problem.units, range(told.rows)), strict=True)
    )
    assert shown["B"] == shown["x"] == "-" and float(shown["K"])


def test_units_are_written_one_way_in_tables_and_the_schema_and_one_way_on_drawings(shaper):
    """As they are typed, and as they are printed."""
    told = [column.heading(shaper.problem.units) for table in tables(shaper) for column in table.columns]
    described = json.dumps(schema(), ensure_ascii=False)
    position = detailed_drawings(shaper)[0]
    notes = [text for draw in (draw_motion_plans, draw_lever) for __, sheet in draw(position) for text in sheet.texts()]
    assert "a, m/s^2" in told and "m/s^2" in described and any(note.endswith("(m/s²)/mm") for note in notes)
    assert any(note.endswith(" N·m") for note in notes)
    for other in ("m/s2", "m/s²", "N·m", "N m"):
        assert not [text for text in (*told, described) if other in text], other
    for other in ("m/s2", "m/s^2", "N*m", "N m"):
        assert not [text for text in notes if other in text], other
