"""Solves many cases, on this machine or on a pool of workers, and returns columns."""

from __future__ import annotations

import functools
import html
import math
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import _voussoir
from ._study import Source, Study, source

#: Greatest number of cases in one task of a worker.
CHUNK = 512


class Table(dict[str, Any]):
    """Columns by name, with one row for each case in order of id. Numbers are arrays (NaN if missing), words are lists.

    `pandas.DataFrame(table)` and `polars.DataFrame(table)` accept it unchanged.
    """

    @property
    def count(self) -> int:
        """Number of rows."""
        return len(self["id"])

    def rows(self) -> list[dict[str, Any]]:
        """The rows as dictionaries."""
        names = list(self)
        return [dict(zip(names, row)) for row in zip(*self.values())]

    def write_parquet(self, path: str | os.PathLike[str]) -> None:
        """Writes the columns as a Parquet file, for pandas, polars, DuckDB and other programs. Numbers keep every bit; a missing
        number is null. Needs polars (`pip install voussoir[parquet]`).
        """
        import polars

        polars.DataFrame(dict(self), nan_to_null=True).write_parquet(os.fspath(path))

    def _repr_html_(self) -> str:
        names = [name for name in self if name not in ("case_hash", "seconds", "notes")]
        head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
        shown = zip(*(list(self[name])[:50] for name in names))
        body = "".join("<tr>" + "".join(f"<td>{html.escape(str(value))}</td>" for value in row) + "</tr>" for row in shown)
        more = f"<p>{self.count} rows, of which 50 are shown</p>" if self.count > 50 else ""
        return f"<table><tr>{head}</tr>{body}</table>{more}"


@functools.lru_cache(maxsize=4)
def _reader(key: tuple[str, str, str, tuple[tuple[str, str], ...]]) -> _voussoir.Sweep:
    """Reads the study of a worker, once in each process and without checking it again."""
    form, text, file, sets = key
    return _voussoir.Sweep((form, text, file, list(sets)), False)


def solve_chunk(study: Source, ids: range, version: str) -> dict[str, Any]:
    """The task of a worker: solves some cases and returns their columns."""
    if version != _voussoir.__version__:
        raise RuntimeError(f"the worker has voussoir {_voussoir.__version__}, the caller {version}: install the same on both")
    form, text, file, sets = study
    return _voussoir_solve(_reader((form, text, file, tuple(sets))), ids)


def _voussoir_solve(sweep: _voussoir.Sweep, ids: range) -> dict[str, Any]:
    return sweep.solve(list(ids))


def sweep(
    study: Study,
    *,
    set: Mapping[str, Any] | None = None,
    jobs: int = 1,
    client: Any = None,
    chunk: int | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> Table:
    """Solves every case of a study and returns a row for each: parameters, status, load factor, bounds, mechanism. Outputs of the
    case that plug-ins declare have columns "TAG.NAME".

    Forces and motions are not stored, so that a hundred thousand cases fit into memory; `voussoir.run(study, cases=[id])`
    returns them for one case.

    `client` is the pool of workers: a `dask.distributed.Client`, a `concurrent.futures` executor, or any object with
    `submit`. Without a client, `jobs` cases are solved in parallel in this process. A task of a worker has `chunk` cases.
    If a worker dies, no results are lost if its pool repeats the task on another worker, as Dask does. `progress` is
    called with (number of solved cases, number of all cases).

    Every case is created once before the first is solved, so that StudyError contains all mistakes. Results are the same
    on every pool, bit for bit, except `seconds`.
    """
    given = source(study, set)
    reader = _voussoir.Sweep(given)
    count = reader.count
    tell = progress or (lambda answered, of: None)
    parts: list[dict[str, Any]] = []
    size = chunk or max(1, min(CHUNK, math.ceil(count / 32)))
    ranges = [range(start, min(start + size, count)) for start in range(0, count, size)]
    if client is None:
        step = max(1, jobs) * size
        for start in range(0, count, step):
            stop = min(start + step, count)
            parts.append(reader.solve(list(range(start, stop)), jobs))
            tell(stop, count)
        return _joined(parts)
    # Dask merges tasks with the same arguments. This is correct, because the same chunk has the same results.
    futures = [client.submit(solve_chunk, given, ids, _voussoir.__version__) for ids in ranges]
    answered = 0
    for future, ids in zip(futures, ranges):
        parts.append(future.result())
        answered += len(ids)
        tell(answered, count)
    return _joined(parts)


def _joined(parts: list[dict[str, Any]]) -> Table:
    """Concatenates the columns of all parts."""
    names = list(dict.fromkeys(name for part in parts for name in part))
    table = Table()
    for name in names:
        values: list[Any] = []
        # A part without a column of numbers has NaN.
        missing = math.nan if any(isinstance(value, float) for part in parts for value in part.get(name, ())) else None
        for part in parts:
            values.extend(part[name] if name in part else [missing] * len(part["id"]))
        if values and isinstance(values[0], (bool, int, float)) and all(value is not None for value in values):
            table[name] = np.array(values)
        else:
            table[name] = values
    return table
