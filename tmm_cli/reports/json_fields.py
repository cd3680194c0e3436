"""Fields of result.json: one description gives both the content and its JSON Schema.

    STROKE = json_record("a stroke", JsonField("run", NUMBER, "signed"), JsonField("from", NUMBER, "...", "low"))

A field has a key, a type, a description and a source of its value. The source is an attribute of the result (dotted for
an attribute of an attribute), or a function of the result. By default it is the attribute with the name of the key.
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
    """A type of JSON content.

    Attributes:
        schema: JSON Schema of the type.
        content: function that turns a result into JSON content.
        note: text appended to the description of every field of this type.
    """

    schema: dict[str, Any]
    content: Callable[[Any], Any] = lambda found: found
    note: str = ""


NUMBER = JsonType({"type": ["number", "null"]})
INTEGER = JsonType({"type": "integer"})
TEXT = JsonType({"type": "string"})
FLAG = JsonType({"type": "boolean"})
FLAGS = JsonType({"type": "array", "items": FLAG.schema}, note=", one value per position")
SERIES = JsonType({"type": "array", "items": NUMBER.schema}, note=", one value per position")


def list_of(item: JsonType) -> JsonType:
    """Return the type of a list whose items have the given type."""
    return JsonType({"type": "array", "items": item.schema}, lambda items: [item.content(element) for element in items])


def map_of(value: JsonType) -> JsonType:
    """Return the type of an object with arbitrary keys whose values have the given type."""
    schema = {"type": "object", "additionalProperties": value.schema}
    return JsonType(schema, lambda mapping: {key: value.content(element) for key, element in mapping.items()})


def optional(shape: JsonType) -> JsonType:
    """Return the type of a value that may be null."""
    kind = shape.schema["type"]
    schema = {**shape.schema, "type": kind if "null" in kind else [kind, "null"]}
    return replace(shape, schema=schema, content=lambda content: None if content is None else shape.content(content))


@dataclass(frozen=True)
class JsonField:
    """A key of a JSON object, with the type and the source of its value.

    Attributes:
        key: the key.
        shape: type of the value.
        text: description in the schema.
        read: source of the value: a (dotted) attribute or a function; by default, the attribute named like the key.
        there: condition for writing the key: a function that returns True, or the name of an attribute that is not
            None. By default the key is always written.
    """

    key: str
    shape: JsonType
    text: str
    read: str | Callable[[Any], Any] = ""
    there: str | Callable[[Any], bool] = lambda found: True

    @property
    def schema(self) -> dict[str, Any]:
        return {**self.shape.schema, "description": self.text + self.shape.note}

    def applies_to(self, record: Any) -> bool:
        return self.there(record) if callable(self.there) else getattr(record, self.there) is not None

    @cached_property
    def reader(self) -> Callable[[Any], Any]:
        return self.read if callable(self.read) else attrgetter(self.read or self.key)

    def content(self, record: Any) -> Any:
        return self.shape.content(self.reader(record))


def record_items(fields: Iterable[JsonField], record: Any) -> Iterator[tuple[str, Any]]:
    """Yield the key and the content of each field of a JSON object, for a given result.

    A field is omitted if its condition (`there`) is not fulfilled.
    """
    return ((field.key, field.content(record)) for field in fields if field.applies_to(record))


def field_schemas(fields: Iterable[JsonField]) -> dict[str, Any]:
    """Return the JSON Schemas of fields, by key."""
    return {field.key: field.schema for field in fields}


def attribute_fields(attribute: str, fields: Iterable[JsonField]) -> tuple[JsonField, ...]:
    """Return copies of the fields of a nested record.

    The copies read their values from an attribute of the outer record, e.g. `energy`.
    """
    reader = attrgetter(attribute)

    def moved(field: JsonField) -> JsonField:
        content = JsonType(field.shape.schema, field.content, field.shape.note)
        return replace(field, shape=content, read=reader, there=lambda record: field.applies_to(reader(record)))

    return tuple(moved(field) for field in fields)


def json_record(text: str, *fields: JsonField) -> JsonType:
    """Return the type of a JSON object with the given fields. text: description of the object in the schema."""
    schema = {"description": text, "type": "object", "properties": field_schemas(fields)}
    return JsonType(schema, lambda record: dict(record_items(fields, record)))


NAMES = list_of(TEXT)
_AXES = json_record(
    "a vector", JsonField("x", SERIES, "x component", "real"), JsonField("y", SERIES, "y component", "imag")
)
VECTOR = replace(_AXES, schema={**_AXES.schema, "required": ["x", "y"]})


def quantity_fields(quantities: Iterable[Quantity]) -> Iterator[JsonField]:
    """Yield the JSON fields of quantities: for each a series over the positions, or for a vector two series, x and
    y.
    """
    for quantity in quantities:
        shape = VECTOR if quantity.vector else SERIES
        text = f"{quantity.text}, {quantity.unit}" if quantity.unit else quantity.text
        yield JsonField(quantity.name, shape, text, quantity.value, quantity.there)
