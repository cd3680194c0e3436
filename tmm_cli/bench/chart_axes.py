"""Axes that charts of measurements share."""

from __future__ import annotations

from typing import Any


def bare(axes: Any, title: str) -> None:
    """A title, small figures, a light grid behind."""
    axes.set_title(title, fontsize=10, loc="left")
    axes.tick_params(labelsize=8)
    axes.grid(True, color="#e2e2e2", lw=0.5)
    axes.set_axisbelow(True)
