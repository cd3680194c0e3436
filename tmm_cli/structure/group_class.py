"""Class of an Assur group after I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 3.

A group of two links is of class II; otherwise the class is the number of sides of its largest closed contour of inner
pairs, or of the inner pairs of its richest link when it has no contour.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

from tmm_cli.linkage import Driver

if TYPE_CHECKING:
    from tmm_cli.structure.assur import Pair


def group_class(
    bodies: Iterable[tuple[str, ...]], inner: Iterable[Pair], outer: Iterable[Pair], drivers: Iterable[Driver],
    as_higher: Collection[str] = (),
) -> int:  # fmt: skip
    """Class of a group after replacing: a higher pair by a link with two hinges, a driven pair by one rigid link.

    Links of one body are rigid to one another; as_higher: names of lower pairs that count as higher ones.
    """
    one = {name: links[0] for links in bodies for name in links}
    for driver in drivers:
        if driver.base in one:
            keep, gone = one[driver.base], one[driver.link]
            one = {name: keep if as_one == gone else as_one for name, as_one in one.items()}
    replaced = list(dict.fromkeys(one.values()))
    joints: list[tuple[str, str]] = []
    for pair in (*inner, *outer):
        ends = [one[link] for link in (pair.i, pair.j) if link in one]
        if not pair.lower or pair.name in as_higher:
            replaced.append(f"tooth {pair.name}")
            joints += [(end, replaced[-1]) for end in ends]
        elif len(set(ends)) == 2:
            joints.append((ends[0], ends[1]))
    if len(replaced) <= 2:
        return 2
    return max(3, _largest_contour(replaced, joints), *(sum(body in joint for joint in joints) for body in replaced))


def _largest_contour(links: list[str], inner: list[tuple[str, str]]) -> int:
    """Sides of the largest closed contour of inner pairs (groups are small: a plain search of all simple cycles)."""
    joined: dict[str, list[str]] = {link: [] for link in links}
    for i, j in inner:
        joined[i].append(j)
        joined[j].append(i)
    best, budget = 0, 20_000
    stack: list[tuple[str, tuple[str, ...]]] = [(link, (link,)) for link in links]
    while stack and budget:
        budget -= 1
        link, path = stack.pop()
        for after in joined[link]:
            if after == path[0] and len(path) > 2:
                best = max(best, len(path))
            elif after not in path and links.index(after) > links.index(path[0]):
                stack.append((after, (*path, after)))
    return best
