"""A problem's output folder: result.json, a CSV file a table, and what others add to it (drawings)."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_cli.chain import ChainResults
from tmm_cli.pipeline import Results
from tmm_cli.results.as_json import to_json
from tmm_cli.results.files import csv_bytes, folder_name, json_bytes, listed, write_whole
from tmm_cli.results.reports import tables

if TYPE_CHECKING:
    from tmm_cli.results.digits import Trusted


def write_results(
    results: Results | ChainResults, out: Path, more: Iterable[tuple[str, bytes]] = (), digits: Trusted | None = None
) -> Path:
    """Write everything to out/<problem>/ and give that folder; files of an earlier run that are not renewed go.

    All is computed and drawn first: a refusal or an interruption before the end leaves the folder as it was.
    """
    folder = out / folder_name(results.problem.name)
    shown = tables(results)
    if digits is not None:
        from tmm_cli.results.digits import judged_tables

        shown = judged_tables(shown, digits)
    content = {f"{table.name}.csv": csv_bytes(table, results.problem.units) for table in shown}
    content |= dict(more)
    record = json_bytes(to_json(results, digits) | {"files": sorted(content)})
    earlier = listed(folder)
    for name, data in content.items():
        write_whole(folder / name, data)
    write_whole(folder / "result.json", record)
    for name in earlier - set(content):
        (folder / name).unlink(missing_ok=True)
    return folder
