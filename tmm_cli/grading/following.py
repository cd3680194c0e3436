"""Following errors: an answer that is right given the student's own earlier answers earns its points.

Earlier is what the order of the work has before it, at the same position. Each wrong answer is first tried with one
earlier answer in the place of the right one, then with all of them.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.grading.diagnose import Claim
from tmm_cli.grading.own_answers import own_answer
from tmm_cli.grading.sheet import Right, Written, written_down
from tmm_cli.grading.solution import solve
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real

Cell = tuple[int, int]  # a student and an answer


def following(
    family: Family, right: Right, written: Written, claims: dict[int, list[Claim]]
) -> dict[Cell, tuple[int, ...]]:
    """Wrong answers that follow from earlier ones of the same student: from which."""
    wrong = right.error(written) > right.allowed
    whole = _whole(right, written)
    found: dict[Cell, tuple[int, ...]] = _by_mistake(right, wrong, claims)
    rows = np.flatnonzero(np.sum(wrong, axis=1) > 1)
    wanted: dict[tuple[int, ...], list[Cell]] = {}
    for n in rows.tolist():
        for k in np.flatnonzero(wrong[n]).tolist():
            for before in _earlier(right, wrong, n, k):
                wanted.setdefault((before,), []).append((n, k))
    found |= _fitting(family, right, written, whole, wanted, found)
    wanted = {}
    for n in rows.tolist():
        for k in np.flatnonzero(wrong[n]).tolist():
            sources = tuple(_earlier(right, wrong, n, k))
            if len(sources) > 1 and (n, k) not in found:
                wanted.setdefault(sources, []).append((n, k))
    return found | _fitting(family, right, written, whole, wanted, found)


def _whole(right: Right, written: Written) -> Real:
    """Answers as vectors: what is told by its size alone has the right direction."""
    with np.errstate(all="ignore"):
        direction = np.where(right.value == 0, 1, right.value / np.abs(right.value))
    return np.where(written.size, np.abs(written.value) * direction, written.value)


def _earlier(right: Right, wrong: Real, n: int, k: int) -> Iterable[int]:
    """Wrong answers that come before one in the work, at its position."""
    asked = right.asked
    for j in np.flatnonzero(wrong[n]).tolist():
        same = asked[j].position == asked[k].position
        if same and (asked[j].quantity.order, j) < (asked[k].quantity.order, k):
            yield j


def _by_mistake(right: Right, wrong: Real, claims: dict[int, list[Claim]]) -> dict[Cell, tuple[int, ...]]:
    """What one mistake in the work made wrong costs once: later answers follow from the first that shows it."""
    found: dict[Cell, tuple[int, ...]] = {}
    for n, own in claims.items():
        for claim in own:
            if all(case.solves for case in claim.alternatives):
                for k in claim.answers:
                    before = [j for j in _earlier(right, wrong, n, k) if j in claim.answers]
                    if before:
                        found[n, k] = (before[0],)
    return found


def _fitting(
    family: Family, right: Right, written: Written, whole: Real, wanted: dict[tuple[int, ...], list[Cell]],
    known: dict[Cell, tuple[int, ...]],
) -> dict[Cell, tuple[int, ...]]:  # fmt: skip
    """Those of the wanted answers that fit the sources under which they stand."""
    found: dict[Cell, tuple[int, ...]] = {}
    for sources, cells in wanted.items():
        cells = [cell for cell in cells if cell not in known and cell not in found]
        if not cells:
            continue
        students = np.array(sorted({n for n, _ in cells}))
        own = family.take(students)
        motion = solve(own).motion
        values = [whole[students, j][:, None] for j in sources]
        rights = [right.value[students, j][:, None] for j in sources]
        made = [
            own_answer(right.asked[j].quantity, v, motion, r) for j, v, r in zip(sources, values, rights, strict=True)
        ]
        mistakes = [one for one in made if one is not None]
        if not mistakes:
            continue
        with np.errstate(all="ignore"):
            value = written_down(solve(own, mistakes), right.asked)
            part = right.take(students)
            scale = np.maximum(1.0, np.abs(value) / part.scale)
            fits = part.error(written.take(students), value) / scale <= part.allowed
        at = {n: row for row, n in enumerate(students.tolist())}
        found |= {(n, k): sources for n, k in cells if fits[at[n], k]}
    return found
