"""The JSON Schema of problem files, for editors."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel

from tmm_cli.problem.schema import File, Output, Tabulated
from tmm_cli.problem.schema_chain import SpatialFile
from tmm_cli.problem.schema_parts import OnLine


def file_schema(tasks: Iterable[type[BaseModel]]) -> dict[str, Any]:
    """Made by pydantic from the shape; models that have validators of their own around them are put in by name.

    tasks: the shapes of the blocks that may stand under `synthesis`.
    """
    schema = File.model_json_schema(by_alias=True)
    definitions = schema.setdefault("$defs", {})
    for model in (OnLine, Output, Tabulated, SpatialFile):
        inner = model.model_json_schema(by_alias=True)
        for name, definition in inner.pop("$defs", {}).items():
            definitions.setdefault(name, definition)
        definitions.setdefault(model.__name__, inner)
    shapes = [shape.model_json_schema(by_alias=True) for shape in tasks]
    for inner in shapes:
        for name, definition in inner.pop("$defs", {}).items():
            definitions.setdefault(name, definition)
    definitions["Synthesis"] = {"anyOf": shapes}
    whole = {
        "$defs": schema.pop("$defs"),
        "if": {"required": ["structure"]},
        "then": {"$ref": "#/$defs/SpatialFile"},
        "else": schema,
    }
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_referred(whole)}


def _referred(part: Any) -> Any:
    """The same schema with {"$comment": NAME} as a reference to the model NAME."""
    if isinstance(part, dict):
        if set(part) == {"$comment"}:
            return {"$ref": f"#/$defs/{part['$comment']}"}
        return {key: _referred(value) for key, value in part.items()}
    return [_referred(value) for value in part] if isinstance(part, list) else part
