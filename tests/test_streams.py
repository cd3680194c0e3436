"""Streams and files that fail the commands: closed, full, broken off, in another encoding; interruptions."""

import os
import re
import shutil
import subprocess
import sys
from functools import partial

import pytest
from test_commands import ROOT, after_the_echo, tmm

from tmm_cli.batch import in_processes
from tmm_cli.cli import report_fault
from tmm_cli.mechanics.quantities import NUMBER, product_text
from tmm_cli.problem import UnitSystem, build_any_problem
from tmm_cli.reports import Column, Table, csv_text, text_table

SINE = ROOT / "problems" / "sine.yaml"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "NO_COLOR": "1"}
posix = pytest.mark.skipif(os.name == "nt", reason="a shell of POSIX")


def shell(line, cwd=ROOT, **environment):
    """A line of a shell in which `tmm` is the command."""
    line = line.replace("tmm ", f"{sys.executable} -m tmm_cli ")
    return subprocess.run(
        ["/bin/sh", "-c", line], capture_output=True, cwd=cwd, env={**ENVIRONMENT, **environment}, check=False
    )


@posix
@pytest.mark.parametrize("command", [f"forces {SINE} --json", "--help", "check problems/x"])
def test_a_reader_that_leaves_is_no_error(command):
    done = shell(f"(tmm {command}; echo code $? >&2) | true")
    said = done.stderr.decode()
    assert "Traceback" not in said and "Broken" not in said
    assert said.endswith("code 0\n") or command.startswith("check")


@posix
@pytest.mark.parametrize("command", [f"structure {SINE}", "schema"])
def test_a_full_disk_is_one_error(command):
    done = shell(f"tmm {command} > /dev/full")
    assert done.returncode == 2
    assert done.stderr.decode().splitlines()[-1] == "error: output: No space left on device"
    assert "Traceback" not in done.stderr.decode()


@posix
@pytest.mark.parametrize("closed", [">&- 2>&-", "<&-"])
def test_a_closed_stream_swallows_what_is_printed(closed, tmp_path):
    done = shell(f"tmm run {SINE} --no-drawings -o {tmp_path} {closed}")
    assert done.returncode == 0 and b"Traceback" not in done.stderr + done.stdout
    assert (tmp_path / "sine" / "result.json").exists()


@pytest.mark.parametrize(("encoding", "command"), [("cp1251", "explain"), ("ascii", "forces")])
def test_a_console_that_lacks_characters_shows_question_marks(encoding, command, tmp_path):
    file = tmp_path / "задача.yaml"
    text = SINE.read_text(encoding="utf-8")
    file.write_text(text.replace("title: ", "title: ω̇ 摇 Кулиса ", 1), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "tmm_cli", command, str(file)],
        capture_output=True,
        env={**ENVIRONMENT, "PYTHONIOENCODING": encoding},
        cwd=tmp_path,
        check=False,
    )
    assert done.returncode == 0 and b"Traceback" not in done.stderr
    assert "phi" in done.stdout.decode(encoding) or "crank" in done.stdout.decode(encoding)
    assert encoding == "ascii" or command == "forces" or "Кулиса" in done.stdout.decode(encoding)


@posix
def test_a_file_whose_name_is_not_utf_8_is_worked_on_like_any(tmp_path):
    name = os.path.join(os.fsencode(tmp_path), b"\xea\xf3\xeb.yaml")
    shutil.copy(SINE, name)
    for command in (["run", "--no-drawings", "-o", str(tmp_path)], ["check"]):
        done = subprocess.run(
            [sys.executable, "-m", "tmm_cli", command[0], name, *command[1:]],
            capture_output=True,
            env=ENVIRONMENT,
            cwd=ROOT,
            check=False,
        )
        assert b"Traceback" not in done.stderr, done.stderr
        assert done.returncode == (1 if command == ["check"] else 0)


def interrupted(where):
    """The command, interrupted when it imports this module."""
    code = (
        "import sys, runpy\n"
        "class Interrupt:\n"
        "    def find_spec(self, name, path, target=None):\n"
        f"        if name == {where!r}: raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Interrupt())\n"
        f"sys.argv = ['tmm', 'run', {str(SINE)!r}]\n"
        "runpy.run_module('tmm_cli', run_name='__main__')\n"
    )
    return subprocess.run([sys.executable, "-c", code], capture_output=True, env=ENVIRONMENT, cwd=ROOT, check=False)


@pytest.mark.parametrize("where", ["tmm_cli.mechanics.errors", "tmm_cli.cli", "typer", "numpy"])
def test_ctrl_c_at_any_time_ends_with_130_and_no_word(where):
    done = interrupted(where)
    assert (done.returncode, done.stderr) == (130, b"")


def test_check_names_what_cannot_be_written(tmp_path):
    shutil.copy(SINE, tmp_path)
    (tmp_path / "expected").write_text("a file", encoding="utf-8")
    done = tmm("check", tmp_path, "--update")
    assert done.returncode == 2
    assert (
        done.stderr == f"error: sine: {tmp_path / 'expected'}: File exists\nproblems: 1, of which with differences: 1\n"
    )
    done = tmm("check", tmp_path, "--junit", tmp_path)
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1] == f"error: {tmp_path}: Is a directory"
    done = tmm("check", SINE, "--junit", tmp_path)  # its expected values are there, and met
    assert (done.returncode, done.stderr) == (2, f"error: {tmp_path}: Is a directory\n")


def test_expected_values_nested_without_end_are_none(tmp_path):
    shutil.copy(SINE, tmp_path)
    (tmp_path / "expected").mkdir()
    (tmp_path / "expected" / "sine.json").write_text("[" * 100_000, encoding="utf-8")
    done = tmm("check", tmp_path)
    assert done.returncode == 1
    wrong = "this is not a file of expected values (its brackets are nested too deeply)"
    assert (
        done.stderr
        == f"error: sine: {tmp_path / 'expected' / 'sine.json'}: {wrong}\nproblems: 1, of which with differences: 1\n"
    )


@pytest.mark.parametrize(
    ("word", "cell"),
    [
        ("a;b", '"a;b"'),
        ("a;=cmd()", '"a;\'=cmd()"'),
        ("a\t@sum", '"a\t\'@sum"'),
        ("a, +b", '"a,\' +b"'),
        ("x|-y()", '"x|\'-y()"'),
        ("=1", "'=1"),
        (" =1", "' =1"),
        ("1; -2,5", '"1; -2,5"'),
        ("-1.5e-3", "-1.5e-3"),
        ("nan", '"nan"'),
        ("Inf", '"Inf"'),
        ("link 2", "link 2"),
        ('a"b', '"a""b"'),
        ("\tx", '"\'\tx"'),
    ],
)
def test_no_cell_breaks_or_runs_in_any_locale(word, cell):
    table = text_table("t", "", ("header",), [(word,)])
    assert "".join(csv_text(table, UnitSystem())) == f"header\n{cell}\n"


def test_names_of_links_reach_the_table_defused(tmp_path):
    text = SINE.read_text(encoding="utf-8")
    for name, hostile in (("crank", "=cmd|calc"), ("stone", "nan"), ("slider with a slot", "a;-b")):
        text = text.replace(f"name: {name},", f'name: "{hostile}",')
    (tmp_path / "x.yaml").write_text(text, encoding="utf-8")
    assert tmm("structure", tmp_path / "x.yaml", "-o", tmp_path).returncode == 0
    lines = (tmp_path / "x" / "links.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1:] == [
        '1,crank,"\'=cmd|calc","O, A",turns about O',
        '2,stone,"nan",A,translation',
        '3,slider,"a;\'-b",E,slides along guide x',
    ]


def test_what_is_no_number_has_an_empty_cell():
    values = [1.0, float("nan"), float("inf"), None]
    for bound in (None, [1e-9] * 4, [float("nan")] * 4):
        table = Table("t", "", (Column("header", values, NUMBER, bound=bound),))
        lines = "".join(csv_text(table, UnitSystem())).splitlines()
        assert lines[2:] == ["", "", ""]


def test_characters_that_the_font_lacks_are_one_note(tmp_path):
    file = tmp_path / "sine.yaml"
    file.write_text(SINE.read_text(encoding="utf-8").replace("title: ", "title: 摇杆 ", 1), encoding="utf-8")
    done = tmm("structure", file, "--drawings", "-o", tmp_path)
    note = "note: the font of the drawings lacks these characters, which are drawn as boxes: 摇 杆\n"
    assert done.returncode == 0
    assert after_the_echo(done.stderr) == f"{note}written: {tmp_path / 'sine'}\n"


SHAPER_FILE = ROOT / "problems" / "shaper.yaml"
NAMED = [
    "run",
    "structure",
    "kinematics",
    "forces",
    "dynamics",
    "explain",
    "check",
    "note",
    "sheets",
    "animate",
    "gallery",
    "synthesis",
    "import",
    "export",
]


@pytest.mark.parametrize("command", NAMED)
def test_control_characters_of_a_name_do_not_reach_the_terminal(command, tmp_path):
    name = "a\x1b]0;mine\x07\x1b[31mred\r\x9b2J\u202e.yaml"
    (tmp_path / name).write_text(SINE.read_text(encoding="utf-8"), encoding="utf-8")
    further = ["--to", "pylinkage"] if command == "export" else []
    done = tmm(command, name, *further, cwd=tmp_path)
    assert done.stdout + done.stderr
    assert not set("\x1b\x07\r\x9b\u202e") & set(done.stdout + done.stderr)
    several = tmm("structure", name, name, cwd=tmp_path)  # whose tables come under their names
    assert several.returncode == 0 and not set("\x1b\x07\r\x9b\u202e") & set(several.stdout + several.stderr)


def test_a_line_break_in_a_name_makes_no_line_of_its_own(tmp_path):
    name = "a\nerror: all is lost.yaml"
    (tmp_path / name).write_text(SINE.read_text(encoding="utf-8"), encoding="utf-8")
    for words in (("structure", name), ("run", name, "--no-drawings", "-o", "o\nut"), ("run", "none\n.yaml")):
        done = tmm(*words, cwd=tmp_path)
        assert all(not line.startswith(("error: all", "ut", ".yaml")) for line in done.stderr.splitlines())


WITH_PLACES = [
    ("run", "f"),
    ("structure", "f"),
    ("kinematics", "f"),
    ("forces", "f"),
    ("dynamics", "f"),
    ("note", "f"),
    ("sheets", "f"),
    ("animate", "f"),
    ("gallery", "f"),
    ("synthesis", "f"),
    ("import", "f"),
    ("export", "f", "--to", "pylinkage"),
    ("new", "shaper"),
    ("sweep", "f", "--over", "r=20..80:4"),
    ("schemes", "--links", "4"),
    ("grade", "f", "--variants", "v", "--submissions", "s"),
    ("variants", "f", "--count", "3"),
]


@pytest.mark.parametrize("words", WITH_PLACES, ids=lambda words: words[0])
def test_an_address_of_a_network_is_no_place_of_results(words, tmp_path):
    for address in ("s3://bucket/results", "file:///results", "https://host/x"):
        done = tmm(*words, "-o", address, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        said = address.replace(":///", "://")
        assert done.stderr == (f"error: {said} is a network address; specify a local folder or file for the results\n")
    assert not list(tmp_path.iterdir())


def test_an_internal_fault_is_one_line_with_what_to_report_and_has_an_exit_code_of_its_own(monkeypatch):
    def broken(tree):
        return 1 / 0

    monkeypatch.setattr("tmm_cli.cli.opening.build_any_problem", broken)
    done = tmm("forces", SINE)
    assert done.returncode == 3 and done.stdout == ""
    assert re.fullmatch(
        r"internal error: ZeroDivisionError at tmm_cli/cli/opening\.py:\d+ \(tmm 0\.1\.0, command forces\): "
        r"please report this line and send the problem file; with TMM_TRACEBACK=1 the traceback is printed\n",
        done.stderr,
    )
    monkeypatch.setenv("TMM_TRACEBACK", "1")
    told = tmm("forces", SINE).stderr
    assert told.startswith("Traceback (most recent call last):") and told.endswith(done.stderr)


def test_a_fault_in_another_process_is_placed_where_it_was_raised(capsys):
    try:
        list(in_processes(2)([partial(product_text, 3)] * 2, lambda: False))
    except Exception as error:
        assert report_fault(error, ["grade"]) == 3
    assert re.match(
        r"internal error: AttributeError at tmm_cli/mechanics/quantities\.py:\d+ \(", capsys.readouterr().err
    )


def test_a_fault_of_one_file_does_not_keep_the_others_from_being_worked_on(monkeypatch):
    def broken(tree, sound=build_any_problem):
        return sound(tree) if tree.name == "shaper" else 1 / 0

    monkeypatch.setattr("tmm_cli.cli.opening.build_any_problem", broken)
    done = tmm("forces", SINE, SHAPER_FILE)
    assert done.returncode == 3 and done.stderr.count("internal error") == 1
    assert f"== {SHAPER_FILE} ==" in done.stdout and "M_b" in done.stdout


def test_want_of_memory_is_one_line(monkeypatch):
    def greedy(tree):
        raise MemoryError

    monkeypatch.setattr("tmm_cli.cli.opening.build_any_problem", greedy)
    done = tmm("forces", SINE)
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == "error: not enough memory; reduce the number of positions, variants or drawings\n"


def test_a_wrong_backend_of_matplotlib_does_not_matter(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "tmm_cli", "run", str(SINE), "-o", str(tmp_path)],
        capture_output=True,
        encoding="utf-8",
        env={**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "nonsense"},
    )
    assert done.returncode == 0, done.stderr
