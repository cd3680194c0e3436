"""Keys for the title block of sheets and for the style of the calculation note."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from tmm_cli.problem.schema_types import NAMES, Strict

MAX_TEXT_LENGTH = 200


def _checked_short_text(raw: Any) -> str:
    """Return a text of one line; a number is converted to text, as the name of a student group may be a number."""
    if isinstance(raw, bool) or not isinstance(raw, int | str):
        raise PydanticCustomError("words", "expected a text")
    if len(str(raw)) > MAX_TEXT_LENGTH:
        raise PydanticCustomError("words", f"text is at most {MAX_TEXT_LENGTH} characters long")
    return str(raw)


ShortText = Annotated[str, BeforeValidator(_checked_short_text), WithJsonSchema({"anyOf": NAMES})]


class SheetTexts(Strict):
    """Texts of the title block. A text that is too long for its cell is cut off."""

    student: ShortText = Field(default="", description="name of the student, in the title block")
    group: ShortText = Field(default="", description="group of the student")
    teacher: ShortText = Field(default="", description="name of the teacher, in the title block")
    institution: ShortText = Field(default="", description="university, on the title page of the calculation note")
    department: ShortText = Field(default="", description="university and department, in the title block")
    code: ShortText = Field(
        default="", description="designation of the project; the number of the sheet is added to it"
    )
    block: Literal["gost", "plain"] = Field(
        default="gost", description="form of the title block. gost: GOST 2.104, form 1; plain: a simple title block"
    )


class NoteStyle(Strict):
    """Style of the calculation note. The defaults are those usual in courses."""

    inertia: Literal["U", "Φ"] | None = Field(
        default=None,
        description="letter for inertia forces; default: the usual letter in the language (Φ in Russian)",
    )
    arms: Literal["m", "paper"] = Field(
        default="m",
        description="moment arms in equations. m: in metres; paper: in millimetres of the drawing, with the scale mu_l",
    )
    sections: Literal["usual", "MATI"] = Field(
        default="usual",
        description=(
            "order of the force analysis. usual: the common order; MATI: steps 1 to 4 of the MATI guidelines, "
            "then the Zhukovsky lever"
        ),
    )
