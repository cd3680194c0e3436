"""`tmm grade` as a teacher runs it: what is written and said, exit codes, a run that is stopped."""

from __future__ import annotations

import csv
import signal

import pytest
from test_commands import after_the_echo, tmm
from test_grading_runs import ASKED, SINE, TABLE

from tmm_cli.grading import run

RIGHT = "quantity,position,value\nH,,{H}\nv of E,3,{v}\n"


@pytest.fixture
def course(tmp_path):
    """A folder with a task, variants of 12 students, and what 11 of them handed in."""
    (tmp_path / "task.yaml").write_text(SINE + ASKED, encoding="utf-8")
    rows = [["student", *TABLE.names], *([student, *row] for student, row in TABLE.rows.items())]
    (tmp_path / "variants.csv").write_text("".join(",".join(row) + "\n" for row in rows), encoding="utf-8")
    (tmp_path / "handed").mkdir()
    for student, (r,) in list(TABLE.rows.items())[:-1]:
        own = RIGHT.format(H=2 * float(r), v=0.011 * float(r))
        (tmp_path / "handed" / f"{student}.csv").write_text(own, encoding="utf-8")
    return tmp_path


def graded(course, *options):
    return tmm("grade", "task.yaml", "--variants", "variants.csv", "--submissions", "handed", *options, cwd=course)


def points(course):
    with (course / "marks" / "marks.csv").open(encoding="utf-8-sig", newline="") as stream:
        return {row[0]: row[1] for row in list(csv.reader(stream))[1:]}


def test_all_are_graded_and_all_is_written(course):
    done = graded(course)
    assert done.returncode == 0
    assert (
        after_the_echo(done.stderr)
        == "written: marks; students graded: 11, without an answer: 1, impossible to grade: 0\n"
    )
    assert set(points(course).values()) == {"2", "0"}
    assert {"marks.csv", "marks.xlsx", "moodle.csv", "junit.xml", "gradescope", "feedback", ".graded"} <= {
        path.name for path in (course / "marks").iterdir()
    }


def test_what_cannot_be_read_is_told_and_stops_nothing(course):
    (course / "handed" / "S3.csv").write_bytes(b"\0\1\2")
    (course / "handed" / "S6.csv").write_text("my answers", encoding="utf-8")
    (course / "handed" / "stranger.csv").write_text(RIGHT.format(H=180, v=1), encoding="utf-8")
    done = graded(course, "--formats", "csv")
    assert done.returncode == 1
    assert done.stderr.endswith("marks; students graded: 9, without an answer: 2, impossible to grade: 2\n")
    assert "this student has no variant" in done.stdout and "there are no answers in S6.csv" in done.stdout
    assert points(course)["S4"] == "2" and points(course)["S3"] == "0"
    assert {path.name for path in (course / "marks").iterdir()} == {".graded", "marks.csv", "answers.csv"}
    again = graded(course, "--formats", "csv")
    assert (again.returncode, again.stdout) == (1, done.stdout)


def test_a_second_run_grades_what_has_changed_alone(course, monkeypatch):
    given = []
    monkeypatch.setattr(run, "grade", lambda task, table, own, do=run.grade: given.extend(own) or do(task, table, own))
    first = graded(course, "--formats", "csv").stdout, points(course)
    assert len(given) == 12
    assert (graded(course, "--formats", "csv").stdout, points(course)) == first and len(given) == 12
    (course / "handed" / "S5.csv").write_text(RIGHT.format(H=1, v=1), encoding="utf-8")
    graded(course, "--formats", "csv")
    assert [one.student for one in given[12:]] == ["S5"] and points(course)["S5"] == "1"


def test_a_run_that_is_stopped_keeps_what_is_graded(course, monkeypatch):
    monkeypatch.setattr(run, "CHUNK", 5)
    monkeypatch.setattr(
        run, "append_marks", lambda *own, do=run.append_marks: do(*own) or signal.raise_signal(signal.SIGINT)
    )
    done = graded(course, "--jobs", 1)
    assert done.returncode == 1
    assert after_the_echo(done.stderr).splitlines() == [
        "stopping as soon as the submissions now being graded are finished",
        "stopped; submissions graded: 5 of 12; the next run keeps their marks and grades the others",
    ]
    assert not (course / "marks" / "marks.csv").exists()
    monkeypatch.undo()
    assert graded(course, "--formats", "csv").returncode == 0 and len(points(course)) == 12


def test_two_processes_write_the_same_files(course, monkeypatch):
    found = []
    for jobs in (1, 2):
        graded(course, "--formats", "csv,junit", "--jobs", jobs)
        files = [course / "marks" / name for name in ("marks.csv", "answers.csv", "junit.xml")]
        found.append([path.read_bytes() for path in files])
        for path in files:
            path.unlink()
        monkeypatch.setattr(run, "CHUNK", 6)  # of which the group has two; they are graded already
    assert found[0] == found[1]


def test_what_would_be_right_is_told_where_the_teacher_wants_it(course):
    (course / "handed" / "S5.csv").write_text(RIGHT.format(H=1, v=1), encoding="utf-8")
    told = []
    for options in ([], ["--reveal"]):
        graded(course, "--formats", "feedback", *options)
        told.append((course / "marks" / "feedback" / "S5.md").read_text(encoding="utf-8"))
    assert ["181 mm" in text for text in told] == [False, True]


@pytest.mark.parametrize("name", ["sheet.csv", "sheet.xlsx", "sheet.yaml"])
def test_an_empty_sheet_is_written_and_no_more(name, course):
    done = tmm("grade", "task.yaml", "--template", name, cwd=course)
    assert (done.returncode, done.stderr) == (0, f"written: {name}\n")
    assert (course / name).stat().st_size > 30 and not (course / "marks").exists()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--submissions", "handed"], "error: give --variants and --submissions, or --template\n"),
        (
            ["--variants", "variants.csv", "--submissions", "handed", "--formats", "csv,moodel"],
            (
                "error: --formats: there is no gradebook format of that name\n"
                "  found:   'moodel'\n"
                "  allowed: csv, xlsx, feedback, gradescope, moodle, junit, drawing, json\n"
                "  did you mean 'moodle'?\n"
            ),
        ),
        (
            ["--template", "sheet.odt"],
            (
                "error: an answer sheet cannot have this file extension\n"
                "  found:   '.odt'\n"
                "  allowed: .xlsx, .csv, .yaml\n"
            ),
        ),
    ],
)
def test_what_is_refused(options, told, course):
    done = tmm("grade", "task.yaml", *options, cwd=course)
    assert (done.returncode, done.stderr) == (2, told)
