"""Other programs, measured if installed (pip install tmm-cli[bench]). To add one, write a module and list it here."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from tmm_cli.bench.methods.case import Method

RIVALS = ("pylinkage", "kinepy")


def list_installed() -> tuple[tuple[Method, ...], tuple[str, ...]]:
    """Return the methods of the other programs that are installed, and the names of the programs that are not
    installed.
    """
    there = [name for name in RIVALS if find_spec(name) is not None]
    methods = [import_module(f"tmm_cli.bench.rivals.{name}_rival").METHOD for name in there]
    return tuple(methods), tuple(name for name in RIVALS if name not in there)
