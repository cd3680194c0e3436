"""File formats of other programs, one module per format. Every reader returns an ImportedMechanism."""

from __future__ import annotations

from typing import Final, Protocol

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.formats import linkage_v2, pmks_link, pylinkage
from tmm_cli.problem.formats.imported_mechanism import ImportedMechanism


class FileFormat(Protocol):
    """Interface of a module that reads a file format.

    Its function `recognised` returns True for a text in this format, and `read` reads the text.
    """

    def recognised(self, text: str) -> bool: ...
    def read(self, text: str, file: str) -> ImportedMechanism: ...


FORMATS: Final[dict[str, FileFormat]] = {
    "pylinkage": pylinkage,
    "PMKS+, a saved link": pmks_link,
    "linkage/v2": linkage_v2,
}


def read_mechanism(text: str, file: str) -> ImportedMechanism:
    """Read a mechanism from a file of another program, in any of the supported formats.

    Args:
        text: content of the file.
        file: name of the file, for messages.

    Raises:
        ProblemError: the format is not supported, or the content is wrong.
    """
    for file_format in FORMATS.values():
        if file_format.recognised(text):
            return file_format.read(text, file)
    raise ProblemError(_("the format of this file is not supported"), allowed="; ".join(FORMATS), file=file)
