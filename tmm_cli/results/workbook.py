"""Workbooks for spreadsheets, where the extra is installed that writes them."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from io import BytesIO
from typing import Any, Final

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError

INSTALL: Final = "pip install 'tmm-cli[excel]'"
WRITTEN: Final = datetime(2000, 1, 1)  # the same tables give the same bytes
PLAIN: Final = {"constant_memory": True, "strings_to_formulas": False, "strings_to_urls": False,
                "strings_to_numbers": False}  # fmt: skip


def empty_workbook(file: str, stream: BytesIO, options: Mapping[str, bool] = PLAIN, allowed: str = INSTALL) -> Any:
    """One of xlsxwriter that is to be written into a stream; file: what a refusal calls it. Raises ProblemError."""
    try:
        from xlsxwriter import Workbook
    except ImportError:
        raise ProblemError(
            _("{file} is written by xlsxwriter, which is not installed").format(file=file), allowed=allowed
        ) from None
    return Workbook(stream, dict(options))
