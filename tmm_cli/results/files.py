"""Results on disk: CSV tables and result.json, each written whole or not at all."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table, true_digits
from tmm_cli.results.terminal import heading

FORMULA = ("=", "+", "-", "@", "\t", "\r")


def folder_name(name: str) -> str:
    """A problem's folder: its name with nothing in it that could lead elsewhere."""
    return re.sub(r"[^\w.-]+", "_", name).lstrip(".") or "problem"


def write_whole(path: Path, content: bytes) -> None:
    """Write beside and rename, so that a killed run leaves the old file or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def csv_bytes(table: Table, units: UnitSystem) -> bytes:
    """A table as CSV in the units of the file; a cell that a spreadsheet would run as a formula is quoted."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_safe(heading(c, units)) for c in table.columns)
    columns = [_cells(c, units) for c in table.columns]
    writer.writerows(zip(*columns, strict=True))
    return text.getvalue().encode()


def _cells(column: Column, units: UnitSystem) -> list[str]:
    if column.dimension is None:
        return [_safe(str(v)) for v in column.values]
    values = np.array([np.nan if v is None else v for v in column.values] if isinstance(column.values, list)
                      else column.values, dtype=float)  # fmt: skip
    factor = 1.0
    if column.dimension != NUMBER:
        values = units.unit(column.dimension).from_si(values)
        factor = units.unit(column.dimension).from_si(1.0)
    if column.bound is None:
        return [f"{v:.15g}" if math.isfinite(v) else "" for v in values.tolist()]
    known = np.isfinite(values) & np.isfinite(column.bound)
    true = true_digits(np.where(known, values, 0.0), np.where(known, column.bound, 0.0) * factor)
    return [
        (f"{v:.{n}g}" if n else "0") if sound else ""
        for v, n, sound in zip(values.tolist(), true.tolist(), known.tolist(), strict=True)
    ]


def _safe(text: str) -> str:
    return "'" + text if text.startswith(FORMULA) else text


def json_bytes(content: Any) -> bytes:
    """JSON with a line for every series of numbers, so that two results can be compared line by line."""
    return ("".join(_lines(content, "")) + "\n").encode()


def _lines(value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, dict) and value:
        yield "{\n"
        for k, (key, part) in enumerate(value.items()):
            yield f"{indent} {json.dumps(key, ensure_ascii=False)}: "
            yield from _lines(part, indent + " ")
            yield ",\n" if k < len(value) - 1 else "\n"
        yield indent + "}"
    elif isinstance(value, list) and any(isinstance(part, dict | list) for part in value):
        yield "[\n"
        for k, part in enumerate(value):
            yield indent + " "
            yield from _lines(part, indent + " ")
            yield ",\n" if k < len(value) - 1 else "\n"
        yield indent + "]"
    else:
        yield json.dumps(value, ensure_ascii=False, allow_nan=False)


def listed(folder: Path) -> set[str]:
    """The files that an earlier run wrote into the folder, as its result.json lists them; never a path."""
    try:
        names = json.loads((folder / "result.json").read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    return {n for n in names if isinstance(n, str) and re.fullmatch(r"\w[\w(),-]*\.(csv|png|svg)", n)}
