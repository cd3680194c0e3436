"""Least and largest values of quantities over the cycle, and the driver coordinates at which they occur."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.analysis.pipeline import Results, results_at
from tmm_cli.mechanics.analysis.selection import mass_centres, named_points
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real, to_float
from tmm_cli.mechanics.quantities import ANGLE, FORCE, LENGTH, MOMENT, Dimension

STEPS_PER_TURN = 720  # steps per revolution, or over the driver range
ROUNDS, PARTS = 5, 16  # refinements around each extreme, and subdivision of the step in each
FULL_TURN = 2 * np.pi - 1e-6  # rad: an angle that varies by more has no extremes


@dataclass(frozen=True)
class QuantityExtreme:
    """Least and largest value of a quantity (SI), and the driver coordinates at which they occur (rad or m)."""

    kind: str
    name: str
    dimension: Dimension
    low: float
    low_at: float
    high: float
    high_at: float


@dataclass(frozen=True)
class SampledQuantity:
    """Values of a quantity at driver coordinates, (positions,). `turns` is True if the values are angles."""

    kind: str
    name: str
    dimension: Dimension
    values: Real

    @property
    def turns(self) -> bool:
        return self.dimension == ANGLE


def with_extremes(results: Results) -> Results:
    """Add extremes to results: the largest forces if the results have forces, else the extreme positions.

    The extreme positions are those of all points, links and sliding blocks.
    """

    def sample(q: Real) -> list[SampledQuantity]:
        solved = results_at(results, q)
        assert solved.motion is not None
        return (
            _sample_motion(solved.motion)
            if solved.reactions is None
            else _sample_forces(solved.reactions, results.linkage)
        )

    q = results.closely(STEPS_PER_TURN * max(results.turns, 1) + 1)
    return replace(results, extremes=find_extremes(sample, q, cyclic=bool(results.turns)))


def _sample_motion(motion: Motion) -> list[SampledQuantity]:
    linkage, samples = motion.linkage, []
    for name in named_points(linkage):
        place = motion.named(name).x
        samples += [SampledQuantity("x", name, LENGTH, place.real), SampledQuantity("y", name, LENGTH, place.imag)]
    for name, (link, __) in mass_centres(linkage).items():
        place = motion.centre(link).x
        samples += [SampledQuantity("x", name, LENGTH, place.real), SampledQuantity("y", name, LENGTH, place.imag)]
    samples += [SampledQuantity("angle", link, ANGLE, motion.link(link).angle) for link in linkage.moving]
    samples += [SampledQuantity("s", slide.name, LENGTH, motion.slide(slide).run) for slide in linkage.slides]
    return samples


def _sample_forces(reactions: Reactions, linkage: Linkage) -> list[SampledQuantity]:
    samples = [SampledQuantity("R", r.pair.name, FORCE, np.abs(r.force)) for r in reactions.all]
    samples += [SampledQuantity("M", r.pair.name, MOMENT, r.couple) for r in reactions.all if r.couple is not None]
    samples += [
        SampledQuantity("R pin", f"{pin.point}, {pin.link}", FORCE, np.abs(pin.force))
        for pin in reactions.pins(linkage)
    ]
    for balance in reactions.balances:
        turns = balance.moment is not None
        dimension = MOMENT if turns else FORCE
        samples.append(
            SampledQuantity("M_b" if turns else "F_b", balance.driver.link, dimension, np.asarray(balance.generalized))
        )
    return samples


def find_extremes(
    sample: Callable[[Real], Sequence[SampledQuantity]], q: Real, *, cyclic: bool
) -> tuple[QuantityExtreme, ...]:
    """Find the least and the largest value of each quantity. Angles of links that rotate fully are left out.

    The extremes on a first grid of driver coordinates are refined on finer and finer grids around them.

    Args:
        sample: function that returns the quantities at driver coordinates.
        q: closely spaced driver coordinates, rad or m.
        cyclic: True if both ends of q are the same position.
    """
    courses = list(sample(q))
    rows, turning = _value_rows(courses, q), np.array([c.turns for c in courses])
    rows[turning] = _unwrap_rows(rows[turning])
    spread = np.array([np.ptp(row[np.isfinite(row)]) if np.isfinite(row).any() else 0.0 for row in rows])
    kept = (spread > 0) & ~(turning & (spread > FULL_TURN))
    # minima are maxima of the negated rows, so each row occurs twice
    signs, turning = np.repeat([-1.0, 1.0], len(rows))[:, None], np.concatenate([turning, turning])[:, None]
    each = np.arange(2 * len(rows))
    signed = signs * np.concatenate([rows, rows])
    best = np.argmax(np.where(np.isfinite(signed), signed, -np.inf), axis=1)
    coordinates, values, step = q[best], signed[each, best], abs(float(q[1] - q[0]))
    for _ in range(ROUNDS):
        near = coordinates[:, None] + step * np.linspace(-1, 1, 2 * PARTS + 1)
        near = near if cyclic else np.clip(near, np.min(q), np.max(q))
        fine = _value_rows(sample(near.ravel()), near.ravel()).reshape(len(rows), *near.shape)
        refined = signs * np.concatenate([fine, fine])[each, each]
        change = refined - values[:, None]
        refined = np.where(turning, values[:, None] + change - 2 * np.pi * np.round(change / (2 * np.pi)), refined)
        refined = np.where(np.isfinite(refined), refined, -np.inf)
        best = np.argmax(refined, axis=1)
        better = refined[each, best] > values
        coordinates, values = (
            np.where(better, near[each, best], coordinates),
            np.where(better, refined[each, best], values),
        )
        step /= PARTS
    half = len(courses)
    return tuple(
        QuantityExtreme(
            c.kind,
            c.name,
            c.dimension,
            -float(values[n]),
            float(coordinates[n]),
            float(values[half + n]),
            float(coordinates[half + n]),
        )
        for n, c in enumerate(courses)
        if kept[n]
    )


def _value_rows(courses: Iterable[SampledQuantity], q: Real) -> Real:
    """Stack the values of several quantities, one quantity in each row: shape (quantities, positions)."""
    return np.stack([np.broadcast_to(to_float(np.asarray(c.values)), q.shape) for c in courses]).astype(float)


def _unwrap_rows(rows: Real) -> Real:
    """Unwrap the angles in each row, skipping missing positions."""
    unwrapped = rows.copy()
    for row in unwrapped:
        finite = np.isfinite(row)
        row[finite] = np.unwrap(row[finite])
    return unwrapped
