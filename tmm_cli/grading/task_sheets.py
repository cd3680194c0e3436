"""Task sheets of the students: scheme, dimensions, requested quantities, and a problem file for each student."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from itertools import groupby

import yaml

from tmm_cli.batch import Question, Task
from tmm_cli.drawing.formats import write_png
from tmm_cli.drawing.sheets import task_picture
from tmm_cli.grading.record import VariantTable
from tmm_cli.grading.untrusted_tables import printable_text
from tmm_cli.language import N_, _, spelt, translated
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.quantities import DIMENSIONS, LENGTH, NUMBER, Dimension
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.reports import Table, folder_name, input_data_tables, text_table
from tmm_cli.synthesis import structure_of

FOR_TEACHERS = ("variants", "grading")
MEASURES = (LENGTH, *(kind.dimension for kind in DIMENSIONS.values()))
PLAIN = re.compile(r"[\w.+\-*/^()° ]+")
SIGNS = re.compile(r"([\\`*_\[\]|#~])")  # of markup
MEANINGS = {  # of what is asked, by the name before ` of ` or `_`
    "W": N_("mobility"),
    "class": N_("class of the mechanism"),
    "n": N_("number of moving links"),
    "p1": N_("number of pairs with one degree of freedom"),
    "p2": N_("number of pairs with two degrees of freedom"),
    "passive": N_("number of redundant constraints"),
    "H": N_("stroke of the output link"),
    "strokes": N_("number of strokes of the output link in a cycle"),
    "psi": N_("swing angle of the output link"),
    "k": N_("time ratio: duration of the working stroke divided by that of the return stroke"),
    "x": N_("coordinate in the axes of the frame"),
    "y": N_("coordinate in the axes of the frame"),
    "v": N_("velocity, a vector"),
    "a": N_("acceleration, a vector"),
    "phi": N_(
        "angle from the x axis to the direction from the link's first point to its second, positive counterclockwise"
    ),
    "s": N_(
        "displacement along the guide from its reference point; for an oscillating output link, the angle of this link"
    ),
    "omega": N_("angular velocity, positive counterclockwise"),
    "epsilon": N_("angular acceleration, positive counterclockwise"),
    "jerk": N_("jerk, the derivative of the acceleration; of a link, of its angular acceleration"),
    "v along": N_("velocity of the link along its guide, positive where its displacement increases"),
    "a along": N_("acceleration of the link along its guide, positive where its displacement increases"),
    "v on": N_("relative velocity or acceleration of one link along its guide on the other link"),
    "a on": N_("relative velocity or acceleration of one link along its guide on the other link"),
    "Coriolis": N_("Coriolis acceleration, a vector"),
    "U": N_("inertia force, a vector"),
    "M": N_("inertia couple, positive counterclockwise"),
    "R": N_("force of the first link on the second, a vector"),
    "arm": N_("point of action of the guide reaction: its distance along the guide from the sliding point"),
    "M_b": N_("balancing moment on the input link, positive counterclockwise"),
    "F_b": N_("balancing force on the input link"),
}
STYLE = """
body{font:16px/1.45 system-ui,sans-serif;color:#1a1a1a;max-width:52rem;margin:2rem auto;padding:0 1rem}
h1{font-size:1.35rem;margin:0}h2{font-size:1.05rem;margin:1.6rem 0 .3rem}.who{font-size:1.1rem;margin:.2rem 0 1rem}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.25rem 1.2rem .25rem 0;border-bottom:1px solid #ddd}
th{border-bottom:2px solid #1a1a1a}.note{color:#555;font-size:.87rem}
img{display:block;max-width:100%;max-height:36rem;margin:1rem auto}
@media print{body{margin:0;max-width:none;font-size:10.5pt}img{max-height:130mm}
tr,li,img{break-inside:avoid}h2{break-after:avoid}@page{margin:18mm}}
"""
SAFE = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"


def file_names(students: Iterable[str]) -> dict[str, str]:
    """Return a file name for each student, without extension. All names differ, even where case is ignored."""
    found: dict[str, str] = {}
    taken = {"variants", "key"}
    for student in students:
        base = folder_name(_("variant-{number}").format(number=student) if student.isdigit() else student)
        numbers = (base if n == 1 else f"{base}-{n}" for n in range(1, len(taken) + 2))
        found[student] = next(name for name in numbers if name.casefold() not in taken)
        taken.add(found[student].casefold())
    return found


class TaskSheets:
    """Writer of the files that each student receives. Its methods raise ProblemError.

    Attributes:
        task: the task.
        text: text of the task file.
        table: variants of the students.
        names: file name of each student, without extension.
        measures: dimension of each parameter.
    """

    def __init__(self, task: Task, text: str, table: VariantTable) -> None:
        self.task, self.text, self.table = task, text, table
        self.names, self.measures = file_names(table.rows), _parameter_dimensions(task)

    def build_files(self, student: str) -> Iterator[tuple[str, bytes]]:
        """Yield names and contents of a student's files: problem file, scheme, task sheet in Markdown and HTML."""
        name, title = self.names[student], self.task.problem.title
        who = _("Variant {number}").format(number=student) if student.isdigit() else printable_text(student)
        values = dict(zip(self.table.names, self.table.rows[student], strict=True))
        yield f"{name}.yaml", variant_problem_text(self.text, values).encode()
        results = structure_of(self.task.variant(values))
        figure = task_picture(results)
        picture = None if figure is None else write_png(figure)
        if picture is not None:
            yield f"{name}.png", picture
        tables = [
            _parameter_table(self.task, values, self.measures),
            *map(_reduce_facts, input_data_tables(results.problem)),
            *_question_tables(self.task),
        ]
        yield f"{name}.md", _markdown(title, who, f"{name}.png" if picture else "", tables).encode()
        yield f"{name}.html", _page(title, who, picture, tables).encode()


def variant_problem_text(text: str, values: Mapping[str, str]) -> str:
    """Return the text of a task file with the parameter values of a variant, without the blocks for the teacher."""
    tree = read_text(text, "")
    ends = {}
    for event in yaml.parse(text):
        start, end = event.start_mark, event.end_mark
        if isinstance(event, yaml.ScalarEvent) and start and end:
            ends[start.line + 1, start.column + 1] = start.index, end.index
    changes = []
    for name, value in values.items():
        mark = tree.marks["parameters", name]
        place = ends[mark.line, mark.column]
        changes.append((*place, value if PLAIN.fullmatch(value) else json.dumps(value, ensure_ascii=False)))
    for first, last, value in sorted(changes, reverse=True):
        text = text[:first] + value + text[last:]
    return _remove_teacher_blocks(text)


def _remove_teacher_blocks(text: str) -> str:
    tree = read_text(text, "")
    lines = text.splitlines(keepends=True)
    starts = sorted(mark.line for path, mark in tree.key_marks.items() if len(path) == 1)
    for block in FOR_TEACHERS:
        mark = tree.key_marks.get((block,))
        if mark is not None and mark.column == 1:
            end = next((line for line in starts if line > mark.line), len(lines) + 1)
            lines[mark.line - 1 : end - 1] = [""] * (end - mark.line)
    return "".join(lines)


def _parameter_table(task: Task, values: Mapping[str, str], measures: Mapping[str, Dimension | None]) -> Table:
    """Return the table of all parameters of a variant with their units."""
    rows = []
    for name, own in (task.tree.data.get("parameters") or {}).items():
        text = values.get(name, str(own))
        number, _space, unit = text.partition(" ")
        measure = measures[name]
        unit = spelt(unit) or (task.units.spelt(measure) if measure else "")
        rows.append((name, number, unit))
    return text_table("dimensions", _("Dimensions"), (_("name"), _("value"), _("unit")), rows)


def _reduce_facts(table: Table) -> Table:
    """Keep only the driver, the gravitational acceleration and the positions in the table `facts`.

    Any other table is returned unchanged.
    """
    if table.name != "facts":
        return table
    rows = zip(*(column.values for column in table.columns), strict=True)
    kept = [row for row in rows if row[0] in (_("driver"), _("gravitational acceleration"), _("positions"))]
    return text_table(
        table.name, _("Driver and positions"), [translated(column.header) for column in table.columns], kept
    )


def _parameter_dimensions(task: Task) -> dict[str, Dimension | None]:
    """Return the dimension of each parameter.

    For a parameter without a unit it is the first dimension with which the task file is valid.
    """
    found: dict[str, Dimension | None] = {}
    for name in task.tree.data.get("parameters") or {}:
        (own,) = task.values_in_file((name,))
        found[name] = own.dimension or next((d for d in MEASURES if _accepts_dimension(task, name, own.value, d)), None)
    return found


def _accepts_dimension(task: Task, name: str, value: float, dimension: Dimension) -> bool:
    try:
        task.make((name,), (dimension,), (task.units.si(value, dimension),))
    except (ProblemError, LinkageError):
        return False
    return True


def _question_tables(task: Task) -> Iterator[Table]:
    if task.blocks.grading is None:
        return
    if task.rules.from_ == "either":
        told = _(
            "Positions are numbered from {first}; the first one is either of the extreme positions of the output link."
        )
    else:
        told = _("Positions are numbered from {first}.")
    rows = []
    for name, group in groupby(task.asked, lambda one: one.quantity.name):
        every = list(group)
        numbers = ", ".join(str(one.number) for one in every if one.number is not None)
        points = f"{sum(one.points for one in every):.10g}"
        rows.append((name, numbers, _unit(task, every[0]), points, explain_quantity(every[0].quantity)))
    headers = (_("quantity"), _("positions"), _("unit"), _("maximum score"), _("meaning"))
    notes = [told.format(first=task.rules.count)]
    if any(one.quantity.vector for one in task.asked):
        notes.append(
            _(
                "Give a vector by its magnitude and direction (counterclockwise from the x axis), e.g. 3.6 at 34 "
                "deg, or by its components, e.g. (1.2; -3.4)."
            )
        )
    yield text_table("asked", _("Requested quantities"), headers, rows, notes)


def explain_quantity(quantity: NamedQuantity) -> str:
    """Return what the name of a quantity means, as a phrase for the student; "" if the name is unknown."""
    kind, _of, thing = quantity.name.partition(" of ")
    if f"{kind} on" in MEANINGS and not quantity.vector:
        kind = f"{kind} on" if " on " in thing else f"{kind} along"
    return _(MEANINGS.get(kind, MEANINGS.get(kind.partition("_")[0], "")))


def _unit(task: Task, asked: Question) -> str:
    dimension = asked.quantity.dimension
    return "" if dimension == NUMBER else task.units.spelt(dimension)


def _markdown(title: str, student: str, picture: str, tables: Iterable[Table]) -> str:
    def plain(text: str) -> str:
        return SIGNS.sub(r"\\\1", escape(" ".join(text.split()), quote=False))

    parts = [f"# {plain(title)}", f"**{plain(student)}**"]
    if picture:
        parts.append(f"![{plain(_('scheme'))}](<{picture}>)")
    for table in tables:
        rows = [[plain(translated(column.header)) for column in table.columns], ["---"] * len(table.columns)]
        rows += [[plain(str(cell)) for cell in row] for row in zip(*(c.values for c in table.columns), strict=True)]
        parts += [f"## {plain(table.title)}", "\n".join(f"| {' | '.join(row)} |" for row in rows)]
        parts += map(plain, table.notes)
    return "\n\n".join(parts) + "\n"


def _page(title: str, student: str, picture: bytes | None, tables: Iterable[Table]) -> str:
    """Return a task sheet as a self-contained HTML page without scripts."""
    body = [f'<h1>{escape(title)}</h1>\n<p class="who"><bdi>{escape(student)}</bdi></p>']
    if picture is not None:
        body.append(
            f'<img alt="{escape(_("scheme"))}" src="data:image/png;base64,{base64.b64encode(picture).decode()}">'
        )
    for table in tables:
        head = "".join(f"<th>{escape(translated(column.header))}</th>" for column in table.columns)
        rows = "\n".join(
            "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>"
            for row in zip(*(column.values for column in table.columns), strict=True)
        )
        body.append(f"<h2>{escape(table.title)}</h2>\n<table><tr>{head}</tr>\n{rows}\n</table>")
        body += (f'<p class="note">{escape(note)}</p>' for note in table.notes)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width,initial-scale=1">'
        f'<meta http-equiv="Content-Security-Policy" content="{SAFE}">'
        f"<title>{escape(title)}: {escape(student)}</title><style>{STYLE}</style></head>\n<body>\n"
        + "\n".join(body)
        + "\n</body></html>\n"
    )
