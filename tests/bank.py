"""Problems of the bank that have dimensions: their results, sheets and notes, once for all tests of a run."""

from __future__ import annotations

from functools import cache

from models import PROBLEMS

from tmm_cli import load, solve
from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw import sheets
from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.note import note
from tmm_cli.note.blocks import Note
from tmm_cli.problem.build import is_chain
from tmm_cli.problem.reader import read_file

NAMES = sorted(path.stem for path in PROBLEMS.glob("*.yaml") if not is_chain(read_file(str(path))))


@cache
def solved(name: str) -> Results:
    """A problem of the bank, computed."""
    return solve(load(str(PROBLEMS / f"{name}.yaml")))


@cache
def drawn(name: str) -> dict[str, Drawing]:
    """The sheets of a problem by their stems."""
    return dict(sheets(solved(name)))


@cache
def written(name: str) -> Note:
    """Its note without drawings, which have tests of their own."""
    return note(solved(name), drawn=False)
