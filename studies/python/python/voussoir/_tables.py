"""The table of results as a pandas DataFrame."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped,unused-ignore]

#: Columns of texts, which may look like numbers or be empty.
TEXTS = (
    "variant", "scene", "status", "continuation", "kind", "hinge_joints", "sliding_joints", "crushing_joints", "flow_read_as",
    "solver", "notes", "region",
)  # fmt: skip
#: Columns of truths, in which a value may be missing.
TRUTHS = ("unique", "certificate_passed")


def header(files: Mapping[str, bytes]) -> list[str]:
    """The names of the columns of results.csv; empty without the file."""
    if "results.csv" not in files:
        return []
    return next(csv.reader(io.StringIO(files["results.csv"].decode())), [])


def unit(column: str) -> str | None:
    """The unit in the name of a column: "m" of "scene.thickness [m]"."""
    found = re.search(r" \[([^\]]*)\]$", column)
    return found[1] if found else None


def _values(name: str, cells: list[str]) -> tuple[list[Any], str | None]:
    """The values of a column of results.csv and their type in pandas. Only an empty cell is missing: a variant may be "NA"."""
    if name in TEXTS:
        return [cell or None for cell in cells], "str"
    if name in TRUTHS:
        return [{"true": True, "false": False}.get(cell) for cell in cells], "boolean"
    try:
        if unit(name) is None and "" not in cells:
            return [int(cell) for cell in cells], "int64"
    except ValueError:
        pass
    try:
        return [float(cell) if cell else math.nan for cell in cells], "float64"
    except ValueError:
        return [cell or None for cell in cells], "str"


def frame(files: Mapping[str, bytes]) -> pandas.DataFrame:
    """The table of a run; its units are in `attrs["units"]`."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("Results.df needs pandas: pip install pandas") from error
    if "results.csv" in files:
        # pandas does not keep the last bit of a number in every version.
        names, *rows = csv.reader(io.StringIO(files["results.csv"].decode(), newline=""))
        columns = {name: _values(name, [row[index] for row in rows]) for index, name in enumerate(names)}
        table = pandas.DataFrame({name: pandas.Series(values, dtype=kind) for name, (values, kind) in columns.items()})
    elif "results.parquet" in files:
        try:
            import polars
        except ImportError as error:
            raise ImportError("Results.df needs polars to read results.parquet: pip install polars") from error
        read = polars.read_parquet(io.BytesIO(files["results.parquet"]))
        table = pandas.DataFrame(read.to_dict(as_series=False))
        kinds = {name: "boolean" for name in TRUTHS} | {name: "str" for name in TEXTS}
        table = table.astype({name: kind for name, kind in kinds.items() if name in table})
    else:
        raise ValueError('these results have no table: add "results_csv" to the writers of [output]')
    table.attrs["units"] = {name: unit(name) for name in table if unit(name) is not None}
    return table
