"""The JSON Schema of problem files, for editors."""

from __future__ import annotations

from typing import Any

from tmm_cli.problem.schema import File, OnLine, Output, Tabulated
from tmm_cli.problem.schema_chain import SpatialFile
from tmm_cli.problem.schema_more import Cam, Friction, Gear, Rack, Spring
from tmm_cli.problem.synthesis import reader
from tmm_cli.synthesis import TASKS


def file_schema() -> dict[str, Any]:
    """Made by pydantic from the shape; models that have validators of their own around them are put in by name."""
    schema = File.model_json_schema(by_alias=True)
    definitions = schema.setdefault("$defs", {})
    for model in (OnLine, Output, Tabulated, SpatialFile, Gear, Rack, Cam, Spring, Friction):
        inner = model.model_json_schema(by_alias=True)
        for name, definition in inner.pop("$defs", {}).items():
            definitions.setdefault(name, definition)
        definitions.setdefault(model.__name__, inner)
    tasks = [reader(task).Shape for task in TASKS]
    for shape in tasks:
        inner = shape.model_json_schema(by_alias=True)
        for name, definition in inner.pop("$defs", {}).items():
            definitions.setdefault(name, definition)
    shapes = [{k: v for k, v in s.model_json_schema(by_alias=True).items() if k != "$defs"} for s in tasks]
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
