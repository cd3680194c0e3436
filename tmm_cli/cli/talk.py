"""Messages of the command line: exit codes, printing to standard error, language of the output."""

from __future__ import annotations

import os
import re
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import typer

import tmm_cli
from tmm_cli.language import ENGLISH, USUAL, _, speak, spoken, write
from tmm_cli.problem import clean, escape_controls

OK, CHECK_FAILED, BAD_INPUT, FAULT = 0, 1, 2, 3
TRACEBACK = "TMM_TRACEBACK"  # environment variable: 1 prints the traceback of an internal fault
ADDRESS = re.compile(r"[a-z][a-z0-9+.-]+:[/\\]", re.IGNORECASE)  # s3://; one letter only is a drive

Language = Literal["en", "ru", "sr"]
Lang = Annotated[
    Language | None,
    typer.Option("--lang", envvar="TMM_LANG", help="Language, overrides that of the file.", show_default=False),
]

_requested_language: ContextVar[str | None] = ContextVar("requested_language", default=None)


def say(text: str) -> None:
    """Print a message to standard error, with control characters escaped."""
    typer.echo(escape_controls(text), err=True)


def warn(text: str) -> None:
    """Print a warning to standard error."""
    say(_("warning: {warning}").format(warning=text))


def printable(path: object) -> str:
    """Return a path as one line of text without control characters."""
    return clean(str(path), 300)


def report_fault(error: Exception, words: Sequence[str]) -> int:
    """Print one line that reports an internal error or a lack of memory, and return the exit code.

    The traceback is printed as well if the environment variable TMM_TRACEBACK is set.

    Args:
        error: exception that no other code has handled.
        words: arguments of the command line.
    """
    if os.environ.get(TRACEBACK, "0") not in ("", "0"):
        traceback.print_exception(error)
    if isinstance(error, MemoryError):
        say(_("error: not enough memory; reduce the number of positions, variants or drawings"))
        return FAULT
    place = _program_line(error)
    command = next((word for word in words if not word.startswith("-")), "")
    text = _(
        "internal error: {name} at {place} (tmm {version}, command {command}): please report this line and "
        "send the problem file; with {variable}=1 the traceback is printed"
    )
    name, version = type(error).__name__, tmm_cli.__version__
    say(text.format(name=name, place=place, version=version, command=clean(command, 40), variable=TRACEBACK))
    return FAULT


def _program_line(error: Exception) -> str:
    """Return the file and line of this program in which the error occurred, also if it occurred in a worker process."""
    remote = getattr(error.__cause__, "tb", "")  # text of the traceback in another process
    frames = re.findall(r'File "([^"]+)", line (\d+)', remote if isinstance(remote, str) else "")
    frames = frames or [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
    home = Path(tmm_cli.__file__).parent
    program_lines = [
        f"{Path(file).relative_to(home.parent).as_posix()}:{line}"
        for file, line in frames
        if home in Path(file).parents
    ]
    return program_lines[-1] if program_lines else "?"


def refuse_addresses(named: Mapping[str, Any]) -> None:
    """Refuse network addresses as output folders or files. Raises typer.Exit."""
    for name in ("out", "template", "junit"):
        path = named.get(name)
        if isinstance(path, Path) and ADDRESS.match(str(path)):
            address = re.sub(r"^([^:]+):[/\\]+", r"\1://", str(path))
            text = _("error: {address} is a network address; specify a local folder or file for the results")
            say(text.format(address=printable(address)))
            raise typer.Exit(BAD_INPUT)


def with_language_option(command: Callable[..., None]) -> Callable[..., None]:
    """Add the option --lang to a command. It takes precedence over the language of a file."""

    @wraps(command)
    def spoken_command(*arguments: Any, lang: Language | None = None, **named: Any) -> None:
        before = _requested_language.set(lang)
        try:
            with spoken(lang or ENGLISH):
                refuse_addresses(named)
                command(*arguments, **named)
        finally:
            _requested_language.reset(before)

    original = signature(command, eval_str=True)
    option = Parameter("lang", Parameter.KEYWORD_ONLY, default=None, annotation=Lang)
    shape = original.replace(parameters=[*original.parameters.values(), option])
    vars(spoken_command).update(__signature__=shape, __wrapped__=None)  # typer reads this signature
    spoken_command.__annotations__ = {name: parameter.annotation for name, parameter in shape.parameters.items()}
    return spoken_command


def use_file_language(language: object) -> None:
    """Switch to the language of a file, unless --lang was given."""
    if _requested_language.get() is None and language in get_args(Language):
        speak(str(language))


def use_file_notation(file: Mapping[str, object]) -> None:
    """Use the frame number and the symbol of inertia forces that the file specifies. The file need not be validated
    yet.
    """
    note = file.get("note")
    letter = note.get("inertia") if isinstance(note, dict) else ""
    write(str(file.get("frame", USUAL.frame)), str(letter))
