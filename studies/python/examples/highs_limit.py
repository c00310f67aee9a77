"""A limit solver on HiGHS, compared with the built-in one on an arch: `pip install scipy`, then run this file."""

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array

import voussoir


@voussoir.limit_solver("highs")
class Highs:
    """Limit analysis by the dual simplex method of HiGHS."""

    def __init__(self, tolerance=1e-10):
        self.options = {"primal_feasibility_tolerance": tolerance, "dual_feasibility_tolerance": tolerance}

    def solve(self, program):
        matrix = csr_array((program.data, program.indices, program.indptr), shape=program.shape)
        equations, goal = program.equations, np.zeros(program.shape[1])
        goal[-1] = -1.0
        found = linprog(
            goal,
            A_eq=matrix[:equations],
            b_eq=program.row_bounds[:equations, 1],
            A_ub=matrix[equations:],
            b_ub=program.row_bounds[equations:, 1],
            bounds=program.column_bounds,
            method="highs-ds",
            options=self.options,
        )
        if found.status != 0:
            raise ValueError(found.message)
        return found.x, found.eqlin.marginals


if __name__ == "__main__":
    arch = {
        "name": "arch",
        "scene": {
            "scene": "arch", "profile": {"shape": "segmental", "span": 4.0, "rise": 1.0}, "thickness": 0.5, "width": 1.0,
            "voussoirs": 15, "material": "stone", "joint": "dry",
        },
        "materials": {"stone": {"law": "rigid", "density": 2200.0}},
        "joints": {"dry": {"law": "coulomb_associated", "friction": 0.6}},
        "stages": [
            {"name": "dead", "gravity": 9.81},
            {"name": "live", "until": "collapse", "loads": [{"kind": "point", "span_fraction": 0.25, "force": [0.0, -1000.0]}]},
        ],
    }  # fmt: skip
    for solver in ({"solver": "python_limit", "class": "highs"}, {"solver": "auto"}):
        case = voussoir.run({**arch, "solver": solver})[0]
        print(f"{case.solver:14} {case.status} {case.load_factor:.9f} certified: {case.certified}")
