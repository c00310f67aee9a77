"""A study as it is given: a dictionary, a path, or the text of a file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Union

#: A dictionary with the keys of a study file, the path of such a file, or its text.
Study = Union[Mapping[str, Any], str, "os.PathLike[str]"]

#: (form, text, name of the file, keys that are set), as the native module takes it.
Source = tuple[str, str, str, list[tuple[str, str]]]


def plain(value: Any) -> Any:
    """What JSON has no word for but a study may hold: numbers and arrays of NumPy, tuples, paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a study cannot hold {value!r}, which is a {type(value).__name__}")


def dumps(value: Any) -> str:
    """JSON of a value in a study."""
    return json.dumps(value, default=plain, allow_nan=False)


def toml_value(value: Any) -> str:
    """A value as `--set` takes it: TOML, which JSON is but for tables."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return dumps(value)


def source(study: Study, overrides: Mapping[str, Any] | None = None) -> Source:
    """What the native module takes. A text with a line break or an `=` is the study itself, any other a path."""
    overrides = overrides or {}
    if isinstance(study, Mapping):
        return "json", dumps(study), "", [(key, dumps(value)) for key, value in overrides.items()]
    sets = [(key, toml_value(value)) for key, value in overrides.items()]
    if isinstance(study, str) and ("\n" in study or "=" in study):
        return "toml", study, "study", sets
    path = os.fspath(study)
    with open(path, encoding="utf-8") as file:
        return "toml", file.read(), path, sets
