"""The program `tmm` and its list of commands. The module of a command is imported only when the command is called."""

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
    """Add the requested command to the application; without a known one, add the names and help lines of all commands.

    Args:
        app: application or command group to which the commands are added.
        lines: help line of each command, by name. All are added if the command line names none of them, for `--help`
            and for the suggestion after a misspelt name.
        words: arguments of the command line.
        home: returns the name of the module in `tmm_cli.cli` that defines a command. The module has a function with the
            name of the command, or a function `group` that returns a group of commands for the remaining arguments.
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
    """Do nothing: placeholder for a command that appears only in the list of commands."""


# To add a command, write a function with its name in a module with its name (or in a module listed in HOMES), and add
# its help line here.


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
    "schemes": "Enumerate all schemes composed of Assur groups.",
    "synthesis": "Find the lengths of a mechanism from its requirements.",
    "sweep": "Show how quantities depend on one or two parameters.",
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

HOMES = {  # modules that define several commands
    **dict.fromkeys(("structure", "kinematics", "forces", "dynamics"), "stages"),
    **dict.fromkeys(("import", "export"), "other_programs"),
    **dict.fromkeys(("animate", "gallery"), "web_pages"),
}


def application(words: Sequence[str]) -> typer.Typer:
    """Create the application for a command line, with the requested command or with the names of all commands.

    Args:
        words: arguments of the command line, without the program name.
    """
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
    """Run the command line and exit. This is the entry point of the program."""
    warnings.simplefilter("ignore", RuntimeWarning)  # from NumPy: missing values are reported by our own messages
    gc.set_threshold(100_000)  # imports create many objects that live on; collecting them would waste time
    # the search for pydantic plugins reads the metadata of every installed package; none is needed
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    os.environ["MPLBACKEND"] = "agg"  # no window is opened, whatever the environment specifies
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
    """Prepare the standard streams.

    A closed stream is replaced by one that discards its output. Characters that the encoding of the terminal (e.g.
    cp866) lacks are printed as question marks.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding=None if os.environ.get("PYTHONIOENCODING") else "utf-8", errors="replace")


def _flush_output(code: Any) -> Any:
    """Flush standard output and return the exit code.

    A full disk is an error; a closed pipe (`tmm ... | head`) is not.
    """
    try:
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # else Python flushes again at exit
        if not isinstance(error, BrokenPipeError) and code in (OK, None):
            say(_os_error_text(error))
            return BAD_INPUT
    return code


def _os_error_text(error: OSError) -> str:
    return _("error: {error}").format(error=f"{printable(error.filename or _('output'))}: {error.strerror}")
