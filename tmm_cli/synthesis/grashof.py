"""Which links turn fully: four-bar (Grashof), crank-slider, slotted lever. Lengths are floats or arrays.

A joint of a four-bar between links x and y, with z and w the others, turns fully when the distance that z and w must
bridge stays within their reach: x + y <= z + w and |x - y| >= |z - w|. The types are those of C. R. Barker, A complete
classification of planar four-bar linkages, Mechanism and Machine Theory 20 (1985): with the shortest link s and the
longest l, s + l less than the sum of the others (Grashof, by the shortest link), more (triple rockers, by the
longest), or the same (change points).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.record import SMALLEST, Demand, Infeasible, Outcome, Shown, Value

PARAMETERS: Final[dict[str, str]] = {}
W: Final = "synthesis_grashof"
SAME = 1e-12  # of the sum of the links: sums that differ by less are equal (0.1 + 0.2 is not 0.3)
ROLES: Final = ("frame", "input", "coupler", "output")
# in the order frame, input, coupler, output: of the shortest link, of the longest, of the shortest at a change point
GRASHOF: Final = ("GCCC", "GCRR", "GRCR", "GRRC")
TRIPLE: Final = ("RRR1", "RRR2", "RRR3", "RRR4")
CHANGE: Final = ("SCCC", "SCRR", "SRCR", "SRRC")
TYPES: Final = (*GRASHOF, *TRIPLE, *CHANGE, "S2X", "S3X")
SLIDERS: Final = ("crank", "rod", "none", "change")
LEVERS: Final = ("swings", "turns", "none", "change")


@dataclass(frozen=True)
class FourBar:
    """Lengths (m) of links 1 to 4 as they are joined round; frame, driver: numbers (1 to 4) of two adjacent ones."""

    l1: Any
    l2: Any
    l3: Any
    l4: Any
    frame: int = 4
    driver: int = 1

    @property
    def ordered(self) -> tuple[Any, Any, Any, Any]:
        """Frame, input, coupler, output."""
        links = (self.l1, self.l2, self.l3, self.l4)
        step = 1 if (self.driver - self.frame) % 4 == 1 else -1
        g, a, b, c = (links[(self.frame - 1 + step * k) % 4] for k in range(4))
        return g, a, b, c


@dataclass(frozen=True)
class CrankSlider:
    """Crank r, rod l, offset e (m)."""

    r: Any
    l: Any  # noqa: E741  its name in every course
    e: Any = 0.0


@dataclass(frozen=True)
class SlottedLever:
    """Crank OA, frame OC, and the distance e of the slot's line from C (m)."""

    OA: Any
    OC: Any
    e: Any = 0.0


@dataclass(frozen=True)
class FourBarFound:
    """kind: number in TYPES, -1 where the links do not close; excess: (p + q) - (s + l), m: positive for Grashof.

    joints: whether those of frame-input, input-coupler, coupler-output, output-frame turn fully; turns: whether input,
    coupler, output turn fully against the frame (at change points: whether they can). Arrays, joints and turns with a
    last axis more.
    """

    kind: Any
    excess: Any
    joints: Any
    turns: Any


@dataclass(frozen=True)
class Condition:
    """kind: number in SLIDERS or LEVERS; margin (m): by how much the crank turns fully (negative: does not)."""

    kind: Any
    margin: Any


def four_bar(asked: FourBar) -> FourBarFound:
    """Type and turning links of four-bars."""
    links = np.stack(np.broadcast_arrays(*asked.ordered), axis=-1)
    total = links.sum(-1)
    same = SAME * total
    order = np.argsort(links, axis=-1, kind="stable")
    ranked = np.take_along_axis(links, order, axis=-1)
    excess = (ranked[..., 2] - ranked[..., 3]) + (ranked[..., 1] - ranked[..., 0])
    shortest, longest = order[..., 0], order[..., 3]
    equal = np.abs(np.diff(ranked, axis=-1)) <= same[..., None]
    change = np.abs(excess) <= same
    pairs = equal[..., 0] & equal[..., 2]  # at a change point one pair of equal links brings the other
    kind = np.where(excess > 0, shortest, 4 + longest)
    kind = np.where(change, np.where(pairs, np.where(equal[..., 1], 13, 12), 8 + shortest), kind)
    kind = np.where(2 * ranked[..., 3] >= total - same, -1, kind)
    joints = []
    for k in range(4):
        x, y, z, w = (links[..., (k + i) % 4] for i in range(4))
        joints.append((x + y <= z + w + same) & (np.abs(x - y) >= np.abs(z - w) - same) & (kind >= 0))
    a, b, c, d = joints
    # full turns in both joints on the way from the frame to the coupler take each other away
    return FourBarFound(kind, excess, np.stack(joints, -1), np.stack([a, (a ^ b) | (c ^ d), d], -1))


def crank_slider(asked: CrankSlider) -> Condition:
    """The crank turns fully when l >= r + |e|, with r = l and e = 0 or l = r + |e| a change point."""
    r, rod, e = np.broadcast_arrays(asked.r, asked.l, np.abs(asked.e))
    same = SAME * (r + rod + e)
    margin = rod - (r + e)
    other = r - (rod + e)
    kind = np.where(margin > same, 0, np.where(other > same, 1, 2))
    return Condition(np.where((np.abs(margin) <= same) | (np.abs(other) <= same), 3, kind), margin)


def slotted_lever(asked: SlottedLever) -> Condition:
    """The slotted link swings when OC > OA + |e|, turns when OA > OC + |e|; else the crank does not turn."""
    crank, frame, e = np.broadcast_arrays(asked.OA, asked.OC, np.abs(asked.e))
    same = SAME * (crank + frame + e)
    margin = np.abs(frame - crank) - e
    kind = np.where(margin > same, np.where(frame > crank, 0, 1), 2)
    return Condition(np.where(np.abs(margin) <= same, 3, kind), margin)


def solve(asked: FourBar | CrankSlider | SlottedLever) -> Outcome:
    """The answer for one file. Raises Infeasible for what is no mechanism."""
    lengths = {name: value for name, value in vars(asked).items() if name not in ("frame", "driver")}
    for name, value in lengths.items():
        if name != "e" and not value > 0:
            raise Infeasible(name, f"{W}.positive", *_closing(asked, lengths, name))
    given = tuple(Value(name, value, "length", f"{W}.{name}") for name, value in lengths.items())
    if isinstance(asked, FourBar):
        return _four_bar(asked, given)
    slider = isinstance(asked, CrankSlider)
    found = crank_slider(asked) if isinstance(asked, CrankSlider) else slotted_lever(asked)
    name = (SLIDERS if slider else LEVERS)[int(found.kind)]
    which = "slider" if slider else "lever"
    crank = name == "crank" if slider else name in ("swings", "turns")
    values = (
        Value("", None, "word", f"{W}.kind", f"{W}.{which}_{name}"),
        Value("", found.margin, "length", f"{W}.{which}_margin"),
    )
    return Outcome(given, values, f"{W}.source_{which}", () if name == "change" else (_turning(crank),))


def _closing(
    asked: FourBar | CrankSlider | SlottedLever, lengths: dict[str, Any], name: str
) -> tuple[str, dict[str, Shown]]:
    """Words of the least length of a link that is none: with it the links of a four-bar close."""
    rest = sorted(max(0.0, float(value)) for other, value in lengths.items() if other != name)
    gap = rest[-1] - sum(rest[:-1]) if isinstance(asked, FourBar) else 0.0
    open_end = gap >= SMALLEST  # where the links would lie in one line
    return f"{W}.at_least", {"least": (max(gap, SMALLEST), "length", *(("above",) if open_end else ()))}


def _four_bar(asked: FourBar, given: tuple[Value, ...]) -> Outcome:
    found = four_bar(asked)
    links = {f"l{number}": getattr(asked, f"l{number}") for number in range(1, 5)}
    longest = max(links, key=lambda name: float(links[name]))
    if found.kind < 0:
        rest = float(sum(links.values()) - links[longest])
        raise Infeasible(
            longest, f"{W}.open", f"{W}.closing", {"most": (rest, "length", "below"), "link": (longest, "word")}
        )
    change = int(found.kind) >= 8
    given += tuple(Value(name, None, "word", f"{W}.{name}", f"l{getattr(asked, name)}") for name in ("frame", "driver"))
    values = [
        Value("", None, "word", f"{W}.kind", f"{W}.{TYPES[int(found.kind)]}"),
        Value("", found.excess, "length", f"{W}.excess"),
    ]
    for role, turns in zip(ROLES[1:], found.turns, strict=True):
        word = f"{W}.may" if change and turns else f"{W}.{'turns' if turns else 'rocks'}"
        values.append(Value("", None, "word", f"{W}.{role}", word))
    return Outcome(given, tuple(values), f"{W}.source", () if change else (_turning(bool(found.turns[0])),))


def _turning(turns: bool) -> Demand:
    return Demand(f"{W}.crank_turns", float(turns), "number", crank_turns, asked=False)
