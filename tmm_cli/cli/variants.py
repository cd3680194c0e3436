"""Command `tmm variants`: generates variants of a task for a group of students."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmm_cli.batch import Task, read_task, with_vary
from tmm_cli.cli.common import console, reporting_errors, with_progress
from tmm_cli.cli.opening import read_in_file_language
from tmm_cli.cli.talk import printable, say, warn
from tmm_cli.grading import (
    HEADER,
    TaskSheets,
    VariantGenerator,
    VariantTable,
    check_load_tables,
    compute_answer_key,
    csv_bytes,
    describe_idle_questions,
    draw_numbered_variants,
    draw_student_variants,
    read_students,
    variant_table_rows,
    xlsx_bytes,
)
from tmm_cli.language import _
from tmm_cli.problem import ProblemError
from tmm_cli.reports import StagedFolder, print_on_terminal, refuse_unwritable, text_table

TABLE = "variants.csv"

File = Annotated[str, typer.Argument(metavar="TASK", help="Problem file (YAML); may have a block `variants`.")]
Count = Annotated[int, typer.Option(min=1, max=10_000, help="Number of variants.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the random choice; the same seed gives the same variants.")]
Folder = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for all files.")]
Students = Annotated[
    str | None,
    typer.Option(metavar="FILE", help="Table with the students' names, instead of --count.", show_default=False),
]
Vary = Annotated[
    list[str] | None,
    typer.Option(metavar="NAME=FROM..TO:STEP", help="Vary this parameter (may be repeated).", show_default=False),
]


def variants(
    file: File,
    count: Count = 25,
    seed: Seed = 1,
    out: Folder = Path("variants"),
    students: Students = None,
    vary: Vary = None,
) -> None:
    """Generate variants of a task for a group: table, answer key, and sheet and problem file for each student."""
    with reporting_errors():
        refuse_unwritable(out, folder=True)
        task = read_task(with_vary(read_in_file_language(file), vary or ()))
        variety = VariantGenerator(task)
        if students is None:
            table = draw_numbered_variants(variety, seed, count)
        else:
            listed = read_students(students)
            before = read_students(out / TABLE) if (out / TABLE).exists() else ()
            first = [name for name in before if name in listed]
            table = draw_student_variants(variety, seed, [*first, *sorted(set(listed) - set(first))])
            count = len(listed)
        _print_drawn(variety, table)
        for slip in check_load_tables(task, table):
            warn(f"{task.problem.name}: {slip}")
        if len(table.rows) < count:
            raise ProblemError(
                _("the ranges yield too few feasible and distinct variants: {found}").format(found=len(table.rows)),
                found=_("number of variants required: {count}").format(count=count),
                allowed=_("wider ranges or smaller steps"),
                file=file,
            )
        _write(task, Path(file).read_text(encoding="utf-8-sig"), table, out)


def _print_drawn(variety: VariantGenerator, table: VariantTable) -> None:
    """Print how many variants were generated, and how many candidates were rejected, by reason."""
    rows = [(why, str(count)) for why, count in variety.rejected.most_common() if count]
    text = _("variants: {count}, varied parameters: {free}, candidates tried: {tried}")
    say(text.format(count=len(table.rows), free=", ".join(table.names), tried=variety.tried))
    if rows:
        rejected = text_table("rejected", _("Rejected candidates"), (_("reason"), _("number of candidates")), rows)
        print_on_terminal(rejected, variety.task.units, console())


def _write(task: Task, text: str, table: VariantTable, out: Path) -> None:
    """Write all files, or none if one fails. Raises ProblemError or OSError."""
    with StagedFolder(out) as folder:
        rows = variant_table_rows(table)
        folder.write(TABLE, [csv_bytes(rows)])
        book = xlsx_bytes({"variants": rows})
        if book is None:
            say(_("note: variants.xlsx requires the package xlsxwriter: pip install 'tmm-cli[excel]'"))
        else:
            folder.write("variants.xlsx", [book])
        if task.blocks.grading is None:
            say(_("note: no answer key is written, as the file has no block `grading`"))
        else:
            key = list(compute_answer_key(task, table))
            folder.write("key.csv", [csv_bytes([HEADER, *(line.cells(task) for line in key)])])
            for sentence in describe_idle_questions(key):
                say(sentence)
        sheets = TaskSheets(task, text, table)
        for student in with_progress(list(table.rows)):
            for name, content in sheets.build_files(student):
                folder.write(name, [content])
    say(_("written: {files}").format(files=printable(out)))
