"""Output formats of grading. To add one, write a function that yields file names with contents; list it in EXPORTS."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from typing import Final

from tmm_cli.grading.exports import csv_files, feedback, gradescope_junit, result_json, xlsx
from tmm_cli.grading.exports.book import Export, Gradebook
from tmm_cli.problem import ProblemError
from tmm_cli.reports import StagedFolder, write_atomically

EXPORTS: Final[Mapping[str, Export]] = {
    "csv": csv_files.csv_tables,
    "xlsx": xlsx.xlsx_file,
    "feedback": feedback.feedback_files,
    "gradescope": gradescope_junit.gradescope_files,
    "moodle": csv_files.moodle_file,
    "junit": gradescope_junit.junit_file,
    "drawing": lambda book: import_module("tmm_cli.grading.group_chart").files(book),
    "json": result_json.result_file,
}


def write_formats(
    folder: Path,
    book: Gradebook,
    formats: Collection[str] = tuple(EXPORTS),
    say: Callable[[str], None] = lambda note: None,
) -> None:
    """Write a gradebook in several formats.

    All files are prepared first, and each then appears completely or not at all. Other files in the folder are kept.

    Args:
        folder: Folder for the files.
        book: Gradebook.
        formats: Names of formats, keys of EXPORTS.
        say: Called with a message for each format that cannot be written; that format is skipped.

    Raises:
        OSError: A file cannot be written.
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
