"""What students hand in, in all formats and shapes; what is broken gets its line and stops nothing."""

from __future__ import annotations

import csv
import math
import os

import pytest
import xlsxwriter
from test_variants_of_task import TABLE, family_of, task

from tmm_cli.grading import ReadAnswer, grade, read_rows, read_submissions, write_template
from tmm_cli.grading.submissions import answers, read as reading
from tmm_cli.problem import ProblemError

OWN = task()  # asks H, k, class, v of E at 3 and 7, a of E at 3, R_34 at 7, M_b at 3 and 7
FIVE = {
    ("H", None): ReadAnswer(414.5, unit="mm"),
    ("class", None): ReadAnswer(2.0),
    ("v of E", 7): ReadAnswer(1.2, 180.0, "polar", "m/s", "deg"),
    ("R_34", 7): ReadAnswer(1.2, -3.4, "components", "kN"),
    ("M_b", 3): ReadAnswer(-20.0, unit="N*m"),
}
LONG = """quantity;position;value;unit;x;y;size;angle, deg
H;;414,5;mm;;;;
class;;II;;;;;
v of E;7;;m/s;;;1,2;180
R_34;7;;kN;1,2;−3,4;;
M_b;3;-20;N*m;;;;
k;;;;;;;
"""
WIDE = """"H, mm",class,"v of E at 7, m/s","v of E at 7, angle, deg",R_34 x at 7 [kN],R_34 y at 7,"M_b at 3, N*m",k
"414,5",II,"1,2",180,"1,2","-3,4",-20,–
"""
YAML = """answers:
  H: 414,5 mm
  class: II
  v of E at 7: 1,2 m/s at 180 deg
  R_34 at 7, kN: [1,2; -3,4]
  M_b at 3, N*m: -20
  k:
"""
PARTS = """student: Ana
H, mm: 414.5
class: 2
v of E at 7, m/s: {size: 1.2, 'angle, deg': 180}
R_34 at 7, kN:
  x: 1,2
  y: -3,4
M_b at 3: -20 N·m
"""


def read(path, students=("Ana", "Ivan")):
    return {one.student: one for one in read_submissions(path, OWN, students)}


def of_ana(folder, name, content):
    """Ana's submission, in a file of a folder."""
    folder.mkdir(exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return read(folder)["Ana"]


def plain(found):
    """Answers without their texts; units that are written in another way as the usual one."""
    return {key: (g.first, g.second, g.form, g.unit.replace("·", "*"), g.turn_unit) for key, g in found.items()}


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("Ana.csv", LONG),
        ("Ana.csv", LONG.replace(";", "\t").encode("utf-16")),
        ("Ana.csv", ("\ufeff" + LONG)),
        ("Ana.csv", LONG.replace("quantity;position;value;unit", "Величина;№ положения;Ответ;Ед. изм.")),
        (
            "Ana.csv",
            LONG.replace(
                "quantity;position;value;unit;x;y;size;angle", "Veličina;Položaj;Vrednost;Jedinica;x;y;intenzitet;ugao"
            ),
        ),
        (
            "Ana.csv",
            LONG.replace("quantity;position;value", "величина;положение;значение").replace("−", "-").encode("cp1251"),
        ),
        ("Ana.csv", WIDE),
        ("ana.CSV", "student," + WIDE.replace('"414,5"', 'Ana,"414,5"')),
        ("Ana.yaml", YAML),
        ("Ana.yml", PARTS),
    ],
)
def test_every_shape_and_format_says_the_same(name, content, tmp_path):
    found = of_ana(tmp_path / "in", name, content)
    assert plain(found.answers) == plain(FIVE)
    assert not found.problems and not found.unread


def test_an_xlsx_says_the_same(tmp_path):
    with xlsxwriter.Workbook(tmp_path / "Ana.xlsx") as book:
        sheet = book.add_worksheet()
        for n, row in enumerate(csv.reader(LONG.splitlines(), delimiter=";")):
            sheet.write_row(n, 0, row)
        sheet.write_number("C2", 414.5)
        sheet.write_formula("C6", "=-4*5", None, -20)
    assert plain(read(tmp_path)["Ana"].answers) == plain(FIVE)


def test_one_table_of_all_students_in_either_shape(tmp_path):
    long = tmp_path / "long.csv"
    long.write_text("student,quantity,position,value\nAna,H,,414 mm\nIvan,H,,400\nAna,v of E,7,(1; 2) m/s\n")
    found = read(long)
    assert plain(found["Ana"].answers) == {
        ("H", None): (414.0, 0.0, "number", "mm", ""),
        ("v of E", 7): (1.0, 2.0, "components", "m/s", ""),
    }
    assert found["Ivan"].answers["H", None].first == 400
    wide = tmp_path / "wide.csv"
    wide.write_text('name;H, mm;"v of E at 7, m/s"\nAna;414;(1; 2)\nIvan;400;\n')
    wide.write_text(wide.read_text().replace("(1; 2)", '"(1; 2)"'))
    other = read(wide)
    assert plain(other["Ana"].answers) == plain(found["Ana"].answers)
    assert list(other["Ivan"].answers) == [("H", None)]


def test_a_table_is_read_student_by_student(tmp_path):
    (tmp_path / "a.csv").write_text("quantity,value\nH,1\n")
    (tmp_path / "b.csv").mkdir()
    one_by_one = read_submissions(tmp_path, OWN, ["a", "c"])
    assert next(one_by_one).student == "a"
    assert [one.student for one in one_by_one] == ["b", "c"]


def test_a_comma_in_a_heading_does_not_shift_the_answers(tmp_path):
    found = of_ana(tmp_path, "Ana.csv", "H, mm,k\n400,1.5\n")
    assert found.problems == (
        "Ana.csv: a heading that contains a comma must be in quotes; found: 'mm'; allowed: \"H, mm\" or H [mm]",
    )


def test_a_table_without_students_is_refused(tmp_path):
    (tmp_path / "t.csv").write_text("quantity,value\nH,1\n")
    with pytest.raises(ProblemError, match="no column contains the names of the students"):
        read(tmp_path / "t.csv")
    with pytest.raises(ProblemError, match="no such file"):
        read(tmp_path / "none.csv")


HEAD = "quantity,position,value\n"


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (
            HEAD + "v of D,7,1\nv of E,5,1\n",
            "these answers are not requested and are not graded: v of D at 7 (requested: v of E), v of E at 5",
        ),
        (HEAD + "R_43,7,1\n", "these answers are not requested and are not graded: R_43 at 7 (requested: R_34)"),
        (HEAD + "v of e,7,1\n", "there is no quantity with this name; found: 'v of e'; did you mean 'v of E'?"),
        (HEAD + "M_b,7,1\nM_b,7,2\n", "M_b at 7 is given twice: the first answer counts"),
        (HEAD + "H,,nan\n", "H: the number must be finite; found: 'nan'"),
        (HEAD + "H,,(1; 2)\n", "H: expected one number; found: '(1; 2)'"),
        (HEAD + "M_b,7,3 foo\n", "M_b at 7: unknown unit; found: 'foo'; allowed: e.g. mm, deg, rpm, kg, N, N*m"),
        (
            HEAD + "H,,1,5\n",
            ("a row with more cells than the header is ignored. Does it contain a decimal comma without quotes?"),
        ),
        (
            '"R_34 x at 7, N","R_34 y at 7, kN"\n5,6\n',
            "R_34 at 7: the components have different units; found: 'N', 'kN'",
        ),
        ("R_34 x at 7\n5\n", "R_34 at 7: one component is missing; found: x; allowed: x, y"),
        (
            "R_34 angle at 7\n5\n",
            "R_34 at 7: the magnitude of the vector is missing; found: angle; allowed: size, angle",
        ),
        # minutes, were there several ways of dividing the blanks between the commas
        (
            HEAD + f'"H{", " * 28}[",,1\n',
            f"this column heading is not recognised; found: 'H{', ' * 28}['; allowed: v of E at 7, m/s",
        ),
        ("student,quantity,value\nIvan,H,3\n", "the file contains the name of another student: 'Ivan'"),
        ("student,quantity,value\n../Ivan,H,3\n", "the file contains the name of another student: '∕Ivan'"),
    ],
)
def test_what_cannot_be_counted_is_told_in_a_line(content, told, tmp_path):
    assert of_ana(tmp_path / "in", "Ana.csv", content).problems == (told,)


def test_the_opposite_reaction_is_not_taken_for_the_one_that_is_asked(tmp_path):
    assert not of_ana(tmp_path / "in", "Ana.csv", HEAD + "R_43,7,1\n").answers


def test_many_problems_are_told_shortly(tmp_path):
    rows = "".join(f"nothing {n},7,1\n" for n in range(1500))
    told = of_ana(tmp_path / "in", "Ana.csv", HEAD + rows).problems
    assert (len(told), told[-1]) == (21, "and 1480 more")


def test_far_more_cells_than_are_asked_are_not_read(tmp_path, monkeypatch):
    monkeypatch.setattr(answers, "MOST_CELLS", 2)
    found = of_ana(tmp_path / "in", "Ana.csv", "H,k,class\n1,2,3\n")
    assert (len(found.answers), found.problems) == (2, ("only the first 2 cells are read",))


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        (
            "Ana.yaml",
            "a: &x [1]\nb: *x\n",
            (
                "Ana.yaml:1:4: a: YAML aliases (* and &) are not allowed in a problem file; allowed: the "
                "value itself, or a parameter; a text that begins with * or & needs quotation marks"
            ),
        ),
        ("Ana.yaml", "a: " + "[" * 500, "Ana.yaml:1:23: a[0][0]: too many nested levels; allowed: at most 20 levels"),
        (
            "Ana.yaml",
            "a: !!python/object/apply:os.system [ls]",
            (
                "Ana.yaml:1:4: a: YAML tags (!) are not allowed in a problem file; found: "
                "'tag:yaml.org,2002:python/object/apply:os.system'; allowed: values without tags"
            ),
        ),
        (
            "Ana.yaml",
            "H: 1\nH: 2\n",
            ("Ana.yaml:2:1: H: this key occurs twice; found: 'H'; allowed: each key once; the first is on line 1"),
        ),
        (
            "Ana.yaml",
            "- 1\n",
            (
                "Ana.yaml:1:1: the top level of the file must consist of keys with values; found: [1]; "
                "allowed: lines 'key: value'"
            ),
        ),
        (
            "Ana.yaml",
            "answers: [1, 2]\n",
            "Ana.yaml: this is not an answer sheet; found: '[1, 2]'; allowed: answers: {v of E at 7: 1.31 m/s}",
        ),
        ("Ana.csv", b"\x00\x01\x02", "Ana.csv: this is not a text file; allowed: a table in CSV or XLSX format"),
        ("Ana.csv", b"", "Ana.csv: the table is empty"),
        (
            "Ana.csv",
            "what;where;number\nH;;414\nv of E;7;1,3\n",
            (
                "Ana.csv: none of the headings of this table is recognised; found: 'what; where; number'; allowed: "
                "columns quantity; position; unit; value, or headings such as v of E at 7"
            ),
        ),
        ("Ana.csv", "\n".join("1" * 2001), "Ana.csv: there are too many rows; allowed: at most 2000"),
        ("Ana.csv", b"1" * 1_000_001, "Ana.csv: the file is too large; found: 1000001; allowed: at most 1000000"),
        ("Ana.yaml", b"#" * 1_000_001, "Ana.yaml: the file is too large; found: 1000001; allowed: at most 1000000"),
        ("Ana.xlsx", b"PK\x03\x04", "Ana.xlsx: the XLSX file is damaged: File is not a zip file"),
        ("Ana.xlsm", b"PK\x03\x04", "Ana.xlsm: this is not an answer sheet; allowed: CSV, XLSX without macros, YAML"),
        ("Ana.pdf", b"%PDF", "Ana.pdf: this is not an answer sheet; allowed: CSV, XLSX without macros, YAML"),
    ],
)
def test_a_broken_file_gets_one_line(name, content, told, tmp_path):
    found = of_ana(tmp_path / "in", name, content)
    assert found.problems == (told,)
    assert found.unread and not found.answers


def test_a_broken_file_stops_nothing(tmp_path):
    secret = tmp_path / "secret.csv"
    secret.write_text("quantity,value\nH,1\n")
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "A.csv").symlink_to(secret)
    (folder / "B").mkdir()
    os.mkfifo(folder / "C.csv")
    (folder / "D.csv").write_text("quantity,value\nH,1\n")
    (folder / "D.yaml").write_text("H: 2")
    (folder / "E.csv").write_text("quantity,value\nH,1\n")
    for of_the_system in (".DS_Store", "Thumbs.db", "desktop.ini"):
        (folder / of_the_system).write_text("")
    found = read(folder, ["A", "E", "F"])
    none = "this is not a regular file but a link, a folder or a device"
    assert {name: one.problems for name, one in found.items()} == {
        "A": (f"A.csv: {none}",),
        "B": (f"B: {none}",),
        "C": (f"C.csv: {none}",),
        "D": ("there is more than one file of this student (2): D.csv, D.yaml",),
        "E": (),
        "F": ("nothing was handed in",),
    }
    assert [name for name, one in found.items() if one.unread] == ["A", "B", "C", "D"]


def test_students_are_known_by_names_that_look_alike(tmp_path):
    names = ["Ёлкин Й", "Novak_A", "Novak A"]
    (tmp_path / "Е\u0308лкин И\u0306.csv").write_text(HEAD + "H,,1\n")  # as macOS writes it
    (tmp_path / "novak a.csv").write_text(HEAD + "H,,1\n")  # may be either
    assert [one.student for one in read_submissions(tmp_path, OWN, names)] == ["novak a", *names]


@pytest.mark.parametrize(
    ("name", "called"), [("../../etc/passwd", "∕..∕etc∕passwd"), ("a\\b", "a⧵b"), ("..", "?"), ("a\nb", "a\\nb")]
)
def test_a_student_of_no_name_leads_to_no_other_folder(name, called, tmp_path):
    (tmp_path / "t.csv").write_text(f'student,H\n"{name}",1\n')
    assert next(read_submissions(tmp_path / "t.csv", OWN, [])).student == called


def test_a_table_of_too_many_rows_is_refused_early(tmp_path, monkeypatch):
    monkeypatch.setattr(reading, "MOST_ROWS_OF_ALL", 1000)
    (tmp_path / "t.csv").write_text("1\n" * 1001)
    with pytest.raises(ProblemError, match="there are too many rows"):
        read(tmp_path / "t.csv")
    with open(tmp_path / "large.csv", "wb") as file:
        file.truncate(10**9)
    with pytest.raises(ProblemError, match="the file is too large"):
        read(tmp_path / "large.csv")


def test_a_position_by_its_crank_angle_is_that_of_the_students_variant(tmp_path):
    """The first position is an extreme one: at another angle for every variant."""
    (tmp_path / "t.csv").write_text("student,H\n1,1\n")
    first = next(grade(OWN, TABLE, list(read_submissions(tmp_path / "t.csv", OWN, ["1"]))))
    right = next(mark for mark in first.marks if mark.key == ("M_b", 3)).right
    place = math.degrees(family_of(OWN).q[0, 3])
    (tmp_path / "t.csv").write_text(
        f"student,M_b at phi = {place:.1f} deg,M_b at φ = {place + 10:.0f}°,M_b at {place - 30:.0f} deg\n"
        f"1,{right.real:.5g} N*m,1,2\n"
    )
    marks = next(grade(OWN, TABLE, list(read_submissions(tmp_path / "t.csv", OWN, ["1"]))))
    assert [mark.key for mark in marks.marks if mark.state == "right"] == [("M_b", 3)]
    assert marks.problems == (
        f"M_b at phi = {place + 10:.0f} deg: there is no position at this angle; "
        f"the nearest is position 3 at {place % 360:.6g} deg",
        "these answers are not requested and are not graded: M_b at 2",
    )


@pytest.mark.parametrize("kind", ["csv", "xlsx", "yaml"])
def test_an_empty_sheet_asks_for_everything_and_answers_nothing(kind, tmp_path):
    write_template(OWN, tmp_path / f"Ana.{kind}")
    found = read(tmp_path)["Ana"]
    assert not found.answers and found.problems == (f"there are no answers in Ana.{kind}",)


def filled(path):
    """A sheet as a student fills it: a class in Roman figures, vectors by their parts, the rest numbers from 1.5 on."""
    if path.suffix == ".yaml":
        lines = path.read_text(encoding="utf-8").splitlines()
        given = ["1,5", "2.5", "II", "4.5 at 30 deg", "(5,5; -30)", "6.5 at 30 deg", "(7.5; -30)", "8.5", "−9,5"]
        path.write_text("\n".join([*lines[:2], *map(" ".join, zip(lines[2:], given, strict=True))]), encoding="utf-8")
        return
    header, *rows = read_rows(path)
    numbers = (str(n + 1.5) for n in range(9))
    for row, number in zip(rows, numbers, strict=True):
        row[3:] = ["", "", "", number, "30"] if row[1] == "3" else ["", number, "-30"]
        if row[0] in ("H", "k", "M_b"):
            row[3:] = [number]
    rows[2][3:] = ["II"]
    rows[-1][3:] = ["-9.5"]
    if path.suffix == ".csv":
        with open(path, "w", encoding="cp1251", newline="") as file:
            csv.writer(file, delimiter=";").writerows([header, *rows])
    else:
        with xlsxwriter.Workbook(path, {"strings_to_numbers": True}) as book:
            sheet = book.add_worksheet()
            for n, row in enumerate([header, *rows]):
                sheet.write_row(n, 0, row)


@pytest.mark.parametrize("kind", ["csv", "xlsx", "yaml"])
def test_a_sheet_that_is_filled_in_gives_what_was_put_in(kind, tmp_path):
    write_template(OWN, tmp_path / f"Ana.{kind}")
    filled(tmp_path / f"Ana.{kind}")
    found = read(tmp_path)["Ana"]
    assert not found.problems
    assert plain(found.answers) == {
        ("H", None): (1.5, 0.0, "number", "mm", ""),
        ("k", None): (2.5, 0.0, "number", "", ""),
        ("class", None): (2.0, 0.0, "number", "", ""),
        ("v of E", 3): (4.5, 30.0, "polar", "m/s", "deg"),
        ("v of E", 7): (5.5, -30.0, "components", "m/s", ""),
        ("a of E", 3): (6.5, 30.0, "polar", "m/s^2", "deg"),
        ("R_34", 7): (7.5, -30.0, "components", "N", ""),
        ("M_b", 3): (8.5, 0.0, "number", "N*m", ""),
        ("M_b", 7): (-9.5, 0.0, "number", "N*m", ""),
    }


def test_another_ending_of_a_sheet_is_refused(tmp_path):
    with pytest.raises(ProblemError) as caught:
        write_template(OWN, tmp_path / "sheet.docx")
    assert str(caught.value) == (
        "an answer sheet cannot have this file extension\n  found:   '.docx'\n  allowed: .xlsx, .csv, .yaml"
    )
