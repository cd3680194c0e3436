"""Writing results: a folder is put in its place whole, a part of a run never takes the place of a whole one."""

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from test_commands import ROOT, after_the_echo, tmm

from tmm_cli.reports import (
    StagedFolder,
    choose_folder,
    folder_name,
    listed_files,
    recorded_part,
    result_files as files,
    write_atomically,
)

SHAPER = ROOT / "problems" / "shaper.yaml"
SINE = ROOT / "problems" / "sine.yaml"


def content(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def written(folder, texts):
    with StagedFolder(folder) as staged:
        for name, text in texts.items():
            staged.write(name, (text,))
    return staged


def record(*names, part=""):
    return json.dumps({**({"part": part} if part else {}), "files": list(names)})


def run_of(folder, *names, part=""):
    """A folder as a run of this part leaves it."""
    return written(folder, dict.fromkeys(names, "new") | {"result.json": record(*names, part=part)})


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (("run", "-p", 2, "--no-drawings"), "p2-no-drawings"),
        (("run", "--no-drawings"), "no-drawings"),
        (("forces",), "no-drawings"),
        (("kinematics", "--of", "A"), "kinematics-A"),
        (("structure",), "structure"),
    ],
)
def test_a_part_of_a_run_goes_beside_a_whole_one(options, part, tmp_path):
    whole = tmp_path / "sine"
    run_of(whole, "cycle.csv", "lever-03.png")
    before = content(whole)
    done = tmm(*options, SINE, "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    assert content(whole) == before
    assert (
        f"written: {tmp_path}/sine-{part}; the folder {whole} with the results of another run is unchanged\n"
        in done.stderr
    )
    assert json.loads((tmp_path / f"sine-{part}" / "result.json").read_text(encoding="utf-8"))["part"] == part


def test_where_there_is_no_other_result_a_part_has_the_usual_folder(tmp_path):
    assert choose_folder(tmp_path, "sine", "p2") == (tmp_path / "sine", None)
    run_of(tmp_path / "sine", "cycle.csv", part="p2")
    assert recorded_part(tmp_path / "sine") == "p2"
    assert choose_folder(tmp_path, "sine", "p2") == (tmp_path / "sine", None)
    assert choose_folder(tmp_path, "sine", "p3") == (tmp_path / "sine-p3", tmp_path / "sine")
    assert choose_folder(tmp_path, "sine", "") == (tmp_path / "sine", None)


def test_a_part_never_takes_the_place_of_a_problem_that_is_named_like_it(tmp_path):
    run_of(tmp_path / "sine", "cycle.csv")
    run_of(tmp_path / "sine-p2-no-drawings", "cycle.csv")
    done = tmm("run", SINE, "-p", 2, "--no-drawings", "-o", tmp_path)
    assert done.returncode == 2
    assert (
        after_the_echo(done.stderr)
        == f"error: {tmp_path}/sine-p2-no-drawings: the folder contains the results of another run\n"
    )


def test_what_a_whole_run_removes_is_said(tmp_path):
    run_of(tmp_path / "sine", "cycle.csv", "old.csv", "lever-11.png", part="no-drawings")
    done = tmm("run", SINE, "--no-drawings", "-o", tmp_path)
    folder = tmp_path / "sine"
    removed = f"{folder}: lever-11.png, old.csv (files of an earlier run that this run does not write)\n"
    assert removed in done.stderr
    assert not (folder / "old.csv").exists()


def test_drawings_of_the_structure_alone_do_not_take_the_place_of_those_of_a_run(tmp_path):
    run_of(tmp_path / "outputs" / "sine", "structure.png")
    done = tmm("structure", SINE, "--drawings", cwd=tmp_path)
    own, usual = Path("outputs") / "sine-drawings", Path("outputs") / "sine"
    assert f"written: {own}; the folder {usual} with the results of another run is unchanged\n" in done.stderr
    assert (tmp_path / usual / "structure.png").read_bytes() == b"new"
    assert (tmp_path / own / "structure.png").read_bytes().startswith(b"\x89PNG")


def test_files_of_the_users_own_stay_in_a_folder_that_is_written_anew(tmp_path):
    folder = tmp_path / "out"
    run_of(folder, "a.csv", "b.csv")
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    (folder / "photos").mkdir()
    (folder / "photos" / "one.png").write_bytes(b"mine")
    assert run_of(folder, "b.csv", "c.csv").removed == ["a.csv"]
    assert sorted(os.listdir(folder)) == ["b.csv", "c.csv", "notes.txt", "photos", "result.json"]
    assert (folder / "photos" / "one.png").read_bytes() == b"mine"
    assert os.listdir(tmp_path) == ["out"]


@pytest.mark.parametrize("refused", [1, 2])
def test_when_a_rename_fails_the_old_results_stay_whole(refused, tmp_path, monkeypatch):
    """As on Windows, where a folder with an open file cannot be renamed."""
    folder = tmp_path / "out"
    run_of(folder, "a.csv")
    before, rename, calls = content(folder), os.rename, []

    def failing(source, target):
        calls.append(source)
        if len(calls) == refused:
            raise PermissionError(errno.EACCES, "open elsewhere", str(source))
        rename(source, target)

    monkeypatch.setattr(files.os, "rename", failing)
    with pytest.raises(PermissionError):
        run_of(folder, "b.csv")
    assert content(folder) == before
    assert os.listdir(tmp_path) == ["out"]


def test_results_that_another_program_holds_are_one_error(tmp_path, monkeypatch):
    """As on Windows, where a table is open in a spreadsheet."""
    run_of(tmp_path / "sine", "cycle.csv", part="no-drawings")
    before = content(tmp_path / "sine")

    def refused(source, target):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(source), None, str(target))

    for name in ("rename", "replace"):
        monkeypatch.setattr(files.os, name, refused)
    done = tmm("run", SINE, "--no-drawings", "-o", tmp_path)
    assert done.returncode == 2
    assert after_the_echo(done.stderr) == f"error: {tmp_path / 'sine'}: Permission denied\n"
    assert content(tmp_path / "sine") == before and os.listdir(tmp_path) == ["sine"]


def test_a_directory_in_the_place_of_a_table_is_an_error_and_nothing_changes(tmp_path):
    folder = tmp_path / "sine"
    run_of(folder, "old.csv")
    (folder / "cycle.csv").mkdir()
    before = content(folder)
    done = tmm("run", SINE, "--no-drawings", "-o", tmp_path)
    beside = tmp_path / "sine-no-drawings"
    assert done.returncode == 0 and content(folder) == before
    (beside / "cycle.csv").unlink()
    (beside / "cycle.csv").mkdir()
    done = tmm("run", SINE, "--no-drawings", "-o", tmp_path)
    assert done.returncode == 2
    assert after_the_echo(done.stderr) == f"error: {beside / 'cycle.csv'}: Is a directory\n"
    assert sorted(os.listdir(tmp_path)) == ["sine", "sine-no-drawings"]


def gone():
    """The number of a process that is no more."""
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    return ended.pid


def test_what_a_killed_run_left_is_removed_by_the_next(tmp_path):
    folder, number = tmp_path / "out", gone()
    run_of(folder, "a.csv")
    run_of(tmp_path / f".out.new-{number}", "half.csv")
    run_of(folder, "a.csv")
    assert os.listdir(tmp_path) == ["out"]
    (tmp_path / f".one.json.new-{number}").write_bytes(b"half")
    write_atomically(tmp_path / "one.json", b"{}")
    assert sorted(os.listdir(tmp_path)) == ["one.json", "out"]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no devices among files")
def test_a_device_is_not_replaced_by_a_file(tmp_path):
    os.mkfifo(tmp_path / "device")
    (tmp_path / "one.json").symlink_to("device")
    with pytest.raises(FileExistsError, match="this is a device, not a file"):
        write_atomically(tmp_path / "one.json", b"{}")
    assert (tmp_path / "device").is_fifo()


def test_what_a_run_still_writes_is_left_alone(tmp_path):
    other = tmp_path / f".out.new-{os.getppid()}"
    run_of(other, "a.csv")
    run_of(tmp_path / "out", "a.csv")
    assert (other / "a.csv").exists()


def test_a_run_killed_between_the_two_renames_loses_nothing(tmp_path):
    folder, number = tmp_path / "out", gone()
    run_of(tmp_path / f".out.old-{number}", "a.csv", "old.csv")
    (tmp_path / f".out.old-{number}" / "notes.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(ZeroDivisionError), StagedFolder(folder):
        1 / 0  # noqa: B018
    assert sorted(os.listdir(folder)) == ["a.csv", "notes.txt", "old.csv", "result.json"]


def test_a_run_killed_after_them_leaves_the_users_files_for_the_next_to_bring_back(tmp_path):
    folder, number = tmp_path / "out", gone()
    run_of(tmp_path / f".out.old-{number}", "a.csv", "old.csv")
    (tmp_path / f".out.old-{number}" / "notes.txt").write_text("mine", encoding="utf-8")
    run_of(folder, "a.csv")
    run_of(folder, "a.csv")
    assert sorted(os.listdir(folder)) == ["a.csv", "notes.txt", "result.json"]
    assert os.listdir(tmp_path) == ["out"]


def test_a_run_that_is_killed_while_it_writes_leaves_the_old_results_and_the_next_one_cleans(tmp_path):
    assert tmm("run", SINE, "--no-drawings", "-o", tmp_path).returncode == 0
    before = content(tmp_path / "sine")
    code = (
        "import os, sys\n"
        "from tmm_cli.reports.result_files import StagedFolder\n"
        "with StagedFolder(sys.argv[1]) as staged:\n"
        "    staged.write('cycle.csv', ('half',))\n"
        "    print('now', flush=True)\n"
        "    sys.stdin.read()\n"
    )
    writer = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "sine")], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT
    )
    assert writer.stdout.readline()
    writer.kill()
    writer.communicate()
    assert content(tmp_path / "sine") == before and len(os.listdir(tmp_path)) == 2
    assert tmm("run", SINE, "--no-drawings", "-o", tmp_path).returncode == 0
    assert content(tmp_path / "sine") == before and os.listdir(tmp_path) == ["sine"]


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("CON", "_CON"),
        ("aux", "_aux"),
        ("nul.v2", "_nul.v2"),
        ("com1", "_com1"),
        ("LPT9", "_LPT9"),
        ("task...", "task"),
        ("task ", "task_"),
        ("..", "problem"),
        ("a/b\\c:d", "a_b_c_d"),
        ("console", "console"),
        ("кривошип", "кривошип"),
        ("x" * 400, "x" * 150),
    ],
)
def test_a_folder_has_a_name_that_every_system_takes(name, safe):
    assert folder_name(name) == safe


def test_only_names_of_files_are_taken_from_a_record(tmp_path):
    (tmp_path / "result.json").write_text('{"files": ["a.csv", "../b.csv", "notes.txt", 3]}', encoding="utf-8")
    assert listed_files(tmp_path) == {"a.csv"}
    (tmp_path / "result.json").write_text('{"files": [' + "[" * 90_000, encoding="utf-8")
    assert listed_files(tmp_path) == set()


@pytest.mark.parametrize(
    "command",
    [
        ("sweep", SHAPER, "--over", "OA=80..120:3"),
        ("synthesis", SHAPER),
        ("run", SHAPER),
        ("gallery", SHAPER),
        ("animate", SHAPER),
        ("variants", ROOT / "problems" / "grading" / "shaper" / "task.yaml"),
    ],
)
def test_a_place_that_cannot_be_written_is_refused_before_the_work(command, tmp_path):
    (tmp_path / "taken").write_text("mine", encoding="utf-8")
    done = tmm(*command, "-o", tmp_path / "taken" / "x.html")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"error: {tmp_path}/taken: Not a directory\n"
    assert content(tmp_path) == {"taken": b"mine"}
