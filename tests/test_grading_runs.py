"""A group is graded alike by one process, by several and by a cluster; what is graded is kept, and not graded again."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import replace

import pytest
from test_commands import ROOT

from tmm_cli.batch import in_processes, on_cluster, read_task, run_here, workers
from tmm_cli.grading import (
    Mark,
    ReadAnswer,
    StudentMarks,
    Submission,
    VariantTable,
    append_marks,
    grade_group,
    read_saved_marks,
    run,
)
from tmm_cli.problem import ProblemError, read_text

SINE = (ROOT / "problems" / "sine.yaml").read_text(encoding="utf-8")
ASKED = "\ngrading: {answers: [{of: H}, {of: v of E, at: 3}]}\n"
TABLE = VariantTable(("r",), {f"S{n}": (f"{90 + n / 10}",) for n in range(12)})
GIVEN = {("H", None): ReadAnswer(180.0), ("v of E", 3): ReadAnswer(0.99)}
GROUP = [Submission(student, GIVEN) for student in TABLE.rows]


def task(asked=ASKED):
    return read_task(read_text(SINE + asked, "task.yaml"))


@pytest.fixture
def small(monkeypatch):
    monkeypatch.setattr(run, "CHUNK", 4)


def counted(done):
    """The way of this process, and how many students it was given."""

    def way(jobs, stopped):
        for number, marks in run_here(jobs, stopped):
            done.append(len(marks))
            yield number, marks

    return way


def test_a_second_run_grades_only_what_has_changed(small, tmp_path):
    kept, done, seen = tmp_path / "marks" / ".graded", [], []
    first = grade_group(task(), TABLE, GROUP, counted(done), kept)
    assert done == [4, 4, 4]
    assert repr(grade_group(task(), TABLE, GROUP, counted(done), kept, seen.append)) == repr(first)
    assert done == [4, 4, 4] and seen == [12]
    changed = [*GROUP[:5], replace(GROUP[5], answers={}), *GROUP[6:]]
    moved = replace(TABLE, rows=TABLE.rows | {"S7": ("92",)})
    second = grade_group(task(), moved, changed, counted(done), kept)
    assert done == [4, 4, 4, 2] and second[6] == first[6] and {m.state for m in second[5].marks} == {"missing"}


FORMS = [
    Mark(("H", None), "missing", 0.0, 1.0),
    Mark(("H", None), "right", 1.0, 1.0, 0.0, 0.18, allowed=0.02),  # a real answer that is zero
    Mark(
        ("v of E", 3), "wrong", 0.0, 2.5, 1.5 - 2j, -1e-320 + 3e307j, True, 7.0, 0.5, 0.02, "mm/s", ("Why.",), ("sign",)
    ),
    Mark(("v of E", 0), "follows", 1 / 3, 1.0, complex("nan"), complex("inf"), text="Ω = \ud800 \n 1,5"),
]


@pytest.mark.parametrize("mark", FORMS, ids=lambda mark: mark.state)
def test_marks_of_every_form_come_back_as_they_were_kept(mark, tmp_path):
    marks = {
        "key": StudentMarks("Ана", (mark, mark), ("this student has no variant",)),
        "none": StudentMarks("", ()),
    }
    append_marks(tmp_path / ".graded", marks)
    again = read_saved_marks(tmp_path / ".graded", {"key", "none"})
    assert repr(again) == repr(marks).replace("value=0.0", "value=0j").replace("right=0.18", "right=(0.18+0j)")


@pytest.mark.parametrize(
    "submission",
    [
        Submission("nobody"),
        Submission("nobody", GIVEN),
        Submission("S1", problems=("broken",), unread=True),
        Submission("S2", GIVEN | {("v of E", 99): ReadAnswer(1.0)}),
        Submission("S3", {("H", None): ReadAnswer(0.0)}),
        Submission("S4", {("v of E", 3): ReadAnswer(1.0, 2.0, "polar", "m/s", "deg", "1 at 2")}),
    ],
    ids=lambda one: one.student,
)
def test_marks_of_every_kind_of_submission_are_the_same_in_a_second_run(submission, tmp_path):
    first, again = (grade_group(task(), TABLE, [submission], run_here, tmp_path / ".graded") for __ in range(2))
    assert repr(again) == repr(first) == repr(grade_group(task(), TABLE, [submission]))


def test_a_task_that_has_changed_is_graded_anew(tmp_path):
    done = []
    for one in (task(), task(ASKED.replace("{of: H}", "{of: H, points: 2}"))):
        grade_group(one, TABLE, GROUP, counted(done), tmp_path / ".graded")
    assert done == [12, 12]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: text[: len(text) // 2],
        lambda text: text.replace(b'"right"', b'"wrong"'),
        lambda text: os.urandom(1000),
        lambda text: b"{" * 10_000,
    ],
    ids=["torn", "changed", "noise", "nested"],
)
def test_what_is_damaged_of_the_kept_marks_is_graded_again(spoil, tmp_path):
    kept, done = tmp_path / ".graded", []
    first = grade_group(task(), TABLE, GROUP, run_here, kept)
    kept.write_bytes(spoil(kept.read_bytes()))
    assert repr(grade_group(task(), TABLE, GROUP, counted(done), kept)) == repr(first)
    assert sum(done) > 0
    assert repr(grade_group(task(), TABLE, GROUP, counted(done := []), kept)) == repr(first) and not done


@pytest.mark.parametrize("way", [run_here, in_processes(2)], ids=["here", "processes"])
def test_what_is_graded_before_a_stop_is_kept_and_the_gradebook_is_the_same_to_the_last_bit(way, small, tmp_path):
    kept, seen, done = tmp_path / ".graded", [], []
    part = grade_group(task(), TABLE, GROUP, way, kept, seen.append, lambda: any(seen))
    assert 4 <= len(part) == sum(seen)
    whole = grade_group(task(), TABLE, GROUP, counted(done), kept)
    assert sum(done) == 12 - sum(seen)
    assert repr(whole) == repr(grade_group(task(), TABLE, GROUP))


def test_what_fails_is_told_of_its_student_and_stops_nothing():
    table = replace(TABLE, rows=TABLE.rows | {"S3": ("90 N",), "S4": ("four",)})
    marks = grade_group(task(), table, [*GROUP, Submission("nobody")])
    told = {one.student: one.problems[0] for one in marks if one.problems}
    assert told == {
        "S3": (
            "the answers could not be graded: task.yaml:16:44: links.1.length: expected here: a length; found: "
            "  'r', a force (90 N); allowed: a length, e.g. 110 mm or 0.11 m"
        ),
        "S4": "the answers could not be graded: there is no such parameter; found:   'four'; allowed: none is given",
        "nobody": "this student has no variant",
    }
    assert [one.student for one in marks] == [*TABLE.rows, "nobody"]


def test_a_table_of_other_parameters_is_refused_before_the_work():
    with pytest.raises(ProblemError, match="no parameter has this name"):
        grade_group(task(), replace(TABLE, names=("R",)), GROUP)


def test_no_scheduler_is_one_line(monkeypatch):
    monkeypatch.setattr(workers, "ANSWER_TIMEOUT", 0.2)
    with pytest.raises(ProblemError, match="no Dask scheduler answers at this address"):
        grade_group(task(), TABLE, GROUP, on_cluster("tcp://127.0.0.1:9"))


@pytest.mark.parametrize(
    "address", ["tls://127.0.0.1:9", "nonsense", "http://", "tcp://", "x://y:z", "", "tcp://a b:1"]
)
def test_an_address_that_is_none_is_one_line(address):
    pytest.importorskip("distributed")
    with pytest.raises(ProblemError) as refused:
        grade_group(task(), TABLE, GROUP, on_cluster(address))
    told = f"this is not a valid address of a Dask scheduler\n  found:   '{address}'\n  allowed: tcp://host:8786"
    assert str(refused.value) == told


def test_a_server_that_says_nothing_is_one_line(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(workers, "ANSWER_TIMEOUT", 0.2)
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        pytest.raises(ProblemError, match="no Dask scheduler answers"),
    ):
        grade_group(task(), TABLE, GROUP, on_cluster(f"127.0.0.1:{server.getsockname()[1]}"))


def started(tmp_path, kind, *options, path=ROOT):
    """A process of Dask. path: where it finds the program."""
    note = tmp_path / "scheduler.json"
    call = [sys.executable, "-m", "distributed.cli.dask_" + kind, "--no-dashboard", "--scheduler-file", str(note)]
    return subprocess.Popen(
        [*call, *options], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(path)}, stderr=subprocess.DEVNULL
    )


def address_of(tmp_path):
    """The address of the scheduler that was started."""
    note = tmp_path / "scheduler.json"
    while True:
        with suppress(FileNotFoundError, json.JSONDecodeError):  # not there, or not whole yet
            return json.loads(note.read_text(encoding="utf-8"))["address"]
        time.sleep(0.05)


def test_a_scheduler_without_workers_and_a_worker_with_another_program_are_one_line(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    processes_of_dask = [started(tmp_path, "scheduler", "--host", "127.0.0.1", "--port", "0")]
    try:
        address = address_of(tmp_path)
        monkeypatch.setattr(workers, "ANSWER_TIMEOUT", 0.5)
        with pytest.raises(ProblemError, match="the Dask scheduler has no workers") as refused:
            grade_group(task(), TABLE, GROUP, on_cluster(address))
        assert refused.value.allowed == f"dask worker {address}"
        monkeypatch.setattr(workers, "ANSWER_TIMEOUT", 60)
        (tmp_path / "old" / "tmm_cli").mkdir(parents=True)
        (tmp_path / "old" / "tmm_cli" / "__init__.py").write_text('__version__ = "0.0.1"\n', encoding="utf-8")
        worker = started(tmp_path, "worker", "--no-nanny", "--nthreads", "1", path=tmp_path / "old")
        processes_of_dask.append(worker)
        with pytest.raises(ProblemError, match="a worker of the cluster has a different version of tmm"):
            grade_group(task(), TABLE, GROUP, on_cluster(address))
    finally:
        for process in processes_of_dask:
            process.kill()
            process.wait()


def test_a_job_that_reaches_a_worker_with_another_program_is_not_done():
    with pytest.raises(ProblemError, match="a different version of tmm"):
        workers._run_with_same_program("another", "en", lambda: 1)
    assert workers._run_with_same_program(workers.program_digest(), "en", lambda: 1) == 1


@pytest.fixture
def dask(tmp_path):
    """The address of a scheduler, and its two workers as processes."""
    distributed = pytest.importorskip("distributed")
    # they wait for the scheduler
    workers = [started(tmp_path, "worker", "--no-nanny", "--nthreads", "1") for _ in range(2)]
    every = [started(tmp_path, "scheduler", "--host", "127.0.0.1", "--port", "0"), *workers]
    try:
        address = address_of(tmp_path)
        with distributed.Client(address, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
        yield address, workers
    finally:
        for one in every:
            one.kill()
            one.wait()


def test_a_cluster_that_loses_a_worker_on_the_way_gives_the_same_gradebook(dask, monkeypatch):
    monkeypatch.setattr(run, "CHUNK", 1)
    address, workers = dask
    seen = []

    def lose(count):
        seen.append(count)
        if sum(seen) == 2:
            workers[0].kill()

    assert repr(grade_group(task(), TABLE, GROUP, on_cluster(address), None, lose)) == repr(
        grade_group(task(), TABLE, GROUP)
    )
    assert seen == [0, *[1] * 12]


def test_a_cluster_that_loses_all_its_workers_is_one_line(dask, monkeypatch):
    monkeypatch.setattr(run, "CHUNK", 1)
    address, processes_of_dask = dask

    def lose(count):
        if count:
            monkeypatch.setattr(workers, "ANSWER_TIMEOUT", 2)
            for one in processes_of_dask:
                one.kill()

    with pytest.raises(ProblemError, match="the Dask scheduler has no workers"):
        grade_group(task(), TABLE, GROUP, on_cluster(address), None, lose)
