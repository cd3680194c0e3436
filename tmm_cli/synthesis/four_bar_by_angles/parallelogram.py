"""Pairs of equal angles: every parallelogram l1 = l3, l2 = l4 passes them, and l1/l4 is free.

Freudenstein's equation has p = q and s = 1 then, whatever p is. In a parallelogram the transmission angle is the angle
of DC from AD itself, so that no choice of l1/l4 is better than another; with both zero angles free DC stands across AD
in the middle of its swing.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars

SAME: Final = 1e-11  # rad: angles that are equal but for rounding
SHARE: Final = 0.5  # l1/l4 of the parallelogram that is taken


def parallelogram(phi: Any, psi: Any, phi0: Any, psi0: Any) -> Bars | None:
    """The one that is taken for three to five pairs (rad; a zero angle of None is to be found); None where the angles
    from the zeros do not stay equal. Angles that stay half a turn apart are equal ones of a link drawn the other way.
    """
    phi, psi = np.asarray(phi, dtype=float), np.asarray(psi, dtype=float)
    if len(phi) < 3 or np.max(np.abs(np.sin((psi - phi - psi[0] + phi[0]) / 2))) > SAME:
        return None
    if phi0 is None and psi0 is None:
        psi0 = np.pi / 2 - (psi.min() + psi.max()) / 2
    gap = psi[0] - phi[0]
    if phi0 is None:
        phi0 = math.remainder(psi0 + gap, math.tau)
    elif psi0 is None:
        psi0 = math.remainder(phi0 - gap, math.tau)
    elif abs(np.sin(psi0 + gap - phi0)) > SAME:
        return None
    elif np.cos(psi0 + gap - phi0) < 0:
        phi0 = math.remainder(phi0 + np.pi, math.tau)
    return Bars(SHARE, 1.0, SHARE, phi0, psi0)
