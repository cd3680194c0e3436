"""Files changed at random are solved or refused: a slice of what `python tests/fuzz.py` does."""

from __future__ import annotations

from random import Random

from fuzz import cases, fuzz
from fuzz_blocks import BLOCKS, Parts
from models import PROBLEMS

from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text


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
                build(read_text(str(data | block(Parts(Random(seed), data))), "block.yaml"))
                fitting += 1
            except ProblemError:
                pass
        assert fitting > 4, block.__name__
