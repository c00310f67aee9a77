"""Limit solvers written in Python.

    @voussoir.limit_solver("highs")
    class Highs:
        def solve(self, program):
            ...
            return columns, duals

In a study: `solver = {"solver": "python_limit", "class": "highs"}`.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

_CLASSES: dict[str, type[Any]] = {}
_Class = TypeVar("_Class", bound="type[Any]")


class LinearProgram:
    """Maximise the last column x[-1] subject to `row_bounds[:, 0] <= A x <= row_bounds[:, 1]` and
    `column_bounds[:, 0] <= x <= column_bounds[:, 1]`. Bounds may be infinite; all numbers are of about size one.

    A is sparse, in compressed rows: row i has the columns `indices[indptr[i]:indptr[i + 1]]` with the values
    `data[indptr[i]:indptr[i + 1]]`. The first `equations` rows are equations of equilibrium, the other rows strengths of the
    form A x <= b. The columns are forces of the joints (`joint` and `component` of each: 0 for N_0, 1 for N_1, 2 for T), then
    load factors, for which both are -1.
    """

    def __init__(
        self, indptr: Any, indices: Any, data: Any, row_bounds: Any, column_bounds: Any, names: Any, equations: int
    ) -> None:
        self.indptr, self.indices, self.data = indptr, indices, data
        self.row_bounds, self.column_bounds = row_bounds, column_bounds
        self.joint, self.component = names[:, 0], names[:, 1]
        self.equations = equations

    @property
    def shape(self) -> tuple[int, int]:
        """The number of rows and of columns of A."""
        return len(self.row_bounds), len(self.column_bounds)

    def dense(self) -> Any:
        """Returns A as a dense array."""
        matrix = np.zeros(self.shape)
        row = np.repeat(np.arange(self.shape[0]), np.diff(self.indptr))
        np.add.at(matrix, (row, self.indices), self.data)
        return matrix


def limit_solver(name: str) -> Callable[[_Class], _Class]:
    """Registers a class as a limit solver for `solver = "python_limit"`. The class has `solve(program)`, which receives a
    `LinearProgram` and returns (columns, duals): the optimal value of every column, and the dual of every row or of the
    equations only, in either sign convention. If the program has no optimum, `solve` raises an exception.

    The program asks one to five linear programs for each stage. It checks the forces and the motion that result: a wrong
    solution cannot become a proof.
    """

    def register(cls: _Class) -> _Class:
        _CLASSES[name] = cls
        return cls

    return register


def _unknown(name: str) -> str:
    known = ", ".join(sorted(_CLASSES)) or "none"
    return f'no class is registered as "{name}" with @voussoir.limit_solver in this process (registered: {known})'


def check(name: str, parameters: str) -> tuple[str, str] | None:
    """Checks a solver. Returns the key of its table and the mistake, or None."""
    if name not in _CLASSES:
        return "class", _unknown(name)
    try:
        made = _CLASSES[name](**json.loads(parameters))
    except Exception as error:  # noqa: BLE001 - any exception of the class is reported
        wanted = inspect.signature(_CLASSES[name])
        return "parameters", f"{name}{wanted} cannot be made with them: {type(error).__name__}: {error}"
    return None if callable(getattr(made, "solve", None)) else ("class", f"{name} has no method `solve(program)`")


def solve(name: str, parameters: str, parts: list[bytes], equations: int) -> tuple[bytes, bytes]:
    """Solves a program with a registered class."""
    if name not in _CLASSES:
        raise KeyError(_unknown(name))
    integers, numbers = np.int64, np.float64
    indptr, indices, names = (np.frombuffer(part, integers) for part in parts[:3])
    data, row_bounds, column_bounds = (np.frombuffer(part, numbers) for part in parts[3:])
    shapes = row_bounds.reshape(-1, 2), column_bounds.reshape(-1, 2), names.reshape(-1, 2)
    program = LinearProgram(indptr, indices, data, *shapes, equations)
    columns, duals = _CLASSES[name](**json.loads(parameters)).solve(program)
    out = [np.ascontiguousarray(part, dtype=numbers).ravel() for part in (columns, duals)]
    return out[0].tobytes(), out[1].tobytes()
