"""Shared parts of the commands: options, processing of several files, error reports, exit codes."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn

import typer
from rich.console import Console, ConsoleOptions, RenderableType
from rich.progress import Progress, track
from rich.segment import Segment

from tmm_cli.cli.talk import BAD_INPUT, OK, printable, report_fault, say
from tmm_cli.language import _, language, spoken
from tmm_cli.problem import ProblemError, escape_controls
from tmm_cli.reports import SpreadsheetKind, folder_name, refuse_unwritable

Files = Annotated[list[str], typer.Argument(metavar="FILE...", help="Problem files (YAML).", show_default=False)]
Json = Annotated[bool, typer.Option("--json", help="Print result.json instead of tables.")]
Position = Annotated[
    list[int] | None,
    typer.Option("--position", "-p", min=0, help="Compute only this position (may be repeated).", show_default=False),
]
WithDigits = Annotated[
    bool,
    typer.Option("--digits", help="Show the rounding error bound of each value and its sensitivity to the data."),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="NAME=VALUE", help="Set a parameter to another value (may be repeated).", show_default=False
    ),
]
Variants = Annotated[
    str | None,
    typer.Option(metavar="FILE", help="Table of variants of the task, CSV or XLSX.", show_default=False),
]
Variant = Annotated[
    str | None,
    typer.Option(metavar="N", help="Variant in the table: its number, or the student's name.", show_default=False),
]
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Also write tables to this folder.", show_default=False),
]
Folder = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="Folder for the results.")]
Jobs = Annotated[
    int | None, typer.Option(min=1, help="Number of processes; default: one per core.", show_default=False)
]
Scheduler = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="Use a Dask cluster with this scheduler.", show_default=False)
]
Tables = Annotated[
    SpreadsheetKind | None,
    typer.Option(
        "--tables",
        help="Also write tables for a spreadsheet, with rounded values, in your language.",
        show_default=False,
    ),
]

Pictures = Iterable[tuple[str, bytes]]


def draw_pictures(
    kind: Literal["whole", "hodographs", "centres", "assemblies", "synthesis", "group-table"],
    *arguments: Any,
    **options: Any,
) -> Pictures:
    """Draw pictures and return their file names and contents. The drawing modules are imported only here.

    Args:
        kind: kind of drawings; `whole` means all drawings of a run.
        arguments: positional arguments of the drawing function.
        options: keyword arguments of the drawing function.
    """
    pictures: Pictures = import_module("tmm_cli.cli.pictures").PICTURES[kind](*arguments, **options)
    return pictures


class _VisibleConsole(Console):
    """Console that escapes control characters in the printed texts, so that a file cannot control the terminal."""

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        for segment in super().render(renderable, options):
            text = segment.text if segment.control else escape_controls(segment.text)
            yield segment if text == segment.text else Segment(text, segment.style)


def console() -> Console:
    """Create a console for results on standard output. If the output is not a terminal, the console is 200 columns
    wide.
    """
    return _VisibleConsole(width=None if sys.stdout.isatty() else 200, highlight=False, markup=False)


def for_each_file(
    files: Sequence[str],
    work: Callable[[str], int],
    *,
    as_json: bool = False,
    headed: bool = True,
    out: Path | None = None,
) -> NoReturn:
    """Process every file, with a progress bar for several, and exit with the highest exit code.

    An error in one file is reported and does not stop the processing of the others.

    Args:
        files: problem files.
        work: processes one file and returns an exit code.
        as_json: print errors as JSON as well.
        headed: print the name of each file above its results if there are several files.
        out: output folder with a subfolder for each file. Two files with the same name are refused.

    Raises:
        typer.Exit: always, with the exit code.
    """
    worst = OK
    if out is not None:
        _refuse_same_folder(files)
        with reporting_errors():
            refuse_unwritable(out, folder=True)
    for file in with_progress(files):
        if headed and len(files) > 1 and not as_json:
            console().print(f"== {printable(file)} ==", style="bold")
        try:
            with spoken(language()), reporting_errors(as_json):
                code = work(file)
        except typer.Exit as refused:
            code = refused.exit_code
        except OSError:
            raise
        except Exception as error:  # the other files are still processed
            code = report_fault(error, sys.argv[1:])
        worst = max(worst, code)
    raise typer.Exit(worst)


@contextmanager
def reporting_errors(as_json: bool = False, name: str = "") -> Iterator[None]:
    """Context manager that reports errors in the input and exits with the exit code for bad input.

    Args:
        as_json: print the error as JSON as well.
        name: name of the file for messages, used if the operating system reports none.

    Raises:
        typer.Exit: ProblemError or OSError was raised in the `with` block.
    """
    try:
        yield
    except ProblemError as error:
        if as_json:
            emit_json({"error": error.to_dict()})
        say(_("error: {error}").format(error=error))
        raise typer.Exit(BAD_INPUT) from None
    except BrokenPipeError:
        raise
    except OSError as error:
        say(_("error: {error}").format(error=f"{printable(error.filename or name or _('output'))}: {error.strerror}"))
        raise typer.Exit(BAD_INPUT) from None


def _refuse_same_folder(files: Sequence[str]) -> None:
    """Refuse files whose results would be written to the same folder."""
    first: dict[str, str] = {}
    for file in files:
        other = first.setdefault(folder_name(Path(file).stem).casefold(), file)
        if Path(other).resolve() != Path(file).resolve():
            say(
                _(
                    "error: {first} and {second} have the same name, so their results would be written to the "
                    "same folder"
                ).format(first=printable(other), second=printable(file))
            )
            raise typer.Exit(BAD_INPUT)


def write_new_file(file: Path, text: str) -> bool:
    """Write a text to a new file; for the name `-`, print it instead.

    Returns:
        True if a file was written.

    Raises:
        ProblemError: the file already exists.
    """
    if str(file) == "-":
        typer.echo(text, nl=False)
        return False
    if file.exists():
        raise ProblemError(
            _("{file} already exists").format(file=printable(file)), allowed=_("another file name, given with -o FILE")
        )
    with file.open("x", encoding="utf-8") as stream:
        stream.write(text)
    return True


def problems_in(paths: Sequence[Path], further: Sequence[Path] = ()) -> list[Path]:
    """List the given files and the problem files (*.yaml) in the given folders and their subfolders.

    Args:
        paths: files and folders.
        further: files to append to the list.

    Raises:
        typer.Exit: there is no file.
    """
    depths = ("*.yaml", "*/*.yaml")
    files = [f for p in paths for f in ([f for d in depths for f in sorted(p.glob(d))] if p.is_dir() else [p])]
    if not files and not further:
        folders = ", ".join(map(printable, paths))
        say(_("error: no problems (*.yaml) in {folders}").format(folders=folders))
        raise typer.Exit(BAD_INPUT)
    return list(dict.fromkeys([*files, *further]))


def with_progress(files: Sequence[Any]) -> Iterable[Any]:
    """Return an iterator over the files that shows a progress bar if there are several."""
    if len(files) < 2:
        return files
    return track(files, description="", console=Console(stderr=True), transient=True)


def progress_bars(quiet: bool = False) -> Progress:
    """Create progress bars; they are hidden if `quiet` or if standard error is not a terminal."""
    return Progress(console=Console(stderr=True), transient=True, disable=quiet or not sys.stderr.isatty())


def emit_json(content: dict[str, Any]) -> None:
    """Print a JSON document on standard output."""
    sys.stdout.write(json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1) + "\n")
