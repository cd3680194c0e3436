"""What grading writes. A further format is a file here, whose function gives its files by name, and a line below."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from typing import Final

from tmm_cli.grading.exports import csv_files, feedback, gradescope_junit, xlsx
from tmm_cli.grading.exports.book import Export, Gradebook
from tmm_cli.problem import ProblemError
from tmm_cli.reports import StagedFolder, write_atomically

EXPORTS: Final[Mapping[str, Export]] = {
    "csv": csv_files.csv_tables,
    "xlsx": xlsx.files,
    "feedback": feedback.feedback_files,
    "gradescope": gradescope_junit.gradescope_files,
    "moodle": csv_files.moodle_file,
    "junit": gradescope_junit.junit_file,
    "drawing": lambda book: import_module("tmm_cli.grading.group_chart").files(book),
}


def write(
    folder: Path,
    book: Gradebook,
    formats: Collection[str] = tuple(EXPORTS),
    say: Callable[[str], None] = lambda note: None,
) -> None:
    """Write a gradebook: each file and each folder of files whole or not at all, and none before all are there.

    A format that cannot be written here is left out, and `say` is told why. Other files in the folder stay. Raises
    OSError.
    """
    whole: dict[str, bytes] = {}
    with ExitStack() as stack:
        staged: dict[str, StagedFolder] = {}
        for name in formats:
            try:
                for file, content in EXPORTS[name](book):
                    inner, between, rest = file.rpartition("/")
                    if not between:
                        whole[file] = b"".join(p if isinstance(p, bytes) else p.encode() for p in content)
                        continue
                    if inner not in staged:
                        staged[inner] = stack.enter_context(StagedFolder(folder / inner))
                    staged[inner].write(rest, content)
            except ProblemError as error:
                say(str(error))
    for file, data in whole.items():
        write_atomically(folder / file, data)
