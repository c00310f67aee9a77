"""Results of a run or of a folder: cases with arrays, tables, plots, figures for notebooks, and the files of the command line."""

from __future__ import annotations

import base64
import functools
import html
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from . import _voussoir

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped,unused-ignore]
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

#: Number of rows of a table in a notebook.
ROWS_SHOWN = 20


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


class Block(NamedTuple):
    """A block before it moves [m]."""

    #: Name, as in `motion`.
    name: str
    #: True for a support.
    fixed: bool
    #: Corners (n, 2).
    vertices: Array
    #: The point whose velocity `motion` has.
    centroid: Array


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
    def outputs(self) -> dict[str, Array]:
        """Outputs of plug-ins by name, with NaN for null: one value for each point, joint or block, or one value of the case. If two
        plug-ins have an output of the same name, the key is "TAG.NAME". Places and positions are in `raw["outputs"]`."""
        entries = self.raw.get("outputs", [])
        names = [entry["name"] for entry in entries]
        key = (entry["name"] if names.count(entry["name"]) == 1 else f"{entry['plugin']}.{entry['name']}" for entry in entries)
        return {name: _array(entry["values"]) for name, entry in zip(key, entries)}

    @property
    def rows(self) -> Array | None:
        """For a driven point: one row for each step; `columns` contains the names."""
        found = self.raw.get("rows")
        return None if found is None else _array(found)


class Results(Sequence[Case]):
    """All cases of a run or of a results folder, in order of id."""

    def __init__(
        self,
        name: str,
        files: Mapping[str, bytes],
        table: str,
        remarks: list[str],
        certified: bool,
        raw: dict[str, Any] | None = None,
    ) -> None:
        #: Name of the study.
        self.name = name
        #: The files that the command line would write: bytes by file name.
        self.files = files
        #: The table that the command line prints; for a results folder, a shorter one.
        self.table = table
        #: Remarks on the run for the user.
        self.remarks = remarks
        #: True if every case is solved and certified.
        self.certified = certified
        #: The unchanged content of results.json.
        self.raw: dict[str, Any] = raw or (json.loads(files["results.json"]) if "results.json" in files else {"cases": []})
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
        found = ((_stem(file), file) for file in sorted(self.files) if file.endswith(".svg"))
        return {name: Figure(name, self.files[file].decode()) for name, file in found}

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

    @property
    def answer(self) -> str:
        """The first sentence of the report: the result of the study. Without a report of cases, the number of cases
        by status, or of claims by verdict."""
        found = re.search(r'<p class="summary"><strong>(.*?)</strong>', self.report or "", re.DOTALL)
        if found:
            return html.unescape(re.sub(r"<[^>]*>", "", found[1])).strip()
        words = [case.raw["status"] for case in self] or [claim["verdict"] for claim in self.raw.get("claims", [])]
        counts = ", ".join(f"{words.count(word)} {word.replace('_', ' ')}" for word in dict.fromkeys(words))
        return f"{len(words)} {'case' if len(self) else 'claim'}(s): {counts}." if words else f"{self.name} has no cases."

    @property
    def worst(self) -> Case | None:
        """The critical case: the case that a search has found, otherwise the case with the least load factor. None if no case
        has a load factor, or the study compares scenes."""
        ids = [entry["case"] for name in ("worsts", "optima", "seismic") for entry in self.raw.get(name, [])]
        if "comparison" in self.raw:
            return None
        cases = [case for case in self if not ids or case.raw["id"] in ids]
        loaded = [case for case in cases if case.raw.get("load_factor") is not None]
        if len(self) == 1:
            return self[0]
        return min(loaded, key=lambda case: float(case.raw["load_factor"]), default=None)

    @functools.cached_property
    def df(self) -> pandas.DataFrame:
        """results.csv as a pandas DataFrame, with the same columns; if there is no CSV file, results.parquet (needs polars). Units
        are in the names of the columns, and by column in `df.attrs["units"]`."""
        from ._tables import frame

        return frame(self.files)

    def blocks(self, case: int) -> list[Block]:
        """The blocks of a case before it moves, in the order of `motion` and `displacements`."""
        found = _voussoir.blocks(("toml", self.files["resolved.toml"].decode(), "", []), json.dumps(self.case(case).raw))
        return [Block(name, fixed, _array(corners).reshape(-1, 2), _array(centre)) for name, fixed, corners, centre in found]

    def plot(
        self, what: str | None = None, *, case: int | None = None, variant: str | None = None, ax: Axes | None = None
    ) -> Axes:
        """Draws with matplotlib and returns the axes.

        `what` is one of
        - "sweep": load factors over the first swept number, or over the positions of an envelope;
        - "curve": load factor over displacement, or traction over gap of a driven point;
        - "map": load factors or ratios of a variant over two swept numbers;
        - "mechanism": blocks of a case, moved by its mechanism or its last displacements, with thrust line and hinges.

        Without `what`, it is the first of map, sweep, curve and mechanism that the results have. `case` is the id of a case, by
        default the critical case for a mechanism and all cases for curves. `variant` selects cases, or the variant of a map. `ax`
        are axes to draw into.
        """
        from ._plot import plot

        return plot(self, what, case, variant, ax)

    def _picture(self) -> Figure | None:
        """The figure for notebooks: the critical case, otherwise the figure of the whole study."""
        figures = self.figures
        worst = self.worst
        own = [f"case-{worst.raw['id']:04}-{name}" for name in ("mechanism", "scene")] if worst else []
        wholes = ["map", "comparison", "envelope", "sweep", "curve"]
        return next((figures[name] for name in [*own, *wholes, *figures] if name in figures), None)

    def _repr_html_(self) -> str:
        columns = self.columns()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
        rows = list(zip(*columns.values()))[:ROWS_SHOWN]
        body = "".join("<tr>" + "".join(f"<td>{html.escape(_cell(value))}</td>" for value in row) + "</tr>" for row in rows)
        more = f"<p>{len(self)} cases, of which {ROWS_SHOWN} are shown</p>" if len(self) > ROWS_SHOWN else ""
        # As an image, so that names and styles inside the SVG do not meet the names and styles of other figures.
        picture = self._picture()
        data = base64.b64encode(picture.svg.encode()).decode() if picture else ""
        image = f'<img alt="{html.escape(picture.name)}" style="max-width:100%" src="data:image/svg+xml;base64,{data}">' if picture else ""
        answer = f"<p><strong>{html.escape(self.answer)}</strong></p>"
        return f"{answer}{image}<table><caption>{html.escape(self.name)}</caption><tr>{head}</tr>{body}</table>{more}"

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes the files that the command line would write; `voussoir.verify` checks them."""
        for name, content in self.files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            aside = path.with_name(path.name + ".tmp")
            aside.write_bytes(content)
            aside.replace(path)


def _stem(file: str) -> str:
    """The name of a figure: its file without `figures/` and without the ending."""
    path = Path(file)
    folder = path.parent.as_posix().removesuffix("figures").strip("/.")
    return f"{folder}/{path.stem}" if folder else path.stem


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def text_table(columns: Mapping[str, Sequence[Any]]) -> str:
    """Columns as text, with aligned cells."""
    lines = [list(columns), *([_cell(value) for value in row] for row in zip(*columns.values()))]
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in lines)
