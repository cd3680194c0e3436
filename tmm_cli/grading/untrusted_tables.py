"""Reading of CSV and XLSX files from unknown sources as rows of text; size is limited, nothing is executed."""

from __future__ import annotations

import codecs
import csv
import io
import lzma
import os
import re
import signal
import stat
import sys
import zipfile
import zlib
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from datetime import date, datetime, time, timedelta
from multiprocessing import get_context
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from tmm_cli.language import N_, _
from tmm_cli.problem import ProblemError, quote

LONGEST_SHOWN = 200  # characters of a name, or of an answer as it was written
LONGEST_SENTENCE = 600
JOINERS = "\u200c\u200d"  # that words of Persian and of Indian languages need


def printable_text(text: str, longest: int = LONGEST_SHOWN) -> str:
    """Return an untrusted text as one line: control characters removed, cut to `longest` characters."""
    if len(text) > longest:
        text = text[: longest - 1] + "…"
    return text if text.isprintable() else re.sub(r"\s", " ", "".join(map(_printable_character, text)))


def _printable_character(sign: str) -> str:
    return sign if sign.isprintable() or sign.isspace() or sign in JOINERS else "\ufffd"


def printable_sentence(text: str) -> str:
    """Return a sentence that quotes an untrusted text as one printable line of at most LONGEST_SENTENCE characters."""
    return printable_text(text, LONGEST_SENTENCE)


# Calls that may exhaust the memory or abort, in one process that is started again after its end.


if sys.platform != "win32":
    import resource

P = ParamSpec("P")
T = TypeVar("T")


class ProcessEndedError(Exception):
    """The separate process ended before it returned a result."""


class GuardedProcess:
    """Separate process for function calls that may exhaust the memory or crash. It is started by the first call.

    Args:
        memory: Limit of its address space in bytes, on systems that support such a limit (POSIX).
    """

    def __init__(self, memory: int) -> None:
        self._memory = memory
        self._pool: ProcessPoolExecutor | None = None

    def call(self, function: Callable[P, T], *args: P.args, **named: P.kwargs) -> T:
        """Call a function in the process; return its result or raise its exception.

        Raises:
            ProcessEndedError: The process ended, e.g. for lack of memory; the next call starts another one.
        """
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, get_context("spawn"), _limit_process, (self._memory,))
        try:
            return self._pool.submit(function, *args, **named).result()
        except BrokenProcessPool:
            self._pool.shutdown(wait=False)
            self._pool = None
            raise ProcessEndedError from None


def _limit_process(memory: int) -> None:
    """Limit the memory of the current process, discard its error output and ignore Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    if sys.platform != "win32":
        __, most = resource.getrlimit(resource.RLIMIT_AS)
        limit = memory if most == resource.RLIM_INFINITY else min(memory, most)
        resource.setrlimit(resource.RLIMIT_AS, (limit, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


# Tables of other programs as rows of texts: CSV as people save it, and XLSX. Nothing of them is trusted or run.


READER = GuardedProcess(memory=2 << 30)
LARGEST = 2_000_000  # bytes of a file
MOST_ROWS = 10_000
MOST_COLUMNS = 500
LONGEST = 5_000  # characters of a cell
UNPACKED = 10  # times as large may be what is packed in an XLSX
COPIED = 100  # times as large its texts may be when every cell has the longest of them
PARTS = 1_000  # in an XLSX

_NAME, _GIVEN = rb"(?:[^\s<>/:]+:)?", rb"""\s*=\s*(?:"[^"<>]*"|'[^'<>]*')"""
PLACE = re.compile(  # a cell that says where it stands
    rb"<" + _NAME + rb"c(?:\s+(?!r\s*=)[\w:.-]+" + _GIVEN + rb"""){0,20}+\s+r\s*=\s*["']([A-Za-z]+)(\d+)["'][\s/>]"""
)
TEXT = re.compile(rb"</(?:[\w.-]+:)?si\s*>")
CELL = re.compile(rb"<" + _NAME + rb"c[\s/>]")
COUNTING = re.compile(rb"<[^<>]*ount[^<>]*>")
COUNT = re.compile(rb"""\s(uniqueC|c)ount\s*=\s*["'](\d+)["']""")  # a reader may reserve memory for so many
DIMENSION = re.compile(rb"<" + _NAME + rb"""dimension\s[^<>]*?ref\s*=\s*["']([^"'<>]*)["']""")
CORNER = re.compile(rb"\$?([A-Za-z]{1,3})\$?([1-9]\d{0,6})")
SHEET = 1_048_576, 16_384  # rows and columns of a sheet, at most
SHORTEST_TEXT = 5  # bytes: <si/>
OTHERS = {"content.xml", "xl/workbook.bin"}  # in what is not XLSX, and might be read as a table all the same
REFUSED = {  # parts of an XLSX
    "vbaproject": N_("the file contains macros: save it as .xlsx without macros"),
    "externallink": N_("the file refers to other files: replace the references by their values"),
}


def read_rows(path: Path | str, largest: int = LARGEST, most: int = MOST_ROWS) -> list[list[str]]:
    """Read the non-empty rows of a CSV file, or of the first sheet of an XLSX file, as texts.

    Args:
        path: File. CSV may have semicolons, tabs or commas, in UTF-8, UTF-16 with a byte-order mark, or cp1251. A
            formula in XLSX is read as its last saved value.
        largest: Largest permitted size of the file, bytes.
        most: Largest permitted number of rows.

    Raises:
        ProblemError: The file cannot be read or is too large.
    """
    file = os.fspath(path)
    try:
        data = read_file_bytes(file, largest)
        rows = _parse_xlsx(data, largest, most) if data.startswith(b"PK\x03\x04") else _parse_csv(data, most)
        found = [[cell.strip() for cell in row] for row in rows]
        long = next((cell for row in found for cell in row if len(cell) > LONGEST), None)
        if long is not None:
            raise _limit_error(_("the text in a cell is too long"), len(long), LONGEST)
        return [row for row in found if any(row)]
    except ProblemError as error:
        raise error.located(file) from None


def read_file_bytes(path: Path | str, largest: int) -> bytes:
    """Read a regular file of at most `largest` bytes.

    Raises:
        ProblemError: The file cannot be read, is a link or a device, or is too large.
    """
    file = os.fspath(path)
    try:
        found = os.lstat(file)
        if not stat.S_ISREG(found.st_mode):
            raise ProblemError(_("this is not a regular file but a link, a folder or a device"))
        if found.st_size > largest:
            raise _limit_error(_("the file is too large"), found.st_size, largest)
        with open(file, "rb") as stream:
            return stream.read(largest + 1)
    except FileNotFoundError:
        raise ProblemError(_("there is no such file")) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ProblemError(_("the file cannot be read: {reason}").format(reason=reason)) from None


def _limit_error(message: str, found: int, allowed: int) -> ProblemError:
    return ProblemError(message, found=f"{found}", allowed=_("at most {most}").format(most=allowed))


def _parse_csv(data: bytes, most: int) -> list[list[str]]:
    text = decode_text(data)
    if "\0" in text:
        raise ProblemError(_("this is not a text file"), allowed=_("a table in CSV or XLSX format"))
    told = re.match(r"sep=(.)\r?\n", text)  # as Excel begins some
    body = text[told.end() :] if told else text
    head = re.sub(r'"[^"]*"', "", body.lstrip().partition("\n")[0])
    between = told[1] if told else max(";\t,", key=lambda sign: (sign in head, head.count(sign)))
    found: list[list[str]] = []
    try:
        for row in csv.reader(io.StringIO(body, newline=""), delimiter=between, skipinitialspace=True):
            if len(row) > MOST_COLUMNS:
                raise _limit_error(_("there are too many columns"), len(row), MOST_COLUMNS)
            if len(found) == most:
                raise ProblemError(_("there are too many rows"), allowed=_("at most {most}").format(most=most))
            if row:
                found.append(row)
    except csv.Error as error:
        raise ProblemError(_("this is not a valid CSV file: {reason}").format(reason=error)) from None
    return found


def decode_text(data: bytes) -> str:
    """Decode a text in UTF-8, in UTF-16 with a byte-order mark, or else in cp1251."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1251", errors="replace")


def _parse_xlsx(data: bytes, largest: int, most: int) -> list[list[str]]:
    """Read the rows of the first sheet in a separate process; report a crash of that process as an error.

    Raises:
        ProblemError: The file cannot be read or is too large.
    """
    _inspect_archive(data, largest, most)
    try:
        return READER.call(_read_sheet, data)
    except ImportError:
        raise ProblemError(
            _("XLSX requires the package python-calamine, which is not installed"),
            allowed=_("a CSV file; for XLSX, run: pip install 'tmm-cli[excel]'"),
        ) from None
    except (MemoryError, ProcessEndedError):
        raise ProblemError(
            _("the file cannot be read: it requires too much memory or crashes the program"),
            allowed=_("a table in CSV format"),
        ) from None
    except ValueError as error:
        raise _damaged_file_error(error) from None


def _read_sheet(data: bytes) -> list[list[str]]:
    """Return the cells of the first sheet as texts.

    Raises:
        ValueError, ImportError, MemoryError: The sheet cannot be read.
    """
    from python_calamine import CalamineError, CalamineWorkbook

    try:
        with CalamineWorkbook.from_filelike(io.BytesIO(data)) as book:
            sheet = book.get_sheet_by_index(0)
            return [[_cell_text(cell) for cell in row] for row in sheet.to_python()]
    except (CalamineError, OSError, ValueError, IndexError) as error:
        raise ValueError(str(error)) from None
    except BaseException as error:
        if type(error).__name__ != "PanicException":  # of Rust: a file that it did not think of
            raise
        raise ValueError(str(error)) from None


def _damaged_file_error(error: BaseException) -> ProblemError:
    return ProblemError(_("the XLSX file is damaged: {reason}").format(reason=error))


def _inspect_archive(data: bytes, largest: int, most: int) -> None:
    """Check an XLSX archive before it is read: refuse one that would fill the memory or contains more than tables.

    Raises:
        ProblemError: The archive is refused.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as packed:
            parts = packed.infolist()
            if len(parts) > PARTS or sum(part.file_size for part in parts) > UNPACKED * largest:
                raise ProblemError(
                    _("the unpacked file is far larger than a table can be"), allowed=_("a smaller file")
                )
            names = {part.filename.casefold() for part in parts}
            for name, why in REFUSED.items():
                if any(name in part for part in names):
                    raise ProblemError(_(why))
            if "xl/workbook.xml" not in names or names & OTHERS:
                raise ProblemError(_("this is not an XLSX file"), allowed=_("a table in CSV or XLSX format"))
            cells, longest, whole = 0, 0, sum(part.file_size for part in parts)
            for part in parts:
                content = packed.read(part)  # with its checksum: its size is what it says
                _refuse_declared_sizes(content, whole)
                here = len(CELL.findall(content))
                if b"sheetData" in content:
                    _refuse_distant_cells(content, here, most)
                cells += here
                if b"sst" in content:
                    longest = max(longest, *map(len, TEXT.split(content)))
            if cells * longest > COPIED * largest:
                raise ProblemError(
                    _("the unpacked file is far larger than a table can be"), allowed=_("shorter texts in the cells")
                )
    except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, OSError, RuntimeError, ValueError) as error:
        raise _damaged_file_error(error) from None


def _refuse_declared_sizes(content: bytes, whole: int) -> None:
    """Refuse a file inside an XLSX archive that declares more texts or cells than it can contain.

    Args:
        content: The unpacked file.
        whole: Total size of all unpacked files, bytes.

    Raises:
        ProblemError: A declared count or range is too large.
    """
    for kind, digits in (count for tag in COUNTING.findall(content) for count in COUNT.findall(tag)):
        most = len(content) // SHORTEST_TEXT if kind == b"uniqueC" else whole
        if len(digits) > 12 or int(digits) > most:
            raise ProblemError(
                _("the XLSX file is damaged: it states a larger number of cells or texts than it contains"),
                found=quote(digits[:20].decode()),
                allowed=_("a file saved by a spreadsheet program"),
            )
    for cells in DIMENSION.findall(content):
        for corner in cells.split(b":"):
            match = CORNER.fullmatch(corner)
            if match is None or int(match[2]) > SHEET[0] or _column_number(match[1]) > SHEET[1]:
                raise ProblemError(
                    _("the XLSX file is damaged: it states a larger number of cells or texts than it contains"),
                    found=quote(cells[:40].decode(errors="replace")),
                    allowed=_("a file saved by a spreadsheet program"),
                )


def _column_number(letters: bytes) -> int:
    column = 0
    for letter in letters[:8].upper():
        column = column * 26 + letter - 64
    return column


def _refuse_distant_cells(content: bytes, cells: int, most: int) -> None:
    """Refuse a table in which a cell has a distant address: reading it would create all the empty cells before it.

    Args:
        content: The unpacked file of the table inside an XLSX archive.
        cells: Number of cells in it.
        most: Largest permitted row number.

    Raises:
        ProblemError: A cell has no address, or lies outside the permitted rows and columns.
    """
    places = PLACE.findall(content)
    if len(places) != cells:
        raise ProblemError(_("a cell has no address"), allowed=_("a file saved by a spreadsheet program"))
    for letters, digits in set(places):
        if len(digits) > 8 or int(digits) > most or _column_number(letters) > MOST_COLUMNS:
            raise ProblemError(
                _("a cell is outside the permitted range"),
                found=quote((letters + digits).decode()),
                allowed=_("{rows} rows, {columns} columns").format(rows=most, columns=MOST_COLUMNS),
            )


def _cell_text(cell: Any) -> str:
    """Return a cell as a spreadsheet shows it; a number with at most 15 significant figures."""
    if isinstance(cell, bool | str):
        return str(cell)
    if isinstance(cell, datetime | date | time):
        return cell.isoformat()
    return str(cell) if isinstance(cell, timedelta) else f"{cell:.15g}"
