"""What grading writes. A further format is a file here, whose function gives its files by name, and a line below."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Final

from tmm_cli.grading.exports import (
    feedback,
    gradescope,
    group,
    junit,
    moodle,
    tables_csv,
    xlsx,
)
from tmm_cli.grading.exports.book import Export, Gradebook
from tmm_cli.results.files import Staged, write_whole

EXPORTS: Final[Mapping[str, Export]] = {
    "csv": tables_csv.files,
    "xlsx": xlsx.files,
    "feedback": feedback.files,
    "gradescope": gradescope.files,
    "moodle": moodle.files,
    "junit": junit.files,
    "drawing": group.files,
}


def write(folder: Path, book: Gradebook, formats: Collection[str] = tuple(EXPORTS)) -> None:
    """Write a gradebook: each file and each folder of files whole or not at all, and none before all are there.

    Other files in the folder stay. Raises OSError.
    """
    whole: dict[str, bytes] = {}
    with ExitStack() as stack:
        staged: dict[str, Staged] = {}
        for name in formats:
            for file, content in EXPORTS[name](book):
                inner, between, rest = file.rpartition("/")
                if not between:
                    whole[file] = b"".join(p if isinstance(p, bytes) else p.encode() for p in content)
                    continue
                if inner not in staged:
                    staged[inner] = stack.enter_context(Staged(folder / inner))
                staged[inner].write(rest, content)
    for file, data in whole.items():
        write_whole(folder / file, data)
