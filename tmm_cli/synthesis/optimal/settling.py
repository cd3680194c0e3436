"""Parameters that a motion rests on linearly, as the place of a frame or of a coupler's point, found by themselves.

With all others fixed they are a problem of linear least squares, which has one solution (G. Golub, V. Pereyra, SIAM
Journal on Numerical Analysis 10 (1973)). A path without given places takes for each wanted point the nearest of its
places, and then others, in turn (P. Besl, N. McKay, IEEE PAMI 14 (1992)).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_cli.synthesis.optimal.candidates import LOST, Candidates, reader
from tmm_cli.synthesis.optimal.least_squares import Rows, step_of
from tmm_cli.synthesis.optimal.quantities.deviation import Deviation, corners
from tmm_cli.vectors import Real

LINEAR = 1e-9  # of the motion: what second differences of something linear may be
SHOWN, DRAWN = 3, 200  # candidates that show it, of so many
TURNS = 12  # of taking nearest places anew
DAMPING = 1e-9  # keeps what is not determined where it was
BLOCK = 250  # candidates at once


class Settling:
    """Called with candidates (variants, n) in 0..1, that can be assembled; gives better ones."""

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        assert isinstance(candidates.task.objective, Deviation)
        self.objective = candidates.task.objective
        self.linear = self._linear()

    def __call__(self, x: Real) -> Real:
        if not self.linear or not len(x):
            return x
        with np.errstate(all="ignore"):
            return np.concatenate([self._settled(x[at : at + BLOCK]) for at in range(0, len(x), BLOCK)])

    def _settled(self, x: Real) -> Real:
        ends = np.repeat(x[None], 1 + len(self.linear), axis=0)
        ends[:, :, self.linear] = 0
        ends[np.arange(1, len(ends)), :, self.linear] = 1
        curves = self._curve(ends.reshape(-1, x.shape[1])).reshape(len(ends), len(x), -1)
        first, slopes = curves[0], np.moveaxis(curves[1:] - curves[0], 0, -1)
        wanted, found = np.array(self.objective.wanted), x[:, self.linear]
        for __ in range(1 if self.objective.places else TURNS):
            off, own = first + np.einsum("vpk,vk->vp", slopes, found), slopes
            if not self.objective.places:
                near = corners(off.real.copy(), off.imag.copy(), wanted).T
                off = np.take_along_axis(off, near, axis=1)
                own = np.take_along_axis(slopes, near[..., None], axis=1)
            rows = Rows(_real(off - wanted), np.zeros((len(x), 0)))
            step = step_of(rows, Rows(_real(own), np.zeros((len(x), 0, len(self.linear)))), found, DAMPING)
            found = np.clip(found + step, 0, 1)
        settled = x.copy()
        settled[:, self.linear] = found
        return settled

    def _curve(self, x: Real) -> Any:
        """What is compared with what is wanted, (variants, places)."""
        one = self.candidates
        found = one.coarse(one.numbers(x), one.places)
        return self.objective.curve(reader(found, 0, one.exact[0]))

    def _linear(self) -> list[int]:
        """Those whose changes add up, with one another and with themselves."""
        x = np.random.default_rng(0).random((DRAWN, len(self.candidates.low)))
        x = x[self.candidates.evaluate(x)[1] < LOST][:SHOWN]

        def adds(k: int, m: int) -> bool:
            ends = np.repeat(x[None], 4, axis=0)
            ends[:, :, [k, m]] = 0.25
            ends[1::2, :, k] += 0.25
            ends[2:, :, m] += 0.25
            curves = [self._curve(end) for end in ends]
            off = np.max(np.abs(curves[3] - curves[2] - curves[1] + curves[0]))
            return bool(off <= LINEAR * np.max(np.abs(curves)))

        found: list[int] = []
        with np.errstate(all="ignore"):
            for k in range(x.shape[1]):
                if len(x) and all(adds(k, m) for m in (*found, k)):
                    found.append(k)
        return found


def _real(rows: Any) -> Real:
    """Complex rows as two real ones each, (variants, rows, ...)."""
    return np.concatenate([rows.real, rows.imag], axis=1) if np.iscomplexobj(rows) else rows
