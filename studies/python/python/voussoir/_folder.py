"""Files of a results folder, read when they are needed."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from ._results import Results, text_table

#: Value of `format` in results.json that this version reads.
FORMAT = 1


class Folder(Mapping[str, bytes]):
    """The files of a results folder: bytes by name, with `/` between the parts of a name."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self._root = Path(folder)
        found = (path for path in self._root.rglob("*") if path.is_file())
        self._names = sorted(path.relative_to(self._root).as_posix() for path in found)

    def __getitem__(self, name: str) -> bytes:
        if name not in self._names:
            raise KeyError(name)
        return (self._root / name).read_bytes()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{len(self)} files of {self._root}>"


def load(folder: str | os.PathLike[str]) -> Results:
    """Reads a results folder written by `voussoir run` or `Results.write`. Nothing is solved or checked: `verify` does that.

    Raises FileNotFoundError if the folder has no results.json, and ValueError if the file is not a results file.
    """
    path = Path(folder)
    if not (path / "results.json").is_file():
        why = "it has no results.json"
        if (path / "unfinished.jsonl").is_file():
            why = "its run has not finished; the same `voussoir run` continues it"
        raise FileNotFoundError(f"{path} is not a results folder: {why}")
    files = Folder(path)
    try:
        raw = json.loads(files["results.json"])
        readable = raw["format"] == FORMAT and isinstance(raw["cases"], list)
        name = raw["study"]
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f"{path / 'results.json'} is not a results file: {error!r}") from None
    if not readable:
        raise ValueError(f"{path / 'results.json'} has format {raw['format']}; this version reads format {FORMAT}")
    results = Results(name, files, "", [], False, raw)
    results.table = text_table(results.columns())
    results.certified = all(case.certified for case in results)
    return results
