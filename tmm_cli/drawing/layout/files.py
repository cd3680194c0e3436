"""Large sheets as files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib.util import find_spec

from tmm_cli.drawing.formats import FORMATS, WITH_PAGES, JobRunner, missing_character_notes, run_in_process
from tmm_cli.drawing.layout.contents import choose_positions
from tmm_cli.drawing.layout.large import large_sheets
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results
from tmm_cli.problem import ProblemError, parse_names

MOST_PLANS = 24  # positions of which plans are drawn


def parse_formats(text: str) -> list[str]:
    """Formats from their names with commas. Raises ProblemError."""
    wanted = parse_names(text, FORMATS, "--as", _("there is no such format of drawings"))
    if "dxf" in wanted and find_spec("ezdxf") is None:
        raise ProblemError(_("DXF is written by ezdxf, which is not installed"), allowed="pip install 'tmm-cli[cad]'")
    return wanted


def refuse_plans(count: int) -> None:
    """Refuse plans of motion of more positions than sheets are read with. Raises ProblemError."""
    if count > MOST_PLANS:
        raise ProblemError(
            _("plans of so many positions fill no sheet that is read"),
            found=str(count),
            allowed=_("{most} at most; with --positions detail: those of positions.detail").format(most=MOST_PLANS),
        )


def large_sheet_files(
    results: Results,
    paper: str,
    formats: Sequence[str],
    say: Callable[[str], None],
    way: JobRunner = run_in_process,
    *,
    every: bool,
) -> Iterator[tuple[str, bytes]]:
    """Every sheet in every format, by the name of its file; a PDF has all as its pages. Raises ProblemError.

    way: who draws and who writes. every: whether motion plans are drawn of all positions.
    """
    choice = choose_positions(results, every=every)
    refuse_plans(len(choice.plans))
    if choice.moves and not choice.loaded:
        say(_("note: nothing has a weight and no load acts, so there is no sheet of forces"))
    sheets = dict(large_sheets(choice, paper, way))
    jobs: list[tuple[str, Callable[[], bytes]]] = []
    for name in formats:
        if name in WITH_PAGES:
            jobs.append((f"sheets.{name}", partial(WITH_PAGES[name], *sheets.values())))
        else:
            jobs += [(f"{stem}.{name}", partial(FORMATS[name], sheet)) for stem, sheet in sheets.items()]
    yield from zip((file for file, __ in jobs), way([job for __, job in jobs]), strict=True)
    for note in missing_character_notes(text for sheet in sheets.values() for text in sheet.texts()):
        say(note)
