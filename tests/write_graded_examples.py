"""Writes the graded examples of the bank, problems/grading: python tests/write_graded_examples.py.

Three tasks with made-up submissions of 12 students each: right ones off drawings, ones with a mistake in (computed by
the product with that mistake), one that was copied, and broken ones. `tmm check problems` grades them again.
"""

from __future__ import annotations

import csv
from datetime import datetime
from pathlib import Path

import numpy as np
import xlsxwriter

from tmm_cli.batch import read_task, split_families
from tmm_cli.grading import VariantTable, compute_right_answers, list_cases, predict_answers, read_parameter_values
from tmm_cli.problem import read_file

PROBLEMS = Path(__file__).parents[1] / "problems"
NAMES = [
    "Antonova",
    "Borisov",
    "Vasic",
    "Georgieva",
    "Dimitrov",
    "Jovanovic",
    "Zaitseva",
    "Ivanov",
    "Kovac",
    "Lebedeva",
    "Markovic",
    "Novak",
]
DRAWING = 0.01  # of the largest value
MISTAKES = {  # of the students, by number: the mistake, or of whom the sheet was copied, or what broke
    3: "Coriolis",
    4: "Rpm",
    5: "WeightForMass",
    6: "Sense",
    7: "OppositeReaction",
    8: "copy",
    9: "broken",
    10: "late",
}
TASKS = {
    "shaper": (
        "shaper",
        "variants: {OA: {from: 95, to: 120, step: 5}, n1: {among: [70 rpm, 80 rpm, 90 rpm]}}",
        """
grading:
  answers:
    - {of: class}
    - {of: H, points: 2}
    - {of: k}
    - {of: v of E, at: [3, 7], points: 2}
    - {of: omega of 3, at: [3, 7]}
    - {of: a of E, at: [3, 7], points: 2}
    - {of: epsilon of 3, at: [3, 7]}
    - {of: R_34, at: [3, 7], points: 2}
    - {of: R_03, at: 7, points: 2}
    - {of: M_b, at: [3, 7], points: 3}
""",
    ),
    "six-bar": (
        "six-bar",
        "variants: {OA: {from: 80, to: 105, step: 5}, BF: {from: 430, to: 490, step: 10}, "
        "n1: {from: 80 rpm, to: 110 rpm, step: 5 rpm}}",
        """
grading:
  from: either
  count: 1
  reveal: true
  answers:
    - {of: W}
    - {of: H}
    - {of: v of B, at: [4, 9]}
    - {of: v of F, at: [4, 9]}
    - {of: a of B, at: [4, 9]}
    - {of: a of F, at: [4, 9], points: 2}
    - {of: U of 5, at: [4, 9]}
    - {of: R_45, at: [4, 9], points: 2}
    - {of: M_b, at: [4, 9], points: 3}
""",
    ),
    "crank-slider": (
        "crank-slider",
        "variants: {r: {from: 50, to: 70, step: 5}, l: {from: 200, to: 240, step: 10}}",
        """
grading:
  drawn: false
  answers:
    - {of: H}
    - {of: s of 3, at: [2, 5, 8]}
    - {of: v of B, at: [2, 5, 8]}
    - {of: a of B, at: [2, 5, 8]}
    - {of: R_12, at: [2, 5, 8], points: 2}
    - {of: M_b, at: [2, 5, 8], points: 2}
""",
    ),
}


def written(asked, value):
    """An answer as a student writes it: number and unit."""
    units = {
        "H": ("mm", 1e3),
        "s of": ("mm", 1e3),
        "v of": ("m/s", 1),
        "omeg": ("1/s", 1),
        "a of": ("m/s^2", 1),
        "epsi": ("1/s^2", 1),
        "U of": ("N", 1),
        "R_": ("N", 1),
        "M_b": ("N*m", 1),
    }
    unit, factor = next((u for start, u in units.items() if asked.quantity.name.startswith(start)), ("", 1))
    value = value * factor
    if asked.quantity.against == "exact":
        return "II" if asked.quantity.name == "class" else f"{value.real:.0f}", ""
    if asked.quantity.vector and asked.quantity.name.startswith("R_"):
        return f"{abs(value):.4g} at {np.degrees(np.angle(value)) % 360:.1f} deg", unit
    if asked.quantity.vector:
        return f"{abs(value):.4g}", unit
    return f"{value.real:.4g}", unit


def sheets(task, table, random):
    """Answers of every student, as text; None: nothing that could be read."""
    dimensions, columns = read_parameter_values(task, table, NAMES)
    family = next(split_families(lambda x: task.make(table.names, dimensions, x), columns))[1]
    known = compute_right_answers(family, task.asked)
    by_kind = {type(case).__name__: case for case in reversed(list_cases(family))}
    found = []
    for n in range(len(NAMES)):
        values = known.value[n]
        case = by_kind.get(MISTAKES.get(n, ""))
        if case is not None:
            values = predict_answers(family.take(np.array([n])), task.asked, [case])[0]
        if MISTAKES.get(n) == "copy":
            values = known.value[n - 7]
        if MISTAKES.get(n) == "late":  # an early answer that is wrong, and what follows from it
            values = values.copy()
            values[2] = values[2] * 1.3
        size = DRAWING if task.rules.drawn else 0.001
        exact = np.array([asked.quantity.against == "exact" for asked in task.asked])
        error = random.uniform(-size, size, values.shape) * np.maximum(known.scale[n], np.abs(values))
        found.append(values + np.where(exact, 0, error))
    return found


def main():
    for name, (problem, free, grading) in TASKS.items():
        random = np.random.default_rng(len(name))
        folder = PROBLEMS / "grading" / name
        folder.mkdir(parents=True, exist_ok=True)
        text = (PROBLEMS / f"{problem}.yaml").read_text(encoding="utf-8")
        body = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
        head = f"# A task for a group, made of problems/{problem}.yaml: what is free in it, and how it is marked.\n"
        (folder / "task.yaml").write_text(f"{head}{body}\n{free}{grading}", encoding="utf-8")
        task = read_task(read_file(str(folder / "task.yaml")))
        table = variants(task, folder, random)
        hand_in(task, name, folder, sheets(task, table, random))


def variants(task, folder, random):
    """A table made by hand: units in the header, decimal points, semicolons."""
    free = task.tree.data["variants"]
    rows = {}
    for name in NAMES:
        row = []
        for own in free.values():
            values = own.get("among")
            if values is None:
                low, high, step = (float(str(own[key]).split()[0]) for key in ("from", "to", "step"))
                unit = " rpm" if "rpm" in str(own["from"]) else ""
                values = [f"{x:g}{unit}" for x in np.arange(low, high + step / 2, step)]
            row.append(str(random.choice(values)))
        rows[name] = tuple(row)
    with (folder / "variants.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter=";").writerows([["student", *free], *([name, *row] for name, row in rows.items())])
    return VariantTable(tuple(free), rows)


def hand_in(task, name, folder, found):
    cells = [[written(asked, value) for asked, value in zip(task.asked, row, strict=True)] for row in found]
    heads = [asked.name for asked in task.asked]
    if name == "shaper":  # a file of each student, in the format that the student likes
        submissions = folder / "submissions"
        submissions.mkdir(exist_ok=True)
        for n, (student, row) in enumerate(zip(NAMES, cells, strict=True)):
            if MISTAKES.get(n) == "broken":
                (submissions / f"{student}.yaml").write_text("answers: [v of E: 1,2\n", encoding="utf-8")
                continue
            rows = [["quantity", "position", "value", "unit"]]
            for asked, (value, unit) in zip(task.asked, row, strict=True):
                rows.append([asked.quantity.name, "" if asked.number is None else asked.number, value, unit])
            if n % 3 == 1:
                comma = [[str(cell).replace(".", ",") if k == 2 else cell for k, cell in enumerate(r)] for r in rows]
                with (submissions / f"{student}.csv").open("w", encoding="utf-8-sig", newline="") as file:
                    csv.writer(file, delimiter=";").writerows(comma)
            else:
                with (submissions / f"{student}.csv").open("w", encoding="utf-8", newline="") as file:
                    csv.writer(file).writerows(rows)
    elif name == "six-bar":  # one wide table of all, units in the cells
        with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["student", *heads])
            for n, (student, row) in enumerate(zip(NAMES, cells, strict=True)):
                own = [
                    f"{value} {unit}" if " at " not in value else value.replace(" at", f" {unit} at")
                    for value, unit in row
                ]
                writer.writerow(
                    [student, *(["=2+3", "n/a"] * 99)[: len(own)]]
                    if MISTAKES.get(n) == "broken"
                    else [student, *map(str.strip, own)]
                )
    else:  # a workbook, units in the header
        book = xlsxwriter.Workbook(str(folder / "answers.xlsx"), {"strings_to_formulas": False})
        book.set_properties({"created": datetime(2026, 1, 1)})  # the same bytes whenever it is written
        sheet = book.add_worksheet("answers")
        for k, (head, (_value, unit)) in enumerate(zip(heads, cells[0], strict=True)):
            sheet.write_string(0, k + 1, f"{head}, {unit}" if unit else head)
        sheet.write_string(0, 0, "student")
        for n, (student, row) in enumerate(zip(NAMES, cells, strict=True)):
            sheet.write_string(n + 1, 0, "Nobody" if MISTAKES.get(n) == "broken" else student)
            for k, (value, _unit) in enumerate(row):
                sheet.write_string(n + 1, k + 1, value)
        book.close()


if __name__ == "__main__":
    main()
