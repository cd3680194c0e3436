"""Marks of earlier runs, so that only what has changed is graded: a line a student, added as soon as it is graded.

A line has the key of what it was graded from, a digest of the rest, and the marks as JSON. A line that is damaged is as
if it were not there.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import fields
from hashlib import blake2b
from pathlib import Path
from typing import Any

from tmm_cli.grading.record import Mark, StudentMarks, Submission, VariantTable
from tmm_cli.grading.task import Task
from tmm_cli.grading.workers import program_digest
from tmm_cli.language import language

NAMES = tuple(field.name for field in fields(Mark))
VECTORS = ("value", "right")


def key_of(task: Task, table: VariantTable, submission: Submission) -> str:
    """A digest of all that the marks of a student come from: program, task, variant, what was handed in."""
    row = table.rows.get(submission.student)
    return _digest(program_digest(), language(), task.tree.data, table.names, row, submission)


def _digest(*parts: object) -> str:
    return blake2b(repr(parts).encode(errors="backslashreplace"), digest_size=16).hexdigest()


def _line(key: str, marks: StudentMarks) -> str:
    """A line of the file, without its end."""
    rows = [[_plain(getattr(mark, name), name) for name in NAMES] for mark in marks.marks]
    text = json.dumps([marks.student, rows, marks.problems])
    return f"{key} {_digest(text)} {text}"


def _plain(value: Any, name: str) -> Any:
    """A value of a mark as JSON has it: of a vector, which may be a real number, both components."""
    if name not in VECTORS or value is None:
        return value
    number = complex(value)
    return [number.real, number.imag]


def read_kept(path: Path, keys: Collection[str]) -> dict[str, StudentMarks]:
    """The marks under these keys, as far as the file has them."""
    found: dict[str, StudentMarks] = {}
    try:
        with path.open(encoding="ascii", errors="replace") as stream:
            for line in stream:
                key, _, rest = line.rstrip("\n").partition(" ")
                digest, _, text = rest.partition(" ")
                if key in keys and digest == _digest(text):
                    with suppress(TypeError, ValueError, KeyError):  # of another form: graded again
                        found[key] = _marks(text)
    except OSError:
        pass  # there is none yet, or none that can be read
    return found


def _marks(text: str) -> StudentMarks:
    student, rows, problems = json.loads(text)
    return StudentMarks(student, tuple(_mark(dict(zip(NAMES, row, strict=True))) for row in rows), tuple(problems))


def _mark(row: dict[str, Any]) -> Mark:
    vectors = {name: None if row[name] is None else complex(*row[name]) for name in VECTORS}
    return Mark(**row | vectors | {name: tuple(row[name]) for name in ("key", "reasons", "mistakes")})


def keep(path: Path, marks: Mapping[str, StudentMarks]) -> None:
    """Add marks by their keys. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="ascii") as stream:
        stream.writelines(f"\n{_line(key, own)}" for key, own in marks.items())
