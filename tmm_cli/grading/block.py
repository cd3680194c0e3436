"""The blocks `variants` and `grading` of a task's file: what is free in it, what is asked, and how it is marked."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_parts import Name, Strict, Value
from tmm_cli.synthesis.optimal.block_ranges import Range

MOST_ANSWERS = 200


def _listed(found: object) -> object:
    return [found] if isinstance(found, int | str) else found


class AnswerRule(Strict):
    """A quantity that is asked, at one position or several."""

    of: str = Field(max_length=40, description="v of E, a of S3, omega of 3, R_34, M_b, W, class, H, k")
    at: Annotated[list[int], BeforeValidator(_listed)] = Field(
        default_factory=list,
        max_length=120,
        description="positions, as the students count them; none for H, k, W, class",
    )
    points: Value = Field(default=1, description="for each position")
    tolerance: Value | None = Field(default=None, description="share of the largest value in the cycle, e.g. 3 %")
    drawn: bool | None = Field(default=None, description="measured off a drawing; else computed")


class Grading(Strict):
    """What students are asked, and how it is marked."""

    answers: list[AnswerRule] = Field(min_length=1, max_length=MOST_ANSWERS)
    count: int = Field(default=0, ge=0, le=1, description="number of the first position on the students' sheets")
    from_: Literal["task", "either"] = Field(
        default="task",
        alias="from",
        description="positions are counted as in the task, or from either extreme position of the output",
    )
    drawn: bool = Field(default=True, description="answers are measured off drawings; false: computed")
    reveal: bool = Field(default=False, description="whether students are told the right values")


class Blocks(Strict):
    """The two blocks, as they stand in a file."""

    variants: dict[Name, Range] = Field(default_factory=dict, max_length=20)
    grading: Grading | None = None
