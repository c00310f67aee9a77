"""Elastic blocks with dry joints to their limit load: Voussoir's two path solvers and GetFEM, on one mesh.

    apt-get install python3-getfem                                   # Debian 12: GetFEM 5.4.2
    /usr/bin/python3 elastic_path.py --voussoir ../../target/release/voussoir ring:13

The ring of `scenes.py` in plane stress, E = 5 GPa, ν = 0.3, 6 elements along a voussoir × 4 across, nine nodes each, contact at
the nodes of the joints. GetFEM gets what suits it: forces in units of a voussoir's weight, lengths in units of the
displacement of a block under it, nodal multipliers (Alart and Curnier), joints pressed to begin with, and the load as the
multiplier of the displacement at its point, so that the limit is a plateau that any large displacement reaches, not a failure
to converge. It is run with several numbers of increments; told is the least processor time to an error of the limit load.

With small displacements and strengths of the joints' ends alone the limit load is that of rigid blocks, which linear programming
gives (`limit_load.py`): that is the reference, and it is no answer of a path solver. A program that is not installed is left out.
"""

import dataclasses
import math
import os
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")  # before NumPy and GetFEM are loaded: waiting threads count as processor time

from limit_load import append_rows, arguments, by_paths, by_voussoir, report
from scenes import RING, area_and_centre, ring, ring_joints

YOUNG, POISSON = 5e9, 0.3
MESH = (6, 4, 2)  # elements along a voussoir, across it, order
INCREMENTS, AUGMENTATIONS, TOLERANCES = [100.0, 400.0, 2000.0], [0.1, 0.3, 1.0], [1e-3, 1e-6, 1e-9]


def elastic(count, solver):
    """The scene of that ring with elastic blocks, for one of Voussoir's path solvers."""
    along, across, order = MESH
    scene = ring(count)
    text = scene.study.replace('law = "rigid"', f'law = "elastic"\nyoung_modulus = {YOUNG}\npoisson_ratio = {POISSON}')
    text = text.replace('solver = "auto"', f'solver = "{solver}"')
    mesh = f"mesh = {{ elements = [{along}, {across}], order = {order} }}\n"
    return dataclasses.replace(scene, study=text.replace('material = "stone"\n', 'material = "stone"\n' + mesh, 1))


class GetfemRing:
    """The ring as GetFEM has it. Blocks stand far apart, since its mesh would join their common points: gaps are differences
    of displacements, which do not see where blocks stand."""

    APART = 100.0  # m
    NEWTON = ("max_res", 1e-9, "max_iter", 30, "lsearch", "simplest", "alpha min", 0.3, "lsolver", "mumps")
    augmentation = 0.3  # of Alart and Curnier

    def __init__(self, count):
        import getfem
        import numpy

        self.gf, self.np = getfem, numpy
        along, across, order = MESH
        getfem.util("trace level", 0)
        getfem.util("warning level", 0)
        self.count, self.order = count, order
        self.inside, self.outside, self.angles = ring_joints(count)
        corners = [[self.inside[k], self.outside[k], self.inside[k + 1], self.outside[k + 1]] for k in range(count)]
        outlines = [[c[2], c[3], c[1], c[0]] for c in corners]
        self.unit = max(area_and_centre(outline)[0] for outline in outlines) * RING["density"] * 9.81
        self.soften = self.unit / YOUNG  # m; a unit of displacement
        self.mesh = getfem.Mesh("empty", 2)
        across_map = getfem.GeoTrans("GT_QK(2,1)")
        for k, corner in enumerate(corners):
            for i in range(along):
                for j in range(across):
                    points = [self.place(k, corner, (j + a) / across, (i + b) / along) for b in (0, 1) for a in (0, 1)]
                    self.mesh.add_convex(across_map, numpy.array(points).T)
        self.field = getfem.MeshFem(self.mesh, 2)
        self.field.set_fem(getfem.Fem(f"FEM_QK(2,{order})"))
        self.quadrature = getfem.MeshIm(self.mesh, getfem.Integ(f"IM_GAUSS_PARALLELEPIPED(2,{2 * order})"))
        self.nodes = {}
        for dof, (x, y) in enumerate(self.field.basic_dof_nodes().T[::2]):
            self.nodes[round(x, 7), round(y, 7)] = 2 * dof
        self.joints = self.contact_rows(corners, across)
        self.load = self.load_row(corners, along)

    def place(self, k, corner, s, t):
        """At the share s of the thickness from inside, t of the way from the block's first joint to its second."""
        weights = ((1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t)
        x, y = (sum(w * c[i] for w, c in zip(weights, corner)) for i in range(2))
        return x, y + self.APART * k

    def node(self, point):
        """First degree of freedom there; y may be off in the last digit of the rounding."""
        x, y = round(point[0], 7), round(point[1], 7)
        near = ((round(x + dx, 7), round(y + dy, 7)) for dx in (0, 1e-7, -1e-7) for dy in (0, 1e-7, -1e-7))
        return next(self.nodes[p] for p in near if p in self.nodes)

    def contact_rows(self, corners, across):
        """Rows of the approach (B_n u ≤ 0) and of the slip at each node of each joint."""
        normal, slip, count = [], [], self.order * across
        for k, a in enumerate(self.angles):
            n, t = (math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a))
            for i in range(count + 1):
                share, row, turned = i / count, {}, {}
                sides = [(k - 1, 1.0, 1.0)] if k > 0 else []
                sides += [(k, 0.0, -1.0)] if k < self.count else []
                for block, end, sign in sides:
                    dof = self.node(self.place(block, corners[block], share, end))
                    for axis in range(2):
                        row[dof + axis] = sign * n[axis]
                        turned[dof + axis] = sign * t[axis]
                normal.append(row)
                slip.append(turned)
        return self.matrix(normal), self.matrix(slip)

    def matrix(self, rows):
        """A matrix of GetFEM from rows {column: value}."""
        matrix = self.gf.Spmat("empty", len(rows), self.field.nbdof())
        for i, row in enumerate(rows):
            for j, value in row.items():
                matrix.add(i, j, value)
        return matrix

    def load_row(self, corners, along):
        """Displacement downwards at the load's point: the shape functions of the edge that it stands on."""
        x = -RING["span"] / 4
        k = next(k for k in range(self.count) if self.outside[k][0] <= x < self.outside[k + 1][0])
        t = (x - self.outside[k][0]) / (self.outside[k + 1][0] - self.outside[k][0]) * along
        element = min(int(t), along - 1)
        row = {}
        for i in range(self.order + 1):
            value = 1.0
            for j in range(self.order + 1):
                if j != i:
                    value *= ((t - element) * self.order - j) / (i - j)
            row[self.node(self.place(k, corners[k], 1.0, (element + i / self.order) / along)) + 1] = -value
        return self.matrix([row])

    def model(self):
        """Elasticity, weight, contact with friction, and a displacement that the load keeps. E is 1."""
        np, normal = self.np, self.joints[0]
        model = self.gf.Model("real")
        model.add_fem_variable("u", self.field)
        model.add_initialized_data("E", [1.0])
        model.add_initialized_data("nu", [POISSON])
        model.add_isotropic_linearized_elasticity_pstress_brick(self.quadrature, "u", "E", "nu")
        model.add_initialized_data("weight", [0.0, -RING["density"] * 9.81 / self.unit])
        model.add_source_term_brick(self.quadrature, "u", "weight")
        points = normal.size()[0]
        for name in ("pressure", "shear"):
            model.add_variable(name, points)
        model.add_initialized_data("r", [self.augmentation])
        model.add_initialized_data("friction", [RING["friction"]])
        model.add_initialized_data("gap", np.zeros(points))
        model.add_initialized_data("alpha", np.ones(points))
        model.add_basic_contact_brick("u", "pressure", "shear", "r", *self.joints, "friction", "gap", "alpha", 1)
        model.set_variable("pressure", -np.ones(points))  # seeded: all joints pressed
        return model

    def solve(self, first, tolerance):
        """Load factor on the plateau and the number of Newton iterations. The displacement's increments, `first` to begin with,
        are doubled where Newton's method converges and halved where it does not, until one changes the load by no more than
        the tolerance, relative. (An increment on the plateau costs one or two iterations.)"""
        model, names = self.model(), ("u", "pressure", "shear", "load")
        total, converged = model.solve(*self.NEWTON)
        if not converged:
            raise ArithmeticError("no convergence under the dead load")
        reach = self.load.mult(model.variable("u"))[0]
        model.add_variable("load", 1)
        model.add_initialized_data("reach", [reach])
        model.add_constraint_with_multipliers("u", "load", self.load, "reach")
        step, kept = first, [model.variable(name) for name in names]
        while step > 1e-6 * first:
            model.set_variable("reach", [reach + step])
            iterations, converged = model.solve(*self.NEWTON)
            total += iterations
            if not converged:
                for name, values in zip(names, kept):
                    model.set_variable(name, values)
                step /= 2
                continue
            before, reach, step = kept[-1][0], reach + step, 2 * step
            kept = [model.variable(name) for name in names]
            if abs(kept[-1][0] - before) <= tolerance * abs(before):
                return -kept[-1][0] * self.unit / 1000.0, total
        raise ArithmeticError("increments vanish")


def by_getfem(peer, first, augmentation, tolerance):
    """Seconds and factor of a run; infinite where it fails."""
    start = time.process_time()
    peer.augmentation = augmentation
    try:
        factor, _ = peer.solve(first, tolerance)
    except (ArithmeticError, RuntimeError) as failure:
        print(f"    GetFEM from increments of {first:g}, r = {augmentation:g}: {failure}")
        return math.inf, math.inf
    return time.process_time() - start, factor


def measure(count, program, getfem, rounds):
    """The limit load of rigid blocks, and name → [(seconds, load factor)], by turns."""
    reference = by_voussoir(program, ring(count))[0]
    peer = GetfemRing(count) if getfem else None
    results = {}
    for _ in range(rounds):
        by_paths(program, lambda solver: elastic(count, solver), results)
        settings = [(i, a, t) for i in INCREMENTS for a in AUGMENTATIONS for t in TOLERANCES] if getfem else []
        for setting in settings:
            seconds, factor = by_getfem(peer, *setting)
            results.setdefault("GetFEM", []).append((seconds, factor))
    return reference, results


def main():
    options = arguments(__doc__, ["ring:13"], 2)
    try:
        import getfem

        print("GetFEM", getfem.getfem_env("version") if hasattr(getfem, "getfem_env") else "of this Python")
    except ImportError:
        getfem = None
        print("GetFEM is not installed for this Python, left out (Debian: python3-getfem, for /usr/bin/python3)")
    for word in options.scenes:
        count = int(word.removeprefix("ring:"))
        reference, results = measure(count, options.voussoir, getfem is not None, options.rounds)
        report(elastic(count, "auto"), reference, results)
        append_rows(options.csv, f"elastic, scene.voussoirs = {count}", results)


if __name__ == "__main__":
    main()
