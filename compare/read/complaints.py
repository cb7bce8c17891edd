"""Errors of validation in one line, for every kind of file: one formatter."""

import difflib
import reprlib
from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from analytic.problem.errors import InputError
from compare.read.toml import Place

_LONGEST_NAME = 100


class _Brief(reprlib.Repr):
    def repr_int(self, x: int, level: int) -> str:
        try:
            return super().repr_int(x, level)
        except ValueError:  # Python refuses to write thousands of digits
            return f"an integer of {x.bit_length()} bits"


_brief = _Brief()
_brief.maxstring = _brief.maxother = 80


def shown(value: object) -> str:
    """A value for an error: in one line, and not longer than helps."""
    return _brief.repr(value)


def complaint(
    error: ValidationError,
    schema: object,
    place: Place,
    outer: Sequence[str] = (),
) -> InputError:
    """What a validation error says, in one line."""
    parts = error.errors(include_url=False)
    first = min(parts, key=lambda part: part["type"] not in _UNKNOWN_KEY)
    inside, allowed = _walk(schema, first["loc"])
    name = place([*outer, *inside])
    value = shown(first["input"])
    context = first.get("ctx", {})
    match first["type"]:
        case "extra_forbidden" | "unexpected_keyword_argument":
            near = difflib.get_close_matches(inside[-1], allowed, n=1)
            return InputError(
                name,
                value,
                f"one of the keys {', '.join(allowed)}",
                f"did you mean {near[0]}?" if near else f"remove {shown(inside[-1])}",
            )
        case "missing":
            return InputError(name, "missing", "given", "add it")
        case "union_tag_invalid":
            tag, tags = shown(context["tag"]), context["expected_tags"]
            return InputError(f"{name}.kind", tag, f"one of {tags}", "choose one")
        case "union_tag_not_found":
            return InputError(f"{name}.kind", "missing", "given", "say what it is")
        case "literal_error":
            return InputError(name, value, f"one of {context['expected']}", "choose one")
        case "bool_parsing" | "bool_type":
            return InputError(name, value, "true or false", "write it without quotes")
        case "too_short" | "too_long":
            few = first["type"] == "too_short"
            allowed_count = context["min_length"] if few else context["max_length"]
            return InputError(
                name,
                value,
                f"of {'at least' if few else 'at most'} {allowed_count}",
                "add what is missing" if few else "leave some out",
            )
        case "value_error":
            return _refused(context["error"], value, inside, outer, place)
    allowed_value = first["msg"].removeprefix("Input should be ").removeprefix("Value should be ")
    return InputError(name, value, allowed_value, "change it")


def _refused(
    error: Exception, value: str, inside: Sequence[str], outer: Sequence[str], place: Place
) -> InputError:
    """What a table says against a value, of one of its keys if it names one."""
    if isinstance(error, InputError):
        keys = error.name.split(".")
        if keys[: len(inside)] == [*inside]:
            return error.called(place([*outer, *keys]))
    return InputError(place([*outer, *inside]), value, "usable", str(error))


_UNKNOWN_KEY = ("extra_forbidden", "unexpected_keyword_argument")


def _walk(schema: object, location: Sequence[int | str]) -> tuple[list[str], list[str]]:
    """The keys of a place in a schema, and the keys of the table that the last one is in.

    A location also names the kind of a table that may be of several; no key of the file does.
    """
    keys: list[str] = []
    table, allowed = schema, list(_fields(schema))
    for part in location:
        kinds = {name: kind for kind in get_args(table) for name in _kind(kind)}
        if part in kinds:
            table = kinds[str(part)]
        else:
            keys.append(str(part))
            allowed = list(_fields(table)) or allowed
            table = _fields(table).get(str(part))
            while get_origin(table) is Annotated or NoneType in get_args(table):
                table = get_args(table)[0]  # of what may be missing, too
    return keys, allowed


def _fields(table: object) -> dict[str, Any]:
    """The keys that a table may have, with what each of them holds."""
    if isinstance(table, type) and issubclass(table, BaseModel):
        return {field.alias or name: field.annotation for name, field in table.model_fields.items()}
    if isinstance(table, type) and is_dataclass(table):
        return {field.name: field.type for field in fields(table)}
    return {}


def _kind(table: object) -> tuple[str, ...]:
    """By which names a table of several kinds is chosen."""
    field: FieldInfo | None = getattr(table, "model_fields", {}).get("kind")
    return () if field is None else get_args(field.annotation)


def plain_name(text: str) -> str:
    """A name that files and folders can have, and that stays in its folder."""
    if (
        not text.strip()
        or len(text.encode(errors="replace")) > _LONGEST_NAME
        or text.startswith(".")
        or any(character in '/\\:*?"<>|' or not character.isprintable() for character in text)
    ):
        raise ValueError(
            f'a name is 1 to {_LONGEST_NAME} printable characters without / \\ : * ? " < > |, '
            "the first of them no dot"
        )
    return text


def name_of(path: Path) -> str:
    """What a file is called that does not say it itself: its name without the suffix."""
    try:
        return plain_name(path.stem)
    except ValueError as error:
        raise InputError(
            "name of the file", repr(path.name), "usable as a name", f"rename it: {error}"
        ) from error
