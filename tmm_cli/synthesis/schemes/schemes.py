"""Structural synthesis: all schemes of mechanisms formed by attaching Assur groups one after another.

A scheme begins with driving cranks hinged to the frame. Every group is attached by its external pairs to the frame and
to links that are already present (L. V. Assur; I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 3). The
mobility then equals the number of cranks, because a group neither adds nor removes degrees of freedom. A scheme is
admissible if it can move:

- The external pairs of a group are not all on one link, with which the group would form a rigid body.
- Every hinge can rotate: two links that keep their relative direction, because they are connected only by prismatic
  pairs, have no hinge between them. A contour with a single revolute pair would have one.
- Every crank drives a link, and the mechanism stays connected when the frame is removed.

All pairs are simple. A compound hinge consists of two hinges of a link at one point, which is a matter of dimensions.
Two schemes are equal if their links correspond: the frame to the frame, cranks to cranks, and every pair to a pair of
the same kind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Literal

from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import ROMAN, structural_formula
from tmm_cli.synthesis.schemes.chains import GraphForm, canonical_form

Kind = Literal["R", "P"]
Joint = tuple[int, int, Kind]
"""Two links, the one placed earlier first, and the kind of their pair. Link 0 is the frame."""

MOST_LINKS_OF_SCHEME = 9
MOST_CRANKS = 3
MOST_SCHEMES = 2000


@dataclass(frozen=True)
class GroupType:
    """Type of an Assur group.

    Attributes:
        name: name of the type, e.g. RRP; for class III and IV the class.
        grade: class of the group as a number.
        links: number of links; they are numbered 0, 1, ....
        inner: internal pairs.
        outer: external pairs, each as a link of the group and the kind of pair.
    """

    name: str
    grade: int
    links: int
    inner: tuple[Joint, ...]
    outer: tuple[tuple[int, Kind], ...]

    @property
    def title(self) -> str:
        """Class and type, e.g. II RRP; for a group of class III or IV the class alone."""
        return f"{ROMAN[self.grade]} {self.name}" if self.grade == 2 else self.name


def _make_dyad(name: str) -> GroupType:
    return GroupType(name, 2, 2, ((0, 1, _read_kind(name[1])),), ((0, _read_kind(name[0])), (1, _read_kind(name[2]))))


def _read_kind(letter: str) -> Kind:
    return "P" if letter == "P" else "R"


GROUP_TYPES: dict[str, GroupType] = {
    **{name: _make_dyad(name) for name in ("RRR", "RRP", "RPR", "PRP", "RPP")},
    # a ternary link with its three external pairs
    "III": GroupType("III", 3, 4, ((0, 1, "R"), (0, 2, "R"), (0, 3, "R")), ((1, "R"), (2, "R"), (3, "R"))),
    # a closed contour of four; external pairs on adjacent links would split it into two dyads
    "IV": GroupType("IV", 4, 4, ((0, 1, "R"), (1, 2, "R"), (2, 3, "R"), (0, 3, "R")), ((0, "R"), (2, "R"))),
}
GROUP_CLASSES = {"II": ("RRR", "RRP", "RPR", "PRP", "RPP"), "III": ("III",), "IV": ("IV",)}


class TooManySchemes(Exception):  # noqa: N818
    """Raised if there are more than MOST_SCHEMES schemes."""


@dataclass(frozen=True)
class PlacedGroup:
    """An Assur group in a scheme.

    Attributes:
        type: type of the group.
        links: numbers of its links in the scheme.
        inner: internal pairs.
        outer: external pairs, in the order of the type.
    """

    type: GroupType
    links: tuple[int, ...]
    inner: tuple[Joint, ...]
    outer: tuple[Joint, ...]

    @property
    def title(self) -> str:
        """Class and links as the structural formula writes them, e.g. II(2,3)."""
        return f"{ROMAN[self.type.grade]}({','.join(map(str, self.links))})"


@dataclass(frozen=True)
class Scheme:
    """A scheme of a mechanism: driving cranks and Assur groups.

    Link 0 is the frame. The cranks are numbered from 1, followed by the links of the groups in the order of attachment.

    Attributes:
        cranks: number of cranks.
        groups: Assur groups in the order of attachment.
    """

    cranks: int
    groups: tuple[PlacedGroup, ...] = ()

    @property
    def mobility(self) -> int:
        """Mobility by Chebyshev's formula, 3n - 2 p1, for n moving links and p1 pairs."""
        return 3 * self.links - 2 * len(self.joints)

    @property
    def links(self) -> int:
        """Number of moving links."""
        return self.cranks + sum(len(group.links) for group in self.groups)

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """All kinematic pairs: first those of the cranks with the frame, then those of each group."""
        driving: tuple[Joint, ...] = tuple((0, crank, "R") for crank in range(1, self.cranks + 1))
        return driving + tuple(joint for group in self.groups for joint in (*group.outer, *group.inner))

    @property
    def formula(self) -> str:
        """Structural formula of the mechanism, as `structural_formula` writes it."""
        titles = {crank: f"I({FRAME},{crank})" for crank in range(1, self.cranks + 1)}
        titles |= {link: group.title for group in self.groups for link in group.links}
        parts: dict[str, list[str]] = {titles[crank]: [] for crank in range(1, self.cranks + 1)}
        for group in self.groups:
            ends = [link for i, j, _kind in group.outer for link in (i, j)]
            parts[group.title] = [titles[link] for link in ends if link in titles and link not in group.links]
        return structural_formula(parts)

    @property
    def types(self) -> tuple[str, ...]:
        """Classes and types of the groups, e.g. II RRR, II RRP, III."""
        return tuple(group.type.title for group in self.groups)

    @property
    def name(self) -> str:
        """Name for a file, e.g. II-RRR-II-RRP."""
        return "-".join(title.replace(" ", "-") for title in self.types)

    @cached_property
    def form(self) -> GraphForm:
        """Canonical form, independent of the numbering of the links. Two schemes are equal if and only if their forms
        are equal.
        """
        colours = [0, *[1] * self.cranks, *[2] * (self.links - self.cranks)]
        return canonical_form(colours, {(min(i, j), max(i, j)): "RP".index(kind) for i, j, kind in self.joints})

    @cached_property
    def directions(self) -> tuple[int, ...]:
        """For each link, the lowest-numbered link whose direction relative to it is constant.

        The two links are connected only by prismatic pairs, or are the same link.
        """
        return _find_first_joined_links(self.links, [(i, j) for i, j, kind in self.joints if kind == "P"])


def enumerate_schemes(links: int, mobility: int = 1, types: Sequence[str] = tuple(GROUP_TYPES)) -> tuple[Scheme, ...]:
    """Enumerate all admissible schemes, sorted by the types of their groups.

    Args:
        links: number of moving links.
        mobility: number of driving cranks.
        types: names of the group types to use.

    Raises:
        TooManySchemes: there are more than MOST_SCHEMES schemes.
        ValueError: the number of links or cranks is out of range.
    """
    if not (mobility <= links <= MOST_LINKS_OF_SCHEME and 1 <= mobility <= MOST_CRANKS):
        raise ValueError(f"1 to {MOST_CRANKS} cranks and at most {MOST_LINKS_OF_SCHEME} moving links")
    order = {GROUP_TYPES[name].name: k for k, name in enumerate(types)}
    levels: dict[int, dict[GraphForm, Scheme]] = {mobility: {(start := Scheme(mobility)).form: start}}
    for count in range(mobility, links):
        for scheme in levels.get(count, {}).values():
            for name in order:
                kind = GROUP_TYPES[name]
                if count + kind.links > links:
                    continue
                level = levels.setdefault(count + kind.links, {})
                for grown in attach_group(scheme, kind):
                    level.setdefault(grown.form, grown)
                    if len(level) > MOST_SCHEMES:
                        raise TooManySchemes
    schemes = [s for s in levels.get(links, {}).values() if s.groups and _is_connected_without_frame(s)]
    return tuple(sorted(schemes, key=lambda s: [order[group.type.name] for group in s.groups]))


def attach_group(scheme: Scheme, kind: GroupType) -> Iterator[Scheme]:
    """Yield every scheme that results from attaching a group of this type; some of them may be equal."""
    first = scheme.links + 1
    new_links = tuple(range(first, first + kind.links))
    inner = tuple((new_links[a], new_links[b], pair) for a, b, pair in kind.inner)
    for held in product(range(first - 1, -1, -1), repeat=len(kind.outer)):
        if len(set(held)) == 1:
            continue
        outer = tuple((support, new_links[end], pair) for support, (end, pair) in zip(held, kind.outer, strict=True))
        grown = Scheme(scheme.cranks, (*scheme.groups, PlacedGroup(kind, new_links, inner, outer)))
        if all(grown.directions[i] != grown.directions[j] for i, j, pair in (*outer, *inner) if pair == "R"):
            yield grown


def _is_connected_without_frame(scheme: Scheme) -> bool:
    """Return True if all moving links, including the cranks, stay connected when the frame is removed."""
    return len(set(_find_first_joined_links(scheme.links, [(i, j) for i, j, _ in scheme.joints if i and j])[1:])) == 1


def _find_first_joined_links(links: int, pairs: Iterable[tuple[int, int]]) -> tuple[int, ...]:
    """Return, for each link 0 to `links`, the lowest-numbered link to which it is connected by `pairs` (or itself)."""
    first = list(range(links + 1))
    for i, j in pairs:
        low, high = sorted((first[i], first[j]))
        first = [low if k == high else k for k in first]
    return tuple(first)
