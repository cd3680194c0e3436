"""Crank condition: which links of a four-bar, a crank-slider or a slotted-lever mechanism rotate fully."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.numerics import SAME_RATIO
from tmm_cli.problem import ProblemError, Value as FileValue, ValueReader
from tmm_cli.synthesis.blocks import UNDETERMINED, TaskBlock, read_numbers
from tmm_cli.synthesis.four_bar import FIRST_CHANGE_POINT, FOUR_BAR_TYPES, FourBarLinks, classify_four_bar
from tmm_cli.synthesis.measures import driver_completes_range
from tmm_cli.synthesis.record import Demand, Infeasible, NamedValue, SynthesisOutcome, given_values

PARAMETERS: Final[dict[str, str]] = {}
LINKS: Final = {  # quantities that a task may give: kind and description
    "l1": ("length", N_("link 1")),
    "l2": ("length", N_("link 2")),
    "l3": ("length", N_("link 3")),
    "l4": ("length", N_("link 4")),
    "r": ("length", N_("crank r")),
    "l": ("length", N_("connecting rod l")),
    "e": ("length", N_("offset e")),
    "OA": ("length", N_("crank OA")),
    "OC": ("length", N_("frame OC")),
}
FOUR_BAR_TITLES: Final = {
    "GCCC": N_("GCCC: crank-crank-crank (double crank, drag link)"),
    "GCRR": N_("GCRR: crank-rocker-rocker (crank-rocker)"),
    "GRCR": N_("GRCR: rocker-crank-rocker (double rocker whose coupler rotates fully)"),
    "GRRC": N_("GRRC: rocker-rocker-crank (rocker-crank)"),
    "RRR1": N_("RRR1: triple rocker, longest link is the frame"),
    "RRR2": N_("RRR2: triple rocker, longest link is the input link"),
    "RRR3": N_("RRR3: triple rocker, longest link is the coupler"),
    "RRR4": N_("RRR4: triple rocker, longest link is the output link"),
    "SCCC": N_("SCCC: crank-crank-crank with change points"),
    "SCRR": N_("SCRR: crank-rocker-rocker with change points"),
    "SRCR": N_("SRCR: rocker-crank-rocker with change points"),
    "SRRC": N_("SRRC: rocker-rocker-crank with change points"),
    "S2X": N_("S2X: two pairs of equal links (parallelogram or kite), with change points"),
    "S3X": N_("S3X: four equal links (rhombus), with change points"),
}
CRANK_SLIDER_TYPES: Final = {  # by index of the kind
    "crank": N_("the crank rotates fully"),
    "rod": N_("the crank rocks, the rod rotates fully"),
    "none": N_("neither the crank nor the rod rotates fully"),
    "change": N_("change point: the slider may move to the other side of the crank pivot"),
}
SLOTTED_LEVER_TYPES: Final = {
    "swings": N_("the crank rotates fully, the slotted link swings"),
    "turns": N_("both the crank and the slotted link rotate fully"),
    "none": N_("the crank does not rotate fully"),
    "change": N_("change point: the sliding block may pass through the hinge of the slotted link"),
}


@dataclass(frozen=True)
class CrankSlider:
    """Dimensions of a crank-slider (m): crank r, connecting rod l, offset e of the guide."""

    r: Any
    l: Any  # noqa: E741  its name in every course
    e: Any = 0.0


@dataclass(frozen=True)
class SlottedLever:
    """Dimensions of a slotted-lever mechanism (m): crank OA, frame OC, distance e of the slot's centre line from C."""

    OA: Any
    OC: Any
    e: Any = 0.0


@dataclass(frozen=True)
class CrankCondition:
    """Type of a crank-slider or slotted-lever mechanism, and the margin of its crank condition.

    Attributes:
        kind: index in CRANK_SLIDER_TYPES or SLOTTED_LEVER_TYPES.
        margin: l - (r + e) or |OC - OA| - e (m); positive if the crank rotates fully.
    """

    kind: Any
    margin: Any


CrankConditionTask = FourBarLinks | CrankSlider | SlottedLever


def classify_crank_slider(task: CrankSlider) -> CrankCondition:
    """Return the type of a crank-slider. The crank rotates fully if l >= r + |e|.

    With l = r + |e|, and with r = l + |e|, the mechanism has a change point.

    Args:
        task: dimensions (m), numbers or arrays.
    """
    r, rod, e = np.broadcast_arrays(task.r, task.l, np.abs(task.e))
    same = SAME_RATIO * (r + rod + e)
    margin = rod - (r + e)
    other = r - (rod + e)
    kind = np.where(margin > same, 0, np.where(other > same, 1, 2))
    kind = np.where((np.abs(margin) <= same) | (np.abs(other) <= same), 3, kind)
    return CrankCondition(kind, _zero_rounding(margin, same))


def classify_slotted_lever(task: SlottedLever) -> CrankCondition:
    """Return the type of a slotted-lever mechanism.

    The crank rotates fully if |OC - OA| > |e|: the slotted link then swings if OC > OA and rotates fully if OC < OA.
    With |OC - OA| = |e| the mechanism has a change point.

    Args:
        task: dimensions (m), numbers or arrays.
    """
    crank, frame, e = np.broadcast_arrays(task.OA, task.OC, np.abs(task.e))
    same = SAME_RATIO * (crank + frame + e)
    margin = np.abs(frame - crank) - e
    kind = np.where(margin > same, np.where(frame > crank, 0, 1), 2)
    return CrankCondition(np.where(np.abs(margin) <= same, 3, kind), _zero_rounding(margin, same))


def _zero_rounding(margin: Any, same: Any) -> Any:
    return np.where(np.abs(margin) <= same, 0.0, margin)[()]


def refuse(task: CrankConditionTask) -> None:
    """Raise Infeasible if the links of a four-bar do not form a closed loop."""
    if isinstance(task, FourBarLinks) and classify_four_bar(task).kind < 0:
        longest = max(("l1", "l2", "l3", "l4"), key=lambda name: float(getattr(task, name)))
        reason = _(
            "the links do not form a closed loop: {link} is as long as the other three together, or longer. "
            "Shorten {link}"
        )
        raise Infeasible(longest, reason.format(link=longest))


def solve(task: CrankConditionTask) -> SynthesisOutcome:
    """Classify the mechanism of a task. Raises Infeasible if its links do not form a closed loop."""
    refuse(task)
    if isinstance(task, FourBarLinks):
        return _solve_four_bar(task)
    if isinstance(task, CrankSlider):
        condition, types, margin = classify_crank_slider(task), CRANK_SLIDER_TYPES, N_("l - (r + e)")
        source = N_("Grashof's condition in the limit of an infinitely long rocker: l >= r + e")
    else:
        condition, types, margin = classify_slotted_lever(task), SLOTTED_LEVER_TYPES, N_("|OC - OA| - e")
        source = N_("the sliding block cannot come closer to C than the centre line of the slot: |OC - OA| >= e")
    name = list(types)[int(condition.kind)]
    values = (NamedValue("", types[name], "word", N_("type")), NamedValue("", condition.margin, "length", margin))
    return SynthesisOutcome(
        given_values(task, LINKS),
        values,
        source,
        _make_rotation_demands(name in ("crank", "swings", "turns"), name == "change"),
    )


def _solve_four_bar(task: FourBarLinks) -> SynthesisOutcome:
    four_bar = classify_four_bar(task)
    change = int(four_bar.kind) >= FIRST_CHANGE_POINT
    at_change, fully, rocks = (
        N_("rotates fully or rocks, depending on the motion through the change points"),
        N_("rotates fully"),
        N_("rocks"),
    )
    given_rows = (
        *given_values(task, LINKS),
        NamedValue("frame", f"l{task.frame}", "word", N_("frame")),
        NamedValue("driver", f"l{task.driver}", "word", N_("driver")),
    )
    values = [
        NamedValue("", FOUR_BAR_TITLES[FOUR_BAR_TYPES[int(four_bar.kind)]], "word", N_("type")),
        NamedValue("", four_bar.excess, "length", N_("(sum of the two middle lengths) - (shortest + longest)")),
    ]
    for role, turns in zip((N_("input link"), N_("coupler"), N_("output link")), four_bar.turns, strict=True):
        values.append(NamedValue("", (at_change if change else fully) if turns else rocks, "word", role))
    source = N_(
        "Grashof's condition: s + l is compared with p + q; types by C. R. Barker, A complete "
        "classification of planar four-bar linkages, Mechanism and Machine Theory 20 (1985)"
    )
    return SynthesisOutcome(given_rows, tuple(values), source, _make_rotation_demands(bool(four_bar.turns[0]), change))


def _make_rotation_demands(turns: bool, change: bool) -> tuple[Demand, ...]:
    """Return the check that the driver of the analysed mechanism rotates fully, or does not, as the classification
    predicts.

    There is no check for mechanisms with change points.
    """
    words = N_("driver rotates fully (1: yes, 0: no)")
    return () if change else (Demand(words, float(turns), "number", driver_completes_range, asked=False),)


# Keys of the task.


LinkName = Literal["l1", "l2", "l3", "l4"]
KEY_SETS: tuple[tuple[Any, tuple[str, ...], tuple[str, ...]], ...] = (  # record, required keys, optional keys
    (FourBarLinks, ("l1", "l2", "l3", "l4"), ("frame", "driver")),
    (CrankSlider, ("r", "l"), ("e",)),
    (SlottedLever, ("OA", "OC"), ("e",)),
)


class GrashofBlock(TaskBlock):
    """Keys of the task `grashof`: a four-bar (l1 to l4), a crank-slider (r, l, e) or a slotted-lever mechanism (OA, OC,
    e).
    """

    task: Literal["grashof"]
    l1: FileValue | None = Field(
        default=None, description="link lengths l1 to l4 of a four-bar, in the order in which the links are connected"
    )
    l2: FileValue | None = None
    l3: FileValue | None = None
    l4: FileValue | None = None
    frame: LinkName | None = Field(default=None, description="link that is the frame; default l4")
    driver: LinkName | None = Field(
        default=None, description="link adjacent to the frame that is the driver; default: the next link in order"
    )
    r: FileValue | None = Field(default=None, description="crank length of a crank-slider")
    l: FileValue | None = Field(default=None, description="rod length of a crank-slider")  # noqa: E741
    e: FileValue | None = Field(default=None, description="offset of the guide, or of the slot; default 0")
    OA: FileValue | None = Field(default=None, description="crank length of a slotted-lever mechanism")
    OC: FileValue | None = Field(
        default=None, description="distance between the fixed hinges of a slotted-lever mechanism"
    )


BLOCK = GrashofBlock


def read(block: GrashofBlock, values: ValueReader) -> CrankConditionTask:
    """Convert the keys of the task to lengths (m).

    Raises:
        ProblemError: the keys do not determine a mechanism.
    """
    lengths = read_numbers(block, values, LINKS)
    given_keys = {*lengths, *(key for key in ("frame", "driver") if getattr(block, key) is not None)}
    fitting = [record_type for record_type, needed, more in KEY_SETS if set(needed) <= given_keys <= {*needed, *more}]
    if not fitting:
        raise ProblemError(
            translated(UNDETERMINED),
            found=", ".join(sorted(given_keys)) or _("none"),
            allowed="; ".join(f"{', '.join(needed)} (+ {', '.join(more)})" for __, needed, more in KEY_SETS),
            key=True,
        )
    record = fitting[0]
    if record is FourBarLinks:
        frame = int((block.frame or "l4")[1])
        driver = int(block.driver[1]) if block.driver else frame % 4 + 1
        if (driver - frame) % 2 == 0:
            allowed = ", ".join(f"l{(frame - 1 + step) % 4 + 1}" for step in (1, -1))
            raise ProblemError(
                _("the driver must be hinged to the frame"),
                path=("driver",),
                found=_("'l{driver}', the link opposite the frame l{frame}").format(driver=driver, frame=frame),
                allowed=allowed,
            )
        lengths |= {"frame": frame, "driver": driver}
    task: CrankConditionTask = record(**lengths)
    return task
