"""Time to an error: limit loads by Voussoir and by other programs on the same polygons.

    python3 -m venv venv && venv/bin/pip install -r requirements.txt
    venv/bin/python limit_load.py --voussoir ../../target/release/voussoir ring:13 ring:1000 wall:10 wall:20

Every program is run over a ladder of tolerances. What counts is not the tolerance it was given but the error of the load
factor it gave, against Voussoir's, whose bounds meet: for each error asked for the least processor time of the settings
that got there, least of several rounds, all programs by turns. Programs that are not installed are named and left out.
"""

import argparse
import csv
import importlib.metadata
import math
import os
import platform
import subprocess
import tempfile
import time
from pathlib import Path

from contestants import CONTESTANTS, Data
from scenes import ring, running_bond, wall

TOLERANCES = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12]
ERRORS = [1e-3, 1e-6, 1e-9]
# Seconds after which a program is not asked for more.
PATIENCE = 10.0


def scene_of(word):
    kind, _, size = word.partition(":")
    if kind == "ring":
        return ring(int(size))
    if kind == "wall":
        bricks, _, courses = size.partition("x")
        return wall(running_bond(int(bricks), int(courses or bricks)), f"wall of {bricks} x {courses or bricks}")
    raise SystemExit(f"{word}: scenes are ring:N, wall:N and wall:BRICKSxCOURSES")


def problem_of(word):
    """The name of a scene of this script in the studies of `benches/scenes`."""
    kind, _, size = word.partition(":")
    return f"{kind}, scene.{'voussoirs' if kind == 'ring' else 'bricks'} = {size.partition('x')[0]}"


def by_voussoir(program, scene):
    """Load factor and processor time of a certified case from the study, made anew: `voussoir bench`."""
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "study.toml"
        study.write_text(scene.study)
        command = [program, "bench", str(study), "--out", folder, "--runs", "1", "--quiet"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(Path(folder) / "bench.csv", newline="") as file:
            row = next(csv.DictReader(file))
        if row["certified"] != "true":
            raise SystemExit(f"{scene.name}: Voussoir's own answer is not certified")
        return float(row["load_factor [-]"]), float(row["seconds [s]"])


def timed(solve, data, tolerance):
    """The factor and processor time of one run; infinite where it fails."""
    try:
        start = time.process_time()
        factor = solve(data, tolerance) * data.unit
        seconds = time.process_time() - start
        return factor, seconds
    except Exception as failure:  # each program fails in words of its own
        print(f"    {solve.__name__} at {tolerance:g}: {failure}")
        return math.nan, math.inf


def measure(scene, program, contestants, rounds):
    """Name → [(seconds, load factor)], all by turns."""
    data = Data(scene)
    reference, seconds = by_voussoir(program, scene)
    results = {"Voussoir, certified": [(seconds, reference)]}
    best = {}
    slow = set()
    for _ in range(rounds):
        own = by_voussoir(program, scene)[1]
        results["Voussoir, certified"].append((own, reference))
        for name, solve in contestants.items():
            for tolerance in TOLERANCES:
                if name in slow:
                    break
                factor, seconds = timed(solve, data, tolerance)
                before = best.get((name, tolerance), (math.inf, factor))
                best[name, tolerance] = (min(before[0], seconds), factor)
                if seconds > PATIENCE:
                    slow.add(name)
    for (name, _), found in best.items():
        results.setdefault(name, []).append(found)
    return reference, results


def error_of(factor, reference):
    """The relative error; infinite for a run that failed."""
    return abs(factor / reference - 1.0) if math.isfinite(factor) else math.inf


def append_rows(file, problem, results):
    """Appends the runs of other programs to a CSV file for `voussoir bench --others`."""
    if file is None:
        return
    new = not os.path.exists(file)
    with open(file, "a", newline="") as rows:
        writer = csv.writer(rows, lineterminator="\n")
        if new:
            writer.writerow(["problem", "program", "load_factor [-]", "seconds [s]"])
        for name, found in results.items():
            if not name.endswith("certified"):
                known = (run for run in found if all(map(math.isfinite, run)))
                writer.writerows([problem, name, repr(float(factor)), f"{seconds:.4g}"] for seconds, factor in known)


def report(scene, reference, results):
    results = {name: [(s, error_of(factor, reference)) for s, factor in found] for name, found in results.items()}
    own = min(seconds for seconds, _ in next(iter(results.values())))
    print(f"\n{scene.name}: load factor {reference:.12g}")
    header = "".join(f" | {'to ' + format(error, 'g'):>22}" for error in ERRORS)
    print(f"  {'':22}{header} | least error")
    for name, found in results.items():
        cells = []
        for target in ERRORS:
            times = [seconds for seconds, error in found if error <= target]
            cells.append(f"{1e3 * min(times):11.4g} ms {min(times) / own:6.3g} x" if times else "never")
        least = min(error for _, error in found)
        print(f"  {name:22}" + "".join(f" | {cell:>22}" for cell in cells) + f" | {least:.1e}")


def arguments(doc, scenes, rounds):
    """The words of the command line, and who measures."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=scenes)
    parser.add_argument("--voussoir", default="voussoir", help="the program")
    parser.add_argument("--rounds", type=int, default=rounds)
    parser.add_argument("--csv", help="append the runs of other programs to this file")
    options = parser.parse_args()
    version = subprocess.run([options.voussoir, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    print(f"{version}; Python {platform.python_version()}; {platform.machine()}, {platform.system()}")
    return options


def by_paths(program, scene, results):
    """Adds seconds and load factor of both path solvers on their own scenes to name → [(seconds, load factor)]."""
    for solver in ("event_path", "newton_path"):
        factor, seconds = by_voussoir(program, scene(solver))
        results.setdefault(f"{solver}, certified", []).append((seconds, factor))


def main():
    options = arguments(__doc__, ["ring:13", "ring:1000", "wall:10"], 3)
    contestants = {}
    for name, (package, solve) in CONTESTANTS.items():
        try:
            print(f"{name}: {package} {importlib.metadata.version(package)}")
            contestants[name] = solve
        except importlib.metadata.PackageNotFoundError:
            print(f"{name}: {package} is not installed, left out")
    for word in options.scenes:
        scene = scene_of(word)
        reference, results = measure(scene, options.voussoir, contestants, options.rounds)
        report(scene, reference, results)
        append_rows(options.csv, problem_of(word), results)


if __name__ == "__main__":
    main()
