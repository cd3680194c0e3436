"""A group drawn in its other assembly."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.language import N_
from tmm_cli.variants.family import Family


@dataclass(frozen=True)
class Mirror(Mistake):
    """The group of these links lies on the other side."""

    links: str = ""

    name = N_("mirror assembly")
    sentence = N_("This belongs to another assembly: links {links} were drawn on the other side.")

    @classmethod
    def cases(cls, family: Family) -> Iterable[Self]:
        for kernel in family.kernels:
            if isinstance(kernel, Closed) and kernel.assemblies == 2:
                yield cls(", ".join(kernel.group.links))

    def kernel(self, kernel: Kernel, family: Family) -> Kernel:
        if isinstance(kernel, Closed) and ", ".join(kernel.group.links) == self.links:
            return replace(kernel, sign=-kernel.sign)
        return kernel
