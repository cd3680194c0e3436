"""Couples of inertia left out."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.grading.mistakes.no_inertia import NoInertia
from tmm_cli.language import N_


@dataclass(frozen=True)
class NoCouple(NoInertia):
    """Of one link, or of all."""

    name = N_("couple of inertia left out")
    sentence = N_("The couple of inertia J epsilon was left out.")
    part, of = "moment", "inertia"
