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
    driver, letters = linkage.driver, LETTERS.get(chain, "")
    if not letters or driver.kind != "turn":
        return {}
    link, found = driver.link, [driver.joint]
    for __ in linkage.links:
        if len(found) == len(letters):
            break
        hinged = {h.point: h.links for h in linkage.hinges if link in h.links and h.point not in found}
        ends = hinged or {p: (FRAME, link) for p in linkage.links[link].points if p not in found}
        pivots = [p for p in hinged if FRAME in hinged[p]]
        wanted = pivots or list(ends)
        across = {s.carrier if s.runner == link else s.runner for s in linkage.slides if link in (s.carrier, s.runner)}
        if len(wanted) == 1:
            found += wanted
            link = link if pivots else next((n for n in ends[wanted[0]] if n != link), FRAME)
        elif not wanted and len(across) == 1:  # a stone: the chain goes on along its lever
            (link,) = across
        else:
            return {}
    if len(found) < len(letters):
        return {}
    at = {spot.name: spot.at for spot in drawn.spots}
    crank = linkage.links[driver.link].points
    own, wished = abs(crank[found[0]] - crank[found[1]]), abs(at[f"{letters[1]}1"] - at[letters[0]])
    return dict(zip(letters, found, strict=True)) if abs(own - wished) <= NEAR * wished else {}
