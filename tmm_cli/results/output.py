"""A problem's output folder: result.json, a CSV file a table, and what others add to it (drawings)."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.language import ENGLISH, spoken
from tmm_cli.results.as_json import sections
from tmm_cli.results.digits import AccuracyReport
from tmm_cli.results.files import Staged, folder_of
from tmm_cli.results.for_people import Kind, files
from tmm_cli.results.reports import walk
from tmm_cli.results.table import Table
from tmm_cli.results.text import csv_text, json_text

NAMED = 6  # positions that stand in the name of a folder; of more of them the first and the last


def part_of(results: Results | ChainResults, drawn: bool) -> str:
    """What of a run is there, as its folder is named; nothing where all is."""
    if isinstance(results, ChainResults):
        return ""
    if results.motion is None:
        return "structure"
    words = [word for word in ("assemblies", "centres", "extremes") if getattr(results, word) is not None]
    if results.reactions is None:
        words = [*(words or ["kinematics"]), *results.of]
    numbers = results.numbers
    if numbers != tuple(range(len(results.asked))):
        few = len(numbers) <= NAMED
        words.append("p" + ("-".join(map(str, numbers)) if few else f"{numbers[0]}-to-{numbers[-1]}"))
    return "-".join(words if drawn or results.reactions is None else [*words, "no-drawings"])


class Written(NamedTuple):
    """The folder that was written, files of an earlier run that went, and the folder that keeps other results."""

    folder: Path
    removed: list[str]
    kept: Path | None


def write_results(
    results: Results | ChainResults, out: Path, drawings: Iterable[tuple[str, bytes]] | None = None,
    digits: AccuracyReport | None = None, people: Kind | None = None, part: str = "",
) -> Written:  # fmt: skip
    """Write everything to out/<problem>/, a part of a run beside a whole one; files of an earlier run go.

    Each table is dropped when it is written. The folder takes the place of the old one when all is there: a refusal or
    an interruption before the end leaves the old one as it was. people: tables for their spreadsheets too. part: what
    the drawings are, where they are others than those of a whole run.
    """
    part = "-".join(word for word in (part_of(results, drawings is not None), part) if word)
    folder, kept = folder_of(out, results.problem.name, part)

    def tables() -> Iterable[Table]:
        return walk(results) if digits is None else digits.with_bounds(walk(results))

    with Staged(folder) as staged:
        with spoken(ENGLISH):
            for table in tables():
                staged.write(f"{table.name}.csv", csv_text(table, results.problem.units))
        for name, content in files(people, tables(), results.problem.units) if people else ():
            staged.write(name, content)
        for name, picture in drawings or ():
            staged.write(name, (picture,))
        names = sorted(staged.names)
        parts = sections(results, None if digits is None else digits.json())
        with spoken(ENGLISH):
            staged.write("result.json", json_text(chain(parts, [("part", part)] if part else [], [("files", names)])))
    return Written(folder, staged.removed, kept)
