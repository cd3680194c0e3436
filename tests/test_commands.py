"""The commands as a user runs them: their output, exit codes and files; what belongs to a process, in one."""

from __future__ import annotations

import contextlib
import csv
import functools
import gc
import io
import json
import os
import re
import subprocess
import sys
import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from unittest import mock

import pytest
import yaml
from bank import EVERY, solved
from rich.console import Console

from tmm_cli.cli import COMMANDS, MEASUREMENTS, main
from tmm_cli.problem import UnitSystem, list_templates, load_translations, template_text
from tmm_cli.reports import (
    MORE_ROWS,
    MORE_ROWS_AS_JSON,
    MOST_ROWS,
    ResultDifference,
    difference_table,
    find_differences,
    print_on_terminal,
    tables,
)

ROOT = Path(__file__).parent.parent
SHAPER = ROOT / "problems" / "shaper.yaml"


def tmm(*arguments, cwd=None):
    """Run `tmm` without a process of its own; what would be a traceback is raised, warnings are printed as in one."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    call = ["tmm", *map(str, arguments)]
    often = gc.get_threshold()

    def show(message, category, filename, lineno, file=None, line=None):
        err.write(warnings.formatwarning(message, category, filename, lineno, line))

    with (
        mock.patch.dict(os.environ, {"NO_COLOR": "1"}),
        mock.patch.object(sys, "argv", call),
        contextlib.chdir(cwd or ROOT),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        warnings.catch_warnings(),
        pytest.raises(SystemExit) as ended,
    ):
        warnings.showwarning = show
        main()
    gc.set_threshold(*often)
    told = []
    for stream in (out, err):
        stream.flush()
        told.append(stream.buffer.getvalue().decode("utf-8"))
    return subprocess.CompletedProcess(call, ended.value.code or 0, *told)


def process(*arguments, cwd=None):
    """Run `tmm` in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "tmm_cli", *map(str, arguments)],
        capture_output=True,
        encoding="utf-8",
        cwd=cwd or ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT), "NO_COLOR": "1", "PYTHONIOENCODING": "utf-8"},
    )


def after_the_echo(stderr):
    """What a command says on stderr after the three lines of what it understood, which come first."""
    lines = stderr.splitlines(keepends=True)
    assert [line.split(": ")[1] for line in lines[:3]] == ["units of numbers given without a unit", "driver", "lengths"]
    return "".join(lines[3:])


def leaves(value):
    if isinstance(value, dict | list):
        for part in value.values() if isinstance(value, dict) else value:
            yield from leaves(part)
    else:
        yield value


@pytest.fixture(scope="module")
def shaper(tmp_path_factory):
    out = tmp_path_factory.mktemp("out")
    done = process("run", SHAPER, "-o", out)
    assert done.returncode == 0, done.stderr
    return done, out / "shaper"


def test_run_writes_tables_drawings_and_results(shaper):
    done, folder = shaper
    names = {path.name for path in folder.iterdir()}
    assert {"result.json", "structure.csv", "points.csv", "reactions.csv", "lever.csv", "cycle.csv"} <= names
    drawings = (
        "structure",
        "groups",
        "mechanism",
        "position-03",
        "velocity-03",
        "acceleration-03",
        "forces-03-links-4-5",
        "forces-03-links-2-3",
        "forces-03-link-1",
        "lever-03",
        "diagrams",
        "reactions",
        "group-loads-03-links-4-5",
        "group-loads-03-links-2-3",
        "group-loads-03-link-1",
    )
    for name in drawings:
        assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert (folder / f"{name}.svg").read_text(encoding="utf-8").rstrip().endswith("</svg>")
    assert "I(0,1) → II(2,3) → II(4,5)" in done.stdout
    assert not [n for n in names if n.startswith(".")]


def test_result_json_is_plain_and_follows_its_schema(shaper):
    result = json.loads((shaper[1] / "result.json").read_text(encoding="utf-8"))
    schema = json.loads(tmm("schema", "--result").stdout)
    assert set(result) <= set(schema["properties"])
    described(result, schema, "")
    assert result["lever"]["holds"] is True
    assert max(result["lever"]["difference"]) < 1e-10
    assert result["output"]["k"] == pytest.approx(1.51108, abs=1e-5)


def described(value, schema, path):
    """Every key of the result is documented, and is of the documented type."""
    kinds = schema.get("type")
    kinds = [kinds] if isinstance(kinds, str) else kinds
    names = {dict: "object", list: "array", str: "string", bool: "boolean", int: "number", float: "number"}
    if kinds and value is not None:
        kind = names[type(value)]
        assert kind in kinds or (kind == "number" and "integer" in kinds), (path, kind, kinds)
    if isinstance(value, dict):
        for key, part in value.items():
            inner = schema.get("properties", {}).get(key) or schema.get("additionalProperties")
            assert inner, f"{path}.{key} is not documented"
            described(part, inner, f"{path}.{key}")
    elif isinstance(value, list):
        for part in value[:3]:
            described(part, schema["items"], f"{path}[]")


def test_csv_tables_have_a_row_a_position_and_units_of_the_file(shaper):
    rows = list(csv.reader((shaper[1] / "cycle.csv").open(encoding="utf-8")))
    assert rows[0][:3] == ["position", "phi, deg", "s of 5, mm"]
    assert len(rows) == 13


def test_two_files_of_one_name_do_not_take_each_others_folder(tmp_path):
    text = (ROOT / "problems" / "sine.yaml").read_text(encoding="utf-8")
    for student in ("ivan", "petr"):
        (tmp_path / student).mkdir()
        (tmp_path / student / "task.yaml").write_text(text, encoding="utf-8")
    files = [tmp_path / student / "task.yaml" for student in ("ivan", "petr")]
    done = tmm("kinematics", *files, "-o", tmp_path / "out")
    assert done.returncode == 2 and "have the same name" in done.stderr and not (tmp_path / "out").exists()
    assert tmm("kinematics", *files).returncode == 0


def test_a_second_run_is_the_same_to_the_byte(shaper, tmp_path):
    assert tmm("run", SHAPER, "-o", tmp_path).returncode == 0
    for path in shaper[1].iterdir():
        assert path.read_bytes() == (tmp_path / "shaper" / path.name).read_bytes(), path.name


@pytest.mark.parametrize("command", ["structure", "kinematics", "forces"])
def test_json_is_pure_and_each_stage_computes_no_more_than_it_says(command):
    result = json.loads(tmm(command, SHAPER, "--json").stdout)
    assert ("kinematics" in result) == (command != "structure")
    assert ("forces" in result) == ("lever" in result) == (command == "forces")


def test_position_7_alone_is_position_7_of_the_cycle():
    cycle = json.loads(tmm("forces", SHAPER, "--json").stdout)
    alone = json.loads(tmm("forces", SHAPER, "--json", "--position", "7").stdout)
    assert alone["positions"]["number"] == [7]

    def compare(one, many, path=()):
        if isinstance(one, dict):
            for key in one:
                compare(one[key], many[key], (*path, key))
        elif isinstance(one, list) and one and isinstance(one[0], dict):
            for a, b in zip(one, many, strict=True):
                compare(a, b, path)
        elif isinstance(one, list) and len(one) == 1 and len(many) == 12 and isinstance(one[0], float):
            largest = max(abs(v) for v in many if v is not None)
            assert abs(one[0] - many[7]) <= 1e-15 * largest, path

    for part in ("kinematics", "forces"):
        compare(alone[part], cycle[part])


@functools.cache
def imported(*arguments):
    """The modules that a command imports."""
    code = (
        "import sys; sys.argv = ['tmm', *sys.argv[1:]]\n"
        "from tmm_cli.cli.app import main\n"
        "try: main()\n"
        "except SystemExit: print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, cwd=ROOT)
    return set(done.stderr.splitlines()[-1].split())


def test_structure_imports_neither_matplotlib_nor_scipy_and_version_nothing_heavy():
    heavy = {"numpy", "pydantic", "matplotlib", "scipy", "yaml"}
    assert heavy & imported("structure", str(SHAPER)) == {"numpy", "pydantic", "yaml"}
    assert not heavy & imported("--version")


def test_a_command_makes_no_other_one_and_no_masked_arrays():
    names = {"numpy.ma", *(f"tmm_cli.cli.{name}" for name in ("check", "new", "schemes", "stages"))}
    assert names & imported("structure", str(SHAPER)) == {"tmm_cli.cli.stages"}
    slip = tmm("structre", SHAPER)
    assert slip.returncode == 2 and "Did you mean 'structure'?" in slip.stderr


def test_several_files_at_once_and_one_bad_among_them(tmp_path):
    bad = tmp_path / "bad.yaml"
    bad.write_text("tmm: 1\n", encoding="utf-8")
    good = [ROOT / "problems" / f"{name}.yaml" for name in ("sine", "slotted-lever")]
    done = tmm("run", good[0], bad, good[1], "-o", tmp_path / "out", "--no-drawings")
    assert done.returncode == 2
    assert "links: the key `links` is missing" in done.stderr
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"sine", "slotted-lever"}


def test_above_the_limit_of_the_lever_the_run_says_so_and_exits_1(tmp_path):
    problem = tmp_path / "strict.yaml"
    text = SHAPER.read_text(encoding="utf-8").replace("lever: 5 %", "lever: 1e-20 %")
    problem.write_text(text, encoding="utf-8")
    done = tmm("run", problem, "-o", tmp_path, "--no-drawings")
    assert done.returncode == 1
    assert re.search(
        r"the Zhukovsky lever differs from the force plan by .* % at position \d+; the limit is 1e-20 %", done.stderr
    )


def test_the_lever_of_every_problem_agrees_in_what_it_is_checked_against():
    for name in EVERY:
        file = ROOT / "problems" / f"{name}.yaml"
        assert "Property to see:" in file.read_text(encoding="utf-8")
        expected = json.loads((file.parent / "expected" / f"{file.stem}.json").read_text(encoding="utf-8"))
        assert max(d for d in expected["result"]["lever"]["difference"] if d is not None) < 1e-10, file


def test_problems_of_all_kinds_run_at_once(tmp_path):
    names = ("whitworth", "class-iv", "cam-lever", "cylinder", "planetary-dwell-press", "five-bar")
    files = (ROOT / "problems" / f"{name}.yaml" for name in names)
    done = tmm("run", *files, "-o", tmp_path, "--no-drawings")
    assert done.returncode == 0, done.stderr
    for name in names:
        result = json.loads((tmp_path / name / "result.json").read_text(encoding="utf-8"))
        assert max(d for d in result["lever"]["difference"] if d is not None) < 1e-10, name
        assert all(v == v for v in leaves(result) if isinstance(v, float))


def test_check_finds_what_differs_and_update_takes_it_over(tmp_path):
    text = SHAPER.read_text(encoding="utf-8")
    (tmp_path / "one.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "two.yaml").write_text(text, encoding="utf-8")
    assert tmm("check", tmp_path).returncode == 1  # nothing to compare with
    assert tmm("check", tmp_path, "--update").returncode == 0
    assert tmm("check", tmp_path).returncode == 0
    golden = tmp_path / "expected" / "one.json"
    record = json.loads(golden.read_text(encoding="utf-8"))
    del record["result"]["kinematics"]["links"]["2"]["epsilon"]
    golden.write_text(json.dumps(record), encoding="utf-8")
    done = tmm("check", tmp_path)
    assert done.returncode == 0
    new = (
        "note: one: new quantities, not compared: 1, e.g. kinematics.links.2.epsilon; `tmm check --update` records them"
    )
    assert new in done.stderr.splitlines()
    (tmp_path / "two.yaml").write_text(text.replace("DE: 210", "DE: 210.001"), encoding="utf-8")
    report = tmp_path / "report.xml"
    done = tmm("check", tmp_path, "--junit", report)
    assert done.returncode == 1
    assert "kinematics.points.E.x.x" in done.stdout
    assert "problems: 2, of which with differences: 1" in done.stderr
    suite = ElementTree.parse(report).getroot()
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("2", "1", "0")
    assert [len(case) for case in suite] == [0, 1]


def test_a_table_that_is_cut_advises_only_options_that_its_command_has():
    for advice, commands in ((MORE_ROWS, ("run", "structure", "forces")), (MORE_ROWS_AS_JSON, ("schemes",))):
        advised = set(re.findall(r"(?<=\s)-{1,2}\w+", advice))
        assert advised
        for command in commands:
            assert advised <= set(re.findall(r"(?<!\S)-{1,2}\w+", tmm(command, "--help").stdout))


def test_a_table_of_differences_that_is_cut_says_how_many_are_left_out():
    table = difference_table({"shaper": [ResultDifference(f"q{k}", None, 0.0, 1.0, 1.0) for k in range(MOST_ROWS + 7)]})
    console = Console(file=io.StringIO(), record=True)
    print_on_terminal(table, UnitSystem(), console, more="... further rows: {rows}")
    assert "... further rows: 7\n" in console.export_text()


def test_templates_run_as_they_are(tmp_path):
    listed = tmm("new").stdout.split("\n")
    names = [line.split()[0] for line in listed if line]
    assert names == ["crank-slider", "four-bar", "shaper", "sine", "slotted-lever", "tangent"]
    for name in names:
        assert tmm("new", name, cwd=tmp_path).returncode == 0
    done = tmm("run", *(f"{name}.yaml" for name in names), "--no-drawings", cwd=tmp_path)
    assert done.returncode == 0
    assert "warning" not in done.stderr and "error" not in done.stderr
    again = tmm("new", "sine", cwd=tmp_path)
    assert again.returncode == 2
    assert "error: sine.yaml already exists" in again.stderr
    assert "did you mean 'sine'?" in tmm("new", "sin").stderr


@pytest.mark.parametrize("language", ["ru", "sr"])
def test_templates_are_the_same_problems_in_every_language(language):
    used = set()
    for name, title in list_templates().items():
        english, other = (template_text(name, tongue) for tongue in ("en", language))
        data, translated = (yaml.safe_load(text) for text in (english, other))
        assert translated.pop("lang") == language
        assert translated["title"] == list_templates(language)[name] and data["title"] == title
        for problem in (data, translated):
            problem.pop("title")
            for link in problem["links"].values():
                link.pop("name", None)
        assert translated == data
        assert max(map(len, other.split("\n"))) <= 120
        plain = re.sub(r"\n *# ", " ", other)
        used |= {e["en"] for e in load_translations() if e[language].replace("{file}", f"{name}.yaml") in plain}
    assert used == {entry["en"] for entry in load_translations()}


def test_a_template_has_the_comments_of_the_language_and_the_name_of_its_file(tmp_path):
    listed = tmm("new", "--lang", "ru").stdout
    assert "shaper          Поперечно-строгальный станок\n" in listed
    made = tmm("new", "shaper", "--lang", "ru", "-o", "станок.yaml", cwd=tmp_path)
    assert made.returncode == 0 and "tmm run станок.yaml" in made.stderr
    text = (tmp_path / "станок.yaml").read_text("utf-8")
    assert text.startswith(
        "# Измените числа и запустите: tmm run станок.yaml (`tmm explain станок.yaml` покажет, как файл понят).\n"
        "# Строгальный станок: кривошип 1, камень 2, кулиса 3, шатун 4, ползун 5; центр масс ползуна не в шарнире E.\n"
        "tmm: 1                                   # версия формата, всегда 1\n"
        "lang: ru                                 # или en, sr: язык чертежей, таблиц и сообщений\n"
    )
    done = tmm("structure", "станок.yaml", cwd=tmp_path)
    assert done.returncode == 0 and "кулиса" in done.stdout and "предупреждение" not in done.stderr
    assert tmm("new", "sine", "-o", "-").stdout == template_text("sine")
    assert tmm("new", "sine", "-o", "my.yaml", cwd=tmp_path).returncode == 0
    assert "tmm run my.yaml (`tmm explain my.yaml`" in (tmp_path / "my.yaml").read_text("utf-8")


def test_schema_knows_every_key_of_the_problems():
    schema = json.loads(tmm("schema").stdout)
    planar = schema["else"]  # the rest are chains given by pairs alone
    assert {"tmm", "links", "driver"} <= set(planar["properties"])
    assert planar["additionalProperties"] is False


def test_explain_says_what_is_computed_by_which_group_and_what_is_skipped():
    told = tmm("explain", ROOT / "problems" / "crank-slider.yaml").stdout
    assert "II(2,3) RRP" in told
    assert "of the two, the one with the sign +1, as in the sketch" in told
    assert "inertia couples of links 3" in told


def test_a_spring_alone_is_no_mechanism_without_forces(tmp_path):
    file = tmp_path / "sprung.yaml"
    spring = "springs: {return: {between: [0, 3], at: [[300, 0], B], rate: 2 N/mm, free: 80}}\ngravity: 0\n"
    whole = (ROOT / "problems" / "crank-slider.yaml").read_text(encoding="utf-8")
    bare = re.sub(r"(?m)^(masses|loads):.*\n(?:[ ].*\n)*", "", whole)
    file.write_text(bare + "gravity: 0\n", encoding="utf-8")
    assert "all forces are zero" in tmm("explain", file).stdout
    file.write_text(bare + spring, encoding="utf-8")
    assert "all forces are zero" not in tmm("explain", file).stdout


def test_no_line_of_help_is_cut():
    for words, names in (((), COMMANDS), (("bench",), MEASUREMENTS)):
        told = tmm(*words, "--help").stdout
        assert re.findall(r"^  (\w+) {2,}\S", told.partition("Commands:")[2], re.M) == list(names)
        assert "..." not in told.partition("Commands:")[2]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_and_stands_in_the_documentation(command):
    done = tmm(command, "--help")
    assert done.returncode == 0 and len(done.stdout) > 100
    assert f"tmm {command}" in (ROOT / "problems" / "docs" / "COMMANDS.md").read_text(encoding="utf-8")


def test_a_narrow_terminal_breaks_tables_into_parts_and_no_number_is_cut():
    results = solved("shaper")
    for width in (60, 80, 120, 300):
        console = Console(width=width, record=True, file=io.StringIO(), highlight=False)
        for table in tables(results):
            print_on_terminal(table, results.problem.units, console, {0, 1} if table.long else None)
        text = console.export_text()
        assert "…" not in text
        assert all(len(line) <= width for line in text.splitlines())
        assert ("Cycle (continued)" in text) == (width < 120)


def test_zeros_of_a_golden_run_are_compared_with_the_largest_value_of_their_kind():
    """Each processor rounds a zero in its own way; what is larger than such rounding is a difference."""
    expected = {
        "links": {"2": {"second": [125.0, 3.0]}, "3": {"second": [0.0, -7e-14]}},
        "energy": {"inertia": [1410.0, 1410.0], "slope": [-3.8e-11, 0.0]},
    }
    found = json.loads(json.dumps(expected))
    found["links"]["3"]["second"] = [1e-12, 2e-13]
    found["energy"]["slope"] = [-5.5e-11, 1e-11]
    assert find_differences(expected, found, 1e-9) == []
    found["links"]["3"]["second"][0] = 1e-10
    found["energy"]["slope"][1] = 1e-8
    assert [one.quantity for one in find_differences(expected, found, 1e-9)] == ["links.3.second", "energy.slope"]
