"""Problems of the bank that have dimensions: read, solved, drawn and told in notes once for all tests of a process."""

from __future__ import annotations

from functools import cache
from typing import Any

from models import PROBLEMS, file_of

from tmm_cli import load, solve
from tmm_cli.drawing.paper import Drawing
from tmm_cli.drawing.run import all_sheets
from tmm_cli.mechanics.analysis import Results
from tmm_cli.note import Note, note

AT_THE_TOP = [  # chains given by pairs alone have no dimensions: test_spatial
    path.stem for path in sorted(PROBLEMS.glob("*.yaml")) if "\nstructure:" not in path.read_text(encoding="utf-8")
]
IN_FOLDERS = [  # by chapters of the sources: folder/name
    f"{path.parent.name}/{path.stem}" for path in sorted(PROBLEMS.glob("*/*.yaml"))
]
EVERY = [*AT_THE_TOP, *IN_FOLDERS]
REPEATED = {  # each with the one whose groups by their pairs, toothed pairs, drivers and blocks it has: test_structure
    "course-1": "shaper",
    "course-3": "shaper",
    "course-4": "shaper",
    "whitworth": "shaper",
    "crank-slider-offset": "crank-slider",
    "inclined-slider": "crank-slider",
    "slotted/angle-doubling": "slotted-lever-synthesis",
    "four-bars/swing-doubler": "crank-rocker",
    "slotted-lever": "slotted-lever-synthesis",
    "toggle-press": "six-bar",
    "two-strokes": "six-bar",
    "cranks/double-stroke-press": "six-bar",
    "settings/adjustable-lever": "six-bar",
    "triad-six-assemblies": "shaking-screen",
    "four-bars/transfer": "parallel-couplers",
    "four-bars/swing-crank-rocker": "crank-rocker",
    "four-bars/claw": "crank-rocker",
    "settings/rod-length": "crank-slider",
    "settings/guide-setting": "crank-slider",
    "settings/shaper-settings": "shaper",
    "settings/leading-arm": "six-bar",
    "settings/rocker-angle": "six-bar",
}
NAMES = [  # what each whole-bank test goes through: of the small ones in folders a third, and each kind once
    name for name in (*AT_THE_TOP, *IN_FOLDERS[::3]) if name not in REPEATED
]


@cache
def problem(name: str) -> Any:
    """A problem; what it searches for is found once."""
    return load(str(file_of(name)))


@cache
def moved(name: str) -> Results:
    """Its kinematics."""
    return solve(problem(name), "kinematics")


@cache
def solved(name: str) -> Results:
    """Its kinematics and forces."""
    return solve(problem(name))


@cache
def drawn(name: str) -> dict[str, Drawing]:
    """Its sheets by their stems."""
    return dict(all_sheets(solved(name)))


@cache
def written(name: str) -> Note:
    """Its note without drawings, which have tests of their own."""
    return note(solved(name), drawn=False)
