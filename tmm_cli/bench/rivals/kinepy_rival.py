"""Computation by kinepy.

Positions are found in closed form, accelerations by second differences over time, forces from these accelerations.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stdout
from itertools import product
from typing import Any

import kinepy
import numpy as np

from tmm_cli.bench.methods.case import Case, Method, MethodAnswers, UnsupportedLinkageError
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, Vector, cross, unit

STEP = 2 * np.pi / 360  # rad: largest step, since differences over time are taken between positions
SAME = 1e-6  # of the linkage's size


def prepare_kinepy(case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the computation of a case by kinepy at equally spaced driver coordinates.

    Raises:
        MethodUnable: kinepy cannot compute this linkage.
    """
    model = _KinepyModel(case)

    def at(q: Real) -> MethodAnswers:
        chosen, dt = model.solve(q)
        return model.build_answers(chosen, dt)

    return at


def prepare_kinepy_alone(case: Case) -> Callable[[Real], object]:
    """Prepare kinepy's `solve_dynamics` without conversion of its results.

    Raises:
        MethodUnable: kinepy cannot compute this linkage.
    """
    return _KinepyModel(case).solve


class _KinepyModel:
    """A linkage as a kinepy model in SI units."""

    def __init__(self, case: Case) -> None:
        driver = case.linkage.driver
        if driver.kind != "turn" or case.linkage.others:
            raise UnsupportedLinkageError("the driver must be a single crank")
        kinepy.units.set_unit_system(kinepy.units.SI)
        self.case, self.system = case, kinepy.System()
        self.solids: dict[str, Any] = {FRAME: self.system.ground}
        for name in case.linkage.moving:
            link = case.linkage.links[name]
            self.solids[name] = self.system.add_solid(name, link.mass, link.inertia, _components(link.centre))
        self.joints: dict[str, Any] = {}
        for pair in case.structure.pairs:
            i, j = self.solids[pair.i], self.solids[pair.j]
            if pair.slide is None:
                ends = (_components(case.linkage.local(link, pair.point)) for link in (pair.i, pair.j))
                self.joints[pair.name] = self.system.add_revolute(i, j, *ends)
            else:
                slide, turned = pair.slide, pair.slide.direction - pair.slide.turned
                a, b = (
                    (slide.direction, cross(unit(slide.direction), slide.through)),
                    (
                        turned,
                        cross(unit(turned), slide.at),
                    ),
                )
                if pair.i != slide.carrier:
                    a, b = b, a
                self.joints[pair.name] = self.system.add_prismatic(i, j, *map(float, (*a, *b)))
        self.crank = self.joints[case.structure.driving_pair(driver).name]
        gravity = self.case.linkage.gravity
        self.system.add_gravity(_components(gravity))
        self._loaded: tuple[float, float, int] | None = None
        with redirect_stdout(io.StringIO()):  # it prints its progress
            self.system.pilot(self.crank)
            self.system.block(self.crank)
            try:
                self.system.compile()
            except Exception as error:
                raise UnsupportedLinkageError(
                    f"the program cannot build this linkage: {type(error).__name__}"
                ) from None
        self._choose_assemblies()

    def _choose_assemblies(self) -> None:
        """Choose the assembly of each group that the sketch shows."""
        case = self.case
        q = case.start + STEP * np.arange(5)
        true = compute_motion(case.linkage, case.kernels, q, case.law)
        for signs in product((1, -1), repeat=len(self.system._object.signs)):
            if signs:
                self.system.change_signs(signs)
            self.system.solve_kinematics(q[None, :].copy())
            assemblies = self.positions()
            if all(
                np.max(np.abs(assemblies[p] - true.named(p).x)) < SAME * case.size for p in case.linkage.moving_points
            ):
                return
        raise UnsupportedLinkageError("the program does not solve this linkage")

    def solve(self, q: Real) -> tuple[slice, float]:
        """Solve the model at equally spaced driver coordinates q.

        A position is added at each end, because kinepy does not compute the values at the ends.

        Returns:
            Slice of the requested positions, and the time step (s).
        """
        key = (float(q[0]), float(q[1] - q[0]), len(q))
        if key != self._loaded:
            step = key[1]
            self._times = max(1, int(np.ceil(abs(step) / STEP - 1e-9)))  # steps between two requested positions
            step /= self._times
            self._grid = q[0] + step * np.arange(-1, (len(q) - 1) * self._times + 2)
            motion = compute_motion(self.case.linkage, self.case.kernels, self._grid, self.case.law)  # loads are data
            self.apply_loads([(a.link, a.at, a.force, a.moment) for a in self.case.loads(motion) if a.kind == "load"])
            self._dt = step / (self.case.law.sense * self.case.law.rate)
            self._loaded = key
        self.system.solve_dynamics(self._grid[None, :].copy(), self._dt * len(self._grid))
        return slice(1, -1, self._times), self._dt

    def apply_loads(self, acting: list[tuple[str, complex, Vector, Real]]) -> None:
        """Replace the loads of the model by loads on links: link, point of action, force, moment."""
        for name in self.solids:
            self.solids[name].external_actions.externals.clear()
        for link, at, force, moment in acting:
            if np.any(force != 0):
                self.solids[link].add_force(np.array([force.real, force.imag]), _components(at))
            if np.any(moment != 0):
                self.solids[link].add_torque(moment)

    def positions(self) -> dict[str, Vector]:
        """Return the positions of the named points (m) by name."""
        positions = {}
        for point in self.case.linkage.moving_points:
            link = self.case.linkage.owner(point)
            x, y = self.solids[link].get_point(_components(self.case.linkage.local(link, point)))
            positions[point] = x + 1j * y
        return positions

    def build_answers(self, chosen: slice, dt: float) -> MethodAnswers:
        """Return the results in the common form; velocities and accelerations by kinepy's own difference formulas.

        Args:
            chosen: Slice of the requested positions.
            dt: Time step, s.
        """
        x = self.positions()
        v = {name: _pad_with_nan((at[2:] - at[:-2]) / (2 * dt)) for name, at in x.items()}
        a = {name: _pad_with_nan((at[2:] + at[:-2] - 2 * at[1:-1]) / (dt * dt)) for name, at in x.items()}
        reactions = {name: self._reaction(name)[chosen] for name in self.joints}
        one, two, three = ({name: part[chosen] for name, part in parts.items()} for parts in (x, v, a))
        return MethodAnswers(one, two, three, reactions, -np.asarray(self.crank.torque)[chosen])

    def _reaction(self, name: str) -> Vector:
        """Return the reaction on the second link of a pair; kinepy gives the reaction on the first link."""
        joint = self.joints[name]
        pair = self.case.structure.pair(name)
        if pair.slide is None:
            x, y = joint.force
            found: Vector = -(x + 1j * y)
            return found
        s1 = self.solids[pair.i]
        direction = pair.slide.direction - (0 if pair.i == pair.slide.carrier else pair.slide.turned)
        force: Vector = -1j * unit(np.asarray(s1.angle) + direction) * np.asarray(joint.normal)
        return force


def _pad_with_nan(values: Vector) -> Vector:
    nothing = np.array([np.nan])
    return np.concatenate((nothing, values, nothing))


def _components(vector: Any) -> tuple[float, float]:
    return float(np.real(vector)), float(np.imag(vector))


METHOD = Method("kinepy", "kinepy", prepare_kinepy, alone=prepare_kinepy_alone)
