"""The number that is told for a refused guidance of a coupler, typed in, is solved; a little nearer it is not."""

from __future__ import annotations

import re

import numpy as np
import pytest
from test_synthesis_limits import guided, refused, solved

from tmm_cli.problem.errors import ProblemError

LESS = 1e-4  # relative, to a value or to how far it is from what was given
PARTS = ("x", "y", "angle")
NONE = "no single number, changed alone, helps"


def task(positions, **keys):
    return {"task": "coupler-positions", "positions": positions, **keys}


def place(told):
    """The way to the number of a block that is named, and the value that is told for it."""
    what = r"(?:position (?P<which>\d)|(?P<key>\w+))(?:: (?P<part>x|y|angle))?"
    match = re.match(rf"{what} (?P<value>\S+ (?:mm|deg))", told)
    part = () if match["part"] is None else (PARTS.index(match["part"]),)
    return (("positions", int(match["which"]) - 1) if match["which"] else (match["key"],)) + part, match["value"]


def put(block, path, value):
    """The block with a value at a place."""
    if not path:
        return value
    inner = block.copy()
    inner[path[0]] = put(block[path[0]], path[1:], value)
    return inner


def at(block, path):
    for step in path:
        block = block[step]
    return float(block)


def nearer(printed, given):
    """A printed value a little nearer to what was given."""
    number, unit = printed.split()
    value = float(number)
    step = min(LESS * max(abs(value), abs(value - given)), abs(value - given))
    return f"{float(value - np.sign(value - given) * step)!r} {unit}"


def limits(block):
    """The number that is told for a block is solved, and a little nearer to what was given it is refused."""
    path, value = place(refused(block).allowed)
    solved(put(block, path, value))
    refused(put(block, path, nearer(value, at(block, path))))
    return path


@pytest.mark.parametrize(("block", "key"), [
    (task([[0, 0, 0], [52, -19, 27], [75, 20, 40], [142, 29, 59]], AB_turn=31, DC_turn=25), "positions"),
    (task([[0, 0, 0], [36, 57, 23], [85, 47, 32], [138, 88, 56]], AB_turn=32, DC_turn=6), "positions"),
    (task([[0, 0, 0], [63, 0, 8], [98, 18, 34], [157, 40, 54]], AB_turn=10, DC_turn=27), "positions"),
    (task([[0, 0, 0], [27, 36, 25], [48, 85, 48], [101, 94, 65]], AB_turn=14, DC_turn=-20), "AB_turn"),
    (task([[0, 0, 0], [60, 40, 75]], B=[0, 0], AB=30, C=[50, 0], DC=60), "AB"),
    (task([[0, 0, 0], [50, 20, 10], [100, 10, 30]], A=[0, 60], D=[0, 60]), "D"),
])  # fmt: skip
def test_the_number_that_is_told_is_the_limit(block, key):
    assert limits(block)[0] == key


@pytest.mark.parametrize(("count", "seed"), [(3, 0), (3, 3), (3, 5), (2, 12), (2, 17)])
def test_a_number_of_a_link_is_told_for_two_and_three_positions(count, seed):
    r = np.random.default_rng([seed, count, 7])
    while True:
        block = guided(r, count)
        try:
            solved(block)
        except ProblemError:
            break
    limits(block)


@pytest.mark.parametrize(("block", "point"), [
    (task([[0, 0, 0], [100, 50, 40]], B=[0, 0], C=[0, 0], AB=200, DC=200), "C"),
    (task([[0, 0, 0], [100, 50, 40], [150, 120, 70]], A=[0, 0], D=[0, 0]), "D"),
    (task([[0, 0, 0], [0, 0, 40]], B=[0, 0], C=[100, 0], AB=20, DC=200), "B"),
])  # fmt: skip
def test_another_place_is_told_of_a_point_that_makes_no_four_bar(block, point):
    path, value = place(refused(block).allowed)
    assert path[0] == point
    solved(put(block, path, value))


def test_where_the_other_link_is_free_a_turn_is_told_with_which_there_is_one():
    block = task([[0, 0, 0], [27, 36, 25], [48, 85, 48], [101, 94, 65]], AB_turn=14)
    path, value = place(refused(block).allowed)
    assert path == ("AB_turn",)
    solved(block | {"AB_turn": value})


def test_where_no_single_number_helps_that_is_said():
    error = refused(task([[0, 0, 0], [34, 17, 22], [64, 13, 39], [87, 75, 49]], AB_turn=-56, DC_turn=-36))
    assert error.allowed == f"other positions or links; {NONE}"
    error = refused(task([[0, 0, 0], [0, 0, 31.39]], A=[-55.01, 75.65], D=[66.12, -56.5], AB=26.6, DC=24.7))
    assert error.allowed == f"defects: keep; {NONE}"


@pytest.mark.parametrize("count", [3, 4])
def test_where_the_coupler_only_turns_about_one_point_that_point_is_told(count):
    pole, turned = 30 + 40j, [0, 10, 30, 60][:count]
    places = [pole + (20 - pole) * np.exp(1j * np.radians(angle)) for angle in turned]
    block = task([[z.real, z.imag, angle] for z, angle in zip(places, turned, strict=True)])
    if count == 3:
        block |= {"B": [5, 8], "C": [60, -10]}
    error = refused(block)
    assert "only turns about one point" in error.message
    assert error.allowed.startswith("a hinge at [30 mm, 40 mm] in the place of a four-bar")


def test_a_link_of_a_turn_near_that_of_the_coupler_is_told_the_turn_with_which_it_is_not_too_long():
    block = task([[0, 0, 0], [60, 40, 15], [110, 100, 35], [130, 170, 60]], AB_turn=15.01, defects="keep")
    error = refused(block)
    assert re.match(r"AB of this turn is \S+ mm long.*grow beyond all bounds", error.message)
    solved(block | {"AB_turn": error.allowed.removeprefix("AB_turn ")})


def test_a_point_whose_places_lie_on_a_line_is_told_the_nearest_place_with_a_link_of_sensible_size():
    block = task([[0, 0, 0], [50, 0, 15], [100, 0, 35]], B=[0, 0], C=[50, 10])
    path, value = place(refused(block).allowed)
    length = float(solved(put(block, path, value)).parameters["l1"].value)
    assert path[0] == "B" and length == pytest.approx(100 * 0.1, rel=0.02)  # a hundred sizes of the task


@pytest.mark.parametrize("block", [
    task([[0, 0, 0], [4.2, 44.3, -21.2]], A=[2.6, -61.5], C=[2.6, -61.5], AB=132.2, DC=159.8),
    task([[0, 0, 0], [56.6, -71.9, 27.8]], A=[15.3, 7.1], C=[15.3, 7.1], AB=138.5, DC=43.7859),
])  # fmt: skip
def test_a_kite_passes_the_line_of_the_frame_dead_whatever_rounding_says(block):
    """Pin C lies on pivot A in position 1, whatever the length of AB: BC is folded on AB, and CD on AD."""
    path, value = place(refused(block).allowed)
    assert path[0] in "ABCD" and len(path) == 2
    solved(put(block, path, value))
