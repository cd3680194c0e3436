"""Command `tmm schema`: prints the JSON Schema of problem files or of result.json."""

from __future__ import annotations

from typing import Annotated

import typer

from tmm_cli.batch import Blocks
from tmm_cli.cli.common import emit_json
from tmm_cli.problem import file_schema
from tmm_cli.reports import schema as result_schema
from tmm_cli.synthesis import TASKS, block_module


def schema(
    result: Annotated[bool, typer.Option("--result", help="Print the schema of result.json instead.")] = False,
) -> None:
    """Print the JSON Schema of problem files, for editors."""
    if result:
        emit_json(result_schema())
    else:
        emit_json(file_schema((block_module(task).BLOCK for task in TASKS), Blocks))
