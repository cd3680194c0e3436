"""A quantity by the name that the tables give it, and how it is read from what was solved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from tmm_cli.linkage import Linkage
from tmm_cli.quantities import Dimension
from tmm_cli.structure.assur import Structure

Stage = Literal["structure", "places", "velocities", "accelerations", "forces", "balance"]
STAGES: tuple[Stage, ...] = ("structure", "places", "velocities", "accelerations", "forces", "balance")


class Solved(Protocol):
    """What quantities are read from: one linkage at its positions, or many variants at once."""

    @property
    def linkage(self) -> Any: ...

    @property
    def motion(self) -> Any: ...

    @property
    def reactions(self) -> Any: ...

    @property
    def strokes(self) -> Any: ...


@dataclass(frozen=True)
class Quantity:
    """A quantity of this linkage, by name.

    read: its values in SI, (positions) or (variants, positions), complex where it is a vector; (1) or (variants, 1)
    where it belongs to the mechanism as a whole (`whole`). against: what an error of it is a share of: its largest size
    in the cycle, its range there (of a place), a radian (of an angle, taken modulo 360 degrees: the end of a link is
    then off by that share of its length), or nothing (it is exact, as a class is). thing: the link, point or pair that
    it is of; on: the link on which a reaction acts. otherwise: the same reaction if the links of its compound hinge are
    attached to the other of its two links, as students may do.
    """

    name: str
    stage: Stage
    dimension: Dimension
    read: Callable[[Solved], Any]
    vector: bool = False
    whole: bool = False
    against: Literal["largest", "range", "angle", "exact"] = "largest"
    thing: str = ""
    on: str = ""
    otherwise: Quantity | None = None

    @property
    def order(self) -> int:
        """In which order the work is done."""
        return STAGES.index(self.stage)


Maker = Callable[["Linkage", "Structure"], "dict[str, Quantity]"]  # all quantities of a kind, by name
