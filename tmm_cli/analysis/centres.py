"""Instantaneous centres of a mechanism in the positions in detail."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.analysis.in_detail import in_detail
from tmm_cli.analysis.pipeline import Results
from tmm_cli.kinematics.centres import centres


def with_centres(results: Results) -> Results:
    """Kinematics with the centres, in positions that were asked for one by one or are in detail."""
    motion = results.motion
    assert motion is not None
    every = len(results.numbers) < len(results.asked)
    chosen = np.flatnonzero(motion.moving).tolist() if every else in_detail(results)
    return replace(results, centres={k: centres(motion, results.structure, k) for k in chosen})
