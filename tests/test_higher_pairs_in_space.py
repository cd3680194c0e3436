"""Gears, racks and cams counted in space: teeth that touch in a line have four freedoms, crowned teeth five."""

from __future__ import annotations

import blocks
import pytest
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.mechanics.structure import count_in_space
from tmm_cli.problem import build_problem, read_text


def in_space(text):
    results = solve(build_problem(read_text(text, "x.yaml")), "structure")
    return count_in_space(results.linkage, results.structure)


@pytest.mark.parametrize("text, crowned", [(blocks.PLANET, "z"), (blocks.RACK, "k"), (blocks.CAM, "c")])
def test_a_line_of_contact_holds_once_more_what_two_shafts_hold_already(text, crowned):
    found = in_space(text)
    assert (found.chain.count, found.redundant) == ("6*2 - 5*2 - 2*1 = 0", 1)
    assert [(r.pair.name, r.kind) for r in found.replacements] == [(crowned, "sphere on plane")]
    assert (found.proposed.count, found.redundant_then) == ("6*2 - 5*2 - 1 = 1", 0)
    assert (found.rank.redundant, found.rank.free) == (0, 0)


def test_a_geared_five_bar_has_three_redundant_constraints_a_contour_and_one_of_its_teeth():
    found = in_space(blocks.GEARED)
    assert (found.chain.mobility, found.redundant, found.redundant_then) == (-3, 4, 0)


def test_two_drivers_want_two_freedoms():
    found = in_space(blocks.TWO)
    assert (found.wanted, found.chain.mobility, found.redundant, found.redundant_then) == (2, -1, 3, 0)


def test_every_block_goes_through_the_whole_run(tmp_path):
    for name, text in blocks.EVERYTHING.items():
        (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
    files = [tmp_path / f"{name}.yaml" for name in blocks.EVERYTHING]
    done = tmm("run", *files, "--no-drawings", "-o", tmp_path / "out")
    assert (done.returncode, "Traceback" in done.stderr) == (0, False), done.stderr
    for name in blocks.EVERYTHING:
        assert (tmp_path / "out" / name / "result.json").is_file()
    assert "3*4 - 2*5 - 1 = 1" in (tmp_path / "out" / "geared" / "structure.csv").read_text(encoding="utf-8")
