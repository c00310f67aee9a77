"""Rigid blocks on compliant joints that only press, to their limit load: Voussoir's two path solvers and OpenSeesPy.

    apt-get install libblas3 liblapack3 libgfortran5                  # what OpenSees is linked with (Debian 12)
    venv/bin/pip install openseespy==3.7.1.2
    venv/bin/python compliant_path.py --voussoir ../../target/release/voussoir ring:13 ring:100

The ring of `scenes.py` on joints of 20 GPa/m across and half of that along them, nine contact points to a joint, small
displacements; joints never slide, so that all is elastic and the limit load is that of rigid blocks without sliding, which
linear programming gives: that is the reference, and it is no answer of a path solver. OpenSees gets what suits it: a section of
nine fibres without tension to a joint (`zeroLengthSection`), one rigid link from it to the centre of each block, forces in kN,
and the load as what keeps the displacement of its block, so that the limit is a plateau; increments double until the load stays
within the tolerance. Several first increments and solvers are tried; told is the least processor time to an error.
"""

import dataclasses
import math
import os
import time

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")  # before NumPy is loaded: waiting threads count as processor time

from limit_load import append_rows, arguments, by_paths, by_voussoir, report
from scenes import QUIET, RING, area_and_centre, ring, ring_joints, studies

STIFFNESS = (2e10, 1e10)  # across and along a joint, Pa/m
SEGMENTS = 4  # of quadratic contact along a joint: nine points
INCREMENTS, TOLERANCES, SYSTEMS = [1e-6, 1e-5, 1e-4], [1e-3, 1e-6, 1e-9], ["BandGeneral", "UmfPack"]
STUCK = 'law = "unilateral"\ntangential = "stuck"'


def compliant(count, solver):
    """The scene with joints that give, for one of Voussoir's solvers."""
    joint = f"{STUCK}\nnormal_stiffness = {STIFFNESS[0]}\nshear_stiffness = {STIFFNESS[1]}"
    text = studies.ring(count, joint=joint, more=f"mesh = {{ elements = [1, {SEGMENTS}] }}", output=QUIET, solver=solver)
    return dataclasses.replace(ring(count), study=text)


class OpenSeesRing:
    """The ring as OpenSees has it: node k + 1 is the centre of block k, nodes below zero of the abutment are fixed."""

    def __init__(self, count):
        self.count = count
        self.inside, self.outside, self.angles = ring_joints(count)
        self.blocks = []
        for k in range(count):
            outline = [self.inside[k + 1], self.outside[k + 1], self.outside[k], self.inside[k]]
            area, centre = area_and_centre(outline)
            self.blocks.append((area * RING["density"] * 9.81 / 1e3, centre))
        x = -RING["span"] / 4
        self.loaded = next(k for k in range(count) if self.outside[k][0] <= x < self.outside[k + 1][0])
        self.lever = x - self.blocks[self.loaded][1][0]

    def build(self, ops, system):
        """Nodes, joints and dead load."""
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        ops.uniaxialMaterial("ENT", 1, STIFFNESS[0] / 1e3)
        ops.uniaxialMaterial("Elastic", 2, STIFFNESS[1] / 1e3 * RING["thickness"])
        points = 2 * SEGMENTS + 1
        shares = [(2.0 if i % 2 == 0 else 4.0) / (6 * SEGMENTS) for i in range(points)]  # Simpson's rule
        shares[0] = shares[-1] = 1.0 / (6 * SEGMENTS)
        ops.section("Fiber", 1)
        for i, share in enumerate(shares):
            ops.fiber((i / (points - 1) - 0.5) * RING["thickness"], 0.0, share * RING["thickness"], 1)
        ops.section("Aggregator", 2, 2, "Vy", "-section", 1)
        for k, (_, centre) in enumerate(self.blocks):
            ops.node(k + 1, *centre)
        node = self.count + 1
        for k, angle in enumerate(self.angles):
            middle = [(a + b) / 2 for a, b in zip(self.inside[k], self.outside[k])]
            for block, tag in ((k - 1, node), (k, node + 1)):
                ops.node(tag, *middle)
                if 0 <= block < self.count:
                    ops.rigidLink("beam", block + 1, tag)
                else:
                    ops.fix(tag, 1, 1, 1)
            normal = (math.cos(angle), -math.sin(angle), 0.0)
            along = (math.sin(angle), math.cos(angle), 0.0)
            ops.element("zeroLengthSection", k + 1, node, node + 1, 2, "-orient", *normal, *along)
            node += 2
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        for k, (weight, _) in enumerate(self.blocks):
            ops.load(k + 1, 0.0, -weight, 0.0)
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system(system)
        ops.algorithm("Newton")
        ops.analysis("Static", "-noWarnings")

    def solve(self, ops, first, tolerance, system):
        """Load factor on the plateau."""
        self.build(ops, system)
        ops.test("NormUnbalance", 1e-8, 100, 0)
        ops.integrator("LoadControl", 1.0)
        if ops.analyze(1) != 0:
            raise ArithmeticError("no convergence under the dead load")
        ops.loadConst("-time", 0.0)
        ops.timeSeries("Linear", 2)
        ops.pattern("Plain", 2, 2)
        ops.load(self.loaded + 1, 0.0, -1.0, -self.lever)
        step, before = first, 0.0
        while 1e-9 < step < 1e3:
            ops.integrator("DisplacementControl", self.loaded + 1, 2, -step)
            if ops.analyze(1) != 0:
                step /= 4
                continue
            factor = ops.getTime()
            if abs(factor - before) <= tolerance * abs(factor):
                return factor
            step, before = 2 * step, factor
        raise ArithmeticError("no plateau")


def by_opensees(ops, peer, setting):
    """Seconds and factor of a run; infinite where it fails."""
    start = time.process_time()
    try:
        factor = peer.solve(ops, *setting)
    except (ArithmeticError, ops.OpenSeesError) as failure:
        print(f"    OpenSees with {setting}: {failure}")
        return math.inf, math.inf
    return time.process_time() - start, factor


def measure(count, program, ops, rounds):
    """The limit load of rigid blocks, and name → [(seconds, load factor)], by turns."""
    rigid = dataclasses.replace(ring(count), study=studies.ring(count, joint=STUCK, output=QUIET))
    reference = by_voussoir(program, rigid)[0]
    peer = OpenSeesRing(count)
    results = {}
    for _ in range(rounds):
        by_paths(program, lambda solver: compliant(count, solver), results)
        settings = [(i, t, s) for i in INCREMENTS for t in TOLERANCES for s in SYSTEMS] if ops else []
        for setting in settings:
            seconds, factor = by_opensees(ops, peer, setting)
            results.setdefault("OpenSees", []).append((seconds, factor))
    return reference, results


def main():
    options = arguments(__doc__, ["ring:13"], 2)
    try:
        import openseespy.opensees as ops

        print("OpenSees", ops.version())
        ops.logFile(os.devnull, "-noEcho")
    except ImportError:
        ops = None
        print("OpenSeesPy is not installed, left out")
    for word in options.scenes:
        count = int(word.removeprefix("ring:"))
        reference, results = measure(count, options.voussoir, ops, options.rounds)
        report(ring(count), reference, results)
        append_rows(options.csv, f"compliant, scene.voussoirs = {count}", results)


if __name__ == "__main__":
    main()
