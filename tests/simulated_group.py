"""Figures of the diagnosis on simulated students: how often it is right, wrong or silent.

`python -m tests.simulated_group` prints them for both linkages.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from simulated_students import (
    FACTORS,
    MISCOPIED,
    SHAPER_ASKED,
    SHAPER_MISTAKES,
    SIX_BAR_ASKED,
    SIX_BAR_MISTAKES,
    SLIPS,
    UNKNOWN,
    Work,
    answers_of,
    figures,
    shaper,
    six_bar,
    written,
)

from tmm_cli.batch import read_task
from tmm_cli.grading import ReadAnswer, Submission, VariantTable, find_copies, grade
from tmm_cli.problem import read_text

PROBLEMS = Path(__file__).parents[1] / "problems"
TASKS = {"shaper": (SHAPER_ASKED, shaper, SHAPER_MISTAKES), "six-bar": (SIX_BAR_ASKED, six_bar, SIX_BAR_MISTAKES)}
UNITS = {
    "H": "m",
    "k": "",
    "omega": "rad/s",
    "v": "m/s",
    "epsilon": "rad/s^2",
    "a": "m/s^2",
    "M_b": "N*m",
    "R_34": "N",
    "R_03": "N",
    "R_45": "N",
}
NAMES = {  # of the product's mistakes, where those of the simulated students are readings of one of them
    "other-extreme": "other-zero",
    "x-axis-zero": "other-zero",
    "sense-own-zero": "sense",
    "sense-counted": "sense",
    "coriolis-reversed": "coriolis-left-out",
    "mass-for-weight": "weight-left-out",
    "load-both-strokes": "load-wrong-stroke",
}


@dataclass(frozen=True)
class Sheet:
    """A student's variant, work, and answers without drawing errors.

    wrong: number of answers that the mistake moves so far that no drawing error hides it.
    """

    numbers: tuple[float, float]
    work: Work
    right: dict
    values: dict
    drawn: dict

    def moved(self, allowed):
        """Questions whose answers the mistake moves beyond the tolerance, drawing errors included."""
        return [key for key in self.values if self._moves(key, allowed[key])]

    def _moves(self, key, allowed):
        right = self.right[key[0]][key[1] or 0]
        gap, largest = abs(self.values[key] - right), np.max(np.abs(self.right[key[0]]))
        return not gap <= (allowed + 0.025) * largest


class Group:
    """Simulated students of one linkage."""

    def __init__(self, name, seed=1):
        asked, self.solve, self.mistakes = TASKS[name]
        self.name, self.random = name, np.random.default_rng(seed)
        self.text, self.asked = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8"), asked
        self.task = read_task(read_text(self.text + asked, "task.yaml"))
        self.keys = [one.key for one in self.task.asked]

    def reversed_task(self):
        """The same task with its questions in reverse order."""
        head, _, questions = self.asked.rpartition("  answers:\n")
        lines = reversed(questions.splitlines(keepends=True))
        return read_task(read_text(f"{self.text}{head}  answers:\n{''.join(lines)}", "task.yaml"))

    def sheet(self, work):
        low, high = ((0.095, 0.12), (0.09, 0.11))[self.name == "six-bar"]
        numbers = round(self.random.uniform(low, high), 4), round(self.random.uniform(75, 100), 1)
        right, values = answers_of(self.solve, numbers, self.keys, work, self.random)
        return Sheet(numbers, work, right, values, written(right, values, self.keys, self.random))

    def one_wrong_answer(self):
        """A right sheet in which one random answer is off by 15 to 100 % of its largest value, in any direction."""
        sheet = self.sheet(Work())
        key = self.keys[self.random.integers(len(self.keys))]
        right = np.asarray(sheet.right[key[0]])
        largest, sign = np.max(np.abs(right)), self.random.choice([-1, 1])
        turn = sign if not np.any(right.imag) else np.exp(2j * np.pi * self.random.random())
        value = right[key[1] or 0] + self.random.uniform(0.15, 1) * largest * turn
        number = complex(figures(value.real), figures(value.imag)) if np.iscomplexobj(right) else figures(value)
        sheet.drawn[key] = number
        return sheet

    def slip(self, name, number):
        """A sheet with a wrong intermediate result in one position, from which the student goes on rightly."""
        factor = self.random.choice([self.random.uniform(0.4, 0.85), self.random.uniform(1.2, 2)])
        sheet = self.sheet(Work(slips={name: factor}))
        if name != "omega_1":
            for key in self.keys:
                if key[1] != number:
                    sheet.values[key] = sheet.right[key[0]][key[1] or 0]
            sheet.drawn.update(written(sheet.right, sheet.values, self.keys, self.random))
        return sheet

    def copy(self, sheet, retouch):
        """The answers of a sheet handed in by a student with another variant, each changed by up to `retouch`."""
        own = self.sheet(Work())
        for key, value in sheet.drawn.items():
            value = value * (1 + self.random.uniform(-retouch, retouch)) if retouch else value
            numbers = figures(complex(value).real), figures(complex(value).imag)
            own.drawn[key] = complex(*numbers) if isinstance(value, complex) else numbers[0]
        return own

    def grade(self, sheets):
        names = [f"s{n}" for n in range(len(sheets))]
        rows = {n: (f"{s.numbers[0]} m", f"{s.numbers[1]} rpm") for n, s in zip(names, sheets, strict=True)}
        table = VariantTable(("OA", "n1"), rows)
        handed_in = [Submission(n, self._answers(s)) for n, s in zip(names, sheets, strict=True)]
        return find_copies(list(grade(self.task, table, handed_in)))

    def _answers(self, sheet):
        found = {}
        for key, value in sheet.drawn.items():
            unit = UNITS[key[0].split(" of ")[0]]
            if isinstance(value, complex) and key[0][:2] in ("v ", "a "):  # along the guide
                found[key] = ReadAnswer(value.real, 0.0, "number", unit, text=f"{value.real}")
            elif isinstance(value, complex):
                found[key] = ReadAnswer(value.real, value.imag, "components", unit, text=f"{value}")
            else:
                found[key] = ReadAnswer(value, 0.0, "number", unit, text=f"{value}")
        return found

    def verdict(self, sheet, marks):
        """How the mistake was named: right, wrong, both or silent."""
        claims = {claim for mark in marks.marks for claim in mark.identifiers}
        code = sheet.work.mistake.partition(":")[0]
        wanted = {code, NAMES.get(code, code)}
        wanted |= {one for one, of in NAMES.items() if of in wanted}
        hits = [bool(wanted & set(re.split("[:|]", claim))) for claim in claims]
        return "silent" if not hits else "right" if all(hits) else "both" if any(hits) else "wrong"


def recognisable(group, count):
    """Sheets with one mistake that moves two answers or more, and how it was named, by mistake."""
    sheets = []
    for mistake in group.mistakes:
        for _ in range(count):
            factor = group.random.choice(FACTORS[mistake]) if mistake in FACTORS else 1.0
            sheets.append(group.sheet(Work(mistake, factor)))
    found, lone = Counter(), Counter()
    for sheet, marks in zip(sheets, group.grade(sheets), strict=True):
        allowed = {mark.key: mark.allowed for mark in marks.marks}
        moved = sheet.moved(allowed)
        if moved:
            (found if len(moved) > 1 else lone)[sheet.work.mistake, group.verdict(sheet, marks)] += 1
    return found, lone


def unknown(group, count):
    works = [Work(name) for name in UNKNOWN] + [
        Work(slips={name: f}) for name in MISCOPIED[group.name] for f in (0.93, 1.08)
    ]
    sheets = [group.sheet(work) for work in works for _ in range(count)]
    return sheets, group.grade(sheets)


def told(found):
    """Students to whom a mistake was named."""
    return sum(any(mark.mistakes for mark in marks.marks) for marks in found)


def lost(marks):
    return [mark.key for mark in marks.marks if mark.state == "wrong"]


def show(counts):
    total = Counter()
    for (_, verdict), number in counts.items():
        total[verdict] += number
    whole = sum(total.values())
    return f"{whole}: " + ", ".join(f"{v} {n} ({100 * n / max(1, whole):.0f} %)" for v, n in total.items())


def main(count=8):
    for name in TASKS:
        group = Group(name)
        found, lone = recognisable(group, count)
        print(f"{name}: recognisable {show(found)}; in one answer {show(lone)}")
        for mistake in group.mistakes:
            verdicts = {v: n for (m, v), n in found.items() if m == mistake}
            if set(verdicts) != {"right"}:
                print("   ", mistake, verdicts)
        sheets, marks = unknown(group, count)
        print(f"  no model: {len(sheets)}, told {told(marks)}")
        sheets = [group.sheet(Work()) for _ in range(200)]
        marks = group.grade(sheets)
        print(f"  right: {len(sheets)}, told {told(marks)}, with a wrong answer {sum(map(bool, map(lost, marks)))}")
        marks = group.grade([group.one_wrong_answer() for _ in range(200)])
        print(f"  one random wrong answer: 200, told {told(marks)}")
        sheets = [group.slip(s, n) for s in SLIPS[name] for n in sorted({k[1] for k in group.keys if k[1]}) * 4]
        marks = group.grade(sheets)
        one = sum(len({k[1] for k in lost(m)}) == len(lost(m)) for m in marks)
        print(f"  slips: {len(sheets)}, told {told(marks)}, of whom lose at most one answer in a position {one}")
        by = Counter()
        for s, m in zip(sheets, marks, strict=True):
            (slip,) = s.work.slips
            by[slip, "told"] += told([m])
            by[slip, "lost"] += len({k[1] for k in lost(m)}) < len(lost(m))
        print("   ", {k: v for k, v in by.items() if v})


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
