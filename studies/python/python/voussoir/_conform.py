"""Conformance of plug-ins: `voussoir.conform`."""

from __future__ import annotations

import inspect
import json
from collections import Counter
from dataclasses import dataclass
from typing import Any

from . import _laws, _voussoir


@dataclass(frozen=True)
class Finding:
    """A promise that a plug-in does not keep. `study` is the text of a study that shows it, if a path leads to it."""

    check: str
    what: str
    study: str | None


@dataclass(frozen=True)
class Report:
    """The checks of one plug-in: the number of times that each was made, the checks that were left out, and the findings. If
    plug-ins of several kinds have the tag, the report is about all of them."""

    tag: str
    kind: str
    text: str
    passed: bool
    done: dict[str, int]
    left_out: list[str]
    findings: list[Finding]

    def __str__(self) -> str:
        return self.text.rstrip()


def conform(plug_in: type[Any] | str, **parameters: Any) -> Report:
    """Checks that a plug-in keeps the promises of its trait and its card, as `voussoir conform` does.

    `plug_in` is the tag of a registered plug-in, or a class that is a joint law; `parameters` are the arguments with which
    the class is made. These attributes of the class replace the card of a law in Rust:

    - `units`: the SI unit of each argument, for example `{"friction": "-", "cohesion": "Pa"}`
    - `size`: gap [m] at which the law changes its branch (default 1e-4)
    - `sources`: where the equations come from
    - `branches`: names that the walks must reach, among "elastic", "open" and "dissipating"
    - `claims`: properties that hold for all arguments, such as "associated" or "dissipative"
    - `known_paths`: a list of `{"source": ..., "steps": [((g_n, g_t), (t_n, t_t)), ...], "tolerance": 1e-9}`, with tractions
      that do not come from the class itself

    Raises ValueError if there is no such plug-in, or if a description cannot be read.
    """
    if isinstance(plug_in, str):
        if parameters:
            raise ValueError(f"the parameters of {plug_in!r} are those of the samples on its card")
        told = _voussoir.conform_tag(plug_in)
        if not told:
            raise ValueError(f"no plug-in has the tag {plug_in!r}; voussoir.plugins(kind) lists them")
        return _report(told)
    return _report([_voussoir.conform_law(json.dumps(_described(plug_in, parameters)))])


def _report(told: list[Any]) -> Report:
    tags, kinds, texts, passed, done, left_out, findings = zip(*told)
    times: Counter[str] = Counter()
    for own in done:
        times.update(dict(own))
    return Report(
        tag=tags[0],
        kind=", ".join(kinds),
        text="".join(texts),
        passed=all(passed),
        done=dict(times),
        left_out=[why for own in left_out for why in own],
        findings=[Finding(*finding) for own in findings for finding in own],
    )


def _described(cls: type[Any], parameters: dict[str, Any]) -> dict[str, Any]:
    name = next((name for name, own in _laws._CLASSES.items() if own is cls), None)
    if name is None:
        # No class that a study names has this name.
        name = f"{cls.__module__}.{cls.__qualname__}"
        _laws.law(name)(cls)
    form = "facets" if hasattr(cls, "facets") else "response"
    mistake = _laws.check(name, json.dumps(parameters), form)
    if mistake is not None:
        raise ValueError(": ".join(mistake))
    units = getattr(cls, "units", {})
    keys = []
    for key in inspect.signature(cls).parameters.values():
        if key.name not in units:
            raise ValueError(f'{cls.__name__}.units gives no unit for "{key.name}"; "-" is the unit of a pure number')
        has_default = key.default is not inspect.Parameter.empty
        value = parameters.get(key.name, key.default)
        keys.append({
            "name": key.name,
            "unit": units[key.name],
            "list": isinstance(value, (list, tuple)),
            "default": json.dumps(key.default) if has_default and key.default is not None else None,
            "optional": has_default and key.default is None,
        })  # fmt: skip
    made = cls(**parameters)
    return {
        "form": f"python_{form}",
        "table": f"class = {json.dumps(name)}\nparameters = {_inline(parameters)}",
        "responds": form == "response" or _laws.stiffness(made) is not None,
        "summary": inspect.getdoc(cls) or "",
        "size": float(getattr(cls, "size", 1e-4)),
        "branches": list(getattr(cls, "branches", ())),
        "sources": list(getattr(cls, "sources", ())),
        "claims": list(getattr(cls, "claims", ())),
        "parameters": keys,
        "known_paths": [
            {
                "source": path["source"],
                "steps": [[list(map(float, at)), list(map(float, force))] for at, force in path["steps"]],
                "tolerance": float(path.get("tolerance", 1e-9)),
            }
            for path in getattr(cls, "known_paths", ())
        ],
    }


def _inline(parameters: dict[str, Any]) -> str:
    """Returns an inline table of TOML."""
    return "{ " + ", ".join(f"{key} = {json.dumps(value)}" for key, value in parameters.items()) + " }"
