"""What the commands share: arguments, reading files one after the other, errors, exit codes."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from tmm_cli.errors import _

if TYPE_CHECKING:
    from rich.console import Console

    from tmm_cli.analysis.pipeline import Results, Stage
    from tmm_cli.analysis.spatial_chain import ChainResults
    from tmm_cli.results.digits import AccuracyReport

OK, CHECK_FAILED, BAD_INPUT = 0, 1, 2

Files = Annotated[list[str], typer.Argument(metavar="FILE...", help="Problem files (YAML).", show_default=False)]
Json = Annotated[bool, typer.Option("--json", help="Print result.json instead of tables.")]
Position = Annotated[
    list[int] | None,
    typer.Option("--position", "-p", min=0, help="Compute this position only (may be repeated).", show_default=False),
]
Digits = Annotated[
    bool,
    typer.Option("--digits", help="Show beside each value its bound by rounding and its sensitivity to the data."),
]
Out = Annotated[
    Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write tables there too.", show_default=False)
]


def console() -> Console:
    """For results: standard output, as wide as the tables need when it is not a terminal."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else 200, highlight=False, markup=False)


def say(text: str) -> None:
    """Talk goes to standard error."""
    typer.echo(text, err=True)


def each(
    files: Sequence[str], work: Callable[[str], int], *, as_json: bool = False, headed: bool = True,
    out: Path | None = None,
) -> NoReturn:  # fmt: skip
    """Do the work on every file, with a progress bar when there are several; exit with the worst code.

    out: where each of them has a folder of its name, so that no two may have the same. headed: the tables of each of
    several files come under its name. Bad input is one message and does not keep the other files from being worked on.
    """
    worst = OK
    if out is not None:
        _refuse_one_name(files)
    for file in _progress(files):
        if headed and len(files) > 1 and not as_json:
            console().print(f"== {file} ==", style="bold")
        try:
            with refusing(as_json, file):
                code = work(file)
        except typer.Exit as refused:
            code = refused.exit_code
        worst = max(worst, code)
    raise typer.Exit(worst)


@contextmanager
def refusing(as_json: bool = False, name: str = "") -> Iterator[None]:
    """Bad input inside is one message, with --json as JSON too. Raises typer.Exit.

    name: of what is read or written, where the system does not say it.
    """
    from tmm_cli.problem.errors import ProblemError

    try:
        yield
    except ProblemError as error:
        if as_json:
            emit_json({"error": error.to_dict()})
        say(_("error: {error}").format(error=error))
        raise typer.Exit(BAD_INPUT) from None
    except OSError as error:
        say(_("error: {error}").format(error=f"{error.filename or name}: {error.strerror}"))
        raise typer.Exit(BAD_INPUT) from None


def _refuse_one_name(files: Sequence[str]) -> None:
    """Files whose results would take the place of one another's end the command before its work."""
    from tmm_cli.results.files import folder_name

    first: dict[str, str] = {}
    for file in files:
        folder = folder_name(Path(file).stem)
        if folder in first and Path(first[folder]).resolve() != Path(file).resolve():
            say(
                _(
                    "error: {first} and {second} have one name, so that the results of both would go to the folder "
                    "{folder}: name them differently, or compute them one by one"
                ).format(first=first[folder], second=file, folder=folder)
            )
            raise typer.Exit(BAD_INPUT)
        first[folder] = file


def _progress(files: Sequence[Any]) -> Iterable[Any]:
    if len(files) < 2:
        return files
    from rich.console import Console
    from rich.progress import track

    return track(files, description="", console=Console(stderr=True), transient=True)


def solved(file: str, stage: Stage, positions: Sequence[int] | None, of: Sequence[str] = ()) -> Results:
    """Read and compute one file. Raises ProblemError."""
    from tmm_cli import load, solve

    return solve(load(file), stage, positions, of)


def emit_json(content: dict[str, Any]) -> None:
    """Pure JSON on standard output, one document a file."""
    sys.stdout.write(json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1) + "\n")


def emit_results(results: Results | ChainResults, digits: AccuracyReport | None = None) -> None:
    """The content of result.json on standard output, as it comes."""
    from tmm_cli.results.as_json import sections
    from tmm_cli.results.text import json_text

    sys.stdout.writelines(json_text(sections(results, digits)))


def bounds_of(results: Results, digits: bool) -> AccuracyReport | None:
    """How far each number is to be trusted, with `digits` in full; None where nothing moves."""
    if results.motion is None:
        return None
    from tmm_cli.results.digits import accuracy

    return accuracy(results, digits)


def report(results: Results, names: Iterable[str], as_json: bool, out: Path | None, digits: bool = False) -> int:
    """Show the results as tables or JSON, write the files if asked, say the warnings; the exit code.

    digits: show bounds and sensitivities beside the values.
    """
    found = bounds_of(results, digits)
    if as_json:
        emit_results(results, found)
    else:
        show(results, names, found)
    if out is not None:
        from tmm_cli.results.output import write_results

        say(_("written: {folder}").format(folder=write_results(results, out, digits=found)))
    if results.motion is not None:
        from tmm_cli.results.warnings import warnings

        for warning in warnings(results):
            say(_("warning: {warning}").format(warning=warning))
    return checked(results)


def checked(results: Results) -> int:
    """The exit code: whether the lever holds, and what a synthesis asked."""
    if results.motion is None:
        return OK  # of the structure alone there is nothing to check
    from tmm_cli.synthesis.check import measured_on

    return OK if results.lever_holds and all(m.met for m in measured_on(results)) else CHECK_FAILED


def write_pictures(results: Results, out: Path | None, pictures: Mapping[str, bytes]) -> None:
    """With the tables into the folder asked for; alone, and beside what a run has written, into the usual one."""
    from tmm_cli.results.files import folder_name, write_whole
    from tmm_cli.results.output import write_results

    if out is not None:
        say(_("written: {folder}").format(folder=write_results(results, out, pictures.items())))
    elif pictures:
        folder = Path("outputs") / folder_name(results.problem.name)
        for name, content in pictures.items():
            write_whole(folder / name, content)
        say(_("written: {folder}").format(folder=folder))


def show(results: Results, names: Iterable[str], found: AccuracyReport | None = None) -> None:
    """Tables of these names; of long ones the positions in detail (all of them when few were computed)."""
    from tmm_cli.results.reports import walk
    from tmm_cli.results.terminal import show as print_table

    screen = console()
    shown = walk(results, set(names))
    if found is not None:
        from tmm_cli.results.digits import beside, with_bounds

        shown = with_bounds(shown, found)
        shown = map(beside, shown) if found.full else shown
    for table in shown:
        print_table(table, results.problem.units, screen, detailed_rows(results, table) if table.long else None)


def detailed_rows(results: Results, table: Any) -> set[int]:
    """Rows of a long table that belong to positions in detail; the first position when there are none."""
    chosen = {results.numbers.index(n) for n in results.problem.request.detail if n in results.numbers}
    if len(results.numbers) == 1 or not chosen:
        chosen = {0}
    per = table.rows // max(len(results.numbers), 1)
    return {k * per + i for k in chosen for i in range(per)}
