"""Commands are imported when they are called: a file each, whose imports stand at its top and cost no other command."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from keyword import iskeyword

import typer

from tmm_cli.cli.talk import speaking


def add_commands(app: typer.Typer, package: str, lines: Mapping[str, str], words: Sequence[str]) -> None:
    """Of the commands of a package, each with its line of help, the one that the words of a command line ask for.

    It is the function, or the group made by `group` of the further words, in the module of its name. Where none is
    asked for, all get their names and lines, as help lists them and a slip is compared with them.
    """
    asked = [word for word in words if not word.startswith("-")]
    if not asked or asked[0] not in lines:
        for name, line in lines.items():
            app.command(name, help=line)(_listed)
        return
    name, *further = asked
    own = f"{name}_" if iskeyword(name) else name
    module = import_module(f"{package}.{own}")
    if hasattr(module, "group"):
        app.add_typer(module.group(further))
    else:
        app.command(name)(speaking(getattr(module, own)))


def _listed() -> None:
    """What is listed only is not called."""
