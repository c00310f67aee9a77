"""Joint laws written in Python.

    @voussoir.law("my_friction")
    class MyFriction:
        def __init__(self, friction):
            self.friction = friction

        def facets(self):
            mu = self.friction
            return [Facet("opening", [-1, 0], 0.0), Facet("sliding", [-mu, 1], 0.0), Facet("sliding", [-mu, -1], 0.0)]

In a study: `joints.dry = {"law": "python_facets", "class": "my_friction", "parameters": {"friction": 0.6}}`.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

_CLASSES: dict[str, type[Any]] = {}
_Class = TypeVar("_Class", bound="type[Any]")


class Facet:
    """A half plane `normal` · t <= `bound` of admissible tractions t = (t_n, t_t) [Pa], t_n > 0 in compression, and the
    direction of flow on it. Without `flow`, flow is associated. `mode` is "opening", "sliding" or "crushing"."""

    def __init__(self, mode: str, normal: Sequence[float], bound: float, flow: Sequence[float] | None = None) -> None:
        if mode not in ("opening", "sliding", "crushing"):
            raise ValueError(f'a facet is "opening", "sliding" or "crushing", not {mode!r}')
        self.mode = mode
        self.normal = [float(x) for x in normal]
        self.bound = float(bound)
        self.flow = self.normal if flow is None else [float(x) for x in flow]
        if len(self.normal) != 2 or len(self.flow) != 2:
            raise ValueError("normal and flow of a facet are two numbers, (n, t)")
        numbers = [*self.normal, *self.flow, self.bound]
        if not np.all(np.isfinite(numbers)) or self.bound < 0 or self.normal == [0.0, 0.0]:
            raise ValueError("a facet has finite numbers, a normal that is not zero and a bound that is not negative")

    def __repr__(self) -> str:
        return f"Facet({self.mode!r}, {self.normal}, {self.bound}, {self.flow})"


@dataclass(frozen=True)
class Context:
    """What a law can read besides gaps and states: arrays with one entry for each point.

    `previous_gap` (points, 2) is the gap at the start of the step [m], `position` (points, 2) the place of the point in the
    undeformed scene [m], `length` the length of the joint that it represents [m], `width` the width of the joint [m],
    `time_step` the duration of the step [s] (0 without duration). `fields` and `previous_fields` are the values at the end
    and at the start of the step of the fields that the attribute `fields` of the class names; a field that no stage has
    set is NaN.
    """

    previous_gap: Any
    position: Any
    length: Any
    width: Any
    time_step: Any
    fields: dict[str, Any]
    previous_fields: dict[str, Any]


def law(name: str) -> Callable[[_Class], _Class]:
    """Registers a class as a joint law. For `law = "python_facets"`, the class has `facets()`, which returns a list of
    `Facet`. For `law = "python_response"`, it has `respond(gap, state)`, `stiffness` and, if the law has a memory,
    `state_names`.

    `respond` receives gaps (points, 2) [m], open > 0, and states (points, n). It returns (traction, state) or a dictionary
    with `traction` (points, 2) [Pa], compression > 0, `state`, and optionally `tangent` (points, 2, 2) [Pa/m], `stored`
    and `dissipated` (points) [J/m2]. If the tangent is missing, it is computed by differences with a step of 1e-6 times the
    attribute `size` of the class (default 1e-4 m). `respond` must be a pure function of its arguments.

    If `respond` has a third argument, it also receives a `Context`. A law that reads fields may return `supplied`, the
    energy that changing fields supply (points) [J/m2].
    """

    def register(cls: _Class) -> _Class:
        _CLASSES[name] = cls
        return cls

    return register


def make(name: str, parameters: str) -> Any:
    """Creates an object of a registered class."""
    if name not in _CLASSES:
        known = ", ".join(sorted(_CLASSES)) or "none"
        raise KeyError(f'no class is registered as "{name}" with @voussoir.law in this process (registered: {known})')
    return _CLASSES[name](**json.loads(parameters))


def check(name: str, parameters: str, form: str) -> tuple[str, str] | None:
    """Checks a law. Returns the key of its table and the mistake, or None."""
    if name not in _CLASSES:
        known = ", ".join(sorted(_CLASSES)) or "none"
        return "class", f'no class is registered as "{name}" with @voussoir.law in this process (registered: {known})'
    try:
        made = make(name, parameters)
    except Exception as error:  # noqa: BLE001 - any exception of the class is reported
        wanted = inspect.signature(_CLASSES[name])
        return "parameters", f"{name}{wanted} cannot be made with them: {type(error).__name__}: {error}"
    try:
        if form == "facets":
            if not facets(made):
                return "class", f"{name}.facets() is empty"
            stiffness(made)
        else:
            if stiffness(made) is None:
                return "class", f"{name} needs `stiffness`, two numbers [k_n, k_t] in Pa/m"
            state = np.array(initial_state(made), dtype=float)
            names = fields_read(made)
            context = None if names is None else _untouched(names)
            answers = respond(made, np.zeros((1, 2)).tobytes(), state.tobytes(), 1, context)
            if not all(np.all(np.isfinite(np.frombuffer(part))) for part in answers):
                return "class", f"{name}.respond gives numbers that are not finite at the untouched state"
            tangent = np.frombuffer(answers[1]).reshape(2, 2)
            if not (tangent[0, 0] < 0 and np.linalg.det(tangent) > 0):
                told = "a gap must meet a traction that grows against it"
                return "class", f"{name}: the tangent at the untouched state, {tangent.tolist()}, is not stiff: {told}"
    except Exception as error:  # noqa: BLE001
        return "class", f"{name}: {type(error).__name__}: {error}"
    return None


def facets(made: Any) -> list[tuple[str, list[float], float, list[float]]]:
    """Returns the facets of a law in the form that the native module expects."""
    return [(facet.mode, facet.normal, facet.bound, facet.flow) for facet in made.facets()]


def stiffness(made: Any) -> list[float] | None:
    """Returns [k_n, k_t] [Pa/m] if the law has a stiffness."""
    found = getattr(made, "stiffness", None)
    if found is None:
        return None
    numbers = [float(x) for x in (found() if callable(found) else found)]
    if len(numbers) != 2 or not all(x > 0 and np.isfinite(x) for x in numbers):
        raise ValueError("stiffness is two positive numbers, [k_n, k_t] in Pa/m")
    return numbers


def state_names(made: Any) -> list[str]:
    """Returns the name of each number of the state, with its unit."""
    return [str(name) for name in getattr(made, "state_names", ())]


def initial_state(made: Any) -> list[float]:
    """Returns the state of the untouched joint: zeros, unless the class defines `initial_state`."""
    names = state_names(made)
    found = getattr(made, "initial_state", None)
    numbers = [0.0] * len(names) if found is None else [float(x) for x in (found() if callable(found) else found)]
    if len(numbers) != len(names):
        raise ValueError(f"initial_state has {len(numbers)} numbers, state_names {len(names)}")
    return numbers


def fields_read(made: Any) -> list[str] | None:
    """Returns the names of the fields that a law reads, or None if `respond` has no argument for the context."""
    if len(inspect.signature(made.respond).parameters) < 3:
        return None
    return [str(name) for name in getattr(made, "fields", ())]


def _untouched(names: list[str]) -> tuple[bytes, bytes]:
    """Returns the context of one point of a square metre, without duration. All fields are 1, so that the check of a class
    does not meet NaN."""
    return np.array([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0]).tobytes(), np.ones(2 * len(names)).tobytes()


def _context(made: Any, count: int, told: tuple[bytes, bytes]) -> Context:
    names = [str(name) for name in getattr(made, "fields", ())]
    places = np.frombuffer(told[0]).reshape(count, 7)
    fields = np.frombuffer(told[1]).reshape(count, len(names), 2)
    ends = [{name: fields[:, index, end] for index, name in enumerate(names)} for end in range(2)]
    return Context(
        previous_gap=places[:, :2],
        position=places[:, 2:4],
        length=places[:, 4],
        width=places[:, 5],
        time_step=places[:, 6],
        fields=ends[1],
        previous_fields=ends[0],
    )


def respond(
    made: Any, gap: bytes, state: bytes, count: int, context: tuple[bytes, bytes] | None = None
) -> tuple[bytes, ...]:
    """Computes tractions, tangents, states, and stored, dissipated and supplied energies of a group of points."""
    gaps = np.frombuffer(gap).reshape(count, 2)
    old = np.frombuffer(state).reshape(count, len(state_names(made)))
    further = () if context is None else (_context(made, count, context),)

    def ask(gaps: Any) -> dict[str, Any]:
        answer = made.respond(gaps, old, *further)
        return answer if isinstance(answer, dict) else {"traction": answer[0], "state": answer[1]}

    answer = ask(gaps)
    tangent = answer.get("tangent")
    if tangent is None:
        tangent = _differences(lambda gaps: ask(gaps)["traction"], 1e-6 * float(getattr(made, "size", 1e-4)), gaps)
    zeros = np.zeros(count)
    parts = (
        ("traction", answer["traction"], (count, 2)),
        ("tangent", tangent, (count, 2, 2)),
        ("state", answer["state"], old.shape),
        ("stored", answer.get("stored", zeros), (count,)),
        ("dissipated", answer.get("dissipated", zeros), (count,)),
        ("supplied", answer.get("supplied", zeros), (count,)),
    )
    return tuple(_shaped(name, value, shape).tobytes() for name, value, shape in parts)


def _shaped(name: str, value: Any, shape: tuple[int, ...]) -> Any:
    array = np.ascontiguousarray(value, dtype=np.float64)
    if array.shape != shape:
        raise ValueError(f"respond gives {name} of shape {array.shape}, wanted {shape}")
    return array


def _differences(traction: Callable[[Any], Any], step: float, gaps: Any) -> Any:
    """Computes the tangent by differences on the smooth side of each point.

    Next to a corner of the law a central difference mixes the tangents of both sides. On the side of the corner the
    difference changes if the step is halved; the other side is taken. At the corner itself the stiffer side is taken.
    """
    here = np.asarray(traction(gaps))
    tangent = np.empty((len(gaps), 2, 2))
    for j in range(2):

        def slope(length: float, j: int = j) -> Any:
            shift = np.zeros(2)
            shift[j] = length
            return (np.asarray(traction(gaps + shift)) - here) / length

        ahead, behind = slope(step), slope(-step)
        bend_ahead = np.abs(ahead - slope(step / 2)).max(axis=1)
        bend_behind = np.abs(behind - slope(-step / 2)).max(axis=1)
        largest = np.abs(ahead).max(axis=1) + np.abs(behind).max(axis=1)
        smooth = np.abs(ahead - behind).max(axis=1) <= 1e-3 * largest
        at_corner = np.maximum(bend_ahead, bend_behind) <= 1e-3 * largest
        stiffer = np.abs(ahead).max(axis=1) > np.abs(behind).max(axis=1)
        side = np.where(np.where(at_corner, stiffer, bend_ahead < bend_behind)[:, None], ahead, behind)
        tangent[:, :, j] = np.where(smooth[:, None], (ahead + behind) / 2, side)
    return tangent
