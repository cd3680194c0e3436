"""Program of traced operations, and the results that it returns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.batch.trace_terms import UFUNCS, Term, axes_of

Array = np.ndarray[Any, Any]


class TraceOutputs(Mapping[str, Array]):
    """Results by name, (variants, positions), or (positions,) if no input depends on the variant.

    Real and imaginary parts are stored separately, and `part` returns one of them. A complex array is combined
    when it is read.
    """

    def __init__(
        self,
        names: Mapping[str, tuple[Any, Any]],
        planes: Mapping[Any, Array],
        turned: bool,
        several: bool,
        shape: tuple[int, int],
    ) -> None:
        self.names, self.planes, self.turned, self.several, self.shape = names, planes, turned, several, shape

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def part(self, name: str, imaginary: bool = False) -> Array:
        """Return the real or imaginary part of a result."""
        value = self.names[name][imaginary]
        plane = self.planes[value.number] if isinstance(value, Term) else np.asarray(0.0 if value is None else value)
        if plane.shape != self.shape:
            plane = np.broadcast_to(plane, self.shape)
        return (plane.T if self.turned else plane) if self.several else plane.reshape(-1)

    def without(self, name: str) -> TraceOutputs:
        """Return the results without the one of this name."""
        names = {output: parts for output, parts in self.names.items() if output != name}
        return TraceOutputs(names, self.planes, self.turned, self.several, self.shape)

    @property
    def several_shape(self) -> tuple[int, int]:
        """Shape (variants, positions) of the results that depend on the variant."""
        return self.shape[::-1] if self.turned else self.shape

    def replace_values(self, variant: int, where: Array, values: Mapping[str, Array]) -> TraceOutputs:
        """Return the results with values of one variant replaced at the positions where the mask `where` is True."""
        planes = dict(self.planes)
        for name, parts in self.names.items():
            for imaginary, term in enumerate(parts):
                if isinstance(term, Term):
                    plane = planes[term.number]
                    if plane.shape != self.shape or term.op == "input":
                        plane = planes[term.number] = np.broadcast_to(plane, self.shape).copy()
                    row = plane[:, variant] if self.turned else plane[variant]
                    row[where] = values[name].imag if imaginary else values[name].real
        return TraceOutputs(self.names, planes, self.turned, self.several, self.shape)

    def __getitem__(self, name: str) -> Array:
        if self.names[name][1] is None:
            return self.part(name)
        real, imag = self.part(name), self.part(name, True)
        combined = np.empty(real.shape, dtype=complex)
        combined.real, combined.imag = real, imag
        return combined


# Programs: NumPy calls on registers that are allocated in advance.


CHUNK = 9000  # numbers in a register: with fewer there are more calls, with more there are cache misses


@dataclass(frozen=True)
class TraceProgram:
    """Program of traced operations: a sequence of NumPy calls on registers (work arrays).

    Memory is allocated once, each call writes its result in place, and long data are processed in chunks that
    fit into the processor cache. If there are more variants than positions, variants are on the last axis,
    where NumPy is faster.

    Attributes:
        terms: the operations in order.
        inputs: axes of each input (bit 1: variants, bit 2: positions).
        outputs: terms of the real and the imaginary part of each output, by name.
    """

    terms: tuple[Term, ...]
    inputs: tuple[int, ...]
    outputs: Mapping[str, tuple[Any, Any]]

    def only(self, *names: str) -> TraceProgram:
        """Return the program restricted to the outputs with these names."""
        return replace(self, outputs={name: self.outputs[name] for name in names})

    @property
    def operations(self) -> int:
        """Number of NumPy calls per chunk."""
        return self._code.operations

    @cached_property
    def _code(self) -> _CompiledProgram:
        return _CompiledProgram(self)

    def __call__(self, *data: Any) -> TraceOutputs:
        """Run the program on data of shape (variants, 1), (positions,) or (variants, positions), according to
        `inputs`.
        """
        columns = [np.asarray(d, dtype=float) for d in data]
        variants = positions = 1
        for column, axes in zip(columns, self.inputs, strict=True):
            if axes & 1:
                variants = max(variants, len(column))
            if axes & 2:
                positions = max(positions, column.shape[-1])
        several = any(axes & 1 for axes in self.inputs)
        turned = positions < variants  # the longer axis last
        shape = (positions, variants) if turned else (variants, positions)
        arranged = [_arrange_axes(d, axes, turned) for d, axes in zip(columns, self.inputs, strict=True)]
        return TraceOutputs(self.outputs, self._code.run(arranged, shape), turned, several, shape)


def _arrange_axes(value: Array, axes: int, turned: bool) -> Array:
    """Arrange data so that their axes match those of the registers."""
    if axes == 3:
        return np.ascontiguousarray(value.T if turned else value)
    last = (axes == 1) == turned  # whether its own axis is the last one
    return value.reshape((1, -1) if last else (-1, 1))


class _CompiledProgram:
    """Program in two parts. Operations that depend on both the variant and the position are in the second one.

    The first part runs once, the second part for each chunk of the data. The second part is a generated function with
    one NumPy call per line, on inputs i, outputs o and registers r.
    """

    def __init__(self, program: TraceProgram) -> None:
        used = _needed_terms(program)
        self.everywhere = 0
        for axes in program.inputs:
            self.everywhere |= axes
        self.before = [t for t in used if t.op != "input" and t.axes != self.everywhere]
        self.inputs = {t.number: t.args[0] for t in used if t.op == "input"}
        full = [t for t in used if t.op != "input" and t.axes == self.everywhere]
        outputs = [v for parts in program.outputs.values() for v in parts if isinstance(v, Term)]
        self.small = {t.number for t in outputs if t.op == "input" or t.axes != self.everywhere}
        slots = {t.number: t for t in outputs if t.number not in self.small}
        ordered = sorted(slots.values(), key=lambda t: t.truth)  # booleans last
        self.slots = {t.number: k for k, t in enumerate(ordered)}
        self.truths = sum(t.truth for t in ordered)
        writer = _ProgramWriter(full, self.slots)
        self.operations, self.kinds, self.outer = len(writer.lines), writer.kinds, writer.outer
        names: dict[str, Any] = {f"f_{name}": function for name, function in UFUNCS.items()}
        names |= {"copy": np.copyto, "where": np.where, "read": _interpolate, "call": _call} | writer.constants
        exec(compile(writer.source, "<trace>", "exec"), names)  # contains only names of NumPy functions and registers
        self.function = names["program"]
        self.space: dict[tuple[int, int], list[Array]] = {}

    def registers(self, shape: tuple[int, int]) -> list[Array]:
        """Return the work arrays for a chunk of this shape; they are kept for later chunks."""
        if shape not in self.space:
            if len(self.space) > 4:
                self.space.clear()
            block = np.empty((sum(not truth for truth in self.kinds), *shape))
            truths = np.empty((sum(self.kinds), *shape), dtype=bool)
            floats, bools = iter(block), iter(truths)
            self.space[shape] = [next(bools if truth else floats) for truth in self.kinds]
        return self.space[shape]

    def run(self, data: Sequence[Array], shape: tuple[int, int]) -> dict[Any, Array]:
        """Return the arrays of all terms that are outputs, by number of the term."""
        with np.errstate(all="ignore"):
            evaluated = {number: data[k] for number, k in self.inputs.items()}
            for term in self.before:
                evaluated[term.number] = _evaluate(term, evaluated)
            operands = [evaluated[number] for number in self.outer]
            floats, truths = len(self.slots) - self.truths, self.truths
            rows, columns = shape
            wide = -(-columns // -(-columns // CHUNK))  # chunks of equal width
            high = max(1, min(rows, CHUNK // wide))
            if rows <= high and columns <= wide:
                planes = [*np.empty((floats, *shape)), *np.empty((truths, *shape), dtype=bool)]
                self.function(*operands, *planes, *self.registers(shape))
            else:  # one array for each output: a single large block would be cleared by the system every time
                planes = [np.empty(shape, dtype=bool if k >= floats else float) for k in range(floats + truths)]
                for top in range(0, rows, high):
                    for first_column in range(0, columns, wide):
                        chunk = (slice(top, top + high), slice(first_column, first_column + wide))
                        chunk_shape = (min(high, rows - top), min(wide, columns - first_column))
                        parts = [_chunk_of(d, chunk) for d in operands]
                        self.function(*parts, *[plane[chunk] for plane in planes], *self.registers(chunk_shape))
        return dict(zip(self.slots, planes, strict=True)) | {n: evaluated[n] for n in self.small}


def _chunk_of(data: Array, chunk: tuple[slice, slice]) -> Array:
    """Return a chunk of data; an axis of length 1 is kept whole."""
    return data[chunk[0] if data.shape[0] > 1 else slice(None), chunk[1] if data.shape[1] > 1 else slice(None)]


def _evaluate(term: Term, evaluated: Mapping[int, Array]) -> Array:
    args = [evaluated[a.number] if isinstance(a, Term) else a for a in term.args]
    if term.op == "where":
        return np.where(*args)
    if term.op == "table":
        return np.asarray(np.interp(args[0], *args[1]))
    (called,), operands = (args[0], args[1:]) if term.op == "call" else ((UFUNCS[term.op],), args)
    evaluation: Array = called(*operands)
    return evaluation


def _call(function: tuple[Any], *operands: Any) -> None:
    *inputs, out = operands
    out[...] = function[0](*inputs)


def _interpolate(x: Array, table: tuple[Any, Any], out: Array) -> None:
    out[...] = np.interp(x, *table)


def _needed_terms(program: TraceProgram) -> tuple[Term, ...]:
    """Return the terms on which the outputs depend, in the order of their numbers."""
    needed: set[int] = set()
    pending = [v for parts in program.outputs.values() for v in parts if isinstance(v, Term)]
    while pending:
        term = pending.pop()
        if term.number not in needed:
            needed.add(term.number)
            pending += [a for a in term.args if isinstance(a, Term)]
    return tuple(t for t in program.terms if t.number in needed)


class _ProgramWriter:
    """Writes source code for terms one by one; a register is used again after its last use.

    slots: index of the output for each term that is an output; it is computed in place.
    """

    def __init__(self, terms: Sequence[Term], slots: Mapping[int, int]) -> None:
        self.slots = slots
        self.constants: dict[str, Any] = {}
        self._names: dict[tuple[str, Any], str] = {}
        self.kinds: list[bool] = []
        self.outer: list[int] = []
        self.lines: list[str] = []
        self._free: dict[bool, list[str]] = {False: [], True: []}
        self._owned: dict[int, str] = {}
        self._where = {number: f"o{slot}" for number, slot in slots.items()}
        inner = {t.number for t in terms}
        uses: dict[int, list[int]] = {}
        for k, term in enumerate(terms):
            for arg in term.args:
                if isinstance(arg, Term):
                    uses.setdefault(arg.number, []).append(k)
                    if arg.number not in inner and arg.number not in self.outer:
                        self.outer.append(arg.number)
                        self._where[arg.number] = f"i{len(self.outer) - 1}"
        self._last = {number: where[-1] for number, where in uses.items()}
        for k, term in enumerate(terms):
            self._write(k, term)
        head = [f"i{k}" for k in range(len(self.outer))] + [f"o{k}" for k in range(len(slots))]
        head += [f"r{k}" for k in range(len(self.kinds))]
        body = "\n    ".join(self.lines or ["pass"])
        self.source = f"def program({', '.join(head)}):\n    {body}\n"

    def _constant(self, value: Any) -> str:
        key = ("table", id(value)) if isinstance(value, tuple) else (type(value).__name__, value)
        if key not in self._names:
            self._names[key] = f"c{len(self._names)}"
            self.constants[self._names[key]] = value if isinstance(value, tuple) else np.asarray(value)
        return self._names[key]

    def _name(self, value: Any) -> str:
        return self._where[value.number] if isinstance(value, Term) else self._constant(value)

    def _release(self, k: int, args: tuple[Any, ...]) -> None:
        for arg in args:
            if isinstance(arg, Term) and self._last[arg.number] == k and arg.number in self._owned:
                self._free[arg.truth].append(self._owned.pop(arg.number))

    def _write(self, k: int, term: Term) -> None:
        op, args = term.op, term.args
        read = [self._constant(a) if isinstance(a, tuple) else self._name(a) for a in args]
        if op != "where":
            self._release(k, args)
        if term.number in self.slots:
            to = self._where[term.number]
        else:
            free = self._free[term.truth]
            if not free:
                free.append(f"r{len(self.kinds)}")
                self.kinds.append(term.truth)
            to = self._owned[term.number] = self._where[term.number] = free.pop()
        if op == "where":
            if axes_of(args[0]) == 1:  # neighbouring elements differ, for which masked copying is slow
                self.lines.append(f"copy({to}, where({', '.join(read)}))")
            else:
                self.lines += [f"copy({to}, {read[2]})", f"copy({to}, {read[1]}, where={read[0]})"]
            self._release(k, args)
        else:
            out = f"out={to}" if op in ("maximum", "minimum") else to
            name = {"table": "read", "call": "call"}.get(op, f"f_{op}")
            self.lines.append(f"{name}({', '.join(read)}, {out})")
