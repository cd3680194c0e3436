"""Which positions are drawn in full: those the file names, or where the driver is balanced hardest."""

from __future__ import annotations

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.vectors import Real


def in_detail(results: Results) -> tuple[int, ...]:
    """Indices of the positions in detail, among those computed; none where nothing moves.

    A single position is always one. Where the file names none it is the one of the largest balancing moment or force
    of the first driver; where nothing acts, the one after position 0, in which the output often rests.
    """
    computed = _computed(results)
    wanted = results.inputs.request.detail if len(results.numbers) > 1 else results.numbers
    if wanted:
        return tuple(k for k in np.flatnonzero(computed).tolist() if results.numbers[k] in wanted)
    if not computed.any():
        return ()
    balance = balancing(results)
    if balance.any():
        return (int(np.argmax(balance)),)
    return (int(np.flatnonzero(computed)[:2][-1]),)


def chosen_here(results: Results) -> bool:
    """Whether the file leaves it to the program which position is drawn in full."""
    return len(results.numbers) > 1 and not results.inputs.request.detail


def balancing(results: Results) -> Real:
    """The size of the first driver's balancing moment (N m) or force (N) at each position; zero where there is none."""
    computed = _computed(results)
    if results.reactions is None:
        return np.zeros(len(computed))
    sizes: Real = np.abs(results.reactions.balance.generalized)
    return np.where(computed & np.isfinite(sizes), sizes, 0.0)


def _computed(results: Results) -> Real:
    motion = results.motion
    assert motion is not None
    return motion.moving & ~results.locked
