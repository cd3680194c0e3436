"""One budget of work: what would take longer than a minute, or more than a gigabyte, is refused before it starts."""

import pytest
from test_commands import ROOT, tmm

from tmm_cli import load
from tmm_cli.problem import ProblemError, refuse_options

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
            (
                "positions.count: there are too many positions for so many links, points and loads found: "
                "positions: 20000; links: 5, points: 8, loads: 200 allowed: at most 6089"
            ),
        ),
        (
            {"count: 12": "count: 100000"},
            (
                "positions.count: there are too many positions for so many links, points and loads found: "
                "positions: 100000; links: 5, points: 8, loads: 1 allowed: at most 74240"
            ),
        ),
        (
            {"points: [C, D], length: CD": points(5000)},
            (
                "links: this mechanism is too large found: links: 5, points: 5008, loads: 1 allowed: at most 3942 "
                "in total, counting a link as 6, a point as 1 and a load as 2"
            ),
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


def test_what_options_add_is_refused_before_anything_is_computed(tmp_path, monkeypatch):
    file = tmp_path / "much.yaml"
    file.write_text(SHAPER.replace("points: [C, D], length: CD", points(500)), encoding="utf-8")
    assert tmm("run", file, "--no-drawings", cwd=tmp_path).returncode == 0
    monkeypatch.setattr("tmm_cli.mechanics.analysis.pipeline.solve", lambda *_, **__: pytest.fail("this was computed"))
    for command, told in {
        ("run",): (
            "positions.detail: there are too many drawings for so many links, points and positions found: "
            "detailed positions: 1; links: 5, points: 508, loads: 1 allowed: a run without drawings"
        ),
        ("structure", "--drawings"): "allowed: a run without drawings",
        ("note",): (
            "positions.detail: there are too many drawings for so many links, points and positions found: "
            "detailed positions: 1; links: 5, points: 508, loads: 1 allowed: a run without drawings"
        ),
        ("sheets",): "positions.detail: there are too many drawings",
        ("sheets", "--positions", "all"): "positions.detail: there are too many drawings",
        (
            "kinematics",
            "--centres",
            *(word for k in range(6) for word in ("-p", str(k))),
        ): (
            "--centres: there are too many instantaneous centres for so many links and positions found: "
            "detailed positions: 6; links: 5, points: 508, loads: 1 allowed: at most 3 detailed positions, or "
            "detailed positions without instantaneous centres"
        ),
        **{
            (name, "--digits"): (
                "--digits: there are too many positions, or the mechanism is too large, to estimate the correct "
                "digits found: positions: 12; links: 5, points: 508, loads: 1 allowed: at most 2 positions, or a "
                "run without --digits"
            )
            for name in ("run", "kinematics", "forces")
        },
    }.items():
        done = tmm(command[0], file, *command[1:], "-o", tmp_path / "refused", cwd=tmp_path)
        assert done.returncode == 2 and told in " ".join(done.stderr.split()), done.stderr
    assert not (tmp_path / "refused").exists()


def test_every_problem_of_the_bank_may_be_drawn_in_twelve_positions_and_judged():
    """And none is near the budget: a course project never meets it."""
    for name in ("shaper", "press-class-iii", "engine-four", "positioner", "excavator"):
        linkage = load(str(ROOT / "problems" / f"{name}.yaml")).linkage
        refuse_options(linkage, 12, digits=True, detail=12)
        refuse_options(linkage, 3600, digits=False, detail=12)


def test_large_sheets_of_many_positions_are_refused_before_their_long_layout(tmp_path, monkeypatch):
    """They are drawn again until they are full: 24 positions of a crank-slider took more than a minute of it."""
    text = SHAPER.replace("count: 12", "count: 48")
    assert "count: 48" in text
    file = tmp_path / "much.yaml"
    file.write_text(text, encoding="utf-8")
    monkeypatch.setattr("tmm_cli.mechanics.analysis.pipeline.solve", lambda *_, **__: pytest.fail("this was computed"))
    for options, told in {
        ("--positions", "all"): (
            "error: too many positions: the motion plans on the sheet would be illegible found: 48 allowed: at "
            "most 24; with --positions detail only the positions in positions.detail are drawn"
        ),
        (
            "--positions",
            "all",
            "--set",
            "n1=1 rpm",
        ): "too many positions: the motion plans on the sheet would be illegible",
    }.items():
        done = tmm("sheets", file, *options, "-o", tmp_path / "refused", cwd=tmp_path)
        assert done.returncode == 2 and told in " ".join(done.stderr.split()), done.stderr
    linkage = load(str(ROOT / "problems" / "shaper.yaml")).linkage
    refuse_options(linkage, 12, digits=False, detail=12, large=True)
    with pytest.raises(ProblemError) as refused:
        refuse_options(linkage, 24, digits=False, detail=24, large=True)
    assert refused.value.allowed == "at most 15 detailed positions, or a run without drawings"


def test_plans_of_all_positions_count_less_than_positions_in_detail():
    """Of the press of class III all 24 take 15 s on a core, and are drawn."""
    press = load(str(ROOT / "problems" / "press-class-iii.yaml")).linkage
    refuse_options(press, 24, digits=False, detail=1, large=True, plans=24)
    with pytest.raises(ProblemError) as refused:
        refuse_options(press, 36_000, digits=False, detail=1, large=True, plans=24)
    assert (refused.value.path, refused.value.found) == (
        ("--positions",),
        "positions: 24; links: 7, points: 14, loads: 1",
    )
    assert refused.value.allowed == "plans for at most 19 positions, or a run with --positions detail"
