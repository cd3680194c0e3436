"""Fields of result.json: one description gives both the content and its JSON Schema.

    STROKE = json_record("a stroke", JsonField("run", NUMBER, "signed"), JsonField("from", NUMBER, "...", "low"))

A field has a key, a type, a meaning and a source: a (dotted) attribute, or a function; by default the attribute with
the name of the key.
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
    """A JSON Schema, and the function that turns a result into JSON content. note: end of the description of such
    fields.
    """

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
    """Return the type of a list of items of one type."""
    return JsonType({"type": "array", "items": item.schema}, lambda found: [item.content(part) for part in found])


def map_of(value: JsonType) -> JsonType:
    """Return the type of an object with values of one type and any keys."""
    schema = {"type": "object", "additionalProperties": value.schema}
    return JsonType(schema, lambda found: {key: value.content(part) for key, part in found.items()})


def optional(shape: JsonType) -> JsonType:
    """Return the type of a value that may be null."""
    own = shape.schema["type"]
    schema = {**shape.schema, "type": own if "null" in own else [own, "null"]}
    return replace(shape, schema=schema, content=lambda found: None if found is None else shape.content(found))


@dataclass(frozen=True)
class JsonField:
    """A key of a JSON record.

    Attributes:
        key: the key.
        shape: type of its value.
        text: description in the schema.
        read: source of the value, see the module.
        there: condition for the key: a function, or an attribute that is not None. Default: always present.
    """

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
    """Yield key and content of each field that the result has."""
    return ((field.key, field.content(found)) for field in fields if field.is_there(found))


def field_schemas(fields: Iterable[JsonField]) -> dict[str, Any]:
    """Return the schemas of fields by their keys."""
    return {field.key: field.schema for field in fields}


def attribute_fields(attribute: str, fields: Iterable[JsonField]) -> tuple[JsonField, ...]:
    """Return fields that are read from an attribute of a record instead of the record itself."""
    part = attrgetter(attribute)
    return tuple(replace(f, shape=JsonType(f.shape.schema, f.content, f.shape.note), read=part) for f in fields)


def json_record(text: str, *fields: JsonField) -> JsonType:
    """Return the type of an object with these fields. text: description of the object."""
    schema = {"description": text, "type": "object", "properties": field_schemas(fields)}
    return JsonType(schema, lambda found: dict(record_items(fields, found)))


NAMES = list_of(TEXT)
_AXES = json_record(
    "a vector", JsonField("x", SERIES, "x component", "real"), JsonField("y", SERIES, "y component", "imag")
)
VECTOR = replace(_AXES, schema={**_AXES.schema, "required": ["x", "y"]})


def quantity_fields(quantities: Iterable[Quantity]) -> Iterator[JsonField]:
    """Yield the fields of quantities, each a series or a vector over the positions."""
    for quantity in quantities:
        shape = VECTOR if quantity.vector else SERIES
        text = f"{quantity.text}, {quantity.unit}" if quantity.unit else quantity.text
        yield JsonField(quantity.name, shape, text, quantity.value, quantity.there)
