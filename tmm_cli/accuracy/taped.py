"""The product's own way for many positions: the closed-form groups written on a tape and played back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tmm_cli.accuracy.case import Answers, Case, Unable
from tmm_cli.batch import prepare as batch_of
from tmm_cli.forces.plan import Reactions
from tmm_cli.motion import Motion
from tmm_cli.vectors import Real


def prepare(case: Case) -> Callable[[Real], Answers]:
    """Writes the tape. Raises Unable for groups that are found by iteration."""

    def asked(motion: Motion, plan: Reactions | None) -> Mapping[str, Any]:
        assert plan is not None
        found: dict[str, Any] = {"balancing": plan.balance.generalized}
        for name in case.points:
            point = motion.named_on(case.linkage.owner(name), name)
            found |= {f"positions.{name}": point.x, f"velocities.{name}": point.v, f"accelerations.{name}": point.a}
        return found | {f"reactions.{r.pair.name}": r.onto(r.pair.j) for r in plan.all}

    batch = batch_of(case.linkage, asked, strokes=case.strokes)
    if batch.program is None:
        raise Unable("groups that are found by iteration cannot be written on a tape")

    kinds = ("positions", "velocities", "accelerations", "reactions")
    names = {kind: [name for name in batch.program.outputs if name.startswith(f"{kind}.")] for kind in kinds}

    def at(q: Real) -> Answers:
        found = batch(q)
        x, v, a, forces = ({name[len(kind) + 1 :]: found[name] for name in own} for kind, own in names.items())
        return Answers(x, v, a, forces, found["balancing"])

    return at
