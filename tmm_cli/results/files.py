"""Files on disk, each written whole or not at all."""

from __future__ import annotations

import contextlib
import json
import os
import re
import tempfile
from collections.abc import Iterable
from pathlib import Path

LISTED = 100_000  # bytes: the list of files at the end of result.json is shorter, and the rest may be very long


def folder_name(name: str) -> str:
    """A problem's folder: its name with nothing in it that could lead elsewhere."""
    return re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "problem"


def write_whole(path: Path, content: bytes) -> None:
    """Write beside and rename, so that a killed run leaves the old file or the new one."""
    with Staged(path.parent) as staged:
        staged.write(path.name, (content,))


class Staged:
    """Files written beside their places and renamed together when all are there; none of them on an error."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.waiting: dict[str, str] = {}

    def __enter__(self) -> Staged:
        self.made = not self.folder.exists()
        self.folder.mkdir(parents=True, exist_ok=True)
        return self

    def write(self, name: str, content: Iterable[str | bytes]) -> None:
        """A file of the folder, from its content piece by piece."""
        self._forget(name)
        handle, self.waiting[name] = tempfile.mkstemp(prefix=f".{name}.", dir=self.folder)
        with os.fdopen(handle, "wb") as stream:
            for piece in content:
                stream.write(piece if isinstance(piece, bytes) else piece.encode())
        os.chmod(self.waiting[name], 0o644)

    def _forget(self, name: str) -> None:
        if name in self.waiting:
            Path(self.waiting.pop(name)).unlink(missing_ok=True)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            for name, temporary in self.waiting.items():
                os.replace(temporary, self.folder / name)
            return
        for name in list(self.waiting):
            self._forget(name)
        if self.made:
            with contextlib.suppress(OSError):
                self.folder.rmdir()


def listed(folder: Path) -> set[str]:
    """The files that an earlier run wrote into the folder, as the end of its result.json lists them; never a path."""
    try:
        with (folder / "result.json").open("rb") as stream:
            stream.seek(-min(LISTED, stream.seek(0, os.SEEK_END)), os.SEEK_END)
            end = stream.read().decode(errors="replace")
        names = json.loads(end[end.rindex('"files": [') + len('"files": ') :].rstrip().removesuffix("}"))
    except (OSError, ValueError):
        return set()
    return {n for n in names if isinstance(n, str) and re.fullmatch(r"\w[\w(),-]*\.(csv|png|svg)", n)}
