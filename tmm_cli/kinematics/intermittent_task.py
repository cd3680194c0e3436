"""What is asked of intermittent motion: a wheel that a link takes along on some strokes and that stands on others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from tmm_cli.linkage import Linkage

When = Literal["forward", "backward", "working stroke", "idle stroke"]


@dataclass(frozen=True)
class Setting:
    """The linkage of one of the settings that take turns; values: of parameters, as they are written.

    linkage: None where it is that of the file.
    """

    values: Mapping[str, str] = field(default_factory=dict)
    linkage: Linkage | None = None


@dataclass(frozen=True)
class WheelTask:
    """A wheel (or a shaft, a flange) on the axis of `link`, which turns on the frame and takes it along.

    when: the link turns forward (counterclockwise) or backward, or in strokes of the output; settings: one a cycle of
    the driver, in turn.
    """

    name: str
    link: str
    when: When
    settings: tuple[Setting, ...] = (Setting(),)
