"""Result folder of a problem: result.json, CSV files and drawings, written atomically.

A file or folder is written under a temporary name in the same folder and then renamed; after an error or an
interruption the old one is unchanged.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import json
import os
import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from tmm_cli.language import _, words_of_files
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.reports.digits import AccuracyReport
from tmm_cli.reports.register import walk
from tmm_cli.reports.result_json import sections
from tmm_cli.reports.spreadsheets import SpreadsheetKind, spreadsheet_files
from tmm_cli.reports.table import Table, csv_text, json_text

RECORD_TAIL = 100_000  # bytes: the list of files at the end of result.json is shorter, and the rest may be very long
LONGEST_FOLDER_NAME = 150  # bytes of a folder's name
RECORD = "result.json"
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)  # devices of Windows, in every folder
QUERY_PROCESS = 0x1000  # of OpenProcess: no more is asked than whether a process is there


def folder_name(name: str) -> str:
    """Return the folder name of a problem: without path separators, and valid on every operating system."""
    safe = re.sub(r"[^\w.-]+", "_", name).encode()[:LONGEST_FOLDER_NAME].decode(errors="ignore").strip(".") or "problem"
    return f"_{safe}" if RESERVED.fullmatch(safe) else safe


def choose_folder(out: Path, name: str, part: str) -> tuple[Path, Path | None]:
    """Return the folder for results and, if there is one, a folder with other results that must be kept.

    Args:
        out: parent folder.
        name: name of the problem.
        part: name of an incomplete run; empty for a complete one. An incomplete run does not replace other results: if
            the usual folder contains other results, the incomplete run gets a folder of its own.

    Raises:
        FileExistsError: both the usual folder and the folder of the incomplete run contain other results.
    """
    usual, part_folder = (out / folder_name(text) for text in (name, f"{name}-{part}"))
    if not part or recorded_part(usual) in (None, part):
        return usual, None
    if recorded_part(part_folder) not in (None, part):
        raise FileExistsError(errno.EEXIST, _("the folder contains the results of another run"), str(part_folder))
    return part_folder, usual


def refuse_unwritable(path: Path, *, folder: bool) -> None:
    """Raise OSError for a folder or file that cannot be written, before the calculation starts."""
    path = Path(os.path.realpath(path))
    if path.exists() and path.is_dir() != folder:
        number = errno.ENOTDIR if folder else errno.EISDIR
        raise OSError(number, os.strerror(number), str(path))
    above = path if folder else path.parent
    while not above.exists():
        above = above.parent
    if not above.is_dir() or not os.access(above, os.W_OK):
        number = errno.EACCES if above.is_dir() else errno.ENOTDIR
        raise OSError(number, os.strerror(number), str(above))


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file under a temporary name and then rename it, so that an interrupted run never leaves half a file."""
    path = Path(os.path.realpath(path))
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():  # a device of the system would be gone after the renaming
        raise FileExistsError(errno.EEXIST, _("this is a device, not a file"), str(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    for left in _abandoned_paths(path, "new"):
        left.unlink(missing_ok=True)
    new = _temporary_path(path, "new")
    try:
        new.write_bytes(content)
        os.replace(new, path)
    except BaseException:
        new.unlink(missing_ok=True)
        raise


class StagedFolder:
    """A folder that is written under a temporary name, and renamed when it is complete and no error has occurred.

    If a new result.json is written, files listed in the old one are deleted. Other files of the old folder are kept.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(os.path.realpath(folder))
        self.new, self.old = _temporary_path(self.folder, "new"), _temporary_path(self.folder, "old")
        self.names: set[str] = set()
        self.removed: list[str] = []

    def __enter__(self) -> StagedFolder:
        if self.folder.exists() and not self.folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(self.folder))
        self.made = not self.folder.parent.exists()
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        for left in _abandoned_paths(self.folder, "old"):
            _move_remaining(left, self.folder)
        for left in _abandoned_paths(self.folder, "new"):
            shutil.rmtree(left, ignore_errors=True)
        self.new.mkdir()
        return self

    def write(self, name: str, content: Iterable[str | bytes]) -> None:
        """Write a file into the new folder, piece by piece."""
        self.names.add(name)
        with (self.new / name).open("wb") as stream:
            for piece in content:
                stream.write(piece if isinstance(piece, bytes) else piece.encode())

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        try:
            if kind is None:
                self._exchange()
        finally:
            shutil.rmtree(self.new, ignore_errors=True)
            if self.made and not self.folder.exists():
                with contextlib.suppress(OSError):
                    self.folder.parent.rmdir()

    def _exchange(self) -> None:
        """Replace the old folder by the new one with two renames; if the second fails, undo the first."""
        for name in self.names:
            if (self.folder / name).is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(self.folder / name))
        if not self.folder.exists():
            os.rename(self.new, self.folder)
            return
        if RECORD in self.names:
            self.removed = sorted(
                name for name in listed_files(self.folder) - self.names if (self.folder / name).exists()
            )
        try:
            os.rename(self.folder, self.old)
            os.rename(self.new, self.folder)
        except BaseException:
            if not self.folder.exists():
                os.rename(self.old, self.folder)
            raise
        _move_remaining(self.old, self.folder)


def _move_remaining(old: Path, folder: Path) -> None:
    """Move the files of the old folder that are not results of an earlier run into the new folder; delete the old
    folder.

    The old result.json, which lists the earlier results, is deleted last. If the run is killed before that, the next
    run completes the deletion.
    """
    if not folder.exists():
        os.rename(old, folder)
        return
    gone = listed_files(old) | {RECORD} if (folder / RECORD).exists() else set()
    for entry in sorted(old.iterdir(), key=lambda entry: entry.name == RECORD):
        if entry.name in gone or (folder / entry.name).exists():
            entry.unlink()
        else:
            os.rename(entry, folder / entry.name)
    old.rmdir()


def _temporary_path(path: Path, kind: str) -> Path:
    """Return the temporary path of a new or old version of a file or folder, which contains the number of this process.

    kind: `new` or `old`.
    """
    return path.with_name(f".{path.name}.{kind}-{os.getpid()}")


def _abandoned_paths(path: Path, kind: str) -> Iterator[Path]:
    """Yield temporary paths of a file or folder that were left by processes which no longer run.

    kind: `new` for new versions, `old` for old versions.
    """
    for other in list(path.parent.iterdir()):
        match = re.fullmatch(rf"\.{re.escape(path.name)}\.{kind}-(\d{{1,9}})", other.name)
        if match is not None and not _is_running(int(match[1])):
            yield other


def _is_running(process: int) -> bool:
    """Return True if another process with this number is running."""
    if process == os.getpid():
        return False
    if sys.platform == "win32":  # where os.kill would end it
        return bool(ctypes.windll.kernel32.OpenProcess(QUERY_PROCESS, False, process))
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def listed_files(folder: Path) -> set[str]:
    """Return the names of the files listed in the result.json of a folder; names that contain a path are ignored."""
    try:
        end = _end_of_record(folder)
        names = json.loads(end[end.rindex('"files": [') + len('"files": ') :].rstrip().removesuffix("}"))
    except (OSError, ValueError, RecursionError):
        return set()
    return {n for n in names if isinstance(n, str) and re.fullmatch(r"\w[\w(),-]*\.(csv|png|svg|xlsx)", n)}


def recorded_part(folder: Path) -> str | None:
    """Return the name of the run whose results a folder contains: "" for a complete run, None if it contains no
    results.
    """
    try:
        match = re.search(r'"part": "([^"]*)",\s*"files": \[[^\[]*\Z', _end_of_record(folder))
    except OSError:
        return None
    return match[1] if match else ""


def _end_of_record(folder: Path) -> str:
    with (folder / RECORD).open("rb") as stream:
        stream.seek(-min(RECORD_TAIL, stream.seek(0, os.SEEK_END)), os.SEEK_END)
        return stream.read().decode(errors="replace")


# A problem's output folder: result.json, a CSV file a table, and what others add to it (drawings).


NAMED_POSITIONS = 6  # positions that stand in the name of a folder; of more of them the first and the last


def part_name(results: Results | ChainResults, drawn: bool) -> str:
    """Return a name for a run that omits stages or positions, e.g. `structure` or `kinematics-p2`; "" for a complete
    run.
    """
    if isinstance(results, ChainResults):
        return ""
    if results.motion is None:
        return "structure"
    words = [word for word in ("assemblies", "centres", "extremes") if getattr(results, word) is not None]
    if results.reactions is None:
        words = [*(words or ["kinematics"]), *results.of]
    numbers = results.numbers
    if numbers != tuple(range(len(results.asked))):
        few = len(numbers) <= NAMED_POSITIONS
        words.append("p" + ("-".join(map(str, numbers)) if few else f"{numbers[0]}-to-{numbers[-1]}"))
    return "-".join(words if drawn or results.reactions is None else [*words, "no-drawings"])


class WrittenFolder(NamedTuple):
    """The folder to which results were written.

    Attributes:
        folder: the folder.
        removed: names of the deleted files of an earlier run.
        kept: folder with the results of another run, which were not replaced; None if there is no such folder.
    """

    folder: Path
    removed: list[str]
    kept: Path | None


def write_results(
    results: Results | ChainResults,
    out: Path,
    drawings: Iterable[tuple[str, bytes]] | None = None,
    digits: AccuracyReport | None = None,
    spreadsheets: SpreadsheetKind | None = None,
    part: str = "",
) -> WrittenFolder:
    """Write result.json, tables and drawings to out/<problem>/, and delete the files of an earlier run.

    The old folder is replaced only when everything is written. After an error or an interruption it is unchanged.

    Args:
        results: results to write.
        out: parent folder.
        drawings: names and contents of the files of drawings; None if no drawings were requested.
        digits: accuracy of the results, which limits the number of digits in the tables.
        spreadsheets: kind of spreadsheet files to write as well; None for no such files.
        part: name of the drawings, if they are not those of a complete run.
    """
    part = "-".join(word for word in (part_name(results, drawings is not None), part) if word)
    folder, kept = choose_folder(out, results.problem.name, part)

    def tables() -> Iterable[Table]:
        return walk(results) if digits is None else digits.with_bounds(walk(results))

    with StagedFolder(folder) as staged:
        with words_of_files():
            for table in tables():
                staged.write(f"{table.name}.csv", csv_text(table, results.problem.units))
        for name, content in spreadsheet_files(spreadsheets, tables(), results.problem.units) if spreadsheets else ():
            staged.write(name, content)
        for name, picture in drawings or ():
            staged.write(name, (picture,))
        names = sorted(staged.names)
        parts = sections(results, None if digits is None else digits.json())
        with words_of_files():
            staged.write("result.json", json_text(chain(parts, [("part", part)] if part else [], [("files", names)])))
    return WrittenFolder(folder, staged.removed, kept)
