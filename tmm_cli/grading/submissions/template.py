"""Empty answer sheets with the requested quantities, their units and blank cells."""

from __future__ import annotations

import csv
import io
import json
import os
import re
from collections.abc import Callable
from pathlib import Path

from tmm_cli.batch import Question, Task
from tmm_cli.language import _
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import ProblemError, quote
from tmm_cli.reports import open_workbook, write_atomically

COLUMNS = ("quantity", "position", "unit", "value", "x", "y", "size")  # and the angle, in the file's unit
SCALAR, VECTOR = COLUMNS[3:4], (*COLUMNS[4:], "angle")  # where an answer is written
PLAIN_KEY = re.compile(r"[^\W\d_][\w ,.*/^%°·-]*")


def write_template(task: Task, path: str | os.PathLike[str]) -> None:
    """Write an empty answer sheet for one student; the file extension selects the format: .xlsx, .csv or .yaml.

    Raises:
        ProblemError: The extension is unknown.
    """
    kind = Path(path).suffix.lower()
    if kind not in FORMATS:
        raise ProblemError(
            _("an answer sheet cannot have this file extension"), found=quote(kind), allowed=", ".join(FORMATS)
        )
    write_atomically(Path(path), FORMATS[kind](task))


def _header(task: Task) -> list[str]:
    return [*COLUMNS, f"angle, {task.units.symbol(ANGLE)}"]


def _row(one: Question, task: Task) -> list[str | int]:
    position = "" if one.number is None else one.number
    return [one.quantity.name, position, task.units.symbol(one.quantity.dimension)]


def _csv(task: Task) -> bytes:
    """Return the answer sheet as CSV with semicolons and a byte-order mark, so that Excel opens it as a table."""
    found = io.StringIO()
    writer = csv.writer(found, delimiter=";", lineterminator="\r\n")
    writer.writerow(_header(task))
    for one in task.asked:
        row = _row(one, task)
        writer.writerow([*row, *[""] * (len(COLUMNS) + 1 - len(row))])
    return found.getvalue().encode("utf-8-sig")


def _xlsx(task: Task) -> bytes:
    """Return the answer sheet as XLSX; cells that the student must leave empty are grey."""
    found = io.BytesIO()
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}
    with open_workbook("XLSX", found, options, _("a CSV file; for XLSX, run: pip install 'tmm-cli[excel]'")) as book:
        sheet = book.add_worksheet("answers")
        head, grey = book.add_format({"bold": True, "bottom": 1}), book.add_format({"bg_color": "#D9D9D9"})
        room = book.add_format({"border": 1})
        sheet.write_row(0, 0, _header(task), head)
        for n, one in enumerate(task.asked, start=1):
            sheet.write_row(n, 0, _row(one, task))
            wanted = VECTOR if one.quantity.vector else SCALAR
            for k, name in enumerate((*COLUMNS, "angle")[3:], start=3):
                sheet.write_blank(n, k, None, room if name in wanted else grey)
        sheet.set_column(0, 0, max(12, *(len(one.quantity.name) + 2 for one in task.asked)))
        sheet.set_column(3, len(COLUMNS), 12)
        sheet.freeze_panes(1, 0)
    return found.getvalue()


def _yaml(task: Task) -> bytes:
    """Return the answer sheet as YAML, with a line for each answer."""
    lines = [
        _(
            "# Write each answer after the colon. To use another unit, write it after the number: 1.31 m/s. "
            "Vectors: (1.2; -3.4) or 3.6 at 34 deg."
        ),
        "answers:",
    ]
    for one in task.asked:
        unit = task.units.symbol(one.quantity.dimension)
        key = f"{one.name}, {unit}" if unit else one.name
        lines.append(f"  {key if PLAIN_KEY.fullmatch(key) else json.dumps(key, ensure_ascii=False)}:")
    return ("\n".join(lines) + "\n").encode()


FORMATS: dict[str, Callable[[Task], bytes]] = {".xlsx": _xlsx, ".csv": _csv, ".yaml": _yaml}
