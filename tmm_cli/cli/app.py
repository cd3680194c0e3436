"""The command `tmm` and its list of commands. The module of a command is imported when it is called."""

from __future__ import annotations

import gc
import os
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from keyword import iskeyword
from typing import Annotated, Any

import typer

from tmm_cli import __version__
from tmm_cli.cli.talk import BAD_INPUT, OK, printable, report_fault, say, with_language_option
from tmm_cli.language import _


def add_commands(app: typer.Typer, lines: Mapping[str, str], words: Sequence[str], home: Callable[[str], str]) -> None:
    """Add the command that a command line requests, or the names and help lines of all.

    Args:
        lines: line of help of each command, by name. If no known command is requested all are listed, for help and
            for comparison with a misspelt name.
        words: the command line.
        home: gives the module of a command in `tmm_cli.cli`. It has a function of the command's name, or a function
            `group` that makes a group of commands from the further words.
    """
    requested = [word for word in words if not word.startswith("-")]
    if not requested or requested[0] not in lines:
        for name, line in lines.items():
            app.command(name, help=line)(_list_only)
        return
    name, *further = requested
    module = import_module(f"tmm_cli.cli.{home(name)}")
    function = f"{name}_" if iskeyword(name) else name
    if hasattr(module, function):
        app.command(name)(with_language_option(getattr(module, function)))
    else:
        app.add_typer(module.group(further))


def _list_only() -> None:
    """Placeholder of a command that is only listed."""


# The command `tmm`. A new command is a function of its name in the module of its name, or in one named in HOMES, and a
# line here.


COMMANDS = {
    "run": "Compute a problem; write tables, drawings, result.json.",
    "structure": "Show mobility, pairs, Assur groups, link names, contours.",
    "kinematics": "Show positions, velocities, accelerations.",
    "forces": "Show loads, reactions, balancing moment, Zhukovsky lever.",
    "dynamics": "Show the law of motion, motor, flywheel, balancing.",
    "check": "Recompute problems and compare with expected values.",
    "explain": "Explain how a file is understood and what is computed.",
    "new": "Start a problem file from a commented template.",
    "schema": "Print the JSON Schema of problem files, for editors.",
    "schemes": "Enumerate all schemes built of Assur groups.",
    "synthesis": "Find the lengths of a mechanism from its requirements.",
    "sweep": "Show quantities over parameters and feasible regions.",
    "variants": "Generate variants of a task for a group of students.",
    "grade": "Mark the submissions of a group of students.",
    "import": "Convert a file of another program to a problem file.",
    "export": "Write the linkage of a problem for another program.",
    "sheets": "Draw framed sheets to scale, as PDF or DXF.",
    "note": "Write the explanatory note with formulas and numbers.",
    "animate": "Write a web page with the moving mechanism.",
    "gallery": "Write a web page with many moving mechanisms.",
    "bench": "Measure speed, accuracy, stability, savings, synthesis.",
}

HOMES = {  # modules of commands that share one
    **dict.fromkeys(("structure", "kinematics", "forces", "dynamics"), "stages"),
    **dict.fromkeys(("import", "export"), "other_programs"),
    **dict.fromkeys(("animate", "gallery"), "web_pages"),
}


def application(words: Sequence[str]) -> typer.Typer:
    """Return the application with the command that a command line requests, or with the names of all commands."""
    app = typer.Typer(
        name="tmm",
        help="Calculator for course projects on planar linkages (theory of mechanisms and machines).",
        no_args_is_help=True,
        context_settings={"help_option_names": ["-h", "--help"]},
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
    )
    app.callback()(_options)
    add_commands(app, COMMANDS, words, lambda name: HOMES.get(name, name))
    return app


def _version(requested: bool) -> None:
    if requested:
        typer.echo(f"tmm {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line."""
    warnings.simplefilter("ignore", RuntimeWarning)  # of numbers: what has no value is said in the product's own words
    gc.set_threshold(100_000)  # a short run makes little rubbish, and importing makes much that only looks like it
    # looking for plugins of pydantic reads every installed package; there is nothing here for them to do
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    os.environ["MPLBACKEND"] = "agg"  # whatever the environment has: no window is opened
    _open_streams()
    try:
        application(sys.argv[1:])()
    except SystemExit as ended:
        left = isinstance(ended.__context__, BrokenPipeError)  # `tmm ... | head` is not an error
        sys.exit(_flush_output(OK if left else ended.code))
    except OSError as error:
        say(_os_error_text(error))
        sys.exit(_flush_output(BAD_INPUT))
    except Exception as error:
        sys.exit(_flush_output(report_fault(error, sys.argv[1:])))


def _open_streams() -> None:
    """Prepare the standard streams: a closed one discards output; unencodable characters (cp866) become question
    marks.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding=None if os.environ.get("PYTHONIOENCODING") else "utf-8", errors="replace")


def _flush_output(code: Any) -> Any:
    """Return the exit code after flushing output: a full disk is an error, a reader that has left is none."""
    try:
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or Python tries once more, and complains
        if not isinstance(error, BrokenPipeError) and code in (OK, None):
            say(_os_error_text(error))
            return BAD_INPUT
    return code


def _os_error_text(error: OSError) -> str:
    return _("error: {error}").format(error=f"{printable(error.filename or _('output'))}: {error.strerror}")
