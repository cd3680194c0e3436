"""Load elements in a problem file: what the blocks of all kinds have in common, and how they are built.

A block is a field of `schema.File` that lists models with the base class ElementKeys, as `springs` does.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.elements.element import LoadElement
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.problem.schema_types import Name, Place, Strict
from tmm_cli.problem.values import FileSection, ValueReader, check_name

if TYPE_CHECKING:
    from tmm_cli.problem import schema


class ElementKeys(Strict):
    """Keys of every load element."""

    between: list[Name] = Field(min_length=2, max_length=2, description="the two links; one of them may be the frame")
    at: list[Place] | None = Field(
        default=None,
        min_length=2,
        max_length=2,
        description="ends of the element, one on each link; default: the first points of the links",
    )

    @abstractmethod
    def build(self, name: str, linkage: Linkage, section: FileSection) -> LoadElement:
        """Build the element from its section of the file. Raises ProblemError."""


class ElementPlace(NamedTuple):
    """The links that an element joins, and its points in the axes of each (m)."""

    i: str
    j: str
    at_i: complex
    at_j: complex


def build_elements(linkage: Linkage, shape: schema.File, values: ValueReader) -> tuple[LoadElement, ...]:
    """Build the load elements of all blocks, in their order in `schema.File`. Raises ProblemError."""
    elements: dict[str, LoadElement] = {}
    for block, name, keys in _element_keys(shape):
        check_name(name, (block, name), "load", {*shape.loads, *elements})
        elements[name] = keys.build(name, linkage, FileSection(keys, (block, name), values))
    return tuple(elements.values())


def _element_keys(shape: schema.File) -> Iterator[tuple[str, str, ElementKeys]]:
    """Yield each load element of the file: its block, its name and its keys."""
    for block in type(shape).model_fields:
        listed = getattr(shape, block)
        if isinstance(listed, dict):
            yield from ((block, name, keys) for name, keys in listed.items() if isinstance(keys, ElementKeys))


def place_element(section: FileSection, linkage: Linkage, *, turns: bool) -> ElementPlace:
    """Read `between` and `at` of an element. Raises ProblemError.

    turns: True for a torsional element, which has no ends.
    """
    keys: ElementKeys = section.keys
    i, j = section.two_links(linkage.links)
    if turns and keys.at is not None:
        raise section.refusal("at", _("a torsional element has no end points"), at_key=True)
    if keys.at is None:
        if not turns and any(len(linkage.links[n].points) > 1 for n in (i, j)):
            allowed = _("at: [point of the first link, point of the second link]")
            raise section.refusal("at", _("the ends are not given"), allowed=allowed)
        first, second = (next(iter(linkage.links[n].points.values()), 0j) for n in (i, j))
        return ElementPlace(i, j, first, second)
    first, second = (
        section.values.place(place, linkage.links[n].points, (*section.path, "at", k), n)
        for k, (n, place) in enumerate(zip((i, j), keys.at, strict=True))
    )
    if any({i, j} <= set(h.links) and keys.at[0] == keys.at[1] == h.point for h in linkage.hinges):
        message = _("both ends are at hinge {point}, so the length is zero")
        raise section.refusal("at", message.format(point=keys.at[0]))
    return ElementPlace(i, j, first, second)
