"""The product's own way for many positions: the groups written on a tape and played back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tmm_cli.bench.methods.case import Answers, Case, Unable
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.variants.batch import Batch
from tmm_cli.variants.batch import prepare as batch_of
from tmm_cli.vectors import Real


def batch(case: Case, *, forces: bool = True) -> Batch:
    """What the common form of answers holds, and nothing else: QUANTITY.NAME, and "balancing"."""

    def asked(motion: Motion, plan: Reactions | None) -> Mapping[str, Any]:
        found: dict[str, Any] = {}
        for name in case.linkage.moving_points:
            point = motion.named_on(case.linkage.owner(name), name)
            found |= {f"positions.{name}": point.x, f"velocities.{name}": point.v, f"accelerations.{name}": point.a}
        if plan is not None:
            found |= {f"reactions.{r.pair.name}": r.onto(r.pair.j) for r in plan.all}
            found["balancing"] = plan.balance.generalized
        return found

    return batch_of(case.linkage, asked, forces=forces, strokes=case.strokes)


def prepare(case: Case) -> Callable[[Real], Answers]:
    """Writes the tape. Raises Unable for what cannot be written on one."""
    played = batch(case)
    if played.program is None:
        raise Unable("laws of cams, friction and passive constraints cannot be written on a tape")
    kinds = ("positions", "velocities", "accelerations", "reactions")
    names = {kind: [name for name in played.program.outputs if name.startswith(f"{kind}.")] for kind in kinds}

    def at(q: Real) -> Answers:
        found = played(q)
        x, v, a, forces = ({name[len(kind) + 1 :]: found[name] for name in own} for kind, own in names.items())
        return Answers(x, v, a, forces, found["balancing"])

    return at
