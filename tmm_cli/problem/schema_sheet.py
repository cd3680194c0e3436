"""The shapes of the blocks `sheet` and `note`: texts of the title block, and how the course writes its notes."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from tmm_cli.problem.schema_parts import NAMES, Strict

LONGEST = 200


def _words(found: Any) -> str:
    """A line of text; the number of a group may be written as a number."""
    if isinstance(found, bool) or not isinstance(found, int | str):
        raise PydanticCustomError("words", "text is wanted")
    if len(str(found)) > LONGEST:
        raise PydanticCustomError("words", f"text is at most {LONGEST} characters long")
    return str(found)


Words = Annotated[str, BeforeValidator(_words), WithJsonSchema({"anyOf": NAMES})]


class SheetTexts(Strict):
    """Texts of the title block. One that is too long for its cell is cut there."""

    student: Words = Field(default="", description="who drew it")
    group: Words = Field(default="", description="the student's group")
    teacher: Words = Field(default="", description="who checks it")
    institution: Words = Field(default="", description="the university, on the title page of the note")
    department: Words = Field(default="", description="the university and its department")
    code: Words = Field(default="", description="designation of the project; the number of the sheet is added to it")
    block: Literal["gost", "plain"] = Field(default="gost", description="GOST 2.104 form 1, or a plain one")


class NoteStyle(Strict):
    """How the course writes: of the choices each is the usual one where the file leaves it out."""

    inertia: Literal["U", "Φ"] | None = Field(
        default=None,
        description="letter of inertia forces; left out: that of the language (in Russian Φ)",
    )
    arms: Literal["m", "paper"] = Field(
        default="m",
        description="arms in equations of moments: in metres, or in millimetres of the drawing with its scale mu_l",
    )
    sections: Literal["usual", "MATI"] = Field(
        default="usual", description="MATI: the force analysis in the steps 1 to 4 of the guidelines, before the lever"
    )
