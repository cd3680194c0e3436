"""File formats of other programs, one module each; all are read into an ImportedMechanism."""

from __future__ import annotations

from typing import Final, Protocol

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats import linkage_v2, pmks_link, pylinkage
from tmm_cli.problem.formats.imported_mechanism import ImportedMechanism


class FileFormat(Protocol):
    """Interface of the module of a format."""

    def recognised(self, text: str) -> bool: ...
    def read(self, text: str, file: str) -> ImportedMechanism: ...


FORMATS: Final[dict[str, FileFormat]] = {
    "pylinkage": pylinkage,
    "PMKS+, a saved link": pmks_link,
    "linkage/v2": linkage_v2,
}


def read_mechanism(text: str, file: str) -> ImportedMechanism:
    """Read the mechanism of a file, whichever supported format it has. Raises ProblemError."""
    for file_format in FORMATS.values():
        if file_format.recognised(text):
            return file_format.read(text, file)
    raise ProblemError(_("the format of this file is not supported"), allowed="; ".join(FORMATS), file=file)
