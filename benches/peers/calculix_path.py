"""Elastic blocks with dry joints to their limit load: Voussoir's two path solvers and CalculiX, on the same polygons.

    apt-get install calculix-ccx                                     # Debian 12: CalculiX 2.20
    venv/bin/python calculix_path.py --voussoir ../../target/release/voussoir ring:13

The ring of `scenes.py` in plane stress, E = 5 GPa, ν = 0.3. CalculiX gets four-node elements (CPS4), penalty contact node to
surface with friction, the dead load in one step, then 100 kN at the two nodes beside the loaded point, in increments of its own; the load is that of the last one
that converges. (Driven by a displacement, which an equation ties to these nodes, it diverges in the first increment.) It is run
over contact stiffnesses, meshes and first increments; told is the least processor time to an error of the limit load.

With small displacements and strengths of the joints' ends alone the limit load is that of rigid blocks, which linear programming
gives: that is the reference. NLGEOM is off; that the load agrees to all digits of CalculiX's tables shows that it stays so.
"""

import itertools
import math
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from elastic_path import POISSON, YOUNG, elastic
from limit_load import append_rows, arguments, by_paths, by_voussoir, report
from scenes import RING, ring, ring_joints

GRAVITY = 9.81
STIFFNESSES = [1e10, 1e11, 1e12]  # Pa/m, of a joint
MESHES = [(2, 2), (4, 4)]  # elements along a voussoir, across it
LOAD = 100.0  # kN
INCREMENTS = [(0.3, 1e-4), (0.1, 1e-4), (0.05, 1e-6)]  # of it: at first and at most, at least


class Deck:
    """The ring as an input file of CalculiX."""

    def __init__(self, count, mesh):
        self.along, self.across = mesh
        self.nodes, self.elements, self.surfaces = [], [], []
        inside, outside, angles = ring_joints(count)
        quads = [[inside[k], outside[k], inside[k + 1], outside[k + 1]] for k in range(count)]
        for quad in quads:
            self.block(quad, self.along, self.across)
        free = len(self.nodes)
        for k, turn in [(0, -1.0), (count, 1.0)]:
            deep = lambda p, a=angles[k], s=turn: (p[0] + s * 0.1 * math.cos(a), p[1] - s * 0.1 * math.sin(a))
            near, far = [inside[k], outside[k]], [deep(inside[k]), deep(outside[k])]
            self.block(far + near if k == 0 else near + far, 1, 1)
        self.held = range(free + 1, len(self.nodes) + 1)
        self.pairs = [(count, 0)] + [(k, k + 1) for k in range(count - 1)] + [(count - 1, count + 1)]
        self.point = self.loaded(quads)

    def block(self, quad, along, across):
        """A block's nodes and elements; its first and last joints as surfaces."""
        first = len(self.nodes)
        a, b, c, d = quad
        for i in range(along + 1):
            for j in range(across + 1):
                s, t = j / across, i / along
                weights = ((1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t)
                self.nodes.append(tuple(sum(w * p[x] for w, p in zip(weights, (a, b, c, d))) for x in range(2)))
        at = lambda i, j: first + i * (across + 1) + j + 1
        start = len(self.elements)
        # Anticlockwise: from inside to outside is to the left of the way along the ring.
        for i in range(along):
            for j in range(across):
                self.elements.append((at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
        number = lambda i, j: start + i * across + j + 1
        self.surfaces.append(([number(0, j) for j in range(across)], [number(along - 1, j) for j in range(across)]))

    def loaded(self, quads):
        """The two nodes beside the loaded point on the extrados, with their shares."""
        x = -RING["span"] / 4
        per_block = (self.along + 1) * (self.across + 1)
        for block in range(len(quads)):
            edge = [block * per_block + i * (self.across + 1) + self.across + 1 for i in range(self.along + 1)]
            for a, b in zip(edge, edge[1:]):
                left, right = self.nodes[a - 1][0], self.nodes[b - 1][0]
                if left <= x < right:
                    share = (x - left) / (right - left)
                    return (a, 1 - share), (b, share)
        raise ValueError("no edge under the load")

    def text(self, stiffness, increment, least):
        out = ["*NODE"] + [f"{k}, {x:.12g}, {y:.12g}, 0" for k, (x, y) in enumerate(self.nodes, 1)]
        out += ["*ELEMENT, TYPE=CPS4, ELSET=STONE"] + [f"{k}, " + ", ".join(map(str, e)) for k, e in enumerate(self.elements, 1)]
        out += ["*MATERIAL, NAME=STONE", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", str(RING["density"])]
        out += ["*SOLID SECTION, ELSET=STONE, MATERIAL=STONE", "1.0"]
        for k, (first, last) in enumerate(self.surfaces):
            out += [f"*SURFACE, NAME=F{k}, TYPE=ELEMENT"] + [f"{e}, S4" for e in first]
            out += [f"*SURFACE, NAME=L{k}, TYPE=ELEMENT"] + [f"{e}, S2" for e in last]
        out += ["*SURFACE INTERACTION, NAME=DRY", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness}, 1.0, 1e-3"]
        out += ["*FRICTION", f"{RING['friction']}, {stiffness}"]
        for before, after in self.pairs:
            out += ["*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE", f"L{before}, F{after}"]
        out += ["*BOUNDARY"] + [f"{k}, 1, 2" for k in self.held]
        out += ["*STEP, INC=1000", "*STATIC", "0.25, 1", "*DLOAD", f"STONE, GRAV, {GRAVITY}, 0, -1, 0", "*END STEP"]
        out += ["*STEP, INC=10000", "*STATIC", f"{increment}, 1, {least}, {increment}", "*CLOAD"]
        out += [f"{node}, 2, {-1000 * LOAD * share:.12g}" for node, share in self.point]
        return "\n".join(out + ["*END STEP", ""])


def by_calculix(program, text):
    """Processor time and the load [kN] of the last increment that converges; infinite where none does."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "ring.inp").write_text(text)
        environment = os.environ | {"OMP_NUM_THREADS": "1"}
        process = subprocess.Popen([program, "ring"], cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, _, used = os.wait4(process.pid, 0)
        table = Path(folder, "ring.sta").read_text() if Path(folder, "ring.sta").exists() else ""
    # Step, increment, attempt (U: it did not converge), iterations, total time, time in the step, its increment.
    ends = [line.split() for line in table.splitlines() if re.match(r"\s+2\s+\d+\s+\d+\s", line)]
    if not ends:
        return math.inf, math.inf
    return used.ru_utime + used.ru_stime, LOAD * float(ends[-1][5])


def measure(count, program, calculix, rounds):
    """The limit load of rigid blocks, and name → [(seconds, load factor)], by turns."""
    reference = by_voussoir(program, ring(count))[0]
    decks = {mesh: Deck(count, mesh) for mesh in MESHES}
    results = {}
    for turn in range(rounds):
        by_paths(program, lambda solver: elastic(count, solver), results)
        settings = itertools.product(MESHES, STIFFNESSES, INCREMENTS) if calculix else []
        for mesh, stiffness, (increment, least) in settings:
            seconds, factor = by_calculix(calculix, decks[mesh].text(stiffness, increment, least))
            if turn == 0:
                print(f"    CalculiX, {mesh[0]} x {mesh[1]}, {stiffness:g} Pa/m, {increment:g} to {least:g}: {factor:.6f} in {seconds:.3g} s")
            results.setdefault("CalculiX", []).append((seconds, factor))
    return reference, results


def main():
    options = arguments(__doc__, ["ring:13"], 1)
    calculix = shutil.which("ccx")
    if calculix:
        print(subprocess.run([calculix, "-v"], capture_output=True, text=True).stdout.strip())
    else:
        print("CalculiX is not installed, left out (Debian: calculix-ccx)")
    for word in options.scenes:
        count = int(word.removeprefix("ring:"))
        reference, results = measure(count, options.voussoir, calculix, options.rounds)
        report(elastic(count, "auto"), reference, results)
        append_rows(options.csv, f"elastic, scene.voussoirs = {count}", results)


if __name__ == "__main__":
    main()
