"""What every file of the command line leans on: exit codes, where talk goes, and in which language."""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from functools import wraps
from inspect import Parameter, signature
from typing import Annotated, Any, Literal, get_args

import typer

from tmm_cli.language import ENGLISH, _, speak, spoken

OK, CHECK_FAILED, BAD_INPUT = 0, 1, 2

Language = Literal["en", "ru", "sr"]
Lang = Annotated[
    Language | None,
    typer.Option("--lang", envvar="TMM_LANG", help="Language, whatever the file says.", show_default=False),
]

_asked_for: ContextVar[str | None] = ContextVar("asked_for", default=None)


def say(text: str) -> None:
    """Talk goes to standard error."""
    typer.echo(text, err=True)


def warn(text: str) -> None:
    """Say a warning."""
    say(_("warning: {warning}").format(warning=text))


def speaking(command: Callable[..., None]) -> Callable[..., None]:
    """The command with an option for the language; it goes before what a file says."""

    @wraps(command)
    def spoken_command(*arguments: Any, lang: Language | None = None, **named: Any) -> None:
        before = _asked_for.set(lang)
        try:
            with spoken(lang or ENGLISH):
                command(*arguments, **named)
        finally:
            _asked_for.reset(before)

    known = signature(command, eval_str=True)
    option = Parameter("lang", Parameter.KEYWORD_ONLY, default=None, annotation=Lang)
    shape = known.replace(parameters=[*known.parameters.values(), option])
    vars(spoken_command).update(__signature__=shape, __wrapped__=None)  # typer reads the shape, and looks no further
    spoken_command.__annotations__ = {name: one.annotation for name, one in shape.parameters.items()}
    return spoken_command


def speak_as(language: object) -> None:
    """Speak the language of a file from here on, unless the command was asked for another."""
    if _asked_for.get() is None and language in get_args(Language):
        speak(str(language))
