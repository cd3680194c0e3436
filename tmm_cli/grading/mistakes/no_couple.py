"""Couples of inertia left out."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.errors import _
from tmm_cli.grading.mistakes.no_inertia import NoInertia


@dataclass(frozen=True)
class NoCouple(NoInertia):
    """Of one link, or of all."""

    name = _("couple of inertia left out")
    sentence = _("The couple of inertia J epsilon was left out.")
    part, of = "moment", "inertia"
