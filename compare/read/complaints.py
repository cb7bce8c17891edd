"""Errors of validation in one line, for every kind of file: one formatter."""

import re
import reprlib
from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from analytic.problem.errors import InputError, called, near
from compare.read.toml import KeyPlace

_LONGEST_NAME = 100
_OF_KINDS = ("profile", "body")  # tables that are of one of several kinds
_PLAIN = {
    "Input should be": "must be", "Value should be": "must be", "Value error, ": "",
    "valid tuple": "list", "valid list": "list", "valid dictionary": "table",
    "valid string": "text in quotes", "valid integer": "whole number",
    "a valid boolean": "true or false", "valid number": "number",
}  # fmt: skip
UNKNOWN_KEY = "unknown_key"
_brief = reprlib.Repr()
_brief.maxstring = _brief.maxother = 80


def shown(value: object) -> str:
    """A value for an error: in one line, and not longer than helps."""
    return _brief.repr(value)


def complaint(error: ValidationError, place: KeyPlace, outer: Sequence[str] = ()) -> InputError:
    """What a validation error says, in one line; an unknown key explains what else is wrong."""
    found = error.errors(include_url=False)
    first = min(found, key=lambda one: one["type"] != UNKNOWN_KEY)
    inside = [*map(str, first["loc"])]
    if inside[:1] and inside[0] in _OF_KINDS:  # pydantic names the kind, too, which is no key
        del inside[1:2]
    keys = [*outer, *inside]
    name, value, context = place(keys), shown(first["input"]), first.get("ctx", {})
    match first["type"]:
        case "unknown_key":
            key, known = context["key"], context["allowed"]
            remedy = near(key, known.split(", "), "say it by these, or leave it out")
            allowed = f"one of the keys {known}"
            return InputError(place([*keys, key]), shown(first["input"][key]), allowed, remedy)
        case "missing":
            return InputError(name, "missing", "given", "add it")
        case "union_tag_invalid" | "union_tag_not_found":
            tag = shown(context["tag"]) if "tag" in context else "missing"
            known = context.get("expected_tags", "")
            allowed, remedy = f"one of {known}" if known else "given", "say what it is"
            remedy = near(context.get("tag", ""), re.findall("[a-z-]+", known), remedy)
            return InputError(f"{name}.kind", tag, allowed, remedy)
        case "too_long" | "too_short" | "string_too_short":
            (count,) = (context[end] for end in ("max_length", "min_length") if end in context)
            allowed = f"a list of {count}"
            if context.get("field_type") != "Tuple":
                more = "not empty" if count == 1 else f"of {count} or more"
                allowed = f"of {count} or fewer" if "max_length" in context else more
            return InputError(name, value, allowed, "change it")
        case "model_type" | "dataclass_type":
            return InputError(name, value, "a table", "write its keys below its name in brackets")
        case "value_error":
            refused = context["error"]
            if isinstance(refused, InputError):
                named = refused.name.split(".")
                if named[: len(inside)] == inside:  # it says which of the table's keys
                    return called(refused, place([*outer, *named]))
            return InputError(name, value, "usable", str(refused))
    allowed = in_our_words(first["msg"]).removeprefix("must be ")
    quoted = isinstance(first["input"], str) and allowed.endswith("number")
    remedy = "write it without quotes and without a unit" if quoted else "change it"
    return InputError(name, value, allowed, remedy)


def in_our_words(said: str) -> str:
    """What pydantic says, as everything else here does."""
    for theirs, plain in _PLAIN.items():
        said = said.replace(theirs, plain)
    return said.partition(", unable to parse")[0]


def require_known(given: object, allowed: Sequence[str]) -> None:
    """Refuse a table with an unknown key."""
    for key in given if isinstance(given, dict) else ():
        if key not in allowed:
            about = {"key": key, "allowed": ", ".join(allowed)}
            raise PydanticCustomError(UNKNOWN_KEY, "no known key", about)


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
