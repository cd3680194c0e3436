"""Files that other programs read: a format is a function in a file here and an entry below."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tmm_cli.analysis.pipeline import Results
from tmm_cli.results.exports.pylinkage import pylinkage

EXPORTS: Final[dict[str, Callable[[Results], tuple[str, list[str]]]]] = {"pylinkage": pylinkage}  # text, what is left
