"""Charts of results with matplotlib."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._tables import header

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._results import Array, Case, Results

#: An axis over a larger ratio of values is logarithmic.
DECADES = 100.0
#: Greatest displacement in a picture, as a share of the size of the scene.
MAGNIFIED = 0.04
STONE, EDGE, GROUND, THRUST, MOTION = "#e9dfcb", "#6b6150", "#cccccc", "#00795a", "#c8102e"


def plot(results: Results, what: str | None, case: int | None, variant: str | None, ax: Axes | None) -> Axes:
    """Draws one chart into `ax` or into a new figure."""
    charts: dict[str, Callable[[Results, int | None, str | None, Axes], None]]
    charts = {"map": _map, "sweep": _sweep, "curve": _curve, "mechanism": _mechanism}
    chosen = what or ("mechanism" if case is not None else _first(results))
    if chosen not in charts:
        raise ValueError(f"there is no plot {chosen!r}: choose {', '.join(sorted(charts))}")
    names = [own.raw.get("variant") for own in results]
    if variant is not None and variant not in names:
        known = ", ".join(sorted({str(name) for name in names if name is not None})) or "none"
        raise ValueError(f"there is no variant {variant!r}; variants: {known}")
    if ax is not None:
        charts[chosen](results, case, variant, ax)
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("Results.plot needs matplotlib: pip install matplotlib") from error
    figure, ax = pyplot.subplots(layout="constrained")
    try:
        charts[chosen](results, case, variant, ax)
    except BaseException:
        # A notebook would show the empty figure.
        pyplot.close(figure)
        raise
    return ax


def _first(results: Results) -> str:
    if "map" in results.raw.get("comparison", {}):
        return "map"
    if "worsts" in results.raw or _numbers(results):
        return "sweep"
    return "curve" if any("curve" in case.raw or "rows" in case.raw for case in results) else "mechanism"


def _numbers(results: Results) -> list[str]:
    """The parameters with several numbers, for cases with load factors; for an optimisation, the optimised one is first."""
    values: dict[str, set[float]] = {}
    for case in (own for own in results if own.raw.get("load_factor") is not None):
        for key, value in case.raw.get("parameters", {}).items():
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                values.setdefault(key, set()).add(value)
    several = [key for key, own in values.items() if len(own) > 1]
    searched = [entry["parameter"] for entry in results.raw.get("optima", [])]
    return sorted(several, key=lambda key: key not in searched)


def _title(results: Results, key: str) -> str:
    """The name of a column with its unit."""
    return next((name for name in header(results.files) if name.split(" [")[0] == key), key)


def _words(*values: Any, **named: Any) -> str:
    """The label of a line: values that are given, and parameters."""
    texts = [str(value) for value in values if value is not None]
    shown = {key: f"{value:g}" if isinstance(value, float) else value for key, value in named.items()}
    return ", ".join([*texts, *(f"{key.split('.')[-1]} = {value}" for key, value in shown.items())])


def _scale(set_scale: Callable[[str], object], values: Iterable[float]) -> None:
    """Makes an axis logarithmic if its values are positive and far apart."""
    finite = [value for value in values if math.isfinite(value)]
    if finite and min(finite) > 0 and max(finite) > DECADES * min(finite):
        set_scale("log")


def _lines(ax: Axes, lines: dict[str, list[tuple[float, float]]]) -> None:
    """Lines by label, each in order of x, with a legend if there are several."""
    for label, points in lines.items():
        x, y = np.array(sorted(points), dtype=float).T
        ax.plot(x, y, marker="." if len(x) <= 60 else "", label=label)
    if len(lines) > 1:
        ax.legend(fontsize="small")
    for set_scale, side in ((ax.set_xscale, 0), (ax.set_yscale, 1)):
        _scale(set_scale, (point[side] for points in lines.values() for point in points))
    ax.grid(alpha=0.3)


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _sweep(results: Results, case: int | None, variant: str | None, ax: Axes) -> None:
    lines: dict[str, list[tuple[float, float]]] = {}
    if "worsts" in results.raw:
        for own in results.raw.get("curve", []):
            if variant in (None, own["variant"]):
                label = _words(own["variant"], own["vehicle"], own["direction"], **own["parameters"])
                lines.setdefault(label, []).append((own["value"], _number(own["result"])))
        name = results.raw["worsts"][0]["parameter"]
    else:
        keys = _numbers(results)
        if not keys:
            raise ValueError("these results have no swept number")
        name, others = keys[0], keys[1:]
        for own in results:
            parameters = own.raw.get("parameters", {})
            if name in parameters and variant in (None, own.raw.get("variant")):
                rest = {key: value for key, value in parameters.items() if key in others or isinstance(value, str)}
                label = _words(own.raw.get("variant"), own.raw.get("scene"), **rest)
                lines.setdefault(label, []).append((parameters[name], _number(own.raw.get("load_factor"))))
    _lines(ax, lines)
    for own in [*results.raw.get("worsts", []), *results.raw.get("optima", [])]:
        x, y = own["value"], own["result"]
        if None not in (x, y) and variant in (None, own["variant"]):
            ax.plot([x], [y], "o", mfc="none", ms=9, color=MOTION)
            ax.annotate(f"{y:.4g}", (x, y), xytext=(6, -12), textcoords="offset points", color=MOTION)
    ax.set_xlabel(_title(results, name))
    ax.set_ylabel("load_factor [-]")


def _chosen(results: Results, case: int | None, variant: str | None) -> list[Case]:
    if case is not None:
        return [results.case(case)]
    return [own for own in results if variant in (None, own.raw.get("variant"))]


def _curve(results: Results, case: int | None, variant: str | None, ax: Axes) -> None:
    curves = [own for own in _chosen(results, case, variant) if "curve" in own.raw or "rows" in own.raw]
    if not curves:
        raise ValueError("there is no curve: set curve = true in [output] and follow a path")
    labels = ("displacement [m]", "load_factor [-]")
    for own in curves:
        values = own.curve
        if values is None:
            values, labels = _driven(own, curves[0])
        words = _words(own.raw.get("variant"), own.raw.get("scene"), **own.raw.get("parameters", {}))
        (line,) = ax.plot(values[:, 0], values[:, 1], label=words or f"case {own.raw['id']}")
        factor = own.raw.get("load_factor")
        if factor is not None:
            ax.axhline(factor, color=line.get_color(), lw=0.8, ls=":")
    ax.set_xlabel(labels[0])
    ax.set_ylabel(labels[1])
    if len(curves) > 1:
        ax.legend(fontsize="small")
    ax.grid(alpha=0.3)


def _driven(case: Case, first: Case) -> tuple[Array, tuple[str, str]]:
    """Traction over gap of a driven point, in the direction in which the gap of the first case changes most."""
    names = case.raw["columns"]
    rows, leading = case.rows, first.rows
    assert rows is not None and leading is not None
    gaps = [index for index, name in enumerate(names) if name.startswith("gap_")]
    gap = max(gaps, key=lambda index: float(np.ptp(leading[:, index])))
    traction = next(index for index, name in enumerate(names) if name.startswith(names[gap][:5].replace("gap", "traction")))
    return rows[:, [gap, traction]], (names[gap], names[traction])


def _map(results: Results, case: int | None, variant: str | None, ax: Axes) -> None:
    comparison = results.raw.get("comparison", {})
    if "map" not in comparison:
        raise ValueError('these results have no map: their study is not of the kind "map"')
    from matplotlib.ticker import MaxNLocator

    axes = comparison["map"]
    name = variant or axes["contours"]
    column = comparison["voices"].index(name)
    ratio = name != comparison["reference"]
    shape = (len(axes["x_values"]), len(axes["y_values"]))
    cells = [row["cells"][column]["ratio" if ratio else "load_factor"] for row in comparison["rows"]]
    values = np.array([_number(cell) for cell in cells]).reshape(shape).T
    x, y = np.array(axes["x_values"]), np.array(axes["y_values"])
    # Contours need values in order.
    by_x, by_y = np.argsort(x), np.argsort(y)
    x, y, values = x[by_x], y[by_y], values[np.ix_(by_y, by_x)]
    colours = ax.pcolormesh(x, y, np.ma.masked_invalid(values), shading="nearest", cmap="viridis")
    words = f"load of {name} / load of {comparison['reference']} [-]" if ratio else f"load factor of {name} [-]"
    ax.figure.colorbar(colours, ax=ax, label=words)
    least, greatest = np.nanmin(values), np.nanmax(values)
    # A level that many values have, such as the ratio 1, would follow their rounding.
    same = 1e-6 * abs(greatest)
    levels = [level for level in MaxNLocator(7).tick_values(least, greatest) if least + same < level < greatest - same]
    if min(shape) > 1 and levels:
        ax.clabel(ax.contour(x, y, values, levels, colors="white", linewidths=0.8), fontsize="small")
    _scale(ax.set_xscale, x)
    _scale(ax.set_yscale, y)
    ax.set_xlabel(axes["x_label"])
    ax.set_ylabel(axes["y_label"])


def moved(points: Array, centre: Array, twist: Array) -> Array:
    """Points of a body after unit time with a twist (velocity of its centre, rotation); exact for any angle."""
    turn = float(twist[2])
    along = np.sinc(turn / np.pi)
    across = 0.0 if turn == 0.0 else 2.0 * math.sin(turn / 2.0) ** 2 / turn
    cos, sin = math.cos(turn), math.sin(turn)
    shift = np.array([along * twist[0] - across * twist[1], across * twist[0] + along * twist[1]])
    return np.asarray(centre + shift + (points - centre) @ np.array([[cos, sin], [-sin, cos]]))


def _mechanism(results: Results, case: int | None, variant: str | None, ax: Axes) -> None:
    found = results.case(case) if case is not None else results.worst
    if found is None or "mechanism" not in found.raw:
        raise ValueError('give the id of a case: plot("mechanism", case=…)' if found is None else f"{found!r} has no blocks")
    blocks = results.blocks(found.raw["id"])
    corners = np.concatenate([block.vertices for block in blocks])
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    twists = np.zeros((len(blocks), 3))
    if found.motion is not None:
        twists = found.motion["velocity"]
    elif isinstance(found.displacements, dict) and "displacement" in found.displacements:
        twists = found.displacements["displacement"]
    shown = [(block, twist) for block, twist in zip(blocks, twists) if len(block.vertices)]
    # The way of the fastest corner for a millionth of the motion.
    way = max(np.abs(moved(own.vertices, own.centroid, 1e-6 * twist) - own.vertices).max() for own, twist in shown)
    share = 1e-6 * MAGNIFIED * size / way if way > 0 else 0.0
    for block, twist in shown:
        corners = moved(block.vertices, block.centroid, share * twist)
        ax.fill(*corners.T, lw=0.8, fc=GROUND if block.fixed else STONE, ec=EDGE)
        if share and not block.fixed:
            ax.fill(*block.vertices.T, fill=False, ec=EDGE, lw=0.5, ls=":")
    # The thrust line is that of the blocks at rest; hinges move with one of their blocks.
    if found.thrust_line is not None and not share:
        ax.plot(*found.thrust_line.T, color=THRUST, lw=1.5, label="thrust line")
        ax.legend(fontsize="small")
    places = {block.name: (block, twist) for block, twist in shown}
    for hinge in (found.raw["mechanism"] or {}).get("hinges", []):
        point, held = np.array(hinge["point"]), places.get(hinge["between"][0])
        at = moved(point, held[0].centroid, share * held[1]) if held else point
        ax.plot(*at, "o", ms=5, mfc="white", color=MOTION)
    factor = found.raw.get("load_factor")
    words = found.raw["status"].replace("_", " ") + ("" if factor is None else f", load factor {factor:.5g}")
    ax.set_title(f"case {found.raw['id']}: {words}", fontsize="medium")
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
