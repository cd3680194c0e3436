"""What grading writes: the same marks in every format, whatever stands in names and answers."""

import csv
import io
import json
import os
import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from python_calamine import CalamineWorkbook
from rich.console import Console
from test_commands import SHAPER

from tmm_cli.batch import read_task
from tmm_cli.grading import (
    ANSWERS_HEADER,
    EXPORTS,
    Gradebook,
    Mark,
    StudentMarks,
    count_by_points,
    direction,
    draw_group_chart,
    exports,
    points_text,
    printable_text,
    rank_difficulties,
    rank_mistakes,
    share_text,
    statistics_tables,
    write_formats,
)
from tmm_cli.grading.exports import xlsx
from tmm_cli.problem import read_text
from tmm_cli.reports import print_on_terminal

ASKED = """
grading:
  reveal: REVEAL
  answers: [{of: H}, {of: class}, {of: v of E, at: 3}, {of: a of E, at: 7}, {of: M_b, at: 3, points: 0.1}]
"""
HOSTILE = (
    "=cmd|' /C calc'!A0",
    "<script>alert(1)</script>",
    "../../x",
    "a\0b\tc\r\nd",
    "\u202eabc\u2066",
    "x" * 10_000,
    "",
    "@SUM(1)",
    '"><img src=x onerror=alert(1)>',
    "| a |`b`[c](javascript:d)",
    "]]>&amp;",
    "\udcff",
    "CON",
    "con",
)
TEXTS = tuple(name for name in EXPORTS if name != "drawing")  # quick ones
LOST = "The Coriolis acceleration of link 2 on link 3 was left out or has the opposite direction."
OWN = "This answer is right if your own earlier values of v of E at 3 are used."


def task(reveal=True):
    asked = ASKED.replace("REVEAL", str(reveal).lower())
    return read_task(read_text(SHAPER.read_text(encoding="utf-8") + asked, "task.yaml"))


@pytest.fixture(scope="module")
def own():
    return task()


def marks(student, text="0,41", **others):
    """H right, class missing, v wrong, a right given v, M_b right; read in units that were not written."""
    return StudentMarks(
        student,
        (
            Mark(("H", None), "right", 1, 1, 0.41, 0.42, error=0.024, allowed=0.03, reading="m", text=text),
            Mark(("class", None), "missing", 0, 1, None, 2, allowed=1e-6),
            Mark(("v of E", 3), "wrong", 0, 1, 1.5, -1.2, True, 1.6, 0.1875, 0.03, "", (LOST,), ("Coriolis",), "1.5"),
            Mark(("a of E", 7), "follows", 1, 1, 3 + 4j, 4j, False, 9, 0.333, 0.045, "", (OWN,), text="5 ∠ 53.13"),
            Mark(("M_b", 3), "right", 0.1, 0.1, 200, 200, scale=250, error=0.0, allowed=0.05, text=text),
        ),
        **others,
    )


def absent(student, *problems):
    return StudentMarks(student, tuple(Mark(m.key, "missing", 0, m.of) for m in marks("").marks), problems)


def written(folder, book, *formats):
    write_formats(folder, book, formats or tuple(EXPORTS))
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def read_csv(data, between=","):
    return list(csv.DictReader(io.StringIO(data.decode("utf-8-sig")), delimiter=between))


def test_a_gradebook_has_all_its_files(own, tmp_path):
    files = written(tmp_path / "marks", Gradebook(own, [marks("Ann"), marks("Боб")]))
    each = [f"feedback/{name}.{kind}" for name in ("Ann", "Боб") for kind in ("html", "md")]
    assert sorted(files) == sorted(
        [
            "marks.csv",
            "answers.csv",
            "marks.xlsx",
            "moodle.csv",
            "junit.xml",
            "result.json",
            "group.png",
            "group.svg",
            *each,
            "gradescope/Ann.json",
            "gradescope/Боб.json",
        ]
    )


def test_tables_have_a_row_a_student_and_a_row_an_answer(own, tmp_path):
    files = written(tmp_path, Gradebook(own, [marks("Ann", copied="Bob"), absent("Bob", "no variant")]), "csv")
    ann, bob = read_csv(files["marks.csv"])
    assert list(ann.values()) == [
        "Ann",
        "2.1",
        "4.1",
        "51.2",
        "1 right",
        "0 missing",
        "0 wrong",
        "1 follows",
        "0.1 right",
        "the answers match the variant of Bob",
    ]
    assert (bob["points"], bob["notes"]) == ("0", "no variant")
    rows = read_csv(files["answers.csv"])
    assert list(rows[0]) == list(ANSWERS_HEADER)
    assert list(rows[0].values()) == [
        "Ann",
        "H",
        "",
        "0,41",
        "410",
        "",
        "420",
        "",
        "mm",
        "2.4",
        "3",
        "right",
        "1",
        "1",
        "m",
        "",
        "",
    ]
    v, a = rows[2], rows[3]
    assert (v["value"], v["direction, deg"], v["right value"], v["right direction, deg"]) == ("1.5", "", "1.2", "180")
    assert (a["value"], a["direction, deg"], a["reasons"]) == ("5", "53.13", OWN)
    assert {row["right value"] for row in rows[5:]} == {""}  # nothing is right of a student without a variant


def test_with_decimal_commas_cells_are_divided_by_semicolons(own, tmp_path):
    files = written(tmp_path, Gradebook(own, [marks("Ann")], decimal=","), "csv", "moodle")
    assert files["moodle.csv"].decode() == "\ufeffuser;grade\nAnn;2,1\n"
    assert read_csv(files["marks.csv"], ";")[0]["M_b at 3"] == "0,1 right"


def test_moodle_is_told_of_students_whom_the_teacher_named_alone(own, tmp_path):
    book = Gradebook(own, [marks("ann@school.org"), marks("stranger")], users={"ann@school.org"})
    assert written(tmp_path, book, "moodle") == {"moodle.csv": b"user,grade\nann@school.org,2.1\n"}


def test_a_workbook_has_marks_answers_and_the_group(own, tmp_path):
    data = written(tmp_path, Gradebook(own, [marks("=1+1", text="=2+2"), marks("https://x.org")]), "xlsx")["marks.xlsx"]
    book = CalamineWorkbook.from_filelike(io.BytesIO(data))
    assert book.sheet_names == ["Marks", "Answers", "Group"]
    rows = book.get_sheet_by_name("Marks").to_python()
    assert rows[1][:6] == ["=1+1", 2.1, 4.1, 51.2, 1.0, 0.0] and rows[2][0] == "https://x.org"
    answers = book.get_sheet_by_name("Answers").to_python()
    assert answers[1] == ["=1+1", "H", "0.41 m †", "420 mm", 2.4, 1.0, ""]
    assert answers[4] == ["=1+1", "a of E at 7", "5 m/s² at 53.13°", "4 m/s² at 90°", 33.3, 1.0, OWN]
    assert ["Coriolis", 2.0, 2.0] in [row[:3] for row in book.get_sheet_by_name("Group").to_python()]
    assert (
        b"<f>" not in data
        and data
        == written(tmp_path, Gradebook(own, [marks("=1+1", text="=2+2"), marks("https://x.org")]), "xlsx")["marks.xlsx"]
    )


def test_where_nothing_writes_workbooks_the_rest_is_written_and_it_is_said(own, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "xlsxwriter", None)
    told = []
    write_formats(tmp_path, Gradebook(own, [marks("Ann")]), ("xlsx", "moodle"), told.append)
    assert os.listdir(tmp_path) == ["moodle.csv"]
    assert told == [
        ("writing marks.xlsx requires xlsxwriter, which is not installed\n  allowed: pip install 'tmm-cli[excel]'")
    ]


def test_what_one_sheet_cannot_hold_goes_on_in_the_next(own, tmp_path, monkeypatch):
    monkeypatch.setattr(xlsx, "MOST_ROWS", 5)
    data = written(tmp_path, Gradebook(own, [marks("Ann"), marks("Bob")]), "xlsx")["marks.xlsx"]
    book = CalamineWorkbook.from_filelike(io.BytesIO(data))
    assert book.sheet_names == ["Marks", "Answers", "Answers 2", "Group"]
    assert len(book.get_sheet_by_name("Answers 2").to_python()) == 6


def test_feedback_says_what_was_read_what_was_allowed_and_why(own, tmp_path):
    files = written(tmp_path, Gradebook(own, [marks("Ann", copied="Bob")]), "feedback")
    assert (
        files["feedback/Ann.md"].decode()
        == f"""# Crank shaper, variant 7

**Ann**: 2.1 of 4.1 points (51.2 %)

| quantity | your answer | right value | deviation | allowed | score | result |
| --- | --- | --- | --- | --- | --- | --- |
| H | 0.41 m † | 420 mm | 2.4 % | 3 % | 1 / 1 | right |
| class | - | 2 | - | exact answer only | 0 / 1 | no answer |
| v of E at 3 | 1.5 m/s | 1.2 m/s at 180° | 19 % | 3 % | 0 / 1 | wrong |
| a of E at 7 | 5 m/s² at 53.13° | 4 m/s² at 90° | 33 % | 4.5 %, usually 3 % | 1 / 1 | right with your earlier values |
| M_b at 3 | 200 N·m | 200 N·m | 0 % | 5 % | 0.1 / 0.1 | right |

## Explanation of mistakes

- {LOST} (v of E at 3)
- {OWN} (a of E at 7)

† no unit was given: the unit that fits best was assumed.

Errors are given in per cent of the largest value of the quantity in the cycle.

The tolerance is larger than usual where drawing errors of 0.5 mm per 100 mm already cause such a deviation: the value \
cannot be measured more accurately there.
"""
    )
    assert b"Bob" not in b"".join(files.values())


def test_right_values_are_told_only_where_the_teacher_reveals_them(tmp_path):
    files = written(tmp_path, Gradebook(task(reveal=False), [marks("Ann")]), "feedback", "gradescope", "junit")
    assert not any(told in data.decode() for data in files.values() for told in ("420", "right value"))


def test_gradescope_takes_a_record_a_student(own, tmp_path):
    book = Gradebook(own, [marks("Ann", problems=("row 9: no such quantity",))])
    found = json.loads(written(tmp_path, book, "gradescope")["gradescope/Ann.json"])
    assert (found["score"], found["output"]) == (2.1, "row 9: no such quantity")
    assert [test["status"] for test in found["tests"]] == ["passed", "failed", "failed", "passed", "passed"]
    assert found["tests"][3] == {
        "name": "a of E at 7",
        "score": 1.0,
        "max_score": 1.0,
        "status": "passed",
        "output_format": "text",
        "visibility": "visible",
        "output": "result: right with your earlier values\nyour answer: 5 m/s² at 53.13°"
        "\nright value: 4 m/s² at 90°\ndeviation: 33 % of the largest value in the cycle; allowed: 4.5 %, usually 3 %\n"
        + OWN,
    }


def test_junit_has_a_case_an_answer_with_the_text_in_the_element(own, tmp_path):
    root = ElementTree.fromstring(written(tmp_path, Gradebook(own, [marks("Ann")]), "junit")["junit.xml"])
    cases = root.findall("testsuite/testcase")
    assert {case.get("classname") for case in cases} == {"Ann"} and cases[2].get("name") == "v of E at 3"
    assert (root.get("tests"), root.get("failures")) == ("5", "2")
    assert cases[1].find("failure").get("type") == "missing"
    assert cases[2].find("failure").text.endswith(LOST)


class Tags(HTMLParser):
    """Elements of a page with their attributes."""

    def __init__(self, page):
        super().__init__()
        self.found = set()
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.found |= {(tag, name) for name, _ in attributes} | {tag}


def test_nothing_of_hostile_names_and_answers_becomes_more_than_text(own, tmp_path):
    books = [
        Gradebook(own, [marks("Ann")]),
        Gradebook(own, [marks(name, text=name, problems=(name,), copied=name) for name in HOSTILE]),
    ]
    plain, files = (written(tmp_path / str(n), book, *TEXTS) for n, book in enumerate(books))
    assert sorted(os.listdir(tmp_path)) == ["0", "1"] and len(files) == 6 + 3 * len(HOSTILE)
    names = {name.rpartition("/")[2].casefold() for name in files}
    assert len({name for name in names if name.endswith(".html")}) == len(HOSTILE)
    assert all(len(name.encode()) < 200 and not name.startswith((".", "con.")) for name in names)
    allowed = Tags(plain["feedback/Ann.html"].decode()).found | {"ul", "li"}
    for name, data in files.items():
        text = data.decode(errors="replace")
        if name.endswith(".html"):
            assert Tags(text).found <= allowed
        if name.endswith(".md"):
            assert "<" not in text and "[c](" not in text
        if name.endswith(".csv"):
            cells = [cell for row in csv.reader(io.StringIO(text)) for cell in row]
            assert not any(cell.startswith(("=", "+", "@", "\t", "\r")) for cell in cells)
        if not name.endswith("xlsx"):
            assert not set(text) & set("\0\r\t\u202e\u2066") and "x" * 600 not in text and "nan" not in text
    ElementTree.fromstring(files["junit.xml"])
    rows = CalamineWorkbook.from_filelike(io.BytesIO(files["marks.xlsx"])).get_sheet_by_name("Marks").to_python()
    assert [row[0] for row in rows[1:]] == [printable_text(name) for name in HOSTILE]


def test_what_is_no_number_is_no_number_in_any_table(own, tmp_path):
    odd = [replace(m, value=complex(np.inf, np.nan), error=np.nan, allowed=np.inf) for m in marks("Ann").marks]
    files = written(tmp_path, Gradebook(own, [StudentMarks("Ann", tuple(odd))]), *TEXTS)
    for name in ("marks.csv", "answers.csv", "junit.xml", "gradescope/Ann.json", "feedback/Ann.html"):
        assert not re.search(r"\b(nan|inf|None)\b", files[name].decode()), name


def test_an_error_on_the_way_leaves_the_old_files_and_nothing_else(own, tmp_path, monkeypatch):
    before = written(tmp_path / "marks", Gradebook(own, [marks("Ann")]), *TEXTS)
    (tmp_path / "marks" / "my notes.txt").write_text("mine")
    monkeypatch.setitem(exports.EXPORTS, "drawing", lambda book: iter([("group.png", (b"", 1 / 0))]))
    with pytest.raises(ZeroDivisionError):
        write_formats(tmp_path / "marks", Gradebook(own, [marks("Ann", text="other")]))
    after = {str(p.relative_to(tmp_path / "marks")): p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
    assert after == before | {"my notes.txt": b"mine"}


def test_points_are_written_as_people_do():
    assert [points_text(x) for x in (4.0, 3.5, 0.1 + 0.2, 3 * (1 / 3), 2 / 3, 0)] == [
        "4",
        "3.5",
        "0.3",
        "1",
        "0.667",
        "0",
    ]
    assert [share_text(x) for x in (0.0051, 0.051, 0.51, 40, np.nan)] == ["0.51 %", "5.1 %", "51 %"] + 2 * [
        "more than 999 %"
    ]
    assert [direction(v) for v in (1, 1j, -1, -1e-12j + 1)] == [0, 90, 180, 0]


def test_statistics_are_of_those_who_handed_in(own):
    group = [marks("Ann"), marks("Bob", problems=("row 9: no number",), copied="Ann"), absent("Eve")]
    assert count_by_points(group).tolist() == [0, 0, 0, 0, 0, 2, 0, 0, 0, 0]
    assert [(one.name, one.share) for one in rank_difficulties(own, group)][:2] == [("class", 0), ("v of E", 0)]
    assert rank_mistakes(group) == [("Coriolis", 2, 2)]
    found = {table.name: table for table in statistics_tables(own, group)}
    assert list(found) == ["group", "histogram", "hardest", "mistakes", "copies", "problems"]
    assert found["group"].notes == ("students: 3", "students without any answer (not counted): 1")
    console = Console(file=io.StringIO(), width=100)
    for table in found.values():
        print_on_terminal(table, own.units, console)
    assert "omega" not in console.file.getvalue() and "row 9: no number" in console.file.getvalue()


def test_a_group_without_an_answer_has_no_figures(own):
    assert [table.name for table in statistics_tables(own, [absent("Ann", "no such file")])] == ["problems"]
    assert [table.name for table in statistics_tables(own, [])] == []
    assert "no typical mistake was recognised" in draw_group_chart(own, [absent("Ann")]).texts()
