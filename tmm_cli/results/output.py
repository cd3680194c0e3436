"""A problem's output folder: result.json, a CSV file a table, and what others add to it (drawings)."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.results.as_json import sections
from tmm_cli.results.files import Staged, folder_name, listed
from tmm_cli.results.reports import walk
from tmm_cli.results.text import csv_text, json_text

if TYPE_CHECKING:  # a structure alone has no digits, and does not wait for what finds them
    from tmm_cli.results.digits import AccuracyReport


def write_results(
    results: Results | ChainResults, out: Path, more: Iterable[tuple[str, bytes]] = (),
    digits: AccuracyReport | None = None,
) -> Path:  # fmt: skip
    """Write everything to out/<problem>/ and give that folder; files of an earlier run that are not renewed go.

    Each table is dropped when it is written. Nothing is renamed to its name before all is there: a refusal or an
    interruption before the end leaves the folder as it was.
    """
    folder = out / folder_name(results.problem.name)
    shown = walk(results) if digits is None else digits.with_bounds(walk(results))
    earlier = listed(folder)
    with Staged(folder) as staged:
        for table in shown:
            staged.write(f"{table.name}.csv", csv_text(table, results.problem.units))
        for name, picture in more:
            staged.write(name, (picture,))
        names = sorted(staged.waiting)
        content = sections(results, None if digits is None else digits.json())
        staged.write("result.json", json_text(chain(content, [("files", names)])))
    for name in earlier - set(names):
        (folder / name).unlink(missing_ok=True)
    return folder
