"""Drawing functions for the commands. The module is imported only when drawings are requested, as matplotlib loads
slowly.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from tmm_cli.cli.common import Pictures
from tmm_cli.cli.drawing import run_on_all_cores
from tmm_cli.cli.talk import say
from tmm_cli.drawing import run as draw
from tmm_cli.drawing.formats import NamedDrawings, drawing_files
from tmm_cli.drawing.sheets import (
    draw_assemblies,
    draw_centres,
    draw_group_table,
    draw_reaction_hodographs,
    draw_synthesis,
)
from tmm_cli.mechanics.analysis import Results


def _draw_run(results: Results, *, quiet: bool = False) -> Pictures:
    return draw.sheet_files(results, say, partial(run_on_all_cores, quiet=quiet))


def _draw_sheets(draw: Callable[..., NamedDrawings], *arguments: Any) -> Pictures:
    return drawing_files(draw(*arguments), say)


PICTURES: dict[str, Callable[..., Pictures]] = {  # by what is drawn: the files, by their names
    "whole": _draw_run,
    "hodographs": partial(_draw_sheets, draw_reaction_hodographs),
    "centres": partial(_draw_sheets, draw_centres),
    "assemblies": partial(_draw_sheets, draw_assemblies),
    "synthesis": partial(_draw_sheets, draw_synthesis),
    "group-table": partial(_draw_sheets, draw_group_table),
}
