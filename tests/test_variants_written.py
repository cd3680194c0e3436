"""`tmm variants`: what a teacher and the students get, tables made by hand, and one variant of a table run."""

from __future__ import annotations

import csv
import json

import pytest
from test_commands import SHAPER, tmm
from test_drawn_variants import ASKED, task

from tmm_cli import load, solve
from tmm_cli.grading import (
    TaskSheets,
    VariantTable,
    compute_answer_key,
    describe_idle_questions,
    draw_variants,
    explain_quantity,
    read_rows,
    read_students,
    read_table,
    variant_problem_text,
)
from tmm_cli.problem import ProblemError

NAMES = ["=cmd|A1", "<script>alert(1)</script>", "../../etc/passwd", "Иванов Иван"]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("variants")
    file, group = folder / "task.yaml", folder / "group.csv"
    file.write_text(SHAPER.read_text(encoding="utf-8") + ASKED, encoding="utf-8")
    group.write_bytes("\n".join(["student;group", *(f"{name};1" for name in NAMES)]).encode("cp1251"))
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(draw_variants, "CHUNK", 100)
        patched.setattr(draw_variants, "ENOUGH", 50)
        done = tmm("variants", file, "--students", group, "--seed", "3", "-o", folder / "out")
    assert done.returncode == 0, done.stderr
    return folder / "out", done


def test_every_student_has_a_sheet_and_a_problem_that_is_his_variant(written):
    out, done = written
    assert "variants: 4, varied parameters: OA, DE, n1, candidates tried: 100" in done.stderr
    table = read_table(out / "variants.csv", task())
    assert table == read_table(out / "variants.xlsx", task()) and set(table.rows) == set(NAMES)
    values = dict(zip(table.names, table.rows["Иванов Иван"], strict=True))
    own = load(str(out / "Иванов_Иван.yaml"))
    assert own.linkage == task().variant(values).linkage
    page = (out / "Иванов_Иван.md").read_text(encoding="utf-8")
    assert f"| OA | {values['OA']} | mm |" in page and "| v of E | 3, 7 | m/s | 2 |" in page
    assert (out / "Иванов_Иван.png").read_bytes().startswith(b"\x89PNG")


def test_a_sheet_says_what_every_name_stands_for_and_how_vectors_are_answered(written):
    page = (written[0] / "Иванов_Иван.md").read_text(encoding="utf-8")
    assert "| M\\_b | 3 | N\\*m | 1 | balancing moment on the input link, positive counterclockwise |" in page
    assert "3.6 at 34 deg" in page
    meanings = {name: explain_quantity(quantity) for name, quantity in task().quantities.items()}
    assert all(meanings.values())
    assert len({meanings[name] for name in ("v of 2 on 3", "v of E", "v of 5", "M of 3", "M_b")}) == 5


def test_names_run_nothing_and_lead_nowhere(written):
    out, _done = written
    assert not [path for path in out.parent.rglob("*") if path.is_file() and path.parent not in (out, out.parent)]
    assert sum(path.suffix == ".html" for path in out.iterdir()) == 4
    for path in out.glob("*.html"):
        text = path.read_text(encoding="utf-8")
        assert "<script" not in text and "http:" not in text
    for path in out.glob("*.md"):
        assert "<script" not in path.read_text(encoding="utf-8")
    cells = [cell for name in ("variants.csv", "key.csv") for row in _rows(out / name) for cell in row]
    assert not [cell for cell in cells if cell.startswith(("=", "+", "@", "\t", "\r"))]


def _rows(path):
    with path.open(encoding="utf-8-sig", newline="") as stream:
        return list(csv.reader(stream))


def test_a_name_does_not_turn_the_writing_of_a_sheet_round():
    own, text = task(), SHAPER.read_text(encoding="utf-8") + ASKED
    sheets = TaskSheets(own, text, VariantTable(("OA",), {"\u202eanA": ("110",)}))
    pages = [page.decode() for name, page in sheets.build_files("\u202eanA") if name.endswith((".md", ".html"))]
    assert all("\ufffdanA" in page and "\u202e" not in page for page in pages)


def test_the_key_has_every_answer_of_every_student(written):
    head, *rows = _rows(written[0] / "key.csv")
    assert head[:4] == ["student", "quantity", "position", "value"]
    assert len(rows) == 4 * 5
    stroke = next(row for row in rows if row[0] == "Иванов Иван" and row[1] == "H")
    found = solve(load(str(written[0] / "Иванов_Иван.yaml")), "kinematics")
    assert float(stroke[3]) == pytest.approx(1000 * found.strokes.travel, rel=1e-5)


def test_what_can_tell_nothing_is_said():
    own = task("\ngrading: {answers: [{of: v of E, at: [0, 3]}]}\n")
    lines = list(compute_answer_key(own, VariantTable(("OA",), {"Ana": ("110",), "Iva": ("115",)})))
    assert list(describe_idle_questions(lines)) == [
        (
            "v of E at 0: the question does not distinguish right answers from wrong ones: zero counts as a "
            "right answer (students: 2 of 2)"
        )
    ]


def test_one_variant_of_a_table_is_run_by_its_number_or_its_student(tmp_path):
    table = tmp_path / "table.csv"
    table.write_text("студент;OA, cm;n1, об/мин\nАна;11,5;80\nБоб;12;90\n", encoding="cp1251")
    for variant in ("2", "Боб"):
        done = tmm("kinematics", SHAPER, "--variants", table, "--variant", variant, "-p", 3)
        assert done.returncode == 0 and "--set OA=12 cm, --set n1=90 об/мин" in done.stderr
    for name in ("run", "forces", "structure"):
        done = tmm(name, SHAPER, "--variants", table)
        assert done.stderr == (
            "error: specify both the table of variants and the variant\n  allowed: --variants FILE --variant 7\n"
        )
    done = tmm("forces", SHAPER, "--variants", table, "--variant", "3")
    assert done.returncode == 2 and done.stderr == (
        f"error: {table}: unknown variant\n  found:   '3'\n"
        "  allowed: a number from 1 to 2, or the name of a student in the table\n"
    )


def test_too_few_variants_are_refused():
    file = SHAPER.relative_to(SHAPER.parents[1])
    done = tmm("variants", file, "--vary", "OA=100..104:2", "--count", "9", "-o", "nowhere")
    assert done.returncode == 2 and done.stderr.splitlines()[-3:] == [
        f"error: {file}: the ranges yield too few feasible and distinct variants: 3",
        "  found:   number of variants required: 9",
        "  allowed: wider ranges or smaller steps",
    ]
    assert not (SHAPER.parents[1] / "nowhere").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "OAA,n1\n1,2\n",
            ("no parameter has this name\n  found:   'OAA'\n  allowed: OA, OC, CD, DE, n1\n  did you mean 'OA'?"),
        ),
        (
            "student,OA\nAna,80\nAna,90\n",
            (
                "row 3: each row must name a different student\n"
                "  found:   'Ana'\n"
                "  allowed: a name that occurs only once"
            ),
        ),
        ("student,OA\nAna,\n", "row 2.OA: expected a value\n  found:   an empty cell"),
        ("student,n1\nAna,80 mm\n", None),
        ("OA\n", ("expected a header row and one row for each variant\n  allowed: student;OA, mm;n1, rpm")),
        ("OA,OA\n1,2\n", ("two columns have the same name\n  found:   'OA'")),
    ],
)
def test_tables_that_are_none_are_refused(text, message, tmp_path):
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(ProblemError) as caught:
        read_table(path, task())
    assert message is None or str(caught.value) == f"{path}: {message}"


def test_students_are_read_from_the_first_column_or_that_of_their_names(tmp_path):
    path = tmp_path / "group.csv"
    path.write_text("Ana\nIva\nAna\n")
    assert read_students(path) == ("Ana", "Iva")
    path.write_text("group,Student\n1,Ana\n1,Iva\n")
    assert read_students(path) == ("Ana", "Iva")
    assert read_rows(path)[0] == ["group", "Student"]


def test_a_problem_text_keeps_all_but_the_values_and_the_blocks_of_the_teacher():
    text = "tmm: 1\nparameters: {OA: '1', n1: 82 rpm}   # why\nvariants: {OA: [1, 2]}\ngrading:\n  a: 1\nlinks: {}\n"
    assert variant_problem_text(text, {"OA": "2.5", "n1": "70 об/мин"}) == (
        "tmm: 1\nparameters: {OA: 2.5, n1: 70 об/мин}   # why\nlinks: {}\n"
    )


def test_the_schema_of_files_has_the_blocks_of_a_task():
    schema = json.loads(tmm("schema").stdout)
    assert schema["else"]["properties"]["grading"]["anyOf"][0] == {"$ref": "#/$defs/Grading"}
    assert "AnswerRule" in schema["$defs"] and "additionalProperties" in schema["else"]["properties"]["variants"]
