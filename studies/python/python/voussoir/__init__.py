"""Stability and collapse of masonry made of blocks.

    import voussoir
    results = voussoir.run("my_bridge.toml")        # or a dictionary with the same keys, or the text of a file
    results[0].load_factor

`run` solves all cases of a study and returns the results with their proofs. `load` reads the results of a folder. `sweep`
solves many cases, on this machine or on a cluster, and returns columns. `law` registers a class as a joint law, and
`limit_solver` registers one as a limit solver. `conform` checks a law or another plug-in.
"""

from __future__ import annotations

import json as _json
import os as _os
from typing import Any as _Any

from ._native import choose as _choose

_choose()

from . import _voussoir  # noqa: E402
from ._conform import Finding, Report, conform
from ._folder import load
from ._laws import Context, Facet, law
from ._results import Block, Case, Figure, Results
from ._solvers import LinearProgram, limit_solver
from ._study import Study
from ._sweep import Table, sweep
from ._voussoir import StudyError, __version__

__all__ = [
    "Block", "Case", "Context", "Facet", "Figure", "Finding", "LinearProgram", "Report", "Results", "Study", "StudyError",
    "Table", "__version__", "check", "conform", "law", "limit_solver", "load", "plugins", "run", "schema", "sweep", "verify",
]  # fmt: skip


def run(
    study: Study,
    *,
    set: dict[str, _Any] | None = None,
    cases: list[int] | None = None,
    jobs: int = 1,
    progress: _Any = None,
) -> Results:
    """Solves the cases of a study of any kind.

    `study` is a dictionary with the keys of a study file, the path of such a file, or its text. `set` overrides keys, for
    example `{"joints.dry.friction": 0.5}`. `cases` are the ids of the cases to solve. `jobs` is the number of cases that
    are solved in parallel.

    `progress` is called with a dictionary: `{"event": "begins", "cases": 38}`, then `"answered"` with case, status and
    load_factor, and `"path"` with case, stage, factor and states. If it returns False, the run ends and returns the solved
    cases. If it raises an exception, or you press Ctrl-C, the run ends with this exception.

    Raises StudyError with all mistakes of the study.
    """
    from ._study import source

    answer = _voussoir.run(source(study, set), cases, jobs, progress)
    return Results(answer["name"], answer["files"], answer["table"], answer["remarks"], answer["certified"])


def check(study: Study, *, set: dict[str, _Any] | None = None) -> dict[str, _Any]:
    """Returns name, number of cases (`count`), `notes` and `plan` of a study. Raises StudyError if it has mistakes."""
    from ._study import source

    return _voussoir.check(source(study, set))


def verify(folder: str | _os.PathLike[str], *, jobs: int = 1) -> list[str]:
    """Checks a results folder written by `voussoir run` or `Results.write`. Returns the findings; empty if all is confirmed."""
    found: list[str] = _voussoir.verify(_os.fspath(folder), jobs)["findings"]
    return found


def schema() -> dict[str, _Any]:
    """Returns the JSON Schema of study files."""
    found: dict[str, _Any] = _json.loads(_voussoir.schema())
    return found


def plugins(kind: str | None = None) -> dict[str, str]:
    """Returns tags and summaries of plug-ins of one kind ("laws", "materials", "scenes", "solvers" and others), or of all."""
    return {tag: summary for of, tag, summary in _voussoir.plugins() if kind is None or of == kind}
