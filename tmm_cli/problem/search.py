"""What the search of a file is for, without searching: for measurements of the search itself."""

from __future__ import annotations

from tmm_cli.problem import schema
from tmm_cli.problem.build import _Builder
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import Tree
from tmm_cli.problem.synthesis.build import asked
from tmm_cli.problem.units import UnitSystem
from tmm_cli.synthesis.optimal import Asked


def search_of(tree: Tree) -> Asked:
    """The task of a file with an optimal synthesis. Raises ProblemError."""
    shape = schema.File.model_validate(tree.data)
    builder = _Builder(shape.model_copy(update={"synthesis": None, "parameters": {}}), tree, extended=False)
    try:
        found = asked(shape.synthesis, shape.parameters, UnitSystem(shape.units), builder.variant)
    except ProblemError as error:
        raise error.located(tree.file, tree) from None
    assert isinstance(found, Asked)
    return found
