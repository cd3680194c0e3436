"""The method of tmm, in single, double and extended precision, and as a recorded computation that is repeated.

Each Assur group is solved on its own: its positions in closed form, if there is one, then its reactions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.batch import Batch, prepare_batch as batch_of
from tmm_cli.bench.methods.case import Case, MethodAnswers, UnsupportedLinkageError, build_answers_from_forces
from tmm_cli.mechanics.accuracy import as_double_doubles
from tmm_cli.mechanics.forces import Reactions, solve_reactions
from tmm_cli.mechanics.groups import GroupSolver, NewtonSolver, WrappedSolver
from tmm_cli.mechanics.kinematics import Motion, compute_motion
from tmm_cli.mechanics.numerics import DoubleDouble, Real, map_record, to_double_double
from tmm_cli.mechanics.structure import Group, Pair


def convert_precision(value: Any, real: type) -> Any:
    """Convert all numbers in records, tuples and arrays to the type `real`, or to the corresponding complex type."""
    if isinstance(value, (bool, int, str, Group, Pair)) or value is None:
        return value
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fc":
            return value
        return value.astype(np.result_type(real, np.complex64) if value.dtype.kind == "c" else real)
    if isinstance(value, (float, np.floating)):
        return real(value)
    if isinstance(value, (complex, np.complexfloating)):
        return np.result_type(real, np.complex64).type(value)
    if isinstance(value, Mapping):
        return {key: convert_precision(element, real) for key, element in value.items()}
    if isinstance(value, tuple):
        return tuple(convert_precision(element, real) for element in value)
    if is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in fields(value) if field.init]
        return replace(value, **{name: convert_precision(getattr(value, name), real) for name in names})
    return value


@dataclass(frozen=True)
class ConvertedSolver(WrappedSolver):
    """Solver of an Assur group that computes in another precision: its input and its results are converted."""

    real: type

    def passed(self, work: Callable[..., Any], *arguments: Any) -> Any:
        return convert_precision(work(*(convert_precision(argument, self.real) for argument in arguments)), self.real)


def prepare_double(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the method of tmm in float64: dyads in closed form, groups of higher class by Newton's method."""
    return _prepare_precision(case, np.float64)


def prepare_single(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the method of tmm in float32.

    Only sums of loads and products with the driver speed are computed in float64.
    """
    linkage = convert_precision(case.linkage, np.float32)
    kernels = tuple(ConvertedSolver(k.group, k.size, _round_start(k.rebind(linkage)), np.float32) for k in case.kernels)
    return _prepare_precision(replace(case, linkage=linkage, kernels=kernels), np.float32)


def _round_start(kernel: GroupSolver) -> GroupSolver:
    """Round the initial guesses of a group of higher class to float32."""
    if isinstance(kernel, NewtonSolver):
        return replace(
            kernel, start=convert_precision(kernel.start, np.float32), trace=convert_precision(kernel.trace, np.float32)
        )
    return kernel


def prepare_extended(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the method of tmm in double-double arithmetic from the same input data; the results are longdouble."""
    linkage = as_double_doubles(case.linkage)
    wide = _prepare_precision(
        replace(case, linkage=linkage, kernels=tuple(k.rebind(linkage) for k in case.kernels)), to_double_double
    )
    return lambda q: map_record(lambda _, leaf: _longdouble(leaf) if isinstance(leaf, DoubleDouble) else leaf, wide(q))


def _longdouble(value: DoubleDouble) -> Any:
    kind = np.clongdouble if value.dtype.kind == "c" else np.longdouble
    return value.hi.astype(kind) + value.lo


def _prepare_precision(case: Case, real: Callable[[Any], Any]) -> Callable[[Real], MethodAnswers]:
    def at(q: Real) -> MethodAnswers:
        motion = compute_motion(case.linkage, case.kernels, real(q), case.law)
        motion = replace(motion, rate=real(motion.rate))  # otherwise its square would be rounded to float64
        return build_answers_from_forces(case, motion, solve_reactions(motion, case.structure, case.loads(motion)))

    return at


# The product's method for many positions: the groups as a traced program, which is replayed.


def make_batch(case: Case, *, forces: bool = True) -> Batch:
    """Record the computation of the compared quantities, so that it can be repeated for other driver coordinates.

    The results have names such as "velocities.B".
    """

    def asked(motion: Motion, plan: Reactions | None) -> Mapping[str, Any]:
        values: dict[str, Any] = {}
        for name in case.linkage.moving_points:
            point = motion.named_on(case.linkage.owner(name), name)
            values |= {f"positions.{name}": point.x, f"velocities.{name}": point.v, f"accelerations.{name}": point.a}
        if plan is not None:
            values |= {f"reactions.{r.pair.name}": r.onto(r.pair.j) for r in plan.all}
            values["balancing"] = plan.balance.generalized
        return values

    return batch_of(case.linkage, asked, forces=forces, strokes=case.strokes)


def prepare_traced(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the method of tmm as a recorded computation, which is repeated for new driver coordinates.

    Raises:
        MethodUnable: The computation of the linkage cannot be recorded.
    """
    played = make_batch(case)
    if played.program is None:
        raise UnsupportedLinkageError("cam laws, friction and redundant constraints cannot be traced")
    kinds = ("positions", "velocities", "accelerations", "reactions")
    names = {kind: [name for name in played.program.outputs if name.startswith(f"{kind}.")] for kind in kinds}

    def at(q: Real) -> MethodAnswers:
        values = played(q)
        x, v, a, forces = ({name[len(kind) + 1 :]: values[name] for name in outputs} for kind, outputs in names.items())
        return MethodAnswers(x, v, a, forces, values["balancing"])

    return at
