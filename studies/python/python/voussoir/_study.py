"""Converts a study (a dictionary, a path, or the text of a file) for the native module."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any, Union

#: A dictionary with the keys of a study file, the path of such a file, or its text.
Study = Union[Mapping[str, Any], str, "os.PathLike[str]"]

#: (form, text, name of the file, overridden keys), in the form that the native module expects.
Source = tuple[str, str, str, list[tuple[str, str]]]


def plain(value: Any) -> Any:
    """Converts values that JSON cannot represent but a study may contain: numbers and arrays of NumPy, paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a study cannot hold {value!r}, which is a {type(value).__name__}")


def dumps(value: Any) -> str:
    """Converts a value of a study to JSON."""
    return json.dumps(value, default=plain, allow_nan=False)


def toml_value(value: Any) -> str:
    """Converts a value to TOML, as `--set` expects it. Values other than tables are written as in JSON."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return dumps(value)


def source(study: Study, overrides: Mapping[str, Any] | None = None) -> Source:
    """Converts a study for the native module. A text with a line break or an `=` is a study, any other text a path."""
    overrides = overrides or {}
    if isinstance(study, Mapping):
        return "json", dumps(study), "", [(key, dumps(value)) for key, value in overrides.items()]
    sets = [(key, toml_value(value)) for key, value in overrides.items()]
    if isinstance(study, str) and ("\n" in study or "=" in study):
        return "toml", study, "study", sets
    path = os.fspath(study)
    with open(path, encoding="utf-8") as file:
        return "toml", file.read(), path, sets
