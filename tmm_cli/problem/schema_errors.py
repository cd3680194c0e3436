"""Messages for pydantic's validation errors in the terms of the file. Keys in Russian or Serbian are recognised."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from tmm_cli.language import N_, _
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, Tree, nearest_name, quote
from tmm_cli.problem.reader import decimal_comma_hint

_TRANSLATED_KEYS: Final = {
    "title": "название заголовок naslov naziv",
    "description": "описание opis",
    "units": "единицы jedinice",
    "parameters": "параметры parametri",
    "synthesis": "синтез sinteza",
    "points": "точки tačke tacke",
    "guides": "направляющие vođice vodice",
    "links": "звенья članovi clanovi чланови",
    "link": "звено član clan члан",
    "driver": "привод двигатель pogon",
    "gears": "колёса колеса шестерни zupčanici zupcanici",
    "racks": "рейки letve",
    "cams": "кулачки bregovi",
    "springs": "пружины opruge",
    "dampers": "демпферы prigušivači prigusivaci",
    "friction": "трение trenje",
    "sketch": "эскиз схема skica",
    "masses": "массы mase",
    "mass": "масса masa",
    "loads": "нагрузки силы opterećenja opterecenja",
    "gravity": "тяжесть gravitacija",
    "output": "выход izlaz",
    "positions": "положения položaji polozaji",
    "checks": "проверки provere",
    "sheet": "лист",
    "student": "студент",
    "group": "группа grupa",
    "teacher": "преподаватель руководитель nastavnik profesor",
    "institution": "университет институт вуз univerzitet fakultet",
    "department": "кафедра katedra",
    "code": "шифр обозначение oznaka",
    "length": "длина dužina duzina",
    "name": "имя ime",
    "speed": "скорость brzina",
    "slides": "скользит ползун klizi klizač",
    "along": "вдоль duž duz",
    "angle": "угол ugao",
    "force": "сила sila",
    "moment": "момент moment",
    "weight": "вес težina tezina",
    "inertia": "инерция inercija",
    "centre": "центр centar težište",
    "count": "число количество broj",
    "turns": "вращение smer",
    "task": "задача zadatak",
}
KEYS_IN_OTHER_LANGUAGES: Final = {word: key for key, words in _TRANSLATED_KEYS.items() for word in words.split()}


KEYS_EXPECTED = N_("expected keys with values")
MESSAGES = {  # messages by pydantic's type of error
    "int": N_("expected a whole number"),
    "greater_than_equal": N_("expected a number not less than {ge}"),
    "less_than_equal": N_("expected a number not greater than {le}"),
    "too_long": N_("there are too many items or characters; at most {max_length} are allowed"),
    "string_too_long": N_("there are too many items or characters; at most {max_length} are allowed"),
    "too_short": N_("there are too few items; at least {min_length} are required here"),
    "empty": N_("a value is required here, but nothing is given"),
    "string_type": N_("expected a text"),
    "list_type": N_("expected a list [..., ...]"),
    "dict_type": KEYS_EXPECTED,
    "model_type": KEYS_EXPECTED,
    "model_attributes_type": KEYS_EXPECTED,
}


def shape_error(error: ValidationError, tree: Tree, model: type[BaseModel], prefix: Path = ()) -> ProblemError:
    """Convert the validation error that comes first in the file to a ProblemError with line and column.

    Args:
        error: validation error of pydantic.
        tree: content of the file.
        model: model that was validated.
        prefix: path of the validated value in the file; () for the whole file.
    """
    meant: list[tuple[str, ProblemError]] = []
    others: list[tuple[str, ProblemError]] = []
    for kind, loc, context in _flatten_errors(error, prefix):
        path, value, fits = _find_value(tree.data, loc, kind)
        inside = path[: len(prefix)] == prefix and len(path) > len(prefix)
        fields = _find_fields(model, path[len(prefix) :]) if inside else _find_fields(schema.File, path)
        refusal = _make_error(kind, path, value, context, fields, decimal_comma_hint(tree, path))
        (meant if fits else others).append((kind, refusal))
    refusals = meant or others
    misspelt = {(*r.path[:-1], r.near) for kind, r in refusals if kind == "extra_forbidden"}
    # a misspelt key is not missing
    located = [r.located(tree.file, tree) for kind, r in refusals if kind != "missing" or r.path not in misspelt]
    return min(located, key=lambda r: (r.mark.line, r.mark.column) if r.mark else (0, 0))


def _flatten_errors(error: ValidationError, prefix: Path) -> Iterable[tuple[str, Path, dict[str, Any]]]:
    for item in error.errors():
        inner = item.get("ctx", {}).get("error")
        if isinstance(inner, ValidationError):
            yield from _flatten_errors(inner, (*prefix, *item["loc"]))
        else:
            yield item["type"], (*prefix, *item["loc"]), {**item.get("ctx", {}), "msg": item["msg"]}


def _find_value(data: Any, loc: Sequence[str | int], kind: str) -> tuple[Path, Any, bool]:
    """Find the value to which a validation error of pydantic refers.

    Returns:
        Path in the file, value at this path, and True if the value has the type that pydantic tried when the error
        occurred (a field may allow several types).
    """
    path: list[str | int] = []
    fits = True
    step: Any
    for number, step in enumerate(loc, 1):
        if step in data if isinstance(data, dict) else isinstance(data, list) and isinstance(step, int):
            path.append(step)
            data = data[step]
        elif kind == "missing" and number == len(loc):
            path.append(step)
        else:  # the name of a union's branch
            fits = fits and isinstance(data, list) == str(step).startswith("list")
    return tuple(path), data, fits


def _find_fields(model: type[BaseModel] | None, path: Path) -> tuple[dict[str, FieldInfo], FieldInfo | None]:
    """Return the keys that are allowed at the end of a path, and the pydantic field of its last key.

    An item of a list has the field of the list.
    """
    while path and isinstance(path[-1], int):
        path = path[:-1]
    named = False  # whether the next key is one of the user's own names
    for step in path[:-1]:
        if isinstance(step, int) or model is None or named:
            named = False
            continue
        field = model.model_fields.get(step)
        model = None if field is None else _find_model([field.annotation])
        named = field is not None and get_origin(field.annotation) is dict
    fields = {field.alias or name: field for name, field in model.model_fields.items()} if model else {}
    return fields, fields.get(str(path[-1])) if path else None


def _find_model(parts: Iterable[Any]) -> type[BaseModel] | None:
    """Return the first pydantic model that a type annotation contains, or None."""
    for annotation in parts:
        model = (
            annotation
            if isinstance(annotation, type) and issubclass(annotation, BaseModel)
            else _find_model(get_args(annotation))
        )
        if model:
            return model
    return None


def _make_error(
    kind: str,
    path: Path,
    value: Any,
    context: dict[str, Any],
    fields: tuple[dict[str, FieldInfo], FieldInfo | None],
    hint: str | None,
) -> ProblemError:
    keys, field = fields
    described = _(field.description) if field and field.description else None
    if kind == "extra_forbidden":
        key = str(path[-1])
        foreign = nearest_name(key, [word for word, latin_key in KEYS_IN_OTHER_LANGUAGES.items() if latin_key in keys])
        near = KEYS_IN_OTHER_LANGUAGES[foreign] if foreign else nearest_name(key, keys)
        return ProblemError(_("unknown key"), path=path, found=quote(key), allowed=", ".join(keys), near=near, key=True)
    if kind == "missing":
        named = get_args(field.annotation) if field and get_origin(field.annotation) is Literal else ()
        described = ", ".join(word for word in named if isinstance(word, str)) or described
        return ProblemError(_("the key `{path}` is missing").format(path=path[-1]), path=path, allowed=described)
    if kind == "literal_error":
        words = str(context.get("expected", "")).replace("'", "").replace(" or ", ", ")
        return ProblemError(
            _("this value is not allowed here"),
            path=path,
            found=quote(value),
            allowed=described if described and "[" in described else words,  # a list may stand here too
            near=nearest_name(str(value), words.split(", ")),
        )
    if kind in ("model_type", "model_attributes_type") and field and (shape := _find_model([field.annotation])):
        described = ", ".join(inner.alias or name for name, inner in shape.model_fields.items())
    if kind == "too_short" and context["min_length"] == 1:
        kind = "empty"
    message = _(MESSAGES.get("int" if kind.startswith("int_") else kind, "{msg}")).format(
        **{**context, "msg": _(context["msg"])}
    )
    return ProblemError(message, path=path, found=quote(value), allowed=hint or described)
