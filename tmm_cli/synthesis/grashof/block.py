"""Which links turn fully: keys of the task."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from tmm_cli.language import _, translated
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.schema_parts import Value
from tmm_cli.problem.values import ValueReader
from tmm_cli.synthesis.blocks import UNDETERMINED, Block, numbers
from tmm_cli.synthesis.four_bar import FourBar
from tmm_cli.synthesis.grashof.solver import LINKS, CrankSlider, SlottedLever, Task

Link = Literal["l1", "l2", "l3", "l4"]
SETS: tuple[tuple[Any, tuple[str, ...], tuple[str, ...]], ...] = (  # record, keys that it needs, keys that it may have
    (FourBar, ("l1", "l2", "l3", "l4"), ("frame", "driver")),
    (CrankSlider, ("r", "l"), ("e",)),
    (SlottedLever, ("OA", "OC"), ("e",)),
)


class Shape(Block):
    """Crank conditions of a four-bar (l1 to l4), a crank-slider (r, l, e) or a slotted lever (OA, OC, e)."""

    task: Literal["grashof"]
    l1: Value | None = Field(default=None, description="links of a four-bar as they are joined round")
    l2: Value | None = None
    l3: Value | None = None
    l4: Value | None = None
    frame: Link | None = Field(default=None, description="which of them is the frame; l4")
    driver: Link | None = Field(default=None, description="which of its two neighbours drives; the next one round")
    r: Value | None = Field(default=None, description="crank of a crank-slider")
    l: Value | None = Field(default=None, description="its rod")  # noqa: E741
    e: Value | None = Field(default=None, description="offset of the guide, or of the slot; 0")
    OA: Value | None = Field(default=None, description="crank of a slotted lever")
    OC: Value | None = Field(default=None, description="distance of its fixed hinges")


def read(shape: Shape, values: ValueReader) -> Task:
    """The lengths in m. Raises ProblemError."""
    found = numbers(shape, values, LINKS)
    given = {*found, *(key for key in ("frame", "driver") if getattr(shape, key) is not None)}
    fitting = [one for one, needed, more in SETS if set(needed) <= given <= {*needed, *more}]
    if not fitting:
        raise ProblemError(
            translated(UNDETERMINED), found=", ".join(sorted(given)) or _("none"),
            allowed="; ".join(f"{', '.join(needed)} (+ {', '.join(more)})" for __, needed, more in SETS), key=True,
        )  # fmt: skip
    record = fitting[0]
    if record is FourBar:
        frame = int((shape.frame or "l4")[1])
        driver = int(shape.driver[1]) if shape.driver else frame % 4 + 1
        if (driver - frame) % 2 == 0:
            allowed = ", ".join(f"l{(frame - 1 + step) % 4 + 1}" for step in (1, -1))
            raise ProblemError(
                _("the driver is hinged to the frame"), path=("driver",),
                found=_("'l{driver}' opposite the frame l{frame}").format(driver=driver, frame=frame),
                allowed=allowed,
            )  # fmt: skip
        found |= {"frame": frame, "driver": driver}
    made: Task = record(**found)
    return made
