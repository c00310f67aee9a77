"""Results of a run: cases with arrays, figures for notebooks, and the files that the command line would write."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _array(values: Any) -> Array:
    """Converts numbers to an array, with NaN for null."""
    return np.array(values, dtype=np.float64)


def _columns(entries: list[dict[str, Any]] | None) -> dict[str, NDArray[Any]] | None:
    """Converts a list of entries with the same keys to an array for each key."""
    if entries is None:
        return None
    keys = entries[0].keys() if entries else ()
    return {key: np.array([entry[key] for entry in entries]) for key in keys}


class Figure:
    """A figure as SVG. Notebooks display it."""

    def __init__(self, name: str, svg: str) -> None:
        self.name = name
        self.svg = svg

    def __repr__(self) -> str:
        return f"<Figure {self.name}>"

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the SVG."""
        Path(path).write_text(self.svg, encoding="utf-8")


class Case:
    """The result of one case. Every key of its entry in results.json is an attribute; lists of numbers are arrays."""

    def __init__(self, entry: dict[str, Any]) -> None:
        #: The unchanged entry of results.json.
        self.raw = entry

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["raw"][name]
        except KeyError:
            raise AttributeError(f"the case has no {name}; it has {', '.join(self.__dict__.get('raw', {}))}") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.raw})

    def __repr__(self) -> str:
        factor = self.raw.get("load_factor")
        shown = "" if factor is None else f", load_factor={factor:.7g}"
        return f"<Case {self.raw['id']}: {self.raw['status']}{shown}>"

    @property
    def certified(self) -> bool:
        """True if every residual of the certificate is within its tolerance."""
        return bool(self.raw["certificate"]["passed"]) if "certificate" in self.raw else self.raw["status"] != "stalled"

    @property
    def bounds(self) -> Array | None:
        """[proved lower bound, proved upper bound] of the factor."""
        found = self.raw.get("bounds")
        return None if found is None else _array(found)

    @property
    def curve(self) -> Array | None:
        """Rows of (displacement [m], factor), if `[output] curve = true`."""
        found = self.raw.get("curve")
        return None if found is None else _array(found)

    @property
    def field(self) -> dict[str, NDArray[Any]] | None:
        """Contact forces: `joint`, `point` [m] and `force` [N] (normal, tangential), one row for each point."""
        return _columns(self.raw.get("field"))

    @property
    def motion(self) -> dict[str, NDArray[Any]] | None:
        """The mechanism: `body` and `velocity` (x, y, rotation), one row for each body."""
        return _columns(self.raw.get("motion"))

    @property
    def displacements(self) -> Any:
        """Displacements at the end of a path, one row for each body."""
        found = self.raw.get("displacements")
        return _columns(found) if isinstance(found, list) and found and isinstance(found[0], dict) else found

    @property
    def thrust_line(self) -> Array | None:
        """The point where the resultant crosses each joint [m]; NaN if a joint is not loaded."""
        found = self.raw.get("thrust_line")
        return None if found is None else _array([[np.nan, np.nan] if point is None else point for point in found])

    @property
    def rows(self) -> Array | None:
        """For a driven point: one row for each step; `columns` contains the names."""
        found = self.raw.get("rows")
        return None if found is None else _array(found)


class Results(Sequence[Case]):
    """All cases of a run, in order of id."""

    def __init__(self, name: str, files: dict[str, bytes], table: str, remarks: list[str], certified: bool) -> None:
        #: Name of the study.
        self.name = name
        #: The files that the command line would write: bytes by file name.
        self.files = files
        #: The table that the command line prints.
        self.table = table
        #: Remarks on the run for the user.
        self.remarks = remarks
        #: True if every case is solved and certified.
        self.certified = certified
        #: The unchanged content of results.json.
        self.raw: dict[str, Any] = json.loads(files["results.json"]) if "results.json" in files else {"cases": []}
        self._cases = [Case(entry) for entry in self.raw["cases"]]

    @overload
    def __getitem__(self, index: int) -> Case: ...
    @overload
    def __getitem__(self, index: slice) -> list[Case]: ...
    def __getitem__(self, index: int | slice) -> Case | list[Case]:
        return self._cases[index]

    def __len__(self) -> int:
        return len(self._cases)

    def __iter__(self) -> Iterator[Case]:
        return iter(self._cases)

    def __repr__(self) -> str:
        return f"<Results of {self.name}: {len(self)} case(s)>\n{self.table}"

    def case(self, id: int) -> Case:
        """The case with this id."""
        for case in self._cases:
            if case.raw["id"] == id:
                return case
        raise KeyError(f"there is no case {id} in these results")

    @property
    def figures(self) -> dict[str, Figure]:
        """Figures by name. Notebooks display them."""
        names = sorted(name for name in self.files if name.endswith(".svg"))
        stems = {name: Path(name).stem for name in names}
        return {stem: Figure(stem, self.files[name].decode()) for name, stem in stems.items()}

    @property
    def report(self) -> str | None:
        """Returns report.html, one self-contained page."""
        found = self.files.get("report.html")
        return None if found is None else found.decode()

    def columns(self) -> dict[str, list[Any]]:
        """Returns parameters and results as columns, for pandas or polars."""
        keys = list(dict.fromkeys(key for case in self for key in case.raw.get("parameters", {})))
        columns: dict[str, list[Any]] = {"id": [case.raw["id"] for case in self]}
        for name in ("variant", "scene"):
            if any(case.raw.get(name) is not None for case in self):
                columns[name] = [case.raw.get(name) for case in self]
        for key in keys:
            columns[key] = [case.raw.get("parameters", {}).get(key) for case in self]
        columns["status"] = [case.raw["status"] for case in self]
        columns["load_factor"] = [case.raw.get("load_factor") for case in self]
        columns["certified"] = [case.certified for case in self]
        return columns

    def _repr_html_(self) -> str:
        columns = self.columns()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
        rows = zip(*columns.values())
        body = "".join("<tr>" + "".join(f"<td>{_cell(value)}</td>" for value in row) + "</tr>" for row in rows)
        return f"<table><caption>{html.escape(self.name)}</caption><tr>{head}</tr>{body}</table>"

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes the files that the command line would write; `voussoir.verify` checks them."""
        for name, content in self.files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            aside = path.with_name(path.name + ".tmp")
            aside.write_bytes(content)
            aside.replace(path)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return html.escape(f"{value:.7g}" if isinstance(value, float) else str(value))
