"""Code that works on arrays, written down once and played back on many numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tmm_cli.batch.tape.program import Outputs, Program
from tmm_cli.batch.tape.terms import Tape
from tmm_cli.batch.tape.traced import DependsOnData, TracedArray

__all__ = ["DependsOnData", "Outputs", "Program", "TracedArray", "record"]


def record(function: Callable[..., Mapping[str, Any]], *axes: int, data: Mapping[int, Any] | None = None) -> Program:
    """Run a function on stand-ins for real arrays; what it gives by name are the outputs of the program.

    axes: on what each argument depends: 1 on the variant, 2 on the position, 3 on both. data: of some arguments, by
    their number, if the program is for these alone. Raises DependsOnData where the code takes a branch by numbers that
    differ.
    """
    tape = Tape(dict(data or {}))
    stands = [TracedArray(tape, tape.term("input", k, axes=axis)) for k, axis in enumerate(axes)]
    outputs = {}
    for name, value in function(*stands).items():
        if isinstance(value, TracedArray):
            outputs[name] = (value.re, value.im)
        else:
            one = np.ravel(value)[0]
            outputs[name] = (one.real, one.imag) if np.iscomplexobj(one) else (one, None)
    return Program(tuple(tape.terms), axes, outputs)
