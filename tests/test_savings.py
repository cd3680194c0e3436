"""No more is computed than what is asked for, and what is asked for does not change by it."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from bank import NAMES, problem as read, solved
from test_commands import ROOT, SHAPER, tmm

from tmm_cli import load, solve
from tmm_cli.bench import (
    SAVING_TITLES,
    Saving,
    Savings,
    count_solutions,
    savings_charts,
    with_all_orders,
    without_closed_forms,
)
from tmm_cli.drawing.run import sheet_files as drawings
from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.groups import DriverMotion, NotComputed, solvers_towards
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.quantities import LENGTH, NUMBER
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import UnitSystem, build_any_problem, build_chain, read_file, read_text
from tmm_cli.reports import (
    Column,
    StagedFolder,
    Table,
    csv_text,
    describe_stages,
    json_bytes,
    json_text,
    links_with_inertia,
    listed_files,
)
from tmm_cli.synthesis import count, structure_of

NAMES = [name for name in NAMES if name != "crank-rocker-optimal"]  # a four-bar, sought for seconds


def into_numpy(work):
    """What of numpy a piece of work calls."""
    called = []

    def watch(frame, event, found):
        if event == "c_call":
            own = getattr(found, "__self__", None)
            home = getattr(found, "__module__", None) or ""
            if home.startswith("numpy") or isinstance(own, np.ndarray | np.generic):
                called.append(found)

    sys.setprofile(watch)
    try:
        work()
    finally:
        sys.setprofile(None)
    return called


@pytest.mark.parametrize("name", NAMES[::2])
def test_structure_alone_builds_no_arrays_and_solves_no_group(name):
    problem = read(name)
    with count_solutions() as count:
        called = into_numpy(lambda: structure_of(problem).structure.formula)
    if analyse_structure(problem.linkage).sound:
        assert count.all == 0
        assert called == []
    else:  # counting alone does not tell its mobility: the rank does, from numbers
        assert solve(problem, "structure").structure.passive


def test_the_structure_of_a_chain_in_space_builds_no_arrays():
    problem = build_chain(read_file(str(ROOT / "problems" / "spatial-six-bar.yaml")))
    assert into_numpy(lambda: count(problem)) == []


def test_a_name_that_the_pairs_tell_needs_no_motion_and_a_crank_is_told_by_its_turn():
    toothed = solve(load(str(ROOT / "problems" / "planetary-dwell-press.yaml")), "structure")
    shaper = solve(load(str(SHAPER)), "structure")
    with count_solutions() as count:
        assert toothed.roles["1"] == "carrier"
        assert count.all == 0
        assert shaper.roles["1"] == "crank"
        assert count.places > 0
        assert count.velocities == count.accelerations == 0


@pytest.mark.parametrize("name", NAMES[1::3])
def test_a_link_alone_moves_as_in_the_whole_linkage_by_the_groups_on_its_way(name):
    problem, whole = read(name), solved(name)
    for link in problem.linkage.moving:
        kernels = solvers_towards(whole.kernels, [link])
        assert kernels == tuple(kernel for kernel in whole.kernels if kernel in kernels)
        q = whole.motion.q[:3]
        alone = compute_motion(problem.linkage, kernels, q, DriverMotion(float(q[0]), 1.0, 0.0, 1), 1)
        there = alone.placed & whole.motion.placed[:3]
        here, known = alone.poses[link].x[there], whole.motion.poses[link].x[:3][there]
        assert np.allclose(here, known, rtol=1e-12, atol=1e-13)  # where it is iterated, to rounding


def test_groups_that_do_not_lead_to_what_is_asked_are_not_solved():
    problem = load(str(ROOT / "problems" / "engine-four.yaml"))
    ways = {"3": ["II(2,3)"], "5": ["II(4,5)"], "7": ["II(6,7)"], "1": []}  # all rods are attached to the crank
    for piston, titles in ways.items():
        with count_solutions() as count:
            results = solve(problem, "kinematics", of=[piston])
        assert [kernel.group.title for kernel in results.motion.kernels] == titles
        assert count.accelerations == len(titles) * len(results.numbers)


def test_kinematics_of_names_lists_them_alone_with_the_numbers_of_the_whole_table():
    whole = json.loads(tmm("kinematics", SHAPER, "--json").stdout)["kinematics"]
    alone = json.loads(tmm("kinematics", SHAPER, "--json", "--of", "E,5,S3").stdout)
    part = alone["kinematics"]
    assert (list(part["points"]), list(part["centres"]), list(part["links"])) == (["E"], ["S3"], ["5"])
    assert part["points"]["E"] == whole["points"]["E"]
    assert part["centres"]["S3"] == whole["centres"]["S3"]
    assert part["links"]["5"] == whole["links"]["5"]
    assert part["slides"] == {}
    assert "pressure" not in alone
    assert list(json.loads(tmm("kinematics", SHAPER, "--json", "--of", "D").stdout)["kinematics"]["margins"]) == [
        "II(2,3)"
    ]


def test_an_unknown_name_is_one_error_with_the_nearest_one():
    done = tmm("kinematics", SHAPER, "--of", "E,S33")
    assert done.returncode == 2
    assert "'S33'" in done.stderr
    assert "did you mean 'S3'" in done.stderr
    assert "Traceback" not in done.stderr


def test_only_positions_asked_for_are_solved():
    problem = load(str(SHAPER))
    with count_solutions() as one:
        results = solve(problem, "forces", [7])
    with count_solutions() as all_of_them:
        solve(problem, "forces")
    groups, others = len(results.structure.groups), len(results.asked) - 1
    assert all_of_them.places - one.places == groups * others
    assert (one.accelerations, all_of_them.accelerations) == (groups, groups * (others + 1))


@pytest.mark.parametrize("name", NAMES[::3])
def test_range_strokes_dead_positions_and_names_need_no_accelerations_and_are_the_same_with_them(name):
    problem = read(name)
    if any(kernel.followed for kernel in solved(name).kernels):
        return  # a group is followed by its accelerations

    def quality():
        found = solve(problem, "structure").mechanism
        return found.driver_range, found.strokes, found.dead, found.roles, found.further

    with count_solutions() as count:
        lean = quality()
    assert count.accelerations == 0
    with with_all_orders():
        assert repr(quality()) == repr(lean)


def test_without_the_saving_every_place_has_accelerations():
    with with_all_orders(), count_solutions() as count:
        solve(load(str(SHAPER)), "structure").driver_range  # noqa: B018
    assert count.accelerations == count.velocities > 0


def test_places_alone_have_no_velocities_and_asking_for_them_is_an_error():
    results = solve(load(str(SHAPER)), "kinematics")
    q = results.motion.q
    law = DriverMotion(float(q[0]), 1.0, 0.0, 1)
    places, rates = (compute_motion(results.linkage, results.kernels, q, law, order) for order in (0, 1))
    assert np.allclose(places.spot("E"), results.motion.named("E").x, rtol=1e-15, atol=0)
    assert np.array_equal(rates.first["5"].v, results.motion.first["5"].v)
    with pytest.raises(NotComputed, match="velocities"):
        places.link("3")
    with pytest.raises(NotComputed, match="accelerations"):
        rates.named("E")
    with pytest.raises(NotComputed):
        rates.centre("3")


def test_massless_links_carry_no_inertia():
    results = solve(load(str(ROOT / "problems" / "cylinder.yaml")))
    light = [name for name in results.linkage.moving if name not in links_with_inertia(results.linkage)]
    assert not [load for load in results.loads if load.link in light and load.kind in ("weight", "inertia")]


def test_every_group_with_a_closed_form_is_solved_by_it():
    for name in ("shaper", "six-bar", "sine", "tangent", "press-class-iii", "gear-straight-line"):
        results = solve(load(str(ROOT / "problems" / f"{name}.yaml")), "structure")
        for kernel in results.kernels:
            if kernel.group.type in ("RRR", "RRP", "RPR", "PRP", "RPP") and not kernel.group.drivers:
                assert type(kernel).__name__ == kernel.group.type


def test_closed_form_and_newton_give_the_same_places():
    results = solve(load(str(ROOT / "problems" / "six-bar.yaml")), "kinematics")
    with without_closed_forms():
        iterated = assemble(results.linkage, results.structure)
    motion = compute_motion(results.linkage, iterated, results.motion.q, DriverMotion(0.0, 1.0, 0.0, 1), 0)
    assert {type(kernel).__name__ for kernel in iterated} == {"NewtonSolver"}
    for link, pose in motion.poses.items():
        assert np.allclose(pose.x, results.motion.poses[link].x, rtol=0, atol=1e-13)


def test_a_group_that_is_equally_far_from_dead_everywhere_is_not_searched_for_dead_positions():
    """Its margin has hundreds of least values, all of them rounding."""
    text = (ROOT / "problems" / "crossed-slots.yaml").read_text(encoding="utf-8").replace("L: [0, 220]", "L: [0, 440]")
    results = solve(build_any_problem(read_text(text, "x.yaml")))
    with count_solutions() as count:
        assert results.dead == ()
    assert count.all < 15_000


def test_what_shows_tables_imports_no_drawing_and_no_optimisation():
    commands = ("structure", "kinematics", "forces", "explain")
    code = (
        "import sys\nfrom tmm_cli.cli.app import application\nfor command in sys.argv[2:]:\n"
        " try: application([command])([command, sys.argv[1]])\n except SystemExit as end: print(command, end.code, "
        "[m for m in sys.modules if m in ('matplotlib', 'scipy') or m[:10] == 'tmm_cli.dr'], file=sys.stderr)"
    )
    call = [sys.executable, "-c", code, str(SHAPER), *commands]
    done = subprocess.run(call, capture_output=True, text=True, cwd=ROOT)
    ends = [line for line in done.stderr.splitlines() if line.startswith(commands)]
    assert ends == [f"{command} 0 []" for command in commands]


def test_explain_says_of_every_stage_what_the_stage_does():
    results = solve(load(str(SHAPER)), "kinematics")
    rows = {row[0]: row for row in describe_stages(results)}
    with count_solutions() as count:
        results.mechanism.strokes  # noqa: B018
        asked = count.places
        results.dead  # noqa: B018
    groups = len(results.structure.groups)
    assert count.places - asked >= groups * int(rows["dead positions"][2])
    assert rows["kinematics"][1:4] == ("all 2", "12", "positions, velocities, accelerations")
    assert "inertia of links 1, 2, 3, 4, 5" in rows["forces"][4]


def test_every_saving_is_one(tmp_path, monkeypatch):
    monkeypatch.setattr("tmm_cli.bench.savings.FEW_REPEATS", 1)
    monkeypatch.setattr("tmm_cli.cli.bench.png_bytes", lambda figure: b"")
    done = tmm("bench", "savings", "--reduced", "--json", "-o", tmp_path)
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert tuple(saving["name"] for saving in found["savings"]) == tuple(SAVING_TITLES)
    assert found["holds"] and all(saving["holds"] for saving in found["savings"])
    assert {path.name for path in tmp_path.iterdir()} == {f"savings.{kind}" for kind in ("csv", "json", "png")}


def test_what_saves_nothing_is_said_so():
    spared, wasted = (Saving(name, "solutions", n, 5, (1.0, 1.0)) for name, n in (("groups", 4), ("closed", 5)))
    found = Savings("shaper", "A shaper", (spared, wasted))
    assert found.failures == ("closed form where available",)
    assert found.tables[0].columns[-1].values == ["", "saves nothing"]
    figure = savings_charts(found)["savings.png"]
    names = [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    assert names == ["only the groups required", "closed form where available"]


# ---------------------------------------------------------------------------------------------- writing of long cycles

VALUES = np.concatenate(
    [
        [
            0.0,
            -0.0,
            1.0,
            -1.0,
            np.nan,
            np.inf,
            -np.inf,
            0.1,
            1e15,
            1e16,
            123456789012345678.0,
            1e-5,
            1e-4,
            5e-324,
            1.8e308,
        ],
        np.random.default_rng(1).standard_normal(3000) * 10.0 ** np.random.default_rng(2).integers(-30, 30, 3000),
        np.repeat([1.5, 0.0, -2.25e-9], 2000),
        np.round(np.random.default_rng(3).standard_normal(500), 3),
    ]
)


def test_a_table_is_written_as_a_csv_writer_writes_it():
    words = ["a", "b, c", 'say "x"', "=1+1", "-5", "-5+A1", "two\nlines", ""]
    told = [words[k % len(words)] for k in range(len(VALUES))]
    table = Table("t", "t", (Column("word, here", told), Column("x", VALUES, LENGTH), Column("y", VALUES, NUMBER)))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["word, here", "x, mm", "y"])
    for word, value in zip(told, VALUES.tolist(), strict=True):
        cells = [f"{number:.15g}" if np.isfinite(number) else "" for number in (value * 1000, value)]
        writer.writerow(["'" + word if word in ("=1+1", "-5+A1") else word, *cells])  # -5 is a number
    assert "".join(csv_text(table, UnitSystem())) == text.getvalue()


def test_a_record_is_written_as_json_writes_it():
    finite = VALUES[np.isfinite(VALUES)]
    record = {"a": {"x": finite, "flags": finite > 0, "whole": np.arange(5), "none": np.zeros(0)}, "b": [1, "й", None]}
    plainly = {"a": {key: part.tolist() for key, part in record["a"].items()}, "b": record["b"]}
    text = "".join(json_text(record.items()))
    assert text.encode() == json_bytes(plainly)
    assert json.loads(text) == plainly
    assert f'"x": {json.dumps(finite.tolist())},\n' in text
    assert json.loads("".join(json_text([("v", VALUES)])))["v"][4:7] == [None, None, None]


def test_nothing_is_renamed_before_all_is_written(tmp_path):
    with pytest.raises(ZeroDivisionError), StagedFolder(tmp_path / "new") as staged:
        staged.write("a.csv", ["a"])
        staged.write("b.csv", (str(1 / k) for k in (1, 0)))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "a.csv").write_text("old", encoding="utf-8")
    with StagedFolder(tmp_path) as staged:
        staged.write("a.csv", ["ne", b"w"])
        assert (tmp_path / "a.csv").read_text(encoding="utf-8") == "old"
    assert [(path.name, path.read_text(encoding="utf-8")) for path in tmp_path.iterdir()] == [("a.csv", "new")]


def test_the_files_of_an_earlier_run_are_read_from_the_end_of_its_record(tmp_path):
    record = {"kinematics": {"x": list(range(50_000))}, "files": ["a.csv", "b.png", "../c.csv"]}
    (tmp_path / "result.json").write_bytes(json_bytes(record))
    assert listed_files(tmp_path) == {"a.csv", "b.png"}
    (tmp_path / "result.json").write_text("{}", encoding="utf-8")
    assert listed_files(tmp_path) == set()


def test_a_run_of_3_000_positions_needs_less_than_90_MB(tmp_path):
    """Of which some 60 are there for 12 already: so 36 000 need less than 420."""
    text = SHAPER.read_text(encoding="utf-8").replace("count: 12", "count: 3000")
    assert "count: 3000" in text
    (tmp_path / "long.yaml").write_text(text, encoding="utf-8")
    code = (
        "import sys\nfrom tmm_cli.cli.app import main\ntry: main()\nexcept SystemExit:\n"
        "    with open('/proc/self/status') as status: lines = dict(line.split(':') for line in status)\n"
        "    print(int(lines['VmHWM'].split()[0]) / 1024, file=sys.stderr)"  # ru_maxrss: the parent too
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "run", str(tmp_path / "long.yaml"), "--no-drawings", "-o", str(tmp_path / "out")],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert float(done.stderr.strip().splitlines()[-1]) < 90
    with (tmp_path / "out" / "long" / "cycle.csv").open(encoding="utf-8") as stream:
        assert sum(1 for _ in stream) == 3_001


def test_a_diagram_of_many_positions_marks_no_more_than_can_be_told_apart():
    problem = load(str(SHAPER))
    many = replace(problem, request=replace(problem.request, count=3600, detail=()))
    drawn = drawings(solve(many, "kinematics"))
    assert next(len(content) for name, content in drawn if name == "diagrams.svg") < 600_000
