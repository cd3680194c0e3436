"""Files changed at random are solved or refused: a slice of what `python tests/fuzz.py` does."""

from __future__ import annotations

import json
from random import Random

import numpy as np
from fuzz import cases, fuzz
from fuzz_blocks import BLOCKS, Parts
from models import PROBLEMS
from test_commands import tmm

from tmm_cli.mechanics.groups import GroupState
from tmm_cli.problem import ProblemError, build_problem, read_text


def test_no_file_ends_in_anything_but_a_problem_or_the_products_own_error() -> None:
    counts = {"load": 90, "solve": 10, "run": 1, "grade": 1}
    ended, faults = fuzz(seed=14, counts=counts)
    assert faults == {}
    assert all(ended[kind] == count for kind, count in counts.items())
    assert ended["solve: solved"] and ended["load: loaded"] and ended["load: refused"]


def test_a_case_is_the_same_in_every_run() -> None:
    for kind in ("load", "run"):
        first, second = cases(kind, 3), cases(kind, 3)
        assert [next(first) for _ in range(5)] == [next(second) for _ in range(5)]


def test_every_kind_of_block_fits_some_problem() -> None:
    """A block that no file accepts would try nothing."""
    trees = [read_text((PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8"), name) for name in ("shaper", "six-bar")]
    for block in BLOCKS:
        fitting = 0
        for seed in range(40):
            data = dict(trees[seed % 2].data)
            try:
                build_problem(read_text(str(data | block(Parts(Random(seed), data))), "block.yaml"))
                fitting += 1
            except ProblemError:
                pass
        assert fitting > 4, block.__name__


# what a long run of the fuzzer found


def changed_bank_file(tmp_path, name, *edits):
    """A file of the bank with other texts in it."""
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")
    for before, after in edits:
        assert before in text, before
        text = text.replace(before, after, 1)
    file = tmp_path / "changed.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_cam_at_rest_has_a_note_and_a_ratio_to_its_speed_has_no_value(tmp_path):
    file = changed_bank_file(tmp_path, "cam-lever", ("driver: {link: 1, speed: n1}", "driver: {link: 1, speed: 0}"))
    assert tmm("note", file, "-o", tmp_path).returncode == 0
    done = tmm("kinematics", file, "--json")
    ratio = json.loads(done.stdout)["properties"][0]
    assert (done.returncode, ratio["value"]) == (1, None)  # it is not what is expected


def test_a_balancing_force_in_the_pivot_of_the_crank_is_refused(tmp_path):
    file = changed_bank_file(tmp_path, "crank-slider", ("turns: ccw}", "balance: force, end: O}"))
    done = tmm("forces", file)
    assert done.returncode == 2
    assert ("driver.end: a balancing force applied at the pivot O has no moment arm\n  found:   'O'\n") in done.stderr
    assert "  allowed: another point of the link" in done.stderr


def test_a_sweep_of_links_that_hold_one_another_is_refused_in_the_words_of_the_file(tmp_path):
    file = changed_bank_file(
        tmp_path,
        "crank-slider",
        ("points: {O: [0, 0]}", "points: {O: [0, 0], C: [300, 90]}"),
        ("driver:", "  4: {points: [C, B], length: 100}\ndriver:"),
    )
    done = tmm("sweep", file, "--over", "l=200..240:3")
    assert done.returncode == 2
    assert (
        "driver.link: link 1 cannot be a driver: pairs or other drivers already determine its motion"
    ) in done.stderr


def test_no_states_of_a_group_are_moved_by_no_step():
    none = GroupState(np.zeros((0, 4), complex), np.zeros((0, 4))).moved(np.zeros((0, 12)), 1.0)
    assert none.x.shape == none.unwrapped.shape == (0, 4)
