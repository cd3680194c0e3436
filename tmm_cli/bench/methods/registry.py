"""List of all methods, those of tmm and others. To add one, write a module and list it here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from tmm_cli.bench.methods import board, differences, product
from tmm_cli.bench.methods.case import Case, Method, MethodAnswers
from tmm_cli.bench.methods.constraint_equations import prepare_loops, prepare_multibody
from tmm_cli.mechanics.numerics import Real


def method_family(
    name: str,
    prepare: Callable[[float, Case], Callable[[Real], MethodAnswers]],
    settings: Mapping[str, float],
    *,
    timed: bool = True,
) -> tuple[Method, ...]:
    """Return methods that differ in one setting.

    Args:
        name: Name of the family.
        prepare: Called with the setting and the case.
        settings: Values of the setting, by the suffix of the method's name.
        timed: False if the times of these methods are not meaningful.
    """
    return tuple(Method(f"{name}-{key}", name, partial(prepare, at), at, timed) for key, at in settings.items())


CLOSED_FORM = Method("closed", "closed", product.prepare_double)
TAPED = Method("taped", "taped", product.prepare_traced)
METHODS: tuple[Method, ...] = (
    CLOSED_FORM,
    TAPED,
    *method_family("newton", prepare_loops, {f"{k}": 10.0**-k for k in range(2, 16)}),
    Method("multibody", "multibody", prepare_multibody),
    *method_family("differences", differences.prepare_differences, {f"{k}": 10.0**-k for k in range(1, 9)}),
    Method("single", "single", product.prepare_single),
    Method("extended", "extended", product.prepare_extended),
    *method_family("board", board.prepare_board, {f"{mm:.2f}": mm for mm in (0.25, 0.5)}, timed=False),
)
LEFT_OUT = ("newton-3", "newton-5", "newton-7", "newton-9", "newton-11", "newton-13", "differences-5", "differences-7")
FEWER = tuple(method for method in METHODS if method.name not in LEFT_OUT)
