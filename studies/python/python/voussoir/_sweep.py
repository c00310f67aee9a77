"""Many cases as columns, on this machine or on any pool of workers."""

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

#: Cases that a worker is given at once.
CHUNK = 512


class Table(dict[str, Any]):
    """Columns by name, a row a case in order of id: numbers as arrays (NaN where there is none), words as lists.

    `pandas.DataFrame(table)` and `polars.DataFrame(table)` take it as it is.
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
        """Writes the columns as a Parquet file, which pandas, polars, DuckDB and others read: numbers keep every bit, a number
        that there is none of is null. Needs polars (`pip install voussoir[parquet]`).
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
    """The study of a worker, read once in each process and not checked again."""
    form, text, file, sets = key
    return _voussoir.Sweep((form, text, file, list(sets)), False)


def solve_chunk(study: Source, ids: range, version: str) -> dict[str, Any]:
    """What a worker does: solves some cases and gives their columns."""
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
    """Answers every case of a study and gives a row for each: parameters, status, load factor, bounds, mechanism.

    Forces and motions are not kept, so that a hundred thousand cases fit; `voussoir.run(study, cases=[id])` gives them for
    one. `client` is whoever works: a `dask.distributed.Client`, a `concurrent.futures` executor, anything with `submit`;
    without one `jobs` cases are worked on side by side here. Workers get `chunk` cases at a time. A worker that dies loses
    nothing where its pool gives its work to another, as Dask does. `progress` is called with (answered, all).

    Every case is made once before the first is answered: StudyError tells every mistake. Results do not depend on who
    works, bit for bit, but for `seconds`.
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
    # Dask would take two chunks of the same study for the same work, which they are: it may.
    futures = [client.submit(solve_chunk, given, ids, _voussoir.__version__) for ids in ranges]
    answered = 0
    for future, ids in zip(futures, ranges):
        parts.append(future.result())
        answered += len(ids)
        tell(answered, count)
    return _joined(parts)


def _joined(parts: list[dict[str, Any]]) -> Table:
    """The columns of all parts, one below the other."""
    names = list(dict.fromkeys(name for part in parts for name in part))
    table = Table()
    for name in names:
        values: list[Any] = []
        for part in parts:
            values.extend(part[name] if name in part else [None] * len(part["id"]))
        if values and isinstance(values[0], (bool, int, float)) and all(value is not None for value in values):
            table[name] = np.array(values)
        else:
            table[name] = values
    return table
