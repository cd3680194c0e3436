"""The block `synthesis` of a problem file: parameters, refusals, the command; tasks have tests of their own."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
from test_commands import ROOT, tmm
from test_synthesis_crank_slider import LINKAGE, MET

from tmm_cli import load, solve
from tmm_cli.drawing.sheets import synthesis_diagram
from tmm_cli.problem import ProblemError, TaskProblem, UnitSystem, read_text
from tmm_cli.synthesis import TASKS, Diagram, DiagramLine, build_synthesised


def refusal(text):
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(f"tmm: 1\nsynthesis: {text}\n{LINKAGE.format(speed=1.0)}", "x.yaml"))
    return str(caught.value).partition(": ")[2]


REFUSED = {
    "{task: crank-slider, stroke: 120, k: 1.5, ratio: 40}": (
        "synthesis.k: the crank does not rotate fully: k is too large for this ratio L = l/r\n  found:   1.5"
    ),
    "{task: crank-slider, stroke: 120, k: 3.5, ratio: 2}": (
        "synthesis.k: in a crank-slider whose crank rotates fully, k must be less than 3\n  found:   3.5\n"
    ),
    "{task: crank-slider, stroke: 120, k: 0.8, ratio: 2}": (
        "synthesis.k: k must be 1 or more: it is the duration of the working stroke divided by that of the "
        "shorter return stroke\n"
        "  found:   0.8\n"
    ),
    "{task: crank-slider, stroke: 120, k: 1.1, pressure: 30}": (
        "synthesis.pressure: with this k the largest pressure angle exceeds the given one for every rod "
        "length\n"
        "  found:   30\n"
    ),
    "{task: crank-slider, stroke: 120, k: 3, pressure: 80}": (
        "synthesis.k: in a crank-slider whose crank rotates fully, k must be less than 3\n  found:   3\n"
    ),
    "{task: crank-slider, stroke: 120, nu: 0.1, pressure: 95}": (
        "synthesis.pressure: the largest pressure angle must be less than 90 deg\n  found:   95\n"
    ),
    "{task: crank-slider, stroke: 120, nu: 2, ratio: 2.5}": (
        "synthesis.nu: the crank does not rotate fully: this requires l > r + e\n  found:   2\n"
    ),
    "{task: crank-slider, stroke: 120, nu: -1, ratio: 2.5}": (
        "synthesis.nu: the offset is a distance and cannot be negative; to place the guide on the other "
        "side, mirror the mechanism\n"
        "  found:   -1\n"
    ),
    "{task: crank-slider, stroke: 120, nu: 0.2, ratio: 0.5}": (
        "synthesis.ratio: the crank rotates fully only if the rod is longer than the crank\n  found:   0.5\n"
    ),
    "{task: crank-slider, stroke: 0, nu: 0.2, ratio: 3}": (
        "synthesis.stroke: this value is too small for a mechanism\n  found:   0"
    ),
    "{task: crank-slider, stroke: 50, e: 80, k: 1.5}": (
        "synthesis.k: the crank does not rotate fully: k is too large for this stroke and offset\n  found:   1.5\n"
    ),
    "{task: crank-slider, stroke: 50, e: 20, k: 1}": (
        "synthesis.k: if there is an offset, k must be greater than 1\n  found:   1"
    ),
    "{task: crank-slider, stroke: 50, e: 0, k: 1}": (
        "synthesis.e: with zero offset k is always 1, and the lengths remain undetermined\n  found:   0\n"
    ),
    "{task: crank-slider, stroke: 20, k: 1.1}": (
        "synthesis: these keys do not determine a mechanism; missing: ratio or pressure or e\n"
        "  found:   k\n"
        "  allowed: ratio and nu; or ratio and e; or ratio and k; or pressure and nu; or pressure and k; or e and k"
    ),
    "{task: crank-slider, strok: 20, k: 1.1, ratio: 3}": "synthesis.strok: unknown key\n  found:   'strok'\n"
    "  allowed: task, names, stroke, speed, crank_speed, ratio, nu, k, pressure, e\n  did you mean 'stroke'?",
    "{task: crank-slidr, stroke: 20}": ("synthesis.task: this value is not allowed here\n  found:   'crank-slidr'\n"),
    "{task: [a]}": "synthesis.task: ",
    "{task: {a: b}}": "synthesis.task: ",
    "{task: 3}": "synthesis.task: ",
    "{stroke: 20}": "synthesis.task: the key `task` is missing\n",
    "3": (
        "synthesis: expected keys with values\n"
        "  found:   3\n"
        "  allowed: synthesis task whose results become parameters: {task: ...}"
    ),
    "{task: crank-slider, stroke: 20 kg, k: 1.1, ratio: 3}": (
        "synthesis.stroke: expected here: a length\n"
        "  found:   '20 kg', a mass (20 kg)\n"
        "  allowed: a length, e.g. 110 mm or 0.11 m"
    ),
    "{task: crank-slider, stroke: 20, k: 1.1, ratio: 3, names: {R: OA}}": (
        "synthesis.names.R: the synthesis crank-slider finds no parameter with this name\n"
        "  found:   'R'\n"
        "  allowed: r, l, e\n"
        "  did you mean 'r'?"
    ),
    "{task: crank-slider, stroke: 20, k: 1.1, ratio: 3, names: {r: l}}": (
        "synthesis.names: the parameters r and l that the synthesis finds have the same name in the file\n"
        "  found:   'l'\n"
        "  allowed: different names"
    ),
    "{task: crank-slider, stroke: 20, k: 1.1, ratio: 3, names: {r: 2a}}": (
        "synthesis.names.r: invalid name of a parameter\n"
        "  found:   '2a'\n"
        "  allowed: letters, digits and _, beginning with a letter"
    ),
    "{task: crank-slider, stroke: 120, k: 1.2, ratio: 3}\nparameters: {e: 3}": (
        "parameters.e: parameter e is given, although the synthesis crank-slider finds it (under the name e)\n"
        "  found:   3\n"
        "  allowed: only one of the two; or another name: synthesis: {names: {e: ...}}"
    ),
    "{task: crank-slider, stroke: H, k: 1.2, ratio: 3}\nparameters: {H: 2*OA, OA: r}": (
        "synthesis.stroke: the task depends on parameters that the synthesis itself finds\n"
        "  found:   'H'\n"
        "  allowed: parameters that do not"
    ),
}


NO_MECHANISM = {
    "crank-slider, stroke: 10, k: 1, ratio: 1e250": "ratio: this value is too large",
    "crank-slider, stroke: 10, nu: 1e200, pressure: 30": "nu: this value is too large",
    "crank-slider, stroke: 10, k: 1, pressure: 1e-200": "pressure: this value is too small",
    "crank-slider, speed: 1e200, crank_speed: 1e-200, nu: 0, ratio: 4": "speed: this value is too large",
    "four-bar-by-k, l3: 1e-250, psi1: 10, psi2: 70, k: 1.2": "l3: this value is too small",
    "four-bar-by-k, l3: 1e12, psi1: 10, psi2: 70, k: 1.2": (
        "l3: this value is too large for a mechanism\n  found:   1e12\n  allowed: 1e+09 mm or less"
    ),
    "four-bar-by-k, l3: 100, psi1: 10, psi2: 70, k: 1.2, near: [1e12, 0]": (
        "near[0]: this value is too large for a mechanism\n  found:   1e12"
    ),
    "four-bar-by-k, l3: 1e250, psi1: 10, psi2: 70, k: 1.2": "l3: this value is too large",
    "four-bar-by-k, l3: 100, psi1: 10, psi2: 70, k: 1.2, near: [1e200, 0]": "near[0]: this value is too large",
    "four-bar-by-k, l3: 100, psi1: 1e16, psi2: 10000000000000050, k: 1.2": "psi1: this value is too large",
    "shaper, stroke: 10, k: 1.7, frame_ratio: .499, rod_ratio: 3e9": "rod_ratio: this value is too large",
    "grashof, l1: 1e200, l2: 1e200, l3: 1e200, l4: 1e199": "l1: this value is too large",
}


@pytest.mark.parametrize("block", NO_MECHANISM)
def test_sizes_that_no_mechanism_has_are_refused_before_numbers_overflow(block):
    assert refusal(f"{{task: {block}}}").startswith(f"synthesis.{NO_MECHANISM[block]}")


def test_sizes_at_the_bounds_give_numbers():
    for more in (
        "k: 1, ratio: 1e6",
        "nu: 1e6, pressure: 0.001",
        "nu: 0, pressure: 1e-6 rad",
        "k: 1.0000000001, ratio: 1e6",
    ):
        found = build_synthesised(
            read_text(
                f"tmm: 1\nsynthesis: {{task: crank-slider, stroke: 10, {more}}}\n{LINKAGE.format(speed=1.0)}", "x"
            )
        )
        assert all(np.isfinite(float(v.value)) for v in found.synthesis.outcome.found if v.kind != "word")


@pytest.mark.parametrize("text", REFUSED)
def test_what_cannot_be_is_refused_with_the_reason_and_what_could(text):
    assert refusal(text).startswith(REFUSED[text])


def test_parameters_that_rest_on_the_answer_and_those_that_it_rests_on():
    text = "{task: crank-slider, stroke: H, ratio: L, nu: 0}\nparameters: {H: 2*a, a: 30, L: 3, AS: AB/2, AB: l}"
    found = build_synthesised(
        read_text(f"tmm: 1\nsynthesis: {text}\n{LINKAGE.format(speed=1.0)}".replace("-e]", "-AS + AB/2]"), "x")
    )
    assert abs(found.linkage.links["2"].points["B"]) == pytest.approx(0.09, rel=1e-15)


@pytest.fixture(scope="module")
def press(tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    return tmm("synthesis", ROOT / "problems" / "press-synthesis.yaml", "-o", out), out / "press-synthesis"


def test_the_command_shows_what_was_asked_found_and_measured_and_draws_the_construction(press):
    done, folder = press
    assert done.returncode == 0, done.stderr
    for part in (
        "Task: crank-slider",
        "stroke H                     120",
        "58.80621953",
        "relative difference",
        "Source: triangle",
    ):
        assert part in done.stdout
    names = {path.name for path in folder.iterdir()}
    drawings = {f"synthesis-{name}.{kind}" for name in ("construction", "extremes") for kind in ("png", "svg")}
    tables = {f"synthesis-{name}.csv" for name in ("asked", "found", "measured", "quality")}
    assert names == drawings | tables | {"synthesis.json"}
    result = json.loads((folder / "synthesis.json").read_text(encoding="utf-8"))
    assert result["met"] is True and set(result["parameters"]) == {"OA", "AB", "e"}
    assert 0 < max(m["difference"] for m in result["measured"]) < MET
    with (folder / "synthesis-measured.csv").open(encoding="utf-8") as measured:
        assert {row["relative difference"] for row in csv.DictReader(measured)} == {"0"}, "rounding is no difference"


def test_a_mechanism_that_does_something_else_fails(tmp_path):
    text = (ROOT / "problems" / "press-synthesis.yaml").read_text(encoding="utf-8")
    bad = tmp_path / "bad.yaml"
    bad.write_text(text.replace("length: AB}", "length: AB + 1 mm}"), encoding="utf-8")
    done = tmm("synthesis", bad)
    assert done.returncode == 1
    assert "warning: k (time ratio): required value 1.08, measured value 1.07" in done.stderr


def test_a_file_without_a_linkage_is_for_the_synthesis_alone(tmp_path):
    file = tmp_path / "alone.yaml"
    file.write_text("tmm: 1\nsynthesis: {task: crank-slider, stroke: 100, ratio: 3, nu: 0}\n", encoding="utf-8")
    done = tmm("synthesis", file, "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["parameters"]["r"] == pytest.approx(0.05)
    assert json.loads(done.stdout)["measured"] is None
    done = tmm("run", file)
    assert (
        done.returncode == 2
        and "the file has no linkage that could use the dimensions found by the synthesis" in done.stderr
    )
    done = tmm("synthesis", ROOT / "problems" / "shaper.yaml")
    assert done.returncode == 2 and "the file has no block `synthesis`" in done.stderr


def test_numbers_of_what_is_found_are_numbers_in_the_table_and_texts_are_no_formulas(tmp_path):
    file = tmp_path / "guided.yaml"
    block = "{task: coupler-positions, positions: [[0, 0, 0], [60, 40, 15], [110, 100, 35]], B: [0, -20], C: [50, 0]}"
    file.write_text(f"tmm: 1\nsynthesis: {block}\n", encoding="utf-8")
    assert tmm("synthesis", file, "-o", tmp_path).returncode == 0
    rows = (tmp_path / "guided" / "synthesis-found.csv").read_text(encoding="utf-8").splitlines()
    values = {row.split(",")[0]: row.split(",")[-2] for row in rows[1:]}
    assert min(float(values[name]) for name in ("Ax", "Ay", "Dx", "Dy")) < 0


def test_explain_says_where_parameters_come_from():
    told = tmm("explain", ROOT / "problems" / "press-synthesis.yaml").stdout
    assert "Parameters found by synthesis" in told and "Task: crank-slider" in told


def test_a_task_is_solved_when_its_problem_is_first_asked_for_a_number_and_only_then():
    # A stone whose slot hinges on C has theta between its ends: OA = OC sin(theta/2), theta = pi (k - 1)/(k + 1).
    problem = load(str(ROOT / "problems" / "slotted-lever-synthesis.yaml"))
    assert isinstance(problem, TaskProblem) and "whole" not in vars(problem)
    assert sorted(set(problem.linkage.links) - {"0"}) == ["1", "2", "3"]
    assert (problem.request.count, problem.request.start, problem.request.detail) == (12, "working stroke", (3,))
    found = {value.name: value.value for value in problem.synthesis.outcome.found if value.name}
    assert problem.synthesis.task == "slotted-lever" and set(found) == set(problem.synthesis.names)
    assert found["OA"] == pytest.approx(0.4 * np.sin(np.pi * 0.6 / 2.6 / 2), rel=1e-12)
    assert problem.linkage is problem.whole.linkage and solve(problem).problem is problem.whole


def test_a_file_without_a_synthesis_imports_nothing_of_it():
    assert load(str(ROOT / "problems" / "shaper.yaml")).synthesis is None


def test_a_diagram_of_a_task_is_drawn_in_the_units_of_the_file():
    axis = ("largest pressure angle", "angle")
    line = DiagramLine("largest pressure angle", np.array([0.1, 0.2]), np.array([0.0, np.pi]))
    dots = DiagramLine("k", np.array([0.15]), np.array([1.0]), dots=True)
    drawn = Diagram("family", "A family", ("stroke", "length"), axis, (line, dots))
    sheet = synthesis_diagram("A task", drawn, UnitSystem())
    assert {"largest pressure angle, deg", "stroke, mm", "100", "200", "180", "k"} <= set(sheet.texts())


def test_the_schema_for_editors_knows_the_keys_of_every_task():
    schema = json.loads(tmm("schema").stdout)
    assert schema["else"]["properties"]["synthesis"]["anyOf"] == [{"$ref": "#/$defs/Synthesis"}]
    tasks = {part["properties"]["task"]["const"]: part["properties"] for part in schema["$defs"]["Synthesis"]["anyOf"]}
    assert set(tasks) == set(TASKS)
    assert {"stroke", "k", "ratio", "names"} <= set(tasks["crank-slider"])


@pytest.mark.parametrize("task", TASKS)
def test_every_task_stands_in_the_documentation(task):
    page = "optimal-synthesis.md" if task == "optimal" else "synthesis.md"
    text = (ROOT / "problems" / "docs" / page).read_text(encoding="utf-8")
    assert f"`{task}`" in text or f"task: {task}" in text


def test_a_run_tells_the_synthesis_with_the_rest(tmp_path):
    done = tmm("run", ROOT / "problems" / "press-synthesis.yaml", "-o", tmp_path, "--no-drawings")
    assert done.returncode == 0, done.stderr
    assert "Solution" in done.stdout and "measured on the mechanism" in done.stdout
    folder = tmp_path / "press-synthesis"
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert result["synthesis"]["met"] is True and set(result["synthesis"]["parameters"]) == {"OA", "AB", "e"}
    assert (folder / "synthesis-measured.csv").exists()


def test_tables_of_several_files_come_under_their_names():
    files = [ROOT / "problems" / f"{name}.yaml" for name in ("press-synthesis", "pump-synthesis")]
    done = tmm("synthesis", *files)
    assert [line for line in done.stdout.splitlines() if line.startswith("==")] == [f"== {file} ==" for file in files]


def test_a_misspelt_block_is_told_at_its_place(tmp_path):
    text = (ROOT / "problems" / "press-synthesis.yaml").read_text()
    file = tmp_path / "press.yaml"
    file.write_text(text.replace("\nsynthesis:", "\nsinthesis:"))
    done = tmm("synthesis", file)
    line = 1 + text[: text.index("\nsynthesis:") + 1].count("\n")
    assert done.returncode == 2 and f"press.yaml:{line}:1: sinthesis: unknown key" in done.stderr
    assert "did you mean 'synthesis'?" in done.stderr


def test_what_the_synthesis_finds_is_among_the_names_that_arithmetic_may_use():
    with pytest.raises(ProblemError) as caught:
        build_synthesised(
            read_text(
                "tmm: 1\nparameters: {n: 3, AS: 0.35*AB}\nsynthesis: {task: crank-slider, stroke: 120, k: 1.1, "
                f"ratio: 3.5}}\n{LINKAGE.format(speed=1.0)}",
                "x.yaml",
            )
        )
    assert caught.value.path == ("parameters", "AS") and caught.value.near is None
    assert caught.value.allowed == "r, l, e, n"


@pytest.mark.parametrize(
    "block",
    [
        "{task: four-bar-by-k, l3: 250, psi1: 60, psi2: 110, k: 1.2, support: 400}",
        "{task: four-bar-by-k, l3: 250, psi1: 60, psi2: 110, k: 1.2, support: [400]}",
        "{task: four-bar-by-k, l3: 250, psi1: 60, psi2: 110, k: 1.2, near: [1, 2, 3]}",
        "{task: slotted-lever, k: 1.8, B1: 3, B2: [1, 2], OC: 30}",
        "{task: slotted-lever, k: 1.8, CB: 30, within: 20}",
        "{task: four-bar-by-angles, function: x^2, x: 3, input: [30, 120], output: [60, 150], l4: 100}",
    ],
)
def test_a_place_or_a_range_that_is_none_is_said_in_our_words(block):
    with pytest.raises(ProblemError, match=r"two (coordinates|numbers) \[\w+, \w+\]"):
        build_synthesised(read_text(f"tmm: 1\nsynthesis: {block}\n{LINKAGE.format(speed=1.0)}", "x.yaml"))


def test_a_family_is_written_in_numbers_and_not_shown_on_the_terminal(tmp_path):
    done = tmm("synthesis", ROOT / "problems" / "crank-rocker-synthesis.yaml", "-o", tmp_path)
    assert done.returncode == 0 and "All pivots A" not in done.stdout
    folder = tmp_path / "crank-rocker-synthesis"
    rows = (folder / "synthesis-family.csv").read_text().splitlines()
    records = json.loads((folder / "synthesis.json").read_text())["tables"]["family"]
    assert len(rows) == len(records) + 1 > 100
    assert {"beta", "xA", "yA", "l1", "l2", "l4", "pressure", "transmission"} <= records[0].keys()
    assert rows[0].startswith("arc,")
