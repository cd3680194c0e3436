"""Letters of a construction: joints as the user's linkage calls them, parameters as the file does."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.synthesis.construction import LETTERS, Chain, Construction

FREE = "MNKQSTUVWXYZ"  # letters of centres of circles
BARS = {"l1": "AB", "l2": "BC", "l3": "DC", "l4": "AD"}
NEAR = 1e-6  # relative: a link as long as that of the construction


def rename(
    drawn: Construction, linkage: Linkage | None, names: Mapping[str, str]
) -> tuple[Construction, Mapping[str, str]]:
    """The construction in the user's letters, and these letters by those of its words."""
    own = {letter: letter for letter in LETTERS.get(drawn.chain, "")}
    if linkage is not None:
        own |= joints(linkage, drawn.chain, drawn)
    taken = set(own.values()) | {spot.name[:1] for spot in drawn.spots if spot.name[:1] not in own}
    centre = next(letter for letter in FREE if letter not in taken)
    parameters = {name: shown for name, shown in names.items() if shown != name}
    if set(parameters) & set(BARS) and drawn.chain == "four-bar":  # the others are called likewise
        parameters = {bar: "".join(own[c] for c in ends) for bar, ends in BARS.items()} | parameters

    def point(text: str) -> str:
        letter, number = text[:1], text[1:]
        shown = own.get(letter, letter)
        return f"{shown}({number})" if number[:1].isdigit() and shown[-1:].isdigit() else shown + number

    def line(text: str) -> str:
        return re.sub(r"[A-Za-z]+\d*", lambda found: quantity(found[0]), text)

    def quantity(word: str) -> str:
        if word in parameters:
            return parameters[word]
        return "".join(own[c] for c in word) if all(c in own for c in word) else word

    named = replace(
        drawn,
        spots=tuple(replace(s, name=point(s.name)) for s in drawn.spots),
        segments=tuple(replace(s, name=line(s.name)) for s in drawn.segments),
        sizes=tuple(replace(s, name=line(s.name)) for s in drawn.sizes),
        centres=tuple(replace(c, name=centre) for c in drawn.centres),
        values=tuple((line(name), value, kind) for name, value, kind in drawn.values),
    )
    return named, {**own, "M": centre}


def joints(linkage: Linkage, chain: Chain, drawn: Construction) -> dict[str, str]:
    """Names of joints along the chain from the driver; none where the linkage is another one, or drives elsewhere."""
    try:
        found = _walk(linkage, chain)
    except LookupError:
        return {}
    letters = LETTERS[chain]
    crank = linkage.links[linkage.driver.link].points
    own = abs(crank[found[0]] - crank[found[1]])
    at = {spot.name: spot.at for spot in drawn.spots}
    wanted = abs(at[f"{letters[1]}1"] - at[letters[0]])
    if len(set(found)) < len(found) or abs(own - wanted) > NEAR * wanted:
        return {}
    return dict(zip(letters, found, strict=True))


def _walk(linkage: Linkage, chain: Chain) -> list[str]:
    """Points from joint to joint. Raises LookupError."""
    driver = linkage.driver
    if not chain or driver.kind != "turn":
        raise LookupError(chain)
    pin, link = _next(linkage, driver.link, driver.joint)
    found = [driver.joint, pin]
    if chain in ("four-bar", "crank-slider"):
        joint, link = _next(linkage, link, pin)
        found.append(joint)
        if chain == "four-bar":
            found.append(_next(linkage, link, joint, frame=True)[0])
        return found
    ways = [s for s in linkage.slides if link in (s.carrier, s.runner) and FRAME not in (s.carrier, s.runner)]
    if len(ways) != 1:
        raise LookupError(link)
    lever = ways[0].carrier if ways[0].runner == link else ways[0].runner
    pivot = _next(linkage, lever, "", frame=True)[0]
    if chain == "slotted-lever":
        ends = [name for name in linkage.links[lever].points if name not in (pivot, pin)]
        if len(ends) != 1:
            raise LookupError(lever)
        return [*found, pivot, ends[0]]
    joint, rod = _next(linkage, lever, pivot)
    return [*found, pivot, joint, _next(linkage, rod, joint)[0]]


def _next(linkage: Linkage, link: str, other: str, *, frame: bool = False) -> tuple[str, str]:
    """The one hinge of a link besides another one, with the frame or with a moving link, and that link."""
    found = [
        (h.point, next((n for n in h.links if n != link), FRAME))
        for h in linkage.hinges
        if link in h.links and h.point != other and (FRAME in h.links) == frame
    ]
    if len(found) != 1:
        raise LookupError(link)
    return found[0]
