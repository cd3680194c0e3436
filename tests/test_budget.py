"""One budget of work: what would take longer than a minute, or more than a gigabyte, is refused before it starts."""

import pytest
from test_commands import ROOT, tmm

SHAPER = (ROOT / "problems" / "shaper.yaml").read_text(encoding="utf-8")
LOAD = "F: {on: 5, at: [100, 30], force: [1500, 0], when: working stroke}"


def loads(number):
    return "\n  ".join(LOAD.replace("F:", f"F{k}:") for k in range(number))


def points(number):
    named = ", ".join(f"K{k}: [{k}, 0]" for k in range(number))
    return f"points: [C, D], length: CD, also: {{{named}}}"


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {LOAD: loads(200), "count: 12": "count: 20000"},
            "positions.count: too many positions for so many links, points and loads found: 20000 positions; 5 links, "
            "8 points, 200 loads allowed: at most 6129",
        ),
        (
            {"count: 12": "count: 100000"},
            "positions.count: too many positions for so many links, points and loads found: 100000 positions; 5 links, "
            "8 points, 1 loads allowed: at most 74280",
        ),
        (
            {"points: [C, D], length: CD": points(5000)},
            "links: this linkage is too large found: 5 links, 5008 points, 1 loads "
            "allowed: 6 a link, 1 a point, 2 a load: at most 4160 in all",
        ),
    ],
)
def test_what_would_take_too_long_is_refused_with_what_may_be_asked(changes, told, tmp_path):
    text = SHAPER
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    file = tmp_path / "much.yaml"
    file.write_text(text, encoding="utf-8")
    for command in ("explain", "run"):
        done = tmm(command, file, cwd=tmp_path)
        assert done.returncode == 2
        assert told in " ".join(done.stderr.split()), done.stderr


def test_a_linkage_with_many_points_is_computed_but_neither_drawn_nor_judged(tmp_path):
    file = tmp_path / "much.yaml"
    file.write_text(SHAPER.replace("points: [C, D], length: CD", points(300)), encoding="utf-8")
    told = tmm("run", file, cwd=tmp_path).stderr
    assert "positions.detail: these are too many drawings for so many links and points" in told
    assert "allowed: --no-drawings" in told
    told = tmm("run", file, "--no-drawings", "--digits", cwd=tmp_path).stderr
    assert "--digits: the linkage is too large for its digits to be judged" in told
    assert not (tmp_path / "outputs").exists()
    assert tmm("run", file, "--no-drawings", cwd=tmp_path).returncode == 0


def test_every_problem_of_the_bank_may_be_drawn_in_all_its_positions_and_judged(tmp_path):
    """And none is near the budget: a course project never meets it."""
    from tmm_cli import load
    from tmm_cli.problem.budget import BUDGET, DRAWN, JUDGED, SEARCHED, parts

    for name in ("shaper", "press-class-iii", "engine-four", "positioner"):
        problem = load(str(ROOT / "problems" / f"{name}.yaml"))
        size = parts(problem.linkage)
        assert 12 * size < DRAWN and 2 * size < JUDGED and size * (SEARCHED + 3600) < BUDGET
