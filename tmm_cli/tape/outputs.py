"""What a program gives: planes of real numbers, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from tmm_cli.tape.terms import Term

Array = np.ndarray[Any, Any]


class Outputs(Mapping[str, Array]):
    """Results by name, (variants, positions), or (positions,) where no data are over variants.

    Real and imaginary parts lie in planes of their own, `part` gives one of them; an array of complex numbers is put
    together when it is asked for.
    """

    def __init__(
        self, names: Mapping[str, tuple[Any, Any]], planes: Mapping[Any, Array], turned: bool, several: bool,
        shape: tuple[int, int],
    ) -> None:  # fmt: skip
        self.names, self.planes, self.turned, self.several, self.shape = names, planes, turned, several, shape

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def part(self, name: str, imaginary: bool = False) -> Array:
        """Real or imaginary part of a result."""
        value = self.names[name][imaginary]
        found = self.planes[value.number] if isinstance(value, Term) else np.asarray(0.0 if value is None else value)
        if found.shape != self.shape:
            found = np.broadcast_to(found, self.shape)
        return (found.T if self.turned else found) if self.several else found.reshape(-1)

    def without(self, name: str) -> Outputs:
        """All but one."""
        names = {one: parts for one, parts in self.names.items() if one != name}
        return Outputs(names, self.planes, self.turned, self.several, self.shape)

    @property
    def several_shape(self) -> tuple[int, int]:
        """Variants and positions."""
        return self.shape[::-1] if self.turned else self.shape

    def put(self, variant: int, where: Array, values: Mapping[str, Array]) -> Outputs:
        """With other values of a variant at the positions of a mask; there are as many as it has, in their order."""
        planes = dict(self.planes)
        for name, parts in self.names.items():
            for imaginary, term in enumerate(parts):
                if isinstance(term, Term):
                    plane = planes[term.number]
                    if plane.shape != self.shape or term.op == "input":
                        plane = planes[term.number] = np.broadcast_to(plane, self.shape).copy()
                    own = plane[:, variant] if self.turned else plane[variant]
                    own[where] = values[name].imag if imaginary else values[name].real
        return Outputs(self.names, planes, self.turned, self.several, self.shape)

    def __getitem__(self, name: str) -> Array:
        if self.names[name][1] is None:
            return self.part(name)
        real, imag = self.part(name), self.part(name, True)
        found = np.empty(real.shape, dtype=complex)
        found.real, found.imag = real, imag
        return found
