"""Results that are computed on request: detailed positions, instantaneous centres, all assemblies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_cli.mechanics.analysis.mechanism import Inputs
from tmm_cli.mechanics.analysis.pipeline import Results, solve
from tmm_cli.mechanics.assembly import assemble, find_assemblies
from tmm_cli.mechanics.errors import AmbiguousSketchError, UnknownPositionError
from tmm_cli.mechanics.kinematics import find_centres
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.structure import Group


def detailed_positions(results: Results) -> tuple[int, ...]:
    """Return the indices of the detailed positions, for which plans are drawn, among the computed positions.

    A single computed position is always detailed. If the file names no detailed positions, the one with the largest
    balancing moment or force is taken. Without loads it is the one after position 0, since the output link often rests
    at position 0. The result is empty if no position can be assembled.
    """
    computed = _solved_positions(results)
    requested = results.inputs.request.detail if len(results.numbers) > 1 else results.numbers
    if requested:
        return tuple(k for k in np.flatnonzero(computed).tolist() if results.numbers[k] in requested)
    if not computed.any():
        return ()
    balance = balancing_magnitude(results)
    if balance.any():
        return (int(np.argmax(balance)),)
    return (int(np.flatnonzero(computed)[:2][-1]),)


def detail_chosen_by_program(results: Results) -> bool:
    """Return True if the file does not say which positions are detailed, so that the program chooses one."""
    return len(results.numbers) > 1 and not results.inputs.request.detail


def balancing_magnitude(results: Results) -> Real:
    """Return the magnitude of the first driver's balancing moment (N m) or force (N), (positions,).

    It is zero at positions that cannot be assembled or at which the mechanism is self-locking, and everywhere if forces
    were not computed.
    """
    computed = _solved_positions(results)
    if results.reactions is None:
        return np.zeros(len(computed))
    sizes: Real = np.abs(results.reactions.balance.generalized)
    return np.where(computed & np.isfinite(sizes), sizes, 0.0)


def _solved_positions(results: Results) -> Real:
    motion = results.motion
    assert motion is not None
    return motion.moving & ~results.locked


# Instantaneous centres at the detailed positions.


def with_centres(results: Results) -> Results:
    """Add the instantaneous centres to results.

    They are computed at the detailed positions. If the results contain only some requested positions, they are computed
    at all of these.
    """
    motion = results.motion
    assert motion is not None
    one_by_one = len(results.numbers) < len(results.asked)
    chosen = np.flatnonzero(motion.moving).tolist() if one_by_one else detailed_positions(results)
    return replace(results, centres={k: find_centres(motion, results.structure, k) for k in chosen})


# All real assemblies of the groups, not only the one that the sketch shows.


def with_assemblies(inputs: Inputs, positions: Sequence[int] | None, problem: Any = None) -> Results:
    """Compute the motion, and at the given positions all real assemblies.

    If the sketch does not determine the assembly, there is no motion: the results contain the structure and the
    assemblies.

    Args:
        inputs: the mechanism and its positions.
        positions: numbers of positions; None: the first detailed one.
        problem: object of the caller, kept in the results.

    Raises:
        LinkageError: see `solve`.
    """
    try:
        results = solve(inputs, "kinematics", positions, problem=problem)
    except AmbiguousSketchError as error:
        return _find_undecided_assemblies(inputs, error.group, positions or (), problem)
    numbers = positions or inputs.request.detail[:1] or (0,)
    return replace(
        results,
        assemblies=tuple(
            find_assemblies(results.linkage, results.structure, results.kernels, float(results.asked[n]), n)
            for n in numbers
        ),
    )


def _find_undecided_assemblies(inputs: Inputs, group: Group, positions: Sequence[int], problem: Any) -> Results:
    """Find the assemblies if the sketch does not determine the assembly of `group`.

    Groups are solved in order up to and including this group. Assemblies are found at the given positions if the file
    lists driver coordinates, else at the position of the sketch.
    """
    results = solve(inputs, "structure", problem=problem)
    order = [g.links for g in results.structure.solved]
    kernels = assemble(inputs.linkage, results.structure, results.structure.solved[: order.index(group.links)])
    coordinates = inputs.request.places
    for number in positions:
        if coordinates and number >= len(coordinates):
            raise UnknownPositionError(number, len(coordinates))
    numbered: list[tuple[float, int | None]] = [(coordinates[n], n) for n in positions] if coordinates else []
    return replace(
        results,
        assemblies=tuple(
            find_assemblies(inputs.linkage, results.structure, kernels, q, number)
            for q, number in numbered or [(inputs.linkage.sketch.at, None)]
        ),
    )
