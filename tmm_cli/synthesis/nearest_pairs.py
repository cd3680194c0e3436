"""Why no four-bar passes some pairs of angles in order, and the nearest change with which one does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis import freudenstein
from tmm_cli.synthesis.freudenstein import Bars
from tmm_cli.synthesis.pairs import LONG, SCAN, Asked, chosen, quality, through
from tmm_cli.synthesis.record import Infeasible, Shown

W: Final = "synthesis_four_bar_by_angles"
STEP: Final = np.radians(0.25)  # by which the last output angle is changed for the nearest task,
WIDEST: Final = np.radians(60)  # and how far
FEW: Final = 60  # four-bars through two pairs that are compared then, at coarser steps
COARSE: Final = np.radians(1)
SHARE: Final = 0.02  # by which a second length is changed with two pairs, and
TIMES: Final = 100.0  # how far
LINKS: Final = 50.0  # the longest link over the shortest of a four-bar that is worth while
INWARDS: Final = 2e-6  # rad, or a share of a length, from where there is one first


def refuse_found(asked: Asked, found: list[Bars]) -> None:
    """None of what was found is any good: raises Infeasible, with the nearest last output angle or second length."""
    key: tuple[str | int, ...] = ("output",) if asked.function else ("pairs", len(asked.psi) - 1)
    defects = {quality(one, asked).defect for one in found}
    if found:
        words = "all_both" if len(defects) > 1 else "all_branch" if defects == {"branch"} else "all_locks"
    else:
        words = "endless" if _endless(asked) else "none"
    suffix = "" if found else "_alone"
    if len(asked.lengths) == 2:
        found_length = _nearest_length(asked)
        if found_length is not None:
            name, values = found_length
            side = "more" if values["length"][2] == "least" else "less"
            raise Infeasible(name, f"{W}.{words}", f"{W}.nearest_{side}{suffix}", values)
    last = len(asked.psi) - 1
    for which in (last, *range(0 if asked.function or len(asked.psi) < 3 else last)[::-1]):
        near = _nearest_angle(asked, which)
        if near is not None:
            told = {"psi": near[0], "links": (f"{LINKS:g}", "word"), "which": (str(which + 1), "word")}
            bound, of = "_long" if near[1] else "", "" if which == last else "_of"
            raise Infeasible((*key[:-1], which) if of else key, f"{W}.{words}", f"{W}.nearest{bound}{of}{suffix}", told)
    raise Infeasible(key, f"{W}.{words}", f"{W}.other{suffix}")


def _endless(asked: Asked) -> bool:
    """Whether four-bars pass the pairs whose links are infinitely long beside the frame."""
    if len(asked.phi) < 3:
        return False
    found = freudenstein.solutions([asked.phi], [asked.psi], asked.phi0, asked.psi0)
    lengths = np.stack([np.asarray(x, dtype=float) for x in (found.l1, found.l2, found.l3)])
    return bool(np.any(np.isfinite(lengths) & (lengths >= LONG)))


def _sound(asked: Asked, scan: int) -> tuple[bool, bool]:
    """Whether there is a four-bar without defects, and whether its links are of sensible length."""
    found = through(asked)
    at = chosen(asked, found)
    if not 0 <= at < len(found) or quality(found[at], asked).defect:
        return False, False
    links = [1.0, *(float(x) for x in (found[at].l1, found[at].l2, found[at].l3))]
    return True, max(links) <= LINKS * min(links)


def _edge(good: Callable[[float], bool], inside: float, outside: float) -> float:
    """Where what is good inside begins."""
    for _ in range(40):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(middle) else (inside, middle)
    return inside


def _nearest_angle(asked: Asked, which: int) -> tuple[Shown, bool] | None:
    """The nearest output angle of a pair (of a function: its end) with which there is a four-bar without defects, and
    whether the length of its links is what bounds it; None: there is none within 60 deg."""
    two = len(asked.phi) < 3
    scan, step = (FEW, COARSE) if two else (SCAN, STEP)

    def ends(change: float) -> Asked:
        if asked.function:
            function = replace(asked.function, psi=(asked.function.psi[0], asked.function.psi[1] + change))
            phi, psi = function.precision(len(asked.phi))
            return replace(asked, function=function, phi=tuple(phi), psi=tuple(psi))
        return replace(asked, psi=(*asked.psi[:which], asked.psi[which] + change, *asked.psi[which + 1 :]))

    def good(change: float) -> bool:
        return all(_sound(ends(change), scan))

    for size in step * np.arange(1, round(WIDEST / step) + 1):
        for change in (size, -size):
            if good(change):
                sign = float(np.sign(change))
                inside = _edge(good, change, change - sign * step)
                long = _sound(ends(inside - sign * 1e-7), scan)[0]
                last = asked.function.psi[1] if asked.function else asked.psi[which]
                end = float(last + inside + sign * INWARDS)
                return (end, "angle", "least" if sign > 0 else "most"), long
    return None


def _nearest_length(asked: Asked) -> tuple[str, dict[str, Shown]] | None:
    """With two pairs and two lengths: the nearest second one (m) for which there is a four-bar without defects."""
    name = list(asked.lengths)[-1]
    given = float(asked.lengths[name])

    def good(share: float) -> bool:
        changed = replace(asked, lengths=asked.lengths | {name: given * float(np.exp(share))})
        return all(_sound(changed, SCAN))

    for size in np.arange(SHARE, np.log(TIMES), SHARE):
        for change in (size, -size):
            if good(change):
                sign = float(np.sign(change))
                inside = _edge(good, change, change - sign * SHARE) + sign * INWARDS
                value: Any = given * float(np.exp(inside))
                side = "least" if sign > 0 else "most"
                return name, {"length": (value, "length", side), "name": (name, "word")}
    return None
