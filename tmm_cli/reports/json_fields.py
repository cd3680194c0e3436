"""How the parts of result.json look: one description gives both the content and its JSON Schema.

    STROKE = record("a stroke", Field("run", NUMBER, "of the output, signed"), Field("from", NUMBER, "...", "low"))

A field has its key, shape, meaning, and where it is read from: an attribute (of an attribute) or a function; without
one the attribute of the key's name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from typing import Any

from tmm_cli.mechanics.quantities import Quantity


@dataclass(frozen=True)
class JsonType:
    """A JSON Schema, and what makes the content of what was found. note: how descriptions of such fields end."""

    schema: dict[str, Any]
    content: Callable[[Any], Any] = lambda found: found
    note: str = ""


NUMBER = JsonType({"type": ["number", "null"]})
INTEGER = JsonType({"type": "integer"})
TEXT = JsonType({"type": "string"})
FLAG = JsonType({"type": "boolean"})
FLAGS = JsonType({"type": "array", "items": FLAG.schema}, note=", one value a position")
SERIES = JsonType({"type": "array", "items": NUMBER.schema}, note=", one value a position")


def list_of(item: JsonType) -> JsonType:
    """A list of what is iterable."""
    return JsonType({"type": "array", "items": item.schema}, lambda found: [item.content(part) for part in found])


def map_of(value: JsonType) -> JsonType:
    """An object with a value for each key of a mapping."""
    schema = {"type": "object", "additionalProperties": value.schema}
    return JsonType(schema, lambda found: {key: value.content(part) for key, part in found.items()})


def optional(shape: JsonType) -> JsonType:
    """Null where there is nothing."""
    own = shape.schema["type"]
    schema = {**shape.schema, "type": own if "null" in own else [own, "null"]}
    return replace(shape, schema=schema, content=lambda found: None if found is None else shape.content(found))


@dataclass(frozen=True)
class JsonField:
    """A key of a record. there: whether a record has it, if not always, or what it then has that is not None."""

    key: str
    shape: JsonType
    text: str
    read: str | Callable[[Any], Any] = ""
    there: str | Callable[[Any], bool] = lambda found: True

    @property
    def schema(self) -> dict[str, Any]:
        return {**self.shape.schema, "description": self.text + self.shape.note}

    def is_there(self, found: Any) -> bool:
        return self.there(found) if callable(self.there) else getattr(found, self.there) is not None

    @cached_property
    def reader(self) -> Callable[[Any], Any]:
        return self.read if callable(self.read) else attrgetter(self.read or self.key)

    def content(self, found: Any) -> Any:
        return self.shape.content(self.reader(found))


def record_items(fields: Iterable[JsonField], found: Any) -> Iterator[tuple[str, Any]]:
    """What was found, field by field; fields that it has not are left out."""
    return ((field.key, field.content(found)) for field in fields if field.is_there(found))


def field_schemas(fields: Iterable[JsonField]) -> dict[str, Any]:
    """The schemas of fields by their keys."""
    return {field.key: field.schema for field in fields}


def attribute_fields(attribute: str, fields: Iterable[JsonField]) -> tuple[JsonField, ...]:
    """The fields of what is an attribute of a record, as fields of that record."""
    part = attrgetter(attribute)
    return tuple(replace(f, shape=JsonType(f.shape.schema, f.content, f.shape.note), read=part) for f in fields)


def json_record(text: str, *fields: JsonField) -> JsonType:
    """An object with these keys. text: what it is, where it stands in a list or a map."""
    schema = {"description": text, "type": "object", "properties": field_schemas(fields)}
    return JsonType(schema, lambda found: dict(record_items(fields, found)))


NAMES = list_of(TEXT)
_AXES = json_record(
    "a vector", JsonField("x", SERIES, "x component", "real"), JsonField("y", SERIES, "y component", "imag")
)
VECTOR = replace(_AXES, schema={**_AXES.schema, "required": ["x", "y"]})


def quantity_fields(quantities: Iterable[Quantity]) -> Iterator[JsonField]:
    """The fields of quantities."""
    for quantity in quantities:
        shape = VECTOR if quantity.vector else SERIES
        text = f"{quantity.text}, {quantity.unit}" if quantity.unit else quantity.text
        yield JsonField(quantity.name, shape, text, quantity.value, quantity.there)
