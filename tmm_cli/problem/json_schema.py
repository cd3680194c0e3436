"""The JSON Schema of problem files, for editors."""

from __future__ import annotations

from typing import Any

from tmm_cli.problem.schema import File, OnLine, Tabulated


def file_schema() -> dict[str, Any]:
    """Made by pydantic from the shape; the parts that are read by their own validators are added by name."""
    schema = File.model_json_schema(by_alias=True)
    definitions = schema.setdefault("$defs", {})
    for model in (OnLine, Tabulated):
        definitions.setdefault(model.__name__, model.model_json_schema(by_alias=True))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
