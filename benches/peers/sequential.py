"""Loads with slip that does not open: the sequence of linear programs with fictitious cohesion (Gilbert, Casapulla & Ahmed,
Computers & Structures 84, 2006) on HiGHS's simplex method, beside `limit_sequential`.

    venv/bin/python sequential.py --voussoir ../../target/release/voussoir 'wall 1' 2x6

HiGHS keeps no basis here: each program is solved from nothing. Several shares of the way to the new normal forces are
tried, since which of them settles is not known beforehand. The last column is in units of the heaviest block.
"""

import argparse
import time

import numpy as np

from contestants import Data, highs
from limit_load import append_rows, by_voussoir
from scenes import WALL_FRICTION, WALLS, running_bond, wall

PROGRAMS = 200
# Relative change of the factor, and how often one after the other, at which the sequence is left, as the paper does.
SETTLED = 1e-6
STEADY = 2
# The same changes for the rows of a CSV file.
LADDER = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10]


def sequence(scene, share, settled=SETTLED):
    """The last factor, the number of programs, whether it settled and by how much its field exceeds friction."""
    data = Data(scene)
    highs(data, 1e-9)
    normal, steady, last = np.zeros(0), 0, data.answer[-1]
    for count in range(1, PROGRAMS + 1):
        forces = data.answer[:-1].reshape(-1, 3)
        pressed = forces[:, 0] + forces[:, 1]
        exceeded = (np.abs(forces[:, 2]) - scene.friction * pressed).max()
        if steady == STEADY:
            return last, count, True, exceeded
        normal = pressed if count == 1 else normal + share * (pressed - normal)
        data = Data(scene, relief=np.repeat(scene.friction * normal, 2), dilatancy=0.0)
        highs(data, 1e-9)
        factor = data.answer[-1]
        steady = steady + 1 if abs(factor - last) <= settled * abs(factor) else 0
        last = factor
    return last, PROGRAMS, False, exceeded


def timed(scene, share, settled=SETTLED):
    """What `sequence` returns, and its processor time."""
    start = time.process_time()
    answer = sequence(scene, share, settled)
    return answer, time.process_time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("walls", nargs="*", default=list(WALLS), help="'wall 1' to 'wall 4', or BRICKSxCOURSES")
    parser.add_argument("--voussoir", default="voussoir", help="the program")
    parser.add_argument("--csv", help="append the runs of walls of bricks to this file")
    options = parser.parse_args()
    for name in options.walls:
        rows = WALLS[name] if name in WALLS else running_bond(*map(int, name.split("x")))
        scene = wall(rows, name, law="coulomb", solver="limit_sequential")
        own = min((by_voussoir(options.voussoir, scene) for _ in range(3)), key=lambda pair: pair[1])
        print(f"{name}: limit_sequential {own[0]:.9f} in {1e3 * own[1]:.3g} ms, certified")
        for share in (1.0, 0.7, 0.5, 0.3):
            (factor, count, settled, exceeded), seconds = timed(scene, share)
            end = "settled" if settled else "not settled"
            print(f"    HiGHS, share {share}: {factor:.9f} in {1e3 * seconds:.4g} ms, {count} programs, {end}, friction exceeded by {exceeded:.1e}")
            if name not in WALLS:
                runs = [timed(scene, share, settled) for settled in LADDER]
                rows = [(seconds, answer[0]) for answer, seconds in runs if answer[2]]
                append_rows(options.csv, f"wall_non_associated, joints.dry.friction = {WALL_FRICTION}", {"HiGHS, sequence": rows})


if __name__ == "__main__":
    main()
