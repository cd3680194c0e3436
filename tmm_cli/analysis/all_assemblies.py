"""Every real assembly of the groups at some positions, beside the one that the sketch chooses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from tmm_cli.analysis.mechanism import Inputs
from tmm_cli.analysis.pipeline import Results, solve
from tmm_cli.assembly.choose import assemble
from tmm_cli.assembly.enumerate import find_assemblies
from tmm_cli.errors import AmbiguousSketchError, UnknownPositionError
from tmm_cli.structure.assur import Group


def with_assemblies(inputs: Inputs, positions: Sequence[int] | None, problem: Any = None) -> Results:
    """Kinematics with all assemblies at the positions, or at the first in detail; problem: see Results.

    Where the sketch does not decide, the structure with the assemblies. Raises LinkageError as `solve`.
    """
    try:
        results = solve(inputs, "kinematics", positions, problem=problem)
    except AmbiguousSketchError as error:
        return _undecided(inputs, error.group, positions or (), problem)
    numbers = positions or inputs.request.detail[:1] or (0,)
    return replace(results, assemblies=tuple(
        find_assemblies(results.linkage, results.structure, results.kernels, float(results.asked[n]), n)
        for n in numbers
    ))  # fmt: skip


def _undecided(inputs: Inputs, group: Group, positions: Sequence[int], problem: Any) -> Results:
    """The groups before the one that is not decided, and this one, at the sketch's place or those of the file."""
    results = solve(inputs, "structure", problem=problem)
    order = [g.links for g in results.structure.solved]
    kernels = assemble(inputs.linkage, results.structure, results.structure.solved[: order.index(group.links)])
    given = inputs.request.places
    for number in positions:
        if given and number >= len(given):
            raise UnknownPositionError(number, len(given))
    places: list[tuple[float, int | None]] = [(given[n], n) for n in positions] if given else []
    return replace(results, assemblies=tuple(
        find_assemblies(inputs.linkage, results.structure, kernels, q, number)
        for q, number in places or [(inputs.linkage.sketch.at, None)]
    ))  # fmt: skip
