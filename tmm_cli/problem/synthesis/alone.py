"""A file with a synthesis and no linkage."""

from __future__ import annotations

from pathlib import PurePath

from pydantic import ValidationError

from tmm_cli.problem.errors import ProblemError, nearest, quote
from tmm_cli.problem.reader import Tree
from tmm_cli.problem.record import Synthesised
from tmm_cli.problem.synthesis import SynthesisFile
from tmm_cli.problem.synthesis.build import with_synthesis
from tmm_cli.problem.units import UnitSystem
from tmm_cli.synthesis import TASKS


def no_block(tree: Tree, message: str) -> ProblemError:
    """The refusal of a file without a synthesis, at the key that was perhaps meant to be one."""
    meant = next((key for key in tree.data if nearest(key, ["synthesis"]) is not None), None)
    allowed = f"synthesis: {{task: ...}}, one of {', '.join(TASKS)}"
    if meant is None:
        return ProblemError(message, allowed=allowed, file=tree.file)
    error = ProblemError(
        "unknown key", path=(meant,), found=quote(meant), allowed=allowed, near="synthesis", key=True
    )  # fmt: skip
    return error.located(tree.file, tree)


def alone(tree: Tree) -> tuple[str, str, Synthesised, UnitSystem]:
    """Name, title, what was found, units. Raises ProblemError."""
    try:
        shape = SynthesisFile.model_validate(tree.data)
    except ValidationError as error:
        from tmm_cli.problem.refusals import shape_error

        raise shape_error(error, tree) from None
    name = PurePath(tree.file).stem
    try:
        try:
            units = UnitSystem(shape.units)
        except ProblemError as error:
            raise error.at("units") from None
        _, found = with_synthesis(shape.synthesis, shape.parameters, units)
    except ProblemError as error:
        raise error.located(tree.file, tree) from None
    return name, shape.title or name, found, units
