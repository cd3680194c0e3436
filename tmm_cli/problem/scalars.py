"""Values of unquoted words according to the YAML 1.2 core schema; decimal commas are detected."""

from __future__ import annotations

import math
import re
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, WrittenNumber, quote

Scalar = str | int | float | bool | None

MAX_DIGITS: Final = 40

# Control characters and invisible ones that reorder or hide text: an editor would not show what is read.
HIDDEN: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\xad\u200b-\u200f\u2028-\u202e\u2060-\u206f\ud800-\udfff\ufeff"
    "\ufff9-\ufffb\ufffe\uffff]"
)
_NULL = re.compile(r"null|Null|NULL|~|")
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.?(nan|inf|infinity)", re.IGNORECASE)
_WHOLE = re.compile(r"[-+]?[0-9]+")
_PART = re.compile(r"[0-9]+(\s*[^\W\d]\S*|\s*[°%])?")


def plain_value(text: str) -> Scalar:
    """Return the value of an unquoted word: null, a bool, a number or a text.

    Raises:
        ProblemError: the word is an invalid number. The error contains no position.
    """
    if _NULL.fullmatch(text):
        return None
    if text in _BOOL:
        return _BOOL[text]
    if _INT.fullmatch(text):
        if len(text) > MAX_DIGITS:
            allowed = _("at most {max_digits} digits").format(max_digits=MAX_DIGITS)
            raise ProblemError(_("the number is too long"), found=quote(text), allowed=allowed)
        return int(text, {"0o": 8, "0x": 16}.get(text[:2], 10))
    if _FLOAT.fullmatch(text):
        finite_float(text)
        return WrittenNumber(text)
    if _NOT_FINITE.fullmatch(text):
        raise ProblemError(_("the number must be finite"), found=quote(text), allowed=_("a finite number"))
    whole, comma, fraction = text.partition(",")
    if comma and is_split_number(whole, fraction):
        raise decimal_comma_error(whole, fraction)
    return text


def finite_float(text: str) -> float:
    """Convert decimal digits to a float.

    Raises:
        ProblemError: the number is too large or too small for float64.
    """
    number = float(text)
    if math.isinf(number) or (number == 0 and re.search("[1-9]", re.split("[eE]", text)[0])):
        raise ProblemError(
            _("the number is too large or too small"),
            found=quote(text),
            allowed=_("absolute values from 1e-300 to 1e300"),
        )
    return number


def is_split_number(whole: str, fraction: str) -> bool:
    """Return True if the texts around a comma may be a number with a decimal comma, like `1,5` or `1,5 mm`."""
    return bool(_WHOLE.fullmatch(whole) and _PART.fullmatch(fraction))


def decimal_comma_error(whole: str, fraction: str) -> ProblemError:
    """Return the error for a number with a decimal comma."""
    return ProblemError(
        _("decimal comma: write {whole}.{part}").format(whole=whole, part=fraction),
        found=quote(f"{whole},{fraction}"),
        allowed=_("a decimal point; a list is written [{whole}, {part}]").format(whole=whole, part=fraction),
    )
