"""problems/docs/COMMANDS.md: every command with its arguments and options, from the help texts of the program."""

from __future__ import annotations

import inspect
import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, get_args, get_origin
from unittest import mock

import typer
import typer.models

from tmm_cli.cli import COMMANDS, MEASUREMENTS, application

HEAD = """# Reference: commands

Every command with its arguments and options. `python -m tests.documentation` writes this page from the help texts that
`tmm COMMAND --help` prints; tasks are explained in the [how-to pages](README.md).

## Exit codes

| code | meaning |
| --- | --- |
| 0 | done |
| 1 | done, but a check failed: a limit of `checks`, an `expected` value, a file of a group or of a bank |
| 2 | input that cannot be used: one message with the place, what was found and what is allowed |
| 3 | an internal fault (one line to report), or too little memory |

## Environment

| variable | meaning |
| --- | --- |
| `TMM_LANG` | language of messages, tables and drawings: `en`, `ru` or `sr`; `--lang` and `lang:` in a file go first |
| `TMM_TRACEBACK` | `1` prints the traceback of an internal fault |
| `NO_COLOR` | any value: no colours on a terminal |

Results are printed on standard output, warnings and messages on standard error.

"""


def lines() -> Iterator[str]:
    """The page."""
    yield HEAD
    yield "## All commands\n\n| command | what it does |\n| --- | --- |\n"
    for name, line in COMMANDS.items():
        yield f"| [`tmm {name}`](#tmm-{name}) | {line} |\n"
    with mock.patch.dict(os.environ, {"TMM_LANG": "en"}):
        for name in COMMANDS:
            yield from _section(f"tmm {name}", _command(name))
            for measurement in MEASUREMENTS if name == "bench" else ():
                yield from _section(f"tmm bench {measurement}", _command("bench", measurement))


def escaped(text: str) -> str:
    """A text on one line of Markdown."""
    return " ".join(text.split()).replace("|", "\\|").replace("<", "\\<")


def _command(*words: str) -> Any:
    """The function of a command, or the group of commands."""
    app = application(words)
    for __ in words[1:]:
        app = app.registered_groups[0].typer_instance
    return app.registered_commands[0].callback if app.registered_commands else app.registered_groups[0].typer_instance


@dataclass(frozen=True)
class Row:
    """An argument or an option: how it is written, its default, its meaning."""

    written: str
    default: str
    meaning: str
    argument: bool


def _section(title: str, command: Any) -> Iterator[str]:
    group = isinstance(command, typer.Typer)
    rows = [] if group else list(_rows(command))
    text = command.info.help if group else inspect.getdoc(command)
    arguments = [row.written for row in rows if row.argument]
    yield f"\n## {title}\n\n"
    options = ["[OPTIONS]"] if len(arguments) < len(rows) else []
    yield f"```text\n{' '.join([title, *options, *arguments])}\n```\n\n"
    yield "".join(f"{escaped(part)}\n\n" for part in (text or "").split("\n\n"))
    if rows:
        yield "| argument or option | default | meaning |\n| --- | --- | --- |\n"
    for row in sorted(rows, key=lambda row: not row.argument):
        written = f"`{row.written}`" if row.argument else row.written
        yield f"| {written} | {row.default} | {row.meaning} |\n"


def _rows(function: Any) -> Iterator[Row]:
    """What a command takes, from the annotations of its function: those typer reads."""
    for name, one in inspect.signature(function).parameters.items():
        kind, info = get_args(one.annotation)[:2]
        argument = isinstance(info, typer.models.ArgumentInfo)
        kind = next((way for way in get_args(kind) if way is not type(None)), kind) if _optional(kind) else kind
        several = get_origin(kind) is list
        item = get_args(kind)[0] if several else kind
        required = one.default in (inspect.Parameter.empty, ...)
        if argument:
            written = f"{(info.metavar or name).upper().removesuffix('...')}{'...' if several else ''}"
            written = written if required else f"[{written}]"
        else:
            options = [part for part in (info.default, *(info.param_decls or ())) if str(part).startswith("-")]
            plain = f"--{name.replace('_', '-')}"
            options = options or ([f"{plain}/--no-{plain[2:]}"] if item is bool else [plain])
            written = ", ".join(f"`{option}`" for option in sorted(dict.fromkeys(options), key=len))
            written = written.replace("/", "` / `") + ("" if item is bool else f" `{_value(item, info)}`")
        text = escaped(info.help or "")
        text += " May be repeated." if several and not argument and "repeated" not in text else ""
        yield Row(written, "required" if required else _default(one.default), text, argument)


def _optional(kind: Any) -> bool:
    return get_origin(kind) is not Literal and type(None) in get_args(kind)


def _value(kind: Any, info: Any) -> str:
    if get_origin(kind) is Literal:
        return "\\|".join(get_args(kind))
    words = {int: "N", float: "NUMBER"}.get(kind, "TEXT")
    return str(info.metavar or words)


def _default(default: Any) -> str:
    if default is True:
        return "yes"
    return "-" if default in (None, False, (), [], "") else f"`{default}`"
