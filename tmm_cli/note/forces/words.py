"""How forces and couples are told: sizes, angles, senses, lists of letters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_cli.draw.sheets.mechanism import place_of_driver
from tmm_cli.language import _
from tmm_cli.note.context import Subject, with_degrees


def angle(subject: Subject, radians: float) -> str:
    """Of a force from x, 0 to 360, in degrees."""
    return subject.figures_of(f"{round(float(np.degrees(radians)), 1) % 360:.1f}")


def direction(subject: Subject, force: complex) -> str:
    """The same with the sign of degrees."""
    return f"{angle(subject, float(np.angle(force)))}°"


def links_of(names: Sequence[str]) -> str:
    """Link 4; links 4, 5."""
    return (_("links {links}") if len(names) > 1 else _("link {links}")).format(links=", ".join(names))


def at_position(subject: Subject, k: int) -> str:
    """Which position, and where the driver stands."""
    place = with_degrees(place_of_driver(subject.results, float(subject.motion.q[k]), 4))
    return _("position {number}, {place}").format(number=subject.called(k), place=place)
