"""What a refused guidance of a coupler is told, typed in as printed, is solved, and a little less far it is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest
from test_synthesis_limits import guided, refused, solved

from tmm_cli.problem.errors import ProblemError
from tmm_cli.synthesis import coupler_positions, nearest_positions
from tmm_cli.synthesis.burmester_search import Effort

LESS = 1e-4  # relative, to a value or to how far it is from what was given
PARTS = ("x", "y", "angle")


def number(printed):
    return float(printed.split()[0])


def nearer(printed, given):
    """A printed value a little nearer to what was given."""
    value, unit = number(printed), printed.split()[1]
    step = min(LESS * max(abs(value), abs(value - given)), abs(value - given))
    return f"{float(value - np.sign(value - given) * step)!r} {unit}"


def plainly_refused(block):
    """Refused, without a search for what to tell."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(coupler_positions, "told", lambda asked, error, solves: error)
        error = refused(block)
    assert re.search("defect|no link|no pivot|no room|links of sensible length", error.message), error
    return error


def task(positions, **keys):
    return {"task": "coupler-positions", "positions": positions, **keys}


def with_position(block, which, part, value):
    positions = [list(pose) for pose in block["positions"]]
    positions[which][PARTS.index(part)] = value
    return block | {"positions": positions}


POSITIONS = {
    "a coordinate": task([[0, 0, 0], [52, -19, 27], [75, 20, 40], [142, 29, 59]], AB_turn=31, DC_turn=25),
    "an angle": task([[0, 0, 0], [36, 57, 23], [85, 47, 32], [138, 88, 56]], AB_turn=32, DC_turn=6),
    "no link of that turn": task([[0, 0, 0], [63, 0, 8], [98, 18, 34], [157, 40, 54]], AB_turn=10, DC_turn=27),
}


@pytest.mark.parametrize("case", POSITIONS)
def test_four_positions_without_a_sound_pair_of_links_are_told_the_nearest_position_with_one(case):
    block = POSITIONS[case]
    told = refused(block).allowed
    match = re.search(r"position (\d): (x|y|angle) (\S+ (?:mm|deg))(?:;|$)", told)
    assert match, told
    which, part = int(match[1]) - 1, match[2]
    given = float(block["positions"][which][PARTS.index(part)])
    solved(with_position(block, which, part, match[3]))
    plainly_refused(with_position(block, which, part, nearer(match[3], given)))


def test_a_task_that_is_solved_without_the_turns_is_told_so():
    block = task([[0, 0, 0], [34, 17, 22], [64, 13, 39], [87, 75, 49]], AB_turn=-56, DC_turn=-36)
    assert refused(block).allowed == "without AB_turn, DC_turn"
    solved({key: value for key, value in block.items() if not key.endswith("turn")})


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


def test_a_box_is_told_grown_by_the_least_that_helps():
    block = task(
        [[0, 0, 0], [60, 40, 15], [110, 100, 35], [130, 170, 60]], AB_turn=10, pivots_within=[[210, 290], [250, 240]]
    )  # fmt: skip
    told = refused(block).allowed
    match = re.search(r"^\[\[(\S+ mm), (\S+ mm)\], \[(\S+ mm), (\S+ mm)\]\].* moved outwards by (\S+) mm", told)
    assert match, told
    box, given = [[match[1], match[2]], [match[3], match[4]]], block["pivots_within"]
    for printed, at, way in zip(box[0] + box[1], given[0] + given[1], (-1, 1, 1, -1), strict=True):
        assert number(printed) == pytest.approx(at + way * float(match[5]), rel=1e-5)
    solved(block | {"pivots_within": box})
    less = [[nearer(*pair) for pair in zip(*rows, strict=True)] for rows in zip(box, given, strict=True)]
    plainly_refused(block | {"pivots_within": less})


@pytest.mark.parametrize(("count", "seed"), [(3, 0), (3, 3), (2, 12)])
def test_a_point_that_is_told_is_the_nearest_in_its_direction(count, seed):
    block = guided(np.random.default_rng([seed, count, 7]), count)
    match = re.search(r"^([BC]) \[(\S+ mm), (\S+ mm)\]", refused(block).allowed)
    solved(block | {match[1]: [match[2], match[3]]})
    less = [nearer(printed, given) for printed, given in zip(match.groups()[1:], block[match[1]], strict=True)]
    plainly_refused(block | {match[1]: less})


@pytest.mark.parametrize(("positions", "turns"), [
    ([[0, 0, 0], [21, 23, 22], [67, 44, 35], [96, 50, 47]], {"AB_turn": -59, "DC_turn": -11}),
    ([[0, 0, 0], [67, 8, 11], [90, 39, 19], [111, 82, 31]], {"AB_turn": -2, "DC_turn": 56}),
    ([[0, 0, 0], [39, 19, 27], [77, 14, 37], [114, 22, 48]], {"AB_turn": -33, "DC_turn": -7}),
])  # fmt: skip
def test_of_turns_that_are_told_for_both_links_none_can_be_nearer(positions, turns):
    block = task(positions, **turns)
    match = re.search(
        r"AB_turn (\S+ deg) with AB_branch: (.) and DC_turn (\S+ deg) with DC_branch: (.)", refused(block).allowed
    )
    told = dict(zip(("AB_turn", "AB_branch", "DC_turn", "DC_branch"), match.groups(), strict=True))
    solved(block | told)
    for key, given in turns.items():
        plainly_refused(block | told | {key: nearer(told[key], given)})


@pytest.mark.parametrize(("turn", "free"), [({"AB_turn": 14}, True), ({"AB_turn": 14, "DC_turn": -20}, False)])
def test_the_nearest_turn_of_one_link_is_told_whether_the_other_is_free_or_given(turn, free):
    block = task([[0, 0, 0], [27, 36, 25], [48, 85, 48], [101, 94, 65]], **turn)
    words = r"^(AB_turn|DC_turn) (\S+ deg) \((\S+ deg) for a least transmission angle of (\d+) deg\); or defects"
    match = re.search(words, refused(block).allowed)
    solved(block | {match[1]: match[2]})
    found = solved(block | {match[1]: match[3]}).found
    least = next(float(v.value) for v in found if v.words.endswith(".transmission"))
    assert np.degrees(least) > int(match[4]) >= 1
    plainly_refused(block | {match[1]: nearer(match[2], turn[match[1]])})


def test_a_link_of_a_turn_near_that_of_the_coupler_is_told_the_turn_with_which_it_is_not_too_long():
    block = task([[0, 0, 0], [60, 40, 15], [110, 100, 35], [130, 170, 60]], AB_turn=15.01, defects="keep")
    printed = refused(block).allowed
    solved(block | {"AB_turn": printed})
    with pytest.raises(ProblemError, match="grow beyond all bounds"):
        solved(block | {"AB_turn": nearer(printed, 15.01)})


def test_a_point_whose_places_lie_on_a_line_is_told_the_nearest_place_with_a_link_of_fifty_sizes():
    block = task([[0, 0, 0], [50, 0, 15], [100, 0, 35]], B=[0, 0], C=[50, 10])
    match = re.search(r"^B \[(\S+ mm), (\S+ mm)\], whose link reaches 50 times the size", refused(block).allowed)
    length = float(solved(block | {"B": [match[1], match[2]]}).parameters["l1"].value)
    assert length == pytest.approx(50 * 0.1, rel=0.02)
    less = [nearer(printed, 0) for printed in match.groups()]
    assert float(solved(block | {"B": less}).parameters["l1"].value) > length


def test_a_limit_is_followed_beyond_where_a_short_search_loses_it(monkeypatch):
    short = Effort(1, 1)
    monkeypatch.setattr(nearest_positions, "QUICK", short)
    monkeypatch.setattr(nearest_positions, "soluble", lambda at, *efforts: at > (0.5 if short in efforts else 0.3))
    assert nearest_positions.limit(lambda at: at, 1.0, 0.0, 0.01) == pytest.approx(0.3, abs=0.011)


def test_where_no_coordinate_alone_helps_a_whole_position_is_told():
    positions = [[0, 0, 0], [25, 29, 23], [52, 8, 28], [34, 19, 21]]
    match = re.search(r"^position 4: \[(\S+ mm), (\S+ mm), (\S+ deg)\]", refused(task(positions)).allowed)
    solved(task([*positions[:3], list(match.groups())]))


@pytest.mark.parametrize("block", [
    task([[0, 0, 0], [4.2, 44.3, -21.2]], A=[2.6, -61.5], C=[2.6, -61.5], AB=132.2, DC=159.8),
    task([[0, 0, 0], [56.6, -71.9, 27.8]], A=[15.3, 7.1], C=[15.3, 7.1], AB=138.5, DC=43.7859),
])  # fmt: skip
def test_a_kite_passes_the_line_of_the_frame_dead_whatever_rounding_says(block):
    """Pin C lies on pivot A in position 1, whatever the length of AB: BC is folded on AB, and CD on AD."""
    told = refused(block).allowed
    match = re.match(r"(?:another )?(\w+),?(?: as)? (.+?)[;,] (?:or|for|with)", told)
    value = match[2].strip("[]").split(", ")
    solved(block | {match[1]: value if "[" in match[2] else value[0]})


def test_two_positions_turned_about_one_place_have_a_size_from_what_is_given():
    """Both places are the origin of the coupler: its task is as large as its pivots and links."""
    block = task([[0, 0, 0], [0, 0, 31.39]], A=[-55.01, 75.65], D=[66.12, -56.5], AB=26.6, DC=24.7)
    match = re.match(r"D \[(\S+ mm), (\S+ mm)\]", refused(block).allowed)
    solved(block | {"D": list(match.groups())})
