"""Tests of limit solvers written in Python."""

import runpy
from pathlib import Path

import numpy as np
import pytest

import voussoir

EXAMPLE = Path(__file__).parents[1] / "examples" / "highs_limit.py"
HIGHS = {"solver": "python_limit", "class": "highs"}


@pytest.fixture(scope="module", autouse=True)
def highs():
    pytest.importorskip("scipy")
    runpy.run_path(str(EXAMPLE))


def study(scene, load, joint=None, friction=0.6, **stage):
    return {
        "name": "scene",
        "scene": {**scene, "width": 1.0, "material": "stone", "joint": "dry"},
        "materials": {"stone": {"law": "rigid", "density": 2200.0}},
        "joints": {"dry": {"law": "mohr_coulomb", "friction": friction, **(joint or {})}},
        "stages": [{"name": "dead", "gravity": 9.81}, {"name": "live", "loads": [load], **(stage or {"until": "collapse"})}],
    }


def arch(thickness=0.5, voussoirs=7):
    profile = {"shape": "segmental", "span": 4.0, "rise": 1.0}
    return {"scene": "arch", "profile": profile, "thickness": thickness, "voussoirs": voussoirs}


WALL = {"scene": "wall", "brick": [0.4, 0.2], "rows": [[0.5, 1, 1, 0.5], [1, 1, 1], [0.5, 1, 1, 0.5]]}
BLOCK = {
    "scene": "blocks",
    "blocks": [
        {"name": "ground", "fixed": True, "vertices": [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]]},
        {"name": "stone", "vertices": [[-0.5, 0.0], [0.5, 0.0], [0.5, 0.5], [-0.5, 0.5]]},
    ],
}
PUSH = {"kind": "body", "acceleration": [9.81, 0.0]}


def point(at, force):
    return {"kind": "point", "span_fraction": at, "force": force}


def on_block(force):
    return {"kind": "point", "block": "stone", "point": [0.0, 0.5], "force": force}


SCENES = {
    "arch": study(arch(), point(0.25, [0.0, -1000.0])),
    "arch to a factor below its collapse": study(arch(), point(0.25, [0.0, -1000.0]), factor=2.0),
    "arch to a factor above its collapse": study(arch(), point(0.25, [0.0, -1000.0]), factor=1000.0),
    "arch too thin for its weight": study(arch(0.02), point(0.25, [0.0, -1000.0])),
    "thin arch": study(arch(0.05), point(0.25, [0.0, -1000.0])),
    "arch with cohesion": study(arch(0.4), point(0.25, [0.0, -1000.0]), {"cohesion": 2e4, "tensile_strength": 1e4}),
    "arch of 40 voussoirs": study(arch(0.4, 40), point(0.3, [0.0, -1.0]), friction=0.7),
    "arch pushed sideways": study(arch(0.5, 9), PUSH),
    "wall": study(WALL, PUSH, friction=0.65),
    "wall that slides": study(WALL, PUSH, friction=0.2),
    "block pushed": study(BLOCK, on_block([1000.0, 0.0]), friction=0.4),
    "block tipped": study(BLOCK, on_block([1000.0, 0.0]), friction=2.0),
    "block pressed": study(BLOCK, on_block([100.0, -1000.0]), friction=0.4),
    "block lifted": study(BLOCK, on_block([0.0, 1000.0]), friction=0.4),
}


def solved(study, solver):
    return voussoir.run({**study, "solver": solver})[0]


@pytest.mark.parametrize("name", SCENES)
def test_highs_agrees_with_limit_conic(name):
    own, conic = solved(SCENES[name], HIGHS), solved(SCENES[name], {"solver": "limit_conic"})
    assert own.certified and own.solver == "python_limit", own.notes
    assert own.status == conic.status
    if conic.load_factor is not None:
        assert own.load_factor == pytest.approx(conic.load_factor, rel=1e-7, abs=1e-10)


def test_the_scenes_have_every_status():
    statuses = {solved(study, {"solver": "limit_conic"}).status for study in SCENES.values()}
    assert statuses == {"stands", "collapse", "unbounded", "no_equilibrium"}


@voussoir.limit_solver("liar")
class Liar:
    """Returns a false solution of one kind."""

    def __init__(self, lie):
        self.lie = lie

    def solve(self, program):
        from voussoir._solvers import _CLASSES

        x, duals = (np.array(part) for part in _CLASSES["highs"]().solve(program))
        match self.lie:
            case "factor":
                x[-1] *= 1.01
            case "forces":
                x[0] += 0.1
            case "duals":
                duals[:] = np.arange(len(duals)) - 3.0
            case "everything is carried":
                x[-1] = min(program.column_bounds[-1, 1], 1e6)
            case "nan":
                x[-1] = np.nan
            case "short":
                x = x[1:]
            case "raises":
                raise RuntimeError("out of order")
        return x, duals


@pytest.mark.parametrize("lie", ["factor", "forces", "duals", "everything is carried", "nan", "short", "raises"])
def test_a_false_solution_proves_nothing(lie):
    case = solved(SCENES["arch"], {"solver": "python_limit", "class": "liar", "parameters": {"lie": lie}})
    assert case.status in ("stalled", "open") and not case.certified, (case.status, case.notes)


def test_a_program_has_names_and_arrays():
    seen = []

    @voussoir.limit_solver("seen")
    class Seen:
        def solve(self, program):
            seen.append(program)
            raise ValueError("no")

    solved(SCENES["block pushed"], {"solver": "python_limit", "class": "seen"})
    program = seen[0]
    rows, columns = program.shape
    assert program.dense().shape == (rows, columns) and program.equations == 3
    assert program.joint.tolist() == [0, 0, 0, -1] and program.component.tolist() == [0, 1, 2, -1]
    # Both normal forces press upwards on the block, the shear to one side, and the weight is the third equation's unit.
    assert np.allclose(np.abs(program.dense()[1, :2]), 1.0) and program.dense()[1, 2] == 0.0


def test_mistakes_in_solvers_are_told():
    def wrong(**table):
        with pytest.raises(voussoir.StudyError) as found:
            voussoir.check({**SCENES["arch"], "solver": {"solver": "python_limit", **table}})
        return str(found.value)

    @voussoir.limit_solver("idle")
    class Idle:
        pass

    assert "no class is registered" in wrong(**{"class": "nobody"})
    assert "cannot be made" in wrong(**{"class": "highs", "parameters": {"x": 1}})
    assert "no method `solve(program)`" in wrong(**{"class": "idle"})
    assert "class" in wrong()
    crushing = {**SCENES["arch"], "joints": {"dry": {"law": "mohr_coulomb", "friction": 0.6, "compressive_strength": 1e6}}}
    case = solved(crushing, HIGHS)
    assert case.status == "stalled" and any("a cone" in note for note in case.notes)
