"""The JSON Schema of problem files, for editors."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel

from tmm_cli.problem.schema import File
from tmm_cli.problem.schema_chain import SpatialFile


def file_schema(tasks: Iterable[type[BaseModel]], blocks: type[BaseModel]) -> dict[str, Any]:
    """Made by pydantic from the shapes; tasks: those of the blocks that may stand under `synthesis`; blocks: further
    ones of a file, by their names."""
    definitions: dict[str, Any] = {}

    def schema(model: type[BaseModel]) -> dict[str, Any]:
        inner = model.model_json_schema(by_alias=True)
        definitions.update({**inner.pop("$defs", {}), **definitions})
        return inner

    planar = schema(File)
    planar["properties"]["synthesis"]["anyOf"] = [{"$ref": "#/$defs/Synthesis"}]
    planar["properties"] |= schema(blocks)["properties"]
    definitions["SpatialFile"] = schema(SpatialFile)
    definitions["Synthesis"] = {"anyOf": [schema(task) for task in tasks]}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$defs": definitions,
        "if": {"required": ["structure"]},
        "then": {"$ref": "#/$defs/SpatialFile"},
        "else": planar,
    }
