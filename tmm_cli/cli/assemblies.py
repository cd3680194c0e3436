"""`tmm kinematics --assemblies`: kinematics with every real assembly of the groups, listed and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_cli.cli.common import report, say

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results
    from tmm_cli.problem.record import Problem
    from tmm_cli.structure.assur import Group


def list_assemblies(file: str, as_json: bool, out: Path | None, positions: Sequence[int] | None) -> int:
    """Compute one file, show its assemblies and draw them; the exit code. Raises ProblemError."""
    from tmm_cli.assemblies import listed
    from tmm_cli.draw.assemblies import files
    from tmm_cli.results.files import folder_name, write_whole
    from tmm_cli.results.output import write_results
    from tmm_cli.words import say as words

    results = with_assemblies(file, positions)
    code = report(results, [stem for stem, _, _ in listed(results.assemblies or ())], as_json, None)
    for here in results.assemblies or ():
        if here.undecided is not None:
            say(words("assemblies.undecided", group=here.undecided.title))
            if positions and here.number is None:
                say(words("assemblies.sketch_place"))
        for group in here.lost:
            say(words("assemblies.lost", group=group.title))
    pictures = dict(files(results))
    if out is not None:
        say(f"written: {write_results(results, out, pictures.items())}")
    elif pictures:
        folder = Path("outputs") / folder_name(results.problem.name)
        for name, content in pictures.items():
            write_whole(folder / name, content)
        say(f"written: {folder}")
    return code


def with_assemblies(file: str, positions: Sequence[int] | None) -> Results:
    """Kinematics with all assemblies at the positions; where the sketch does not decide, structure with assemblies.

    Raises ProblemError.
    """
    from tmm_cli import load, pipeline
    from tmm_cli.assemblies import find_assemblies
    from tmm_cli.problem.refusals import refusal
    from tmm_cli.refused import Refused, Undecided

    problem = load(file)
    try:
        results = pipeline.solve(problem, "kinematics", positions)
    except Undecided as error:
        return _undecided(problem, error.group, positions)
    except Refused as error:
        raise refusal(error, problem) from None
    numbers = positions or problem.request.detail[:1] or (0,)
    asked = results.asked
    return replace(results, assemblies=tuple(
        find_assemblies(results.linkage, results.structure, results.kernels, float(asked[n]), n) for n in numbers
    ))  # fmt: skip


def _undecided(problem: Problem, group: Group, positions: Sequence[int] | None) -> Results:
    """The groups before the one that is not decided, and this one, at the sketch's place or those of the file."""
    from tmm_cli import pipeline
    from tmm_cli.assemblies import find_assemblies
    from tmm_cli.assembly import assemble
    from tmm_cli.problem.refusals import refusal
    from tmm_cli.refused import NoSuchPosition, Refused

    results = pipeline.solve(problem, "structure")
    order = [g.links for g in results.structure.solved]
    before = results.structure.solved[: order.index(group.links)]
    given = problem.request.places
    try:
        kernels = assemble(problem.linkage, results.structure, before)
        for number in positions or ():
            if given and number >= len(given):
                raise NoSuchPosition(number, len(given))
    except Refused as error:
        raise refusal(error, problem) from None
    places: list[tuple[float, int | None]] = [(given[n], n) for n in positions or ()] if given else []
    return replace(results, assemblies=tuple(
        find_assemblies(problem.linkage, results.structure, kernels, q, number)
        for q, number in places or [(problem.linkage.sketch.at, None)]
    ))  # fmt: skip
