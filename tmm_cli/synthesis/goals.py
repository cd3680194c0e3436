"""What a mechanism can be optimised for or held to: quantities over its cycle, for many variants at once.

A quantity is written on the tape with the linkage (`outputs`), and then read off coarsely, from places all round the
cycle, or finely, from windows of places about its peaks and zeros (`peaks`), where it is exact to some 1e-12.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import combinations
from typing import Any, Final, Literal

import numpy as np

from tmm_cli.forces.plan import Reactions
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Motion
from tmm_cli.pressure import followers, sides
from tmm_cli.strokes import output_link, output_place, output_slope
from tmm_cli.synthesis.peaks import peak, zero
from tmm_cli.synthesis.readings import (
    apart_squared,
    ends_of,
    forward_share,
    longest,
    nearest,
    peaks_of,
    ratio_of,
    sums,
    swept,
)
from tmm_cli.vectors import Real

PEAKS: Final = ("pressure", "moment", "reaction", "margin", "crank", "box")
STROKES: Final = ("stroke", "k", "speed")
PLACES: Final = ("path", "law")
PLAIN: Final = ("length", "mass")
ALL: Final = (*PLAIN, *PEAKS, *STROKES, *PLACES)
FORCES: Final = ("moment", "reaction")
LEAST: Final = ("margin", "crank")  # whose least value counts
SIDES: Final = (("x", 1), ("x", -1), ("y", 1), ("y", -1))  # of the box: right, left, top, bottom
MOST_PEAKS = 4
FOUR = 4  # ends of strokes in a cycle: of more the highest and the lowest may belong to two strokes
OF_A_SIDE = 3  # points that may come to bear on a side of the box
SIDE = "side"  # outputs whose sign tells on which side of a dead position a group is that has one assembly only
CLOSELY = "closely."  # outputs that are wanted for windows alone

Read = Callable[[str], Real]  # an output by name, (variants, places)


@dataclass(frozen=True)
class Over:
    """What a quantity is read over: closed when the driver turns on and on; cycle: of the driver (rad).

    swings: the output's run is an angle. rough: forces may jump, so that there is nothing smooth about their peaks.
    counts: of points in a box, of distances on each link whose length counts.
    """

    swings: bool
    closed: bool = True
    cycle: float = 2 * np.pi
    rough: bool = False
    counts: tuple[int, ...] = ()


@dataclass(frozen=True)
class Goal:
    """A quantity of ALL. name: of the pair, the point or the link; links: those whose lengths count.

    places: of the driver (rad), with the wanted values there; a path without places is to pass through the points in
    any of its positions. norm: how deviations are counted.
    """

    of: str
    name: str = ""
    links: tuple[str, ...] = ()
    places: tuple[float, ...] = ()
    wanted: tuple[Any, ...] = ()
    norm: Literal["least squares", "largest"] = "least squares"
    relative: bool = False

    def kind(self, linkage: Linkage, groups: Any) -> str:
        """Its dimension by name."""
        slides, turns = self.slides(linkage, groups), linkage.driver.kind == "turn"
        own = {
            "mass": "mass", "pressure": "angle", "moment": "moment of force" if turns else "force", "reaction": "force",
            "margin": "number", "crank": "number", "k": "number", "speed": "speed",
            "stroke": "length" if slides else "angle", "law": "length" if slides else "angle",
        }  # fmt: skip
        return own.get(self.of, "length")

    def slides(self, linkage: Linkage, groups: Any) -> bool:
        """Whether the output slides."""
        link = self.name if self.of == "law" else output_link(linkage, groups)
        return link is not None and linkage.slides_on_frame(link)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        """What is to be written down for it."""
        linkage = motion.linkage
        groups = tuple(kernel.group for kernel in motion.kernels)
        output = output_link(linkage, groups)
        if self.of == "length":
            spans = [spans_of(linkage, name) for name in self.links or tuple(linkage.links)]
            closely = {f"{CLOSELY}{n}.{k}": span for n, own in enumerate(spans) for k, span in enumerate(own)}
            return closely | {"value": sum(reduce(np.maximum, own, 0.0) for own in spans)}
        if self.of == "mass":
            return {"value": sum(linkage.links[name].mass for name in linkage.moving)}
        if self.of == "pressure":
            leads = [(n, lead) for n, group in enumerate(groups) for lead in followers(group)]
            leads = [x for x in leads if x[1][0] == output] or leads
            tangents = []
            for n, lead in leads:
                sine, cosine = sides(motion, motion.kernels[n], motion.placements[n], lead)
                tangents.append(sine / cosine)
            return {"y0": reduce(np.maximum, tangents)}
        if self.of == "moment":
            assert reactions is not None
            return {"y0": np.abs(reactions.balances[0].generalized)}
        if self.of == "reaction":
            assert reactions is not None
            return {"y0": reduce(np.maximum, [np.abs(r.force) for r in reactions.all if r.pair.name == self.name])}
        if self.of == "margin":
            return {"y0": -reduce(np.minimum, [at.margin for at in motion.placements])}
        if self.of == "crank":
            both = list(zip(motion.kernels, motion.placements, strict=True))
            single = [at.det for kernel, at in both if getattr(kernel, "assemblies", 0) == 1]
            return {f"{SIDE}{k}": det for k, det in enumerate(single)} | {
                "y0": reduce(np.maximum, [at.gap / kernel.size for kernel, at in both])
            }
        if self.of == "box":
            spots = [motion.spot(p) for p in points_of(linkage)]
            x, y = [p.real for p in spots], [p.imag for p in spots]
            closely = {f"{CLOSELY}{axis}{k}": v for axis, vs in (("x", x), ("y", y)) for k, v in enumerate(vs)}
            return closely | {
                "y0": reduce(np.maximum, x), "y1": -reduce(np.minimum, x),
                "y2": reduce(np.maximum, y), "y3": -reduce(np.minimum, y),
            }  # fmt: skip
        if self.of in STROKES:
            assert output is not None
            found = {"slope": output_slope(motion, output)}
            if self.of != "k":
                found["run"] = output_place(motion, output)
            if self.of == "speed":
                found["rate"] = linkage.driver.rate + 0.0 * found["slope"]
                found["gain"] = linkage.driver.acceleration + 0.0 * found["slope"]
            return found
        if self.of == "law":
            return {"run": output_place(motion, self.name)}
        p = motion.spot(self.name)
        return {"px": p.real, "py": p.imag}

    # reading it off

    def coarse(self, read: Read, over: Over) -> Real:
        """From places all over the way (for `places`: from those), (variants,)."""
        if self.of in PLAIN:
            return read("value")[:, 0]
        if self.of in PEAKS:
            return self.told(sum(np.max(read(name), axis=1) for name in self.curves))
        if self.of == "k":
            return ratio_of(forward_share(read("slope")))
        if self.of in STROKES:
            run = read("run")
            travel = np.max(run, axis=1) - np.min(run, axis=1)
            if over.swings and np.any(past := travel > np.pi):  # angles are within -pi..pi
                slope = read("slope")[past]
                turns = np.all(slope > 0, axis=1) | np.all(slope < 0, axis=1)  # such an output has no strokes
                travel[past] = np.where(turns & over.closed, np.nan, swept(run[past]))
            if self.of == "stroke":
                more = over.closed and np.any(ends_of(read("slope")) > FOUR)
                return longest(run, travel, turns=over.swings) if more else np.asarray(travel)
            found: Real = np.sum(np.abs(run - np.roll(run, 1, axis=1)), axis=1) * _mean_rate(read, over) / over.cycle
            return found
        return self.counted(self.deviations(read, over))

    @property
    def curves(self) -> tuple[str, ...]:
        return ("y0", "y1", "y2", "y3") if self.of == "box" else ("y0",)

    def told(self, y: Any) -> Real:
        """The quantity from the peak of its curve."""
        found: Real = np.arctan(y) if self.of == "pressure" else -y if self.of in LEAST else y
        return found

    def deviations(self, read: Read, over: Over) -> Real:
        """From what is wanted at each place, or of the path from each point: (variants, wanted), m or rad."""
        if self.of == "law":
            off = read("run") - np.array(self.wanted)
            if self.relative:
                off = off - off[:, :1]
            turned: Real = np.angle(np.exp(1j * off)) if over.swings else off
            return turned
        x, y = read("px"), read("py")
        if self.places:
            apart: Real = np.hypot(x - np.real(self.wanted), y - np.imag(self.wanted))
            return apart
        return nearest(x, y, np.array(self.wanted), closed=over.closed)

    def counted(self, off: Real) -> Real:
        """Root mean square, or the largest."""
        if self.norm == "largest":
            off = np.max(np.abs(off), axis=1, keepdims=True)
        found: Real = np.sqrt(np.mean(off * off, axis=1))
        return found

    # finely

    def windows(self, read: Read, over: Over) -> list[tuple[str, int]]:
        """Curves and places about which to look closely, from a scan of one variant over the way.

        A curve of the box is its side and a point, whose own path is smooth; that of a run the angle there, followed.
        """
        if self.of == "box":
            found = []
            for side, (axis, sign) in enumerate(SIDES):
                ys = {k: sign * read(f"{CLOSELY}{axis}{k}")[0] for k in range(sum(over.counts))}
                tops = [(y[at], k, at) for k, y in ys.items() for at in peaks_of(y, MOST_PEAKS, over.closed)]
                tops.sort(reverse=True)
                found += [(f"{side}{axis}{k}", at) for _, k, at in tops[:OF_A_SIDE]]
            return found
        if self.of in PEAKS:
            return [("y0", k) for k in peaks_of(read("y0")[0], MOST_PEAKS, over.closed)]
        if self.of in STROKES:
            slope = read("slope")[0]
            moves = np.flatnonzero(slope)  # in a dwell it is exactly zero
            after = np.roll(moves, -1) if over.closed else np.append(moves[1:], moves[-1:])
            turns = [int(k) for k in moves[slope[moves] * slope[after] < 0]]
            turns = turns if over.closed else [0, *turns, len(slope) - 1]
            if self.of == "k" or not over.swings:
                return [("0", k) for k in turns]
            followed = np.unwrap(read("run")[0])
            return [(f"{followed[k]}", k) for k in turns]
        if self.of == "path" and not self.places:
            p = read("px")[0] + 1j * read("py")[0]
            return [(f"{n}", int(np.argmin(np.abs(p - w)))) for n, w in enumerate(self.wanted)]
        return []

    def fine(self, parts: list[tuple[str, float, Read]], exact: Read, over: Over, step: float) -> Real:
        """Pieces of the quantity, (variants, pieces); the largest counts (of LEAST: the least).

        parts: curve, first place and outputs of every window; exact: outputs at the goal's own places; step: of places
        in windows. Places are shares of the way.
        """
        if self.of == "length":
            return sums([[exact(f"{CLOSELY}{n}.{k}")[:, 0] for k in range(m)] for n, m in enumerate(over.counts)])
        if self.of in PLAIN:
            return exact("value")[:, :1]
        if self.of == "box":
            sides: list[list[Real]] = [[], [], [], []]
            for curve, _, read in parts:
                side = int(curve[0])
                sides[side].append(peak(SIDES[side][1] * read(CLOSELY + curve[1:])))
            return sums(sides)
        if self.of in PEAKS:
            ys = [np.arctan(read(c)) if self.of == "pressure" else read(c) for c, _, read in parts]
            rough = over.rough and self.of in FORCES
            found: Real = np.stack([np.max(y, axis=1) if rough else peak(y) for y in ys], axis=1)
            return -found if self.of in LEAST else found
        if self.of in STROKES:
            if not parts:
                return exact("slope")[:, :1] * np.nan  # it has no strokes
            if self.of != "k":
                runs = []
                for angle, _, read in parts:
                    run = read("run")
                    if over.swings:
                        run = run - 2 * np.pi * np.round((run - float(angle)) / (2 * np.pi))
                    runs.append(run)
                if self.of == "stroke" and not (over.closed and len(parts) > FOUR):
                    tops, lows = ([peak(side * run) for run in runs] for side in (1, -1))
                    travel: Real = np.max(tops, axis=0) + np.max(lows, axis=0)
                    return travel[:, None]
                ends = [
                    np.where(run[:, 0] + run[:, -1] < 2 * np.mean(run, axis=1), peak(run), -peak(-run)) for run in runs
                ]
                strokes = np.abs(np.diff([*ends, ends[0]], axis=0))
                if self.of == "stroke":
                    return strokes.T
                whole = np.sum(strokes, axis=0)
                speed: Real = whole * _mean_rate(parts[0][2], over) / over.cycle
                return speed[:, None]
            forward: Any = 0.0
            for _, start, read in parts:
                slope = read("slope")
                forward = forward + np.where(slope[:, 0] > 0, 1, -1) * (start + step * zero(slope))
            return ratio_of(np.mod(forward, 1.0))[:, None]
        if self.of == "path" and not self.places:
            near = [-peak(-apart_squared(read("px"), read("py"), self.wanted[int(n)])) for n, _, read in parts]
            off = np.sqrt(np.maximum(np.stack(near, axis=1), 0))
        else:
            off = self.deviations(exact, over)
        return np.hstack([off, -off]) if self.norm == "largest" else self.counted(off)[:, None]


def _mean_rate(read: Read, over: Over) -> Real:
    """The crank's mean speed in the first cycle from position 0 on: half the sum of those at its ends, (variants,)."""
    rate, gain = (read(name)[:, 0] for name in ("rate", "gain"))
    found: Real = (rate + np.sqrt(rate * rate + 2 * gain * over.cycle)) / 2
    return found


def points_of(linkage: Linkage) -> list[str]:
    """Points of moving links, those on the frame first."""
    fixed = linkage.links[FRAME].points
    points = {p for name in linkage.moving for p in linkage.links[name].points}
    return sorted(points, key=lambda p: (p not in fixed, p))


def spans_of(linkage: Linkage, link: str) -> list[Any]:
    """Distances of a link's points, of the frame those of its hinges, m; the largest is its length."""
    points = linkage.links[link].points
    names = [n for n in points if link != FRAME or any(n == h.point and FRAME in h.links for h in linkage.hinges)]
    return [np.abs(points[a] - points[b]) for a, b in combinations(names, 2)]
