"""Files of other programs: a format is a file here, and a line below; all are read into a Foreign, which is written."""

from __future__ import annotations

from typing import Final, Protocol

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats import linkage_v2, pmks_link, pylinkage
from tmm_cli.problem.formats.imported_mechanism import ImportedMechanism


class FileFormat(Protocol):
    """A module."""

    def recognised(self, text: str) -> bool: ...
    def read(self, text: str, file: str) -> ImportedMechanism: ...


FORMATS: Final[dict[str, FileFormat]] = {
    "pylinkage": pylinkage,
    "PMKS+, a saved link": pmks_link,
    "linkage/v2": linkage_v2,
}


def read_mechanism(text: str, file: str) -> ImportedMechanism:
    """The mechanism of a file in the format that it is of. Raises ProblemError."""
    for one in FORMATS.values():
        if one.recognised(text):
            return one.read(text, file)
    raise ProblemError(_("the format of this file is not supported"), allowed="; ".join(FORMATS), file=file)
