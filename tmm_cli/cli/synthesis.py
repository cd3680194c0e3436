"""`tmm synthesis`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tmm_cli.cli.common import CHECK_FAILED, OK, Files, Json, Out, console, each, emit_json, say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tmm_cli.pipeline import Results
    from tmm_cli.problem.record import Synthesised
    from tmm_cli.problem.units import UnitSystem
    from tmm_cli.synthesis.check import Measured


def synthesis(files: Files, as_json: Json = False, out: Out = None) -> None:
    """Find lengths from what a mechanism must do, analyse it, and measure on it what was asked.

    The file has a block `synthesis`; what it finds becomes parameters of its linkage. Exit code 1 when the mechanism
    does not do what was asked within 1e-9. With -o the tables and the construction as a drawing are written too.
    """

    def work(file: str) -> int:
        from tmm_cli.results.synthesis import missed, tables, to_json
        from tmm_cli.results.terminal import show
        from tmm_cli.words import say as words

        name, title, found, units, results = _solved(file)
        measured = None
        if results is not None:
            measured = results.measured
        if as_json:
            emit_json({"problem": name, **to_json(found, measured)})
        else:
            screen = console()
            for table in tables(found, measured, units):
                if table.long:
                    continue
                show(table, units, screen, most=None)
            if measured is None:
                say(words("synthesis.no_linkage"))
        if out is not None:
            say(f"written: {_write(out, (name, title), found, measured, units, results)}")
        for fault in missed(measured or (), units):
            say(f"warning: {fault}")
        return OK if all(m.met for m in measured or ()) else CHECK_FAILED

    each(files, work, as_json=as_json, out=out)


def _solved(file: str) -> tuple[str, str, Synthesised, UnitSystem, Results | None]:
    """Name and title of the problem, what was found, units, the motion if there is a linkage. Raises ProblemError."""
    from tmm_cli.problem.reader import read_file
    from tmm_cli.words import say as words

    tree = read_file(file)
    if "synthesis" not in tree.data:
        from tmm_cli.problem.synthesis.alone import no_block

        raise no_block(tree, words("synthesis.no_block"))
    if "links" not in tree.data:
        from tmm_cli.problem.synthesis.alone import alone

        return (*alone(tree), None)
    from tmm_cli import solve
    from tmm_cli.problem.build import build

    problem = build(tree)
    assert problem.synthesis is not None
    return problem.name, problem.title, problem.synthesis, problem.units, solve(problem, "kinematics")


def _write(
    out: Path, names: tuple[str, str], found: Synthesised, measured: Sequence[Measured] | None, units: UnitSystem,
    results: Results | None,
) -> Path:  # fmt: skip
    from tmm_cli.draw.synthesis import files
    from tmm_cli.results.files import Staged, folder_name
    from tmm_cli.results.synthesis import tables, to_json
    from tmm_cli.results.text import csv_text, json_bytes

    folder = out / folder_name(names[0])
    with Staged(folder) as staged:
        for table in tables(found, measured, units, 15):
            staged.write(f"{table.name}.csv", csv_text(table, units))
        for name, picture in files(names[1], found.outcome, results, units, found.names):
            staged.write(name, (picture,))
        staged.write("synthesis.json", (json_bytes({"problem": names[0], **to_json(found, measured)}),))
    return folder
