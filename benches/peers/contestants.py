"""Other programs on the linear program of a scene: each takes a tolerance and returns the load factor that it says.

Variables x = (r, λ), λ to be the greatest; E r + λ p = −w; F r ≤ h; normal forces not negative. Data are made once; what is
timed is setting up the program and solving it.
"""

import numpy as np
import scipy.sparse as sp

from scenes import friction_rows


class Data:
    """Matrices in the forms that programs want."""

    def __init__(self, scene, relief=None, dilatancy=None):
        joints = scene.equilibrium.shape[1] // 3
        self.equalities = sp.hstack([scene.equilibrium, scene.varying.reshape(-1, 1)], format="csc")
        self.right = -scene.fixed
        flow = friction_rows(joints, scene.friction if dilatancy is None else dilatancy)
        self.rows = sp.hstack([flow, sp.csc_matrix((flow.shape[0], 1))], format="csc")
        self.bounds = np.zeros(flow.shape[0]) if relief is None else relief
        self.count = self.equalities.shape[1]
        normal = np.arange(self.count - 1) % 3 < 2
        self.pressed = np.flatnonzero(normal)
        self.lower = np.where(np.append(normal, False), 0.0, -np.inf)
        signs = (-np.ones(len(self.pressed)), (np.arange(len(self.pressed)), self.pressed))
        positive = sp.csc_matrix(signs, shape=(len(self.pressed), self.count))
        self.inequalities = sp.vstack([self.rows, positive], format="csc")
        self.limits = np.append(self.bounds, np.zeros(len(self.pressed)))
        self.cost = np.zeros(self.count)
        self.cost[-1] = -1.0
        self.unit = scene.unit


def piqp(data, tolerance):
    """PIQP's sparse interior point; no objective of second order."""
    import piqp as program

    solver = program.SparseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = tolerance
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = tolerance
    solver.settings.max_iter = 500
    none = sp.csc_matrix((data.count, data.count))
    lowest = np.full(len(data.bounds), -np.inf)
    solver.setup(none, data.cost, data.equalities, data.right, data.rows, lowest, data.bounds, data.lower, None)
    solver.solve()
    return solver.result.x[-1]


def clarabel(data, tolerance):
    """Clarabel."""
    import clarabel as program

    settings = program.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    matrix = sp.vstack([data.equalities, data.inequalities], format="csc")
    right = np.append(data.right, data.limits)
    cones = [program.ZeroConeT(len(data.right)), program.NonnegativeConeT(len(data.limits))]
    none = sp.csc_matrix((data.count, data.count))
    return program.DefaultSolver(none, data.cost, matrix, right, cones, settings).solve().x[-1]


def ecos(data, tolerance):
    """ECOS."""
    import ecos as program

    answer = program.solve(
        data.cost,
        data.inequalities,
        data.limits,
        {"l": len(data.limits), "q": []},
        data.equalities,
        data.right,
        abstol=tolerance,
        reltol=tolerance,
        feastol=tolerance,
        verbose=False,
    )
    return answer["x"][-1]


def highs(data, tolerance, method="simplex"):
    """HiGHS: dual simplex, or interior point without crossover."""
    import highspy as program

    solver = program.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("threads", 1)
    solver.setOptionValue("solver", method)
    solver.setOptionValue("run_crossover", "off")
    for name in ("primal_feasibility_tolerance", "dual_feasibility_tolerance"):
        solver.setOptionValue(name, min(max(tolerance, 1e-10), 1e-3))
    solver.setOptionValue("ipm_optimality_tolerance", min(max(tolerance, 1e-12), 1e-3))
    model, infinity = program.HighsLp(), program.kHighsInf
    matrix = sp.vstack([data.equalities, data.rows], format="csc")
    model.num_col_, model.num_row_ = data.count, matrix.shape[0]
    model.col_cost_ = data.cost
    model.col_lower_ = np.where(np.isfinite(data.lower), data.lower, -infinity)
    model.col_upper_ = np.full(data.count, infinity)
    model.row_lower_ = np.append(data.right, np.full(len(data.bounds), -infinity))
    model.row_upper_ = np.append(data.right, data.bounds)
    model.a_matrix_.format_ = program.MatrixFormat.kColwise
    model.a_matrix_.start_, model.a_matrix_.index_, model.a_matrix_.value_ = matrix.indptr, matrix.indices, matrix.data
    solver.passModel(model)
    solver.run()
    data.answer = np.array(solver.getSolution().col_value)
    return data.answer[-1]


def highs_interior_point(data, tolerance):
    """HiGHS by its interior point."""
    return highs(data, tolerance, "ipm")


CONTESTANTS = {
    "PIQP": ("piqp", piqp),
    "Clarabel": ("clarabel", clarabel),
    "ECOS": ("ecos", ecos),
    "HiGHS simplex": ("highspy", highs),
    "HiGHS interior point": ("highspy", highs_interior_point),
}
